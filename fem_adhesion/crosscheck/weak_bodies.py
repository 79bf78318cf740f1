"""The contacts of scenes in the weak form of `fem_adhesion.weak_form`, each on bodies that are ever finer.

Of a body with a length they share with the finite elements what draws the mesh, and nothing else: elements, forms,
quadrature, radii, profiles and areas are the weak form's own. A user's mesh is taken as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from skfem import MeshTri

from fem_adhesion.bodies.body import Body as ElasticBody
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.bodies.layers import FAR_OUT, Stratified
from fem_adhesion.crosscheck.definitions import heights, lengths, numbers_of
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.discretise import finest_length
from fem_adhesion.mesh.file import is_straight, refined
from fem_adhesion.mesh.spheres import with_contact_to
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.body import (
    TRIANGLES,
    Body,
    discretise,
    fine_within,
    half_space,
    on_ground,
    opposed,
    with_rigid,
)
from fem_adhesion.weak_form.contact import Contact, Law, lennard_jones
from halfspace.elastic import grid
from halfspace.elastic.layers import surface_compliance
from halfspace.laws import LENNARD_JONES
from halfspace.values import Array

FineAt = Callable[[float, float], Contact]
"""The contact on cells that are finest at one radius in beta, and fine up to another."""


def sharpness(scene: Scene, radius: float) -> float:
    """How narrow the spike of tension at an edge is: the Tabor parameter, of a soft contact by the 3-9 law.

    On a wide contact it is narrow in contact radii.
    """
    return float(np.sqrt(max(radius / USUAL.wide, 1.0) / scene.scales.spike_width))


def law_of(scene: Scene) -> Law:
    """Law by its potential: the 3-9 law's in a formula of its own, any other's as it states it."""
    law = scene.law
    if law == LENNARD_JONES:
        return Law(lennard_jones)
    room = float(law.room(np.array(-1.0)))
    known = numbers_of(law)
    return Law(lambda h: law.energy(h - 1, 1.0), known.stiffness**-0.5, room, 1 + known.edge)


def contacts(scene: Scene, load: float | None = None) -> list[FineAt]:
    """Contact of a scene on bodies each of which is finer than the one before.

    The load, in R dgamma, is the largest that is to act, that of its events unless given; if it is infinite, what they
    leave out is little beside what they deflect, however little that is.
    """
    if not scene.sized:
        return [partial(_on_half_space, scene, fineness) for fineness in USUAL.fineness]
    if scene.body.file:
        return [partial(_on_given_mesh, scene, degree) for degree in USUAL.degrees if degree in TRIANGLES]
    more = int(scene.checked_by is None or scene.poisson > USUAL.nearly or scene.body.layered is not None)
    load = load or scene.scales.largest_load
    return [partial(_sized, scene, degree + more, load) for degree in USUAL.degrees]


# Half-spaces


def _on_half_space(scene: Scene, fineness: tuple[int, float], radius: float, reach: float) -> Contact:
    """Contact on a box with cells at a radius that are finer than the spike of tension there.

    Lengths are in contact radii and go by powers of 2, so that few bodies serve all.
    """
    degree, size = fineness
    sharp, attraction = sharpness(scene, radius), scene.scales.radius_at(scene.law.range(0.1))
    size *= USUAL.farther if scene.scales.far_energy else float(2.0 ** np.round(np.log2(max(attraction / radius, 1.0))))
    degree += sum(sharp > times * USUAL.sharp for times in (1, 3))
    degree += scene.law != LENNARD_JONES or scene.poisson > USUAL.locking
    first = scene.surface.first_cell(USUAL.tip) / radius  # under a tip that needs one
    tip = float(2.0 ** np.floor(np.log2(first))) if np.isfinite(first) else np.inf
    reach = float(2.0 ** np.ceil(np.log2(reach / radius)))
    body = _half_space(_finest(scene, radius), size, int(degree), scene.poisson, tip, reach)
    return Contact(body.scaled(radius), scene.tabor, heights(scene), law_of(scene))


def _finest(scene: Scene, radius: float) -> float:
    """Length of the cells at the contact edge in contact radii, by powers of 3 so that few bodies serve all."""
    return float(0.04 * 3.0 ** -max(0.0, np.ceil(np.log(sharpness(scene, radius) ** 2 / 4) / np.log(3))))


_half_space = lru_cache(maxsize=8)(half_space)


# Bodies with a length


def _on_given_mesh(scene: Scene, degree: int, *_: float) -> Contact:
    """Contact of a user's mesh."""
    body = discretise(_given_mesh(scene), degree, scene.body.regions, slides=scene.body.held == "sliding")
    R, _ = lengths(scene)
    return Contact(body, scene.tabor, lambda _: R * body.depths, law_of(scene))


@lru_cache(maxsize=2)
def _given_mesh(scene: Scene) -> Any:
    """The mesh as it is, of straight cells that on their smooth line; the vertices of triangles ascend.

    So neighbours agree on the places along their sides.
    """
    mesh = scene.body.mesh(lengths(scene)[0], np.zeros(1), 0.0, Discretisation(USUAL.degrees[0]))
    mesh = refined(mesh) if is_straight(mesh) else mesh
    return type(mesh)(mesh.doflocs, np.sort(mesh.t, axis=0), mesh.boundaries) if isinstance(mesh, MeshTri) else mesh


def _sized(scene: Scene, degree: int, load: float, radius: float, reach: float) -> Contact:
    """Contact of one body or two, whose cells are finest at a radius."""
    R, bodies = lengths(scene)
    R = (
        bodies[0] if np.isfinite(bodies[0]) else min(R, scene.surface.end)
    )  # the first body's, or where what attracts ends
    radius, reach = (min(r, USUAL.widest * R) for r in (radius, reach))  # what attracts from afar may be wider
    how = Discretisation(
        degree, 2 * _finest(scene, radius) * radius / scene.scales.spike_width, USUAL.growth, USUAL.rings
    )
    if isinstance(scene.body, Stratified) and scene.body.held == "substrate":
        how = replace(how, beyond=_clamped(scene, scene.body, load, R, radius))
    outer, coordinate = scene.body.layout(R, replace(how, rings=0) if scene.counter else how)
    length = finest_length(scene, how)
    lines = grid.graded(coordinate.of(radius), length, float(outer[0]), growth=USUAL.growth)
    core = fine_within(
        coordinate.of(reach), grid.towards_axis(lines, scene.surface.first_cell(USUAL.tip), USUAL.growth)
    )
    mesh = scene.body.mesh(R, core, length, how)
    if scene.counter is None:
        body = _standing(scene.body, mesh, degree)
        body = with_rigid(body, *_flat_rim(body.rim, R)) if scene.body.layered else body
        return Contact(body, scene.tabor, heights(scene), law_of(scene))
    end, other = float(coordinate.radius(core[-1:])[0][0]), scene.counter
    meshes = mesh, other.facing(bodies[1], core, length, R, how)
    first, second = (
        _standing(body, with_contact_to(one, end), degree)
        for body, one in zip((scene.body, other), meshes, strict=True)
    )
    body = with_rigid(opposed(first, second, scene.share or 0.0), *_rim(first.rim, R))
    return Contact(body, scene.tabor, heights(scene), law_of(scene))


def _clamped(scene: Scene, strata: Stratified, W: float, R: float, radius: float) -> float:
    """Size of a half-space under strata, as of `Discretisation.beyond`: W/(pi E L) at its end L is what a clamp omits.

    That is little beside eps and what W deflects within the contact. In one much larger the cells near its surface are
    so flat that rounding hides the force that the clamp bears.
    """
    yielding = float(surface_compliance(strata, np.array([1 / radius]))[0]) / (2 * radius)
    far = 1 / (np.pi * strata.beyond.modulus * USUAL.clamped * (1 / (scene.tabor * W) + yielding))
    return max(1 / FAR_OUT, far / strata.spread(R))


def _standing(elastic: ElasticBody, mesh: Any, degree: int) -> Body:
    """Body as it is held."""
    material, slides = elastic.material, elastic.held in ("sliding", "sheet")
    body = discretise(
        mesh, degree, elastic.regions, slides=slides, plate=elastic.endless, on_surface=material.area == "surface"
    )
    if not elastic.endless:
        return body
    # On a half-space (1 - r^2/e^2)^(3/2), of the load 2 pi e^2/5, does the work 4 pi^2 e^3/35.
    e = body.rim
    pressure = np.maximum(1 - (body.radii / e) ** 2, 0) ** 1.5
    return on_ground(body, pressure, 2 * np.pi * e**2 / 5, 4 * np.pi**2 * e**3 / 35)


def _flat_rim(begin: float, end: float, points: int = 40) -> tuple[Array, Array]:
    """Radii and parts of dA between two radii on a plane, by Gauss's rule in log(r); if they are the same, of no area.

    There are strata beyond those that yield, see `Stratified.layout`.
    """
    t, w = np.polynomial.legendre.leggauss(points)
    half = float(np.log(end / begin)) / 2
    r = begin * np.exp(half * (1 + t))
    return r, 2 * np.pi * r**2 * half * w


def _rim(begin: float, end: float, points: int = 12) -> tuple[Array, Array]:
    """Radii and parts of dA between two radii, by Gauss's rule in the angle sin(theta) = r/end."""
    t, w = np.polynomial.legendre.leggauss(points)
    first = float(np.arcsin(begin / end))
    theta, d_theta = first + (np.pi / 2 - first) * (1 + t) / 2, (np.pi / 2 - first) * w / 2
    return end * np.sin(theta), 2 * np.pi * end**2 * np.sin(theta) * np.cos(theta) * d_theta
