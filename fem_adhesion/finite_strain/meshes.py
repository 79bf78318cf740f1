"""A sphere of a scene at finite strain, on meshes fine for some range of contact radii."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

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

NEARBY = 0.01  # relative difference of contact radii that one mesh of an event serves


@dataclass(frozen=True, eq=False, repr=False)
class ScenesBody(Valued):
    """The body of a scene, a hemisphere at finite strain, to be meshed for any range of contact radii.

    `how` is the degree of the elements and the size of their cells, which grow the slower the more steeply the tension
    ends.
    """

    scene: Scene
    how: Discretisation

    def meshed(self, inner: float, outer: float) -> FiniteStrainProblem:
        """Discretise with cells that are fine for contact radii between these, as far as a contact may reach."""
        scene, R = self.scene, self.scene.sphere_radius
        how = replace(self.how, growth=scene.scales.growth(self.how.growth))
        ends, coordinate = layout_of(scene, how)
        first, last = (coordinate.of(min(radius, FARTHEST * R)) for radius in (inner, outer))
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
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""
        return finest_length(self.scene, self.how)


@dataclass(frozen=True, eq=False, repr=False)
class Windows(Valued):
    """Charts for the whole curve, each fine for a window of contact radii, made when they are first asked for."""

    body: ScenesBody
    made: dict[int, Chart] = field(default_factory=dict, compare=False, repr=False)
    farther = together = None

    def __iter__(self) -> Iterator[Chart]:
        """All of them in order."""
        return map(self._chart, range(self._count))

    def __call__(self, event: Located) -> Chart:
        """Chart for a point of the curve."""
        radius = float(np.nan_to_num(undeformed_radius(event.problem, event.point)))
        return self._chart(min(int(radius / self._width), self._count - 1))

    def _chart(self, number: int) -> Chart:
        if number not in self.made:
            first, last = self._width * number, self._width * (number + 1)
            problem = self.body.meshed(first, last)
            self.made[number] = Chart(problem, problem.body.unknowns, min(last, self._farthest))
        return self.made[number]

    @property
    def _width(self) -> float:
        return WINDOW * self.body.length

    @property
    def _farthest(self) -> float:
        return FARTHEST * self.body.scene.sphere_radius

    @property
    def _count(self) -> int:
        return int(np.ceil(self._farthest / self._width))

    @property
    def everywhere(self) -> Windows:
        """The same."""
        return self

    @property
    def unknowns(self) -> int:
        """Most unknowns of a mesh made so far."""
        return max(chart.unknowns for chart in self.made.values())


@dataclass(frozen=True, eq=False, repr=False)
class AroundEvents(Valued):
    """A discretisation on which every event has a mesh made for its own contact radius.

    `everywhere` is for the points of a curve.
    """

    body: ScenesBody
    everywhere: Windows
    made: list[tuple[float, FiniteStrainProblem]] = field(default_factory=list, compare=False, repr=False)
    farther = together = None

    def __call__(self, event: Located) -> Chart:
        """Chart for an event."""
        problem = self.mesh(event)
        return Chart(problem, problem.body.unknowns)

    def mesh(self, event: Located) -> FiniteStrainProblem:
        """Mesh for an event, by its contact radius, unless one made before will do."""
        for _, problem in self.made:  # on its own an event may have moved by more than that serves
            if problem is event.problem:
                return problem
        radius = float(np.nan_to_num(undeformed_radius(event.problem, event.point)))
        for made_for, problem in self.made:
            if abs(radius - made_for) <= NEARBY * radius:
                return problem
        self.made.append((radius, self.body.meshed(radius, radius)))
        return self.made[-1][1]

    @property
    def unknowns(self) -> int:
        """Most unknowns of a mesh made so far."""
        return max(problem.body.unknowns for _, problem in self.made)


def fine_between(inner: float, outer: float, finest: float, end: float, growth: float) -> Array:
    """Ends of cells from 0 to `end`: no longer than `finest` from `inner` to `outer`, growing away from both."""
    count = max(int(np.ceil((outer - inner) / finest - 1e-9)), 0)
    before = inner - grid.geometric(inner, finest, growth)[:0:-1] if inner else np.zeros(0)
    beyond = outer + grid.geometric(end - outer, finest, growth)[1:]
    lines = np.concatenate([before, np.linspace(inner, outer, count + 1), beyond])
    lines[0] = 0.0  # not what rounding leaves of it
    return lines
