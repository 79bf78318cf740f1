"""The Greenwood study as a directory: figures, tables, and a page that shows them all."""

from __future__ import annotations

import base64
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from fem_adhesion.common.facts import versions
from fem_adhesion.common.machine import machine
from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page_tables import STYLE, Table, html, typeset, write_csv
from fem_adhesion.greenwood.figures import PLOTS, draw
from fem_adhesion.greenwood.plot import Plot
from fem_adhesion.greenwood.record import tables
from fem_adhesion.greenwood.study import Greenwood1997

PAPER = "J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297"
DOI = "10.1098/rspa.1997.0070"


def write(study: Greenwood1997, directory: Path, progress: Callable[[str], None] | None = None) -> None:
    """Write every figure as SVG and PNG, every table and the captions as CSV, and ``index.html``.

    Give it a directory made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.

    Parameters
    ----------
    study : Greenwood1997
        What was computed.
    directory : Path
        Where to write.
    progress : callable, optional
        Told what is drawn next, once for each of `fem_adhesion.greenwood.figures.PLOTS`.
    """
    draw(study, directory, progress)
    written = tables(study)
    for table in (*written, _captions(study)):
        write_csv(table, directory)
    (directory / "index.html").write_text("\n".join(_page(study, written, directory)) + "\n", encoding="utf-8")


def _captions(study: Greenwood1997) -> Table:
    """What is to be seen in each figure, for pages that show it elsewhere."""
    rows = tuple((plot.stem, f"After Fig. {plot.number}: {plot.title}. {plot.see(study)}") for plot in PLOTS)
    return Table("captions", "Captions", "", ("figure", "caption"), rows)


def _page(study: Greenwood1997, written: Sequence[Table], directory: Path) -> Iterator[str]:
    yield '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>Greenwood (1997), computed again</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>"
    yield from _head(study, written)
    for plot in PLOTS:
        yield from _figure(plot, study, directory)
    for table in written:
        yield from html(table)
    yield from _foot(study)
    yield "</main>\n</body>\n</html>"


def _head(study: Greenwood1997, written: Sequence[Table]) -> Iterator[str]:
    yield f"<h1>Greenwood (1997), computed again{', quick run' if study.quick else ''}</h1>"
    yield from _state(study)
    yield f'<p>Figures and tables after {PAPER}, doi <a href="https://doi.org/{DOI}">{DOI}</a>.</p>'
    yield typeset(
        "Loads in R dgamma, positive in compression; gaps and approach in eps, the approach positive when pressed "
        "together; radii in beta; pressures P in dgamma/(mu eps). Errors are estimated by refinement."
    ).join(("<p>", "</p>"))
    if math.isfinite(study.critical_tabor.value):
        critical = typeset(f"mu = {plus_minus(study.critical_tabor)}")
        yield f"<p>The curve under fixed grips first has a vertical tangent at <strong>{critical}</strong>; "
        yield "the paper says about 1.</p>"
    links = [f'<a href="#{plot.stem}">{plot.number}</a>' for plot in PLOTS]
    yield f"<nav><p>Figures: {', '.join(links)}</p><ul>"
    yield from (f'<li><a href="#{table.stem}">{typeset(table.title)}</a></li>' for table in written)
    yield "</ul></nav>"


def _state(study: Greenwood1997) -> Iterator[str]:
    """What kind of run it was, and what failed that should not have."""
    if study.quick:
        yield "<p>A quick run: fewer points, coarser tolerances, fewer sweeps allowed to Greenwood's iteration.</p>"
    troubles = list(study.troubles())
    if troubles:
        yield f"<p><strong>FAILED where it should not have, {len(troubles)} times:</strong></p><ul>"
        yield from (f"<li>{typeset(trouble)}</li>" for trouble in troubles)
        yield "</ul>"


def _figure(plot: Plot, study: Greenwood1997, directory: Path) -> Iterator[str]:
    """A figure with its caption; the image is part of the page, which can be sent alone."""
    image = base64.b64encode((directory / f"{plot.stem}.svg").read_bytes()).decode()
    files = " ".join(f'<a href="{plot.stem}.{suffix}">{suffix.upper()}</a>' for suffix in ("svg", "png"))
    yield f'<figure id="{plot.stem}">'
    see = plot.see(study)
    yield f'<img alt="{typeset(f"{plot.title}. {see}")}" src="data:image/svg+xml;base64,{image}">'
    yield f"<figcaption><strong>After Fig. {plot.number}.</strong> {typeset(plot.title)}. {typeset(see)} {files}"
    yield "</figcaption></figure>"


def _foot(study: Greenwood1997) -> Iterator[str]:
    facts = {**machine(), **versions(), "computed in": f"{study.seconds:.1f} s, drawing apart"}
    yield f"<footer><p>{'; '.join(typeset(f'{key} {value}') for key, value in facts.items())}</p></footer>"
