"""Meshes of a body that faces a smaller sphere: its cells end at the same radii and have their nodes there too.

The smaller sphere is given by its coordinate s, and its cells by their ends in it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.curved import Block, joined
from halfspace.elastic import grid
from halfspace.values import Array

GROWTH = 2.5  # ratio of neighbouring cells beyond those of the smaller body


def hemisphere_over(lines: Array, depths: Array, R1: float, R2: float, rings: Array) -> Any:
    """Hemisphere of radius R2 whose cells end where those of R1 do, and beyond at its own core's end."""
    along = partial(_along, coordinate=_coordinate_on(R1, R2), last=float(lines[-1]))
    rest = spheres.CORE * R2 - float(along(lines[-1:])[0])
    beyond = _beyond(lines, rest) if rest > 1e-9 * R2 else lines[:0]
    return spheres.hemisphere(R2, np.concatenate([lines, beyond]), depths, along, rings)


def block(lines: Array, depths: Array, R1: float, size: float) -> Any:
    """Block whose cells end where those of the sphere do, and beyond at ever larger distances."""
    along = partial(_along, coordinate=_coordinate_on(R1, np.inf), last=float(lines[-1]))
    s = np.concatenate([lines, _beyond(lines, size)])
    vertices = np.arange(s.size * depths.size).reshape(s.size, -1)
    return spheres.named_block(joined([Block(s, depths, lambda s, d: np.array([along(s), -d]))], [vertices]))


def _beyond(lines: Array, length: float) -> Array:
    """Ends of more cells."""
    return np.asarray(lines[-1] + grid.geometric(length, float(lines[-1] - lines[-2]), GROWTH)[1:])


def _coordinate_on(R1: float, R2: float) -> Callable[[Array], Array]:
    """Coordinate on the second surface, flat if R2 is infinite, of points at the first one's coordinate s."""

    def coordinate(s: Array) -> Array:
        r = spheres.Stereographic(R1).radius(s)[0]
        sine = r / R2
        return np.asarray(2 * r / (1 + np.sqrt((1 - sine) * (1 + sine))))

    return coordinate


def _along(s: Array, *, coordinate: Callable[[Array], Array], last: float) -> Array:
    """The second surface's coordinate: shared with the first up to `last`, then as long as s is."""
    return coordinate(np.minimum(s, last)) + np.maximum(s - last, 0.0)
