"""Attard & Parker's false rise of the pull-off force, made on purpose: uniform triangles too wide for the spike.

An interval wider than the spike of tension at the contact edge pins the edge to the nodes: the load ripples as the
edge goes from one to the next, and its least value lies deeper than the true pull-off, [G97] section 4b.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from halfspace.elastic import compliance, grid
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath, transfer
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
    """The curve near pull-off on a uniform grid.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    spacing : float
        Of the nodes, in beta.
    approach, load : (n,) arrays
        In eps and R dgamma, at falling contact radii.
    """

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


def ripple(path: EquilibriumPath, spacing: float, window: float, steps: int = STEPS_DRAWN) -> Ripple:
    """Separate the surfaces through pull-off on uniform triangles, from a resolved path's state in contact.

    The contact radius is prescribed, which goes on falling where approach and load ripple.

    Parameters
    ----------
    path : EquilibriumPath
        Resolved curve.
    spacing : float
        Of the nodes, in beta.
    window : float
        Contact radii followed on both sides of that at pull-off, in beta.
    steps : int
        Of the contact radius to a spacing.

    Raises
    ------
    halfspace.errors.NotConverged
        If the coarse grid has no state near the resolved one.
    """
    problem = Unguarded(compliance.triangles(grid.uniform(EXTENT, spacing)), path.tabor)
    centre = path.events["pull_off"].contact_radius
    radii = np.arange(centre + window, centre - window, -spacing / steps)
    values = np.array(list(_separated(problem, _start(path, problem, radii[0]), radii)))
    return Ripple(path.tabor, spacing, values[:, APPROACH], values[:, LOAD])


def _start(path: EquilibriumPath, problem: ContactProblem, radius: float) -> Array:
    """Resolved state near a contact radius, moved to the coarse grid."""
    source = path.segments[-1]
    near = min(source.points, key=lambda point: abs(float(point.observables[CONTACT_RADIUS]) - radius))
    return transfer(source.problem, near.x, problem)


def _separated(problem: ContactProblem, x: Array, radii: Array) -> Iterator[Array]:
    """Observables at falling contact radii."""
    for radius in radii:
        solution = newton.solve(problem, x, newton.contact_radius(radius))
        x = solution.x
        yield solution.observables


def false_rise(paths: Sequence[EquilibriumPath], spacing: float) -> Rise:
    """Pull-off at rising Tabor parameters on one spacing, until the rise is proved or the grid has no solution."""
    found: list[Ripple] = []
    for path in paths:
        try:
            found.append(ripple(path, spacing, WINDOW * spacing, STEPS))
        except NotConverged as error:
            return Rise(tuple(found), f"no solution at mu = {path.tabor:.3g}: {error}")
        if found[-1].pull_off < ENOUGH:
            return Rise(tuple(found), f"the load is below {ENOUGH:g} R dgamma")
    return Rise(tuple(found), "no larger mu was asked for")
