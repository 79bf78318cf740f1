"""Maugis's theory: a constant tension over an annulus around the contact, from DMT-M to JKR with one parameter.

D. Maugis, J. Colloid Interface Sci. 150 (1992) 243, in the units of the project: loads in R dgamma, radii in beta,
approaches in eps, tensions in dgamma/(mu eps), E* = 1. The tension s acts from the contact radius a to c, where the
surfaces have parted by eps mu/s. With m = c/a, z = sqrt(m^2 - 1) and t = arctan z, the load, the approach and the
condition on the opening at c are

    W        = 4 a^3/3 - 2 s a^2 (z + m^2 t),
    alpha*   = mu (a^2 - 2 s a z),
    pi/s     = a^2 [z + (z^2 - 1) t] + 4 s a (z t - m + 1).

The last is a quadratic in a, so that the curve is explicit in z. Before contact the tension acts over a disc of radius
c that grows from nothing to c0, where the centres meet (Johnson & Greenwood, J. Colloid Interface Sci. 192 (1997) 326):

    W = -pi s c^2,   alpha*/mu = c^2/2 - 4 s c/pi - 1/s,   c0^2 + 4 s c0 (1 - 2/pi) = 2/s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from halfspace.laws import LENNARD_JONES
from halfspace.limits import require_between, require_positive
from halfspace.roots import root
from halfspace.theories.closed_forms import ContactState, gap_shape
from halfspace.values import Array

TENSION_TO_MAUGIS = float(np.cbrt(9 / (2 * np.pi)))  # lambda/s, from lambda = sigma0 (9 R/(2 pi E*^2 dgamma))^(1/3)
MAUGIS_UNIT = float(np.cbrt(3 * np.pi / 4))  # his unit of radius (3 pi R^2 dgamma/(4 E*))^(1/3), in beta
ROUNDING = 1 + 1e-12  # leeway for radii that are equal but for rounding


@dataclass(frozen=True)
class MaugisDugdale:
    """The theory at one lambda.

    Parameters
    ----------
    maugis : float
        Maugis's parameter lambda, 1e-6 to 1e6.
    tabor : float
        Tabor parameter, the unit of the approach.
    """

    maugis: float
    tabor: float

    def __post_init__(self) -> None:
        """Refuse what is out of range."""
        require_between(self.maugis, "maugis", 1e-6, 1e6, "take DMT-M below, JKR above")
        require_positive(self.tabor, "tabor", "give the Tabor parameter")

    @classmethod
    def matched(cls, tabor: float) -> MaugisDugdale:
        """Return the theory whose tension is the largest of the Lennard-Jones law: lambda = 1.1570 mu."""
        largest = -float(LENNARD_JONES.pressure(np.array(LENNARD_JONES.edge_gap), tabor))
        return cls(TENSION_TO_MAUGIS * largest, tabor)

    @property
    def tension(self) -> float:
        """Tension s in dgamma/(mu eps)."""
        return self.maugis / TENSION_TO_MAUGIS

    def cohesive_radius(self, radius: ArrayLike) -> Array:
        """Outer radius c at a contact radius a > 0."""
        a = np.asarray(radius, float)
        return np.asarray(a * np.hypot(1, self._ratio(a)))

    def load(self, radius: ArrayLike) -> Array:
        """Load at a contact radius a > 0."""
        a = np.asarray(radius, float)
        return self._load(a, self._ratio(a))

    def approach(self, radius: ArrayLike) -> Array:
        """Approach at a contact radius a > 0."""
        a = np.asarray(radius, float)
        return self._approach(a, self._ratio(a))

    def separated_load(self, cohesive_radius: ArrayLike) -> Array:
        """Load before contact, at 0 <= c <= c0."""
        return np.asarray(-np.pi * self.tension * self._before_contact(cohesive_radius) ** 2)

    def separated_approach(self, cohesive_radius: ArrayLike) -> Array:
        """Approach before contact, at 0 <= c <= c0."""
        c, s = self._before_contact(cohesive_radius), self.tension
        return np.asarray(self.tabor * (c**2 / 2 - 4 * s * c / np.pi - 1 / s))

    @cached_property
    def touching_radius(self) -> float:
        """c0, the radius of the cohesive disc when the centres meet."""
        b = 2 * self.tension * (1 - 2 / np.pi)
        return float(2 / self.tension / (b + np.sqrt(b**2 + 2 / self.tension)))

    def pull_off(self) -> ContactState:
        """Where contact is lost under dead load: the least load, a (z/m + m t) = 2 s (1 - 1/m + m t^2)."""
        return self._turning(dead_load=True)

    def jump_on(self) -> ContactState:
        """Where the surfaces jump on, under fixed grips and dead load alike: as soon as the attraction reaches across.

        The tension sets in with its full strength, over a disc that grows while the surfaces are drawn apart.
        """
        return self._separated(0.0)

    def jump_off(self) -> ContactState:
        """Where the surfaces part under fixed grips: the least approach, a (z/m + m t) = 2 s (1 - 1/m).

        Below lambda = 0.938 contact is lost before, and the fold is that of the cohesive disc, c = 4 s/pi.
        """
        fold = 4 * self.tension / np.pi
        if fold <= self.touching_radius * ROUNDING:
            return self._separated(fold)
        return self._turning(dead_load=False)

    def _turning(self, *, dead_load: bool) -> ContactState:
        """State of contact at which load or approach is least: the equations of `pull_off` and `jump_off`."""
        s = self.tension

        def excess(log_z: float) -> float:
            z = np.exp(log_z)
            m, t = np.hypot(1, z), np.arctan(z)
            right = z**2 / (m * (1 + m)) + dead_load * m * t**2  # the first term is 1 - 1/m, free of cancellation
            return float(self._radius(z) * (z / m + m * t) - 2 * s * right)

        ends = float(np.log(1e-3 / (1 + s))), float(np.log(1e12 * (1 + s**-1.5)))
        z = np.exp(root(excess, *ends, "the cohesive zone; take a parameter nearer 1", xtol=1e-14))
        a = self._radius(z)
        return ContactState(float(self._approach(a, z)), float(self._load(a, z)), float(a))

    def _separated(self, c: float) -> ContactState:
        return ContactState(float(self.separated_approach(c)), float(self.separated_load(c)), float("nan"))

    def _before_contact(self, cohesive_radius: ArrayLike) -> Array:
        c = np.asarray(cohesive_radius, float)
        return np.where((c >= 0) & (c <= self.touching_radius * ROUNDING), c, np.nan)

    def _load(self, a: Array, z: Array) -> Array:
        return np.asarray(4 / 3 * a**3 - 2 * self.tension * a**2 * (z + (1 + z**2) * np.arctan(z)))

    def _approach(self, a: Array, z: Array) -> Array:
        return np.asarray(self.tabor * (a**2 - 2 * self.tension * a * z))

    def _radius(self, z: Array) -> Array:
        """Contact radius a at z: the positive root of g a^2 + 4 s k a = pi/s."""
        s, g, k = self.tension, gap_shape(z), _closing_shape(z)
        return np.asarray(np.pi / s / (2 * s * k + np.sqrt((2 * s * k) ** 2 + np.pi / s * g)))

    def _ratio(self, a: Array) -> Array:
        """Return z at a contact radius: Newton's method in logarithms, where the opening is nearly a power of z."""
        s = self.tension
        z = np.minimum(np.sqrt(np.pi / (2 * s**2 * a)), np.cbrt(3 * np.pi / (4 * s * a**2)))
        for _ in range(8):  # five give ten digits at any lambda and radius
            opening = s * a / np.pi * (a * gap_shape(z) + 4 * s * _closing_shape(z))
            t, m = np.arctan(z), np.hypot(1, z)
            slope = s * a / np.pi * (a * 2 * z * (t + z / m**2) + 4 * s * (t + z / m**2 - z / m))
            z = z * np.exp(-np.log(opening) * opening / (slope * z))
        return np.asarray(z)


def _closing_shape(z: Array) -> Array:
    """Shape k = z arctan z - sqrt(1 + z^2) + 1, by which the tension closes the gap at c; free of cancellation."""
    return np.asarray(z * (np.arctan(z) - z / (1 + np.hypot(1, z))))


def carpick_pull_off(maugis: ArrayLike) -> Array:
    """Load at pull-off by Carpick, Ogletree & Salmeron, J. Colloid Interface Sci. 211 (1999) 395: -2 pi to -3 pi/2.

    It fits Maugis's within 1.7 %, their radius under no load within 1.4 %, that under compression within 2.2 %.
    """
    x = 4.04 * np.asarray(maugis, float) ** 1.4
    return np.asarray(np.pi * (-7 / 4 + (x - 1) / (x + 1) / 4))


def carpick_zero_load_radius(maugis: ArrayLike) -> Array:
    """Contact radius under no load by the same authors."""
    x = 2.28 * np.asarray(maugis, float) ** 1.3
    return np.asarray(MAUGIS_UNIT * (1.54 + 0.279 * (x - 1) / (x + 1)))


def carpick_transition(maugis: ArrayLike) -> Array:
    """Return their transition parameter, 0 for DMT-M to 1 for JKR, from lambda = -0.924 ln(1 - 1.02 alpha)."""
    return np.asarray((1 - np.exp(-np.asarray(maugis, float) / 0.924)) / 1.02)


def carpick_radius(load: ArrayLike, maugis: ArrayLike) -> Array:
    """Contact radius under a load above pull-off: a/a0 = [(alpha + sqrt(1 - W/Wc))/(1 + alpha)]^(2/3)."""
    alpha, remaining = carpick_transition(maugis), 1 - np.asarray(load, float) / carpick_pull_off(maugis)
    root = np.sqrt(np.where(remaining < 0, np.nan, remaining))
    return np.asarray(carpick_zero_load_radius(maugis) * ((alpha + root) / (1 + alpha)) ** (2 / 3))
