"""Sections of the report: what was computed for it, and what other commands have left in directories."""

from __future__ import annotations

import base64
import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

MOST_LINES = 400  # of a table that is shown


@dataclass(frozen=True)
class Figure:
    """A picture as a data URI, with its text alternative and its caption."""

    source: str
    alternative: str
    caption: str = ""


@dataclass(frozen=True)
class Table:
    """A table: the title of all, those of its columns, and lines of text."""

    title: str
    columns: Sequence[str]
    lines: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Section:
    """A part of the page.

    Attributes
    ----------
    name, title : str
        For links, and for the reader.
    missing : bool
        Whether the command of that name was not run for it.
    paragraphs : sequence of str
        Before figures and tables.
    """

    name: str
    title: str
    missing: bool = False
    paragraphs: Sequence[str] = ()
    figures: Sequence[Figure] = ()
    tables: Sequence[Table] = field(default_factory=tuple)


@dataclass(frozen=True)
class Source:
    """What a command leaves in its directory that goes into the report.

    Attributes
    ----------
    command, title : str
        Its name, and the section's title.
    figures : sequence of (stem, text alternative)
        SVG files.
    tables : sequence of (stem, title)
        CSV files.
    """

    command: str
    title: str
    figures: Sequence[tuple[str, str]]
    tables: Sequence[tuple[str, str]]


SOURCES = (
    Source(
        "speed",
        "Speed against error",
        (
            ("pull_off", "Error of the pull-off load against wall time, one line a method, with the Pareto front."),
            ("jump_on", "Error of the approach at jump-on against wall time, one line a method."),
            ("hysteresis", "Error of the energy lost in a cycle against wall time, one line a method."),
        ),
        (("speed", "Every method on every rung of its ladder"),),
    ),
    Source(
        "hard",
        "Hard cases",
        (),
        (("hard", "Each case ends in a number within its estimate or in a refusal"), ("locking", "Locking")),
    ),
    Source(
        "greenwood",
        "Greenwood (1997), printed and computed",
        (
            ("fig_3b", "After Fig. 3b: load against approach at several Tabor parameters."),
            ("fig_7", "After Fig. 7: pull-off force against the Tabor parameter, with the theories and their limits."),
            ("fig_8", "The stiffness of the apparatus below which a contact jumps, against the Tabor parameter."),
        ),
        (("table_1", "Table 1"), ("table_2", "Table 2"), ("criteria_constants", "Criteria for jumping on")),
    ),
    Source(
        "finite-sphere",
        "Is the half-space good enough for my sphere?",
        (
            (
                "chart",
                "Contours of the half-space's error over Tabor parameter and R/eps, with real materials on them.",
            ),
            ("causes", "The deviation of the pull-off force from the half-space split into causes, against beta/R."),
        ),
        (("rules", "Rules of thumb"), ("theories", "Beside the theories of the rigid and of the soft sphere")),
    ),
)


def section_of(source: Source, directory: Path | None) -> Section:
    """Section from a command's directory, or one that says that it was not computed.

    Raises
    ------
    ValueError
        If the directory does not hold what the command writes.
    """
    if directory is None:
        return Section(source.command, source.title, missing=True)
    figures = tuple(
        Figure(data_uri(_require(directory / f"{stem}.svg", source).read_bytes()), text)
        for stem, text in source.figures
    )
    tables = tuple(read_table(_require(directory / f"{stem}.csv", source), title) for stem, title in source.tables)
    return Section(source.command, source.title, figures=figures, tables=tables)


def _require(file: Path, source: Source) -> Path:
    if not file.is_file():
        raise ValueError(f"{file} is not there; give the directory that fem-adhesion {source.command} --out wrote")
    return file


def data_uri(svg: bytes) -> str:
    """An SVG picture as part of the page."""
    return f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"


def read_table(file: Path, title: str) -> Table:
    """Contents of a CSV file."""
    with file.open(newline="", encoding="utf-8") as stream:
        columns, *lines = list(csv.reader(stream))
    return Table(title, [name.replace("_", " ") for name in columns], lines[:MOST_LINES])


def crosscheck_section(record: dict[str, Any]) -> Section:
    """The comparison on its three levels, a table for each Tabor parameter."""
    return Section(
        "levels",
        "The three levels",
        paragraphs=(
            "Both elastic operators under the same pressures; the state found by one solver in the equations of the "
            "other; the events. Loads in R Δγ, approaches in ε, energies in R Δγ ε. A quantity agrees only if the "
            "difference is within the sum of both error estimates and that sum within the budget.",
        ),
        tables=tuple(_case_table(case) for case in record["cases"]),
    )


def _case_table(case: dict[str, Any]) -> Table:
    title = f"Tabor parameter {case['tabor']:g}, Poisson's ratio {case['poisson']:g}: {case['verdict']}"
    if "reason" in case:
        return Table(title, ("reason",), ((case["reason"],),))
    errors = ("difference", "error (hs)", "error (fe)", "budget")
    columns = ("quantity", "unit", "half-space", "finite elements", *errors, "verdict")
    return Table(title, columns, [_case_line(row) for row in case["comparison"]])


def _case_line(row: dict[str, Any]) -> list[str]:
    values = [_number(row[name], ".9g") for name in ("halfspace", "finite_element")]
    errors = [_number(row[name], ".1e") for name in ("difference", "halfspace_error", "finite_element_error", "budget")]
    return [row["quantity"], row["unit"], *values, *errors, row["verdict"]]


def _number(value: float | None, form: str) -> str:
    return "none" if value is None else format(value, form)


def settings_section(record: dict[str, Any], machine: dict[str, str]) -> Section:
    """Versions, machine and what the solvers chose."""
    facts = {**record["versions"], **machine}
    lines = [
        [f"{case['tabor']:g}", name, *_solution(case[key])]
        for case in record["cases"]
        if "reason" not in case
        for key, name in (("halfspace", "half-space"), ("finite_element", "finite elements"))
    ]
    return Section(
        "settings",
        "Versions and settings",
        tables=(
            Table("Versions", ("what", "which"), list(map(list, facts.items()))),
            Table("Settings", ("Tabor parameter", "solver", "settings", "unknowns", "seconds"), lines),
        ),
    )


def _solution(solved: dict[str, Any]) -> list[str]:
    return [json.dumps(solved["settings"]), str(solved["unknowns"]), f"{solved['seconds']:.2f}"]
