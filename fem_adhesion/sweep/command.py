"""``fem-adhesion sweep``: the events of many curves as one table."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from typing import Any

from fem_adhesion.common.files import STANDARD
from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import (
    AGREE,
    DISAGREE,
    Command,
    Parser,
    add_files,
    add_resume,
    add_workers,
    all_written,
)
from fem_adhesion.common.scene_options import add_law, law_of
from halfspace.errors import InputError

MOST = 10**5  # Tabor parameters of one FROM:TO:COUNT: over seven decades neighbours then differ by 2e-4


def add_options(command: Parser) -> None:
    """Add the options."""
    tabor = "Tabor parameters, or FROM:TO:COUNT for as many in equal ratios"
    command.add_argument("--tabor", nargs="+", required=True, help=tabor, metavar="MU")
    add_law(command.add_argument_group("contact"))
    command.add_argument("--rtol", type=float, default=1e-6, help="relative accuracy, 1e-9 to 1e-1")
    command.add_argument(
        "--to-load", type=float, default=5.0, help="load in R dgamma at which a curve ends", metavar="W"
    )
    add_files(command, required=True, csv="the events of each curve")
    add_resume(command)
    add_workers(command)


def tabors_of(texts: Sequence[str]) -> list[float]:
    """Tabor parameters, each once: numbers, and FROM:TO:COUNT for some in equal ratios."""
    from halfspace.limits import require_tabor

    found = [require_tabor(value) for text in texts for value in _values(text)]
    return list(dict.fromkeys(found))


def _values(text: str) -> Sequence[float]:
    from numpy import geomspace

    parts = text.split(":")
    try:
        if len(parts) == 1:
            return [float(text)]
        first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (ValueError, IndexError) as error:
        raise InputError(f"tabor = {text} is no number and not FROM:TO:COUNT; write 0.05:50:200, say") from error
    outside = not (min(first, last) > 0 and max(first, last) < math.inf) or first == last
    if len(parts) > 3 or not 2 <= count <= MOST or outside:
        limit = f"FROM:TO:COUNT, FROM and TO positive, finite and different, COUNT 2 to {MOST}"
        raise InputError(f"tabor = {text}, limit: {limit}; write 0.05:50:200, say")
    return [float(value) for value in geomspace(first, last, count)]


def run(options: argparse.Namespace) -> int:
    """Trace the curves that neither the atlas nor the store has, and write the table.

    Returns
    -------
    int
        1 if any curve could not be traced, else 0.
    """
    from fem_adhesion.common.files import open_store
    from fem_adhesion.common.record import record, write_records
    from fem_adhesion.sweep import study
    from halfspace.limits import require_load, require_rtol

    tabors = tabors_of(options.tabor)
    rtol, to_load = require_rtol(options.rtol), require_load(options.to_load)
    asked: dict[str, Any] = {"rtol": rtol, "to_load": to_load, "law": law_of(options)}
    store = open_store(options.resume, study.code(), resume=True, force=None) if options.resume else None
    with all_written(csv=options.csv) as files, progress_bar() as step:
        known = study.by_atlas(tabors, rtol, asked["law"])
        todo = [tabor for tabor in tabors if tabor not in known]
        traced = study.run(todo, asked, store, jobs=options.jobs, dask=options.dask, progress=step)
        found = known | dict(zip(todo, traced, strict=True))
        curves = [found[tabor] for tabor in tabors]
        study.write_csv(curves, files["csv"], known)
        write_records(files, lambda: record(tabor=tabors, **asked), csv=options.csv)
    failed = [curve for curve in curves if curve.reason]
    out = sys.stderr if options.csv == STANDARD else sys.stdout
    solved = [curve for curve in curves if not curve.reason]
    folding = sum("jump_on" in curve.events for curve in solved)
    met = f"{sum(not curve.missed for curve in solved)} as accurate as asked, rtol {options.rtol:g}"
    source = f"{len(known)} of them from halfspace.atlas" if known else "none from halfspace.atlas"
    told = f"{len(solved)} of {len(curves)} curves known, {source}, {folding} fold, {met}"
    print(told, file=out)
    for curve in failed:
        print(f"fem-adhesion: tabor {curve.tabor:g}: {curve.reason}", file=sys.stderr)
    return DISAGREE if failed else AGREE


COMMAND = Command(
    "sweep",
    "trace the curves at many Tabor parameters and write their events as one table",
    "Pull-off, jumps and zero load of many curves on the half-space, the energy set free and the energy lost in a "
    "cycle, each with its error. They are read from the atlas, halfspace.atlas, where that is as accurate as --rtol; "
    "other curves are solved on all cores, and what is interrupted goes on with --resume. Exits with 1 if a curve "
    "cannot be traced.",
    "--tabor 0.05:50:200 --csv sweep.csv",
    add_options,
    run,
)
