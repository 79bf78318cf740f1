"""Which events a traced curve has: its deepest load, its folds, its zero load, each solved for where it was met."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import NoReturn

import numpy as np

from halfspace.equilibrium.charts import metric_for
from halfspace.equilibrium.conditions import (
    EXTREMUM,
    FOLD,
    STEEPEST,
    ZERO_LOAD,
    Condition,
    Located,
    between,
    brackets,
    compliance,
    locate,
    part_way,
    seen_from,
    steepest_from,
    wound,
)
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, WIDEST
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Metric, Point, Segment, correct
from halfspace.errors import ContactTooWide, HeldApart, NotConverged, Unsolved, required
from halfspace.scales import BRADLEY

Bracket = tuple[Traceable, Point, Point]


@dataclass(frozen=True)
class SearchSettings:
    """Numbers by which the events of a curve are searched."""

    behind: tuple[float, float] = (1e-6, 0.1)  # arclengths by which one discretisation may be behind another
    deep: float = 0.1  # of the deepest load by the cubics: others as deep are solved for as well
    same: float = 1e-6  # of approach, load and central gap, what two turns differ by where they are two
    in_doubt: float = 0.02  # eps/(R dgamma), a least -d(alpha*)/dW: the Tabor parameter is 0.65 to 0.74 then
    astray: float = 0.1  # of a compliance in doubt, by which the curve's is another than that of the cubics to rely on
    most: int = 40  # points put between those of a curve


FIND = SearchSettings()


def states(segments: Sequence[Segment], condition: Condition) -> list[Located]:
    """Every state of a traced curve that meets a condition, in order."""
    return [state for one in brackets_of(segments, condition) for state in required(with_care(one, condition))]


def brackets_of(segments: Sequence[Segment], condition: Condition) -> list[Bracket]:
    """Discretisation and pair of points for every state that meets a condition, in order."""
    metric = metric_for(segments[0].problem)
    return [
        (segment.problem, a, b)
        for segment, after in zip_longest(segments, segments[1:])
        for a, b in brackets(segment.problem, _to_hand_over(segment, after, condition, metric), metric, condition)
    ]


def _to_hand_over(segment: Segment, after: Segment | None, condition: Condition, metric: Metric) -> Sequence[Point]:
    """Points of a segment, and one more where the next discretisation begins beyond a state that this has not met."""
    last, problem = segment.points[-1], segment.problem
    if after is None or (condition.of(last) < 0) == (condition.of(after.points[0]) < 0):
        return segment.points
    for step in np.geomspace(*FIND.behind, 8):
        point = correct(problem, last, step, metric)
        if point and (condition.of(point) < 0) != (condition.of(last) < 0):
            return (*segment.points, point)
    return segment.points


def _state(bracket: Bracket, condition: Condition) -> Located:
    problem, a, b = bracket
    return required(between(problem, a, b, condition, metric_for(problem)))


def _deepest(brackets: Sequence[Bracket]) -> Located:
    """Of the extrema of the load the deepest, where the cubics through the points beside it do not leave it open."""
    expected = sorted((_least_load(a, b), i) for i, (_, a, b) in enumerate(brackets))
    found = [
        _state(brackets[i], EXTREMUM) for low, i in expected if low <= expected[0][0] + FIND.deep * abs(expected[0][0])
    ]
    return min(found, key=lambda e: float(e.point.observables[LOAD]))


def _least_load(a: Point, b: Point) -> float:
    """Least load between two points, about, by the cubic through them."""
    t, h = np.linspace(0, 1, 9), b.arclength - a.arclength
    (f, df), (g, dg) = ((float(p.observables[LOAD]), h * float(p.rates[LOAD])) for p in (a, b))
    cubic = f + t**2 * (3 - 2 * t) * (g - f) + t * (1 - t) * ((1 - t) * df - t * dg)
    return float(np.min(cubic))


def find_events(segments: Sequence[Segment]) -> dict[str, Located]:
    """Solve for the events of a traced curve and name them.

    They are ``pull_off`` (the deepest minimum of the load), ``jump_on`` (the first fold from separation), ``jump_off``
    (the first from compression), ``zero_load``, and the two states between which the energy is taken, ``separated`` and
    ``zero_approach``. NotConverged if the curve ends before one of those that it must have: for want of body, it is a
    ContactTooWide; as HeldApart if the surfaces do not touch.
    """
    _require_touching(segments)
    separated = segments[0].problem.interface.scales.separated_approach

    def required(name: str, condition: Condition) -> list[Bracket]:
        return brackets_of(segments, condition) or _missing(segments[-1], name)

    folds = brackets_of(segments, FOLD)
    found = {"pull_off": _deepest(required("pull_off", EXTREMUM))}
    if folds:
        found |= {"jump_on": _state(folds[0], FOLD), "jump_off": _state(folds[-1], FOLD)}
    far = Condition(APPROACH, value=separated)
    found["separated"] = _state(required("separation", far)[0], far)
    for name, condition in (("zero_load", ZERO_LOAD), ("zero_approach", Condition(APPROACH))):
        found[name] = _state(required(name, condition)[-1], condition)
    return found


def _require_touching(segments: Sequence[Segment]) -> None:
    """Raise HeldApart if a barrier, or a second minimum farther out, holds the surfaces apart to the curve's end."""
    law, last = segments[0].problem.interface.law, segments[-1].points[-1].observables
    if law.outermost and last[CENTRAL_GAP] > law.innermost:
        raise HeldApart(
            f"the law holds the surfaces {last[CENTRAL_GAP]:.3g} eps apart at the curve's end, load {last[LOAD]:.3g} "
            f"R dgamma, limit: {law.innermost:.3g} eps in contact; take a larger to_load"
        )


def with_care(bracket: Bracket, condition: Condition) -> list[Located] | Unsolved:
    """State between two points, or those that shorter steps between them find where its own search does not end."""
    problem, a, b = bracket
    metric = metric_for(problem)
    found = between(problem, a, b, condition, metric)
    if found:
        return [found]
    points = wound(problem, a, b, metric)
    return locate(problem, points, metric, condition) if isinstance(points, list) else points


Chains = Sequence[Sequence[Located]]
"""A state on discretisations that differ in one respect from one to the next, all chains ending with the finest."""


Turn = tuple[Point, Located | None]
"""About where an observable turns, and the state; None where it is not pinned down."""


def turns(segments: Sequence[Segment], condition: Condition, inner: slice = slice(None)) -> list[Turn]:
    """Where an observable turns along the curve as it was traced, in order."""
    found: list[Turn] = []
    for bracket in brackets_of(segments, condition)[inner]:
        states = with_care(bracket, condition)
        found += [(turn.point, turn) for turn in states] if states else [(bracket[1], None)]
    return found


def confirmed(
    traced: Sequence[Turn], solve: Callable[[Located], Chains | Unsolved], known: Sequence[Located] = ()
) -> tuple[list[Chains], list[Point]]:
    """Turns of a curve that every discretisation has, on each of these, and about where the rest are.

    This decides what a turn is, for the events and for the branches in approach, load and central gap alike. Along the
    curve least and largest values follow each other, so that one that is lost takes its neighbour with it. A ripple of
    one grid is lost on another, or becomes another turn; those known are no new ones. The first and the last of the
    known, if there are any, are the turns before and after those sought.
    """
    kept: list[Chains] = []
    lost: list[Point] = []
    found = [(point, solve(turn) if turn else []) for point, turn in traced]
    own = [turn.slope for _, turn in traced if turn]
    if not own:
        return [], [point for point, _ in found]
    before, last = (-known[0].slope, known[-1].slope) if known else (own[0], -own[-1])
    for point, chains in found:
        fine = chains[0][-1] if chains else None
        others = (*known, *(one[0][-1] for one in kept))
        if chains and fine and fine.slope * before > 0 and not any(_same_turn(fine, other) for other in others):
            kept.append(chains)
            before = -before
        else:
            lost.append(point)
    if kept and before * last < 0:
        lost.append(kept.pop()[0][-1].point)
    return kept, lost


def _same_turn(a: Located, b: Located) -> bool:
    """Whether two turns of an observable are one and the same."""
    first, second = a.point.observables[:CONTACT_RADIUS], b.point.observables[:CONTACT_RADIUS]
    return bool(np.all(np.abs(first - second) < FIND.same * (1 + np.abs(second))))


def _missing(segment: Segment, event: str) -> NoReturn:
    """Say why a curve ends before an event."""
    last, body = segment.points[-1].observables, segment.problem.interface.profile.end
    radius = last[CONTACT_RADIUS]
    if not radius >= WIDEST * body:
        raise NotConverged(
            f"the curve has no {event} before it ends at approach {last[APPROACH]:.6g} eps, load {last[LOAD]:.6g} "
            "R dgamma; take a larger to_load or a smaller rtol"
        )
    raise ContactTooWide(
        f"contact radius {radius:.3g} beta exceeds {WIDEST:g} of the body's radius, {body:.3g} beta, before {event} is "
        "reached; take a larger radius_ratio or a smaller tabor"
    )


def energy_released(before: Located, after: Located) -> float:
    """Energy between two states, as ``separated`` and ``zero_approach`` of `find_events`, in R dgamma eps."""
    return before.problem.energy(before.point.x) - after.problem.energy(after.point.x)


def energy_size(state: Located) -> float:
    """Sum of the sizes of the terms of a state's energy, which may cancel, in R dgamma eps."""
    return state.problem.interface.energy_size(state.problem.surface_state(state.point.x))


def _least_compliance(a: Point, b: Point) -> tuple[float, float]:
    """Least compliance between two points, by the cubics of approach and load, and the part of the way to it."""
    t, h = np.linspace(0, 1, 17), b.arclength - a.arclength
    slopes = (
        np.outer(1 - 4 * t + 3 * t**2, a.rates)
        + np.outer(3 * t**2 - 2 * t, b.rates)
        + np.outer(6 * t * (1 - t), (b.observables - a.observables) / h)
    )
    compliances = compliance(slopes[:, APPROACH], slopes[:, LOAD])
    least = int(np.argmin(compliances))
    return float(compliances[least]), float(t[least])


def folds_in_doubt(segments: Sequence[Segment]) -> dict[str, Located]:
    """Where the curve falls most steeply, if two folds there are about to merge or to be born; nothing otherwise."""
    metric = metric_for(segments[0].problem)
    in_doubt = FIND.in_doubt * BRADLEY / metric.load
    falls = [(*_least_compliance(a, b), s.problem, a, b) for s in segments for a, b in pairwise(s.points)]
    for _ in range(FIND.most):
        fall = min(falls, key=lambda one: one[0])
        least, part, problem, a, b = fall
        if abs(least) >= in_doubt:
            return {}
        point = required(part_way(problem, a, b, part, metric)) if part else a
        if abs(STEEPEST.of(point) - least) < FIND.astray * in_doubt:
            return {"steepest": required(steepest_from(problem, point, metric))}
        falls.remove(fall)  # the curve does not fall as steeply there as the cubics have it
        pairs = (a, point), (point, seen_from(point, b, metric))
        falls += [(*_least_compliance(c, d), problem, c, d) for c, d in pairs]
    raise NotConverged("where the curve falls most steeply is not found; take a smaller rtol")
