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
    """Gauss points of the contact facets by radius, q in all, and the m unknowns s that move them.

    Radii (q,) are r in beta, undeformed, their rates (q,) r', the derivative by the arclength, and the measure (q,) is
    2 pi ds; the ends, in beta, are the facets'. Unknowns (m,) are the body's reduced ones that are not zero at the
    points, ascending: radial, vertical and radial_rate (q, m) give u_r, u_z and u_r' from these.
    """

    radii: Array
    radii_rate: Array
    measure: Array
    ends: Array
    unknowns: Index
    radial: Array
    vertical: Array
    radial_rate: Array

    def deformed_radii(self, s: Array, stretch: float) -> Array:
        """r_d in beta, (q,)."""
        return np.asarray(self.radii + stretch * (self.radial @ s))

    def areas(self, s: Array, stretch: float) -> Array:
        """Weights of the deformed horizontal area 2 pi r_d dr_d, (q,), in beta^2."""
        return np.asarray(self.measure * self.deformed_radii(s, stretch) * self._radii_rate(s, stretch))

    def area_rates(self, s: Array, stretch: float) -> Array:
        """Derivative by s of the areas, (q, m)."""
        change = self._radii_rate(s, stretch)[:, None] * self.radial
        change += self.deformed_radii(s, stretch)[:, None] * self.radial_rate
        return np.asarray(stretch * self.measure[:, None] * change)

    def area_gradient(self, s: Array, stretch: float, amounts: Array) -> Array:
        """Derivative by s of the areas, summed with the given amounts (q,), (m,)."""
        amounts = stretch * self.measure * amounts
        by_radius = (self._radii_rate(s, stretch) * amounts) @ self.radial
        return np.asarray(by_radius + (self.deformed_radii(s, stretch) * amounts) @ self.radial_rate)

    def area_curvature(self, stretch: float, amounts: Array) -> Array:
        """Second derivative by s of the areas, summed with the given amounts (q,), (m, m)."""
        half = self.radial.T @ ((stretch**2 * self.measure * amounts)[:, None] * self.radial_rate)
        return np.asarray(half + half.T)

    def _radii_rate(self, s: Array, stretch: float) -> Array:
        return np.asarray(self.radii_rate + stretch * (self.radial_rate @ s))

    @property
    def rigid(self) -> ElasticOperator:
        """Operator of a rigid body on the points, with the weights of the undeformed horizontal area."""
        q = self.radii.size
        nodes = np.arange(q).reshape(self.ends.size - 1, -1)
        weights = self.measure * self.radii * self.radii_rate
        return ElasticOperator(self.radii, weights, np.zeros((q, q)), self.ends, nodes)


def contact_surface(space: Space, exterior: Exterior, points: int) -> ContactSurface:
    """Evaluate the contact surface and the reduced unknowns at `points` Gauss points a facet."""
    basis = boundary_basis(space, "contact", points)
    r = basis.global_coordinates()[0].ravel()
    order = np.argsort(r)
    n_z = np.asarray(basis.normals)[1].ravel()[order]
    values = np.array([b[0] for b in basis.basis])
    # The tangent that leads outwards from the pole, where the outward normal points up, is (n_z, -n_r).
    rates = np.array([b[0].grad[0] * basis.normals[1] - b[0].grad[1] * basis.normals[0] for b in basis.basis])
    own = space.boundary_functions("contact")  # the others of a facet's cell vanish on it but for rounding
    at_points, along = (_rows(basis, v)[order][:, own] for v in (values, rates))
    parts = [exterior.reduction.tocsr()[components[own]] for components in space.components]
    moved = np.unique(np.concatenate([part.nonzero()[1] for part in parts]))
    radial, vertical = (part[:, moved].toarray() for part in parts)
    ends = np.sort(space.mesh.p[0, np.unique(space.mesh.facets[:, space.mesh.boundaries["contact"]])])
    fields = (at_points @ radial, at_points @ vertical, along @ radial)
    return ContactSurface(r[order], n_z, 2 * np.pi * basis.dx.ravel()[order], ends, moved, *fields)


def _rows(basis: Any, values: Array) -> sparse.csr_array:
    """Sparse rows, (facets k, functions), from values (functions of a cell, facets, k) of a boundary basis."""
    rows = np.broadcast_to(np.arange(values[0].size).reshape(values[0].shape), values.shape)
    columns = np.broadcast_to(basis.element_dofs[:, :, None], values.shape)
    shape = (values[0].size, basis.N)
    return sparse.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)
