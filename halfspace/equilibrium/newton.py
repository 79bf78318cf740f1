"""Damped Newton's method on an equilibrium problem bordered by one control."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, final

import numpy as np

from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, ContactProblem, Solver
from halfspace.errors import Unsolved, required
from halfspace.values import Array, Valued, appended


@dataclass(frozen=True)
class NewtonSettings:
    """Numbers of Newton's method and of what follows from its last factors."""

    growth: float = 10.0  # of the relative residual, let through in one step
    round_off: float = 1e-10  # relative size of a step below which the residual may be no more than rounding
    rough: float = 3e-2  # relative accuracy of a first step that is iterated for; later the square of that before
    left: float = 1e-4  # of the tolerance: error left by the last step; the least of any step that is iterated for
    turns: int = 12  # steps towards a turning point
    astray: float = 0.01  # relative size of a step to the path, from where it cannot be told how the path goes
    turned: float = 1e-9  # relative size of the last of them: what it leaves goes as its square
    rounded: float = 1e-6  # of a last one that is no smaller than that before: rounding is up to 5e-7 of the state
    little: float = 1e-6  # relative size of a change by which a derivative is taken


NEWTON = NewtonSettings()


class Traceable(Protocol):
    """What the solver, the path and the events need to know of a contact problem, condensed or not."""

    def residual(self, x: Array) -> Array:
        """Left-hand sides of all equations but the control."""

    def along(self, x: Array, v: Array) -> Array:
        """Derivative of the residual along a direction."""

    def bordered_solver(self, x: Array, row: Array) -> Solver:
        """Solver for the linearised equations with the control row below them; all nan if these are singular."""

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap, contact radius."""

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Weighted sum of the observables."""

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative of a weighted sum of the observables."""

    def rates(self, x: Array, v: Array) -> Array:
        """Derivatives of the observables along a direction, 0 of one that is nan."""

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of a step that keeps gaps positive."""

    def size(self, x: Array, dx: Array) -> float:
        """Relative size of a step."""

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm of the residual relative to the state."""

    def require_resolution(self, x: Array) -> None:
        """Raise GridTooCoarse for a state that the discretisation cannot carry."""

    # What a whole curve, its stability, its jumps and its change of discretisation need beyond that.

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""

    @property
    def interface(self) -> ContactProblem:
        """Surface law, profile and grid of the surface: the problem itself if that is all its state is made of."""

    def surface_state(self, x: Array) -> Array:
        """State as `interface` knows it: gaps, approach, scale of the grid."""

    def state_from_surface(self, state: Array) -> Array:
        """State whose surface is about that of a state of `interface`, as a start."""

    def rough(self, radii: Array, approach: float) -> Array:
        """Part of the gaps in eps that is known at any radii; what is left of them is smooth within the cells."""

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps."""

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the energy falls at fixed approach; 0 means stable under fixed grips."""


@dataclass(frozen=True, eq=False, repr=False)
class Control(Valued):
    """One more equation for one more unknown: a weighted sum of the observables has a target.

    The weights (4,) are of approach, load, central gap and contact radius.
    """

    weights: Array
    target: float


def approach(value: float) -> Control:
    """Fixed grips: alpha* = value."""
    return _single(APPROACH, value)


def load(value: float) -> Control:
    """Dead load: W = value, in R dgamma."""
    return _single(LOAD, value)


def central_gap(value: float) -> Control:
    """H(0) = value."""
    return _single(CENTRAL_GAP, value)


def contact_radius(value: float) -> Control:
    """Gap of the largest tension at the radius `value`, in beta; the start must be in contact."""
    return _single(CONTACT_RADIUS, value)


def spring(stiffness: float, base: float) -> Control:
    """Apparatus of finite stiffness: W = stiffness (base - alpha*), in R dgamma/eps."""
    weights = np.zeros(4)
    weights[[APPROACH, LOAD]] = stiffness, 1.0
    return Control(weights, stiffness * base)


def _single(observable: int, value: float) -> Control:
    return Control(np.eye(4)[observable], float(value))


@final
@dataclass(frozen=True, eq=False, repr=False)
class Solution(Valued):
    """A converged state x, its observables (4,), approach, load, central gap and contact radius, and its control.

    The error left is of the order of the square of the last Newton step, or less than `NEWTON.left` of the tolerance.
    Astray is the relative size of the first, by how much the start was off. The solver is for the linearised equations,
    bordered by the control, at the state or very near to it.
    """

    x: Array
    observables: Array
    iterations: int
    control: Control
    solver: Solver
    astray: float = 0.0


def solve(
    problem: Traceable, start: Array, control: Control, *, tolerance: float = 1e-8, max_iterations: int = 40
) -> Solution:
    """Solve the equilibrium under a control as of `attempt`, or raise NotConverged."""
    return required(attempt(problem, start, control, tolerance=tolerance, max_iterations=max_iterations))


def attempt(
    problem: Traceable,
    start: Array,
    control: Control,
    *,
    tolerance: float = 1e-8,
    max_iterations: int = 40,
    contraction: float = math.inf,
) -> Solution | Unsolved:
    """Solve the equilibrium under a control, from a start whose gaps are positive, or say why Newton's method fails.

    Whether the grid can carry the state found is another question: ask ``problem.require_resolution``. A state is
    accepted if the last step's relative size is within the tolerance; convergence is quadratic. Unsolved if the steps
    or the damping run out, or a step is longer than the part `contraction` of that two before, at first of 1.
    """
    x = start.copy()
    F = _equations(problem, x, control)
    if np.isnan(F[-1]):
        return Unsolved("the start has no contact radius to be prescribed; start from a state in contact")
    before = last = 1.0 if contraction < 1 else math.inf
    astray = 0.0
    for iteration in range(1, max_iterations + 1):
        solver = problem.bordered_solver(x, problem.gradient(x, control.weights))
        accuracy = min(max(before**2, NEWTON.left), NEWTON.rough)
        dx = -solver(F, accuracy)
        update = problem.size(x, dx)
        if not math.isfinite(update):
            break
        astray = astray or update
        x, F, damping = _damped(problem, x, F, dx, control)
        if damping == 1 and update < tolerance and update * max(update, accuracy) < NEWTON.left * tolerance:
            return Solution(x, problem.observables(x), iteration, control, solver, astray)
        if not damping or update > contraction * last:
            break
        last, before = before, update
    return Unsolved(
        f"no convergence in {iteration} Newton steps (last relative step {update:.1e}, limit {tolerance:.0e}, "
        f"relative residual {_misfit(problem, x, F):.1e}); try a nearer start, a smaller change or another control"
    )


def tangent(problem: Traceable, solution: Solution) -> Array:
    """Direction of the path at a solution in which the weighted observables of its control change by 1.

    The factors of the last step give it to the size of that step; what they leave is solved for by them once again.
    """
    row, unit = problem.gradient(solution.x, solution.control.weights), _last(solution.x.size)
    t = solution.solver(unit)
    return t + solution.solver(unit - appended(problem.along(solution.x, t), float(row @ t)), NEWTON.left)


def turning_point(
    problem: Traceable, start: Array, weights: Array, direction: Array, reach: float
) -> tuple[Solution, float, float] | Unsolved:
    """Solve for the state near a start at which a weighted sum of the observables is stationary along the path.

    Return it, how fast the rate of the sum changes there, and the arclength that the last steps were along the path:
    where rounding ends them it is known no better.

    Newton's method on the equilibrium and the sum's rate psi = c t, c the sum's gradient, t the tangent of the path.
    The weights (4,) are of the observables in the sum, the direction (4,) is the arclength's gradient at a point
    nearby, and the reach the arclength by which a step may move along the path. Unsolved if there is no such state so
    near.
    """
    x, last, before = start, math.inf, 0.0
    for iteration in range(1, NEWTON.turns + 1):
        here = _Tangent(problem, x, weights, direction)
        dx = -here.solver(appended(problem.residual(x), 0.0), NEWTON.left)  # towards the path, across it
        near = problem.size(x, dx) < NEWTON.astray
        if near:
            slope, bend = here.changes(here.tangent)
            step = -(here.rate + here.changes(dx)[0]) / slope if slope else np.inf
            if not abs(step) <= reach:
                break
            dx = dx + step * here.tangent + step**2 / 2 * bend
        elif iteration > 1:  # from farther off steps lead nowhere
            break
        update = problem.size(x, dx)
        if not math.isfinite(update):
            break
        damping = problem.longest_step(x, dx)
        x = x + damping * dx
        rounding = last / 2 < update < NEWTON.rounded
        if near and damping == 1 and (update < NEWTON.turned or rounding):
            solution = Solution(x, problem.observables(x), iteration, Control(direction, 0.0), here.solver)
            return solution, slope, abs(step) + rounding * before
        last, before = update, abs(step) if near else 0.0
    return Unsolved("the path does not turn here; take a smaller rtol")


@dataclass(frozen=True, eq=False, repr=False)
class _Tangent(Valued):
    """Tangent of the path at a state, B t = e, B the Jacobian bordered by the arclength's gradient."""

    problem: Traceable
    x: Array
    weights: Array
    direction: Array

    @cached_property
    def solver(self) -> Solver:
        return self.problem.bordered_solver(self.x, self.problem.gradient(self.x, self.direction))

    @cached_property
    def tangent(self) -> Array:
        return self.solver(_last(self.x.size))

    @cached_property
    def gradient(self) -> Array:
        return self.problem.gradient(self.x, self.weights)

    @cached_property
    def rate(self) -> float:
        """Of the weighted sum along the path, psi = c t."""
        return float(self.gradient @ self.tangent)

    def changes(self, v: Array) -> tuple[float, Array]:
        """Changes of psi and t with a change v of the state: c' t - c B^-1 B' t and -B^-1 B' t, by central differences.

        On a grid that stands still a sharp edge that moves makes both terms of c' t + c t' up to 1e6 times their sum. A
        difference to one side left a hundred times the slope, and the steps crept: they ended 1e-9 of the approach off.
        """
        size = self.problem.size(self.x, v)
        if not size:
            return 0.0, np.zeros_like(v)
        h, t = NEWTON.little / size, self.tangent

        def rate(of: Callable[[Array], Array]) -> Array:
            return np.asarray((of(self.x + h * v) - of(self.x - h * v)) / (2 * h))

        along, across = (
            rate(lambda x: self.problem.along(x, t)),
            rate(lambda x: self.problem.gradient(x, self.direction)),
        )
        turned = -self.solver(appended(along, float(across @ t)), NEWTON.left)
        own = rate(lambda x: self.problem.gradient(x, self.weights)) @ t
        return float(own + self.gradient @ turned), turned


def _last(size: int) -> Array:
    """Right-hand side of a tangent: no equation is out of balance, and the control changes by 1."""
    unit = np.zeros(size)
    unit[-1] = 1.0
    return unit


def _damped(problem: Traceable, x: Array, F: Array, dx: Array, control: Control) -> tuple[Array, Array, float]:
    """Take the longest of the steps f dx, f/2 dx ... that keeps gaps positive and the residual in bounds, 0 if none.

    Where the surfaces repel, the law is steep and convex: a step that overshoots raises the residual once and then
    converges from one side. A line search that insists on descent would crawl there, so some growth is let through.
    """
    merit = _misfit(problem, x, F)
    damping = problem.longest_step(x, dx)
    while damping > 1e-4:
        trial = x + damping * dx
        changed = _equations(problem, trial, control)
        if _misfit(problem, x, changed) <= NEWTON.growth * merit or problem.size(x, dx) < NEWTON.round_off:
            return trial, changed, damping
        damping /= 2
    return x, F, 0.0


def _equations(problem: Traceable, x: Array, control: Control) -> Array:
    return appended(problem.residual(x), problem.weighted_observables(x, control.weights) - control.target)


def _misfit(problem: Traceable, x: Array, F: Array) -> float:
    """Size of the equations' left-hand sides, the problem's relative to its gaps and the control's as it is."""
    return math.hypot(problem.misfit(x, F[:-1]), float(F[-1]))
