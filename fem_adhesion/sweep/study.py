"""Many curves on all cores, each kept on disk as soon as it is there, and the table of their numbers."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from typing import IO, Any

from fem_adhesion.common.facts import code_digest, plain
from fem_adhesion.common.files import Plain, Store
from fem_adhesion.common.jobs import Kept, solve_all
from fem_adhesion.common.record import UNITS, column
from fem_adhesion.registry import record_of
from halfspace.accuracy.sweep import UNKNOWN, Summary, summary
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import EVENTS, Event
from halfspace.errors import InputError
from halfspace.values import Estimate


def code() -> str:
    """Digest of the code that computes a curve."""
    return code_digest(__name__)


def run(
    tabors: Sequence[float],
    asked: Mapping[str, Any],
    store: Store | None = None,
    *,
    work: Callable[..., Summary] = summary,
    **how: Any,
) -> tuple[Summary, ...]:
    """Trace the curves at Tabor parameters, each once, that the store does not hold, and store each at once.

    What is asked of every curve are the relative accuracy `rtol`, the load `to_load` in R dgamma at which it ends, and
    the `law`. What could not be traced says why; where a worker died it is not stored. The work, a function of a
    module, solves for one curve; `how` are further keywords of `fem_adhesion.common.jobs.solve_all`: jobs, dask,
    progress.
    """

    def inputs(tabor: float) -> Plain:
        return {"tabor": tabor, **{name: record_of(value) for name, value in asked.items()}}

    def write(curve: Summary) -> Plain:
        return {name: plain(value) if isinstance(value, dict) else value for name, value in asdict(curve).items()}

    kept = Kept(inputs, "tabor {:g}".format, write, _from_plain, Summary.failed)
    return solve_all(tabors, store, work=partial(work, **asked), kept=kept, **how)


def _from_plain(_: float, kept: Mapping[str, Any]) -> Summary:
    """Read a curve of the store, where what is not a number is None."""
    try:
        events = {name: Event(**_numbers(event)) for name, event in kept["events"].items()}
        energy, lost = (Estimate(**_numbers(kept[name])) for name in ("energy", "energy_lost"))
        missed = {name: tuple(numbers) for name, numbers in kept["missed"].items()}
        return Summary(kept["tabor"], events, energy, lost, missed, kept["reason"])
    except (KeyError, TypeError) as error:
        raise InputError(f"it is no curve ({error})") from error


def _numbers(kept: Mapping[str, Any]) -> dict[str, Any]:
    return {name: math.nan if value is None else value for name, value in kept.items()}


def write_csv(curves: Sequence[Summary], file: IO[str]) -> None:
    """Write a row for each curve: its events' numbers with their errors, units in the names of the columns.

    What does not exist, as the jumps of a curve that does not fold, is left empty. ``missed_rtol`` names what is less
    accurate than was asked for, ``reason`` tells why a curve could not be traced.
    """
    rows = [_row(curve) for curve in curves]
    writer = csv.DictWriter(file, _row(Summary.failed(1.0, "")).keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)


def _row(curve: Summary) -> dict[str, str]:
    """Columns of a curve."""
    numbers = {"tabor": curve.tabor}
    for name in EVENTS:
        for quantity in OBSERVABLES:
            event = curve.events.get(name)
            numbers |= _named(f"{name}_{quantity}", quantity, event.estimate(quantity) if event else UNKNOWN)
    numbers |= _named("energy", "energy", curve.energy) | _named("energy_lost", "energy", curve.energy_lost)
    missed = "; ".join(f"{name} {' '.join(quantities)}" for name, quantities in curve.missed.items())
    written = {name: repr(float(value)) if math.isfinite(value) else "" for name, value in numbers.items()}
    return {**written, "missed_rtol": missed, "reason": curve.reason}


def _named(name: str, quantity: str, estimate: Estimate) -> dict[str, float]:
    unit = UNITS[quantity]
    return {column(name, unit): estimate.value, column(f"{name}_error", unit): estimate.error}
