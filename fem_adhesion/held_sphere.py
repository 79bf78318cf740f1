"""Mesh of the whole sphere held over a cap around the point opposite the pole, graded towards the contact and the rim.

The half that faces the wall is the hemisphere of `fem_adhesion.bodies`. The other half is its mirror image with lines
of its own: as many, since they meet at the mid-plane, but spread over the cap and the free surface beside it. At the
rim of the cap the stress is singular, u ~ d^(1/2) with d the distance from the rim; there the cells are cut into rings.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fem_adhesion.bodies import CORE, DEPTH, LAYERS, stereographic
from fem_adhesion.curved import Block, CurvedQuads, joined
from fem_adhesion.nested import refined_towards
from halfspace.compliance import Array, Index
from halfspace.errors import InputError
from halfspace.limits import require_cap_angle
from halfspace.values import Valued

RINGS = 0.2 ** np.arange(1.0, 8.0)
"""Sizes of the rings around the rim of the cap, in parts of the cells there; what is left errs by some 1e-9."""

COARSE = RINGS[:5]
"""The same around the equator: in smaller cells of the contact, its slope there is lost to rounding; errs by 1e-7."""

IN_CORE = 1.4
"""Largest rim, in R on the flat plane, that lies in the core of the far half; a larger one lies between its layers."""

NARROW = 1.2
"""Radius of the core in R where the rim is outside."""

SHALLOW = 0.25
"""Least depth of the cells under the surface in R where the rim is outside the core."""

REACH = 0.5
"""Distance from the rim within which lines are evenly spaced, in parts of that to the nearer end of the core."""

STEEPEST = 2.5
"""Most that lines grow from one to the next on their way to the rim of a small cap; rings lead to it otherwise."""

NEAREST, NESTED = 0.7, 0.4
"""Most that its rim is from the axis then, or else from the equator, in cells; and ratio of the rings' sizes."""


@dataclass(frozen=True, eq=False, repr=False)
class _Lines(Valued):
    """Lines of one half.

    Attributes
    ----------
    x, depths : (m + 1,) and (n + 1,) array
        Of the core, a tensor grid on the flat plane.
    layers : (LAYERS + 1,) array
        From the core (0) to the mid-plane (1).
    """

    x: Array
    depths: Array
    layers: Array


def held_sphere(R: float, x_lines: Array, depths: Array, cap_angle: float) -> CurvedQuads:
    """Mesh the sphere that touches z = 0 from below, held over a cap around the point opposite the pole.

    Parameters
    ----------
    R : float
        Radius in beta.
    x_lines, depths : (m + 1,) and (n + 1,) array
        Lines of the core of the half that faces the wall, as those of `fem_adhesion.bodies.hemisphere`: on the flat
        plane from 0 to CORE R and DEPTH R, in beta.
    cap_angle : float
        Half-angle of the cap in degrees, 1 to 89.99, or 90.

    Returns
    -------
    CurvedQuads
        With the boundaries "axis", "contact" (the half that faces the wall) and "far" (the cap); the surface between
        them is free and belongs to none. The contact's cells end at `contact_ends` beyond the core.

    Raises
    ------
    InputError
        If cap_angle is out of range, or x_lines are fewer than three.
    """
    angle = np.radians(require_cap_angle(cap_angle))
    if len(x_lines) < 3:
        raise InputError(f"x_lines = {x_lines} are {len(x_lines)}, limit 3: the cap ends at one of them; give more")
    rim = _rim(R, cap_angle)
    near = _Lines(x_lines, depths, np.linspace(0, 1, LAYERS + 1))
    far = _far_lines(R, len(x_lines) - 1, len(depths) - 1, rim)
    near_vertices, far_vertices = _vertices(len(x_lines), len(depths))
    met = _Lines(np.linspace(0, CORE * R, len(x_lines)), far.depths, far.layers)
    blocks = [*_blocks(R, near, met, stereographic), *_blocks(R, far, met, _mirrored)]
    mesh = joined(blocks, [*near_vertices, *far_vertices])
    if len(past := _past(R, rim)):
        mesh = refined_towards(mesh, _vertex_at(mesh, R, -R), past)
    elif rim < NEAREST * far.x[1]:
        mesh = refined_towards(mesh, _vertex_at(mesh, 0, -2 * R), _leading(rim / far.x[1]))
    rim_vertex = _vertex_at(mesh, R * float(np.sin(angle)), -R * (1 + float(np.cos(angle))))
    return _named(refined_towards(mesh, rim_vertex, COARSE if rim == 2 * R else RINGS), R, angle)


def contact_ends(R: float, cap_angle: float) -> Array:
    """Ends of the contact's cells from the core to the equator, in the surface's coordinate, in beta.

    Those of the hemisphere, and where the cap begins near the equator or at it those of rings around there.
    """
    ends, rim = R * np.linspace(CORE, 2.0, LAYERS + 1), _rim(R, cap_angle)
    rings = COARSE if rim == ends[-1] else _past(R, rim)
    return np.concatenate([ends[:-1], ends[-1] - (ends[-1] - ends[-2]) * rings, ends[-1:]])


def _blocks(R: float, own: _Lines, met: _Lines, onto: Callable[[Array, float], Array]) -> list[Block]:
    """Blocks of a half with lines of its own, that meet those of the other half on rays to the ends of others.

    They are cut at whole numbers, so that halves with different lines run along the mid-plane alike. No cell is turned
    over: the rays end on the circle 2R, inside whose tangents both cores lie, and beyond the sides of both.
    """

    def across(lines: Array, i: Array) -> Array:
        return np.interp(i, np.arange(len(lines)), lines)

    def core(lines: _Lines, i: Array, j: Array) -> Array:
        return across(lines.x, i) - 1j * across(lines.depths, j)

    def outwards(i: Array, j: Array, t: Array) -> Array:
        """Points between a side of the core (t = 0) and the circle 2R (t = 1)."""
        ray = core(met, i, j)
        return (1 - t) * core(own, i, j) + t * 2 * R * ray / np.abs(ray)

    m, n = len(own.x) - 1, len(own.depths) - 1
    i, j = np.arange(m + 1.0), np.arange(n + 1.0)
    return [
        Block(i, j, lambda i, j: onto(core(own, i, j), R)),
        Block(j, own.layers, lambda j, t: onto(outwards(np.array(m), j, t), R)),
        Block(i, own.layers, lambda i, t: onto(outwards(i, np.array(n), t), R)),
    ]


def _mirrored(Z: Array, R: float) -> Array:
    """Return r and z of points of the flat plane that touches the sphere opposite the pole."""
    r, z = stereographic(Z, R)
    return np.array([r, -2 * R - z])


def _vertices(m: int, n: int) -> tuple[list[Index], list[Index]]:
    """Numbers of the vertices of the blocks of both halves, for m lines x and n depths; they share the mid-plane."""
    around = m + n - 1
    own = m * n + around * (LAYERS - 1)

    def half(first: int) -> list[Index]:
        core = first + np.arange(m * n).reshape(m, n)
        layers = first + m * n + np.arange(around * (LAYERS - 1)).reshape(around, LAYERS - 1)
        out = np.column_stack([np.append(core[-1], core[-2::-1, -1]), layers, 2 * own + np.arange(around)])
        return [core, out[:n], out[: n - 2 : -1]]

    return half(0), half(own)


def _far_lines(R: float, m: int, n: int, rim: float) -> _Lines:
    """Lines of the half with the cap, m and n cells, of which one ends at its rim: in the core, or beside it.

    If the lines are too few for a small cap, they are evenly spaced.
    """
    even = _Lines(np.linspace(0, CORE * R, m + 1), np.linspace(0, DEPTH * R, n + 1), np.linspace(0, 1, LAYERS + 1))
    if rim < NEAREST * even.x[1] and _steps(rim, CORE * R).sum() > m * np.log(STEEPEST):
        return even
    if rim <= IN_CORE * R:
        return replace(even, x=_about(rim, CORE * R, m), depths=_spread(DEPTH * R, n, _reach(rim, CORE * R)))
    depths = np.append(0, np.linspace(max(DEPTH / n, SHALLOW), DEPTH, n)) * R
    if rim == 2 * R or len(_past(R, rim)):
        return replace(even, depths=depths)
    layers = np.append(np.linspace(0, (rim / R - NARROW) / (2 - NARROW), LAYERS), 1.0)
    return _Lines(np.linspace(0, NARROW * R, m + 1), depths, layers)


def _rim(R: float, cap_angle: float) -> float:
    """Rim of the cap on the flat plane."""
    return 2 * R * float(np.tan(np.radians(cap_angle / 2))) if cap_angle < 90 else 2 * R


def _past(R: float, rim: float) -> Array:
    """Sizes of rings around the equator, the last of which ends at a rim close to it; none if it is not."""
    part = (2 - rim / R) * LAYERS / (2 - CORE)
    return _leading(part) if 0 < part < NEAREST else np.empty(0)


def _leading(part: float) -> Array:
    """Sizes of rings in parts of a cell, the last of the size given."""
    count = int(np.ceil(np.log(part) / np.log(NESTED)))
    return np.asarray(part ** (np.arange(1.0, count + 1) / count))


def _about(rim: float, end: float, count: int) -> Array:
    """Lines of `count` cells from 0 to `end`, one of them at the rim."""
    reach, (inside, outside) = _reach(rim, end), _steps(rim, end)
    cells = int(np.clip(np.rint(count * inside / (inside + outside)), 1, count - 1))
    inner = rim - _spread(rim, cells, reach)[::-1]
    inner[0] = 0.0  # not what rounding leaves of it
    return np.concatenate([inner[:-1], rim + _spread(end - rim, count - cells, reach)])


def _steps(rim: float, end: float) -> Array:
    """How many lines fit between the axis and the rim, and between that and the end, by the logarithm of growth."""
    return np.log1p(np.array([rim, end - rim]) / _reach(rim, end))


def _reach(rim: float, end: float) -> float:
    """Distance from the rim within which lines are evenly spaced."""
    return REACH * min(rim, end - rim)


def _spread(length: float, count: int, reach: float) -> Array:
    """Lines from 0 to `length`, evenly spaced as far as `reach` and geometrically from there on."""
    return np.asarray(reach * np.expm1(np.linspace(0, np.log1p(length / reach), count + 1)))


def _vertex_at(mesh: CurvedQuads, r: float, z: float) -> int:
    """Number of the vertex at a place."""
    return int(np.argmin(np.hypot(mesh.p[0] - r, mesh.p[1] - z)))


def _named(mesh: CurvedQuads, R: float, cap: float) -> CurvedQuads:
    """Name the boundary facets by the places of their chords' middles; the cap's half-angle is in radians."""
    facets = mesh.boundary_facets()
    r, z = mesh.p[:, mesh.facets[:, facets]].mean(axis=1)
    of = {"axis": r == 0, "contact": (r > 0) & (z > -R), "far": (r > 0) & (np.arctan2(r, -R - z) < cap)}
    named: CurvedQuads = mesh.with_boundaries({name: facets[those] for name, those in of.items()})
    return named
