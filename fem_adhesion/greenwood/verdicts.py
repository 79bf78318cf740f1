"""A claim of the paper, the number that tests it, and the rule by which the number decides.

A claim allows its number an interval, which the paper's own words give: the last printed digit, "within 2 %", "below".
Where the words give no number, the interval is ours and says so. The verdict follows from the interval and from the
computed number with its error, and from nothing else.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from halfspace.values import Estimate

Facts = TypeVar("Facts")

HOLDS, FAILS, MISPRINT, OPEN = "holds", "does not hold", "misprint", "open"
FORMULA = 1e-9  # relative tolerance of a printed formula, which is exact


@dataclass(frozen=True)
class Allowed:
    """Interval in which a claim holds: its ends, in the unit of the number, and the words that give it.

    `printed` is the number or the words of the paper. With an `aim`, not zero, a relative deviation is told from there;
    without, the distance from the nearer end.
    """

    low: float
    high: float
    printed: str
    words: str
    aim: float | None = None

    @property
    def interval(self) -> str:
        """The interval and the words that give it."""
        if math.isinf(self.low):
            ends = f"up to {self.high:.6g}"
        elif math.isinf(self.high):
            ends = f"from {self.low:.6g} on"
        elif self.high - self.low <= 3 * FORMULA * abs(self.high):
            ends = f"{self.high:.6g}"
        else:
            ends = f"{self.low:.6g} to {self.high:.6g}"
        return f"{ends}: {self.words}"


def digits(printed: str) -> Allowed:
    """Allow what rounds to a printed number."""
    value, half = float(printed), 0.5 * 10.0 ** -len(printed.partition(".")[2]) * (1 + 1e-9)
    return Allowed(value - half, value + half, printed, "last printed digit", value)


def formula(value: float, printed: str) -> Allowed:
    """Allow the value of a printed formula."""
    return within(value, FORMULA, printed, "a formula")


def within(value: float, part: float, printed: str, words: str) -> Allowed:
    """Allow a relative deviation from a value."""
    return Allowed(value - part * abs(value), value + part * abs(value), printed, words, value)


def below(limit: float, printed: str, words: str = "the claim's own limit") -> Allowed:
    """Allow what is not above a limit."""
    return Allowed(-math.inf, limit, printed, words)


def above(limit: float, printed: str, words: str = "the claim's own limit") -> Allowed:
    """Allow what is not below a limit."""
    return Allowed(limit, math.inf, printed, words)


def between(low: float, high: float, printed: str, words: str = "the claim's own limits") -> Allowed:
    """Allow an interval."""
    return Allowed(low, high, printed, words)


@dataclass(frozen=True)
class Reading(Generic[Facts]):
    """What explains a claim that fails: words, and the number, interval and verdict (a misprint) that it then has."""

    words: str
    measure: Callable[[Facts], Estimate]
    allowed: Allowed
    verdict: str = MISPRINT


@dataclass(frozen=True)
class Claim(Generic[Facts]):
    """A statement of the paper in our words, and the number that tests it, measured on what was computed.

    Section and unit of the number, and the figure, table or file where it is seen. A reading is what the statement may
    mean, should it fail as printed.
    """

    section: str
    words: str
    allowed: Allowed
    measure: Callable[[Facts], Estimate]
    unit: str
    shown: str
    reading: Reading[Facts] | None = None


@dataclass(frozen=True)
class Judged:
    """A claim with its number and verdict, one of HOLDS, FAILS, MISPRINT and OPEN, and how far it holds or does not."""

    section: str
    words: str
    allowed: Allowed
    computed: Estimate
    unit: str
    shown: str
    verdict: str
    how: str


def judge(claim: Claim[Facts], facts: Facts) -> Judged:
    """Measure the number of a claim and decide."""
    computed = claim.measure(facts)
    verdict = decide(computed, claim.allowed)
    how = [distance(computed, claim.allowed, claim.unit)]
    if verdict == FAILS and (reading := claim.reading):
        read = reading.measure(facts)
        if decide(read, reading.allowed) == HOLDS:
            verdict = reading.verdict
            how += [f"but holds {reading.words}", distance(read, reading.allowed, claim.unit)]
    told = ", ".join(filter(None, how))
    return Judged(claim.section, claim.words, claim.allowed, computed, claim.unit, claim.shown, verdict, told)


def decide(computed: Estimate, allowed: Allowed) -> str:
    """Whether a number is in an interval with its error: HOLDS, FAILS, or OPEN if the error leaves both possible."""
    low, high = computed.value - computed.error, computed.value + computed.error
    if allowed.low <= low and high <= allowed.high:
        return HOLDS
    return FAILS if high < allowed.low or low > allowed.high else OPEN


def distance(computed: Estimate, allowed: Allowed, unit: str) -> str:
    """How far a number is from what a claim says, in words; nothing of a limit that is just met."""
    if not math.isfinite(computed.value):
        return "no number"
    if allowed.aim:
        part = (computed.value - allowed.aim) / abs(allowed.aim)
        return "to rounding" if abs(part) < FORMULA else f"off by {_percent(part)}"
    beyond = max(allowed.low - computed.value, computed.value - allowed.high)
    words = f"{abs(beyond):.3g}{'' if unit == '1' else ' ' + unit}"
    return f"{words} beyond the limit" if beyond > 0 else f"{words} to spare" if beyond < 0 else ""


def _percent(part: float) -> str:
    return f"{100 * part:+.3g} %" if abs(part) < 10 else f"a factor of {1 + part:.3g}"
