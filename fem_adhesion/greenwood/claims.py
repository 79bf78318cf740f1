"""All claims of the paper in its order, decided; and their table on the page."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fem_adhesion.common.numbers import counted, digits, listed
from fem_adhesion.common.page import Columns, Table
from fem_adhesion.greenwood.claims_curves import SECTION_3, SECTION_5
from fem_adhesion.greenwood.claims_jumps import APPENDIX_C, SECTION_4C, over_bulge, rigid_bulge
from fem_adhesion.greenwood.claims_model import ABSTRACT, APPENDIX_A, APPENDIX_B, SECTION_1, SECTION_2
from fem_adhesion.greenwood.claims_theories import SECTION_4A, SECTION_4B
from fem_adhesion.greenwood.facts import JUMPING, Facts, exact
from fem_adhesion.greenwood.verdicts import FAILS, HOLDS, MISPRINT, OPEN, Claim, Judged, judge
from halfspace.values import Estimate

CLAIMS: tuple[Claim[Facts], ...] = (
    *ABSTRACT,
    *SECTION_1,
    *SECTION_2,
    *SECTION_3,
    *SECTION_4A,
    *SECTION_4B,
    *SECTION_4C,
    *SECTION_5,
    *APPENDIX_A,
    *APPENDIX_B,
    *APPENDIX_C,
)


@dataclass(frozen=True)
class Number:
    """A number that claims rest on and no other table has: what, at which Tabor parameter, and its unit."""

    what: str
    tabor: float
    computed: Estimate
    unit: str


@dataclass(frozen=True)
class Claims:
    """Every claim with its verdict, and numbers that they rest on."""

    judged: tuple[Judged, ...]
    numbers: tuple[Number, ...]


def examined(facts: Facts) -> Claims:
    """Decide every claim."""
    return Claims(tuple(judge(claim, facts) for claim in CLAIMS), tuple(_numbers(facts)))


def _numbers(facts: Facts) -> Iterator[Number]:
    for mu in JUMPING:
        yield Number("w(0) sigma'/sigma, (4.3), at the jump on", mu, facts.criterion(mu, "jump_on"), "1")
        yield Number("w(0) sigma'/sigma, (4.3), at the jump off", mu, facts.criterion(mu, "jump_off"), "1")
        yield Number("h0/w(0) at the jump on", mu, over_bulge(facts, mu), "1")
        yield Number("w(0) over that of undeformed surfaces", mu, facts.bulge(mu) / rigid_bulge(facts, mu), "1")
    for gap, moved in facts.cores.items():
        name = f"jump-on approach less that of the 3-9 law, dgamma raised at gaps below {gap:.4g} eps"
        yield Number(name, 5.0, moved, "eps")
    for (mu, spacing), force in facts.coarse.items():
        yield Number(f"pull-off force, uniform triangles of {spacing:g} beta", mu, exact(force), "R dgamma")
    for rise, name in zip(facts.omitted, ("without the kernel's singular point", "by triangles"), strict=True):
        for r in rise.ripples:
            yield Number(
                f"pull-off force {name}, nodes {r.spacing:g} beta apart", r.tabor, exact(-r.pull_off), "R dgamma"
            )


def tables(claims: Claims) -> list[Table]:
    """Claims with printed and computed numbers, verdicts and where each is seen; and what else they rest on."""
    columns: Columns[Judged] = {
        "section": lambda c: c.section,
        "claim (what is measured)": lambda c: c.words,
        "printed": lambda c: c.allowed.printed,
        ("computed", "error", "unit"): lambda c: (*_cells(c.computed), c.unit),
        "verdict": lambda c: f"{c.verdict}: {c.how}" if c.how else c.verdict,
        "holds for": lambda c: c.allowed.interval,
        "shown by": lambda c: c.shown,
    }
    rest: Columns[Number] = {
        "quantity": lambda n: n.what,
        "mu": lambda n: f"{n.tabor:g}",
        ("computed", "error", "unit"): lambda n: (*_cells(n.computed), n.unit),
    }
    see = "Forces on coarse grids and by a wrong sum are wrong on purpose: their error is that of rounding."
    return [
        Table.of("claims", "Every claim, in the order of the paper", words(claims.judged), claims.judged, columns),
        Table.of("claims_numbers", "Numbers that claims rest on and no other table has", see, claims.numbers, rest),
    ]


def _cells(number: Estimate) -> tuple[str, str]:
    """Value to its error, eight digits at most, and the error; nothing of what is no number."""
    if not math.isfinite(number.value):
        return "", ""
    if number.error == 0:
        return f"{number.value:g}", "0"
    value = f"{number.value:.8g}" if number.error < 1e-7 * abs(number.value) else digits(number)
    return value if abs(number.value) > 1e-9 else f"{number.value:.1e}", f"{number.error:.1e}"


def words(claims: Sequence[Judged]) -> str:
    """How many claims there are of each verdict, and what decides."""
    of = Counter(claim.verdict for claim in claims)
    kinds = {HOLDS: "hold", FAILS: "do not", MISPRINT: "are misprints", OPEN: "stay open"}
    each = listed([f"{of[kind]} {text}" for kind, text in kinds.items()])
    return (
        f"Of {counted(len(claims), 'claim')}, {each}. A claim "
        "holds if the computed number lies with its error in the interval that the paper's words give; where they give "
        "no number, the interval is ours and says so. A misprint fails as printed and holds as it is read here."
    )
