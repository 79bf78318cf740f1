"""Stages of a ladder: discretisations on each of which every event is solved for again, from one to the next."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

from halfspace.equilibrium.charts import Chart, Stage, settled, undeformed_radius
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.events import FOLDS, USUAL, ErrorRule, Event, estimate_event, is_event
from halfspace.errors import ContactTooWide, IllPosed, NotConverged
from halfspace.values import Valued

Charts = Sequence[Chart]
State = Mapping[str, Located]


@dataclass(frozen=True, eq=False, repr=False)
class Charted(Stage):
    """The same charts for every event, one for those on a grid that stands still, one for those on one that follows.

    The chart for the grid that follows the contact is the last.
    """

    charts: Charts

    def __call__(self, event: Located) -> Chart:
        """Chart of the event's kind."""
        return self.charts[-1 if event.problem.interface.follows_contact else 0]

    @property
    def unknowns(self) -> int:
        """Unknowns of the largest chart."""
        return max(chart.unknowns for chart in self.charts)


@dataclass(frozen=True, eq=False, repr=False)
class LeavesEarly(Charted):
    """Two charts of which events leave the first as soon as their contact is wider than `leave`, in beta.

    The curve stays on it as long as it serves.
    """

    leave: float

    def __call__(self, event: Located) -> Chart:
        """Chart for an event."""
        wide = event.point.observables[CONTACT_RADIUS] > self.leave
        return self.charts[-1] if wide else super().__call__(event)

    @cached_property
    def everywhere(self) -> Charted:
        """The same charts for every point of a curve."""
        return Charted(self.charts)


@dataclass(frozen=True, eq=False, repr=False)
class WhereAsked(Stage):
    """A stage whose charts are made when first asked for, each with the contact radii from and to which it serves."""

    made: list[tuple[float, float, Chart]] = field(default_factory=list, compare=False, repr=False, kw_only=True)

    def serving(self, radius: float) -> Chart | None:
        """Chart made before that serves a contact radius in beta."""
        return next((chart for least, most, chart in self.made if least <= radius <= most), None)

    def keep(self, least: float, most: float, chart: Chart) -> Chart:
        """Keep a chart that serves contact radii between these."""
        self.made.append((least, most, chart))
        return chart

    @property
    def unknowns(self) -> int:
        """Most unknowns of a chart made so far."""
        return max(chart.unknowns for *_, chart in self.made)


class Gridded(Protocol):
    """A body that a grid can be made on for any contact radius."""

    @property
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""
        ...

    def standing(self, radius: float) -> Chart:
        """Chart that stands still, its cells finest at a contact radius in beta, or on the axis."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Standing(WhereAsked):
    """A stage on which every event has a grid of its own that stands still, finest where its contact ends.

    `along` is for the points of a curve.
    """

    body: Gridded
    along: Stage

    def __call__(self, event: Located) -> Chart:
        """Chart for an event, made unless one made before will do."""
        for *_, chart in self.made:  # on its own an event may have moved by more than that serves
            if chart.problem is event.problem:
                return chart
        radius, near = undeformed_radius(event.problem, event.point), NEAR * self.body.length
        radius = radius if radius > self.body.length else 0.0
        return self.serving(radius) or self.keep(radius - near, radius + near, self.body.standing(radius))

    @property
    def everywhere(self) -> Stage:
        """That for the points of a curve."""
        return self.along


NEAR = 0.1  # of the finest cell, that a contact may end beside the place for which a grid was made


@dataclass(frozen=True, eq=False, repr=False)
class Rung(Valued):
    """One step of a ladder of discretisations.

    `curve` makes the charts for tracing the curve on this rung; they need not all be made before. On each of the stages
    every event is solved for; each differs from the one before in one respect, the last, which the settings tell, is
    the finest. The changes add up to the error, by the rule. On the lowest rung they only prepare, and there may be
    none. The twin is as fine as the rung below, with other cells: it errs as much, but not by the same accident of
    sign.
    """

    curve: Callable[[], Iterable[Chart]]
    stages: tuple[Stage, ...]
    settings: Mapping[str, object]
    twin: Stage | None = None
    rule: ErrorRule = USUAL

    def chains(self, state: State) -> list[list[State]]:
        """Chains of states from the rung below, and from its twin, to the last stage."""
        chain = [state]
        for stage in self.stages:
            chain.append(on_all(chain[-1], stage))
        return [chain, [on_all(chain[-1], self.twin), chain[-1]]] if self.twin else [chain]

    def estimates(self, chains: Sequence[Sequence[State]]) -> dict[str, Event]:
        """Events of the last state, with their changes along the chains as errors."""
        names = [name for name in chains[0][-1] if is_event(name)]
        return {name: estimate_event(name, [[s[name] for s in chain] for chain in chains], self.rule) for name in names}


class FoldsLost(NotConverged):
    """Folds about to merge are found on one rung but not on another."""


def on_all(state: State, stage: Stage) -> State:
    """Solve for all events again on a stage."""
    stage.prepare(state.values())
    return {name: _found_again(name, event, stage) for name, event in state.items()}


def _found_again(name: str, event: Located, stage: Stage) -> Located:
    try:
        return moved_to(event, stage)
    except (ContactTooWide, IllPosed):  # for any grid
        raise
    except NotConverged as error:
        raise FoldsLost(str(error)) if name in FOLDS else error from error


def moved_to(event: Located, stage: Stage) -> Located:
    """Solve for an event again, unless it has been on this stage."""
    return event if stage(event).problem is event.problem else settled(event, stage, stage.moved)
