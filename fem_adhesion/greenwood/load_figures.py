"""Load against approach: figures after [G97] 1a to 2b, each with what is to be seen in it, measured on its data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import listed, told
from fem_adhesion.common.style import dress, note, panels
from fem_adhesion.greenwood import drawing
from fem_adhesion.greenwood.drawing import curve, elements_beside, rises, theory
from fem_adhesion.greenwood.study import JUMPS_AT, Greenwood1997
from halfspace.theories import dmt
from halfspace.theories.closed_forms import (
    BRADLEY_PULL_OFF,
    JKR_PULL_OFF,
    bradley_load,
    hertz_load,
    hertz_radius_at,
    jkr_approach,
    jkr_load,
    jkr_zero_load,
)
from halfspace.values import Array

DMT = {
    "DMT force method": dmt.force_load,
    "DMT thermodynamic": dmt.thermodynamic_load,
    "DMT-M": dmt.maugis_load,
}
RIGID = (0.02, 0.1, 0.3)  # Tabor parameters of Fig. 1a
SCALED = (0.1, 0.3, 0.5, 1.0)  # of Fig. 1b
SOFT = (1.0, 2.0, 3.0, 5.0)  # of Fig. 2b
DMT_TABOR = 0.1  # at which Fig. 1a shows the DMT theories


def _figure_1a(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels(height=5.8)
    for mu in RIGID:
        curve(axes, mu, study.curves[mu].approach, study.curves[mu].load)
    apart = np.linspace(-2, 0.2, 300)
    theory(axes, "Bradley", apart, bradley_load(apart), "Bradley, $\\mu = 0$")
    _dmt(axes, DMT_TABOR, np.linspace(0, 0.6, 200), f", $\\mu = {DMT_TABOR:g}$")
    dress(axes, drawing.APPROACH, drawing.LOAD, legend="below", xlim=(-1.8, 0.6), ylim=(-6.8, 1.5))
    return figure


def _dmt(axes: Any, tabor: float, approach: Array, suffix: str) -> None:
    """Three DMT theories and Hertz's at one Tabor parameter."""
    for name, load in DMT.items():
        theory(axes, name, approach, load(approach, tabor), f"{name}{suffix}")
    theory(axes, "Hertz", approach, hertz_load(hertz_radius_at(approach, tabor)), f"Hertz{suffix}")


def _see_1a(study: Greenwood1997) -> Iterator[str]:
    """Bradley's curve far from contact, the DMT theories at zero load."""
    path = study.curves[RIGID[0]]
    apart = (path.approach > -1.8) & (path.approach < 0)
    off = np.abs(path.load - bradley_load(path.approach))[apart]
    near = f"{np.max(off, initial=0):.2g} R dgamma of Bradley's"
    yield told(f"Apart, at -1.8 < alpha* < 0, the load at mu = {RIGID[0]:g} is within {near}.", off)
    softer = study.curves[DMT_TABOR]
    if event := softer.event("zero_load"):
        loads = _dmt_loads(event.approach, softer.tabor)
        trend = "they rise sooner" if loads.min() > 0 else "not all of them rise sooner"
        text = (
            f"At mu = {softer.tabor:g} and alpha* = {event.approach:.3f}, where the solution's load is zero, the DMT "
            f"theories have {loads.min():.2f} to {loads.max():.2f} R dgamma: {trend}."
        )
        yield told(text, event.approach, loads)


def _dmt_loads(approach: float, tabor: float) -> Array:
    return np.array([float(load(approach, tabor)) for load in DMT.values()])


def _scaled_curves(study: Greenwood1997, tabors: Sequence[float]) -> tuple[Figure, Any]:
    """Loads against approaches in units of beta^2/R, in which JKR's theory is one curve."""
    figure, (axes,) = panels()
    for mu in tabors:
        curve(axes, mu, study.curves[mu].approach / mu, study.curves[mu].load)
    radius = np.linspace(0, 3, 300)
    theory(axes, "JKR", jkr_approach(radius, 1.0), jkr_load(radius))
    return figure, axes


def _figure_1b(study: Greenwood1997) -> Figure:
    figure, axes = _scaled_curves(study, SCALED)
    scaled = np.linspace(0, 4, 200)
    theory(axes, "DMT-M", scaled, dmt.maugis_load(scaled, 1.0))
    theory(axes, "Hertz", scaled, hertz_load(hertz_radius_at(scaled, 1.0)))
    dress(axes, drawing.SCALED_APPROACH, drawing.LOAD, legend="upper left", xlim=(-5, 3.5), ylim=(-6.6, 3))
    return figure


def _see_1b(study: Greenwood1997) -> Iterator[str]:
    """Pull-off force between the limits."""
    forces = np.array([-study.curves[mu].events["pull_off"].load for mu in SCALED])
    between = np.all((forces < -BRADLEY_PULL_OFF) & (forces > -JKR_PULL_OFF))
    trend = "falls all along" if rises(-forces) else "does not fall all along"
    yield "Scaled by mu, Hertz, DMT-M and JKR are one curve each."
    text = (
        f"From mu = {SCALED[0]:g} to {SCALED[-1]:g} the computed pull-off force goes from {forces[0]:.4f} to "
        f"{forces[-1]:.4f} R dgamma: it {trend}, {'' if between else 'not '}between DMT-M's 2 pi and JKR's 3 pi/2."
    )
    yield told(text, forces)


def _figure_1c(study: Greenwood1997) -> Figure:
    mu = RIGID[0]
    path = study.curves[mu]
    figure, (axes,) = panels()
    curve(axes, mu, path.approach, path.load)
    apart = np.linspace(-2, 0.32, 300)
    theory(axes, "Bradley", apart, bradley_load(apart), "Bradley, $\\mu = 0$")
    _dmt(axes, mu, np.linspace(0, 0.2, 200), "")
    dress(axes, drawing.APPROACH, drawing.LOAD, legend="upper left", xlim=(-0.6, 0.42), ylim=(-8, 20))
    return figure


def _see_1c(study: Greenwood1997) -> Iterator[str]:
    """The end of the compressed curve beside the DMT theories."""
    path = study.curves[RIGID[0]]
    approach, load = path.approach[-1], path.load[-1]
    loads = _dmt_loads(float(approach), path.tabor)
    trend = "later than in any" if loads.min() > load else "not later than in every"
    apart = abs(loads[0] - loads[2])
    text = (
        f"The load rises {trend} DMT theory: at alpha* = {approach:.3f} it is {load:.1f} R dgamma, theirs "
        f"{loads.min():.1f} to {loads.max():.1f}. The force method and DMT-M differ there by {apart:.1g}."
    )
    yield told(text, approach, load, loads)


def _figure_2a(study: Greenwood1997) -> Figure:
    path = study.curves[JUMPS_AT]
    figure, (axes,) = panels()
    drawing.branches(axes, path, "approach", "load")
    drawing.stability_key(axes)
    if fe := study.elements.get(JUMPS_AT):
        drawing.elements(axes, fe, fe.approach, fe.load)
    for letters, jump in study.jumps.items():
        ends = [(jump.take_off.approach, state.load) for state in jump.ends]
        style.arrow(axes, *ends, color=style.RED, linewidth=1.6, zorder=1)
        for letter, end in zip(letters, ends, strict=True):
            note(axes, letter, end, (-14, -4) if letters == "CD" else (7, 2), weight="bold")
    dress(axes, drawing.APPROACH, drawing.LOAD, legend="upper left", xlim=(-7, 4), ylim=(-5.6, 1.5))
    axes.set_title(rf"$\mu = {JUMPS_AT:g}$")
    return figure


def _see_2a(study: Greenwood1997) -> Iterator[str]:
    """Jumps, and the finite elements on the curve."""
    path, fe = study.curves[JUMPS_AT], study.elements.get(JUMPS_AT)
    jumps = [
        f"from {' to '.join(letters)} at alpha* = {jump.take_off.approach:.4f}"
        for letters, jump in study.jumps.items()
        if np.isfinite([jump.take_off.approach, jump.take_off.load, jump.landing.load]).all()
    ]
    yield f"The surfaces jump {listed(jumps)}." if jumps else "No jump was found."
    yield "Between the folds the branch is unstable." if np.any(~path.stable) else "No branch is unstable."
    yield elements_beside(fe, path, "approach", "load")


def _figure_2b(study: Greenwood1997) -> Figure:
    figure, axes = _scaled_curves(study, SOFT)
    dress(axes, drawing.SCALED_APPROACH, drawing.LOAD, legend="upper left", xlim=(-3.5, 3.5), ylim=(-5.6, 3))
    return figure


def _see_2b(study: Greenwood1997) -> Iterator[str]:
    """How the curves close in on JKR's at zero load, and where they jump on."""
    ends = np.array([_scaled(study, mu, "zero_load") for mu in SOFT])
    starts = np.array([_scaled(study, mu, "jump_on") for mu in SOFT])
    jkr = jkr_zero_load(1.0).approach
    closing = "closes in" if rises(-np.abs(ends - jkr)) else "does not close in"
    coming = "towards" if rises(-np.abs(starts)) else "not towards"
    span = f"from mu = {SOFT[0]:g} to {SOFT[-1]:g}"
    at_zero = f"At zero load alpha*/mu goes from {ends[0]:.4f} to {ends[-1]:.4f} {span}"
    yield told(f"{at_zero}: it {closing} on JKR's {jkr:.4f}.", ends)
    yield told(f"The jump on goes from alpha*/mu = {starts[0]:.3f} to {starts[-1]:.3f}, {coming} 0.", starts)


def _scaled(study: Greenwood1997, tabor: float, name: str) -> float:
    event = study.curves[tabor].event(name)
    return event.approach / tabor if event else float("nan")


SMALL = "Load against approach around pull-off, small Tabor parameters"
JUMPING = f"Load against approach at mu = {JUMPS_AT:g}, and the jumps under fixed grips"
FIGURES = (
    ("1a", SMALL, _figure_1a, _see_1a),
    ("1b", "The same with the approach in units of beta^2/R", _figure_1b, _see_1b),
    ("1c", f"Deep compression at mu = {RIGID[0]:g}", _figure_1c, _see_1c),
    ("2a", JUMPING, _figure_2a, _see_2a),
    ("2b", f"Load against scaled approach for mu = {SOFT[0]:g} to {SOFT[-1]:g}", _figure_2b, _see_2b),
)
