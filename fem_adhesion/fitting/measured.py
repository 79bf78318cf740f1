"""Measured force curves: read from a file, with signs and segments found, and refused where they contradict."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import numpy as np

from fem_adhesion.common.numbers import counted, engineering, listed, parse
from fem_adhesion.fitting import makers
from halfspace.errors import InputError
from halfspace.limits import require_positive
from halfspace.values import Array, Valued

FEWEST = 50  # points of a segment, a tenth of which shows the level of its ends and their noise
FEW = 5  # samples next to the turn, whose median shows the force there
BASE, APPROACH = "base", "approach"
TRAVELS = {"sensor": BASE, "piezo": BASE, "separation": APPROACH}  # the best first: a sensor knows of creep
SEGMENTS = {
    **dict.fromkeys(("approach", "extend", "forward", "trace"), "approach"),
    **dict.fromkeys(("retract", "withdraw", "backward", "retrace"), "retract"),
}
COLUMN = re.compile(rf"({'|'.join(TRAVELS)}|force|deflection)(?:_(.+))?", re.IGNORECASE)
SPRING = re.compile(r"#\s*spring_constant\s*=\s*(.+)")
CLEAR = 10.0  # times the change of the flat end of a segment, that of the end in contact, if the two are exchanged


@dataclass(frozen=True, eq=False, repr=False)
class ForceCurve(Valued):
    """A measured curve of approach and retract, in the order of time; baseline and drift are in it as recorded.

    Attributes
    ----------
    coordinate : str
        What the travel is: "base", that of the spring's base, or "approach", the position of the tip, from which the
        spring's deflection is taken off already.
    travel : (n,) array
        In m, rising towards the sample from a zero of the instrument's.
    force : (n,) array
        On the tip in N, positive in compression.
    approach, retract : slice
        Parts of the arrays.
    deflection_given : bool
        Whether the force is known as a deflection times the stiffness, so that it scales with that.
    stiffness : float or None
        Spring constant in N/m that the file names or the user gave.
    told : tuple of str
        What was found about columns, signs and segments, in sentences.
    """

    coordinate: str
    travel: Array
    force: Array
    approach: slice
    retract: slice
    deflection_given: bool
    stiffness: float | None = None
    told: tuple[str, ...] = ()


def read(
    path: Path, *, stiffness: float | None = None, sensitivity: float | None = None, number: int = 0
) -> ForceCurve:
    """Read a curve from a CSV file whose header has the units, or from a file of a maker, see `makers`.

    The columns are ``sensor`` or ``piezo``, the travel of the base, or ``separation``, that of the tip, then ``force``
    or ``deflection``, each followed by ``_`` and its unit, and ``segment``: approach or retract, which is found by the
    turn of the travel where it is missing. Lines that begin with # are comments, but for ``# spring_constant =``.

    Parameters
    ----------
    path : Path
        The file.
    stiffness : float, optional
        Spring constant in N/m, by which a deflection or a force whose file names its own becomes a force; that of the
        file unless given.
    sensitivity : float, optional
        Of the detector in m/V, where the file of a maker lacks it.
    number : int
        Which curve of a file of many, from 0.

    Raises
    ------
    InputError
        If the file cannot be read, lacks a unit, a segment or numbers, or has two columns for one thing; if a
        deflection comes without a stiffness; if the signs of its segments contradict each other.
    """
    path = Path(path)
    curves = makers.load(path, stiffness, sensitivity) if makers.is_makers(path) else [_in_csv(path)]
    if not 0 <= number < len(curves):
        raise InputError(f"curve {number} of {path}, limit: 0 to {len(curves) - 1}; take one of these")
    return _curve_of(path, curves[number], stiffness)


def count(path: Path, *, stiffness: float | None = None, sensitivity: float | None = None) -> int:
    """Number of curves in a file; the arguments as for `read`."""
    return len(makers.load(path, stiffness, sensitivity)) if makers.is_makers(path) else 1


def _in_csv(path: Path) -> makers.Columns:
    """Columns of a CSV file."""
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")  # letters stand in the header alone
    except OSError as error:
        raise InputError(f"{path} cannot be read ({error.strerror}); give a CSV file of a force curve") from error
    spring = SPRING.search(text)
    own = parse(spring[1].strip(), "stiffness") if spring else None
    lines = [(at, line) for at, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if len(lines) <= 2 * FEWEST:  # the first is the header
        raise InputError(
            f"{path} has {counted(max(len(lines) - 1, 0), 'line')} of data, limit: {2 * FEWEST}; give more points"
        )
    header = lines[0][1]
    delimiter = max(",;\t", key=header.count)
    names = [name.strip() for name in header.split(delimiter)]
    columns, told = _columns(path, names)
    wanted = [names.index(name) for name in columns.values()]
    rows = list(csv.reader((line for _, line in lines[1:]), delimiter=delimiter))
    for (at, _), row in zip(lines[1:], rows, strict=True):
        if len(row) != len(names):
            raise InputError(f"{path}, line {at} has {counted(len(row), 'column')}, limit: {len(names)}; mend it")
    numbers = np.array([_row(path, at, row, wanted) for (at, _), row in zip(lines[1:], rows, strict=True)])
    values = {
        what: column * _unit(path, what, name) for (what, name), column in zip(columns.items(), numbers.T, strict=True)
    }
    labels = [row[names.index("segment")].strip().lower() for row in rows] if "segment" in names else None
    return makers.Columns(values, labels, own, told)


def _columns(path: Path, names: Sequence[str]) -> tuple[dict[str, str], tuple[str, ...]]:
    """Name of the column of each quantity that is used, the travel first, and what is said about the others."""
    found = [(match[1].lower(), name) for name in names if (match := COLUMN.fullmatch(name))]
    forces = [(what, name) for what, name in found if what not in TRAVELS]
    travels = sorted((pair for pair in found if pair[0] in TRAVELS), key=lambda pair: list(TRAVELS).index(pair[0]))
    if len(forces) > 1 or len({what for what, _ in found}) < len(found):
        both = listed([name for _, name in (forces if len(forces) > 1 else found)])
        raise InputError(f"{path} has {both}, limit: one column for one quantity; leave out all but one")
    for what, pairs in (
        ("a travel, as piezo_m or separation_m", travels),
        ("a force, as force_N or deflection_m", forces),
    ):
        if not pairs:
            raise InputError(f"{path} has the columns {listed(names)}, limit: {what}; name it with its unit")
    used = dict([travels[0], forces[0]])
    told = (f"{travels[0][1]} is used, not {listed([name for _, name in travels[1:]])}.",) if travels[1:] else ()
    return used, told


def _unit(path: Path, what: str, name: str) -> float:
    """SI units in the unit of a column."""
    unit = name[len(what) + 1 :]
    if not unit:
        raise InputError(f"{path}: the column {name} has no unit; write {name}_{'N' if what == 'force' else 'm'}, say")
    try:
        return parse(f"1{unit}", what)
    except InputError as error:
        raise InputError(f"{path}, column {name}: {error}") from error


def _row(path: Path, at: int, row: Sequence[str], wanted: Sequence[int]) -> list[float]:
    """Numbers of a line that are used."""
    try:
        numbers = [float(row[column]) for column in wanted]
    except ValueError as error:
        raise InputError(f"{path}, line {at}: {','.join(row)[:60]}, limit: a number in each column; mend it") from error
    if not np.isfinite(numbers).all():
        raise InputError(f"{path}, line {at}: {','.join(row)[:60]}, limit: finite numbers; leave the line out")
    return numbers


def _curve_of(path: Path, columns: makers.Columns, stiffness: float | None) -> ForceCurve:
    """Curve of columns, on a spring of the stiffness in N/m if it is given.

    The signs are found: the approach goes towards the sample, and its last force is a compression unless the retract
    goes on in its direction, as after a turn in tension.
    """
    ((what, travel), (given, force)), own = columns.values.items(), columns.stiffness
    used = own if stiffness is None else require_positive(stiffness, "stiffness", "give it in N/m", "N/m")
    if given == "deflection":
        if used is None:
            raise InputError(f"{path} has a deflection and no stiffness, limit: both; give the stiffness, as 0.2N/m")
        force = force * used
    elif used and own:
        force = force * (used / own)
    if not (np.isfinite(travel).all() and np.isfinite(force).all()):
        raise InputError(f"{path} has samples that are no finite numbers, limit: none; leave them out")
    parts, notes = _segments(path, travel, columns.labels)
    (x, y), (back, pull) = ((travel[part], force[part]) for part in parts)
    fewest = min(x.size, back.size)
    if fewest < FEWEST:
        raise InputError(f"{path} has a segment of {counted(fewest, 'point')}, limit: {FEWEST}; give more points")
    if abs(back[-1] - x[-1]) < abs(back[0] - x[-1]):
        back, pull = back[::-1], pull[::-1]
        notes = (*notes, "The retract is stored against the order of time and was turned round.")
    way = float(np.sign(_level(x[::-1]) - _level(x)))
    if not way:
        raise InputError(f"{path}: the {what} stays where it is, limit: an approach; give the travel that moves")
    sign = _sign(path, y, pull)
    if way < 0:
        notes = (*notes, f"The {what} falls towards the sample and was turned round.")
    if sign < 0:
        notes = (*notes, f"The {given} was negative in compression and was turned round.")
    joined = way * np.concatenate([x, back]), sign * np.concatenate([y, pull])
    cut = slice(0, x.size), slice(x.size, x.size + back.size)
    by_deflection = given == "deflection" or own is not None
    return ForceCurve(TRAVELS[what], *joined, *cut, by_deflection, used, (*columns.told, *notes))


def _segments(path: Path, travel: Array, labels: Sequence[str] | None) -> tuple[tuple[slice, slice], tuple[str, ...]]:
    """Approach and retract, by their labels or by the turn of the travel."""
    if labels is None:
        turn = int(np.argmax(np.abs(travel - travel[0]))) + 1
        if travel.size - turn < FEWEST:
            raise InputError(f"{path} goes one way only, limit: approach and retract; give the retract too")
        return (slice(0, turn), slice(turn, None)), ("Approach and retract were divided at the turn of the travel.",)
    found, at = list[tuple[str, slice]](), 0
    for label, run in groupby(labels):
        found.append((SEGMENTS.get(label, label), slice(at, at := at + len(list(run)))))
    for name in ("approach", "retract"):
        count = sum(label == name for label, _ in found)
        if count != 1:
            has = f"{path} has {counted(count, 'segment')} called {name}"
            raise InputError(f"{has}, limit: 1; give one approach and its retract in a file")
    named = dict(found)
    left = [label for label in named if label not in ("approach", "retract")]
    told = (f"What is called {listed(left)} is left out.",) if left else ()
    return (named["approach"], named["retract"]), told


def _level(values: Array) -> float:
    """Median of the first tenth."""
    return float(np.median(values[: values.size // 10]))


def _spread(values: Array) -> float:
    """Standard deviation of the first tenth."""
    return float(np.std(values[: values.size // 10]))


def _sign(path: Path, approach: Array, retract: Array) -> int:
    """Sign by which the force becomes positive in compression.

    Where the force was largest in contact at the turn, that is a compression: it can only fall from there.
    """
    for name, far, near in (("approach", approach, approach[::-1]), ("retract", retract[::-1], retract)):
        flat, steep = (float(np.ptp(end[: end.size // 10])) for end in (far, near))
        if flat > CLEAR * steep:
            changes = f"{engineering(flat, 'N')} far from the sample and by {engineering(steep, 'N')} near it"
            remedy = "the travel has the wrong sign or the segments are exchanged; exchange them"
            raise InputError(f"{path}: in the {name} the force changes by {changes}, limit: more near it; {remedy}")
    last, first = (float(np.median(end[:FEW])) for end in (approach[::-1], retract))
    before, after = last - _level(approach), first - _level(retract[::-1])
    if before * after < 0 and min(abs(before), abs(after)) > CLEAR * _spread(approach):
        both = f"{engineering(before, 'N')} in approach and {engineering(after, 'N')} in retract"
        raise InputError(f"{path}: at the turn the force is {both}, limit: one sign; turn one of them round")
    side = 1 if before + after > 0 else -1
    further = float(np.max(side * (retract - _level(retract[::-1]))))
    return -side if further > 1.5 * abs(before + after) / 2 and further > CLEAR * _spread(retract[::-1]) else side
