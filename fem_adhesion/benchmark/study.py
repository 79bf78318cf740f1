"""Which cause fits a submission: each variant to all numbers, by its evidence, and the verdict of each number.

A code errs besides by its own noise, a part of each number that is the same for all of a problem. What a number may
deviate by is that, half its last digit, what error is stated, our bar and the spread of the cause. A variant with a
parameter pays for it by the part of its range that the numbers leave (the Occam factor of Bayesian evidence), so that
chance fits do not win. Of a cause with several variants each has its share of the prior probability.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from fem_adhesion.benchmark.causes import REMEDIES, Variant, variants
from fem_adhesion.benchmark.problems import KINDS, Problem
from fem_adhesion.benchmark.submission import Number, Submitted
from fem_adhesion.common.record import UNITS
from halfspace.equilibrium.events import EVENTS, approach_scale
from halfspace.values import Array, Estimate

NOISE = np.geomspace(1e-9, 1e-2, 57)  # parts of a number by which a code may err: with more nothing is told


@dataclass(frozen=True)
class CauseSettings:
    """By how much a cause must explain numbers better than chance."""

    step: float = 0.2  # of the logarithm of a parameter from trial to trial; the best is refined
    sure: float = 7.0  # log of the evidence by which a defect must beat sound numbers: chance finds a thousandth of it
    likely: float = 2.0  # the same where they cannot be sound: in 24 trials noise of 1 % gave 1.9, a box of 40 beta 2.2
    alike: float = 3.0  # logarithm of the evidence within which two causes fit alike
    fits: float = 4.0  # mean square of deviations in what is allowed up to which a cause fits
    sound: float = 2e-3  # part by which a number may be off beyond its digits and errors: two units of the third digit


HOW = CauseSettings()


@dataclass(frozen=True)
class Row:
    """One number of theirs beside ours, which is nan if we have none.

    `allowed` is how far the number may be off: half its last digit, the error stated and our bar. The deviation is a
    part of `scale`: of our value, and of approaches and gaps of eps and the range of all events.
    """

    problem: str
    quantity: str
    unit: str
    theirs: float
    ours: float
    bar: float
    allowed: float
    scale: float
    deviation: float
    digits: float
    verdict: str


@dataclass(frozen=True)
class Fit:
    """How well a cause fits: its evidence, the way in which it occurs, its parameter by problem, and the noise left."""

    cause: str
    what: str
    parameters: tuple[float, ...]
    evidence: float
    misfit: float
    noise: float


@dataclass(frozen=True)
class Diagnosis:
    """Rows, causes and fits of a submission.

    The causes are the likely one and those that fit alike, `problems` those of each problem alone; the fits are of all
    causes, from the best.
    """

    rows: Sequence[Row]
    causes: Sequence[str]
    fits: Sequence[Fit]
    problems: Mapping[str, Sequence[str]]
    submitted: Sequence[Submitted]

    @property
    def cause(self) -> str:
        """The most likely."""
        return self.causes[0]

    @property
    def record(self) -> dict[str, Any]:
        """Everything for JSON."""
        return {
            "cause": self.cause,
            "alike": self.causes[1:],
            "remedy": REMEDIES[self.cause],
            "problems": {name: {"cause": own[0], "alike": own[1:]} for name, own in self.problems.items()},
            "fits": [asdict(fit) for fit in self.fits],
            "rows": [asdict(row) for row in self.rows],
        }


def diagnose(submitted: Sequence[Submitted]) -> Diagnosis:
    """Compare a submission with our solutions, and find the cause of what is wrong with it."""
    tables = [[_row(one.problem, number) for number in one.numbers] for one in submitted]
    pairs = list(zip(submitted, tables, strict=True))
    fits = [[_fitted(variant, one.problem, rows) for one, rows in pairs] for variant in variants()]
    alone = {
        one.problem.name: _named([row[i : i + 1] for row in fits], tables[i])[0] for i, one in enumerate(submitted)
    }
    rows = [row for table in tables for row in table]
    return Diagnosis(rows, *_named(fits, rows), alone, submitted)


def _named(fits: Sequence[Sequence[Fit | None]], rows: Sequence[Row]) -> tuple[Sequence[str], Sequence[Fit]]:
    """Causes that are told, sound unless another is surely better, and all that fit alike; and fits of all causes."""
    sound = fits[0]
    found = dict[str, list[Fit]]()
    for variant in fits:
        if own := [fit for fit in variant if fit]:
            parts = [part for fit, as_sound in zip(variant, sound, strict=True) if (part := fit or as_sound)]
            sizes = tuple(size for fit in own for size in fit.parameters)
            evidence, misfit, noise = zip(*((part.evidence, part.misfit, part.noise) for part in parts), strict=True)
            whole = Fit(own[0].cause, own[0].what, sizes, sum(evidence), max(misfit), max(noise))
            found.setdefault(whole.cause, []).append(whole)
    best = [max(ways, key=lambda fit: fit.evidence) for ways in found.values()]
    ranked = [replace(fit, evidence=fit.evidence - math.log(len(found[fit.cause]))) for fit in best]
    ranked.sort(key=lambda fit: -fit.evidence)
    alike = [fit for fit in ranked if fit.misfit <= HOW.fits]
    chance = next(fit for fit in ranked if fit.cause == "sound")
    may = chance in alike and all(abs(row.deviation) <= HOW.sound + row.allowed / row.scale for row in rows)
    if alike and (chance not in alike or alike[0].evidence - chance.evidence >= (HOW.sure if may else HOW.likely)):
        return [fit.cause for fit in alike if alike[0].evidence - fit.evidence < HOW.alike and fit != chance], ranked
    return ["sound" if may else "cannot-tell"], ranked


def _row(problem: Problem, number: Number) -> Row:
    values, kind = problem.values, KINDS[number.quantity]
    ours = values.get(number.quantity, Estimate(math.nan, 0.0))
    scale = abs(number.value if math.isnan(ours.value) else ours.value) or 1.0
    if kind in ("approach", "central_gap"):
        scale = approach_scale(values[f"{name}_approach"].value for name in EVENTS if f"{name}_approach" in values)
    allowed, deviation = number.allowed + ours.error, (number.value - ours.value) / scale
    verdict = "agrees" if abs(deviation) <= allowed / scale * (1 + 1e-9) else "differs"
    verdict, digits = "does not exist" if math.isnan(ours.value) else verdict, -math.log10(max(abs(deviation), 1e-12))
    sides = number.value, ours.value, ours.error
    return Row(problem.name, number.quantity, UNITS[kind], *sides, allowed, scale, deviation, digits, verdict)


def _fitted(variant: Variant, problem: Problem, rows: Sequence[Row]) -> Fit | None:
    """Evidence of a variant for the numbers of a problem; None where it does not say anything of it."""
    theirs, scale, allowed = np.array([(row.theirs, row.scale, row.allowed) for row in rows]).T
    floor = allowed / scale

    def misfits(logarithm: float) -> tuple[Array, Array]:
        """Deviations from the prediction, and its spreads, in parts of the numbers."""
        values, spreads = variant.predict(problem, math.exp(logarithm)) or ({}, {})
        given = np.array([values.get(row.quantity, math.nan) for row in rows])
        spread = np.array([spreads.get(row.quantity, 0.0) for row in rows]) / scale
        return np.nan_to_num((theirs - given) / scale, nan=1.0), np.minimum(spread, 1.0)

    first, last = (math.log(end) for end in variant.ends)
    if not any(re.search(variant.needs, row.quantity) for row in rows):
        return None
    if not (variant.predict(problem, variant.ends[0]) and variant.predict(problem, variant.ends[1])):
        return None

    def worse(logarithm: float) -> float:
        return -_likelihood(*misfits(logarithm), floor)[0]

    place = first
    if first < last:
        trials = np.linspace(first, last, math.ceil((last - first) / HOW.step) + 1)
        near = int(np.argmin([worse(trial) for trial in trials]))
        ends = trials[max(near - 1, 0)], trials[min(near + 1, trials.size - 1)]
        place = float(minimize_scalar(worse, bounds=ends, method="bounded", options={"xatol": 1e-10}).x)
    (deviations, spread), beside = misfits(place), misfits(place + 1e-6)
    likelihood, misfit, noise = _likelihood(deviations, spread, floor)
    rates = (beside[0] - deviations) / 1e-6 * (last - first)
    occam = math.log1p(float(np.sum(rates**2 / (floor**2 + noise**2 + spread**2)))) / 2
    parameters = (math.exp(place),) if first < last else ()
    return Fit(variant.cause, variant.what, parameters, likelihood - occam, misfit, noise)


def _likelihood(deviations: Array, spread: Array, floor: Array) -> tuple[float, float, float]:
    """Largest logarithm of the likelihood over the noise, the mean square misfit there, and the noise."""
    squares = floor**2 + spread**2 + NOISE[:, None] ** 2
    parts = deviations**2 / squares
    logarithms = -np.sum(parts + np.log(squares), axis=1) / 2
    best = int(np.argmax(logarithms))
    return float(logarithms[best]), float(parts[best].mean()), float(NOISE[best])
