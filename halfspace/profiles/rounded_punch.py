"""Flat punch with a rounded edge, smooth where the one goes over into the other; R is the radius of the rounding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from halfspace.limits import require_between
from halfspace.profiles.profile import Endless
from halfspace.values import Array, keep

NARROWEST, WIDEST = 0.1, 5.0


@dataclass(frozen=True)
class RoundedPunch(Endless):
    """z = (sqrt(a^2 + u^2) - a)^2/2 in beta^2/R: u^4/8 a^2 inside, a parabola about u = a far outside.

    The radius a of the flat part is in beta, 0.1 to 5, or InputError; a paraboloid as it vanishes.
    """

    flat: float

    def __post_init__(self) -> None:
        remedy = "a narrower one is a paraboloid, of a wider one each edge is straight"
        keep(self, flat=require_between(self.flat, "flat", NARROWEST, WIDEST, remedy, " of the punch"))

    def _rise(self, radii: Array) -> Array:
        """Return sqrt(a^2 + u^2) - a, without cancellation."""
        return np.asarray(radii**2 / (self.flat + np.hypot(self.flat, radii)))

    def height(self, radii: Array) -> Array:
        """Return its square over 2."""
        return self._rise(radii) ** 2 / 2

    def slope(self, radii: Array) -> Array:
        """Return it times u/sqrt(a^2 + u^2)."""
        return self._rise(radii) * radii / np.hypot(self.flat, radii)

    def first_cell(self, tolerance: float) -> float:  # noqa: ARG002 (smooth over the length a)
        """Return the radius a: the height is singular at as far from the axis, at imaginary radii."""
        return self.flat
