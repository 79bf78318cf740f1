"""Theories of the exact sphere, of finite radius: rigid under the Lennard-Jones law, and soft after JKR.

Loads in R dgamma, positive in compression; radii in beta; approaches in eps; E* = 1. Two ratios make the radius finite,
rho = R/eps for a rigid sphere and X = R/beta = sqrt(rho/mu) for a soft one; as they grow the sphere becomes the
paraboloid of `halfspace.theories.closed_forms`. A quantity is nan where the theory has no contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from halfspace.laws import LENNARD_JONES
from halfspace.limits import require_between, require_positive
from halfspace.roots import root
from halfspace.theories.closed_forms import ContactState
from halfspace.values import Array

SERIES_BELOW = 0.5  # a/X below which arctanh x - x is summed as a series; above it nothing cancels
OUTERMOST = 1 - 1e-12  # largest a/X at which the logarithm of the soft sphere is a number


@dataclass(frozen=True)
class RigidSphere:
    """A rigid sphere before a rigid wall: [G97] (1.3) with the sphere's shape in place of the paraboloid's.

    A ring of the surface at the height z over the pole covers 2 pi r dr = 2 pi (R - z) dz of the wall. With the gap h0
    at the pole, and z from 0 to R for the hemisphere, to 2 R for the whole sphere,

        W = -2 pi int sigma(h0 + z) (R - z) dz.

    The far side counts negative: by the divergence theorem this is the attraction summed over the solid body. The ratio
    is rho = R/eps, at least 0.001, or InputError; the hemisphere ends at the equator, and `whole` takes in the far
    side.
    """

    radius_ratio: float
    whole: bool = False

    def __post_init__(self) -> None:
        _require_ratio(self.radius_ratio, 1e-3)  # a smaller sphere's tension is lost to rounding

    def load(self, approach: ArrayLike) -> Array:
        """Load at an approach alpha* below 1, the law acting on the projected area.

        In eps, and with h1 the gap at the end of the body, a power h^-n of the law gives

            (1 + h0/rho) (h0^(1-n) - h1^(1-n))/(n - 1) - (h0^(2-n) - h1^(2-n))/((n - 2) rho).
        """
        rho = self.radius_ratio
        return self._sum(approach, lambda h, n: (1 + h / rho) * self._moment(h, n) - self._moment(h, n - 1) / rho)

    def surface_load(self, approach: ArrayLike) -> Array:
        """Load at an approach, the law acting on the sphere's own surface: dz in place of (1 - z/R) dz.

        The other convention in use. It leaves the slope of the surface out of account, so that near contact its
        tension is the larger by the part (9/7)/rho.
        """
        return self._sum(approach, self._moment)

    def pull_off(self) -> ContactState:
        """Least load, -W/(2 pi) = 1 - (9/7)/rho + (c + 1/32)/rho^2 + O(rho^-3); the contact radius is nan.

        c = 4/3 for the hemisphere and 1 for the whole sphere is the term at contact, h0 = 1. The tension gains the 1/32
        on its way to its maximum at h0 = 1 + 1/(16 rho).
        """
        rho = self.radius_ratio
        return self._least(self.load, lambda h, n: self._moment(h, n) / rho - h**-n - self.whole * self._end(h) ** -n)

    def surface_pull_off(self) -> ContactState:
        """Least `surface_load`, -W/(2 pi) = 1 - c/rho^2 + O(rho^-3), c = 4/3 or, for the whole sphere, 1/3."""
        return self._least(self.surface_load, lambda h, n: self._end(h) ** -n - h**-n)

    def _end(self, h: Array) -> Array:
        return np.asarray(h + (2 if self.whole else 1) * self.radius_ratio)

    def _moment(self, h: Array, n: float) -> Array:
        """Integral of t^-n from the pole's gap h to the end's."""
        return np.asarray((h ** (1 - n) - self._end(h) ** (1 - n)) / (n - 1))

    def _sum(self, approach: ArrayLike, power: Callable[[Array, float], Array]) -> Array:
        """Load, or its derivative by the gap, from the integrals of the law's two powers."""
        h, law = 1 - np.asarray(approach, float), LENNARD_JONES
        return np.asarray(-2 * np.pi * law.amplitude * (power(h, law.attraction) - power(h, law.repulsion)))

    def _least(self, load: Callable[[ArrayLike], Array], slope: Callable[[Array, float], Array]) -> ContactState:
        """Solve for the zero of the load's derivative by the gap, given the derivatives of the two integrals."""
        what = "the largest tension of a rigid sphere; take a larger radius_ratio"
        approach = root(lambda alpha: float(self._sum(alpha, slope)), -1.0, 1e-6, what, xtol=1e-15)
        return ContactState(approach, float(load(approach)), math.nan)


@dataclass(frozen=True)
class JKRSphere:
    """JKR's theory with the exact profile of the sphere in place of the parabola: D. Maugis, Langmuir 11 (1995) 679.

    Sneddon's punch R - sqrt(R^2 - r^2) on a half-space, less the flat punch that Griffith's balance asks for. In the
    units of the project, with X = R/beta and L = ln[(X + a)/(X - a)],

        W         = X [(X^2 + a^2) L/2 - a X] - sqrt(8 pi a^3),
        alpha*/mu = X a L/2 - sqrt(2 pi a).

    They exceed JKR's values at the same contact radius by 8 a^5/(15 X^2) and a^4/(3 X^2) to leading order. The Tabor
    parameter mu is the unit of the approach; the ratio is rho = R/eps, at least mu, lest the contact span the sphere,
    and X = sqrt(rho/mu). InputError if either is out of range.
    """

    tabor: float
    radius_ratio: float

    def __post_init__(self) -> None:
        require_positive(self.tabor, "tabor", "give the Tabor parameter")
        _require_ratio(self.radius_ratio, self.tabor)

    @property
    def radius(self) -> float:
        """X = R/beta, which no contact radius reaches."""
        return math.sqrt(self.radius_ratio / self.tabor)

    def load(self, radius: ArrayLike) -> Array:
        """Load at a contact radius; nan from X on."""
        a = np.asarray(radius, float)
        return np.asarray(a**3 * _punch_load(a / self.radius) - np.sqrt(8 * np.pi * a**3))

    def approach(self, radius: ArrayLike) -> Array:
        """Approach at a contact radius; nan from X on."""
        a = np.asarray(radius, float)
        return np.asarray(self.tabor * (a**2 * _punch_approach(a / self.radius) - np.sqrt(2 * np.pi * a)))

    def pull_off(self) -> ContactState:
        """Where contact is lost under dead load: the least load."""
        return self._state(_punch_slope, 1.5 * math.sqrt(2 * math.pi))

    def jump_off(self) -> ContactState:
        """Where contact is lost under fixed grips: the least approach."""
        return self._state(_punch_slope, math.sqrt(math.pi / 2))

    def zero_load(self) -> ContactState:
        """Contact under no load."""
        return self._state(_punch_load, math.sqrt(8 * math.pi))

    def zero_approach(self) -> ContactState:
        """Contact at zero approach."""
        return self._state(_punch_approach, math.sqrt(2 * math.pi))

    def _state(self, shape: Callable[[Array], Array], value: float) -> ContactState:
        """State in which a^(3/2) times a shape of a/X, which rises from about 1 to infinity, has a value."""
        X, what = self.radius, "the contact radius over R; take a larger radius_ratio"
        x = root(lambda x: float((x * X) ** 1.5 * shape(np.array(x))) - value, 0.0, OUTERMOST, what, xtol=1e-300)
        a = x * X
        return ContactState(float(self.approach(a)), float(self.load(a)), a)


def _punch_load(x: Array) -> Array:
    """Load of Sneddon's punch over a^3: 4/3 + 8 x^2/15 + ..., x = a/X."""
    return np.asarray(1 + (1 + x**2) * _relative_excess(x))


def _punch_approach(x: Array) -> Array:
    """Approach of Sneddon's punch over mu a^2: 1 + x^2/3 + ..."""
    return np.asarray(1 + x**2 * _relative_excess(x))


def _punch_slope(x: Array) -> Array:
    """d(alpha*)/da of Sneddon's punch over mu a, 2 + 4 x^2/3 + ...; dW/da is 2 a^2 times it."""
    return np.asarray(_punch_approach(x) + 1 / (1 - x**2))


def _relative_excess(x: Array) -> Array:
    """Return (arctanh x - x)/x^3 = 1/3 + x^2/5 + x^4/7 + ..., free of cancellation; nan from x = 1 on."""
    low, high = np.minimum(x, SERIES_BELOW), np.clip(x, SERIES_BELOW, OUTERMOST)
    series = np.polynomial.polynomial.polyval(low**2, 1 / (2 * np.arange(30) + 3.0))
    closed = (np.arctanh(high) - high) / high**3
    return np.where(x < SERIES_BELOW, series, np.where(x < 1, closed, np.nan))


def _require_ratio(radius_ratio: float, least: float) -> None:
    remedy = "give R/eps, or take halfspace.theories.closed_forms for the paraboloid"
    require_between(radius_ratio, "radius_ratio", least, math.inf, remedy)
