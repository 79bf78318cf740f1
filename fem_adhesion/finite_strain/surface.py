"""The contact surface of a body at finite strain: its Gauss points, and displacements and their rates at them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from fem_adhesion.elasticity.boundaries import boundary_basis
from fem_adhesion.elasticity.far_field import Exterior
from fem_adhesion.elasticity.space import Space
from halfspace.elastic.compliance import ElasticOperator
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class ContactSurface(Valued):
    """Gauss points of the contact facets by radius, q in all, and the body's n reduced unknowns at them.

    Attributes
    ----------
    radii : (q,) array
        r in beta, undeformed.
    radii_rate : (q,) array
        r', the derivative by the arclength.
    measure : (q,) array
        2 pi ds.
    radial, vertical, radial_rate : (q, n) sparse array
        u_r, u_z and u_r'.
    """

    radii: Array
    radii_rate: Array
    measure: Array
    radial: sparse.csr_array
    vertical: sparse.csr_array
    radial_rate: sparse.csr_array

    def deformed_radii(self, y: Array, stretch: float) -> Array:
        """r_d in beta, (q,), of a body whose reduced unknowns are y."""
        return np.asarray(self.radii + stretch * (self.radial @ y))

    def areas(self, y: Array, stretch: float) -> Array:
        """Weights of the deformed horizontal area 2 pi r_d dr_d, (q,), in beta^2."""
        return np.asarray(self.measure * self.deformed_radii(y, stretch) * self._radii_rate(y, stretch))

    def area_rates(self, y: Array, stretch: float) -> sparse.csr_array:
        """Derivative by y of the areas, (q, n)."""
        change = scaled(self._radii_rate(y, stretch), self.radial)
        change = change + scaled(self.deformed_radii(y, stretch), self.radial_rate)
        return scaled(stretch * self.measure, change)

    def area_gradient(self, y: Array, stretch: float, amounts: Array) -> Array:
        """Derivative by y of the areas, summed with the given amounts (q,), (n,)."""
        amounts = stretch * self.measure * amounts
        by_radius = self.radial.T @ (self._radii_rate(y, stretch) * amounts)
        return np.asarray(by_radius + self.radial_rate.T @ (self.deformed_radii(y, stretch) * amounts))

    def area_curvature(self, stretch: float, amounts: Array) -> sparse.csr_array:
        """Second derivative by y of the areas, summed with the given amounts (q,), (n, n)."""
        half = self.radial.T @ scaled(stretch**2 * self.measure * amounts, self.radial_rate)
        return sparse.csr_array(half + half.T)

    @property
    def unknowns(self) -> Index:
        """The reduced unknowns that move the surface, ascending."""
        return np.unique(np.concatenate([field.indices for field in (self.radial, self.vertical, self.radial_rate)]))

    def _radii_rate(self, y: Array, stretch: float) -> Array:
        return np.asarray(self.radii_rate + stretch * (self.radial_rate @ y))


def scaled(factors: Array, rows: sparse.csr_array) -> sparse.csr_array:
    """Rows times factors."""
    data = rows.data * np.repeat(factors, np.diff(rows.indptr))
    return sparse.csr_array((data, rows.indices, rows.indptr), shape=rows.shape)


def contact_surface(space: Space, exterior: Exterior, points: int) -> ContactSurface:
    """Evaluate the contact surface and the reduced unknowns at `points` Gauss points a facet."""
    basis = boundary_basis(space, "contact", points)
    r = basis.global_coordinates()[0].ravel()
    order = np.argsort(r)
    T, n_z = exterior.reduction.tocsr(), np.asarray(basis.normals)[1].ravel()[order]
    values = np.array([b[0] for b in basis.basis])
    # The tangent that leads outwards from the pole, where the outward normal points up, is (n_z, -n_r).
    rates = np.array([b[0].grad[0] * basis.normals[1] - b[0].grad[1] * basis.normals[0] for b in basis.basis])
    radial, vertical = (T[components] for components in space.components)
    at_points, along = (_rows(basis, v)[order] for v in (values, rates))
    # On a facet only its own functions count; the others of its cell vanish there but for rounding.
    own = np.zeros(basis.N)
    own[space.boundary_functions("contact")] = 1.0
    radial, vertical = (sparse.diags_array(own) @ part for part in (radial, vertical))
    fields = (at_points @ radial, at_points @ vertical, along @ radial)
    measure = 2 * np.pi * basis.dx.ravel()[order]
    return ContactSurface(r[order], n_z, measure, *(_without_zeros(field) for field in fields))


def _without_zeros(field: sparse.csr_array) -> sparse.csr_array:
    rows = sparse.csr_array(field)
    rows.eliminate_zeros()
    return rows


def _rows(basis: Any, values: Array) -> sparse.csr_array:
    """Sparse rows, (facets k, functions), from values (functions of a cell, facets, k) of a boundary basis."""
    rows = np.broadcast_to(np.arange(values[0].size).reshape(values[0].shape), values.shape)
    columns = np.broadcast_to(basis.element_dofs[:, :, None], values.shape)
    shape = (values[0].size, basis.N)
    return sparse.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)


def rigid_operator(space: Space, surface: ContactSurface) -> ElasticOperator:
    """Operator of a rigid body on the surface's points, with the weights of the undeformed horizontal area."""
    q = surface.radii.size
    ends = np.sort(space.mesh.p[0, np.unique(space.mesh.facets[:, space.mesh.boundaries["contact"]])])
    weights = surface.measure * surface.radii * surface.radii_rate
    nodes = np.arange(q).reshape(ends.size - 1, -1)
    return ElasticOperator(surface.radii, weights, np.zeros((q, q)), ends, nodes)
