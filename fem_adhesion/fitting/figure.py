"""Data and fit, their residuals, and the contour of work of adhesion and spacing."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from fem_adhesion.common import style
from fem_adhesion.fitting.data import ORDER
from fem_adhesion.fitting.study import Fit

COLOURS = (style.BLUE, style.RED)  # of approach and retract
PRESSED = 2.0  # pull-off forces up to which the contact is shown beside its jumps
AROUND = 1.5  # distances of the two jumps shown on either side of the contact


def draw(fit: Fit) -> Figure:
    """Force against travel about the jumps, all residuals in standard deviations of the noise, contour."""
    best, data = fit.best, fit.best.problem.data
    found = best.problem.branches(best.apparatus)
    model = data.modelled(found)
    force, x = data.levelled(model), data.travel - best.apparatus.contact_point
    on, off = (at - best.apparatus.contact_point for at in (found.on, found.off))
    figure = Figure(figsize=(12.0, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2, 1), height_ratios=(2, 1))
    top, below, right = (figure.add_subplot(place) for place in (grid[0, 0], grid[1, 0], grid[:, 1]))
    for run, residuals in best.residuals():
        colour = COLOURS[run.segment]
        top.plot(x[run.samples], force[run.samples], ".", markersize=2.5, color=colour, alpha=0.5)
        top.plot(x[run.samples], model[run.samples], color="black", linewidth=1.0)
        below.plot(x[run.samples], residuals, ".", markersize=2, color=colour)
    if found.jumps:
        for at, order in zip((on, off), ORDER, strict=True):
            base = at + best.apparatus.contact_point
            first, then = (float(np.interp(base, *getattr(found, branch))) for branch in order)
            style.arrow(top, (at, first), (at, then), color="0.4")
    for name, colour in zip(("approach", "retract"), COLOURS, strict=True):
        top.plot([], [], ".", color=colour, label=name)
    top.plot([], [], color="black", label="fit, on the branch of the samples")
    travel = "travel of the base from the contact point"
    width = max(abs(on - off), 1e-3 * float(np.ptp(x)))
    light = x[force < PRESSED * fit.prepared.pull_off]
    near = min(on, off) - AROUND * width, max(float(light.max()), AROUND * width)
    shown = force[(x > near[0]) & (x < near[1])]
    margin = 0.08 * float(np.ptp(shown))
    style.dress(top, travel, "force", xlim=near, ylim=(float(shown.min()) - margin, float(shown.max()) + margin))
    below.axhline(0.0, color="0.6", linewidth=0.8)
    style.dress(below, f"{travel}, all of the curve", "residual, noise", legend=None)
    right.fill(*fit.contour, color=style.SKY, alpha=0.4, label="95 % of the pair")
    right.plot(best.apparatus.work_of_adhesion, best.apparatus.spacing, "+", color="black", markersize=10, label="best")
    style.dress(right, "work of adhesion", "spacing eps")
    right.set_title("does not fit" if fit.misfit else f"best model: {fit.model}", fontsize=11)
    axes = top.xaxis, top.yaxis, below.xaxis, right.xaxis, right.yaxis
    for axis, unit in zip(axes, ("m", "N", "m", "J/m²", "m"), strict=True):
        style.engineering_ticks(axis, unit)
    right.xaxis.set_major_locator(MaxNLocator(3))
    return figure
