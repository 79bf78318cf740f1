"""The contact problem: an elastic operator under a rigid paraboloid that acts through a surface law.

Unknowns x = (H_1 ... H_q, alpha*, s): nodal gaps in eps, approach in eps, and the scale s of the grid. Equations
[G97] (2.8), and one for the scale, which is either fixed or follows the contact edge:

    H + alpha* - mu (s u)^2/2 - mu s C P(H) = 0,        s = 1   or   H(u = 1) = H_edge.

The elastic operator is homogeneous, so a grid that breathes with the contact costs one unknown and keeps
the spike of tension at its edge on the same nodes all along the path.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.linalg.lapack import dgetrf, dgetrs, dsytrf
from scipy.optimize import brentq

from halfspace.compliance import ElasticOperator
from halfspace.lennard_jones import LENNARD_JONES, SurfaceLaw

Array = NDArray[np.float64]

APPROACH, LOAD, CENTRAL_GAP, CONTACT_RADIUS = range(4)  # the observables, in this order


def spike_width(tabor: float) -> float:
    """Width in beta over which the tension at a contact edge varies: mu^-2, or about mu^-1/2 when nearly rigid."""
    return float(min(tabor**-2, 0.7 * tabor**-0.5))


def widest_interval(nodes: int) -> float:
    """Widest interval between k nodes of a cell that carries the spike, in its widths: found by trial."""
    k = nodes - 1
    return max(0.1, min(0.1 * k, 0.021 * k**2))


class GridTooCoarse(ValueError):
    """The grid cannot carry the spike of tension at the contact edge; the message says where and by how much."""


@dataclass(frozen=True)
class ContactProblem:
    """Equilibrium of a surface law with an elastic operator.

    Parameters
    ----------
    operator : ElasticOperator
        Any body's surface compliance, from any discretisation.
    tabor : float
        Tabor parameter mu.
    law : SurfaceLaw
        Pressure against gap.
    follows_contact : bool
        If true, the operator's unit of length is the contact radius, which joins the unknowns.
    """

    operator: ElasticOperator
    tabor: float
    law: SurfaceLaw = LENNARD_JONES
    follows_contact: bool = False

    def undeformed(self, approach: float, scale: float = 1.0) -> Array:
        """State with the gaps of the undeformed surfaces, H = -alpha* + mu u^2/2, as a start for Newton's method."""
        gap = -approach + self.tabor * (scale * self.operator.radii) ** 2 / 2
        return np.concatenate([gap, [approach, scale]])

    def residual(self, x: Array) -> Array:
        """Left-hand sides of the equilibrium (in eps) and scale equations, shape (q + 1,)."""
        H, alpha, s = x[:-2], x[-2], x[-1]
        mu, u = self.tabor, self.operator.radii
        w = mu * s * (self.operator.compliance @ self.law.pressure(H, mu))
        return np.append(H + alpha - mu * (s * u) ** 2 / 2 - w, self._scale_equation(H, s))

    def _scale_equation(self, H: Array, s: float) -> float:
        return float(self.operator.unit_row @ H - self.law.edge_gap) if self.follows_contact else s - 1

    def jacobian(self, x: Array) -> Array:
        """Derivative of the residual, shape (q + 1, q + 2)."""
        H, s = x[:-2], x[-1]
        mu, u, C = self.tabor, self.operator.radii, self.operator.compliance
        J = np.empty((x.size - 1, x.size))
        J[:-1, :-2] = C * (-mu * s * self.law.slope(H, mu))
        J[:-1, :-2].flat[:: x.size - 1] += 1
        J[:-1, -2] = 1
        J[:-1, -1] = -mu * s * u**2 - mu * (C @ self.law.pressure(H, mu))
        J[-1] = 0
        if self.follows_contact:
            J[-1, :-2] = self.operator.unit_row
        else:
            J[-1, -1] = 1
        return J

    def bordered_solver(self, x: Array, row: Array) -> Callable[[Array], Array]:
        """Factorise the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        lu, pivots, info = dgetrf(np.vstack([self.jacobian(x), row]), overwrite_a=True)
        if info > 0:
            raise np.linalg.LinAlgError("the bordered Jacobian is singular")
        return lambda rhs: np.asarray(dgetrs(lu, pivots, rhs)[0])

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius (nan without contact), shape (4,)."""
        return np.array([self._observable(x, index) for index in range(4)])

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Sum of the observables by the given weights; one of weight zero is not computed and need not exist."""
        return float(sum(weights[index] * self._observable(x, index) for index in range(4) if weights[index]))

    def _observable(self, x: Array, index: int) -> float:
        if index == APPROACH:
            return float(x[-2])
        if index == LOAD:
            return self.load(x)
        if index == CENTRAL_GAP:
            return float(self.operator.axis_row @ x[:-2])
        return self.contact_radius(x)

    def load(self, x: Array) -> float:
        """W in R dgamma, positive in compression."""
        return float(x[-1] ** 2 * (self.operator.weights @ self.pressure(x)))

    def pressure(self, x: Array) -> Array:
        """Nodal pressures P, shape (q,)."""
        return self.law.pressure(x[:-2], self.tabor)

    def radii(self, x: Array) -> Array:
        """Nodal radii in beta, shape (q,)."""
        return np.asarray(x[-1] * self.operator.radii)

    def contact_radius(self, x: Array) -> float:
        """Largest radius in beta at which the gap is 3^(1/6) eps, or nan where the surfaces are further apart."""
        H, edge = x[:-2], self.law.edge_gap
        inside = np.flatnonzero(edge > H)
        if self.follows_contact:
            return float(x[-1])
        if inside.size == 0 and self.operator.axis_row @ H > edge:
            return float("nan")
        radii = np.append(self.operator.radii, self.operator.extent)
        below, above = (radii[inside[-1]], radii[inside[-1] + 1]) if inside.size else (0.0, radii[0])
        return float(brentq(lambda r: float(self.operator.interpolation(r)[0] @ H - edge), below, above, xtol=1e-14))

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative by x of the weighted sum of the observables, shape (q + 2,)."""
        row = np.zeros(x.size)
        row[-2] = weights[APPROACH]
        if weights[LOAD]:
            H, s = x[:-2], x[-1]
            row[:-2] += weights[LOAD] * s**2 * self.operator.weights * self.law.slope(H, self.tabor)
            row[-1] += weights[LOAD] * 2 * self.load(x) / s
        if weights[CENTRAL_GAP]:
            row[:-2] += weights[CENTRAL_GAP] * self.operator.axis_row
        if weights[CONTACT_RADIUS]:
            row += weights[CONTACT_RADIUS] * self._radius_gradient(x)
        return row

    def _radius_gradient(self, x: Array) -> Array:
        if self.follows_contact:
            return np.asarray(np.eye(1, x.size, x.size - 1)[0])
        value, slope = self.operator.interpolation(self.contact_radius(x))
        return np.append(-value / (slope @ x[:-2]), [0.0, 0.0])

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands where the grid is too coarse for the spike of tension there.

        Linear interpolation wants ten intervals in the spike's width, polynomials fewer (`widest_interval`). A coarser
        grid still converges, to a pull-off force that is too large ([G97] 4b).

        Raises
        ------
        GridTooCoarse
            With the spacing, its place and the limit.
        """
        radius, scale = self.contact_radius(x), x[-1]
        if np.isnan(radius):
            return
        spacing = scale * self.operator.spacing(radius / scale)
        limit = spike_width(self.tabor) * widest_interval(self.operator.cell_nodes.shape[1])
        if spacing > limit * (1 + 1e-9):
            raise GridTooCoarse(
                f"grid spacing {spacing:.3g} beta at the contact edge, radius {radius:.3g} beta, "
                f"exceeds {limit:.3g} beta for tabor {self.tabor:g}; refine the grid there"
            )

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that takes no gap h, nor the scale, below a quarter of its value."""
        positive = np.append(x[:-2] + 1, x[-1])
        change = np.append(dx[:-2], dx[-1])
        shrink = -change / positive
        return float(min(1.0, 0.75 / max(shrink.max(), 0.75)))

    def size(self, x: Array, dx: Array) -> float:
        """Relative size of the change dx of the state x."""
        return float(np.max(np.abs(dx) / np.concatenate([x[:-2] + 1, [1 + abs(x[-2]), x[-1]]])))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm of the residual relative to the gaps, lest the far field of a scaled grid drown the contact."""
        return float(np.linalg.norm(residual / np.append(x[:-2] + 1, 1)))

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps, elastic and surface; its derivative by the approach is the load.

        Beyond the grid the surfaces are taken as undeformed: the energy's tail falls only as U^-2.
        """
        H, alpha, s = x[:-2], x[-2], x[-1]
        mu, u = self.tabor, self.operator.radii * s
        deflection = H + alpha - mu * u**2 / 2
        density = self.law.energy(H, mu) + self.pressure(x) * deflection / 2
        return float(s**2 * (self.operator.weights @ density)) + self._energy_beyond(alpha, s * self.operator.extent)

    def _energy_beyond(self, alpha: float, U: float) -> float:
        h, (n, m) = 1 - alpha + self.tabor * U**2 / 2, (self.law.attraction, self.law.repulsion)
        tail = h ** -(m - 2) / ((m - 1) * (m - 2)) - h ** -(n - 2) / ((n - 1) * (n - 2))
        return float(2 * np.pi * self.law.amplitude * tail)

    def negative_directions(self, x: Array, half: Array | None = None) -> int:
        """Number of directions in which the energy falls at fixed approach; 0 means stable under fixed grips.

        The Hessian A^-1 - mu w P'(H), A = C/w, has the inertia of I - mu L^T P'(H) L, where L L^T is the compliance
        made symmetric by the square roots of the weights.
        """
        L = self.compliance_root() if half is None else half
        hessian = np.eye(L.shape[1]) - L.T @ (L * (self.tabor * x[-1] * self.law.slope(x[:-2], self.tabor))[:, None])
        return count_negative(hessian)

    def compliance_root(self) -> Array:
        """L, (q, m), with L L^T the symmetric part of w^(1/2) C w^(-1/2).

        The rank m falls short of q where the nodes outnumber the freedoms of the surface.
        """
        root = np.sqrt(self.operator.weights)
        balanced = self.operator.compliance * (root[:, None] / root)
        values, vectors = eigh((balanced + balanced.T) / 2)
        kept = values > 1e-13 * values[-1]
        return np.asarray(vectors[:, kept] * np.sqrt(values[kept]))


def count_negative(matrix: Array) -> int:
    """Count the negative eigenvalues of a symmetric matrix by Sylvester's law of inertia (Bunch-Kaufman)."""
    ldu, pivots, _ = dsytrf(matrix, lower=1)
    single = pivots > 0
    return int(np.sum(np.diag(ldu)[single] < 0) + np.sum(~single) // 2)  # a 2 x 2 block has one of each sign
