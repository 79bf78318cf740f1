"""What a measured curve says before any model: its baseline, noise, contact and jumps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial
from scipy.signal import savgol_filter

from fem_adhesion.common.numbers import engineering
from fem_adhesion.fitting.measured import APPROACH, ForceCurve
from halfspace.errors import InputError
from halfspace.values import Array, Mask, Valued


@dataclass(frozen=True)
class PrepareSettings:
    """What of a measured curve is noise, baseline, contact or a jump."""

    beyond: float = 5.0  # standard deviations of the noise beyond which a force is a contact's or a jump's
    flat: float = 0.1  # share of a segment that the baseline has at least, and of the slope in contact at most
    apart: float = 0.05  # share of the baseline next to the contact that is left out, for the attraction before it
    finest: float = 1e-4  # share of the largest force that is no contact's, even where there is no noise
    rounds: int = 4  # of clipping and of moving the contact, after which neither changes
    turn: int = 50  # samples next to the turn, which are in contact if any are
    run: int = 5  # samples in a row beyond the noise that are a contact, or equal ones a detector's limit
    rounded: float = 1e-9  # of its way, by which a travel scatters where a file's digits end; converters resolve 1e-8
    settled: float = 0.03  # share of the steepest step of a jump below which it is over; amplifiers ring and creep
    smeared: int = 10  # samples over which a jump is seen at most: those of the curves tried are over 2 to 7


HOW = PrepareSettings()

PERIODS = np.geomspace(200e-9, 600e-9, 250).tolist()  # m, of half the wavelengths of lasers, 400 to 1200 nm
MAD = 1.4826  # standard deviation of normal noise in its median absolute deviation


@dataclass(frozen=True)
class Far:
    """The part of a segment that is far from the sample: the line and the wave through it, and where it ends.

    Light from the sample interferes with that from the cantilever: a wave, whose phase follows their distance, so that
    it stands still in contact.

    Attributes
    ----------
    line : Polynomial
        Force in N of the travel in m, of degree 2 where the noise does not hide a curvature.
    wave : tuple of float
        Coefficients of its sine and cosine in N.
    period : float
        Of the wave in m, 0 without one.
    end : int
        First sample beyond.
    edge : float
        Travel at which the force leaves the line.
    """

    line: Polynomial
    wave: tuple[float, float]
    period: float
    end: int
    edge: float

    @property
    def amplitude(self) -> float:
        """Of the wave in N."""
        return math.hypot(*self.wave)

    def at(self, travel: Array) -> Array:
        """Force without contact in N at travels in m."""
        phase = 2 * np.pi * np.minimum(travel, self.edge) / (self.period or 1.0)
        return np.asarray(self.line(travel) + self.wave[0] * np.sin(phase) + self.wave[1] * np.cos(phase))


@dataclass(frozen=True, eq=False, repr=False)
class Prepared(Valued):
    """A curve and what was found in it.

    Attributes
    ----------
    curve : ForceCurve
        As measured.
    baseline : mapping of str to Far
        That of "approach" and that of "retract": the detector drifts between the two.
    background : (n,) array
        Both baselines in N at the samples.
    noise : float
        Standard deviation of the force about its baseline, in N.
    correlation : float
        Of a sample of the noise with the next.
    contact : float
        Travel in m at which the force of the approach, below its baseline, last rises through it.
    jump_on, jump_off : slice or None
        From the last sample before a jump of the force to the first after it; those between belong to no branch, as the
        base stands still. None where no jump stands out of the noise.
    pull_off : float
        Depth of the least force of the retract below the baseline in N, positive.
    """

    curve: ForceCurve
    baseline: Mapping[str, Far]
    background: Array
    noise: float
    correlation: float
    contact: float
    jump_on: slice | None
    jump_off: slice | None
    pull_off: float

    @property
    def told(self) -> tuple[str, ...]:
        """What was found about the curve, in sentences."""
        wave = max(self.baseline.values(), key=lambda each: each.amplitude)
        sizes = f"{engineering(wave.amplitude, 'N')} and a period of {engineering(wave.period, 'm')}"
        light = f"The baseline has a wave of {sizes}, as light makes that interferes; it was taken off."
        return (*self.curve.told, *([light] if wave.amplitude else []))


def prepare(curve: ForceCurve) -> Prepared:
    """Find baseline, noise, contact and jumps of a curve.

    Raises
    ------
    InputError
        If it has no baseline, no contact, or forces at the limit of the detector.
    """
    curve = _steadied(curve)
    ways = {"approach": curve.approach, "retract": slice(None, curve.retract.start - 1, -1)}  # both towards the sample
    far = {name: _far(name, curve.travel[way], curve.force[way]) for name, way in ways.items()}
    background = np.empty_like(curve.force)
    for name, way in ways.items():
        background[way] = far[name].at(curve.travel[way])
    above = curve.force - background
    left = [above[way][: far[name].end] for name, way in ways.items()]
    noise = float(np.std(np.concatenate(left)))
    steps = float(np.std(np.concatenate([np.diff(part) for part in left])))
    _require_unsaturated(curve.force, above, noise)
    contact = _contact(curve.travel[curve.approach], above[curve.approach])
    on = slice(far["approach"].end - HOW.smeared, curve.approach.stop)
    jump_on = _jump(-above, on, steps)
    if jump_on is None and above[curve.approach].max() < HOW.beyond * noise:
        raise InputError(_no_contact("approach", above[curve.approach], HOW.beyond * noise))
    for name, way in ways.items():
        _require_flat(name, far[name], curve.travel[way], curve.force[way])
    deepest = curve.retract.start + int(np.argmin(above[curve.retract]))
    off = slice(max(deepest - HOW.smeared, curve.retract.start), above.size - far["retract"].end + HOW.smeared)
    return Prepared(
        curve,
        far,
        background,
        noise,
        max(0.0, 1 - (steps / noise) ** 2 / 2) if noise else 0.0,
        contact,
        jump_on,
        _jump(above, off, steps),
        -float(above[curve.retract].min()),
    )


def _steadied(curve: ForceCurve) -> ForceCurve:
    """Curve whose travel is smooth in time in each segment where what scatters is the sensor, not the base.

    In contact the force follows the base: if it scatters less about a smooth motion than about the recorded one, the
    base did not move so. Of tip positions nothing is told apart: the noise of the force is in them.
    """
    if curve.coordinate == APPROACH:
        return curve
    smooth, recorded, steady = curve.travel.copy(), 0.0, 0.0
    for part, near in ((curve.approach, slice(-HOW.turn, None)), (curve.retract, slice(HOW.turn))):
        smooth[part] = savgol_filter(curve.travel[part], int(HOW.flat * (part.stop - part.start)) | 1, 3)
        force, own, slow = (each[part][near] for each in (curve.force, curve.travel, smooth))
        stiffness = np.polyfit(slow - slow.mean(), force, 1)[0]
        recorded += float(np.var(np.diff(force - stiffness * own)))
        steady += float(np.var(np.diff(force - stiffness * slow)))
    scatter = float(np.std(curve.travel - smooth))
    if recorded <= steady or scatter < HOW.rounded * float(np.ptp(curve.travel)):
        return curve
    why = (
        f"The travel scatters by {engineering(scatter, 'm')}, which the force does not follow: it was smoothed in time."
    )
    return replace(curve, travel=smooth, told=(*curve.told, why))


def _far(name: str, travel: Array, force: Array) -> Far:
    """Part of a segment, which begins apart, before the force leaves its line for good.

    The search starts from a level and from the drift of the first half; the one that goes farther is right,
    but not to the end of a segment that is one line in contact.
    """
    least, lag = int(HOW.flat * travel.size), travel.size // 20
    level, half = float(np.median(force[:least])), travel.size // 2
    rise, way = (float(np.median(each[lag:half] - each[: half - lag])) for each in (force, travel))
    drift = rise / way if way else 0.0
    limit = max(HOW.flat / 2 * float(np.max(np.abs(force - level))), HOW.beyond * float(np.std(force[:least])))
    middle = float(np.median(travel[:least]))
    found = [_left(travel, force, Polynomial([level - drift * middle, drift]), limit) for drift in (0.0, drift)]
    line, leaves = max([each for each in found if each[1] < travel.size] or found, key=lambda each: each[1])
    if leaves == travel.size:
        raise InputError(_no_contact(name, force - line(travel), limit))
    end = int((1 - HOW.apart) * leaves)
    if end < least:
        many = f"{end} of {travel.size} samples are on a line far from the sample"
        raise InputError(f"no baseline in the {name}: {many}, limit: {least}; begin farther away")
    return Far(*_waved(travel[:end], force[:end], line), end, float(travel[leaves]))


def _left(travel: Array, force: Array, line: Polynomial, limit: float) -> tuple[Polynomial, int]:
    """Line through the far part and the sample at which the force leaves it, beginning with a line and a limit."""
    leaves = 0
    for _ in range(HOW.rounds):
        leaves = _first_run(np.abs(force - line(travel)) > limit)
        end = int((1 - HOW.apart) * leaves)
        if leaves == force.size or end < HOW.flat * force.size:
            break
        line, noise = _line(travel[:end], force[:end])
        limit = max(HOW.beyond * noise, HOW.finest * float(np.max(np.abs(force - force[0]))))
    return line, leaves


def _require_flat(name: str, far: Far, travel: Array, force: Array) -> None:
    """Refuse a baseline that rises as the force does in contact: it is one."""
    slope, beyond = abs(float(far.line.deriv()(far.edge))), travel >= far.edge
    steep = float(np.ptp(force[beyond]) / np.ptp(travel[beyond]))
    if slope > HOW.flat * steep:
        rises = f"the force changes by {slope:.2g} N/m far from the sample and {steep:.2g} N/m near it"
        raise InputError(f"no baseline in the {name}: {rises}, limit: {HOW.flat:g} of that; begin farther away")


def _no_contact(name: str, above: Array, limit: float) -> str:
    """Say that the force stays on its baseline."""
    most, needed = (engineering(number, "N") for number in (float(np.abs(above).max()), limit))
    off = f"the force is at most {most} off its baseline, never {HOW.run} samples in a row by {needed}"
    remedy = "press until the force rises, begin and end far apart"
    return f"no contact in the {name}: {off}, limit: {HOW.beyond:g} standard deviations; {remedy}"


def _line(travel: Array, force: Array) -> tuple[Polynomial, float]:
    """Line through most samples, a parabola where the data demand it, and their spread about it."""
    kept = np.ones(force.size, dtype=bool)
    for _ in range(HOW.rounds):
        line = Polynomial.fit(travel[kept], force[kept], 1)
        off = np.abs(force - line(travel))
        kept = off <= HOW.beyond * MAD * np.median(off)
    bent = Polynomial.fit(travel[kept], force[kept], 2)
    straight, curved = ((force - each(travel))[kept] for each in (line, bent))
    return (bent, float(np.std(curved))) if _demanded(straight, curved, 1) else (line, float(np.std(straight)))


def _waved(travel: Array, force: Array, line: Polynomial) -> tuple[Polynomial, tuple[float, float], float]:
    """Line with a wave where the data demand one and show it one and a half times; else the line as it was."""
    span = float(np.ptp(travel))
    plain = line, (0.0, 0.0), 0.0
    before = best = force - line(travel)
    found = plain
    for period in [each for each in PERIODS if 1.5 * each < span]:
        phase = 2 * np.pi * travel / period
        columns = np.column_stack([np.ones_like(travel), (travel - travel[0]) / span, np.sin(phase), np.cos(phase)])
        (offset, slope, sine, cosine), *_ = np.linalg.lstsq(columns, force)
        rest = force - columns @ [offset, slope, sine, cosine]
        if np.sum(rest**2) < np.sum(best**2):
            straight = Polynomial([offset - slope * travel[0] / span, slope / span])
            best, found = rest, (straight, (float(sine), float(cosine)), period)
    return found if _demanded(before, best, 3) else plain


def _demanded(before: Array, after: Array, parameters: int) -> bool:
    """Whether more parameters take off more than they do of noise, whose samples are not independent.

    Each takes off the share of one independent sample, 25 times that by a chance of 1e-6.
    """
    if not np.any(after):  # a curve without noise
        return bool(np.any(before))
    correlation = max(0.0, float(np.mean(after[1:] * after[:-1]) / np.mean(after**2)))
    independent = after.size * (1 - correlation) / (1 + correlation)
    return bool(np.sum(before**2) > (1 + parameters * HOW.beyond**2 / independent) * np.sum(after**2))


def _first_run(beyond: Mask) -> int:
    """Index of the first of `RUN` samples in a row that are beyond; the number of samples if there are none."""
    runs = np.flatnonzero(np.convolve(beyond, np.ones(HOW.run), "valid") == HOW.run)
    return int(runs[0]) if runs.size else beyond.size


def _require_unsaturated(force: Array, above: Array, noise: float) -> None:
    """Refuse equal forces in a row at the largest or the least force, unless that is the baseline's."""
    for extreme in (force.max(), force.min()):
        at = _first_run(force == extreme)
        if at < force.size and abs(above[at]) > HOW.beyond * noise:
            raise InputError(
                f"the force is saturated: it stays at {engineering(float(extreme), 'N')} from sample {at} on, limit: "
                f"less than {HOW.run} equal samples at an extreme; press less or extend the detector's range"
            )


def _contact(travel: Array, above: Array) -> float:
    """Travel at which the force last rises through the baseline; its last if it never does."""
    i = int(np.flatnonzero(above <= 0)[-1])  # the baseline is a mean: some samples are below it
    pair = slice(i, i + 2)
    return float(np.interp(0.0, above[pair], travel[pair]))


def _jump(force: Array, where: slice, steps: float) -> slice | None:
    """Jump about the steepest rise of the force in a part of the curve, if it stands out of the noise of steps."""
    rises = np.diff(force[where])
    if not rises.size:  # the force was least where the baseline begins already
        return None
    steepest = int(np.argmax(rises))
    jumps = rises > max(HOW.beyond * steps, HOW.settled * rises[steepest])
    if not jumps[steepest]:
        return None
    before, after = np.flatnonzero(~jumps[:steepest]), np.flatnonzero(~jumps[steepest:])
    last = where.start + (int(before[-1]) + 1 if before.size else 0)
    first = where.start + steepest + (int(after[0]) if after.size else jumps.size - steepest)
    return slice(last, first) if first - last <= HOW.smeared else None
