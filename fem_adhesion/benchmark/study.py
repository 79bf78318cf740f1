"""Which cause fits a submission: each variant to all numbers, by its evidence, and the verdict of each number.

A code errs besides by its own noise, a part of each number that is the same for all of a problem. What a number may
deviate by is that, half its last digit, what error is stated, our bar and the spread of the cause. A variant with a
parameter pays for it by the part of its range that the numbers leave (the Occam factor of Bayesian evidence), so that
chance fits do not win.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from fem_adhesion.benchmark.causes import REMEDIES, Truth, Variant, variants
from fem_adhesion.benchmark.problems import KINDS, Problem
from fem_adhesion.benchmark.submission import Number, Submitted
from fem_adhesion.common.record import UNITS
from halfspace.equilibrium.events import EVENTS, approach_scale
from halfspace.values import Array, Estimate

NOISE = np.geomspace(1e-9, 3e-3, 53)  # parts of a number by which a code may err: with more nothing is told
STEP = 0.1  # of the logarithm of a parameter from trial to trial; the best is refined
SURE = 7.0  # logarithm of the evidence by which a defect must beat sound numbers: chance finds a thousandth of that
ALIKE = 3.0  # logarithm of the evidence within which two causes fit alike
FITS = 4.0  # mean square of deviations in what is allowed up to which a cause fits


@dataclass(frozen=True)
class Row:
    """One number of theirs beside ours; the deviation is a part of our value, of approaches of the size of them all."""

    problem: str
    number: Number
    ours: Estimate | None
    scale: float

    @property
    def deviation(self) -> float:
        """Deviation, or nan where we have no such number."""
        return (self.number.value - self.ours.value) / self.scale if self.ours else math.nan

    @property
    def digits(self) -> float:
        """Digits that are right."""
        return -math.log10(max(abs(self.deviation), 1e-12)) if self.ours else math.nan

    @property
    def verdict(self) -> str:
        """Whether it is right within what both sides say."""
        if self.ours is None:
            return "does not exist"
        allowed = self.number.rounding + self.number.error + self.ours.error
        return "agrees" if abs(self.number.value - self.ours.value) <= allowed * (1 + 1e-9) else "differs"


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
    """Rows, fits of all causes from the best, and the causes named: the likely one and those that fit alike."""

    rows: Sequence[Row]
    fits: Sequence[Fit]
    causes: Sequence[str]
    submitted: Sequence[Submitted]

    @property
    def cause(self) -> str:
        """The most likely."""
        return self.causes[0]

    @property
    def record(self) -> dict[str, Any]:
        """Everything for JSON."""
        fits = [vars(fit) for fit in self.fits]
        rows = [
            {
                "problem": row.problem,
                "quantity": row.number.quantity,
                "unit": UNITS[KINDS[row.number.quantity]],
                "theirs": row.number.value,
                "ours": row.ours.value if row.ours else None,
                "bar": row.ours.error if row.ours else None,
                "deviation": row.deviation,
                "digits": row.digits,
                "verdict": row.verdict,
            }
            for row in self.rows
        ]
        named = {"cause": self.cause, "alike": list(self.causes[1:]), "remedy": REMEDIES[self.cause]}
        return {
            **named,
            "runners_up": [fit for fit in fits if fit["cause"] not in self.causes][:3],
            "fits": fits,
            "rows": rows,
        }


def diagnose(submitted: Sequence[Submitted]) -> Diagnosis:
    """Compare a submission with our solutions, and find the cause of what is wrong with it."""
    truths = [Truth(one.problem) for one in submitted]
    tables = [list(_rows(one, truth.problem)) for one, truth in zip(submitted, truths, strict=True)]
    sound, best = None, dict[str, Fit]()
    counts = dict[str, int]()
    for variant in variants():
        results = [_fitted(variant, truth, rows) for truth, rows in zip(truths, tables, strict=True)]
        if variant.cause == "sound":
            sound = results
        if sound is None or not any(results):
            continue
        counts[variant.cause] = counts.get(variant.cause, 0) + 1
        parts = [own or as_sound for own, as_sound in zip(results, sound, strict=True) if own or as_sound]
        evidence, misfits, noises = (tuple(part[i] for part in parts if part) for i in (0, 1, 2))
        parameters = tuple(part[3] for part in parts if part and variant.ends)
        fit = Fit(variant.cause, variant.what, parameters, sum(evidence), max(misfits), max(noises))
        if variant.cause not in best or fit.evidence > best[variant.cause].evidence:
            best[variant.cause] = fit
    fits = sorted(best.values(), key=lambda fit: fit.evidence - math.log(counts[fit.cause]), reverse=True)
    return Diagnosis([row for rows in tables for row in rows], fits, _named(fits), submitted)


def _named(fits: Sequence[Fit]) -> list[str]:
    """Causes that are told: sound unless another is surely better, and all that fit alike."""
    sound = next(fit for fit in fits if fit.cause == "sound")
    fitting = [fit for fit in fits if fit.misfit <= FITS]
    if not fitting:
        return ["cannot-tell"]
    if sound in fitting and fitting[0].evidence - sound.evidence < SURE:
        return ["sound"]
    return [fit.cause for fit in fitting if fitting[0].evidence - fit.evidence < ALIKE]


def _rows(submitted: Submitted, problem: Problem) -> Iterator[Row]:
    values = problem.values
    span = approach_scale(values[f"{name}_approach"].value for name in EVENTS if f"{name}_approach" in values)
    for number in submitted.numbers:
        ours, kind = values.get(number.quantity), KINDS[number.quantity]
        size = abs(ours.value) if ours else abs(number.value)
        yield Row(problem.name, number, ours, span if kind in ("approach", "central_gap") or not size else size)


Result = tuple[float, float, float, float]  # evidence, mean square misfit, noise, parameter


def _fitted(variant: Variant, truth: Truth, rows: Sequence[Row]) -> Result | None:
    """Evidence of a variant for the numbers of a problem; None where it does not say anything of it."""
    theirs, scale = (np.array(column) for column in zip(*((row.number.value, row.scale) for row in rows), strict=True))
    own = [row.number.rounding + row.number.error + (row.ours.error if row.ours else 0.0) for row in rows]
    floor = np.array(own) / scale

    def misfits(logarithm: float) -> tuple[Array, Array] | None:
        """Deviations from the prediction, and its spreads, in parts of the numbers."""
        predicted = variant.predict(truth, math.exp(logarithm))
        if predicted is None:
            return None
        values, spreads = predicted
        given = np.array([values.get(row.number.quantity, math.nan) for row in rows])
        spread = np.array([spreads.get(row.number.quantity, 0.0) for row in rows]) / scale
        deviations = (theirs - given) / scale
        return np.where(np.isnan(deviations), 1.0, deviations), np.minimum(spread, 1.0)

    if variant.ends is None:
        found = misfits(0.0)
        return (*_likelihood(*found, floor), math.nan) if found else None
    first, last = np.log(variant.ends)
    trials = np.linspace(first, last, math.ceil((last - first) / STEP) + 1)
    if misfits(trials[0]) is None or misfits(trials[-1]) is None:
        return None

    def worse(logarithm: float) -> float:
        found = misfits(logarithm)
        return -_likelihood(*found, floor)[0] if found else math.inf

    near = int(np.argmin([worse(trial) for trial in trials]))
    ends = trials[max(near - 1, 0)], trials[min(near + 1, trials.size - 1)]
    place = float(minimize_scalar(worse, bounds=ends, method="bounded", options={"xatol": 1e-10}).x)
    found, beside = misfits(place), misfits(place + 1e-6)
    if found is None or beside is None:
        return None
    likelihood, misfit, noise = _likelihood(*found, floor)
    rates = (beside[0] - found[0]) / 1e-6 * (last - first)
    occam = math.log1p(float(np.sum(rates**2 / (floor**2 + noise**2 + found[1] ** 2)))) / 2
    return likelihood - occam, misfit, noise, math.exp(place)


def _likelihood(deviations: Array, spread: Array, floor: Array) -> tuple[float, float, float]:
    """Largest logarithm of the likelihood over the noise, the mean square misfit there, and the noise."""
    squares = floor**2 + spread**2 + NOISE[:, None] ** 2
    parts = deviations**2 / squares
    logarithms = -np.sum(parts + np.log(squares), axis=1) / 2
    best = int(np.argmax(logarithms))
    return float(logarithms[best]), float(parts[best].mean()), float(NOISE[best])
