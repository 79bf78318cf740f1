"""``fem-adhesion greenwood``: the paper, computed again."""

from __future__ import annotations

import argparse
import itertools

from fem_adhesion.common.options import AGREE, DISAGREE, Commands, add_output, progress_bar


def add(commands: Commands) -> None:
    """Add the command."""
    greenwood = commands.add_parser(
        "greenwood",
        help="recompute Greenwood (1997): every figure and table beside the printed values",
        description="Recompute the figures and tables of the paper, with finite elements drawn over the half-space. "
        "Exit code 1 if a number is off that should not be.",
        epilog="example: fem-adhesion greenwood --out greenwood --quick",
    )
    greenwood.add_argument("--quick", action="store_true", help="fewer points and lower accuracies")
    add_output(greenwood)
    greenwood.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Compute, draw and write the figures and tables of the paper."""
    from fem_adhesion.common.files import directory_written_aside
    from fem_adhesion.common.writing import writing
    from fem_adhesion.greenwood import page
    from fem_adhesion.greenwood import study as greenwood
    from fem_adhesion.greenwood.figures import PLOTS

    total = len(greenwood.SUBJECTS) + len(PLOTS)
    done = itertools.count()
    with directory_written_aside(options.out, force=options.force) as aside, progress_bar() as step:

        def begin(part: str) -> None:
            step(part, next(done), total)

        study = greenwood.compute(quick=options.quick, progress=begin)
        with writing(options.out):
            page.write(study, aside, begin)
    troubles = list(study.troubles())
    if troubles:
        print(f"{len(troubles)} failed that should not have, the first: {troubles[0]}")
    print(f"written: {options.out / 'index.html'}")
    return DISAGREE if troubles else AGREE
