"""The deviations by Poisson's ratio, and those of the jumps without the body's yield: figures and captions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from fem_adhesion.common import style
from fem_adhesion.common.style import Picture
from fem_adhesion.common.words import at_points, counted, span
from fem_adhesion.finite_sphere.cause_figure import PART, SIZE, finish, signed
from fem_adhesion.finite_sphere.points import (
    Samples,
    by_poisson,
    jumping_tabors,
    points_by_poisson,
    reference_poisson,
    samples,
)
from fem_adhesion.finite_sphere.table import DeviationRow, Results
from halfspace.values import Array

MOST_LINES = 4
DASHES = ("-", style.DASHED, style.DOTTED)  # one after the other when colours and markers come again
JUMPS = {"jump_on_approach": "jump-on", "jump_off_approach": "jump-off"}
COLOURS = (style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PINK, style.SKY)
MARKERS = ("o", "s", "^", "D", "v", "P")
APPROACHES = (
    "Deviations of approaches, which have no natural zero, are parts of the spacing and the range of the approaches at "
    "all events on the half-space."
)


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
    style.legend_below(figure, panels, columns=3)
    return figure


def _by_poisson(axes: Any, points: tuple[Array, Array], tabor: float, ratio: float, number: int) -> None:
    nu, y = points
    if not nu.size:
        return
    look = {"color": COLOURS[number % 6], "marker": MARKERS[number % 6], "markersize": PART, "linewidth": 1.2}
    look["linestyle"] = DASHES[number // 6 % len(DASHES)]
    axes.plot(nu, np.abs(y), label=rf"$\mu = {tabor:g}$, $R/\epsilon = {ratio:g}$", **look)
    axes.plot(nu[y > 0], np.abs(y[y > 0]), **look | {"linestyle": "none", "markerfacecolor": "white"})


def _see_poisson(results: Results) -> Iterator[str]:
    yield "Hollow markers: the force is strengthened, or the jump is from nearer."
    yield from _trend(results.rows)
    yield from _signs(results.rows)


def _trend(rows: Sequence[DeviationRow]) -> Iterator[str]:
    """Which way the size of the pull-off's deviation goes from the least to the largest Poisson's ratio."""
    ends = []
    for mu, rho in points_by_poisson(rows):
        nu, deviation = by_poisson(rows, "pull_off_load", mu, rho)
        ends.append((float(nu[0]), float(nu[-1]), *np.abs(deviation[[0, -1]])))
    falling = sum(last < first for _, _, first, last in ends)
    if ends:
        least, most = min(end[0] for end in ends), max(end[1] for end in ends)
        yield (
            f"From Poisson's ratio {least:g} to {most:g} the size of the pull-off's deviation falls at {falling} of "
            f"{counted(len(ends), 'point')}."
        )


def _signs(rows: Sequence[DeviationRow]) -> Iterator[str]:
    """Where the deviation of the jump-on changes its sign with Poisson's ratio."""
    found = [by_poisson(rows, "jump_on_approach", mu, rho)[1] for mu, rho in points_by_poisson(rows)]
    known = [deviation for deviation in found if deviation.size > 1]
    changing = sum(bool(deviation.min() < 0 < deviation.max()) for deviation in known)
    if known:
        yield f"That of the approach at jump-on changes its sign at {changing} of {counted(len(known), 'point')}."


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
    finish(figure, panels, columns=4)
    return figure


def _line(axes: Any, data: Samples, number: int, dashes: Any, label: str) -> None:
    """Deviations joined by a line, with markers where they exceed their errors."""
    if not data.tabor.size:
        return
    colour, marker = COLOURS[number % 6], MARKERS[number % 6]
    order = np.argsort(data.stretch)
    axes.plot(data.stretch[order], np.abs(data.deviation[order]), color=colour, linestyle=dashes, linewidth=1.1)
    signed(axes, data, color=colour, marker=marker)
    axes.plot([], [], color=colour, marker=marker, linestyle=dashes, linewidth=1.1, label=label)


def _see_bulk(results: Results) -> Iterator[str]:
    rows, poisson = results.rows, reference_poisson(results.rows)
    yield (
        "The yield of the body as a whole is kappa W/(E* R), which can be taken out by hand. Filled markers: from "
        "farther away than on the half-space; hollow: from nearer. Where a line has no marker, the deviation is within "
        f"its error. {APPROACHES}"
    )
    shares = np.concatenate([_left(rows, f"jump_{way}_approach", poisson) for way in ("on", "off")])
    if not jumping_tabors(rows) or not shares.size:
        return
    most = int(np.sum(shares < 0.5))
    yield (
        f"Without it {span(100 * shares)} % of the deviation is left{at_points(shares.size)}: the yield is most of it "
        f"at {most if most < shares.size else 'all'} of them."
    )


def _left(rows: Sequence[DeviationRow], quantity: str, poisson: float | None) -> Array:
    """Part of an approach's deviation, at most, that is left without the yield, where the whole exceeds its error."""
    whole, rest = (samples(rows, "all", quantity + suffix, poisson) for suffix in ("", "_less_bulk"))
    whole = whole.significant
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), np.abs(whole.deviation), strict=True))
    points = zip(rest.tabor, rest.radius_ratio, np.abs(rest.deviation) + rest.error, strict=True)
    return np.array([size / sizes[mu, rho] for mu, rho, size in points if (mu, rho) in sizes], float)


POISSON_FIGURE = Picture(
    "poisson",
    "How the deviations depend on Poisson's ratio",
    _figure_poisson,
    lambda results: " ".join(_see_poisson(results)),
    lambda results: "" if points_by_poisson(results.rows) else "no point was solved at two Poisson's ratios",
)
BULK_FIGURE = Picture(
    "bulk",
    "The approach at the jumps, raw and without the body's linear yield",
    _figure_bulk,
    lambda results: " ".join(_see_bulk(results)),
    lambda results: "" if jumping_tabors(results.rows) else "no Tabor parameter jumps on spheres of two sizes",
)
