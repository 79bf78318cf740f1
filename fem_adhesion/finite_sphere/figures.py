"""The figures of the finite sphere: its chart, and the deviations from the half-space by cause and Poisson's ratio."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from fem_adhesion.common import style
from fem_adhesion.finite_sphere.chart_figure import chart, legend_below
from fem_adhesion.finite_sphere.fit import RIGID_PULL_OFF, SOFT_PULL_OFF, Samples, fit, samples
from fem_adhesion.finite_sphere.points import (
    by_poisson,
    jumping_tabors,
    panel_tabors,
    points_by_poisson,
    reference_poisson,
)
from fem_adhesion.finite_sphere.table import Results, Row
from fem_adhesion.finite_sphere.terms import leading_terms
from fem_adhesion.finite_sphere.words import headline
from halfspace.errors import InputError
from halfspace.values import Array

DOTS_PER_INCH = 160
LOOK: Mapping[Any, Any] = {**style.LOOK, "svg.fonttype": "none"}
STRETCH = r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
SIZE = "|relative deviation from the half-space|"
SMALLEST = 1e-7  # deviation that is shown
MOST_LINES = 4
DASHES = ("-", style.DASHED, style.DOTTED)  # one after the other when colours and markers come again
WHOLE, PART = 8.0, 5.5  # sizes of markers: that of the whole shows round that of its largest part

CAUSES: Mapping[str, tuple[str, str, str]] = {
    "all": ("black", "o", "all: elastic sphere, sliding mid-plane"),
    "profile": (style.BLUE, "s", "profile: sphere for paraboloid"),
    "body": (style.RED, "^", "body: hemisphere for half-space"),
    "grip": (style.GREEN, "D", "grip: bonded for sliding"),
    "traction": (style.PINK, "v", "traction: true for projected area"),
    "strain": (style.ORANGE, "P", "strain: neo-Hookean for linear"),
}
JUMPS = {"jump_on_approach": "jump-on", "jump_off_approach": "jump-off"}
COLOURS = (style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PINK, style.SKY)
MARKERS = ("o", "s", "^", "D", "v", "P")


@dataclass(frozen=True)
class Picture:
    """A figure of the study.

    Attributes
    ----------
    stem, title : str
        File name without its suffix, and what is drawn.
    draw : callable
        Draws it from the results.
    lacks : callable
        What it lacks to be drawn, or empty.
    """

    stem: str
    title: str
    draw: Callable[[Results], Figure]
    lacks: Callable[[Results], str]


def draw(results: Results, directory: Path, begin: Callable[[str], None] | None = None) -> None:
    """Write figures as SVG and PNG into a directory that exists, but for those that lack something.

    Parameters
    ----------
    results : Results
        What to draw.
    directory : Path
        Where.
    begin : callable, optional
        Told each figure's stem.
    """
    with rc_context(dict(LOOK)):
        for picture in PICTURES:
            if begin:
                begin(f"figure {picture.stem}")
            if picture.lacks(results):
                continue
            figure = picture.draw(results)
            figure.savefig(directory / f"{picture.stem}.svg", metadata={"Date": None, "Title": picture.title})
            figure.savefig(directory / f"{picture.stem}.png", dpi=DOTS_PER_INCH)


def _figure_chart(results: Results) -> Figure:
    partly = results.study.quick or results.study.failed
    heading = headline(results.study) if partly else ""
    return chart(results.rows, reference_poisson(results.rows), results.borders, heading)


def _figure_causes(results: Results) -> Figure:
    rows = results.rows
    tabors, poisson = panel_tabors(rows), reference_poisson(rows)
    figure, panels = style.panels(max(len(tabors), 2), height=6.4)
    for axes, tabor in zip(panels, tabors, strict=False):
        for cause in CAUSES:
            _cause(axes, rows, cause, tabor, poisson)
        axes.set_title(rf"$\mu = {tabor:g}$")
        _theories(axes, tabor)
    _finish(figure, panels[: len(tabors)])
    for axes in panels[len(tabors) :]:
        axes.set_axis_off()
    return figure


def _finish(figure: Figure, panels: Sequence[Any], columns: int = 3) -> None:
    """Label the panels, give them one ordinate that holds all lines, and put one legend below them."""
    sizes = np.concatenate([np.empty(0), *(line.get_ydata() for axes in panels for line in axes.lines)])
    sizes = sizes[np.isfinite(sizes) & (sizes > 0)]
    for axes in panels:
        axes.set(xscale="log", yscale="log")
        style.dress(axes, STRETCH, SIZE if axes is panels[0] else "", legend=None)
        _plain(axes.xaxis)
        if sizes.size:
            axes.set_ylim(max(sizes.min() / 1.6, SMALLEST), max(sizes.max(), SMALLEST) * 1.6)
    legend_below(figure, panels, columns)


def _plain(axis: Any) -> None:
    """Plain numbers at 1, 2 and 5 of each decade of a logarithmic axis, and none between."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def _cause(axes: Any, rows: Sequence[Row], cause: str, tabor: float, poisson: float | None) -> None:
    data = samples(rows, cause, "pull_off_load", None if cause == "profile" else poisson)
    data = data.where(data.tabor == tabor)
    colour, marker, label = CAUSES[cause]
    size = WHOLE if cause == "all" else PART
    _signed(axes, data, color=colour, marker=marker, markersize=size, label=label)
    try:
        found = fit(data, terms := leading_terms(cause, "pull_off_load", one_tabor=True))
    except InputError:
        return  # too few points for a line through them: the table says so
    x = np.geomspace(data.stretch.min(), found.holds_to, 200)
    parts = [c.value * terms[name](np.full_like(x, tabor), tabor / x**2) for name, c in found.coefficients.items()]
    axes.plot(x, np.abs(np.sum(parts, axis=0)), color=colour, linewidth=1.0)


def _signed(axes: Any, data: Samples, **look: Any) -> None:
    """Sizes of deviations that exceed their errors: filled markers where negative, hollow where positive."""
    known = data.significant
    for sign, face in ((-1, look["color"]), (1, "white")):
        chosen = known.where(np.sign(known.deviation) == sign)
        if chosen.tabor.size:
            x, y = chosen.stretch, np.abs(chosen.deviation)
            axes.plot(x, y, **{"markersize": PART, **look}, linestyle="none", markerfacecolor=face)
            look["label"] = None  # once is enough


def _theories(axes: Any, tabor: float) -> None:
    """What theory says of the profile's part, for a rigid sphere and for JKR's, as far as there are points."""
    points = np.concatenate([np.empty(0), *(line.get_xdata() for line in axes.lines)])
    if not points.size:
        return
    x: Array = np.geomspace(points.min() / 1.2, points.max() * 1.2, 50)
    lines = {"rigid sphere, $(9/7)\\,\\epsilon/R$": RIGID_PULL_OFF / tabor, "Maugis 1995": SOFT_PULL_OFF}
    for (label, factor), dashes in zip(lines.items(), (style.DOTTED, style.DASHED), strict=True):
        axes.plot(x, abs(factor) * x**2, color="0.45", linestyle=dashes, linewidth=1.6, label=label)


def _figure_poisson(results: Results) -> Figure:
    figure, panels = style.panels(2, height=6.4)
    quantities = {"pull_off_load": "pull-off force", "jump_on_approach": "approach at jump-on"}
    for axes, (quantity, title) in zip(panels, quantities.items(), strict=True):
        for number, (tabor, ratio) in enumerate(points_by_poisson(results.rows)):
            _by_poisson(axes, by_poisson(results.rows, quantity, tabor, ratio), tabor, ratio, number)
        axes.set(title=title, yscale="log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100 * y:g} %"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        style.dress(axes, r"Poisson's ratio $\nu$", SIZE, legend=None)
    legend_below(figure, panels, columns=3)
    return figure


def _by_poisson(axes: Any, points: tuple[Array, Array], tabor: float, ratio: float, number: int) -> None:
    nu, y = points
    if not nu.size:
        return
    look = {"color": COLOURS[number % 6], "marker": MARKERS[number % 6], "markersize": PART, "linewidth": 1.2}
    look["linestyle"] = DASHES[number // 6 % len(DASHES)]
    axes.plot(nu, np.abs(y), label=rf"$\mu = {tabor:g}$, $R/\epsilon = {ratio:g}$", **look)
    axes.plot(nu[y > 0], np.abs(y[y > 0]), **look | {"linestyle": "none", "markerfacecolor": "white"})


def _figure_bulk(results: Results) -> Figure:
    rows = results.rows
    figure, panels = style.panels(2, height=6.4)
    for axes, (quantity, name) in zip(panels, JUMPS.items(), strict=True):
        for number, tabor in enumerate(jumping_tabors(rows)[:MOST_LINES]):
            for suffix, how, dashes in (("", "raw", "-"), ("_less_bulk", "bulk yield taken out", style.DASHED)):
                data = samples(rows, "all", quantity + suffix, reference_poisson(rows))
                label = rf"$\mu = {tabor:g}$, {how}"
                _line(axes, data.where(data.tabor == tabor), number, dashes, label)
        axes.set_title(f"approach at {name}")
    _finish(figure, panels, columns=4)
    return figure


def _line(axes: Any, data: Samples, number: int, dashes: Any, label: str) -> None:
    """Deviations joined by a line, with markers where they exceed their errors."""
    if not data.tabor.size:
        return
    colour, marker = COLOURS[number % 6], MARKERS[number % 6]
    order = np.argsort(data.stretch)
    axes.plot(data.stretch[order], np.abs(data.deviation[order]), color=colour, linestyle=dashes, linewidth=1.1)
    _signed(axes, data, color=colour, marker=marker)
    axes.plot([], [], color=colour, marker=marker, linestyle=dashes, linewidth=1.1, label=label)


def _no_sphere(results: Results) -> str:
    solved = samples(results.rows, "all", "pull_off_load", reference_poisson(results.rows))
    return "" if solved.tabor.size else "no elastic sphere was solved beside the half-space"


PICTURES = (
    Picture("chart", "Where the half-space is good enough", _figure_chart, _no_sphere),
    Picture("causes", "What makes the pull-off force deviate", _figure_causes, _no_sphere),
    Picture(
        "poisson",
        "How the deviations depend on Poisson's ratio",
        _figure_poisson,
        lambda results: "" if points_by_poisson(results.rows) else "no point was solved at two Poisson's ratios",
    ),
    Picture(
        "bulk",
        "The approach at the jumps, raw and without the body's linear yield",
        _figure_bulk,
        lambda results: "" if jumping_tabors(results.rows) else "no Tabor parameter jumps on spheres of two sizes",
    ),
)
