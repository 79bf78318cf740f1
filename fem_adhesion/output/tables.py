"""Tables for the terminal."""

from __future__ import annotations

import math

from rich.table import Table

from fem_adhesion.studies.crosscheck import Case, Row
from halfspace.curve import EquilibriumPath, Estimate

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
WORDS = ("quantity", "unit", "verdict")  # columns without numbers
STYLES = {"agree": "green", "disagree": "bold red", "inconclusive": "yellow"}


def crosscheck_table(case: Case) -> Table:
    """One line for each quantity: both values, the difference, both error estimates, the budget and the verdict."""
    style = STYLES[case.verdict]
    table = Table(
        title=f"tabor {case.scene.tabor:g}, poisson {case.scene.poisson:g}: [{style}]{case.verdict}[/]",
        caption=f"half-space {_cost(case.halfspace)}; finite elements {_cost(case.finite_element)}",
        title_justify="left",
        caption_justify="left",
    )
    for name in COLUMNS:
        table.add_column(name, justify="left" if name in WORDS else "right", no_wrap=True)
    for row in case.rows:
        table.add_row(*cells(row), style=None if row.verdict == "agree" else STYLES[row.verdict])
    return table


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
    if abs(estimate.value) < 100 * estimate.error:
        return _small(estimate.value)
    digits = max(0, min(10, -math.floor(math.log10(estimate.error or 1e-10))))
    return f"{estimate.value:.{digits}f}"


def _small(value: float) -> str:
    return f"{value:.1e}" if math.isfinite(value) else "-"


def _cost(path: EquilibriumPath) -> str:
    return f"{path.unknowns} unknowns, {path.seconds:.2f} s"
