"""The claims of the paper, the numbers that test them, and the rule by which a number decides.

A claim allows its number an interval, which the paper's own words give: the last printed digit, "within 2 %", "below".
Where the words give no number, the interval is ours and says so. The verdict follows from the interval and from the
computed number with its error, and from nothing else. The claims stand in ``data/claims.csv``, each with its measure:
an expression in the words of `measures`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from fem_adhesion.common.numbers import counted, digits, listed
from fem_adhesion.common.page import Columns, Table, data_rows, titled
from fem_adhesion.greenwood import measures
from fem_adhesion.greenwood.facts import Facts, exact
from fem_adhesion.greenwood.tables import TABORS, last_digit
from halfspace.values import Estimate

HOLDS, FAILS, MISPRINT, OPEN = "holds", "does not hold", "misprint", "open"
FORMULA = 1e-9  # relative tolerance of a printed formula, which is exact


@dataclass(frozen=True)
class Allowed:
    """Interval in which a claim holds: its ends, in the unit of the number, and the words that give it.

    `printed` is the number or the words of the paper. With an `aim`, not zero, a relative deviation is stated from it;
    without, the distance from the nearer end.
    """

    low: float
    high: float
    printed: str
    words: str
    aim: float | None = None

    @classmethod
    def of(cls, row: Mapping[str, str]) -> Allowed:
        """Interval of a row of the claims."""
        printed, words = row["printed"], row["words"]
        if row["aim"]:
            aim = float(row["aim"])
            half, words = (float(row["part"]) * abs(aim), words) if words else (FORMULA * abs(aim), "a formula")
        elif row["low"] or row["high"]:
            ends = float(row["low"] or "-inf"), float(row["high"] or "inf")
            limits = "limits" if row["low"] and row["high"] else "limit"
            return cls(*ends, printed, words or f"the claim's own {limits}")
        else:
            aim, half, words = float(printed), last_digit(printed) / 2 * (1 + FORMULA), "last printed digit"
        return cls(aim - half, aim + half, printed, words, aim)

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


@dataclass(frozen=True)
class Claim:
    """A statement of the paper in our words, and the number that tests it.

    Section, the measure, an expression in the words of `measures`, the unit of the number, and the files that show it.
    A reading is what the statement may mean, should it fail as printed: its unit is the verdict that it then has.
    """

    section: str
    words: str
    allowed: Allowed
    measure: str
    unit: str
    shown: str
    reading: Claim | None = None

    def measured(self, facts: Facts) -> Estimate:
        """The number that tests it."""
        words = {**vars(measures), "f": facts, "pi": math.pi}
        found: Estimate = eval(self.measure, words)  # an expression of our own file, nothing of a user's
        return found


def read_claims() -> Iterator[Claim]:
    """Claims in the order of the paper."""
    reading = None
    for row in reversed(data_rows("greenwood", "claims.csv")):
        texts = row["measure"], row["unit"], row["shown"]
        claim = Claim(row["section"], row["claim"], Allowed.of(row), *texts, reading)
        if row["section"]:
            yield claim
        reading = None if row["section"] else claim


CLAIMS = tuple(read_claims())[::-1]


@dataclass(frozen=True)
class Judged:
    """A claim with its number and verdict, one of HOLDS, FAILS, MISPRINT and OPEN, and how far it holds or does not."""

    claim: Claim
    computed: Estimate
    verdict: str
    how: str


def numbers(facts: Facts) -> Iterator[tuple[str, float, Estimate, str]]:
    """What claims rest on and no other table has: quantity, Tabor parameter, number, its unit."""
    for mu in TABORS:
        for event, words in (("jump_on", "jump on"), ("jump_off", "jump off")):
            yield (f"w(0) sigma'/sigma, (4.3), at the {words}", mu, measures.criterion_at(facts, mu, event), "1")
        yield ("h0/w(0) at the jump on", mu, measures.h0(facts, mu) / measures.displacement(facts, mu), "1")
        yield ("w(0) over that of undeformed surfaces", mu, measures.displacement_over_rigid(facts, mu), "1")
    for gap, moved in facts.cores.items():
        name = f"jump-on approach less that of the 3-9 law, dgamma raised at gaps below {gap:.4g} eps"
        yield (name, 5.0, moved, "eps")
    for (mu, spacing), force in facts.coarse.items():
        yield (f"pull-off force, uniform triangles of {spacing:g} beta", mu, exact(force), "R dgamma")
    for ripples, name in zip(facts.omitted, ("without the kernel's singular point", "by triangles"), strict=True):
        for r in ripples:
            what = f"pull-off force {name}, nodes {r.spacing:g} beta apart"
            yield (what, r.tabor, exact(-r.pull_off), "R dgamma")


def judge(claim: Claim, facts: Facts) -> Judged:
    """Measure the number of a claim and decide."""
    computed = claim.measured(facts)
    verdict = decide(computed, claim.allowed)
    how = [distance(computed, claim.allowed, claim.unit)]
    if verdict == FAILS and (reading := claim.reading):
        read = reading.measured(facts)
        if decide(read, reading.allowed) == HOLDS:
            verdict = reading.unit
            how += [f"but holds {reading.words}", distance(read, reading.allowed, claim.unit)]
    return Judged(claim, computed, verdict, ", ".join(filter(None, how)))


def judged(facts: Facts) -> tuple[Judged, ...]:
    """All claims, each with its verdict."""
    return tuple(judge(claim, facts) for claim in CLAIMS)


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
        far = f"{100 * part:+.3g} %" if abs(part) < 10 else f"a factor of {1 + part:.3g}"
        return "to rounding" if abs(part) < FORMULA else f"off by {far}"
    beyond = max(allowed.low - computed.value, computed.value - allowed.high)
    words = f"{abs(beyond):.3g}{'' if unit == '1' else ' ' + unit}"
    return f"{words} beyond the limit" if beyond > 0 else f"{words} to spare" if beyond < 0 else ""


# Tables and captions


def tables(claims: Sequence[Judged], facts: Facts) -> list[Table]:
    """Claims with printed and computed numbers, verdicts and where each is seen; and what else they rest on."""
    columns: Columns[Judged] = {
        ("section", "claim (what is measured)"): lambda c: (c.claim.section, c.claim.words),
        "printed": lambda c: c.claim.allowed.printed,
        ("computed", "error", "unit"): lambda c: (*_cells(c.computed), c.claim.unit),
        "verdict": lambda c: f"{c.verdict}: {c.how}" if c.how else c.verdict,
        ("holds for", "shown by"): lambda c: (c.claim.allowed.interval, c.claim.shown),
    }
    rest = [(what, f"{mu:g}", *_cells(computed), unit) for what, mu, computed, unit in numbers(facts)]
    return [
        Table.of(*titled("greenwood", "claims", **counts(claims)), claims, columns),
        Table(*titled("greenwood", "claims_numbers"), ("quantity", "mu", "computed", "error", "unit"), rest),
    ]


def _cells(number: Estimate) -> tuple[str, str]:
    """Value to its error, eight digits at most, and the error; nothing of what is no number."""
    if not math.isfinite(number.value):
        return "", ""
    if number.error == 0:
        return f"{number.value:g}", "0"
    value = f"{number.value:.8g}" if number.error < 1e-7 * abs(number.value) else digits(number)
    return value if abs(number.value) > 1e-9 else f"{number.value:.1e}", f"{number.error:.1e}"


def counts(claims: Sequence[Judged]) -> dict[str, str]:
    """How many claims there are, and of each verdict."""
    of = Counter(claim.verdict for claim in claims)
    kinds = {HOLDS: "hold", FAILS: "do not", MISPRINT: "are misprints", OPEN: "stay open"}
    verdicts = listed([f"{of[kind]} {text}" for kind, text in kinds.items()])
    return {"claims": counted(len(claims), "claim"), "verdicts": verdicts}


def caption(stem: str, claims: Sequence[Judged]) -> str:
    """How many of the claims that name a figure hold there, and what of the others does not."""
    shown = [judged for judged in claims if stem in judged.claim.shown.split(", ")]
    if not shown:
        return ""
    held = sum(judged.verdict == HOLDS for judged in shown)
    rest = (f"{c.claim.words.rstrip('.')}: {c.verdict}, {c.how}." for c in shown if c.verdict != HOLDS)
    return " ".join([f"{held} of {counted(len(shown), 'claim')} of the paper on it hold.", *rest])
