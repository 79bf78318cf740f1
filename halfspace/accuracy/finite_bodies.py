"""Bodies with a length of their own: charts for their load-approach curve, and operators around its events.

No single compliance serves all contact radii of such a body. The curve is traced on an operator interpolated between a
few radii (`halfspace.elastic.operators.Interpolated`). The events are then solved for on one between more of them,
across the radii of the events alone, or each on an operator of its own, made for radii close to that of the event,
where the interpolation is as good as exact: whichever takes fewer operators.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from halfspace.accuracy.stages import Charted, Rung, Standing, WhereAsked
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.elastic.operators import Interpolated, MovingGrid, chebyshev_radii
from halfspace.equilibrium.charts import COMPRESSION, Chart, Stage, moved
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS, WIDEST, contact_of
from halfspace.equilibrium.events import ErrorRule
from halfspace.equilibrium.newton import Traceable
from halfspace.errors import ContactTooWide, NotConverged
from halfspace.profiles import Surface
from halfspace.scales import Scales
from halfspace.values import Array, Valued

LEAST = 0.7  # of the radius at which the chart centred on the axis is left: the least that the other one knows
EQUAL = 3  # cells of equal length on the axis of that chart, which carry a contact wherever it ends in them
LEAVE = 0.8  # of these cells: the radius at which the chart centred on the axis is left
WINDOW, AROUND = 2e-3, 3  # half the logarithmic width of the radii around an event on the lowest rung, operators in it
WIDE, WIDELY = 0.4, 7  # the same farther around: an event that lies off by a fifth is then told to 1e-6 of its radius
ACROSS = 60.0  # R dgamma or eps, what a polynomial through no operator would err by; measured: 10 to 100
COARSEST = 1e-3  # tolerance for that: at 1e-2 landings and pull-off on hemispheres were up to 4.9 times outside
BESIDE = 0.01  # logarithmic width by which a chart for all events reaches past them: they move from grid to grid
STEPS = 25  # per unit of the logarithm: where charts begin and end, so that those of like contacts are the same
TIGHT = 1e-6  # tolerance below which a derivative that errs by the window's square is not good enough
CLIMBED = 2  # rungs up, from which on it is not either
APART = 1.7  # mean ratio of the radii between which the curve's operator is interpolated
CLOSER = 1.4  # the same of its points when they are solved for again on the lowest rung; closer on those above it
# Cells on the axis after which an event has its own that end at its contact edge: on those of the axis the estimates of
# folds were up to a thousand times too large. By finite elements they were not; a fifth of the time is saved there.
EVENTS_LEAVE = 1.0
TOGETHER = 4  # grids integrated at once: with all of a curve's at once it took 0.18 GB more, and no less time
EXACT = 1e-12  # tolerance past which they are no closer: at rtol 1e-9 they were up to thousands

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
    makes what `make` does of several grids, (n, m + 1), at once.
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

    @property
    def length(self) -> float:
        """Length of the cells at the contact edge, or on the axis, in beta."""
        return self.scales.edge_cell(self.finest)

    @property
    def _growth(self) -> float:
        return self.scales.growth(self.growth)

    @property
    def until(self) -> float:
        """Contact radius in beta up to which the chart fine on the axis serves."""
        return LEAVE * self._reach

    @property
    def _reach(self) -> float:
        return min(EQUAL * self.length, float(self.outer[0]) / 2)

    def lines(self, edge: float = 0.0) -> Array:
        """Ends of all cells that are finest at a contact edge, in the surface's coordinate, or on the axis."""
        end, until = self._end_beyond(edge), edge or self._reach
        lines = grid.graded(edge, self.length, end, growth=self._growth, last=self.last, until=until)
        return np.concatenate([grid.towards_axis(lines, self.first, self._growth), self.outer[1:]])

    def _end_beyond(self, edge: float) -> float:
        """End of the cells that move with a contact edge; ContactTooWide unless they reach beyond it."""
        end = float(self.outer[0])
        if edge >= end:
            raise ContactTooWide(
                f"contact radius = {edge:.3g} beta, limit: {end:.3g}, beyond which the body is taken as rigid; take a "
                "blunter tip, a thicker layer or the half-space solver"
            )
        return end

    def centred(self) -> Chart:
        """Chart fine on the axis."""
        return replace(self.standing(0.0), until=self.until)

    def standing(self, radius: float) -> Chart:
        """Chart that stands still, finest at a contact radius in beta, or on the axis."""
        operator, unknowns = self.make(self.lines(self.coordinate.of(radius)))
        return Chart(contact_of(self.scales, operator), unknowns)

    def following(self, moving: MovingGrid, scales: Array) -> Chart:
        """Chart that follows the contact edge, from operators at some contact radii."""
        lines = np.array([moving.lines(float(a)) for a in scales])
        made = self.made(lines)
        operator = Interpolated(scales, made[0][0].cell_nodes, moving, partial(_operators, self, lines))
        return Chart(contact_of(self.scales, operator.knowing([one for one, _ in made])), made[0][1])

    def made(self, lines: Array) -> list[Made]:
        """Operators on some grids, and their numbers of unknowns; lines (n, m + 1)."""
        if not self.together:
            return [self.make(one) for one in lines]
        some = np.array_split(lines, math.ceil(len(lines) / TOGETHER))
        return [made for few in some for made in self.together(few)]

    @property
    def radii_of_curve(self) -> tuple[float, float]:
        """Least and widest contact radius of charts for the whole curve that follow the contact."""
        widest = min(step_above(self.scales.widest_radius(self.to_load)), WIDEST * self.scales.profile.end)
        return least_along(self.until, widest), widest

    def curve(self, apart: float = APART) -> tuple[Chart, Chart]:
        """Charts for the whole curve: the second from operators at radii that are `apart` times one the other."""
        _, widest = self.radii_of_curve
        edge = self.coordinate.of(widest)
        end = self._end_beyond(edge)
        inner = self._inner(2 * self.length / edge, widest)
        outside = grid.geometric(end, self.length, self._growth, self.last)
        moving = self._moving(inner, outside / end)
        return self.centred(), self.following(moving, radii_along(self.until, widest, apart, self.scales.softest))

    def around(self, radius: float, window: float = WINDOW, count: int = AROUND) -> Chart:
        """Chart for contact radii near the given one, from so many operators, on cells fine enough for all."""
        least, most = self.span(radius, window)
        edge = self.coordinate.of(most)
        end = self._end_beyond(edge)
        inner = self._inner(self.length / edge, most)
        rest = end - self.coordinate.of(least)
        outside = grid.geometric(rest, self.length, self._growth, self.last)
        return self.following(self._moving(inner, outside / rest), chebyshev_radii(least, most, count))

    def span(self, radius: float, window: float) -> tuple[float, float]:
        """Least and widest contact radius in a window about one, inside the cells that move."""
        return radius * np.exp(-window), min(radius * np.exp(window), WIDEST * self.scales.profile.end)

    def _inner(self, last: float, widest: float) -> Array:
        """Ends of the cells inside an edge as parts of its coordinate, the last so long, for radii up to the widest."""
        lines = 1 - grid.geometric(1.0, last, self._growth)[::-1]
        return grid.towards_axis(lines, self.first / widest, self._growth)

    def _moving(self, inner: Array, outside: Array) -> MovingGrid:
        """Grid from the ends of cells inside the edge, as parts of x_a, and outside, as parts of the rest."""
        inner[0], inner[-1], end = 0.0, 1.0, float(self.outer[0])
        fixed = np.concatenate([0 * inner, end * outside[1:], self.outer[1:]])
        moving = np.concatenate([inner, 1 - outside[1:], 0 * self.outer[1:]])
        return MovingGrid(fixed, moving, self.coordinate)


def _operators(body: SizedBody, lines: Array) -> list[ElasticOperator]:
    return [operator for operator, _ in body.made(lines)]


def standing(body: SizedBody) -> Standing:
    """Stage on which every event has cells of its own."""
    return Standing(body, AlongCurve(body))


def least_along(until: float, widest: float) -> float:
    """Least contact radius of a chart for a curve, up to the widest, on which it comes from the one on the axis."""
    return min(LEAST * until, widest / 2)


def radii_along(until: float, widest: float, apart: float = APART, softest: float = 1.0) -> Array:
    """Contact radii for a curve from where the chart centred on the axis is left: one `apart` times the other.

    Or nearer, of what yields `softest` times as much as a half-space of E*: the polynomial through them errs in parts
    of that, and n more leave rho^-n. In the logarithm of the radius, what is below strata deflects them by a kernel
    that is analytic up to pi/2 beside the real axis, where a distance is the depth times i; see `operators_across`.
    """
    least = least_along(until, widest)
    side = np.pi / np.log(widest / least)
    more = np.log(softest) / np.arcsinh(side)
    return chebyshev_radii(least, widest, 2 + int(np.ceil(np.log(widest / least) / np.log(apart) + more)))


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
    """The next length above of a sequence with `STEPS` to a factor of e."""
    return of_sequence(length, STEPS, np.ceil)


def of_sequence(length: float, steps: int, rounded: Callable[[float], float]) -> float:
    """That length of the geometric sequence with 1, so many steps to a factor of e, to which another is rounded."""
    return float(np.exp(rounded(steps * np.log(length)) / steps))


def surroundings(rtol: float, level: int) -> tuple[float, int]:
    """Half the logarithmic width of the radii around an event on a rung, halved on each above it, and operators in it.

    In their middle the operator is as good as exact. Its derivative, by which a fold or an extremum is found, errs by
    the window's square with three operators, some 1e-7 of the approach at pull-off, and by its fourth power with five.
    What each operator errs by counts the more the narrower the window: under a large sphere on strata as much at a
    quarter of the lowest rung's as its square does, so that there are five where the two lowest rungs did not do.
    """
    window, count = (WINDOW, AROUND) if rtol >= TIGHT and level < CLIMBED else (2 * WINDOW, AROUND + 2)
    return window / 2**level, count


def sized_rung(
    fine: SizedBody, other: SizedBody, rtol: float, level: int, settings: Mapping[str, object], rule: ErrorRule
) -> Rung:
    """Rung of a level on which events leave the chart on the axis early, with a twin as fine as the level below."""
    stage = AroundEvents(fine, *surroundings(rtol, level), EVENTS_LEAVE)
    twin = AroundEvents(other, *surroundings(rtol, level - 1), EVENTS_LEAVE) if level else None
    return Rung(fine.curve, (stage,), settings, twin, rule)


def apart_for_events(body: SizedBody, rtol: float) -> float | None:
    """Ratio of the radii of a curve's operators by which events are found as well as on those made for each, to rtol.

    They err by no more at coarse ones, lest estimates followed them. None where that takes more of them than the curve
    for itself, and so many for each of four events.
    """
    count, apart = _as_good_as(body, min(rtol, TIGHT))
    alone = radii_along(body.until, body.radii_of_curve[1]).size + FOLLOWING * surroundings(rtol, 0)[1]
    return apart if count < alone else None


def _as_good_as(body: SizedBody, rtol: float) -> tuple[int, float]:
    """Number of a curve's operators between which one is as good as that, and the ratio of their radii."""
    least, widest = body.radii_of_curve
    count = operators_across(body, rtol, 0, math.sqrt(least * widest), math.log(widest / least) / 2)
    return count, (widest / least) ** (1 / (count - 2))


FOLLOWING = 4  # events on grids that follow the contact


def operators_across(body: SizedBody, rtol: float, level: int, radius: float, window: float) -> int:
    """Operators for one chart of all events, within so much of the logarithm of a contact radius, on a rung.

    In the logarithm of the edge's coordinate the kernel is analytic up to pi beside the real axis, where a node is the
    image of another, and along it up to the end of the cells that move. The polynomial through n of them errs by
    rho^-n, rho the sum of the half axes, in windows, of the ellipse around the window that reaches so far (Bernstein).
    There is one more on each rung, whose change tells the error: of few it falls unevenly, so that there are no fewer
    at coarser tolerances.
    """
    least, most = (np.log(body.coordinate.of(a)) for a in body.span(radius, window))
    window, middle = (most - least) / 2, (most + least) / 2
    end = (np.log(float(body.outer[0])) - middle) / window
    side, end = np.pi / window, max(end, 1.1)  # where they end within the window, more than ever pay
    rho = min(side + np.sqrt(side**2 + 1), end + np.sqrt(end**2 - 1))
    return int(np.ceil(np.log(ACROSS / min(rtol, COARSEST)) / np.log(rho))) + level


@dataclass(frozen=True, eq=False, repr=False)
class AroundEvents(WhereAsked):
    """Stage of a ladder on which events have operators made for their contact radii, all of them together or each.

    An event may leave the chart that stands on the axis earlier than the curve, which gets along with one for all
    radii: as soon as its contact is wider than so many of the cells there (`leave`). The window is half the logarithmic
    width of the contact radii that a chart for one event serves, with so many operators in it, see `surroundings`. A
    fold is where a derivative vanishes, which errs by a power of it: windows that differ from rung to rung let the
    error estimate see it. `across` tells how many operators a chart for all events has, by its middle radius and its
    window, see `operators_across`; `apart` is the ratio of the radii with operators for all points of the curve, if it
    is not to be by the window, which is so many times `wider` than `surroundings`.
    """

    body: SizedBody
    window: float = WINDOW
    count: int = AROUND
    leave: float = np.inf
    across: Callable[[float, float], int] | None = None
    apart: float | None = None
    wider: float = 1.0

    def prepare(self, events: Iterable[Located]) -> None:
        """Make one chart for all these events, where one for each takes more operators."""
        radii = sorted({radius for event in events if (radius := self._radius(event)) and not self.serving(radius)})
        if not self.across or not radii:
            return
        alone = 1 + sum(b > a * (1 + self.window) for a, b in pairwise(radii))
        least, most = 1 / step_above(np.exp(BESIDE) / radii[0]), step_above(np.exp(BESIDE) * radii[-1])
        middle, window = float(np.sqrt(least * most)), float(np.log(most / least)) / 2
        if (count := self.across(middle, window)) < alone * self.count:
            self._made_around(middle, window, count)

    def __call__(self, event: Located) -> Chart:
        """Chart for an event, made unless one made before will do."""
        radius = self._radius(event)
        return self.serving(radius) or self._made_around(radius, self.window, self.count)

    def _radius(self, event: Located) -> float:
        """Contact radius for which an event has operators; 0 on the chart that stands on the axis."""
        radius = float(event.point.observables[CONTACT_RADIUS])
        found_following = event.problem.interface.follows_contact
        return radius if found_following or radius > self.leave * self.body.length else 0.0

    def _made_around(self, radius: float, window: float, count: int) -> Chart:
        chart = self.body.around(radius, window, count) if radius else self.body.centred()
        return self.keep(radius * np.exp(-window), radius * np.exp(window), chart)

    def moved(self, event: Located, problem: Traceable) -> Located:
        """Solve for an event on a chart made for where it was found, or if that leads astray on one for farther off."""
        if not problem.interface.follows_contact:
            return moved(event, problem)
        before = float(event.point.observables[CONTACT_RADIUS])
        with suppress(NotConverged):
            found = moved(event, problem)
            if abs(found.point.observables[CONTACT_RADIUS] - before) <= ASTRAY * before:
                return found
        found = moved(event, self.body.around(before, WIDE, WIDELY).problem)
        there = self(found).problem  # from nearer; the wide chart, which errs more, is none of this stage's
        return moved(found, problem if there is self(event).problem else there)

    @cached_property
    def everywhere(self) -> AlongCurve:
        """The same grid for every point of a curve."""
        apart = 1 + (CLOSER - 1) * self.window / (self.wider * WINDOW) * 2.0 ** (AROUND - self.count)
        return AlongCurve(self.body, self.apart or max(apart, _as_good_as(self.body, EXACT)[1]))

    def by_curve(self) -> tuple[Chart, Chart]:
        """Charts for the curve that serve its events as well, but for contacts smaller than they know."""
        centred, following = self.everywhere.charts
        self.keep(0.0, 0.0, centred)
        self.keep(following.problem.interface.operator.least_radius, np.inf, following)
        return centred, following

    @cached_property
    def at_rest(self) -> Stage:
        """One operator for each state, where it is dear; a step of the law's tension would cross cells that stand."""
        return AtRest(self) if self.across and not self.body.scales.step_gap else self


@dataclass(frozen=True, eq=False, repr=False)
class AtRest(WhereAsked):
    """States that no derivative by the contact radius tells, on a stage for events: several operators tell that one.

    Each has one, as good as exact for all radii, on cells that stand still, finest where its contact ends; those made
    for events serve where there are some.
    """

    events: AroundEvents

    def __call__(self, event: Located) -> Chart:
        """Chart for a state, made unless one made before will do."""
        own = next((chart for *_, chart in self.made if chart.problem is event.problem), None)
        radius, body = float(event.point.observables[CONTACT_RADIUS]), self.events.body
        if own or not radius > body.until:
            return own or self.events(event)
        near = NEAR * body.length
        serving = self.events.serving(radius) or self.serving(radius)
        return serving or self.keep(radius - near, radius + near, body.standing(radius))


NEAR = 0.25  # of the finest cell, as for events on grids that stand still; no derivative by the radius is asked here

ASTRAY = 0.05  # of a contact radius: a leap in which a chart made for the first tells nothing about the second


@dataclass(frozen=True, eq=False, repr=False)
class AlongCurve(Stage):
    """Charts of a body for every point of its curve, made when they are first asked for.

    `apart` is the ratio of the radii between which the operator is interpolated.
    """

    body: SizedBody
    apart: float = APART

    @cached_property
    def charts(self) -> tuple[Chart, Chart]:
        """That on the axis, and that which follows the contact."""
        return self.body.curve(self.apart)

    def __call__(self, event: Located) -> Chart:
        """Chart for a point of a curve."""
        return Charted(self.charts)(event)

    @property
    def unknowns(self) -> int:
        """Unknowns of the larger chart."""
        return Charted(self.charts).unknowns
