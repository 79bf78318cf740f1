"""Pseudo-arclength continuation of an equilibrium along its load-approach curve, through every fold.

Arclength is measured in the space of approach, load and central gap, each in a unit of its own (`Metric`): three
numbers that every discretisation has, so its value does not depend on the grid, nor change where a grid is exchanged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np

from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD
from halfspace.equilibrium.newton import Control, Traceable
from halfspace.errors import ContactTooWide, GridTooCoarse, IllPosed, Unsolved
from halfspace.values import Array, Valued


@dataclass(frozen=True)
class PathSettings:
    """Numbers by which steps along the path are begun, refused and made longer."""

    unfelt: float = 1e-8  # eps or R dgamma in the arclength 1: so far apart that an exponential law is all but nothing
    nearly: float = 0.2  # of the larger of two slopes: one that nearly vanishes
    faint: float = 0.1  # slope in the metric's units, of which the observable is but a tenth of the path
    like: float = 0.8  # of an exponential's mean slope, or as much above; a power law's is 0.9 where it grows eightfold
    turning_margin: float = 0.3  # of the step's length, by which slopes inside it clear zero
    short: float = 0.1  # a step below which the cubic errs by far less than that
    straight: float = 1e-10  # of the slopes: a bend that is rounding
    ratio: float = 4.0  # of a gap to the step by which it closes at most, where that is longer than the longest


PATH = PathSettings()


@dataclass(frozen=True)
class Metric:
    """Units of approach, load and central gap in which the arclength is measured."""

    approach: float
    load: float = 2 * np.pi
    central_gap: float = 2.0

    @cached_property
    def weights(self) -> Array:
        """Inverse squares of the units; the contact radius, which need not exist, has none."""
        return np.array([self.approach**-2, self.load**-2, self.central_gap**-2, 0.0])

    def distance(self, a: Point, b: Point) -> float:
        """Length of the straight line between two points."""
        return math.sqrt(self.weights[:3] @ (b.observables - a.observables)[:3] ** 2)

    def step(self, a: Point, b: Point) -> float:
        """Arclength from one point to another as it is measured along the tangent of the first."""
        return float((self.weights * a.rates)[:3] @ (b.observables - a.observables)[:3])

    def along(self, a: Point, b: Point) -> float:
        """Cosine of the angle between the path at two points."""
        return float(self.weights @ (a.rates * b.rates))


@final
@dataclass(frozen=True, eq=False, repr=False)
class Point(Valued):
    """A converged point x of the path, its observables, unit tangent dx/ds and arclength s from the start of the path.

    The observables (4,) are approach, load, central gap and contact radius, the rates their derivatives by s, that of
    the contact radius 0 where there is none; the iterations are the Newton steps that the point took, and astray is the
    relative size of the first of them.
    """

    x: Array
    observables: Array
    tangent: Array
    rates: Array
    arclength: float
    iterations: int
    astray: float


@dataclass(frozen=True, eq=False, repr=False)
class Segment(Valued):
    """Points of the path in order on one discretisation."""

    problem: Traceable
    points: tuple[Point, ...]


@dataclass(frozen=True)
class Steps:
    """Lengths of the continuation's steps, in arclength, and what they adapt to.

    A step below `shortest` ends the path with an error. `turn` is the angle between the tangents at a step's two ends
    that the next step is to have, in radians; one of twice that is refused. `iterations` are the Newton steps allowed
    for one continuation step, `astray` is the relative size of the first of them if the step is of the right length,
    and `contraction` the part of the Newton step two before that one may have.
    """

    first: float = 0.05
    longest: float = 1.0
    shortest: float = 1e-7
    turn: float = 0.35
    iterations: int = 8
    astray: float = 0.02
    contraction: float = 0.5


def make_point(
    problem: Traceable, solution: newton.Solution, metric: Metric, direction: Array, arclength: float
) -> Point:
    """Attach the unit tangent to a solution, oriented so that it has a positive component along `direction`.

    That (4,) is a covector on the observables: the arclength's gradient at a point nearby.
    """
    tangent = newton.tangent(problem, solution)
    rates = problem.rates(solution.x, tangent)
    length = math.copysign(math.sqrt(metric.weights @ rates**2), direction @ rates)
    along, rates = tangent / length, rates / length
    return Point(solution.x, solution.observables, along, rates, arclength, solution.iterations, solution.astray)


def solved_point(
    problem: Traceable,
    start: Array,
    control: Control,
    metric: Metric,
    direction: Array,
    arclength: float = 0.0,
    **how: Any,
) -> Point | Unsolved:
    """Solve for a point under a control, as of `newton.attempt`, and attach its tangent, as of `make_point`."""
    solution = newton.attempt(problem, start, control, **how)
    return solution and make_point(problem, solution, metric, direction, arclength)


def correct(
    problem: Traceable,
    point: Point,
    step: float,
    metric: Metric,
    guess: Array | None = None,
    *,
    iterations: int = 20,
    contraction: float = np.inf,
) -> Point | Unsolved:
    """Solve for the point of the path at the arclength `step` past `point`, measured along its tangent.

    Newton's method starts from the guess, or else on the tangent.
    """
    start = predict(problem, point, step) if guess is None else guess
    across, weights = plane_across(point, metric, step)
    how = {"max_iterations": iterations, "contraction": contraction}
    return solved_point(problem, start, across, metric, weights, point.arclength + step, **how)


def plane_across(point: Point, metric: Metric, step: float = 0.0) -> tuple[Control, Array]:
    """Control of the plane across the path at a point, or a step past it, and its weights (4,) of the observables."""
    weights = metric.weights * point.rates
    used = weights != 0
    return Control(weights, float(weights[used] @ point.observables[used]) + step), weights


def predict(problem: Traceable, point: Point, step: float, bend: Array | float = 0.0) -> Array:
    """Extrapolate along the tangent, or a slope that has so much more than it."""
    slope = point.tangent + bend
    return np.asarray(point.x + problem.longest_step(point.x, step * slope) * step * slope)


def _bend(before: Point, point: Point, step: float, metric: Metric) -> Array:
    """What the slope up to a step ahead has more than the tangent, by the cubic through the point before with its own.

    It is a cubic in the arclength as the step is measured, along the tangent of the point.
    """
    length = -metric.step(point, before)
    mean, ahead = (point.x - before.x) / length, step / length
    first, last = before.tangent / metric.along(before, point), point.tangent
    return np.asarray(ahead * (first + 2 * last - 3 * mean + ahead * (first + last - 2 * mean)))


def follow(
    problem: Traceable,
    start: Point,
    metric: Metric,
    stop: Callable[[Point], bool],
    *,
    steps: Steps,
    max_points: int = 2000,
) -> list[Point] | Unsolved:
    """Continue the path from a point to the first for which `stop` holds, in steps adapted to its curvature.

    The tangent of the start, which is the first of the points, says in which direction. Unsolved if the step falls
    below the shortest allowed, or the points run out; GridTooCoarse if the contact edge comes to a place where the grid
    is too coarse for the spike of tension there.
    """
    points, step = [start], steps.first
    while len(points) < max_points:
        new = _advance(problem, points, step, metric, steps)
        if not new:
            step /= 3
            if step < steps.shortest:
                at = points[-1].observables
                return Unsolved(
                    f"the path ends at approach {at[0]:.6g} eps, load {at[1]:.6g} R dgamma: no step of "
                    f"{steps.shortest:.0e} or more converges ({new.reason}); take a smaller rtol, or a finer mesh"
                )
            continue
        ended = stop(new)
        if ended and step > steps.shortest and not _carried(problem, new):
            step /= 3  # it leapt over the end into cells that need not carry a contact
            continue
        problem.require_resolution(new.x)
        points.append(new)
        if ended:
            return points
        step = _next_step(step, points, metric, steps)
    return Unsolved(f"the path did not end within {max_points} points; allow more points or longer steps")


def _carried(problem: Traceable, point: Point) -> bool:
    """Whether a discretisation is wide and fine enough for a point, and its equations well-posed there."""
    try:
        problem.require_resolution(point.x)
    except (ContactTooWide, GridTooCoarse, IllPosed):
        return False
    return True


def _advance(
    problem: Traceable, points: Sequence[Point], step: float, metric: Metric, steps: Steps
) -> Point | Unsolved:
    """One step, refused if it leaves what the operator knows, or if the path turns too far for its folds to be seen."""
    point = points[-1]
    guess = predict(problem, point, step, _bend(points[-2], point, step, metric) if len(points) > 1 else 0.0)
    new = correct(problem, point, step, metric, guess, iterations=steps.iterations, contraction=steps.contraction)
    least, _ = problem.interface.operator.served
    if not new or new.observables[CONTACT_RADIUS] < least:
        return new and Unsolved(f"the contact radius is below {least:.3g} beta, the chart's least")
    if max(_turn(point, new, metric), _aside(point, new, metric)) > 2 * steps.turn:
        return Unsolved("the path turns too sharply")
    if any(_hides_turning_points(point, new, k, metric) for k in (APPROACH, LOAD)):
        return Unsolved("the step may leap over a pair of folds")
    return new


def _hides_turning_points(a: Point, b: Point, k: int, metric: Metric) -> bool:
    """Whether an observable may rise and fall between two points at whose tangents it only rises, or only falls.

    Its least slope between them, in the metric's units, must clear zero by a margin that shrinks with the step, and as
    its square where it is short: so a curve that all but folds is passed, and folds are where its slope changes sign.
    No more than a part of the larger slope at the ends is asked for, since curves of soft bodies wind in little; and
    nothing of a load that is faint and grows as an exponential, from afar: a cubic dips there, which it does not.
    """
    if max(abs(a.rates[k]), abs(b.rates[k])) < PATH.unfelt:
        return False
    length, unit = b.arclength - a.arclength, math.sqrt(metric.weights[k])
    first, last = unit * float(a.rates[k]), unit * float(b.rates[k])
    mean = unit * float(b.observables[k] - a.observables[k]) / length
    if k == LOAD and grows_from_afar(first, last, mean):
        return False
    margin = PATH.turning_margin * length * min(1.0, length / PATH.short)
    return least_slope(first, last, mean) < min(margin, PATH.nearly * max(abs(first), abs(last)))


def grows_from_afar(first: float, last: float, mean: float) -> bool:
    """Whether a slope, in the metric's units, is faint and its mean about that of an exponential, the logarithmic."""
    if max(abs(first), abs(last)) >= PATH.faint or first * last <= 0 or first == last:
        return False
    return PATH.like < mean * math.log(last / first) / (last - first) < 1 / PATH.like


def least_slope(first: float, last: float, mean: float) -> float:
    """Least slope inside an interval of the cubic with given end slopes of one sign and mean slope.

    Positive as long as the cubic goes on in the direction of its ends; infinite if it has no least slope inside, or
    the end slopes differ in sign.
    """
    if first * last <= 0:
        return float("inf")
    bend = 6 * (first + last) - 12 * mean
    straight = abs(bend) <= PATH.straight * abs(first + last)
    t = 0.0 if straight else (4 * first + 2 * last - 6 * mean) / bend
    if not 0 < t < 1:
        return float("inf")
    slope = first * (1 - 4 * t + 3 * t**2) + last * (3 * t**2 - 2 * t) + 6 * mean * t * (1 - t)
    return float(slope * np.sign(first))


def _turn(a: Point, b: Point, metric: Metric) -> float:
    """Angle between two tangents in radians."""
    return math.acos(min(1.0, max(-1.0, metric.along(a, b))))


def _aside(a: Point, b: Point, metric: Metric) -> float:
    """Largest angle in radians between the tangents at two points and the straight line from one to the other.

    Beyond a sharp turn, as at the load's least on flat tips, a path taken to go back looks straight by its tangents.
    """
    ahead = min(metric.step(a, b), -metric.step(b, a)) / metric.distance(a, b)
    return math.acos(min(1.0, max(-1.0, ahead)))


def _next_step(step: float, points: list[Point], metric: Metric, steps: Steps) -> float:
    """Lengthen the step while Newton's method and the curvature allow, shorten it where they do not.

    By how much a state predicted by a cubic is astray goes as the fourth power of the step.
    """
    by_turn = steps.turn / max(_turn(points[-2], points[-1], metric), 1e-6)
    by_astray = math.sqrt(math.sqrt(steps.astray / max(points[-1].astray, 1e-12)))
    wide = (1 + float(points[-1].observables[CENTRAL_GAP])) / (PATH.ratio * metric.central_gap)
    return min(step * min(max(by_turn, 0.3), max(by_astray, 0.3), 2.0), steps.longest * max(1.0, wide))
