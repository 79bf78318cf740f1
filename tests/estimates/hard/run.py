"""Attempts at hard cases, each with the endings declared before it is made: a number within its estimate, a refusal."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from halfspace.errors import InputError, NotConverged
from hard.measured import Measured

Attempt = Callable[[], Measured]
Outcome = Literal["converged", "refused", "wrong"]


@dataclass(frozen=True)
class Refusal:
    """An end by an exception of one class and no other, in a message that names what the user needs.

    Attributes
    ----------
    kind : type
        Class of the exception, itself and not a base of it.
    value, limit, remedy : str
        Parts of the message: what was given or reached, what it is held against, and what to do.
    """

    kind: type[InputError] | type[NotConverged]
    value: str
    limit: str
    remedy: str

    def __str__(self) -> str:
        """Name of the exception's class."""
        return self.kind.__name__

    def left_out(self, message: str) -> list[str]:
        """What a message does not name."""
        return [part for part in (self.value, self.limit, self.remedy) if part not in message]


@dataclass(frozen=True)
class Within:
    """An end in numbers, all of them within their estimates."""

    def __str__(self) -> str:
        """Word for it in the tables."""
        return "converged"


WITHIN = Within()
Ending = Within | Refusal


@dataclass(frozen=True)
class Case:
    """A name, what is attempted under it, and how it may end: mostly in one way."""

    name: str
    attempt: Attempt
    endings: tuple[Ending, ...] = (WITHIN,)

    @property
    def expected(self) -> str:
        """The endings in words."""
        return " or ".join(map(str, self.endings))


@dataclass(frozen=True)
class Row:
    """How a case ended.

    Attributes
    ----------
    name : str
        Of the case.
    outcome : str
        ``converged`` or ``refused`` if the case ended as declared, ``wrong`` if it ended otherwise.
    expected, found : str
        Endings declared, and the one that came: ``converged``, ``beyond the estimate``, or the class of the exception
        with what its message does not name.
    message : str
        What was compared with what, or the refusal.
    error, estimate : float
        Of the quantity worst off; NaN if refused.
    newton_steps : int
        Taken; 0 if refused.
    seconds : float
        Wall time, that of the reference included.
    """

    name: str
    outcome: Outcome
    expected: str
    found: str
    message: str
    error: float
    estimate: float
    newton_steps: int
    seconds: float


def run(cases: Sequence[Case]) -> Iterator[Row]:
    """Attempt the cases one after the other; an exception that is no refusal is a defect, and ends it all."""
    for case in cases:
        began = time.perf_counter()
        try:
            measured = case.attempt()
        except (InputError, NotConverged) as refusal:
            yield _refused(case, refusal, time.perf_counter() - began)
        else:
            yield _measured(case, measured, time.perf_counter() - began)


def _measured(case: Case, ended: Measured, seconds: float) -> Row:
    found = str(WITHIN) if ended.within else "beyond the estimate"
    outcome: Outcome = "converged" if ended.within and WITHIN in case.endings else "wrong"
    message = f"{ended.quantity}, against: {ended.reference}"
    steps = ended.newton_steps
    return Row(case.name, outcome, case.expected, found, message, ended.error, ended.estimate, steps, seconds)


def _refused(case: Case, refusal: InputError | NotConverged, seconds: float) -> Row:
    message, kind = str(refusal), type(refusal)
    declared = [e for e in case.endings if isinstance(e, Refusal) and e.kind is kind]
    left_out = min((ending.left_out(message) for ending in declared), key=len, default=[])
    found = " without ".join([kind.__name__, *map(repr, left_out)])
    outcome: Outcome = "refused" if declared and not left_out else "wrong"
    return Row(case.name, outcome, case.expected, found, message, math.nan, math.nan, 0, seconds)
