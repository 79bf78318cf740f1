"""One quantity from two sources, and whether they agree on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from halfspace.values import Estimate

Verdict = Literal["agree", "disagree", "inconclusive"]
Pair = tuple[str, str]

SOLVERS: Pair = ("half-space", "finite elements")
HARMONICS: Pair = ("harmonics", "finite elements")
WEAK_FORM: Pair = ("weak form", "finite elements")
CLOSED_FORM: Pair = ("closed form", "half-space")


@dataclass(frozen=True)
class Row:
    """One quantity from two sources, whose names are `between`.

    Values have error estimates, and are None where a source does not find one. The difference is the magnitude of that
    of the values, or the largest over a field; the budget the largest sum of both error estimates with which a
    comparison means something.
    """

    quantity: str
    unit: str
    first: Estimate | None
    second: Estimate | None
    difference: float
    budget: float
    between: Pair = SOLVERS

    @property
    def error(self) -> float:
        """Sum of both error estimates."""
        if self.first is None or self.second is None:
            return float("nan")
        return self.first.error + self.second.error

    @property
    def verdict(self) -> Verdict:
        """Agreement within the estimates, and estimates within the budget."""
        if not (self.difference <= self.error or self.error == math.inf):
            return "disagree"
        return "agree" if self.error <= self.budget else "inconclusive"


def difference(first: Estimate | None, second: Estimate | None) -> float:
    """Magnitude of the difference of two values, nan unless there are two."""
    return abs(first.value - second.value) if first and second else float("nan")


def worst(verdicts: Sequence[Verdict]) -> Verdict:
    """Return ``disagree`` if there is one, else ``inconclusive`` if there is one, else ``agree``."""
    for bad in ("disagree", "inconclusive"):
        if bad in verdicts:
            return bad
    return "agree"
