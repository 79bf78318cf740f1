"""Meshes of the block: body z <= 0 in the r-z plane, contact surface z = 0, boundaries axis, contact and far."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from skfem import MeshQuad, MeshTri

from halfspace.elastic import grid
from halfspace.errors import InputError
from halfspace.values import Array

SizeFunction = Callable[[Array, Array], Array]
"""Largest edge wanted at (r, z), in beta."""


def graded_size(fine: float, fine_radius: float, growth: float) -> SizeFunction:
    """Return size(r, z) = max(fine, growth * distance to the segment 0 <= r <= fine_radius of the surface).

    Sizes and the segment's length are in beta; growth is the increase of the size per unit of distance.
    """

    def size(r: Array, z: Array) -> Array:
        distance = np.hypot(np.maximum(r - fine_radius, 0.0), z)
        return np.maximum(fine, growth * distance)

    return size


def quarter_disc(radius: float, size: SizeFunction) -> Any:
    """Triangulate the quarter disc of a radius L in beta, no edge longer than `size` at its triangle's centroid.

    Triangles are cut until they are small enough; new nodes of the far boundary are pushed onto the arc, so the body is
    a polygon inscribed in the quarter disc. The size, in beta, is bounded away from zero. Returns a MeshTri with the
    boundaries "axis", "contact" and "far".
    """
    diagonal = radius * np.sqrt(0.5)
    nodes = np.array([[0.0, radius, diagonal, 0.0], [0.0, 0.0, -diagonal, -radius]])
    mesh = MeshTri(nodes, np.array([[0, 0], [1, 2], [2, 3]]))
    while True:
        corners = mesh.p[:, mesh.t]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=0)
        large = np.flatnonzero(edges.max(axis=0) > size(*corners.mean(axis=1)))
        if not large.size:
            return with_named_boundaries(mesh)
        mesh = mesh.refined(large)
        points, arc = mesh.p.copy(), np.unique(mesh.facets[:, mesh.facets_satisfying(_far, boundaries_only=True)])
        points[:, arc] *= radius / np.linalg.norm(points[:, arc], axis=0)
        mesh = MeshTri(points, mesh.t)


def tensor_grid(r_breaks: Array, z_breaks: Array, interfaces: Sequence[float] = ()) -> Any:
    """Mesh the square box with quadrilaterals between lines of constant radius (m + 1,) and depth (n + 1,), in beta.

    Both ascend from 0, depths positive into the body; the interfaces, ascending, are those at which another material
    begins. Returns a MeshQuad of m times n cells with the boundaries "axis", "contact" and "far", and one subdomain for
    each material; InputError if the lines do not ascend from 0.
    """
    for name, lines in (("r_breaks", r_breaks), ("z_breaks", z_breaks)):
        if len(lines) < 2 or lines[0] != 0.0 or np.any(np.diff(lines) <= 0.0):
            raise InputError(f"{name} = {lines} must ascend strictly from 0; sort them and remove duplicates")
    mesh = with_named_boundaries(MeshQuad.init_tensor(r_breaks, -z_breaks[::-1]))
    region = np.searchsorted(interfaces, -mesh.p[1, mesh.t].mean(axis=0))
    return mesh.with_subdomains({str(n): np.flatnonzero(region == n) for n in range(len(interfaces) + 1)})


def block_grid(fine: float, fine_radius: float, length: float, *, growth: float = 2.0) -> Any:
    """Mesh the box [0, length] x [-length, 0]: cells of the size `fine` on its surface up to a radius, growing beyond.

    Lengths are in beta; the growth, above 1, is the ratio of one cell to the one before. InputError as of
    `halfspace.elastic.grid.graded`, which makes the lines in both directions.
    """
    r_breaks, z_breaks = (grid.graded(0.0, fine, length, growth=growth, until=end) for end in (fine_radius, fine))
    return tensor_grid(r_breaks, z_breaks)


def with_named_boundaries(mesh: Any) -> Any:
    """Return the mesh with its boundaries named "axis" (r = 0), "contact" (z = 0) and "far" (the rest)."""
    return mesh.with_boundaries({"axis": lambda x: x[0] == 0.0, "contact": lambda x: x[1] == 0.0, "far": _far})


def _far(x: Array) -> Any:
    """Tell which midpoints of boundary facets lie neither on the axis nor on the surface."""
    return (x[0] != 0.0) & (x[1] != 0.0)
