"""The report: one page that a reviewer can be sent, with every figure and all that moves inside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from matplotlib import rc_context

from fem_adhesion.common.facts import machine
from fem_adhesion.common.page import Section, inlined, render, template_text
from fem_adhesion.common.style import laid_out
from fem_adhesion.crosscheck.comparison import Case, Failure, overall_verdict, verdict_of
from fem_adhesion.curve import figure as curve_figure
from fem_adhesion.curve.lines import UNSTABLE, smooth
from fem_adhesion.curve.solve import Curves
from fem_adhesion.report.sections import SOURCES, crosscheck_section, section_of, settings_section
from fem_adhesion.report.walk import Walk, walk_data, walk_words

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
    return Section("curves", f"The curve by {solvers}", figures=(inlined(stream.getvalue(), "curves", text),))
