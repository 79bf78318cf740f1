"""Stages of a ladder: discretisations on each of which every event is solved for again, from one to the next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from halfspace.equilibrium.charts import Chart, Finest, moved_near, settled
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.events import FOLDS, Event, estimate_event, is_event
from halfspace.errors import ContactTooWide, IllPosed, NotConverged
from halfspace.values import Valued

Charts = Sequence[Chart]
State = Mapping[str, Located]


class Stage(Finest, Protocol):
    """One discretisation on which events, found on another, are solved for again."""

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
    farther = None

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


class FoldsLost(NotConverged):
    """Folds about to merge are found on one rung but not on another."""


def change_along(values: Sequence[Sequence[float]], last: float) -> float:
    """Sum of the changes along a chain, of which the last counts so many times, the largest of all chains.

    A chain has two values or more.
    """
    changes = [np.abs(np.diff(chain)) for chain in values]
    return max(float(np.sum(change) + (last - 1) * change[-1]) for change in changes)


def step_up(state: State, stages: Sequence[Stage], twin: Stage | None) -> list[list[State]]:
    """Chains of states from the rung below, and from its twin, to the last stage of a rung."""
    chain = [state]
    for stage in stages:
        chain.append(on_all(chain[-1], stage))
    return [chain, [on_all(chain[-1], twin), chain[-1]]] if twin else [chain]


def on_all(state: State, stage: Stage) -> State:
    """Solve for all events again on a stage."""
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


def estimate_all(chains: Sequence[Sequence[State]], remaining: float, *, along: bool, last: float) -> dict[str, Event]:
    """Events of the last state, with their changes along the chains as errors."""
    names = [name for name in chains[0][-1] if is_event(name)]
    by_name = {name: [[state[name] for state in chain] for chain in chains] for name in names}
    return {name: estimate_event(name, own, remaining, along=along, last=last) for name, own in by_name.items()}
