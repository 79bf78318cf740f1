"""The iterations of 1997 on the paper's 200 nodes: where each converges, in how many sweeps, and what Newton costs.

All solve for the state in contact whose central gap is the equilibrium spacing, H(0) = 0, from the undeformed surfaces.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from halfspace.elastic import compliance, grid
from halfspace.equilibrium import newton, relaxation
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.errors import NotConverged
from halfspace.values import Array

NODES, OUTER = 200, 6.0  # uniform triangles, to this radius in beta, or in beta/sqrt(mu) below mu = 1
TABORS = (0.05, 0.2, 0.5, 1.0, 2.0, 3.0)
GREENWOOD_TABORS = (0.05, 1.0, 3.0)  # five seconds each
GREENWOOD_TOLERANCE = 1e-5  # relative misfit of the pressure
CONTACT = newton.central_gap(0.0)

Iteration = Callable[[ContactProblem, Array], relaxation.Relaxed]


@dataclass(frozen=True)
class Attempt:
    """How one iteration fared.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    method : str
        Name of the iteration.
    sweeps : int or None
        None if it did not converge.
    outcome : str
        Largest deviation of the load from Newton's, or why there is none.
    seconds, newton_seconds : float
        Of the iteration, and of Newton's method through a dozen central gaps from far away.
    """

    tabor: float
    method: str
    sweeps: int | None
    outcome: str
    seconds: float
    newton_seconds: float


def attempts(most_sweeps: int) -> Iterator[Attempt]:
    """Each iteration at several Tabor parameters; Greenwood's may take `most_sweeps`."""

    def simple(c: float) -> Iteration:
        return lambda problem, x: relaxation.simple(problem, x, CONTACT, relaxation=c)

    def greenwood(problem: ContactProblem, x: Array) -> relaxation.Relaxed:
        return relaxation.greenwood(
            problem, x, CONTACT, relaxation=1.5, tolerance=GREENWOOD_TOLERANCE, most_sweeps=most_sweeps
        )

    every: dict[str, Iteration] = {f"simple relaxation, c = {c:g}": simple(c) for c in (0.05, 0.005)}
    for tabor in TABORS:
        methods = every | ({"Greenwood's, relaxation 1.5": greenwood} if tabor in GREENWOOD_TABORS else {})
        outer = OUTER / np.sqrt(min(tabor, 1.0))
        problem = ContactProblem(compliance.triangles(grid.uniform(outer, outer / (NODES - 1))), tabor)
        began = time.perf_counter()
        load = _by_newton(problem)
        newton_seconds = time.perf_counter() - began
        for name, iterate in methods.items():
            yield _attempt(problem, name, iterate, load, newton_seconds)


def _by_newton(problem: ContactProblem) -> float:
    """Load at H(0) = 0, by way of larger gaps."""
    x = problem.undeformed(-6.0)
    for gap in (5, 3, 2, 1.5, 1, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02):
        x = newton.solve(problem, x, newton.central_gap(gap)).x
    return float(newton.solve(problem, x, CONTACT).observables[LOAD])


def _attempt(problem: ContactProblem, name: str, iterate: Iteration, load: float, newton_seconds: float) -> Attempt:
    start = problem.undeformed(1.0)
    start[:-2] = np.maximum(start[:-2], 0.0)
    began = time.perf_counter()
    try:
        found = iterate(problem, start)
    except NotConverged as error:
        return Attempt(problem.tabor, name, None, str(error), time.perf_counter() - began, newton_seconds)
    seconds = time.perf_counter() - began
    outcome = f"load within {abs(found.observables[LOAD] - load):.0e} R dgamma of Newton's"
    return Attempt(problem.tabor, name, found.sweeps, outcome, seconds, newton_seconds)
