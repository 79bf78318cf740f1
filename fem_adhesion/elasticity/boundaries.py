"""Boundaries of a mesh: Gauss's points on a named one, and the functions there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from skfem.refdom import RefLine

from fem_adhesion.elasticity.space import Space, quadrature, reference_functions
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Trace(Valued):
    """Gauss's points of a named boundary, k on each of its facets, and the scalar functions there.

    Places and normals (2, facets, k) are r and z of the points, and of the outward normal there; lengths (facets, k)
    are the weights of the length along the boundary. Of the functions (m,), those that do not vanish on it, ascending,
    the values (facets k, m) are at the points. Of the n functions of each facet's cell, whose numbers are `cells`
    (n, facets), the slopes (n, facets, k) are their derivatives by the arclength along (n_z, -n_r): on the contact
    surface, whose normal is upwards at the pole, that is outwards from it.
    """

    places: Array
    normals: Array
    lengths: Array
    functions: Index
    values: sparse.csr_array
    cells: Index
    slopes: Array

    @property
    def rates(self) -> sparse.csr_array:
        """Slopes of the functions at the points, (facets k, m)."""
        return _rows(self.slopes, self.cells, self.functions)


def trace_on(space: Space, name: str, points: int) -> Trace:
    """Evaluate a space at so many Gauss points on each facet of a named boundary."""
    mesh, functions = space.mesh, space.boundary_functions(name)
    facets = mesh.boundaries[name]
    cells, (X, weights) = mesh.f2t[0, facets], quadrature(RefLine, 2 * points - 1)
    ends = [np.argmax(mesh.t[:, cells] == vertex, axis=0) for vertex in mesh.facets[:, facets]]
    places, normals = np.empty((2, 2, cells.size, points))
    lengths = np.empty((cells.size, points))
    values, rates = np.empty((2, len(space.scalar_dofs.element_dofs), *lengths.shape))
    for side in np.unique(ends, axis=1).T:  # all facets between the same corners at once
        alike = np.all(np.transpose(ends) == side, axis=1)
        Y, along, outwards = _side(space.element.refdom.p, side[0], side[1], X[0])
        J = np.asarray(mesh.mapping().DF(Y, tind=cells[alike]))
        tangents = np.einsum("ijfk,j->ifk", J, along)
        lengths[alike] = np.hypot(*tangents)
        turned = outwards * np.sign(J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0])
        normals[:, alike] = turned * np.array([tangents[1], -tangents[0]]) / lengths[alike]
        places[:, alike] = mesh.mapping().F(Y, tind=cells[alike])
        value, slopes = reference_functions(space.element, Y)
        values[:, alike] = value[:, None]
        rates[:, alike] = np.einsum("nik,i->nk", slopes, along)[:, None] * -turned / lengths[alike]
    dofs = np.asarray(space.scalar_dofs.element_dofs)[:, cells]
    return Trace(places, normals, lengths * weights, functions, _rows(values, dofs, functions), dofs, rates)


def _side(corners: Array, first: int, second: int, X: Array) -> tuple[Array, Array, float]:
    """Points of the reference cell on a side, its direction, and 1 if outwards is to the right of that, -1 if not."""
    along, inwards = corners[:, second] - corners[:, first], corners.mean(axis=1) - corners[:, first]
    Y = corners[:, first, None] + along[:, None] * X
    return Y, along, float(np.sign(along[0] * inwards[1] - along[1] * inwards[0]))


def _rows(values: Array, dofs: Index, functions: Index) -> sparse.csr_array:
    """Rows of the values (n, facets, k) of the unknowns dofs (n, facets), for some functions."""
    k, found = values.shape[2], np.isin(dofs, functions)
    columns = np.broadcast_to(np.searchsorted(functions, dofs)[:, :, None], values.shape)
    rows = np.broadcast_to(np.arange(values[0].size).reshape(-1, k), values.shape)
    entries = values[found].ravel(), (rows[found].ravel(), columns[found].ravel())
    return sparse.csr_array(entries, shape=(values[0].size, len(functions)))
