"""The whole load-approach curve of one contact, traced over a sequence of charts, and what it carries.

A chart is a discretisation fit for one stretch of the path. The half-space needs two: a grid centred on the axis while
the surfaces are apart or just touch, and one that follows the edge of the contact. A mesh fine enough everywhere is
a single chart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cached_property
from typing import Any, NoReturn, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, WIDEST, ContactProblem
from halfspace.equilibrium.events import (
    EVENTS,
    EXTREMUM,
    FOLD,
    REMAINING,
    ZERO_LOAD,
    Condition,
    Event,
    Located,
    Tolerance,
    approach_scale,
    between,
    brackets,
    is_event,
    locate,
    relocate,
    same_place,
    tolerance_told,
    usual,
)
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import WHOLE_BODY, Metric, Point, Segment, Steps, follow, loaded_to, make_point
from halfspace.equilibrium.states import FinestCurve, States, Ways, finest_curve, require_coordinate, resampled
from halfspace.errors import ContactTooWide, InputError, NotConverged
from halfspace.limits import require_points
from halfspace.values import Array, Estimate, Valued, shown

COMPRESSION = 5.0  # load in R dgamma at which a curve ends unless asked otherwise


@dataclass(frozen=True, eq=False, repr=False)
class Chart(Valued):
    """A discretisation, its unknowns, and the undeformed contact radius (beta) up to which it serves, or infinity."""

    problem: Traceable
    unknowns: int
    until: float = np.inf


class Finest(Protocol):
    """The finest discretisation that a path was computed on."""

    def __call__(self, event: Located) -> Chart:
        """Chart for an event."""
        ...

    @property
    def unknowns(self) -> int:
        """Unknowns of its largest chart."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumPath(Valued):
    """The load-approach curve from far separation to compression, through every fold.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    segments : tuple of Segment
        Points in order on the coarsest discretisation, from which all else starts.
    events : mapping of str to Event
        ``pull_off``, ``zero_load`` and, where the curve folds, ``jump_on`` and ``jump_off``; where it has more folds,
        ``fold_2``, ``fold_3`` ... between these, solved for when one is first asked for.
    energy : Estimate
        Potential energy released from `Scales.separated_approach` on the separated branch to zero approach in contact,
        in R dgamma eps.
    stages : tuple of mappings of str to Located
        The events, and the two states of `energy`, on each discretisation from the coarsest to the finest.
    finest : callable
        Chart of the finest discretisation for an event, found on any.
    seconds : float
        Wall time of the whole computation.
    settings : mapping
        What was asked for, ``rtol`` among it, and how it was discretised.
    below : callable, optional
        The finest discretisation of the rung below the last, unless that is the curve's own.
    twin : callable, optional
        A discretisation as fine as the last but one, with other cells, or one that differs from the finest in one
        respect only where that differs from the curve's in two; for the errors of what is solved for later.
    remaining : float
        Part of the change from either to the finest that may be left.
    ways : chains of callables
        To the finest discretisation that serves the whole curve, see `halfspace.equilibrium.states.Ways`.
    margin : Estimate, optional
        How far the curve is from folding where two folds are about to be born or to merge: its least -d(alpha*)/dW in
        eps/(R dgamma). Any apparatus of a greater compliance jumps; if it is negative, so do fixed grips.
    spread : mapping of str to mapping of str to float
        By event, how far apart its numbers are in models between which the assumptions leave a choice; of no event if
        they leave none.
    """

    tabor: float
    segments: tuple[Segment, ...]
    events: Mapping[str, Event]
    energy: Estimate
    stages: tuple[Mapping[str, Located], ...]
    finest: Finest
    seconds: float = field(compare=False)
    settings: Mapping[str, Any] = field(default_factory=dict)
    below: Finest | None = None
    twin: Finest | None = None
    remaining: float = REMAINING
    ways: Ways = ()
    margin: Estimate | None = None
    spread: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    @property
    def unknowns(self) -> int:
        """Unknowns of the finest discretisation used, elastic ones included."""
        return self.finest.unknowns

    @property
    def rtol(self) -> float:
        """Relative accuracy that was asked of loads and approaches."""
        return float(self.settings["rtol"])

    @property
    def met(self) -> bool:
        """Whether the events have their loads and approaches to the accuracy asked for; `missed` says which have not.

        The folds between the jumps, as they are, do not count.
        """
        return not self.missed

    @property
    def missed(self) -> dict[str, tuple[str, ...]]:
        """By event, the numbers whose estimated errors exceed `tolerance`."""
        return self.tolerance.missed(usual(self.events))

    @property
    def tolerance(self) -> Tolerance:
        """What `rtol` means for loads and approaches."""
        return Tolerance.on(usual(self.events), self.rtol)

    def event(self, name: str) -> Event | None:
        """Event by name, or None if the curve does not have it.

        Raises
        ------
        InputError
            If no curve has an event of that name.
        """
        if not is_event(name):
            near = get_close_matches(name, EVENTS, n=1)
            remedy = (
                f'did you mean "{near[0]}"?' if near else "take one of these, or fold_2, fold_3 ... between the jumps"
            )
            raise InputError(f'event = "{name}" is none of {", ".join(EVENTS)}; {remedy}')
        return self.events.get(name)

    @property
    def jumps(self) -> bool | None:
        """Whether fixed grips jump on and off; None if it cannot be told, as `margin` is within its error of zero."""
        found = "jump_on" in self.events
        if self.margin and (abs(self.margin.value) <= self.margin.error or found != (self.margin.value < 0)):
            return None
        return found

    @property
    def approach_scale(self) -> float:
        """Size in eps that approaches are measured by, see `halfspace.equilibrium.events.approach_scale`."""
        return approach_scale(event.approach for event in usual(self.events).values())

    def __repr__(self) -> str:
        """What was asked and found: events with their errors, energy, effort."""
        events = "; ".join(map(_told, usual(self.events).values()))
        first, last = (self.segments[i].points[i].observables[APPROACH] for i in (0, -1))
        return (
            f"<EquilibriumPath of tabor {self.tabor:g}: {self.count} points on {len(self.segments)} charts, "
            f"approach {first:.4g} to {last:.4g} eps; {events}; energy released "
            f"{self.energy.value:.6g} +- {self.energy.error:.1g} R dgamma eps; "
            f"{tolerance_told(self.rtol, self.missed)}; "
            f"{self.unknowns} unknowns, {self.seconds:.2g} s; settings {shown(self.settings)}>"
        )

    @property
    def approach(self) -> Array:
        """Approach alpha* in eps, positive when pressed together, shape (points,)."""
        return self._observable(APPROACH)

    @property
    def load(self) -> Array:
        """Load W in R dgamma, positive in compression, shape (points,)."""
        return self._observable(LOAD)

    @property
    def central_gap(self) -> Array:
        """H(0) in eps, shape (points,)."""
        return self._observable(CENTRAL_GAP)

    @property
    def contact_radius(self) -> Array:
        """Contact radius in beta, nan while the central gap exceeds 3^(1/6) eps, shape (points,)."""
        return self._observable(CONTACT_RADIUS)

    @property
    def approach_error(self) -> Array:
        """Estimated errors of `approach` in eps: the exact curve passes by each point within those of its numbers."""
        return self.finest_curve.errors[:, APPROACH]

    @property
    def load_error(self) -> Array:
        """Estimated errors of `load` in R dgamma, shape (points,)."""
        return self.finest_curve.errors[:, LOAD]

    @property
    def central_gap_error(self) -> Array:
        """Estimated errors of `central_gap` in eps, shape (points,)."""
        return self.finest_curve.errors[:, CENTRAL_GAP]

    @property
    def contact_radius_error(self) -> Array:
        """Estimated errors of `contact_radius` in beta, nan without contact, shape (points,)."""
        return self.finest_curve.errors[:, CONTACT_RADIUS]

    @property
    def arclength(self) -> Array:
        """Arclength from the first point as it was traced, in the units of `Metric`, shape (points,)."""
        return np.array([point.arclength for segment in self.segments for point in segment.points])

    @property
    def metric(self) -> Metric:
        """Units of the arclength."""
        return metric_for(self.segments[0].problem)

    @property
    def points(self) -> list[Point]:
        """All points in order, on the finest discretisation."""
        return [point for segment in self.finest_curve.segments for point in segment.points]

    @property
    def count(self) -> int:
        """Number of points."""
        return sum(len(segment.points) for segment in self.segments)

    @cached_property
    def finest_curve(self) -> FinestCurve:
        """The points solved for on the finest discretisation, when they are first asked for."""
        return finest_curve(self.segments, self.ways, self.remaining, self.metric)

    def at(
        self,
        *,
        approach: ArrayLike | None = None,
        load: ArrayLike | None = None,
        central_gap: ArrayLike | None = None,
        branch: str | None = None,
    ) -> States:
        """Solve for the states that have a given approach, load or central gap.

        Parameters
        ----------
        approach, load, central_gap : array_like
            One of them, in eps, R dgamma or eps; a number or an array.
        branch : str, optional
            Part of the curve between two places where that coordinate turns, as between the folds of the approach:
            ``separated``, ``unstable``, ``contact``; see `branches`. Needed where there are several such states.

        Returns
        -------
        States
            On the finest discretisation, each number with its error at the value asked for.

        Raises
        ------
        InputError
            If there is no such state, or there are several.
        """
        asked = {"approach": approach, "load": load, "central_gap": central_gap}
        given = {name: values for name, values in asked.items() if values is not None}
        if len(given) != 1:
            names = " and ".join(given) or "nothing"
            raise InputError(f"a state is asked for by {names}, limit: one of {', '.join(asked)}; give that one")
        ((coordinate, values),) = given.items()
        return self.finest_curve.at(coordinate, values, branch)

    def states(self, condition: Condition) -> list[Located]:
        """Every state of the path as it was traced, on the coarsest grid, that meets a condition, in order."""
        return states(self.segments, condition)

    def branches(self, coordinate: str) -> dict[str, tuple[float, float]]:
        """Parts of the curve in order along which a coordinate goes in one direction, and its range on each.

        Parameters
        ----------
        coordinate : {"approach", "load", "central_gap"}
            Two folds of the approach make three branches; the four of a winding curve number the unstable ones.
        """
        return self.finest_curve.branches(require_coordinate(coordinate))

    def resampled(self, points: int) -> EquilibriumPath:
        """Return the same path with another number of points, evenly spaced in arclength.

        Raises
        ------
        InputError
            If there are fewer than two.
        """
        return replace(self, segments=resampled(self.segments, require_points(points), self.metric))

    @cached_property
    def stable(self) -> NDArray[np.bool_]:
        """Stability under fixed grips, from the inertia of the tangent, shape (points,)."""
        return np.concatenate([_stable(segment) for segment in self.finest_curve.segments])

    @cached_property
    def stable_under_dead_load(self) -> NDArray[np.bool_]:
        """Stability under a dead load: stable under fixed grips and dW/dalpha positive, shape (points,)."""
        rates = np.array([point.rates for point in self.points])
        return np.asarray(self.stable & (rates[:, LOAD] * rates[:, APPROACH] > 0))

    def _observable(self, index: int) -> Array:
        return np.array([point.observables[index] for point in self.points])


def _told(event: Event) -> str:
    return (
        f"{event.name} at approach {event.approach:.6g} +- {event.approach_error:.1g} eps, "
        f"load {event.load:.6g} +- {event.load_error:.1g} R dgamma"
    )


def _stable(segment: Segment) -> NDArray[np.bool_]:
    return np.array([segment.problem.negative_directions(point.x) == 0 for point in segment.points], dtype=bool)


def metric_for(problem: Traceable) -> Metric:
    """Units by which a curve's long branches take about as many steps at every Tabor parameter, law and profile."""
    scales = problem.interface.scales
    return Metric(approach=2 * (1 + scales.tabor), load=scales.largest_load)


def trace_charts(
    charts: Iterable[Chart],
    to_load: float = COMPRESSION,
    steps: Steps | None = None,
) -> tuple[Segment, ...]:
    """Trace the curve from far separation to a compressive load over the charts in order, as many as it takes.

    Raises
    ------
    NotConverged
        If the continuation gets stuck.
    """
    segments: list[Segment] = []
    for chart in charts:
        problem, metric = chart.problem, metric_for(chart.problem)
        point = _hand_over(segments[-1], problem, metric) if segments else _far_separation(problem, metric)
        body = problem.interface.profile.end
        radius, ended = WIDEST * body if np.isinf(chart.until) else chart.until, _ended(to_load, body)
        stop, pace = _left(problem, radius, ended), steps or _pace(problem, segments)
        segments.append(Segment(problem, tuple(follow(problem, point, metric, stop, steps=pace))))
        if ended(segments[-1].points[-1]):
            break
    return tuple(segments)


def _ended(to_load: float, body: float) -> Callable[[Point], bool]:
    """Stop under a compressive load, or where the body is drawn flat: its contact is wider, and the load falls."""
    loaded = loaded_to(to_load)
    return lambda p: loaded(p) or bool(p.observables[CONTACT_RADIUS] > body and p.rates[LOAD] < 0)


def _left(problem: Traceable, radius: float, ended: Callable[[Point], bool]) -> Callable[[Point], bool]:
    """Stop there, or where the contact leaves what a chart serves or fills the body as allowed."""
    return lambda point: ended(point) or undeformed_radius(problem, point) > radius


def _pace(problem: Traceable, before: Sequence[Segment]) -> Steps | None:
    """Steps to begin with on a body of whose unknowns the surface is but a part: half as long as the last."""
    if problem.interface is problem or not before:
        return None
    last = [point.arclength for point in before[-1].points[-2:]]
    return replace(WHOLE_BODY, first=(last[-1] - last[0]) / 2 or WHOLE_BODY.first)


def undeformed_radius(problem: Traceable, point: Point) -> float:
    """Radius in beta that the point at the contact edge has on the undeformed body; nan without contact."""
    if problem.interface is problem:
        return float(point.observables[CONTACT_RADIUS])
    return problem.interface.contact_radius(problem.surface_state(point.x))


def _far_separation(problem: Traceable, metric: Metric) -> Point:
    """First point of the path, heading towards contact."""
    control = newton.approach(problem.interface.scales.separated_approach - 10)
    solution = newton.solve(problem, problem.undeformed(control.target), control)
    return make_point(problem, solution, metric, control.weights, 0.0)


def _hand_over(segment: Segment, problem: Traceable, metric: Metric) -> Point:
    """Solve the last state of a segment again on the next chart, at the same contact radius."""
    last = segment.points[-1]
    radius = float(last.observables[CONTACT_RADIUS])
    start = transfer(segment.problem, last.x, problem)
    solution = newton.solve(problem, start, newton.contact_radius(radius))
    return make_point(problem, solution, metric, metric.weights * last.rates, last.arclength)


def transfer(source: Traceable, x: Array, target: Traceable) -> Array:
    """Interpolate a state of one problem as a start for another."""
    return target.state_from_surface(_transfer(source.interface, source.surface_state(x), target.interface))


def _transfer(source: ContactProblem, x: Array, target: ContactProblem) -> Array:
    """Interpolate the deflection: gaps are as steep as the profile, and in the cells' polynomials may turn negative."""
    alpha, body = x[-2], source.operator_at(x)
    scale = source.contact_radius(x) if target.follows_contact else 1.0
    radii = target.operator.at(scale).radii
    inside = radii < body.extent
    deflection = np.empty(radii.size)
    deflection[inside] = body.values_at(radii[inside], source.deflection(x))
    deflection[~inside] = _deflection_beyond(source, x, radii[~inside])
    return np.concatenate([source.tabor * source.profile.height(radii) - alpha + deflection, [alpha, scale]])


def _deflection_beyond(source: ContactProblem, x: Array, radii: Array) -> Array:
    """Deflection in eps past the extent of the source's grid, by its infinite cell or else as under a point load."""
    body = source.operator_at(x)
    if body.beyond.size:
        return body.values_beyond(radii, source.deflection(x))
    return np.asarray(source.tabor * source.load(x) / (np.pi * radii))


def placed(finest: Finest, problem: Traceable, point: Point) -> tuple[Traceable, Point]:
    """Solve for a point of the path again on another discretisation, in the plane across the path at that point."""
    target = finest(Located(FOLD, problem, point, 1.0)).problem
    if target is problem:
        return problem, point
    start = transfer(problem, point.x, target)
    return target, same_place(point, target, start, metric_for(target))


def moved(event: Located, problem: Traceable) -> Located:
    """Solve for an event again on another discretisation."""
    start = transfer(event.problem, event.point.x, problem)
    return relocate(event, problem, start, metric_for(problem))


Bracket = tuple[Traceable, Point, Point]


def states(segments: Sequence[Segment], condition: Condition) -> list[Located]:
    """Every state of a traced curve that meets a condition, in order."""
    return [state for bracket in _brackets(segments, condition) for state in _with_care(bracket, condition)]


def _brackets(segments: Sequence[Segment], condition: Condition) -> list[Bracket]:
    """Discretisation and pair of points for every state that meets a condition, in order."""
    metric = metric_for(segments[0].problem)
    return [(s.problem, a, b) for s in segments for a, b in brackets(s.problem, s.points, metric, condition)]


def _state(bracket: Bracket, condition: Condition) -> Located:
    problem, a, b = bracket
    return between(problem, a, b, condition, metric_for(problem))


def _deepest(brackets: Sequence[Bracket]) -> Located:
    """Of the extrema of the load the deepest, where the cubics through the points beside it do not leave it open."""
    expected = sorted((_least_load(a, b), i) for i, (_, a, b) in enumerate(brackets))
    found = [_state(brackets[i], EXTREMUM) for low, i in expected if low <= expected[0][0] + DEEP * abs(expected[0][0])]
    return min(found, key=lambda e: float(e.point.observables[LOAD]))


def _least_load(a: Point, b: Point) -> float:
    """Least load between two points, about, by the cubic through them."""
    t, h = np.linspace(0, 1, 9), b.arclength - a.arclength
    (f, df), (g, dg) = ((float(p.observables[LOAD]), h * float(p.rates[LOAD])) for p in (a, b))
    cubic = f + t**2 * (3 - 2 * t) * (g - f) + t * (1 - t) * ((1 - t) * df - t * dg)
    return float(np.min(cubic))


DEEP = 0.1  # of the deepest load by the cubics: others as deep are solved for as well


def find_events(segments: Sequence[Segment]) -> dict[str, Located]:
    """Solve for the events of a traced curve and name them.

    Returns
    -------
    dict of Located
        ``pull_off`` (the deepest minimum of the load), ``jump_on`` (the first fold from separation), ``jump_off`` (the
        first from compression), ``zero_load``, and the two states between which the energy is taken, ``separated``
        and ``zero_approach``.

    Raises
    ------
    NotConverged
        If the curve ends before one of those that it must have: for want of body, it is a ContactTooWide.
    """
    _require_touching(segments)
    separated = segments[0].problem.interface.scales.separated_approach

    def required(name: str, condition: Condition) -> list[Bracket]:
        return _brackets(segments, condition) or _missing(segments[-1], name)

    folds = _brackets(segments, FOLD)
    found = {"pull_off": _deepest(required("pull_off", EXTREMUM))}
    if folds:
        found |= {"jump_on": _state(folds[0], FOLD), "jump_off": _state(folds[-1], FOLD)}
    far = Condition(APPROACH, value=separated)
    found["separated"] = _state(required("separation", far)[0], far)
    for name, condition in (("zero_load", ZERO_LOAD), ("zero_approach", Condition(APPROACH))):
        found[name] = _state(required(name, condition)[-1], condition)
    return found


def _require_touching(segments: Sequence[Segment]) -> None:
    """Raise NotConverged if a barrier, or a second minimum farther out, holds the surfaces apart to the curve's end."""
    law, last = segments[0].problem.interface.law, segments[-1].points[-1].observables
    if law.outermost and last[CENTRAL_GAP] > law.innermost:
        raise NotConverged(
            f"the law holds the surfaces {last[CENTRAL_GAP]:.3g} eps apart at the curve's end, load {last[LOAD]:.3g} "
            f"R dgamma, limit: {law.innermost:.3g} eps in contact; take a larger to_load"
        )


def further_folds(segments: Sequence[Segment]) -> list[Located]:
    """Solve for the folds between the jumps, in order along a traced curve; one that is not pinned down is left out."""
    found: list[Located] = []
    for bracket in _brackets(segments, FOLD)[1:-1] if segments else ():
        with suppress(NotConverged):
            found += _with_care(bracket, FOLD)
    return found


def _with_care(bracket: Bracket, condition: Condition) -> list[Located]:
    """State between two points, or those that shorter steps between them find where its own search does not end."""
    problem, a, b = bracket
    metric = metric_for(problem)
    step, past = (b.arclength - a.arclength) / SHORTER, metric.weights * b.rates

    def beyond(point: Point) -> bool:
        return bool(past[:3] @ (point.observables - b.observables)[:3] >= 0)

    try:
        return [between(problem, a, b, condition, metric)]
    except NotConverged:
        points = follow(problem, a, metric, beyond, steps=Steps(first=step, longest=step))
        return locate(problem, points, metric, condition)


SHORTER = 4  # steps in the place of one where the curve winds too much for it


def _missing(segment: Segment, event: str) -> NoReturn:
    """Say why a curve ends before an event."""
    last, body = segment.points[-1].observables, segment.problem.interface.profile.end
    radius = last[CONTACT_RADIUS]
    if not radius >= WIDEST * body:
        raise NotConverged(
            f"the curve has no {event} before it ends at approach {last[APPROACH]:.6g} eps, load {last[LOAD]:.6g} "
            "R dgamma; take a larger to_load or a smaller rtol"
        )
    raise ContactTooWide(
        f"contact radius {radius:.3g} beta exceeds {WIDEST:g} of the body's radius, {body:.3g} beta, before {event} is "
        "reached; take a larger radius_ratio or a smaller tabor"
    )


def energy_released(located: Mapping[str, Located]) -> float:
    """Energy between the states ``separated`` and ``zero_approach`` of `find_events`, in R dgamma eps."""
    before, after = located["separated"], located["zero_approach"]
    return before.problem.energy(before.point.x) - after.problem.energy(after.point.x)
