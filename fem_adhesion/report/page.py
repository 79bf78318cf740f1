"""The report: one page that a reviewer can be sent, with every figure and all that moves inside it."""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

from matplotlib import rc_context

from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.lines import UNSTABLE, smooth
from fem_adhesion.common.page import Columns, Figure, Section, Table, data_rows, render, template_text
from fem_adhesion.common.style import laid_out
from fem_adhesion.crosscheck.comparison import (
    CLOSED_FORM,
    SOLVERS,
    TRIANGLES,
    WEAK_FORM,
    Case,
    Failure,
    Row,
    Solution,
    cells,
    columns,
    overall_verdict,
    told,
    verdict_of,
)
from fem_adhesion.curve import figure as curve_figure
from fem_adhesion.curve.solve import Curves
from fem_adhesion.report.walk import Walk, walk_data, walk_words
from halfspace.errors import InputError

WORDS = {
    "failed": "A solver failed",
    "disagree": "The two solvers disagree",
    "inconclusive": "The two solvers' error estimates are too wide to tell whether they agree",
    "agree": "The two solvers agree",
}
"""What each verdict is called, worst first."""


@dataclass(frozen=True)
class Contents:
    """What goes into a report: the cross-check, one curve, by both solvers and state by state, and other results.

    Those are in directories by their commands' names; `lost` says why there is no curve, or is empty.
    """

    cases: Sequence[Case | Failure]
    curves: Curves | None
    walk: Walk | None
    directories: Mapping[str, Path]
    lost: str = ""


def page(contents: Contents) -> str:
    """The page as HTML, or InputError if a directory does not hold what its command writes."""
    cases = contents.cases
    paths = contents.curves.paths.values() if contents.curves else ()
    others = [section_of(source, contents.directories.get(source.name)) for source in SOURCES]
    return render(
        "report/report.html.j2",
        title="Adhesive contact of a sphere: do two solvers agree?",
        verdict="failed" if contents.lost else overall_verdict(cases),
        words=verdict_words(cases),
        cases=cases,
        counts=_counts(cases),
        lost=contents.lost,
        curves=_curves_section(contents.curves) if contents.curves else None,
        walk=walk_data(contents.walk, contents.curves) if contents.walk and contents.curves else None,
        walk_words=walk_words(contents.walk) if contents.walk else (),
        has_unstable=any((smooth(path).kind == UNSTABLE).any() for path in paths),
        levels=crosscheck_section(cases),
        others=others,
        settings=settings_section(cases, machine()),
        script=template_text("report", "walk.js"),
    )


def verdict_words(cases: Sequence[Case | Failure]) -> str:
    """The verdict on all cases; where they differ, worst first with the Tabor parameters of each."""
    found = [verdict_of(case) for case in cases]
    if len(set(found)) == 1:
        return f"{WORDS[found[0]]}."
    tabors = {word: [f"{case.scene.tabor:g}" for case in cases if verdict_of(case) == word] for word in WORDS}
    return " ".join(f"{WORDS[one]} at Tabor parameter {', '.join(at)}." for one, at in tabors.items() if at)


def _counts(cases: Sequence[Case | Failure]) -> dict[str, int]:
    """How many quantities ended how, those of failed cases too."""
    verdicts = [row.verdict for case in cases for row in case.rows]
    return {verdict: verdicts.count(verdict) for verdict in WORDS if verdict in verdicts}


def _curves_section(curves: Curves) -> Section:
    stream = BytesIO()
    with rc_context(curve_figure.LOOK):
        drawn = laid_out(curve_figure.draw(curves))
        drawn.savefig(stream, format="svg", metadata={"Date": None})
    solvers = " and by ".join(curves.paths)
    last = "the deformed mesh" if curve_figure.has_mesh(curves) else "the central gap"
    text = (
        f"Load against approach at Tabor parameter {curves.question.scene.tabor:g} by {solvers}: "
        f"{', '.join(curve_figure.named(drawn))}. Pressure and gap at {', '.join(curve_figure.states(curves))}; the "
        f"spike of tension at the contact edge with the nodes of the grid; {last}."
    )
    return Section("curves", f"The curve by {solvers}", figures=(Figure(stream.getvalue(), text),))


# Sections: the cross-check in its levels, what the solvers chose, and what other commands left


LEVELS = {
    "operator:": ("Both elastic operators under the same pressures", SOLVERS),
    "cross-residual:": ("The state found by one solver in the equations of the other", SOLVERS),
    "triangles:": ("The half-space by overlapping triangles, as in 1997", TRIANGLES),
    "equations:": ("What both share, at a state made up, and a weak form that shares nothing", WEAK_FORM),
    "apart:": ("The events of the finite elements in that weak form", WEAK_FORM),
    "law:": ("The law, by its definition", CLOSED_FORM),
    "profile:": ("The profile, by its definition", CLOSED_FORM),
    "length:": ("The lengths, by their definition", CLOSED_FORM),
    "elimination:": ("The same elements condensed and with all displacements kept", WEAK_FORM),
    "limit:": ("What both share, in closed form", CLOSED_FORM),
    "": ("The events", SOLVERS),
}
VERDICTS = ("agree", "inconclusive", "disagree")

Cases = Sequence[Case | Failure]


def crosscheck_section(cases: Cases) -> Section:
    """The comparison: a summary, and tables of its levels."""
    failures = [(f"{case.scene.tabor:g}", told(case)) for case in cases if isinstance(case, Failure)]
    lost = (Table("", "Not solved", "", ("Tabor parameter", "reason"), failures, open=True),) if failures else ()
    levels = [
        Table(
            "",
            title,
            "",
            ("Tabor parameter", *columns(between)),
            [(tabor, *cells(row)) for tabor, row in _rows(cases, level)],
        )
        for level, (title, between) in LEVELS.items()
    ]
    return Section(
        "levels",
        "The levels",
        paragraphs=(
            "A quantity agrees only if the difference is within the sum of both error estimates and that sum within "
            "the budget. Loads in R dgamma, approaches in eps, energies in R dgamma eps.",
            f"Poisson's ratio {', '.join(sorted({f'{case.scene.poisson:g}' for case in cases}))}. "
            + "; ".join(f"Tabor parameter {case.scene.tabor:g}: {verdict_of(case)}" for case in cases)
            + ".",
        ),
        tables=(_summary(cases), *lost, *levels),
    )


def _rows(cases: Cases, level: str) -> list[tuple[str, Row]]:
    """Tabor parameters and rows of a level."""
    rows = [(f"{case.scene.tabor:g}", row) for case in cases for row in case.rows]
    return [(at, row) for at, row in rows if level == next(filter(row.quantity.startswith, LEVELS))]


def _summary(cases: Cases) -> Table:
    """Numbers of verdicts of each level, and its largest ratios of difference, error and budget."""

    def ratio(part: float, whole: float) -> float:
        return part / whole if whole else (math.inf if part else 0.0)

    lines = []
    for level, (title, _) in LEVELS.items():
        rows = [row for _, row in _rows(cases, level)]
        counts = [str(sum(row.verdict == verdict for row in rows)) for verdict in VERDICTS]
        known = [row for row in rows if row.first and row.second]
        ratios = [(ratio(row.difference, row.error), ratio(row.error, row.budget)) for row in known]
        largest = [f"{max(column):.2g}" for column in zip(*ratios, strict=True)] or ["none", "none"]
        lines.append([title, str(len(rows)), *counts, *largest])
    columns = ("level", "quantities", *VERDICTS, "largest difference / error", "largest error / budget")
    return Table("", "Summary", "", columns, lines, open=True)


def settings_section(cases: Cases, machine: dict[str, str]) -> Section:
    """Versions, machine and what the solvers chose."""
    columns: Columns[tuple[Case, str, Solution]] = {
        "Tabor parameter": lambda solved: f"{solved[0].scene.tabor:g}",
        "solver": lambda solved: solved[1],
        "settings": lambda solved: _settings(solved[2].settings),
        "tolerance": lambda solved: solved[2].tolerance,
        "unknowns": lambda solved: str(solved[2].unknowns),
        "seconds": lambda solved: f"{solved[2].seconds:.2f}",
    }
    every = [(case, *named) for case in cases if isinstance(case, Case) for named in case.solutions.items()]
    facts = Table("", "Versions", "", ("what", "which"), list((versions() | machine).items()), open=True)
    settings = Table.of("", "Settings", "", every, columns)
    return Section("settings", "Versions and settings", tables=(facts, settings))


def _settings(value: object) -> str:
    """Settings in words; those of a part in brackets."""
    if isinstance(value, Mapping):
        parts = ((name, _settings(part), isinstance(part, Mapping)) for name, part in value.items())
        return ", ".join(f"{name} ({text})" if nested else f"{name} {text}" for name, text, nested in parts)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


WELL = ("converged", "refused")  # how a hard case may end
MOST_ROWS = 400  # of a table that is shown


@dataclass(frozen=True)
class Source:
    """What a command line leaves in a directory that goes into the report.

    The line is the command of the same name unless given. The name is that of the section and of the option that takes
    the directory; the introduction is what to know before looking. Figures are SVG files by stem, whose captions, the
    text alternatives too, stand in ``captions.csv``. Tables are CSV files by stem and title; of one, `counted` or "",
    the column ``outcome`` is counted.
    """

    name: str
    title: str
    introduction: str
    figures: Sequence[str]
    tables: Sequence[tuple[str, str]]
    counted: str = ""
    line: str = ""

    @property
    def made_by(self) -> str:
        """The command line."""
        return self.line or f"fem-adhesion {self.name} --out {self.name}"


def _read_sources() -> Iterator[Source]:
    for row in data_rows("report", "sources.csv"):
        tables = [(stem, title) for stem, _, title in (part.partition(": ") for part in row["tables"].split("; "))]
        words = row["name"], row["title"], row["introduction"]
        yield Source(*words, row["figures"].split(), tables, row["counted"], row["line"])


SOURCES = tuple(_read_sources())


def section_of(source: Source, directory: Path | None) -> Section:
    """Section from a command's directory, InputError if it lacks what that writes, or one that it was not computed."""
    if directory is None:
        return Section(source.name, source.title, missing=source.made_by)
    captions = {}
    if source.figures:
        file = _require(directory / "captions.csv", source)
        captions = dict(zip(_column(file, "figure"), _column(file, "caption"), strict=True))
    figures = tuple(
        Figure(_svg(_require(directory / f"{stem}.svg", source)), captions[stem])
        for stem in source.figures
        if captions.get(stem)  # those without were not drawn
    )
    tables = {stem: read_table(_require(directory / f"{stem}.csv", source), title) for stem, title in source.tables}
    paragraphs, warning = [source.introduction], ""
    if source.counted:
        ended = Counter(_column(directory / f"{source.counted}.csv", "outcome"))
        paragraphs.append(f"Of {ended.total()} cases: {', '.join(f'{n} {outcome}' for outcome, n in ended.items())}.")
        wrong = {outcome: n for outcome, n in ended.items() if outcome not in WELL}
        warning = f"{', '.join(f'{n} {outcome}' for outcome, n in wrong.items())}." if wrong else ""
    shown = tuple(tables.values())
    return Section(source.name, source.title, warning=warning, paragraphs=paragraphs, figures=figures, tables=shown)


def _svg(file: Path) -> bytes:
    """Contents of an SVG file, InputError if it is none: a browser would show nothing in its place."""
    contents = file.read_bytes()
    try:
        first = ElementTree.fromstring(contents).tag
    except ElementTree.ParseError as error:
        raise InputError(f"{file} is no SVG picture: {error}; run its command again") from error
    if first != "{http://www.w3.org/2000/svg}svg":
        raise InputError(f"{file} is no SVG picture: its first element is {first}; run its command again")
    return contents


def _column(file: Path, name: str) -> list[str]:
    """Column of a CSV file, InputError if there is none of that name."""
    columns, *rows = _lines(file)
    if name not in columns:
        raise InputError(f"{file} has the columns {', '.join(columns)}, but not {name}; run its command again")
    return [row[columns.index(name)] for row in rows]


def _lines(file: Path) -> list[list[str]]:
    """Lines of a CSV file, of its columns' names first; InputError if it is empty or not all have as many cells."""
    try:
        with file.open(newline="", encoding="utf-8") as stream:
            lines = list(csv.reader(stream))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{file} is no CSV file: {error}; run its command again") from error
    if not lines or not lines[0]:
        raise InputError(f"{file} is empty; run its command again")
    for number, line in enumerate(lines, start=1):
        if len(line) != len(lines[0]):
            raise InputError(f"{file}, line {number}: {len(line)} cells, not {len(lines[0])}; run its command again")
    return lines


def read_table(file: Path, title: str) -> Table:
    """Contents of a CSV file, InputError if it holds none; the title says so where rows are left out."""
    columns, *rows = _lines(file)
    left_out = f" (first {MOST_ROWS} of {len(rows)} lines; all are in {file.name})" if len(rows) > MOST_ROWS else ""
    shown = [[cell(text) for text in row] for row in rows[:MOST_ROWS]]
    return Table("", title + left_out, "", [name.replace("_", " ") for name in columns], shown)


def cell(text: str) -> str:
    """Text of a cell; a number of more than twelve digits, which none wrote to be read, is rounded to four."""
    if re.fullmatch(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text) and len(re.sub(r"e.*|\D", "", text)) > 12:
        return f"{float(text):.4g}"
    return text


def _require(file: Path, source: Source) -> Path:
    if not file.is_file():
        raise InputError(f"{file} is not there; give the directory that {source.made_by} wrote")
    return file
