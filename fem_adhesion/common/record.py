"""The record: what every file of results says besides its numbers.

A JSON file has the record among its keys. Beside a table ``NAME.csv`` it stands in ``NAME.csv-metadata.json``, and one
``csv-metadata.json`` serves all tables of a directory, as W3C's "CSV on the Web" has it. Its keys are

    schema      number of this format; raised when a key or a column changes its meaning
    command     command line that repeats the run; empty where Python code asked
    versions    of Python and of the libraries that decide the numbers
    scene       contact, as `fem_adhesion.registry.part_from` reads it; null where there are several or none
    options     what else was asked for, by the names of the options
    units       unit of each number, by its name; a number that has its unit in its name or beside it needs none here

The name of a column is the quantity, then ``_error`` where it is the estimated error, then the unit, in which ``_``
stands for a blank: ``load_R_dgamma``, ``load_error_R_dgamma``, ``load_error_N``.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TextIO

from fem_adhesion.common.facts import plain, versions
from fem_adhesion.common.options import COMMAND
from fem_adhesion.registry import record_of
from halfspace.errors import InputError

SCHEMA = 4

UNITS: Mapping[str, str] = {
    "arclength": "1",
    "approach": "eps",
    "load": "R dgamma",
    "central_gap": "eps",
    "contact_radius": "beta",
    "energy": "R dgamma eps",
    "stiffness": "R dgamma/eps",
}
"""Units of the paper of the quantities that are written."""


def record(scene: object = None, /, units: Mapping[str, str] = UNITS, **options: Any) -> dict[str, Any]:
    """Record of a run that is under way, ready for JSON."""
    return {
        "schema": SCHEMA,
        "command": COMMAND.get(),
        "versions": versions(),
        "scene": plain(record_of(scene)),
        "options": plain({name: record_of(value) for name, value in options.items()}),
        "units": dict(units),
    }


def column(quantity: str, unit: str) -> str:
    """Name of a column."""
    return f"{quantity}_{unit.replace(' ', '_')}"


def beside(table: Path) -> Path:
    """File of the record of a table, or of all tables of a directory."""
    return table / "csv-metadata.json" if table.is_dir() else table.with_name(f"{table.name}-metadata.json")


def write_beside(file: TextIO, table: str, head: Mapping[str, Any]) -> None:
    """Write the record of a table, to the file that stands beside it."""
    json.dump({"@context": "http://www.w3.org/ns/csvw", "url": table, **head}, file, indent=1, allow_nan=False)


def write_records(files: Mapping[str, TextIO], head: Callable[[], Mapping[str, Any]], **tables: Path | None) -> None:
    """Write the record of each table that has a file for it, see `fem_adhesion.common.options.all_written`.

    The head is made if there is one: to ask for the versions takes a tenth of a second.
    """
    for name, table in tables.items():
        if table and (file := files.get(f"{name} record")):
            write_beside(file, table.name, head())


def lines_of(table: Path, remedy: str = "run its command again") -> list[list[str]]:
    """Lines of a CSV file, the names of its columns first; InputError if it is none, empty, or its lines differ."""
    try:
        with table.open(newline="", encoding="utf-8-sig") as stream:
            reader = csv.reader(stream)
            found = [(reader.line_num, line) for line in reader if line]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{table} cannot be read as CSV: {getattr(error, 'strerror', error)}; {remedy}") from error
    if not found:
        raise InputError(f"{table} is empty; {remedy}")
    _, names = found[0]
    for number, line in found:
        if len(line) != len(names):
            raise InputError(f"{table}, line {number}: {len(line)} cells, not {len(names)}; {remedy}")
    return [line for _, line in found]


def read(path: Path) -> Mapping[str, Any]:
    """Record of a JSON file, a table or a directory of tables; empty if there is none that can be read."""
    places = [path] if path.suffix == ".json" else [beside(path), beside(path.parent)]
    for place in places:
        try:
            found = json.loads(place.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue
        if isinstance(found, dict) and "schema" in found:
            return found
    return {}
