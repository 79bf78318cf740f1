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
Constants = tuple[tuple[str, float | None, Estimate], ...]
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
    constants: Constants
    scatter: float


def fit(tabor: Array, central_gap: Array, approach: Array) -> tuple[Criterion, ...]:
    """Refit every criterion by least squares of logarithms to true jumps: gaps and approaches in eps, all (n,)."""
    mu, y, z = tabor, central_gap + 1, 1 - approach
    formula = "(H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2)"
    left = np.log(y**3.5 / (np.pi * np.sqrt(2) * mu**1.5))
    found = [
        Criterion(name, formula, partial(criteria.closed_gap, k=value), False, *_fitted(_constant, y, left, k=value))
        for name, value in CLOSED.items()
    ]
    fitted = _fitted(_repulsion, y, np.log(y**3.5 / mu**1.5), c=criteria.FIT, n=criteria.FIT_REPULSION)
    formula = "(H0 + 1)^(7/2) = c mu^(3/2) [1 - n/(H0 + 1)^6]"
    found.append(Criterion("fit (4.5)", formula, criteria.fitted_gap, False, *fitted))
    fitted = _fitted(_constant, z, np.log(z**3.5 / mu**1.5), c=3 * np.pi**2)
    formula = "(|alpha*| + 1)^(7/2) = c mu^(3/2)"
    found.append(Criterion("fit of App. C", formula, criteria.fitted_approach, True, *fitted))
    far = mu >= REPULSION_GONE
    if far.sum() >= 4:  # 3/7 by every theory, which no one fitted
        for name, symbol, values in (("gap", "H0", y), ("approach", "|alpha*|", z)):
            fitted = _fitted(_power, np.log(mu[far]), np.log(values[far]), c=None, n=3 / 7)
            title, formula = f"power of mu, {name}, mu >= {REPULSION_GONE:g}", f"{symbol} + 1 = c mu^n"
            found.append(Criterion(title, formula, None, name == "approach", *fitted))
    return tuple(found)


def _constant(x: Array, log_c: float) -> Array:
    return np.full_like(x, log_c)


def _repulsion(y: Array, log_c: float, n: float) -> Array:
    """Logarithm of c [1 - n/y^6], bounded where there is none."""
    return np.asarray(log_c + np.log(np.maximum(1 - n / y**6, 1e-6)))


def _power(log_x: Array, log_c: float, n: float) -> Array:
    return np.asarray(log_c + n * log_x)


def _fitted(formula: Callable[..., Array], x: Array, y: Array, **printed: float | None) -> tuple[Constants, float]:
    """Constants by name, as printed and refitted with their standard errors, and the scatter of one value.

    The formula has the logarithm of the first constant, and the others as they are.
    """
    first, *others = (value or 1.0 for value in printed.values())
    start = [np.log(first), *others]
    values, covariance = curve_fit(formula, x, y, start)
    errors = np.sqrt(np.diag(covariance))
    scatter = float(np.std(y - formula(x, *values), ddof=len(start)))
    values[0] = np.exp(values[0])
    errors[0] *= values[0]
    fitted = [Estimate(float(v), float(e)) for v, e in zip(values, errors, strict=True)]
    return tuple(zip(printed, printed.values(), fitted, strict=True)), scatter
