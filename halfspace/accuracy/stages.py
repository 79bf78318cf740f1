"""Stages of a ladder: discretisations on each of which every event is solved for again, from one to the next."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from halfspace.equilibrium.charts import Chart, Stage
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.events import FOLDS, USUAL, ErrorRule, Event, estimate_event, is_event
from halfspace.equilibrium.search import Chains
from halfspace.equilibrium.states import after_coarser, met_again, with_twin
from halfspace.errors import NotConverged, Unsolved
from halfspace.values import Valued

T = TypeVar("T")
Charts = Sequence[Chart]
State = Mapping[str, Located]


@dataclass(frozen=True, eq=False, repr=False)
class Charted(Stage):
    """The same charts for every state, the last of which follows the contact, if there are several."""

    charts: Charts

    def __call__(self, event: Located) -> Chart:
        """Chart of a state: the first only where it was found on a grid that stands still too, and has not left it."""
        follows = event.problem.interface.follows_contact
        wide = event.point.observables[CONTACT_RADIUS] > self.charts[0].leave
        return self.charts[-1 if follows or wide else 0]

    @property
    def unknowns(self) -> int:
        """Unknowns of the largest chart."""
        return max(chart.unknowns for chart in self.charts)


Discretised = tuple[Callable[[], Charts], Stage]
"""Makes the charts for tracing a curve at one resolution, and the stage for its events and points."""


def charted(charts: Charts) -> Discretised:
    """The same charts for the curve, its events and its points."""
    return partial(tuple, charts), Charted(charts)  # what a pickled path takes along


@dataclass(frozen=True, eq=False, repr=False)
class Rung(Valued):
    """One step of a ladder of discretisations.

    `curve` makes the charts for tracing the curve on this rung; they need not all be made before. On each of the stages
    every event is solved for; each differs from the one before in one respect, the last, which the settings tell, is
    the finest. The changes add up to the error, by the rule. On the lowest rung they only prepare, and there may be
    none. The twin is as fine as the rung below, with other cells: it errs as much, but not by the same accident of
    sign. The coarser stage is coarser than the rung below by a node in each cell or a degree: two neighbours may err
    alike. It need not have an event.
    """

    curve: Callable[[], Iterable[Chart]]
    stages: tuple[Stage, ...]
    settings: Mapping[str, object]
    twin: Stage | None = None
    coarser: Stage | None = None
    rule: ErrorRule = USUAL

    def chains(self, state: State) -> dict[str, Chains]:
        """Chain of each event from a coarser stage and the rung below to the last stage."""
        return {name: _demanded(name, self.chains_of(event)) for name, event in state.items()}

    def with_twin(self, found: Mapping[str, Chains]) -> dict[str, Chains]:
        """The chains of each event with that from the twin, if there is one and it is not among them."""
        return {name: _demanded(name, self.beside_twin(chains)) for name, chains in found.items()}

    def chains_of(self, event: Located) -> Chains | Unsolved:
        """The chain of one event."""
        chain = [event]
        for stage in self.stages:
            found = met_again(stage, chain[-1])
            if not found:
                return found
            chain.append(found)
        return [after_coarser(chain, self.coarser, met_again)]

    def beside_twin(self, chains: Chains) -> Chains | Unsolved:
        """The chains of one event with that from the twin."""
        own, *twins = chains
        return chains if twins else with_twin(list(own), self.twin, met_again)

    def estimates(self, found: Mapping[str, Chains]) -> dict[str, Event]:
        """Events, with their changes along the chains as errors."""
        return {name: estimate_event(name, chains, self.rule) for name, chains in found.items() if is_event(name)}


class FoldsLost(NotConverged):
    """Folds about to merge are found on one rung but not on another."""


def on_all(state: State, stage: Stage) -> State:
    """Solve for all events again on a stage, or raise NotConverged."""
    return {name: _demanded(name, met_again(stage, event)) for name, event in state.items()}


def _demanded(name: str, outcome: T | Unsolved) -> T:
    """Return what was found of an event; raise FoldsLost or NotConverged if it is lost."""
    if isinstance(outcome, Unsolved):
        raise (FoldsLost if name in FOLDS else NotConverged)(outcome.reason)
    return outcome
