"""A meridian section of second-order cells turned about its axis into a solid of second-order cells.

A quadrilateral becomes a hexahedron of 27 nodes, one with a side on the axis a wedge of 18, a triangle a wedge of 18.
A cell that touches the axis otherwise becomes one some of whose nodes coincide. Sides along the angle are parabolas:
over `SEGMENT` they leave the circle by less than 2e-4 of its radius, so that nothing is gained by linear cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued

SEGMENT = 15.0
"""Largest angle of a cell in degrees."""

HEXAHEDRON27, WEDGE18 = 29, 32
"""VTK's numbers of cell types."""

ON_AXIS = 1e-12
"""Radius, in the largest, below which a node does not move with the angle."""


def _on_layer(layer: int, nodes: range) -> list[tuple[int, int]]:
    return [(layer, node) for node in nodes]


def _wedge_on_axis() -> list[tuple[int, int]]:
    """Wedge of a quadrilateral whose side from its first to its last corner is on the axis: its rows are triangles."""
    bottom, top, middle = (3, 6, 2), (0, 4, 1), (7, 8, 5)  # rows, from the axis outwards; the axis points to the top
    corners, sides = ((0, 0), (0, 2), (2, 2)), ((0, 1), (1, 2), (2, 1))  # layer, and place in the row
    ends = [(layer, row[place]) for part in (corners, sides) for row in (bottom, top) for layer, place in part]
    return ends + [(layer, middle[place]) for part in (corners, sides) for layer, place in part]


_HEXAHEDRON_OF_QUAD9 = np.array(
    [
        *(*_on_layer(0, range(4)), *_on_layer(2, range(4))),
        *(*_on_layer(0, range(4, 8)), *_on_layer(2, range(4, 8)), *_on_layer(1, range(4))),
        *((1, 7), (1, 5), (1, 4), (1, 6), (0, 8), (2, 8), (1, 8)),
    ]
)
"""Layer in the angle, and node of the section's cell, of each node of the solid's, in VTK's order."""

_WEDGE_OF_TRIANGLE6 = np.array(
    [
        *(*_on_layer(0, range(3)), *_on_layer(2, range(3))),
        *(*_on_layer(0, range(3, 6)), *_on_layer(2, range(3, 6)), *_on_layer(1, range(6))),
    ]
)

_WEDGE_ON_AXIS = np.array(_wedge_on_axis())

_MIRRORED = {6: [0, 2, 1, 5, 4, 3], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}
"""Nodes of a cell in the opposite sense."""


@dataclass(frozen=True, eq=False, repr=False)
class Solid(Valued):
    """A solid of revolution.

    Attributes
    ----------
    angles : (nodes,) array
        Of each node, in radians.
    meridian : (nodes,) int array
        Node of the section that each came from.
    points : (nodes, 3) array
        In beta; the axis is z.
    cells : mapping of int to (cells, n) int array
        Nodes of the cells by VTK's type.
    """

    angles: Array
    meridian: Index
    points: Array
    cells: dict[int, Index]

    def scalars(self, values: Array) -> Array:
        """Values (nodes, ...) of fields (section, ...) that do not turn with the angle."""
        return np.asarray(values[self.meridian])

    def vectors(self, values: Array) -> Array:
        """Cartesian components (nodes, 3) of vectors (section, 3) given where the angle is zero."""
        c, s = np.cos(self.angles), np.sin(self.angles)
        r, _, z = values[self.meridian].T
        return np.stack([c * r, s * r, z], axis=1)

    def tensors(self, values: Array) -> Array:
        """Components xx, yy, zz, xy, yz, xz (nodes, 6) of tensors rr, tt, zz, rt, tz, rz (section, 6)."""
        c, s = np.cos(self.angles), np.sin(self.angles)
        rr, tt, zz, _, _, rz = values[self.meridian].T
        xx, yy, xy = c**2 * rr + s**2 * tt, s**2 * rr + c**2 * tt, c * s * (rr - tt)
        return np.stack([xx, yy, zz, xy, s * rz, c * rz], axis=1)


def revolved(points: Array, cells: Index, degrees: float) -> Solid:
    """Turn a section about its axis.

    Parameters
    ----------
    points : (2, n) array
        r and z of its nodes, in beta.
    cells : (m, 6 or 9) int array
        Its triangles or quadrilaterals.
    degrees : float
        Angle of the wedge; 360 closes the solid.

    Raises
    ------
    InputError
        Unless 0 < degrees <= 360.
    """
    require_angle(degrees)
    layers = 2 * int(np.ceil(degrees / SEGMENT - 1e-9)) + 1
    axial = points[0] <= ON_AXIS * points[0].max()
    numbers, layer, meridian = _numbered(axial, layers, closed=degrees == 360)
    angles = np.radians(degrees) * layer / (layers - 1)
    r, z = points[:, meridian]
    solid: dict[int, Index] = {}
    for kind, table, sections in _kinds(axial, _clockwise(points, cells)):
        turned = [numbers[first + table[:, 0], sections[:, table[:, 1]]] for first in range(0, layers - 1, 2)]
        solid[kind] = np.concatenate(turned)
    return Solid(angles, meridian, np.stack([r * np.cos(angles), r * np.sin(angles), z], axis=1), solid)


def require_angle(degrees: float) -> None:
    """Raise InputError unless 0 < degrees <= 360."""
    if not 0 < degrees <= 360:
        raise InputError(f"revolve = {degrees:g} is outside 0 < revolve <= 360; give degrees, 360 for the whole solid")


def _numbered(axial: NDArray[np.bool_], layers: int, *, closed: bool) -> tuple[Index, Index, Index]:
    """Numbers (layers, n) of the section's nodes in each layer; layer and section's node of each number."""
    copies = np.tile(np.arange(axial.size), (layers, 1)) + axial.size * np.arange(layers)[:, None]
    copies[:, axial] = copies[0, axial]
    if closed:
        copies[-1] = copies[0]
    kept, numbers = np.unique(copies, return_inverse=True)
    return numbers.reshape(copies.shape), kept // axial.size, kept % axial.size


def _clockwise(points: Array, cells: Index) -> Index:
    """Cells of a section all in the sense from z to r, seen from which the angle ascends away."""
    r, z = points[:, cells[:, : cells.shape[1] // 2]]  # 3 corners of 6 nodes, 4 of 9
    area = np.sum(r * np.roll(z, -1, axis=1) - z * np.roll(r, -1, axis=1), axis=1)
    return np.where(area[:, None] > 0, cells[:, _MIRRORED[cells.shape[1]]], cells)


def _kinds(axial: NDArray[np.bool_], cells: Index) -> list[tuple[int, Index, Index]]:
    """VTK's type, table and cells of each kind of solid cell."""
    if cells.shape[1] == len(_MIRRORED[6]):
        return [(WEDGE18, _WEDGE_OF_TRIANGLE6, cells)]
    first = np.arange(4)
    on_axis = axial[cells[:, first]] & axial[cells[:, (first + 3) % 4]]
    beside = on_axis.any(axis=1)
    turns = (on_axis[beside].argmax(axis=1)[:, None] + first) % 4
    nodes = np.concatenate([turns, 4 + turns, np.full((len(turns), 1), 8)], axis=1)
    wedges = np.take_along_axis(cells[beside], nodes, axis=1)
    return [(WEDGE18, _WEDGE_ON_AXIS, wedges), (HEXAHEDRON27, _HEXAHEDRON_OF_QUAD9, cells[~beside])]
