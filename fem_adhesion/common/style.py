"""How figures look: one colour for each Tabor parameter, stable and unstable told apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array

# Okabe and Ito's colours, which colour-blind eyes tell apart; a figure shows no two parameters of the same colour.
BLUE, SKY, GREEN, ORANGE, RED, PINK = "#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7"
OF_TABOR = {0.02: SKY, 0.1: BLUE, 0.3: GREEN, 0.5: ORANGE, 1.0: RED, 2.0: BLUE, 3.0: PINK, 5.0: GREEN}
DASHED, DOTTED, CHAIN, LONG = (0, (5, 1.5)), (0, (1, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (9, 2))
DASHES_OF_TABOR: Mapping[float, Any] = {
    0.02: "-",
    0.1: DASHED,
    0.3: CHAIN,
    0.5: LONG,
    1.0: "-",
    2.0: DASHED,
    3.0: CHAIN,
}
THEORIES: Mapping[str, Mapping[str, Any]] = {
    "Bradley": {"color": "black", "linestyle": DOTTED, "linewidth": 1.8},
    "JKR": {"color": "black", "linestyle": DASHED, "linewidth": 1.5},
    "Hertz": {"color": "0.45", "linestyle": CHAIN, "linewidth": 1.5},
    "DMT-M": {"color": "black", "linestyle": LONG, "linewidth": 1.1},
    "DMT force method": {"color": PINK, "linestyle": DASHED, "linewidth": 1.5},
    "DMT thermodynamic": {"color": RED, "linestyle": CHAIN, "linewidth": 1.5},
}
ELEMENTS: Mapping[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 5,
    "markerfacecolor": "white",
    "zorder": 4,
}
LOOK: Mapping[Any, Any] = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "G97"}

LEGEND: Mapping[str, Any] = {"fontsize": 9.5, "handlelength": 3.2}

LOAD = r"load $W/R\Delta\gamma$"
APPROACH = r"approach $\alpha^*$"
SCALED_APPROACH = r"scaled approach $\alpha^*/\mu$"
CENTRAL_GAP = r"central gap $H(0)$"
RADIUS = r"radius $u = r/\beta$"


def panels(columns: int = 1, height: float = 5.0) -> tuple[Figure, Sequence[Any]]:
    """Figure with panels side by side, its height in inches."""
    figure = Figure(figsize=(7.4 if columns == 1 else 12.0, height), layout="constrained")
    return figure, figure.subplots(1, columns, squeeze=False)[0]


def dress(
    axes: Any, x: str, y: str, *, legend: str | None = "best", columns: int = 3, **limits: tuple[float, float]
) -> None:
    """Label the axes, set `xlim` and `ylim` if given, and add a legend of what is drawn, at a place or below."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set(**limits)
    axes.grid(True, color="0.93", linewidth=0.8)
    axes.set_axisbelow(True)
    if not axes.get_legend_handles_labels()[1]:
        return
    if legend == "below":
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=columns, frameon=False, **LEGEND)
    elif legend:
        axes.legend(loc=legend, framealpha=0.9, edgecolor="none", **LEGEND)


def plain_ticks(axis: Any, ticks: Sequence[float]) -> None:
    """Ticks of a logarithmic axis as plain numbers."""
    axis.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)


def curve(axes: Any, tabor: float, x: Array, y: Array, label: str | None = None) -> None:
    """Whole curve at a Tabor parameter, its dashes those of the parameter."""
    style = {"color": OF_TABOR[tabor], "linestyle": DASHES_OF_TABOR.get(tabor, DOTTED)}
    axes.plot(x, y, label=label or rf"$\mu = {tabor:g}$", linewidth=1.9, **style)


def branches(axes: Any, path: EquilibriumPath, x: Array, y: Array, label: str | None = None) -> None:
    """Curve whose stretches unstable under fixed grips are dotted."""
    colour = OF_TABOR[path.tabor]
    unstable = ~path.stable
    axes.plot(x, np.where(unstable, np.nan, y), color=colour, linewidth=1.9, label=label)
    axes.plot(x, np.where(_widened(unstable), y, np.nan), color=colour, linewidth=1.9, linestyle=DOTTED)


def _widened(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mask with the neighbours of its points, so that the stretches join."""
    wide = mask.copy()
    wide[1:] |= mask[:-1]
    wide[:-1] |= mask[1:]
    return wide


def stability_key(axes: Any) -> None:
    """Legend entries that say which line is stable."""
    axes.plot([], [], color="0.3", linewidth=1.9, label="stable under fixed grips")
    axes.plot([], [], color="0.3", linewidth=1.9, linestyle=DOTTED, label="unstable")


def elements(axes: Any, path: EquilibriumPath, x: Array, y: Array, label: str = "finite elements") -> None:
    """Finite-element points over a curve."""
    axes.plot(x, y, label=label, color=OF_TABOR[path.tabor], **ELEMENTS)


def theory(axes: Any, name: str, x: Array, y: Array, label: str | None = None, **style: Any) -> None:
    """Curve of a theory."""
    axes.plot(x, y, label=label or name, **{**THEORIES[name], **style})


def note(axes: Any, text: str, at: tuple[float, float], offset: tuple[float, float] = (6, 4), **style: Any) -> None:
    """Text beside a point, offset in points."""
    axes.annotate(text, at, xytext=offset, textcoords="offset points", fontsize=10.5, **style)
