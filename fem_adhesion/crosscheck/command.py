"""``fem-adhesion compare``: whether two solvers agree."""

from __future__ import annotations

import argparse
import json

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import (
    AGREE,
    DISAGREE,
    Command,
    Parser,
    add_files,
    add_workers,
    all_written,
    console_beside,
)
from fem_adhesion.common.scene_options import POISSON, add_body, scene_of


def add_options(command: Parser) -> None:
    """Add the options."""
    scenes, body, results = map(command.add_argument_group, ("scenes", "body", "results"))
    tabors = [0.05, 0.5, 1, 2, 3, 5]
    scenes.add_argument("--tabor", nargs="+", type=float, default=tabors, help="Tabor parameters", metavar="MU")
    for name, whose in (("poisson", "the elements"), ("counter-poisson", "the counter-body")):
        of = f"Poisson's ratio of {whose}, 0 <= nu < 0.5; {POISSON:g} unless given"
        scenes.add_argument(f"--{name}", type=float, help=of, metavar="NU")
    scenes.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy of the comparison, 1e-9 to 1e-1")
    add_body(body)
    add_files(results, json="all quantities, their errors and both curves")
    add_workers(command)


def run(options: argparse.Namespace) -> int:
    """Compare all scenes asked for, print a table each, and write the record."""
    from fem_adhesion.common.record import record as run_record
    from fem_adhesion.crosscheck import comparison
    from fem_adhesion.crosscheck import scenes as comparisons
    from halfspace.limits import require_rtol

    require_rtol(options.rtol)
    scenes = [scene_of(options, mu) for mu in options.tabor]
    for scene in scenes:
        comparison.require_comparable(scene, options.rtol)
    console, how = console_beside(options.json), {"jobs": options.jobs, "dask": options.dask}
    with all_written(json=options.json) as files:
        with progress_bar() as step:
            cases = comparisons.run(scenes, rtol=options.rtol, progress=step, **how)
        record = run_record(rtol=options.rtol) | comparison.crosscheck_record(cases)
        if "json" in files:
            json.dump(record, files["json"], indent=1, allow_nan=False)
    console.print(*comparison.verdict_told(cases), "", sep="\n", highlight=False, markup=False)
    for case in cases:
        if case.reason:
            failed = f"{', '.join(case.scene.words)}: failed: {case.told}"
            lines = [failed, *(f"  {row.quantity}: {row.verdict}" for row in case.rows)]
            console.print(*lines, "", sep="\n", highlight=False, markup=False)
        else:
            for table in comparison.crosscheck_tables(case):
                console.print(table)
                console.print()
    return AGREE if record["verdict"] == "agree" else DISAGREE


COMMAND = Command(
    "compare",
    "check that two solvers which share no elasticity agree",
    "Solve the adhesive contact of a body by finite elements and by a solver that shares no operator "
    "with them: a half-space by an integral equation, a hemisphere that slides by spherical harmonics. Compare "
    "operators, residuals and events, and what both solvers share, or all of a body that only finite elements can "
    "solve, with a problem that shares nothing. "
    "Exit code 0: all agree, 1: some do not, 2: bad input.",
    "--tabor 0.5 2 --rtol 1e-4",
    add_options,
    run,
)
