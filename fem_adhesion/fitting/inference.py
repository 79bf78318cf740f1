"""Fit of an apparatus to a measured curve: likelihood, its best values, and their intervals.

Each sample is compared with the branch it was recorded on, before or after the jump in the data. The place of a jump is
a datum of its own, with the sampling step's error. Otherwise the likelihood would leap whenever the model's jump passes
a sample, by the square of the jump over the noise: no interval could be read off it. Samples between the last before
and the first after a jump are left out: the spring flies there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import brentq, least_squares
from scipy.stats import chi2 as chi2_law

from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting.model import Apparatus, Branches, Other, Theory, recorded
from halfspace.values import Array

LEVEL = 0.95  # of all intervals
BLIND = 1e6  # largest ratio of two standard errors
FARTHEST = 12.0  # coordinates beyond which nothing is asked for: a factor of 1e5
FEW = 5  # samples on either side of a division at least, of which a slope is known
ROUNDS = 5  # of dividing runs and fitting; two are usual
STEPS: Mapping[str, Any] = {"diff_step": 1e-4, "x_scale": 0.1, "xtol": 1e-5, "ftol": 1e-7, "max_nfev": 300}
"""Of least squares: derivatives over 1e-4 see past the kinks between the places of a curve."""


@dataclass(frozen=True)
class Run:
    """Samples in order on one branch: "separated", "contact", or "both" where the data show no jump."""

    segment: int
    branch: str
    samples: slice


@dataclass(frozen=True)
class Place:
    """Travel in m at which the data jump "on" or "off", and its standard error."""

    jump: str
    travel: float
    error: float


@dataclass(frozen=True)
class Data:
    """What is fitted: base's travel in m and force in N, as recorded, by runs, and the places of jumps.

    `noise` is the standard deviation of the force in N, `correlation` that of a sample with the next, `degree` that of
    the baseline, which is fitted with the contact: fitted before, it would take part of the far attraction away.
    `jitter` is the standard error of a travel in m, `periods` are those of the wave in the baseline of approach
    and of retract in m, 0 without one: a wave that stands still in contact, from the travel `standing` on.
    """

    travel: Array
    force: Array
    runs: Sequence[Run]
    places: Sequence[Place]
    noise: float
    correlation: float
    degree: int = 1
    jitter: float = 0.0
    periods: tuple[float, ...] = ()
    standing: float = math.inf

    def whitened(self, values: Array) -> Array:
        """Values of the samples (n, ...), run after run, made of unit variance and uncorrelated if they are noise."""
        return np.concatenate(
            [_white(values[run.samples], *level) for run, level in zip(self.runs, self._levels, strict=True)]
        )

    @cached_property
    def _levels(self) -> list[tuple[float, float]]:
        """Noise and correlation of each run: in contact an error of the travel is one of the force."""
        levels = list[tuple[float, float]]()
        for run in self.runs:
            slope = float(np.ptp(self.force[run.samples]) / np.ptp(self.travel[run.samples]))
            noise = math.hypot(self.noise, slope * self.jitter) if run.branch == "contact" else self.noise
            levels.append((noise, self.correlation * (self.noise / noise) ** 2))
        return levels

    @cached_property
    def baseline(self) -> Array:
        """Columns (n, ...) of the baseline: a polynomial and a wave for each segment, as drag and drift differ."""
        x = 2 * (self.travel - self.travel.min()) / np.ptp(self.travel) - 1
        segment, apart = np.zeros(x.size), np.minimum(self.travel, self.standing)
        for run in self.runs:
            segment[run.samples] = run.segment
            if run.branch == "contact":
                apart[run.samples] = self.standing
        powers = np.polynomial.legendre.legvander(x, self.degree).T
        columns = [power * (segment == way) for way in (0, 1) for power in powers]
        for way, period in enumerate(self.periods):
            phase = 2 * np.pi * apart / (period or 1.0)
            columns += [wave * (segment == way) for wave in (np.sin(phase), np.cos(phase)) if period]
        return np.column_stack(columns)

    @cached_property
    def _base(self) -> tuple[Array, Array, Array]:
        """Orthonormal columns that span the whitened baseline, those of the fit, and the whitened force."""
        q, r = np.linalg.qr(self.whitened(self.baseline))
        return q, r, self.whitened(self.force)

    def compared(self, model: Array) -> Array:
        """Whitened residuals of the best baseline beside a model's force."""
        q, _, force = self._base
        rest = force - self.whitened(model)
        return np.asarray(rest - q @ (q.T @ rest))

    def levelled(self, model: Array) -> Array:
        """Force without the baseline that is best beside a model's force."""
        q, r, force = self._base
        return self.force - self.baseline @ np.linalg.solve(r, q.T @ (force - self.whitened(model)))

    def modelled(self, found: Branches) -> Array:
        """Force of a model at the samples."""
        force = np.empty_like(self.force)
        for run in self.runs:
            z = self.travel[run.samples]
            if run.branch == "both":
                before, after = (np.interp(z, *branch) for branch in (found.separated, found.contact))
                force[run.samples] = np.where(z < found.place(run.segment), before, after)
            else:
                force[run.samples] = np.interp(z, *getattr(found, run.branch))
        return force

    def divided(self, found: Branches, *, loose: bool = False) -> Data:
        """The same data with runs on both branches divided where a model that jumps would best have it.

        If `loose`, the samples alone decide, and not where the model jumps.

        The samples before and after leave the place of a faint jump open: its standard error is that of a step of
        known size in noise, sqrt(26) (noise/step)^2 samples (Yao, Ann. Stat. 15 (1987) 1321), beside the sampling step.
        """
        if not found.jumps:
            return self
        rest, runs, places = (
            self.levelled(self.modelled(found)),
            list[Run](),
            list(self.places),
        )
        noise = self.noise * math.sqrt((1 + self.correlation) / (1 - self.correlation))  # of means of many samples
        for run in self.runs:
            if run.branch != "both":
                runs.append(run)
                continue
            z, turn = self.travel[run.samples], found.place(run.segment)
            order = (found.contact, found.separated) if run.segment else (found.separated, found.contact)
            first, then = (np.interp(z, *branch) for branch in order)
            size = abs(float(np.interp(turn, *found.contact) - np.interp(turn, *found.separated)))
            step = float(np.median(np.abs(np.diff(z))))
            error = step * math.hypot(math.sqrt(1 / 12), math.sqrt(26) * (noise / size) ** 2)
            gain = ((rest[run.samples] - first) ** 2 - (rest[run.samples] - then) ** 2)[1:] / noise**2
            between = (z[1:] + z[:-1]) / 2
            off = ((between - turn) / error) ** 2 * (not loose)
            i = int(np.argmin((np.cumsum(gain) - gain + off)[FEW:-FEW])) + FEW + 1
            names = ("contact", "separated") if run.segment else ("separated", "contact")
            start, stop = run.samples.start, run.samples.stop
            parts = slice(start, start + i), slice(start + i, stop)
            runs += [Run(run.segment, branch, part) for branch, part in zip(names, parts, strict=True)]
            places.append(Place("off" if run.segment else "on", float(between[i - 1]), error))
        return replace(self, runs=runs, places=places)


def _white(values: Array, noise: float, correlation: float) -> Array:
    """Values in order without noise's correlation with the next one, in standard deviations of the noise."""
    rest = (values[1:] - correlation * values[:-1]) / math.sqrt(1 - correlation**2)
    return np.concatenate([values[:1], rest]) / noise


SCALES = ("radius", "modulus", "work_of_adhesion", "spacing", "stiffness", "sensitivity")
"""Positive parameters: the fitter moves their logarithms."""


@dataclass(frozen=True)
class Problem:
    """Likelihood of an apparatus, as residuals whose squares sum up to -2 ln of it.

    `start` holds all parameters, `fitted` the names of those that are moved, `prior` what was known of some of them.
    """

    theory: Theory
    other: Other
    data: Data
    start: Apparatus
    fitted: tuple[str, ...]
    prior: Mapping[str, Measured]
    recorded_stiffness: float | None = None

    def apparatus(self, x: Array) -> Apparatus:
        """Apparatus at the fitter's coordinates: logarithms, and lengths in spacings of the start."""
        moved = {name: self.value(name, float(at)) for name, at in zip(self.fitted, x, strict=True)}
        return replace(self.start, **moved)

    def value(self, name: str, x: float) -> float:
        """Value at a coordinate."""
        value: float = getattr(self.start, name)
        if name in SCALES:
            return value * math.exp(min(max(x, -FARTHEST), FARTHEST))
        return value + x * self._unit(name) if name == "contact_point" else max(value + x * self._unit(name), 0.0)

    def coordinate(self, name: str, value: float) -> float:
        """Coordinate of a value."""
        start: float = getattr(self.start, name)
        return math.log(value / start) if name in SCALES else (value - start) / self._unit(name)

    @property
    def held(self) -> tuple[str, ...]:
        """What is known with an error and was not fitted."""
        return tuple(name for name in self.prior if name not in self.fitted)

    def departure(self, name: str, value: float) -> float:
        """Standard errors from what was known to a value; log-normal where the quantity is positive.

        A normal error would leave a radius of 10 +- 3 nm free to run to zero for 3.3 standard errors, and it did.
        """
        known, error = self.prior[name]
        return math.log(value / known) * known / error if name in SCALES else (value - known) / error

    def _unit(self, name: str) -> float:
        units = self.other.units(self.start)
        return units.approach + units.displacement if name == "contact_point" else 1 / self.start.stiffness

    def branches(self, apparatus: Apparatus) -> Branches:
        """Branches as they are recorded."""
        return recorded(self.theory, apparatus, self.other.units(apparatus), self.recorded_stiffness)

    def residuals(self, x: Array) -> Array:
        """Whitened residuals of the samples, then those of the jumps' places and of what was known before."""
        apparatus = self.apparatus(x)
        found = self.branches(apparatus)
        samples = self.data.compared(self.data.modelled(found))
        places = [((found.on if at.jump == "on" else found.off) - at.travel) / at.error for at in self.data.places]
        known = [self.departure(name, getattr(apparatus, name)) for name in self.prior]
        return np.concatenate([samples, places, known])

    def __call__(self, x: Array) -> float:
        """Sum of the squares."""
        residuals = self.residuals(x)
        return float(residuals @ residuals)

    def jacobian(self, x: Array) -> Array:
        """Derivatives of the residuals by the coordinates."""
        return np.asarray(least_squares(self.residuals, x, diff_step=STEPS["diff_step"], max_nfev=1).jac)

    def best(self, x: Array, held: str | None = None) -> Best:
        """Least squares from coordinates on, one of the parameters held or none."""
        free = np.array([name != held for name in self.fitted])

        def residuals(moved: Array) -> Array:
            at = x.copy()
            at[free] = moved
            return self.residuals(at)

        found = least_squares(residuals, x[free], method="lm", **STEPS)
        there = x.copy()
        there[free] = found.x
        return Best(self, self, there, 2 * float(found.cost), np.asarray(found.jac))

    def settled(self, x: Array, held: str | None = None, *, loose: bool = False) -> Best:
        """Least squares where runs without a jump in the data are divided as the model has it; see `Data.divided`.

        If `loose`, the coordinates are a first guess, and the samples alone decide on the first division.
        """
        runs = self.data.runs
        for i in range(ROUNDS):
            divided = self.data.divided(self.branches(self.apparatus(x)), loose=loose and not i)
            found = replace(replace(self, data=divided).best(x, held), asked=self)
            if runs == divided.runs:
                break
            x, runs = found.x, divided.runs
        return found


@dataclass(frozen=True, eq=False)
class Best:
    """Where the likelihood is greatest: coordinates x, -2 ln of it, and the Jacobian of the residuals.

    `asked` is the problem with the runs of the data, `problem` that with the runs as the fit divides them.
    """

    problem: Problem
    asked: Problem
    x: Array
    chi2: float
    jacobian: Array

    @property
    def apparatus(self) -> Apparatus:
        """What was found."""
        return self.problem.apparatus(self.x)

    @property
    def degrees(self) -> int:
        """Degrees of freedom, the coefficients of the baseline taken off."""
        return int(len(self.jacobian) - self.problem.data.baseline.shape[1] - self.x.size)

    @property
    def scale(self) -> float:
        """Chi square per degree of freedom, or 1 if that is less: intervals grow by its root, as a misfit demands."""
        return max(1.0, self.chi2 / self.degrees)

    def error(self, name: str) -> float:
        """Standard error of a parameter's coordinate, by the curvature."""
        i = self.problem.fitted.index(name)
        return math.sqrt(self.scale * self.covariance[i, i])

    @cached_property
    def covariance(self) -> Array:
        """Inverse of the curvature of the likelihood, of the coordinates where the noise is the baseline's.

        What the data do not show at all has a standard error of `BLIND` times that of what they show best.
        """
        _, sizes, directions = np.linalg.svd(self.jacobian, full_matrices=False)
        return np.asarray((directions.T / np.maximum(sizes, sizes[0] / BLIND) ** 2) @ directions)

    def interval(
        self, name: str, limits: tuple[float, float], others: Sequence[Best] = ()
    ) -> tuple[float | None, float | None]:
        """Ends of a parameter's interval by the profile likelihood, in its coordinate; None if beyond the limits.

        Other fits that are likely enough show how far the interval reaches at least, whatever lies between.
        MINOS was tried in the place of this: of 24 curves it gave up an end of five, where the likelihood has a kink
        or a limit, and had the same ends to three digits elsewhere.
        """
        i, rise = self.problem.fitted.index(name), self.scale * float(chi2_law.ppf(LEVEL, 1))
        seeds = [
            np.array([self.problem.coordinate(key, getattr(one.apparatus, key)) for key in self.problem.fitted])
            for one in others
            if one.chi2 < self.chi2 + rise
        ]
        low, high = (
            self._end(
                name, side, side * (limit - float(self.x[i])), [x for x in seeds if side * (x[i] - self.x[i]) > 0]
            )
            for side, limit in zip((-1, 1), limits, strict=True)
        )
        return low, high

    def _end(self, name: str, side: int, limit: float, seeds: Sequence[Array]) -> float | None:
        """Coordinate where the profile has risen by the quantile, each fit from the nearest one before."""
        i, rise = self.problem.fitted.index(name), self.scale * float(chi2_law.ppf(LEVEL, 1))
        known = {side * float(x[i] - self.x[i]): (0.0, x) for x in (self.x, *seeds)}
        along = side * self.covariance[:, i] / self.covariance[i, i]

        def excess(t: float) -> float:
            if t not in known or not known[t][0]:
                near = min(known, key=lambda other: abs(other - t))
                starts = [known[near][1].copy(), known[near][1] + (t - near) * along]
                starts[0][i] = self.x[i] + side * t
                found = self.asked.settled(min(starts, key=self.asked), held=name)
                known[t] = found.chi2 - self.chi2 - rise, found.x
            return known[t][0]

        near = max(known)
        if near >= limit:
            return None
        known[near] = min(known[near][0], -1e-9), known[near][1]
        step = min(2 * self.error(name), 1.0)
        far = min(near + step, limit)
        while excess(far) < 0:
            if far >= limit:
                return None
            step *= 2
            near, far = far, min(far + step, limit)
        return float(self.x[i] + side * brentq(excess, near, far, xtol=1e-2 * (far - near), rtol=1e-3))

    def contour(self, names: tuple[str, str], ends: tuple[float, float], count: int = 5) -> Array:
        """Contour (2, n) of a pair: the second name's values between the ends, the first's where the profile says.

        At each value of the second the first is taken to be normal about its best value.
        """
        i, j = (self.problem.fitted.index(name) for name in names)
        level = self.scale * float(chi2_law.ppf(LEVEL, 2))
        points = list[tuple[float, float, float]]()
        for end in ends:
            x = self.x
            for value in np.linspace(self.x[j], end, count):
                x = x.copy()
                x[j] = value
                found = self.asked.settled(x, held=names[1])
                x, rest = found.x, level - (found.chi2 - self.chi2)
                if rest > 0:
                    k = i - (i > j)
                    half = math.sqrt(rest * found.covariance[k, k])
                    points.append((float(value), x[i] - half, x[i] + half))
        value, low, high = np.array(sorted(points)).T
        return np.array([np.append(low, high[::-1]), np.append(value, value[::-1])])
