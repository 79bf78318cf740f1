"""``fem-adhesion formulas``: closed expressions in the languages of other codes."""

from __future__ import annotations

import argparse

from fem_adhesion.common.options import AGREE, Command, add_output


def run(options: argparse.Namespace) -> int:
    """Write the files."""
    from fem_adhesion.common.files import directory_written_aside, writing
    from fem_adhesion.formulas import emit

    with directory_written_aside(options.out, force=options.force) as aside, writing(options.out):
        emit.write(aside)
    return AGREE


COMMAND = Command(
    "formulas",
    "write closed expressions for other codes, in Python, C, Fortran, Markdown and LaTeX",
    "Pull-off load, and its factor for spheres, radius under no load, approaches of both jumps, the energy lost in "
    "a cycle and the load at an approach, down to tear-off, at any Tabor parameter, each with its worst error, and the "
    "conventions of six codes with functions that convert theirs.",
    "--out formulas",
    add_output,
    run,
)
