"""The chart of the finite sphere: contours of the half-space's error, with real materials placed among them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.output import greenwood_style as style
from fem_adhesion.studies.finite_sphere_chart import LEVELS, Array, Field, contour, field_of, refused_below
from fem_adhesion.studies.finite_sphere_table import Row
from fem_adhesion.studies.materials import Material, materials

TABOR = r"Tabor parameter $\mu$"
RATIO = r"radius over spacing $R/\epsilon$"
LEFT, RIGHT = 0.028, 25.0  # Tabor parameters of the chart's edges
BOTTOM, TOP = 4.0, 2e5  # R/eps of its edges

PANELS = {"pull_off_load": "error of the pull-off force", "jump_on_approach": "error of the approach at jump-on"}
LINES: Mapping[float, tuple[str, Any, float]] = {
    0.1: (style.RED, "-", 2.6),
    0.01: (style.BLUE, style.DASHED, 2.2),
    0.001: ("black", style.DOTTED, 2.0),
}
SHADES = ("0.80", "0.90", "0.96")
WHITE = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
MARKERS: Mapping[str, tuple[str, str]] = {
    "silica": ("o", style.BLUE),
    "gold": ("s", style.ORANGE),
    "mica": ("^", style.GREEN),
    "polystyrene": ("D", style.PINK),
    "toner": ("P", style.RED),
    "PDMS": ("v", "black"),
}


def chart(rows: Sequence[Row], poisson: float | None) -> Figure:
    """Draw the contours of 0.1, 1 and 10 % for the pull-off force and for the jump-on approach, side by side.

    Parameters
    ----------
    rows : sequence of Row
        The table of the study.
    poisson : float or None
        Which Poisson's ratio.
    """
    figure, panels = style.panels(2, height=7.4)
    for axes, (quantity, title) in zip(panels, PANELS.items(), strict=True):
        _panel(axes, field_of(rows, quantity, poisson))
        axes.set_title(f"half-space's {title}")
        _materials(axes)
        _dress(axes)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False, **style.LEGEND)
    return figure


def _panel(axes: Any, field: Field) -> None:
    axes.set(xscale="log", yscale="log", xlim=(LEFT, RIGHT), ylim=(BOTTOM, TOP))
    if not field.tabor.size:
        return
    _contours(axes, field)
    _no_solution(axes, field)
    _no_jump(axes, field)
    _points(axes, field)


def _contours(axes: Any, field: Field) -> None:
    for shade, level in zip(SHADES, LEVELS, strict=True):
        ratio = contour(field, level)
        colour, dashes, width = LINES[level]
        axes.fill_between(field.tabor, BOTTOM, ratio, color=shade, linewidth=0, zorder=level - 1)
        axes.plot(field.tabor, ratio, color=colour, linestyle=dashes, linewidth=width, label=f"{100 * level:g} %")
        _name(axes, field.tabor, ratio, level)


def _name(axes: Any, tabor: Array, ratio: Array, level: float) -> None:
    """The contour's error beside its right end."""
    known = np.flatnonzero(np.isfinite(ratio))
    if known.size:
        at = float(tabor[known[-1]]), float(ratio[known[-1]])
        style.note(axes, f"{100 * level:g} %", at, (5, -3), color=LINES[level][0], fontweight="bold", bbox=WHITE)


def _no_solution(axes: Any, field: Field) -> None:
    """Hatch where the solver refuses."""
    limit = refused_below(field)
    if np.isfinite(limit).any():
        look = {"facecolor": "white", "edgecolor": "0.35", "hatch": "///", "linewidth": 0.0, "zorder": 1.5}
        label = "no solution: contact as wide as the sphere"
        axes.stairs(limit, _midways(field.tabor), baseline=BOTTOM, fill=True, label=label, **look)


def _midways(tabor: Array) -> Array:
    """Tabor parameters midway between neighbours, and the outermost two."""
    return np.concatenate([tabor[:1], np.sqrt(tabor[1:] * tabor[:-1]), tabor[-1:]])


def _no_jump(axes: Any, field: Field) -> None:
    """Say where the contact has no jump: at the Tabor parameters that were solved and have no deviation."""
    smooth = field.tabor[~np.isfinite(field.deviation).any(axis=1) & ~field.refused.all(axis=1)]
    jumping = field.tabor[np.isfinite(field.deviation).any(axis=1)]
    if not smooth.size or not jumping.size:
        return
    end = float(np.sqrt(smooth[-1] * jumping[0]))
    axes.axvspan(LEFT, end, color="0.97", zorder=-2)
    axes.axvline(end, color="0.6", linewidth=0.8)
    words = "no jump under fixed grips"
    axes.text(end * 0.93, BOTTOM * 1.25, words, rotation=90, ha="right", va="bottom", color="0.35", fontsize=10)


def _points(axes: Any, field: Field) -> None:
    """Dots where the plane was solved, crosses where it was refused."""
    solved, refused = np.isfinite(field.deviation), field.refused
    mu, rho = np.meshgrid(field.tabor, field.radius_ratio, indexing="ij")
    axes.plot(mu[solved], rho[solved], ".", color="0.6", markersize=3, zorder=1.6, label="solved")
    if refused.any():
        axes.plot(mu[refused], rho[refused], "x", color="0.2", markersize=4, zorder=1.6, label="refused")


def _materials(axes: Any) -> None:
    for name, sizes in groupby(materials(), key=lambda material: material.name.split(",")[0]):
        listed = list(sizes)
        marker, colour = MARKERS[name]
        look = {"marker": marker, "color": colour, "markeredgecolor": "black", "markersize": 8, "linewidth": 0.9}
        inside = [m.units for m in listed if m.units.tabor < RIGHT]
        if inside:
            axes.plot([u.tabor for u in inside], [u.radius_ratio for u in inside], label=name, zorder=3, **look)
        for material in listed:
            _label(axes, material, name)


def _label(axes: Any, material: Material, name: str) -> None:
    """Size: of a bead beside its point, of all tips at the left edge, with an arrow for one beyond the right edge."""
    mu, rho = material.units.tabor, material.units.radius_ratio
    size = (
        f"{1e9 * material.units.radius:g} nm" if material.units.radius < 1e-6 else f"{1e6 * material.units.radius:g} µm"
    )
    if mu > RIGHT:
        arrow = {"arrowstyle": "-|>", "color": "black"}
        text = f"{name}, {size},\n" rf"$\mu = {mu:.0f}$"
        place = {"xytext": (-104, 0), "textcoords": "offset points", "va": "center", "fontsize": 9.5}
        axes.annotate(text, (RIGHT, rho), arrowprops=arrow, **place)
    elif "tip" not in material.name:
        style.note(axes, size, (mu, rho), (7, 4), zorder=4)
    elif name == "silica":
        axes.text(LEFT * 1.06, rho, size, color="0.25", fontsize=9.5, va="center")


def _dress(axes: Any) -> None:
    style.plain_ticks(axes.xaxis, (0.1, 0.3, 1, 3, 10))
    axes.set_xlabel(TABOR)
    axes.set_ylabel(RATIO)
    axes.grid(True, color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
