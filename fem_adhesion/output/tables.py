"""Tables for the terminal."""

from __future__ import annotations

import math

from fem_adhesion.output.terminal import Column, Fitted
from fem_adhesion.studies.crosscheck import Case, Row
from halfspace.curve import EquilibriumPath, Estimate
from halfspace.events import tolerance_told

COLUMNS = (
    "quantity",
    "unit",
    "half-space",
    "finite elements",
    "difference",
    "error (hs)",
    "error (fe)",
    "budget",
    "verdict",
)
RANKS = {
    "unit": 1,
    "half-space": 1,
    "finite elements": 1,
    "difference": 2,
    "error (hs)": 3,
    "error (fe)": 3,
    "budget": 4,
}
WORDS = ("quantity", "unit", "verdict")  # columns without numbers
STYLES = {"agree": "green", "disagree": "bold red", "inconclusive": "yellow"}


def crosscheck_table(case: Case) -> Fitted:
    """One line for each quantity: both values, the difference, both error estimates, the budget and the verdict."""
    style = STYLES[case.verdict]
    columns = zip(COLUMNS, zip(*map(cells, case.rows), strict=True), strict=True)
    return Fitted(
        [Column(name, texts, RANKS.get(name, 0), name in WORDS, wraps=name == "quantity") for name, texts in columns],
        [f"tabor {case.scene.tabor:g}", f"poisson {case.scene.poisson:g}: [{style}]{case.verdict}[/]"],
        [f"half-space {told(case.halfspace)}", f"finite elements {told(case.finite_element)}"],
        ["" if row.verdict == "agree" else STYLES[row.verdict] for row in case.rows],
    )


def cells(row: Row) -> tuple[str, ...]:
    """What stands in `COLUMNS`: values with digits down to the first uncertain one, errors with two."""
    hs, fe = row.halfspace, row.finite_element
    return (
        row.quantity,
        row.unit,
        _value(hs),
        _value(fe),
        _small(row.difference),
        _small(hs.error if hs else math.nan),
        _small(fe.error if fe else math.nan),
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
