"""Closed-form theories of adhesive contact, the limits that the numerical solutions must meet.

Loads in R dgamma, positive in compression; radii in beta; approaches in eps unless said otherwise; E* = 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def bradley_load(approach: ArrayLike) -> Array:
    """Load on a rigid paraboloid, [G97] (1.3): the limit of vanishing Tabor parameter.

    Parameters
    ----------
    approach : array_like
        Approach alpha* in eps, below 1; the central gap is 1 - alpha*.
    """
    h = 1 - np.asarray(approach, float)
    return np.asarray(-2 * np.pi * (4 / 3) * (h**-2 - h**-8 / 4))


def hertz_load(radius: ArrayLike) -> Array:
    """Load at a contact radius without adhesion, [G97] (1.4): W = 4 a^3/3."""
    return np.asarray(4 / 3 * np.asarray(radius, float) ** 3)


def jkr_radius(load: ArrayLike) -> Array:
    """Contact radius of the stable JKR branch at a load above -3 pi/2, [G97] (1.5)."""
    W = np.asarray(load, float)
    a3 = 3 / 4 * (W + 3 * np.pi + np.sqrt(6 * np.pi * W + 9 * np.pi**2))
    return np.asarray(np.cbrt(a3))


def jkr_load(radius: ArrayLike) -> Array:
    """JKR load at a contact radius: W = 2 pi 3 (s^3 - s^(3/2)), s = a/a0, a0^3 = 9 pi/2."""
    s = np.asarray(radius, float) / np.cbrt(9 * np.pi / 2)
    return np.asarray(6 * np.pi * (s**3 - s**1.5))


def jkr_approach(radius: ArrayLike, tabor: float) -> Array:
    """JKR approach in eps at a contact radius: alpha*/mu = (9 pi/2)^(2/3) (s^2 - 2 sqrt(s)/3)."""
    a0 = np.cbrt(9 * np.pi / 2)
    s = np.asarray(radius, float) / a0
    return np.asarray(tabor * a0**2 * (s**2 - 2 / 3 * np.sqrt(s)))


JKR_PULL_OFF = -1.5 * np.pi
BRADLEY_PULL_OFF = -2 * np.pi
