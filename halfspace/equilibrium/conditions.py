"""Conditions on a state of the path, and the states that meet them, each found by solving for it on the path.

A fold in the approach is where d(alpha*)/ds vanishes along the path, an extremum of the load where dW/ds does. The
corrector runs at every trial of the root finder; nothing is interpolated between samples of the curve.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import final

import numpy as np

from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.equilibrium.newton import Control, Traceable
from halfspace.equilibrium.path import (
    PATH,
    Metric,
    Point,
    Steps,
    correct,
    follow,
    grows_from_afar,
    least_slope,
    make_point,
    plane_across,
    solved_point,
)
from halfspace.errors import Unsolved, required, tried
from halfspace.roots import sought
from halfspace.values import Array, Valued

ROUND_OFF = 1e-11  # what Newton's method, root finder and matrices leave, relative to 1 + the sizes of the terms


@dataclass(frozen=True)
class ConditionSettings:
    """Numbers by which states that meet a condition are searched."""

    shortest: float = 1e-12  # arclength to which a root is known
    shorter: int = 4  # steps in the place of one that hides a pair of roots
    leap: float = 1e-3  # of what should vanish, in its largest value around: more is left where states leap
    long: float = 0.05  # arclength in which a rate that nearly vanishes at an end may do so twice
    solved: float = 3e-9  # relative size of the last step: after 1e-8 loads that should be zero were up to 3e-11
    nearby: float = 0.3  # arclength within which an event is looked for on another discretisation at once
    farthest: float = 1.0  # arclength to which the path is followed there to find it
    points: int = 60  # of that path at most; 24 on a clamped block at a spike of 0.03 beta
    past: float = 1.5  # how far past it the first step aims, in secants
    widths: tuple[float, ...] = (0.1, 0.03, 0.01, 0.003)  # of the parabolas, in arclength


LOCATE = ConditionSettings()


@dataclass(frozen=True)
class Condition:
    """What vanishes at an event: an observable less a value or, if it is stationary, its rate d/ds along the path.

    With a compliance the observable is taken at the far end of a spring that bears the load: the approach and a
    compliance 1/k make the base of an apparatus of stiffness k. The observable is one of APPROACH, LOAD, CENTRAL_GAP
    and CONTACT_RADIUS; the compliance is in eps/(R dgamma) for the approach.
    """

    observable: int
    stationary: bool = False
    value: float = 0.0
    compliance: float = 0.0

    @property
    def weights(self) -> Array:
        """Weights (4,) of the observables in the one at the far end of the spring."""
        weights = np.zeros(4)
        weights[LOAD] = self.compliance
        weights[self.observable] += 1.0
        return weights

    def of(self, point: Point) -> float:
        """Quantity whose root is sought."""
        return self.rate(point) if self.stationary else self.level(point) - self.value

    def rate(self, point: Point) -> float:
        """Rate of the observable at the far end of the spring."""
        return float(point.rates[self.observable] + self.compliance * point.rates[LOAD])

    def level(self, point: Point) -> float:
        """Observable at the far end of the spring."""
        return float(point.observables[self.observable] + self.compliance * point.observables[LOAD])


@dataclass(frozen=True)
class Steepest(Condition):
    """Where the curve falls most steeply: the first place to jump with a softer apparatus, or under a fold's birth."""

    observable: int = APPROACH

    def of(self, point: Point) -> float:
        """Compliance -d(alpha*)/dW in eps/(R dgamma) of the apparatus that would jump here; infinite where W rises."""
        return float(compliance(point.rates[APPROACH], point.rates[LOAD]))


def compliance(approach: Array, load: Array) -> Array:
    """-d(alpha*)/dW from the rates of approach and load along the path; infinite where the load rises."""
    return np.where(np.less(load, 0), approach / -np.minimum(load, -TINY), np.inf)


TINY = 1e-300
FOLD = Condition(APPROACH, stationary=True)
STEEPEST = Steepest()
EXTREMUM = Condition(LOAD, stationary=True)
ZERO_LOAD = Condition(LOAD)


@final
@dataclass(frozen=True, eq=False, repr=False)
class Located(Valued):
    """A root of a condition on one discretisation's path.

    The point has converged; the slope is the derivative along the path of what vanishes, to start a root finder from.
    By so much arclength, `left`, the root is not known: that of a rate is where it vanishes but for rounding. If a
    grid that stands still lost it, or turned the path there itself, it is `followed`: it keeps to grids that follow the
    contact.
    """

    condition: Condition
    problem: Traceable
    point: Point
    slope: float
    left: float = 0.0
    followed: bool = False

    @property
    def rounding(self) -> Array:
        """What rounding leaves of the observables, (4,)."""
        return rounding(self.problem, self.point.x) + self.left * np.abs(self.point.rates)


def rounding(problem: Traceable, x: Array) -> Array:
    """What rounding leaves of the observables of a state, (4,): it is of the terms, however much of these cancels."""
    return ROUND_OFF * (1 + problem.interface.sizes(problem.surface_state(x)))


def locate(problem: Traceable, points: Sequence[Point], metric: Metric, condition: Condition) -> list[Located]:
    """Find every root of a condition between successive points of one discretisation's path, or raise NotConverged."""
    pairs = brackets(problem, points, metric, condition)
    return [required(between(problem, a, b, condition, metric)) for a, b in pairs]


def brackets(
    problem: Traceable, points: Sequence[Point], metric: Metric, condition: Condition
) -> list[tuple[Point, Point]]:
    """Find every pair of points, the second reached from the first, between which a condition has a root."""
    return [
        (c, d)
        for a, b in pairwise(points)
        if b.arclength > a.arclength  # points solved for again may change places
        for c, d in _watched(problem, a, b, condition, metric)
        if _changes(c, d, condition) and not _unfelt(c, d, condition)
    ]


def _changes(a: Point, b: Point, condition: Condition) -> bool:
    """Whether what should vanish changes its sign: the product would be zero at a root, and where it underflows."""
    return (condition.of(a) < 0) != (condition.of(b) < 0)


def _watched(
    problem: Traceable, a: Point, b: Point, condition: Condition, metric: Metric, depth: int = 8
) -> list[tuple[Point, Point]]:
    """Halve the interval between two points as long as a pair of roots may hide in it, unseen at its ends.

    Of a value that an observable comes near to and goes away from, the roots are on the two sides of where that turns.
    """
    if _comes_near(a, b, condition):
        turn = between(problem, a, b, replace(condition, stationary=True), metric)
        return [(a, turn.point), (turn.point, seen_from(turn.point, b, metric))] if turn else [(a, b)]
    if not depth or not _may_hide(a, b, condition, metric):
        return [(a, b)]
    middle = part_way(problem, a, b, 0.5, metric)
    points = [a, middle] if middle else required(wound(problem, a, b, metric))[:-1]
    points.append(seen_from(points[-1], b, metric))
    return [pair for c, d in pairwise(points) for pair in _watched(problem, c, d, condition, metric, depth - 1)]


def seen_from(a: Point, b: Point, metric: Metric) -> Point:
    """A point with its arclength as `correct` measures it from another, along the tangent of that."""
    return replace(b, arclength=a.arclength + metric.step(a, b))


def wound(problem: Traceable, a: Point, b: Point, metric: Metric) -> list[Point] | Unsolved:
    """Points from one to the first past another, by shorter steps, where the curve winds too much for one."""
    step, past = (b.arclength - a.arclength) / LOCATE.shorter, metric.weights * b.rates

    def beyond(point: Point) -> bool:
        return bool(past[:3] @ (point.observables - b.observables)[:3] >= 0)

    return follow(problem, a, metric, beyond, steps=Steps(first=step, longest=step))


def _may_hide(a: Point, b: Point, condition: Condition, metric: Metric) -> bool:
    """Whether a rate nearly vanishes at an end of a long interval, or inside it by the cubic through both points."""
    first, last, length = condition.of(a), condition.of(b), b.arclength - a.arclength
    if not condition.stationary or first * last <= 0 or _unfelt(a, b, condition):
        return False
    mean = (condition.level(b) - condition.level(a)) / length
    if condition.observable == LOAD and grows_from_afar(*(slope / metric.load for slope in (first, last, mean))):
        return False
    little = PATH.nearly * max(abs(first), abs(last))
    inside = least_slope(first, last, mean)
    return inside < little or (length > LOCATE.long and min(abs(first), abs(last)) < little)


def _comes_near(a: Point, b: Point, condition: Condition) -> bool:
    """Whether an observable may go to a value and come back from it between two points."""
    if condition.stationary or _changes(a, b, condition):
        return False
    first, last = condition.of(a), condition.of(b)
    reach = (b.arclength - a.arclength) * max(abs(condition.rate(a)), abs(condition.rate(b)))
    return first * condition.rate(a) < 0 < last * condition.rate(b) and min(abs(first), abs(last)) < reach


def _unfelt(a: Point, b: Point, condition: Condition) -> bool:
    """Whether what should be stationary between two points is nothing at all at both."""
    return condition.stationary and max(abs(condition.of(a)), abs(condition.of(b))) < PATH.unfelt


def between(problem: Traceable, a: Point, b: Point, condition: Condition, metric: Metric) -> Located | Unsolved:
    """Find the root between two points of which the second was reached from the first.

    Newton's method on the equilibrium together with the condition finds it from where the cubics through both points
    have it. Where that does not end between them, as where the contact edge runs over nodes that stand still, so does
    halving the interval at worst, with the corrector at every trial.
    """
    length, part = b.arclength - a.arclength, _by_cubic(a, b, condition, metric)
    if part is not None:
        found = _solved(problem, condition, hermite(problem, a, b, part, metric), metric, a, length)
        if found and all(metric.distance(found.point, end) <= length for end in (a, b)):
            return found
    trials: dict[float, Point | Unsolved] = {0.0: a, 1.0: b}

    def quantity(part: float) -> float:
        if part not in trials:
            trials[part] = part_way(problem, a, b, part, metric)
        point = trials[part]
        return condition.of(point) if point else math.nan

    root = sought(quantity, 0.0, 1.0, "an event; take a smaller rtol", xtol=LOCATE.shortest / abs(length), rtol=1e-14)
    point = root if isinstance(root, Unsolved) else trials[root]
    if not point:
        return point
    leap = max(LOCATE.leap, 2 * LOCATE.shortest / abs(length))  # what the root finder leaves of a short interval
    if abs(condition.of(point)) > leap * max(abs(condition.of(a)), abs(condition.of(b))) + ROUND_OFF:
        return Unsolved(
            f"an event near approach {a.observables[0]:.6g} eps, load {a.observables[1]:.6g} R dgamma is lost: states "
            "next to each other lie on different branches; take a smaller rtol"
        )
    return Located(condition, problem, point, (condition.of(b) - condition.of(a)) / length)


def _by_cubic(a: Point, b: Point, condition: Condition, metric: Metric) -> float | None:
    """Part of the way between two points at which a condition vanishes on the cubic through both; None on neither."""
    length, level, slope = b.arclength - a.arclength, condition.level, condition.rate
    first, last = length * slope(a), length * slope(b) / metric.along(a, b)
    rise = level(b) - level(a)
    cubic = [first + last - 2 * rise, 3 * rise - 2 * first - last, first, level(a) - condition.value]
    found = np.roots(np.polyder(cubic) if condition.stationary else cubic)
    inside = [float(t.real) for t in found if abs(t.imag) < 1e-9 and 0 <= t.real <= 1]
    return inside[0] if inside else None


def _solved(
    problem: Traceable, condition: Condition, start: Array, metric: Metric, near: Point, reach: float
) -> Located | Unsolved:
    """Solve for a state that meets a condition from a start near a point, no farther from it than the reach."""
    direction, slope, left = metric.weights * near.rates, None, 0.0
    if condition.stationary:
        turn = newton.turning_point(problem, start, condition.weights, direction, reach)
        solution, slope, left = turn or (turn, None, 0.0)
    else:
        control = Control(condition.weights, condition.value)
        solution = newton.attempt(problem, start, control, tolerance=LOCATE.solved)
    if not solution:
        return solution
    used = direction != 0
    step = float(direction[used] @ (solution.observables - near.observables)[used])
    point = make_point(problem, solution, metric, direction, near.arclength + step)
    if metric.distance(point, near) > reach or metric.along(near, point) <= 0:
        return Unsolved("the state found lies on another part of the path; take a smaller rtol")
    return Located(condition, problem, point, condition.rate(point) if slope is None else slope, left)


def part_way(problem: Traceable, a: Point, b: Point, part: float, metric: Metric) -> Point | Unsolved:
    """Solve for the point at a part of the way between two points of which the second was reached from the first."""
    return correct(problem, a, part * (b.arclength - a.arclength), metric, hermite(problem, a, b, part, metric))


def hermite(problem: Traceable, a: Point, b: Point, t: float, metric: Metric) -> Array:
    """State between two points, from the cubic through both with their tangents; gaps stay positive.

    It is a cubic in the arclength as it is measured between them, along the tangent of the first.
    """
    h = b.arclength - a.arclength
    x = (
        (1 + 2 * t) * (1 - t) ** 2 * a.x
        + t**2 * (3 - 2 * t) * b.x
        + h * t * (1 - t) * ((1 - t) * a.tangent - t * b.tangent / metric.along(a, b))
    )
    return np.asarray(a.x + problem.longest_step(a.x, x - a.x) * (x - a.x))


def relocate(
    event: Located, problem: Traceable, start: Array, metric: Metric, most_points: int = LOCATE.points
) -> Located | Unsolved:
    """Solve for an event again on another discretisation, from a state transferred to it.

    Unsolved if the event does not exist near `start` on that discretisation, or within so many points along the path.
    """
    condition = event.condition
    if isinstance(condition, Steepest):
        nearby = same_place(event.point, problem, start, metric)
        return nearby and steepest_from(problem, nearby, metric, LOCATE.widths[1:])
    found = _solved(problem, condition, start, metric, event.point, LOCATE.nearby)
    return found if found and found.slope * event.slope > 0 else _searched(event, problem, start, metric, most_points)


def _searched(event: Located, problem: Traceable, start: Array, metric: Metric, most_points: int) -> Located | Unsolved:
    """Solve for an event farther off: in the plane across the path first, then along it to beyond the event."""
    condition, here = event.condition, same_place(event.point, problem, start, metric)
    if not here:
        return here
    ahead = -condition.of(here) / event.slope
    if abs(ahead) < LOCATE.shortest:
        return Located(condition, problem, here, event.slope)
    way = here if ahead > 0 else _turned(here)

    def beyond(point: Point) -> bool:
        return _changes(way, point, condition) or point.arclength - way.arclength > LOCATE.farthest

    steps = Steps(first=min(LOCATE.past * abs(ahead), LOCATE.nearby), longest=LOCATE.nearby)
    points = tried(follow, problem, way, metric, beyond, steps=steps, max_points=most_points)
    if isinstance(points, Unsolved):
        return points
    if not _changes(way, points[-1], condition):
        at = event.point.observables
        return Unsolved(
            f"the event at approach {at[0]:.6g} eps, load {at[1]:.6g} R dgamma is not found again on another grid; "
            "take a smaller rtol"
        )
    found = between(problem, points[-2], points[-1], condition, metric)
    if not found or metric.along(event.point, found.point) > 0:
        return found
    slope = found.slope if condition.stationary else -found.slope  # of a rate both it and the arclength change sign
    back = replace(_turned(found.point), arclength=2 * way.arclength - found.point.arclength)
    return replace(found, point=back, slope=slope)


def _turned(point: Point) -> Point:
    """The same point of the path that goes the other way."""
    return replace(point, tangent=-point.tangent, rates=-point.rates)


def steepest_from(
    problem: Traceable, point: Point, metric: Metric, widths: Sequence[float] = LOCATE.widths
) -> Located | Unsolved:
    """Where the curve falls most steeply near a point: the least compliance, by parabolas ever narrower."""
    for width in widths:
        sides = [correct(problem, point, h, metric) for h in (-width, width)]
        before, here, after = (STEEPEST.of(p) if p else math.nan for p in (sides[0], point, sides[1]))
        bend = before - 2 * here + after
        if not (np.isfinite(bend) and bend > 0):
            return Unsolved("the curve has no steepest fall here; take a smaller rtol")
        step = float(np.clip((before - after) / (2 * bend), -3, 3)) * width
        found = correct(problem, point, step, metric)
        if not found:
            return found
        point = found
    return Located(STEEPEST, problem, point, 1.0)


def same_place(point: Point, problem: Traceable, start: Array, metric: Metric) -> Point | Unsolved:
    """Solve on another discretisation in the plane across the path at a given point."""
    across, weights = plane_across(point, metric)
    return solved_point(problem, start, across, metric, weights, point.arclength)
