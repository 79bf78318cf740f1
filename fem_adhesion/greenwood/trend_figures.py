"""Jumping on and pull-off against the Tabor parameter: figures after [G97] 6a to 7."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.style import dress, panels, plain_ticks
from fem_adhesion.greenwood import trend_captions as captions
from fem_adhesion.greenwood.criteria import Criterion
from fem_adhesion.greenwood.plot import Plot
from fem_adhesion.greenwood.study import RIPPLE_AT, Greenwood1997, PullOff
from halfspace.scaling import MAUGIS
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.theories.maugis import MaugisDugdale, carpick_pull_off
from halfspace.values import Array

TRUE: dict[str, Any] = {"color": "black", "linestyle": "none", "marker": "o", "markersize": 5, "label": "true jump"}
CRITERIA_STYLES: dict[str, tuple[str, Any]] = {
    "Attard & Parker": (style.RED, style.DASHED),
    "Pethica & Sutton": (style.ORANGE, style.CHAIN),
    "App. C": (style.PINK, style.LONG),
    "fit (4.5)": (style.BLUE, "-"),
    "fit of App. C": (style.GREEN, "-"),
}
SPACING_STYLES: dict[float, tuple[str, Any]] = {
    0.2: (style.RED, style.CHAIN),
    0.1: (style.ORANGE, style.DASHED),
    0.05: (style.PINK, style.LONG),
    0.025: (style.SKY, "-"),
}
TABOR = r"Tabor parameter $\mu$"


def _figure_6a(study: Greenwood1997) -> Figure:
    figure, (gap, approach) = panels(2)
    jumps = study.criteria
    gap.loglog(jumps.tabor, jumps.central_gap + 1, **TRUE)
    approach.loglog(jumps.tabor, 1 - jumps.approach, **TRUE)
    for criterion in jumps.criteria:
        _criterion(approach if criterion.of_approach else gap, criterion, _tabors(study))
    plain_ticks(gap.yaxis, (1.5, 2, 3, 5, 7, 10, 15))
    plain_ticks(approach.yaxis, (2, 3, 5, 7, 10, 15, 20))
    dress(gap, TABOR, r"central gap at the jump, $H_0 + 1$")
    dress(approach, TABOR, r"approach at the jump, $|\alpha^*| + 1$")
    return figure


def _tabors(study: Greenwood1997) -> Array:
    return np.geomspace(0.72, max(study.criteria.tabor, default=1.0), 300)


def _criterion(axes: Any, criterion: Criterion, tabor: Array, power: float = 0.0) -> None:
    """What a criterion predicts, over mu^power."""
    if criterion.predict is None:
        return
    colour, dashes = CRITERIA_STYLES[criterion.name]
    sign = -1 if criterion.of_approach else 1
    predicted = (1 + sign * criterion.predict(tabor)) / tabor**power
    axes.plot(tabor, predicted, color=colour, linestyle=dashes, label=criterion.name)


def _figure_6b(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels()
    jumps = study.criteria
    axes.semilogx(jumps.tabor, (jumps.central_gap + 1) / jumps.tabor ** (3 / 7), **TRUE)
    for criterion in jumps.criteria:
        if not criterion.of_approach:
            _criterion(axes, criterion, _tabors(study), 3 / 7)
    dress(axes, TABOR, r"$(H_0 + 1)/\mu^{3/7}$", legend="lower right", ylim=(1.2, 2.35))
    return figure


def _figure_7(study: Greenwood1997) -> Figure:
    figure, (trend, ripple) = panels(2, height=6.6)
    tabor = np.array([p.tabor for p in study.pull_offs])
    trend.semilogx(
        tabor,
        [-p.half_space.value for p in study.pull_offs],
        color=style.BLUE,
        linewidth=2,
        marker=".",
        label="half-space",
    )
    _elements(trend, [p for p in study.pull_offs if p.finite_element])
    maugis = [-MaugisDugdale.matched(mu).pull_off().load for mu in tabor]
    trend.semilogx(tabor, maugis, color=style.GREEN, linestyle=style.CHAIN, label="Maugis-Dugdale")
    carpick = -carpick_pull_off(MAUGIS.of(tabor))
    trend.semilogx(tabor, carpick, color="0.35", linestyle=style.DOTTED, label="Carpick et al.")
    for spacing, rise in study.rises.items():
        _spacing(trend, spacing, [r.tabor for r in rise.ripples], [-r.pull_off for r in rise.ripples])
    if tabor.size:
        _limits(trend, float(tabor[0]), float(tabor[-1]))
    dress(trend, TABOR, r"pull-off force $-W_\mathrm{min}/R\Delta\gamma$", legend="below", columns=2, ylim=(4.5, 6.5))
    _ripples(ripple, study)
    return figure


def _elements(axes: Any, pull_offs: Sequence[PullOff]) -> None:
    tabor = [p.tabor for p in pull_offs]
    force = [-p.finite_element.value for p in pull_offs if p.finite_element]
    axes.semilogx(tabor, force, color=style.BLUE, label="finite elements", **style.ELEMENTS)


def _spacing(axes: Any, spacing: float, x: Sequence[float] | Array, y: Sequence[float] | Array) -> None:
    colour, dashes = SPACING_STYLES[spacing]
    axes.plot(
        x, y, color=colour, linestyle=dashes, linewidth=1.4, zorder=3, label=rf"uniform triangles, ${spacing:g}\,\beta$"
    )


def _limits(axes: Any, left: float, right: float) -> None:
    """Limits of a rigid and of a soft sphere, named where the curve is far from them."""
    for value in (-BRADLEY_PULL_OFF, -JKR_PULL_OFF):
        axes.axhline(value, color="0.5", linewidth=0.9)
    axes.text(right, -BRADLEY_PULL_OFF + 0.03, r"Bradley, $2\pi$", ha="right", color="0.3", fontsize=10)
    axes.text(left, -JKR_PULL_OFF + 0.03, r"JKR, $3\pi/2$", color="0.3", fontsize=10)


def _ripples(axes: Any, study: Greenwood1997) -> None:
    path = study.curves[RIPPLE_AT]
    for r in study.ripples:
        _spacing(axes, r.spacing, r.approach, r.load)
    axes.plot(path.approach, path.load, color=style.BLUE, linewidth=2, label="half-space, resolved")
    dress(axes, style.APPROACH, style.LOAD, legend="below", columns=2, xlim=(-3.2, 1.2), ylim=(-6.3, -2.6))
    axes.set_title(rf"through pull-off at $\mu = {RIPPLE_AT:g}$")


TREND_PLOTS = (
    Plot(
        "6a",
        "Central gap and approach at jump-on, with the criteria",
        captions.figure_6a,
        _figure_6a,
    ),
    Plot(
        "6b",
        "Central gap at jump-on, scaled by mu^(3/7)",
        captions.figure_6b,
        _figure_6b,
    ),
    Plot(
        "7",
        "Pull-off force against the Tabor parameter, and on coarse grids",
        captions.figure_7,
        _figure_7,
    ),
)
