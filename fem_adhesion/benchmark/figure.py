"""Deviations of all numbers beside what they may be off by, and the first curve over ours."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.benchmark.study import Diagnosis
from fem_adhesion.common import style

LEAST = 1e-10  # deviation below which none is drawn


def draw(found: Diagnosis) -> Figure:
    """Sizes of the deviations, their directions by the symbols; a panel more with the first curve if there is one."""
    curve = next((one for one in found.submitted if one.curve is not None), None)
    rows = [row for row in found.rows if not math.isnan(row.ours)]
    figure, panels = style.panels(1 + bool(curve), height=5.4 if curve else 1.8 + 0.24 * len(rows))
    axes, places = panels[0], np.arange(len(rows))[::-1]
    deviations = np.array([row.deviation for row in rows])
    sizes = np.maximum(np.abs(deviations), LEAST)
    for here, marker, color, label in (
        (deviations >= 0, ">", style.BLUE, "above ours"),
        (deviations < 0, "<", style.RED, "below ours"),
    ):
        axes.plot(sizes[here], places[here], linestyle="", marker=marker, color=color, label=label)
    allowed = np.maximum([row.allowed / row.scale for row in rows], LEAST)
    axes.plot(allowed, places, "|", markersize=12, color="0.5", label="allowed by digits and errors")
    axes.set_xscale("log")
    axes.set_xlim(left=max(LEAST, float(sizes.min()) / 30))
    several = len(found.problems) > 1
    names = [f"{row.problem}: " * several + row.quantity.replace("_", " ") for row in rows]
    axes.set_yticks(places, labels=names, fontsize=9)
    style.dress(axes, "deviation as a part of our value", "", legend="below")
    axes.set_title(f"cause: {' or '.join(found.causes)}", fontsize=11)
    if curve is not None and curve.curve is not None:
        theirs, (approach, load) = curve.curve, curve.problem.curve[:2]
        shown = (approach > theirs[0].min() - 0.5) & (approach < theirs[0].max() + 0.5)
        panels[1].plot(approach[shown], load[shown], color="0.6", linewidth=3, label="ours")
        panels[1].plot(*theirs, ".-", markersize=3, linewidth=0.8, color=style.BLUE, label=curve.problem.name)
        style.dress(panels[1], "approach, eps", "load, R dgamma", legend="below")
    return figure
