"""The numerics of 1997, made again: what a grid that is too coarse does, and how the iterations fare.

Attard & Parker's false rise of the pull-off force is made on purpose, by uniform triangles too wide for the spike. An
interval wider than the spike of tension at the contact edge pins the edge to the nodes: the load ripples as the edge
goes from one to the next, and its least value lies deeper than the true pull-off, [G97] section 4b.

The iterations run on the paper's 200 nodes: where each converges, in how many sweeps, and what Newton costs. All solve
for the state in contact whose central gap is the equilibrium spacing, H(0) = 0, from the undeformed surfaces.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fem_adhesion.common import relaxation
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.kernel import ring_kernel
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import transfer
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import NotConverged
from halfspace.values import Array, Valued

EXTENT = 6.0  # beta: less than 0.6 % of the pull-off load is lost beyond it for mu >= 1
WINDOW = 2.0  # spacings, on both sides of the contact radius at pull-off: the ripple's period is one
STEPS = 12  # of the contact radius to a spacing, where only the least load matters
STEPS_DRAWN = 30
ENOUGH = -7.5  # load in R dgamma below which the rise is proved


class Unguarded(ContactProblem):
    """A contact problem that does not refuse a grid too coarse for the spike: wrong on purpose."""

    def require_resolution(self, x: Array) -> None:
        """Accept every state."""


@dataclass(frozen=True, eq=False, repr=False)
class Ripple(Valued):
    """The curve near pull-off on a uniform grid of a spacing in beta: approach (eps) and load (R dgamma), both (n,)."""

    tabor: float
    spacing: float
    approach: Array
    load: Array

    @property
    def pull_off(self) -> float:
        """Least load met, in R dgamma."""
        return float(self.load.min())


@dataclass(frozen=True)
class Rise:
    """Pull-off at rising Tabor parameters on one spacing, and why it ends where it does."""

    ripples: tuple[Ripple, ...]
    ended: str


def without_singular_point(nodes: Array) -> ElasticOperator:
    """Half-space by a sum of the kernel over uniform nodes (q,) in beta that leaves out the node itself.

    The kernel is infinite there, and a sum over all others is what [G97] section 4b saw a student take.
    """
    weights = np.full(nodes.size, nodes[1] - nodes[0])
    weights[[0, -1]] /= 2  # trapezoidal rule
    r, s = np.broadcast_arrays(nodes[:, None], nodes)
    others = ~np.eye(nodes.size, dtype=bool)
    matrix = np.zeros(r.shape)
    matrix[others] = ring_kernel(r[others], s[others])
    whole = compliance.triangles(nodes)
    return replace(whole, weights=2 * np.pi * nodes * weights, compliance=matrix * nodes * weights)


def ripple(
    path: EquilibriumPath,
    spacing: float,
    window: float,
    steps: int = STEPS_DRAWN,
    body: Callable[[Array], ElasticOperator] = compliance.triangles,
) -> Ripple:
    """Separate the surfaces through pull-off on uniform nodes, from a resolved path's state in contact.

    The nodes are apices of triangles of pressure, unless `body` makes another operator on them. The contact radius is
    prescribed, which goes on falling where approach and load ripple: from a window in beta above that at pull-off to as
    far below, in a number of steps to a spacing. NotConverged if the coarse grid has no state near the resolved one.
    """
    problem = Unguarded(body(grid.uniform(EXTENT, spacing)), path.tabor)
    centre = path.events["pull_off"].contact_radius
    radii = np.arange(centre + window, centre - window, -spacing / steps)
    resolved = path.segments[-1]
    near = min(resolved.points, key=lambda point: abs(float(point.observables[CONTACT_RADIUS]) - radii[0]))
    x, values = transfer(resolved.problem, near.x, problem), []
    for radius in radii:
        solution = newton.solve(problem, x, newton.contact_radius(radius))
        x = solution.x
        values.append(solution.observables[[APPROACH, LOAD]])
    return Ripple(path.tabor, spacing, *np.transpose(values))


def false_rise(
    paths: Sequence[EquilibriumPath], spacing: float, body: Callable[[Array], ElasticOperator] = compliance.triangles
) -> Rise:
    """Pull-off at rising Tabor parameters on one spacing, until the rise is proved or the grid has no solution."""
    found: list[Ripple] = []
    for path in paths:
        try:
            found.append(ripple(path, spacing, WINDOW * spacing, STEPS, body))
        except NotConverged as error:
            return Rise(tuple(found), f"no solution at mu = {path.tabor:.3g}: {error}")
        if found[-1].pull_off < ENOUGH:
            return Rise(tuple(found), f"the load is below {ENOUGH:g} R dgamma")
    return Rise(tuple(found), "no larger mu was asked for")


# Iterations

NODES, OUTER = 200, 6.0  # uniform triangles, to this radius in beta, or in beta/sqrt(mu) below mu = 1
TABORS = (0.05, 0.2, 0.5, 1.0, 2.0, 3.0)
GREENWOOD_TABORS = (0.05, 1.0, 3.0)  # five seconds each
GREENWOOD_TOLERANCE = 1e-5  # relative misfit of the pressure
CONTACT = newton.central_gap(0.0)

Iteration = Callable[[ContactProblem, Array], relaxation.Relaxed]


@dataclass(frozen=True)
class Attempt:
    """How one iteration fared at a Tabor parameter; without sweeps if it did not converge.

    The outcome is the largest deviation of the load from Newton's, or why there is none; Newton's method goes through a
    dozen central gaps from far away.
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
