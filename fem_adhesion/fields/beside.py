"""The half-space at the state of another body: same profile, same cells, at the same contact radius or central gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_adhesion.fields.state import State
from fem_adhesion.scene import Scene
from halfspace.elastic import compliance
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS, ContactProblem
from halfspace.values import Array, Valued

MOST_NODES = 16
"""Of a ring of the half-space."""


@dataclass(frozen=True, eq=False, repr=False)
class Beside(Valued):
    """The half-space beside a state.

    Attributes
    ----------
    pressure, gap : (q,) array
        P and H at the radii of the state.
    observables : (4,) array
        Approach, load, central gap, contact radius of the half-space.
    """

    pressure: Array
    gap: Array
    observables: Array


def half_space_beside(state: State) -> Beside:
    """Solve for the half-space by the integral equation where a body of finite elements was solved for.

    Its rings end where the elements do, except at the contact edge, but its compliance is that of the ring kernel.
    The contact radius is prescribed, or the central gap if there is no contact; approach and load are its own.

    Raises
    ------
    halfspace.errors.NotConverged
        If the half-space has no such state.
    """
    source, tabor = state.problem.operator.at(1.0), state.scene.tabor
    cells = _clear_of(source.cells, float(state.observables[CONTACT_RADIUS]))
    operator = compliance.panels(cells, min(source.cell_nodes.shape[1], MOST_NODES))
    problem = ContactProblem(operator, tabor, state.problem.law, state.problem.profile)
    start = np.append(source.values_at(operator.radii, state.gap), state.point.x[-2:])
    solution = newton.solve(problem, start, _same(state.observables))
    P, H = problem.pressure(solution.x), solution.x[:-2]
    return Beside(operator.values_at(state.radii, P), operator.values_at(state.radii, H), solution.observables)


def _clear_of(cells: Array, radius: float) -> Array:
    """Ends of rings none of which is at the contact edge: gaps jump there, by the error of their polynomials.

    Newton's method would go to and fro between the two sides of such a jump for ever.
    """
    if np.isnan(radius):
        return cells
    nearest = int(np.clip(np.abs(cells - radius).argmin(), 1, cells.size - 2))
    other = nearest - 1 if cells[nearest] <= radius else nearest + 1
    moved = cells.copy()
    moved[nearest] = (cells[nearest] + cells[other]) / 2
    return moved


def is_same_contact(scene: Scene) -> bool:
    """Whether the half-space is the scene's body, so that the two solutions differ by their errors alone."""
    return scene.body.endless


def _same(observables: Array) -> newton.Control:
    radius = float(observables[CONTACT_RADIUS])
    return newton.central_gap(float(observables[CENTRAL_GAP])) if np.isnan(radius) else newton.contact_radius(radius)
