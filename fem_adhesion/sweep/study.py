"""Many curves on all cores, each kept on disk as soon as it is there, and the table of their numbers."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import partial
from typing import IO, Any

from fem_adhesion.common.code_digest import code_digest
from fem_adhesion.common.facts import plain
from fem_adhesion.common.jobs import WorkerDied, stream
from fem_adhesion.common.progress import Progress, unheard
from fem_adhesion.common.store import Plain, Store
from fem_adhesion.registry import record_of
from halfspace.accuracy.sweep import UNKNOWN, Summary, summary
from halfspace.equilibrium.events import EVENTS, Event
from halfspace.laws import LENNARD_JONES, Law
from halfspace.profiles import PARABOLOID
from halfspace.values import Estimate

UNITS = {"approach": "eps", "load": "R_dgamma", "central_gap": "eps", "contact_radius": "beta"}
ENERGY_UNIT = "R_dgamma_eps"


@dataclass(frozen=True)
class Question:
    """What is asked of every curve.

    Attributes
    ----------
    rtol : float
        Relative accuracy.
    to_load : float
        Load in R dgamma at which a curve ends.
    law : Law
        Of the tension between the surfaces.
    """

    rtol: float
    to_load: float
    law: Law = LENNARD_JONES


def code() -> str:
    """Digest of the code that computes a curve."""
    return code_digest(__name__)


def compute(tabor: float, question: Question) -> Summary:
    """Trace one curve."""
    to_load, rtol, law = question.to_load, question.rtol, question.law
    return summary(tabor, law=law, profile=PARABOLOID, body=None, rtol=rtol, to_load=to_load)


def run(
    tabors: Sequence[float],
    question: Question,
    store: Store | None = None,
    *,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
    work: Callable[..., Summary] = compute,
) -> list[Summary]:
    """Trace the curves that the store does not hold, and store each at once.

    Parameters
    ----------
    tabors : sequence of float
        Tabor parameters, each once.
    question : Question
        What is asked of every curve.
    store : Store, optional
        From `fem_adhesion.common.store.open_store`.
    jobs, dask : int and str, optional
        Local processes, or the address of a cluster: see `fem_adhesion.common.jobs.stream`.
    progress : callable
        Called with the last curve, how many are done, and of how many.
    work : callable
        Traces a curve of a `question`; a function of a module.

    Returns
    -------
    list of Summary
        In the order of the Tabor parameters. What could not be traced says why; where a worker died it is not stored.
    """
    found = dict(_stored(tabors, question, store)) if store else {}
    todo = [tabor for tabor in tabors if tabor not in found]
    with closing(stream(partial(work, question=question), todo, jobs=jobs, dask=dask)) as results:
        progress("starting", len(found), len(tabors))
        for tabor, result in results:
            if isinstance(result, WorkerDied):
                found[tabor] = Summary(tabor, {}, UNKNOWN, UNKNOWN, {}, result.reason)
            else:
                found[tabor] = result
                if store:
                    store.put(_inputs(tabor, question), _to_plain(result))
            progress(f"tabor {tabor:g}", len(found), len(tabors))
    return [found[tabor] for tabor in tabors]


def _inputs(tabor: float, question: Question) -> Plain:
    return {"tabor": tabor, "rtol": question.rtol, "to_load": question.to_load, "law": record_of(question.law)}


def _stored(tabors: Sequence[float], question: Question, store: Store) -> Iterator[tuple[float, Summary]]:
    """Curves that the store holds."""
    for tabor in tabors:
        inputs = _inputs(tabor, question)
        kept = store.get(inputs)
        if kept is None:
            continue
        try:
            yield tabor, _from_plain(kept)
        except (KeyError, TypeError) as error:
            store.distrust(inputs, f"it is no curve ({error})")


def _to_plain(curve: Summary) -> Plain:
    return {name: plain(value) if isinstance(value, dict) else value for name, value in asdict(curve).items()}


def _from_plain(kept: Mapping[str, Any]) -> Summary:
    """Read a curve of the store, where what is not a number is None."""
    events = {name: Event(**_numbers(event)) for name, event in kept["events"].items()}
    energy, lost = (Estimate(**_numbers(kept[name])) for name in ("energy", "energy_lost"))
    missed = {name: tuple(numbers) for name, numbers in kept["missed"].items()}
    return Summary(kept["tabor"], events, energy, lost, missed, kept["reason"])


def _numbers(kept: Mapping[str, Any]) -> dict[str, Any]:
    return {name: math.nan if value is None else value for name, value in kept.items()}


def write_csv(curves: Sequence[Summary], file: IO[str]) -> None:
    """Write a row for each curve: its events' numbers with their errors, units in the names of the columns.

    What does not exist, as the jumps of a curve that does not fold, is left empty. ``missed_rtol`` names what is less
    accurate than was asked for, ``reason`` tells why a curve could not be traced.
    """
    rows = [_row(curve) for curve in curves]
    writer = csv.DictWriter(file, _row(Summary(1.0, {}, UNKNOWN, UNKNOWN, {})).keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)


def _row(curve: Summary) -> dict[str, str]:
    """Columns of a curve."""
    numbers = {"tabor": curve.tabor}
    for name in EVENTS:
        for quantity, unit in UNITS.items():
            event = curve.events.get(name)
            estimate = event.estimate(quantity) if event else UNKNOWN
            numbers |= _named(f"{name}_{quantity}", unit, estimate)
    numbers |= _named("energy", ENERGY_UNIT, curve.energy) | _named("energy_lost", ENERGY_UNIT, curve.energy_lost)
    missed = "; ".join(f"{name} {' '.join(quantities)}" for name, quantities in curve.missed.items())
    written = {name: repr(float(value)) if math.isfinite(value) else "" for name, value in numbers.items()}
    return {**written, "missed_rtol": missed, "reason": curve.reason}


def _named(name: str, unit: str, estimate: Estimate) -> dict[str, float]:
    return {f"{name}_{unit}": estimate.value, f"{name}_error_{unit}": estimate.error}
