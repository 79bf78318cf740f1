"""A sphere of a scene on meshes fine for some range of contact radii: linear and at finite strain, on the same mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from skfem import ElementQuadP
from skfem.quadrature import get_quadrature

from fem_adhesion import bodies, sized
from fem_adhesion.condensed import CondensedBody, condense
from fem_adhesion.elasticity import Space
from fem_adhesion.far_field import with_interiors
from fem_adhesion.finite_strain import FiniteStrainProblem
from fem_adhesion.finite_strain_assembly import finite_strain_problem, material_body
from fem_adhesion.finite_strain_events import undeformed_radius
from fem_adhesion.finite_strain_traction import convention_of
from fem_adhesion.incompressible import stiffness_for
from fem_adhesion.scene import Scene
from halfspace import grid, newton
from halfspace.compliance import Array
from halfspace.contact import CENTRAL_GAP, CONTACT_RADIUS, ContactProblem
from halfspace.curve import Chart, transfer
from halfspace.newton import Traceable
from halfspace.path import Point, Segment
from halfspace.sized import SizedBody
from halfspace.values import Valued

FARTHEST = 0.98
"""Undeformed radius in R up to which a contact may spread; small slopes end before, see `halfspace.contact.WIDEST`."""


@dataclass(frozen=True, eq=False, repr=False)
class Discretised(Valued):
    """A body on one mesh.

    Attributes
    ----------
    condensed : CondensedBody
        The linear body.
    linear : ContactProblem
        Its contact.
    problem : FiniteStrainProblem
        That at finite strain.
    """

    condensed: CondensedBody
    linear: ContactProblem
    problem: FiniteStrainProblem

    @property
    def chart(self) -> Chart:
        """Chart for the curve."""
        return Chart(self.problem, self.problem.body.unknowns)

    def near(self, segments: Sequence[Segment], problem: Traceable, point: Point) -> Array:
        """State of the linear body whose contact has the same edge on the undeformed surface, or the same central gap.

        Parameters
        ----------
        segments : sequence of Segment
            Curve of the linear body on any discretisation.
        problem : Traceable
            Any discretisation of the body, at finite strain or not.
        point : Point
            A state of it.

        Raises
        ------
        NotConverged
            If Newton's method does not reach it from the curve's nearest point.
        """
        radius = undeformed_radius(problem, point)
        touching = bool(np.isfinite(radius))
        observable = CONTACT_RADIUS if touching else CENTRAL_GAP
        value = radius if touching else float(point.observables[CENTRAL_GAP])
        control = newton.contact_radius(value) if touching else newton.central_gap(value)
        states = [(s.problem, p) for s in segments for p in s.points]
        source, nearest = min(states, key=lambda s: _distance(s[1].observables[observable], value))
        x = newton.solve(self.linear, transfer(source, nearest.x, self.linear), control).x
        displacement = self.condensed.displacement(self.linear.pressure(x))
        return self.problem.state_from(float(x[-2]), displacement)


def _distance(value: float, target: float) -> float:
    return float("inf") if np.isnan(value) else abs(value - target)


@dataclass(frozen=True, eq=False, repr=False)
class ScenesBody(Valued):
    """The body of a scene, to be meshed for any range of contact radii.

    Attributes
    ----------
    scene : Scene
        A hemisphere at finite strain.
    how : Discretisation
        Degree of the elements and size of their cells.
    """

    scene: Scene
    how: sized.Discretisation

    @property
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""
        return self._sized.length

    @property
    def _sized(self) -> SizedBody:
        return sized.sized_body(linear(self.scene), self.how)

    def richer(self) -> ScenesBody:
        """Return the same with elements of one degree more."""
        return replace(self, how=replace(self.how, degree=self.how.degree + 1))

    def meshed(self, inner: float, outer: float) -> Discretised:
        """Discretise with cells that are fine for contact radii between these, as far as a contact may reach."""
        body, R = self._sized, self.scene.sphere_radius
        first, last = (body.coordinate.of(min(radius, FARTHEST * R)) for radius in (inner, outer))
        lines = fine_between(first, last, body.length, bodies.CORE * R, self.how.growth)
        depths = grid.graded(0.0, float(np.diff(lines).min()), bodies.DEPTH * R, growth=self.how.growth)
        return self._on(bodies.hemisphere(R, lines, depths, rings=sized.corner_rings(self.scene, self.how)), body)

    def _on(self, mesh: Any, sized_body: SizedBody) -> Discretised:
        scene, far_field = self.scene, sized.GRIPS[self.scene.grip]
        space = Space(mesh, ElementQuadP(self.how.degree))
        condensed = condense(space, scene.poisson, far_field=far_field, stiffness=stiffness_for(scene.poisson))
        under_wall = ContactProblem(condensed.operator, scene.tabor, profile=sized_body.profile)
        exterior = with_interiors(far_field(space, scene.poisson), space)
        body = material_body(space, scene.poisson, 1 / scene.sphere_radius)
        convention = convention_of(scene.traction, scene.poisson)
        problem = finite_strain_problem(body, exterior, scene.tabor, profile=sized_body.profile, convention=convention)
        return Discretised(condensed, under_wall, problem)


def linear(scene: Scene) -> Scene:
    """Return the scene at small strain."""
    return replace(scene, strain="small", traction="projected")


def enriched(u: Array, lower: Space, higher: Space) -> Array:
    """Return the displacements u, (N,), of a space in one of a higher degree on the same mesh, exactly."""
    X, _ = get_quadrature(higher.element, 2 * higher.degree)
    at = [
        np.array([space.element.lbasis(X, i)[0] for i in range(len(space.scalar_dofs.element_dofs))])
        for space in (lower, higher)
    ]
    change = np.linalg.lstsq(at[1].T, at[0].T)[0]
    result = np.empty(higher.unknowns)
    for old, new in zip(lower.components, higher.components, strict=True):
        result[new[higher.scalar_dofs.element_dofs]] = change @ u[old[lower.scalar_dofs.element_dofs]]
    return result


def fine_between(inner: float, outer: float, finest: float, end: float, growth: float) -> Array:
    """Ends of cells from 0 to `end`: no longer than `finest` from `inner` to `outer`, growing away from both."""
    count = max(int(np.ceil((outer - inner) / finest - 1e-9)), 0)
    before = inner - grid.geometric(inner, finest, growth)[:0:-1] if inner else np.zeros(0)
    beyond = outer + grid.geometric(end - outer, finest, growth)[1:]
    lines = np.concatenate([before, np.linspace(inner, outer, count + 1), beyond])
    lines[0] = 0.0  # not what rounding leaves of it
    return lines
