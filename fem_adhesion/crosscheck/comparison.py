"""What a comparison finds: quantities from two sources, whether they agree, the record, and tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from fem_adhesion.common.facts import plain, versions
from fem_adhesion.common.numbers import counted, with_error
from fem_adhesion.scene import Scene, require_scene
from halfspace.errors import InputError
from halfspace.values import Estimate

if TYPE_CHECKING:
    from fem_adhesion.common.terminal import Fitted
    from halfspace.equilibrium.curve import EquilibriumPath

Verdict = Literal["failed", "disagree", "inconclusive", "agree"]
VERDICTS: tuple[Verdict, ...] = ("failed", "disagree", "inconclusive", "agree")  # worst first
Pair = tuple[str, str]

SOLVERS: Pair = ("half-space", "finite elements")
TRIANGLES: Pair = ("overlapping triangles", "finite elements")
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
        return self.first.error + self.second.error if self.first and self.second else math.nan

    @property
    def verdict(self) -> Verdict:
        """Agreement within the estimates, and estimates within the budget."""
        if not (self.difference <= self.error or self.error == math.inf):
            return "disagree"
        return "agree" if self.error <= self.budget else "inconclusive"


def of_values(
    quantity: str, unit: str, first: Estimate | None, second: Estimate | None, budget: float, between: Pair = SOLVERS
) -> Row:
    """Row of two values, whose difference is nan unless there are two."""
    off = abs(first.value - second.value) if first and second else math.nan
    return Row(quantity, unit, first, second, off, budget, between)


@dataclass(frozen=True)
class Case:
    """Comparison of one scene: plain data of each solver's curve, by the solver's name, and the rows.

    `reason` says why a solver could not solve the scene, or is empty; then the rows are those that need no solution.
    """

    scene: Scene
    solutions: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    rows: tuple[Row, ...] = ()
    reason: str = ""

    @property
    def verdict(self) -> Verdict:
        """The worst of the rows' verdicts, ``failed`` if the scene was not solved."""
        verdicts: list[Verdict] = ["failed"] if self.reason else [row.verdict for row in self.rows]
        return min(verdicts, key=VERDICTS.index, default="agree")

    @property
    def told(self) -> str:
        """Why the scene was not solved, and the rows that disagree: they show what is wrong with the solver."""
        wrong = [f"{row.quantity} disagrees" for row in self.rows if row.verdict == "disagree"]
        return "; ".join([self.reason, *wrong])


def solution_of(path: EquilibriumPath) -> dict[str, Any]:
    """Plain data of a curve, which may be read without a solver; the tolerance is in words."""
    from halfspace.equilibrium.events import tolerance_told

    events = {name: plain(event) for name, event in path.events.items()}
    kept = {name: getattr(path, name) for name in ("jumps", "rtol", "missed", "unknowns", "seconds", "settings")}
    return {"events": events, **kept, "tolerance": tolerance_told(path.rtol, path.missed)}


# What can be compared


def tighter(rtol: float) -> float:
    """Tolerance of the other solver in a comparison to a tolerance."""
    return max(rtol / 10, 1e-9)


def require_comparable(scene: Scene, rtol: float) -> None:
    """Refuse a scene for which there is one solver only, or none in reach of a tolerance; raise InputError."""
    require_scene(scene)
    if scene.material.finite:
        raise InputError(
            f"material = {scene.material} is compared with nothing, limit: small strain; no other solver of the house "
            "knows it"
        )
    if scene.checked_by == "harmonics":
        from fem_adhesion import harmonics  # here, as other scenes are handed to processes by one that loads no solver

        harmonics.require_few(scene, tighter(rtol))


# A record for machines, tables for the terminal


def overall_verdict(cases: Sequence[Case]) -> Verdict:
    """The worst verdict of all."""
    return min((case.verdict for case in cases), key=VERDICTS.index)


def verdict_told(cases: Sequence[Case]) -> list[str]:
    """The verdict of all in a line, then the difference that is largest beside its errors, and what does not agree."""
    rows = [(case, row) for case in cases for row in case.rows]
    other = [
        f"{row.quantity}, tabor {case.scene.tabor:g}: {row.verdict}" for case, row in rows if row.verdict != "agree"
    ]
    lines = [f"verdict: {overall_verdict(cases)}"]
    told = [(row.difference / row.error, case, row) for case, row in rows if row.difference and row.error > 0]
    if told:
        part, case, row = max(told, key=lambda one: one[0])
        count = f"{len(rows)} quantities of {counted(len(cases), 'scene')}"
        worst = f"{100 * part:.2g} % of both errors: {row.quantity}, tabor {case.scene.tabor:g}"
        lines.append(f"{count}; the largest difference is {worst}")
    return [*lines, *other]


def crosscheck_record(cases: Sequence[Case]) -> dict[str, Any]:
    """All cases with verdict and versions, ready for JSON: no NaN, an event that does not exist is absent."""
    return {"verdict": overall_verdict(cases), "versions": versions(), "cases": plain([_case(case) for case in cases])}


KEYS = {"half-space": "halfspace", "harmonics": "harmonics", "finite elements": "finite_element"}


def _case(case: Case) -> dict[str, Any]:
    found: dict[str, Any] = {"tabor": case.scene.tabor, "poisson": case.scene.poisson, "verdict": case.verdict}
    for name, solution in case.solutions.items():
        found[KEYS[name]] = {key: value for key, value in solution.items() if key != "tolerance"}
    return found | ({"reason": case.told} if case.reason else {}) | {"comparison": [_row(row) for row in case.rows]}


def _row(row: Row) -> dict[str, Any]:
    names = ("quantity", "unit", "between", "difference", "error", "budget", "verdict")
    found = {name: getattr(row, name) for name in names}
    for side, estimate in (("first", row.first), ("second", row.second)):
        found |= {side: estimate and estimate.value, f"{side}_error": estimate and estimate.error}
    return found


WORDS = ("quantity", "verdict")  # columns without numbers
STYLES = {"agree": "green", "disagree": "bold red", "inconclusive": "yellow"}


def columns(between: Pair = SOLVERS) -> tuple[str, ...]:
    """Headers of a table of quantities from two sources."""
    return ("quantity", *between, "difference", "budget", "verdict")


def crosscheck_tables(case: Case) -> list[Fitted]:
    """Tables of a case, one for each pair of sources; the first says what was compared, its verdict and its cost."""
    from fem_adhesion.common.terminal import Column, Fitted

    *parts, last = case.scene.words
    title = [*parts, f"{last}: {case.verdict}"]
    cost = [
        f"{name} {told['unknowns']} unknowns, {told['seconds']:.2f} s, {told['tolerance']}"
        for name, told in case.solutions.items()
    ]
    tables: list[Fitted] = []
    for between in dict.fromkeys(row.between for row in case.rows):
        own = [row for row in case.rows if row.between == between]
        named = zip(columns(between), zip(*map(cells, own), strict=True), strict=True)
        made = [Column(name.replace(" ", "\n"), texts, name in WORDS) for name, texts in named]
        styles = ["" if row.verdict == "agree" else STYLES[row.verdict] for row in own]
        tables.append(Fitted(made, [" and ".join(between)] if tables else title, [] if tables else cost, styles))
    return tables


def cells(row: Row) -> tuple[str, ...]:
    """Texts under `columns`: values with the error of the last digit in brackets, other numbers with two digits."""
    values = (with_error(one, digits=DIGITS) if one else "none" for one in (row.first, row.second))
    quantity = " in ".join(filter(None, (row.quantity, row.unit)))
    return (quantity, *values, _small(row.difference), _small(row.budget), row.verdict)


DIGITS = 10  # of a value at most: more are rounding in sums over thousands of unknowns


def _small(value: float) -> str:
    return f"{value:.1e}" if math.isfinite(value) else "-"
