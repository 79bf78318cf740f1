"""The contact problem: an elastic operator under a rigid profile that acts through a surface law.

Unknowns x = (H_1 ... H_q, alpha*, s): nodal gaps in eps, approach in eps, and the scale s of the grid. Equations
[G97] (2.8), and one for the scale, which is either fixed or is the radius of the contact edge:

    H + alpha* - mu z(u) - mu C P(H) = 0,        s = 1   or   H(u = s) = H_edge,

z the height of the undeformed surface over its pole, u^2/2 for a paraboloid. Radii u, weights and compliance C depend
on s where the grid breathes with the contact (`halfspace.elastic.operators`). That costs one unknown and keeps the
spike of tension at the contact edge on the same nodes all along the path.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg.lapack import dgetrf, dgetrs, dsytrf

from halfspace.elastic.compliance import ElasticOperator, Operator, SurfaceNodes
from halfspace.equilibrium.acting import Acting
from halfspace.errors import ContactTooWide, GridTooCoarse
from halfspace.laws import LENNARD_JONES, Law
from halfspace.profiles import PARABOLOID, Surface
from halfspace.scales import Scales
from halfspace.values import Array, Valued, appended, keep

APPROACH, LOAD, CENTRAL_GAP, CONTACT_RADIUS = range(4)  # the observables, in this order
OBSERVABLES = ("approach", "load", "central_gap", "contact_radius")

LARGEST = 0.75  # part of a gap h by which it may shrink in a step
WIDEST = 0.95  # of the radius of a body, that a contact may reach


def widest_interval(nodes: int) -> float:
    """Widest interval between k nodes of a cell that carries the spike, in its widths.

    Found by trial: at tabor 1 it leaves 5e-5 to 2e-3 of the pull-off load, ten times more if twice as wide.
    """
    k = nodes - 1
    return max(0.1, min(0.1 * k, 0.021 * k**2))


class Solver(Protocol):
    """Of the linearised equations with the control row below them."""

    def __call__(self, rhs: Array, accuracy: float = 0.0, /) -> Array:
        """Solution; one that is iterated for may stop at a relative accuracy, 0 for all digits."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactProblem(Valued):
    """Equilibrium of a surface law with an elastic operator.

    The operator is any body's surface compliance, from any discretisation, on a grid that stands still or follows the
    contact; tabor is mu, the profile that of the undeformed surface.
    """

    operator: Operator
    tabor: float
    law: Law = LENNARD_JONES
    profile: Surface = PARABOLOID

    @cached_property
    def scales(self) -> Scales:
        """Lengths of the contact."""
        return Scales(self.tabor, self.law, self.profile)

    @cached_property
    def _latest(self) -> deque[Acting]:
        """What acts in the last two states, that of a step and its trial: each is asked for several times."""
        return deque(maxlen=2)

    def _acting(self, x: Array) -> Acting:
        state = np.asarray(x, float).tobytes()  # what it holds, since it may be written to
        for known in self._latest:
            if known.state == state:
                return known
        self._latest.append(Acting(state, self.law, self.tabor, self.profile, self.operator, self.scales.far_energy))
        return self._latest[-1]

    @property
    def follows_contact(self) -> bool:
        """Whether the grid follows the contact, whose radius then joins the unknowns."""
        return self.operator.follows_contact

    @property
    def interface(self) -> ContactProblem:
        """The problem itself, whose state is that of the surface: see `halfspace.equilibrium.newton.Traceable`."""
        return self

    def surface_state(self, x: Array) -> Array:
        """Return the state itself."""
        return x

    def state_from_surface(self, state: Array) -> Array:
        """Return the state itself."""
        return state

    def operator_at(self, x: Array) -> ElasticOperator:
        """Operator of a state."""
        return self.operator.at(float(x[-1]))

    def nodes_at(self, x: Array) -> SurfaceNodes:
        """Nodes of a state."""
        return self._acting(x).body

    def undeformed(self, approach: float, scale: float = 1.0) -> Array:
        """State with the gaps of the undeformed surfaces, H = -alpha* + mu z(u), as a start for Newton's method."""
        return np.concatenate([self.rough(self.operator.nodes(scale).radii, approach), [approach, scale]])

    def rough(self, radii: Array, approach: float) -> Array:
        """Gaps of the undeformed surfaces: they are as steep as the profile, the deflection is smooth."""
        return np.asarray(self.tabor * self.profile.height(radii) - approach)

    def residual(self, x: Array) -> Array:
        """Left-hand sides of the equilibrium (in eps) and scale equations, shape (q + 1,)."""
        here = self._acting(x)
        return appended(
            here.deflection - self.tabor * (here.compliance @ here.pressure),
            float(self.operator.edge_row @ x[:-2]) - self.law.edge_gap if self.follows_contact else float(x[-1]) - 1,
        )

    def jacobian(self, x: Array) -> Array:
        """Derivative of the residual, shape (q + 1, q + 2)."""
        return self._bordered(x, np.zeros(x.size))[:-1]

    def _bordered(self, x: Array, row: Array) -> Array:
        """Jacobian with a row below it, as Fortran has it: what is factorised need not be copied."""
        here, J = self._acting(x), np.zeros((x.size, x.size), order="F")
        np.multiply(here.compliance, -self.tabor * here.slope, out=J[:-2, :-2])
        np.einsum("ii->i", J)[:-2] += 1
        J[:-2, -2] = 1
        if self.follows_contact:
            J[:-2, -1] = here.rates[2]
            J[-2, :-2] = self.operator.edge_row
        else:
            J[-2, -1] = 1
        J[-1] = row
        return J

    def along(self, x: Array, v: Array) -> Array:
        """Derivative of the residual along a direction of the state, without its matrix, shape (q + 1,)."""
        here, dH, ds = self._acting(x), v[:-2], v[-1]
        change = dH + v[-2] - self.tabor * (here.compliance @ (here.slope * dH))
        if self.follows_contact:
            return appended(change + here.rates[2] * ds, float(self.operator.edge_row @ dH))
        return appended(change, ds)

    def bordered_solver(self, x: Array, row: Array) -> Solver:
        """Factorise the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        return factorised(self._bordered(x, row))

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius (nan without contact), shape (4,)."""
        here = self._acting(x)
        return np.array([float(getattr(here, name)) for name in OBSERVABLES])

    def sizes(self, x: Array) -> Array:
        """Sums of the sizes of the terms that the observables are made of, shape (4,)."""
        return self._acting(x).sizes

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Sum of the observables by the given weights; one of weight zero is not computed and need not exist."""
        here = self._acting(x)
        pairs = zip(OBSERVABLES, weights.tolist(), strict=True)
        return sum((weight * getattr(here, name) for name, weight in pairs if weight), 0.0)

    def load(self, x: Array) -> float:
        """W in R dgamma, positive in compression."""
        return self._acting(x).load

    def central_gap(self, x: Array) -> float:
        """H(0) in eps."""
        return self._acting(x).central_gap

    def pressure(self, x: Array) -> Array:
        """Nodal pressures P, shape (q,)."""
        return self._acting(x).pressure.copy()

    def radii(self, x: Array) -> Array:
        """Nodal radii in beta, shape (q,)."""
        return self.nodes_at(x).radii

    def deflection(self, x: Array) -> Array:
        """Of the nodes in eps, mu w = H + alpha* - mu z(u), shape (q,)."""
        return self._acting(x).deflection.copy()

    def contact_radius(self, x: Array) -> float:
        """Largest radius in beta at which the gap is that of the largest tension, nan where all gaps are wider.

        Where they are nowhere so far apart it is the extent of the surface.
        """
        return self._acting(x).contact_radius

    def beside_axis(self, x: Array) -> Array:
        """Radii in beta of the nodes in the inner half of the cell on the axis."""
        body = self.nodes_at(x)
        nodes = body.cell_nodes[0]
        return np.asarray(body.radii[nodes[: (nodes.size + 1) // 2]])

    def near_axis(self, x: Array, radii: Array) -> Array:
        """Deflection in eps less the approach at radii (n,) in the cell on the axis: the gap at 0.

        By the polynomial through its nodes in the squares of their places, as the gap on the axis: one in the radii
        errs by far more between nodes than at them.
        """
        body = self.nodes_at(x)
        return np.asarray(body.near_axis(radii) @ self.deflection(x)[body.cell_nodes[0]] - x[-2])

    def ripples(self, x: Array) -> Array:
        """What the deflection's polynomials end with on the axis, in eps, and at the contact edge, in beta, (2,).

        No better are values at a point known: the central gap by the last Legendre coefficients in the first cell, see
        `_left_out`; the contact radius, nan without contact, by the last but one in the cells on both sides of the
        edge, see `_last_but_one`, in the geometric mean: they have it from either. On a grid whose cells inside the
        contact alone grow with it they are not alike, and that outside counts, of whose polynomial the radius is a
        root. On finite elements of degree p, with p + 2 nodes, the last is none of theirs. A straight line between two
        nodes does not tell of the radius: nan.
        """
        body, radius = self.nodes_at(x), self.contact_radius(x)
        gap = _left_out(self._coefficients(x, 0))
        if np.isnan(radius) or body.cell_nodes.shape[1] == 2:
            return np.array([gap, np.nan])
        sides = (-1e-9, 1e-9) if self.operator.alike else (1e-9,)
        cells = {body.cell_of(radius * (1 + side)) for side in sides}
        slope = abs(body.continuous(radius)[1] @ x[:-2])
        left = np.prod([_last_but_one(self._coefficients(x, cell)) for cell in cells]) ** (1 / len(cells))
        return np.array([gap, left / slope])

    def _coefficients(self, x: Array, cell: int) -> Array:
        """Sizes of the Legendre coefficients of the deflection in a cell, whereas the profile is exact, in eps."""
        body = self.nodes_at(x)
        nodes, (first, last) = body.cell_nodes[cell], body.cells[cell : cell + 2]
        places = 2 * (body.radii[nodes] - first) / (last - first) - 1
        deflection = x[nodes] - self.tabor * self.profile.height(body.radii[nodes])
        return np.abs(np.linalg.solve(legvander(places, nodes.size - 1), deflection))

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative by x of the weighted sum of the observables, shape (q + 2,)."""
        here = self._acting(x)
        row = weights[:CONTACT_RADIUS] @ here.gradients
        return row + weights[CONTACT_RADIUS] * here.radius_gradient if weights[CONTACT_RADIUS] else row

    def rates(self, x: Array, v: Array) -> Array:
        """Derivatives of the observables along a direction, 0 of a contact radius that there is not, shape (4,)."""
        here = self._acting(x)
        return appended(here.gradients @ v, 0.0 if np.isnan(here.contact_radius) else float(here.radius_gradient @ v))

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands where the grid is too coarse for the spike of tension, or beyond it.

        Linear interpolation wants ten intervals in the spike's width, polynomials fewer (`widest_interval`). A coarser
        grid still converges, to a pull-off force that is too large ([G97] 4b). GridTooCoarse tells the spacing, its
        place and the limit.
        """
        radius, body = self.contact_radius(x), self.nodes_at(x)
        if np.isnan(radius):
            return
        require_narrow(radius, self.operator.served[1])
        cell, nodes = body.cell_of(radius), body.cell_nodes.shape[1]
        intervals = max(nodes - 1, 1)
        spacing = float((body.cells[cell + 1] - body.cells[cell]) / intervals)
        limit = self.scales.spike_width * widest_interval(nodes)
        if spacing > limit * (1 + 1e-9):
            raise GridTooCoarse(
                f"grid spacing {spacing:.3g} beta at the contact edge, radius {radius:.3g} beta, "
                f"exceeds {limit:.3g} beta for tabor {self.tabor:g}; refine the grid there",
                radius,
                spacing * intervals,
                limit * intervals,
            )

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that leaves a quarter of each gap h, of the scale and of its room on the profile."""
        least, scale, change = float((dx[:-2] / self._acting(x).room).min()), float(x[-1]), float(dx[-1])
        return min(1.0, LARGEST / max(LARGEST, -least, -change / scale, change / (self.profile.end - scale)))

    def size(self, x: Array, dx: Array) -> float:
        """Relative size of the change dx of the state x."""
        gaps = float(np.abs(dx[:-2] / self._acting(x).room).max())
        return max(gaps, abs(float(dx[-2])) / (1 + abs(float(x[-2]))), abs(float(dx[-1]) / float(x[-1])))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm of the residual relative to the gaps, lest the far field of a scaled grid drown the contact."""
        gaps = residual[:-1] / self._acting(x).room
        return math.sqrt(float(gaps @ gaps) + float(residual[-1]) ** 2)

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps, elastic and surface; its derivative by the approach is the load."""
        return self._acting(x).energies[0]

    def energy_size(self, x: Array) -> float:
        """Sum of the sizes of the terms of the energy, which may cancel."""
        return self._acting(x).energies[1]

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the energy falls at fixed approach; 0 means stable under fixed grips.

        The Hessian A^-1 - mu w P'(H), A = C/w, has the inertia of I - mu L^T P'(H) L, where L L^T is the compliance
        made symmetric by the square roots of the weights.
        """
        L = self.operator.root(float(x[-1]))
        hessian = np.eye(L.shape[1]) - L.T @ (L * (self.tabor * self._acting(x).slope)[:, None])
        return count_negative(hessian)


def _left_out(coefficients: Array) -> float:
    """What a polynomial leaves out at the end of a cell, by the sizes of its Legendre coefficients: the last ones.

    Since one may be small by accident, the third last counts as well, carried on by how fast they fall, if there are
    enough to tell: half way to the next, in their logarithms, since they fall unevenly.
    """
    count = coefficients.size
    last = coefficients[max(min(2, count - 1), count - 3) :]  # but no displacement, and no slope
    if count < 6:
        return float(last.max())
    before, after = coefficients[-5:-3].max(), coefficients[-3:-1].max()  # two orders apart
    fall = min(1.0, after / before) if before else 1.0
    return float((last * fall ** np.array([0.25, 0.0, 0.0])).max())


def _last_but_one(coefficients: Array) -> float:
    """Of the sizes of a polynomial's Legendre coefficients that before the last, or what the one after it is to be.

    It may be small by accident, where the deflection is nearly even or odd in the cell; every second one falls alike,
    so that the third last, carried on by the fall over the two orders before it, tells the size of the next.
    """
    known = float(coefficients[-2:][0])
    if coefficients.size < 5:
        return known
    before, last = coefficients[-5], coefficients[-3]
    return max(known, float(last * min(1.0, last / before)) if before else 0.0)


def require_narrow(radius: float, limit: float) -> None:
    """Raise ContactTooWide if a contact radius exceeds a limit, in beta."""
    if radius > limit:
        raise ContactTooWide(
            f"contact radius = {radius:.3g} beta, limit: {limit:.3g}, beyond which the body is taken as rigid; take a "
            "blunter tip, a thicker layer, a larger block or the half-space solver"
        )


def contact_of(scales: Scales, operator: Operator) -> ContactProblem:
    """Contact of these scales, which it shares with others, with an elastic operator."""
    problem = ContactProblem(operator, scales.tabor, scales.law, scales.profile)
    keep(problem, scales=scales.of_contact)  # what is cached of them is found once for all charts
    return problem


def factorised(matrix: Array) -> Solver:
    """Solver by the factors of a matrix, which have all digits; it is overwritten. All nan if it is singular."""
    lu, pivots, singular = dgetrf(matrix, overwrite_a=True)
    if singular:
        lu[:] = np.nan
    return lambda rhs, _=0.0: np.asarray(dgetrs(lu, pivots, rhs)[0])


def count_negative(matrix: Array) -> int:
    """Count the negative eigenvalues of a symmetric matrix by Sylvester's law of inertia (Bunch-Kaufman)."""
    ldu, pivots, _ = dsytrf(matrix, lower=1)
    single = pivots > 0
    return int(np.sum(np.diag(ldu)[single] < 0) + np.sum(~single) // 2)  # a 2 x 2 block has one of each sign
