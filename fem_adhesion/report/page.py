"""The report: one page that a reviewer can be sent, with every figure and all that moves inside it."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

from matplotlib import rc_context

from fem_adhesion.common import record
from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.lines import UNSTABLE, smooth
from fem_adhesion.common.page import Figure, Section, Table, data_rows, render, template_text
from fem_adhesion.common.style import laid_out
from fem_adhesion.crosscheck import comparison
from fem_adhesion.crosscheck.comparison import CLOSED_FORM, SOLVERS, TRIANGLES, WEAK_FORM, Case, Row, columns
from fem_adhesion.curve import figure as curve_figure
from fem_adhesion.curve.load import STATES
from fem_adhesion.curve.solve import Curves
from fem_adhesion.fitting.folder import curve_of, values
from fem_adhesion.fitting.study import Value
from fem_adhesion.fitting.words import interval, sized
from fem_adhesion.report.walk import Walk, walk_data, walk_words
from halfspace.errors import InputError

WORDS = {
    "failed": "A solver failed",
    "disagree": "The two solvers disagree",
    "inconclusive": "The two solvers' error estimates are too wide to tell whether they agree",
    "agree": "The two solvers agree",
}
"""What each verdict is called, worst first."""


def page(
    cases: Sequence[Case], walk: Walk | None, directories: Mapping[str, Path], fit: Path | None = None, lost: str = ""
) -> str:
    """The page as HTML, or InputError if a directory does not hold what its command writes.

    It shows the cross-check, a walk along a curve, with the curve itself, and results of other commands: directories by
    the commands' names, and the record of a fit. Where there is no walk, `lost` says why.
    """
    verdicts = [row.verdict for case in cases for row in case.rows]
    paths = walk.curves.paths.values() if walk else ()
    return render(
        "report/report.html.j2",
        title="Adhesive contact of a sphere: do two solvers agree?",
        verdict="failed" if lost else comparison.overall_verdict(cases),
        words=verdict_words(cases),
        cases=cases,
        counts={verdict: verdicts.count(verdict) for verdict in WORDS if verdict in verdicts},
        lost=lost,
        curves=_curves_section(walk.curves) if walk else None,
        walk=walk_data(walk) if walk else None,
        walk_words=walk_words(walk) if walk else (),
        has_unstable=any((smooth(path).kind == UNSTABLE).any() for path in paths),
        levels=crosscheck_section(cases),
        others=[*(section_of(name, directories.get(name)) for name in SOURCES), fit_section(fit)],
        settings=settings_section(cases, machine()),
        script=template_text("report", "walk.js"),
    )


def verdict_words(cases: Sequence[Case]) -> str:
    """The verdict on all cases; where they differ, worst first with the Tabor parameters of each."""
    tabors = {word: [f"{case.scene.tabor:g}" for case in cases if case.verdict == word] for word in WORDS}
    found = {word: at for word, at in tabors.items() if at}
    if len(found) == 1:
        return f"{WORDS[cases[0].verdict]}."
    return " ".join(f"{WORDS[word]} at Tabor parameter {', '.join(at)}." for word, at in found.items())


def _curves_section(curves: Curves) -> Section:
    stream = BytesIO()
    with rc_context(curve_figure.LOOK):
        drawn = laid_out(curve_figure.draw(curves))
        drawn.savefig(stream, format="svg", metadata={"Date": None})
    solvers = " and by ".join(curves.paths)
    legend = drawn.axes[0].get_legend()
    named = ", ".join(text.get_text() for text in legend.get_texts()) if legend else ""
    states = ", ".join(look.words for name, look in STATES.items() if curves.path.event(name))
    last = "the deformed mesh" if curve_figure.has_mesh(curves) else "the central gap"
    text = (
        f"Load against approach at Tabor parameter {curves.question.scene.tabor:g} by {solvers}: "
        f"{named}. Pressure and gap at {states}; the "
        f"spike of tension at the contact edge with the nodes of the grid; {last}."
    )
    return Section("curves", f"The curve by {solvers}", figures=(Figure(stream.getvalue(), text),))


# Sections: the cross-check in its levels, what the solvers chose, and what other commands left


LEVELS = {
    "operator:": ("Both elastic operators under the same pressures", SOLVERS),
    "cross-residual:": ("The state found by one solver in the equations of the other", SOLVERS),
    "triangles:": ("The half-space by overlapping triangles, as in 1997", TRIANGLES),
    "equations:": ("What both solvers share, at a chosen state, and a weak form that shares nothing", WEAK_FORM),
    "apart:": ("The events of the finite elements in that weak form", WEAK_FORM),
    "law:": ("The law, by its definition", CLOSED_FORM),
    "profile:": ("The profile, by its definition", CLOSED_FORM),
    "length:": ("The lengths, by their definition", CLOSED_FORM),
    "elimination:": ("The same elements condensed and with all displacements kept", WEAK_FORM),
    "limit:": ("What both solvers share, in closed form", CLOSED_FORM),
    "": ("The events", SOLVERS),
}
VERDICTS = ("agree", "inconclusive", "disagree")


def crosscheck_section(cases: Sequence[Case]) -> Section:
    """The comparison: a summary, and tables of its levels."""
    failures = [(f"{case.scene.tabor:g}", case.told) for case in cases if case.reason]
    lost = (Table("", "Not solved", "", ("Tabor parameter", "reason"), failures, open=True),) if failures else ()
    found: dict[str, list[tuple[str, Row]]] = {level: [] for level in LEVELS}
    for case in cases:
        for row in case.rows:
            found[next(filter(row.quantity.startswith, LEVELS))].append((f"{case.scene.tabor:g}", row))
    summary, levels = [], []
    for level, (title, between) in LEVELS.items():
        summary.append([title, *_summary([row for _, row in found[level]])])
        lines = [(tabor, *comparison.cells(row)) for tabor, row in found[level]]
        levels.append(Table("", title, "", ("Tabor parameter", *columns(between)), lines))
    heads = ("level", "quantities", *VERDICTS, "largest difference / error", "largest error / budget")
    poisson = ", ".join(sorted({f"{case.scene.poisson:g}" for case in cases}))
    verdicts = "; ".join(f"Tabor parameter {case.scene.tabor:g}: {case.verdict}" for case in cases)
    return Section(
        "levels",
        "The levels",
        paragraphs=(
            "A quantity agrees only if the difference is within the sum of both error estimates and that sum within "
            "the budget. Loads in R dgamma, approaches in eps, energies in R dgamma eps.",
            f"Poisson's ratio {poisson}. {verdicts}.",
        ),
        tables=(Table("", "Summary", "", heads, summary, open=True), *lost, *levels),
    )


def _summary(rows: Sequence[Row]) -> list[str]:
    """Number of rows, of each verdict, and the largest ratios of difference, error and budget."""

    def largest(parts: Sequence[tuple[float, float]]) -> str:
        ratios = [part / whole if whole else (math.inf if part else 0.0) for part, whole in parts]
        return f"{max(ratios):.2g}" if ratios else "none"

    counts = [len(rows), *(sum(row.verdict == verdict for row in rows) for verdict in VERDICTS)]
    known = [row for row in rows if row.first and row.second]
    by_error = largest([(row.difference, row.error) for row in known])
    return [*map(str, counts), by_error, largest([(row.error, row.budget) for row in known])]


def settings_section(cases: Sequence[Case], machine: dict[str, str]) -> Section:
    """Versions, machine and what the solvers chose."""
    heads = ("Tabor parameter", "solver", "settings", "tolerance", "unknowns", "seconds")
    lines = [
        (
            f"{case.scene.tabor:g}",
            name,
            _settings(told["settings"]),
            told["tolerance"],
            str(told["unknowns"]),
            f"{told['seconds']:.2f}",
        )
        for case in cases
        for name, told in case.solutions.items()
    ]
    facts = Table("", "Versions", "", ("what", "which"), list((versions() | machine).items()), open=True)
    return Section("settings", "Versions and settings", tables=(facts, Table("", "Settings", "", heads, lines)))


def _settings(value: object) -> str:
    """Settings in words; those of a part in brackets."""
    if isinstance(value, Mapping):
        parts = ((name, _settings(part), isinstance(part, Mapping)) for name, part in value.items())
        return ", ".join(f"{name} ({text})" if nested else f"{name} {text}" for name, text, nested in parts)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


WELL = ("converged", "refused")  # how a hard case may end
MOST_ROWS = 400  # of a table that is shown

SOURCES: Mapping[str, Mapping[str, str]] = {row["name"]: row for row in data_rows("report", "sources.csv")}
"""What command lines leave in directories that goes into the report, see the head of ``sources.csv``."""


def section_of(name: str, directory: Path | None) -> Section:
    """Section from a command's directory, InputError if it lacks what that writes, or one that it was not computed."""
    source = SOURCES[name]
    line, title = source["line"] or f"fem-adhesion {name} --out {name}", source["title"]
    if directory is None:
        return Section(name, title, missing=line)

    def file(called: str) -> Path:
        if not (found := directory / called).is_file():
            raise InputError(f"{found} is not there; give the directory that {line} wrote")
        return found

    captions, stems = {}, source["figures"].split()
    if stems:
        of_figures = file("captions.csv")
        captions = dict(zip(_column(of_figures, "figure"), _column(of_figures, "caption"), strict=True))
    # Those without a caption were not drawn.
    figures = [Figure(_svg(file(f"{stem}.svg")), captions[stem]) for stem in stems if captions.get(stem)]
    named = (part.partition(": ") for part in source["tables"].split("; "))
    tables = [read_table(file(f"{stem}.csv"), words) for stem, _, words in named]
    paragraphs, warning = [source["introduction"]], ""
    if source["counted"]:
        ended = Counter(_column(file(f"{source['counted']}.csv"), "outcome"))
        paragraphs.append(f"Of {ended.total()} cases: {', '.join(f'{n} {outcome}' for outcome, n in ended.items())}.")
        wrong = [f"{n} {outcome}" for outcome, n in ended.items() if outcome not in WELL]
        warning = f"{', '.join(wrong)}." if wrong else ""
    return Section(name, title, warning=warning, paragraphs=paragraphs, figures=figures, tables=tables)


def fit_section(file: Path | None) -> Section:
    """Section from the record of a fit, of one curve or many, InputError if it is none; with the figure beside it."""
    title, line = "Work of adhesion from measured curves", "fem-adhesion fit CURVE --json fit.json --plot fit.svg"
    if file is None:
        return Section("fit", title, missing=line)
    found = record.read(file)
    rows = found.get("curves", [found])
    if not all("work_of_adhesion" in row or "reason" in row for row in rows):
        raise InputError(f"{file} is no record of a fit; give the file that {line} wrote")
    names = [name for name in ("work_of_adhesion", "spacing", "pull_off") if any(name in row for row in rows)]
    lines = [
        (
            curve_of(row),
            *(_measured(values([row], name)[0]) if name in row else "" for name in names),
            row.get("model", row.get("reason", "")),
            "yes" if row.get("misfit", {}).get("found") else "",
        )
        for row in rows
    ]
    heads = ("curve", *(f"{name.replace('_', ' ')}, 95 %" for name in names), "best model", "misfit")
    cautions = [*found["told"], *found["warnings"]] if len(rows) == 1 and "told" in found else []
    figure = file.with_suffix(".svg")
    words = "Data, fit, residuals and contour; of many curves, histograms."
    figures = [Figure(_svg(figure), words)] if figure.is_file() else []
    tables = [Table("", "The fits", "", heads, lines, open=True)]
    return Section("fit", title, paragraphs=cautions, figures=figures, tables=tables)


def _measured(value: Value) -> str:
    """Value with its interval, where an end of that is known."""
    number = sized(value.value, value.unit)
    return number if value.low is None and value.high is None else f"{number} ({interval(value)})"


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
    columns, *rows = record.lines_of(file)
    if name not in columns:
        raise InputError(f"{file} has the columns {', '.join(columns)}, but not {name}; run its command again")
    return [row[columns.index(name)] for row in rows]


def read_table(file: Path, title: str) -> Table:
    """Contents of a CSV file, InputError if it holds none; the title says so where rows are left out."""
    columns, *rows = record.lines_of(file)
    left_out = f" (first {MOST_ROWS} of {len(rows)} lines; all are in {file.name})" if len(rows) > MOST_ROWS else ""
    shown = [[cell(text) for text in row] for row in rows[:MOST_ROWS]]
    return Table("", title + left_out, "", [name.replace("_", " ") for name in columns], shown)


def cell(text: str) -> str:
    """Text of a cell; a number of more than twelve digits, which none wrote to be read, is rounded to four."""
    if re.fullmatch(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text) and len(re.sub(r"e.*|\D", "", text)) > 12:
        return f"{float(text):.4g}"
    return text
