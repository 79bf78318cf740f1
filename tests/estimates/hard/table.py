"""The hard cases: tables for the terminal, and both tables as files."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from rich.markup import escape

from fem_adhesion.common.facts import versions
from fem_adhesion.common.terminal import Column, Fitted
from hard.bodies import Locking
from hard.run import Row

COLUMNS = ("case", "expected", "found", "error", "estimate", "Newton steps", "seconds", "compared, or refused because")
RANKS = {"error": 1, "estimate": 1, "seconds": 2, "Newton steps": 3}  # by which columns are left out
WORDS = (*COLUMNS[:3], COLUMNS[-1])
STYLES = {"converged": "green", "refused": "cyan", "wrong": "bold red"}


def cases_table(rows: Sequence[Row]) -> Fitted:
    """One line for each case: the ending declared, the one found; a refusal in its own words."""
    cells = [
        (
            escape(row.name),
            row.expected,
            f"[{STYLES[row.outcome]}]{escape(row.found)}[/]",
            _small(row.error),
            _small(row.estimate),
            _steps(row),
            f"{row.seconds:.2f}",
            escape(row.message),
        )
        for row in rows
    ]
    return Fitted(
        [
            Column(name, texts, RANKS.get(name, 0), name in WORDS, wraps=name in WORDS)
            for name, texts in zip(COLUMNS, zip(*cells, strict=True), strict=True)
        ],
        [summary(rows)],
    )


def summary(rows: Sequence[Row]) -> str:
    """How many cases ended how; otherwise than declared is wrong."""
    counts = {outcome: sum(row.outcome == outcome for row in rows) for outcome in STYLES}
    return ", ".join(f"{count} {outcome}" for outcome, count in counts.items())


def locking_table(rows: Sequence[Locking]) -> Fitted:
    """One line for each Poisson's ratio and element."""
    cells = [(f"{row.poisson:g}", row.element, _small(row.error), _small(row.remedied), row.remedy) for row in rows]
    headers = ("poisson", "element", "error", "with the remedy", "remedy")
    columns = zip(headers, zip(*cells, strict=True), strict=True)
    title = "locking: largest error of the deflection under a smooth pressure"
    return Fitted([Column(name, texts, text=True, wraps=name == "remedy") for name, texts in columns], [title])


def write_hard(directory: Path, rows: Sequence[Row], locking: Sequence[Locking]) -> None:
    """Write hard.csv, locking.csv and hard.json, which holds both, into an existing directory."""
    write_csv(directory / "hard.csv", rows)
    write_csv(directory / "locking.csv", locking)
    with (directory / "hard.json").open("w") as file:
        json.dump(hard_record(rows, locking), file, indent=1, allow_nan=False)


def hard_record(rows: Sequence[Row], locking: Sequence[Locking]) -> dict[str, Any]:
    """Both tables as plain data, ready for JSON: null where a refused case has no number."""
    return {
        "summary": summary(rows),
        "versions": versions(),
        "cases": [_plain(row) for row in rows],
        "locking": [_plain(row) for row in locking],
    }


def write_csv(path: Path, rows: Sequence[Row] | Sequence[Locking]) -> None:
    """Write rows of one kind under their fields' names; empty where there is no number."""
    with path.open("w") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(rows[0])], lineterminator="\n")
        writer.writeheader()
        writer.writerows(_plain(row) for row in rows)


def _plain(row: Row | Locking) -> dict[str, Any]:
    return {name: None if isinstance(v, float) and not math.isfinite(v) else v for name, v in asdict(row).items()}


def _small(value: float) -> str:
    return f"{value:.1e}" if math.isfinite(value) else "-"


def _steps(row: Row) -> str:
    return str(row.newton_steps) if row.newton_steps else "-"
