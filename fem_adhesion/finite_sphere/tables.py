"""The table of the finite sphere as files: CSV for all, Parquet for those who have the library."""

from __future__ import annotations

import csv
import importlib
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from fem_adhesion.finite_sphere.table import Row
from halfspace.values import Estimate

NUMBERS = ("value", "baseline", "half_space", "deviation")  # each followed by its error
FIELDS = tuple(field.name for field in fields(Row))
COLUMNS = tuple(n for name in FIELDS for n in ((name, f"{name}_error") if name in NUMBERS else (name,)))
TEXTS = ("cause", "quantity", "unit", "status", "reason", "kind")
NO_PARQUET = "no Parquet file is written, which needs the extra parquet; pip install 'fem-adhesion[parquet]'"


def write_tables(rows: Sequence[Row], directory: Path) -> str:
    """Write finite_sphere.csv, and finite_sphere.parquet where pyarrow is installed.

    Parameters
    ----------
    rows : sequence of Row
        From `fem_adhesion.finite_sphere.table.rows`.
    directory : Path
        Which exists and is to be seen by others only when it is complete.

    Returns
    -------
    str
        How to get the Parquet file if there is none, else empty.
    """
    with (directory / "finite_sphere.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(_cells(row) for row in rows)
    try:
        parquet = importlib.import_module("pyarrow.parquet")
    except ModuleNotFoundError:
        return NO_PARQUET
    parquet.write_table(_arrow(rows), directory / "finite_sphere.parquet")
    return ""


def _arrow(rows: Sequence[Row]) -> Any:
    arrow = importlib.import_module("pyarrow")
    schema = arrow.schema([(name, arrow.string() if name in TEXTS else arrow.float64()) for name in COLUMNS])
    return arrow.Table.from_pylist([_cells(row) for row in rows], schema=schema)


def _cells(row: Row) -> dict[str, object]:
    """Cells of a line by the names of their columns, None where there is nothing."""
    return dict(zip(COLUMNS, (cell for name in FIELDS for cell in _cells_of(name, getattr(row, name))), strict=True))


def _cells_of(name: str, content: object) -> tuple[object, ...]:
    if name not in NUMBERS:
        return (content,)
    return (content.value, content.error) if isinstance(content, Estimate) else (None, None)
