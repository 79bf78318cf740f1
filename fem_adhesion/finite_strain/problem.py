"""The contact problem at finite strain: Newton's method on every unknown of a neo-Hookean body at once.

Unknowns x = (y, alpha*): reduced unknowns y with u = T y, see `fem_adhesion.elasticity.exterior`, and the approach in
eps. Displacements are in mu eps = beta^2/R, so that a point X moves to X + delta u, delta = beta/R = sqrt(mu/rho). The
surface law, of pressure P and energy Phi, acts on the deformed surface: at its height and on its area. With z the
height of the undeformed surface in beta^2/R and r_d = r + delta u_r, the work it does in a displacement v is

    -int [P(H) v_z dA + c Phi(H)/mu d(dA)],    H = -alpha* + mu (z - u_z),    dA = 2 pi r_d dr_d,

d(dA) the change of the horizontal area by delta v_r. The first term is the force, the second that of a surface stress
c Phi; `fem_adhesion.finite_strain.traction` says what is known of c and of the area, and which are the default. With
c = 0 it is a vertical traction per deformed area.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_adhesion.elasticity.condensation import Dissection
from fem_adhesion.elasticity.exterior import Exterior, FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.body import Body, material_body
from fem_adhesion.finite_strain.held import HeldBody
from fem_adhesion.finite_strain.settings import USUAL, Settings
from fem_adhesion.finite_strain.traction import ContactSurface, Convention, Traction, columns, contact_surface
from halfspace.equilibrium.contact import CONTACT_RADIUS, LOAD, ContactProblem, Solver
from halfspace.equilibrium.newton import NEWTON
from halfspace.errors import IllPosed, InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.profiles import PARABOLOID, Surface
from halfspace.values import Array, Valued


@dataclass(frozen=True, eq=False, repr=False)
class FiniteStrainProblem(Valued):
    """Equilibrium of a surface law with a body at finite strain; a `halfspace.equilibrium.newton.Traceable`.

    The held body has n reduced unknowns; on the surface acts the law. The interface is that law and what can be said of
    a contact from the gaps alone, on a rigid body's operator; the convention says what the law's traction is counted
    per, and its direction.
    """

    held: HeldBody
    surface: ContactSurface
    interface: ContactProblem
    convention: Convention

    @property
    def body(self) -> Body:
        """The body as if it were not held."""
        return self.held.body

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""
        return self.interface.tabor

    @property
    def stretch(self) -> float:
        """Stretch parameter delta = beta/R, zero for the linear body."""
        return self.body.stretch

    @property
    def traction(self) -> Traction:
        """Forces of the surface law."""
        return Traction(self.surface, self.tabor, self.stretch, self.convention, self._columns)

    @cached_property
    def _columns(self) -> Array:
        """Of the surface's undeformed points over the equator's plane; a surface that does not end has none."""
        profile, radii = self.interface.profile, self.surface.points.radii
        if not np.isfinite(profile.end):
            return np.ones(radii.size)
        return columns(self.tabor * (profile.height(np.array(profile.end)) - profile.height(radii)))

    def stretched(self, stretch: float) -> FiniteStrainProblem:
        """Return the same problem at another delta, the undeformed shape unchanged."""
        return replace(self, held=replace(self.held, body=replace(self.body, stretch=stretch)))

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""
        return np.append(np.zeros(self.held.size), approach)

    def surface_unknowns(self, x: Array) -> Array:
        """Those that move the surface, s, (m,)."""
        return x[self.surface.unknowns]

    def gaps(self, x: Array) -> Array:
        """H at the surface's points, (q,)."""
        deflected = self.tabor * (self.surface.vertical @ self.surface_unknowns(x))
        return np.asarray(self._undeformed - x[-1] - deflected)

    @cached_property
    def _undeformed(self) -> Array:
        """Gaps over the undeformed surface that it touches, mu z, (q,)."""
        return self.interface.undeformed(0.0)[:-2]

    def areas(self, x: Array) -> Array:
        """Weights of the horizontal area that the law's traction acts on, (q,), in beta^2."""
        return self.traction.areas(self.surface_unknowns(x))

    def pressure(self, x: Array) -> Array:
        """P at the surface's points, (q,)."""
        return self.interface.law.pressure(self.gaps(x), self.tabor)

    def load(self, x: Array) -> float:
        """W in R dgamma: the pressure on the deformed horizontal area, positive in compression."""
        return float(self.areas(x) @ self.pressure(x))

    def residual(self, x: Array) -> Array:
        """Forces on the reduced unknowns that are out of balance, in R dgamma, shape (n,)."""
        P, Phi, _ = self._law(x)
        return self._unbalanced(x[:-1], P, Phi)

    def _unbalanced(self, y: Array, P: Array, Phi: Array) -> Array:
        """Forces of body, exterior, and a pressure and energy at the surface's points, (n,)."""
        forces = self.held.forces(y)
        forces[self.surface.unknowns] += self.traction.forces(self.surface_unknowns(y), P, Phi)
        return forces

    def _law(self, x: Array) -> tuple[Array, Array, Array]:
        """P, Phi and dP/dH at the surface's points."""
        gaps, mu, law = self.gaps(x), self.tabor, self.interface.law
        return law.pressure(gaps, mu), law.energy(gaps, mu), law.slope(gaps, mu)

    def _surface_tangent(self, x: Array) -> Array:
        """Derivative of the surface law's forces by the surface's unknowns and the approach, (m, m + 1).

        As the approach grows H falls by as much, P by its slope, and Phi rises by P.
        """
        (P, Phi, slope), s = self._law(x), self.surface_unknowns(x)
        return np.column_stack([self.traction.tangent(s, P, Phi, slope), self.traction.forces(s, -slope, P)])

    def along(self, x: Array, v: Array) -> Array:
        """Derivative of the residual along a direction of the state, (n,)."""
        return self.held.tangent_product(x[:-1], self._surface_tangent(x))(v)

    def bordered_solver(self, x: Array, row: Array) -> Solver:
        """Solve the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        ends = np.append(self.surface_unknowns(row), row[-1])
        return self.held.solver(x[:-1], self._surface_tangent(x), ends)

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the body moves on by itself at fixed approach; 0 means stable.

        Counted in the body's tangent as it is condensed to the surface, but for one of each pressure unknown, and what
        the law makes of the surface's own. Where there is an energy that is the number of directions in which it falls
        (Haynsworth: inertia is additive in Schur complements). The tangent of the vertical traction per deformed area
        is not symmetric, but is so up to terms of the order of delta; then the number changes where the determinant
        does its sign, that is at the folds.
        """
        tangent = self.held.tangent(x[:-1])
        whole = tangent.stiffness + self._surface_tangent(x)[:, :-1]
        negative = tangent.negative_directions() + int(np.sum(np.linalg.eigvals(whole).real < 0))
        return negative - (self.body.unknowns - self.body.space.unknowns)

    def surface_state(self, x: Array) -> Array:
        """State as the interface knows it: H, alpha*, and the radii's fixed scale 1."""
        return np.append(self.gaps(x), [x[-1], 1.0])

    def rough(self, radii: Array, approach: float) -> Array:  # noqa: ARG002 (nowhere any)
        """Nothing: where the contact spreads over the flank the gaps vanish, and the deflection is as steep."""
        return np.zeros_like(radii)

    def state_from_surface(self, state: Array) -> Array:
        """State of the body under the pressure that the gaps of an interface's state make, as a start.

        From the undeformed body, by the body's tangent alone: with that of the forces that follow the surface, too,
        first steps may be ten times as long. The first step gives the linear body.
        """
        law, mu, how = self.interface.law, self.tabor, self.held.settings
        P, Phi = law.pressure(state[:-2], mu), law.energy(state[:-2], mu)
        y, m = np.zeros(self.held.size), self.surface.unknowns.size
        for _ in range(how.start_steps):
            solve = self.held.solver(y, np.zeros((m, m + 1)), np.eye(1, m + 1, m)[0])
            dy = -solve(np.append(self._unbalanced(y, P, Phi), 0.0), NEWTON.rough)[:-1]
            y = y + self._unturned(y, dy, 1.0) * dy
            if np.abs(dy).max() < how.start_accuracy * np.abs(y).max():
                break
        return np.append(y, state[-2])

    def _surface_change(self, dx: Array) -> Array:
        deflected = self.tabor * (self.surface.vertical @ self.surface_unknowns(dx))
        return np.append(-deflected - dx[-1], [dx[-1], 0.0])

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius as deformed (nan without contact), shape (4,)."""
        state = self.surface_state(x)
        radius = self.interface.contact_radius(state)
        if not np.isnan(radius):
            radius = float(self._edge_rows(state)[0] @ self._deformed_radii(x))
        return np.array([float(x[-1]), self.load(x), self.interface.central_gap(state), radius])

    def _deformed_radii(self, x: Array) -> Array:
        return self.surface.deformed_radii(self.surface_unknowns(x), self.stretch)

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Sum of the observables by the given weights; one of weight zero need not exist."""
        used = weights != 0
        return float(weights[used] @ self.observables(x)[used])

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative by x of the weighted sum of the observables, shape (n + 1,)."""
        s, state, row = self.surface_unknowns(x), self.surface_state(x), np.zeros(x.size)
        undeformed, by_unknown = weights * (np.arange(4) != LOAD), np.zeros(s.size)
        if weights[CONTACT_RADIUS]:
            value, slope = self._edge_rows(state)
            undeformed[CONTACT_RADIUS] *= slope @ self._deformed_radii(x)
            by_unknown += weights[CONTACT_RADIUS] * self.stretch * (value @ self.surface.radial)
        by_state = self.interface.gradient(state, undeformed)
        by_gap, by_approach = by_state[:-2].copy(), by_state[-2]
        if weights[LOAD]:
            by_gap += weights[LOAD] * self.areas(x) * self.interface.law.slope(state[:-2], self.tabor)
            by_unknown += weights[LOAD] * self.traction.area_gradient(s, self.pressure(x))
        row[self.surface.unknowns] = by_unknown - self.tabor * (by_gap @ self.surface.vertical)
        row[-1] = by_approach - by_gap.sum()
        return row

    def rates(self, x: Array, v: Array) -> Array:
        """Derivatives of the observables along a direction, 0 of a contact radius that there is not, shape (4,)."""
        exists = np.isfinite(self.observables(x))
        return np.array([self.gradient(x, row) @ v if e else 0.0 for row, e in zip(np.eye(4), exists, strict=True)])

    def _edge_rows(self, state: Array) -> tuple[Array, Array]:
        """Rows that interpolate at the contact edge of a surface's state, and their derivatives by its radius."""
        return self.interface.operator.at(1.0).continuous(self.interface.contact_radius(state))

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that takes no gap h below a quarter of its value, nor any J below a tenth."""
        fraction = self.interface.longest_step(self.surface_state(x), self._surface_change(dx))
        return self._unturned(x[:-1], dx[:-1], fraction)

    def _unturned(self, y: Array, dy: Array, fraction: float) -> float:
        """Part of a step, a fraction of it at most, that turns no cell inside out."""
        ratio = self.body.least_volume_ratio
        least = min(self.held.settings.least_volume, ratio(self.held.unknowns(y)) / 2)
        while ratio(self.held.unknowns(y + fraction * dy)) < least:
            fraction /= 2
        return fraction

    def size(self, x: Array, dx: Array) -> float:
        """Relative change of the gaps, the approach and the displacements."""
        displacements = float(np.abs(dx[:-1]).max() / (1 + np.abs(x[:-1]).max()))
        return max(displacements, self.interface.size(self.surface_state(x), self._surface_change(dx)))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm, relative to the gaps, of the body's deflection due to the forces out of balance."""
        dH = -self.tabor * (self.surface.vertical @ self.held.near.surface_change(residual))
        return self.interface.misfit(self.surface_state(x), np.append(dH, 0.0))

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands on facets too long for the spike of tension, or that is a needle.

        GridTooCoarse and IllPosed tell what there is, and the limit.
        """
        self.interface.require_resolution(self.surface_state(x))
        most, drawn = self.held.settings.most_drawn, np.max(self._deformed_radii(x) / self.surface.points.radii)
        if drawn > most:
            raise IllPosed(
                f"the surface is drawn out {drawn:.3g} times at approach {x[-1]:.6g} eps, load {self.load(x):.6g} "
                f"R dgamma, limit {most:g}; take a larger radius_ratio"
            )

    def energy(self, x: Array) -> float:
        """Elastic and surface energy in R dgamma eps, the latter int Phi(H) dA; nan unless conservative.

        Its gradient by y is mu times the residual and its derivative by the approach along the equilibria is the load.
        """
        if not self.convention.conservative:
            return float("nan")
        scales, mu = self.interface.scales, self.tabor
        density = scales.law.energy(self.gaps(x), mu)
        if scales.far_energy:
            density -= scales.law.energy(mu * scales.profile.height(self.surface.points.radii), mu)
        return mu * self.held.energy(x[:-1]) + float(self.areas(x) @ density)


# From its parts


def finite_strain_problem(
    body: Body,
    exterior: Exterior,
    tabor: float,
    *,
    profile: Surface = PARABOLOID,
    convention: Convention,
    points: int | None = None,
    law: Law = LENNARD_JONES,
    settings: Settings = USUAL,
) -> FiniteStrainProblem:
    """Put a body under a rigid flat wall that attracts it.

    The body is a `fem_adhesion.finite_strain.body.material_body`, the exterior one of
    `fem_adhesion.elasticity.exterior` on its space; tabor and law are as in
    `halfspace.equilibrium.contact.ContactProblem`. The profile is the height of the body's undeformed surface over its
    pole, carried along by its points; that of a block is a perturbation of its flat surface, as in the linear body. The
    convention says what the law's traction is counted per, and its direction. Of Gauss's points there are p + 2 on each
    contact facet unless given. InputError if the exterior holds the body by a spring that has to be taken off again
    (`free`).
    """
    if exterior.rigid_compliance:
        raise InputError("a far field with a rigid_compliance is known to `condense` only; use point_load or clamped")
    space = body.space
    whole = with_interiors(exterior, space, body.unknowns - space.unknowns)
    surface = contact_surface(space, whole, space.degree + 2 if points is None else points)
    held = HeldBody(body, Dissection(space, body.cell_dofs.T, whole, surface.unknowns), settings)
    interface = ContactProblem(surface.rigid, tabor, law, profile)
    return FiniteStrainProblem(held, surface, interface, convention)


def assemble(
    space: Space, poisson: float, tabor: float, *, far_field: FarField = point_load, points: int | None = None
) -> FiniteStrainProblem:
    """Contact problem of a linear block under a rigid paraboloid, none of its unknowns condensed but in the solver.

    Space, poisson and points are as in `fem_adhesion.elasticity.condensation.condense`, whose problem has the same
    solutions, the rest and the errors as of `finite_strain_problem`; the far field is `point_load` or `clamped`.
    InputError, too, if poisson is out of range.
    """
    body, exterior = material_body(space, poisson, 0.0), far_field(space, poisson)
    return finite_strain_problem(body, exterior, tabor, convention=Convention(0.0, 0.0), points=points)
