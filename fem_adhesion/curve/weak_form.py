"""The figure of a curve by full Newton on the weak form."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import CubicHermiteSpline

from fem_adhesion.common import lines, style
from fem_adhesion.curve.load import LEGEND, draw_line, draw_states
from fem_adhesion.curve.solve import WEAK_FORM, Curves


def draw(curves: Curves) -> Figure:
    """Load and central gap against approach, by stability, with the events."""
    curve, (figure, axes) = curves.paths[WEAK_FORM], style.panels(2)
    s = np.unique(np.linspace(curve.arclength[:-1], curve.arclength[1:], lines.BETWEEN + 1))
    values = np.column_stack([curve.approach, curve.load, curve.central_gap])
    spline = CubicHermiteSpline(curve.arclength, values, curve.rates)
    before = np.clip(np.searchsorted(curve.arclength, s, side="right") - 1, 0, len(curve.stable) - 2)
    approach, load, central_gap = spline(s).T
    line = lines.Line(
        approach, load, central_gap, lines.kinds(spline(s, 1), curve.stable[before], curve.stable[before + 1])
    )
    for panel, name in zip(axes, ("load", "central_gap"), strict=True):
        draw_line(panel, curves, line, name)
        draw_states(panel, curves, name)
        style.dress(panel, curves.scales["approach"].label, curves.scales[name].label, legend=None)
    axes[0].legend(loc="best", **LEGEND)
    return figure
