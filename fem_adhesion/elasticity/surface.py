"""Gauss's points of a named boundary of a mesh, and the functions of a space there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem.refdom import RefLine

from fem_adhesion.elasticity.reference import quadrature, reference_functions
from fem_adhesion.elasticity.space import Space, ring_measure
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class BoundaryPoints(Valued):
    """Gauss's points of a named boundary, k on each of its facets, outwards, and the scalar functions there.

    Places and normals (2, facets, k) are r and z of the points, and of the outward normal there; lengths (facets, k)
    are the weights of the length along the boundary, and the ends (facets + 1,) radii of the facets' ends. Of the
    functions (m,), those that do not vanish on it, ascending, there are values and rates (q, m) at all q = facets k
    points. The rates are derivatives by the arclength along (n_z, -n_r): on the contact surface, whose normal is
    upwards at the pole, that is outwards from it.
    """

    places: Array
    normals: Array
    lengths: Array
    ends: Array
    functions: Index
    values: sparse.csr_array
    rates: sparse.csr_array

    @property
    def radii(self) -> Array:
        """Radii of the points in beta, (q,); ascending on the contact surface."""
        return np.asarray(self.places[0].ravel())

    @property
    def depths(self) -> Array:
        """Depths of the points under z = 0 in beta, (q,)."""
        return np.asarray(-self.places[1].ravel())

    @property
    def slopes(self) -> Array:
        """Derivative of the depth by the radius, (q,)."""
        n_r, n_z = self.normals
        return np.asarray((n_r / n_z).ravel())

    @property
    def facet_points(self) -> Index:
        """Numbers of the points of each facet, (facets, k)."""
        return np.arange(self.lengths.size).reshape(self.lengths.shape)

    def weights(self, traction: str = "projected") -> Array:
        """Weights of 2 pi r dr, or of the area of the boundary itself with the traction "surface", in beta^2, (q,)."""
        lengths = self.lengths if traction == "surface" else self.normals[1] * self.lengths
        return ring_measure(self.radii) * lengths.ravel()

    def projection(self, field: Callable[[Array, Array], Array]) -> Array:
        """Coefficients (2, m), u_r first, of the best approximation by the functions to a vector field.

        field(r, z) returns the components (2, ...) at the given points. The boundary must have points enough for it.
        """
        weighted = self.values.T * self.lengths.ravel()
        values = field(*self.places).reshape(2, -1)
        return np.asarray(splu(sparse.csc_array(weighted @ self.values)).solve(weighted @ values.T).T)


def boundary_points(space: Space, name: str, points: int) -> BoundaryPoints:
    """Evaluate a space at so many Gauss points on each facet of a named boundary.

    The numbers are those of scikit-fem's `FacetBasis`. That one takes four times as long, and inverts the map of the
    cells by Newton's method: on the thin cells of a block at a Tabor parameter of 300 the inversion does not converge.
    """
    mesh, mapping = space.mesh, space.mesh.mapping()
    facets = mesh.boundaries[name]
    facets = facets[np.argsort(mesh.p[0, mesh.facets[:, facets]].min(axis=0), kind="stable")]
    vertices, cells = mesh.facets[:, facets], mesh.f2t[0, facets]
    vertices = np.take_along_axis(vertices, np.argsort(mesh.p[0, vertices], axis=0, kind="stable"), axis=0)
    X, weights = quadrature(RefLine, 2 * points - 1)
    corners = [np.argmax(mesh.t[:, cells] == vertex, axis=0) for vertex in vertices]
    starts, ends = (space.element.refdom.p[:, corner] for corner in corners)
    along = ends - starts
    Y = starts[:, :, None] + along[:, :, None] * X[0]
    tangents = np.einsum("ijfk,jf->ifk", np.asarray(mapping.DF(Y, tind=cells)), along)
    lengths = np.hypot(*tangents)
    chord, inwards = (p - mesh.p[:, vertices[0]] for p in (mesh.p[:, vertices[1]], mesh.p[:, mesh.t[:, cells]].mean(1)))
    outwards = np.sign(chord[0] * inwards[1] - chord[1] * inwards[0])[:, None]  # 1 if that is to the right
    normals = outwards * np.array([tangents[1], -tangents[0]]) / lengths
    sides = [reference_functions(space.element, Y[:, facet]) for facet in range(cells.size)]  # kept, for each side
    values, slopes = np.stack([value for value, _ in sides], axis=1), np.stack([slope for _, slope in sides], axis=2)
    rates = np.einsum("nifk,if->nfk", slopes, along) * -outwards / lengths
    functions, dofs = space.boundary_functions(name), np.asarray(space.scalar_dofs.element_dofs)[:, cells]
    places, radii = np.asarray(mapping.F(Y, tind=cells)), np.sort(mesh.p[0, np.unique(vertices)])
    rows = _rows(dofs, functions, values, rates)
    return BoundaryPoints(places, normals, lengths * weights, radii, functions, *rows)


def _rows(dofs: Index, functions: Index, *arrays: Array) -> list[sparse.csr_array]:
    """Rows of arrays of values (n, facets, k) of the unknowns dofs (n, facets), for some functions."""
    shape, found = arrays[0].shape, np.isin(dofs, functions)
    columns = np.broadcast_to(np.searchsorted(functions, dofs)[:, :, None], shape)[found].ravel()
    points = shape[1] * shape[2]
    rows = np.broadcast_to(np.arange(points).reshape(shape[1:]), shape)[found].ravel()
    size = points, len(functions)
    return [sparse.csr_array((values[found].ravel(), (rows, columns)), shape=size) for values in arrays]
