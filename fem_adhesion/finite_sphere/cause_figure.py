"""The deviations of the finite sphere by cause: a figure, and what is seen in it, each sentence found by a test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from fem_adhesion.common import style
from fem_adhesion.common.style import Picture
from fem_adhesion.common.words import at_points, span
from fem_adhesion.finite_sphere.chart_figure import no_sphere
from fem_adhesion.finite_sphere.fit import RIGID_PULL_OFF, SOFT_PULL_OFF, fit, leading_terms
from fem_adhesion.finite_sphere.points import Samples, panel_tabors, reference_poisson, samples
from fem_adhesion.finite_sphere.table import DeviationRow, Results
from halfspace.errors import InputError
from halfspace.values import Array

STRETCH = r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
SIZE = "|relative deviation from the half-space|"
SMALLEST = 1e-7  # deviation that is shown
WHOLE, PART = 8.0, 5.5  # sizes of markers: that of the whole shows round that of its largest part
PARTS = ("profile", "body")
"""Causes of which the whole deviation is made; the others change what is held fixed in it."""

CAUSES: Mapping[str, tuple[str, str, str]] = {
    "all": ("black", "o", "all: elastic sphere, sliding mid-plane"),
    "profile": (style.BLUE, "s", "profile: sphere for paraboloid"),
    "body": (style.RED, "^", "body: hemisphere for half-space"),
    "grip": (style.GREEN, "D", "grip: bonded for sliding"),
    "traction": (style.PINK, "v", "traction: true for projected area"),
    "strain": (style.ORANGE, "P", "strain: neo-Hookean for linear"),
}


def _draw(results: Results) -> Figure:
    rows = results.rows
    tabors, poisson = panel_tabors(rows), reference_poisson(rows)
    figure, panels = style.panels(max(len(tabors), 2), height=6.4)
    for axes, tabor in zip(panels, tabors, strict=False):
        for cause in CAUSES:
            _cause(axes, rows, cause, tabor, poisson)
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


def _plain(axis: Any) -> None:
    """Plain numbers at 1, 2 and 5 of each decade of a logarithmic axis, and none between."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def _cause(axes: Any, rows: Sequence[DeviationRow], cause: str, tabor: float, poisson: float | None) -> None:
    data = samples(rows, cause, "pull_off_load", None if cause == "profile" else poisson)
    data = data.where(data.tabor == tabor)
    colour, marker, label = CAUSES[cause]
    size = WHOLE if cause == "all" else PART
    signed(axes, data, color=colour, marker=marker, markersize=size, label=label)
    try:
        found = fit(data, terms := leading_terms(cause, "pull_off_load", one_tabor=True))
    except InputError:
        return  # too few points for a line through them: the table says so
    x = np.geomspace(data.stretch.min(), found.holds_to, 200)
    parts = [c.value * terms[name](np.full_like(x, tabor), tabor / x**2) for name, c in found.coefficients.items()]
    axes.plot(x, np.abs(np.sum(parts, axis=0)), color=colour, linewidth=1.0)


def signed(axes: Any, data: Samples, **look: Any) -> None:
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


def _caption(results: Results) -> Iterator[str]:
    rows, poisson = results.rows, reference_poisson(results.rows)
    yield "Filled markers: the force is weakened; hollow: strengthened; only what exceeds its error has one."
    for tabor in panel_tabors(rows):
        found = {cause: _of(rows, cause, tabor, poisson) for cause in PARTS}
        yield from _largest(found, tabor)
    yield from _exponents(rows, poisson)
    yield from _changes(rows, poisson)
    yield from _given_back(rows, poisson)


def _of(rows: Sequence[DeviationRow], cause: str, tabor: float, poisson: float | None) -> Samples:
    data = samples(rows, cause, "pull_off_load", None if cause == "profile" else poisson).significant
    return data.where(data.tabor == tabor)


def _largest(found: Mapping[str, Samples], tabor: float) -> Iterator[str]:
    """Which part is the larger on the smallest and on the largest sphere on which profile and body are both known."""
    both = np.intersect1d(found["profile"].radius_ratio, found["body"].radius_ratio)
    ends = []
    for ratio in dict.fromkeys(float(value) for value in both[[0, -1]]) if both.size else ():
        sizes = {cause: _size_at(data, ratio) for cause, data in found.items()}
        known = {cause: size for cause, size in sizes.items() if np.isfinite(size)}
        most = max(known, key=lambda cause: known[cause])
        ends.append(f"the {most}'s at R/eps = {ratio:g} ({100 * known[most]:.2g} %)")
    if ends:
        yield f"At mu = {tabor:g} the larger part is {', and '.join(ends)}."


def _size_at(data: Samples, ratio: float) -> float:
    size = np.abs(data.deviation[data.radius_ratio == ratio])
    return float(size[0]) if size.size else float("nan")


def _exponents(rows: Sequence[DeviationRow], poisson: float | None) -> Iterator[str]:
    """Powers of beta/R in which profile and body go between the two largest spheres, of the middle panel."""
    for tabor in panel_tabors(rows)[1:2]:
        found = {cause: _of(rows, cause, tabor, poisson) for cause in ("profile", "body")}
        powers = [f"the {cause}'s as (beta/R)^{_power(data):.2g}" for cause, data in found.items() if _two(data)]
        if powers:
            yield f"Between the two largest R/eps at mu = {tabor:g} the parts go: {', '.join(powers)}."


def _two(data: Samples) -> bool:
    return bool(data.stretch.size > 1)


def _power(data: Samples) -> float:
    order = np.argsort(data.stretch)[:2]
    x, y = np.log(data.stretch[order]), np.log(np.abs(data.deviation[order]))
    return float((y[1] - y[0]) / (x[1] - x[0]))


def _changes(rows: Sequence[DeviationRow], poisson: float | None) -> Iterator[str]:
    """What grip and strain change beside the whole."""
    whole = samples(rows, "all", "pull_off_load", poisson)
    for cause, name in (("grip", "The grip"), ("strain", "Finite strain")):
        shares = np.abs(_ratios(samples(rows, cause, "pull_off_load", poisson), whole))
        if shares.size:
            yield f"{name} changes the force by {span(100 * shares)} % of the whole deviation{at_points(shares.size)}."
    others = [_ratios(samples(rows, cause, "pull_off_load", poisson), whole) for cause in ("reference", "normal")]
    spread = np.abs(np.concatenate(others))
    if spread.size:
        yield (
            f"What its traction is counted per, a model uncertainty, leaves {span(100 * spread)} % of it "
            f"open{at_points(spread.size)}."
        )


def _given_back(rows: Sequence[DeviationRow], poisson: float | None) -> Iterator[str]:
    """Whether the law per true area undoes what the profile does."""
    shares = _ratios(
        samples(rows, "traction", "pull_off_load", poisson), samples(rows, "profile", "pull_off_load", None)
    )
    if not shares.size:
        return
    where = at_points(shares.size)
    if np.all(shares < 0):
        yield f"The law per true area gives back {span(-100 * shares)} % of what the profile takes{where}."
    elif np.all(shares > 0):
        yield f"The law per true area adds {span(100 * shares)} % to what the profile does{where}."
    else:
        yield f"The law per true area works against the profile at {np.sum(shares < 0)} of {shares.size} points."


def _ratios(part: Samples, whole: Samples) -> Array:
    """A deviation over another, where both exceed their errors."""
    part, whole = part.significant, whole.significant
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), whole.deviation, strict=True))
    points = zip(part.tabor, part.radius_ratio, part.deviation, strict=True)
    return np.array([value / sizes[mu, rho] for mu, rho, value in points if (mu, rho) in sizes], float)


CAUSES_FIGURE = Picture(
    "causes", "What makes the pull-off force deviate", _draw, lambda results: " ".join(_caption(results)), no_sphere
)
