"""Mesh of the whole sphere held over a cap around the point opposite the pole, graded towards the contact and the rim.

The half that faces the wall is the hemisphere of `fem_adhesion.mesh.spheres`. The other half is its mirror image with
lines of its own: as many, since they meet at the mid-plane, but spread over the cap and the free surface beside it. At
the rim of the cap the stress is singular, u ~ d^(1/2) with d the distance from the rim; there the cells are cut into
rings.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_adhesion.mesh.curved import CurvedQuads, joined, refined_towards
from fem_adhesion.mesh.spheres import (
    CORE,
    DEPTH,
    LAYERS,
    Lines,
    even,
    half_patches,
    half_vertices,
    named,
    stereographic,
    vertex_at,
)
from halfspace.errors import InputError
from halfspace.limits import require_cap_angle
from halfspace.values import Array

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


def held_sphere(R: float, x_lines: Array, depths: Array, cap_angle: float) -> CurvedQuads:
    """Mesh the sphere of radius R that touches z = 0 from below, held over a cap around the point opposite the pole.

    Lines and depths, (m + 1,) and (n + 1,), are of the core of the half that faces the wall, as those of
    `fem_adhesion.mesh.spheres.hemisphere`: on the flat plane from 0 to CORE R and DEPTH R. Lengths are in beta; the
    half-angle of the cap is in degrees, 1 to 89.99, or 90. The boundaries are "axis", "contact" (the half that faces
    the wall) and "far" (the cap); the surface between them is free and belongs to none. Beyond the core the contact's
    cells end at `fem_adhesion.mesh.spheres.contact_ends` of `rings_at_equator`. InputError if cap_angle is out of
    range, or x_lines are fewer than three.
    """
    angle = np.radians(require_cap_angle(cap_angle))
    if len(x_lines) < 3:
        raise InputError(f"x_lines = {x_lines} are {len(x_lines)}, limit 3: the cap ends at one of them; give more")
    rim = _rim(R, cap_angle)
    m, n = len(x_lines), len(depths)
    near, far = Lines(x_lines, depths), _far_lines(R, m - 1, n - 1, rim)
    met = Lines(np.linspace(0, CORE * R, m), far.depths)
    own = m * n + (m + n - 1) * (LAYERS - 1)
    patches = [*half_patches(R, near, met, stereographic), *half_patches(R, far, met, _mirrored)]
    mesh = joined(patches, [*half_vertices(m, n, 0, 2 * own), *half_vertices(m, n, own, 2 * own)])
    if len(past := _past(R, rim)):
        mesh = refined_towards(mesh, vertex_at(mesh, R, -R), past)
    elif rim < NEAREST * far.x[1]:
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


def _far_lines(R: float, m: int, n: int, rim: float) -> Lines:
    """Lines of the half with the cap, m and n cells, of which one ends at its rim: in the core, or beside it.

    If the lines are too few for a small cap, they are evenly spaced.
    """
    plain = even(R, m, n)
    if rim < NEAREST * plain.x[1] and _steps(rim, CORE * R).sum() > m * np.log(STEEPEST):
        return plain
    if rim <= IN_CORE * R:
        return replace(plain, x=_about(rim, CORE * R, m), depths=_spread(DEPTH * R, n, _reach(rim, CORE * R)))
    depths = np.append(0, np.linspace(max(DEPTH / n, SHALLOW), DEPTH, n)) * R
    if rim == 2 * R or len(_past(R, rim)):
        return replace(plain, depths=depths)
    layers = np.append(np.linspace(0, (rim / R - NARROW) / (2 - NARROW), LAYERS), 1.0)
    return Lines(np.linspace(0, NARROW * R, m + 1), depths, layers)


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
