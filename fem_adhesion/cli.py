"""Command line: parses arguments, calls one study or output each, prints.

What computes is imported inside the commands, so that ``--help`` answers at once.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction["Parser"]

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
    _add_compare(commands)
    _add_speed(commands)
    _add_hard(commands)
    _add_greenwood(commands)
    return parser


def _add_compare(commands: Commands) -> None:
    compare = commands.add_parser(
        "compare",
        help="check that the half-space and the finite-element solver agree",
        description="Solve the adhesive contact of a paraboloid with a half-space by an integral equation and by "
        "finite elements, and compare operators, residuals and events. "
        "Exit code 0: all agree, 1: some do not, 2: bad input.",
        epilog="example: fem-adhesion compare --tabor 0.5 2 --rtol 1e-4",
    )
    tabors = [0.05, 0.5, 1, 2, 3, 5]
    compare.add_argument("--tabor", nargs="+", type=float, default=tabors, help="Tabor parameters", metavar="MU")
    compare.add_argument("--poisson", type=float, default=0.3, help="Poisson's ratio, 0 <= nu < 0.5", metavar="NU")
    compare.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy of the comparison, 1e-9 to 1e-1")
    compare.add_argument("--json", type=Path, help="also write the result to this file", metavar="FILE")
    compare.set_defaults(run=run_compare)


def _add_speed(commands: Commands) -> None:
    speed = commands.add_parser(
        "speed",
        help="measure what each digit costs, by every method in the house",
        description="Time every method on a ladder of resolutions and plot error against wall time.",
        epilog="example: fem-adhesion speed --out speed --quick",
    )
    speed.add_argument("--tabor", type=float, default=1.0, help="Tabor parameter, 0.05 to 2", metavar="MU")
    speed.add_argument("--quick", action="store_true", help="finish in half a minute, at lower accuracies")
    _add_output(speed)
    speed.set_defaults(run=run_speed)


def _add_hard(commands: Commands) -> None:
    hard = commands.add_parser(
        "hard",
        help="run the hard cases: a number within its estimate, or a clear refusal",
        description="Run the cases that are hard for the solvers. Exit code 1 if one ends in a wrong number.",
        epilog="example: fem-adhesion hard --out hard",
    )
    _add_output(hard)
    hard.set_defaults(run=run_hard)


def _add_greenwood(commands: Commands) -> None:
    greenwood = commands.add_parser(
        "greenwood",
        help="recompute Greenwood (1997): every figure and table beside the printed values",
        description="Recompute the figures and tables of the paper, with finite elements drawn over the half-space.",
        epilog="example: fem-adhesion greenwood --out greenwood --quick",
    )
    greenwood.add_argument("--quick", action="store_true", help="fewer points and lower accuracies")
    _add_output(greenwood)
    greenwood.set_defaults(run=run_greenwood)


def _add_output(command: Parser) -> None:
    command.add_argument("--out", type=Path, required=True, help="directory for the results", metavar="DIR")
    command.add_argument("--force", action="store_true", help="replace files in a directory that is not empty")


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

    from fem_adhesion.studies import crosscheck

    console = Console(width=None if sys.stdout.isatty() else 150)
    names = [f"tabor {scene.tabor:g}" for scene in scenes] + ["done"]
    cases: list[Case | Failure] = []
    with _progress_bar() as step:
        step(names[0], 0, len(scenes))
        for case in crosscheck.run(scenes, rtol=rtol):
            cases.append(case)
            _show(case, console)
            step(names[len(cases)], len(cases), len(scenes))
    return cases


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


def run_speed(options: argparse.Namespace) -> int:
    """Measure, draw and write the speed study."""
    from fem_adhesion.output import speed_report
    from fem_adhesion.output.files import directory_written_aside
    from fem_adhesion.studies import speed

    speed.require_tabor(options.tabor)
    with directory_written_aside(options.out, force=options.force) as aside, _progress_bar() as step:
        study = speed.measure(options.tabor, quick=options.quick, progress=step)
        speed_report.write(study, aside)
    print((options.out / "speed.md").read_text(), end="")
    return AGREE


def run_hard(options: argparse.Namespace) -> int:
    """Run the hard cases, print their tables and write them."""
    from rich.console import Console

    from fem_adhesion.output import hard_report
    from fem_adhesion.output.files import directory_written_aside
    from fem_adhesion.studies import hard_bodies, hard_cases

    cases = hard_cases.cases()
    names = [*(case.name for case in cases), "locking"]
    rows: list[hard_cases.Row] = []
    with directory_written_aside(options.out, force=options.force) as aside:
        with _progress_bar() as step:
            step(names[0], 0, len(names))
            for row in hard_cases.run(cases):
                rows.append(row)
                step(names[len(rows)], len(rows), len(names))
            locking = list(hard_bodies.locking())
        hard_report.write_hard(aside, rows, locking)
    console = Console(width=None if sys.stdout.isatty() else 150)
    console.print(hard_report.cases_table(rows), hard_report.locking_table(locking))
    return DISAGREE if any(row.outcome == "wrong" for row in rows) else AGREE


def run_greenwood(options: argparse.Namespace) -> int:
    """Compute, draw and write the figures and tables of the paper."""
    from fem_adhesion.output import greenwood_report
    from fem_adhesion.output.files import directory_written_aside
    from fem_adhesion.output.greenwood_plots import PLOTS
    from fem_adhesion.studies import greenwood1997

    total = len(greenwood1997.SUBJECTS) + len(PLOTS)
    done = itertools.count()
    with directory_written_aside(options.out, force=options.force) as aside, _progress_bar() as step:

        def begin(part: str) -> None:
            step(part, next(done), total)

        study = greenwood1997.compute(quick=options.quick, progress=begin)
        greenwood_report.write(study, aside, begin)
    print(f"written: {options.out / 'index.html'}")
    return AGREE


@contextmanager
def _progress_bar() -> Iterator[Callable[[str, int, int], None]]:
    """Bar on standard error; the function it gives says what is under way, how much is done and of how much."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=None)
        yield lambda name, done, total: progress.update(task, description=name, completed=done, total=total)


if __name__ == "__main__":
    sys.exit(main())
