"""The iterations of 1997, kept as baselines: simple relaxation and Greenwood's local Newton-Raphson.

Both correct one state under fixed grips or a given central gap, sweep after sweep. Neither can pass a fold, nor follow
the curve where the contact is unstable under the control; `halfspace.equilibrium.newton` and
`halfspace.equilibrium.path` do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, ContactProblem
from halfspace.equilibrium.newton import Control
from halfspace.errors import InputError, NotConverged
from halfspace.values import Array, Valued


@dataclass(frozen=True)
class Settings:
    """Numbers of both iterations."""

    most: int = 20_000  # sweeps, Greenwood's
    closest: float = -0.7  # gap H below which the law is not followed: an overshoot, no contact bears such pressures
    hopeless: float = 1e6  # relative residual beyond which an iteration has run away
    checked: int = 10  # sweeps between two looks at the residual


USUAL = Settings()


@dataclass(frozen=True, eq=False, repr=False)
class Relaxed(Valued):
    """A state to which an iteration converged: the state vector x of the problem, on its fixed grid.

    Observables (4,) are approach, load, central gap, contact radius; the sweeps taken are a multiple of
    `USUAL.checked`. The residual is the largest misfit of gap or pressure, relative, below the tolerance; the error is
    larger by the number of sweeps in which the iteration gains a factor e.
    """

    x: Array
    observables: Array
    sweeps: int
    residual: float


def simple(
    problem: ContactProblem,
    start: Array,
    control: Control,
    *,
    relaxation: float = 0.05,
    tolerance: float = 1e-10,
    most_sweeps: int = USUAL.most,
) -> Relaxed:
    """Solve by simple relaxation, H <- H + c (H' - H), H' being the gaps under the pressures that belong to H.

    The problem is on a fixed grid, `start` its first state vector, and the control that of the approach or the central
    gap. The larger the Tabor parameter, the smaller c must be, and the more sweeps it takes: Greenwood went down to
    0.005, with which states in contact converge up to a Tabor parameter of 3 in 19 000 sweeps of 200 nodes. The
    tolerance is the largest change H' - H accepted, relative to the gap h. InputError if the grid follows the contact,
    or the control is another one; NotConverged if the gaps run away or `most_sweeps` run out.
    """
    (given, C), tabor, law = _gaps_under(problem, control), problem.tabor, problem.law
    H = start[:-2].copy()

    def sweep() -> None:
        nonlocal H
        H = np.maximum(H + relaxation * (given + C @ law.pressure(H, tabor) - H), USUAL.closest)

    def state() -> State:
        P = law.pressure(H, tabor)
        return H, P, float(np.max(np.abs(given + C @ P - H) / (1 + H)))

    return _iterate(problem, "simple relaxation", relaxation, sweep, state, tolerance, most_sweeps)


def greenwood(
    problem: ContactProblem,
    start: Array,
    control: Control,
    *,
    relaxation: float = 1.0,
    tolerance: float = 1e-10,
    most_sweeps: int = USUAL.most,
) -> Relaxed:
    """Solve by Greenwood's local Newton-Raphson iteration.

    Node after node, P_i is corrected from its own misfit P_i - P(H_i) while P_(i-1) and P_(i+1) change by half as much
    the other way, so that the deflection changes near the node only. What is smooth on the grid therefore fades slowly:
    sweeps grow as the square of the number of nodes.

    The relaxation is the part of each correction that is made, 0.5 to 1.5, the tolerance the largest misfit of the
    pressure accepted, relative to the largest pressure; the rest, and what is raised, as of `simple`.
    """
    (given, C), tabor, law = _gaps_under(problem, control), problem.tabor, problem.law
    P = problem.pressure(start)
    # Columns: the gaps' change as P_i rises by 1 while P_(i-1) and P_(i+1) fall by 1/2.
    changes = C.copy()
    changes[:, :-1] -= C[:, 1:] / 2
    changes[:, 1:] -= C[:, :-1] / 2
    columns = changes.T.copy()

    def sweep() -> None:
        """Local corrections, in place; each node sees those before it."""
        H = given + C @ P
        for i, column in enumerate(columns):
            gap = max(H[i], USUAL.closest)
            change = relaxation * (law.pressure(gap, tabor) - P[i]) / (1 - law.slope(gap, tabor) * column[i])
            P[i] += change
            if i > 0:
                P[i - 1] -= change / 2
            if i < P.size - 1:
                P[i + 1] -= change / 2
            H += change * column

    def state() -> State:
        H = given + C @ P
        off = P - law.pressure(np.maximum(H, USUAL.closest), tabor)
        return H, P, float(np.max(np.abs(off)) / np.max(np.abs(P)))

    return _iterate(problem, "Greenwood's iteration", relaxation, sweep, state, tolerance, most_sweeps)


def _gaps_under(problem: ContactProblem, control: Control) -> tuple[Array, Array]:
    """Terms of H = given + C @ P, from which the control has eliminated the approach of [G97] (2.8).

    It is given, or follows from the gap given on the axis.
    """
    if problem.follows_contact:
        raise InputError("the grid follows the contact; the 1997 iterations need a fixed one")
    body, undeformed = problem.operator.at(1.0), problem.undeformed(0.0)[:-2]
    C = problem.tabor * body.compliance
    if np.array_equal(control.weights, np.eye(4)[APPROACH]):
        return undeformed - control.target, C
    if np.array_equal(control.weights, np.eye(4)[CENTRAL_GAP]):
        return undeformed + control.target, C - body.axis_row @ C  # on the axis the undeformed one is zero
    raise InputError("the 1997 iterations work under newton.approach or newton.central_gap only; take newton.solve")


State = tuple[Array, Array, float]
"""Gaps, pressures, and the residual."""


def _iterate(
    problem: ContactProblem,
    name: str,
    relaxation: float,
    sweep: Callable[[], None],
    state: Callable[[], State],
    tolerance: float,
    most_sweeps: int,
) -> Relaxed:
    """Sweep until the residual meets the tolerance, and add the approach at which the pressures leave the gaps."""
    first = misfit = state()[-1]
    for sweeps in range(1, most_sweeps + 1):
        sweep()
        if sweeps % USUAL.checked:
            continue
        H, P, misfit = state()
        if misfit < tolerance:
            deflection = problem.tabor * problem.operator.at(1.0).compliance[0] @ P
            x = np.concatenate([H, [problem.undeformed(0.0)[0] + deflection - H[0], 1.0]])
            return Relaxed(x, problem.observables(x), sweeps, misfit)
        if not misfit < USUAL.hopeless * (1 + first):
            raise NotConverged(
                f"{name} ran away within {sweeps} sweeps at relaxation {relaxation:g} (relative residual "
                f"{misfit:.1e}); take a smaller relaxation, a nearer start or halfspace.equilibrium.newton.solve"
            )
    raise NotConverged(
        f"{name} did not converge in {most_sweeps} sweeps at relaxation {relaxation:g} (relative residual "
        f"{misfit:.1e}, limit {tolerance:.0e}); take another relaxation, fewer nodes or Newton's method"
    )
