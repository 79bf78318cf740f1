"""Sections and solids in cells of the second order: elements of high degree cut finely, and turned about the axis.

A quadrilateral becomes a hexahedron of 27 nodes, one with a side on the axis a wedge of 18, a triangle a wedge of 18.
A cell that touches the axis otherwise becomes one some of whose nodes coincide. Sides along the angle are parabolas:
over `SEGMENT` they leave the circle by less than 2e-4 of its radius, so that nothing is gained by linear cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree
from skfem import Basis, ElementQuad2, ElementTriP2, MeshQuad, MeshTri
from skfem.refdom import RefTri

from fem_adhesion.elasticity.space import Space
from fem_adhesion.elasticity.stress import positions, sampled
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued

MOST_CUTS = 12  # into which a side of an element is ever cut
SAME = 1e-3  # of the shortest distance between two nodes of a cell, within which points are one


def lattice(cuts: int, *, triangular: bool) -> Basis:
    """A reference element, a triangle or square, cut into n by n cells of the second order.

    It is a mesh of scikit-fem, whose elements number their nodes as VTK does: ``doflocs``, (2, k), are their places in
    the reference element, ``element_dofs``, (6 or 9, cells), those of each cell.
    """
    sides = np.linspace(0, 1, cuts + 1)
    if not triangular:
        return Basis(MeshQuad.init_tensor(sides, sides), ElementQuad2())
    square = MeshTri.init_tensor(sides, sides).scaled((-1, 1)).translated((1, 0))
    below = square.p[:, square.t].mean(axis=1).sum(axis=0) < 1
    return Basis(square.restrict(np.flatnonzero(below)), ElementTriP2())


@dataclass(frozen=True)
class Cut:
    """A body's elements cut into cells of the second order, each by a `lattice`."""

    space: Space
    lattice: Basis

    @cached_property
    def numbers(self) -> Index:
        """Number of each element's nodes among those of the whole body, (elements, k)."""
        r, z = positions(self.space, self.lattice.doflocs)
        region = np.broadcast_to(np.abs(z).max() * self.regions[:, None], r.shape)  # they do not share nodes
        points = np.stack([r.ravel(), z.ravel(), region.ravel()], axis=1)
        pairs = KDTree(points).query_pairs(SAME * self._shortest(r, z), output_type="ndarray")
        links = coo_array((np.ones(len(pairs)), pairs.T), shape=2 * (len(points),))
        return np.asarray(connected_components(links, directed=False)[1].reshape(r.shape), dtype=np.intp)

    @cached_property
    def regions(self) -> Index:
        """Number of the region of each element, (elements,): of those that do not share vertices."""
        mesh = self.space.mesh
        firsts = np.broadcast_to(mesh.t[0], mesh.t.shape)
        links = coo_array((np.ones(mesh.t.size), (mesh.t.ravel(), firsts.ravel())), shape=2 * (mesh.t.max() + 1,))
        part = connected_components(links, directed=False)[1][mesh.t[0]]
        return np.unique(part, return_inverse=True)[1]

    @property
    def node_regions(self) -> Index:
        """The same of each node."""
        repeated = np.broadcast_to(self.regions[:, None], self.numbers.shape)
        return np.asarray(repeated.ravel()[self.firsts])

    @cached_property
    def firsts(self) -> Index:
        """Where each node of the body first stands among those of all elements, (nodes,)."""
        return np.unique(self.numbers, return_index=True)[1]

    @property
    def cells(self) -> Index:
        """Nodes of each cell, (cells, 6 or 9), in VTK's order."""
        return np.concatenate(list(self.numbers[:, self.lattice.element_dofs.T]))

    @property
    def points(self) -> Array:
        """Radius and height of the nodes in beta, (2, nodes)."""
        return self._merged(positions(self.space, self.lattice.doflocs))

    def values(self, coefficients: Array) -> Array:
        """Values (m, nodes) of fields given by the coefficients (m, functions) of the space."""
        return self._merged(sampled(self.space, coefficients, self.lattice.doflocs))

    def _merged(self, values: Array) -> Array:
        return np.asarray(values.reshape(len(values), -1)[:, self.firsts])

    def _shortest(self, r: Array, z: Array) -> float:
        cells = self.lattice.element_dofs
        sides = [np.hypot(*(x[:, cells[0]] - x[:, cells[k]] for x in (r, z))).min() for k in (1, 2)]
        return float(min(sides)) / 2


def cut_for(space: Space, fields: Array, tolerance: float) -> Cut:
    """Cut elements as coarsely as fields and the shape of the body allow.

    Coefficients (m, functions) of the fields are taken together, as components of a vector. The tolerance is the
    largest error between the nodes, relative to the largest absolute value; for the shape, to the body's size.
    """
    triangular, cuts = space.element.refdom is RefTri, 1
    cells = lattice(cuts, triangular=triangular)
    while (error := _shown_error(space, fields, cells)) > tolerance and cuts < MOST_CUTS:
        wanted = int(np.ceil(cuts * np.cbrt(error / tolerance)))  # the error falls as their third power
        cuts = min(max(wanted, cuts + 1), MOST_CUTS)
        cells = lattice(cuts, triangular=triangular)
    return Cut(space, cells)


def _shown_error(space: Space, fields: Array, cells: Basis) -> float:
    """Error of the cells' polynomials at points half-way between their nodes."""
    places, shapes = _between(cells)
    errors = []
    for values, wanted in (
        (sampled(space, fields, cells.doflocs), sampled(space, fields, places)),
        (positions(space, cells.doflocs), positions(space, places)),
    ):
        shown = np.einsum("fesn,cn->fesc", values[:, :, cells.element_dofs.T], shapes).reshape(wanted.shape)
        errors.append(np.abs(shown - wanted).max() / np.abs(wanted).max())
    return float(max(errors))


def _between(cells: Basis) -> tuple[Array, Array]:
    """Points of the reference element half-way between nodes of the cells, cell by cell, and shapes (c, n) there."""
    X = np.array([*product((0.25, 0.5, 0.75), repeat=2), (0.0, 0.25), (0.0, 0.75), (0.25, 0.0), (0.75, 0.0)]).T
    X = X[:, X.sum(axis=0) <= 1] if cells.elem.refdom is RefTri else X
    shapes = np.stack([cells.elem.lbasis(X, i)[0] for i in range(cells.Nbfun)], axis=1)
    return cells.mapping.F(X).reshape(2, -1), shapes


SEGMENT = 15.0  # largest angle of a cell in degrees
HEXAHEDRON27, WEDGE18 = 29, 32  # VTK's numbers of cell types
ON_AXIS = 1e-12  # radius, in the largest, below which a node does not move with the angle


def _layered(*groups: tuple[int, Sequence[int]]) -> Index:
    """Layer in the angle, and node of the section's cell, of each node of the solid's, in VTK's order, by groups."""
    return np.array([(layer, node) for layer, nodes in groups for node in nodes])


_HEXAHEDRON_OF_QUAD9 = _layered(
    *((0, range(4)), (2, range(4)), (0, range(4, 8)), (2, range(4, 8)), (1, range(4))),
    *((1, (7, 5, 4, 6)), (0, (8,)), (2, (8,)), (1, (8,))),
)
_WEDGE_OF_TRIANGLE6 = _layered(*((0, range(3)), (2, range(3)), (0, range(3, 6)), (2, range(3, 6)), (1, range(6))))
# A quadrilateral whose side from its first to its last corner is on the axis: its rows (3, 6, 2), (0, 4, 1) and between
# them (7, 8, 5), from the axis outwards, are triangles, and the axis points to the top.
_WEDGE_ON_AXIS = _layered(
    *((0, (3, 2)), (2, (2,)), (0, (0, 1)), (2, (1,))),
    *((0, (6,)), (1, (2,)), (2, (6,)), (0, (4,)), (1, (1,)), (2, (4,))),
    *((0, (7, 5)), (2, (5,)), (0, (8,)), (1, (5,)), (2, (8,))),
)

_MIRRORED = {6: [0, 2, 1, 5, 4, 3], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}  # nodes of a cell in the opposite sense


@dataclass(frozen=True, eq=False, repr=False)
class Solid(Valued):
    """A solid of revolution about z, its points (nodes, 3) in beta, its cells by VTK's type.

    Each node has its angle in radians, and the node of the section, on the meridian, that it came from.
    """

    angles: Array
    meridian: Index
    points: Array
    cells: dict[int, Index]

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
    """Turn a section about its axis: r and z of its nodes, (2, n) in beta, its cells, (m, 6 or 9).

    Cells are triangles or quadrilaterals; the angle of the wedge is in degrees, and 360 closes the solid, or InputError
    as by `require_angle`.
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
    if cells.shape[1] == 6:
        return [(WEDGE18, _WEDGE_OF_TRIANGLE6, cells)]
    first = np.arange(4)
    on_axis = axial[cells[:, first]] & axial[cells[:, (first + 3) % 4]]
    beside = on_axis.any(axis=1)
    turns = (on_axis[beside].argmax(axis=1)[:, None] + first) % 4
    nodes = np.concatenate([turns, 4 + turns, np.full((len(turns), 1), 8)], axis=1)
    wedges = np.take_along_axis(cells[beside], nodes, axis=1)
    return [(WEDGE18, _WEDGE_ON_AXIS, wedges), (HEXAHEDRON27, _HEXAHEDRON_OF_QUAD9, cells[~beside])]
