"""The figure of a curve by full Newton on the weak form."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import lines, style
from fem_adhesion.curve.load import LEGEND, draw_line, draw_states
from fem_adhesion.curve.solve import WEAK_FORM, Curves


def draw(curves: Curves) -> Figure:
    """Load and central gap against approach, by stability, with the events."""
    curve, (figure, axes) = curves.paths[WEAK_FORM], style.panels(2)
    values = np.column_stack([curve.approach, curve.load, curve.central_gap])
    line = lines.through(curve.arclength, values, curve.rates, curve.stable)
    for panel, name in zip(axes, ("load", "central_gap"), strict=True):
        draw_line(panel, curves, line, name)
        draw_states(panel, curves, name)
        style.dress(panel, curves.scales["approach"].label, curves.scales[name].label, legend=None)
    axes[0].legend(loc="best", **LEGEND)
    return figure
