"""What a measured curve says before any model: its baseline, noise, contact and jumps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from fem_adhesion.common.numbers import engineering
from fem_adhesion.fitting.measured import ForceCurve
from halfspace.errors import InputError
from halfspace.values import Array, Mask, Valued

BEYOND = 5.0  # standard deviations of the noise beyond which a force is a contact's or a jump's
FLAT = 0.1  # share of a segment that the baseline has at least, and of the slope in contact that it has at most
APART = 0.05  # share of the baseline next to the contact that is left out, for the attraction before it
FINEST = 1e-4  # share of the largest force that is no contact's, even where there is no noise
ROUNDS = 4  # of clipping and of moving the contact, after which neither changes
RUN = 5  # samples in a row beyond the noise that are a contact, or equal at an extreme force a detector's limit
MAD = 1.4826  # standard deviation of normal noise in its median absolute deviation
SETTLED = 0.03  # share of the steepest step of a jump below which it is over; amplifiers ring and creep
SMEARED = 10  # samples over which a jump is seen at most: amplifiers smear those of the curves tried over 2 to 7


@dataclass(frozen=True)
class Jump:
    """A jump of the force while the base stands still.

    Attributes
    ----------
    last, first : int
        Index of the last sample before and of the first after it; those between belong to no branch.
    travel : float
        Place of the base or tip in m, in the middle between the two.
    size : float
        Change of the force in N, positive.
    """

    last: int
    first: int
    travel: float
    size: float


@dataclass(frozen=True)
class Baseline:
    """Force without contact, offset + slope s + curvature s^2, s the travel from the contact.

    Attributes
    ----------
    offset, slope, curvature : float
        In N, N/m and N/m^2; the curvature is zero where the noise hides it.
    """

    offset: float
    slope: float
    curvature: float

    def at(self, distance: Array) -> Array:
        """Force in N at travels in m from the contact, positive beyond it."""
        return self.offset + distance * (self.slope + distance * self.curvature)


@dataclass(frozen=True, eq=False, repr=False)
class Prepared(Valued):
    """A curve and what was found in it.

    Attributes
    ----------
    curve : ForceCurve
        As measured.
    baseline : mapping of str to Baseline
        That of "approach" and that of "retract": the detector drifts between the two.
    background : (n,) array
        Both baselines in N at the samples.
    noise : float
        Standard deviation of the force about its baseline, in N.
    correlation : float
        Of a sample of the noise with the next.
    contact : float
        Travel in m at which the force of the approach, below its baseline, last rises through it.
    jump_on, jump_off : Jump or None
        None where no jump stands out of the noise.
    pull_off : float
        Depth of the least force of the retract below the baseline in N, positive.
    """

    curve: ForceCurve
    baseline: Mapping[str, Baseline]
    background: Array
    noise: float
    correlation: float
    contact: float
    jump_on: Jump | None
    jump_off: Jump | None
    pull_off: float


def prepare(curve: ForceCurve) -> Prepared:
    """Find baseline, noise, contact and jumps of a curve.

    Raises
    ------
    InputError
        If it has no baseline, no contact, or forces at the limit of the detector.
    """
    ways = {"approach": curve.approach, "retract": slice(None, curve.retract.start - 1, -1)}  # both towards the sample
    far = {name: _far(name, curve.travel[way], curve.force[way]) for name, way in ways.items()}
    background = np.empty_like(curve.force)
    for name, way in ways.items():
        background[way] = far[name].line(curve.travel[way])
    above = curve.force - background
    left = [above[way][: far[name].end] for name, way in ways.items()]
    noise = float(np.std(np.concatenate(left)))
    steps = float(np.std(np.concatenate([np.diff(part) for part in left])))
    _require_unsaturated(curve.force, above, noise)
    contact = _contact(curve.travel[curve.approach], above[curve.approach])
    on = slice(far["approach"].end - SMEARED, curve.approach.stop)
    jump_on = _jump(curve.travel, -above, on, steps)
    if jump_on is None and above[curve.approach].max() < BEYOND * noise:
        raise InputError(_no_contact("approach", above[curve.approach], BEYOND * noise))
    for name, way in ways.items():
        _require_flat(name, far[name], curve.travel[way], curve.force[way])
    deepest = curve.retract.start + int(np.argmin(above[curve.retract]))
    off = slice(max(deepest - SMEARED, curve.retract.start), above.size - far["retract"].end + SMEARED)
    return Prepared(
        curve,
        {name: _at(far[name].line, contact) for name in ways},
        background,
        noise,
        max(0.0, 1 - (steps / noise) ** 2 / 2) if noise else 0.0,
        contact,
        jump_on,
        _jump(curve.travel, above, off, steps),
        -float(above[curve.retract].min()),
    )


@dataclass(frozen=True)
class Far:
    """The part of a segment that is far from the sample: the line through it, and at which sample it ends."""

    line: Polynomial
    end: int


def _far(name: str, travel: Array, force: Array) -> Far:
    """Part of a segment, which begins apart, before the force leaves its line for good."""
    least = int(FLAT * travel.size)
    line, end = Polynomial([np.median(force[:least])]), 0
    size = float(np.max(np.abs(force - line(travel[0]))))
    limit = max(FLAT * size / 2, BEYOND * float(np.std(force[:least])))
    for _ in range(ROUNDS):
        found = _first_run(np.abs(force - line(travel)) > limit)
        if found is None:
            raise InputError(_no_contact(name, force - line(travel), limit))
        end = int((1 - APART) * found)
        if end < least:
            many = f"{end} of {travel.size} samples are on a line far from the sample"
            raise InputError(f"no baseline in the {name}: {many}, limit: {least}; begin farther away")
        line, noise = _line(travel[:end], force[:end])
        limit = max(BEYOND * noise, FINEST * size)
    return Far(line, end)


def _require_flat(name: str, far: Far, travel: Array, force: Array) -> None:
    """Refuse a baseline that rises as the force does in contact: it is one."""
    slope = abs(float(far.line.deriv()(travel[far.end])))
    steep = float(np.ptp(force[far.end :]) / np.ptp(travel[far.end :]))
    if slope > FLAT * steep:
        rises = f"the force changes by {slope:.2g} N/m far from the sample and {steep:.2g} N/m near it"
        raise InputError(f"no baseline in the {name}: {rises}, limit: {FLAT:g} of that; begin farther away")


def _no_contact(name: str, above: Array, limit: float) -> str:
    """Say that the force stays on its baseline."""
    most, needed = (engineering(number, "N") for number in (float(np.abs(above).max()), limit))
    off = f"the force is at most {most} off its baseline, never {RUN} samples in a row by {needed}"
    remedy = "press until the force rises, begin and end far apart"
    return f"no contact in the {name}: {off}, limit: {BEYOND:g} standard deviations; {remedy}"


def _line(travel: Array, force: Array) -> tuple[Polynomial, float]:
    """Line through most samples, a parabola where that takes off more than the noise explains, and their spread."""
    kept = np.ones(force.size, dtype=bool)
    for _ in range(ROUNDS):
        line = Polynomial.fit(travel[kept], force[kept], 1)
        off = np.abs(force - line(travel))
        kept = off <= BEYOND * MAD * np.median(off)
    bent = Polynomial.fit(travel[kept], force[kept], 2)
    straight, curved = ((force - each(travel))[kept] for each in (line, bent))
    # A parabola fitted to noise takes off the share of one independent sample; 25 times that by a chance of 1e-6.
    correlation = max(0.0, float(np.mean(curved[1:] * curved[:-1]) / np.mean(curved**2)))
    independent = curved.size * (1 - correlation) / (1 + correlation)
    if np.sum(straight**2) > (1 + BEYOND**2 / independent) * np.sum(curved**2):
        line, straight = bent, curved
    return line, float(np.std(straight))


def _first_run(beyond: Mask) -> int | None:
    """Index of the first of `RUN` samples in a row that are beyond."""
    runs = np.flatnonzero(np.convolve(beyond, np.ones(RUN), "valid") == RUN)
    return int(runs[0]) if runs.size else None


def _at(line: Polynomial, contact: float) -> Baseline:
    """Baseline of a polynomial in the travel."""
    offset, slope, curvature = (float(line.deriv(order)(contact) if order else line(contact)) for order in range(3))
    return Baseline(offset, slope, curvature / 2)


def _require_unsaturated(force: Array, above: Array, noise: float) -> None:
    """Refuse equal forces in a row at the largest or the least force, unless that is the baseline's."""
    for extreme in (force.max(), force.min()):
        at = _first_run(force == extreme)
        if at is not None and abs(above[at]) > BEYOND * noise:
            raise InputError(
                f"the force is saturated: it stays at {engineering(float(extreme), 'N')} from sample {at} on, limit: "
                f"less than {RUN} equal samples at an extreme; press less or extend the detector's range"
            )


def _contact(travel: Array, above: Array) -> float:
    """Travel at which the force last rises through the baseline; its last if it never does."""
    i = int(np.flatnonzero(above <= 0)[-1])  # the baseline is a mean: some samples are below it
    pair = slice(i, i + 2)
    return float(np.interp(0.0, above[pair], travel[pair]))


def _jump(travel: Array, force: Array, where: slice, steps: float) -> Jump | None:
    """Jump about the steepest rise of the force in a part of the curve, if it stands out of the noise of steps."""
    rises = np.diff(force[where])
    steepest = int(np.argmax(rises))
    jumps = rises > max(BEYOND * steps, SETTLED * rises[steepest])
    if not jumps[steepest]:
        return None
    before, after = np.flatnonzero(~jumps[:steepest]), np.flatnonzero(~jumps[steepest:])
    last = where.start + (int(before[-1]) + 1 if before.size else 0)
    first = where.start + steepest + (int(after[0]) if after.size else jumps.size - steepest)
    if first - last > SMEARED:
        return None
    return Jump(last, first, float(travel[last] + travel[first]) / 2, float(force[first] - force[last]))
