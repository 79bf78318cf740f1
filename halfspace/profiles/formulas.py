"""Profiles by a formula for the height at the radius u, in beta: paraboloid, power, hyperboloid and rounded punch.

And true spheres: one before a wall, or two, each up to the equator of the smaller.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from halfspace.limits import require_between, require_counter_radius, require_radius_ratio
from halfspace.profiles.profile import Dimensionless, Endless, Surface
from halfspace.values import Array, keep


@dataclass(frozen=True)
class Paraboloid(Dimensionless):
    """r^2/2R, up to the radius `end` in beta.

    Every smooth surface is close to one at its pole: Greenwood's sphere, [G97] (2.1) and (2.6).
    """

    end: float = np.inf

    def height(self, radii: Array) -> Array:
        """Return u^2/2."""
        return np.asarray(radii**2 / 2)

    def slope(self, radii: Array) -> Array:
        """Return u."""
        return np.asarray(radii)


PARABOLOID = Paraboloid()


@dataclass(frozen=True)
class Power(Endless):
    """r^k/(k R^(k-1)) in lengths R, or u^k/k in beta^2/R: blunter than a sphere above k = 2, sharper below.

    The exponent k is 1.5 to 10, or InputError: a cone, k = 1, has a pressure without bound on its axis. Without
    adhesion a contact of radius a bears B((k + 2)/2, 1/2) a^(k+1) (L. A. Galin, 1946), B Euler's beta function.
    """

    k: float

    def __post_init__(self) -> None:
        remedy = "round a cone's tip: profiles.Hyperboloid; or take 10 for a flat punch"
        keep(self, k=require_between(self.k, "k", 1.5, 10.0, remedy, " of the profile"))

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


@dataclass(frozen=True)
class Hyperboloid(Endless):
    """Cone with a rounded tip, z = b^2 (sqrt(1 + u^2/b^2) - 1) in beta^2/R; R is its radius at the apex.

    It is u^2/2 near the apex, the cone b u from u = b on; a paraboloid as b grows. The length b is in beta, 0.01 or
    more, or InputError: R tan(angle between cone and plane)/beta.
    """

    b: float

    def __post_init__(self) -> None:
        keep(self, b=require_between(self.b, "b", 1e-2, np.inf, "take a blunter tip", " of the hyperboloid"))

    def height(self, radii: Array) -> Array:
        """Return u^2/(1 + sqrt(1 + u^2/b^2)), without cancellation."""
        return np.asarray(radii**2 / (1 + np.hypot(1, radii / self.b)))

    def slope(self, radii: Array) -> Array:
        """Return u/sqrt(1 + u^2/b^2)."""
        return np.asarray(radii / np.hypot(1, radii / self.b))

    def first_cell(self, tolerance: float) -> float:  # noqa: ARG002 (smooth over the length b)
        """Return the length b of the tip."""
        return self.b


@dataclass(frozen=True)
class RoundedPunch(Endless):
    """Flat punch with a smoothly rounded edge, z = (sqrt(a^2 + u^2) - a)^2/2 in beta^2/R; R is the edge's radius.

    It is u^4/8 a^2 inside, a parabola about u = a far outside. The radius a of the flat part is in beta, 0.1 to 5, or
    InputError; a paraboloid as it vanishes.
    """

    flat: float

    def __post_init__(self) -> None:
        remedy = "a narrower one is a paraboloid, of a wider one each edge is straight"
        keep(self, flat=require_between(self.flat, "flat", 0.1, 5.0, remedy, " beta of the punch"))

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


# True spheres


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
        R = math.sqrt(require_radius_ratio(self.radius_ratio, tabor) / tabor)  # of the pair, 1/R = 1/R1 + 1/R2
        return SphereSurface(R * (1 + 1 / self.counter_radius), R * (1 + self.counter_radius))


@dataclass(frozen=True)
class SphereSurface(Surface):
    """Gap between a sphere and a wall or a larger sphere: the heights R1 - sqrt(R1^2 - r^2) of both add.

    It goes up to the equator of the smaller, the radius `end` = R1/beta; `counter` is R2/beta, infinite for a wall.
    """

    end: float
    counter: float = np.inf

    def height(self, radii: Array) -> Array:
        """Sum of (R/R1) u^2/(1 + cos theta), sin theta = r/R1, without cancellation."""
        return np.asarray(sum(part * radii**2 / (1 + cosine) for part, cosine in self._parts(radii)))

    def slope(self, radii: Array) -> Array:
        """Sum of (R/R1) u/cos theta: infinite at the equator."""
        return np.asarray(sum(part * radii / cosine for part, cosine in self._parts(radii)))

    def _parts(self, radii: Array) -> Iterator[tuple[float, Array]]:
        """R/R1 and cos theta of both spheres, 1/R = 1/R1 + 1/R2.

        The cosine is nan beyond the equator: a trial of Newton's method may end there, and is refused for it.
        """
        for own, other in ((self.end, self.counter), (self.counter, self.end)):
            if np.isfinite(own):
                sine = radii / own
                with np.errstate(invalid="ignore"):
                    yield 1 / (1 + own / other), np.sqrt((1 - sine) * (1 + sine))
