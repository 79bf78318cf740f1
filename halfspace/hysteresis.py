"""Energy lost in a cycle of approach and separation under fixed grips: what both jumps set free.

    loss = [E(A) - E(B)] + [E(C) - E(D)]

A is the fold at which the surfaces jump on and B the state in contact at the same approach; C the fold at which they
jump off and D the separated state at the same approach. As dE/d(alpha*) = W along each branch, it equals the integral
of W d(alpha*) round the loop.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from halfspace import newton
from halfspace.contact import APPROACH, ContactProblem
from halfspace.curve import EquilibriumPath, Estimate, Segment, metric_for, transfer
from halfspace.events import ROUND_OFF, Condition, Located, locate
from halfspace.newton import Equilibrium

Array = NDArray[np.float64]


@runtime_checkable
class Energetic(Protocol):
    """An equilibrium with a potential energy."""

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps."""
        ...


def hysteresis(path: EquilibriumPath) -> Estimate | None:
    """Energy lost in a cycle, in R dgamma eps, with its change from stage to stage as error; None without jumps."""
    losses = [loss for stage in path.stages if (loss := energy_lost(path.segments, stage)) is not None]
    if not losses:
        return None
    changes = sum(abs(b - a) for a, b in pairwise(losses))
    return Estimate(losses[-1], changes + ROUND_OFF * (1 + abs(losses[-1])))


def energy_lost(segments: Sequence[Segment], found: Mapping[str, Located]) -> float | None:
    """Energy lost in a cycle, in R dgamma eps, or None if the curve does not fold.

    Parameters
    ----------
    segments : sequence of Segment
        The traced curve, to start the landing states from.
    found : mapping of str to Located
        Events of `halfspace.curve.find_events` on the discretisation whose loss is wanted, the curve's or a finer.
    """
    if "jump_on" not in found:
        return None
    jumps = (
        (found["jump_on"], found["zero_approach"].problem, -1),  # the last state at its approach is in contact
        (found["jump_off"], found["separated"].problem, 0),  # the first is separated
    )
    return sum(_drop(segments, fold, problem, which) for fold, problem, which in jumps)


def _drop(segments: Sequence[Segment], fold: Located, problem: Equilibrium, which: int) -> float:
    """Energy set free from a fold to where it lands, on the discretisation `problem`."""
    approach = float(fold.point.observables[APPROACH])
    metric = metric_for(segments[0].problem.tabor)
    condition = Condition(APPROACH, value=approach)
    landing = [e for s in segments for e in locate(s.problem, s.points, metric, condition)][which]
    return _energy(fold.problem, fold.point.x) - _energy(problem, _on(problem, landing, approach))


def _on(problem: Equilibrium, state: Located, approach: float) -> Array:
    """State vector of a state on another discretisation, solved at the approach."""
    if problem is state.problem:
        return state.point.x
    assert isinstance(state.problem, ContactProblem)
    assert isinstance(problem, ContactProblem)
    return newton.solve(problem, transfer(state.problem, state.point.x, problem), newton.approach(approach)).x


def _energy(problem: Equilibrium, x: Array) -> float:
    assert isinstance(problem, Energetic)
    return problem.energy(x)
