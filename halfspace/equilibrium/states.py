"""States anywhere on a curve, each solved for on the finest discretisation, with the estimated error of each number.

A curve is traced on a coarse discretisation. Each of its points is solved for again on the finest, in the plane across
the path at that point: two discretisations share the arclength, where at a fold they share neither approach nor load.
The errors are by the same state, in the plane across the point found, on the discretisations of the `Ladder`.

Where a coordinate is prescribed, as the approach, the errors of the others are those in the plane and what that shift
along the path makes of them by which the coordinate would come back to its value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby, pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from halfspace.branches import branch_names, chosen_branch
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import Stage, placed, settled, transfer
from halfspace.equilibrium.conditions import (
    FOLD,
    LOCATE,
    Condition,
    Located,
    between,
    part_way,
    rounding,
    same_place,
    seen_from,
)
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD
from halfspace.equilibrium.events import ErrorRule, errors_of, with_doubt
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Metric, Point, Segment, solved_point
from halfspace.equilibrium.search import Chains, confirmed, turns
from halfspace.errors import InputError, NotConverged, Unsolved, required
from halfspace.limits import require_numbers
from halfspace.values import Array, States, Valued

T = TypeVar("T")


@dataclass(frozen=True, eq=False, repr=False)
class Ladder(Valued):
    """Discretisations on which a state is solved for, so that its changes between them tell its error by a rule.

    The chain begins with the rung below the finest, and each differs from the one before in one respect. The twin is as
    fine as the first of the chain, with other cells; it has the same error but for the accident of its sign. A coarser
    discretisation comes before the chain, where it has the state.
    """

    chain: tuple[Stage, ...]
    twin: Stage | None
    rule: ErrorRule
    coarser: Stage | None = None

    @property
    def finest(self) -> Stage:
        """The finest discretisation."""
        return self.chain[-1]

    @cached_property
    def along(self) -> Ladder:
        """The same for any state of the curve, where charts for events serve these alone."""
        stages = [stage.everywhere for stage in self.chain]
        differing = [a for a, b in zip(stages, [*stages[1:], None], strict=True) if a is not b]
        rule = replace(self.rule, remaining=max(self.rule.remaining, 1.0), least=0.0)
        twin, coarser = (other and other.everywhere for other in (self.twin, self.coarser))
        return Ladder(tuple(differing), twin, rule, coarser)

    def chains(self, fine: T, again: Callable[[Stage, T], T | Unsolved]) -> list[list[T]] | Unsolved:
        """Chains to a state of the finest discretisation, where `again` solves for it on another one."""
        chain = [fine]
        for stage in self.chain[-2::-1]:
            there = again(stage, fine)
            if isinstance(there, Unsolved):
                return there
            chain.insert(0, there)
        return with_twin(after_coarser(chain, self.coarser, again), self.twin, again)


def after_coarser(chain: Sequence[T], coarser: Stage | None, again: Callable[[Stage, T], T | Unsolved]) -> list[T]:
    """Chain of a state after a coarser discretisation, where that has it."""
    return [again(coarser, chain[-1]) or chain[0], *chain] if coarser else list(chain)


def with_twin(own: list[T], twin: Stage | None, again: Callable[[Stage, T], T | Unsolved]) -> list[list[T]] | Unsolved:
    """Chains of a state: its own, and from a twin to its last."""
    if twin is None:
        return [own]
    there = again(twin, own[-1])
    return there if isinstance(there, Unsolved) else [own, [there, own[-1]]]


def met_again(stage: Stage, state: Located) -> Located | Unsolved:
    """Solve for a state that meets a condition again on a discretisation."""
    return state if stage(state).problem is state.problem else settled(state, stage, stage.moved)


COORDINATES: Mapping[str, tuple[int, str]] = {
    "approach": (APPROACH, "eps"),
    "load": (LOAD, "R dgamma"),
    "central_gap": (CENTRAL_GAP, "eps"),
}


def measured(problem: Traceable, points: Sequence[Point], metric: Metric, before: Point | None = None) -> Segment:
    """Measure the arclength between points along the tangent of the first of any two, as a step is measured.

    It begins with that of the first, or where the last point before it is given, on another discretisation, from there.
    """
    found = [points[0] if before is None else _onwards(before, points[0], metric)]
    for point in points[1:]:
        found.append(_onwards(found[-1], point, metric))
    return Segment(problem, tuple(found))


def _onwards(last: Point, point: Point, metric: Metric) -> Point:
    """Return the point with its arclength from the last one."""
    step = max(metric.step(last, point), 0.0)  # 0 where one grid hands over to the next
    return replace(point, arclength=last.arclength + step)


@dataclass(frozen=True, eq=False, repr=False)
class FinestCurve(Valued):
    """A curve's segments, in order, on the finest discretisation of a ladder.

    `traced` are those on which it was traced; the metric says what arclength means. A point that the finest
    discretisation does not have stays on one of those left behind, with infinite errors. The folds are the events.
    """

    segments: tuple[Segment, ...]
    traced: tuple[Segment, ...]
    ladder: Ladder
    metric: Metric
    folds: Sequence[Located]
    left_behind: tuple[Traceable, ...] = ()

    @cached_property
    def errors(self) -> Array:
        """Estimated errors of approach, load, central gap and contact radius at each point, (points, 4).

        Infinite at a point that another discretisation does not have, nor a state near to it.
        """
        return np.concatenate([self._errors_along(segment) for segment in self.segments])

    def _errors_along(self, segment: Segment) -> Array:
        """Those of a segment: of every third point and the last, the larger of two for a point between these.

        A point next to one whose errors are not known has its own.
        """
        points, every = segment.points, np.arange(len(segment.points))
        there = np.union1d(every[::EVERY], every[-1:])
        known = np.array([self._errors(segment.problem, points[i]) for i in there])
        before, after = np.searchsorted(there, every, side="right") - 1, np.searchsorted(there, every)
        errors = np.asarray(np.maximum(known[before], known[after]))
        exist = np.isfinite([point.observables for point in points])
        for i in np.setdiff1d(np.flatnonzero((exist & ~np.isfinite(errors)).any(axis=1)), there):
            errors[i] = self._errors(segment.problem, points[i])
        law = segment.problem.interface.law
        return np.array([with_doubt(own, point.observables, law) for own, point in zip(errors, points, strict=True)])

    def branches(self, coordinate: str) -> dict[str, tuple[float, float]]:
        """Range of a coordinate on each of its branches, by name."""
        k, parts = COORDINATES[coordinate][0], self.parts(coordinate)
        ends = {name: (part[0].points[0], part[-1].points[-1]) for name, part in parts.items()}
        values = {name: sorted(float(point.observables[k]) for point in pair) for name, pair in ends.items()}
        return {name: (low, high) for name, (low, high) in values.items()}

    def parts(self, coordinate: str) -> Mapping[str, Sequence[Segment]]:
        """Parts of the curve along which a coordinate goes in one direction, by name."""
        if coordinate not in self._parts:
            self._parts[coordinate] = self._cut(COORDINATES[coordinate][0])
        return self._parts[coordinate]

    @cached_property
    def _parts(self) -> dict[str, Mapping[str, Sequence[Segment]]]:
        """Those that were asked for before."""
        return {}

    def turns(self, condition: Condition) -> list[Located]:
        """Places in order where an observable turns on every discretisation, on the finest; the folds are the events.

        See `halfspace.equilibrium.search.confirmed`.
        """
        if condition == FOLD:
            return list(self.folds)
        return [chains[0][-1] for chains in confirmed(turns(self.traced, condition), self._again)[0]]

    def _again(self, turn: Located) -> Chains | Unsolved:
        ladder = self.ladder.along
        fine = met_again(ladder.finest, turn)
        return fine and ladder.chains(fine, met_again)

    def _cut(self, k: int) -> Mapping[str, Sequence[Segment]]:
        """Cut the curve where an observable turns, between the points from which the way over the turn is shortest."""
        points = [(segment.problem, point) for segment in self.segments for point in segment.points]
        branches, first = list[list[tuple[Traceable, Point]]](), 0
        begin: list[tuple[Traceable, Point]] = []
        for turn in self.turns(Condition(k, stationary=True)):
            end, place = (turn.problem, turn.point), self._place(points, turn)
            branches.append([*begin, *points[first:place], end])
            begin, first = [end], max(first, place)
        branches.append([*begin, *points[first:]])
        return dict(
            zip(branch_names(len(branches)), (measured_runs(one, self.metric) for one in branches), strict=True)
        )

    def _place(self, points: Sequence[tuple[Traceable, Point]], turn: Located) -> int:
        """Number of the point before which a turn lies."""
        far = np.array([self.metric.distance(point, turn.point) for _, point in points])
        apart = np.array([self.metric.distance(a, b) for (_, a), (_, b) in pairwise(points)])
        return int(np.argmin(far[:-1] + far[1:] - apart)) + 1

    def at(self, coordinate: str, values: ArrayLike, branch: str | None) -> States:
        """States on a branch where a coordinate has given values."""
        wanted = require_numbers(values, coordinate)
        found = [self._at(coordinate, float(value), branch) for value in wanted.ravel()]
        numbers = np.array(found).reshape(-1, 8).T.reshape(8, *wanted.shape)
        return States(*(number[()] for number in numbers))

    def _at(self, coordinate: str, value: float, branch: str | None) -> Array:
        """Numbers of one state and their errors, (8,)."""
        k, unit = COORDINATES[coordinate]
        name = chosen_branch(self.branches(coordinate), coordinate, unit, value, branch)
        problem, point, bend = self._solved(k, value, self.parts(coordinate)[name])
        errors = self._errors(problem, point)
        if np.isfinite(errors[k]):
            errors = errors + np.abs(point.rates) * shift(errors[k], abs(point.rates[k]), bend)
        errors[k] = rounding(problem, point.x)[k]
        return np.concatenate([point.observables, with_doubt(errors, point.observables, problem.interface.law)])

    def _solved(self, k: int, value: float, parts: Sequence[Segment]) -> tuple[Traceable, Point, float]:
        """State on a branch where an observable has a value, and the observable's second derivative along the path."""
        condition = Condition(k, value=value)
        for part in parts:
            for a, b in pairwise(part.points):
                if condition.of(a) * condition.of(b) <= 0 and b.arclength > a.arclength:
                    return part.problem, *self._met(part.problem, a, b, condition)
        # Between the last point on one discretisation and the first on the next, either of which may not have it.
        known = [part for part in parts if not self._is_left_behind(part.problem)] or parts
        for problem, a, b in (bridge for before, after in pairwise(known) for bridge in self._bridges(before, after)):
            if condition.of(a) * condition.of(b) <= 0:
                return problem, *self._met(problem, a, b, condition)
        # Or in the hole, no wider than their errors, between two grids of which one hands over to the next.
        points = [(part.problem, point) for part in known for point in part.points]
        problem, near = min(points, key=lambda one: abs(condition.of(one[1])))
        control = newton.Control(condition.weights, value)
        found = solved_point(problem, near.x, control, self.metric, self.metric.weights * near.rates, near.arclength)
        if not found or self.metric.distance(found, near) > LOCATE.nearby:  # it may be on another branch
            raise NotConverged(f"no state at {value:.6g} is found between two grids; take a smaller rtol")
        return problem, found, 0.0

    def _met(self, problem: Traceable, a: Point, b: Point, condition: Condition) -> tuple[Point, float]:
        """State between two points that meets a condition, and the observable's second derivative there."""
        k = condition.observable
        bend = abs(b.rates[k] - a.rates[k]) / (b.arclength - a.arclength)
        return required(between(problem, a, b, condition, self.metric)).point, bend

    def _bridges(self, before: Segment, after: Segment) -> Iterator[tuple[Traceable, Point, Point]]:
        """Last point on one discretisation and first on the next, both on either of these that has them."""
        last, first = before.points[-1], after.points[0]
        for problem, other, point in ((before.problem, after.problem, first), (after.problem, before.problem, last)):
            if problem.interface.follows_contact and np.isnan(point.observables[CONTACT_RADIUS]):
                continue
            there = same_place(point, problem, transfer(other, point.x, problem), self.metric)
            if there:
                a, b = (last, there) if point is first else (there, first)
                if (b := seen_from(a, b, self.metric)).arclength > a.arclength:
                    yield problem, a, b

    def _is_left_behind(self, problem: Traceable) -> bool:
        return any(problem is one for one in self.left_behind)

    def _errors(self, problem: Traceable, point: Point) -> Array:
        """Errors of the observables in the plane across the path, (4,)."""
        ladder, here = self.ladder.along, Located(PLANE, problem, point, 1.0)
        chains = not self._is_left_behind(problem) and ladder.chains(here, placed)
        if not chains:  # another discretisation does not have it
            return np.full(4, np.inf)
        errors = errors_of(chains, ladder.rule)
        if ladder.twin:
            return errors
        # One chain: the plane itself goes with the gap, which is known to its polynomial's end alone.
        rates, weights = np.abs(point.rates), self.metric.weights
        return np.asarray(errors + rates * weights[CENTRAL_GAP] * rates[CENTRAL_GAP] * errors[CENTRAL_GAP])


# Points of a curve to one whose errors are solved for, in a third of the time. On ten curves of 30 to 200 points the
# others are told their own errors in the median, and no less than 0.35 of them.
EVERY = 3
PLANE = Condition(APPROACH)  # of a state that meets no condition but lies in a plane across the path


def shift(change: float, rate: float, bend: float) -> float:
    """Bound of the arclength that takes a change of a coordinate back, which has a rate and a second derivative.

    Towards a fold the root of rate s - bend s^2/2 = change, past it, where there is none, that of bend s^2/2 = change.
    """
    inside = rate**2 - 2 * bend * change
    return float(2 * change / (rate + np.sqrt(inside)) if inside > 0 else np.sqrt(2 * change / bend))


def require_coordinate(name: str) -> str:
    """Return the name of a coordinate, or raise InputError if there is none of that name."""
    if name not in COORDINATES:
        raise InputError(f'coordinate = "{name}" is none of {", ".join(COORDINATES)}; take one of these')
    return name


def finest_curve(segments: Sequence[Segment], ladder: Ladder, metric: Metric, folds: Sequence[Located]) -> FinestCurve:
    """Solve for the points of a curve on the finest discretisation.

    The segments are of the curve on any discretisation. A point that cannot be solved for there stays where it is.
    """
    found, left_behind = list[tuple[Traceable, Point]](), dict[int, Traceable]()
    for problem, point in ((segment.problem, point) for segment in segments for point in segment.points):
        there = placed(ladder.finest.everywhere, Located(PLANE, problem, point, 1.0))
        found.append((there.problem, there.point) if there else (problem, point))
        if not there:
            left_behind[id(problem)] = problem
    left = tuple(left_behind.values())
    return FinestCurve(measured_runs(found, metric), tuple(segments), ladder, metric, folds, left)


def measured_runs(points: Sequence[tuple[Traceable, Point]], metric: Metric) -> tuple[Segment, ...]:
    """Segments of points in order, each on a discretisation, with their arclength."""
    segments: list[Segment] = []
    for _, run in groupby(points, key=lambda one: id(one[0])):
        own = list(run)
        before = segments[-1].points[-1] if segments else None
        segments.append(measured(own[0][0], [point for _, point in own], metric, before))
    return tuple(segments)


def resampled(segments: Sequence[Segment], count: int, metric: Metric) -> tuple[Segment, ...]:
    """Points of a curve evenly spaced in arclength, on its own discretisations."""
    places = np.linspace(segments[0].points[0].arclength, segments[-1].points[-1].arclength, count)
    ends = [segment.points[-1].arclength for segment in segments]
    own = np.searchsorted(ends[:-1], places)
    return tuple(
        Segment(segment.problem, tuple(_spread(segment, places[own == i], metric)))
        for i, segment in enumerate(segments)
        if np.any(own == i)
    )


def _spread(segment: Segment, places: Array, metric: Metric) -> Iterator[Point]:
    """Points at arclengths within a segment."""
    problem, points = segment.problem, segment.points
    s = np.array([point.arclength for point in points])
    for place in places:
        i = int(np.clip(np.searchsorted(s, place) - 1, 0, s.size - 2))
        a, b = points[i], points[i + 1]
        if place in (a.arclength, b.arclength):  # the end itself, which solving anew would move by its rounding
            yield a if place == a.arclength else b
            continue
        yield required(part_way(problem, a, b, (place - a.arclength) / (b.arclength - a.arclength), metric))
