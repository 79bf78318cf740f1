"""Their numbers: read from CSV as quantities, or as curves whose events are read off, in the units of the project."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_adhesion.benchmark.problems import KINDS, Problem, named
from fem_adhesion.common.numbers import PREFIXES
from fem_adhesion.common.record import UNITS
from halfspace.errors import InputError
from halfspace.values import Array

NUMBERS, CURVES = ("problem", "quantity", "value"), ("problem", "approach", "load")
SIZES = {name.replace("µ", "u"): 10.0**exponent for exponent, name in PREFIXES.items()} | {"µ": 1e-6}
OTHER = {"pi R dgamma": ("R dgamma", math.pi)}
LEAP = 8.0  # usual changes of the load from row to row above which a change is a jump


@dataclass(frozen=True)
class Number:
    """One of their numbers, in our units: its value, half its last digit, and what error they state."""

    quantity: str
    value: float
    rounding: float
    error: float


@dataclass(frozen=True)
class Submitted:
    """What they say of a problem: numbers, and the curve (n, 2) of approach and load if it was one."""

    problem: Problem
    numbers: Sequence[Number]
    curve: Array | None = None


def read(path: Path) -> list[Submitted]:
    """Read a submission; InputError, with the line, if there is something that cannot be understood."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = csv.DictReader((line for line in file if line.strip()), skipinitialspace=True, restval="")
            header, rows = [name.strip() for name in lines.fieldnames or ()], list(lines)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read ({error}), limit: a CSV file in UTF-8; give one") from error
    form = next((form for form in (NUMBERS, CURVES) if set(form) <= set(header)), None)
    if form is None or not rows:
        limit = f"a header {','.join(NUMBERS)} or {','.join(CURVES)} and rows below it"
        raise InputError(
            f"{path} has the columns {','.join(header)} and {len(rows)} rows, limit: {limit}; see --problems"
        )
    grouped = dict[str, list[tuple[str, Mapping[str, str]]]]()
    for number, row in enumerate(rows, 2):
        where = f"{path}, row {number}"
        kept = {str(name).strip(): str(text).strip() for name, text in row.items() if name}
        grouped.setdefault(kept["problem"], []).append((where, kept))
    read_one = _numbers if form == NUMBERS else _curve
    return [read_one(named(name), found) for name, found in grouped.items()]


def _numbers(problem: Problem, rows: Iterable[tuple[str, Mapping[str, str]]]) -> Submitted:
    found = dict[str, Number]()
    for where, row in rows:
        quantity = re.sub(r"_(?<!contact_)radius$", "_contact_radius", row["quantity"])
        if quantity not in KINDS:
            states = "pull_off_load, jump_on_approach, zero_load_radius, energy_lost"
            raise InputError(f"{where}: quantity = {row['quantity']!r}, limit: as {states}; see --problems")
        if quantity in found:
            raise InputError(f"{where}: {quantity} of {problem.name} stands twice, limit: once; leave one out")
        size = _size(problem, KINDS[quantity], row.get("unit", ""), where)
        value, text = _float(where, "value", row["value"]), row["value"].lower().partition("e")
        decimals = len(text[0].partition(".")[2]) - int(text[2] or 0)
        error = _float(where, "error", row["error"]) if row.get("error") else 0.0
        found[quantity] = Number(quantity, value * size, abs(size) * 10.0**-decimals / 2, abs(error * size))
    return Submitted(problem, list(found.values()))


def _float(where: str, name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError as error:
        raise InputError(f"{where}: {name} = {text!r} is no number; write 1.5e-3, say") from error
    if not math.isfinite(value):
        raise InputError(f"{where}: {name} = {text} is not finite; leave the row out")
    return value


def _size(problem: Problem, kind: str, unit: str, where: str) -> float:
    """Size of a unit in ours."""
    ours, factor = OTHER.get(unit, (unit, 1.0))
    if ours in ("", UNITS[kind]):
        return factor
    si, name = problem.units.si(kind)
    if unit.endswith(name) and unit.removesuffix(name) in SIZES:
        return SIZES[unit.removesuffix(name)] / si
    raise InputError(f"{where}: unit = {unit!r}, limit: {UNITS[kind]} or a multiple of {name}; as {UNITS[kind]}")


def _curve(problem: Problem, rows: Iterable[tuple[str, Mapping[str, str]]]) -> Submitted:
    """Curve with the events that can be read off it."""
    rows = list(rows)
    if len(rows) < 8:
        raise InputError(f"{rows[0][0]}: a curve of {len(rows)} rows, limit: 8; give more points of {problem.name}")
    columns = [[_float(where, name, row[name]) for where, row in rows] for name in CURVES[1:]]
    curve = np.array(columns).T
    return Submitted(problem, list(read_off(*curve.T)), curve)


def read_off(approach: Array, load: Array) -> list[Number]:
    """Events of a curve as it was sampled: on the way in, up to the largest approach, then on the way out.

    The error of each is the distance to the next row. Where the curve turns back on its way, as one that follows the
    unstable states does, the jumps are its folds, otherwise the places where the load leaps.
    """
    turn, step = int(np.argmax(approach)), np.abs(np.diff(approach))
    least, last = int(np.argmin(load)), load.size - 1
    beside = load[max(least - 1, 0) : least + 2]
    places = {"pull_off": least}
    found = [Number("pull_off_load", float(load[least]), 0.0, float(np.ptp(beside)) / 4)]
    signs = np.flatnonzero((load[:-1] < 0) != (load[1:] < 0))
    if signs.size:
        i = int(signs[-1])
        part = load[i] / (load[i] - load[i + 1])
        at = float(approach[i] + part * (approach[i + 1] - approach[i]))
        found.append(Number("zero_load_approach", at, 0.0, float(step[i]) ** 2))
    drop = np.maximum.accumulate(approach[: turn + 1]) - approach[: turn + 1]
    rise, usual = np.diff(load), LEAP * float(np.median(np.abs(np.diff(load))))
    if drop.max(initial=0.0) > 3 * float(np.median(step)):
        off = int(np.argmax(drop))
        places |= {"jump_off": off, "jump_on": int(np.argmax(approach[: off + 1]))}
    else:
        inwards, outwards = (rise[:turn], rise[turn:]) if turn < last else (rise, rise[:0])
        if inwards.size and -inwards.min() > usual:
            places["jump_on"] = int(np.argmin(inwards)) + 1
        if outwards.size and outwards.max() > usual:
            places["jump_off"] = turn + int(np.argmax(outwards)) + 1
    for name, i in places.items():
        error = float(step[max(i - 1, 0) : i + 1].max(initial=0.0))
        found.append(Number(f"{name}_approach", float(approach[i]), 0.0, error))
    return found
