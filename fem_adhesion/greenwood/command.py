"""``fem-adhesion greenwood``: the paper, computed again."""

from __future__ import annotations

import argparse

from fem_adhesion.common.jobs import in_turn, progress_bar
from fem_adhesion.common.options import Command, Parser, add_output, exit_code_of


def add_options(command: Parser) -> None:
    """Add the options."""
    command.add_argument("--quick", action="store_true", help="fewer points and lower accuracies")
    add_output(command)


def run(options: argparse.Namespace) -> int:
    """Compute, draw and write the figures and tables of the paper."""
    from fem_adhesion.common.files import directory_written_aside, writing
    from fem_adhesion.greenwood import page
    from fem_adhesion.greenwood import study as greenwood
    from fem_adhesion.greenwood.figures import FIGURES

    with directory_written_aside(options.out, force=options.force) as aside, progress_bar() as progress:
        begin = in_turn(progress, len(greenwood.SUBJECTS) + len(FIGURES))
        study = greenwood.compute(quick=options.quick, begin=begin)
        with writing(options.out):
            page.write(study, aside, begin)
    return exit_code_of(list(study.troubles()))


COMMAND = Command(
    "greenwood",
    "recompute Greenwood (1997): every figure and table beside the printed values",
    "Recompute the figures and tables of the paper, with finite elements drawn over the half-space. "
    "Exit code 1 if a number is off that should not be.",
    "--out greenwood --quick",
    add_options,
    run,
)
