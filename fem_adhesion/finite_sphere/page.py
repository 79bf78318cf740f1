"""The study of the finite sphere as a directory: tables, figures, and a page: whether the half-space will do."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fem_adhesion.bodies.body import GripName
from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page import Columns, Section, Table, bullets, said, titled, write_csv, write_page
from fem_adhesion.common.style import captions, draw, shown
from fem_adhesion.finite_sphere.bulk import Bulk, coefficients
from fem_adhesion.finite_sphere.cases import CRITICAL, Record
from fem_adhesion.finite_sphere.chart import CHART, LINES, in_plane, safe_from
from fem_adhesion.finite_sphere.figures import FIGURES
from fem_adhesion.finite_sphere.fit import DEVIATIONS, TOLERANCE, Finding, compare, findings
from fem_adhesion.finite_sphere.study import Study
from fem_adhesion.finite_sphere.table import CAUSES, SHOWN, DeviationRow, borders, write_tables
from halfspace.errors import Unsolved, tried


def all_tables(study: Study) -> list[Table]:
    """All tables in the order of the page."""
    return [make(study) for make in (_safe, _borders, _fits, _theories, _bulk, _failures)]


def _safe(study: Study) -> Table:
    """Least R/eps of the points solved from which on a deviation is below a level, at each Tabor parameter."""
    planes = {name: in_plane(study.rows, name, study.poisson) for name in SHOWN}
    tabors = sorted({row.tabor for plane in planes.values() for row in plane})

    def cell(plane: Sequence[DeviationRow], level: float) -> str:
        least = safe_from(plane, level)
        return f"{least:g}" if np.isfinite(least) else "none" if any(row.known for row in plane) else ""

    columns: Columns[tuple[str, float]] = {
        ("quantity", "half-space errs less than"): lambda at: (SHOWN[at[0]], f"{100 * at[1]:g} %"),
        tuple(f"R/eps at mu = {tabor:g}" for tabor in tabors): lambda at: [
            cell([row for row in planes[at[0]] if row.tabor == tabor], at[1]) for tabor in tabors
        ],
    }
    return Table.of(*titled("finite_sphere", "safe"), product(SHOWN, LINES), columns)


def _fits(study: Study) -> Table:
    def cells(one: Finding) -> tuple[str, ...]:
        fit = one[3]
        if isinstance(fit, Unsolved):
            return ("", "", "", "", fit.reason)
        terms = "; ".join(f"({plus_minus(c)}) {name}" for name, c in fit.coefficients.items())
        return (terms, f"{fit.holds_to:.2g}", str(fit.points), f"{fit.worst:.1e}", "")

    columns: Columns[Finding] = {
        ("quantity", "cause"): lambda one: (SHOWN[one[1]], one[0]),
        "mu": lambda one: "all" if one[2] is None else f"{one[2]:g}",
        ("leading terms", "up to beta/R", "points", "largest residual", "why no fit"): cells,
    }
    wanted = [r for r in study.rows if r.quantity in SHOWN and (r.cause == "all" or r.quantity == "pull_off_load")]
    texts = titled("finite_sphere", "fits", deviations=DEVIATIONS, tolerance=100 * TOLERANCE)
    return Table.of(*texts, findings(wanted, study.poisson or 0.0), columns)


def _theories(study: Study) -> Table:
    columns = ("theory and term", "expected", "fitted", "error", "at mu", "why not")
    found = tried(lambda: list(compare(study.rows)), refusals=True)
    lines = [
        (theory, f"{expected:.4f}", f"{fitted.value:.4f}", f"{fitted.error:.1e}", f"{tabor:g}", "")
        for theory, expected, tabor, fitted in found or ()
    ]
    if isinstance(found, Unsolved):
        lines = [("", "", "", "", "", found.reason)]
    return Table(*titled("finite_sphere", "theories"), columns, lines)


def _bulk(study: Study) -> Table:
    grips: tuple[GripName, ...] = ("sliding", "bonded")
    poissons = sorted({r.case.poisson for r in study.records if r.case.poisson is not None})
    columns: Columns[tuple[GripName, float, Bulk]] = {
        "grip": lambda row: row[0],
        "Poisson's ratio": lambda row: f"{row[1]:g}",
        ("kappa_0", "error"): lambda row: (f"{row[2].constant.value:.4f}", f"{row[2].constant.error:.1e}"),
        "kappa_1": lambda row: f"{row[2].logarithm:.5f}",
        "size of the term in beta/R": lambda row: f"{row[2].linear:.2g}",
    }
    rows = [(grip, poisson, coefficients(grip, poisson)) for grip in grips for poisson in poissons]
    return Table.of(*titled("finite_sphere", "bulk"), rows, columns)


def _failures(study: Study) -> Table:
    failed = [record for record in study.records if record.status != "solved"]
    columns: Columns[Record] = {
        "case": lambda record: record.case.name,
        ("status", "kind", "reason"): lambda record: (record.status, record.kind, record.reason),
    }
    texts = titled("finite_sphere", "failures", failed=len(failed), tried=len(study.records))
    return Table.of(*texts, failed, columns)


def _borders(study: Study) -> Table:
    def cells(one: Record) -> tuple[str, str, str]:
        if tabor := one.values.get(CRITICAL):
            return (f"{tabor.value:.9g}", f"{tabor.error:.1e}", "")
        return ("", "", one.reason or said("finite_sphere", "first_jumps", "none"))

    columns: Columns[Record] = {
        "R/eps": lambda one: "half-space" if one.case.radius_ratio is None else f"{one.case.radius_ratio:g}",
        "Poisson's ratio": lambda one: "" if one.case.poisson is None else f"{one.case.poisson:g}",
        ("mu", "error", "why none"): cells,
    }
    return Table.of(*titled("finite_sphere", "first_jumps"), borders(study.records), columns)


PICTURES = (CHART, *FIGURES)
PARTS = ("table", *(f"figure {picture.stem}" for picture in PICTURES), "page")
"""What `write` begins, in this order."""


def write(study: Study, directory: Path, begin: Callable[[str], None] = lambda _: None) -> str:
    """Write the table, every figure as SVG and PNG, the findings as CSV, and ``index.html``, into a directory.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none. `begin`
    is called with each of `PARTS` in turn. Returns how to get the Parquet file if there is none, else nothing.
    """
    begin("table")
    note = write_tables(study.rows, directory)
    draw(PICTURES, study, directory, begin)
    begin("page")
    safe, *others = tables = all_tables(study)
    write_csv([*tables, captions(PICTURES, study)], directory)
    switched = [Markup("<strong>{}</strong>: {};").format(name, cause.meaning) for name, cause in CAUSES.items()]
    assumptions = Markup("Between the two lie several assumptions, switched one at a time:") + bullets(switched)
    parts = (("where", CHART.title, PICTURES[:1], (), [safe]), ("why", "Causes", PICTURES[1:], (assumptions,), ()))
    sections = []
    for name, title, pictures, paragraphs, shown_tables in parts:
        lacking = [f"{one.title}. Not drawn: {lack}." for one in pictures if (lack := one.lacks(study))]
        figures = shown(pictures, study, directory)
        sections.append(Section(name, title, "", "", (*paragraphs, *lacking), figures, shown_tables))
    sections += [Section("tables", "Tables", tables=others), _settings(study.records)]
    lead = [Markup("<strong>{}.</strong>").format(study.headline), *_answer(study)]
    spent = f"{sum(r.seconds for r in study.records):.0f} s of work on {len(study.records)} cases"
    write_page(directory, "Is the half-space good enough for my sphere?", lead, sections, spent)
    return note


def remove_outdated(directory: Path, written: Path) -> None:
    """Remove figures of an earlier study from its directory that the study written anew does not have."""
    for name in (f"{picture.stem}.{suffix}" for picture in PICTURES for suffix in ("svg", "png")):
        if not (written / name).exists():
            (directory / name).unlink(missing_ok=True)


def _answer(study: Study, level: float = 0.01) -> Iterator[str]:
    """From which R/eps on the half-space errs by less than a level at all points solved, in words."""
    if study.poisson is None:
        yield "No elastic sphere was solved."
        return
    answers = []
    for quantity, name in SHOWN.items():
        plane = in_plane(study.rows, quantity, study.poisson)
        known, least = sorted({row.tabor for row in plane if row.known}), safe_from(plane, level)
        if not known:
            where = "nowhere that is known: the study has no point of it"
        elif np.isnan(least):
            largest = max(row.radius_ratio or 0.0 for row in plane)
            where = f"at no R/eps up to {largest:g} for all mu from {known[0]:g} to {known[-1]:g}"
        else:
            where = f"if R/eps is {least:g} or more (points solved, mu from {known[0]:g} to {known[-1]:g})"
        answers.append(Markup("the <strong>{}</strong> {};").format(name, where))
    words = Markup("By the points solved at Poisson's ratio {:g} it errs by less than {:g} % in")
    yield words.format(study.poisson, 100 * level) + bullets(answers)
    yield said("finite_sphere", "answer", "all")


def _settings(records: Sequence[Record]) -> Section:
    """How it was computed, and how to do so again."""
    names = ("tabor", "radius_ratio", "poisson", "rtol")
    inputs = {name: sorted({v for r in records if (v := getattr(r.case, name)) is not None}) for name in names}
    asked = bullets([f"{name}: {', '.join(f'{v:g}' for v in values)}" for name, values in inputs.items()])
    again = Markup(said("finite_sphere", "settings", "again"))
    return Section("settings", "Settings", paragraphs=(asked, again))
