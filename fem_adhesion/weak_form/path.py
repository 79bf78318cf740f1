"""The path of equilibria through the folds: Newton's method with a border, pseudo-arclength, and the events on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, newton

from fem_adhesion.weak_form.body import Array
from fem_adhesion.weak_form.problem import Problem
from halfspace.errors import NotConverged
from halfspace.values import Valued

MOST_STEPS = 12  # Newton steps, after which a step along the path is halved
NEAR = 1e-5  # relative change of a gap in the last Newton step; the error after it is about the square
CLOSING = 0.75  # part of a gap that one Newton step may close
USUAL = 5  # Newton steps of a step along the path that suits; the next is longer after fewer
SHORTEST, MOST_POINTS = 1e-6, 1000  # step along the path at which it ends without a curve; points likewise
OPENING = 0.3  # largest part by which the gap on the axis changes in a step, lest it pass by two folds
TURN = 0.5  # least cosine between the tangents at both ends of a step
ROOT = 1e-7  # part of a step along the path within which an event is found
FIRST = 0.5  # first step, in units of the arclength
ASIDE = 1e-3  # arclength to the second state from which an event is sought by the secant


@dataclass(frozen=True, eq=False, repr=False)
class Point(Valued):
    """An equilibrium and the direction of the path there.

    Attributes
    ----------
    x, tangent, row : (n + 1,) array
        State, unit tangent along the path, and the row <tangent, .> of the inner product.
    observables : (4,) array
        Approach, load, central gap, contact radius.
    rates : (3,) array
        Of approach, load and central gap along the path.
    stable : bool
        Whether the state is stable under fixed grips: no eigenvalue of the tangent matrix is negative.
    """

    x: Array
    tangent: Array
    row: Array
    observables: Array
    rates: Array
    stable: bool


def bordered_newton(problem: Problem, x: Array, row: Array, value: float) -> tuple[Array, int]:
    """Solve F(x) = 0 and row x = value, from nearby; also the number of steps taken.

    Each step solves [[A, b], [row]] dx = -[F, row x - value] with A = dF/du and b = dF/dalpha, by two
    back-substitutions. NotConverged if the steps run out.
    """
    for step in range(1, MOST_STEPS + 1):
        h = problem.gap(x)
        factors = problem.tangent(h)
        du, by_approach = factors.solve(-problem.residual(x)), factors.solve(-problem.by_approach(h))
        d = (value - row @ x - row[:-1] @ du) / (row[:-1] @ by_approach + row[-1])
        dx = np.append(du + d * by_approach, d)
        change = problem.gap_change(dx) / h
        x = x + min(1.0, CLOSING / max(float(-change.min()), CLOSING)) * dx
        largest = float(np.abs(change).max())
        if not np.isfinite(largest):
            break
        if largest < NEAR:
            return x, step
    raise NotConverged(f"no equilibrium of the weak form in {MOST_STEPS} Newton steps; try another to_load or tabor")


def point_at(problem: Problem, x: Array, along: Array | None = None) -> Point:
    """Point at an equilibrium; the tangent points the way of a row, or towards contact."""
    h = problem.gap(x)
    factors = problem.tangent(h)
    direction = np.append(factors.solve(-problem.by_approach(h)), 1.0)
    row = problem.row(direction)
    size = np.sqrt(row @ direction)
    if along is not None and along @ direction < 0:
        size = -size
    tangent = direction / size
    dh = problem.gap_change(tangent)
    rates = np.array([tangent[-1], problem.load_rate(h, dh), problem.central_gap(tangent)])
    stable = bool((factors.U.diagonal() > 0).all())
    return Point(x, tangent, row / size, problem.observables(x), rates, stable)


def onward(problem: Problem, a: Point, s: float) -> tuple[Point, int]:
    """Point of the path on the plane at arclength s past a point, and the Newton steps that it took."""
    if s == 0:
        return a, 0
    x, steps = bordered_newton(problem, a.x + s * a.tangent, a.row, float(a.row @ a.x) + s)
    return point_at(problem, x, a.row), steps


def follow(problem: Problem, approach: float, to_load: float) -> list[Point]:
    """Points of the path from an approach of separated surfaces, through every fold, to a compressive load."""
    start, last = np.zeros(problem.free.size + 1), np.zeros(problem.free.size + 1)
    start[-1], last[-1] = approach, 1.0
    points, s = [point_at(problem, bordered_newton(problem, start, last, approach)[0])], FIRST
    while points[-1].observables[1] < to_load:
        if s < SHORTEST or len(points) > MOST_POINTS:
            raise NotConverged(f"the weak form's path ends at alpha = {points[-1].x[-1]:.4g} eps; try a smaller tabor")
        try:
            point, steps = onward(problem, points[-1], s)
        except NotConverged:
            s /= 2
            continue
        before, after = (1 + each.observables[2] for each in (points[-1], point))
        opened = abs(after / before - 1)
        if opened > OPENING or points[-1].row @ point.tangent < TURN or turns_twice(points[-1], point):
            s /= 2
            continue
        points.append(point)
        s *= min(max(USUAL / steps, 0.5), 2.0)
    return points


def turns_twice(a: Point, b: Point) -> bool:
    """Whether approach or load turn and turn back between two points, by the cubics with their values and rates."""
    means = (b.observables - a.observables)[:2] / (a.row @ (b.x - a.x))
    before, after = a.rates[:2], b.rates[:2]
    halfway = 1.5 * means - (before + after) / 4
    return bool(((before * after > 0) & (before * halfway < 0)).any())


def on_finer(problem: Problem, coarse: Problem, points: Sequence[Point]) -> list[Point]:
    """The points of a path solved for on elements of higher degree, each on its plane across the path."""
    found = []
    for point in points:
        x, tangent = (problem.taken_over(coarse, each) for each in (point.x, point.tangent))
        row = problem.row(tangent)
        found.append(point_at(problem, bordered_newton(problem, x, row, float(row @ x))[0], row))
    return found


# Events

Condition = Callable[[Point], float]


def fold(point: Point) -> float:
    """Dalpha/ds, zero at a jump under fixed grips."""
    return float(point.rates[0])


def extremum(point: Point) -> float:
    """dW/ds, zero at a jump under a dead load."""
    return float(point.rates[1])


def unloaded(point: Point) -> float:
    """Load W, zero where nothing pulls or presses."""
    return float(point.observables[1])


CONDITIONS: Mapping[str, Condition] = {"pull_off": extremum, "zero_load": unloaded}  # of all other events: fold


def events_on_finer(problem: Problem, coarse: Problem, found: Mapping[str, Point]) -> dict[str, Point]:
    """The events of a path on elements of higher degree, each by the secant from its place on those of lower degree."""
    carried = zip(found, on_finer(problem, coarse, list(found.values())), strict=True)
    return {name: _moved(problem, point, CONDITIONS.get(name, fold)) for name, point in carried}


def _moved(problem: Problem, near: Point, condition: Condition) -> Point:
    """Point past another, or before it, where a condition is zero."""
    s = newton(lambda s: condition(onward(problem, near, s)[0]), 0.0, x1=ASIDE, tol=ROOT * FIRST, maxiter=MOST_STEPS)
    return onward(problem, near, float(s))[0]


def located(problem: Problem, points: Sequence[Point], condition: Condition) -> list[Point]:
    """All points of the path at which a condition changes its sign, in order.

    Each is a root in the arclength past the point before it; the state is solved for at every trial.
    """
    found = []
    for a, b in pairwise(points):
        if condition(a) * condition(b) < 0:
            length = float(a.row @ (b.x - a.x))
            root = brentq(lambda s, a=a: condition(onward(problem, a, s)[0]), 0.0, length, xtol=ROOT * length)
            found.append(onward(problem, a, root)[0])
    return found


def events(problem: Problem, points: Sequence[Point]) -> dict[str, Point]:
    """Pull-off, zero load in contact, and the folds: jump_on and jump_off the outermost, fold_2 ... between them."""
    folds = located(problem, points, fold)
    extrema = located(problem, points, extremum)
    if not extrema:
        raise NotConverged("the weak form's path has no minimum of the load; give a larger to_load")
    found = {"pull_off": min(extrema, key=unloaded)}
    if len(folds) > 1:
        found |= {"jump_on": folds[0], "jump_off": folds[-1]}
        found |= {f"fold_{n}": point for n, point in enumerate(folds[1:-1], 2)}
    if zeros := located(problem, points, unloaded):
        found["zero_load"] = zeros[-1]
    return found
