"""Closed expressions for a paraboloid on a half-space under the 3-9 law, fitted to `halfspace.atlas`.

They serve any Tabor parameter mu, and all but `load` are exact in both limits, Bradley's and JKR's. For mu from 0.01 to
300 they are off by no more than

    pull_off_load       2.1e-5 of the load
    zero_load_radius    5.7e-5 of the radius
    jump_on_approach    5.9e-6 of |alpha*| + 1
    jump_off_approach   4.1e-4 of |alpha*|
    energy_lost         2.5e-4 of the energy
    load                7.5e-3 of the pull-off load

and for spheres within `halfspace.atlas.sphere`

    sphere_factor       2.3e-3 of the factor.

Loads in R dgamma, radii in beta, approaches in eps, energies in R dgamma eps. Jumps are under fixed grips, and nan
below the birth of folds at mu = b; up to mu = b + 1e-5 the energy, below 4e-10, is not compared. Coefficients are in
ascending order.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebval
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from halfspace.limits import SMALLEST_SPHERE
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, ZERO_LOAD_RADIUS
from halfspace.values import Array

FILE, FORCE_FILE = (Path(__file__).with_name(name) for name in ("fits.json", "force.json"))
CONSTANTS: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
"""What is fitted, by ``python -m fem_adhesion.formulas.fit``: the formulas in C and Fortran have it from here too."""

FORCE: list[dict[str, Any]] = json.loads(FORCE_FILE.read_text(encoding="utf-8"))
"""Coefficients of `load`, by ``python -m fem_adhesion.formulas.fit_force``."""

BIRTH: float = CONSTANTS["birth"]  # b
RIGID_RADIUS = np.sqrt(2 * (3 ** (1 / 6) - 4 ** (-1 / 6)))  # where the gap under no load is that of the largest tension
SOFTENING: float = CONSTANTS["softening"]  # of the pull-off of a nearly rigid body: 2 pi - 3.2427624 mu^(3/2)
ATTRACTION: float = CONSTANTS["attraction"]  # (1 - alpha*)/mu^(3/7) at the jump on, where repulsion is too far to count


def pull_off_load(tabor: ArrayLike) -> Array:
    """Least load: -2 pi + 3.24 mu^(3/2) where the body is nearly rigid, and -3 pi/2 where it is soft."""
    s = np.sqrt(np.asarray(tabor, float))
    above = polyval(s, CONSTANTS["pull_off"])
    below = (
        above + SOFTENING / (JKR_PULL_OFF - BRADLEY_PULL_OFF) * s**3 + s**4 * polyval(s, CONSTANTS["pull_off_below"])
    )
    return np.asarray(JKR_PULL_OFF + (BRADLEY_PULL_OFF - JKR_PULL_OFF) * above / below)


def sphere_factor(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike = 0.3) -> Array:
    """Pull-off load of a hemisphere on a sliding mid-plane over the half-space's, at R/eps and Poisson's ratio.

    For tabor from 0.05 to 10, R/eps from 5 to 1e5, R from 1.5 beta and Poisson's ratios from 0 to 0.49, else nan.
    """
    mu, rho, nu = np.broadcast_arrays(*(np.asarray(value, float) for value in (tabor, radius_ratio, poisson)))
    inside = (mu >= 0.05) & (mu <= 10) & (rho >= 5) & (rho <= 1e5) & (nu >= 0) & (nu <= 0.49)
    inside &= rho * (1 + 1e-12) >= SMALLEST_SPHERE * mu
    return np.where(inside, np.exp(sphere_terms(mu, rho, nu) @ np.array(CONSTANTS["sphere"])), np.nan)


def sphere_terms(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike) -> Array:
    """Terms (..., 11) of the factor's logarithm, in b = beta/R, e = eps/R, g = mu/(1 + mu), k = (1 - 2 nu)(1 - nu).

    c0 b k g + c1 b k g^2 + c2 b k g^3, c3 e + c4 e g + c5 e^2, c6 b^2 + c7 b^2 k^2, nu^2 (c8 b^3 + c9 b^4 + c10 b^5).
    """
    mu, rho, nu = (np.asarray(value, float) for value in (tabor, radius_ratio, poisson))
    b, e, g, k, n = np.sqrt(mu / rho), 1 / rho, mu / (1 + mu), (1 - 2 * nu) * (1 - nu), nu**2 * (mu / rho) ** 1.5
    linear, square = b * k * g, b**2
    terms = linear, linear * g, linear * g**2, e, e * g, e**2, square, square * k**2, n, n * b, n * square
    return np.stack(terms, axis=-1)


def zero_load_radius(tabor: ArrayLike) -> Array:
    """Contact radius under no load: 0.90/sqrt(mu) where the body is nearly rigid, and JKR's where it is soft."""
    s = np.sqrt(np.asarray(tabor, float))
    above = (
        polyval(s, CONSTANTS["zero_load"]) + ZERO_LOAD_RADIUS / RIGID_RADIUS * CONSTANTS["zero_load_below"][-1] * s**5
    )
    return np.asarray(RIGID_RADIUS / s * above / polyval(s, CONSTANTS["zero_load_below"]))


def jump_on_approach(tabor: ArrayLike) -> Array:
    """Approach from which fixed grips jump into contact: 1 - 2.64 mu^(3/7) where the body is soft."""
    mu = np.asarray(tabor, float)
    return np.asarray(1 - ATTRACTION * mu ** (3 / 7) * _towards_one(past_birth(mu, 18 / 7), CONSTANTS["jump_on"]))


def jump_off_approach(tabor: ArrayLike) -> Array:
    """Approach from which fixed grips jump out of contact: JKR's, -(3/4) pi^(2/3) mu, where the body is soft."""
    mu = np.asarray(tabor, float)
    return np.asarray(-3 / 4 * np.pi ** (2 / 3) * mu * _towards_one(past_birth(mu, 3 / 2), CONSTANTS["jump_off"]))


def energy_lost(tabor: ArrayLike) -> Array:
    """Energy lost in a cycle under fixed grips: as (mu - b)^2 past the birth of folds, JKR's where the body is soft."""
    mu = np.asarray(tabor, float)
    v = past_birth(mu, 4 / 7)
    return np.asarray(JKR_LOST * mu * v**4 * _towards_one(v, CONSTANTS["energy_lost"]))


def past_birth(mu: Array, power: float) -> Array:
    """V = sqrt(1 - (b/mu)^power), which goes from 0 at the birth of folds to 1."""
    below = 1 - (BIRTH / mu) ** power
    return np.sqrt(np.where(below >= 0, below, np.nan))


def _towards_one(v: Array, coefficients: Sequence[float]) -> Array:
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


def load(approach: ArrayLike, tabor: ArrayLike, *, unloading: ArrayLike) -> Array:
    """Load at an approach under fixed grips: loading up to the jump on, unloading down to the jump off (tear-off).

    Past its end each branch goes over to the other. For loads up to 5 R dgamma and mu from 0.01 to 300, else nan.

    With M = 1 + mu, y solves y^3 + 3 s y = approach/M - c: a cubic with one root where curves do not fold, and one a
    branch where they do, from Cardano's formula. The load is 4 W_p q^3 (1 - q^3), W_p that of the pull-off, which is
    JKR's with q^3 = (a/a0)^(3/2), and q = (r + Y)^(3/4) (1 + z) (c0 + c1 z + c2 z^2 ...), Y = y/0.8,
    r = sqrt(1 + Y^2), z = Y/r. c, s and c0 ... are Chebyshev series in ln(mu) on three pieces.
    """
    alpha, mu, back = np.broadcast_arrays(np.asarray(approach, float), np.asarray(tabor, float), np.asarray(unloading))
    q = np.full(alpha.shape, np.nan)
    for piece in FORCE:
        here = (piece["from"] <= mu) & (mu <= piece["to"])
        t = place(mu[here], piece["from"], piece["to"])
        middle, slope, *sums = (chebval(t, c) for c in (piece["middle"], piece["slope"], *piece["sums"]))
        x = alpha[here] / (1 + mu[here]) - middle
        beyond = np.abs(x) > 2 * np.maximum(-slope, 0) ** 1.5
        y = root_of_cubic(x, slope, np.where(beyond, x > 0, back[here]))
        q[here] = np.sum(sums * shapes(y, len(sums)), axis=0)
    return np.asarray(4 * pull_off_load(mu) * q**3 * (1 - q**3))


def place(tabor: Array, low: float, high: float) -> Array:
    """Place of a Tabor parameter on a piece, -1 to 1."""
    return np.asarray((2 * np.log(tabor) - np.log(low * high)) / np.log(high / low))


def root_of_cubic(x: Array, s: Array, greatest: Array) -> Array:
    """Root of y^3 + 3 s y = x: where there are three the greatest or the least; past its end that at the end."""
    size = np.sqrt(np.maximum(np.abs(s), 1e-20))
    c = x / (2 * size**3)
    up, down = (np.maximum(sign * c, -1) for sign in (1, -1))
    roots = [
        np.where(k > 1, np.cosh(np.arccosh(np.maximum(k, 1)) / 3), np.cos(np.arccos(np.minimum(k, 1)) / 3))
        for k in (up, down)
    ]
    return np.asarray(2 * size * np.where(s > 0, np.sinh(np.arcsinh(c) / 3), np.where(greatest, roots[0], -roots[1])))


def shapes(y: Array, count: int) -> Array:
    """Functions (count, n) of which q is a sum."""
    Y = y / 0.8
    r = np.sqrt(1 + Y**2)
    return np.asarray((r + Y) ** 0.75 * (1 + Y / r) * (Y / r) ** np.arange(count)[:, None])
