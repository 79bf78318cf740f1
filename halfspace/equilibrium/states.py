"""States anywhere on a curve, each solved for on the finest discretisation, with the estimated error of each number.

A curve is traced on a coarse discretisation. Each of its points is solved for again on the finest, in the plane across
the path at that point: two discretisations share the arclength, where at a fold they share neither approach nor load.
The same in the plane of the point found, on the discretisations that the events went through before, tells the errors.

Where a coordinate is prescribed, as the approach, the errors of the others are those in the plane and what that shift
along the path makes of them by which the coordinate would come back to its value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import ArrayLike

from halfspace.equilibrium import newton
from halfspace.equilibrium.conditions import FOLD, Condition, Located, between, hermite, rounding
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, LOAD
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Metric, Point, Segment, correct, make_point
from halfspace.equilibrium.search import states_in
from halfspace.errors import InputError, NotConverged
from halfspace.values import Array, Valued

Again = Callable[[Traceable, Point], tuple[Traceable, Point]]
"""Solves for a point of the path on another discretisation, in the plane across the path at that point."""

Ways = Sequence[Sequence[Again]]
"""Chains of discretisations, each of which differs from the one before in one respect; all end with the finest."""

COORDINATES: Mapping[str, tuple[int, str]] = {
    "approach": (APPROACH, "eps"),
    "load": (LOAD, "R dgamma"),
    "central_gap": (CENTRAL_GAP, "eps"),
}


@dataclass(frozen=True, eq=False, repr=False)
class States(Valued):
    """States of a contact, with the estimated error of each number; all arrays have the shape of what was asked.

    Attributes
    ----------
    approach, approach_error : array
        In eps.
    load, load_error : array
        In R dgamma, positive in compression.
    central_gap, central_gap_error : array
        H(0) in eps.
    contact_radius, contact_radius_error : array
        In beta; nan where the central gap exceeds 3^(1/6) eps.
    """

    approach: Array
    load: Array
    central_gap: Array
    contact_radius: Array
    approach_error: Array
    load_error: Array
    central_gap_error: Array
    contact_radius_error: Array


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
    step = float((metric.weights * last.rates)[:3] @ (point.observables - last.observables)[:3])
    return replace(point, arclength=last.arclength + max(step, 0.0))  # 0 where one grid hands over to the next


@dataclass(frozen=True, eq=False, repr=False)
class FinestCurve(Valued):
    """A curve's segments, in order, on the finest discretisation.

    By the ways, chains of discretisations, errors are found; `remaining` is the part of the changes along a chain that
    may be left, and the metric says what arclength means. A point that the finest discretisation does not have stays on
    one of those left behind, with infinite errors. The folds are those that are told as events.
    """

    segments: tuple[Segment, ...]
    ways: Ways
    remaining: float
    metric: Metric
    folds: Callable[[], Sequence[Located]]
    left_behind: tuple[Traceable, ...] = ()

    @cached_property
    def errors(self) -> Array:
        """Estimated errors of approach, load, central gap and contact radius at each point, (points, 4).

        No less than between those at the points beside it, in the geometric mean: along the path a change passes
        through zero, where it tells nothing. Where there is but one change to tell, of two points on either side the
        larger counts, since a change may be all but zero at several. Where one grid hands over to the next its last
        point has the other's beside it as well: it may be the only one in contact. Infinite at a point that another
        discretisation does not have, nor a state near to it.
        """
        part = max(self.remaining, 1.0)
        own = [np.array([self._errors(s.problem, point, part) for point in s.points]) for s in self.segments]
        apart = np.concatenate([self._no_less_than_beside(along) for along in own])
        return np.asarray(np.fmax(apart, self._no_less_than_beside(np.concatenate(own))))

    def _no_less_than_beside(self, own: Array) -> Array:
        """Errors along the path, (points, 4), no less than those beside; at its ends, and a contact's, its own."""
        farther = 2 if self._one_change else 1
        padded = np.pad(np.where(np.isfinite(own), own, np.nan), ((farther, farther), (0, 0)), mode="edge")
        sides = [padded[k : k + len(own)] for k in range(2 * farther + 1) if k != farther]
        before, after = (np.fmax.reduce(side) for side in (sides[:farther], sides[farther:]))
        return np.where(np.isnan(own), own, np.fmax(own, np.sqrt(_known(before, own) * _known(after, own))))

    @property
    def _one_change(self) -> bool:
        """Whether there is one chain, of two discretisations."""
        return [len(way) for way in self.ways] == [2]

    def branches(self, coordinate: str) -> dict[str, tuple[float, float]]:
        """Range of a coordinate on each of its branches, by name."""
        ends = [part.points[place].observables for part, place in self._ends(coordinate)]
        values = [float(end[COORDINATES[coordinate][0]]) for end in ends]
        pairs = zip(values[::2], values[1::2], strict=True)
        return {name: (min(pair), max(pair)) for name, pair in zip(self.parts(coordinate), pairs, strict=True)}

    def _ends(self, coordinate: str) -> Iterator[tuple[Segment, int]]:
        for parts in self.parts(coordinate).values():
            yield parts[0], 0
            yield parts[-1], -1

    def parts(self, coordinate: str) -> Mapping[str, Sequence[Segment]]:
        """Parts of the curve along which a coordinate goes in one direction, by name."""
        if coordinate not in self._parts:
            self._parts[coordinate] = self._cut(COORDINATES[coordinate][0])
        return self._parts[coordinate]

    @cached_property
    def _parts(self) -> dict[str, Mapping[str, Sequence[Segment]]]:
        """Those that were asked for before."""
        return {}

    def confirmed(self, turns: Sequence[Located]) -> list[Located]:
        """Places in order where an observable turns, found on any discretisation, but for those by which it ripples.

        The approach turns at the folds that are told as events. Another observable ripples between two places next to
        each other where on the finest it goes by no more than it errs there, or back. A shift that both share, from
        grid to grid, does not count.
        """
        if turns and turns[0].condition == FOLD:
            return self._folds_among(turns)
        left = list(turns)
        told = [self._finest_level(turn) for turn in turns] if self.ways and len(turns) > 1 else []
        while told and len(left) > 1:
            goes = np.diff([turn.condition.level(turn.point) for turn in left])
            levels, errs = np.array(told).T
            clear = np.sign(goes) * np.diff(levels) / (errs[1:] + errs[:-1])
            ripple = int(np.lexsort((np.abs(goes), clear))[0])
            if clear[ripple] > 1:
                break
            for numbers in (left, told):
                del numbers[ripple : ripple + 2]
        return left

    def _folds_among(self, turns: Sequence[Located]) -> list[Located]:
        """Of the places where the approach turns those nearest to its folds, least or largest as these."""
        found = set[int]()
        for fold in self.folds():
            alike = [turn for turn in turns if turn.slope * fold.slope > 0]
            found |= {id(turn) for turn in sorted(alike, key=lambda t: self.metric.distance(t.point, fold.point))[:1]}
        return [turn for turn in turns if id(turn) in found]

    def _finest_level(self, turn: Located) -> tuple[float, float]:
        """What turns there, on the finest discretisation, and its error; infinite where that has no such state."""
        try:
            problem, point = self.ways[0][-1](turn.problem, turn.point)
        except NotConverged:
            return turn.condition.level(turn.point), math.inf
        errors, weights = self._errors(problem, point, max(self.remaining, 1.0)), turn.condition.weights
        return turn.condition.level(point), float(np.abs(weights[weights != 0]) @ errors[weights != 0])

    def _cut(self, k: int) -> Mapping[str, Sequence[Segment]]:
        """Cut the curve where an observable turns."""
        branches: list[list[Segment]] = [[]]
        found = states_in(self.segments, Condition(k, stationary=True))
        confirmed = {id(turn) for turn in self.confirmed([turn for turns in found for turn in turns])}
        for part, turns in zip(self.segments, found, strict=True):
            points = list(part.points)
            for turn in (one for one in turns if id(one) in confirmed):
                before = [p for p in points if p.arclength < turn.point.arclength]
                branches[-1].append(measured(part.problem, [*before, turn.point], self.metric))
                branches.append([])
                points = [turn.point, *points[len(before) :]]
            branches[-1].append(measured(part.problem, points, self.metric))
        return dict(zip(_names(len(branches)), branches, strict=True))

    def at(self, coordinate: str, values: ArrayLike, branch: str | None) -> States:
        """States on a branch where a coordinate has given values."""
        wanted = np.asarray(values, dtype=float)
        found = [self._at(coordinate, float(value), branch) for value in wanted.ravel()]
        numbers = np.array(found).reshape(-1, 8).T.reshape(8, *wanted.shape)
        return States(*(number[()] for number in numbers))

    def _at(self, coordinate: str, value: float, branch: str | None) -> Array:
        """Numbers of one state and their errors, (8,)."""
        k, _ = COORDINATES[coordinate]
        problem, point, bend = self._solved(k, value, self.parts(coordinate)[self._chosen(coordinate, value, branch)])
        try:
            errors = self._errors_given(k, problem, point, bend)
        except NotConverged:
            errors = _unbounded(point)
            errors[k] = rounding(problem, point.x)[k]
        return np.concatenate([point.observables, errors])

    def _solved(self, k: int, value: float, parts: Sequence[Segment]) -> tuple[Traceable, Point, float]:
        """State on a branch where an observable has a value, and the observable's second derivative along the path."""
        condition = Condition(k, value=value)
        for part in parts:
            for a, b in pairwise(part.points):
                if condition.of(a) * condition.of(b) <= 0 and b.arclength > a.arclength:
                    bend = abs(b.rates[k] - a.rates[k]) / (b.arclength - a.arclength)
                    return part.problem, between(part.problem, a, b, condition, self.metric).point, bend
        # Between the last point on one discretisation and the first on the next, either of which may not have it.
        nearest = [min(part.points, key=lambda p: abs(condition.of(p))) for part in parts]
        by_distance = sorted(zip(nearest, parts, strict=True), key=lambda one: abs(condition.of(one[0])))
        for tries_left, (near, part) in zip(reversed(range(len(parts))), by_distance, strict=True):
            try:
                solution = newton.solve(part.problem, near.x, newton.Control(np.eye(4)[k], value))
                break
            except NotConverged:
                if not tries_left:
                    raise
        weights, s = self.metric.weights * near.rates, near.arclength + abs(condition.of(near))
        return part.problem, make_point(part.problem, solution, self.metric, weights, s), 0.0

    def _chosen(self, coordinate: str, value: float, branch: str | None) -> str:
        """Name of the branch that is asked for, if it has the value, or of the only one that has."""
        ranges, unit = self.branches(coordinate), COORDINATES[coordinate][1]
        if branch and branch not in ranges and not (branch in ENDS and WHOLE in ranges):
            raise InputError(
                f'branch = "{branch}" is none of {", ".join(ranges)} of the {coordinate}; take one of these'
            )
        names = [branch] if branch in ranges else list(ranges)
        having = [name for name in names if ranges[name][0] <= value <= ranges[name][1]]
        if len(having) > 1:
            raise InputError(
                f"{coordinate} = {value:g} {unit} is met on {', '.join(having)}, limit: one; name it by branch"
            )
        if not having:
            low, high = min(ranges[name][0] for name in names), max(ranges[name][1] for name in names)
            where = f"on {names[0]}" if len(names) == 1 else "on this curve"
            raise InputError(
                f"{coordinate} = {value:g} is outside {low:.6g} <= {coordinate} <= {high:.6g} {unit} {where}; take one "
                "inside"
            )
        return having[0]

    def _errors(self, problem: Traceable, point: Point, part: float) -> Array:
        """Errors of the observables in the plane across the path, (4,); nan where there is nothing to compare with.

        They are a part of the largest change along a chain of discretisations; infinite where one of these has no such
        state.
        """
        try:
            steps = self._steps(problem, point)
        except NotConverged:
            return _unbounded(point)
        return self._in_plane(problem, point, part * _largest(steps))

    def _steps(self, problem: Traceable, point: Point) -> Sequence[Array]:
        """Changes of the observables from each discretisation of a chain to the next, (steps, 4) for every chain.

        NotConverged if one of these has no such state.
        """
        if any(problem is one for one in self.left_behind):
            raise NotConverged("the finest grid has no state near this one; take a larger rtol")
        found = [[again(problem, point)[1].observables for again in way[:-1]] for way in self.ways]
        return [np.diff([*others, point.observables], axis=0) for others in found]

    def _in_plane(self, problem: Traceable, point: Point, change: Array) -> Array:
        """Errors in the plane by changes there, (4,)."""
        here = point.observables
        if not self.ways:
            return np.full(4, np.nan)
        errors = change + rounding(problem, point.x)
        if len(self.ways) == 1:
            untold, rates = problem.untold(point.x), point.rates
            doubt = max(untold[CENTRAL_GAP] - errors[CENTRAL_GAP], 0.0)  # the plane goes with it
            errors += np.abs(rates) * (self.metric.weights[CENTRAL_GAP] * abs(rates[CENTRAL_GAP]) * doubt)
            errors = np.fmax(errors, untold)
        return np.where(np.isnan(errors), np.abs(here), errors)  # a contact that only one discretisation has

    def _errors_given(self, k: int, problem: Traceable, point: Point, bend: float) -> Array:
        """Errors where an observable is prescribed: those in the plane and those by a shift along the path, (4,).

        What a change of the others in the plane owes to that of the prescribed one, as all do to that of a gap, which
        errs most, a shift takes back; but for what the path's bend, or the gap's ripple, adds to it. On a single chain,
        where one change may be small by accident, both count in full.
        """
        steps, part, rates = self._steps(problem, point), max(self.remaining, 1.0), point.rates
        change = part * _largest(steps)
        errors = self._in_plane(problem, point, change)
        whole, straight = shift(errors[k], abs(rates[k]), bend), change[k] / abs(rates[k])
        if len(self.ways) > 1 and whole > straight:
            back = part * _largest([step - np.outer(step[:, k], rates / rates[k]) for step in steps])
            rest = self._in_plane(problem, point, back) + np.abs(rates) * (whole - straight)
            errors = np.minimum(errors + np.abs(rates) * whole, rest)
        else:
            errors = errors + np.abs(rates) * whole
        errors[k] = rounding(problem, point.x)[k]
        return errors


def _unbounded(point: Point) -> Array:
    """Errors at a point that another discretisation does not have, (4,)."""
    return np.where(np.isnan(point.observables), np.nan, np.inf)


def _known(numbers: Array, otherwise: Array) -> Array:
    """Numbers, others in the place of those that are nan."""
    return np.where(np.isnan(numbers), otherwise, numbers)


def _largest(steps: Sequence[Array]) -> Array:
    """Sum of the changes along a chain, the largest of all chains, (4,)."""
    return np.asarray(np.max([np.sum(np.abs(chain), axis=0) for chain in steps], axis=0)) if steps else np.zeros(4)


def shift(change: float, rate: float, bend: float) -> float:
    """Bound of the arclength that takes a change of a coordinate back, which has a rate and a second derivative.

    Towards a fold the root of rate s - bend s^2/2 = change, past it, where there is none, that of bend s^2/2 = change.
    """
    inside = rate**2 - 2 * bend * change
    return float(2 * change / (rate + np.sqrt(inside)) if inside > 0 else np.sqrt(2 * change / bend))


ENDS = ("separated", "contact")
WHOLE = "whole"


def _names(count: int) -> Sequence[str]:
    """Names of branches in order: of one that is the whole curve, of two that meet, or with unstable ones between."""
    if count < 3:
        return ENDS if count == 2 else (WHOLE,)
    inner = ["unstable"] if count == 3 else [f"unstable {i + 1}" for i in range(count - 2)]
    return (ENDS[0], *inner, ENDS[1])


def require_coordinate(name: str) -> str:
    """Return the name of a coordinate, or raise InputError if there is none of that name."""
    if name not in COORDINATES:
        raise InputError(f'coordinate = "{name}" is none of {", ".join(COORDINATES)}; take one of these')
    return name


def finest_curve(
    segments: Sequence[Segment], ways: Ways, remaining: float, metric: Metric, folds: Callable[[], Sequence[Located]]
) -> FinestCurve:
    """Solve for the points of a curve on the finest discretisation; without any the curve stays as it is.

    The segments are of the curve on any discretisation; the rest is as of `FinestCurve`, the ways leading to the
    finest. A point that cannot be solved for there stays where it is.
    """
    if not ways:
        return FinestCurve(tuple(segments), ways, math.nan, metric, folds)
    found, left_behind = list[tuple[Traceable, Point]](), dict[int, Traceable]()
    for problem, point in ((segment.problem, point) for segment in segments for point in segment.points):
        try:
            found.append(ways[0][-1](problem, point))
        except NotConverged:
            found.append((problem, point))
            left_behind[id(problem)] = problem
    runs = [list(run) for _, run in groupby(found, key=lambda one: id(one[0]))]
    finest: list[Segment] = []
    for run in runs:
        before = finest[-1].points[-1] if finest else None
        finest.append(measured(run[0][0], [point for _, point in run], metric, before))
    return FinestCurve(tuple(finest), ways, remaining, metric, folds, tuple(left_behind.values()))


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
        step = float(place - a.arclength)
        guess = hermite(problem, a, b, step / (b.arclength - a.arclength), metric)
        yield correct(problem, a, step, guess, metric, iterations=20)
