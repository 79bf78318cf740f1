"""Paraboloid, which every smooth surface is close to its pole: Greenwood's sphere, [G97] (2.4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from halfspace.profiles.profile import Dimensionless
from halfspace.values import Array


@dataclass(frozen=True)
class Paraboloid(Dimensionless):
    """r^2/2R, up to the radius `end` in beta."""

    end: float = np.inf

    def height(self, radii: Array) -> Array:
        """Return u^2/2."""
        return np.asarray(radii**2 / 2)

    def slope(self, radii: Array) -> Array:
        """Return u."""
        return np.asarray(radii)


PARABOLOID = Paraboloid()
