"""The contact problem at finite strain: Newton's method on every unknown of a neo-Hookean body at once.

Unknowns x = (y, alpha*): reduced unknowns y with u = T y, see `fem_adhesion.elasticity.far_field`, and the approach in
eps. Displacements are in mu eps = beta^2/R, so that a point X moves to X + delta u, delta = beta/R = sqrt(mu/rho). The
surface law, of pressure P and energy Phi, acts on the deformed surface: at its height and on its area. With z the
height of the undeformed surface in beta^2/R and r_d = r + delta u_r, the work it does in a displacement v is

    -int [P(H) v_z dA + c Phi(H)/mu d(dA)],    H = -alpha* + mu (z - u_z),    dA = 2 pi r_d dr_d,

d(dA) the change of the horizontal area by delta v_r. The first term is the force, the second that of a surface stress
c Phi; `fem_adhesion.finite_strain.traction` says what is known of c and of the area, and which are the default. With
c = 0 it is a vertical traction per deformed area.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from fem_adhesion.elasticity.far_field import Exterior
from fem_adhesion.finite_strain.bodies import Body
from fem_adhesion.finite_strain.solve import Elimination, Step, elimination
from fem_adhesion.finite_strain.surface import ContactSurface
from fem_adhesion.finite_strain.traction import Convention, Traction
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.profiles import Surface
from halfspace.values import Array, Valued

MOST_STEPS, ENOUGH = 12, 1e-4  # to a start under a given pressure, and its relative accuracy
SLOW = 0.5  # ratio of two such steps from which the stiffness is computed again
LEAST_VOLUME = 0.1
"""J below which no step may take a cell in one go, unless it was there already: before it is turned inside out."""


@dataclass(frozen=True, eq=False, repr=False)
class FiniteStrainProblem(Valued):
    """Equilibrium of a surface law with a body at finite strain; a `halfspace.equilibrium.newton.Traceable`.

    Attributes
    ----------
    body : Body
        Forces, tangent and energy of the material.
    exterior : Exterior
        How it is held or goes on: maps the n reduced unknowns, those beyond the displacements last, to all.
    surface : ContactSurface
        Where the surface law acts.
    interface : ContactProblem
        The surface law, and what can be said of a contact from the gaps alone, on a rigid body's operator.
    convention : Convention
        What the law's traction is counted per, and its direction.
    """

    body: Body
    exterior: Exterior
    surface: ContactSurface
    interface: ContactProblem
    convention: Convention

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""
        return self.interface.tabor

    @property
    def profile(self) -> Surface:
        """Of the undeformed surface."""
        return self.interface.profile

    @property
    def stretch(self) -> float:
        """Stretch parameter delta = beta/R, zero for the linear body."""
        return self.body.stretch

    @property
    def traction(self) -> Traction:
        """Forces of the surface law."""
        return Traction(self.surface, self.tabor, self.stretch, self.convention)

    def stretched(self, stretch: float) -> FiniteStrainProblem:
        """Return the same problem at another delta, the undeformed shape unchanged."""
        return replace(self, body=self.body.stretched(stretch))

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""
        return np.append(np.zeros(self.exterior.reduction.shape[1]), approach)

    def displacement(self, x: Array) -> Array:
        """All N displacements of a state, in beta^2/R."""
        return np.asarray((self.exterior.reduction @ x[:-1])[: self.body.space.unknowns])

    def gaps(self, x: Array) -> Array:
        """H at the surface's points, (q,)."""
        return np.asarray(self.interface.undeformed(x[-1])[:-2] - self.tabor * (self.surface.vertical @ x[:-1]))

    def areas(self, x: Array) -> Array:
        """Weights of the horizontal area that the law's traction acts on, (q,), in beta^2."""
        return self.traction.areas(x[:-1])

    def pressure(self, x: Array) -> Array:
        """P at the surface's points, (q,)."""
        return self.interface.law.pressure(self.gaps(x), self.tabor)

    def load(self, x: Array) -> float:
        """W in R dgamma: the pressure on the deformed horizontal area, positive in compression."""
        return float(self.areas(x) @ self.pressure(x))

    def residual(self, x: Array) -> Array:
        """Forces on the reduced unknowns that are out of balance, in R dgamma, shape (n,)."""
        return self._unbalanced(x[:-1], *self._law(x))

    def _unbalanced(self, y: Array, P: Array, Phi: Array) -> Array:
        """Forces of body, exterior, and a pressure and energy at the surface's points, (n,)."""
        T, S = self.exterior.reduction, self.exterior.stiffness
        return np.asarray(T.T @ self.body.forces(T @ y) + S @ y + self.traction.forces(y, P, Phi))

    def jacobian(self, x: Array) -> sparse.csc_array:
        """Derivative of the residual, (n, n + 1)."""
        T = self.exterior.reduction
        body = T.T @ self.body.tangent(T @ x[:-1]) @ T
        return sparse.csc_array(
            sparse.hstack(
                [
                    body + self._surface_tangent(x) + self.exterior.stiffness,
                    sparse.csc_array(self._by_approach(x)[:, None]),
                ]
            )
        )

    def _law(self, x: Array) -> tuple[Array, Array]:
        """P and Phi at the surface's points."""
        gaps, mu = self.gaps(x), self.tabor
        return self.interface.law.pressure(gaps, mu), self.interface.law.energy(gaps, mu)

    def _by_approach(self, x: Array) -> Array:
        """Derivative of the residual by the approach, (n,): H falls by one, P by its slope, and Phi rises by P."""
        slope = self.interface.law.slope(self.gaps(x), self.tabor)
        return self.traction.forces(x[:-1], -slope, self.pressure(x))

    def _surface_tangent(self, x: Array) -> sparse.csr_array:
        """Derivative by y of the surface law's forces, (n, n)."""
        slope = self.interface.law.slope(self.gaps(x), self.tabor)
        return self.traction.tangent(x[:-1], *self._law(x), slope)

    @cached_property
    def _elimination(self) -> Elimination:
        return elimination(self.body, self.exterior, self.surface.unknowns)

    def bordered_solver(self, x: Array, row: Array) -> Callable[[Array], Array]:
        """Factorise the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        cells = self.body.cell_tangents(self.exterior.reduction @ x[:-1])
        return self._elimination.factorise(
            cells, self._surface_tangent(x) + self.exterior.stiffness, self._by_approach(x), row
        ).solve

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the body moves on by itself at fixed approach; 0 means stable.

        Counted as the negative pivots of the tangent's triangular factors, without exchanges, but for one of each
        pressure unknown. Where there is an energy that is the number of directions in which it falls, by Sylvester's
        law of inertia. The tangent of the vertical traction per deformed area is not symmetric, but is so up to terms
        of the order of delta; then the number changes where the determinant does its sign, that is at the folds.
        """
        step = self._held(x[:-1], self._surface_tangent(x), pivoting=0.0)
        return step.negative_pivots() - (self.body.unknowns - self.body.space.unknowns)

    @cached_property
    def _undeformed(self) -> Step:
        """Factors of the undeformed body's tangent, positive definite or a saddle point; for norms."""
        n = self.exterior.reduction.shape[1]
        return self._held(np.zeros(n), sparse.csr_array((n, n)))

    def surface_state(self, x: Array) -> Array:
        """State as the interface knows it: H, alpha*, and the radii's fixed scale 1."""
        return np.append(self.gaps(x), [x[-1], 1.0])

    def state_from_surface(self, state: Array, near: Array | None = None) -> Array:
        """State of the body under the pressure that the gaps of an interface's state make, as a start.

        By steps with the undeformed body's stiffness as long as they converge, else with that of where they led; the
        first alone gives the linear body.
        """
        law, mu, y = self.interface.law, self.tabor, self.undeformed(0.0)[:-1] if near is None else near[:-1]
        acting = law.pressure(state[:-2], mu), law.energy(state[:-2], mu)
        stiffness, last = self._undeformed, np.inf
        for _ in range(MOST_STEPS):
            unbalanced = np.append(self._unbalanced(y, *acting), 0.0)
            dy = -stiffness.solve(unbalanced)[:-1]
            if not np.abs(dy).max() < SLOW * last:
                stiffness = self._held(y, self.traction.tangent(y, *acting, np.zeros(acting[0].size)))
                dy = -stiffness.solve(unbalanced)[:-1]
            y, last = y + self._unturned(y, dy, 1.0) * dy, float(np.abs(dy).max())
            if last < ENOUGH * np.abs(y).max():
                break
        return np.append(y, state[-2])

    def _held(self, y: Array, surface: sparse.csr_array, pivoting: float = 0.01) -> Step:
        """Factorise the tangent at a fixed approach, for that of the surface's forces."""
        cells = self.body.cell_tangents(self.exterior.reduction @ y)
        apart = np.zeros(y.size), np.eye(1, y.size + 1, y.size)[0]
        return self._elimination.factorise(cells, surface + self.exterior.stiffness, *apart, pivoting=pivoting)

    def _surface_change(self, dx: Array) -> Array:
        return np.append(-self.tabor * (self.surface.vertical @ dx[:-1]) - dx[-1], [dx[-1], 0.0])

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius as deformed (nan without contact), shape (4,)."""
        state = self.surface_state(x)
        gap = float(self.interface.operator.axis_row @ state[:-2])
        radius = self._deformed(x, self.interface.contact_radius(state))
        return np.array([float(x[-1]), self.load(x), gap, radius])

    def _deformed(self, x: Array, radius: float) -> float:
        """r_d of the point of the surface at an undeformed radius."""
        if np.isnan(radius):
            return radius
        row, _ = self.interface.operator.at(1.0).continuous(radius)
        return float(row @ self.surface.deformed_radii(x[:-1], self.stretch))

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Sum of the observables by the given weights; one of weight zero need not exist."""
        used = weights != 0
        return float(weights[used] @ self.observables(x)[used])

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative by x of the weighted sum of the observables, shape (n + 1,)."""
        by_gap, row = weights[CENTRAL_GAP] * self.interface.operator.axis_row, np.zeros(x.size)
        if weights[LOAD]:
            by_gap = by_gap + weights[LOAD] * self.areas(x) * self.interface.law.slope(self.gaps(x), self.tabor)
            row[:-1] += weights[LOAD] * self.traction.area_gradient(x[:-1], self.pressure(x))
        if weights[CONTACT_RADIUS]:
            by_gap = by_gap + weights[CONTACT_RADIUS] * self._radius_by_gap(x)
            at_edge, _ = self._edge_rows(x)
            row[:-1] += weights[CONTACT_RADIUS] * self.stretch * (self.surface.radial.T @ at_edge)
        row[:-1] -= self.tabor * (self.surface.vertical.T @ by_gap)
        row[-1] += weights[APPROACH] - by_gap.sum()
        return row

    def _edge_rows(self, x: Array) -> tuple[Array, Array]:
        """Rows that interpolate at the contact edge, and their derivatives by its undeformed radius."""
        return self.interface.operator.at(1.0).continuous(self.interface.contact_radius(self.surface_state(x)))

    def _radius_by_gap(self, x: Array) -> Array:
        """Derivative of the deformed contact radius by the gaps, as the edge moves over the surface, (q,)."""
        value, slope = self._edge_rows(x)
        r_d = self.surface.deformed_radii(x[:-1], self.stretch)
        return np.asarray(-value * (slope @ r_d) / (slope @ self.gaps(x)))

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that takes no gap h below a quarter of its value, nor any J below a tenth."""
        fraction = self.interface.longest_step(self.surface_state(x), self._surface_change(dx))
        return self._unturned(x[:-1], dx[:-1], fraction)

    def _unturned(self, y: Array, dy: Array, fraction: float) -> float:
        """Part of a step, a fraction of it at most, that turns no cell inside out."""
        T = self.exterior.reduction
        least = min(LEAST_VOLUME, self.body.least_volume_ratio(T @ y) / 2)
        while self.body.least_volume_ratio(T @ (y + fraction * dy)) < least:
            fraction /= 2
        return fraction

    def size(self, x: Array, dx: Array) -> float:
        """Relative change of the gaps, the approach and the displacements."""
        displacements = float(np.abs(dx[:-1]).max() / (1 + np.abs(x[:-1]).max()))
        return max(displacements, self.interface.size(self.surface_state(x), self._surface_change(dx)))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm, relative to the gaps, of the undeformed body's deflection due to the forces out of balance."""
        dH = -self.tabor * (self.surface.vertical @ self._undeformed.solve(np.append(residual, 0.0))[:-1])
        return self.interface.misfit(self.surface_state(x), np.append(dH, 0.0))

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands on facets too long for the spike of tension; raise GridTooCoarse."""
        self.interface.require_resolution(self.surface_state(x))

    def elastic_energy(self, x: Array) -> float:
        """Elastic energy of body and exterior in R dgamma eps."""
        y = x[:-1]
        outside = y @ (self.exterior.stiffness @ y) / 2
        return self.tabor * (self.body.energy(self.exterior.reduction @ y) + float(outside))

    def energy(self, x: Array) -> float:
        """Elastic and surface energy in R dgamma eps, the latter int Phi(H) dA; nan unless conservative.

        Its gradient by y is mu times the residual and its derivative by the approach along the equilibria is the load.
        """
        if not self.convention.conservative:
            return float("nan")
        return self.elastic_energy(x) + float(self.areas(x) @ self.interface.law.energy(self.gaps(x), self.tabor))
