"""The whole load-approach curve of one contact and what it carries: events, energy, points, any state in between."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from halfspace.equilibrium.charts import Stage, metric_for
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD
from halfspace.equilibrium.events import Event, Unconfirmed, WithEvents, is_fold, points_of, tolerance_told, usual
from halfspace.equilibrium.path import Metric, Point, Segment
from halfspace.equilibrium.search import states
from halfspace.equilibrium.states import FinestCurve, Ladder, finest_curve, require_coordinate, resampled
from halfspace.errors import InputError
from halfspace.limits import require_points
from halfspace.values import Array, Estimate, States, Valued, shown


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumPath(WithEvents, Valued):
    """The load-approach curve from far separation to compression, through every fold.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    segments : tuple of Segment
        Points in order on the coarsest discretisation, from which all else starts.
    events : mapping of str to Event
        ``pull_off``, ``zero_load`` and, where the curve folds, ``jump_on`` and ``jump_off``; where it has more folds,
        ``fold_2``, ``fold_3`` ... between these.
    energy : Estimate
        Potential energy released from `Scales.separated_approach` on the separated branch to zero approach in contact,
        in R dgamma eps.
    stages : tuple of mappings of str to Located
        The events, and the two states of `energy`, on each discretisation from the coarsest to the finest.
    ladder : Ladder
        Discretisations by which anything else is solved for later, and its error found.
    seconds : float
        Wall time of the whole computation.
    settings : mapping
        What was asked for, ``rtol`` among it, and how it was discretised.
    margin : Estimate, optional
        How far the curve is from folding where two folds are about to be born or to merge: its least -d(alpha*)/dW in
        eps/(R dgamma). Any apparatus of a greater compliance jumps; if it is negative, so do fixed grips.
    model_uncertainty : callable, optional
        How far apart the numbers of an event are in models between which the assumptions leave a choice, if they do.
    unconfirmed : tuple of Unconfirmed
        Folds that cannot be told: the curve as it was traced has them, but no finer grid.
    """

    tabor: float
    segments: tuple[Segment, ...]
    events: Mapping[str, Event]
    energy: Estimate
    stages: tuple[Mapping[str, Located], ...]
    ladder: Ladder
    seconds: float = field(compare=False)
    settings: Mapping[str, Any] = field(default_factory=dict)
    margin: Estimate | None = None
    model_uncertainty: Callable[[str], Mapping[str, float]] | None = field(default=None, compare=False)
    unconfirmed: tuple[Unconfirmed, ...] = ()

    @property
    def finest(self) -> Stage:
        """Finest discretisation, which has a chart for each event found on any."""
        return self.ladder.finest

    @property
    def unknowns(self) -> int:
        """Unknowns of the finest discretisation used, elastic ones included."""
        return self.finest.unknowns

    @cached_property
    def spread(self) -> dict[str, Mapping[str, float]]:
        """By event, how far models lie apart in its numbers, solved for when first asked for."""
        return {name: self.model_uncertainty(name) for name in usual(self.events)} if self.model_uncertainty else {}

    @property
    def jumps(self) -> bool | None:
        """Whether fixed grips jump on and off; None if it cannot be told.

        As where `margin` is within its error of zero, or where the curve as it was traced has folds, far from merging,
        that no finer grid has.
        """
        found = "jump_on" in self.events
        if self.margin and (abs(self.margin.value) <= self.margin.error or found != (self.margin.value < 0)):
            return None
        return None if self.unconfirmed and not found and not self.margin else found

    @property
    def approach_scale(self) -> float:
        """Size in eps that approaches are measured by, see `halfspace.equilibrium.events.approach_scale`."""
        return self.tolerance.approach

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
        """Contact radius in beta, nan while H(0) exceeds the gap of the largest tension, shape (points,)."""
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
        """Estimated errors of `contact_radius` in beta, nan without contact, infinite where that is open, (points,)."""
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
        folds = [fold for name, fold in self.stages[-1].items() if is_fold(name)]
        return finest_curve(self.segments, self.ladder, self.metric, folds)

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
        halfspace.errors.NotConverged
            If it is lost between two points of the curve.
        """
        asked = {"approach": approach, "load": load, "central_gap": central_gap}
        given = {name: values for name, values in asked.items() if values is not None}
        if len(given) != 1:
            names = " and ".join(given) or "nothing"
            raise InputError(f"a state is asked for by {names}, limit: one of {', '.join(asked)}; give that one")
        ((coordinate, values),) = given.items()
        return self.finest_curve.at(coordinate, values, branch)

    def states(self, condition: Condition) -> list[Located]:
        """Every state that meets a condition, in order: of the path as it was traced, on the coarsest grid.

        Where an observable turns, those that every grid has, on the finest.
        """
        if condition.stationary:
            return self.finest_curve.turns(condition)
        return states(self.segments, condition)

    def branches(self, coordinate: str) -> dict[str, tuple[float, float]]:
        """Parts of the curve in order along which a coordinate goes in one direction, and its range on each.

        The coordinate is "approach", "load" or "central_gap", or InputError. Two folds of the approach make three
        branches; the four of a winding curve number the unstable ones.
        """
        return self.finest_curve.branches(require_coordinate(coordinate))

    def resampled(self, points: int) -> EquilibriumPath:
        """Return the same path with another number of points, two or more or InputError, evenly spaced in arclength."""
        return replace(self, segments=resampled(self.segments, require_points(points), self.metric))

    @cached_property
    def stable(self) -> NDArray[np.bool_]:
        """Stability under fixed grips, from the inertia of the tangent, shape (points,)."""
        segments = self.finest_curve.segments
        found = [part.problem.negative_directions(point.x) == 0 for part in segments for point in part.points]
        return np.array(found, dtype=bool)

    @property
    def rates(self) -> Array:
        """Of approach, load, central gap and contact radius along the path, per arclength, shape (points, 4)."""
        return np.array([point.rates for point in self.points])

    def to_dict(self) -> dict[str, Any]:
        """All numbers as plain data, as of `WithEvents`, with the jumps, the margin and the energy.

        ``energy_released`` is the attribute ``energy``, ``model_uncertainty`` is ``spread``, ``unconfirmed_folds`` are
        ``unconfirmed``.
        """
        return {
            **super().to_dict(),
            **{name: getattr(self, name) for name in ("jumps", "margin")},
            "model_uncertainty": self.spread,
            "energy_released": self.energy,
            "unconfirmed_folds": [fold._asdict() for fold in self.unconfirmed],
        }

    def to_frame(self) -> Any:
        """Points as a `pandas.DataFrame` with the columns of ``curve`` in `to_dict`; InputError without pandas."""
        try:
            from pandas import DataFrame  # here, because few have it
        except ModuleNotFoundError as error:
            raise InputError("a frame needs pandas; pip install '.[frames]' in a clone, or take to_dict") from error
        return DataFrame(points_of(self))

    def _observable(self, index: int) -> Array:
        return np.array([point.observables[index] for point in self.points])


def _told(event: Event) -> str:
    return (
        f"{event.name} at approach {event.approach:.6g} +- {event.approach_error:.1g} eps, "
        f"load {event.load:.6g} +- {event.load_error:.1g} R dgamma"
    )
