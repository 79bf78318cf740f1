"""Fits of many curves at once, each kept as soon as it is there: their table, and their spread beside the intervals.

Curves of one sample differ by more than their noise: another spot, another asperity. The spread between curves is the
uncertainty of the sample, the interval of a curve that of the curve alone.
"""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import IO, Any

import numpy as np

from fem_adhesion.common.facts import code_digest, plain
from fem_adhesion.common.files import Plain, Store
from fem_adhesion.common.jobs import Kept, solve_all
from fem_adhesion.common.numbers import counted
from fem_adhesion.common.record import column
from fem_adhesion.fitting import makers, words
from fem_adhesion.fitting.measured import count, read
from fem_adhesion.fitting.study import Value, fit
from fem_adhesion.registry import record_of
from halfspace.errors import InputError, Unsolved, tried

FORCES: Mapping[str, str] = {"pull_off": "N", "noise": "N"}  # found without a model
SIDE = 1.96  # standard deviations in half an interval of 95 %


@dataclass(frozen=True)
class Source:
    """A curve: its file and its number in it."""

    path: Path
    number: int = 0

    def __str__(self) -> str:
        return f"{self.path.name} {self.number}" if makers.is_makers(self.path) else self.path.name


@dataclass(frozen=True)
class Outcome:
    """What the fit of a curve gave, or the reason why it gave nothing.

    Attributes
    ----------
    file : str
        Path of the file, and `number` of the curve in it.
    values : mapping of str to Value
        Fitted quantities in SI with their intervals at 95 %.
    forces : mapping of str to float
        Pull-off force and noise of the data in N.
    """

    file: str
    number: int
    values: Mapping[str, Value] = field(default_factory=dict)
    forces: Mapping[str, float] = field(default_factory=dict)
    model: str = ""
    misfit: bool = False
    warnings: tuple[str, ...] = ()
    reason: str = ""


@dataclass(frozen=True)
class Spread:
    """A quantity over all curves, in SI: how many gave it, quantiles, and two standard deviations.

    Attributes
    ----------
    between : float
        Half of what the middle 68 % of the curves span.
    within : float
        Median of half the intervals over 1.96; nan if no curve has both ends.
    """

    name: str
    unit: str
    curves: int
    low: float
    median: float
    high: float
    between: float
    within: float


def sources(paths: Sequence[Path], **given: float | None) -> tuple[Source, ...]:
    """Curves of files and folders in the order of their names; stiffness and sensitivity as for `read`."""
    files = [file for path in paths for file in (sorted(path.iterdir()) if path.is_dir() else [path])]
    known = [file for file in files if file.is_file() and (file.suffix.lower() == ".csv" or makers.is_makers(file))]
    if not known:
        names = ", ".join(map(str, paths))
        raise InputError(f"{names} has no file of a force curve, limit: .csv and files of makers; choose another")
    return tuple(Source(file, number) for file in dict.fromkeys(known) for number in range(count(file, **given)))


def outcome(source: Source, *, reading: Mapping[str, float | None], **asked: Any) -> Outcome:
    """Fit of a curve, see `fem_adhesion.fitting.study.fit`, or why there is none."""
    found = tried(lambda: fit(read(source.path, number=source.number, **reading), **asked), refusals=True)
    named = str(source.path), source.number
    if isinstance(found, Unsolved):
        return Outcome(*named, reason=found.reason)
    forces = {name: float(getattr(found.prepared, name)) for name in FORCES}
    return Outcome(*named, found.values, forces, found.model, bool(found.misfit), tuple(words.warnings(found)))


def run(
    curves: Sequence[Source],
    reading: Mapping[str, float | None],
    asked: Mapping[str, Any],
    store: Store | None = None,
    *,
    work: Callable[..., Outcome] = outcome,
    **how: Any,
) -> tuple[Outcome, ...]:
    """Fit the curves that the store does not hold, and store each at once.

    `reading` are keywords of `read`, `asked` those of `fit`. The work, a function of a module, makes the outcome of a
    curve; `how` are further keywords of `fem_adhesion.common.jobs.solve_all`: jobs, dask, progress.
    """

    def inputs(source: Source) -> Plain:
        named = {name: plain(record_of(value)) for name, value in {**reading, **asked}.items()}
        return {"file": _digest(source.path, source.path.stat().st_mtime_ns), "number": source.number, **named}

    def died(source: Source, reason: str) -> Outcome:
        return Outcome(str(source.path), source.number, reason=reason)

    kept = Kept(inputs, str, asdict, _from_plain, died)
    return solve_all(curves, store, work=partial(work, reading=reading, **asked), kept=kept, **how)


def code() -> str:
    """Digest of the code that fits a curve."""
    return code_digest(__name__)


@cache  # the file of a map is read once
def _digest(path: Path, _changed: int) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _from_plain(source: Source, kept: Mapping[str, Any]) -> Outcome:
    """Outcome of the store, which knows the curve by what is in its file."""
    try:
        values = {name: Value(**value) for name, value in kept["values"].items()}
        named = {"file": str(source.path), "values": values, "warnings": tuple(kept["warnings"])}
        return Outcome(**{**kept, **named})
    except (KeyError, TypeError) as error:
        raise InputError(f"it is no fit ({error})") from error


def spreads(outcomes: Sequence[Outcome]) -> tuple[Spread, ...]:
    """Spread of each fitted quantity and force between the curves; the travel of the contact means nothing there."""
    found = list[Spread]()
    for name in dict.fromkeys(name for one in outcomes for name in one.values if name != "contact_point"):
        given = [one.values[name] for one in outcomes if name in one.values]
        halves = [(each.high - each.low) / 2 / SIDE for each in given if each.low is not None and each.high is not None]
        numbers = [each.value for each in given]
        found.append(_spread(name, given[0].unit, numbers, float(np.median(halves)) if halves else float("nan")))
    for name, unit in FORCES.items():
        found.append(_spread(name, unit, [one.forces[name] for one in outcomes if one.forces], float("nan")))
    return tuple(each for each in found if each.curves)


def _spread(name: str, unit: str, numbers: Sequence[float], within: float) -> Spread:
    low, least, median, most, high = np.percentile(numbers or [np.nan], [10, 16, 50, 84, 90]).tolist()
    return Spread(name, unit, len(numbers), low, median, high, (most - least) / 2, within)


def told(outcomes: Sequence[Outcome]) -> str:
    """How many curves were fitted, how many with a misfit, and whether they differ by more than their intervals."""
    fitted = [one for one in outcomes if not one.reason]
    misfits = sum(one.misfit for one in fitted)
    cautions = "; the table (--csv) and the record (--json) have their cautions" if misfits else ""
    lines = [f"{len(fitted)} of {counted(len(outcomes), 'curve')} fitted, {misfits} with a misfit{cautions}."]
    for each in spreads(outcomes):
        if each.curves > 2 and each.between > 2 * each.within:
            times = f"{each.between / each.within:.2g} times what their own intervals allow"
            lines.append(f"The {each.name.replace('_', ' ')} differs between curves by {times}: quote the spread.")
    return " ".join(lines)


def write_csv(outcomes: Sequence[Outcome], file: IO[str]) -> None:
    """Write a row for each curve, in SI; an end of an interval that the curve leaves open is empty."""
    units = {name: value.unit for one in outcomes for name, value in one.values.items()}
    rows = [_row(one, units) for one in outcomes]
    writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)


def _row(one: Outcome, units: Mapping[str, str]) -> dict[str, str]:
    """Columns of a curve."""
    numbers: dict[str, float | None] = {}
    for name, unit in units.items():
        value = one.values.get(name)
        for end in ("value", "low", "high"):
            known = getattr(value, end) if value else None
            numbers[_named(name if end == "value" else f"{name}_{end}", unit)] = known
    numbers |= {_named(name, unit): one.forces.get(name) for name, unit in FORCES.items()}
    written = {name: "" if number is None else repr(float(number)) for name, number in numbers.items()}
    said = {"warnings": " ".join(one.warnings), "reason": one.reason}
    misfit = "" if one.reason else "yes" if one.misfit else "no"
    return {"file": one.file, "curve": str(one.number), "model": one.model, "misfit": misfit, **written, **said}


def _named(name: str, unit: str) -> str:
    return column(name, unit) if unit else name
