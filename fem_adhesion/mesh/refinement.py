"""Finer meshes: nested rings around a singular point, which leave all others alone, and every cell cut into four.

There new nodes are placed by the cells' own shape, which scikit-fem's are not.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import MeshQuad, MeshQuad2, MeshTri, MeshTri2

from fem_adhesion.mesh.curved import CORNERS, DEGREE, CurvedQuads, chebyshev_points, of_cells
from halfspace.values import Array, Index


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
    within = np.full(X.shape[1], cell)
    return np.array([mesh.mapping().Fmap(i, X, within) for i in range(2)])


CURVED = {MeshTri: MeshTri2, MeshTri2: MeshTri2, MeshQuad: MeshQuad2, MeshQuad2: MeshQuad2}
STRAIGHT = {MeshTri: MeshTri, MeshTri2: MeshTri, MeshQuad: MeshQuad, MeshQuad2: MeshQuad}


def refined(mesh: Any) -> Any:
    """Cut each cell of a mesh of straight or curved sides into four of the same shape together.

    A MeshTri or MeshTri2 becomes a MeshTri2, a MeshQuad or MeshQuad2 a MeshQuad2, with the same named boundaries.
    """
    kind = type(mesh)
    sorting = {"sort_t": False} if STRAIGHT[kind] is MeshTri else {}
    straight = STRAIGHT[kind](mesh.p[:, : mesh.nvertices], mesh.t, mesh.boundaries, **sorting)
    finer = straight.refined()
    fine = CURVED[kind].from_mesh(finer)
    cells = fine.dofs.element_dofs
    parents = np.tile(np.arange(mesh.nelements), 4)
    X = straight.mapping().invF(fine.doflocs[:, cells].transpose(0, 2, 1), tind=parents)
    points = fine.doflocs.copy()
    points[:, cells.T] = mesh.mapping().F(X, tind=parents)
    return CURVED[kind](points, fine.t, finer.boundaries)
