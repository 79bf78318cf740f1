"""Command line: calls the command asked for, and turns what goes wrong into one line and an exit code."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence

from fem_adhesion.assess.command import COMMAND as ASSESS
from fem_adhesion.benchmark.command import COMMAND as BENCHMARK
from fem_adhesion.common.files import LEFT, STANDARD, Left, NotWritten
from fem_adhesion.common.jobs import keep_to_one_thread
from fem_adhesion.common.options import BAD_INPUT, COMMAND, DISAGREE, INTERRUPTED, TERMINATED, Parser, ended_by_signal
from fem_adhesion.crosscheck.command import COMMAND as COMPARE
from fem_adhesion.curve.command import COMMAND as CURVE
from fem_adhesion.finite_sphere.command import COMMAND as FINITE_SPHERE
from fem_adhesion.fitting.command import COMMAND as FIT
from fem_adhesion.formulas.command import COMMAND as FORMULAS
from fem_adhesion.greenwood.command import COMMAND as GREENWOOD
from fem_adhesion.report.command import COMMAND as REPORT
from fem_adhesion.speed.command import COMMAND as SPEED
from fem_adhesion.sweep.command import COMMAND as SWEEP
from fem_adhesion.words.command import COMMAND as WORDS
from halfspace.errors import InputError, NotConverged

COMMANDS = (COMPARE, CURVE, SWEEP, ASSESS, FIT, FINITE_SPHERE, SPEED, GREENWOOD, FORMULAS, BENCHMARK, REPORT, WORDS)

STUDIES = ("PIL", "jinja2", "loky", "markupsafe", "matplotlib", "pint", "plotille", "rich")
"""Libraries of the extra that every command needs, the solvers none."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 if all is well, 1 if solvers disagree or fail or the disk is full, 2 for bad input or a missing library, 130
        if interrupted by Ctrl-C, 143 if terminated by SIGTERM.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    options = make_parser().parse_args(arguments)
    asked = COMMAND.set(shlex.join(["fem-adhesion", *arguments]))
    left = Left()
    noted = LEFT.set(left)
    keep_to_one_thread()
    try:
        with ended_by_signal():
            code = int(options.run(options))
        _tell(left)
        return code
    except InputError as error:
        return _told(error, BAD_INPUT)
    except NotConverged as error:
        return _told(f"{error}; nothing was written", DISAGREE)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in STUDIES:
            raise
        return _told(f"{error.name} is not installed; pip install '.[studies]' in a clone", BAD_INPUT)
    except NotWritten as error:
        return _told(error, DISAGREE)
    except KeyboardInterrupt as how:
        word, code = ("terminated", TERMINATED) if how.args else ("interrupted", INTERRUPTED)
        return _told(f"{word}; {left.kept}", code)
    finally:
        COMMAND.reset(asked)
        LEFT.reset(noted)


def _tell(left: Left) -> None:
    """Say what stores held in vain, and in one line what was written, on standard error if the other carries data."""
    for note in (note for store in left.stores for note in store.notes):
        print(f"fem-adhesion: {note}", file=sys.stderr)
    files = [str(name) for name in left.written if name != STANDARD]
    if files:
        print(f"written: {' '.join(files)}", file=sys.stderr if STANDARD in left.written else sys.stdout)


def _told(why: object, code: int) -> int:
    """Say in one line why a command ended, and give its exit code."""
    print(f"fem-adhesion: {why}", file=sys.stderr)
    return code


def make_parser() -> Parser:
    """Parser of all commands."""
    parser = Parser(prog="fem-adhesion", description="Adhesive contact of elastic spheres by two solvers.")
    parser.add_argument("--version", action="version", help="show the version and exit")
    commands = parser.add_subparsers(required=True, metavar="command", parser_class=Parser)
    for command in COMMANDS:
        command.add_to(commands)
    return parser
