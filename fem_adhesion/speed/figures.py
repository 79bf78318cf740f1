"""Error against wall time on log-log axes: a figure for each quantity, half-space and finite elements side by side."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.style import Picture
from fem_adhesion.speed.methods import Family, Method
from fem_adhesion.speed.result import SpeedStudy, Timing, pareto_front

CAPTION = "Error against wall time: half-space left, finite elements right."
FAMILIES: tuple[Family, ...] = ("half-space", "finite elements")
TITLES = {
    "pull_off": "Pull-off load",
    "jump_on": "Approach at which the surfaces jump on",
    "hysteresis": "Energy lost in a cycle of approach and separation",
}
ERRORS = {
    "pull_off": "relative error of the pull-off load",
    "jump_on": "error of the jump-on approach, over spacing and range of approaches",
    "hysteresis": "relative error of the energy lost",
}
COLOURS = (style.ORANGE, style.SKY, style.GREEN, style.BLUE, style.RED, style.PINK)  # black is adaptive
STYLES = tuple(zip(COLOURS, "XPs^vD", strict=True))
ADAPTIVE = {"adaptive": ("#000000", "o"), "hp": ("#000000", "o")}
LINES = {"": "-", "clamped": "--", "monolithic": ":"}
FRONT: dict[str, Any] = {
    "color": "0.85",
    "linewidth": 9,
    "solid_capstyle": "round",
    "solid_joinstyle": "round",
    "zorder": 0,
}
FLOOR: dict[str, Any] = {"color": "0.4", "linewidth": 1, "dashes": (1, 3)}
HIDDEN: dict[str, Any] = {"color": "0.4", "linestyle": "none", "marker": r"$\downarrow$", "markersize": 11}


def pictures(study: SpeedStudy) -> list[Picture[SpeedStudy]]:
    """A figure for each quantity that the study has."""
    return [
        Picture(quantity, TITLES[quantity], partial(error_against_time, quantity=quantity), lambda _: CAPTION)
        for quantity in study.quantities
    ]


def error_against_time(study: SpeedStudy, quantity: str) -> Figure:
    """Figure of one quantity: a panel for each family, with the Pareto front of both families behind.

    A method without this quantity has no line and no place in the legend; an arrow downwards hangs on every error that
    is no more than the uncertainty of the truth.
    """
    figure = Figure(figsize=(11.5, 7.2), layout="constrained")
    quick = ", quick run" if study.quick else ""
    figure.suptitle(f"{TITLES[quantity]}: error against wall time at Tabor parameter {study.tabor:g}{quick}")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, family in zip(panels, FAMILIES, strict=True):
        _draw_front(axes, pareto_front(study.rungs, quantity), quantity)
        axes.axhline(study.uncertainty(family, quantity), label="uncertainty of the truth", **FLOOR)
        for method in study.methods:
            if method.family == family:
                _draw_method(axes, study, method, quantity)
        _draw_hidden(axes, study, family, quantity)
        _dress(axes, f"{family}, judged by the {study.truths[family].family}")
    panels[0].set_ylabel(ERRORS[quantity])
    return figure


def _draw_front(axes: Any, front: Sequence[Timing], quantity: str) -> None:
    """A broad grey line behind the points that no other beats in both time and error."""
    if not front:
        return
    seconds, errors = [rung.seconds for rung in front], [rung.error(quantity) for rung in front]
    axes.loglog(seconds, errors, label="Pareto front, all methods", drawstyle="steps-post", **FRONT)


def _draw_method(axes: Any, study: SpeedStudy, method: Method, quantity: str) -> None:
    """One method's ladder; markers of what departs from the family's usual are hollow."""
    rungs = [rung for rung in study.of(method.name) if np.isfinite(rung.error(quantity))]
    if not rungs:
        return
    colour, marker = _style(study, method)
    axes.loglog(
        [rung.seconds for rung in rungs],
        [rung.error(quantity) for rung in rungs],
        LINES[method.variant],
        color=colour,
        marker=marker,
        markersize=7,
        markerfacecolor="white" if method.variant else colour,
        label=method.name,
    )


def _draw_hidden(axes: Any, study: SpeedStudy, family: Family, quantity: str) -> None:
    """Arrows at the errors that the truth cannot tell."""
    names = {method.name for method in study.methods if method.family == family}
    hidden = [rung for rung in study.rungs if rung.method in names and rung.hidden(quantity)]
    if hidden:
        places = [rung.seconds for rung in hidden], [0.75 * rung.error(quantity) for rung in hidden]
        axes.loglog(*places, label="within that uncertainty", **HIDDEN)


def _style(study: SpeedStudy, method: Method) -> tuple[str, str]:
    """Colour and marker, the same for all variants of a basis."""
    bases = dict.fromkeys(m.basis for m in study.methods if m.family == method.family and m.basis not in ADAPTIVE)
    return ADAPTIVE.get(method.basis) or STYLES[list(bases).index(method.basis)]


def _dress(axes: Any, title: str) -> None:
    axes.set_title(title)
    axes.tick_params(labelleft=True)
    style.dress(axes, "wall time from set-up to events, s", axes.get_ylabel(), legend="below", columns=2)
