"""Surface known at a number of radii, with its slopes there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from halfspace.profiles.profile import Dimensionless
from halfspace.values import Array, Valued

if TYPE_CHECKING:
    from scipy.interpolate import CubicHermiteSpline


@dataclass(frozen=True, eq=False, repr=False)
class TabulatedSurface(Valued, Dimensionless):
    """Heights (n,) at ascending radii (n,), with their slopes: the surface of a body that is given as a mesh."""

    radii: Array
    heights: Array
    slopes: Array

    @property
    def end(self) -> float:
        """Radius in beta at which the surface ends."""
        return float(self.radii[-1])

    def height(self, radii: Array) -> Array:
        """Cubic between the points."""
        return np.asarray(self._spline(radii))

    def slope(self, radii: Array) -> Array:
        """Its derivative."""
        return np.asarray(self._spline(radii, 1))

    @cached_property
    def _spline(self) -> CubicHermiteSpline:
        from scipy.interpolate import CubicHermiteSpline  # it takes as long to load as all else, and few need it

        return CubicHermiteSpline(self.radii, self.heights, self.slopes)
