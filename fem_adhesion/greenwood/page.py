"""The Greenwood study as a directory: figures, tables, and a page that shows them all."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

from markupsafe import Markup

from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page import Section, listed, page, write_csv
from fem_adhesion.common.style import captions, draw, shown
from fem_adhesion.greenwood import load_figures, state_figures, trend_figures
from fem_adhesion.greenwood.record import tables
from fem_adhesion.greenwood.study import Greenwood1997

FIGURES = (*load_figures.FIGURES, *state_figures.FIGURES, *trend_figures.FIGURES)  # in the paper's order
PAPER = "J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297"
DOI = "10.1098/rspa.1997.0070"


def write(study: Greenwood1997, directory: Path, begin: Callable[[str], None] = lambda _: None) -> None:
    """Write every figure as SVG and PNG, every table and the captions as CSV, and ``index.html``.

    Give it a directory made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.

    Parameters
    ----------
    study : Greenwood1997
        What was computed.
    directory : Path
        Where to write.
    begin : callable
        Told what is drawn next, once for each of `FIGURES`.
    """
    draw(FIGURES, study, directory, begin)
    written = tables(study)
    for table in (*written, captions(FIGURES, study)):
        write_csv(table, directory)
    title = f"Greenwood (1997), computed again{', quick run' if study.quick else ''}"
    figures = Section("figures", "Figures", figures=shown(FIGURES, study, directory))
    facts = {**machine(), **versions(), "computed in": f"{study.seconds:.1f} s, drawing apart"}
    text = page(title, list(lead(study)), [figures, Section("tables", "Tables", tables=written)], facts)
    (directory / "index.html").write_text(text, encoding="utf-8")


def lead(study: Greenwood1997) -> Iterator[str]:
    """What kind of run it was, what failed that should not have, and what all figures have in common."""
    if study.quick:
        yield "A quick run: fewer points, coarser tolerances, fewer sweeps allowed to Greenwood's iteration."
    troubles = list(study.troubles())
    if troubles:
        failed = Markup("<strong>FAILED where it should not have, {} times:</strong>").format(len(troubles))
        yield failed + listed(troubles)
    link = Markup('<a href="https://doi.org/{}">{}</a>').format(DOI, DOI)
    yield Markup("Figures and tables after {}, doi {}.").format(PAPER, link)
    yield (
        "Loads in R dgamma, positive in compression; gaps and approach in eps, the approach positive when pressed "
        "together; radii in beta; pressures P in dgamma/(mu eps). Errors are estimated by refinement."
    )
    if math.isfinite(study.critical_tabor.value):
        critical = Markup("<strong>mu = {}</strong>").format(plus_minus(study.critical_tabor))
        first = Markup("The curve under fixed grips first has a vertical tangent at {}; the paper says about 1.")
        yield first.format(critical)
