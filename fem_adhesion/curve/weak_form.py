"""The figure of a curve by full Newton on the weak form."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import CubicHermiteSpline

from fem_adhesion.common import style
from fem_adhesion.common.lines import DRAWING
from fem_adhesion.curve.load import LEGEND, STATES, Look
from fem_adhesion.curve.solve import WEAK_FORM, Curves


def draw(curves: Curves) -> Figure:
    """Load and central gap against approach, by stability, with the events."""
    curve, x = curves.paths[WEAK_FORM], curves.scales["approach"]
    figure, axes = style.panels(2)
    s = np.unique(np.linspace(curve.arclength[:-1], curve.arclength[1:], DRAWING.between + 1))
    values = CubicHermiteSpline(curve.arclength, curve.observables[:, :3], curve.rates)(s)
    falling = CubicHermiteSpline(curve.arclength, curve.observables[:, 0], curve.rates[:, 0])(s, 1) < 0
    before = np.clip(np.searchsorted(curve.arclength, s, side="right") - 1, 0, len(curve.stable) - 2)
    sure = curve.stable[before] == curve.stable[before + 1]
    stable = np.where(sure, curve.stable[before], ~falling)  # next to a fold where the approach rises
    for panel, name, drawn in zip(axes, ("load", "central_gap"), values.T[1:], strict=True):
        y = curves.scales[name]
        for label, kept, look in (
            ("stable under fixed grips", stable, {"color": style.BLUE, "linewidth": 2.2}),
            ("unstable", ~stable, {"color": style.RED, "linestyle": style.DOTTED}),
        ):
            if kept.any():
                panel.plot(x.size * values[:, 0], np.where(kept, y.size * drawn, np.nan), label=label, **look)
        for event_name, event in curve.events.items():
            look_of = STATES.get(event_name, Look(event_name.replace("_", " "), "0.4", "-", "s"))
            at = x.size * event.approach, y.size * getattr(event, name)
            panel.plot(*at, look_of.marker, color=look_of.color, linestyle="none", label=look_of.words)
        style.dress(panel, x.label, y.label, legend=None)
    axes[0].legend(loc="best", **LEGEND)
    return figure
