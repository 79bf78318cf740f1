"""What is fitted of a measured curve: samples by the branch they were recorded on, and the places of jumps.

Each sample is compared with the branch it was recorded on, before or after the jump in the data. The place of a jump is
a datum of its own, with the sampling step's error. Otherwise the likelihood would leap whenever the model's jump passes
a sample, by the square of the jump over the noise: no interval could be read off it. Samples between the last before
and the first after a jump are left out: the spring flies there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_adhesion.fitting.model import Branches
from halfspace.values import Array

ORDER = (("separated", "contact"), ("contact", "separated"))
"""Branches by segment, 0 the approach and 1 the retract, as they are recorded."""

FEW = 5  # samples on either side of a division at least, of which a slope is known


@dataclass(frozen=True)
class Run:
    """Samples in order on one branch: "separated", "contact", or "both" where the data show no jump."""

    segment: int
    branch: str
    samples: slice


@dataclass(frozen=True)
class Place:
    """Travel in m at which the data of a segment jump, its standard error, and whether that is of a uniform law."""

    segment: int
    travel: float
    error: float
    is_uniform: bool = True


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
        levels = zip(self.runs, self._levels, strict=True)
        return np.concatenate([_white(values[run.samples], *level) for run, level in levels])

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
        rest, runs, places = self.levelled(self.modelled(found)), list[Run](), list(self.places)
        noise = self.noise * math.sqrt((1 + self.correlation) / (1 - self.correlation))  # of means of many samples
        for run in self.runs:
            if run.branch != "both":
                runs.append(run)
                continue
            z, turn = self.travel[run.samples], found.place(run.segment)
            names = ORDER[run.segment]
            first, then = (np.interp(z, *getattr(found, name)) for name in names)
            size = abs(float(np.interp(turn, *found.contact) - np.interp(turn, *found.separated)))
            step = float(np.median(np.abs(np.diff(z))))
            error = step * math.hypot(math.sqrt(1 / 12), math.sqrt(26) * (noise / size) ** 2)
            gain = ((rest[run.samples] - first) ** 2 - (rest[run.samples] - then) ** 2)[1:] / noise**2
            between = (z[1:] + z[:-1]) / 2
            off = ((between - turn) / error) ** 2 * (not loose)
            i = int(np.argmin((np.cumsum(gain) - gain + off)[FEW:-FEW])) + FEW + 1
            start, stop = run.samples.start, run.samples.stop
            parts = slice(start, start + i), slice(start + i, stop)
            runs += [Run(run.segment, branch, part) for branch, part in zip(names, parts, strict=True)]
            places.append(Place(run.segment, float(between[i - 1]), error, is_uniform=False))
        return replace(self, runs=runs, places=places)


def _white(values: Array, noise: float, correlation: float) -> Array:
    """Values in order without noise's correlation with the next one, in standard deviations of the noise."""
    rest = (values[1:] - correlation * values[:-1]) / math.sqrt(1 - correlation**2)
    return np.concatenate([values[:1], rest]) / noise
