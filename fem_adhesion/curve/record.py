"""A curve as plain data for machines: JSON with everything, CSV with the points and events."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from typing import IO, Any

from fem_adhesion.common import record as common
from fem_adhesion.common.facts import plain
from fem_adhesion.common.record import UNITS, column
from fem_adhesion.curve.solve import Curves
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.devices import Cycle
from halfspace.equilibrium.events import Event
from halfspace.scaling import IN_SI

ERRORS = tuple(f"{name}_error" for name in OBSERVABLES)
COLUMNS = ("arclength", *OBSERVABLES, *ERRORS)
SPREAD = "_model_uncertainty"  # after an observable's name: how far apart models lie between which there is a choice
NUMBERS = tuple(key for name in OBSERVABLES for key in (name, f"{name}_error"))  # of an event
FLAGS = {"stable_under_fixed_grips": "stable", "stable_under_dead_load": "stable_under_dead_load"}
MORE = {"jumps": "jumps", "margin": "margin", "model_uncertainty": "spread", "energy_released": "energy"}
"""Keys of what the solvers tell and the weak form does not, and their attributes."""


def head(curves: Curves) -> dict[str, Any]:
    """Record of the run; where the material is known ``si`` has each unit's factor into SI, and the SI unit."""
    question, units = curves.question, curves.question.units
    named = {name: units.si(name) for name in UNITS if name in IN_SI} if units else {}
    sizes = {name: {"factor": factor, "unit": unit} for name, (factor, unit) in named.items()}
    asked = {name: getattr(question, name) for name in ("solver", "rtol", "to_load", "stiffness", "points", "kernel")}
    return common.record(question.scene, **asked) | {
        "rtol": question.rtol,
        "to_load": question.to_load,
        "si": units and plain({"material": units, "units": sizes}),
    }


def record(curves: Curves) -> dict[str, Any]:
    """Everything, ready for JSON: no NaN, and None for the contact radius without contact."""
    solutions = {name: _solution(path) | {"left_out": curves.left_out(name)} for name, path in curves.sampled.items()}
    cycles = {"fixed_grips": _cycle(curves.grips), "apparatus": _cycle(curves.apparatus)}
    return head(curves) | {"solutions": plain(solutions), "jumps": plain(cycles)}


def _solution(path: Any) -> dict[str, Any]:
    found = {
        "events": {name: _event(event, path.tolerance.missed_by(event)) for name, event in path.events.items()},
        "curve": {name: getattr(path, name) for name in COLUMNS}
        | {name: getattr(path, flag) for name, flag in FLAGS.items()},
        **{name: getattr(path, name) for name in ("met", "unknowns", "seconds", "settings")},
        **{key: getattr(path, name) for key, name in MORE.items() if hasattr(path, name)},
    }
    return found | {"unconfirmed_folds": [fold._asdict() for fold in getattr(path, "unconfirmed", ())]}


def _event(event: Event, missed: Sequence[str]) -> dict[str, Any]:
    """Numbers of an event with their errors, and which of them miss the tolerance."""
    return {key: getattr(event, key) for key in NUMBERS} | {"missed": missed}


def _cycle(cycle: Cycle | None) -> dict[str, Any] | None:
    if cycle is None:
        return None
    ends = {
        name: {
            "take_off": _event(jump.take_off, cycle.missed_by(name, "take_off")),
            "landing": _event(jump.landing, cycle.missed_by(name, "landing")),
            "energy": jump.energy,
        }
        for name, jump in cycle.jumps.items()
    }
    return {"stiffness": cycle.stiffness, "met": cycle.met, **ends, "energy_lost": cycle.energy_lost}


def write_csv(curves: Curves, file: IO[str]) -> None:
    """Write the points of each solver's curve and, in their places by arclength, its events with errors.

    Where the material is known each quantity comes in SI too. Stability is left out at events, which are where it
    changes. ``missed_rtol`` names the quantities of an event whose errors are above the tolerance. At finite strain the
    ``model_uncertainty`` of an event's numbers has columns of its own. The weak form's events come after the points.
    """
    units, factors = curves.question.units, dict[str, tuple[str, float]]()  # quantity and its unit, by columns
    spread = [
        f"{name}{SPREAD}" for name in OBSERVABLES if any(getattr(path, "spread", {}) for path in curves.paths.values())
    ]
    for quantity in (*OBSERVABLES, *ERRORS, *spread):
        name = quantity.removesuffix("_error").removesuffix(SPREAD)
        size, unit = units.si(name) if units else (1.0, UNITS[name])
        factors |= {column(quantity, UNITS[name]): (quantity, 1.0), column(quantity, unit): (quantity, size)}
    header = ["solver", "event", "arclength", *factors, *FLAGS, "missed_rtol"]
    writer = csv.DictWriter(file, header, lineterminator="\n", restval="", extrasaction="ignore")
    writer.writeheader()
    for solver, path in curves.sampled.items():
        for row in sorted(_rows(path), key=lambda row: row.get("arclength", math.inf)):
            numbers = {
                name: repr(float(row[quantity] * factor))
                for name, (quantity, factor) in factors.items()
                if math.isfinite(row.get(quantity, math.nan))
            }
            writer.writerow({"solver": solver, **row, **numbers})


def _rows(path: Any) -> Iterator[dict[str, Any]]:
    """Points, then events, with their quantities by name."""
    flags = [getattr(path, flag).astype(int).tolist() for flag in FLAGS.values()]
    for values in zip(*(getattr(path, name).tolist() for name in COLUMNS), *flags, strict=True):
        yield {"event": "", **dict(zip((*COLUMNS, *FLAGS), values, strict=True))}
    places, spread = path.stages[-1] if hasattr(path, "stages") else {}, getattr(path, "spread", {})
    for name, event in path.events.items():
        row = {"event": name} | {key: getattr(event, key) for key in NUMBERS}
        row |= {f"{of}{SPREAD}": apart for of, apart in spread.get(name, {}).items()}
        row |= {"arclength": places[name].point.arclength} if name in places else {}
        yield row | {"missed_rtol": " ".join(path.tolerance.missed_by(event))}
