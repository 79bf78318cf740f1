"""Folds between the jumps: solved for when one is first asked for, on the same rungs as the other events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from halfspace.accuracy.stages import Rung, State
from halfspace.equilibrium.charts import Stage
from halfspace.equilibrium.conditions import FOLD, Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.events import EVENTS, Event, Unconfirmed, numbered
from halfspace.equilibrium.path import Point, Segment
from halfspace.equilibrium.search import Chains, confirmed, turns
from halfspace.equilibrium.states import met_again
from halfspace.errors import Unsolved
from halfspace.values import Valued

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Completed(Mapping[str, T]):
    """What is known by name, and what is of the folds between the jumps when one of these is first asked for."""

    known: Mapping[str, T]
    more: Callable[[], Mapping[str, T]]

    @cached_property
    def every(self) -> dict[str, T]:
        """All of it, folds in order along the curve."""
        after = ("jump_off", "zero_load")
        first = {name: value for name, value in self.known.items() if name not in after}
        return {**first, **self.more(), **self.known}

    def __getitem__(self, name: str) -> T:
        return self.known[name] if name in self.known or name in EVENTS else self.every[name]

    def __contains__(self, name: object) -> bool:
        return name in self.known or (name not in EVENTS and name in self.every)

    def __iter__(self) -> Iterator[str]:
        return iter(self.every)

    def __len__(self) -> int:
        return len(self.every)


@dataclass(frozen=True, eq=False, repr=False)
class FurtherFolds(Valued):
    """Folds between the jumps, solved for as the other events and known as well.

    The segments are the curve as it was traced, the jumps the outermost folds, on the finest discretisation. On each of
    the stages `before` an event is solved for on the way to the last rung.
    """

    segments: tuple[Segment, ...]
    jumps: tuple[Located, ...]
    before: tuple[Stage, ...]
    last: Rung

    @property
    def chains(self) -> list[list[State]]:
        """Chains of states as of the events; a fold that a finer grid does not have is left out."""
        return [
            [numbered(states) for states in zip(*chain, strict=True)] for chain in zip(*self._found[0], strict=True)
        ]

    def unconfirmed(self) -> tuple[Unconfirmed, ...]:
        """Where the curve as it was traced has folds that were left out."""
        return tuple(Unconfirmed(*map(float, point.observables[:CONTACT_RADIUS])) for point in self._found[1])

    @cached_property
    def _found(self) -> tuple[list[Chains], list[Point]]:
        traced = turns(self.segments, FOLD, slice(1, -1)) if self.segments else []
        return confirmed(traced, self._chains, self.jumps)

    def _chains(self, fold: Located) -> Chains | Unsolved:
        for stage in self.before:  # where one does not have it, a later one may: its change is then from farther back
            fold = met_again(stage, fold) or fold
        return self.last.chains_of(fold)

    def events(self) -> Mapping[str, Event]:
        """The folds with their errors."""
        return self.last.estimates(self.chains) if self.chains else {}

    def stage(self, number: int) -> State:
        """The folds on one of the discretisations from the rung below the last to the finest."""
        return self.chains[0][number] if self.chains else {}
