"""The contact problem at finite strain: of a body from its parts, or of a sphere on meshes fine for some radii."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import FAR_FIELDS, finest_length, layout_of, mesh_of, quadrilateral
from fem_adhesion.elasticity.boundaries import Exterior, FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.body import Body, displacement_body, material_body
from fem_adhesion.finite_strain.held import HeldBody
from fem_adhesion.finite_strain.problem import FiniteStrainProblem
from fem_adhesion.finite_strain.surface import contact_surface
from fem_adhesion.finite_strain.traction import Convention, convention_of
from fem_adhesion.scene import Scene
from halfspace.accuracy.stages import WhereAsked
from halfspace.elastic import grid
from halfspace.equilibrium.charts import Chart, undeformed_radius
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import ContactProblem
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.profiles import PARABOLOID, Surface
from halfspace.values import Valued

FARTHEST = 0.98
"""Undeformed radius in R up to which a contact may spread.

Small slopes end before: `halfspace.equilibrium.contact.WIDEST`.
"""

WINDOW = 8
"""Fine cells in a mesh of the curve: more cost more unknowns, fewer more meshes."""


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
) -> FiniteStrainProblem:
    """Put a body under a rigid flat wall that attracts it.

    The body is a `displacement_body` or `mixed_body` of `fem_adhesion.finite_strain.body`, the exterior one of
    `fem_adhesion.elasticity.boundaries` on its space; tabor and law are as in
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
    interface = ContactProblem(surface.rigid, tabor, law, profile)
    return FiniteStrainProblem(HeldBody(body, whole, surface.unknowns), surface, interface, convention)


def assemble(
    space: Space,
    poisson: float,
    tabor: float,
    *,
    far_field: FarField = point_load,
    points: int | None = None,
) -> FiniteStrainProblem:
    """Contact problem of a linear block under a rigid paraboloid, none of its unknowns condensed but in the solver.

    Space, poisson and points are as in `fem_adhesion.elasticity.condensation.condense`, whose problem has the same
    solutions, the rest and the errors as of `finite_strain_problem`; the far field is `point_load` or `clamped`.
    InputError, too, if poisson is out of range.
    """
    body, exterior = displacement_body(space, poisson, 0.0), far_field(space, poisson)
    return finite_strain_problem(body, exterior, tabor, convention=Convention(0.0, 0.0), points=points)


# Of a scene


@dataclass(frozen=True, eq=False, repr=False)
class ScenesBody(Valued):
    """The body of a scene, a hemisphere at finite strain, to be meshed for any range of contact radii.

    `how` is the degree of the elements and the size of their cells, which grow the slower the more steeply the tension
    ends.
    """

    scene: Scene
    how: Discretisation

    def standing(self, radius: float) -> Chart:
        """Chart finest at a contact radius in beta."""
        return replace(self.chart(radius, radius), until=np.inf)

    def chart(self, inner: float, outer: float) -> Chart:
        """Chart that serves contact radii between these."""
        problem = self.meshed(inner, outer)
        return Chart(problem, problem.body.unknowns, min(outer, self.farthest))

    def meshed(self, inner: float, outer: float) -> FiniteStrainProblem:
        """Discretise with cells that are fine for contact radii between these, as far as a contact may reach."""
        scene, R = self.scene, self.scene.sphere_radius
        how = replace(self.how, growth=scene.scales.growth(self.how.growth))
        ends, coordinate = layout_of(scene, how)
        first, last = (coordinate.of(min(radius, self.farthest)) for radius in (inner, outer))
        lines = grid.graded(first, self.length, float(ends[0]), growth=how.growth, until=last)
        space = Space(mesh_of(scene, lines, how), quadrilateral(how.degree))
        return finite_strain_problem(
            material_body(space, scene.poisson, 1 / R),
            FAR_FIELDS[scene.body.held](space, scene.poisson),
            scene.tabor,
            profile=scene.surface,
            convention=convention_of(scene.material.traction, scene.poisson),
            law=scene.law,
        )

    @property
    def farthest(self) -> float:
        """Undeformed radius in beta up to which a contact may spread."""
        return FARTHEST * self.scene.sphere_radius

    @property
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""
        return finest_length(self.scene, self.how)


@dataclass(frozen=True, eq=False, repr=False)
class Windows(WhereAsked):
    """Charts for the whole curve, each fine for a window of contact radii."""

    body: ScenesBody

    def __iter__(self) -> Iterator[Chart]:
        """All of them in order."""
        return map(self._chart, range(self._count))

    def __call__(self, event: Located) -> Chart:
        """Chart for a point of the curve."""
        radius = float(np.nan_to_num(undeformed_radius(event.problem, event.point)))
        return self._chart(min(int(radius / self._width), self._count - 1))

    def _chart(self, number: int) -> Chart:
        first, last = self._width * number, self._width * (number + 1)
        return self.serving((first + last) / 2) or self.keep(first, last, self.body.chart(first, last))

    @property
    def _width(self) -> float:
        return WINDOW * self.body.length

    @property
    def _count(self) -> int:
        return int(np.ceil(self.body.farthest / self._width))
