"""The study of the finite sphere as a directory: table, figures, and a page: whether the half-space will do."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator, Sequence
from math import ceil
from pathlib import Path

import numpy as np

from fem_adhesion.common.facts import versions
from fem_adhesion.common.machine import machine
from fem_adhesion.common.page_tables import STYLE, Table, html, typeset, write_csv
from fem_adhesion.finite_sphere import findings
from fem_adhesion.finite_sphere.bulk import bulk_compliance
from fem_adhesion.finite_sphere.cases import CAUSES
from fem_adhesion.finite_sphere.chart import Field, field_of, rule, safe_from
from fem_adhesion.finite_sphere.figures import PICTURES, Picture, draw
from fem_adhesion.finite_sphere.findings import QUANTITIES, line
from fem_adhesion.finite_sphere.points import reference_poisson
from fem_adhesion.finite_sphere.records import Record, Study
from fem_adhesion.finite_sphere.table import Results, Row, results
from fem_adhesion.finite_sphere.tables import write_tables
from fem_adhesion.finite_sphere.words import caption, headline
from halfspace.errors import InputError

LEVEL = 0.01  # of the answer on top
PARTS = ("table", *(f"figure {picture.stem}" for picture in PICTURES), "page")
"""What `write` tells that it begins, in this order."""


def write(study: Study, directory: Path, begin: Callable[[str], None] | None = None) -> str:
    """Write the table, every figure as SVG and PNG, the findings as CSV, and ``index.html``, into a directory.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.

    Parameters
    ----------
    study : Study
        What was computed.
    directory : Path
        Where to write, which exists.
    begin : callable, optional
        Told what is done next, once for each of `PARTS`.

    Returns
    -------
    str
        How to get the Parquet file if there is none, else empty.
    """
    if begin:
        begin("table")
    found = results(study, bulk_compliance)
    note = write_tables(found.rows, directory)
    draw(found, directory, begin)
    if begin:
        begin("page")
    tables = findings.tables(found)
    for one in tables:
        write_csv(one, directory)
    page = "\n".join(_page(found, tables[:-1], directory))
    (directory / "index.html").write_text(page + "\n", encoding="utf-8")
    return note


def remove_outdated(directory: Path, written: Path) -> None:
    """Remove figures of an earlier study from its directory that the study written anew does not have."""
    for name in (f"{picture.stem}.{suffix}" for picture in PICTURES for suffix in ("svg", "png")):
        if not (written / name).exists():
            (directory / name).unlink(missing_ok=True)


def _page(found: Results, tables: Sequence[Table], directory: Path) -> Iterator[str]:
    yield '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>The finite sphere</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>"
    yield f"<h1>Is the half-space good enough for my sphere?</h1>\n<p><strong>{headline(found.study)}.</strong></p>"
    yield from _answer(found.rows)
    chart, *others = PICTURES
    yield from _figure(chart, found, directory)
    rules, *rest = tables
    yield from html(rules)
    yield from _causes()
    for picture in others:
        yield from _figure(picture, found, directory)
    for one in rest:
        yield from html(one)
    yield from _foot(found.study.records)
    yield "</main>\n</body>\n</html>"


def _answer(table: Sequence[Row]) -> Iterator[str]:
    """The rules in words."""
    poisson = reference_poisson(table)
    if poisson is None:
        yield "<p>No elastic sphere was solved.</p>"
        return
    yield f"<p>By the points solved at Poisson's ratio {poisson:g} it errs by less than {100 * LEVEL:g} % in</p><ul>"
    for quantity, name in QUANTITIES.items():
        yield f"<li>the <strong>{name}</strong> {typeset(_when(field_of(table, quantity, poisson)))};</li>"
    yield "</ul>"
    yield typeset(
        "Here mu is the Tabor parameter, mu^3 = R dgamma^2/(E*^2 eps^3), R the radius of the sphere, eps the spacing "
        "of the surface law; the half-space's profile is a paraboloid. The sphere is elastic, its mid-plane slides in "
        "its grip, the wall is rigid and the strains are small. Nothing is said of points beyond the range given."
    ).join(("<p>", "</p>"))


def _when(field: Field) -> str:
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


def _causes() -> Iterator[str]:
    yield "<section><h2>Causes</h2><p>Between the two lie several assumptions, switched one at a time:</p><ul>"
    yield from (f"<li><strong>{name}</strong>: {cause.meaning};</li>" for name, cause in CAUSES.items())
    yield "</ul></section>"


def _figure(picture: Picture, found: Results, directory: Path) -> Iterator[str]:
    """A figure with its caption; the image is part of the page, which can be sent alone."""
    title = typeset(picture.title)
    if lack := picture.lacks(found):
        yield f'<section id="{picture.stem}"><h2>{title}</h2><p>Not drawn: {typeset(lack)}.</p></section>'
        return
    image = base64.b64encode((directory / f"{picture.stem}.svg").read_bytes()).decode()
    files = " ".join(f'<a href="{picture.stem}.{suffix}">{suffix.upper()}</a>' for suffix in ("svg", "png"))
    see = typeset(caption(picture.stem, found))
    yield f'<figure id="{picture.stem}"><h2>{title}</h2>'
    yield f'<img alt="{title}. {see}" src="data:image/svg+xml;base64,{image}">'
    yield f"<figcaption>{see} {files}</figcaption></figure>"


def _foot(records: Sequence[Record]) -> Iterator[str]:
    """How it was computed, and how to do so again."""
    names = ("tabor", "radius_ratio", "poisson", "rtol")
    inputs = {name: sorted({v for r in records if (v := getattr(r.case, name)) is not None}) for name in names}
    yield "<section><h2>Settings</h2><ul>"
    yield from (f"<li>{name}: {', '.join(f'{v:g}' for v in values)}</li>" for name, values in inputs.items())
    yield "</ul><p>All numbers with their errors are in "
    yield '<a href="finite_sphere.csv">finite_sphere.csv</a>. To repeat, <code>fem-adhesion finite-sphere --out DIR'
    yield "</code>; with <code>--resume</code>, what the directory holds is not computed again.</p></section>"
    spent = f"{sum(r.seconds for r in records):.0f} s of work on {len(records)} cases"
    facts = {**machine(), **versions(), "computed in": spent}
    yield f"<footer><p>{'; '.join(typeset(f'{key} {value}') for key, value in facts.items())}</p></footer>"
