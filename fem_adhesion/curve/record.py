"""A curve as plain data for machines: JSON with everything, CSV with the points and events."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import IO, Any

from fem_adhesion.common.facts import plain, versions
from fem_adhesion.curve.solve import PAPER, Curves, Question
from fem_adhesion.registry import record_of
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle
from halfspace.equilibrium.events import Event
from halfspace.scaling import IN_SI, Units

UNITS = {"arclength": "1", **{name: PAPER[name].unit for name in (*OBSERVABLES, "energy", "stiffness")}}
ERRORS = tuple(f"{name}_error" for name in OBSERVABLES)
COLUMNS = ("arclength", *OBSERVABLES, *ERRORS)
SPREAD = "_model_uncertainty"  # after an observable's name: how far apart models lie between which there is a choice
NUMBERS = tuple(key for name in OBSERVABLES for key in (name, f"{name}_error"))  # of an event


def record(curves: Curves) -> dict[str, Any]:
    """Everything, ready for JSON: no NaN, and None for the contact radius without contact.

    ``units`` names the units of all numbers in ``solutions`` and ``jumps``; where the material is known ``si`` has the
    factor that takes each into SI, and the SI unit.
    """
    found = asked(curves.question) | {
        "solutions": {
            name: _solution(path) | {"left_out": curves.left_out(name)} for name, path in curves.sampled.items()
        },
        "jumps": {"fixed_grips": _cycle(curves.grips), "apparatus": _cycle(curves.apparatus)},
        "versions": versions(),
    }
    return {name: plain(part) for name, part in found.items()}


def asked(question: Question) -> dict[str, Any]:
    """What was asked, and the units of all numbers."""
    return {
        "scene": record_of(question.scene),
        "rtol": question.rtol,
        "to_load": question.to_load,
        "units": UNITS,
        "si": _si(question.units) if question.units else None,
    }


def _si(units: Units) -> dict[str, Any]:
    sizes = {name: dict(zip(("factor", "unit"), units.si(name), strict=True)) for name in UNITS if name in IN_SI}
    return {"material": units, "units": sizes}


def _solution(path: EquilibriumPath) -> dict[str, Any]:
    stability = {
        "stable_under_fixed_grips": path.stable,
        "stable_under_dead_load": path.stable_under_dead_load,
    }
    return {
        "events": {name: event_record(event, path.tolerance.missed_by(event)) for name, event in path.events.items()},
        "curve": {name: getattr(path, name) for name in COLUMNS} | stability,
        "met": path.met,
        "jumps": path.jumps,
        "margin": path.margin,
        "unconfirmed_folds": [fold._asdict() for fold in path.unconfirmed],
        "model_uncertainty": path.spread,
        "energy_released": path.energy,
        "unknowns": path.unknowns,
        "seconds": path.seconds,
        "settings": path.settings,
    }


def event_record(event: Event, missed: Sequence[str]) -> dict[str, Any]:
    """Numbers of an event with their errors, and which of them miss the tolerance."""
    return {key: getattr(event, key) for key in NUMBERS} | {"missed": missed}


def _cycle(cycle: Cycle | None) -> dict[str, Any] | None:
    if cycle is None:
        return None
    ends = {
        name: {
            "take_off": event_record(jump.take_off, cycle.missed_by(name, "take_off")),
            "landing": event_record(jump.landing, cycle.missed_by(name, "landing")),
            "energy": jump.energy,
        }
        for name, jump in cycle.jumps.items()
    }
    return {"stiffness": cycle.stiffness, "met": cycle.met, **ends, "energy_lost": cycle.energy_lost}


def write_csv(curves: Curves, file: IO[str]) -> None:
    """Write the points of each solver's curve and, in their places by arclength, its events with errors.

    The unit is part of a column's name; where the material is known each quantity comes in SI too. Stability is left
    out at events, which are where it changes. ``missed_rtol`` names the quantities of an event whose errors are above
    the tolerance. At finite strain the ``model_uncertainty`` of an event's numbers has columns of its own.
    """
    writer = csv.DictWriter(file, columns(curves), lineterminator="\n", restval="")
    writer.writeheader()
    for solver, path in curves.sampled.items():
        rows = sorted([*_points(path), *_events(path)], key=lambda row: row["arclength"])
        writer.writerows(with_units(curves, {"solver": solver, **row}) for row in rows)


def _points(path: EquilibriumPath) -> Iterator[dict[str, Any]]:
    numbers = zip(*(getattr(path, name).tolist() for name in COLUMNS), strict=True)
    for values, grips, dead in zip(numbers, path.stable, path.stable_under_dead_load, strict=True):
        flags = {"stable_under_fixed_grips": int(grips), "stable_under_dead_load": int(dead)}
        yield {"event": "", **dict(zip(COLUMNS, values, strict=True)), **flags}


def _events(path: EquilibriumPath) -> Iterator[dict[str, Any]]:
    for name, event in path.events.items():
        numbers = {key: getattr(event, key) for key in NUMBERS}
        numbers |= {name_of + SPREAD: apart for name_of, apart in path.spread.get(name, {}).items()}
        missed = " ".join(path.tolerance.missed_by(event))
        yield {"event": name, "arclength": path.stages[-1][name].point.arclength, **numbers, "missed_rtol": missed}


def columns(curves: Curves) -> list[str]:
    """Names of the columns of a table, units included."""
    spread = [name + SPREAD for name in OBSERVABLES if any(path.spread for path in curves.paths.values())]
    names = [column for quantity in (*OBSERVABLES, *ERRORS, *spread) for column in _named(curves, quantity)]
    stability = ["stable_under_fixed_grips", "stable_under_dead_load"]
    return ["solver", "event", "arclength", *names, *stability, "missed_rtol"]


def _named(curves: Curves, quantity: str) -> dict[str, float]:
    """Columns of a quantity, unit included, and what its values are multiplied by in them."""
    name = _observable(quantity)
    columns = {f"{quantity}_{UNITS[name].replace(' ', '_')}": 1.0}
    if units := curves.question.units:
        size, unit = units.si(name)
        columns[f"{quantity}_{unit}"] = size
    return columns


def _observable(quantity: str) -> str:
    """Observable that a quantity is the value, the error or the model uncertainty of."""
    return quantity.removesuffix("_error").removesuffix(SPREAD)


def with_units(curves: Curves, row: Mapping[str, Any]) -> dict[str, Any]:
    """Row under the names of the columns; without contact the contact radius is left empty."""
    named: dict[str, Any] = {}
    for key, value in row.items():
        if _observable(key) not in OBSERVABLES:
            named[key] = value
        elif math.isfinite(value):
            named |= {column: repr(float(value * factor)) for column, factor in _named(curves, key).items()}
    return named
