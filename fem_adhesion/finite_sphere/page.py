"""The study of the finite sphere as a directory: tables, figures, and a page: whether the half-space will do."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fem_adhesion.bodies.body import GripName
from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page import Columns, Section, Table, bullets, write_csv, write_page
from fem_adhesion.common.style import captions, draw, shown
from fem_adhesion.finite_sphere.bulk import Bulk, coefficients
from fem_adhesion.finite_sphere.cases import CAUSES, Record
from fem_adhesion.finite_sphere.chart import CHART, LINES
from fem_adhesion.finite_sphere.figures import FIGURES
from fem_adhesion.finite_sphere.fit import DEVIATIONS, TOLERANCE, Finding, compare, findings
from fem_adhesion.finite_sphere.plane import Field, field_of, safe_from
from fem_adhesion.finite_sphere.study import Study
from fem_adhesion.finite_sphere.table import Border, DeviationRow, Results, reference_poisson, results, write_tables
from halfspace.errors import InputError

SHOWN = {
    "pull_off_load": "pull-off force",
    "zero_load_radius": "contact radius under no load",
    "jump_on_approach": "approach at jump-on",
    "jump_on_approach_less_bulk": "approach at jump-on, bulk yield taken out",
    "jump_off_approach": "approach at jump-off",
    "jump_off_approach_less_bulk": "approach at jump-off, bulk yield taken out",
    "hysteresis": "energy lost in a cycle",
}
"""Quantities on the page; the files have the others besides."""


def all_tables(results: Results) -> list[Table]:
    """All tables in the order of the page."""
    rows, records = results.rows, results.study.records
    return [_safe(rows), _borders(results.borders), _fits(rows), _theories(rows), _bulk(records), _failures(records)]


def _safe(rows: Sequence[DeviationRow]) -> Table:
    """Least R/eps of the points solved from which on a deviation is below a level, at each Tabor parameter."""
    fields = {name: field_of(rows, name, reference_poisson(rows)) for name in SHOWN}
    tabors = sorted({tabor for field in fields.values() for tabor in field.tabor})

    def cell(field: Field, level: float) -> str:
        least = safe_from(field, level)
        return f"{least:g}" if np.isfinite(least) else "none" if np.isfinite(field.deviation).any() else ""

    lines = [
        (SHOWN[name], f"{100 * level:g} %", *(cell(field.at(tabor), level) for tabor in tabors))
        for name, field in fields.items()
        for level in LINES
    ]
    see = (
        "Least R/eps of the points solved from which on the deviation, with its error, is below the level at all "
        "larger ones; 'none' where it is not so at the largest one solved, empty where nothing is known."
    )
    columns = ("quantity", "half-space errs less than", *(f"R/eps at mu = {tabor:g}" for tabor in tabors))
    return Table("safe", "From which R/eps on the half-space will do", see, columns, lines)


def _fits(rows: Sequence[DeviationRow]) -> Table:
    see = (
        f"Errors are {DEVIATIONS:g} standard deviations and the change when the points farther than half-way are left "
        f"out; up to the beta/R stated, every point is within {100 * TOLERANCE:g} % of the terms beside its own error."
    )

    def cells(one: Finding) -> tuple[str, ...]:
        if not (fit := one.fit):
            return ("", "", "", "")
        terms = "; ".join(f"({plus_minus(c)}) {name}" for name, c in fit.coefficients.items())
        return (terms, f"{fit.holds_to:.2g}", str(fit.points), f"{fit.worst:.1e}")

    columns: Columns[Finding] = {
        "quantity": lambda one: SHOWN[one.quantity],
        "cause": lambda one: one.cause,
        "mu": lambda one: "all" if one.tabor is None else f"{one.tabor:g}",
        ("leading terms", "up to beta/R", "points", "largest residual"): cells,
        "why no fit": lambda one: one.reason,
    }
    wanted = [row for row in rows if row.quantity in SHOWN and (row.cause == "all" or row.quantity == "pull_off_load")]
    found = findings(wanted, reference_poisson(rows) or 0.0)
    return Table.of("fits", "Leading terms of the relative deviations", see, found, columns)


def _theories(rows: Sequence[DeviationRow]) -> Table:
    columns = ("theory and term", "expected", "fitted", "error", "at mu", "why not")
    see = (
        "The profile's part of the pull-off alone, on a half-space. The theories are of the limits mu = 0 and "
        "infinity, the fits of the mu stated."
    )
    try:
        lines = tuple(
            (theory, f"{expected:.4f}", f"{fitted.value:.4f}", f"{fitted.error:.1e}", f"{tabor:g}", "")
            for theory, expected, tabor, fitted in compare(rows)
        )
    except InputError as error:
        lines = (("", "", "", "", "", str(error)),)
    return Table("theories", "Leading coefficients beside theories", see, columns, lines)


def _bulk(records: Sequence[Record]) -> Table:
    see = (
        "The body approaches by W/(E* R) (kappa_0 + kappa_1 ln(beta/R)) more than the half-space, in eps by mu beta/R "
        "times as much. kappa_1 = -(1 - 2 nu)^2/(2 pi (1 - nu)) is exact, kappa_0 is measured under Hertz's pressure "
        "on r < beta; the term in beta/R is not taken out, but counted as error."
    )
    grips: tuple[GripName, ...] = ("sliding", "bonded")
    poissons = sorted({r.case.poisson for r in records if r.case.poisson is not None})
    columns: Columns[tuple[GripName, float, Bulk]] = {
        "grip": lambda row: row[0],
        "Poisson's ratio": lambda row: f"{row[1]:g}",
        "kappa_0": lambda row: f"{row[2].constant.value:.4f}",
        "error": lambda row: f"{row[2].constant.error:.1e}",
        "kappa_1": lambda row: f"{row[2].logarithm:.5f}",
        "size of the term in beta/R": lambda row: f"{row[2].linear:.2g}",
    }
    rows = [(grip, poisson, coefficients(grip, poisson)) for grip in grips for poisson in poissons]
    return Table.of("bulk", "The body's linear yield, in 1/(E* R)", see, rows, columns)


def _failures(records: Sequence[Record]) -> Table:
    failed = [record for record in records if record.status != "solved"]
    columns: Columns[Record] = {
        "case": lambda record: record.case.name,
        "status": lambda record: record.status,
        "kind": lambda record: record.kind,
        "reason": lambda record: record.reason,
    }
    see = f"{len(failed)} of {len(records)} cases."
    return Table.of("failures", "What was not solved, and why", see, failed, columns)


def _borders(borders: Sequence[Border]) -> Table:
    see = (
        "From this mu on the approach turns back along the curve; the spheres are held on a sliding mid-plane. Errors "
        "are the changes from elements one degree lower, or from a coarser grid."
    )
    columns: Columns[Border] = {
        "R/eps": lambda one: "half-space" if one.radius_ratio is None else f"{one.radius_ratio:g}",
        "Poisson's ratio": lambda one: "" if one.poisson is None else f"{one.poisson:g}",
        "mu": lambda one: f"{one.tabor.value:.9g}" if one.tabor else "",
        "error": lambda one: f"{one.tabor.error:.1e}" if one.tabor else "",
        "why none": lambda one: one.reason,
    }
    return Table.of("first_jumps", "Where jumps under fixed grips begin", see, borders, columns)


PICTURES = (CHART, *FIGURES)
PARTS = ("table", *(f"figure {picture.stem}" for picture in PICTURES), "page")
"""What `write` begins, in this order."""


def write(study: Study, directory: Path, begin: Callable[[str], None] = lambda _: None) -> str:
    """Write the table, every figure as SVG and PNG, the findings as CSV, and ``index.html``, into a directory.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none. `begin`
    is called with each of `PARTS` in turn. Returns how to get the Parquet file if there is none, else nothing.
    """
    begin("table")
    found, records = results(study), study.records
    note = write_tables(found.rows, directory)
    draw(PICTURES, found, directory, begin)
    begin("page")
    safe, *others = tables = all_tables(found)
    write_csv([*tables, captions(PICTURES, found)], directory)
    switched = [Markup("<strong>{}</strong>: {};").format(name, cause.meaning) for name, cause in CAUSES.items()]
    assumptions = Markup("Between the two lie several assumptions, switched one at a time:") + bullets(switched)
    parts = (("where", CHART.title, PICTURES[:1], (), [safe]), ("why", "Causes", PICTURES[1:], (assumptions,), ()))
    sections = []
    for name, title, pictures, paragraphs, shown_tables in parts:
        lacking = [f"{one.title}. Not drawn: {lack}." for one in pictures if (lack := one.lacks(found))]
        figures = shown(pictures, found, directory)
        sections.append(Section(name, title, "", "", (*paragraphs, *lacking), figures, shown_tables))
    sections += [Section("tables", "Tables", tables=others), _settings(records)]
    lead = [Markup("<strong>{}.</strong>").format(study.headline), *_answer(found.rows)]
    spent = f"{sum(r.seconds for r in records):.0f} s of work on {len(records)} cases"
    write_page(directory, "Is the half-space good enough for my sphere?", lead, sections, spent)
    return note


def remove_outdated(directory: Path, written: Path) -> None:
    """Remove figures of an earlier study from its directory that the study written anew does not have."""
    for name in (f"{picture.stem}.{suffix}" for picture in PICTURES for suffix in ("svg", "png")):
        if not (written / name).exists():
            (directory / name).unlink(missing_ok=True)


def _answer(table: Sequence[DeviationRow], level: float = 0.01) -> Iterator[str]:
    """From which R/eps on the half-space errs by less than a level at all points solved, in words."""
    poisson = reference_poisson(table)
    if poisson is None:
        yield "No elastic sphere was solved."
        return
    answers = []
    for quantity, name in SHOWN.items():
        field = field_of(table, quantity, poisson)
        known, least = field.tabor[np.isfinite(field.deviation).any(axis=1)], safe_from(field, level)
        if not known.size:
            where = "nowhere that is known: the study has no point of it"
        elif np.isnan(least):
            where = f"at no R/eps up to {field.radius_ratio[-1]:g} for all mu from {known[0]:g} to {known[-1]:g}"
        else:
            where = f"if R/eps is {least:g} or more (points solved, mu from {known[0]:g} to {known[-1]:g})"
        answers.append(Markup("the <strong>{}</strong> {};").format(name, where))
    said = Markup("By the points solved at Poisson's ratio {:g} it errs by less than {:g} % in")
    yield said.format(poisson, 100 * level) + bullets(answers)
    yield (
        "Here mu is the Tabor parameter, mu^3 = R dgamma^2/(E*^2 eps^3), R the radius of the sphere, eps the spacing "
        "of the surface law; the half-space's profile is a paraboloid. The sphere is elastic, its mid-plane slides in "
        "its grip, the wall is rigid and the strains are small. Nothing is said of points beyond the range given."
    )


def _settings(records: Sequence[Record]) -> Section:
    """How it was computed, and how to do so again."""
    names = ("tabor", "radius_ratio", "poisson", "rtol")
    inputs = {name: sorted({v for r in records if (v := getattr(r.case, name)) is not None}) for name in names}
    asked = bullets([f"{name}: {', '.join(f'{v:g}' for v in values)}" for name, values in inputs.items()])
    again = Markup(
        'All numbers with their errors are in <a href="finite_sphere.csv">finite_sphere.csv</a>. With '
        "<code>--resume</code>, what the directory holds is not computed again."
    )
    return Section("settings", "Settings", paragraphs=(asked, again))
