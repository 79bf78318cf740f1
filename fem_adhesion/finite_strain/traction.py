"""The forces of a surface law on a surface that stretches: per which area, and in which direction.

Underneath is the wall's potential on every particle of the body: the attraction per undeformed volume at a gap H is
-sigma(H), of which Phi(H) is the sum over a column of undeformed matter, and no matter is made or lost. A column whose
particles keep their distances has the energy Phi dA_0. But the attraction stretches it, by e_z downwards and by theta
in its area, so that to the first order it has Phi (1 - e_z) dA_0. Half-space and 3-9 law, M = lambda + 2 G:

    e_z = sigma/M - nu/(1 - nu) theta,    theta = (1 - 2 nu)/(1 - nu) sigma/E*

(the surface displacement of a point load diverges at its point only: K. L. Johnson, Contact Mechanics (1985), eq
(3.18a) at z = 0). What theta does is a matter of shape, and the same as the energy

    (1 - c) int Phi dA_0 + c int Phi dA,    c = nu/(1 - nu),    dA = (1 + theta) dA_0:

the matter below a widened area becomes thinner, so that more of it is near, wholly if it is incompressible. What sigma
does is the yield of the attracted layer itself, in which the stress builds up only: with the strain that it saves,

    Delta Phi(h) = -(1/M) [Phi sigma + 1/2 int_h^inf sigma^2 dh'],    M = E* (1 - nu)^2/(1 - 2 nu),

a change of the law. It moves the surfaces' equilibrium, too, and deepens it from dgamma to `yielded_adhesion`.

* ``projected``, the default: the energy above. By the summed model, solved for itself, c = 0.42 at nu = 0.3.
* ``reference``: c = 0, each particle of the surface attracted by the gap over it, however far it is from the next.
* ``normal``: c = 1, forces normal to the deformed surface; besides, the surface stress Phi pulls the widened surface
  together again.
* ``vertical``: the work of the traction in a displacement v is -int P v_z dA over the deformed area: stretched matter
  counts as new matter. It has no energy.

All that is of a deep column. At the equator of a sphere a column has no depth; one from H down to H_0 has the energy
(1 + c theta) [Phi(H) - Phi(H_0)] dA_0, and no surface stress is left where H = H_0. Were c Phi to end there at once, it
would pull on the equator with f = delta c Phi/mu per length, on either half of the sphere. Under a line force the
displacement has no bound, u = -(4 f/pi) ln s at a distance s, nor have the energy and the load: each cut of the cells,
and each degree, would go on adding dW = 8 delta c^2 Phi P/mu d(ln s) to them. So c falls to zero there, within eps,
closer than which no surface law has a meaning: with the height d above the equator's plane, in eps, to

    c [1 - exp(-d^2)].

The surface stress c Phi couples a wave of the surface's height with its slope along the surface, with c sigma, and both
with the body's stiffness per wave number k: on a half-space

    k [[D, i (B + c sigma)], [-i (B + c sigma), D]],    D = 4 G (1 - nu)/(3 - 4 nu),    B = 2 G (1 - 2 nu)/(3 - 4 nu)

for v = (u_z, u_x), not positive definite, at every wavelength at once, from c sigma = 2 G/(3 - 4 nu) on: the equations
are ill-posed there, and what is computed depends on the mesh. See
`fem_adhesion.finite_strain.scene.require_well_posed`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from fem_adhesion.elasticity.exterior import Exterior
from fem_adhesion.elasticity.space import Space
from fem_adhesion.elasticity.surface import BoundaryPoints, boundary_points
from halfspace.elastic.compliance import ElasticOperator
from halfspace.laws import LENNARD_JONES, Law
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True)
class Convention:
    """What the law's traction is counted per, and whether it spreads the surface.

    `deformed_area` is the part of the traction that is counted per deformed horizontal area, the rest being per
    undeformed one; `surface_stress` is that of the surface, over the energy Phi.
    """

    deformed_area: float
    surface_stress: float

    @property
    def conservative(self) -> bool:
        """Whether the forces derive from the energy int Phi(H) dA, dA being the area that is counted per."""
        return self.deformed_area == self.surface_stress


def convention_of(traction: str, poisson: float) -> Convention:
    """Convention by its name in `fem_adhesion.materials.NeoHookean`."""
    share = poisson / (1 - poisson)
    conventions = {
        "projected": Convention(share, share),
        "reference": Convention(0.0, 0.0),
        "normal": Convention(1.0, 1.0),
        "vertical": Convention(1.0, 0.0),
    }
    return conventions[traction]


def yielded_adhesion(tabor: float, radius_ratio: float, poisson: float, law: Law = LENNARD_JONES) -> float:
    """Work of adhesion over dgamma once the attracted layer has yielded, 1 + 0.274 tabor (beta/R) E*/M for the 3-9 law.

    That is -Phi(eps) - Delta Phi(eps), to the first order in beta/R, of any law that is the sum of what attracts the
    matter at every depth; forces between charges on the surfaces stretch no layer.
    """
    from scipy.integrate import quad  # it takes as long to load as all else, and few need it

    def squared(gap: float) -> float:
        return float(law.pressure(np.array(gap), 1.0)) ** 2

    integral = sum(quad(squared, *ends)[0] for ends in pairwise((0.0, law.edge_gap, np.inf)))
    compliance = (1 - 2 * poisson) / (1 - poisson) ** 2
    return 1 + integral / 2 * tabor * math.sqrt(tabor / radius_ratio) * compliance


@dataclass(frozen=True, eq=False, repr=False)
class Traction(Valued):
    """Forces of a surface law by a convention, at the Tabor parameter mu.

    The stretch is that of the deformed area, delta = beta/R; columns (q,) are the parts of the convention's numbers
    that hold over what matter there is below the points: 1 but next to an equator.
    """

    surface: ContactSurface
    tabor: float
    stretch: float
    convention: Convention
    columns: Array

    def areas(self, s: Array) -> Array:
        """Weights of the horizontal area, (q,), in beta^2."""
        part = self._deformed_area
        undeformed, deformed = (self.surface.areas(s, stretch) for stretch in (0.0, self.stretch))
        return np.asarray((1 - part) * undeformed + part * deformed)

    def area_gradient(self, s: Array, amounts: Array) -> Array:
        """Derivative by s of the areas, summed with the given amounts (q,), (m,)."""
        return np.asarray((self._deformed_area * amounts) @ self.surface.area_rates(s, self.stretch))

    def forces(self, s: Array, P: Array, Phi: Array) -> Array:
        """Less the forces on the surface's unknowns, (m,), in R dgamma: upwards where the pressure is downwards.

        s (m,) are the unknowns of the surface, P and Phi (q,) the pressure and energy of the law.
        """
        spreading = (self._surface_stress / self.tabor * Phi) @ self.surface.area_rates(s, self.stretch)
        return np.asarray((P * self.areas(s)) @ self.surface.vertical + spreading)

    def tangent(self, s: Array, P: Array, Phi: Array, slope: Array) -> Array:
        """Derivative of `forces` by s, (m, m), for the law's slope dP/dH, (q,)."""
        surface, mu, delta, c = self.surface, self.tabor, self.stretch, self.convention
        V = surface.vertical
        tangent = V.T @ ((-mu * slope * self.areas(s))[:, None] * V)
        coupling = V.T @ ((self.columns * P)[:, None] * surface.area_rates(s, delta))
        tangent += c.deformed_area * coupling + c.surface_stress * coupling.T
        tangent += surface.area_curvature(delta, self._surface_stress / mu * Phi)
        return np.asarray(tangent)

    @property
    def _deformed_area(self) -> Array:
        return self.convention.deformed_area * self.columns

    @property
    def _surface_stress(self) -> Array:
        return self.convention.surface_stress * self.columns


def columns(depths: Array) -> Array:
    """Parts of a convention's numbers that hold over matter of these depths in eps, infinite but over a sphere."""
    return np.asarray(-np.expm1(-(depths**2)))


# The contact surface


@dataclass(frozen=True, eq=False, repr=False)
class ContactSurface(Valued):
    """Gauss points of the contact facets by radius, q in all, and the m unknowns s that move them.

    The points are those of the undeformed surface. Unknowns (m,) are the body's reduced ones that are not zero there,
    ascending: radial, vertical and radial_rate (q, m) give u_r, u_z and u_r', the derivative by the arclength, from
    these.
    """

    points: BoundaryPoints
    unknowns: Index
    radial: Array
    vertical: Array
    radial_rate: Array

    def deformed_radii(self, s: Array, stretch: float) -> Array:
        """r_d in beta, (q,)."""
        return np.asarray(self.points.radii + stretch * (self.radial @ s))

    def areas(self, s: Array, stretch: float) -> Array:
        """Weights of the deformed horizontal area 2 pi r_d dr_d, (q,), in beta^2."""
        return np.asarray(self._measure * self.deformed_radii(s, stretch) * self._radii_rate(s, stretch))

    def area_rates(self, s: Array, stretch: float) -> Array:
        """Derivative by s of the areas, (q, m)."""
        change = self._radii_rate(s, stretch)[:, None] * self.radial
        change += self.deformed_radii(s, stretch)[:, None] * self.radial_rate
        return np.asarray(stretch * self._measure[:, None] * change)

    def area_curvature(self, stretch: float, amounts: Array) -> Array:
        """Second derivative by s of the areas, summed with the given amounts (q,), (m, m)."""
        half = self.radial.T @ ((stretch**2 * self._measure * amounts)[:, None] * self.radial_rate)
        return np.asarray(half + half.T)

    @cached_property
    def _measure(self) -> Array:
        """2 pi ds, (q,)."""
        return np.asarray(2 * np.pi * self.points.lengths.ravel())

    def _radii_rate(self, s: Array, stretch: float) -> Array:
        """r_d', which is n_z as long as nothing moves."""
        return np.asarray(self.points.normals[1].ravel() + stretch * (self.radial_rate @ s))

    @property
    def rigid(self) -> ElasticOperator:
        """Operator of a rigid body on the points, with the weights of the undeformed horizontal area."""
        points = self.points
        rigid = np.zeros(2 * points.radii.shape)
        return ElasticOperator(points.radii, points.weights(), points.ends, points.facet_points, compliance=rigid)


def contact_surface(space: Space, exterior: Exterior, points: int) -> ContactSurface:
    """Evaluate the contact surface and the reduced unknowns at `points` Gauss points a facet."""
    trace = boundary_points(space, "contact", points)
    parts = [exterior.reduction.tocsr()[components[trace.functions]] for components in space.components]
    moved = np.unique(np.concatenate([part.nonzero()[1] for part in parts]))
    radial, vertical = (part[:, moved].toarray() for part in parts)
    return ContactSurface(trace, moved, trace.values @ radial, trace.values @ vertical, trace.rates @ radial)
