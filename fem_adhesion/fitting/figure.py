"""Data and fit, their residuals, and the contour of work of adhesion and spacing."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import PREFIXES, exponent_of
from fem_adhesion.fitting.study import Fit

COLOURS = {0: style.BLUE, 1: style.RED}  # of approach and retract
AROUND = 1.5  # pull-off travels shown on either side of the contact


def draw(fit: Fit) -> Figure:
    """Force against travel about the contact, residuals in standard deviations of the noise, contour."""
    best = fit.best
    data, problem = best.problem.data, best.problem
    found = problem.branches(best.apparatus)
    model = data.modelled(found)
    force = data.levelled(model)
    residuals = problem.residuals(best.x)
    origin, width = best.apparatus.contact_point, max(abs(found.on - found.off), 1e-3 * float(np.ptp(data.travel)))
    x, unit = scaled(data.travel - origin, "m", AROUND * width)
    y, newton = scaled(force, "N", fit.prepared.pull_off)
    ratio = y[np.argmax(np.abs(y))] / force[np.argmax(np.abs(y))]
    figure = Figure(figsize=(12.0, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2, 1), height_ratios=(2, 1))
    top, below, right = (figure.add_subplot(place) for place in (grid[0, 0], grid[1, 0], grid[:, 1]))
    per = x[np.argmax(np.abs(x))] / (data.travel - origin)[np.argmax(np.abs(x))]
    for run in data.runs:
        count = data.travel[run.samples].size
        own, residuals = residuals[:count], residuals[count:]
        name = ("approach", "retract")[run.segment]
        first = name not in top.get_legend_handles_labels()[1]
        top.plot(
            x[run.samples],
            y[run.samples],
            ".",
            markersize=2.5,
            color=COLOURS[run.segment],
            alpha=0.5,
            label=name if first else None,
        )
        top.plot(x[run.samples], model[run.samples] * ratio, color="black", linewidth=1.0)
        below.plot(x[run.samples], own, ".", markersize=2, color=COLOURS[run.segment])
    for at, place in ((found.on, 0), (found.off, 1)):
        if found.jumps:
            ends = [np.interp(at, *branch) * ratio for branch in (found.separated, found.contact)]
            style.arrow(top, ((at - origin) * per, ends[place]), ((at - origin) * per, ends[1 - place]), color="0.4")
    near = (
        (min(found.off, found.on) - origin - AROUND * width) * per,
        max((data.travel.max() - origin) * per, AROUND * width * per),
    )
    shown = (x > near[0]) & (x < near[1])
    margin = 0.08 * float(np.ptp(y[shown]))
    top.plot([], [], color="black", label="fit, on the branch of the samples")
    style.dress(
        top, "", f"force, {newton}", xlim=near, ylim=(float(y[shown].min()) - margin, float(y[shown].max()) + margin)
    )
    below.axhline(0.0, color="0.6", linewidth=0.8)
    style.dress(below, f"travel of the base from the contact point, {unit}", "residual, noise", legend=None, xlim=near)
    works, spacings = fit.contour
    w, joules = scaled(works, "J/m^2", float(works.max()))
    s, metres = scaled(spacings, "m", float(spacings.max()))
    right.fill(w, s, color=style.SKY, alpha=0.4, label="95 % of the pair")
    values = fit.values["work_of_adhesion"].value * w[0] / works[0], fit.values["spacing"].value * s[0] / spacings[0]
    right.plot(*values, "+", color="black", markersize=10, label="best")
    style.dress(right, f"work of adhesion, {joules}", f"spacing eps, {metres}")
    right.set_title("does not fit" if fit.misfit else f"best model: {fit.model}", fontsize=11)
    return figure


def scaled(values: np.ndarray, unit: str, size: float) -> tuple[np.ndarray, str]:
    """Values in a unit with the prefix that suits a size."""
    exponent = exponent_of(size)
    return values / 10.0**exponent, f"{PREFIXES[exponent]}{unit}"
