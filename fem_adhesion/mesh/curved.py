"""Quadrilaterals with curved sides: each cell is the polynomial through points of an exact map.

Isoparametric cells of scikit-fem are quadratic; a sphere in cells as long as its radius asks for more. Here the degree
of the cells' shape is free, so that the sphere is as good as exact and the element's degree alone decides the error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebvander
from skfem import MeshQuad
from skfem.mapping import MappingIsoparametric

from halfspace.values import Array, Index, Valued

DEGREE = 8  # degree of the cells' shape: an arc of one radian deviates from the circle by 1e-10 of its radius

CORNERS = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]])  # of the reference square, in scikit-fem's order


@dataclass(frozen=True, eq=False, repr=False)
class Patch(Valued):
    """A structured patch of (m, n) cells: the exact map of a rectangle that is cut at s (m + 1,) and t (n + 1,).

    place(s, t) returns r and z of points of the rectangle, (2, ...).
    """

    s: Array
    t: Array
    place: Callable[[Array, Array], Array]

    def points(self) -> Array:
        """Points (2, m n, (DEGREE + 1)^2) that shape the cells; the first parameter runs slowest in both counts."""
        local = chebyshev_points(DEGREE)
        s = self.s[:-1, None] + np.diff(self.s)[:, None] * local
        t = self.t[:-1, None] + np.diff(self.t)[:, None] * local
        placed = self.place(*np.broadcast_arrays(s[:, None, :, None], t[None, :, None, :]))
        return np.asarray(placed.reshape(2, len(s) * len(t), -1))


class CurvedMapping(MappingIsoparametric):  # type: ignore[misc]
    """Map from the reference square to cells of a mesh, each shaped by a tensor grid of points.

    Points (2, cells, (k + 1)^2) are the places of the k + 1 by k + 1 Chebyshev points of each cell.
    """

    def __init__(self, mesh: Any, points: Array) -> None:
        super().__init__(mesh, mesh.elem())
        self.points = points
        self.degree = round(np.sqrt(points.shape[2])) - 1

    def Fmap(self, i: int, X: Array, tind: Any = None) -> Array:
        """Coordinate i of points of the cells."""
        values, _ = shapes(self.degree, X)
        return self._sum(i, values, tind)

    def _J(self, i: int, j: int, X: Array, tind: Any = None) -> Array:
        _, derivatives = shapes(self.degree, X)
        return self._sum(i, derivatives[j], tind)

    def _sum(self, i: int, shapes: Array, tind: Any) -> Array:
        points = self.points[i] if tind is None else self.points[i][tind]
        return np.asarray(points @ shapes if shapes.ndim == 2 else np.einsum("cn,ncq->cq", points, shapes))

    def bndmap(self, i: int, X: Array, find: Any = None) -> Array:
        """Coordinate i of points of facets, which run from their first vertex to their second."""
        Y, _, cells = self._on_cell(X, find)
        return self.Fmap(i, Y, cells)

    def bndJ(self, i: int, j: int, X: Array, find: Any = None) -> Array:  # noqa: ARG002 (a facet has one direction)
        """Derivative of coordinate i along facets."""
        Y, along, cells = self._on_cell(X, find)
        return np.asarray(sum(self._J(i, k, Y, cells) * along[k][:, None] for k in range(2)))

    def _on_cell(self, X: Array, find: Any) -> tuple[Array, Array, Index]:
        """Facet points as points (2, facets, q) of the reference square, the facets' directions there, their cells."""
        cells = self.mesh.f2t[0, find]
        corners = (np.argmax(self.mesh.t[:, cells] == vertices, axis=0) for vertices in self.mesh.facets[:, find])
        start, end = (CORNERS[:, corner] for corner in corners)
        return start[:, :, None] + (end - start)[:, :, None] * X[0], end - start, cells


@dataclass(repr=False)
class CurvedQuads(MeshQuad):  # type: ignore[misc]
    """Quadrilaterals whose sides are curved; everything else sees their corners."""

    points: Any = None

    def _mapping(self) -> CurvedMapping:
        if not hasattr(self, "_cached_mapping"):
            self._cached_mapping = CurvedMapping(self, self.points)
        return self._cached_mapping


def joined(patches: list[Patch], corners: list[Index]) -> CurvedQuads:
    """Mesh of patches of (m, n) cells that share vertices.

    Corners (m + 1, n + 1) are the numbers of the vertices of each patch; neighbours share those of their common side.
    """
    points = np.concatenate([patch.points() for patch in patches], axis=1)
    cells = [np.array([v[:-1, :-1], v[1:, :-1], v[1:, 1:], v[:-1, 1:]]).reshape(4, -1) for v in corners]
    return of_cells(np.concatenate(cells, axis=1), points)


def of_cells(t: Index, points: Array) -> CurvedQuads:
    """Mesh of cells with the vertices t (4, cells) and the shape of points (2, cells, (DEGREE + 1)^2)."""
    p = np.empty((2, t.max() + 1))
    for local, (s, u) in enumerate(CORNERS.T.astype(int) * DEGREE):
        p[:, t[local]] = points[:, :, s * (DEGREE + 1) + u]
    return CurvedQuads(p, t, points=points)


def shapes(degree: int, X: Array) -> tuple[Array, tuple[Array, Array]]:
    """Products of Lagrange polynomials at reference points (2, ...), and their two derivatives."""
    (a, da), (b, db) = (lagrange_values(degree, x) for x in X)

    def product(f: Array, g: Array) -> Array:
        return (f[:, None] * g[None]).reshape(-1, *f.shape[1:])

    return product(a, b), (product(da, b), product(a, db))


def chebyshev_points(degree: int) -> Array:
    """The degree + 1 Chebyshev points of [0, 1], ends included, ascending."""
    return np.asarray((1 - np.cos(np.pi * np.arange(degree + 1) / degree)) / 2)


def lagrange_values(degree: int, x: Array) -> tuple[Array, Array]:
    """Values and derivatives at x (...) of the Lagrange polynomials through Chebyshev's points, (degree + 1, ...)."""
    series, slopes = _chebyshev_series(degree)
    powers = np.moveaxis(chebvander(2 * x - 1, degree), -1, 0)
    return np.tensordot(series, powers, (0, 0)), np.tensordot(slopes, powers[:-1], (0, 0))


@cache
def _chebyshev_series(degree: int) -> tuple[Array, Array]:
    """Columns of the coefficients in Chebyshev's polynomials of 2x - 1 of these Lagrange polynomials, and of slopes."""
    series = np.asarray(np.linalg.inv(chebvander(2 * chebyshev_points(degree) - 1, degree)), dtype=np.float64)
    return series, np.asarray(chebder(series, scl=2), dtype=np.float64)


# Nested rings around a singular point, which leave all other cells alone


def refined_towards(mesh: CurvedQuads, vertex: int, sizes: Array) -> CurvedQuads:
    """Cut the cells around a vertex, given by its number, into rings, whose sizes fall geometrically towards it.

    Each cell keeps a smaller one at the vertex, and what surrounds that is cut into two along the diagonal; then the
    smaller one is cut so, and so on. Sides that do not end at the vertex stay whole, and with them all other cells.
    Sizes (rings,), descending, are those of the smaller cells, in parts of the old ones. The cells that were cut are at
    the end; names of boundaries are lost.
    """
    corners, cells = np.nonzero(mesh.t == vertex)
    ends = np.setdiff1d(mesh.t[:, cells], vertex)
    t, points = [np.delete(mesh.t, cells, axis=1)], [np.delete(mesh.points, cells, axis=1)]
    for corner, cell in zip(corners, cells, strict=True):
        parts, places = _rings(int(corner), np.append(1.0, sizes))
        t.append(_numbers(mesh.t[:, cell], int(corner), ends, mesh.p.shape[1], len(sizes))[parts].T)
        points.append(_image(mesh, int(cell), places[:, parts]))
    return of_cells(np.concatenate(t, axis=1), np.concatenate(points, axis=1))


def _rings(corner: int, sizes: Array) -> tuple[Index, Array]:
    """Cells that one is cut into around one of its corners, (2 rings + 1, 4), and places (2, 3 (rings + 1) + 1).

    Elements of degree 3 and more need neighbours to run along their common side in the same direction: on sides around
    the corner that of the cell that is cut, on those that lead to it, and on its diagonal, away from it. The cells'
    vertices are numbers of places in the reference square: on the side along the first coordinate, on that along the
    second and on the diagonal, each inwards, and the corner itself.
    """
    at, k = CORNERS[:, corner], np.arange(len(sizes))
    s, t, diagonal = k, k + len(sizes), k + 2 * len(sizes)
    places = [at[:, None] + (CORNERS[:, end] - at)[:, None] * sizes for end in _others(corner)]
    low, high = (s, diagonal) if at[1] == 0 else (diagonal, s)
    beyond_s = np.array([low[1:], low[:-1], high[:-1], high[1:]])
    low, high = (t, diagonal) if at[0] == 0 else (diagonal, t)
    beyond_t = np.array([low[1:], high[1:], high[:-1], low[:-1]])
    innermost = np.empty((4, 1), dtype=np.intp)
    innermost[[*_others(corner), corner], 0] = s[-1], t[-1], diagonal[-1], 3 * len(sizes)
    return np.concatenate([beyond_s, beyond_t, innermost], axis=1).T, np.column_stack([*places, at])


def _others(corner: int) -> tuple[int, int, int]:
    """Corners of the square next to one along the first coordinate, along the second, and opposite."""
    return corner ^ 1, 3 - corner, (corner + 2) % 4


def _numbers(cell: Index, corner: int, ends: Index, first: int, rings: int) -> Index:
    """Numbers of the places of `_rings`: on a line that leads to the vertex they follow from its other end."""
    lines = [
        np.append(cell[end], first + rings * np.searchsorted(ends, cell[end]) + np.arange(rings))
        for end in _others(corner)
    ]
    return np.concatenate([*lines, cell[[corner]]])


def _image(mesh: CurvedQuads, cell: int, places: Array) -> Array:
    """Points that shape new cells (2, n, (DEGREE + 1)^2), from the places (2, n, 4) of their vertices in an old one."""
    nodes = chebyshev_points(DEGREE)
    s, t = (x.ravel() for x in np.meshgrid(nodes, nodes, indexing="ij"))
    X = places @ np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    return np.asarray(mesh.mapping().F(X, np.full(X.shape[1], cell)))
