"""Damped Newton's method on an equilibrium problem bordered by one control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.errors import NotConverged
from halfspace.values import Array, Valued

GROWTH = 10.0  # of the relative residual, let through in one step
ROUND_OFF = 1e-10  # relative size of a step below which the residual may be no more than rounding


class Equilibrium(Protocol):
    """What the solver, the path and the events need to know of a contact problem, condensed or not."""

    def residual(self, x: Array) -> Array:
        """Left-hand sides of all equations but the control."""
        ...

    def bordered_solver(self, x: Array, row: Array) -> Callable[[Array], Array]:
        """Solver for the linearised equations with the control row below them; raise NotConverged if singular."""
        ...

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap, contact radius."""
        ...

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Weighted sum of the observables."""
        ...

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative of a weighted sum of the observables."""
        ...

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of a step that keeps gaps positive."""
        ...

    def size(self, x: Array, dx: Array) -> float:
        """Relative size of a step."""
        ...

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm of the residual relative to the state."""
        ...

    def require_resolution(self, x: Array) -> None:
        """Raise GridTooCoarse for a state that the discretisation cannot carry."""
        ...


class Traceable(Equilibrium, Protocol):
    """What a whole curve, its stability, its jumps and its change of discretisation need beyond that."""

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""
        ...

    @property
    def interface(self) -> ContactProblem:
        """Surface law, profile and grid of the surface: the problem itself if that is all its state is made of."""
        ...

    def surface_state(self, x: Array) -> Array:
        """State as `interface` knows it: gaps, approach, scale of the grid."""
        ...

    def state_from_surface(self, state: Array, near: Array | None = None) -> Array:
        """State whose surface is about that of a state of `interface`, as a start, from one near it if there is one."""
        ...

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""
        ...

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps."""
        ...

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the energy falls at fixed approach; 0 means stable under fixed grips."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Control(Valued):
    """One more equation for one more unknown: a weighted sum of the observables has a target.

    Parameters
    ----------
    weights : (4,) array
        Of approach, load, central gap, contact radius.
    target : float
        Value of the weighted sum.
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
    """Gap of 3^(1/6) eps at the radius `value`, in beta; the start must be in contact."""
    return _single(CONTACT_RADIUS, value)


def spring(stiffness: float, base: float) -> Control:
    """Apparatus of finite stiffness: W = stiffness (base - alpha*), in R dgamma/eps."""
    weights = np.zeros(4)
    weights[[APPROACH, LOAD]] = stiffness, 1.0
    return Control(weights, stiffness * base)


def _single(observable: int, value: float) -> Control:
    return Control(np.eye(4)[observable], float(value))


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Valued):
    """A converged state.

    Attributes
    ----------
    x : array
        State vector of the problem.
    observables : (4,) array
        Approach, load, central gap, contact radius.
    iterations : int
        Newton steps taken.
    update : float
        Relative size of the last step; the error left is of the order of its square.
    """

    x: Array
    observables: Array
    iterations: int
    update: float


def solve(
    problem: Equilibrium, start: Array, control: Control, *, tolerance: float = 1e-8, max_iterations: int = 40
) -> Solution:
    """Solve the equilibrium under a control, from a start whose gaps are positive.

    Whether the grid can carry the state found is another question: ask ``problem.require_resolution``.

    Parameters
    ----------
    problem : Equilibrium
        The contact problem.
    start : array
        First state vector.
    control : Control
        What is prescribed.
    tolerance : float
        Relative size of the last step at which the state is accepted; convergence is quadratic.
    max_iterations : int
        Newton steps after which to give up.

    Raises
    ------
    NotConverged
        If the steps or the damping run out; no unconverged state is ever returned.
    """
    x = start.copy()
    F = _equations(problem, x, control)
    if np.isnan(F[-1]):
        raise NotConverged("the start has no contact radius to be prescribed; start from a state in contact")
    for iteration in range(1, max_iterations + 1):
        row = problem.gradient(x, control.weights)
        dx = -problem.bordered_solver(x, row)(F)
        update = problem.size(x, dx)
        x, F, damping = _damped(problem, x, F, dx, control)
        if damping == 1 and update < tolerance:
            return Solution(x, problem.observables(x), iteration, update)
    raise NotConverged(
        f"no convergence in {max_iterations} Newton steps (last relative step {update:.1e}, limit {tolerance:.0e}, "
        f"relative residual {_misfit(problem, x, F):.1e}); try a nearer start, a smaller change or another control"
    )


def _damped(problem: Equilibrium, x: Array, F: Array, dx: Array, control: Control) -> tuple[Array, Array, float]:
    """Take the longest of the steps f dx, f/2 dx ... that keeps gaps positive and the residual in bounds.

    Where the surfaces repel, the law is steep and convex: a step that overshoots raises the residual once and then
    converges from one side. A line search that insists on descent would crawl there, so some growth is let through.
    """
    merit = _misfit(problem, x, F)
    damping = problem.longest_step(x, dx)
    while damping > 1e-4:
        trial = x + damping * dx
        F = _equations(problem, trial, control)
        if _misfit(problem, x, F) <= GROWTH * merit or problem.size(x, dx) < ROUND_OFF:
            return trial, F, damping
        damping /= 2
    raise NotConverged(
        f"the damping ran out (relative residual {merit:.1e}); try a nearer start, a smaller change or another control"
    )


def _equations(problem: Equilibrium, x: Array, control: Control) -> Array:
    return np.append(problem.residual(x), problem.weighted_observables(x, control.weights) - control.target)


def _misfit(problem: Equilibrium, x: Array, F: Array) -> float:
    """Size of the equations' left-hand sides, the problem's relative to its gaps and the control's as it is."""
    return float(np.hypot(problem.misfit(x, F[:-1]), F[-1]))
