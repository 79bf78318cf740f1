"""``fem-adhesion report``: one page to send to a reviewer."""

from __future__ import annotations

import argparse
from pathlib import Path

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import AGREE, DISAGREE, Command, Parser, add_files

STUDIES = {
    "speed": "speed against error",
    "hard": "the hard cases",
    "greenwood": "Greenwood (1997)",
    "finite-sphere": "the finite sphere",
    "peers": "the grades of other codes",
}


def add_options(command: Parser) -> None:
    """Add the options."""
    add_files(command, required=True, html="the page")
    tabors = [0.05, 0.5, 1, 2, 3, 5]
    command.add_argument("--tabor", nargs="+", type=float, default=tabors, help="Tabor parameters", metavar="MU")
    command.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy of the comparison, 1e-9 to 1e-1")
    command.add_argument("--walk", type=float, default=2.0, help="Tabor parameter of the curve shown", metavar="MU")
    for name, what in STUDIES.items():
        command.add_argument(f"--{name}", type=Path, help=f"directory with {what}", metavar="DIR")
    fit = "fit of one curve or many, as fit --json writes it, with its figure beside it if that is FIT.svg"
    command.add_argument("--fit", type=Path, help=fit, metavar="FIT.json")


def run(options: argparse.Namespace) -> int:
    """Compare, walk, and write the page."""
    from fem_adhesion.common.files import written_aside
    from fem_adhesion.crosscheck import scenes as crosscheck
    from fem_adhesion.crosscheck.comparison import overall_verdict
    from fem_adhesion.curve import solve
    from fem_adhesion.report import walk
    from fem_adhesion.report.page import fit_section, page, section_of
    from fem_adhesion.scene import Scene
    from halfspace.errors import Unsolved, tried
    from halfspace.limits import require_rtol

    require_rtol(options.rtol)
    scenes = [Scene(tabor=tabor) for tabor in options.tabor]
    question = solve.Question(Scene(options.walk), "both", options.rtol)
    directories = {name: place for name in STUDIES if (place := getattr(options, name.replace("-", "_")))}
    for name, directory in directories.items():
        section_of(name, directory)  # refuse a directory before any work
    if options.fit:
        fit_section(options.fit)
    with written_aside(options.html) as file, progress_bar() as step:
        cases = crosscheck.run(scenes, rtol=options.rtol, progress=step)
        found = tried(lambda: walk.walk(solve.solve(question, step), progress=step))
        lost = found.reason if isinstance(found, Unsolved) else ""
        step("page", 0, 1)
        file.write(page(cases, found or None, directories, options.fit, lost))
    verdict = "failed" if lost else overall_verdict(cases)
    print(f"verdict: {verdict}")
    return AGREE if verdict == "agree" else DISAGREE


COMMAND = Command(
    "report",
    "write one self-contained page: verdict, tables, figures, and a curve to walk along",
    "Compare both solvers and write one HTML page with all that shows it. Results of other commands "
    "are taken from the directories that they wrote; what is not given is said to be not computed.",
    "--html report.html --tabor 0.5 2 --rtol 1e-4",
    add_options,
    run,
)
