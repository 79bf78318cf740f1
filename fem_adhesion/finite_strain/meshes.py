"""A sphere of a scene at finite strain, on meshes fine for some range of contact radii."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import FAR_FIELDS, finest_length, layout_of, mesh_of
from fem_adhesion.elasticity.far_field import with_interiors
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.assembly import finite_strain_problem
from fem_adhesion.finite_strain.body import material_body
from fem_adhesion.finite_strain.problem import FiniteStrainProblem
from fem_adhesion.finite_strain.traction import convention_of
from fem_adhesion.scene import Scene
from halfspace.accuracy.stages import WhereAsked
from halfspace.elastic import grid
from halfspace.equilibrium.charts import Chart, undeformed_radius
from halfspace.equilibrium.conditions import Located
from halfspace.values import Array, Valued

FARTHEST = 0.98
"""Undeformed radius in R up to which a contact may spread.

Small slopes end before: `halfspace.equilibrium.contact.WIDEST`.
"""

WINDOW = 8
"""Fine cells in a mesh of the curve: more cost more unknowns, fewer more meshes."""


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
        lines = fine_between(first, last, self.length, float(ends[0]), how.growth)
        space = Space(mesh_of(scene, lines, how), ElementQuadP(how.degree))
        exterior = with_interiors(FAR_FIELDS[scene.body.held](space, scene.poisson), space)
        return finite_strain_problem(
            material_body(space, scene.poisson, 1 / R),
            exterior,
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


def fine_between(inner: float, outer: float, finest: float, end: float, growth: float) -> Array:
    """Ends of cells from 0 to `end`: no longer than `finest` from `inner` to `outer`, growing away from both."""
    count = max(int(np.ceil((outer - inner) / finest - 1e-9)), 0)
    before = inner - grid.geometric(inner, finest, growth)[:0:-1] if inner else np.zeros(0)
    beyond = outer + grid.geometric(end - outer, finest, growth)[1:]
    lines = np.concatenate([before, np.linspace(inner, outer, count + 1), beyond])
    lines[0] = 0.0  # not what rounding leaves of it
    return lines
