"""``fem-adhesion fit``: work of adhesion and spacing from a measured force curve."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_adhesion.common.options import (
    AGREE,
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
    from fem_adhesion.common.numbers import Measured

MEASURED = {
    "radius": ("RADIUS", "of the sphere, as 100nm"),
    "modulus": ("MODULUS", "its Young's modulus, as 70GPa"),
    "stiffness": ("K", "of the cantilever, as 0.2N/m; that of the file unless given"),
    "sensitivity": ("S", "true deflection over the recorded one; 1 unless given"),
    "compliance": ("C", "of anything else that bends in series with the cantilever, as 0.5m/N; none unless given"),
}
FREE = "free"
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
    add_files(results, json="what is found", plot="data, fit and contour")
    results.add_argument("--nanite", type=Path, help="write a fit model for nanite and PyJibe", metavar="FILE.py")
    many = command.add_argument_group("many curves")
    add_files(many, csv="the fits")
    add_resume(many)
    add_workers(command)


def run(options: argparse.Namespace) -> int:
    """Fit the curves, print what is found, and write what is asked for.

    Returns
    -------
    int
        1 if one of many curves was not fitted, else 0.
    """
    from fem_adhesion.fitting.measured import count

    given = asked(options)
    if options.nanite:
        _write_plugin(options.nanite, given)
    if not options.curves:
        if options.nanite:
            return AGREE
        raise InputError("no curve, limit: one or more; give a file or a folder")
    stiffness = given.get("stiffness")
    reading = {"stiffness": stiffness and stiffness.value, "sensitivity": _detector(options.detector)}
    first = options.curves[0]
    if len(options.curves) > 1 or first.is_dir() or count(first, **reading) > 1:
        from fem_adhesion.fitting.many import fit_all

        return fit_all(options, options.curves, reading, given)
    for name in ("csv", "resume"):
        if getattr(options, name):
            raise InputError(f"--{name} with one curve, limit: many; give a folder or write --json")
    return _fit_one(options, reading, given)


def _fit_one(options: argparse.Namespace, reading: Mapping[str, float | None], given: Mapping[str, Any]) -> int:
    from fem_adhesion.common import style
    from fem_adhesion.common.jobs import progress_bar
    from fem_adhesion.fitting import figure, terminal
    from fem_adhesion.fitting.measured import read
    from fem_adhesion.fitting.study import fit

    (path,), form = options.curves, style.require_suffix(options.plot) if options.plot else ""
    with all_written(json=options.json, plot=options.plot) as files:
        with progress_bar() as step:
            found = fit(
                read(path, stiffness=reading["stiffness"], sensitivity=reading["sensitivity"]), **given, progress=step
            )
        if "json" in files:
            json.dump(terminal.record(found, curve=path, **given), files["json"], indent=1, allow_nan=False)
        if "plot" in files:
            style.write(lambda: figure.draw(found), files["plot"], form)
        report = terminal.report(found)
    console_beside(options.json).print(report)
    return AGREE


def _write_plugin(path: Path, given: Mapping[str, Any]) -> None:
    from fem_adhesion.fitting import plugin

    plugin.write(path, radius=given["radius"].value, modulus=given["modulus"].value, poisson=given["poisson"])


def _detector(text: str | None) -> float | None:
    from fem_adhesion.common.numbers import parse

    return parse(text, "detector") if text else None


def asked(options: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `fem_adhesion.fit`, all but the curve."""
    from fem_adhesion.common.numbers import parse

    missing = [f"--{name}" for name in ("radius", "modulus", "poisson") if getattr(options, name) is None]
    if missing:
        raise InputError(f"{', '.join(missing)} missing, limit: radius, modulus and poisson; give it too")
    found: dict[str, Any] = {
        name: quantity(text, name) for name in MEASURED if (text := getattr(options, name)) is not None
    }
    for name in ("counter_modulus", "counter_radius"):
        if text := getattr(options, name):
            found[name] = parse(text, name)
    found |= {"poisson": options.poisson, "counter_poisson": options.counter_poisson}
    return found | ({"models": tuple(options.models)} if options.models else {})


def quantity(text: str, name: str) -> Measured:
    """Quantity that is exact, has a standard error, or is free."""
    from fem_adhesion.common.numbers import Measured, measured

    if text == FREE:
        return Measured(STARTS[name], math.inf)
    return measured(text, name)


COMMAND = Command(
    "fit",
    "fit work of adhesion and range to a measured force curve",
    "Fit the contact as the apparatus meets it, with its spring and its jumps, and say what the curve leaves open. "
    "Intervals are profile likelihoods at 95 %.",
    "curve.csv --radius 100nm --modulus 70GPa --poisson 0.17 --stiffness 0.2N/m --json out.json --plot fit.png",
    add_options,
    run,
)
