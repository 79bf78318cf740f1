"""Closed expressions for a paraboloid on a half-space under the 3-9 law, fitted to `halfspace.atlas`.

They serve any Tabor parameter mu, and are exact in both limits, Bradley's and JKR's. For mu from 0.01 to 300 they are
off by no more than

    pull_off_load       2.3e-5 of the load
    zero_load_radius    6.3e-5 of the radius
    jump_on_approach    4.5e-5 of |alpha*| + 1
    jump_off_approach   7.1e-4 of |alpha*|
    energy_lost         4.5e-4 of the energy.

Loads in R dgamma, radii in beta, approaches in eps, energies in R dgamma eps. Jumps are under fixed grips, and nan
below the birth of folds at mu = b. Coefficients are in ascending order.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, ZERO_LOAD_RADIUS
from halfspace.values import Array

BIRTH = 0.69721461  # b
RIGID_RADIUS = np.sqrt(2 * (3 ** (1 / 6) - 4 ** (-1 / 6)))  # where the gap under no load is that of the largest tension
SOFTENING = 3.2427624  # of the pull-off force of a nearly rigid body, which is 2 pi - 3.2427624 mu^(3/2)
ATTRACTION = 2.6408948  # (1 - alpha*)/mu^(3/7) at the jump on, where repulsion is too far to count

PULL_OFF = (1, -1.5195, 1.0858, 0.84845)  # in sqrt(mu)
PULL_OFF_BELOW = (-3.3199, 3.4133, 0.38808, 0.18368)  # from mu^2 on
ZERO_LOAD = (1, 1.2657, 3.2332, 11.155, -9.0501)  # in sqrt(mu)
ZERO_LOAD_BELOW = (1, 1.2207, 4.2511, -3.3869, 4.8511)
JUMP_ON = (-0.01397, -0.01259, 0.006625)
JUMP_OFF = (0.09677, 0.1584, -0.6821, 2.993, -4.558, 2.732)
ENERGY_LOST = (0.0453, -0.0152, 0.609, -2.28, 1.85)


def pull_off_load(tabor: ArrayLike) -> Array:
    """Least load: -2 pi + 3.24 mu^(3/2) where the body is nearly rigid, and -3 pi/2 where it is soft."""
    s = np.sqrt(np.asarray(tabor, float))
    above = polyval(s, PULL_OFF)
    below = above + SOFTENING / (JKR_PULL_OFF - BRADLEY_PULL_OFF) * s**3 + s**4 * polyval(s, PULL_OFF_BELOW)
    return np.asarray(JKR_PULL_OFF + (BRADLEY_PULL_OFF - JKR_PULL_OFF) * above / below)


def zero_load_radius(tabor: ArrayLike) -> Array:
    """Contact radius under no load: 0.90/sqrt(mu) where the body is nearly rigid, and JKR's where it is soft."""
    s = np.sqrt(np.asarray(tabor, float))
    above = polyval(s, ZERO_LOAD) + ZERO_LOAD_RADIUS / RIGID_RADIUS * ZERO_LOAD_BELOW[-1] * s**5
    return np.asarray(RIGID_RADIUS / s * above / polyval(s, ZERO_LOAD_BELOW))


def jump_on_approach(tabor: ArrayLike) -> Array:
    """Approach from which fixed grips jump into contact: 1 - 2.64 mu^(3/7) where the body is soft."""
    mu = np.asarray(tabor, float)
    return np.asarray(1 - ATTRACTION * mu ** (3 / 7) * _towards_one(_past_birth(mu, 18 / 7), JUMP_ON))


def jump_off_approach(tabor: ArrayLike) -> Array:
    """Approach from which fixed grips jump out of contact: JKR's, -(3/4) pi^(2/3) mu, where the body is soft."""
    mu = np.asarray(tabor, float)
    return np.asarray(-3 / 4 * np.pi ** (2 / 3) * mu * _towards_one(_past_birth(mu, 3 / 2), JUMP_OFF))


def energy_lost(tabor: ArrayLike) -> Array:
    """Energy lost in a cycle under fixed grips: as (mu - b)^2 past the birth of folds, JKR's where the body is soft."""
    mu = np.asarray(tabor, float)
    v = _past_birth(mu, 4 / 7)
    return np.asarray(JKR_LOST * mu * v**4 * _towards_one(v, ENERGY_LOST))


def _past_birth(mu: Array, power: float) -> Array:
    """V = sqrt(1 - (b/mu)^power), which goes from 0 at the birth of folds to 1."""
    below = 1 - (BIRTH / mu) ** power
    return np.sqrt(np.where(below >= 0, below, np.nan))


def _towards_one(v: Array, coefficients: tuple[float, ...]) -> Array:
    """Sum 1 + (1 - v) (c0 + c1 v + c2 v^2 ...)."""
    return np.asarray(1 + (1 - v) * polyval(v, coefficients))


def _jkr_lost() -> float:
    """JKR's energy lost over mu: of -W d(alpha*)/mu along the contact branch, from the jump off to zero approach.

    With q = sqrt(a/a0), W = 6 pi (q^6 - q^3) and alpha*/mu = a0^2 (q^4 - 2 q/3), at q^3 from 1/6 to 2/3.
    """
    first, last = np.cbrt([1 / 6, 2 / 3])

    def primitive(q: float) -> float:  # of (q^3 - q^6) (4 q^3 - 2/3)
        return 4 * q**7 / 7 - 4 * q**10 / 10 - q**4 / 6 + 2 * q**7 / 21

    return float(6 * np.pi * ZERO_LOAD_RADIUS**2 * (primitive(last) - primitive(first)))


JKR_LOST = _jkr_lost()
