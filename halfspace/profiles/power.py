"""Power of the radius, z = r^k/(k R^(k-1)) in lengths R: blunter than a sphere above k = 2, sharper below.

Without adhesion a contact of radius a bears B((k + 2)/2, 1/2) a^(k+1) (L. A. Galin, 1946), B Euler's beta function.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from halfspace.limits import require_between
from halfspace.profiles.profile import Endless
from halfspace.values import Array, keep

SHARPEST, BLUNTEST = 1.5, 10.0


@dataclass(frozen=True)
class Power(Endless):
    """u^k/k in beta^2/R; k = 2 is the paraboloid.

    The exponent k is 1.5 to 10, or InputError: a cone, k = 1, has a pressure without bound on its axis.
    """

    k: float

    def __post_init__(self) -> None:
        remedy = "round a cone's tip: profiles.Hyperboloid; or take 10 for a flat punch"
        keep(self, k=require_between(self.k, "k", SHARPEST, BLUNTEST, remedy, " of the profile"))

    def height(self, radii: Array) -> Array:
        """Return u^k/k."""
        return np.asarray(radii**self.k / self.k)

    def slope(self, radii: Array) -> Array:
        """Return u^(k-1)."""
        return np.asarray(radii ** (self.k - 1))

    @property
    def pointed(self) -> bool:
        """Whether u^k is no polynomial in u^2."""
        return self.k % 2 != 0

    def first_cell(self, tolerance: float) -> float:
        """Radius at which u^k is as small as the tolerance, if it is pointed."""
        return float(tolerance ** (1 / self.k)) if self.pointed else np.inf
