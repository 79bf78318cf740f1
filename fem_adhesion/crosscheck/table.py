"""The cross-check as tables for the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from rich.markup import escape

from fem_adhesion.common.terminal import Column, Fitted
from fem_adhesion.crosscheck.comparison import SOLVERS, Pair, Row
from fem_adhesion.crosscheck.study import Case
from fem_adhesion.scene import Scene
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import tolerance_told
from halfspace.values import Estimate

SHORT = {
    "half-space": "hs",
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
    cost = [f"{name} {told(path)}" for name, path in case.solutions.items()]
    made = [crosscheck_table(case.rows, between) for between in dict.fromkeys(row.between for row in case.rows)]
    return [replace(made[0], title=title, caption=cost), *made[1:]]


def scene_parts(scene: Scene) -> list[str]:
    """What is compared, in rich's markup."""
    return list(map(escape, scene.told))


def crosscheck_table(rows: Sequence[Row], between: Pair = SOLVERS) -> Fitted:
    """One line for each quantity: both values, the difference, both error estimates, the budget and the verdict."""
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


def told(path: EquilibriumPath) -> str:
    """Cost of a curve, and whether it has the accuracy that was asked of it."""
    return f"{path.unknowns} unknowns, {path.seconds:.2f} s, {tolerance_told(path.rtol, path.missed)}"
