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
from scipy import sparse
from skfem import MeshTri

from fem_adhesion.bodies.body import Body as ElasticBody
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.bodies.layers import STRATA, Stratified
from fem_adhesion.crosscheck.definitions import heights, lengths, numbers_of
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.discretise import finest_length
from fem_adhesion.mesh.file import is_straight, refined
from fem_adhesion.mesh.spheres import with_contact_to
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.body import TRIANGLES, Body, box, discretise
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
    room = max(float(law.room(np.array(-1.0))), USUAL.closing)
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
    body = half_space(_finest(scene, radius), size, int(degree), scene.poisson, tip, reach)
    return Contact(scaled(body, radius), scene.tabor, heights(scene), law_of(scene))


def _finest(scene: Scene, radius: float) -> float:
    """Length of the cells at the contact edge in contact radii, by powers of 3 so that few bodies serve all."""
    return float(0.04 * 3.0 ** -max(0.0, np.ceil(np.log(sharpness(scene, radius) ** 2 / 4) / np.log(3))))


@lru_cache(maxsize=8)
def half_space(
    finest: float, size: float, degree: int, poisson: float, tip: float = np.inf, reach: float = 1.0
) -> Body:
    """Box of a half-space as wide and deep as its size, whose cells grow from `finest` at radius 1 of the surface on.

    They are fine up to the radius `reach`; under a sharp tip the one on the axis is `tip` long, or less.

    It stands on a spring that yields as what is beyond would: Hertz's pressure sqrt(1 - r^2), of the load 2 pi/3, does
    the work 4 pi^2/15 on a half-space.
    """
    growth = USUAL.half_space_growth
    lines = grid.graded(1.0, finest, size, growth=growth, until=1 + 2 * finest)
    r = _fine_within(reach, grid.towards_axis(lines, tip, growth))
    z = grid.geometric(size, min(finest, tip), growth)[1:]
    body = discretise(box(r, z), degree, [(poisson, 1.0)], plate=True)
    pressure = np.sqrt(np.maximum(1 - body.radii**2, 0))
    return _with_rigid(_on_ground(body, pressure, 2 * np.pi / 3, 4 * np.pi**2 / 15))


def scaled(body: Body, a: float) -> Body:
    """The same body a times as large: its stiffness grows as its size."""
    return Body(body.stiffness * a, body.values, body.radii * a, body.area * a**2, body.depths * a, body.rim * a)


def displaced(body: Body, tension: Array) -> Array:
    """Unknowns (n,) under a tension at the points: a(u, v) = int tension v_z dA for all v."""
    return np.asarray(body.factors(0 * tension).solve(body.forces(tension)))


def _fine_within(reach: float, lines: Array) -> Array:
    """Ends of cells, cut into equal parts where they are longer than a part of a distance within it."""
    counts = np.where(lines[:-1] < reach, np.ceil(np.diff(lines) / (USUAL.within * reach)), 1).astype(int)
    cells = zip(lines[:-1], lines[1:], counts, strict=True)
    return np.append(np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in cells]), lines[-1])


def _on_ground(body: Body, pressure: Array, load: float, work: float) -> Body:
    """A body on a plate, on a spring with which a pressure of this load does the work that it does on a half-space."""
    missed = 1 + (work - body.integral(pressure * body.rise(displaced(body, pressure)))) / load**2
    stiffness = body.stiffness.copy()
    stiffness[-1, -1] += 1 / missed - 1
    return replace(body, stiffness=stiffness)


def _with_rigid(body: Body, end: float = np.inf) -> Body:
    """Let the surface go on beyond the mesh to a radius: points that attract and do not yield.

    They are of Gauss's rule in s on r = rim/s^4, as little is far away.
    """
    first = (body.rim / end) ** 0.25
    s, ds = np.polynomial.legendre.leggauss(40)
    s, ds = 1 + (s - 1) * (1 - first) / 2, ds * (1 - first) / 2
    r = body.rim / s**4
    values = sparse.vstack([body.values, sparse.csr_array((r.size, body.values.shape[1]))], format="csr")
    area, depths = np.append(body.area, 2 * np.pi * r**2 * 4 * ds / s), np.append(body.depths, 0 * r)
    return replace(body, values=values, radii=np.append(body.radii, r), area=area, depths=depths)


# Bodies with a length


def _on_given_mesh(scene: Scene, degree: int, *_: float) -> Contact:
    """Contact of a user's mesh."""
    body = discretise(_given_mesh(scene), degree, scene.body.regions, slides=scene.body.held == "sliding")
    R, _ = lengths(scene)
    return Contact(body, scene.tabor, lambda _: R * body.depths, law_of(scene))


@lru_cache(maxsize=2)
def _given_mesh(scene: Scene) -> Any:
    """The mesh as it is, or of straight cells cut finer, with the contact on its smooth line.

    The vertices of triangles ascend, so that neighbours agree on the places along their sides.
    """
    mesh = scene.body.mesh(lengths(scene)[0], np.zeros(1), 0.0, Discretisation(USUAL.degrees[0]))
    mesh = refined(mesh) if is_straight(mesh) else mesh
    return type(mesh)(mesh.doflocs, np.sort(mesh.t, axis=0), mesh.boundaries) if isinstance(mesh, MeshTri) else mesh


def _sized(scene: Scene, degree: int, load: float, radius: float, reach: float) -> Contact:
    """Contact of one body or two, whose cells are finest at a radius."""
    R, bodies = lengths(scene)
    # The first body's, or where what attracts ends.
    R = bodies[0] if np.isfinite(bodies[0]) else min(R, scene.surface.end)
    radius, reach = (min(r, USUAL.widest * R) for r in (radius, reach))  # what attracts from afar may be wider
    finest = 2 * _finest(scene, radius) * radius / scene.scales.spike_width
    how = Discretisation(degree, finest, USUAL.growth, USUAL.rings)
    if isinstance(scene.body, Stratified) and scene.body.held == "substrate":
        how = replace(how, beyond=_clamped(scene, scene.body, load, R, radius))
    outer, coordinate = scene.body.layout(R, replace(how, rings=0) if scene.counter else how)
    length = finest_length(scene, how)
    lines = grid.graded(coordinate.of(radius), length, float(outer[0]), growth=USUAL.growth)
    lines = grid.towards_axis(lines, scene.surface.first_cell(USUAL.tip), USUAL.growth)
    core = _fine_within(coordinate.of(reach), lines)
    mesh = scene.body.mesh(R, core, length, how)
    if scene.counter:
        end, other = float(coordinate.radius(core[-1:])[0][0]), scene.counter
        meshes = (scene.body, mesh), (other, other.facing(bodies[1], core, length, R, how))
        first, second = (_standing(one, with_contact_to(its, end), degree) for one, its in meshes)
        body = _opposed(first, second, scene.share or 0.0)
    else:
        body = _standing(scene.body, mesh, degree)
    # Of a pair what lies between the last cell and the equator, of strata what lies beyond those that yield.
    body = _with_rigid(body, R) if scene.counter or scene.body.layered else body
    return Contact(body, scene.tabor, heights(scene), law_of(scene))


def _opposed(first: Body, second: Body, share: float) -> Body:
    """Two bodies that face each other at points of the same radii, the second with this share of the compliance."""
    a, b = (np.argsort(body.radii) for body in (first, second))
    values = sparse.csr_array(sparse.hstack([first.values[a], second.values[b]]))
    stiffness = sparse.csc_array(sparse.block_diag([first.stiffness / (1 - share), second.stiffness / share]))
    return Body(stiffness, values, first.radii[a], first.area[a], first.depths[a], first.rim)


def _clamped(scene: Scene, strata: Stratified, W: float, R: float, radius: float) -> float:
    """Size of a half-space under strata, as of `Discretisation.beyond`: W/(pi E L) at its end L is what a clamp omits.

    That is little beside eps and what W deflects within the contact. In one much larger the cells near its surface are
    so flat that rounding hides the force that the clamp bears.
    """
    yielding = float(surface_compliance(strata, np.array([1 / radius]))[0]) / (2 * radius)
    far = 1 / (np.pi * strata.beyond.modulus * USUAL.clamped * (1 / (scene.tabor * W) + yielding))
    return max(1 / STRATA.far_out, far / strata.spread(R))


def _standing(elastic: ElasticBody, mesh: Any, degree: int) -> Body:
    """Body as it is held."""
    slides, on_surface = elastic.held in ("sliding", "sheet"), elastic.material.area == "surface"
    body = discretise(mesh, degree, elastic.regions, slides=slides, plate=elastic.endless, on_surface=on_surface)
    if not elastic.endless:
        return body
    # On a half-space (1 - r^2/e^2)^(3/2), of the load 2 pi e^2/5, does the work 4 pi^2 e^3/35.
    e = body.rim
    pressure = np.maximum(1 - (body.radii / e) ** 2, 0) ** 1.5
    return _on_ground(body, pressure, 2 * np.pi * e**2 / 5, 4 * np.pi**2 * e**3 / 35)
