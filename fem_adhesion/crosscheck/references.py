"""For each scene a solver that shares no operator with the finite elements, if there is one, and operators of both."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

import halfspace
from fem_adhesion import convergence, discretise, harmonics
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.convergence import on_given_mesh
from fem_adhesion.crosscheck.comparison import HARMONICS, SOLVERS, Pair
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.scene import Scene
from halfspace.accuracy.finite_bodies import SizedBody, at_equator
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.layered import panels_of
from halfspace.equilibrium.contact import ContactProblem, contact_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array

Operators = list[ElasticOperator]


@dataclass(frozen=True)
class Reference:
    """A solver of another kind for the body of a scene: its name and that of the finite elements.

    ``trace(rtol=...)`` is its curve to a tolerance; `operators`, from the tolerance of a comparison, two of its
    operators for the first level, the finer one last.
    """

    between: Pair
    trace: Callable[..., EquilibriumPath]
    operators: Callable[[float], Operators]


def reference_for(scene: Scene) -> Reference | None:
    """The half-space or the whole sphere by harmonics; None for a body that neither knows."""
    if scene.checked_by == "half-space":
        return Reference(SOLVERS, partial(halfspace.trace, **scene.for_half_space), partial(_half_spaces, scene))
    if scene.checked_by == "harmonics":
        return Reference(HARMONICS, partial(harmonics.trace, scene), partial(_spheres, scene))
    return None


# Pressures that all operators are compared under, of the radius in units of `radius_of`

PRESSURES: dict[str, Callable[[Array], Array]] = {
    "uniform disc": lambda r: np.where(r < 1, 1.0, 0.0),
    "Hertz": lambda r: np.sqrt(np.maximum(1 - r**2, 0)),
    "spike": lambda r: -1 / (1 + ((r - 1) / 0.05) ** 2) ** 3,
    "ring": lambda r: r**2 / (1 + r**2) ** 4,
}
SMOOTH = ("spike", "ring")  # without an edge, where harmonics converge slowly; for bodies with a length


def radius_of(scene: Scene) -> float:
    """Radius in beta at which these pressures have their edge: 1, or a sixth of that of the smaller sphere."""
    return scene.surface.end / 6 if math.isfinite(scene.sphere_radius) else 1.0


def _about(edge: float, outer: Array, last: float) -> Array:
    """Ends of cells about an edge, up to the first of the outer ones."""
    return np.append(grid.graded(edge, USUAL.fine * edge, float(outer[0]), last=last), outer[1:])


def _of_blocks(scene: Scene) -> tuple[Array, Array]:
    """Ends of the cells of a block's surface, and of one twice as large."""
    lines = grid.graded(1.0, USUAL.finest, scene.body.cut_off or 40.0)
    return lines, grid.graded(1.0, USUAL.finest, 2 * lines[-1])


def _half_spaces(scene: Scene, rtol: float) -> Operators:
    degree = convergence.resolution_for(scene, rtol, 0)[0].degree
    if scene.sized:
        last = at_equator(scene.tabor, scene.surface, 8)
        lines = _about(radius_of(scene), np.array([scene.surface.end]), last)
    else:
        _, lines = _of_blocks(scene)
    return [panels_of(scene.body.layered, lines, k) for k in (degree + 3, degree + 5)]


def _spheres(scene: Scene, _: float) -> Operators:
    """By harmonics."""
    R = 6 * radius_of(scene)
    hows = [harmonics.Fineness(nodes, count * scene.scales.spike_width / R) for nodes, count in USUAL.harmonic]
    return [_made(harmonics.sized_body(scene, how), scene) for how in hows]


def _made(body: SizedBody, scene: Scene) -> ElasticOperator:
    """Operator of a body with a length on cells about the edge of the pressures."""
    return body.make(_about(body.coordinate.of(radius_of(scene)), body.outer, body.last))[0]


def elements_of(scene: Scene, rtol: float) -> list[ContactProblem]:
    """Problems on finite elements, the finest last; of a block the size before that, of others the degree alone."""
    if scene.body.file:
        return [on_given_mesh(scene, level).problem for level in (0, 1)]
    if not scene.sized:
        degree, (lines, wider) = convergence.resolution_for(scene, rtol, 0)[0].degree, _of_blocks(scene)
        cases = ((lines, degree), (wider, degree), (wider, degree + 1))
        return [discretise.discretise(scene, ends, Discretisation(d, growth=2.0)).problem for ends, d in cases]
    degree = convergence.degree_for(rtol) + (scene.body.layered is not None)  # thin films bend within their thickness
    finest = 2 * USUAL.fine * radius_of(scene) / scene.scales.spike_width
    hows = [replace(convergence.with_rings(d), finest=finest) for d in (degree, degree + 1)]
    made = [discretise.sized_body(scene, how) for how in hows]
    return [contact_of(body.scales, _made(body, scene)) for body in made]
