"""``fem-adhesion speed``: what a digit costs."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import Command, Parser, add_output, console_beside, exit_code_of


def add_options(command: Parser) -> None:
    """Add the options."""
    long = "Tabor parameter, 0.05 to 2; at 2 uniform grids and iterations of 1997 take ten times as long as at 1"
    command.add_argument("--tabor", type=float, default=1.0, help=long, metavar="MU")
    command.add_argument("--quick", action="store_true", help="climb the lower rungs only")
    beside = "speed.csv of an earlier run at this Tabor parameter, whose fronts are shown beside"
    command.add_argument("--beside", type=Path, help=beside, metavar="FILE")
    add_output(command)


def run(options: argparse.Namespace) -> int:
    """Measure, draw and write the speed study."""
    from fem_adhesion.common import terminal
    from fem_adhesion.common.files import directory_written_aside, writing
    from fem_adhesion.common.page import markdown
    from fem_adhesion.speed import page
    from fem_adhesion.speed import study as speed

    speed.require_tabor(options.tabor)
    beside = page.read_earlier(options.beside, options.tabor) if options.beside else None
    with directory_written_aside(options.out, force=options.force) as aside, progress_bar() as step:
        study = speed.measure(options.tabor, quick=options.quick, progress=step, earlier=beside)
        with writing(options.out):
            page.write(study, aside)
    code = exit_code_of(list(study.troubles()))
    parts = list(page.parts(study))
    if sys.stdout.isatty():
        console_beside().print(*terminal.page(parts), sep="\n", highlight=False)
    else:
        print(*markdown(parts), sep="\n")
    return code


COMMAND = Command(
    "speed",
    "measure what each digit costs, by every method in the house",
    "Time every method on a ladder of resolutions and plot error against wall time. "
    "Exit code 1 if a method fails that should not.",
    "--out speed --quick",
    add_options,
    run,
)
