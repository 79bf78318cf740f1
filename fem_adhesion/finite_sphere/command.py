"""``fem-adhesion finite-sphere``: whether the half-space is good enough."""

from __future__ import annotations

import argparse
import sys

from fem_adhesion.common.jobs import in_turn, progress_bar
from fem_adhesion.common.options import AGREE, DISAGREE, Command, Parser, add_output, add_resume, add_workers


def add_options(command: Parser) -> None:
    """Add the options."""
    command.add_argument("--tabor", nargs="+", type=float, help="Tabor parameters", metavar="MU")
    command.add_argument(
        "--radius-ratio", nargs="+", type=float, help="R/eps, 2 or more and 2.25 MU or more", metavar="RHO"
    )
    command.add_argument("--poisson", nargs="+", type=float, help="Poisson's ratios, 0 <= nu < 0.5", metavar="NU")
    command.add_argument(
        "--quick", action="store_true", help="finish in half a minute: two by three points, less accurate"
    )
    add_resume(command)
    add_workers(command)
    add_output(command)


def run(options: argparse.Namespace) -> int:
    """Run what is left of the study and write table, pictures and page; 1 if any case has no solution, else 0."""
    from fem_adhesion.common.files import directory_written_aside, open_store, require_room, writing
    from fem_adhesion.finite_sphere import page
    from fem_adhesion.finite_sphere import study as finite_sphere

    cases, left_out = finite_sphere.plan(options.tabor, options.radius_ratio, options.poisson, quick=options.quick)
    place = options.resume or options.out
    if place.resolve() != options.out.resolve():
        require_room(options.out, force=options.force)
    store = open_store(place, finite_sphere.code(), resume=bool(options.resume), force=options.force)
    settings = {"jobs": options.jobs, "dask": options.dask, "fresh": bool(options.force and not options.resume)}
    with progress_bar() as step:
        solved = finite_sphere.run(cases, store, progress=step, **settings)
    study = finite_sphere.Study((*solved, *left_out), options.quick)
    with directory_written_aside(options.out, force=True) as aside, progress_bar() as step, writing(options.out):
        note = page.write(study, aside, in_turn(step, len(page.PARTS)))
        page.remove_outdated(options.out, aside)
    if note:
        print(f"fem-adhesion: {note}", file=sys.stderr)
    print(study.headline)
    return DISAGREE if study.failed else AGREE


COMMAND = Command(
    "finite-sphere",
    "measure how far the half-space is from a finite sphere, and why",
    "Solve the contact under one assumption less at a time, over Tabor parameters, R/eps and Poisson's "
    "ratios. Each case is stored at once, in --out or where --resume says: what is interrupted goes on with --resume. "
    "Exits with 1 if a case has no solution.",
    "--out sphere --quick",
    add_options,
    run,
)
