"""The contact surface of a body at finite strain: its Gauss points, and displacements and their rates at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_adhesion.elasticity.boundaries import Exterior, trace_on
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
    trace = trace_on(space, "contact", points)
    radii, n_z = trace.places[0].ravel(), trace.normals[1].ravel()
    order = np.argsort(radii)
    parts = [exterior.reduction.tocsr()[components[trace.functions]] for components in space.components]
    moved = np.unique(np.concatenate([part.nonzero()[1] for part in parts]))
    radial, vertical = (part[:, moved].toarray() for part in parts)
    ends = np.sort(space.mesh.p[0, np.unique(space.mesh.facets[:, space.mesh.boundaries["contact"]])])
    measure, at_points, along = 2 * np.pi * trace.lengths.ravel()[order], trace.values[order], trace.rates[order]
    fields = (at_points @ radial, at_points @ vertical, along @ radial)
    return ContactSurface(radii[order], n_z[order], measure, ends, moved, *fields)
