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

from fem_adhesion.output import greenwood_style as style
from fem_adhesion.output.finite_sphere_chart import chart
from fem_adhesion.studies.finite_sphere_fit import RIGID_PULL_OFF, SOFT_PULL_OFF, Samples, fit, samples
from fem_adhesion.studies.finite_sphere_table import Row
from fem_adhesion.studies.finite_sphere_terms import Array, leading_terms
from halfspace.errors import InputError

DOTS_PER_INCH = 160
LOOK: Mapping[Any, Any] = {**style.LOOK, "svg.fonttype": "none"}
STRETCH = r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
SIZE = "|relative deviation from the half-space|"
FAVOURED = (0.3, 1.0, 3.0)  # Tabor parameters of a panel each
POISSON = 0.3

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
    stem, title, see : str
        File name without its suffix, what is drawn, one or two sentences on what to see.
    draw : callable
        Draws it from the table.
    """

    stem: str
    title: str
    see: str
    draw: Callable[[Sequence[Row]], Figure]


def draw(rows: Sequence[Row], directory: Path, begin: Callable[[str], None] | None = None) -> None:
    """Write every figure as SVG and PNG into a directory that exists; `begin` is told each figure's stem."""
    with rc_context(dict(LOOK)):
        for picture in PICTURES:
            if begin:
                begin(f"figure {picture.stem}")
            figure = picture.draw(rows)
            figure.savefig(directory / f"{picture.stem}.svg", metadata={"Date": None, "Title": picture.title})
            figure.savefig(directory / f"{picture.stem}.png", dpi=DOTS_PER_INCH)


def reference_poisson(rows: Sequence[Row]) -> float | None:
    """Poisson's ratio of the figures that show one: 0.3, or the nearest to it in the table."""
    known = {row.poisson for row in rows if row.poisson is not None}
    return min(known, key=lambda nu: abs(nu - POISSON), default=None)


def panel_tabors(rows: Sequence[Row]) -> list[float]:
    """Tabor parameters that have a panel: those nearest to 0.3, 1 and 3 in the table."""
    known = {row.tabor for row in rows}
    return sorted({min(known, key=lambda mu: abs(np.log(mu / wanted))) for wanted in FAVOURED} if known else set())


def _figure_causes(rows: Sequence[Row]) -> Figure:
    tabors, poisson = panel_tabors(rows), reference_poisson(rows)
    figure, panels = _side_by_side(len(tabors))
    for axes, tabor in zip(panels, tabors, strict=False):
        for cause in CAUSES:
            _cause(axes, rows, cause, tabor, poisson)
        _theories(axes, tabor)
        axes.set_ylim(bottom=1e-7)
        axes.set_title(rf"$\mu = {tabor:g}$")
    _finish(figure, panels)
    return figure


def _side_by_side(count: int) -> tuple[Figure, Sequence[Any]]:
    figure, panels = style.panels(max(count, 2), height=6.4)
    for axes in panels[1:]:
        axes.sharey(panels[0])
    return figure, panels


def _finish(figure: Figure, panels: Sequence[Any], columns: int = 3) -> None:
    """Label the panels, and put one legend of what they show below them."""
    for axes in panels:
        axes.set(xscale="log", yscale="log")
        style.dress(axes, STRETCH, SIZE if axes is panels[0] else "", legend=None)
    shown = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if shown:
        handles, labels = list(shown.values()), list(shown)
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False, **style.LEGEND)


def _cause(axes: Any, rows: Sequence[Row], cause: str, tabor: float, poisson: float | None) -> None:
    data = samples(rows, cause, "pull_off_load", None if cause == "profile" else poisson)
    data = data.where(data.tabor == tabor)
    colour, marker, label = CAUSES[cause]
    _signed(axes, data, color=colour, marker=marker, label=label)
    try:
        found = fit(data, terms := leading_terms(cause, "pull_off_load", one_tabor=True))
    except InputError:
        return  # too few points for a line through them: the table says so
    x = np.geomspace(data.stretch.min(), found.holds_to, 200)
    parts = [c.value * terms[name](np.full_like(x, tabor), tabor / x**2) for name, c in found.coefficients.items()]
    axes.plot(x, np.abs(np.sum(parts, axis=0)), color=colour, linewidth=1.0)


def _signed(axes: Any, data: Samples, **look: Any) -> None:
    """Sizes of deviations that exceed their errors: filled markers where negative, hollow where positive."""
    known = np.abs(data.deviation) > data.error
    for sign, face in ((-1, look["color"]), (1, "white")):
        chosen = known & (np.sign(data.deviation) == sign)
        if chosen.any():
            x, y = data.stretch[chosen], np.abs(data.deviation[chosen])
            axes.plot(x, y, **look, linestyle="none", markersize=5.5, markerfacecolor=face)
            look["label"] = None  # once is enough


def _theories(axes: Any, tabor: float) -> None:
    """What theory says of the profile's part: for a rigid sphere, and for JKR's."""
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    x: Array = np.geomspace(low, high, 50)
    lines = {"rigid sphere, $(9/7)\\,\\epsilon/R$": RIGID_PULL_OFF / tabor, "Maugis 1995": SOFT_PULL_OFF}
    for (label, factor), dashes in zip(lines.items(), (style.DOTTED, style.DASHED), strict=True):
        axes.plot(x, abs(factor) * x**2, color="0.45", linestyle=dashes, linewidth=1.6, label=label)


def _figure_poisson(rows: Sequence[Row]) -> Figure:
    figure, panels = style.panels(2, height=6.4)
    quantities = {"pull_off_load": "pull-off force", "jump_on_approach": "approach at jump-on"}
    for axes, (quantity, title) in zip(panels, quantities.items(), strict=True):
        for number, (tabor, ratio) in enumerate(_points_by_poisson(rows)):
            _by_poisson(axes, rows, quantity, tabor, ratio, number)
        axes.set(title=title, yscale="log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100 * y:g} %"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        style.dress(axes, r"Poisson's ratio $\nu$", SIZE, legend=None)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, **style.LEGEND)
    return figure


def _points_by_poisson(rows: Sequence[Row]) -> list[tuple[float, float]]:
    """Tabor parameters and R/eps that were solved at three Poisson's ratios or more."""
    found: dict[tuple[float, float], set[float]] = {}
    for row in rows:
        if row.poisson is not None and row.radius_ratio:
            found.setdefault((row.tabor, row.radius_ratio), set()).add(row.poisson)
    return sorted((point for point, ratios in found.items() if len(ratios) >= 3), key=lambda point: point[::-1])


def _by_poisson(axes: Any, rows: Sequence[Row], quantity: str, tabor: float, ratio: float, number: int) -> None:
    point = ("all", quantity, tabor, ratio)
    chosen = sorted(
        (row.poisson, row.deviation.value)
        for row in rows
        if (row.cause, row.quantity, row.tabor, row.radius_ratio) == point and row.deviation and row.poisson is not None
    )
    if not chosen:
        return
    nu, y = np.array(chosen).T
    look = {"color": COLOURS[number % 6], "marker": MARKERS[number % 6], "markersize": 5.5, "linewidth": 1.2}
    axes.plot(nu, np.abs(y), label=rf"$\mu = {tabor:g}$, $R/\epsilon = {ratio:g}$", **look)
    axes.plot(nu[y > 0], np.abs(y[y > 0]), **look | {"linestyle": "none", "markerfacecolor": "white"})


def _figure_bulk(rows: Sequence[Row]) -> Figure:
    figure, panels = _side_by_side(2)
    tabors = [mu for mu in sorted({row.tabor for row in rows}) if _jumps(rows, mu)][:4]
    for axes, (quantity, name) in zip(panels, JUMPS.items(), strict=True):
        for number, tabor in enumerate(tabors):
            for suffix, how, dashes in (("", "raw", "-"), ("_less_bulk", "bulk yield taken out", style.DASHED)):
                data = samples(rows, "all", quantity + suffix, reference_poisson(rows))
                label = rf"$\mu = {tabor:g}$, {how}"
                _line(axes, data.where(data.tabor == tabor), number, dashes, label)
        axes.set_title(f"approach at {name}")
    _finish(figure, panels, columns=4)
    return figure


def _jumps(rows: Sequence[Row], tabor: float) -> bool:
    data = samples(rows, "all", "jump_on_approach", reference_poisson(rows))
    return bool((data.tabor == tabor).sum() > 1)


def _line(axes: Any, data: Samples, number: int, dashes: Any, label: str) -> None:
    """Deviations joined by a line, with markers where they exceed their errors."""
    colour, marker = COLOURS[number % 6], MARKERS[number % 6]
    order = np.argsort(data.stretch)
    axes.plot(data.stretch[order], np.abs(data.deviation[order]), color=colour, linestyle=dashes, linewidth=1.1)
    _signed(axes, data, color=colour, marker=marker)
    axes.plot([], [], color=colour, marker=marker, linestyle=dashes, linewidth=1.1, label=label)


PICTURES = (
    Picture(
        "chart",
        "Where the half-space is good enough",
        "Above a line the half-space under a paraboloid errs by less than the line says; below it by more. Materials "
        "are typical, and placed by their own values, whatever their Poisson's ratio; sizes are radii, of the tips at "
        "the left edge.",
        lambda rows: chart(rows, reference_poisson(rows)),
    ),
    Picture(
        "causes",
        "What makes the pull-off force deviate",
        "Filled markers: the force is weakened; hollow: strengthened. Lines are the fitted leading terms as far as "
        "they hold. The profile's part falls as (beta/R)^2, the body's as beta/R, so the body decides on large "
        "spheres; the grip hardly matters. What the profile takes, the law per true area would give back.",
        _figure_causes,
    ),
    Picture(
        "poisson",
        "How the deviations depend on Poisson's ratio",
        "The part of the pull-off in proportion to beta/R, which shows at the larger R/eps, goes as the body becomes "
        "incompressible. The approach at jump-on follows the body's yield, kappa, which changes its sign with R/beta "
        "where Poisson's ratio is small. Hollow markers: the force is strengthened, or the jump is from farther away.",
        _figure_poisson,
    ),
    Picture(
        "bulk",
        "The approach at the jumps, raw and without the body's linear yield",
        "Most of the deviation is the yield of the body as a whole, kappa W/(E* R), which can be taken out by hand. "
        "Filled markers: nearer to zero than on the half-space; hollow: farther. Where a line has no marker, the "
        "deviation is less than its error, mostly that of kappa.",
        _figure_bulk,
    ),
)
