"""The deviations of the finite sphere by cause, by Poisson's ratio, and without the body's yield: figures and captions.

Each sentence of a caption is found by a test of the numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from fem_adhesion.common import style
from fem_adhesion.common.numbers import counted, span
from fem_adhesion.common.page import said
from fem_adhesion.common.style import Picture
from fem_adhesion.finite_sphere.chart import no_sphere
from fem_adhesion.finite_sphere.fit import RIGID_PULL_OFF, SOFT_PULL_OFF, fit, leading_terms
from fem_adhesion.finite_sphere.study import Study
from fem_adhesion.finite_sphere.table import CAUSES, DRAWN, SHOWN, Samples, samples, significant
from halfspace.errors import InputError
from halfspace.values import Array

STRETCH = r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
SIZE = "|relative deviation from the half-space|"
SMALLEST = 1e-7  # least deviation that is shown
SWITCHED = ("all", *(name for name, cause in CAUSES.items() if cause.label and name != "all"))


def _draw(study: Study) -> Figure:
    tabors = study.panel_tabors
    figure, panels = style.panels(max(len(tabors), 2), height=6.4)
    for axes, tabor in zip(panels, tabors, strict=False):
        for cause in SWITCHED:
            _cause(axes, study, cause, tabor)
        axes.set_title(rf"$\mu = {tabor:g}$")
        _theories(axes, tabor)
    finish(figure, panels[: len(tabors)])
    for axes in panels[len(tabors) :]:
        axes.set_axis_off()
    return figure


def finish(figure: Figure, panels: Sequence[Any], columns: int = 3) -> None:
    """Label the panels, give them one ordinate that holds all lines, and put one legend below them."""
    sizes = np.concatenate([np.empty(0), *(line.get_ydata() for axes in panels for line in axes.lines)])
    sizes = sizes[np.isfinite(sizes) & (sizes > 0)]
    for axes in panels:
        axes.set(xscale="log", yscale="log")
        style.dress(axes, STRETCH, SIZE if axes is panels[0] else "", legend=None)
        _plain(axes.xaxis)
        if sizes.size:
            axes.set_ylim(max(sizes.min() / 1.6, SMALLEST), max(sizes.max(), SMALLEST) * 1.6)
    style.legend_below(figure, panels, columns)


def _plain(axis: Any, write: str | Callable[[float, int], str] = "{x:g}") -> None:
    """Plain numbers at 1, 2 and 5 of each decade of a logarithmic axis, and none between."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(write)
    axis.set_minor_formatter("")


def _cause(axes: Any, study: Study, cause: str, tabor: float) -> None:
    data, how = study.samples(cause, "pull_off_load", tabor=tabor), CAUSES[cause]
    colour = getattr(style, how.colour, how.colour)
    size = 8.0 if cause == "all" else 5.5  # the whole shows round its largest part
    signed(axes, data, color=colour, marker=how.marker, markersize=size, label=how.label)
    try:
        found = fit(data, terms := leading_terms(cause, "pull_off_load", one_tabor=True))
    except InputError:
        return  # too few points for a line through them: the table says so
    x = np.geomspace(data.stretch.min(), found.holds_to, 200)
    parts = [c.value * terms[name](np.full_like(x, tabor), tabor / x**2) for name, c in found.coefficients.items()]
    axes.plot(x, np.abs(np.sum(parts, axis=0)), color=colour, linewidth=1.0)


def signed(axes: Any, data: Samples, **look: Any) -> None:
    """Sizes of deviations that exceed their errors: filled markers where negative, hollow where positive."""
    known = significant(data)
    for sign, face in ((-1, look["color"]), (1, "white")):
        chosen = known[np.sign(known.deviation) == sign]
        if chosen.size:
            x, y = chosen.stretch, np.abs(chosen.deviation)
            axes.plot(x, y, **{"markersize": 5.5, **look}, linestyle="none", markerfacecolor=face)
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


def _caption(study: Study) -> Iterator[str]:
    """Which part is the larger on the smallest and on the largest sphere, and what grip, strain and area change."""
    yield said("finite_sphere", "causes")
    for tabor in study.panel_tabors:
        found = {c: significant(study.samples(c, "pull_off_load", tabor=tabor)) for c in ("profile", "body")}
        both = np.intersect1d(found["profile"].radius_ratio, found["body"].radius_ratio)
        ends = []
        for ratio in np.unique(both[[0, -1]]) if both.size else ():
            sizes = {c: abs(data.deviation[data.radius_ratio == ratio][0]) for c, data in found.items()}
            most = max(sizes, key=sizes.__getitem__)
            ends.append(f"the {most}'s at R/eps = {ratio:g} ({100 * sizes[most]:.2g} %)")
        if ends:
            yield f"At mu = {tabor:g} the larger part is {', and '.join(ends)}."
    changes = (("grip",), "all"), (("strain",), "all"), (("reference", "normal"), "all"), (("traction",), "profile")
    for (causes, whole), name in zip(changes, ("grip", "strain", "uncertain", "traction"), strict=True):
        *parts, larger = (significant(study.samples(cause, "pull_off_load")) for cause in (*causes, whole))
        shares = 100 * np.concatenate([_over(part, part.deviation, larger) for part in parts])
        if shares.size:
            shown = span(shares if name == "traction" else np.abs(shares))
            yield said("finite_sphere", "causes", name, span=shown, points=counted(shares.size, "point"))


def _over(points: Samples, values: Array, whole: Samples) -> Array:
    """Values at points over the deviation there of a whole, where it has one."""
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), whole.deviation, strict=True))
    each = zip(points.tabor, points.radius_ratio, values, strict=True)
    return np.array([value / sizes[mu, rho] for mu, rho, value in each if (mu, rho) in sizes], float)


LOOKS = tuple(zip((style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PINK, style.SKY), "os^DvP", strict=True))
DASHES = ("-", style.DASHED, style.DOTTED)  # one after the other when colours and markers come again


def _figure_poisson(study: Study) -> Figure:
    figure, panels = style.panels(2, height=6.4)
    for axes, quantity in zip(panels, DRAWN, strict=True):
        for number, (tabor, ratio) in enumerate(study.points_by_poisson):
            data = samples(study.rows, "all", quantity, tabor=tabor, radius_ratio=ratio)
            if data.size:
                order = np.argsort(data.poisson)
                nu, y = data.poisson[order], data.deviation[order]
                colour, marker = LOOKS[number % 6]
                look = {"color": colour, "marker": marker, "markersize": 5.5, "linewidth": 1.2}
                look["linestyle"] = DASHES[number // 6 % len(DASHES)]
                axes.plot(nu, np.abs(y), label=rf"$\mu = {tabor:g}$, $R/\epsilon = {ratio:g}$", **look)
                axes.plot(nu[y > 0], np.abs(y[y > 0]), **look | {"linestyle": "none", "markerfacecolor": "white"})
        axes.set(title=SHOWN[quantity], yscale="log")
        _plain(axes.yaxis, lambda y, _: f"{100 * y:g} %")
        style.dress(axes, r"Poisson's ratio $\nu$", SIZE, legend=None)
    style.legend_below(figure, panels, columns=3)
    return figure


def _figure_bulk(study: Study) -> Figure:
    """Deviations of approaches at up to four Tabor parameters joined by lines, with markers where they are certain."""
    figure, panels = style.panels(2, height=6.4)
    for axes, way in zip(panels, ("on", "off"), strict=True):
        for (colour, marker), tabor in zip(LOOKS, study.jumping_tabors[:4], strict=False):
            for suffix, how, dashes in (("", "raw", "-"), ("_less_bulk", "without bulk compression", style.DASHED)):
                data = study.samples("all", f"jump_{way}_approach{suffix}", tabor=tabor)
                if data.size:
                    look, order = {"color": colour, "linestyle": dashes, "linewidth": 1.1}, np.argsort(data.stretch)
                    axes.plot(data.stretch[order], np.abs(data.deviation[order]), **look)
                    signed(axes, data, color=colour, marker=marker)
                    axes.plot([], [], marker=marker, label=rf"$\mu = {tabor:g}$, {how}", **look)
        axes.set_title(f"approach at jump-{way}")
    finish(figure, panels, columns=4)
    return figure


def _see_bulk(study: Study) -> Iterator[str]:
    """What the figure shows, and how much of the deviation, at most, is left without the yield."""
    yield said("finite_sphere", "bulk_figure")
    left = []
    for quantity in ("jump_on_approach", "jump_off_approach"):
        whole, rest = (study.samples("all", quantity + suffix) for suffix in ("", "_less_bulk"))
        left.append(np.abs(_over(rest, np.abs(rest.deviation) + rest.error, significant(whole))))
    shares = np.concatenate(left)
    if study.jumping_tabors and shares.size:
        most = int(np.sum(shares < 0.5))
        numbers = {"span": span(100 * shares), "points": counted(shares.size, "point")}
        yield said("finite_sphere", "bulk_figure", "left", **numbers, most=most if most < shares.size else "all")


FIGURES = (
    Picture("causes", said("finite_sphere", "causes", "title"), _draw, _caption, no_sphere),
    Picture(
        "poisson",
        said("finite_sphere", "poisson", "title"),
        _figure_poisson,
        lambda _: [said("finite_sphere", "poisson")],
        lambda study: "" if study.points_by_poisson else "no point was solved at two Poisson's ratios",
    ),
    Picture(
        "bulk",
        said("finite_sphere", "bulk_figure", "title"),
        _figure_bulk,
        _see_bulk,
        lambda study: "" if study.jumping_tabors else "no Tabor parameter jumps on spheres of two sizes",
    ),
)
