"""Jumping on, pull-off, and apparatus: figures after [G97] 6a to 7 and one beyond, with what is to be seen in them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import digits, listed, plus_minus, told
from fem_adhesion.common.style import dress, note, panels, plain_ticks
from fem_adhesion.greenwood import drawing
from fem_adhesion.greenwood.criteria import Criterion, words_on
from fem_adhesion.greenwood.drawing import rises
from fem_adhesion.greenwood.numerics_1997 import Ripple
from fem_adhesion.greenwood.study import RIPPLE_AT, Greenwood1997
from halfspace.equilibrium.devices import Cycle
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
STIFFNESS_STYLES = {np.inf: (style.RED, "-"), 3.0: (style.GREEN, style.DASHED), 1.0: (style.ORANGE, style.CHAIN)}
TABOR = r"Tabor parameter $\mu$"
STEADY = 5.0  # Tabor parameter from which the scaled gap at jump-on is looked at for being constant
CONSTANT = 0.01  # relative spread below which it is called so


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


def _see_6b(study: Greenwood1997) -> Iterator[str]:
    """Whether the gap at jump-on goes as mu^(3/7)."""
    jumps = study.criteria
    scaled = (jumps.central_gap + 1) / jumps.tabor ** (3 / 7)
    steady, below = scaled[jumps.tabor >= STEADY], scaled[jumps.tabor < STEADY]
    spread = float(np.ptp(steady) / steady.mean()) if steady.size > 1 else math.nan
    power = f"the power 3/7 of the criteria {'holds' if spread < CONSTANT else 'does not hold'}"
    falls = "falls" if below.size and below[0] < steady.min(initial=np.inf) else "does not fall"
    yield told(f"From mu = {STEADY:g} on the scaled gap varies by {100 * spread:.2g} %: {power} there.", spread)
    if below.size:
        yield told(f"Below it {falls}, to {below[0]:.3f} at mu = {jumps.tabor[0]:.3g}.", scaled)


def _figure_7(study: Greenwood1997) -> Figure:
    figure, (trend, ripple) = panels(2, height=6.6)
    tabor = np.array([p.tabor for p in study.pull_offs])
    force = [-p.half_space.value for p in study.pull_offs]
    trend.semilogx(tabor, force, color=style.BLUE, linewidth=2, marker=".", label="half-space")
    elements = [(p.tabor, -p.finite_element.value) for p in study.pull_offs if p.finite_element]
    trend.semilogx(*np.reshape(elements, (-1, 2)).T, color=style.BLUE, label="finite elements", **drawing.ELEMENTS)
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


def _spacing(axes: Any, spacing: float, x: Sequence[float] | Array, y: Sequence[float] | Array) -> None:
    colour, dashes = SPACING_STYLES[spacing]
    label = rf"uniform triangles, ${spacing:g}\,\beta$"
    axes.plot(x, y, color=colour, linestyle=dashes, linewidth=1.4, zorder=3, label=label)


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
    dress(axes, drawing.APPROACH, drawing.LOAD, legend="below", columns=2, xlim=(-3.2, 1.2), ylim=(-6.3, -2.6))
    axes.set_title(rf"through pull-off at $\mu = {RIPPLE_AT:g}$")


def _see_7(study: Greenwood1997) -> Iterator[str]:
    """The true trend, what finite elements say of it, and where coarse grids turn upwards."""
    forces = np.array([-p.half_space.value for p in study.pull_offs])
    trend = "falls" if rises(-forces) else "does not fall"
    ends = f"from {forces[0]:.4f} to {forces[-1]:.4f} R dgamma" if forces.size else ""
    range_ = f"mu = {study.pull_offs[0].tabor:.3g} to {study.pull_offs[-1].tabor:.3g}" if forces.size else ""
    yield told(f"The true force {trend} all along, {ends} at {range_}.", forces)
    if both := [p.agree for p in study.pull_offs if p.finite_element]:
        yield f"Finite elements agree within both errors at {sum(both)} of {len(both)} Tabor parameters."
    for spacing, rise in study.rises.items():
        yield _turn(spacing, rise.ripples)


def _turn(spacing: float, ripples: Sequence[Ripple]) -> str:
    """Where the pull-off force on one spacing turns upwards."""
    forces = np.array([-r.pull_off for r in ripples])
    if forces.size < 2 or not np.all(np.isfinite(forces)):
        return ""
    if forces[-1] <= forces.min():
        return f"On uniform triangles of {spacing:g} beta it does not rise up to mu = {ripples[-1].tabor:.3g}."
    return f"On uniform triangles of {spacing:g} beta it rises from mu = {ripples[int(forces.argmin())].tabor:.3g} on."


def _figure_8(study: Greenwood1997) -> Figure:
    figure, (jumps, border) = panels(2)
    devices = study.devices
    path = study.curves[devices.tabor]
    drawing.branches(jumps, path, "approach", "load")
    for cycle in devices.cycles:
        if cycle.stiffness in STIFFNESS_STYLES:
            _arrows(jumps, cycle)
    drawing.stability_key(jumps)
    dress(jumps, drawing.APPROACH, drawing.LOAD, legend="below", xlim=(-8, 3), ylim=(-5.6, 0.5))
    jumps.set_title(rf"jumps at $\mu = {devices.tabor:g}$")
    _border(border, study)
    return figure


def _arrows(axes: Any, cycle: Cycle) -> None:
    """Both jumps along their load lines."""
    colour, dashes = STIFFNESS_STYLES[cycle.stiffness]
    look: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": 1.7}
    for jump in (cycle.jump_on, cycle.jump_off):
        tail, head = ((state.approach, state.load) for state in jump.ends)
        style.arrow(axes, tail, head, **look)
    name = "fixed grips" if np.isinf(cycle.stiffness) else rf"$k = {cycle.stiffness:g}\,R\Delta\gamma/\epsilon$"
    axes.plot([], [], label=name, **look)


def _border(axes: Any, study: Greenwood1997) -> None:
    """Stiffness below which a contact jumps, against the Tabor parameter."""
    tabor, stiffness = study.devices.border.T
    axes.semilogy(tabor, stiffness, color=style.BLUE, linewidth=2)
    axes.axvline(study.critical_tabor.value, color="0.5", linewidth=0.9)
    note(axes, "follows smoothly", (0.15, 60))
    note(axes, "jumps", (0.35, 2.2))
    note(axes, rf"fixed grips jump from $\mu = {digits(study.critical_tabor)}$", (0.22, 550))
    if stiffness.size and np.isfinite(stiffness[0]):
        axes.axhline(stiffness[0], color="0.5", linewidth=0.9)
        note(axes, rf"{stiffness[0]:.4g} at $\mu = {tabor[0]:.1g}$", (0.45, stiffness[0]), (0, -14))
    dress(axes, r"Tabor parameter $\mu$", r"stiffness $k\,\epsilon/R\Delta\gamma$", legend=None, ylim=(1, 1000))
    plain_ticks(axes.yaxis, (1, 3, 10, 30, 100, 300, 1000))
    axes.set_title("where an apparatus makes the contact jump")


def _see_8(study: Greenwood1997) -> Iterator[str]:
    """What a softer apparatus does, and from what stiffness a contact jumps."""
    cycles = study.devices.cycles
    lost = np.array([c.energy_lost.value for c in cycles])
    away = np.array([-c.jump_on.take_off.approach for c in cycles])
    pull = np.array([-c.jump_off.take_off.load for c in cycles])
    words = [
        "jumps on from farther away" if rises(away) else "does not always jump on from farther away",
        "jumps off at a larger pull" if rises(pull) else "does not always jump off at a larger pull",
        "loses more" if rises(lost) else "does not always lose more",
    ]
    critical = study.critical_tabor
    yield told(f"At mu = {study.devices.tabor:g} a softer apparatus {listed(words)}.", lost, away, pull)
    yield _follows(study.devices.border)
    yield told(f"Fixed grips jump from mu = {plus_minus(critical)} on.", critical.value, critical.error)


def _follows(border: Array) -> str:
    if not border.size:
        return ""
    tabor, stiffness = border.T
    grows = "grows" if rises(stiffness) else "does not grow all along"
    text = (
        f"The stiffness below which a contact jumps is {stiffness[0]:.4g} R dgamma/eps at mu = {tabor[0]:.2g} and "
        f"{grows} with mu, to {stiffness[-1]:.3g} at mu = {tabor[-1]:.4g}."
    )
    return told(text, border)


FIGURES = (
    (
        "6a",
        "Central gap and approach at jump-on, with the criteria",
        _figure_6a,
        lambda study: words_on(study.criteria),
    ),
    ("6b", "Central gap at jump-on, scaled by mu^(3/7)", _figure_6b, _see_6b),
    ("7", "Pull-off force against the Tabor parameter, and on coarse grids", _figure_7, _see_7),
    ("8", "Jumps of an apparatus of finite stiffness, and where they begin", _figure_8, _see_8),
)
