"""The load-approach curve to an accuracy asked for: a ladder of discretisations of any body.

The curve is traced on the lowest rung and each event solved for again on the next, and on more if need be. An event's
error estimate is a part of its change from the last rung but one to the last, which is nearly the lower rung's error:
half of it where the higher rung leaves a third of that error at most, more where it may leave more.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from halfspace.accuracy.further_folds import Completed, FurtherFolds
from halfspace.accuracy.stages import Charted, FoldsLost, Rung, State, on_all
from halfspace.equilibrium.charts import COMPRESSION, trace_charts
from halfspace.equilibrium.conditions import STEEPEST
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import FOLDS, Event, Tolerance
from halfspace.equilibrium.search import energy_released, energy_size, find_events, folds_in_doubt
from halfspace.equilibrium.states import Ladder
from halfspace.errors import ContactTooWide, GridTooLarge, IllPosed, InputError, NotConverged
from halfspace.values import Estimate, Valued

MOST_RUNGS = 4  # above the lowest
AWAY = 0.1  # eps from zero approach: with 1, a tenth of all energies had estimates over a hundred times their errors
FLAT = 1e-9  # eps/(R dgamma), of it: what the last of the parabolas and rounding leave


def climb(
    rtol: float, rung: Callable[[int], Rung], *, to_load: float = COMPRESSION, most_rungs: int = MOST_RUNGS
) -> EquilibriumPath:
    """Trace the curve on the lowest rung of a ladder and solve for its events on higher ones until `rtol` is met.

    That is the relative accuracy asked of loads and approaches. The rung of level 0 is for the curve, 1, 2 ... for the
    events; after the most rungs, one or more or InputError, the estimates stand as they are. The curve ends at the
    compressive load, in R dgamma. NotConverged if it cannot be traced or an event not be found again, as GridTooCoarse
    if a grid cannot carry the spike at the contact edge.
    """
    for start in range(most_rungs):
        try:
            return _climb_from(start, rtol, rung, to_load, most_rungs)
        except FoldsLost:  # two folds about to merge exist on one grid but not on the next
            if start == most_rungs - 1:
                return _climb_from(0, rtol, rung, to_load, most_rungs, folds=False)
        except GridTooLarge as error:
            remedy = "take a larger rtol or a smaller tabor"
            raise GridTooLarge(f"rtol = {rtol:g} takes grids of {error}; {remedy}") from error
        except (ContactTooWide, IllPosed):  # for any grid
            raise
        except NotConverged:
            if start == most_rungs - 1:
                raise
    raise InputError(f"most_rungs = {most_rungs} leaves nothing to climb; allow 1 or more")


def _climb_from(
    start: int, rtol: float, rung: Callable[[int], Rung], to_load: float, most_rungs: int, *, folds: bool = True
) -> EquilibriumPath:
    """Trace the curve on the rung `start` and climb from there, with its folds or without."""
    began = time.perf_counter()
    lowest = rung(start)
    charts = lowest.curve()
    segments = trace_charts(charts, to_load)
    found = {**find_events(segments), **folds_in_doubt(segments)}
    state: State = {name: event for name, event in found.items() if folds or name not in FOLDS}
    for stage in lowest.stages:
        state = on_all(state, stage)
    ascent = ascend(state, lowest, rtol, rung, range(start + 1, start + most_rungs + 1))
    below, higher, chains, events = ascent.below, ascent.higher, ascent.chains, ascent.events
    state = chains[0][-1]
    margin = _margin(chains, higher)
    if folds and margin and margin.value + margin.error < 0 and "jump_on" not in events:
        raise FoldsLost("the curve folds on a finer grid, but not on its own; take a smaller rtol")
    before = (*lowest.stages, *(() if below is lowest else below.stages[-1:]))
    jumps = tuple(state[name] for name in FOLDS if name in state)
    further = FurtherFolds(segments if folds else (), jumps, before, higher)
    lowest_stage = below.stages[-1] if below.stages else Charted(tuple(charts))
    coarser = (higher.coarser,) if higher.coarser else ()
    ladder = Ladder((*coarser, lowest_stage, *higher.stages), higher.twin, higher.rule)
    return EquilibriumPath(
        segments[0].problem.tabor,
        segments,
        Completed(events, further.events),
        energy_along(chains, higher),
        tuple(Completed(state, partial(further.stage, number)) for number, state in enumerate(chains[0])),
        ladder,
        time.perf_counter() - began,
        {"rtol": rtol, "curve": lowest.settings, "events": higher.settings},
        margin,
        on_twin=chains[1][0] if higher.twin else {},
        left_out=further.unconfirmed,
    )


@dataclass(frozen=True, eq=False, repr=False)
class Ascent(Valued):
    """How far a ladder was climbed: the last two rungs, the chains of states between them, and the events there."""

    below: Rung
    higher: Rung
    chains: list[list[State]]
    events: dict[str, Event]


def ascend(state: State, higher: Rung, rtol: float, rung: Callable[[int], Rung], levels: Sequence[int]) -> Ascent:
    """Solve for the events of a rung on those of the levels above it, one after the other, until `rtol` is met.

    Or as long as there is memory for the next level, where that is not the first.
    """
    for level in levels:
        try:
            next_rung = rung(level)
            chains = next_rung.chains(state)
        except GridTooLarge:
            if level == levels[0]:
                raise
            break
        below, higher, state = higher, next_rung, chains[0][-1]
        events = higher.estimates(chains)
        if not Tolerance.on(events, rtol).missed(events):
            break
    return Ascent(below, higher, chains, events)


def _margin(chains: Sequence[Sequence[State]], rung: Rung) -> Estimate | None:
    """How far the curve is from folds, with the error that the changes along the chains leave."""
    if "steepest" not in chains[0][-1]:
        return None
    values = [[STEEPEST.of(state["steepest"].point) for state in chain] for chain in chains]
    return rung.rule.estimate(values, 0.0) + Estimate(0.0, FLAT)


def energy_along(chains: Sequence[Sequence[State]], rung: Rung) -> Estimate:
    """Energy released from separation to zero approach, with the error that the changes along the chains leave.

    Those of the load there count as well: it is the energy's derivative by the approach. Where the energy stands still
    by accident, it does not a little `AWAY`, and that is as good a place to end at.
    """
    values = [[energy_released(state) for state in chain] for chain in chains]
    ends = [[AWAY * float(state["zero_approach"].point.observables[LOAD]) for state in chain] for chain in chains]
    best = chains[0][-1]
    sizes = sum(energy_size(best[end]) for end in ("separated", "zero_approach"))
    uncounted = rung.rule.beyond * abs(float(best["separated"].point.observables[APPROACH]))
    return rung.rule.estimate(values, sizes, ends) + Estimate(0.0, uncounted)
