"""How curves after the paper's are drawn, and what is to be seen in them: how near finite elements are, and what falls.

Each Tabor parameter and each theory has a look of its own; a figure shows no two parameters of the same colour.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from fem_adhesion.common.lines import smooth
from fem_adhesion.common.numbers import told
from fem_adhesion.common.style import BLUE, CHAIN, DASHED, DOTTED, GREEN, LONG, ORANGE, PINK, RED, SKY
from halfspace.equilibrium.contact import CENTRAL_GAP as GAP
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array

OF_TABOR = {0.02: SKY, 0.1: BLUE, 0.3: GREEN, 0.5: ORANGE, 1.0: RED, 2.0: BLUE, 3.0: PINK, 5.0: GREEN}
DASHES_OF_TABOR = dict(zip(OF_TABOR, ("-", DASHED, CHAIN, LONG, "-", DASHED, CHAIN, DOTTED), strict=True))
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

LOAD = r"load $W/R\Delta\gamma$"
APPROACH = r"approach $\alpha^*$"
SCALED_APPROACH = r"scaled approach $\alpha^*/\mu$"
CENTRAL_GAP = r"central gap $H(0)$"
RADIUS = r"radius $u = r/\beta$"


def curve(axes: Any, tabor: float, x: Array, y: Array) -> None:
    """Whole curve at a Tabor parameter, its dashes those of the parameter."""
    style = {"color": OF_TABOR[tabor], "linestyle": DASHES_OF_TABOR[tabor]}
    axes.plot(x, y, label=rf"$\mu = {tabor:g}$", linewidth=1.9, **style)


def branches(axes: Any, path: EquilibriumPath, x: str, y: str) -> None:
    """Curve by the names of two of approach, load and central gap; stretches unstable under fixed grips are dotted."""
    line = smooth(path)
    for part, dashes in zip(line.stretches(getattr(line, y)), ("-", DOTTED), strict=True):
        axes.plot(getattr(line, x), part, color=OF_TABOR[path.tabor], linewidth=1.9, linestyle=dashes)


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


def rises(values: Array) -> bool:
    """Whether each value exceeds the one before it; there must be two."""
    return values.size > 1 and bool(np.all(np.diff(values) > 0))


def gap_falls(path: EquilibriumPath) -> bool:
    """Whether the central gap falls at every point of a curve, by the tangents: grids hand over with a small step."""
    return all(point.rates[GAP] < 0 for point in path.points)


def elements_beside(fe: EquilibriumPath | None, path: EquilibriumPath, x: str, y: str) -> str:
    """How far finite-element points lie from the half-space's curve."""
    if fe is None:
        return ""
    seen = (fe.load <= path.load.max(initial=-np.inf)) & (fe.approach >= path.approach.min(initial=np.inf))
    if x == "contact_radius" or y == "contact_radius":
        seen &= np.isfinite(fe.contact_radius)
    line = np.isfinite(getattr(path, x)) & np.isfinite(getattr(path, y))
    off = _farthest((getattr(fe, x)[seen], getattr(fe, y)[seen]), (getattr(path, x)[line], getattr(path, y)[line]))
    text = (
        f"At mu = {path.tabor:g} the finite-element points are within {off:.1e} of the line, in units of their extent."
    )
    return told(text, off)


def _farthest(points: tuple[Array, Array], line: tuple[Array, Array]) -> float:
    """Largest distance of points from a polygon, in units of its width and height where the points are."""
    at, corners = np.stack(points), np.stack(line)
    if at.size == 0 or corners.shape[1] < 2:
        return math.nan
    size = np.maximum(np.ptp(at, axis=1), 1e-12)[:, None]
    at, corners = at / size, corners / size
    start, step = corners[:, :-1], np.diff(corners)
    length = np.maximum(np.sum(step**2, axis=0), 1e-30)
    offsets = at[:, :, None] - start[:, None]
    t = np.clip(np.sum(offsets * step[:, None], axis=0) / length, 0, 1)
    return float(np.hypot(*(offsets - t * step[:, None])).min(axis=1).max())
