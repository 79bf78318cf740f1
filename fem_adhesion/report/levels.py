"""The cross-check in the report: its four levels, and what the solvers chose."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from fem_adhesion.common.facts import versions
from fem_adhesion.common.page import Section, Table
from fem_adhesion.crosscheck.comparison import CLOSED_FORM, SOLVERS, WEAK_FORM, Row
from fem_adhesion.crosscheck.record import told, verdict_of
from fem_adhesion.crosscheck.study import Case, Failure
from fem_adhesion.crosscheck.table import cells, columns
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import tolerance_told

LEVELS = {
    "operator:": ("Both elastic operators under the same pressures", SOLVERS),
    "cross-residual:": ("The state found by one solver in the equations of the other", SOLVERS),
    "equations:": ("What both share, at a state made up, and a weak form that shares nothing", WEAK_FORM),
    "apart:": ("The events of the finite elements in that weak form", WEAK_FORM),
    "limit:": ("What both share, in closed form", CLOSED_FORM),
    "": ("The events", SOLVERS),
}
VERDICTS = ("agree", "inconclusive", "disagree")
SETTINGS = ("Tabor parameter", "solver", "settings", "tolerance", "unknowns", "seconds")
SUMMARY = ("level", "quantities", *VERDICTS, "largest difference / error", "largest error / budget")

Cases = Sequence[Case | Failure]


def crosscheck_section(cases: Cases) -> Section:
    """The comparison: a summary, and tables of its levels."""
    failures = [(f"{case.scene.tabor:g}", told(case)) for case in cases if isinstance(case, Failure)]
    lost = (Table("", "Not solved", "", ("Tabor parameter", "reason"), failures, open=True),) if failures else ()
    return Section(
        "levels",
        "The four levels",
        paragraphs=(
            "A quantity agrees only if the difference is within the sum of both error estimates and that sum within "
            "the budget. Loads in R dgamma, approaches in eps, energies in R dgamma eps.",
            f"Poisson's ratio {', '.join(sorted({f'{case.scene.poisson:g}' for case in cases}))}. "
            + "; ".join(f"Tabor parameter {case.scene.tabor:g}: {verdict_of(case)}" for case in cases)
            + ".",
        ),
        tables=(_summary(cases), *lost, *(_level_table(cases, level) for level in LEVELS)),
    )


def _rows(cases: Cases, level: str) -> Iterator[tuple[float, Row]]:
    """Tabor parameters and rows of a level."""
    for case in cases:
        yield from ((case.scene.tabor, row) for row in case.rows if _level(row) == level)


def _level(row: Row) -> str:
    return next(level for level in LEVELS if row.quantity.startswith(level))


def _summary(cases: Cases) -> Table:
    lines = [_summary_line(LEVELS[level][0], [row for _, row in _rows(cases, level)]) for level in LEVELS]
    return Table("", "Summary", "", SUMMARY, lines, open=True)


def _summary_line(title: str, rows: Sequence[Row]) -> list[str]:
    counts = [str(sum(row.verdict == verdict for row in rows)) for verdict in VERDICTS]
    known = [row for row in rows if row.first and row.second]
    ratios = [(_ratio(row.difference, row.error), _ratio(row.error, row.budget)) for row in known]
    largest = [f"{max(column):.2g}" for column in zip(*ratios, strict=True)] or ["none", "none"]
    return [title, str(len(rows)), *counts, *largest]


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else (math.inf if part else 0.0)


def _level_table(cases: Cases, level: str) -> Table:
    lines = [[f"{tabor:g}", *cells(row)] for tabor, row in _rows(cases, level)]
    title, between = LEVELS[level]
    return Table("", title, "", ("Tabor parameter", *columns(between)), lines)


def settings_section(cases: Cases, machine: Mapping[str, str]) -> Section:
    """Versions, machine and what the solvers chose."""
    facts = {**versions(), **machine}
    lines = [
        [f"{case.scene.tabor:g}", name, _settings(path.settings), tolerance_told(path.rtol, path.missed), *_cost(path)]
        for case in cases
        if isinstance(case, Case)
        for name, path in case.solutions.items()
    ]
    return Section(
        "settings",
        "Versions and settings",
        tables=(
            Table("", "Versions", "", ("what", "which"), list(map(list, facts.items())), open=True),
            Table("", "Settings", "", SETTINGS, lines),
        ),
    )


def _cost(path: EquilibriumPath) -> tuple[str, str]:
    return str(path.unknowns), f"{path.seconds:.2f}"


def _settings(value: object) -> str:
    """Settings in words; those of a part in brackets."""
    if isinstance(value, Mapping):
        parts = ((name, _settings(part), isinstance(part, Mapping)) for name, part in value.items())
        return ", ".join(f"{name} ({text})" if nested else f"{name} {text}" for name, text, nested in parts)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
