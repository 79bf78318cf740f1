"""The deviations of the finite sphere by cause, by Poisson's ratio, and without the body's yield: figures and captions.

Each sentence of a caption is found by a test of the numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from fem_adhesion.common import style
from fem_adhesion.common.numbers import counted, span
from fem_adhesion.common.style import Picture
from fem_adhesion.finite_sphere.chart import no_sphere
from fem_adhesion.finite_sphere.fit import RIGID_PULL_OFF, SOFT_PULL_OFF, fit, leading_terms
from fem_adhesion.finite_sphere.table import (
    DeviationRow,
    Results,
    Samples,
    by_poisson,
    jumping_tabors,
    panel_tabors,
    points_by_poisson,
    reference_poisson,
    samples,
)
from halfspace.errors import InputError
from halfspace.values import Array

STRETCH = r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
SIZE = "|relative deviation from the half-space|"
SMALLEST = 1e-7  # deviation that is shown
WHOLE, PART = 8.0, 5.5  # sizes of markers: that of the whole shows round that of its largest part
PARTS = ("profile", "body")  # causes of which the whole deviation is made; the others change what is held fixed in it
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


def _plain(axis: Any, write: Callable[[float], str] = "{:g}".format) -> None:
    """Plain numbers at 1, 2 and 5 of each decade of a logarithmic axis, and none between."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda x, _: write(x)))
    axis.set_minor_formatter(NullFormatter())


def _cause(axes: Any, rows: Sequence[DeviationRow], cause: str, tabor: float, poisson: float | None) -> None:
    data = _pull_off(rows, cause, poisson, tabor=tabor)
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
        found = {cause: _pull_off(rows, cause, poisson, tabor=tabor).significant for cause in PARTS}
        yield from _largest(found, tabor)
    yield from _exponents(rows, poisson)
    yield from _changes(rows, poisson)
    yield from _given_back(rows, poisson)


def _pull_off(rows: Sequence[DeviationRow], cause: str, poisson: float | None, **at: float) -> Samples:
    """Deviations of the pull-off, those by the profile whatever Poisson's ratio."""
    return samples(rows, cause, "pull_off_load", poisson=None if cause == "profile" else poisson, **at)


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
        found = {cause: _pull_off(rows, cause, poisson, tabor=tabor).significant for cause in PARTS}
        powers = [
            f"the {cause}'s as (beta/R)^{_power(data):.2g}" for cause, data in found.items() if data.stretch.size > 1
        ]
        if powers:
            yield f"Between the two largest R/eps at mu = {tabor:g} the parts go: {', '.join(powers)}."


def _power(data: Samples) -> float:
    order = np.argsort(data.stretch)[:2]
    x, y = np.log(data.stretch[order]), np.log(np.abs(data.deviation[order]))
    return float((y[1] - y[0]) / (x[1] - x[0]))


def _changes(rows: Sequence[DeviationRow], poisson: float | None) -> Iterator[str]:
    """What grip and strain change beside the whole."""
    whole = _pull_off(rows, "all", poisson)
    for cause, name in (("grip", "The grip"), ("strain", "Finite strain")):
        shares = np.abs(_ratios(_pull_off(rows, cause, poisson), whole))
        if shares.size:
            yield f"{name} changes the force by {span(100 * shares)} % of the whole deviation{_at_points(shares.size)}."
    others = [_ratios(_pull_off(rows, cause, poisson), whole) for cause in ("reference", "normal")]
    spread = np.abs(np.concatenate(others))
    if spread.size:
        yield (
            f"What its traction is counted per, a model uncertainty, leaves {span(100 * spread)} % of it "
            f"open{_at_points(spread.size)}."
        )


def _given_back(rows: Sequence[DeviationRow], poisson: float | None) -> Iterator[str]:
    """Whether the law per true area undoes what the profile does."""
    shares = _ratios(_pull_off(rows, "traction", poisson), _pull_off(rows, "profile", poisson))
    if not shares.size:
        return
    where = _at_points(shares.size)
    if np.all(shares < 0):
        yield f"The law per true area gives back {span(-100 * shares)} % of what the profile takes{where}."
    elif np.all(shares > 0):
        yield f"The law per true area adds {span(100 * shares)} % to what the profile does{where}."
    else:
        yield f"The law per true area works against the profile at {np.sum(shares < 0)} of {shares.size} points."


def _at_points(count: int) -> str:
    """At how many points something was found."""
    return f" ({counted(count, 'point')})"


def _ratios(part: Samples, whole: Samples) -> Array:
    """A deviation over another, where both exceed their errors."""
    part = part.significant
    return _over(part, part.deviation, whole.significant)


def _over(points: Samples, values: Array, whole: Samples) -> Array:
    """Values at points over the deviation there of a whole, where it has one."""
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), whole.deviation, strict=True))
    each = zip(points.tabor, points.radius_ratio, values, strict=True)
    return np.array([value / sizes[mu, rho] for mu, rho, value in each if (mu, rho) in sizes], float)


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
        _plain(axes.yaxis, lambda y: f"{100 * y:g} %")
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
                data = samples(rows, "all", quantity + suffix, poisson=reference_poisson(rows), tabor=tabor)
                _line(axes, data, number, dashes, rf"$\mu = {tabor:g}$, {how}")
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
        f"Without it {span(100 * shares)} % of the deviation is left{_at_points(shares.size)}: the yield is most of it "
        f"at {most if most < shares.size else 'all'} of them."
    )


def _left(rows: Sequence[DeviationRow], quantity: str, poisson: float | None) -> Array:
    """Part of an approach's deviation, at most, that is left without the yield, where the whole exceeds its error."""
    whole, rest = (samples(rows, "all", quantity + suffix, poisson=poisson) for suffix in ("", "_less_bulk"))
    return np.abs(_over(rest, np.abs(rest.deviation) + rest.error, whole.significant))


def _no_poissons(results: Results) -> str:
    return "" if points_by_poisson(results.rows) else "no point was solved at two Poisson's ratios"


def _no_jumps(results: Results) -> str:
    return "" if jumping_tabors(results.rows) else "no Tabor parameter jumps on spheres of two sizes"


WITHOUT_YIELD = "The approach at the jumps, raw and without the body's linear yield"
FIGURES = (
    Picture("causes", "What makes the pull-off force deviate", _draw, _caption, no_sphere),
    Picture("poisson", "How the deviations depend on Poisson's ratio", _figure_poisson, _see_poisson, _no_poissons),
    Picture("bulk", WITHOUT_YIELD, _figure_bulk, _see_bulk, _no_jumps),
)
