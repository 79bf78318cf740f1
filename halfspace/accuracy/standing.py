"""Events of a body with a length, each on a grid of its own that stands still."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Protocol

import numpy as np

from halfspace.accuracy.finite_bodies import CHARTS, SizedBody
from halfspace.accuracy.stages import Charted, Discretised
from halfspace.equilibrium.charts import Chart, Stage, moved, settled, undeformed_radius
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.newton import Traceable
from halfspace.errors import Unsolved


@dataclass(frozen=True, eq=False, repr=False)
class WhereAsked(Stage):
    """A stage whose charts are made when first asked for, each with the contact radii from and to which it serves."""

    made: list[tuple[float, float, Chart]] = field(default_factory=list, compare=False, repr=False, kw_only=True)

    @abstractmethod
    def make(self, radius: float) -> tuple[float, float, Chart]:
        """Chart for a contact radius in beta, and the radii from and to which it serves."""

    def __call__(self, event: Located) -> Chart:
        """Chart for a state: its own, on which it may have moved by more than that serves, or one that serves it."""
        own = next((chart for *_, chart in self.made if chart.problem is event.problem), None)
        return own or self.serving(_radius(event))

    def serving(self, radius: float) -> Chart:
        """Chart that serves a contact radius in beta, made unless one made before will do."""
        if not any(least <= radius <= most for least, most, _ in self.made):
            self.made.append(self.make(radius))
        return next(chart for least, most, chart in self.made if least <= radius <= most)

    @property
    def unknowns(self) -> int:
        """Most unknowns of a chart made so far."""
        return max((chart.unknowns for *_, chart in self.made), default=0)


class Gridded(Protocol):
    """A body that a grid can be made on for any contact radius."""

    @property
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""

    def standing(self, radius: float) -> Chart:
        """Chart that stands still, its cells finest at a contact radius in beta, or on the axis."""


@dataclass(frozen=True, eq=False, repr=False)
class Standing(WhereAsked):
    """A stage on which every event has a grid of its own that stands still, finest where its contact ends.

    `along` makes the stage for the points of a curve when it is first asked for. `near` is the stage for an event that
    is lost on its own grid, or lies where that turns the path, see `moved`; that of a curve if it is not given.
    """

    body: Gridded
    along: Callable[[], Stage]
    near: Stage | None = None

    def make(self, radius: float) -> tuple[float, float, Chart]:
        """Chart for a contact radius in beta, and the radii from and to which it serves."""
        length, near = self.body.length, CHARTS.near * self.body.length
        if radius <= length:
            return 0.0, length, self.body.standing(0.0)
        return radius - near, radius + near, self.body.standing(radius)

    def __call__(self, event: Located) -> Chart:
        """Chart for a state: one that follows the contact if the state needed such a grid before."""
        return self._following(event) if event.followed else super().__call__(event)

    def moved(self, event: Located, problem: Traceable) -> Located | Unsolved:
        """Solve for an event on a grid that stands still, or near to it on one that follows the contact.

        Over a grid that stands still Newton's method does not take an edge as sharp as it is between its cells far.
        Where the load hardly changes along the path, as at the pull-off of a wide contact, that edge makes it turn
        wherever the grid was made: an event then stays there on every grid, and its changes tell nothing. One that has
        only moved out of the finest cells stands still again where the other grid found it.
        """
        found = moved(event, problem)
        if found and event.followed:
            return replace(found, followed=True)
        alike = found if found and _alike(found, event) else None
        if alike and abs(_radius(alike) - _radius(event)) <= self.body.length:
            return alike
        found = settled(alike or event, self._following, moved)
        return found and replace(found, followed=not alike)

    @property
    def _following(self) -> Stage:
        return self.near or self.everywhere

    @cached_property
    def everywhere(self) -> Stage:
        """That for the points of a curve."""
        return self.along()


def _radius(event: Located) -> float:
    """Contact radius in beta on the undeformed surface, 0 without contact."""
    return float(np.nan_to_num(undeformed_radius(event.problem, event.point)))


def _alike(found: Located, event: Located) -> bool:
    """Whether the path turns about as fast where an event was found as where it was before."""
    return not event.condition.stationary or 1 / CHARTS.alike < found.slope / event.slope < CHARTS.alike


@dataclass(frozen=True, eq=False, repr=False)
class Following(WhereAsked):
    """A stage whose charts follow the contact, each near a radius where it was asked for.

    Their operators leave so much of loads in R dgamma and gaps in eps.
    """

    body: SizedBody
    left: float

    def make(self, radius: float) -> tuple[float, float, Chart]:
        """Chart for a contact radius in beta, and the radii from and to which it serves."""
        return self.body.around(radius, self.left)


def standing(body: SizedBody, left: float) -> Standing:
    """Stage on which every event has cells of its own: one operator, where a chart that follows the contact takes five.

    Points of the curve share operators interpolated between radii, which leave so much of loads in R dgamma and gaps in
    eps.
    """
    return Standing(body, partial(_along, body, left), Following(body, left))


def _along(body: SizedBody, left: float) -> Stage:
    return Charted(body.curve(left))


def sized(body: SizedBody, nodes: int) -> Discretised:
    """A body on cells of so many nodes each."""
    return body.curve, standing(body, left_between(nodes))


def left_between(nodes: int) -> float:
    """What the operators between those of a curve may leave, R dgamma or eps, by the nodes in a cell.

    It is 1e-2 of what the nodes leave at 1e-6, less for a node more, so that the change from rung to rung tells their
    error too.
    """
    return float(10.0 ** (-4 - nodes / 2))
