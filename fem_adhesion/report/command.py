"""``fem-adhesion report``: one page to send to a reviewer."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import AGREE, DISAGREE, Command, Parser

if TYPE_CHECKING:
    from fem_adhesion.curve.solve import Question
    from fem_adhesion.scene import Scene

STUDIES = {
    "speed": "speed against error",
    "hard": "the hard cases",
    "greenwood": "Greenwood (1997)",
    "finite-sphere": "the finite sphere",
}


def add_options(command: Parser) -> None:
    """Add the options."""
    command.add_argument("--out", type=Path, required=True, help="the page", metavar="FILE")
    tabors = [0.05, 0.5, 1, 2, 3, 5]
    command.add_argument("--tabor", nargs="+", type=float, default=tabors, help="Tabor parameters", metavar="MU")
    command.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy of the comparison, 1e-9 to 1e-1")
    command.add_argument("--walk", type=float, default=2.0, help="Tabor parameter of the curve shown", metavar="MU")
    for name, what in STUDIES.items():
        command.add_argument(f"--{name}", type=Path, help=f"directory with {what}", metavar="DIR")


def run(options: argparse.Namespace) -> int:
    """Compare, walk, and write the page."""
    from fem_adhesion.common.files import written_aside
    from fem_adhesion.curve.solve import Question
    from fem_adhesion.report.page import SOURCES, section_of
    from fem_adhesion.scene import Scene
    from halfspace.limits import require_rtol

    require_rtol(options.rtol)
    scenes = [Scene(tabor=tabor) for tabor in options.tabor]
    question = Question(Scene(options.walk), "both", options.rtol)
    named = {name: getattr(options, name.replace("-", "_")) for name in STUDIES}
    directories = {name: directory for name, directory in named.items() if directory is not None}
    for source in SOURCES:
        section_of(source, directories.get(source.name))  # refuse a directory before any work
    with written_aside(options.out) as file:
        verdict, text = _compute(scenes, options.rtol, question, directories, options.asked)
        file.write(text)
    print(f"verdict: {verdict}; written: {options.out}")
    return AGREE if verdict == "agree" else DISAGREE


def _compute(
    scenes: list[Scene], rtol: float, question: Question, directories: dict[str, Path], asked: str
) -> tuple[str, str]:
    """Verdict and page."""
    from fem_adhesion.crosscheck import scenes as crosscheck
    from fem_adhesion.crosscheck.comparison import overall_verdict
    from fem_adhesion.curve.solve import solve
    from fem_adhesion.report.page import Contents, page
    from fem_adhesion.report.walk import walk
    from halfspace.errors import NotConverged

    with progress_bar() as step:
        cases = []
        step("comparison", 0, len(scenes))
        for case in crosscheck.run(scenes, rtol=rtol):
            cases.append(case)
            step("comparison", len(cases), len(scenes))
        contents = Contents(cases, None, None, directories, asked=asked)
        try:
            curves = solve(question, step)
            walked = walk(question.scene.tabor, rtol=rtol, progress=step)
            contents = replace(contents, curves=curves, walk=walked)
        except NotConverged as error:
            contents = replace(contents, lost=str(error))
        step("page", 0, 1)
        return "failed" if contents.lost else overall_verdict(cases), page(contents)


COMMAND = Command(
    "report",
    "write one self-contained page: verdict, tables, figures, and a curve to walk along",
    "Compare both solvers and write one HTML page with all that shows it. Results of other commands "
    "are taken from the directories that they wrote; what is not given is said to be not computed.",
    "--out report.html --tabor 0.5 2 --rtol 1e-4",
    add_options,
    run,
)
