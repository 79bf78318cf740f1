"""A curve as plain data for machines: JSON with everything, CSV with the points and events."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from typing import IO, Any

from fem_adhesion.common import record as common
from fem_adhesion.common.facts import plain
from fem_adhesion.common.record import UNITS, column
from fem_adhesion.curve.solve import Curves
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.devices import ENDS, Cycle
from halfspace.equilibrium.events import points_of
from halfspace.scaling import IN_SI

FLAGS = ("stable_under_fixed_grips", "stable_under_dead_load")
SPREAD = "_model_uncertainty"  # after an observable's name: how far apart models lie between which there is a choice


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
    solutions = {name: path.to_dict() | {"left_out": curves.left_out(name)} for name, path in curves.sampled.items()}
    cycles = {"fixed_grips": _cycle(curves.grips), "apparatus": _cycle(curves.apparatus)}
    return head(curves) | {"solutions": plain(solutions), "jumps": plain(cycles)}


def _cycle(cycle: Cycle | None) -> dict[str, Any] | None:
    if cycle is None:
        return None
    ends = {
        name: {
            **{end: {**getattr(jump, end).numbers, "missed": cycle.missed_by(name, end)} for end in ENDS},
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
    for quantity in (*OBSERVABLES, *(f"{name}_error" for name in OBSERVABLES), *spread):
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
    points = {name: values.tolist() for name, values in points_of(path).items()}
    for values in zip(*points.values(), strict=True):
        point = dict(zip(points, values, strict=True))
        yield {"event": "", **point, **{flag: int(point[flag]) for flag in FLAGS}}
    places, spread = path.stages[-1] if hasattr(path, "stages") else {}, getattr(path, "spread", {})
    for name, event in path.events.items():
        row: dict[str, Any] = {"event": name, **event.numbers}
        row |= {f"{of}{SPREAD}": apart for of, apart in spread.get(name, {}).items()}
        row |= {"arclength": places[name].point.arclength} if name in places else {}
        yield row | {"missed_rtol": " ".join(path.tolerance.missed_by(event))}
