"""True spheres: one before a wall, or two, each up to the equator of the smaller."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from halfspace.limits import require_counter_radius, require_radius_ratio
from halfspace.profiles.profile import Dimensionless, Surface
from halfspace.values import Array, Valued, keep


@dataclass(frozen=True)
class Sphere:
    """Gap between a sphere and a wall, or another sphere.

    The ratio is rho = R/eps, 2 to 1e12; R/beta = sqrt(rho/tabor) is 1.5 or more. Of two spheres 1/R = 1/R1 + 1/R2, and
    the counter-radius is R2/R1, 1 or more; infinite for a wall. InputError if one is out of range.
    """

    radius_ratio: float
    counter_radius: float = math.inf

    def __post_init__(self) -> None:
        keep(
            self,
            radius_ratio=require_radius_ratio(self.radius_ratio),
            counter_radius=require_counter_radius(self.counter_radius),
        )

    def surface(self, tabor: float) -> Surface:
        """Heights in beta^2/R; raise InputError where the sphere is as small as its contact."""
        return between_spheres(math.sqrt(require_radius_ratio(self.radius_ratio, tabor) / tabor), self.counter_radius)


@dataclass(frozen=True)
class SphereSurface(Dimensionless):
    """R - sqrt(R^2 - r^2), up to its equator, the radius `end` = R/beta."""

    end: float

    def height(self, radii: Array) -> Array:
        """Return u^2/(1 + cos theta), sin theta = r/R, without cancellation."""
        return np.asarray(radii**2 / (1 + self._cosine(radii)))

    def slope(self, radii: Array) -> Array:
        """Return u/cos theta: infinite at the equator."""
        return np.asarray(radii / self._cosine(radii))

    def _cosine(self, radii: Array) -> Array:
        """Return cos theta, nan beyond the equator: a trial of Newton's method may end there, and is refused for it."""
        sine = radii / self.end
        with np.errstate(invalid="ignore"):
            return np.asarray(np.sqrt((1 - sine) * (1 + sine)))


@dataclass(frozen=True, eq=False, repr=False)
class PairSurface(Valued, Dimensionless):
    """Gap between two surfaces of radii R1 and R2, 1/R = 1/R1 + 1/R2: their heights add.

    The first and second are in their own units, beta^2/R1 and beta^2/R2; the parts are R/R1 and R/R2.
    """

    first: Surface
    second: Surface
    parts: tuple[float, float]

    @property
    def end(self) -> float:
        """Radius in beta at which the smaller surface ends."""
        return min(self.first.end, self.second.end)

    def height(self, radii: Array) -> Array:
        """Sum of the heights."""
        return self.parts[0] * self.first.height(radii) + self.parts[1] * self.second.height(radii)

    def slope(self, radii: Array) -> Array:
        """Sum of the slopes."""
        return self.parts[0] * self.first.slope(radii) + self.parts[1] * self.second.slope(radii)


def between_spheres(R: float, counter_radius: float = np.inf) -> Surface:
    """Gap between a sphere and another of R2/R1 times its radius, or a wall if that is infinite.

    The radius R of the pair is in beta, 1/R = 1/R1 + 1/R2.
    """
    if np.isinf(counter_radius):
        return SphereSurface(R)
    first, second = R * (1 + 1 / counter_radius), R * (1 + counter_radius)
    return PairSurface(SphereSurface(first), SphereSurface(second), (R / first, R / second))
