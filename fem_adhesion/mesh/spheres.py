"""Meshes of spheres, graded towards the contact: the hemisphere, bodies that face a smaller one, the whole sphere.

The stereographic map m(Z) = Z/(1 + i Z/2R) of the complex plane Z = x - i d takes the half-plane of depths d >= 0 to
the disc of radius R that touches it at the origin, the sphere's meridian section: the axis to the axis, the surface to
the circle, and the quarter disc |Z| < 2R to the quarter disc of the hemisphere. It is conformal, so cells well shaped
for a flat block are so for the sphere, and is the identity near the pole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from fem_adhesion.mesh.block import with_named_boundaries
from fem_adhesion.mesh.curved import CurvedQuads, Patch, joined, refined_towards
from halfspace.elastic import grid
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.values import Array, Index, Valued

CORE, DEPTH = 1.7, 0.9  # radius and depth of the core, a tensor grid about the pole, in R on the flat plane
LAYERS = 2  # cells between the core and the mid-plane
NO_RINGS = np.empty(0)


@dataclass(frozen=True, eq=False, repr=False)
class Lines(Valued):
    """Lines of one half of a sphere.

    x and depths, (m + 1,) and (n + 1,), are those of the core, a tensor grid on the flat plane; layers (LAYERS + 1,) go
    from the core (0) to the mid-plane (1). `along` is the coordinate on the flat plane as a function of x, in which
    cells are cut.
    """

    x: Array
    depths: Array
    layers: Array = field(default_factory=lambda: np.linspace(0, 1, LAYERS + 1))
    along: Callable[[Array], Array] = np.asarray

    def core(self, i: Array, j: Array) -> Array:
        """Points of the core at whole numbers of its lines, or between them."""
        x, depths = (np.interp(k, np.arange(len(lines)), lines) for k, lines in ((i, self.x), (j, self.depths)))
        return np.asarray(self.along(x) - 1j * depths)


def graded_depths(R: float, length: float, growth: float) -> Array:
    """Depths of the lines of a core, the first cell of a length in beta, the others the deeper the longer."""
    return grid.graded(0.0, length, DEPTH * R, growth=growth)


def even(R: float, m: int, n: int) -> Lines:
    """Evenly spaced lines, m + 1 and n + 1 of them in the core."""
    return Lines(np.linspace(0, CORE * R, m + 1), np.linspace(0, DEPTH * R, n + 1))


def hemisphere(
    R: float, lines: Array, depths: Array, along: Callable[[Array], Array] = np.asarray, rings: Array = NO_RINGS
) -> CurvedQuads:
    """Mesh the hemisphere z >= -R of the sphere of radius R in beta that touches z = 0 from below.

    Lines (m + 1,) and depths (n + 1,) are those of the core, a tensor grid on the flat plane, from 0 to CORE R and
    DEPTH R, in beta; `along` is the coordinate x as a function of another one in which the lines and the cells between
    them are given instead. Rings (k,) have sizes as `fem_adhesion.mesh.curved.refined_towards` takes them, around
    the equator: where a bonded mid-plane meets the free surface the stress is singular. The cells that are cut are as
    long as deep then; without rings they are as thin as the contact's. The boundaries are "axis", "contact" (the
    sphere) and "far" (the mid-plane).
    """
    m, n = len(lines), len(depths)
    own = Lines(lines, depths, along=along)
    met = even(R, m - 1, n - 1) if len(rings) else own
    mesh = joined(half_patches(R, own, met, stereographic), half_vertices(m, n, 0, m * n + (m + n - 1) * (LAYERS - 1)))
    if len(rings):
        mesh = refined_towards(mesh, vertex_at(mesh, R, -R), rings)
    above = -R * (1 - 1e-9)
    return named(mesh, lambda r, z: {"axis": r == 0, "contact": (r > 0) & (z > above), "far": (r > 0) & (z < above)})


def half_patches(R: float, own: Lines, met: Lines, onto: Callable[[Array, float], Array]) -> list[Patch]:
    """Patches of one half of a sphere, whose rays from the core to the mid-plane end where those of other lines would.

    They are cut at whole numbers, so that halves with different lines run along the mid-plane alike. No cell is turned
    over: the rays end on the circle 2R, inside whose tangents both cores lie, and beyond the sides of both.
    """

    def outwards(i: Array, j: Array, t: Array) -> Array:
        """Points between a side of the core (t = 0) and the circle 2R (t = 1)."""
        ray = met.core(i, j)
        return (1 - t) * own.core(i, j) + t * 2 * R * ray / np.abs(ray)

    m, n = len(own.x) - 1, len(own.depths) - 1
    i, j = np.arange(m + 1.0), np.arange(n + 1.0)
    return [
        Patch(i, j, lambda i, j: onto(own.core(i, j), R)),
        Patch(j, own.layers, lambda j, t: onto(outwards(np.array(m), j, t), R)),
        Patch(i, own.layers, lambda i, t: onto(outwards(i, np.array(n), t), R)),
    ]


def half_vertices(m: int, n: int, first: int, middle: int) -> list[Index]:
    """Numbers of the vertices of `half_patches` of m lines x and n depths; those on the mid-plane begin at `middle`."""
    core = first + np.arange(m * n).reshape(m, n)
    around = m + n - 1
    layers = first + m * n + np.arange(around * (LAYERS - 1)).reshape(around, LAYERS - 1)
    out = np.column_stack([np.append(core[-1], core[-2::-1, -1]), layers, middle + np.arange(around)])
    return [core, out[:n], out[: n - 2 : -1]]


def contact_ends(R: float, rings: Array) -> Array:
    """Ends of the cells of a sphere's surface from the core to the equator, in its coordinate, in beta."""
    ends = R * np.linspace(CORE, 2.0, LAYERS + 1)
    return np.concatenate([ends[:-1], ends[-1] - (ends[-1] - ends[-2]) * rings, ends[-1:]])


def stereographic(Z: Array, R: float) -> Array:
    """Return r and z of points of the flat plane: Z/(1 + i Z/2R)."""
    image = Z / (1 + 0.5j * Z / R)
    return np.array([image.real, image.imag])


def with_contact_to(mesh: Any, radius: float) -> Any:
    """Return a mesh with its boundary "contact" cut off at a radius where cells end; beyond, its surface is free."""
    facets = mesh.boundaries["contact"]
    inside = np.all(mesh.p[0, mesh.facets[:, facets]] <= radius * (1 + 1e-9), axis=0)
    return mesh.with_boundaries({"contact": facets[inside]})


def named(mesh: CurvedQuads, where: Callable[[Array, Array], dict[str, Any]]) -> CurvedQuads:
    """Name in place the boundary facets for which the masks, by name, hold at r and z of their middles.

    A facet on the axis has r = 0, whatever rounding left where cells were cut.
    """
    facets = mesh.boundary_facets()
    ends = mesh.p[:, mesh.facets[:, facets]]
    r, z = ends.mean(axis=1)
    masks = where(np.where(r < 1e-6 * np.hypot(*np.diff(ends, axis=1)[:, 0]), 0.0, r), z)
    # In place: a copy would number its facets again.
    mesh._boundaries = {name: facets[mask] for name, mask in masks.items()}
    return mesh


def vertex_at(mesh: CurvedQuads, r: float, z: float) -> int:
    """Number of the vertex at a place."""
    return int(np.argmin(np.hypot(mesh.p[0] - r, mesh.p[1] - z)))


# A body that faces a smaller sphere: its cells end at the same radii and have their nodes there too. The smaller sphere
# is given by its coordinate s, and its cells by their ends in it.


def hemisphere_over(lines: Array, depths: Array, R1: float, R2: float, rings: Array) -> Any:
    """Hemisphere of radius R2 whose cells end where those of R1 do, and beyond at its own core's end."""
    along = partial(_along, coordinate=_coordinate_on(R1, R2), last=float(lines[-1]))
    rest = CORE * R2 - float(along(lines[-1:])[0])
    beyond = _beyond(lines, rest) if rest > 1e-9 * R2 else lines[:0]
    return hemisphere(R2, np.concatenate([lines, beyond]), depths, along, rings)


def block_under(lines: Array, depths: Array, R1: float, size: float) -> Any:
    """Block whose cells end where those of the sphere do, and beyond at ever larger distances."""
    along = partial(_along, coordinate=_coordinate_on(R1, np.inf), last=float(lines[-1]))
    s = np.concatenate([lines, _beyond(lines, size)])
    vertices = np.arange(s.size * depths.size).reshape(s.size, -1)
    return with_named_boundaries(joined([Patch(s, depths, lambda s, d: np.array([along(s), -d]))], [vertices]))


def _beyond(lines: Array, length: float) -> Array:
    """Ends of more cells."""
    return np.asarray(lines[-1] + grid.geometric(length, float(lines[-1] - lines[-2]), 2.5)[1:])


def _coordinate_on(R1: float, R2: float) -> Callable[[Array], Array]:
    """Coordinate on the second surface, flat if R2 is infinite, of points at the first one's coordinate s."""
    first, second = SurfaceCoordinate(R1), SurfaceCoordinate(R2)
    return lambda s: second.along(first.radius(s)[0])


def _along(s: Array, *, coordinate: Callable[[Array], Array], last: float) -> Array:
    """The second surface's coordinate: shared with the first up to `last`, then as long as s is."""
    return coordinate(np.minimum(s, last)) + np.maximum(s - last, 0.0)


# The whole sphere, held over a cap around the point opposite the pole. The half that faces the wall is the hemisphere.
# The other is its mirror image with evenly spaced lines, as many, since they meet at the mid-plane. The line that ends
# nearest to the rim of the cap is moved there. At the rim the stress is singular, u ~ d^(1/2) with d the distance from
# it; there the cells are cut into rings.

RINGS = 0.2 ** np.arange(1.0, 8.0)  # sizes of the rings around the rim, in parts of the cells there; they err by 1e-9
COARSE = RINGS[:5]  # rings at the equator, which err by 1e-7: in smaller cells the slope of the contact is rounded off
# Ratio of the sizes of rings that lead to a rim close to the axis or the equator: with 0.2 a cap of 2 degrees takes one
# rung and three times the time more for the same numbers, 0.6 is no faster.
NESTED = 0.4


def held_sphere(R: float, x_lines: Array, depths: Array, cap_angle: float) -> CurvedQuads:
    """Mesh the sphere of radius R that touches z = 0 from below, held over a cap around the point opposite the pole.

    Lines and depths, (m + 1,) and (n + 1,), are of the core of the half that faces the wall, as those of
    `hemisphere`: on the flat plane from 0 to CORE R and DEPTH R; m is 2 or more, as the cap ends at one of the lines.
    Lengths are in beta; the half-angle of the cap is in degrees, 1 to 89.99, or 90. The boundaries are "axis",
    "contact" (the half that faces the wall) and "far" (the cap); the surface between them is free and belongs to none.
    Beyond the core the contact's cells end at `contact_ends` of `rings_at_equator`.
    """
    angle = np.radians(cap_angle)
    m, n = len(x_lines), len(depths)
    met, rim = even(R, m - 1, n - 1), _rim(R, cap_angle)
    far, own = _moved_to(rim, R, met), m * n + (m + n - 1) * (LAYERS - 1)
    patches = [*half_patches(R, Lines(x_lines, depths), met, stereographic), *half_patches(R, far, met, _mirrored)]
    mesh = joined(patches, [*half_vertices(m, n, 0, 2 * own), *half_vertices(m, n, own, 2 * own)])
    if len(past := _past(R, rim)):
        mesh = refined_towards(mesh, vertex_at(mesh, R, -R), past)
    elif rim < far.x[1] / 2:
        mesh = refined_towards(mesh, vertex_at(mesh, 0, -2 * R), _leading(rim / far.x[1]))
    rim_vertex = vertex_at(mesh, R * float(np.sin(angle)), -R * (1 + float(np.cos(angle))))
    return named(
        refined_towards(mesh, rim_vertex, COARSE if rim == 2 * R else RINGS),
        lambda r, z: {"axis": r == 0, "contact": (r > 0) & (z > -R), "far": (r > 0) & (np.arctan2(r, -R - z) < angle)},
    )


def rings_at_equator(R: float, cap_angle: float) -> Array:
    """Sizes of the rings around the equator: where the cap begins at it or near it; none elsewhere."""
    rim = _rim(R, cap_angle)
    return COARSE if rim == 2 * R else _past(R, rim)


def _mirrored(Z: Array, R: float) -> Array:
    """Return r and z of points of the flat plane that touches the sphere opposite the pole."""
    r, z = stereographic(Z, R)
    return np.array([r, -2 * R - z])


def _rim(R: float, cap_angle: float) -> float:
    """Rim of the cap on the flat plane."""
    return 2 * R * float(np.tan(np.radians(cap_angle / 2))) if cap_angle < 90 else 2 * R


def _moved_to(rim: float, R: float, lines: Lines) -> Lines:
    """Evenly spaced lines, of which the nearest to the rim ends there, unless that is the axis or the equator.

    Lines end in the core, at its side, or between its layers; in the core all others are evenly spaced on either side.
    """
    ends = np.append(lines.x, R * (CORE + (2 - CORE) * lines.layers[1:]))
    nearest, m = int(np.abs(ends - rim).argmin()), len(lines.x) - 1
    if not 0 < nearest < ends.size - 1:
        return lines
    if nearest <= m:
        last = rim if nearest == m else ends[m]
        return replace(lines, x=np.interp(np.arange(m + 1), [0, nearest, m], [0.0, rim, last]))
    layers = lines.layers.copy()
    layers[nearest - m] = (rim / R - CORE) / (2 - CORE)
    return replace(lines, layers=layers)


def _past(R: float, rim: float) -> Array:
    """Sizes of rings around the equator, the last of which ends at a rim close to it; none if it is not."""
    part = (2 - rim / R) * LAYERS / (2 - CORE)
    return _leading(part) if 0 < part < 0.5 else np.empty(0)


def _leading(part: float) -> Array:
    """Sizes of rings in parts of a cell, the last of the size given."""
    count = int(np.ceil(np.log(part) / np.log(NESTED)))
    return np.asarray(part ** (np.arange(1.0, count + 1) / count))
