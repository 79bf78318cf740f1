"""Folds between the jumps: solved for when one is first asked for, on the same rungs as the other events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np

from halfspace.accuracy.stages import Rung, State, moved_to
from halfspace.equilibrium.charts import Stage
from halfspace.equilibrium.conditions import FOLD, Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.events import EVENTS, Event, Unconfirmed, numbered
from halfspace.equilibrium.path import Point, Segment
from halfspace.equilibrium.search import between_jumps, with_care
from halfspace.errors import NotConverged
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
        """Chains of states as of the events; a fold that a finer grid does not have is left out.

        That of a ripple on a coarse grid may become another fold, or be lost alone: folds come in pairs.
        """
        return [[numbered(states) for states in zip(*chain, strict=True)] for chain in zip(*self._told[0], strict=True)]

    def unconfirmed(self) -> tuple[Unconfirmed, ...]:
        """Where the curve as it was traced has folds that were left out."""
        return tuple(Unconfirmed(*map(float, point.observables[:CONTACT_RADIUS])) for point in self._told[1])

    @cached_property
    def _told(self) -> tuple[list[list[list[Located]]], list[Point]]:
        """Folds that are confirmed, least and largest approaches in turn, and about where the rest are."""
        found: list[tuple[Point, list[list[Located]]]] = []
        lost: list[Point] = []
        for point, fold in self._traced():
            chains = self._chains(fold) if fold else []
            known = (*self.jumps, *(others[0][-1] for _, others in found))
            last = known[-1] if found else self.jumps[0]
            if chains and last.slope * chains[0][-1].slope < 0 and not any(_same(chains[0][-1], k) for k in known):
                found.append((point, chains))
            else:
                lost.append(point)
        paired = len(found) // 2 * 2
        return [chains for _, chains in found[:paired]], [*lost, *(point for point, _ in found[paired:])]

    def _traced(self) -> Iterator[tuple[Point, Located | None]]:
        """Folds of the curve as it was traced, and where about; none where it is not pinned down."""
        for bracket in between_jumps(self.segments):
            try:
                yield from ((fold.point, fold) for fold in with_care(bracket, FOLD))
            except NotConverged:
                yield bracket[1], None

    def _chains(self, fold: Located) -> list[list[Located]]:
        for stage in self.before:  # where one does not have it, a later one may: its change is then from farther back
            with suppress(NotConverged):
                fold = moved_to(fold, stage)
        try:
            return [[state[""] for state in chain] for chain in self.last.chains({"": fold})]
        except NotConverged:
            return []

    def events(self) -> Mapping[str, Event]:
        """The folds with their errors."""
        return self.last.estimates(self.chains) if self.chains else {}

    def stage(self, number: int) -> State:
        """The folds on one of the discretisations from the rung below the last to the finest."""
        return self.chains[0][number] if self.chains else {}


def _same(a: Located, b: Located) -> bool:
    """Whether two folds are one and the same."""
    first, second = a.point.observables[:CONTACT_RADIUS], b.point.observables[:CONTACT_RADIUS]
    return bool(np.all(np.abs(first - second) < SAME * (1 + np.abs(second))))


SAME = 1e-6  # of approach, load and central gap, what two folds differ by where they are two
