"""For each scene a solver that shares no operator with the finite elements, if there is one, and operators of both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from skfem import ElementQuadP

import halfspace
from fem_adhesion import convergence, harmonics
from fem_adhesion.bodies import sized
from fem_adhesion.bodies.pair import radii_of
from fem_adhesion.bodies.user_mesh import mesh_charts
from fem_adhesion.crosscheck.comparison import HARMONICS, SOLVERS, Pair
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.mesh.file import read_body
from fem_adhesion.scene import Scene
from halfspace.accuracy.finite_bodies import SizedBody, at_equator
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.contact import ContactProblem, spike_width
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import InputError
from halfspace.profiles import PARABOLOID, Profile, Sphere
from halfspace.profiles.sphere import SphereSurface
from halfspace.values import Array

Operators = list[ElasticOperator]


@dataclass(frozen=True)
class Reference:
    """A solver of another kind for the body of a scene.

    Attributes
    ----------
    between : pair of str
        Its name and that of the finite elements.
    trace : callable
        Its curve to a tolerance, ``trace(rtol=...)``.
    operators : callable
        Two of its operators, the finer one last, for the first level of a comparison, from its tolerance.
    """

    between: Pair
    trace: Callable[..., EquilibriumPath]
    operators: Callable[[float], Operators]


def reference_for(scene: Scene) -> Reference | None:
    """The half-space or the whole sphere by harmonics; None for a body that is neither."""
    if scene.body == "block":
        profile: Profile = Sphere(scene.radius_ratio) if scene.radius_ratio else PARABOLOID
        half_space = partial(halfspace.trace, scene.tabor, profile=profile)
        return Reference(SOLVERS, half_space, partial(_half_spaces, scene))
    if scene.body == "hemisphere" and scene.grip == "sliding" and scene.traction == "projected":
        return Reference(HARMONICS, partial(harmonics.trace, scene), partial(_spheres, scene))
    return None


def tighter(rtol: float) -> float:
    """What is asked of it in a comparison to a tolerance."""
    return max(rtol / 10, 1e-9)


def require_comparable(scene: Scene, rtol: float) -> None:
    """Refuse a scene for which there is one solver only, or none in reach of a tolerance; raise InputError."""
    if scene.strain != "small":
        raise InputError(
            f"strain = {scene.strain} is compared with nothing, limit: small; no other solver of the house knows it"
        )
    reference = reference_for(scene)
    if reference and reference.between == HARMONICS:
        harmonics.require_few(scene, tighter(rtol))


# Pressures that all operators are compared under, of the radius in units of `radius_of`

PRESSURES: dict[str, Callable[[Array], Array]] = {
    "uniform disc": lambda r: np.where(r < 1, 1.0, 0.0),
    "Hertz": lambda r: np.sqrt(np.maximum(1 - r**2, 0)),
    "spike": lambda r: -1 / (1 + ((r - 1) / 0.05) ** 2) ** 3,
    "ring": lambda r: r**2 / (1 + r**2) ** 4,
}
SMOOTH = ("spike", "ring")  # without an edge, where harmonics converge slowly
FINEST, FINE = 1e-4, 0.02  # cells at an edge, where the deflection under a disc has a vertical tangent, or without one


def pressures_for(scene: Scene) -> dict[str, Callable[[Array], Array]]:
    """Those under which the operators of a scene are compared."""
    return {name: PRESSURES[name] for name in SMOOTH} if scene.sized else PRESSURES


def radius_of(scene: Scene) -> float:
    """Radius in beta at which these pressures have their edge: 1, or a sixth of that of the smaller sphere."""
    R = radii_of(scene.sphere_radius, scene.counter)[0] if scene.counter else scene.sphere_radius
    return R / 6 if scene.sized else 1.0


# Half-spaces


def _lines(scene: Scene) -> Array:
    """Ends of the cells of a block's surface."""
    if scene.sized:
        R = np.array([scene.sphere_radius])
        return _about(radius_of(scene), R, at_equator(scene.tabor, SphereSurface(R[0]), 8))
    return grid.graded(1.0, FINEST, 40.0 if scene.radius is None else scene.radius)


def _about(edge: float, outer: Array, last: float) -> Array:
    """Ends of cells about an edge, up to the first of the outer ones."""
    return np.append(grid.graded(edge, FINE * edge, float(outer[0]), last=last), outer[1:])


def _half_spaces(scene: Scene, rtol: float) -> Operators:
    degree = convergence.resolution_for(scene, rtol, 0).degree
    lines = _lines(scene)
    wider = lines if scene.sized else grid.graded(1.0, FINEST, 2 * lines[-1])
    return [compliance.panels(wider, k) for k in (degree + 3, degree + 5)]


# Spheres by harmonics

HARMONIC = ((9, 2000), (11, 2600))  # nodes of the cells and harmonics, which resolve the spike at that radius


def _spheres(scene: Scene, _: float) -> Operators:
    R = 6 * radius_of(scene)
    hows = [harmonics.Resolution(nodes, count * spike_width(scene.tabor) / R) for nodes, count in HARMONIC]
    return [_made(harmonics.sized_body(scene, how), scene) for how in hows]


def _made(body: SizedBody, scene: Scene) -> ElasticOperator:
    """Operator of a body with a length on cells about the edge of the pressures."""
    return body.make(_about(body.coordinate.of(radius_of(scene)), body.outer, body.last))[0]


# Finite elements


def elements_of(scene: Scene, rtol: float) -> list[ContactProblem]:
    """Problems on finite elements, the finest last; of a block the size before that, of others the degree alone."""
    if not scene.sized:
        return [ContactProblem(operator, scene.tabor) for operator in _blocks(scene, rtol)]
    if isinstance(scene.body, Path):
        mesh = read_body(scene.body)
        return [mesh_charts(scene, mesh, level)[0].problem.interface for level in (0, 1)]
    degree = sized.degree_for(rtol)
    finest = 2 * FINE * radius_of(scene) / spike_width(scene.tabor)
    hows = [replace(sized.with_rings(d), finest=finest) for d in (degree, degree + 1)]
    made = [sized.sized_body(scene, how) for how in hows]
    return [ContactProblem(_made(body, scene), scene.tabor, profile=body.profile) for body in made]


def _blocks(scene: Scene, rtol: float) -> Operators:
    degree = convergence.resolution_for(scene, rtol, 0).degree
    lines = _lines(scene)
    wider = grid.graded(1.0, FINEST, 2 * lines[-1])
    return [_block(scene, lines, degree), _block(scene, wider, degree), _block(scene, wider, degree + 1)]


def _block(scene: Scene, lines: Array, degree: int) -> ElasticOperator:
    space = Space(tensor_grid(lines, grid.graded(0.0, FINEST, lines[-1])), ElementQuadP(degree))
    far_field, stiffness = convergence.FAR_FIELDS[scene.far_field], stiffness_for(scene.poisson)
    return condense(space, scene.poisson, far_field=far_field, stiffness=stiffness).operator
