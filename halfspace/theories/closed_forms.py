"""Closed-form theories of adhesive contact, the limits that the numerical solutions must meet: Hertz, Bradley, JKR.

Loads in R dgamma, positive in compression; radii in beta; approaches in eps unless said otherwise; E* = 1. In these
units neither JKR's nor Hertz's load and radius contain the spacing eps: the Tabor parameter mu enters only as the unit
of the approach, beta^2/R = mu eps. A quantity is nan where the theory has no contact. Functions named `..._at` take
the approach. Derjaguin, Muller and Toporov's theories are in `halfspace.theories.dmt`, Maugis's in
`halfspace.theories.maugis`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from halfspace.values import Array

JKR_PULL_OFF = -1.5 * np.pi
BRADLEY_PULL_OFF = -2 * np.pi
ZERO_LOAD_RADIUS = float(np.cbrt(9 * np.pi / 2))  # a0, JKR's contact radius under no load


@dataclass(frozen=True)
class ContactState:
    """A point of a theory's load-approach curve: approach (eps), load (R dgamma) and contact radius (beta)."""

    approach: float
    load: float
    contact_radius: float


def bradley_load(approach: ArrayLike) -> Array:
    """Load on a rigid paraboloid at an approach alpha* below 1, [G97] (1.3): the limit of vanishing Tabor parameter."""
    h = 1 - np.asarray(approach, float)
    return np.asarray(-2 * np.pi * (4 / 3) * (h**-2 - h**-8 / 4))


def hertz_load(radius: ArrayLike) -> Array:
    """Load at a contact radius without adhesion, [G97] (1.4): W = 4 a^3/3."""
    return np.asarray(4 / 3 * np.asarray(radius, float) ** 3)


def hertz_radius(load: ArrayLike) -> Array:
    """Contact radius under a compressive load, [G97] (1.4): a^3 = 3 W/4."""
    return np.asarray(np.cbrt(3 / 4 * np.asarray(load, float)))


def hertz_approach(radius: ArrayLike, tabor: float) -> Array:
    """Approach at a contact radius, [G97] (1.4): alpha = a^2/R, alpha* = mu a^2."""
    return np.asarray(tabor * np.asarray(radius, float) ** 2)


def hertz_radius_at(approach: ArrayLike, tabor: float) -> Array:
    """Contact radius at an approach alpha* >= 0 without adhesion."""
    return _root(np.asarray(approach, float) / tabor)


def hertz_gap(radii: ArrayLike, contact_radius: ArrayLike, tabor: float) -> Array:
    """Gap H around a Hertz contact, [G97] section 4: (mu a^2/pi) [sqrt(x^2 - 1) + (x^2 - 2) arccos(1/x)], x = r/a."""
    r, a = np.asarray(radii, float), np.asarray(contact_radius, float)
    return np.asarray(tabor * a**2 / np.pi * gap_shape(_root((r / a) ** 2 - 1)))


def gap_shape(z: Array) -> Array:
    """Bracket of `hertz_gap` at z = sqrt(x^2 - 1), where it is analytic: z + (z^2 - 1) arctan z."""
    return np.asarray(z + (z**2 - 1) * np.arctan(z))


def jkr_load(radius: ArrayLike) -> Array:
    """JKR load at a contact radius: W = 2 pi 3 (s^3 - s^(3/2)), s = a/a0, a0^3 = 9 pi/2."""
    s = np.asarray(radius, float) / ZERO_LOAD_RADIUS
    return np.asarray(6 * np.pi * (s**3 - s**1.5))


def jkr_approach(radius: ArrayLike, tabor: float) -> Array:
    """JKR approach in eps at a contact radius: alpha*/mu = (9 pi/2)^(2/3) (s^2 - 2 sqrt(s)/3)."""
    s = np.asarray(radius, float) / ZERO_LOAD_RADIUS
    return np.asarray(tabor * ZERO_LOAD_RADIUS**2 * (s**2 - 2 / 3 * np.sqrt(s)))


def jkr_radius(load: ArrayLike) -> Array:
    """Contact radius under a load above -3 pi/2, on the branch stable under dead load, [G97] (1.5)."""
    W = np.asarray(load, float)
    return np.asarray(np.cbrt(3 / 4 * (W + 3 * np.pi + 3 * np.pi * _root(1 - W / JKR_PULL_OFF))))


def jkr_radius_at(approach: ArrayLike, tabor: float) -> Array:
    """Contact radius at an approach, on the branch stable under fixed grips: s >= 6^(-2/3).

    With q = sqrt(s) and d = alpha*/(mu a0^2) the approach is the quartic q^4 - 2 q/3 - d = 0. Ferrari completes the
    square, (q^2 + m)^2 = 2 m (q + 1/(6 m))^2, with m^3 + d m = 1/18, which Cardano solves by m = A - B, A B = d/3.
    """
    d = np.asarray(approach, float) / (tabor * ZERO_LOAD_RADIUS**2)
    A = np.cbrt(1 / 36 + _root(1 / 36**2 + d**3 / 27))
    B = d / (3 * A)
    m = 1 / 18 / (A**2 + A * B + B**2)  # A - B, which would cancel in compression
    q = (np.sqrt(2 * m) + _root(np.sqrt(8 / (9 * m)) - 2 * m)) / 2
    return np.asarray(ZERO_LOAD_RADIUS * q**2)


def jkr_load_at(approach: ArrayLike, tabor: float) -> Array:
    """JKR load at an approach, on the branch stable under fixed grips."""
    return jkr_load(jkr_radius_at(approach, tabor))


def jkr_pull_off(tabor: float) -> ContactState:
    """Where contact is lost under dead load: the least load, -3 pi/2, at s = 2^(-2/3)."""
    return _jkr_state(2 ** (-2 / 3), tabor)


def jkr_jump_off(tabor: float) -> ContactState:
    """Where contact is lost under fixed grips: the least approach, -(3/4) pi^(2/3) mu, at s = 6^(-2/3)."""
    return _jkr_state(6 ** (-2 / 3), tabor)


def jkr_zero_load(tabor: float) -> ContactState:
    """Contact under no load, s = 1, where the jump on lands under dead load.

    JKR's attraction has no range, so that the surfaces jump on when they touch: at alpha* = 0 and W = 0.
    """
    return _jkr_state(1.0, tabor)


def jkr_zero_approach(tabor: float) -> ContactState:
    """Contact at zero approach, s = (2/3)^(2/3) and W = -4 pi/3, where the jump on lands under fixed grips."""
    return _jkr_state((2 / 3) ** (2 / 3), tabor)


def _jkr_state(s: float, tabor: float) -> ContactState:
    a = s * ZERO_LOAD_RADIUS
    return ContactState(float(jkr_approach(a, tabor)), float(jkr_load(a)), a)


def _root(x: Array) -> Array:
    """Square root of a number of order one: 0 for what rounding took below it, nan for what is negative indeed."""
    return np.asarray(np.sqrt(np.where(x > -1e-14, np.maximum(x, 0), np.nan)))
