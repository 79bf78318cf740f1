"""What the mesh of a body from a file must fulfil: complaints say what is wrong and what to do, or are None.

They build on each other: what yields one may assume that there was none before. The first ends the search.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from halfspace.errors import InputError
from halfspace.values import Array, Index

GROUPS = {"axis": "axis", "contact": "contact", "grip": "far"}  # groups of lines of a file, and the boundaries inside
TOLERANCE = 1e-8  # tolerance of places in sizes of the body; in single precision digits are fewer, but zeros are zero
FLATNESS = 1e-9  # least Jacobian determinant of a cell over the square of its longest edge
POLE_SLOPE = 0.15  # depth over radius up to which points give the curvature at the pole: 0.3 R on a sphere
POLE_POINTS = (4, 12)  # fewest and most points on the contact line, without the pole, that give the curvature there
RADIUS_ERROR = 0.05  # largest distance of the pole's radius from 1
ROUNDNESS = 0.02  # largest misfit of the pole's points to a round pole, over their depth
ROUND, NEARLY_ROUND = 3, 2  # even powers of r in the fit of the radius, to 1e-5 at worst, and of what counts as round


def require_body(mesh: Any) -> None:
    """Raise InputError unless a mesh with the boundaries "axis", "contact" and "far" is that of a body.

    It is the meridian section, coordinates r and z, about in units of the radius of curvature at the pole. The error
    says in one line what is wrong, with value and limit, and the remedy.
    """
    for check in (_of_cells, _of_boundaries, _of_contact, _of_pole):
        complaint = next(filter(None, check(mesh)), None)
        if complaint:
            raise InputError(complaint)


def facet_nodes(mesh: Any, facets: Index) -> Index:
    """Return the nodes of facets: both ends and, of a curved mesh, the middle; (2 or 3, facets)."""
    middles = mesh.dofs.facet_dofs[:, facets] if mesh.elem.facet_dofs else np.empty((0, len(facets)))
    return np.concatenate([mesh.facets[:, facets], middles]).astype(np.intp)


def pole(mesh: Any) -> int:
    """Return the vertex where the contact line starts: that with the least radius."""
    vertices = np.unique(mesh.facets[:, mesh.boundaries["contact"]])
    return int(vertices[np.argmin(mesh.p[0, vertices])])


def _of_cells(mesh: Any) -> Iterator[str | None]:
    """Complaints about nodes and cells."""
    from scipy.spatial import cKDTree  # it takes long to load, and few need it

    least = float(mesh.p[0].min())
    if least < -_length(mesh):
        yield f"r = {least:.4g} is outside r >= 0; keep only the half x >= 0 of the section, with x = r and y = z"
    pairs = cKDTree(mesh.p.T).query_pairs(_length(mesh), output_type="ndarray")
    yield _complaint("nodes coincide with another", mesh.p[:, pairs[:, 0]], "merge duplicates (Gmsh: Coherence Mesh)")
    corners = mesh.p[:, mesh.t]
    longest = np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=0).max(axis=0)
    J = mesh.mapping().detDF(mesh.elem.doflocs.T)
    least_J = (J * np.sign(J.sum(axis=1, keepdims=True))).min(axis=1)
    flat = corners[:, :, ~(least_J > FLATNESS * longest)].mean(axis=1)
    yield _complaint("cells are flat or turned inside out", flat, "mesh finer or less curved there")
    crowded = np.flatnonzero(np.bincount(mesh.t2f.ravel()) > 2)
    yield _complaint("lines belong to more than two cells", _middles(mesh, crowded), "remove double cells")
    inner = np.flatnonzero(mesh.f2t[1] >= 0)
    folded = inner[_side(mesh, inner, 0) * _side(mesh, inner, 1) > 0]
    yield _complaint("lines have both their cells on one side", _middles(mesh, folded), "mesh the section only once")
    shared = csr_array((np.ones(inner.size), mesh.f2t[:, inner]), shape=2 * (mesh.nelements,))
    pieces = connected_components(shared, directed=False)[0]
    yield f"the body falls into {pieces} pieces, limit 1; join them or keep one" if pieces > 1 else None


def _of_boundaries(mesh: Any) -> Iterator[str | None]:
    """Complaints about the groups of lines, but for what each line of the contact must be."""
    boundary, named = mesh.boundary_facets(), {name: mesh.boundaries[inside] for name, inside in GROUPS.items()}
    inner = np.setdiff1d(np.concatenate(list(named.values())), boundary)
    yield _complaint("lines of the groups run inside the body", _middles(mesh, inner), "take them out")
    for a, b in combinations(GROUPS, 2):
        both = _middles(mesh, np.intersect1d(named[a], named[b]))
        yield _complaint(f'lines are both in "{a}" and in "{b}"', both, "leave each in one group")
    r = mesh.p[0, facet_nodes(mesh, named["axis"])].max()
    if r > _length(mesh):
        yield f'group "axis" reaches r = {r:.4g}, limit r = 0; let it hold the boundary at x = 0 and nothing else'
    on_axis = boundary[np.all(mesh.p[0, mesh.facets[:, boundary]] <= _length(mesh), axis=0)]
    left_out = _middles(mesh, np.setdiff1d(on_axis, named["axis"]))
    yield _complaint('boundary lines at r = 0 are not in group "axis"', left_out, "add them")


def _of_contact(mesh: Any) -> Iterator[str | None]:
    """Complaints about the contact: one line outwards from the pole, on top of the body."""
    degree = np.bincount(mesh.facets[:, mesh.boundaries["contact"]].ravel())
    ends = np.flatnonzero(degree % 2)
    if len(ends) != 2 or degree.max() > 2:
        yield f'group "contact" has {len(ends)} ends, limit 2; make it one line from the pole outwards'
    if not np.isin(ends, mesh.facets[:, mesh.boundaries["axis"]]).any():
        r = mesh.p[0, ends].min()
        yield f'group "contact" starts at r = {r:.4g}, limit r = 0; let it start at the pole, on the axis'
    facets, inner, outer = _contact_outwards(mesh)
    r_0, r_1 = mesh.p[0, inner], mesh.p[0, outer]
    rise = r_1 - r_0 - _length(mesh)
    for middle in facet_nodes(mesh, facets)[2:]:  # of a parabola through three points: its slopes at the ends
        r_m = mesh.p[0, middle]
        rise = np.minimum(rise, np.minimum(4 * r_m - 3 * r_0 - r_1, r_0 + 3 * r_1 - 4 * r_m) + _length(mesh))
    rise[1:] = np.where(outer[:-1] == inner[1:], rise[1:], -1.0)
    remedy = "z must be a function of r: end the group before them"
    yield _complaint("lines of the contact turn back or run upright", _middles(mesh, facets[rise < 0.0]), remedy)
    outwards = np.where(mesh.facets[0, facets] == inner, 1.0, -1.0)
    wrong = _middles(mesh, facets[outwards * _side(mesh, facets, 0) > 0])
    yield _complaint("lines of the contact lie below the body", wrong, "turn the body over: z -> -z")
    higher = mesh.p[:, mesh.p[1] > mesh.p[1, pole(mesh)] + _length(mesh)]
    yield _complaint("nodes stand above the pole", higher, "the pole must be nearest to the wall")


def _of_pole(mesh: Any) -> Iterator[str | None]:
    """Complaints about the radius of curvature at the pole, and the misfit of the nodes near it to a round one."""
    r, depth = _pole_points(mesh)
    if len(r) < POLE_POINTS[0]:
        yield (
            f"the contact line has {len(r)} nodes beside the pole before its slope exceeds {2 * POLE_SLOPE}, limit "
            f"{POLE_POINTS[0]}; round the pole, or mesh it finer"
        )
    misfit, radius = _fitted_pole(r, depth, NEARLY_ROUND)[1], _fitted_pole(r, depth, ROUND)[0]
    if misfit > ROUNDNESS:
        yield f"the contact line is not round at the pole, misfit {misfit:.2g}, limit {ROUNDNESS}; round it off there"
    if abs(radius - 1.0) > RADIUS_ERROR:
        yield (
            f"radius of curvature at the pole = {radius:.4g} must be 1 within {RADIUS_ERROR:.0%}, the unit of length; "
            f"multiply all lengths by {1.0 / radius:.4g} (Gmsh: Mesh.ScalingFactor)"
        )


def pole_radius(mesh: Any) -> float:
    """Radius R of curvature at the pole, in the mesh's unit: depth = r^2/2R + c r^4 + d r^6 fitted to nodes beside it.

    On a sphere it is right to 1e-5 if the nodes reach to 0.3 R, as on the coarsest mesh that is read, and to 1e-7 if
    they do to 0.12 R. Nodes that are wrong by 1e-7 R change it by 1e-4.
    """
    return _fitted_pole(*_pole_points(mesh), ROUND)[0]


def _fitted_pole(r: Array, depth: Array, powers: int) -> tuple[float, float]:
    """Radius R and misfit over the depth of the fit by r^2/2R and further even powers of r."""
    shape = np.stack([(r / r[-1]) ** (2 * k) for k in range(1, powers + 1)], axis=1)
    coefficients = np.linalg.lstsq(shape, depth)[0]
    misfit = np.abs(shape @ coefficients - depth).max() / depth.max()
    return float(r[-1] ** 2 / (2.0 * coefficients[0])), float(misfit)


def _pole_points(mesh: Any) -> tuple[Array, Array]:
    """Return radii and depths below the pole of the first nodes of the contact line, ascending, without the pole."""
    top = pole(mesh)
    nodes = np.setdiff1d(facet_nodes(mesh, mesh.boundaries["contact"]), top)
    nodes = nodes[np.argsort(mesh.p[0, nodes])]
    r, depth = mesh.p[0, nodes], mesh.p[1, top] - mesh.p[1, nodes]
    steep = np.append(depth > POLE_SLOPE * r, True)
    near = slice(min(int(np.argmax(steep)), POLE_POINTS[1]))
    return r[near], depth[near]


def _contact_outwards(mesh: Any) -> tuple[Index, Index, Index]:
    """Return the facets of the contact line by radius, and their ends: the one nearer to the axis, the other."""
    facets = np.asarray(mesh.boundaries["contact"])
    ends = mesh.facets[:, facets]
    ends = np.take_along_axis(ends, np.argsort(mesh.p[0, ends], axis=0), axis=0)
    order = np.argsort(mesh.p[0, ends[0]])
    return facets[order], ends[0, order], ends[1, order]


def _side(mesh: Any, facets: Index, which: int) -> Array:
    """Tell on which side of its facets the first (0) or second (1) cell lies: above zero on their left."""
    start, end = mesh.p[:, mesh.facets[:, facets]].transpose(1, 0, 2)
    cells = mesh.f2t[which, facets]
    along, across = end - start, mesh.p[:, mesh.t[:, cells]].mean(axis=1) - start
    return np.asarray(along[0] * across[1] - along[1] * across[0])


def _middles(mesh: Any, facets: Index) -> Array:
    return np.asarray(mesh.p[:, mesh.facets[:, facets]].mean(axis=1))


def _complaint(what: str, places: Array, remedy: str) -> str | None:
    """Say how many things are wrong and where the first of them is; None if there are none."""
    if not places.size:
        return None
    r, z = places[:, 0]
    return f"{places.shape[1]} {what}, one at (r, z) = ({r:.4g}, {z:.4g}), limit 0; {remedy}"


def _length(mesh: Any) -> float:
    """Return what counts as zero of a length."""
    return float(TOLERANCE * np.ptp(mesh.p, axis=1).max())
