"""The forces of a surface law on a surface that stretches: per which area, and in which direction.

The attraction stretches the surface: a tension sigma widens the area beneath it by the part

    theta = (1 - 2 nu)/(1 - nu) sigma/E*,

since the surface displacement of a point load diverges at its point only (K. L. Johnson, Contact Mechanics (1985), eq
(3.18a) at z = 0). With theta of the order of delta = beta/R, as the finite strains are, what the law's traction is
counted per matters as much as they do. Three conventions, by the work of the traction in a displacement v:

* ``vertical``, the default: -int P v_z dA over the deformed horizontal area dA = 2 pi r_d dr_d. A point of the wall
  attracts as much as if the gap were that of undeformed bodies, so widened matter is attracted as if there were more
  of it: to the first order by int sigma theta dA more than per undeformed area. It has no energy.
* ``normal``: the energy int Phi(H) dA, whose forces are normal to the deformed surface: besides those above, a surface
  stress Phi, which pulls the widened surface together again.
* ``reference``: the energy int Phi(H) dA_0 over the undeformed horizontal area dA_0 = 2 pi r dr. Each particle of the
  surface is attracted by the gap over it alone, however far it is from the next.

Which is right? Of matter that is neither made nor lost, a column that is attracted as a whole holds as much per
undeformed area as before. But free of stress at its surface it becomes thinner by nu/(1 - nu) theta, so more of it is
near: by pairwise summation its energy is (1 + c theta) Phi dA_0, c = nu/(1 - nu), if the attraction reaches less deep
than theta varies. So the truth lies between ``reference``, c = 0, and ``normal``, c = 1, to the first order in
proportion. The traction of ``vertical`` grows too much, by (1 - c) theta, and is not conservative; it is what is meant
by a traction given per area of the deformed surface.

Changes of the linear hemisphere's pull-off load, in R dgamma, at tabor 1, nu = 0.3, sliding mid-plane:

    R/eps   beta/R   linear     vertical   normal    reference
    1000    0.0316   -5.23701   -0.0458    -0.0003   -0.0030
     100    0.1      -5.16350   -0.1114    -0.0116   -0.0093

At R/eps = 1000 int sigma theta dA over the linear state is 0.054; the gap's own change leaves 0.043 of it.
The events of ``normal`` are lost, or differ from degree to degree, where a surface stress -dgamma crumples the surface,
near R/eps = 10 tabor^3: `finite_strain_scene` refuses such spheres. The others go down to R/eps = 2.25 tabor.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import sparse

from fem_adhesion.finite_strain_surface import ContactSurface, scaled
from halfspace.compliance import Array
from halfspace.values import Valued

ConventionName = Literal["vertical", "normal", "reference"]


@dataclass(frozen=True)
class Convention:
    """What the law's traction is counted per, and its direction.

    Attributes
    ----------
    surface_stress : float
        c, of the surface over the energy Phi: 0 if the traction is vertical, 1 if it is normal to the deformed surface.
    deformed_area : bool
        Whether it acts on the deformed horizontal area; c is without effect unless it does.
    """

    surface_stress: float = 0.0
    deformed_area: bool = True

    @property
    def conservative(self) -> bool:
        """Whether the forces derive from the energy int Phi(H) dA."""
        return not self.deformed_area or self.surface_stress == 1.0


CONVENTIONS: dict[ConventionName, Convention] = {
    "vertical": Convention(),
    "normal": Convention(surface_stress=1.0),
    "reference": Convention(deformed_area=False),
}


@dataclass(frozen=True, eq=False, repr=False)
class Traction(Valued):
    """Forces of a surface law by one of the conventions above, or between two of them.

    Attributes
    ----------
    surface : ContactSurface
        Where the law acts.
    tabor : float
        Tabor parameter mu.
    stretch : float
        Of the area: delta = beta/R, or zero for the undeformed one.
    surface_stress : float
        c of `Convention`.
    """

    surface: ContactSurface
    tabor: float
    stretch: float
    surface_stress: float

    def areas(self, y: Array) -> Array:
        """Weights of the horizontal area, (q,), in beta^2."""
        return self.surface.areas(y, self.stretch)

    def area_gradient(self, y: Array, amounts: Array) -> Array:
        """Derivative by y of the areas, summed with the given amounts (q,), (n,)."""
        return self.surface.area_gradient(y, self.stretch, amounts)

    def forces(self, y: Array, P: Array, Phi: Array) -> Array:
        """Less the forces on the reduced unknowns, (n,), in R dgamma: upwards where the pressure is downwards.

        Parameters
        ----------
        y : (n,) array
            Reduced unknowns.
        P, Phi : (q,) array
            Pressure and energy of the law.
        """
        spreading = self.area_gradient(y, self.surface_stress / self.tabor * Phi)
        return np.asarray(self.surface.vertical.T @ (P * self.areas(y)) + spreading)

    def tangent(self, y: Array, P: Array, Phi: Array, slope: Array) -> sparse.csr_array:
        """Derivative of `forces` by y, (n, n), for the law's slope dP/dH, (q,)."""
        s, mu, c, delta = self.surface, self.tabor, self.surface_stress, self.stretch
        tangent = s.vertical.T @ scaled(-mu * slope * self.areas(y), s.vertical)
        if delta:
            rates = s.area_rates(y, delta)
            tangent = tangent + s.vertical.T @ scaled(P, rates)
            if c:
                tangent = tangent + c * (rates.T @ scaled(P, s.vertical)) + s.area_curvature(delta, c / mu * Phi)
        return sparse.csr_array(tangent)
