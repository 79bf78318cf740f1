"""Stages of a ladder: discretisations on each of which every event is solved for again, from one to the next."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

from halfspace.equilibrium.charts import Chart, Finest, moved_near, settled
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.events import FOLDS, USUAL, ErrorRule, Event, estimate_event, is_event
from halfspace.errors import ContactTooWide, IllPosed, NotConverged
from halfspace.values import Valued

Charts = Sequence[Chart]
State = Mapping[str, Located]


class Stage(Finest, Protocol):
    """One discretisation on which events, found on another, are solved for again."""

    @property
    def together(self) -> Callable[[Iterable[Located]], None] | None:
        """Makes a chart that serves all these events, where that is less work; None if the charts are there."""
        ...

    @property
    def everywhere(self) -> Finest:
        """The same for every point of a curve, if charts for events do not serve these."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Charted(Valued):
    """The same charts for every event, one for those on a grid that stands still, one for those on one that follows.

    The chart for the grid that follows the contact is the last.
    """

    charts: Charts
    farther = together = None

    def __call__(self, event: Located) -> Chart:
        """Chart of the event's kind."""
        source = event.problem
        return self.charts[-1 if isinstance(source, ContactProblem) and source.follows_contact else 0]

    @property
    def everywhere(self) -> Finest:
        """The same charts."""
        return self

    @property
    def unknowns(self) -> int:
        """Unknowns of the largest chart."""
        return max(chart.unknowns for chart in self.charts)


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
    if stage.together:
        stage.together(state.values())
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
    return event if stage(event).problem is event.problem else settled(event, stage, partial(moved_near, stage))
