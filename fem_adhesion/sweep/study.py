"""Many curves: from the atlas, or solved on all cores and each kept on disk at once, and the table of their numbers."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from typing import IO, Any

from fem_adhesion.common.facts import code_digest, plain
from fem_adhesion.common.files import Plain, Store
from fem_adhesion.common.jobs import solve_all
from fem_adhesion.common.known import known
from fem_adhesion.common.record import UNITS, column
from fem_adhesion.registry import record_of
from halfspace import atlas
from halfspace.accuracy.sweep import UNKNOWN, Summary, summary
from halfspace.atlas.series import LEAST, MOST
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import EVENTS, Event, Tolerance
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.values import Estimate


def code() -> str:
    """Digest of the code that computes a curve."""
    return code_digest(__name__)


def by_atlas(tabors: Sequence[float], rtol: float, law: Law) -> dict[float, Summary]:
    """Curves of the 3-9 law, by Tabor parameter, whose loads and approaches the atlas has as accurately as asked.

    Where its error leaves open whether a curve folds, the curve is not among them.
    """
    birth = atlas.birth_of_folds()
    inside = [tabor for tabor in tabors if law == LENNARD_JONES and LEAST <= tabor <= MOST]
    inside = [tabor for tabor in inside if abs(tabor - birth.value) > birth.error]
    found = dict[float, Summary]()
    for tabor, (states, released, lost) in zip(inside, known(inside), strict=True):
        events = {name: states[name] for name in EVENTS if name in states}
        if not Tolerance.on(events, rtol).missed(events):
            found[tabor] = Summary(tabor, events, released, lost, {})
    return found


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

    return solve_all(
        tabors,
        store,
        work=partial(work, **asked),
        inputs=inputs,
        name="tabor {:g}".format,
        write=lambda curve: {name: plain(value) for name, value in asdict(curve).items()},
        read=_from_plain,
        died=Summary.failed,
        **how,
    )


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


def write_csv(curves: Sequence[Summary], file: IO[str], known: Collection[float] = ()) -> None:
    """Write a row for each curve: its events' numbers with their errors, units in the names of the columns.

    What does not exist, as the jumps of a curve that does not fold, is left empty. ``source`` says whether the numbers
    are from the ``atlas``, whose Tabor parameters are `known`, or a ``solver`` found them; ``missed_rtol`` names what
    is less accurate than was asked for, ``reason`` tells why a curve could not be traced.
    """
    rows = [_row(curve) | {"source": "atlas" if curve.tabor in known else "solver"} for curve in curves]
    writer = csv.DictWriter(file, [*_row(Summary.failed(1.0, "")), "source"], lineterminator="\n")
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
