"""Command line: parses arguments, calls one study or output each, prints.

What computes is imported inside the commands, so that ``--help`` answers at once.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from rich.console import Console

    from fem_adhesion.scene import Scene
    from fem_adhesion.studies.crosscheck import Case, Failure

AGREE, DISAGREE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


class Parser(argparse.ArgumentParser):
    """Refuses bad arguments in one line."""

    def error(self, message: str) -> NoReturn:
        """Exit with code 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 if all is well, 1 if solvers disagree or fail, 2 for bad input, 130 if interrupted.
    """
    options = make_parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except ValueError as error:
        print(f"fem-adhesion: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("fem-adhesion: interrupted; nothing was written", file=sys.stderr)
        return INTERRUPTED


def make_parser() -> Parser:
    """Parser of all commands."""
    parser = Parser(prog="fem-adhesion", description="Adhesive contact of elastic spheres by two solvers.")
    commands = parser.add_subparsers(required=True, metavar="command", parser_class=Parser)
    compare = commands.add_parser(
        "compare",
        help="check that the half-space and the finite-element solver agree",
        description="Solve the adhesive contact of a paraboloid with a half-space by an integral equation and by "
        "finite elements, and compare operators, residuals and events. "
        "Exit code 0: all agree, 1: some do not, 2: bad input.",
        epilog="example: fem-adhesion compare --tabor 0.5 2 --rtol 1e-4",
    )
    compare.add_argument(
        "--tabor",
        nargs="+",
        type=float,
        default=[0.05, 0.5, 1, 2, 3, 5],
        help="Tabor parameters, positive",
        metavar="MU",
    )
    compare.add_argument("--poisson", type=float, default=0.3, help="Poisson's ratio, 0 <= nu < 0.5", metavar="NU")
    compare.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy of the comparison, 1e-9 to 1e-1")
    compare.add_argument("--json", type=Path, help="also write the result to this file", metavar="FILE")
    compare.set_defaults(run=run_compare)
    return parser


def run_compare(options: argparse.Namespace) -> int:
    """Compare all scenes asked for, print a table each, and write the record."""
    from fem_adhesion.output.files import written_aside
    from fem_adhesion.scene import Scene
    from halfspace.limits import require_rtol

    require_rtol(options.rtol)
    scenes = [Scene(tabor=tabor, poisson=options.poisson) for tabor in options.tabor]
    with written_aside(options.json) if options.json else nullcontext() as file:
        cases = _compare_with_progress(scenes, options.rtol)
        from fem_adhesion.output.record import crosscheck_record

        record = crosscheck_record(cases)
        if file:
            json.dump(record, file, indent=1, allow_nan=False)
    print(f"verdict: {record['verdict']}")
    return AGREE if record["verdict"] == "agree" else DISAGREE


def _compare_with_progress(scenes: Sequence[Scene], rtol: float) -> list[Case | Failure]:
    """Run the cases with a bar on standard error and tables on standard output."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from fem_adhesion.studies import crosscheck

    console = Console(width=None if sys.stdout.isatty() else 150)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    cases: list[Case | Failure] = []
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(_at_work(scenes, 0), total=len(scenes))
        for case in crosscheck.run(scenes, rtol=rtol):
            cases.append(case)
            _show(case, console)
            progress.update(task, advance=1, description=_at_work(scenes, len(cases)))
    return cases


def _at_work(scenes: Sequence[Scene], number: int) -> str:
    return f"tabor {scenes[number].tabor:g}" if number < len(scenes) else "done"


def _show(case: Case | Failure, console: Console) -> None:
    from fem_adhesion.output.tables import crosscheck_table
    from fem_adhesion.studies.crosscheck import Case

    if isinstance(case, Case):
        console.print(crosscheck_table(case))
    else:
        console.print(f"tabor {case.scene.tabor:g}, poisson {case.scene.poisson:g}: failed: {case.reason}")
        for row in case.rows:
            console.print(f"  {row.quantity}: {row.verdict}")
    console.print()


if __name__ == "__main__":
    sys.exit(main())
