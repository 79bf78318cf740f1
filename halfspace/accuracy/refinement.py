"""The load-approach curve to an accuracy asked for: a ladder of discretisations of any body.

The curve is traced on the lowest rung and each event solved for again on the next, and on more if need be. An event's
error estimate is a part of its change from the last rung but one to the last, which is nearly the lower rung's error,
and a fifth of that from a still coarser grid, since two neighbours may err alike; see `ErrorRule`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

from halfspace.accuracy.stages import Charted, FoldsLost, Rung, State, on_all
from halfspace.equilibrium.charts import COMPRESSION, trace_charts
from halfspace.equilibrium.conditions import FOLD, STEEPEST, Located
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import FOLDS, LEAST, Event, Tolerance, Unconfirmed, numbered
from halfspace.equilibrium.path import Point, Segment
from halfspace.equilibrium.search import (
    Chains,
    confirmed,
    energy_released,
    energy_size,
    find_events,
    folds_in_doubt,
    turns,
)
from halfspace.equilibrium.states import Ladder, met_again
from halfspace.errors import ContactTooWide, GridTooLarge, HeldApart, IllPosed, InputError, NotConverged, Unsolved
from halfspace.values import Estimate, Valued

T = TypeVar("T")
MOST_RUNGS = 4  # above the lowest
FLAT = 1e-9  # eps/(R dgamma): what the last of the parabolas and rounding leave of how far a curve is from folds


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
        except (ContactTooWide, HeldApart, IllPosed):  # for any grid
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
    below, higher, margin = ascent.below, ascent.higher, _margin(ascent.chains, ascent.higher)
    if folds and margin and margin.value + margin.error < 0 and "jump_on" not in ascent.events:
        raise FoldsLost("the curve folds on a finer grid, but not on its own; take a smaller rtol")
    jumps = [ascent.state[name] for name in FOLDS if name in ascent.state]
    further, lost = further_folds(segments if folds else (), jumps, below, higher)
    lost += [] if folds else [found[name].point for name in FOLDS if name in found]
    chains = _in_order(ascent.chains, further)
    lowest_stage = below.stages[-1] if below.stages else Charted(tuple(charts))
    ladder = Ladder((lowest_stage, *higher.stages), higher.twin, higher.rule, higher.coarser)
    return EquilibriumPath(
        segments[0].problem.tabor,
        segments,
        _in_order(ascent.events, higher.estimates(further)),
        energy_along(chains, higher),
        tuple({name: one[0][k] for name, one in chains.items()} for k in range(-len(ladder.chain), 0)),
        ladder,
        time.perf_counter() - began,
        {"rtol": rtol, "curve": lowest.settings, "events": higher.settings},
        margin,
        unconfirmed=tuple(Unconfirmed(*map(float, point.observables[:CONTACT_RADIUS])) for point in lost),
    )


def _in_order(known: Mapping[str, T], further: Mapping[str, T]) -> dict[str, T]:
    """What is known of the events and of the folds between the jumps, in order along the curve."""
    after = {name: known[name] for name in ("jump_off", "zero_load") if name in known}
    return {**{name: one for name, one in known.items() if name not in after}, **further, **after}


def further_folds(
    segments: Sequence[Segment], jumps: Sequence[Located], below: Rung, last: Rung
) -> tuple[dict[str, Chains], list[Point]]:
    """Folds between the jumps by name, and about where the curve has others that no finer grid has.

    The segments are the curve as it was traced, the jumps the outermost folds, on the finest discretisation. A fold is
    solved for on the rung below the last on the way to that; where the one does not have it, the other may: its change
    is then from farther back.
    """

    def solve(fold: Located) -> Chains | Unsolved:
        before = met_again(below.stages[-1], fold) if below.stages else fold
        own = last.chains_of(before or fold)
        return own and last.beside_twin(own)

    kept, lost = confirmed(turns(segments, FOLD, slice(1, -1)) if segments else [], solve, jumps)
    return numbered(kept), lost


@dataclass(frozen=True, eq=False, repr=False)
class Ascent(Valued):
    """How far a ladder was climbed: the last two rungs, and the chains of each event between them."""

    below: Rung
    higher: Rung
    chains: dict[str, Chains]

    @property
    def state(self) -> State:
        """The events on the last stage."""
        return {name: chains[0][-1] for name, chains in self.chains.items()}

    @cached_property
    def events(self) -> dict[str, Event]:
        """The events, with errors by their chains."""
        return self.higher.estimates(self.chains)

    def misses(self, rtol: float) -> bool:
        """Whether a number errs by more than is asked for."""
        return bool(Tolerance.on(self.events, rtol).missed(self.events))

    def with_twin(self) -> Ascent:
        """The same with the chains from the last rung's twin."""
        return replace(self, chains=self.higher.with_twin(self.chains))


def ascend(state: State, lowest: Rung, rtol: float, rung: Callable[[int], Rung], levels: Sequence[int]) -> Ascent:
    """Solve for the events of a rung on those of the levels above it, one after the other, until `rtol` is met.

    Or as long as there is memory for the next level, where that is not the first.
    """
    first, *others = levels
    ascent = _risen(lowest, state, rung(first), rtol)
    for level in others:
        if not ascent.misses(rtol):
            break
        try:
            ascent = _risen(ascent.higher, ascent.state, rung(level), rtol)
        except GridTooLarge:
            break
    return ascent.with_twin()


def _risen(below: Rung, state: State, higher: Rung, rtol: float) -> Ascent:
    """Solve for the events of one rung on the next; none is told better than to a part of the accuracy asked for.

    A twin makes errors of loads and approaches no smaller: without it is a rung on which `rtol` is missed in any case.
    """
    higher = replace(higher, rule=replace(higher.rule, least=LEAST * rtol))
    alone = Ascent(below, higher, higher.chains(state))
    return alone if alone.misses(rtol) else alone.with_twin()


def _margin(found: Mapping[str, Chains], rung: Rung) -> Estimate | None:
    """How far the curve is from folds, with the error that the changes along the chains leave."""
    if "steepest" not in found:
        return None
    values = [[STEEPEST.of(state.point) for state in chain] for chain in found["steepest"]]
    return rung.rule.estimate(values, 0.0) + Estimate(0.0, FLAT)


def energy_along(found: Mapping[str, Chains], rung: Rung) -> Estimate:
    """Energy released from separation to zero approach, with the error that the changes along the chains leave."""
    ends = found["separated"], found["zero_approach"]
    values = [[energy_released(*pair) for pair in zip(*both, strict=True)] for both in zip(*ends, strict=True)]
    apart, touching = (chains[0][-1] for chains in ends)
    uncounted = rung.rule.beyond * abs(float(apart.point.observables[APPROACH]))
    return rung.rule.estimate(values, energy_size(apart) + energy_size(touching)) + Estimate(0.0, uncounted)
