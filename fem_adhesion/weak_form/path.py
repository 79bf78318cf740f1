"""The path of equilibria through the folds: Newton's method with a border, pseudo-arclength, and the events on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq, newton

from fem_adhesion.weak_form.body import Array
from fem_adhesion.weak_form.problem import Problem
from halfspace.errors import NotConverged
from halfspace.values import Valued

MOST_STEPS = 12  # Newton steps, after which a step along the path is halved
NEAR = 1e-10  # relative change of a gap that a further Newton step would make
TANGENT = 1e-9  # relative error of the tangent of the path
KEPT = 0.1  # of the step before: one that is shorter is followed by one with the same matrix
CLOSING = 0.75  # part of a gap that one Newton step may close
USUAL = 6  # Newton steps of a step along the path that suits; the next is longer after fewer
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


@dataclass(frozen=True, eq=False, repr=False)
class Bordered(Valued):
    """The bordered matrix [[A, b], [row]] at a state, A = dF/du and b = dF/dalpha, in its factors.

    Attributes
    ----------
    factors : SuperLU
        Of A.
    along : (n + 1,) array
        Solution of A u + b alpha = 0 with alpha = 1.
    row : (n + 1,) array
        The border.
    """

    factors: Any
    along: Array
    row: Array

    @classmethod
    def at(cls, problem: Problem, h: Array, row: Array) -> Bordered:
        """The matrix at gaps h."""
        factors = problem.tangent(h)
        return cls(factors, np.append(factors.solve(-problem.by_approach(h)), 1.0), row)

    @cached_property
    def negative(self) -> int:
        """Number of negative eigenvalues of A."""
        return int((self.factors.U.diagonal() < 0).sum())

    def solve(self, F: Array, value: float) -> Array:
        """Solve A u + b alpha = F with row x = value, by a back-substitution."""
        x = np.append(self.factors.solve(F), 0.0)
        return np.asarray(x + (value - self.row @ x) / (self.row @ self.along) * self.along)


def bordered_newton(problem: Problem, x: Array, row: Array, value: float) -> tuple[Array, Bordered, int]:
    """Solve F(x) = 0 and row x = value, from nearby; also the last matrix and the number of steps taken.

    While each step is much shorter than the one before, the next is taken with the same matrix. NotConverged if the
    steps run out.
    """
    matrix: Bordered | None = None
    for step in range(1, MOST_STEPS + 1):
        h = problem.gap(x)
        if matrix is None:
            matrix, before = Bordered.at(problem, h, row), 1.0  # its error falls as the square
        dx = matrix.solve(-problem.residual(x), value - float(row @ x))
        change = problem.gap_change(dx) / h
        x = x + min(1.0, CLOSING / max(float(-change.min()), CLOSING)) * dx
        largest = float(np.abs(change).max())
        if not np.isfinite(largest):
            break
        if largest**2 < NEAR * before:
            return x, matrix, step
        matrix, before = (matrix if largest < KEPT * before else None), largest
    raise NotConverged(f"no equilibrium of the weak form in {MOST_STEPS} Newton steps; try another to_load or tabor")


def equilibrium(problem: Problem, x: Array, row: Array, value: float) -> tuple[Point, int]:
    """Point of the path where row x = value, from nearby, and the Newton steps that it took; the row points onward."""
    x, matrix, steps = bordered_newton(problem, x, row, value)
    h = problem.gap(x)
    tangent = path_tangent(problem, h, matrix)
    row = problem.row(tangent)
    size = np.sqrt(row @ tangent)
    tangent, row = tangent / size, row / size
    dh = problem.gap_change(tangent)
    rates = np.array([tangent[-1], problem.load_rate(h, dh), problem.central_gap(tangent)])
    # det A has the sign of d(alpha)/ds all along the path; if that matrix has another, a fold lies in between.
    between = (-1) ** matrix.negative * tangent[-1] < 0
    negative = (Bordered.at(problem, h, row) if between else matrix).negative
    return Point(x, tangent, row, problem.observables(x), rates, negative == 0), steps


def path_tangent(problem: Problem, h: Array, nearby: Bordered) -> Array:
    """Solve A t = -b d(alpha), row t = 1 at gaps h by corrections with the matrix of a state nearby."""
    tangent = nearby.solve(np.zeros(nearby.row.size - 1), 1.0)
    for _ in range(MOST_STEPS):
        change = nearby.solve(-problem.residual_along(h, tangent), 1 - float(nearby.row @ tangent))
        tangent = tangent + change
        if np.abs(change).max() < TANGENT * np.abs(tangent).max():
            return tangent
    raise NotConverged(f"no tangent of the weak form's path in {MOST_STEPS} steps; try another to_load or tabor")


def onward(problem: Problem, a: Point, s: float, bend: Array | float = 0.0) -> tuple[Point, int]:
    """Point of the path on the plane at arclength s past a point, and the Newton steps that it took.

    It is sought on the parabola of that tangent and, if it is given, that curvature.
    """
    if s == 0:
        return a, 0
    return equilibrium(problem, a.x + s * (a.tangent + s / 2 * bend), a.row, float(a.row @ a.x) + s)


def follow(problem: Problem, approach: float, to_load: float) -> list[Point]:
    """Points of the path from an approach of separated surfaces, through every fold, to a compressive load."""
    start, last = np.zeros(problem.free.size + 1), np.zeros(problem.free.size + 1)
    start[-1], last[-1] = approach, 1.0
    points, s = [equilibrium(problem, start, last, approach)[0]], FIRST
    while points[-1].observables[1] < to_load:
        if s < SHORTEST or len(points) > MOST_POINTS:
            raise NotConverged(f"the weak form's path ends at alpha = {points[-1].x[-1]:.4g} eps; try a smaller tabor")
        try:
            point, steps = onward(problem, points[-1], s, curvature(points[-2:]))
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


def curvature(points: Sequence[Point]) -> Array | float:
    """Change of the tangent along the path, by its last two points; 0 at its first."""
    a, b = points[0], points[-1]
    return (b.tangent - a.tangent) / float(a.row @ (b.x - a.x)) if len(points) > 1 else 0.0


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
        found.append(equilibrium(problem, x, row, float(row @ x))[0])
    return found


def arclength(before: tuple[Problem, Point], after: tuple[Problem, Point]) -> float:
    """Arclength between two points of a path, each on its own elements, by the tangent at that on the finer ones."""
    (coarse, a), (fine, b) = sorted((before, after), key=lambda each: each[0].degree)
    return abs(float(b.row @ (b.x - fine.taken_over(coarse, a.x))))


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
