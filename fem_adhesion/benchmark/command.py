"""``fem-adhesion benchmark``: other people's numbers beside ours, and what is likely wrong with them."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from fem_adhesion.common.options import (
    AGREE,
    DISAGREE,
    Command,
    Parser,
    add_files,
    add_force,
    all_written,
    console_beside,
)
from fem_adhesion.common.scene_options import refuse
from halfspace.errors import InputError


def add_options(command: Parser) -> None:
    """Add the options."""
    columns = "CSV with the columns problem,quantity,value (unit, error if need be), or problem,approach,load of curves"
    command.add_argument("submission", nargs="?", type=Path, help=columns, metavar="CSV")
    sheets = "write sheets of problems, with our values, and templates into this directory instead"
    command.add_argument("--problems", type=Path, help=sheets, metavar="DIR")
    names = "of the sheets, as half-space-0.5 or layer-2-1; a dozen unless given"
    command.add_argument("--names", nargs="+", help=names, metavar="NAME")
    add_force(command)
    add_files(command, json="what is found", plot="the deviations")


def run(options: argparse.Namespace) -> int:
    """Compare a submission, or write the sheets.

    Returns
    -------
    int
        1 if the numbers are not sound, else 0.
    """
    if (options.submission is None) == (options.problems is None):
        given = "neither a CSV file nor" if options.problems is None else "a CSV file and"
        raise InputError(f"{given} --problems given, limit: one; give numbers to compare or a directory for sheets")
    if options.problems is not None:
        return _write(options)
    refuse(options, ("names",), "with --problems")
    from fem_adhesion.benchmark import figure, terminal
    from fem_adhesion.benchmark.study import diagnose
    from fem_adhesion.benchmark.submission import read
    from fem_adhesion.common import style
    from fem_adhesion.common.facts import plain
    from fem_adhesion.common.record import record

    form = style.require_suffix(options.plot) if options.plot else ""
    submitted = read(options.submission)
    with all_written(json=options.json, plot=options.plot) as files:
        found = diagnose(submitted)
        if "json" in files:
            head = record(submission=options.submission)
            json.dump({**head, **{name: plain(part) for name, part in found.record.items()}}, files["json"], indent=1)
        if "plot" in files:
            style.write(lambda: figure.draw(found), files["plot"], form)
        report = terminal.report(found)
    console_beside(options.json).print(report)
    return AGREE if found.cause == "sound" else DISAGREE


def _write(options: argparse.Namespace) -> int:
    from fem_adhesion.benchmark import problems, terminal
    from fem_adhesion.common.files import directory_written_aside, writing

    refuse(options, ("json", "plot"), "with a CSV file")
    asked = [problems.named(name) for name in options.names or problems.USUAL]
    for problem in asked:
        _ = problem.values  # solved for before anything is written
    with directory_written_aside(options.problems, force=options.force) as aside, writing(options.problems):
        terminal.write(asked, aside)
    return AGREE


COMMAND = Command(
    "benchmark",
    "compare another code's numbers with ours and say what is likely wrong with them",
    "A table of each number beside ours with its bar, and the cause that fits all deviations best, with those that fit "
    "alike. Numbers in R dgamma, eps and beta, or in SI for the material of the problem's sheet. Exits with 1 if the "
    "numbers are not sound.",
    "their.csv --json out.json --plot out.png",
    add_options,
    run,
)
