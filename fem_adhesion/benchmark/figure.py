"""Deviations of all numbers beside what the best defect predicts, and curves over ours."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.benchmark.causes import Truth
from fem_adhesion.benchmark.study import Diagnosis
from fem_adhesion.common import style

LEAST = 1e-10  # deviation below which none is drawn


def draw(found: Diagnosis) -> Figure:
    """Sizes of the deviations, their directions by the symbols; a panel more with the first curve if there is one."""
    curves = [one for one in found.submitted if one.curve is not None and one.problem.in_atlas]
    figure, panels = style.panels(1 + bool(curves), height=1.8 + 0.24 * len(found.rows) if not curves else 5.4)
    rows = [row for row in found.rows if row.ours]
    axes, places = panels[0], np.arange(len(rows))[::-1]
    deviations = np.array([row.deviation for row in rows])
    for sign, marker, label in ((1, ">", "above ours"), (-1, "<", "below ours")):
        here = sign * deviations >= (0 if sign > 0 else 1e-300)
        look = {"linestyle": "", "marker": marker, "color": style.BLUE if sign > 0 else style.RED, "label": label}
        axes.plot(np.maximum(np.abs(deviations[here]), LEAST), places[here], **look)
    allowed = [(row.number.rounding + row.number.error + row.ours.error) / row.scale for row in rows if row.ours]
    axes.plot(np.maximum(allowed, LEAST), places, "|", markersize=12, color="0.5", label="last digit, errors")
    axes.set_xscale("log")
    several = len({row.problem for row in rows}) > 1
    names = [f"{row.problem}: " * several + row.number.quantity.replace("_", " ") for row in rows]
    axes.set_yticks(places, labels=names, fontsize=9)
    style.dress(axes, "deviation, as a part", "", legend="below")
    axes.set_title(f"cause: {' or '.join(found.causes)}", fontsize=11)
    for one in curves[:1]:
        theirs, (approach, load, _) = np.asarray(one.curve), Truth(one.problem).curve
        shown = (approach > theirs[:, 0].min() - 0.5) & (approach < theirs[:, 0].max() + 0.5)
        panels[1].plot(approach[shown], load[shown], color="0.6", linewidth=3, label="ours")
        panels[1].plot(*theirs.T, ".-", markersize=3, linewidth=0.8, color=style.BLUE, label=one.problem.name)
        style.dress(panels[1], "approach, eps", "load, R dgamma", legend="below")
    return figure
