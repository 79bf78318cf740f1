"""Hyperboloid: a cone with a rounded tip, z = b^2 (sqrt(1 + u^2/b^2) - 1) in beta^2/R; R is its radius at the apex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from halfspace.limits import require_between
from halfspace.profiles.profile import Endless
from halfspace.values import Array, keep

SHARPEST = 1e-2


@dataclass(frozen=True)
class Hyperboloid(Endless):
    """u^2/2 near the apex, the cone b u from u = b on; a paraboloid as b grows.

    b is in beta, 0.01 or more, or InputError: R tan(angle between cone and plane)/beta.
    """

    b: float

    def __post_init__(self) -> None:
        keep(self, b=require_between(self.b, "b", SHARPEST, np.inf, "take a blunter tip", " of the hyperboloid"))

    def height(self, radii: Array) -> Array:
        """Return u^2/(1 + sqrt(1 + u^2/b^2)), without cancellation."""
        return np.asarray(radii**2 / (1 + np.hypot(1, radii / self.b)))

    def slope(self, radii: Array) -> Array:
        """Return u/sqrt(1 + u^2/b^2)."""
        return np.asarray(radii / np.hypot(1, radii / self.b))

    def first_cell(self, tolerance: float) -> float:  # noqa: ARG002 (smooth over the length b)
        """Return the length b of the tip."""
        return self.b
