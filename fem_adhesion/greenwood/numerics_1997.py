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
from functools import partial

import numpy as np

from fem_adhesion.common import relaxation
from fem_adhesion.common.fold_birth import approached
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.kernel import ring_kernel
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import transfer
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import Unsolved, tried
from halfspace.values import Array, Valued

EXTENT = 6.0  # radius of uniform grids in beta: less than 0.6 % of the pull-off load is lost beyond it for mu >= 1
NODES = 200  # of the iterations' uniform triangles, to EXTENT, or to EXTENT/sqrt(mu) below mu = 1


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
    steps: int = 30,
    body: Callable[[Array], ElasticOperator] = compliance.triangles,
) -> Ripple:
    """Separate the surfaces through pull-off on uniform nodes, from a resolved path's state in contact.

    The nodes are apices of triangles of pressure, unless `body` makes another operator on them. The contact radius is
    prescribed, which goes on falling where approach and load ripple: from a window in beta above that at pull-off to as
    far below, in a number of steps to a spacing. NotConverged if the coarse grid has no state near the resolved one.
    """
    operator = body(grid.uniform(EXTENT, spacing))
    problem = ContactProblem(operator, path.tabor)  # too coarse, which no one asks of it here
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
    paths: Sequence[EquilibriumPath],
    spacing: float,
    body: Callable[[Array], ElasticOperator] = compliance.triangles,
    *,
    window: float = 2.0,
    steps: int = 12,
) -> tuple[Ripple, ...]:
    """Pull-off at rising Tabor parameters on one spacing, until the rise is proved or the grid has no solution.

    The window is in spacings: the period of the ripple is one. Only the least load matters, so that a dozen steps of
    the contact radius to a spacing do. A load below -7.5 R dgamma proves the rise.
    """
    found: list[Ripple] = []
    for path in paths:
        uneven = tried(ripple, path, spacing, window * spacing, steps, body)
        if isinstance(uneven, Unsolved):
            break
        found.append(uneven)
        if uneven.pull_off < -7.5:
            break
    return tuple(found)


# Iterations

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
    """Each iteration at several Tabor parameters; Greenwood's, which may take `most_sweeps`, at a few, for its time."""
    every: dict[str, Iteration] = {
        f"simple relaxation, c = {c:g}": partial(relaxation.simple, control=CONTACT, relaxation=c)
        for c in (0.05, 0.005)
    }
    greenwood = partial(relaxation.greenwood, control=CONTACT, relaxation=1.5, tolerance=1e-5, most_sweeps=most_sweeps)
    for tabor in (0.05, 0.2, 0.5, 1.0, 2.0, 3.0):
        outer = EXTENT / np.sqrt(min(tabor, 1.0))
        problem = ContactProblem(compliance.triangles(grid.uniform(outer, outer / (NODES - 1))), tabor)
        began = time.perf_counter()
        solution = newton.solve(problem, approached(problem, 0.02), CONTACT)
        spent, load = time.perf_counter() - began, float(solution.observables[LOAD])
        start = problem.undeformed(1.0)
        start[:-2] = np.maximum(start[:-2], 0.0)
        slow: dict[str, Iteration] = {"Greenwood's, relaxation 1.5": greenwood} if tabor in (0.05, 1.0, 3.0) else {}
        for name, iterate in (every | slow).items():
            began, found = time.perf_counter(), tried(iterate, problem, start)
            if isinstance(found, Unsolved):
                sweeps, outcome = None, found.reason
            else:
                off = abs(found.observables[LOAD] - load)
                sweeps, outcome = found.sweeps, f"load within {off:.0e} R dgamma of Newton's"
            yield Attempt(tabor, name, sweeps, outcome, time.perf_counter() - began, spent)
