"""Their numbers: read from CSV as quantities, or as curves whose events are read off, in the units of the project."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_adhesion.benchmark.problems import KINDS, Problem, events_along, named
from fem_adhesion.common.numbers import PREFIXES
from fem_adhesion.common.record import UNITS
from halfspace.errors import InputError
from halfspace.values import Array

NUMBERS, CURVES = ("problem", "quantity", "value"), ("problem", "approach", "load")
SIZES = {name.replace("µ", "u"): 10.0**exponent for exponent, name in PREFIXES.items()} | {"µ": 1e-6}
LEAP = 8.0  # usual changes of the load from row to row above which a change is a jump
Rows = Iterable[tuple[str, Mapping[str, str]]]  # where each stands, and its cells


@dataclass(frozen=True)
class Number:
    """One of their numbers, in our units, and how far it may be off: half its last digit and the error they state."""

    quantity: str
    value: float
    allowed: float


@dataclass(frozen=True)
class Submitted:
    """What they say of a problem: numbers, and the curve (2, n) of approach and load if it was one."""

    problem: Problem
    numbers: Sequence[Number]
    curve: Array | None = None


def read(path: Path, problem: Callable[[str], Problem] = named) -> list[Submitted]:
    """Read a submission; InputError, with the line, if there is something that cannot be understood.

    Rows without a value, as the templates have them, are left out. `problem` gives that of a name.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = csv.DictReader(file, skipinitialspace=True, restval="")
            header = [name.strip() for name in lines.fieldnames or ()]
            rows = [
                (
                    f"{path}, line {lines.line_num}",
                    {str(name).strip(): str(text).strip() for name, text in row.items() if name},
                )
                for row in lines
            ]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read ({error}), limit: a CSV file in UTF-8; give one") from error
    form = next((form for form in (NUMBERS, CURVES) if set(form) <= set(header)), NUMBERS)
    grouped = dict[str, list[tuple[str, Mapping[str, str]]]]()
    for where, row in rows:
        if row.get(form[-1]):
            grouped.setdefault(row.get("problem", ""), []).append((where, row))
    if not grouped:
        raise InputError(
            f"{path} has the columns {','.join(header)} and no row with a value, limit: a header {','.join(NUMBERS)} "
            f"or {','.join(CURVES)} and rows below it; see --problems"
        )
    read_one = _numbers if form == NUMBERS else _curve
    return [read_one(problem(name), found) for name, found in grouped.items()]


def _numbers(problem: Problem, rows: Rows) -> Submitted:
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
        found[quantity] = Number(quantity, value * size, size * (10.0**-decimals / 2 + abs(error)))
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
    if unit in ("", UNITS[kind]):
        return 1.0
    if unit == f"pi {UNITS[kind]}":
        return math.pi
    si, name = problem.units.si(kind)
    if unit.endswith(name) and unit.removesuffix(name) in SIZES:
        return SIZES[unit.removesuffix(name)] / si
    raise InputError(f"{where}: unit = {unit!r}, limit: {UNITS[kind]} or a multiple of {name}; as {UNITS[kind]}")


def _curve(problem: Problem, rows: Rows) -> Submitted:
    """Curve with the events that can be read off it."""
    places = list(rows)
    if len(places) < 8:
        raise InputError(f"{places[0][0]}: a curve of {len(places)} rows, limit: 8; give more points of {problem.name}")
    curve = np.array([[_float(where, name, row[name]) for where, row in places] for name in CURVES[1:]])
    return Submitted(problem, list(read_off(curve)), curve)


def read_off(curve: Array) -> Iterator[Number]:
    """Events of a curve as it was sampled: on the way in, up to the largest approach, then on the way out.

    Where the curve turns back on its way, as one that follows the unstable states does, the jumps are its folds,
    otherwise the rows after which the load has leapt. The error stated is the change from every other row. How far a
    leap is from the jump is for the causes to find.
    """
    approach, load = curve
    rise, turn = np.diff(load), int(np.argmax(approach))
    found, coarse = events_along(curve), events_along(curve[:, ::2])
    drop = np.maximum.accumulate(approach[: turn + 1]) - approach[: turn + 1]
    if not drop.max() > 3 * np.median(np.abs(np.diff(approach))):  # on the way out only what leaps is a jump
        found = {name: state for name, state in found.items() if not name.startswith("jump")}
        usual = LEAP * float(np.median(np.abs(rise)))
        for name, leaps, first in (("jump_on", -rise[:turn], 0), ("jump_off", rise[turn:], turn)):
            if leaps.size and leaps.max() > usual:
                found[name] = coarse[name] = curve[:, first + int(np.argmax(leaps)) + 1]
    for name, state in found.items():
        errors = np.abs(state - coarse.get(name, 0.0))
        for kind, value, error in zip(CURVES[1:], state, errors, strict=True):
            if kind == "approach" or name == "pull_off":
                yield Number(f"{name}_{kind}", float(value), float(error))
