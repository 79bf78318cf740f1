"""Apparatus of any stiffness: a figure beyond the paper's."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import digits
from fem_adhesion.common.style import dress, note, panels, plain_ticks
from fem_adhesion.greenwood import trend_captions as captions
from fem_adhesion.greenwood.plot import Plot
from fem_adhesion.greenwood.study import Greenwood1997
from halfspace.equilibrium.devices import Cycle, Jump

SHOWN = {np.inf: (style.RED, "-"), 3.0: (style.GREEN, style.DASHED), 1.0: (style.ORANGE, style.CHAIN)}


def _figure_8(study: Greenwood1997) -> Figure:
    figure, (jumps, border) = panels(2)
    devices = study.devices
    path = study.curves[devices.tabor]
    style.branches(jumps, path, path.approach, path.load)
    for cycle in devices.cycles:
        if cycle.stiffness in SHOWN:
            _arrows(jumps, cycle)
    style.stability_key(jumps)
    dress(jumps, style.APPROACH, style.LOAD, legend="below", xlim=(-8, 3), ylim=(-5.6, 0.5))
    jumps.set_title(rf"jumps at $\mu = {devices.tabor:g}$")
    _border(border, study)
    return figure


def _arrows(axes: Any, cycle: Cycle) -> None:
    """Both jumps along their load lines."""
    colour, dashes = SHOWN[cycle.stiffness]
    for jump in (cycle.jump_on, cycle.jump_off):
        tail, head = _ends(jump)
        arrow = {
            "arrowstyle": "-|>",
            "color": colour,
            "linestyle": dashes,
            "linewidth": 1.7,
            "shrinkA": 0,
            "shrinkB": 0,
        }
        axes.annotate("", head, tail, arrowprops=arrow)
    name = "fixed grips" if np.isinf(cycle.stiffness) else rf"$k = {cycle.stiffness:g}\,R\Delta\gamma/\epsilon$"
    axes.plot([], [], color=colour, linestyle=dashes, linewidth=1.7, label=name)


def _ends(jump: Jump) -> tuple[tuple[float, float], tuple[float, float]]:
    before, after = jump.take_off, jump.landing
    return (before.approach, before.load), (after.approach, after.load)


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


DEVICE_PLOTS = (
    Plot(
        "8",
        "Jumps of an apparatus of finite stiffness, and where they begin (beyond the paper)",
        captions.figure_8,
        _figure_8,
    ),
)
