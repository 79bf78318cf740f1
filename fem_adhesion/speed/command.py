"""``fem-adhesion speed``: what a digit costs."""

from __future__ import annotations

import argparse
import sys

from fem_adhesion.common.options import AGREE, DISAGREE, Commands, add_output, console_beside, progress_bar


def add(commands: Commands) -> None:
    """Add the command."""
    speed = commands.add_parser(
        "speed",
        help="measure what each digit costs, by every method in the house",
        description="Time every method on a ladder of resolutions and plot error against wall time. "
        "Exit code 1 if a method fails that should not.",
        epilog="example: fem-adhesion speed --out speed --quick",
    )
    speed.add_argument("--tabor", type=float, default=1.0, help="Tabor parameter, 0.05 to 2", metavar="MU")
    speed.add_argument("--quick", action="store_true", help="climb the lower rungs only")
    add_output(speed)
    speed.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Measure, draw and write the speed study."""
    from fem_adhesion.common import terminal
    from fem_adhesion.common.files import directory_written_aside
    from fem_adhesion.common.writing import writing
    from fem_adhesion.speed import page
    from fem_adhesion.speed import study as speed

    speed.require_tabor(options.tabor)
    with directory_written_aside(options.out, force=options.force) as aside, progress_bar() as step:
        study = speed.measure(options.tabor, quick=options.quick, progress=step)
        with writing(options.out):
            page.write(study, aside)
    troubles = list(study.troubles())
    if troubles:
        print(f"{len(troubles)} failed that should not have, the first: {troubles[0]}")
    text = (options.out / "speed.md").read_text()
    if sys.stdout.isatty():
        console_beside().print(*terminal.page(text), sep="\n", highlight=False)
    else:
        print(text, end="")
    return DISAGREE if troubles else AGREE
