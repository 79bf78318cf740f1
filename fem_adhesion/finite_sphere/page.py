"""The study of the finite sphere as a directory: table, figures, and a page: whether the half-space will do."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import ceil
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.page import Section, Table, listed, page, write_csv
from fem_adhesion.common.style import Picture, captions, draw, shown
from fem_adhesion.finite_sphere import findings
from fem_adhesion.finite_sphere.bulk import bulk_compliance
from fem_adhesion.finite_sphere.cases import CAUSES
from fem_adhesion.finite_sphere.cause_figure import CAUSES_FIGURE
from fem_adhesion.finite_sphere.chart import Field, field_of, rule, safe_from
from fem_adhesion.finite_sphere.chart_figure import CHART
from fem_adhesion.finite_sphere.dependence_figures import BULK_FIGURE, POISSON_FIGURE
from fem_adhesion.finite_sphere.findings import QUANTITIES, headline, line
from fem_adhesion.finite_sphere.points import reference_poisson
from fem_adhesion.finite_sphere.records import Record, Study
from fem_adhesion.finite_sphere.table import DeviationRow, Results, results, write_tables
from halfspace.errors import InputError

PICTURES = (CHART, CAUSES_FIGURE, POISSON_FIGURE, BULK_FIGURE)
LEVEL = 0.01  # of the answer on top
PARTS = ("table", *(f"figure {picture.stem}" for picture in PICTURES), "page")
"""What `write` tells that it begins, in this order."""


def write(study: Study, directory: Path, begin: Callable[[str], None] = lambda _: None) -> str:
    """Write the table, every figure as SVG and PNG, the findings as CSV, and ``index.html``, into a directory.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.

    Parameters
    ----------
    study : Study
        What was computed.
    directory : Path
        Where to write, which exists.
    begin : callable
        Told what is done next, once for each of `PARTS`.

    Returns
    -------
    str
        How to get the Parquet file if there is none, else empty.
    """
    begin("table")
    found = results(study, bulk_compliance)
    note = write_tables(found.rows, directory)
    draw(PICTURES, found, directory, begin)
    begin("page")
    tables = findings.tables(found)
    for one in (*tables, captions(PICTURES, found)):
        write_csv(one, directory)
    (directory / "index.html").write_text(_page(found, tables, directory), encoding="utf-8")
    return note


def remove_outdated(directory: Path, written: Path) -> None:
    """Remove figures of an earlier study from its directory that the study written anew does not have."""
    for name in (f"{picture.stem}.{suffix}" for picture in PICTURES for suffix in ("svg", "png")):
        if not (written / name).exists():
            (directory / name).unlink(missing_ok=True)


def _page(found: Results, tables: Sequence[Table], directory: Path) -> str:
    records = found.study.records
    rules, *others = tables
    chart = _section("where", CHART.title, (CHART,), found, directory, tables=[rules])
    causes = _section("why", "Causes", PICTURES[1:], found, directory, _causes())
    lead = [Markup("<strong>{}.</strong>").format(headline(found.study)), *_answer(found.rows)]
    sections = [chart, causes, Section("tables", "Tables", tables=others), _settings(records)]
    spent = f"{sum(r.seconds for r in records):.0f} s of work on {len(records)} cases"
    facts = {**machine(), **versions(), "computed in": spent}
    return page("Is the half-space good enough for my sphere?", lead, sections, facts)


def _section(
    name: str,
    title: str,
    pictures: Sequence[Picture[Results]],
    found: Results,
    directory: Path,
    paragraphs: Sequence[str] = (),
    tables: Sequence[Table] = (),
) -> Section:
    """Section with its figures, and what those that are not drawn lack."""
    lacking = [f"{one.title}. Not drawn: {lack}." for one in pictures if (lack := one.lacks(found))]
    figures = shown(pictures, found, directory)
    return Section(name, title, paragraphs=(*paragraphs, *lacking), figures=figures, tables=tables)


def _answer(table: Sequence[DeviationRow]) -> Iterator[str]:
    """The rules in words."""
    poisson = reference_poisson(table)
    if poisson is None:
        yield "No elastic sphere was solved."
        return
    fields = {name: field_of(table, quantity, poisson) for quantity, name in QUANTITIES.items()}
    yield Markup("By the points solved at Poisson's ratio {:g} it errs by less than {:g} % in").format(
        poisson, 100 * LEVEL
    ) + listed(
        [Markup("the <strong>{}</strong> {};").format(name, _condition(field)) for name, field in fields.items()]
    )
    yield (
        "Here mu is the Tabor parameter, mu^3 = R dgamma^2/(E*^2 eps^3), R the radius of the sphere, eps the spacing "
        "of the surface law; the half-space's profile is a paraboloid. The sphere is elastic, its mid-plane slides in "
        "its grip, the wall is rigid and the strains are small. Nothing is said of points beyond the range given."
    )


def _condition(field: Field) -> str:
    """Condition under which a deviation is below the level."""
    try:
        found = rule(field, LEVEL)
    except InputError:
        return _from(field)
    least, most = found.tabor
    return f"if R/eps > {line(found)} (right within {ceil(100 * found.misfit)} %, mu from {least:g} to {most:g})"


def _from(field: Field) -> str:
    """Condition where the contour is too short for a line."""
    known = field.tabor[np.isfinite(field.deviation).any(axis=1)]
    if not known.size:
        return "nowhere that is known: the study has no point of it"
    least = safe_from(field, LEVEL)
    if np.isnan(least):
        return f"at no R/eps up to {field.radius_ratio[-1]:g} for all mu from {known[0]:g} to {known[-1]:g}"
    return f"if R/eps is {least:g} or more (points solved, mu from {known[0]:g} to {known[-1]:g})"


def _causes() -> list[str]:
    causes = [Markup("<strong>{}</strong>: {};").format(name, cause.meaning) for name, cause in CAUSES.items()]
    return [Markup("Between the two lie several assumptions, switched one at a time:") + listed(causes)]


def _settings(records: Sequence[Record]) -> Section:
    """How it was computed, and how to do so again."""
    names = ("tabor", "radius_ratio", "poisson", "rtol")
    inputs = {name: sorted({v for r in records if (v := getattr(r.case, name)) is not None}) for name in names}
    asked = listed([f"{name}: {', '.join(f'{v:g}' for v in values)}" for name, values in inputs.items()])
    again = Markup(
        'All numbers with their errors are in <a href="finite_sphere.csv">finite_sphere.csv</a>. To repeat, <code>'
        "fem-adhesion finite-sphere --out DIR</code>; with <code>--resume</code>, what the directory holds is not "
        "computed again."
    )
    return Section("settings", "Settings", paragraphs=(asked, again))
