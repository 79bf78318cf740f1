"""``curve --solver weak-form``: the curve by full Newton on the weak form, as table, JSON, CSV and figure."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import IO, Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from scipy.interpolate import CubicHermiteSpline

from fem_adhesion.common import style
from fem_adhesion.common.facts import plain, versions
from fem_adhesion.common.terminal import Column, Fitted, prose
from fem_adhesion.curve import record
from fem_adhesion.curve.load import LEGEND, STATES
from fem_adhesion.curve.solve import Curves, Question
from fem_adhesion.curve.terminal import EVENTS, RANKS, cells, title
from fem_adhesion.weak_form.curve import Curve, trace
from halfspace.equilibrium.contact import OBSERVABLES

NAME = "weak form"
BETWEEN = 12  # points drawn from one computed point to the next


@dataclass(frozen=True)
class Found:
    """A curve by the weak form, and what was asked."""

    question: Question
    curve: Curve

    @cached_property
    def frame(self) -> Curves:
        """The question without paths: it names columns and units."""
        return Curves(self.question, {}, None, None, tuple(self.curve.events.values()))


def solve(question: Question) -> Found:
    """Trace the curve; raise InputError, before any work, if the weak form does not serve what is asked."""
    return Found(question, trace(question.scene, question.rtol, to_load=question.to_load))


def as_record(found: Found) -> dict[str, Any]:
    """Everything, ready for JSON, under the names that the other solvers' records have."""
    question, curve = found.question, found.curve
    columns = {name: getattr(curve, name) for name in record.COLUMNS}
    stability = {name: getattr(curve, flag) for name, flag in FLAGS.items()}
    solution = {
        "events": {
            name: record.event_record(event, curve.tolerance.missed_by(event)) for name, event in curve.events.items()
        },
        "curve": columns | stability,
        "met": curve.met,
        "unknowns": curve.unknowns,
        "seconds": curve.seconds,
        "settings": curve.settings,
    }
    parts = record.asked(question) | {"solutions": {NAME: solution}, "versions": versions()}
    return {name: plain(part) for name, part in parts.items()}


FLAGS = {"stable_under_fixed_grips": "stable", "stable_under_dead_load": "stable_under_dead_load"}


def write_csv(found: Found, file: IO[str]) -> None:
    """Write the points along the curve, and the events after them, in the columns of the other solvers."""
    writer = csv.DictWriter(file, record.columns(found.frame), lineterminator="\n", restval="")
    writer.writeheader()
    for row in _rows(found.curve):
        writer.writerow(record.with_units(found.frame, {"solver": NAME, **row}))


def _rows(curve: Curve) -> Iterator[dict[str, Any]]:
    for n in range(len(curve.load)):
        numbers = {name: float(getattr(curve, name)[n]) for name in record.COLUMNS}
        yield {"event": "", **numbers, **{name: int(getattr(curve, flag)[n]) for name, flag in FLAGS.items()}}
    for name, event in curve.events.items():
        numbers = {key: getattr(event, key) for key in record.NUMBERS}
        yield {"event": name, **numbers, "missed_rtol": " ".join(curve.tolerance.missed_by(event))}


def show(found: Found, console: Console) -> None:
    """Print the events with their errors, and what the curve cost."""
    curve, units = found.curve, found.frame.scales
    numbers = zip(
        *(cells(event, units, curve.tolerance.missed_by(event)) for event in curve.events.values()), strict=True
    )
    columns = [
        Column(f"{name.replace('_', ' ')}\n{units[name].unit}", texts, RANKS[name])
        for name, texts in zip(OBSERVABLES, numbers, strict=True)
    ]
    words = Column("state", [EVENTS.get(name, name.replace("_", " ")) for name in curve.events], text=True, wraps=True)
    console.print(Fitted([words, *columns], list(title(found.frame))))
    cost = f"{curve.unknowns} unknowns, {len(curve.load)} points, {curve.seconds:.1f} s; {curve.tolerance_told}"
    console.print(prose(f"{NAME}: {cost}"), highlight=False)
    reading = "In brackets: error of the last digit. Compression and approach are positive; -: no contact."
    console.print(prose(reading), highlight=False)


def draw(found: Found) -> Figure:
    """Load and central gap against approach, by stability, with the events."""
    curve, units = found.curve, found.frame.scales
    figure, axes = style.panels(2)
    s = np.unique(np.linspace(curve.arclength[:-1], curve.arclength[1:], BETWEEN + 1))
    values = CubicHermiteSpline(curve.arclength, curve.observables[:, :3], curve.rates)(s)
    falling = CubicHermiteSpline(curve.arclength, curve.observables[:, 0], curve.rates[:, 0])(s, 1) < 0
    before = np.clip(np.searchsorted(curve.arclength, s, side="right") - 1, 0, len(curve.stable) - 2)
    sure = curve.stable[before] == curve.stable[before + 1]
    stable = np.where(sure, curve.stable[before], ~falling)  # next to a fold where the approach rises
    x = units["approach"].size * values[:, 0]
    for panel, name, column in zip(axes, ("load", "central_gap"), (1, 2), strict=True):
        y = units[name].size * values[:, column]
        panel.plot(x, np.where(stable, y, np.nan), color=style.BLUE, linewidth=2.2, label="stable under fixed grips")
        if not stable.all():
            panel.plot(x, np.where(stable, np.nan, y), color=style.RED, linestyle=style.DOTTED, label="unstable")
        for event_name, event in curve.events.items():
            look = STATES.get(event_name)
            at = units["approach"].size * event.approach, units[name].size * getattr(event, name)
            panel.plot(
                *at,
                look.marker if look else "s",
                color=look.color if look else "0.4",
                linestyle="none",
                label=look.words if look else event_name.replace("_", " "),
            )
        style.dress(panel, units["approach"].label, units[name].label, legend=None)
    axes[0].legend(loc="best", **LEGEND)
    return figure
