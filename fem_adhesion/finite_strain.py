"""The contact problem at finite strain: Newton's method on every unknown of a neo-Hookean body at once.

Unknowns x = (y, alpha*): reduced unknowns y with u = T y, see `fem_adhesion.far_field`, and the approach in eps.
Displacements are in mu eps = beta^2/R, so that a point X moves to X + delta u, delta = beta/R = sqrt(mu/rho). The
surface law, of pressure P and energy Phi, acts on the deformed surface: at its height and on its area. With z the
height of the undeformed surface in beta^2/R and r_d = r + delta u_r, the work it does in a displacement v is

    -int [P(H) v_z dA + c Phi(H)/mu d(dA)],    H = -alpha* + mu (z - u_z),    dA = 2 pi r_d dr_d,

d(dA) the change of the horizontal area by delta v_r. The vertical force P per horizontal area is that of a pairwise
attraction summed over the matter beneath: a vertical force -d sigma/dh on unit volume, in all sigma on a column.
What the column does sideways depends on its own elasticity, since its stress falls to zero towards the surface: held
sideways by the body, it is under a surface stress c Phi, c = nu/(1 - nu). That is the second term; c = 1, an
incompressible column, makes the whole traction a pressure, normal to the deformed surface. Its effect is of the first
order in delta, as is that of the finite strains. The default c = 0 is the vertical traction of the linear body; it has
no energy and its tangent is not symmetric, both by terms of the order of delta. c = 1 has the energy int Phi(H) dA.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fem_adhesion.far_field import Exterior
from fem_adhesion.finite_strain_bodies import Body
from fem_adhesion.finite_strain_surface import ContactSurface, contact_surface, rigid_operator, scaled
from halfspace.compliance import Array
from halfspace.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.lennard_jones import LENNARD_JONES, SurfaceLaw
from halfspace.profiles import Paraboloid, Profile

PARABOLOID = Paraboloid()

LEAST_VOLUME = 0.1
"""J below which no step may take a cell in one go, unless it was there already: before it is turned inside out."""


@dataclass(frozen=True)
class FiniteStrainProblem:
    """Equilibrium of a surface law with a body at finite strain; a `halfspace.newton.Equilibrium`.

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
    surface_stress : float
        c, surface stress over the attraction's energy.
    """

    body: Body
    exterior: Exterior
    surface: ContactSurface
    interface: ContactProblem
    surface_stress: float

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""
        return self.interface.tabor

    @property
    def profile(self) -> Profile:
        """Of the undeformed surface."""
        return self.interface.profile

    @property
    def stretch(self) -> float:
        """Stretch parameter delta = beta/R, zero for the linear body."""
        return self.body.stretch

    def stretched(self, stretch: float) -> FiniteStrainProblem:
        """Return the same problem at another delta, the undeformed shape unchanged."""
        return replace(self, body=self.body.stretched(stretch))

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""
        return np.append(np.zeros(self.exterior.reduction.shape[1]), approach)

    def state_from(self, approach: float, displacement: Array) -> Array:
        """State from all N displacements, in beta^2/R, such as `CondensedBody.displacement` of a pressure P."""
        T = self.exterior.reduction
        y = splu(sparse.csc_array(T.T @ T)).solve(T.T @ self.body.lifted(displacement))
        return np.append(y, approach)

    def displacement(self, x: Array) -> Array:
        """All N displacements of a state, in beta^2/R."""
        return np.asarray((self.exterior.reduction @ x[:-1])[: self.body.space.unknowns])

    def gaps(self, x: Array) -> Array:
        """H at the surface's points, (q,)."""
        return np.asarray(self.interface.undeformed(x[-1])[:-2] - self.tabor * (self.surface.vertical @ x[:-1]))

    def areas(self, x: Array) -> Array:
        """Weights of the deformed horizontal area 2 pi r_d dr_d, (q,), in beta^2."""
        return self.surface.areas(x[:-1], self.stretch)

    def pressure(self, x: Array) -> Array:
        """P at the surface's points, (q,)."""
        return self.interface.law.pressure(self.gaps(x), self.tabor)

    def load(self, x: Array) -> float:
        """W in R dgamma: the pressure on the deformed horizontal area, positive in compression."""
        return float(self.areas(x) @ self.pressure(x))

    def residual(self, x: Array) -> Array:
        """Forces on the reduced unknowns that are out of balance, in R dgamma, shape (n,)."""
        T, S, y = self.exterior.reduction, self.exterior.stiffness, x[:-1]
        P, Phi = self.pressure(x), self.interface.law.energy(self.gaps(x), self.tabor)
        return np.asarray(T.T @ self.body.forces(T @ y) + S @ y + self._forces(y, P, Phi))

    def _forces(self, y: Array, P: Array, Phi: Array) -> Array:
        """Less the forces of the surface law on the reduced unknowns, (n,): upwards where the pressure is downwards."""
        s, delta = self.surface, self.stretch
        spreading = s.area_gradient(y, delta, self.surface_stress / self.tabor * Phi)
        return np.asarray(s.vertical.T @ (P * s.areas(y, delta)) + spreading)

    def jacobian(self, x: Array) -> sparse.csc_array:
        """Derivative of the residual, (n, n + 1)."""
        return sparse.csc_array(sparse.hstack(self._derivatives(x)))

    def _derivatives(self, x: Array) -> tuple[sparse.csc_array, sparse.csc_array]:
        """Derivatives of the residual by y, (n, n), and by the approach, (n, 1)."""
        T, y = self.exterior.reduction, x[:-1]
        body = T.T @ self.body.tangent(T @ y) @ T + self.exterior.stiffness
        # As the approach grows by one, H falls by one: P by its slope, and Phi rises by P.
        slope = self.interface.law.slope(self.gaps(x), self.tabor)
        by_approach = self._forces(y, -slope, self.pressure(x))
        return sparse.csc_array(body + self._contact_tangent(x, slope)), sparse.csc_array(by_approach[:, None])

    def _contact_tangent(self, x: Array, slope: Array) -> sparse.csr_array:
        """Derivative of `_forces` by y, (n, n), for the law's slope dP/dH."""
        s, mu, delta, c, y = self.surface, self.tabor, self.stretch, self.surface_stress, x[:-1]
        P, Phi, rates = self.pressure(x), self.interface.law.energy(self.gaps(x), self.tabor), s.area_rates(y, delta)
        tangent = s.vertical.T @ (scaled(-mu * slope * s.areas(y, delta), s.vertical) + scaled(P, rates))
        if c:
            tangent = tangent + c * (rates.T @ scaled(P, s.vertical)) + s.area_curvature(delta, c / mu * Phi)
        return sparse.csr_array(tangent)

    def bordered_solver(self, x: Array, row: Array) -> Callable[[Array], Array]:
        """Factorise the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        border = [sparse.csc_array(row[None, :-1]), sparse.csc_array(row[None, -1:])]
        J = sparse.csc_array(sparse.block_array([[*self._derivatives(x)], border], format="csc"))
        try:
            # A symmetric pattern but for the border, indefinite on the unstable branch: ordered as such, yet pivoted.
            factors = splu(J, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True})
        except RuntimeError as error:  # SuperLU's way of saying so
            raise np.linalg.LinAlgError("the bordered Jacobian is singular") from error
        return lambda rhs: np.asarray(factors.solve(rhs))

    @cached_property
    def _factors(self) -> Any:
        """Factors of the undeformed body's tangent, positive definite or a saddle point; for norms."""
        T = self.exterior.reduction
        K = T.T @ self.body.tangent(np.zeros(self.body.unknowns)) @ T + self.exterior.stiffness
        options = {"SymmetricMode": True}
        return splu(sparse.csc_array(K), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def _surface_state(self, x: Array) -> Array:
        """State as the interface knows it: H, alpha*, and the radii's fixed scale 1."""
        return np.append(self.gaps(x), [x[-1], 1.0])

    def _surface_change(self, dx: Array) -> Array:
        return np.append(-self.tabor * (self.surface.vertical @ dx[:-1]) - dx[-1], [dx[-1], 0.0])

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius as deformed (nan without contact), shape (4,)."""
        state = self._surface_state(x)
        gap = float(self.interface.operator.axis_row @ state[:-2])
        radius = self._deformed(x, self.interface.contact_radius(state))
        return np.array([float(x[-1]), self.load(x), gap, radius])

    def _deformed(self, x: Array, radius: float) -> float:
        """r_d of the point of the surface at an undeformed radius."""
        if np.isnan(radius):
            return radius
        row, _ = self.interface.operator.at(1.0).interpolation(radius)
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
            row[:-1] += weights[LOAD] * self.surface.area_gradient(x[:-1], self.stretch, self.pressure(x))
        if weights[CONTACT_RADIUS]:
            by_gap = by_gap + weights[CONTACT_RADIUS] * self._radius_by_gap(x)
            at_edge, _ = self._edge_rows(x)
            row[:-1] += weights[CONTACT_RADIUS] * self.stretch * (self.surface.radial.T @ at_edge)
        row[:-1] -= self.tabor * (self.surface.vertical.T @ by_gap)
        row[-1] += weights[APPROACH] - by_gap.sum()
        return row

    def _edge_rows(self, x: Array) -> tuple[Array, Array]:
        """Rows that interpolate at the contact edge, and their derivatives by its undeformed radius."""
        return self.interface.operator.at(1.0).interpolation(self.interface.contact_radius(self._surface_state(x)))

    def _radius_by_gap(self, x: Array) -> Array:
        """Derivative of the deformed contact radius by the gaps, as the edge moves over the surface, (q,)."""
        value, slope = self._edge_rows(x)
        r_d = self.surface.deformed_radii(x[:-1], self.stretch)
        return np.asarray(-value * (slope @ r_d) / (slope @ self.gaps(x)))

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that takes no gap h below a quarter of its value, nor any J below a tenth."""
        fraction = self.interface.longest_step(self._surface_state(x), self._surface_change(dx))
        T = self.exterior.reduction
        least = min(LEAST_VOLUME, self.body.least_volume_ratio(T @ x[:-1]) / 2)
        while self.body.least_volume_ratio(T @ (x + fraction * dx)[:-1]) < least:
            fraction /= 2
        return fraction

    def size(self, x: Array, dx: Array) -> float:
        """Relative change of the gaps, the approach and the displacements."""
        displacements = float(np.abs(dx[:-1]).max() / (1 + np.abs(x[:-1]).max()))
        return max(displacements, self.interface.size(self._surface_state(x), self._surface_change(dx)))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm, relative to the gaps, of the undeformed body's deflection due to the forces out of balance."""
        dH = -self.tabor * (self.surface.vertical @ self._factors.solve(residual))
        return self.interface.misfit(self._surface_state(x), np.append(dH, 0.0))

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands on facets too long for the spike of tension; raise GridTooCoarse."""
        self.interface.require_resolution(self._surface_state(x))

    def elastic_energy(self, x: Array) -> float:
        """Elastic energy of body and exterior in R dgamma eps."""
        y = x[:-1]
        outside = y @ (self.exterior.stiffness @ y) / 2
        return self.tabor * (self.body.energy(self.exterior.reduction @ y) + float(outside))

    def energy(self, x: Array) -> float:
        """Elastic and surface energy in R dgamma eps, the latter int Phi(H) 2 pi r_d dr_d.

        If c = 1 its gradient by y is mu times the residual and its derivative by the approach along the equilibria is
        the load; else neither.
        """
        return self.elastic_energy(x) + float(self.areas(x) @ self.interface.law.energy(self.gaps(x), self.tabor))


def finite_strain_problem(
    body: Body,
    exterior: Exterior,
    tabor: float,
    *,
    profile: Profile = PARABOLOID,
    surface_stress: float = 0.0,
    points: int | None = None,
    law: SurfaceLaw = LENNARD_JONES,
) -> FiniteStrainProblem:
    """Put a body under a rigid flat wall that attracts it.

    Parameters
    ----------
    body : Body
        From `finite_strain_bodies.displacement_body` or `finite_strain_mixed.mixed_body`.
    exterior : Exterior
        Of all displacement unknowns of its space, interior ones included: see `far_field.with_interiors`.
    tabor, law
        As in `halfspace.contact.ContactProblem`.
    profile : Profile
        Height of the body's undeformed surface over its pole, carried along by its points. That of a block is a
        perturbation of its flat surface, as in the linear body.
    surface_stress : float
        c, surface stress over the attraction's energy: 0 for a vertical traction, 1 for one normal to the deformed
        surface, poisson/(1 - poisson) for that of a thin attracted layer.
    points : int, optional
        Gauss points per contact facet; p + 2 unless given.

    Raises
    ------
    ValueError
        If the exterior holds the body by a spring that has to be taken off again (`free`).
    """
    if exterior.rigid_compliance:
        raise ValueError("a far field with a rigid_compliance is known to `condense` only; use point_load or clamped")
    whole = _with_pressures(exterior, body)
    space = body.space
    surface = contact_surface(space, whole, space.degree + 2 if points is None else points)
    rigid = rigid_operator(space, surface)
    return FiniteStrainProblem(body, whole, surface, ContactProblem(rigid, tabor, law, profile), surface_stress)


def _with_pressures(exterior: Exterior, body: Body) -> Exterior:
    """Let the unknowns beyond the displacements be reduced unknowns themselves."""
    more = body.unknowns - body.space.unknowns
    T = sparse.block_diag([exterior.reduction, sparse.eye_array(more)])
    S = sparse.block_diag([exterior.stiffness, sparse.csc_array((more, more))])
    return Exterior(sparse.csc_array(T), sparse.csc_array(S))
