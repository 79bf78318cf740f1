"""Charts: the discretisations of one contact over which its curve is traced, and the way from one to another.

A chart is a discretisation fit for one stretch of the path. The half-space needs two: a grid centred on the axis while
the surfaces are apart or just touch, and one that follows the edge of the contact. A mesh fine enough everywhere is
a single chart.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from halfspace.equilibrium import newton
from halfspace.equilibrium.conditions import Located, relocate, same_place
from halfspace.equilibrium.contact import CONTACT_RADIUS, LOAD, WIDEST, ContactProblem
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Metric, Point, Segment, Steps, follow, solved_point
from halfspace.errors import Unsolved, required
from halfspace.values import Array, Valued

COMPRESSION = 5.0  # load in R dgamma at which a curve ends unless asked otherwise


@dataclass(frozen=True, eq=False, repr=False)
class Chart(Valued):
    """A discretisation and its unknowns.

    The curve leaves it where the undeformed contact radius exceeds `until`, an event of the curve, found on any other,
    where its contact radius exceeds `leave`; both in beta, infinite where it serves any.
    """

    problem: Traceable
    unknowns: int
    until: float = np.inf
    leave: float = np.inf

    def left(self, point: Point) -> bool:
        """Whether the contact at a point has left what the chart serves, or fills the body as allowed."""
        body = self.problem.interface.profile.end
        return undeformed_radius(self.problem, point) > (WIDEST * body if np.isinf(self.until) else self.until)


class Stage(Valued, ABC):
    """A discretisation by charts on which events and points of a path, found on another, are solved for again."""

    @abstractmethod
    def __call__(self, event: Located) -> Chart:
        """Chart for an event, or for a point of a path."""

    @property
    @abstractmethod
    def unknowns(self) -> int:
        """Most unknowns of a chart made so far."""

    @property
    def everywhere(self) -> Stage:
        """The same for every point of a path: itself, unless its charts are for events."""
        return self

    def moved(self, event: Located, problem: Traceable) -> Located | Unsolved:
        """Solve for an event again on a chart made for where it was found."""
        return moved(event, problem)


def metric_for(problem: Traceable) -> Metric:
    """Units by which a curve's long branches take about as many steps at every Tabor parameter, law and profile."""
    scales = problem.interface.scales
    return Metric(approach=2 * (1 + scales.tabor), load=scales.largest_load)


def trace_charts(
    charts: Iterable[Chart], to_load: float = COMPRESSION, steps: Steps | None = None
) -> tuple[Segment, ...]:
    """Trace the curve from far separation to a compressive load over the charts in order, as many as it takes.

    NotConverged if the continuation gets stuck.
    """
    segments: list[Segment] = []
    for chart in charts:
        problem, metric = chart.problem, metric_for(chart.problem)
        first = problem.interface.scales.separated_approach - 10
        point = _hand_over(segments[-1], problem, metric) if segments else separated(problem, first, metric)
        ended = _ended(to_load, problem.interface.profile.end)
        points = follow(problem, required(point), metric, _left(chart, ended), steps=steps or _pace(segments))
        segments.append(Segment(problem, tuple(required(points))))
        if ended(segments[-1].points[-1]):
            break
    return tuple(segments)


def _ended(to_load: float, body: float) -> Callable[[Point], bool]:
    """Stop under a compressive load, or where the body is drawn flat: its contact is wider, and the load falls."""
    return lambda p: bool(
        p.observables[LOAD] >= to_load or (p.observables[CONTACT_RADIUS] > body and p.rates[LOAD] < 0)
    )


def _left(chart: Chart, ended: Callable[[Point], bool]) -> Callable[[Point], bool]:
    """Stop there, or where a chart is left."""
    return lambda point: ended(point) or chart.left(point)


def _pace(before: Sequence[Segment]) -> Steps:
    """Steps to begin with: far apart, where the path is straight, the longest; else as the last one."""
    last = [point.arclength for segment in before[-1:] for point in segment.points[-2:]]
    usual = Steps()
    return replace(usual, first=(last[-1] - last[0] or usual.first) if last else usual.longest)


def undeformed_radius(problem: Traceable, point: Point) -> float:
    """Radius in beta that the point at the contact edge has on the undeformed body; nan without contact."""
    if problem.interface is problem:
        return float(point.observables[CONTACT_RADIUS])
    return problem.interface.contact_radius(problem.surface_state(point.x))


def separated(problem: Traceable, approach: float, metric: Metric) -> Point | Unsolved:
    """Point on the separated branch at an approach, heading towards contact."""
    control = newton.approach(approach)
    return solved_point(problem, problem.undeformed(approach), control, metric, control.weights)


def _hand_over(segment: Segment, problem: Traceable, metric: Metric) -> Point | Unsolved:
    """Solve the last state of a segment again on the next chart, at the same contact radius if there is one."""
    last = segment.points[-1]
    radius = float(last.observables[CONTACT_RADIUS])
    start = transfer(segment.problem, last.x, problem)
    if np.isnan(radius):
        return same_place(last, problem, start, metric)
    direction = metric.weights * last.rates
    return solved_point(problem, start, newton.contact_radius(radius), metric, direction, last.arclength)


def transfer(source: Traceable, x: Array, target: Traceable) -> Array:
    """Interpolate a state of one problem as a start for another: what of its gaps is smooth, see `Traceable.rough`."""
    surface, state, other = source.interface, source.surface_state(x), target.interface
    alpha, body = state[-2], surface.nodes_at(state)
    scale = surface.contact_radius(state) if other.follows_contact else 1.0
    radii = other.operator.nodes(scale).radii
    inside = radii < body.extent
    within, beyond = radii[inside], radii[~inside]
    gaps = np.empty(radii.size)
    gaps[inside] = body.values_at(within, state[:-2] - source.rough(body.radii, alpha)) + source.rough(within, alpha)
    gaps[~inside] = surface.rough(beyond, alpha) + _deflection_beyond(surface, state, beyond)
    return target.state_from_surface(np.concatenate([gaps, [alpha, scale]]))


def _deflection_beyond(source: ContactProblem, x: Array, radii: Array) -> Array:
    """Deflection in eps past the extent of the source's grid, by its infinite cell or else as under a point load."""
    body = source.nodes_at(x)
    if body.beyond.size:
        return body.values_beyond(radii, source.deflection(x))
    return np.asarray(source.tabor * source.load(x) / (np.pi * radii))


def placed(stage: Stage, state: Located) -> Located | Unsolved:
    """Solve for a state again on another discretisation, in the plane across the path there."""
    problem, point = stage(state).problem, state.point
    if problem is state.problem:
        return state
    start, metric = transfer(state.problem, point.x, problem), metric_for(problem)
    there = same_place(point, problem, start, metric)
    return there and replace(state, problem=problem, point=there)


def moved(event: Located, problem: Traceable) -> Located | Unsolved:
    """Solve for an event again on another discretisation."""
    start = transfer(event.problem, event.point.x, problem)
    return relocate(event, problem, start, metric_for(problem))


def settled(
    state: Located, stage: Stage, solve: Callable[[Located, Traceable], Located | Unsolved]
) -> Located | Unsolved:
    """Solve for a state on a stage, and once more wherever it comes to lie in the reach of another chart."""
    found: Located | Unsolved = state
    tried = set[int]()
    for _ in range(MOVES + 1):
        if not found or id(problem := stage(found).problem) in tried:
            return found
        tried.add(id(problem))
        found = solve(found, problem)
    return Unsolved("an event lies elsewhere on every grid that is made around it; take a smaller rtol")


MOVES = 5  # of a state from chart to chart, after which the last must be one made for where it lies
