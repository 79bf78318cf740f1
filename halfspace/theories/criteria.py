"""Criteria for the jump into contact under fixed grips: estimates to compare with the folds of the computed curve.

Before the jump the sphere's attraction, about (8/3)(eps/h)^3 dgamma/eps over the undeformed gap h = h0 + r^2/(2R),
raises a bulge in the half-space, at its centre

    b = (2/E*) int_0^inf sigma dr = eps pi sqrt2 mu^(3/2) (H0 + 1)^(-5/2),

to the gap H0 = -alpha* - b/eps. The closed criteria differ in what they ask of it:

    (H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2).

Gaps and approaches in eps, loads in R dgamma.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from halfspace.laws import LENNARD_JONES
from halfspace.values import Array

ATTARD_PARKER = 3.0  # b sigma'/sigma = -1, their fundamental criterion, with sigma as h^-3
PETHICA_SUTTON = 8 * np.sqrt(2) / 3
APPENDIX_C = 5 / 2  # d(alpha)/d(h0) = 0, the fold of H0 = -alpha* - b/eps

FIT = 6.233  # [G97] (4.5): (H0 + 1)^(7/2) = 6.233 mu^(3/2) [1 - 1.6/(H0 + 1)^6]
FIT_REPULSION = 1.6
FIT_MEETING = 19 / 7 * FIT_REPULSION  # (H0 + 1)^6 where its two roots meet, at the least mu that it serves
FIT_LEAST_TABOR = (FIT_MEETING ** (19 / 12) / (FIT_MEETING - FIT_REPULSION) / FIT) ** (2 / 3)


def fundamental_criterion(approach: ArrayLike, central_gap: ArrayLike) -> Array:
    """Value of b sigma'(h0)/sigma(h0) in a computed state, which Attard & Parker hold stable above -1, [G97] (4.3).

    Approach alpha* and central gap H0 are those of separated states in eps, such as an `EquilibriumPath` has. The bulge
    is their distance, b/eps = -alpha* - H0, positive towards the sphere: minus the w(0) of [G97] (2.4).
    """
    H0 = np.asarray(central_gap, float)
    bulge = -np.asarray(approach, float) - H0
    return np.asarray(bulge * LENNARD_JONES.slope(H0, 1.0) / LENNARD_JONES.pressure(H0, 1.0))


def closed_gap(tabor: ArrayLike, k: float) -> Array:
    """Central gap H0 at the jump by a closed criterion, (H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2).

    k is ATTARD_PARKER, PETHICA_SUTTON or APPENDIX_C.
    """
    return _solve_power(k * np.pi * np.sqrt(2), tabor) - 1


def undeformed_load(central_gap: ArrayLike) -> Array:
    """Load W = -(8 pi/3)/(H0 + 1)^2 across an undeformed gap, repulsion left out: row AP of [G97] Table 2."""
    return np.asarray(-8 * np.pi / 3 / (np.asarray(central_gap, float) + 1) ** 2)


def fitted_approach(tabor: ArrayLike) -> Array:
    """Approach at the jump by the empirical fit of [G97] App. C, (abs(alpha*) + 1)^(7/2) = 3 pi^2 mu^(3/2)."""
    return 1 - _solve_power(3 * np.pi**2, tabor)


def fitted_gap(tabor: ArrayLike) -> Array:
    """Central gap H0 at the jump by the empirical fit [G97] (4.5), nan below mu = 0.710 where it has no solution.

    With y = H0 + 1 the fit is the root of a convex p(y) = y^(7/2) - C (1 - 1.6 y^-6), and p > 0 where the term of
    repulsion is left out: from there Newton's method descends to the larger root.
    """
    mu = np.asarray(tabor, float)
    C = FIT * np.where(mu < FIT_LEAST_TABOR, np.nan, mu) ** 1.5
    y = C ** (2 / 7)
    for _ in range(60):  # at the end of the fit's range its roots coincide, and a step gains but one bit
        p = y**3.5 - C * (1 - FIT_REPULSION / y**6)
        y = y - p / (3.5 * y**2.5 - 6 * C * FIT_REPULSION / y**7)
    return np.asarray(y - 1)


def _solve_power(factor: float, tabor: ArrayLike) -> Array:
    """Solve y^(7/2) = factor mu^(3/2)."""
    return np.asarray((factor * np.asarray(tabor, float) ** 1.5) ** (2 / 7))
