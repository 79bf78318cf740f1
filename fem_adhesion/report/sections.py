"""Sections of the report that other commands have left in directories."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fem_adhesion.common.page import Section, Table, inlined
from halfspace.errors import InputError

WELL = ("converged", "refused")
"""How a hard case may end."""

MOST_ROWS = 400  # of a table that is shown
MOST_DIGITS = 12  # of a number that was written to be read; more are those of the machine
DIGITS = 4  # that are shown of such


@dataclass(frozen=True)
class Source:
    """What a command line leaves in a directory that goes into the report.

    Attributes
    ----------
    name, title, introduction : str
        Of the section and of the option that takes the directory; its title, and what to know before looking.
    figures : sequence of (stem, caption)
        SVG files; the caption is the text alternative too. What the command measured itself stands in `captions`.
    tables : sequence of (stem, title)
        CSV files.
    counted : str
        Stem of a table whose column ``outcome`` is counted, or "".
    captions : str
        Stem of a CSV file with columns ``figure`` and ``caption``, or "".
    line : str
        The command line, if it is not that of the same name.
    """

    name: str
    title: str
    introduction: str
    figures: Sequence[tuple[str, str]]
    tables: Sequence[tuple[str, str]]
    counted: str = ""
    captions: str = ""
    line: str = ""

    @property
    def made_by(self) -> str:
        """The command line."""
        return self.line or f"fem-adhesion {self.name} --out {self.name}"


SOURCES = (
    Source(
        "speed",
        "Speed against error",
        "Each line is a method at ever finer settings. The grey band is the least time for each error by any method, "
        "the dotted line the uncertainty of the truth that errors are taken against: the other family's solution.",
        (
            ("pull_off", "Error of the pull-off load against wall time: half-space left, finite elements right."),
            ("jump_on", "Error of the approach at jump-on against wall time: half-space left, finite elements right."),
            ("hysteresis", "Error of the energy lost in a cycle: half-space left, finite elements right."),
        ),
        (
            ("speed", "Every method on every rung of its ladder"),
            ("growth", "How the time of the solvers with error control grows"),
        ),
    ),
    Source(
        "hard",
        "Hard cases",
        "Each case has to end in a number whose error is within its estimate, or in a refusal that says why.",
        (),
        (("hard", "Cases"), ("locking", "Locking: largest error of the deflection under a smooth pressure")),
        counted="hard",
        line="make hard",
    ),
    Source(
        "greenwood",
        "Greenwood (1997), printed and computed",
        "The paper's tables beside the same quantities computed here with their estimated errors, and figures after "
        "the paper's and beyond.",
        tuple((stem, "") for stem in ("fig_3b", "fig_7", "fig_8")),
        (("table_1", "Table 1"), ("table_2", "Table 2"), ("criteria_constants", "Criteria for jumping on")),
        captions="captions",
    ),
    Source(
        "finite-sphere",
        "Is the half-space good enough for my sphere?",
        "An elastic sphere of finite radius R beside the half-space with a parabolic profile.",
        (("chart", ""), ("causes", "")),
        (("rules", "Rules of thumb"), ("theories", "Beside the theories of the rigid and of the soft sphere")),
        captions="captions",
    ),
)


def section_of(source: Source, directory: Path | None) -> Section:
    """Section from a command's directory, or one that says that it was not computed.

    Raises
    ------
    InputError
        If the directory does not hold what the command writes.
    """
    if directory is None:
        return Section(source.name, source.title, missing=source.made_by)
    captions = dict(source.figures) | _captions(source, directory)
    figures = tuple(
        inlined(_require(directory / f"{stem}.svg", source).read_bytes(), f"{source.name}-{stem}", captions[stem])
        for stem, _ in source.figures
        if captions[stem]  # those without were not drawn
    )
    tables = {stem: read_table(_require(directory / f"{stem}.csv", source), title) for stem, title in source.tables}
    paragraphs, warning = [source.introduction], ""
    if source.counted:
        ended = _outcomes(tables[source.counted])
        paragraphs.append(f"Of {ended.total()} cases: {', '.join(f'{n} {outcome}' for outcome, n in ended.items())}.")
        wrong = {outcome: n for outcome, n in ended.items() if outcome not in WELL}
        warning = f"{', '.join(f'{n} {outcome}' for outcome, n in wrong.items())}." if wrong else ""
    shown = tuple(tables.values())
    return Section(source.name, source.title, warning=warning, paragraphs=paragraphs, figures=figures, tables=shown)


def _captions(source: Source, directory: Path) -> dict[str, str]:
    """Captions that the command left beside its figures."""
    if not source.captions:
        return {}
    with _require(directory / f"{source.captions}.csv", source).open(newline="", encoding="utf-8") as file:
        return {row["figure"]: row["caption"] for row in csv.DictReader(file)}


def _outcomes(table: Table) -> Counter[str]:
    """How many rows of a table ended how."""
    place = list(table.columns).index("outcome")
    return Counter(row[place] for row in table.rows)


def read_table(file: Path, title: str) -> Table:
    """Contents of a CSV file; the title says so where rows are left out.

    Raises
    ------
    InputError
        If the file is empty.
    """
    with file.open(newline="", encoding="utf-8") as stream:
        columns, *rows = list(csv.reader(stream)) or [[]]
    if not columns:
        raise InputError(f"{file} is empty; run its command again")
    left_out = f" (first {MOST_ROWS} of {len(rows)} lines; all are in {file.name})" if len(rows) > MOST_ROWS else ""
    shown = [[cell(text) for text in row] for row in rows[:MOST_ROWS]]
    return Table("", title + left_out, "", [name.replace("_", " ") for name in columns], shown)


def cell(text: str) -> str:
    """Text of a cell, numbers as the machine has them rounded."""
    if re.fullmatch(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text) and len(re.sub(r"e.*|\D", "", text)) > MOST_DIGITS:
        return f"{float(text):.{DIGITS}g}"
    return text


def _require(file: Path, source: Source) -> Path:
    if not file.is_file():
        raise InputError(f"{file} is not there; give the directory that {source.made_by} wrote")
    return file
