"""Folds between the jumps: solved for when one is first asked for, on the same rungs as the other events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np

from halfspace.accuracy.stages import Stage, State, estimate_all, moved_to, step_up
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.events import EVENTS, Event, numbered
from halfspace.equilibrium.path import Segment
from halfspace.equilibrium.search import further_folds
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

    Attributes
    ----------
    segments : tuple of Segment
        The curve as it was traced.
    jumps : tuple of Located
        The outermost folds, on the finest discretisation.
    before : tuple of Stage
        On each of which an event is solved for on the way to the last rung.
    stages, twin, remaining, along
        Of the last rung.
    """

    segments: tuple[Segment, ...]
    jumps: tuple[Located, ...]
    before: tuple[Stage, ...]
    stages: tuple[Stage, ...]
    twin: Stage | None
    remaining: float
    along: bool

    @cached_property
    def chains(self) -> list[list[State]]:
        """Chains of states as of the events; a fold that a finer grid does not have is left out.

        That of a ripple on a coarse grid may become another fold, or be lost alone: folds come in pairs.
        """
        found: list[list[list[Located]]] = []
        for fold in further_folds(self.segments):
            chains, known = self._chains(fold), (*self.jumps, *(others[0][-1] for others in found))
            if chains and not any(_same(chains[0][-1], other) for other in known):
                found.append(chains)
        pairs = found[: len(found) // 2 * 2]
        return [[numbered(states) for states in zip(*chain, strict=True)] for chain in zip(*pairs, strict=True)]

    def _chains(self, fold: Located) -> list[list[Located]]:
        for stage in self.before:  # where one does not have it, a later one may: its change is then from farther back
            with suppress(NotConverged):
                fold = moved_to(fold, stage)
        try:
            return [[state[""] for state in chain] for chain in step_up({"": fold}, self.stages, self.twin)]
        except NotConverged:
            return []

    def events(self) -> Mapping[str, Event]:
        """The folds with their errors."""
        return estimate_all(self.chains, self.remaining, along=self.along) if self.chains else {}

    def stage(self, number: int) -> State:
        """The folds on one of the discretisations from the rung below the last to the finest."""
        return self.chains[0][number] if self.chains else {}


def _same(a: Located, b: Located) -> bool:
    """Whether two folds are one and the same."""
    first, second = a.point.observables[:CONTACT_RADIUS], b.point.observables[:CONTACT_RADIUS]
    return bool(np.all(np.abs(first - second) < SAME * (1 + np.abs(second))))


SAME = 1e-6  # of approach, load and central gap, what two folds differ by where they are two
