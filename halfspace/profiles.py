"""Undeformed gap profiles: the height of the sphere's surface over its pole, in beta^2/R = mu eps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from halfspace.values import Valued

if TYPE_CHECKING:
    from scipy.interpolate import CubicHermiteSpline

Array = NDArray[np.float64]


class Profile(Protocol):
    """Height of the undeformed surface over its pole as a function of the radius."""

    @property
    def end(self) -> float:
        """Radius in beta at which the surface ends; infinite if it does not."""
        ...

    def height(self, radii: Array) -> Array:
        """Height in beta^2/R at radii in beta."""
        ...

    def slope(self, radii: Array) -> Array:
        """Derivative of the height by the radius."""
        ...


@dataclass(frozen=True)
class Paraboloid:
    """r^2/2R, up to the radius `end` in beta."""

    end: float = np.inf

    def height(self, radii: Array) -> Array:
        """Return u^2/2."""
        return np.asarray(radii**2 / 2)

    def slope(self, radii: Array) -> Array:
        """Return u."""
        return np.asarray(radii)


PARABOLOID = Paraboloid()


@dataclass(frozen=True)
class Sphere:
    """R - sqrt(R^2 - r^2), up to its equator, the radius `end` = R/beta."""

    end: float

    def height(self, radii: Array) -> Array:
        """Return u^2/(1 + cos theta), sin theta = r/R, without cancellation."""
        return np.asarray(radii**2 / (1 + self._cosine(radii)))

    def slope(self, radii: Array) -> Array:
        """Return u/cos theta: infinite at the equator."""
        return np.asarray(radii / self._cosine(radii))

    def _cosine(self, radii: Array) -> Array:
        sine = radii / self.end
        return np.asarray(np.sqrt((1 - sine) * (1 + sine)))


@dataclass(frozen=True, eq=False, repr=False)
class Pair(Valued):
    """Gap between two surfaces of radii R1 and R2, 1/R = 1/R1 + 1/R2: their heights add.

    Parameters
    ----------
    first, second : Profile
        In their own units, beta^2/R1 and beta^2/R2.
    parts : pair of float
        R/R1 and R/R2.
    """

    first: Profile
    second: Profile
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


def between_spheres(R: float, counter_radius: float = np.inf) -> Profile:
    """Gap between a sphere and another, or a wall.

    Parameters
    ----------
    R : float
        Radius of the pair in beta, 1/R = 1/R1 + 1/R2.
    counter_radius : float
        R2/R1; infinite for a wall.
    """
    if np.isinf(counter_radius):
        return Sphere(R)
    first, second = R * (1 + 1 / counter_radius), R * (1 + counter_radius)
    return Pair(Sphere(first), Sphere(second), (R / first, R / second))


@dataclass(frozen=True, eq=False, repr=False)
class Tabulated(Valued):
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
