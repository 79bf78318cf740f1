"""Boundaries of a mesh: Gauss's points on a named one with the functions there, and scikit-fem's basis on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy import sparse
from skfem import FacetBasis
from skfem.mapping import MappingIsoparametric
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from fem_adhesion.elasticity.space import Space, reference_functions
from halfspace.values import Array, Index, Valued

INVERSION_TOLERANCE = 1e-6
"""Summed over the points of a facet, in units of the reference cell; a cell of 1e-9 of its radius is still resolved."""


def boundary_basis(space: Space, name: str, points: int) -> Any:
    """Return skfem's basis of the scalar element on the named boundary, with Gauss `points` on each facet."""
    quadrature = get_quadrature(RefLine, 2 * points - 1)
    facets = space.mesh.boundaries[name]
    return FacetBasis(
        space.mesh,
        space.element,
        mapping=_forgiving_mapping(space.mesh),
        facets=facets,
        quadrature=quadrature,
        dofs=space.scalar_dofs,
        disable_doflocs=True,
    )


def _forgiving_mapping(mesh: Any) -> Any:
    """The mesh's mapping; inverted on quadrilaterals only as far as rounding allows.

    skfem inverts them by Newton's method to 1e-12 of a cell, which the coordinates of thin cells far from the origin
    cannot resolve. On straight-sided rectangles its first step is exact.
    """
    mapping = mesh.mapping()
    if isinstance(mapping, MappingIsoparametric):
        mapping.invF = partial(mapping.invF, newton_tol=INVERSION_TOLERANCE)
    return mapping


@dataclass(frozen=True, eq=False, repr=False)
class Trace(Valued):
    """Gauss's points of a named boundary, k on each of its facets, and the scalar functions there.

    Attributes
    ----------
    places, normals : (2, facets, k) array
        r and z of the points, and of the outward normal there.
    lengths : (facets, k) array
        Weights of the length along the boundary.
    functions : (m,) int array
        Those that do not vanish on it, ascending.
    values : (facets k, m) sparse array
        Their values.
    """

    places: Array
    normals: Array
    lengths: Array
    functions: Index
    values: sparse.csr_array


def trace_on(space: Space, name: str, points: int) -> Trace:
    """Evaluate a space at so many Gauss points on each facet of a named boundary."""
    mesh, corners = space.mesh, space.element.refdom.p
    facets = mesh.boundaries[name]
    cells, (X, weights) = mesh.f2t[0, facets], get_quadrature(RefLine, 2 * points - 1)
    first, second = (np.argmax(mesh.t[:, cells] == vertex, axis=0) for vertex in mesh.facets[:, facets])
    start, along = corners[:, first], corners[:, second] - corners[:, first]
    Y = start[:, :, None] + along[:, :, None] * X[0]
    J = mesh.mapping().DF(Y, tind=cells)
    tangents = np.einsum("ijfk,jf->ifk", J, along)
    # Outwards is to the right of the tangent where the rest of the cell is to its left.
    towards = corners.mean(axis=1)[:, None] - start
    left = np.sign(along[0] * towards[1] - along[1] * towards[0])[:, None] * np.sign(
        J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
    )
    lengths = np.hypot(*tangents)
    functions = space.boundary_functions(name)
    values = _values(space, functions, cells, (first, second), Y)
    normals = left * np.array([tangents[1], -tangents[0]]) / lengths
    return Trace(mesh.mapping().F(Y, tind=cells), normals, lengths * weights, functions, values)


def _values(space: Space, functions: Index, cells: Index, ends: tuple[Index, Index], Y: Array) -> sparse.csr_array:
    """Values of functions at the points Y (2, facets, k) of cells; alike on all facets between the same corners."""
    dofs, k = space.scalar_dofs.element_dofs[:, cells], Y.shape[2]
    values = np.empty((len(dofs), *Y.shape[1:]))
    sides = ends[0] * len(space.mesh.t) + ends[1]
    for side in np.unique(sides):
        alike = np.flatnonzero(sides == side)
        values[:, alike] = reference_functions(space.element, Y[:, alike[0]])[0][:, None]
    found = np.isin(dofs, functions)
    columns = np.broadcast_to(np.searchsorted(functions, dofs)[:, :, None], values.shape)
    rows = np.broadcast_to(np.arange(cells.size * k).reshape(-1, k), values.shape)
    entries = values[found].ravel(), (rows[found].ravel(), columns[found].ravel())
    return sparse.csr_array(entries, shape=(cells.size * k, len(functions)))
