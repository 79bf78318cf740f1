"""Command line: calls the command asked for, and turns what goes wrong into one line and an exit code."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from fem_adhesion.assess import command as assess
from fem_adhesion.common.options import BAD_INPUT, DISAGREE, NOT_WRITTEN, Parser, Version, ended, ended_by_signal
from fem_adhesion.common.writing import NotWritten
from fem_adhesion.crosscheck import command as compare
from fem_adhesion.curve import command as curve
from fem_adhesion.finite_sphere import command as finite_sphere
from fem_adhesion.greenwood import command as greenwood
from fem_adhesion.report import command as report
from fem_adhesion.speed import command as speed
from halfspace.errors import InputError, NotConverged

COMMANDS = (compare, curve, assess, finite_sphere, speed, greenwood, report)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 if all is well, 1 if solvers disagree or fail or the disk is full, 2 for bad input, 130 if interrupted by
        Ctrl-C, 143 if terminated by SIGTERM.
    """
    options = make_parser().parse_args(arguments)
    try:
        with ended_by_signal():
            return int(options.run(options))
    except InputError as error:
        print(f"fem-adhesion: {error}", file=sys.stderr)
        return BAD_INPUT
    except NotConverged as error:
        print(f"fem-adhesion: {error}; nothing was written", file=sys.stderr)
        return DISAGREE
    except NotWritten as error:
        print(f"fem-adhesion: {error}", file=sys.stderr)
        return NOT_WRITTEN
    except KeyboardInterrupt as how:
        return ended(how, "nothing was written")


def make_parser() -> Parser:
    """Parser of all commands."""
    parser = Parser(prog="fem-adhesion", description="Adhesive contact of elastic spheres by two solvers.")
    parser.add_argument("--version", action=Version, nargs=0, help="show the version and exit")
    commands = parser.add_subparsers(required=True, metavar="command", parser_class=Parser)
    for command in COMMANDS:
        command.add(commands)
    return parser


if __name__ == "__main__":
    sys.exit(main())
