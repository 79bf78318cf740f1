"""Load against approach: figures after [G97] 1a to 2b."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.style import curve, dress, note, panels, theory
from fem_adhesion.greenwood import captions
from fem_adhesion.greenwood.captions import DMT_TABOR, RIGID, SCALED, SOFT
from fem_adhesion.greenwood.plot import Plot
from fem_adhesion.greenwood.study import JUMPS_AT, Greenwood1997
from halfspace.theories import dmt
from halfspace.theories.closed_forms import bradley_load, hertz_load, hertz_radius_at, jkr_approach, jkr_load
from halfspace.values import Array


def _figure_1a(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels(height=5.8)
    for mu in RIGID:
        curve(axes, mu, study.curves[mu].approach, study.curves[mu].load)
    apart = np.linspace(-2, 0.2, 300)
    theory(axes, "Bradley", apart, bradley_load(apart), "Bradley, $\\mu = 0$")
    _dmt(axes, DMT_TABOR, np.linspace(0, 0.6, 200), f", $\\mu = {DMT_TABOR:g}$")
    dress(axes, style.APPROACH, style.LOAD, legend="below", xlim=(-1.8, 0.6), ylim=(-6.8, 1.5))
    return figure


def _dmt(axes: Any, tabor: float, approach: Array, suffix: str) -> None:
    """Three DMT theories and Hertz's at one Tabor parameter."""
    theory(axes, "DMT force method", approach, dmt.force_load(approach, tabor), f"DMT force method{suffix}")
    theory(axes, "DMT thermodynamic", approach, dmt.thermodynamic_load(approach, tabor), f"DMT thermodynamic{suffix}")
    theory(axes, "DMT-M", approach, dmt.maugis_load(approach, tabor), f"DMT-M{suffix}")
    theory(axes, "Hertz", approach, hertz_load(hertz_radius_at(approach, tabor)), f"Hertz{suffix}")


def _figure_1b(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels()
    for mu in SCALED:
        curve(axes, mu, study.curves[mu].approach / mu, study.curves[mu].load)
    scaled = np.linspace(0, 4, 200)
    theory(axes, "DMT-M", scaled, dmt.maugis_load(scaled, 1.0))
    theory(axes, "Hertz", scaled, hertz_load(hertz_radius_at(scaled, 1.0)))
    radius = np.linspace(0, 3, 300)
    theory(axes, "JKR", jkr_approach(radius, 1.0), jkr_load(radius))
    dress(axes, style.SCALED_APPROACH, style.LOAD, legend="upper left", xlim=(-5, 3.5), ylim=(-6.6, 3))
    return figure


def _figure_1c(study: Greenwood1997) -> Figure:
    mu = RIGID[0]
    path = study.curves[mu]
    figure, (axes,) = panels()
    curve(axes, mu, path.approach, path.load)
    apart = np.linspace(-2, 0.32, 300)
    theory(axes, "Bradley", apart, bradley_load(apart), "Bradley, $\\mu = 0$")
    _dmt(axes, mu, np.linspace(0, 0.2, 200), "")
    dress(axes, style.APPROACH, style.LOAD, legend="upper left", xlim=(-0.6, 0.42), ylim=(-8, 20))
    return figure


def _figure_2a(study: Greenwood1997) -> Figure:
    path = study.curves[JUMPS_AT]
    figure, (axes,) = panels()
    style.branches(axes, path, path.approach, path.load)
    style.stability_key(axes)
    if fe := study.elements.get(JUMPS_AT):
        style.elements(axes, fe, fe.approach, fe.load)
    for jump in study.states.jumps:
        _arrow(axes, jump.approach.value, jump.load.value, jump.landing_load.value)
        left = jump.take_off == "C"
        for letter, load in ((jump.take_off, jump.load), (jump.landing, jump.landing_load)):
            note(axes, letter, (jump.approach.value, load.value), (-14, -4) if left else (7, 2), weight="bold")
    dress(axes, style.APPROACH, style.LOAD, legend="upper left", xlim=(-7, 4), ylim=(-5.6, 1.5))
    axes.set_title(rf"$\mu = {JUMPS_AT:g}$")
    return figure


def _arrow(axes: Any, approach: float, load: float, landing: float) -> None:
    arrow = {"arrowstyle": "-|>", "color": style.RED, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (approach, landing), xytext=(approach, load), arrowprops=arrow, zorder=1)


def _figure_2b(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels()
    for mu in SOFT:
        curve(axes, mu, study.curves[mu].approach / mu, study.curves[mu].load)
    radius = np.linspace(0, 3, 300)
    theory(axes, "JKR", jkr_approach(radius, 1.0), jkr_load(radius))
    dress(axes, style.SCALED_APPROACH, style.LOAD, legend="upper left", xlim=(-3.5, 3.5), ylim=(-5.6, 3))
    return figure


LOAD_PLOTS = (
    Plot(
        "1a",
        "Load against approach around pull-off, small Tabor parameters",
        captions.figure_1a,
        _figure_1a,
    ),
    Plot(
        "1b",
        "The same with the approach in units of beta^2/R",
        captions.figure_1b,
        _figure_1b,
    ),
    Plot(
        "1c",
        f"Deep compression at mu = {RIGID[0]:g}",
        captions.figure_1c,
        _figure_1c,
    ),
    Plot(
        "2a",
        f"Load against approach at mu = {JUMPS_AT:g}, and the jumps under fixed grips",
        captions.figure_2a,
        _figure_2a,
    ),
    Plot(
        "2b",
        f"Load against scaled approach for mu = {SOFT[0]:g} to {SOFT[-1]:g}",
        captions.figure_2b,
        _figure_2b,
    ),
)
