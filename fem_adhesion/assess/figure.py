"""Force against separation on a cantilever, with its jumps: half-space, finite sphere and closed theories."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.assess.predictions import Prediction
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.study import Assessment
from fem_adhesion.common import style
from fem_adhesion.common.lines import Range, smooth
from fem_adhesion.common.numbers import PREFIXES, engineering, exponent_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import reaching
from halfspace.values import Array

LINES: tuple[dict[str, Any], ...] = (
    {"color": style.BLUE, "linewidth": 2.0},
    {"color": style.ORANGE, "linewidth": 1.8, "linestyle": style.DASHED},
)
THEORIES: dict[str, dict[str, Any]] = {  # thin and in front, so that what they lie upon is seen beside them
    "JKR": {"color": "0.2", "linestyle": style.CHAIN},
    "Maugis-Dugdale": {"color": "0.45", "linestyle": style.DASHED},
    "DMT-M": {"color": "0.45", "linestyle": style.DOTTED},
    "rigid": {"color": "0.65", "linestyle": "-"},
}


def draw(assessment: Assessment) -> Figure:
    """Figure of the assessment."""
    units = assessment.contact.units
    separations, forces = _frame(assessment)
    metres, newtons = exponent_of(separations[1]), exponent_of(-forces[0])

    def scaled(approach: Any, load: Any) -> tuple[Any, Any]:
        """Separation and force in the units of the axes."""
        return (1 - approach) * units.approach * 10.0**-metres, load * units.load * 10.0**-newtons

    figure, (axes,) = style.panels(height=5.4)
    for model, look in zip(filter(None, (assessment.half_space, assessment.finite)), LINES, strict=False):
        axes.plot(*scaled(*_line(model, assessment)), label=model.model, **look)
    for theory in assessment.theories:
        look = {"linewidth": 1.0, "zorder": 3, **THEORIES[theory.model]}
        axes.plot(*scaled(*_line(theory, assessment)), label=theory.model, **look)
    right = separations[1] * 10.0**-metres
    for jump in assessment.best.jumps:
        # A jump along its load line, to the edge of the frame if it lands beyond.
        (x, y), (x_end, y_end) = (scaled(end.approach, end.load) for end in jump)
        part = min(1.0, (right - x) / (x_end - x)) if x_end > x else 1.0
        end = (x + part * (x_end - x), y + part * (y_end - y))
        style.arrow(axes, (x, y), end, clipped=False, linewidth=1.5, color=style.RED)
        if part < 1:
            lands = f"lands at {engineering(x_end * 10.0**metres, 'm')}"
            style.note(axes, lands, end, offset=(-6, -14), ha="right", color=style.RED)
    axes.axhline(0, color="0.75", linewidth=0.8, zorder=0)
    labels = (
        f"separation of the undeformed surfaces, {PREFIXES[metres]}m",
        f"force (compression positive), {PREFIXES[newtons]}N",
    )
    xlim, ylim = (separations[0] * 10.0**-metres, right), (forces[0] * 10.0**-newtons, forces[1] * 10.0**-newtons)
    style.dress(axes, *labels, legend="below", xlim=xlim, ylim=ylim)
    stiffness = assessment.contact.stiffness
    grips = "fixed grips" if np.isinf(stiffness) else f"cantilever {engineering(stiffness, 'N/m')}"
    known = f"$R$ = {engineering(units.radius, 'm')}, $\\mu$ = {units.tabor:.4g}"
    axes.set_title(f"{known}, {grips}: arrows show its jumps", fontsize=11)
    return figure


def _frame(assessment: Assessment) -> tuple[Range, Range]:
    """Separations in m and forces in N that are shown: from a little compression to beyond the jump on."""
    units, values = assessment.contact.units, assessment.best.values
    force, jump = values["pull_off_force"].value, values.get("jump_on_separation")
    approach, load = _line(assessment.best, assessment)
    near = 1 - float(np.nanmax(approach[load * units.load < USUAL.higher * force]))
    parted = 1 - float(np.nanmin(approach[load * units.load < -0.3 * force]))  # the neck may be long
    far = USUAL.wider * max(jump.value / units.approach if jump else 6.0, parted)
    first = (near - 0.04 * (far - near)) * units.approach
    return (first, far * units.approach), (-1.12 * force, USUAL.higher * force)


def _line(model: Prediction, assessment: Assessment) -> tuple[Array, Array]:
    """Approach and load along a model's curve, smooth between computed points."""
    curve = model.curve
    if isinstance(curve, EquilibriumPath):
        path = reaching(curve, assessment.contact.reduced_stiffness)
        line, pull_off = smooth(path), path.events["pull_off"]
        lowest = np.argmin(line.load)
        line.approach[lowest], line.load[lowest] = pull_off.approach, pull_off.load  # solved for, not between points
        return line.approach, line.load
    if curve is None:
        return np.empty(0), np.empty(0)
    approach, load, radius = curve
    if model.source == "atlas":
        return approach, load
    touching = int(np.argmax(np.isfinite(radius)))  # where the curve may leap
    load = np.where(np.arange(load.size) == touching, np.nan, load)
    kept = np.arange(touching % USUAL.thinned, load.size, USUAL.thinned)
    return approach[kept], load[kept]
