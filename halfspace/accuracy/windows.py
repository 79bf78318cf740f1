"""The half-space under a law whose tension ends by a step, on charts that are fine where the step stands.

On a grid that follows the contact edge all cells are scaled with its radius a, but the zone of tension beyond it is
not: over a curve its end at r = a + d moves through two decades of d/a. Were cells as short as the step is narrow
wherever it may stand, they would be three times as many as at any one state. So there is a chart for each stretch of
d/a, or of r on grids that are centred on the axis, and a state is solved for on the one that is fine where its own step
stands. Each is made when it is first asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from halfspace.accuracy.finite_bodies import EQUAL, LEAVE
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium.charts import COMPRESSION, Chart, Stage
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS, contact_of
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Point
from halfspace.errors import NotConverged
from halfspace.scales import Scales
from halfspace.values import Array

# Found by trial, on errors of events and the time of curves.
STRETCH = 2.0  # ratio of the places of a step between which a chart serves
MARGIN = 1.15  # times as far beyond either end of them cells are as short
STEEP = 0.6  # of the growth of cells by the law: at a step, where as many nodes are to leave as little as elsewhere
PASSED = 2  # windows by which the last point on a chart may lie beyond its own
AHEAD = 0.5  # power of `Scales.gradual` in the growth of cells on the axis: on a flat tip the tension's end is wide
BEYOND = 5.0  # most ratio of neighbouring cells outside the step, where a law that ends by one has little tension left


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Window(Chart):
    """Chart that serves as long as the step stands between two places: r in beta, or d/a if it follows the contact."""

    least: float
    most: float
    windows: Windows = field(compare=False)

    def left(self, problem: Traceable, point: Point) -> bool:
        """Whether the contact or the step has left what the chart serves."""
        place = self.windows.place(self.problem.interface.follows_contact, problem, point)
        return super().left(problem, point) or not self.least <= place < self.most

    def onward(self, problem: Traceable, point: Point) -> Chart:
        """Chart on which the curve goes on from a point at which this one is left."""
        follows = self.problem.interface.follows_contact or super().left(problem, point)
        return self.windows.at(follows, problem, point)


@dataclass(frozen=True, eq=False, repr=False)
class Windows(Stage):
    """Charts of the half-space that are fine at a contact edge and at the step, each of the cells that it is asked for.

    Parameters
    ----------
    scales : Scales
        Of the contact.
    finest, growth : float
        Length of the cells at the contact edge, in widths of the spike there, and most ratio of neighbours.
    outer : float
        Radius in beta at which the finite cells of grids that are centred on the axis end.
    half_space : callable
        Operator on cells of given ends.
    tip, inwards : float
        Length in beta of no more than which the cell on the axis is, and ratio of neighbours towards it.
    to_load : float
        Compressive load in R dgamma up to which the contact may grow.
    """

    scales: Scales
    finest: float
    growth: float
    outer: float
    half_space: Callable[[Array], ElasticOperator]
    tip: float
    inwards: float
    to_load: float = COMPRESSION
    made: dict[tuple[bool, int], Window] = field(default_factory=dict, compare=False, repr=False)
    alike: dict[tuple[bool, bytes], int] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, event: Located) -> Window:
        """Chart for an event, or a point of a path."""
        return self.at(event.problem.interface.follows_contact, event.problem, event.point)

    @property
    def unknowns(self) -> int:
        """Most unknowns of a chart made so far."""
        return max(chart.unknowns for chart in self.made.values())

    def curve(self) -> tuple[Window]:
        """Chart on which a curve begins, with the surfaces far apart."""
        return (self._window(False, 0),)

    @property
    def everywhere(self) -> AlongCurve:
        """The same for the points of a curve, each on the cells on which it was traced."""
        return AlongCurve(self)

    def at(self, follows: bool, problem: Traceable, point: Point) -> Window:
        """Chart of either kind for a point of a path."""
        return self._window(follows, self._number(follows, problem, point))

    def _number(self, follows: bool, problem: Traceable, point: Point) -> int:
        place, first = self.place(follows, problem, point), self._first(follows)
        if follows and not place > 0:
            raise NotConverged("the tension ends inside the contact; take a smaller rtol")
        return math.floor(math.log(place / first) / math.log(STRETCH)) if follows or place > first else 0

    def of_same_cells(self, event: Located) -> Window:
        """Chart of the cells on which a point was found, which may be past the end of its window; or else its own.

        Those towards a tip are not compared: they are the longer the more nodes there are in each.
        """
        surface, point = event.problem.interface, event.point
        follows, cells = surface.follows_contact, surface.operator.at(1.0).cells
        if (key := (follows, cells.tobytes())) not in self.alike:
            number = self._number_of_same_cells(follows, cells, self._number(follows, surface, point))
            if number is None:
                return self.at(follows, surface, point)
            self.alike[key] = number
        return self._window(follows, self.alike[key])

    def _number_of_same_cells(self, follows: bool, cells: Array, own: int) -> int | None:
        """Window of these cells, one of those next to a point's own."""
        for number in range(own - PASSED if follows else max(own - PASSED, 0), own + PASSED + 1):
            lines = self._lines(follows, number)[2:]
            if np.array_equal(lines, cells[-lines.size :]):
                return number
        return None

    def place(self, follows: bool, problem: Traceable, point: Point) -> float:
        """Where the step stands on a grid of either kind: d/a, or r in beta, 0 where the surfaces are farther apart."""
        radius = problem.interface.radius_at_gap(problem.surface_state(point.x), self.scales.step_gap)
        return radius / float(point.observables[CONTACT_RADIUS]) - 1 if follows else radius

    def _first(self, follows: bool) -> float:
        """Least place of the step in the window 0: one of those on the axis begins there."""
        return 1.0 if follows else self._reach

    def _window(self, follows: bool, number: int) -> Window:
        if (follows, number) not in self.made:
            least, most = self._between(follows, number)
            operator = self.half_space(self._cells(follows, number))
            self.made[follows, number] = Window(
                contact_of(self.scales, Homogeneous(operator) if follows else operator),
                operator.radii.size,
                math.inf if follows else LEAVE * self._reach,
                least=least,
                most=most,
                windows=self,
            )
        return self.made[follows, number]

    def _between(self, follows: bool, number: int) -> tuple[float, float]:
        """Places of the step between which a window serves."""
        least, most = (self._first(follows) * STRETCH**n for n in (number, number + 1))
        return least if follows or number else 0.0, most

    def _cells(self, follows: bool, number: int) -> Array:
        tip = self.tip / (self._widest if follows else 1.0)
        return grid.towards_axis(self._lines(follows, number), tip, self.inwards)

    def _lines(self, follows: bool, number: int) -> Array:
        """Ends of the cells of a window, without those towards a tip."""
        least, most = self._between(follows, number)
        least, most = (least or most) / MARGIN, most * MARGIN
        growth, steep = self.growth, 1 + STEEP * (self.scales.growth(self.growth) - 1)
        if follows:
            first = 2 * self._length / self._widest  # as wide as it may become
            inside = 1 - grid.geometric(1.0, first, growth)[::-1]
            extent = self.outer / (LEAVE * self._reach) - 1
            outside = grid.about(first, (least, most), extent, growth=growth, within=steep, beyond=BEYOND)
        else:
            growth = 1 + (growth - 1) * self.scales.gradual**AHEAD
            first, extent = self._length, self.outer - self._reach
            inside = np.linspace(0.0, self._reach, EQUAL + 1)
            least, most = min(least - self._reach, extent / 2), min(most - self._reach, extent / 2)
            outside = grid.about(first, (least, most), extent, growth=growth, within=steep, beyond=growth)
        inside[0] = 0.0
        return np.append(inside, inside[-1] + outside[1:])

    @cached_property
    def _length(self) -> float:
        return self.scales.edge_cell(self.finest)

    @property
    def _reach(self) -> float:
        """Radius in beta up to which the cells on the axis carry a contact."""
        return EQUAL * self._length

    @cached_property
    def _widest(self) -> float:
        return self.scales.widest_radius(self.to_load)


@dataclass(frozen=True, eq=False, repr=False)
class AlongCurve(Stage):
    """Stage for the points of a curve: those of a stretch traced on one chart stay on one, to be joined to a curve."""

    windows: Windows

    def __call__(self, event: Located) -> Window:
        """Chart for a point of a curve."""
        return self.windows.of_same_cells(event)

    @property
    def unknowns(self) -> int:
        """Most unknowns of a chart made so far."""
        return self.windows.unknowns
