"""What a comparison finds: quantities from two sources, whether they agree, the record, and tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from fem_adhesion.common.facts import plain, versions
from fem_adhesion.scene import Scene, require_scene
from halfspace.errors import InputError
from halfspace.values import Estimate

if TYPE_CHECKING:
    from fem_adhesion.common.terminal import Fitted
    from halfspace.equilibrium.curve import EquilibriumPath

Verdict = Literal["agree", "disagree", "inconclusive"]
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


@dataclass(frozen=True)
class Failure:
    """A scene that a solver could not solve, with the reason and the rows that need no solution.

    It does not stop the others. A row that disagrees says what is wrong with the solver.
    """

    scene: Scene
    reason: str
    rows: tuple[Row, ...] = ()

    @property
    def shown_by(self) -> tuple[str, ...]:
        """Rows that disagree."""
        return tuple(row.quantity for row in self.rows if row.verdict == "disagree")


@dataclass(frozen=True)
class Solution:
    """What is told of a solver's curve, in plain data: who reads it needs no solver.

    Events are those told, by their names; `tolerance` says whether that was met, in words.
    """

    events: Mapping[str, Any]
    jumps: bool | None
    rtol: float
    missed: Mapping[str, Sequence[str]]
    unknowns: int
    seconds: float
    settings: Mapping[str, Any]
    tolerance: str


def solution_of(path: EquilibriumPath) -> Solution:
    """What is told of a curve."""
    from halfspace.equilibrium.events import is_fold, tolerance_told

    return Solution(
        {name: plain(event) for name, event in path.events.items() if name in EVENT_NAMES or is_fold(name)},
        path.jumps,
        path.rtol,
        path.missed,
        path.unknowns,
        path.seconds,
        path.settings,
        tolerance_told(path.rtol, path.missed),
    )


@dataclass(frozen=True)
class Case:
    """What is told of the solutions of one scene, by the names of their solvers, and their comparison."""

    scene: Scene
    solutions: Mapping[str, Solution]
    rows: tuple[Row, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst of the rows' verdicts."""
        return worst([row.verdict for row in self.rows])


# What can be compared


def tighter(rtol: float) -> float:
    """What is asked of the other solver in a comparison to a tolerance."""
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


# What is told of it: a record for machines, tables for the terminal

VERDICTS = ("failed", "disagree", "inconclusive", "agree")  # worst first
EVENT_NAMES = ("pull_off", "jump_on", "jump_off")


def verdict_of(case: Case | Failure) -> str:
    """Verdict of a case, ``failed`` if it was not solved."""
    return "failed" if isinstance(case, Failure) else case.verdict


def told(failure: Failure) -> str:
    """Why a case has no solution, and which rows show what is wrong."""
    return "; ".join([failure.reason, *(f"{quantity} disagrees" for quantity in failure.shown_by)])


def overall_verdict(cases: Sequence[Case | Failure]) -> str:
    """The worst verdict of all."""
    return min(map(verdict_of, cases), key=VERDICTS.index)


def crosscheck_record(cases: Sequence[Case | Failure]) -> dict[str, Any]:
    """All cases with verdict and versions, ready for JSON: no NaN, an event that does not exist is absent."""
    told_of = [plain(_case(case)) for case in cases]
    return {"verdict": overall_verdict(cases), "versions": versions(), "cases": told_of}


def _case(case: Case | Failure) -> dict[str, Any]:
    scene = {"tabor": case.scene.tabor, "poisson": case.scene.poisson, "verdict": verdict_of(case)}
    if isinstance(case, Failure):
        return {**scene, "reason": told(case), "comparison": [_row(row) for row in case.rows]}
    solutions = {KEYS[name]: _solution(solution) for name, solution in case.solutions.items()}
    return {**scene, **solutions, "comparison": [_row(row) for row in case.rows]}


KEYS = {"half-space": "halfspace", "harmonics": "harmonics", "finite elements": "finite_element"}


def _solution(solution: Solution) -> dict[str, Any]:
    return {name: value for name, value in vars(solution).items() if name != "tolerance"}


def _row(row: Row) -> dict[str, Any]:
    return {
        "quantity": row.quantity,
        "unit": row.unit,
        "between": row.between,
        "first": row.first and row.first.value,
        "second": row.second and row.second.value,
        "difference": row.difference,
        "first_error": row.first and row.first.error,
        "second_error": row.second and row.second.error,
        "error": row.error,
        "budget": row.budget,
        "verdict": row.verdict,
    }


SHORT = {
    "half-space": "hs",
    "overlapping triangles": "tr",
    "harmonics": "ha",
    "finite elements": "fe",
    "weak form": "wf",
    "closed form": "cf",
}
WORDS = ("quantity", "unit", "verdict")  # columns without numbers
STYLES = {"agree": "green", "disagree": "bold red", "inconclusive": "yellow"}


def columns(between: Pair = SOLVERS) -> tuple[str, ...]:
    """Headers of a table of quantities from two sources."""
    errors = (f"error ({SHORT[source]})" for source in between)
    return ("quantity", "unit", *between, "difference", *errors, "budget", "verdict")


RANKS = (0, 1, 1, 1, 2, 3, 3, 4, 0)  # of the columns


def crosscheck_tables(case: Case) -> list[Fitted]:
    """Tables of a case, one for each pair of sources; the first says what was compared and what it cost."""
    style = STYLES[case.verdict]
    *parts, last = scene_parts(case.scene)
    title = [*parts, f"{last}: [{style}]{case.verdict}[/]"]
    cost = [f"{name} {cost_told(solution)}" for name, solution in case.solutions.items()]
    made = [crosscheck_table(case.rows, between) for between in dict.fromkeys(row.between for row in case.rows)]
    return [replace(made[0], title=title, caption=cost), *made[1:]]


def scene_parts(scene: Scene) -> list[str]:
    """What is compared, in rich's markup."""
    from rich.markup import escape

    return list(map(escape, scene.words))


def crosscheck_table(rows: Sequence[Row], between: Pair = SOLVERS) -> Fitted:
    """One line for each quantity: both values, the difference, both error estimates, the budget and the verdict."""
    from fem_adhesion.common.terminal import Column, Fitted

    own = [row for row in rows if row.between == between]
    named = zip(columns(between), zip(*map(cells, own), strict=True), RANKS, strict=True)
    return Fitted(
        [Column(name, texts, rank, name in WORDS, wraps=name == "quantity") for name, texts, rank in named],
        [" and ".join(between)],
        styles=["" if row.verdict == "agree" else STYLES[row.verdict] for row in own],
    )


def cells(row: Row) -> tuple[str, ...]:
    """What stands in `columns`: values with digits down to the first uncertain one, errors with two."""
    first, second = row.first, row.second
    return (
        row.quantity,
        row.unit,
        _value(first),
        _value(second),
        _small(row.difference),
        _small(first.error if first else math.nan),
        _small(second.error if second else math.nan),
        _small(row.budget),
        row.verdict,
    )


def _value(estimate: Estimate | None) -> str:
    """Digits down to the first uncertain one; two of a residual, which is of the size of its error."""
    if estimate is None:
        return "none"
    if not abs(estimate.value) >= 100 * estimate.error:
        return _small(estimate.value)
    digits = max(0, min(10, -math.floor(math.log10(estimate.error or 1e-10))))
    return f"{estimate.value:.{digits}f}"


def _small(value: float) -> str:
    return f"{value:.1e}" if math.isfinite(value) else "-"


def cost_told(solution: Solution) -> str:
    """Cost of a curve, and whether it has the accuracy that was asked of it."""
    return f"{solution.unknowns} unknowns, {solution.seconds:.2f} s, {solution.tolerance}"
