"""The contacts of scenes in the weak form of `fem_adhesion.weak_form`, each on a coarse and on a fine body.

Of a body with a length they share with the finite elements what draws the mesh, and nothing else: elements, forms,
quadrature, radii, profiles and areas are the weak form's own. A user's mesh is taken as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from skfem import MeshTri

from fem_adhesion.bodies.pair import pair_meshes
from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.mesh.file import read_body
from fem_adhesion.mesh.held_sphere import held_sphere
from fem_adhesion.scene import Counter, Scene
from fem_adhesion.weak_form import (
    Body,
    Contact,
    Heights,
    discretise,
    half_space,
    on_ground,
    opposed,
    paraboloid,
    sphere,
)
from halfspace.elastic import grid
from halfspace.values import Array

AtRadius = Callable[[float], Contact]
"""The contact on cells that are finest at a radius in beta."""

FINENESS = ((3, 10.0), (4, 30.0))  # degree of the elements, size of the box in contact radii: coarse, fine
DEGREES = (3, 4)  # of the elements of a body with a length; one more of spheres if nothing else checks them, or if
NEARLY = 0.45  # they are nearly incompressible: Poisson's ratio beyond
SHARP = 6.0
"""Tabor parameter beyond which the spike of tension is too narrow for the weak form to show where a contact turns."""


def contacts(scene: Scene) -> tuple[AtRadius, AtRadius]:
    """Contact of a scene on a coarse and on a fine body."""
    if not scene.sized:
        boxes = half_spaces(scene)
        return partial(_on_half_space, scene, boxes[0]), partial(_on_half_space, scene, boxes[1])
    alone = scene.grip == "bonded" or scene.body == "sphere"
    more = int(not isinstance(scene.body, Path) and (alone or scene.poisson > NEARLY))
    return partial(_sized, scene, DEGREES[0] + more), partial(_sized, scene, DEGREES[1] + more)


# Half-spaces


def half_spaces(scene: Scene) -> tuple[Body, ...]:
    """Half-spaces, coarse and fine, with cells at the contact edge finer than the spike of tension there."""
    more = int(scene.tabor > SHARP) + int(scene.tabor > 3 * SHARP)
    return tuple(_half_space(_finest(scene), size, degree + more, scene.poisson) for degree, size in FINENESS)


def _finest(scene: Scene) -> float:
    """Length of the cells at the contact edge in contact radii."""
    return float(0.04 * 3.0 ** -max(0.0, np.ceil(np.log(scene.tabor**2 / 4) / np.log(3))))


@lru_cache(maxsize=8)
def _half_space(finest: float, size: float, degree: int, poisson: float) -> Body:
    return half_space(finest, size, degree, poisson)


def _on_half_space(scene: Scene, body: Body, radius: float) -> Contact:
    return Contact(body.scaled(radius), scene.tabor)


# Bodies with a length


def _sized(scene: Scene, degree: int, radius: float) -> Contact:
    """Contact of a sphere, of a pair or of a user's mesh."""
    R = float(np.sqrt(scene.radius_ratio / scene.tabor)) if scene.radius_ratio else np.inf
    if isinstance(scene.body, Path):
        body = discretise(_of_file(scene.body).scaled(R), degree, scene.poisson, slides=scene.grip == "sliding")
        return Contact(body, scene.tabor, lambda _: R * body.depths, endless=False)
    radius = min(radius, WIDEST * R)  # what attracts from afar may be wider
    if scene.counter:
        return _pair(scene, scene.counter, R, degree, radius)
    if scene.body == "block":
        block = _block(R, _finest(scene) * radius, radius)
        body = _ground(discretise(block, degree, scene.poisson, plate=True))
        return Contact(body, scene.tabor, _heights(scene, R), endless=False)
    body = discretise(
        _mesh(scene, R, _finest(scene) * radius, radius),
        degree,
        scene.poisson,
        slides=scene.grip == "sliding",
        on_surface=scene.traction == "surface",
    )
    return Contact(body, scene.tabor, _heights(scene, R), endless=False)


def _heights(scene: Scene, R: float) -> Heights:
    """Undeformed gap in beta^2/R; the heights of two spheres add."""
    if scene.profile == "paraboloid":
        return paraboloid
    over = scene.counter.radius if scene.counter else np.inf
    radii = [R * (1 + 1 / over), R * (1 + over)] if np.isfinite(over) else [R]
    return lambda r: sum((R / each * sphere(r, each) for each in radii), 0 * r)


GROWTH, WIDEST = 2.5, 0.95  # ratio of neighbouring cells; the place in R beyond which they are finest nowhere
RINGS = 0.2 ** np.arange(1.0, 5.0)  # sizes of rings of cells around a corner where the stress is singular


def _mesh(scene: Scene, R: float, finest: float, radius: float) -> Any:
    """Mesh of a sphere or hemisphere whose cells are finest at a radius."""
    lines, depths = _lines(R, finest, radius), grid.graded(0.0, finest, spheres.DEPTH * R, growth=GROWTH)
    if scene.body == "sphere":
        return held_sphere(R, lines, depths, scene.cap_angle)
    return spheres.hemisphere(R, lines, depths, rings=_rings(scene))


def _block(R: float, finest: float, radius: float) -> Any:
    """Mesh of a block that is a half-space to a sphere, on which the law acts as far as that reaches."""
    beyond = R + grid.geometric(BEYOND * R, R / 4, GROWTH)[1:]
    lines = np.append(grid.graded(radius, finest, R, growth=GROWTH), beyond)
    mesh = tensor_grid(lines, grid.graded(0.0, finest, BEYOND * R, growth=GROWTH))
    return spheres.with_contact_to(mesh, R)


BEYOND = 1e3  # size of the block in R


def _lines(R: float, finest: float, radius: float) -> Array:
    """Lines of the core of a sphere of radius R, in its coordinate."""
    return grid.graded(spheres.Stereographic(R).of(radius), finest, spheres.CORE * R, growth=GROWTH)


def _rings(scene: Scene) -> Array:
    return RINGS if scene.grip == "bonded" else spheres.NO_RINGS


def _pair(scene: Scene, counter: Counter, R: float, degree: int, radius: float) -> Contact:
    """Contact of two bodies, that beyond the core of the smaller one are rigid."""
    R1, finest, slides = R * (1 + 1 / counter.radius), _finest(scene) * radius, scene.grip == "sliding"
    lines, depths = _lines(R1, finest, radius), partial(grid.graded, 0.0, finest, growth=GROWTH)
    meshes = pair_meshes(lines, depths, R, counter, _rings(scene))
    first = discretise(meshes[0], degree, scene.poisson, slides=slides)
    if np.isinf(counter.radius):
        second = _ground(discretise(meshes[1], degree, counter.poisson, plate=True))
    else:
        second = discretise(meshes[1], degree, counter.poisson, slides=slides)
    body = opposed(first, second, counter.share)
    return Contact(body, scene.tabor, _heights(scene, R), endless=False, rigid=_rim(first.rim, R1))


def _ground(block: Body) -> Body:
    """Block as a half-space, on which (1 - r^2/e^2)^(3/2), of the load 2 pi e^2/5, does the work 4 pi^2 e^3/35."""
    e = block.rim
    pressure = np.maximum(1 - (block.radii / e) ** 2, 0) ** 1.5
    return on_ground(block, pressure, 2 * np.pi * e**2 / 5, 4 * np.pi**2 * e**3 / 35)


def _rim(begin: float, end: float, points: int = 12) -> tuple[Array, Array]:
    """Radii and parts of dA between two radii, by Gauss's rule in the angle sin(theta) = r/end."""
    t, w = np.polynomial.legendre.leggauss(points)
    first = float(np.arcsin(begin / end))
    theta, d_theta = first + (np.pi / 2 - first) * (1 + t) / 2, (np.pi / 2 - first) * w / 2
    return end * np.sin(theta), 2 * np.pi * end**2 * np.sin(theta) * np.cos(theta) * d_theta


@lru_cache(maxsize=2)
def _of_file(path: Path) -> Any:
    """Mesh of a file; the vertices of triangles ascend, so that neighbours agree on the places along their sides."""
    mesh = read_body(path)
    return type(mesh)(mesh.doflocs, np.sort(mesh.t, axis=0), mesh.boundaries) if isinstance(mesh, MeshTri) else mesh
