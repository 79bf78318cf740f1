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

import numpy as np
from scipy.optimize import least_squares

from fem_adhesion.fitting.model import Apparatus, Branches, Other, Theory, recorded
from halfspace.values import Array

LEVEL = 0.95  # of all intervals


@dataclass(frozen=True)
class Given:
    """What is known of a quantity before the fit: its value and standard error, 0 if exact, infinite if free."""

    value: float
    error: float = 0.0


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

    `noise` is the standard deviation of the force in N, `correlation` that of a sample with the next.
    """

    travel: Array
    force: Array
    runs: Sequence[Run]
    places: Sequence[Place]
    noise: float
    correlation: float

    def whitened(self, values: Array) -> Array:
        """Values of the samples (n, ...), run after run, made of unit variance and uncorrelated if they are noise."""
        return np.concatenate([self._whitened(values[run.samples]) for run in self.runs])

    def _whitened(self, run: Array) -> Array:
        rest = (run[1:] - self.correlation * run[:-1]) / math.sqrt(1 - self.correlation**2)
        return np.concatenate([run[:1], rest]) / self.noise

    @cached_property
    def baseline(self) -> Array:
        """Columns (n, 4): offset and slope of the baseline of each segment; drag and drift differ between them."""
        columns = np.zeros((self.travel.size, 4))
        x = (self.travel - self.travel.mean()) / np.ptp(self.travel)
        for run in self.runs:
            columns[run.samples, 2 * run.segment] = 1.0
            columns[run.samples, 2 * run.segment + 1] = x[run.samples]
        return columns

    @cached_property
    def _base(self) -> tuple[Array, Array, Array]:
        """Orthonormal columns that span the whitened baseline, those of the fit, and the whitened force."""
        q, r = np.linalg.qr(self.whitened(self.baseline))
        return q, r, self.whitened(self.force)

    def compared(self, model: Array) -> tuple[Array, Array]:
        """Whitened residuals of the best baseline beside a model's force, and the coefficients of the baseline."""
        q, r, force = self._base
        rest = force - self.whitened(model)
        along = q.T @ rest
        return rest - q @ along, np.asarray(np.linalg.solve(r, along))

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

    def divided(self, found: Branches) -> Data:
        """The same data with runs on both branches divided where a model that jumps would best have it.

        The samples before and after leave the place of a faint jump open: its standard error is that of a step of
        known size in noise, sqrt(26) (noise/step)^2 samples (Yao, Ann. Stat. 15 (1987) 1321), beside the sampling step.
        """
        if not found.jumps:
            return self
        rest, runs, places = self.force - self.baseline @ self.compared(self.modelled(found))[1], list[Run](), list(self.places)
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
            i = int(np.argmin(np.cumsum(gain) - gain + ((between - turn) / error) ** 2)) + 1
            names = ("contact", "separated") if run.segment else ("separated", "contact")
            start, stop = run.samples.start, run.samples.stop
            parts = slice(start, start + i), slice(start + i, stop)
            runs += [Run(run.segment, branch, part) for branch, part in zip(names, parts, strict=True)]
            places.append(Place("off" if run.segment else "on", float(between[i - 1]), error))
        return replace(self, runs=runs, places=places)


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
    prior: Mapping[str, Given]
    recorded_stiffness: float | None = None

    def apparatus(self, x: Array) -> Apparatus:
        """Apparatus at the fitter's coordinates: logarithms, and lengths in spacings of the start."""
        moved = {name: self._value(name, float(at)) for name, at in zip(self.fitted, x, strict=True)}
        return replace(self.start, **moved)

    def _value(self, name: str, x: float) -> float:
        value: float = getattr(self.start, name)
        return value * math.exp(x) if name in SCALES else value + x * self._unit(name)

    def coordinate(self, name: str, value: float) -> float:
        """Coordinate of a value."""
        start: float = getattr(self.start, name)
        return math.log(value / start) if name in SCALES else (value - start) / self._unit(name)

    def _unit(self, name: str) -> float:
        return self.start.spacing if name == "contact_point" else 1 / self.start.stiffness

    def branches(self, apparatus: Apparatus) -> Branches:
        """Branches as they are recorded."""
        return recorded(self.theory, apparatus, self.other.units(apparatus), self.recorded_stiffness)

    def residuals(self, x: Array) -> Array:
        """Whitened residuals of the samples, then those of the jumps' places and of what was known before."""
        apparatus = self.apparatus(x)
        found = self.branches(apparatus)
        samples, _ = self.data.compared(self.data.modelled(found))
        places = [((found.on if at.jump == "on" else found.off) - at.travel) / at.error for at in self.data.places]
        known = [(getattr(apparatus, name) - given.value) / given.error for name, given in self.prior.items()]
        return np.concatenate([samples, places, known])

    def __call__(self, x: Array) -> float:
        """Sum of the squares."""
        residuals = self.residuals(x)
        return float(residuals @ residuals)

    def best(self, x: Array) -> Array:
        """Coordinates of least squares nearby."""
        found = least_squares(self.residuals, x, x_scale=0.1, method="trf", max_nfev=30, xtol=1e-6, ftol=1e-6)
        return np.asarray(found.x)
