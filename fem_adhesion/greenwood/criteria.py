"""Criteria for jumping on, printed and refitted, against true jumps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import curve_fit

from halfspace.theories import criteria
from halfspace.values import Array, Estimate, Valued

CLOSED: Mapping[str, float] = {
    "Attard & Parker": criteria.ATTARD_PARKER,
    "Pethica & Sutton": float(criteria.PETHICA_SUTTON),
    "App. C": criteria.APPENDIX_C,
}
"""Factors k of the criteria that were derived, and not fitted."""
REPULSION_GONE = 10.0  # Tabor parameter above which the exponent is fitted


@dataclass(frozen=True, eq=False, repr=False)
class Criterion(Valued):
    """A criterion with its constants as printed and refitted to the true jumps.

    It predicts the central gap, or if `of_approach` the approach, at a Tabor parameter by the printed constants. Each
    of these, k, c or n, has its name, the printed value, and the refitted one with the standard error of the fit. The
    scatter is the standard deviation of the logarithm of the formula's left-hand side around the refitted formula.
    """

    name: str
    formula: str
    predict: Callable[[Array], Array] | None
    of_approach: bool
    constants: tuple[tuple[str, float | None, Estimate], ...]
    scatter: float


def fit(tabor: Array, central_gap: Array, approach: Array) -> tuple[Criterion, ...]:
    """Refit every criterion by least squares of logarithms to true jumps: gaps and approaches in eps, all (n,)."""
    mu, y, z = tabor, central_gap + 1, 1 - approach
    k, scatter = _mean(np.log(y**3.5 / (np.pi * np.sqrt(2) * mu**1.5)))
    formula = "(H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2)"
    found = [
        Criterion(name, formula, partial(criteria.closed_gap, k=value), False, (("k", value, k),), scatter)
        for name, value in CLOSED.items()
    ]
    (log_c, n), scatter = _fitted(_log_repulsion, y, np.log(y**3.5 / mu**1.5), (np.log(6.0), 1.5))
    constants = ("c", criteria.FIT, _exponential(log_c)), ("n", criteria.FIT_REPULSION, n)
    formula = "(H0 + 1)^(7/2) = c mu^(3/2) [1 - n/(H0 + 1)^6]"
    found.append(Criterion("fit (4.5)", formula, criteria.fitted_gap, False, constants, scatter))
    c, scatter = _mean(np.log(z**3.5 / mu**1.5))
    formula = "(|alpha*| + 1)^(7/2) = c mu^(3/2)"
    constant = ("c", 3 * np.pi**2, c)
    found.append(Criterion("fit of App. C", formula, criteria.fitted_approach, True, (constant,), scatter))
    far = mu >= REPULSION_GONE
    if far.sum() >= 4:  # 3/7 by every theory, which no one fitted
        for name, left, values in (("gap", "H0", y), ("approach", "|alpha*|", z)):
            (log_c, n), scatter = _fitted(lambda x, a, b: a + b * x, np.log(mu[far]), np.log(values[far]), (1.0, 0.4))
            powers = ("n", 3 / 7, n), ("c", None, _exponential(log_c))
            title, formula = f"power of mu, {name}, mu >= {REPULSION_GONE:g}", f"{left} + 1 = c mu^n"
            found.append(Criterion(title, formula, None, name == "approach", powers, scatter))
    return tuple(found)


def _log_repulsion(y: Array, log_c: float, n: float) -> Array:
    """Logarithm of c [1 - n/y^6], bounded where there is none."""
    return np.asarray(log_c + np.log(np.maximum(1 - n / y**6, 1e-6)))


def _fitted(
    formula: Callable[..., Array], x: Array, y: Array, start: tuple[float, float]
) -> tuple[list[Estimate], float]:
    """Two constants with their standard errors, and the scatter of one value."""
    values, covariance = curve_fit(formula, x, y, start)
    errors = np.sqrt(np.diag(covariance))
    scatter = float(np.std(y - formula(x, *values), ddof=2))
    return [Estimate(float(v), float(e)) for v, e in zip(values, errors, strict=True)], scatter


def _exponential(logarithm: Estimate) -> Estimate:
    c = float(np.exp(logarithm.value))
    return Estimate(c, c * logarithm.error)


def _mean(logarithms: Array) -> tuple[Estimate, float]:
    """Geometric mean with its standard error, and the scatter of one value."""
    scatter = float(np.std(logarithms, ddof=1))
    value = float(np.exp(np.mean(logarithms)))
    return Estimate(value, value * scatter / float(np.sqrt(logarithms.size))), scatter
