"""Frictionless contact with any profile, in closed integrals: Hertz's problem after Sneddon, and JKR's.

Lengths in beta, loads in R dgamma, E* = 1, approaches in beta^2/R = mu eps. After I. N. Sneddon, Int. J. Engng Sci. 3
(1965) 47, with r = a sin(theta),

    alpha = a int z'(r) dtheta,      W = 2 a^2 int sin(theta)^2 z'(r) dtheta,      0 < theta < pi/2;

adhesion draws the surface up as a flat punch would, which takes sqrt(2 pi a) of the approach and sqrt(8 pi a^3) of the
load (D. Maugis and M. Barquins, J. Phys. D 11 (1978) 1989). A body that is s times as soft bears 1/s of Hertz's load
and 1/sqrt(s) of the punch's.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from halfspace.profiles.profile import Surface
from halfspace.roots import rising_root
from halfspace.values import Array


@cache
def _quarter() -> tuple[Array, Array]:
    """Sines and weights of a rule over a quarter turn, which crowds to the axis as t^3 where a slope may be a root."""
    x, w = np.polynomial.legendre.leggauss(64)
    t = (1 + x) / 2
    return np.sin(np.pi / 2 * t**3), np.pi / 2 * 3 * t**2 * w / 2


def hertz_approach(surface: Surface, radius: ArrayLike) -> Array:
    """Approach at contact radii without adhesion."""
    sine, weight = _quarter()
    a = np.asarray(radius, float)
    return np.asarray(a * (surface.slope(a[..., None] * sine) @ weight))


def hertz_load(surface: Surface, radius: ArrayLike) -> Array:
    """Load at contact radii without adhesion."""
    sine, weight = _quarter()
    a = np.asarray(radius, float)
    return np.asarray(2 * a**2 * (surface.slope(a[..., None] * sine) @ (weight * sine**2)))


def jkr_approach(surface: Surface, radius: ArrayLike) -> Array:
    """JKR's approach at contact radii."""
    return hertz_approach(surface, radius) - np.sqrt(2 * np.pi * np.asarray(radius))


def jkr_load(surface: Surface, radius: ArrayLike, softness: float = 1.0) -> Array:
    """JKR's load at contact radii."""
    return hertz_load(surface, radius) / softness - np.sqrt(8 * np.pi * np.asarray(radius) ** 3 / softness)


def jkr_fold(surface: Surface) -> float:
    """Least approach by JKR's theory, to a per cent: where contact is lost under fixed grips."""
    return float(jkr_approach(surface, _radii(surface)).min())


def jkr_least_load(surface: Surface) -> float:
    """Least load by JKR's theory, to a per cent: where contact is lost under dead load, -3 pi/2 on a paraboloid."""
    return float(jkr_load(surface, _radii(surface)).min())


def _radii(surface: Surface) -> Array:
    a = np.geomspace(1e-4, 1e4, 400)
    return a[a < surface.end]


def hertz_radius(surface: Surface, load: float, softness: float = 1.0) -> float:
    """Contact radius under a load without adhesion, or the end of the surface if it is wider."""
    return _bearing(lambda a: float(hertz_load(surface, a)) / softness, surface, load)


def jkr_radius(surface: Surface, load: float, softness: float = 1.0) -> float:
    """Contact radius under a load of zero or more by JKR's theory, or the end of the surface if it is wider."""
    return _bearing(lambda a: float(jkr_load(surface, a, softness)), surface, load)


def _bearing(load_at: Callable[[float], float], surface: Surface, load: float) -> float:
    """Radius of the widest contact that bears no more than a load, or the end of the surface."""
    what = f"the contact of this profile that bears {load:g} R dgamma; let it grow more steeply outwards"
    return rising_root(lambda a: load_at(a) - load, what, end=surface.end, farthest=1e12)
