"""The report: one page that a reviewer can be sent, with every figure and all that moves inside it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from fem_adhesion.output import plots
from fem_adhesion.output.curve_lines import UNSTABLE, Line, smooth
from fem_adhesion.output.record import overall_verdict
from fem_adhesion.output.report_figures import figure
from fem_adhesion.output.report_levels import crosscheck_section, settings_section
from fem_adhesion.output.report_parts import Section
from fem_adhesion.output.report_sections import SOURCES, section_of
from fem_adhesion.studies.crosscheck import Case, Failure
from fem_adhesion.studies.curves import Curves
from fem_adhesion.studies.machine import machine
from fem_adhesion.studies.walk import LINES, Station, Walk
from halfspace.compliance import Array

TEMPLATES = "output/templates"

VERDICTS = {
    "agree": "The two solvers agree.",
    "inconclusive": "The two solvers do not contradict each other, but their error estimates are too wide to tell.",
    "disagree": "The two solvers disagree.",
    "failed": "A solver failed.",
}

DIGITS = 5  # of the numbers in the moving figure


@dataclass(frozen=True)
class Contents:
    """What goes into a report.

    Attributes
    ----------
    cases : sequence of Case or Failure
        The cross-check.
    curves : Curves
        One curve by both solvers.
    walk : Walk
        The same curve, state by state.
    directories : mapping of str to Path
        Results of other commands, by the commands' names.
    """

    cases: Sequence[Case | Failure]
    curves: Curves
    walk: Walk
    directories: Mapping[str, Path]


def page(contents: Contents) -> str:
    """The page as HTML.

    Raises
    ------
    InputError
        If a directory does not hold what its command writes.
    """
    verdict = overall_verdict(contents.cases)
    others = [section_of(source, contents.directories.get(source.command)) for source in SOURCES]
    environment = Environment(
        loader=PackageLoader("fem_adhesion", TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    return environment.get_template("report.html.j2").render(
        verdict=verdict,
        words=VERDICTS[verdict],
        cases=contents.cases,
        counts=_counts(contents.cases),
        curves=_curves_section(contents.curves),
        walk=walk_data(contents.walk, contents.curves),
        levels=crosscheck_section(contents.cases),
        others=others,
        settings=settings_section(contents.cases, machine()),
        style=_text("report.css"),
        script=_text("walk.js"),
    )


def _text(name: str) -> str:
    return (resources.files("fem_adhesion") / TEMPLATES / name).read_text(encoding="utf-8")


def _counts(cases: Sequence[Case | Failure]) -> dict[str, int]:
    verdicts = [row.verdict for case in cases if not isinstance(case, Failure) for row in case.rows]
    return {verdict: verdicts.count(verdict) for verdict in VERDICTS if verdict in verdicts}


def _curves_section(curves: Curves) -> Section:
    stream = BytesIO()
    plots.draw(curves).savefig(stream, format="svg")
    tabor = curves.question.scene.tabor
    text = (
        f"Load against approach at Tabor parameter {tabor:g} by finite elements and by the half-space, with stable and "
        "unstable branches, the jumps under fixed grips, and JKR, Bradley and Maugis-Dugdale behind; pressure and gap "
        "at the events; the spike of tension at the contact edge with the points of the grid; the deformed mesh."
    )
    return Section("curves", "Curves with both solvers", figures=(figure(stream.getvalue(), "curves", text),))


def walk_data(walk: Walk, curves: Curves) -> str:
    """The walk, and the curve by both solvers, as JSON that is safe inside a script element."""
    data = {
        "tabor": walk.scene.tabor,
        "radii": _rounded(walk.radii),
        "places": _rounded(walk.places),
        "depths": list(LINES),
        "curves": [_curve(smooth(path)) for path in curves.paths.values()],
        "stations": [_station(station) for station in walk.stations],
    }
    return json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _curve(line: Line) -> dict[str, Any]:
    unstable = (line.kind == UNSTABLE).tolist()
    return {"approach": _rounded(line.approach), "load": _rounded(line.load), "unstable": unstable}


def _station(station: Station) -> dict[str, Any]:
    numbers = ("arclength", "approach", "load", "central_gap", "contact_radius")
    return {
        "name": station.name.replace("_", " "),
        "stable": station.stable,
        **{name: _rounded(np.array([getattr(station, name)]))[0] for name in numbers},
        "pressure": [_rounded(row) for row in station.pressure],
        "gap": [_rounded(row) for row in station.gap],
        "lines": [_rounded(row) for row in station.lines],
    }


def _rounded(values: Array) -> list[float | None]:
    """Numbers of a few digits; what does not exist is null."""
    return [float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None for value in values.tolist()]
