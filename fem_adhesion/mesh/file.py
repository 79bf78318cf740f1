"""A body from a file: whatever meshio reads, as a mesh of scikit-fem with its boundaries named.

The file holds the meridian section of the body in the half-plane x = r >= 0, y = z, in units of the radius R of
curvature at the pole. Should that be off by a few per cent the mesh is rescaled by the radius fitted to it, since R/eps
and all loads are told in that radius. The groups of lines "axis", "contact" and "grip" say what its boundaries are;
lines in no group are free. See meshes/README.md for examples, `fem_adhesion.mesh.checks` for what a body must fulfil.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from skfem import MeshQuad, MeshQuad2, MeshTri, MeshTri2

from fem_adhesion.mesh.checks import GROUPS, TOLERANCE, facet_nodes, pole, pole_radius, require_body
from halfspace.errors import InputError
from halfspace.values import Array, Index

CORNERS = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}
"""Vertices of the cells that are read, by meshio's name."""


def read_body(path: str | Path) -> Any:
    """Return the mesh of `read_scaled` alone."""
    return read_scaled(path)[0]


def read_scaled(path: str | Path) -> tuple[Any, float]:
    """Read the mesh of a body, make sure that it is one, and scale it to the radius R of curvature at its pole.

    Any file that meshio reads will do. Cells are triangles of 3 or 6 nodes, or quadrilaterals of 4, 8 or 9, all of one
    kind. The groups "axis", "contact" and "grip" of lines are Gmsh's physical groups, cell sets, meshio's integer cell
    data "axis-contact-grip" (in any order, see ``meshio convert --sets-to-int-data``) or the boundaries that scikit-fem
    saves.

    Given are the MeshTri, MeshTri2, MeshQuad or MeshQuad2 and R in the file's unit, 1 if that is R. The mesh's lengths
    are in R, the pole is at r = z = 0 and the body below, with the boundaries "axis", "contact" and "far", which is the
    file's "grip". Unused nodes are dropped, a body is shifted along the axis to bring its pole to z = 0, quadrilaterals
    of 8 nodes get the ninth where their own shape functions have it. InputError if the file cannot be read or is no
    mesh of a body says what is wrong and what to do.
    """
    try:
        mesh = _with_boundaries(_read(Path(path)))
        require_body(mesh)
    except InputError as error:
        raise InputError(f"mesh {path}: {error}") from error
    radius = pole_radius(mesh)
    radius = 1.0 if abs(radius - 1.0) <= TOLERANCE else radius
    return _in_place(mesh, radius), radius


def _read(path: Path) -> Any:
    """Return the meshio.Mesh of the file."""
    import meshio  # slow to load, and needed here only

    if not path.is_file():
        raise InputError("there is no such file; check its name")
    said = io.StringIO()  # meshio prints and ends the program when a reader fails
    try:
        with redirect_stdout(said), redirect_stderr(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio's readers let through whatever goes wrong in them
        cause = said.getvalue() if isinstance(error, SystemExit) else f"{type(error).__name__}: {error}"
        raise InputError(
            f"meshio cannot read it ({_one_line(cause)}); save it as Gmsh's .msh, 2.2 if 4.1 fails"
        ) from error


def _with_boundaries(raw: Any) -> Any:
    """Return scikit-fem's mesh of the cells in the file, with the boundaries "axis", "contact" and "far"."""
    kind = _cell_kind(raw)
    mesh, vertices = _cells(raw, kind)
    found = {name: _facets(mesh, vertices, lines, name) for name, lines in _line_groups(raw).items()}
    found = {name: facets for name, facets in {**(mesh.boundaries or {}), **found}.items() if len(facets)}
    missing = [name for name in GROUPS if name not in found]
    if missing:
        raise InputError(
            f"group {_listed(missing)} is missing, the file has {_listed(found)}; name the groups of boundary lines "
            f"{_listed(GROUPS)} (in Gmsh: Physical Curve)"
        )
    boundaries = {inside: np.asarray(found[name], dtype=np.int32) for name, inside in GROUPS.items()}
    return replace(mesh, _boundaries=boundaries, _subdomains=None)


def _cell_kind(raw: Any) -> str:
    """Return meshio's name of the cells, all of one kind."""
    kinds = sorted({block.type for block in raw.cells if block.dim >= 2 and len(block)})
    if not kinds:
        raise InputError(
            "no triangles or quadrilaterals in it; in Gmsh put the surface into a Physical Surface as well"
        )
    if not set(kinds) <= set(CORNERS):
        raise InputError(
            f"cells of type {_listed(kinds)} are none of {_listed(CORNERS)}; mesh the meridian section, in order 1 or 2"
        )
    if len(kinds) > 1:
        raise InputError(f"cells are of {len(kinds)} types, {_listed(kinds)}, limit 1; use triangles or quadrilaterals")
    return str(kinds[0])


def _cells(raw: Any, kind: str) -> tuple[Any, Index]:
    """Return the mesh of the cells of one kind, and the numbers that its vertices have in the file."""
    from meshio import Mesh
    from skfem.io.meshio import from_meshio

    blocks = [k for k, block in enumerate(raw.cells) if block.type == kind]
    cells = np.concatenate([raw.cells[k].data for k in blocks]).astype(np.intp)
    points, vertices = _plane_points(raw.points, cells), np.unique(cells[:, : CORNERS[kind]])
    if kind == "quad8":
        points, cells = _with_centres(points, cells)
        kind = "quad9"
    used, compact = np.unique(cells, return_inverse=True)
    tags = {
        name: [np.concatenate([data[k] for k in blocks])]
        for name, data in raw.cell_data.items()
        if name.startswith("skfem:b:")
    }
    return from_meshio(Mesh(points[used], [(kind, compact.reshape(cells.shape))], cell_data=tags)), vertices


def _plane_points(points: Array, cells: Index) -> Array:
    """Return r and z of the nodes, (nodes, 2); those in no cell are not looked at."""
    if cells.min() < 0 or cells.max() >= len(points):
        wrong = cells.min() if cells.min() < 0 else cells.max()
        raise InputError(f"a cell has node {wrong}, limit 0 to {len(points) - 1}; export the mesh again")
    used = points[np.unique(cells)]
    if not np.all(np.isfinite(used)):
        raise InputError(f"{np.sum(~np.isfinite(used))} coordinates are not finite, limit 0; export the mesh again")
    height = float(np.abs(used[:, 2:]).max(initial=0.0))
    if height > TOLERANCE * np.ptp(used):
        raise InputError(f"third coordinate = {height:.4g} must be 0; let the first be r and the second z")
    return np.asarray(points[:, :2], dtype=np.float64)


def _with_centres(points: Array, cells: Index) -> tuple[Array, Index]:
    """Return points and cells of quadrilaterals of 9 nodes that have the same shape as these of 8."""
    corners, sides = points[cells[:, :4]].sum(axis=1), points[cells[:, 4:]].sum(axis=1)
    centres = 0.5 * sides - 0.25 * corners
    numbers = len(points) + np.arange(len(cells))
    return np.concatenate([points, centres]), np.column_stack([cells, numbers])


def _line_groups(raw: Any) -> dict[str, Index]:
    """Return the ends of the lines in each named group, (lines, 2), numbered as in the file."""
    groups: dict[str, list[Index]] = {}
    for k, block in enumerate(raw.cells):
        if block.type in ("line", "line3"):
            for name, members in _members(raw, k):
                groups.setdefault(name, []).append(block.data[members, :2].astype(np.intp))
    return {name: np.concatenate(lines) for name, lines in groups.items()}


def _members(raw: Any, k: int) -> Iterator[tuple[str, Index]]:
    """Yield the names of groups and their members among the cells of block k."""
    for name, sets in raw.cell_sets.items():
        if sets[k] is not None and not name.startswith("gmsh:"):  # those hold no cells
            yield name, np.asarray(sets[k], dtype=np.intp)
    for name, value in raw.field_data.items():
        if np.shape(value) == (2,) and value[1] == 1 and "gmsh:physical" in raw.cell_data:
            yield name, np.flatnonzero(raw.cell_data["gmsh:physical"][k] == value[0])
    for key, data in raw.cell_data.items():
        names = key.split("-")
        if len(names) > 1 and GROUPS.keys() & set(names):
            yield from ((name, np.flatnonzero(data[k] == number)) for number, name in enumerate(names))


def _facets(mesh: Any, vertices: Index, lines: Index, name: str) -> Index:
    """Return the facets of the mesh that are the lines of a group, each once."""
    ends = np.sort(np.searchsorted(vertices, lines), axis=1)
    known = np.isin(lines, vertices).all(axis=1)
    n, corners = len(vertices), np.sort(mesh.facets, axis=0)
    facets = np.flatnonzero(np.isin(corners[0] * n + corners[1], (ends[:, 0] * n + ends[:, 1])[known]))
    stray = len(np.unique(np.sort(lines, axis=1), axis=0)) - len(facets)
    if stray and name in GROUPS:
        raise InputError(f'{stray} lines of group "{name}" are no sides of cells, limit 0; merge duplicate nodes')
    return facets


def _in_place(mesh: Any, unit: float) -> Any:
    """Return the mesh with its axis at r = 0 to the last digit and its pole at z = 0, lengths in the unit given."""
    points = mesh.doflocs.copy()
    points[0, facet_nodes(mesh, mesh.boundaries["axis"])] = 0.0
    points[1] -= points[1, pole(mesh)]
    return replace(mesh, doflocs=points / unit)


def _listed(names: Any) -> str:
    return ", ".join(f'"{name}"' for name in names) or "none"


def _one_line(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= 150 else f"{words[:150]}..."


# The contact as a smooth line, which straight cells are a polygon in


def on_smooth_line(mesh: Any, r: Array) -> Array:
    """Points (2, n) of the smooth contact line in the place of those at radii (n,) on its polygon.

    It is a cubic spline through the vertices by the length of their chords, even at the pole.
    """
    vertices = mesh.p[:, np.unique(mesh.facets[:, mesh.boundaries["contact"]])]
    x, z = vertices[:, np.argsort(vertices[0])]
    s = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(z))))
    mirrored = [np.concatenate([sign * line[:0:-1], line]) for sign, line in ((-1, s), (-1, x), (1, z))]
    return np.asarray(CubicSpline(mirrored[0], np.stack(mirrored[1:]), axis=1)(np.interp(r, x, s)))


def is_straight(mesh: Any) -> bool:
    """Whether the sides of the cells are."""
    return type(mesh) in (MeshTri, MeshQuad)


def chords(mesh: Any) -> tuple[Array, Array]:
    """Middles of the straight lines of the contact (2, n), and how far the smooth line is from them (n,); none curved.

    The mesh is as of `read_body`; all are in its unit.
    """
    if not is_straight(mesh):
        return np.empty((2, 0)), np.empty(0)
    middles = mesh.p[:, mesh.facets[:, mesh.boundaries["contact"]]].mean(axis=1)
    return middles, np.hypot(*(on_smooth_line(mesh, middles[0]) - middles))


# Finer: new nodes are placed by the shape of the cells, which scikit-fem's are not, and of a polygon on a smooth line


def refined(mesh: Any) -> Any:
    """Cut each cell of a mesh of straight or curved sides into four of the same shape together.

    A MeshTri or MeshTri2 becomes a MeshTri2, a MeshQuad or MeshQuad2 a MeshQuad2, with the same named boundaries. Of
    straight cells the new nodes of the contact are on its smooth line: what the polygon errs by is in the change.
    """
    kind, curved = (MeshTri, MeshTri2) if isinstance(mesh, MeshTri) else (MeshQuad, MeshQuad2)
    straight = kind(mesh.p[:, : mesh.nvertices], mesh.t, mesh.boundaries, sort_t=False)
    finer = straight.refined()
    fine = curved.from_mesh(finer)
    cells = fine.dofs.element_dofs
    parents = np.tile(np.arange(mesh.nelements), 4)
    X = straight.mapping().invF(fine.doflocs[:, cells].transpose(0, 2, 1), tind=parents)
    points = fine.doflocs.copy()
    points[:, cells.T] = mesh.mapping().F(X, tind=parents)
    if is_straight(mesh) and "contact" in (finer.boundaries or {}):
        line = np.unique(facet_nodes(fine, finer.boundaries["contact"]))
        points[:, line] = on_smooth_line(mesh, points[0, line])
    return curved(points, fine.t, finer.boundaries)
