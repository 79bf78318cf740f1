"""Force against separation on a cantilever, with its jumps: half-space, finite sphere and JKR."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.assess.study import Assessment
from fem_adhesion.assess.theories import Curve, loop
from fem_adhesion.common import style
from fem_adhesion.common.lines import smooth
from fem_adhesion.common.numbers import PREFIXES, engineering, exponent_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle, reaching
from halfspace.scaling import Units
from halfspace.values import Array

LINES: tuple[dict[str, Any], ...] = (
    {"color": style.BLUE, "linewidth": 2.0},
    {"color": style.ORANGE, "linewidth": 1.8, "linestyle": style.DASHED},
)
BEHIND: dict[str, Any] = {"color": "0.6", "linewidth": 1.3, "linestyle": style.CHAIN, "zorder": 1}
WIDER, HIGHER = 1.3, 0.35  # frame: beyond the jump on, and above zero in pull-off forces
THINNED = 50  # of so many samples of a closed theory one is drawn

Ends = tuple[float, float]


def draw(assessment: Assessment) -> Figure:
    """Figure of the assessment."""
    frame = _frame(assessment)
    figure, (axes,) = style.panels(height=5.4)
    theory = next(m for m in assessment.theories if m.model == "JKR")
    axes.plot(*frame.scaled(*_line(theory.curve, assessment)), label="JKR", **BEHIND)
    for model, look in zip(filter(None, (assessment.half_space, assessment.finite)), LINES, strict=False):
        axes.plot(*frame.scaled(*_line(model.curve, assessment)), label=model.model, **look)
    for tail, head in _jumps(assessment):
        _arrow(axes, frame, tail, head)
    axes.axhline(0, color="0.75", linewidth=0.8, zorder=0)
    style.dress(axes, *frame.labels, legend="below", xlim=frame.x, ylim=frame.y)
    axes.set_title(_title(assessment), fontsize=11)
    return figure


@dataclass(frozen=True)
class _Frame:
    """What of the curves is shown, and in which units: exponents of ten of m and N."""

    units: Units
    metres: int
    newtons: int
    x: tuple[float, float]
    y: tuple[float, float]

    @property
    def labels(self) -> tuple[str, str]:
        """Of both axes."""
        return (
            f"separation of the undeformed surfaces, {PREFIXES[self.metres]}m",
            f"force (compression positive), {PREFIXES[self.newtons]}N",
        )

    def scaled(self, approach: Array, load: Array) -> tuple[Array, Array]:
        """Separation and force in the units of the axes."""
        x = (1 - approach) * self.units.approach * 10.0**-self.metres
        return x, load * self.units.load * 10.0**-self.newtons


def _frame(assessment: Assessment) -> _Frame:
    """From a little compression to beyond the jump on."""
    units, values = assessment.contact.units, assessment.half_space.values
    force = values["pull_off_force"].value
    jump = values.get("jump_on_separation")
    approach, load = _line(assessment.half_space.curve, assessment)
    near = 1 - float(np.nanmax(approach[load * units.load < HIGHER * force]))
    parted = 1 - float(np.nanmin(approach[load * units.load < -0.3 * force]))  # the neck may be long
    far = WIDER * max(jump.value / units.approach if jump else 6.0, parted)
    metres, newtons = exponent_of(far * units.approach), exponent_of(force)
    x = np.array([near - 0.04 * (far - near), far]) * units.approach * 10.0**-metres
    y = np.array([-1.12, HIGHER]) * force * 10.0**-newtons
    return _Frame(units, metres, newtons, (float(x[0]), float(x[1])), (float(y[0]), float(y[1])))


def _line(curve: EquilibriumPath | Curve | None, assessment: Assessment) -> tuple[Array, Array]:
    """Approach and load along a curve, smooth between computed points."""
    if isinstance(curve, EquilibriumPath):
        path = reaching(curve, assessment.contact.reduced_stiffness)
        line, pull_off = smooth(path), path.events["pull_off"]
        lowest = np.argmin(line.load)
        line.approach[lowest], line.load[lowest] = pull_off.approach, pull_off.load  # solved for, not between points
        return line.approach, line.load
    if curve is None:
        return np.empty(0), np.empty(0)
    touching = int(np.argmax(np.isfinite(curve.radius)))  # where the curve may leap
    load = np.where(np.arange(curve.load.size) == touching, np.nan, curve.load)
    kept = np.arange(touching % THINNED, load.size, THINNED)
    return curve.approach[kept], load[kept]


def _jumps(assessment: Assessment) -> Iterator[tuple[Ends, Ends]]:
    """Take-off and landing, in approach and load, of the half-space's two jumps."""
    stiffness, curve = assessment.contact.reduced_stiffness, assessment.half_space.curve
    if isinstance(curve, EquilibriumPath):
        computed = cycle(curve, stiffness)
        pairs = [(jump.take_off, jump.landing) for jump in (computed.jump_on, computed.jump_off)] if computed else []
        yield from (((a.approach, a.load), (b.approach, b.load)) for a, b in pairs)
    elif curve is not None:
        found = loop(curve, stiffness)
        states = (found.jump_on, found.jump_off) if found else ()
        yield from (((a.approach, a.load), (b.approach, b.load)) for a, b in states)


def _arrow(axes: Any, frame: _Frame, tail: Ends, head: Ends) -> None:
    """Jump along its load line, to the edge of the frame if it lands beyond."""
    (x, x_end), (y, y_end) = frame.scaled(*np.transpose([tail, head]))
    part = min(1.0, (frame.x[1] - x) / (x_end - x)) if x_end > x else 1.0
    end = (x + part * (x_end - x), y + part * (y_end - y))
    style.arrow(axes, (x, y), end, clipped=False, linewidth=1.5, color=style.RED)
    if part < 1:
        lands = f"lands at {engineering(x_end * 10.0**frame.metres, 'm')}"
        style.note(axes, lands, end, offset=(-6, 5), ha="right", color=style.RED)


def _title(assessment: Assessment) -> str:
    contact, units = assessment.contact, assessment.contact.units
    grips = "fixed grips" if np.isinf(contact.stiffness) else f"cantilever {engineering(contact.stiffness, 'N/m')}"
    return f"$R$ = {engineering(units.radius, 'm')}, $\\mu$ = {units.tabor:.4g}, {grips}: arrows show its jumps"
