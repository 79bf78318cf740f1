"""``fem-adhesion hard``: the hard cases."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from fem_adhesion.common.options import AGREE, DISAGREE, add_output, console_beside, progress_bar

if TYPE_CHECKING:
    from fem_adhesion.common.options import Commands


def add(commands: Commands) -> None:
    """Add the command."""
    hard = commands.add_parser(
        "hard",
        help="run the hard cases: a number within its estimate, or a clear refusal",
        description="Run the cases that are hard for the solvers; one minute. "
        "Exit code 1 if one ends otherwise than was declared for it beforehand.",
        epilog="example: fem-adhesion hard --out hard",
    )
    add_output(hard)
    hard.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the hard cases, print their tables and write them."""
    from fem_adhesion.common.files import directory_written_aside
    from fem_adhesion.common.writing import writing
    from fem_adhesion.hard import bodies as hard_bodies
    from fem_adhesion.hard import cases as hard_cases
    from fem_adhesion.hard import run as hard_run
    from fem_adhesion.hard import table as hard_report

    cases = hard_cases.cases()
    names = [*(case.name for case in cases), "locking"]
    rows: list[hard_run.Row] = []
    with directory_written_aside(options.out, force=options.force) as aside:
        with progress_bar() as step:
            step(names[0], 0, len(names))
            for row in hard_run.run(cases):
                rows.append(row)
                step(names[len(rows)], len(rows), len(names))
            locking = list(hard_bodies.locking())
        with writing(options.out):
            hard_report.write_hard(aside, rows, locking)
    console_beside().print(hard_report.cases_table(rows), hard_report.locking_table(locking))
    return DISAGREE if any(row.outcome == "wrong" for row in rows) else AGREE
