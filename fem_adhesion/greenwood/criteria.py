"""Criteria for jumping on, printed and refitted, against true jumps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import curve_fit

import halfspace
from fem_adhesion.common.numbers import told
from halfspace.theories import criteria
from halfspace.values import Array, Estimate, Valued

CLOSED = ("Attard & Parker", "Pethica & Sutton", "App. C")
RTOL = 1e-6  # of the jumps
REPULSION_GONE = 10.0  # Tabor parameter above which the exponent is fitted


@dataclass(frozen=True)
class JumpOn:
    """A true jump into contact under fixed grips."""

    tabor: float
    approach: Estimate
    central_gap: Estimate

    @property
    def fundamental(self) -> float:
        """Value of b sigma'/sigma there, which by [G97] (4.3) should be -1."""
        return float(criteria.fundamental_criterion(self.approach.value, self.central_gap.value))


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


@dataclass(frozen=True)
class CriteriaStudy:
    """True jumps and the criteria fitted to them."""

    jumps: tuple[JumpOn, ...]
    criteria: tuple[Criterion, ...]

    @property
    def tabor(self) -> Array:
        """Tabor parameters of the jumps."""
        return np.array([jump.tabor for jump in self.jumps])

    @property
    def central_gap(self) -> Array:
        """True central gaps at the jumps, in eps."""
        return np.array([jump.central_gap.value for jump in self.jumps])

    @property
    def approach(self) -> Array:
        """True approaches at the jumps, in eps."""
        return np.array([jump.approach.value for jump in self.jumps])


def jump_on(tabor: float) -> JumpOn:
    """Solve for a true jump; above the critical Tabor parameter."""
    event = halfspace.trace(tabor, rtol=RTOL).events["jump_on"]
    return JumpOn(tabor, event.estimate("approach"), event.estimate("central_gap"))


def fit(jumps: Iterable[JumpOn]) -> CriteriaStudy:
    """Refit every criterion by least squares of logarithms."""
    bare = CriteriaStudy(tuple(jumps), ())
    mu, y, z = bare.tabor, bare.central_gap + 1, 1 - bare.approach
    return CriteriaStudy(bare.jumps, (*_closed(mu, y), _repulsion(mu, y), _of_approach(mu, z), *_powers(mu, y, z)))


def _closed(mu: Array, y: Array) -> list[Criterion]:
    """Criteria (H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2): one constant, printed in three values."""
    k, scatter = _mean(np.log(y**3.5 / (np.pi * np.sqrt(2) * mu**1.5)))
    printed = zip(CLOSED, (criteria.ATTARD_PARKER, float(criteria.PETHICA_SUTTON), criteria.APPENDIX_C), strict=True)
    formula = "(H0 + 1)^(7/2) = k pi sqrt2 mu^(3/2)"
    return [
        Criterion(name, formula, partial(criteria.closed_gap, k=value), False, (("k", value, k),), scatter)
        for name, value in printed
    ]


def _repulsion(mu: Array, y: Array) -> Criterion:
    """Fit (4.5), which allows for the repulsion at small mu."""
    ratio = np.log(y**3.5 / mu**1.5)
    start = (np.log(criteria.FIT), criteria.FIT_REPULSION)
    values, covariance = curve_fit(_log_repulsion, y, ratio, start)
    errors = np.sqrt(np.diag(covariance))
    c = float(np.exp(values[0]))
    scatter = np.std(ratio - _log_repulsion(y, *values), ddof=2)
    constants = (
        ("c", criteria.FIT, Estimate(c, c * float(errors[0]))),
        ("n", criteria.FIT_REPULSION, Estimate(float(values[1]), float(errors[1]))),
    )
    formula = "(H0 + 1)^(7/2) = c mu^(3/2) [1 - n/(H0 + 1)^6]"
    return Criterion("fit (4.5)", formula, criteria.fitted_gap, False, constants, float(scatter))


def _log_repulsion(y: Array, log_c: float, n: float) -> Array:
    """Logarithm of c [1 - n/y^6], bounded where there is none."""
    return np.asarray(log_c + np.log(np.maximum(1 - n / y**6, 1e-6)))


def _of_approach(mu: Array, z: Array) -> Criterion:
    """Fit of App. C for the approach."""
    c, scatter = _mean(np.log(z**3.5 / mu**1.5))
    constants = (("c", 3 * np.pi**2, c),)
    formula = "(|alpha*| + 1)^(7/2) = c mu^(3/2)"
    return Criterion("fit of App. C", formula, criteria.fitted_approach, True, constants, scatter)


def _powers(mu: Array, y: Array, z: Array) -> list[Criterion]:
    """Free powers of mu where repulsion no longer matters: 3/7 by every theory, which no one fitted."""
    far = mu >= REPULSION_GONE
    if far.sum() < 4:
        return []
    return [
        _power("power of mu, gap", "H0 + 1 = c mu^n", mu[far], y[far]),
        _power("power of mu, approach", "|alpha*| + 1 = c mu^n", mu[far], z[far]),
    ]


def _power(name: str, formula: str, mu: Array, y: Array) -> Criterion:
    values, covariance = np.polyfit(np.log(mu), np.log(y), 1, cov=True)
    errors = np.sqrt(np.diag(covariance))
    scatter = float(np.std(np.log(y) - np.polyval(values, np.log(mu)), ddof=2))
    c = float(np.exp(values[1]))
    constants = (
        ("n", 3 / 7, Estimate(float(values[0]), float(errors[0]))),
        ("c", None, Estimate(c, c * float(errors[1]))),
    )
    return Criterion(f"{name}, mu >= {REPULSION_GONE:g}", formula, None, "alpha" in formula, constants, scatter)


def _mean(logarithms: Array) -> tuple[Estimate, float]:
    """Geometric mean with its standard error, and the scatter of one value."""
    scatter = float(np.std(logarithms, ddof=1))
    value = float(np.exp(np.mean(logarithms)))
    return Estimate(value, value * scatter / float(np.sqrt(logarithms.size))), scatter


def is_closed(criterion: Criterion) -> bool:
    """Whether a criterion was derived, and not fitted."""
    return criterion.name in CLOSED


def closed_ratios(study: CriteriaStudy) -> Array:
    """(H0 + 1)^(7/2) by each closed criterion over that of the true jumps; shape (criteria, jumps)."""
    predicted = [c.predict(study.tabor) for c in study.criteria if is_closed(c) and c.predict]
    return (np.reshape(predicted, (len(predicted), study.tabor.size)) + 1) ** 3.5 / (study.central_gap + 1) ** 3.5


def words_on(study: CriteriaStudy) -> Iterator[str]:
    """How far the criteria are from the true jumps, a sentence each."""
    yield _closed_words(study)
    yield from (_fit_words(study, criterion) for criterion in study.criteria)


def _closed_words(study: CriteriaStudy) -> str:
    ratio = closed_ratios(study)
    if not ratio.size:
        return ""
    wide = "too wide" if ratio.min() > 1 else "too narrow" if ratio.max() < 1 else "now too wide, now too narrow"
    text = (
        f"Attard & Parker, Pethica & Sutton and App. C expect the jump at {wide} a gap, by factors of "
        f"{ratio.min():.2f} to {ratio.max():.2f} in (H0 + 1)^(7/2)."
    )
    return told(text, ratio)


def _fit_words(study: CriteriaStudy, criterion: Criterion) -> str:
    """Largest deviation of an empirical fit as printed."""
    if criterion.predict is None or is_closed(criterion):
        return ""
    use = study.tabor >= criteria.FIT_LEAST_TABOR
    true = study.approach if criterion.of_approach else study.central_gap
    off = np.abs(criterion.predict(study.tabor[use]) - true[use])
    what = "approach" if criterion.of_approach else "gap"
    return told(f"The {criterion.name} is off by up to {np.max(off, initial=0):.1g} eps in the {what}.", off)
