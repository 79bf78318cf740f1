"""Bodies with a length of their own: charts that follow the contact although no single compliance serves all radii.

The compliance on cells that move with the contact edge is a smooth function of the contact radius: a polynomial through
those at a few radii serves all between, see `halfspace.elastic.operators.Interpolated`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.elastic.kernel import require_memory
from halfspace.elastic.operators import ROOM, Interpolated, MovingGrid, Piecewise, chebyshev_lengths, kernels_of
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.contact import WIDEST, contact_of, require_narrow
from halfspace.profiles import Surface
from halfspace.scales import Scales
from halfspace.values import Array, Valued


@dataclass(frozen=True)
class ChartSettings:
    """Where a curve goes over from the chart fine on the axis to that which follows the contact, and how that is made.

    Events go over elsewhere than the curve: with the radius of the curve their estimates were 1000 times as large.
    """

    equal: int = 3  # cells of equal length on the axis, which carry a contact wherever it ends in them
    leave: float = 0.8  # of these cells: the contact radius at which the curve leaves the chart on the axis
    events: float = 1.0  # cells: the radius at which an event does
    farther: float = 3.0  # times the widest contact that is planned for, as a rigid one on a blunt cone is
    nearly: float = 0.99  # of a body, which the last point of a curve may be as wide as
    most: int = 16  # operators in a part of a chart: each state combines them all
    together: int = 4  # grids integrated at once: with all of a curve's it took 0.18 GB more, and no less time
    across: float = 60.0  # R dgamma or eps, what a polynomial through no operator would err by; measured: 10 to 100
    roughly: float = 0.01  # R dgamma or eps, what the operator of a curve may leave whose events are solved for again
    around: float = 1.005  # by which contact radii differ from where a chart for one event is made: by four or five
    # operators, 1.05 took six or seven, at 1.002 what rounding leaves in their differences moved pull-off on coatings
    steps: int = 25  # per unit of the logarithm: charts end where those of like contacts do, to be the same
    near: float = 0.1  # finest cells that a contact may end away from the place for which a grid that stands was made
    alike: float = 2.0  # ratio of how fast the path turns on two grids: 0.8 to 1.3 on common ones, 3 to 1e6 where a
    # grid turns it


CHARTS = ChartSettings()

Made = tuple[ElasticOperator, int]


@dataclass(frozen=True, eq=False, repr=False)
class SizedBody(Valued):
    """A body that is discretised anew on any grid of its surface.

    `make` gives the operator and its number of unknowns from the ends of all cells, in the coordinate along the
    surface. `finest` is the length of the cells at the contact edge, in widths of the spike of tension there, `growth`
    the most ratio of neighbouring cells. `outer` (k,) are the last cells' ends, ascending, which do not move with the
    contact: their first is where the others end, the last of which is `last` long, in beta, if they are to be fine
    there too; see `at_equator`. Charts for a curve reach as far as the contact under the compressive load `to_load`, in
    R dgamma. No cell on the axis is longer than `first`, in beta; see `at_tip`. Where that is less work, `together`
    makes what `make` does of several grids, (n, m + 1), at once. In the logarithm of the contact radius the kernel is
    analytic up to `strip` beside the real axis: pi, where a node is the image of another, or pi/2 on strata, whose
    images lie at their depth times i. Charts for a curve are made for contacts as wide as `planned`, in beta, at most.
    """

    scales: Scales
    make: Callable[[Array], Made]
    finest: float
    growth: float
    outer: Array
    coordinate: SurfaceCoordinate
    last: float = np.inf
    to_load: float = COMPRESSION
    first: float = np.inf
    together: Callable[[Array], list[Made]] | None = None
    strip: float = np.pi
    planned: float = np.inf

    @property
    def length(self) -> float:
        """Length of the cells at the contact edge, or on the axis, in beta."""
        return self.scales.edge_cell(self.finest)

    @property
    def _growth(self) -> float:
        return self.scales.growth(self.growth)

    @property
    def leave(self) -> float:
        """Contact radius in beta from which on the other chart serves an event."""
        return CHARTS.events * self.length

    @property
    def _reach(self) -> float:
        return min(CHARTS.equal * self.length, float(self.outer[0]) / 2)

    def lines(self, edge: float = 0.0) -> Array:
        """Ends of all cells that are finest at a contact edge, in the surface's coordinate, or on the axis.

        ContactTooWide unless the cells that move reach beyond the edge.
        """
        end, until = float(self.outer[0]), edge or self._reach
        require_narrow(edge, CHARTS.nearly * end)
        lines = grid.graded(edge, self.length, end, growth=self._growth, last=self.last, until=until)
        return np.concatenate([grid.towards_axis(lines, self.first, self._growth), self.outer[1:]])

    def centred(self) -> Chart:
        """Chart fine on the axis; of its equal cells the curve leaves a part, an event those beyond `leave`."""
        return replace(self.standing(0.0), until=CHARTS.leave * self._reach, leave=self.leave)

    def standing(self, radius: float) -> Chart:
        """Chart that stands still, finest at a contact radius in beta, or on the axis."""
        operator, unknowns = self.make(self.lines(self.coordinate.of(radius)))
        return Chart(contact_of(self.scales, replace(operator, coordinate=self.coordinate)), unknowns)

    def made(self, lines: Array) -> list[Made]:
        """Operators on some grids, and their numbers of unknowns; lines (n, m + 1).

        GridTooLarge if the store has no room for all: each state would take all of them anew.
        """
        made: list[Made] = []
        for few in np.array_split(lines, math.ceil(len(lines) / CHARTS.together)):
            made += self.together(few) if self.together else [self.make(one) for one in few]
            nodes = made[0][0].radii.size
            whose = f"{nodes} nodes at {len(lines)} contact radii, whose kernels"
            require_memory(8 * len(lines) * nodes**2, ROOM, whose)
        return made

    def curve(self, error: float = CHARTS.roughly) -> tuple[Chart, Chart]:
        """Charts for the whole curve; that which follows the contact errs by so much in loads, R dgamma, or gaps, eps.

        Narrow parts of few operators each serve wide ranges of contact radii: only those that are met are made. There
        are some for contacts wider than is planned for, as that of a rigid body may be: beyond its ends a polynomial
        leaves any error.
        """
        body, end = self.scales.profile.end, self._widest
        widest = min(step_above(self.scales.widest_radius(self.to_load)), WIDEST * body, self.planned)
        require_narrow(widest, end)
        farther = max(widest, min(CHARTS.farther * widest, CHARTS.nearly * body, end))
        ends, counts = self._parts(min(self.leave, widest / 2), farther, error)
        return self.centred(), self.over(ends, counts, widest)

    def around(self, radius: float, error: float) -> tuple[float, float, Chart]:
        """Chart for a contact radius in beta, erring as that of a curve, and the radii from and to which it serves.

        So do its derivatives by the logarithm of the radius, which between radii so near err by more. It is the one
        fine on the axis for contacts that this serves, else one that follows them near the radius.
        """
        if radius <= self.leave:
            return 0.0, self.leave, self.centred()
        require_narrow(radius, self._widest)
        least, most = radius / CHARTS.around, min(CHARTS.around * radius, self._widest)
        count = self.operators_between(least, most, error * math.log(CHARTS.around))
        # Inside the edge cells are as long as outside where the contact is half as wide as is planned for.
        return least, most, self.over([least, most], [count], widest=2 * most)

    @property
    def _widest(self) -> float:
        """Contact radius in beta that the cells which move can carry."""
        return float(self.coordinate.radius(CHARTS.nearly * self.outer[:1])[0][0])

    def _parts(self, least: float, most: float, error: float) -> tuple[list[float], list[int]]:
        """Ends of the parts of a range of contact radii, ascending, and how many operators serve each."""
        ends = [least]
        while ends[-1] < most:
            ends.append(min(most, self._served_to(ends[-1], error)))
        return ends, [*[CHARTS.most] * (len(ends) - 2), self.operators_between(ends[-2], ends[-1], error)]

    def over(self, ends: Sequence[float], counts: Sequence[int], widest: float) -> Chart:
        """Chart that follows the contact edge, in parts between contact radii (k + 1,), from so many operators (k,).

        It is fine enough for all: the cells inside the edge are twice as long as those outside where the contact is
        as wide as is planned for, and shorter where it is narrower.
        """
        x = [self.coordinate.of(a) for a in ends]
        edge = self.coordinate.of(widest)
        rest = float(self.outer[0]) - x[0]
        inner = 1 - grid.geometric(1.0, 2 * self.length / edge, self._growth)[::-1]
        inner = grid.towards_axis(inner, self.first / widest, self._growth)
        moving = self._moving(inner, grid.geometric(rest, self.length, self._growth, self.last) / rest)
        lengths = [chebyshev_lengths(*between, count) for between, count in zip(pairwise(x), counts, strict=True)]
        kernel = Piecewise(np.array(x), lengths, partial(_kernels, self, moving))
        made = self.made(moving.lines_at(lengths[0]))
        kernel.kernels(0, kernels_of([operator for operator, _ in made]))
        operator = Interpolated(kernel, made[0][0].cell_nodes, moving)
        return Chart(contact_of(self.scales, operator), made[0][1])

    def _moving(self, inner: Array, outside: Array) -> MovingGrid:
        """Grid from the ends of cells inside the edge, as parts of x_a, and outside, as parts of the rest."""
        inner[0], inner[-1], end = 0.0, 1.0, float(self.outer[0])
        fixed = np.concatenate([0 * inner, end * outside[1:], self.outer[1:]])
        moving = np.concatenate([inner, 1 - outside[1:], 0 * self.outer[1:]])
        return MovingGrid(fixed, moving, self.coordinate)

    def operators_between(self, least: float, most: float, error: float) -> int:
        """Operators between two contact radii by which a polynomial leaves an error of loads, R dgamma, or gaps, eps.

        In the logarithm of the edge's coordinate the kernel is analytic up to `strip` beside the real axis and along it
        up to the end of the cells that move. The polynomial through n errs by rho^-n, rho the sum of the half axes, in
        windows, of the ellipse around the window that reaches so far (Bernstein), in parts of what yields `softest`
        times as much as a half-space of E*.
        """
        low, high = (np.log(self.coordinate.of(a)) for a in (least, most))
        window = (high - low) / 2
        end = (np.log(float(self.outer[0])) - (high + low) / 2) / window
        # Where the cells end within the window, more than ever pay.
        log_rho = min(np.arcsinh(self.strip / window), np.arccosh(max(end, 1.1)))
        return max(2, int(np.ceil(self._decay(error) / log_rho)))

    def _served_to(self, least: float, error: float) -> float:
        """Widest contact radius up to which `CHARTS.most` operators serve from another, see `operators_between`."""
        log_rho = self._decay(error) / CHARTS.most
        x = self.coordinate.of(least)
        beyond = np.log(float(self.outer[0]) / x)
        window = min(self.strip / np.sinh(log_rho), beyond / (np.cosh(log_rho) + 1))
        return float(self.coordinate.radius(x * np.exp(2 * window))[0])

    def _decay(self, error: float) -> float:
        """Logarithm of what a polynomial through no operator would err by, in errors that it may leave."""
        return float(np.log(CHARTS.across * self.scales.softest / error))


def _kernels(body: SizedBody, moving: MovingGrid, edges: Array) -> Array:
    """Kernels on a grid at the places (n,) of a contact edge, in the surface's coordinate."""
    return kernels_of([operator for operator, _ in body.made(moving.lines_at(edges))])


def at_equator(tabor: float, profile: Surface, nodes: int) -> float:
    """Length in beta of the last cell at the equator of a sphere, r = R, where its profile has a vertical tangent.

    Cells that grow from there on as they do from the contact edge leave as little of the root of the distance as of
    anything else, but for the last. What a rule of its nodes leaves there is of the order d^(3/2) of its length d in R,
    times h^-2 in the load, h the gap: a decade less with each node more, as everywhere.
    """
    h = 1 + tabor * float(profile.height(np.array(profile.end)))
    return float(profile.end * (10.0 ** (1 - nodes) * h**2) ** (2 / 3))


def at_tip(profile: Surface, nodes: int) -> float:
    """Length in beta of the cell on the axis, infinite where that of a paraboloid will do.

    Of a pointed tip, u^k, n nodes leave n^(-2 k) of what one would.
    """
    return profile.first_cell(10.0**-nodes) * (nodes**2 if profile.pointed else 1)


def step_above(length: float) -> float:
    """The next length above of a sequence with CHARTS.steps to a factor of e."""
    return of_sequence(length, CHARTS.steps, np.ceil)


def of_sequence(length: float, steps: int, rounded: Callable[[float], float]) -> float:
    """That length of the geometric sequence with 1, so many steps to a factor of e, to which another is rounded."""
    return float(np.exp(rounded(steps * np.log(length)) / steps))
