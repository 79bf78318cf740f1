"""The load-approach curve to an accuracy asked for: a ladder of discretisations of any body.

The curve is traced on the lowest rung and each event solved for again on the next, and on more if need be. An event's
error estimate is a part of its change from the last rung but one to the last, which is nearly the lower rung's error:
half of it where the higher rung leaves a third of that error at most, more where it may leave more.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Protocol, TypeVar

import numpy as np

from halfspace.equilibrium.contact import CONTACT_RADIUS, ContactProblem
from halfspace.equilibrium.curve import (
    COMPRESSION,
    Chart,
    EquilibriumPath,
    Finest,
    energy_released,
    find_events,
    further_folds,
    metric_for,
    moved,
    placed,
    trace_charts,
)
from halfspace.equilibrium.events import (
    EVENTS,
    REMAINING,
    ROUND_OFF,
    STEEPEST,
    Event,
    Located,
    Tolerance,
    estimate_event,
    hermite,
    is_event,
    numbered,
    steepest,
    steepest_from,
)
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Segment, correct
from halfspace.equilibrium.states import Ways
from halfspace.errors import ContactTooWide, IllPosed, InputError, NotConverged
from halfspace.scales import BRADLEY
from halfspace.values import Estimate, Valued

MOST_RUNGS = 4  # above the lowest
FOLDS = ("jump_on", "jump_off")
# eps/(R dgamma), of the least -d(alpha*)/dW between points: the Tabor parameter of a paraboloid is then 0.65 to 0.74;
# of another profile as much less as its tensions are larger
IN_DOUBT = 0.02
FLAT = 1e-9  # eps/(R dgamma), of it: what the last of the parabolas and rounding leave

T = TypeVar("T")
Charts = Sequence[Chart]
State = Mapping[str, Located]


class Stage(Protocol):
    """One discretisation on which events are solved for again."""

    def __call__(self, event: Located) -> Chart:
        """Chart for an event found on another discretisation."""
        ...

    @property
    def farther(self) -> Callable[[Located], Chart] | None:
        """Chart for an event that lies farther from where it was found than charts serve; None if these serve all."""
        ...

    @property
    def everywhere(self) -> Finest:
        """The same for every point of a curve, if charts for events do not serve these."""
        ...

    @property
    def unknowns(self) -> int:
        """Unknowns of the largest chart."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Charted(Valued):
    """The same charts for every event, one for those on a grid that stands still, one for those on one that follows.

    Attributes
    ----------
    charts : sequence of Chart
        That for the grid that follows the contact is the last.
    """

    charts: Charts
    farther = None

    def __call__(self, event: Located) -> Chart:
        """Chart of the event's kind."""
        source = event.problem
        return self.charts[-1 if isinstance(source, ContactProblem) and source.follows_contact else 0]

    @property
    def everywhere(self) -> Finest:
        """The same charts."""
        return self

    @property
    def unknowns(self) -> int:
        """Unknowns of the largest chart."""
        return max(chart.unknowns for chart in self.charts)


@dataclass(frozen=True, eq=False, repr=False)
class Rung(Valued):
    """One step of a ladder of discretisations.

    Attributes
    ----------
    curve : callable
        Makes the charts for tracing the curve on this rung; they need not all be made before.
    stages : tuple of Stage
        On each of which every event is solved for; each differs from the one before in one respect, the last is the
        finest. The changes add up to the error. On the lowest rung they only prepare, and there may be none.
    settings : mapping
        How the last stage is discretised.
    twin : Stage or None
        As fine as the rung below, with other cells: it errs as much, but not by the same accident of sign.
    remaining : float
        Part of the changes that may be left as error; above 1 where the error falls slowly from stage to stage.
    along : bool
        Whether the shift of an event along the path counts, see `halfspace.equilibrium.events.estimate_event`: on grids
        that follow the contact, whose radius tells it precisely, and where there is no twin to guard against chance.
    """

    curve: Callable[[], Iterable[Chart]]
    stages: tuple[Stage, ...]
    settings: Mapping[str, object]
    twin: Stage | None = None
    remaining: float = REMAINING
    along: bool = False


def charted_rung(*stages: Charts) -> Rung:
    """Rung of given charts, the last of which also serve for the curve."""
    return Rung(lambda: stages[-1], tuple(Charted(charts) for charts in stages), {})


def climb(
    rtol: float, rung: Callable[[int], Rung], *, to_load: float = COMPRESSION, most_rungs: int = MOST_RUNGS
) -> EquilibriumPath:
    """Trace the curve on the lowest rung of a ladder and solve for its events on higher ones until `rtol` is met.

    Parameters
    ----------
    rtol : float
        Relative accuracy asked of loads and approaches.
    rung : callable
        Makes the rung of a level: 0 for the curve, 1, 2 ... for the events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.
    most_rungs : int
        Levels after which the estimates stand as they are.

    Raises
    ------
    halfspace.errors.NotConverged
        If the curve cannot be traced or an event not be found again.
    GridTooCoarse
        If a grid cannot carry the spike at the contact edge.
    """
    for start in range(most_rungs):
        try:
            return _climb_from(start, rtol, rung, to_load, most_rungs)
        except FoldsLost:  # two folds about to merge exist on one grid but not on the next
            if start == most_rungs - 1:
                return _climb_from(0, rtol, rung, to_load, most_rungs, folds=False)
        except (ContactTooWide, IllPosed):  # for any grid
            raise
        except NotConverged:
            if start == most_rungs - 1:
                raise
    raise InputError(f"most_rungs = {most_rungs} leaves nothing to climb; allow 1 or more")


class FoldsLost(NotConverged):
    """Folds about to merge are found on one rung but not on another."""


def _climb_from(
    start: int, rtol: float, rung: Callable[[int], Rung], to_load: float, most_rungs: int, *, folds: bool = True
) -> EquilibriumPath:
    """Trace the curve on the rung `start` and climb from there, with its folds or without."""
    began = time.perf_counter()
    lowest = rung(start)
    charts = lowest.curve()
    segments = trace_charts(charts, to_load)
    found = {**find_events(segments), **_folds_in_doubt(segments)}
    state: State = {name: event for name, event in found.items() if folds or name not in FOLDS}
    for stage in lowest.stages:
        state = _on_all(state, stage)
    higher = lowest
    for level in range(start + 1, start + most_rungs + 1):
        below, higher = higher, rung(level)
        chains = _step_up(state, higher.stages, higher.twin)
        state = chains[0][-1]
        events = _estimate(chains, higher.remaining, along=higher.along)
        if not Tolerance.on(events, rtol).missed(events):
            break
    margin = _margin(chains, higher.remaining)
    if folds and margin and margin.value + margin.error < 0 and "jump_on" not in events:
        raise FoldsLost("the curve folds on a finer grid, but not on its own; take a smaller rtol")
    before = (*lowest.stages, *(() if below is lowest else below.stages[-1:]))
    traced = segments if folds else ()
    jumps = tuple(state[name] for name in FOLDS if name in state)
    further = FurtherFolds(traced, jumps, before, higher.stages, higher.twin, higher.remaining, higher.along)
    return EquilibriumPath(
        segments[0].problem.tabor,
        segments,
        Completed(events, further.events),
        _energy(chains, higher.remaining),
        tuple(Completed(state, partial(further.stage, number)) for number, state in enumerate(chains[0])),
        higher.stages[-1],
        time.perf_counter() - began,
        {"rtol": rtol, "curve": lowest.settings, "events": higher.settings},
        below.stages[-1] if below.stages else None,
        higher.twin or (higher.stages[-2] if len(higher.stages) > 1 else None),
        higher.remaining,
        _ways(below.stages[-1] if below.stages else Charted(tuple(charts)), higher),
        margin,
    )


@dataclass(frozen=True, eq=False)
class Completed(Mapping[str, T]):
    """What is known by name, and what is of the folds between the jumps when one of these is first asked for."""

    known: Mapping[str, T]
    more: Callable[[], Mapping[str, T]]

    @cached_property
    def every(self) -> dict[str, T]:
        """All of it, folds in order along the curve."""
        after = ("jump_off", "zero_load")
        first = {name: value for name, value in self.known.items() if name not in after}
        return {**first, **self.more(), **self.known}

    def __getitem__(self, name: str) -> T:
        return self.known[name] if name in self.known or name in EVENTS else self.every[name]

    def __contains__(self, name: object) -> bool:
        return name in self.known or (name not in EVENTS and name in self.every)

    def __iter__(self) -> Iterator[str]:
        return iter(self.every)

    def __len__(self) -> int:
        return len(self.every)


@dataclass(frozen=True, eq=False, repr=False)
class FurtherFolds(Valued):
    """Folds between the jumps, solved for as the other events and known as well.

    Attributes
    ----------
    segments : tuple of Segment
        The curve as it was traced.
    jumps : tuple of Located
        The outermost folds, on the finest discretisation.
    before : tuple of Stage
        On each of which an event is solved for on the way to the last rung.
    stages, twin, remaining, along
        Of the last rung.
    """

    segments: tuple[Segment, ...]
    jumps: tuple[Located, ...]
    before: tuple[Stage, ...]
    stages: tuple[Stage, ...]
    twin: Stage | None
    remaining: float
    along: bool

    @cached_property
    def chains(self) -> list[list[State]]:
        """Chains of states as of the events; a fold that a finer grid does not have is left out.

        That of a ripple on a coarse grid may become another fold, or be lost alone: folds come in pairs.
        """
        found: list[list[list[Located]]] = []
        for fold in further_folds(self.segments):
            chains, known = self._chains(fold), (*self.jumps, *(others[0][-1] for others in found))
            if chains and not any(_same(chains[0][-1], other) for other in known):
                found.append(chains)
        pairs = found[: len(found) // 2 * 2]
        return [[numbered(states) for states in zip(*chain, strict=True)] for chain in zip(*pairs, strict=True)]

    def _chains(self, fold: Located) -> list[list[Located]]:
        for stage in self.before:  # where one does not have it, a later one may: its change is then from farther back
            with suppress(NotConverged):
                fold = _moved_to(fold, stage)
        try:
            return [[state[""] for state in chain] for chain in _step_up({"": fold}, self.stages, self.twin)]
        except NotConverged:
            return []

    def events(self) -> Mapping[str, Event]:
        """The folds with their errors."""
        return _estimate(self.chains, self.remaining, along=self.along) if self.chains else {}

    def stage(self, number: int) -> State:
        """The folds on one of the discretisations from the rung below the last to the finest."""
        return self.chains[0][number] if self.chains else {}


def _same(a: Located, b: Located) -> bool:
    """Whether two folds are one and the same."""
    first, second = a.point.observables[:CONTACT_RADIUS], b.point.observables[:CONTACT_RADIUS]
    return bool(np.all(np.abs(first - second) < SAME * (1 + np.abs(second))))


SAME = 1e-6  # of approach, load and central gap, what two folds differ by where they are two


def _ways(below: Stage, higher: Rung) -> Ways:
    """Chains from the rung below, and from its twin, to the last stage of a rung, for any point of the curve."""
    stages = [stage.everywhere for stage in (below, *higher.stages)]
    chain = [partial(placed, b) for a, b in zip([None, *stages], stages, strict=False) if a is not b]
    return (tuple(chain), (partial(placed, higher.twin.everywhere), chain[-1])) if higher.twin else (tuple(chain),)


def _folds_in_doubt(segments: Sequence[Segment]) -> State:
    """Where the curve falls most steeply, if two folds there are about to merge or to be born; nothing otherwise."""
    metric = metric_for(segments[0].problem)
    parts = [(*steepest(s.points), s.problem) for s in segments if len(s.points) > 1]
    least, part, a, b, problem = min(parts, key=lambda one: one[0])
    if abs(least) >= IN_DOUBT * BRADLEY / metric.load:
        return {}
    step = part * (b.arclength - a.arclength)
    point = correct(problem, a, step, hermite(problem, a, b, part, metric), metric, iterations=20) if step else a
    return {"steepest": steepest_from(problem, point, metric)}


def _margin(chains: Sequence[Sequence[State]], remaining: float) -> Estimate | None:
    """How far the curve is from folds, with the error that the changes along the chains leave."""
    if "steepest" not in chains[0][-1]:
        return None
    values = [[STEEPEST.of(state["steepest"].point) for state in chain] for chain in chains]
    return Estimate(values[0][-1], remaining * _change(values) + FLAT)


def _change(values: Sequence[Sequence[float]]) -> float:
    """Sum of the changes along a chain, the largest of all chains."""
    return max(float(np.sum(np.abs(np.diff(chain)))) for chain in values)


def _step_up(state: State, stages: Sequence[Stage], twin: Stage | None) -> list[list[State]]:
    """Chains of states from the rung below, and from its twin, to the last stage of a rung."""
    chain = [state]
    for stage in stages:
        chain.append(_on_all(chain[-1], stage))
    return [chain, [_on_all(chain[-1], twin), chain[-1]]] if twin else [chain]


def _on_all(state: State, stage: Stage) -> State:
    return {name: _found_again(name, event, stage) for name, event in state.items()}


def _found_again(name: str, event: Located, stage: Stage) -> Located:
    try:
        return _moved_to(event, stage)
    except NotConverged as error:
        raise FoldsLost(str(error)) if name in FOLDS else error from error


def _moved_to(event: Located, stage: Stage) -> Located:
    """Solve for an event again, and once more wherever it comes to lie in the reach of another chart."""
    found, tried = event, {id(event.problem)}
    for _ in range(MOVES):
        problem = stage(found).problem
        if id(problem) in tried:
            return found
        tried.add(id(problem))
        found = _moved_near(found, problem, stage)
    raise NotConverged("an event lies elsewhere on every grid that is made around it; take a smaller rtol")


def _moved_near(event: Located, problem: Traceable, stage: Stage) -> Located:
    """Solve for an event on a chart made for where it was found, or where that leads astray on one for farther off."""
    if stage.farther is None:
        return moved(event, problem)
    with suppress(NotConverged):
        found = moved(event, problem)
        before, after = (e.point.observables[CONTACT_RADIUS] for e in (event, found))
        if not abs(after - before) > ASTRAY * before:  # nor nan
            return found
    return moved(event, stage.farther(event).problem)


MOVES = 5  # of an event from chart to chart, after which the last must be one made for where it lies
ASTRAY = 0.05  # of a contact radius: a leap in which a chart made for the first tells nothing about the second


def _estimate(chains: Sequence[Sequence[State]], remaining: float, *, along: bool) -> dict[str, Event]:
    """Events of the last state, with their changes along the chains as errors."""
    names = [name for name in chains[0][-1] if is_event(name)]
    by_name = {name: [[state[name] for state in chain] for chain in chains] for name in names}
    return {name: estimate_event(name, own, remaining, along=along) for name, own in by_name.items()}


def _energy(chains: Sequence[Sequence[State]], remaining: float) -> Estimate:
    values = [[energy_released(state) for state in chain] for chain in chains]
    best = values[0][-1]
    return Estimate(best, remaining * _change(values) + ROUND_OFF * (1 + abs(best)))
