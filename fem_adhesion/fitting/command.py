"""``fem-adhesion fit``: work of adhesion and spacing from a measured force curve."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_adhesion.common.options import (
    AGREE,
    DISAGREE,
    Command,
    Parser,
    add_files,
    add_resume,
    add_workers,
    all_written,
    console_beside,
)
from halfspace.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

    from fem_adhesion.common.jobs import Progress
    from fem_adhesion.fitting.folder import Row, Source

MEASURED = {
    "radius": ("RADIUS", "of the sphere, as 100nm"),
    "modulus": ("MODULUS", "its Young's modulus, as 70GPa"),
    "stiffness": ("K", "of the cantilever, as 0.2N/m; that of the file unless given"),
    "sensitivity": ("S", "true deflection over the recorded one; 1 unless given"),
    "compliance": ("C", "of anything else that bends in series with the cantilever, as 0.5m/N; none unless given"),
}
STARTS = {"radius": 20e-9, "modulus": 10e9, "stiffness": 0.1, "sensitivity": 1.0, "compliance": 0.0}
"""Where a free quantity starts."""


def add_options(command: Parser) -> None:
    """Add the options."""
    columns = "CSV with sensor_m, piezo_m or separation_m, force_N or deflection_m, and segment (approach, retract)"
    makers = "files of makers with the extras afm and nanosurf, or folders of these"
    command.add_argument("curves", nargs="*", type=Path, help=f"{columns}; {makers}", metavar="CURVE")
    contact = command.add_argument_group(
        "contact", "Each with its unit: exact, with a standard error as 100+-20nm, or free, to be fitted."
    )
    for name, (metavar, text) in MEASURED.items():
        contact.add_argument(f"--{name}", help=text, metavar=metavar)
    contact.add_argument("--poisson", type=float, help="Poisson's ratio, 0 <= nu < 0.5", metavar="NU")
    contact.add_argument("--counter-modulus", help="of the other body; rigid unless given", metavar="MODULUS")
    contact.add_argument("--counter-radius", help="of the other body; flat unless given", metavar="RADIUS")
    contact.add_argument("--counter-poisson", type=float, help="of the other body", metavar="NU")
    volts = "sensitivity of the detector, as 50nm/V, where the file of a maker lacks it"
    command.add_argument("--detector", help=volts, metavar="S")
    models = "fitted beside the atlas: maugis-dugdale, jkr, dmt, all three unless given; or by the solvers a law, a "
    models += "profile or a body in one word, as morse:3, sphere, layer:500nm, hemisphere"
    command.add_argument("--models", nargs="+", help=models, metavar="MODEL")
    results = command.add_argument_group("results")
    add_files(results, json="what is found", plot="data, fit and contour; of many curves histograms", csv="the fits")
    results.add_argument("--nanite", type=Path, help="write a fit model for nanite and PyJibe", metavar="FILE.py")
    many = command.add_argument_group("many curves")
    add_resume(many)
    add_workers(command)


def run(options: argparse.Namespace) -> int:
    """Fit the curves, print what is found, and write what is asked for.

    Returns
    -------
    int
        1 if one of many curves was not fitted, else 0.
    """
    from fem_adhesion.common import style
    from fem_adhesion.common.files import open_store
    from fem_adhesion.common.jobs import progress_bar
    from fem_adhesion.common.numbers import parse
    from fem_adhesion.common.record import record, write_records
    from fem_adhesion.fitting import folder, plugin

    given = asked(options)
    if options.nanite:
        tip = {name: given[name].value for name in ("radius", "modulus")}
        plugin.write(options.nanite, **tip, poisson=given["poisson"])
        if not options.curves:
            return AGREE
    reading = {
        "stiffness": given["stiffness"].value if "stiffness" in given else None,
        "sensitivity": parse(options.detector, "detector") if options.detector else None,
    }
    curves = folder.sources(options.curves, **reading)
    is_one = len(curves) == 1 and not options.curves[0].is_dir()
    if is_one and options.resume:
        raise InputError("--resume with one curve, limit: many; give a folder or write --json")
    form = style.require_suffix(options.plot) if options.plot else ""
    store = open_store(options.resume, folder.code(), resume=True, force=None) if options.resume else None
    with all_written(csv=options.csv, json=options.json, plot=options.plot) as files, progress_bar() as step:
        if is_one:
            rows, content, shown, draw = _one(curves[0], reading, given, step)
        else:
            rows = folder.run(curves, reading, given, store, jobs=options.jobs, dask=options.dask, progress=step)
            content, shown = {"curves": rows, "spread": folder.spreads(rows)}, folder.report(rows)
            draw = partial(folder.draw, rows)
        head = record(None, {}, **{"curves": options.curves, **reading, **given})
        if "csv" in files:
            folder.write_csv(rows, files["csv"])
        write_records(files, lambda: head, csv=options.csv)
        if "json" in files:
            json.dump({**head, **content}, files["json"], indent=1, allow_nan=False)
        if "plot" in files:
            style.write(draw, files["plot"], form)
    console_beside(options.csv, options.json).print(shown)
    return DISAGREE if any("reason" in row for row in rows) else AGREE


def _one(
    source: Source, reading: Mapping[str, float | None], given: Mapping[str, Any], step: Progress
) -> tuple[Sequence[Row], Row, RenderableType, Callable[[], Figure]]:
    """Rows, record, what is shown, and how to draw the fit of a curve."""
    from fem_adhesion.fitting import figure, terminal
    from fem_adhesion.fitting.measured import read
    from fem_adhesion.fitting.study import fit

    found = fit(read(source.path, number=source.number, **reading), **given, progress=step)
    row = source.named | terminal.record(found)
    return [row], row, terminal.report(found), partial(figure.draw, found)


def asked(options: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `fem_adhesion.fit`, all but the curve."""
    from fem_adhesion.common.numbers import Measured, measured, parse

    missing = [f"--{name}" for name in ("radius", "modulus", "poisson") if getattr(options, name) is None]
    if missing:
        raise InputError(f"{', '.join(missing)} missing, limit: radius, modulus and poisson; give it too")
    found: dict[str, Any] = {
        name: Measured(STARTS[name], math.inf) if text == "free" else measured(text, name)
        for name in MEASURED
        if (text := getattr(options, name)) is not None
    }
    for name in ("counter_modulus", "counter_radius"):
        if text := getattr(options, name):
            found[name] = parse(text, name)
    found |= {"poisson": options.poisson, "counter_poisson": options.counter_poisson}
    return found | ({"models": tuple(options.models)} if options.models else {})


COMMAND = Command(
    "fit",
    "fit work of adhesion and range to a measured force curve",
    "Fit the contact as the apparatus meets it, with its spring and its jumps, and say what the curve leaves open. "
    "Intervals are profile likelihoods at 95 %.",
    "curve.csv --radius 100nm --modulus 70GPa --poisson 0.17 --stiffness 0.2N/m --json out.json --plot fit.png",
    add_options,
    run,
)
