"""Central gap, profiles and contact radius: figures after [G97] 3a to 5."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.style import branches, curve, dress, note, panels, theory
from fem_adhesion.greenwood import captions
from fem_adhesion.greenwood.captions import GAPS_AT, RADII_AT
from fem_adhesion.greenwood.plot import Plot
from fem_adhesion.greenwood.study import WINDING_AT, Greenwood1997
from halfspace.scaling import MAUGIS
from halfspace.theories.closed_forms import hertz_load, jkr_load
from halfspace.theories.maugis import MaugisDugdale, carpick_radius
from halfspace.values import Array

THEORIES_AT = (0.5, 2.0)
FOLD_NUMBERS = ((0, (8, 0)), (1, (-16, -3)), (1, (8, -3)), (0, (-4, 9)))  # panel and offset in points
PROFILE_STYLES = (
    (style.SKY, "-"),
    (style.BLUE, style.DASHED),
    (style.GREEN, style.CHAIN),
    (style.PINK, style.LONG),
    (style.ORANGE, style.DOTTED),
    (style.RED, style.DASHED),
    ("black", "-"),
)


def _figure_3a(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels()
    for mu, place in zip(GAPS_AT, ((-0.75, 0.6), (-2.45, 0.4), (-3.45, 0.9), (-5.3, 1.2)), strict=True):
        path = study.curves[mu]
        branches(axes, path, path.approach, path.central_gap)
        _name(axes, mu, place)
    style.stability_key(axes)
    dress(axes, style.APPROACH, style.CENTRAL_GAP, legend="upper right", xlim=(-9, 2), ylim=(-0.4, 6))
    return figure


def _name(axes: Any, tabor: float, at: tuple[float, float]) -> None:
    """Name a curve in its colour."""
    axes.text(*at, rf"$\mu = {tabor:g}$", color=style.OF_TABOR[tabor], fontsize=11, weight="bold")


def _figure_3b(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels()
    for mu, place in zip(GAPS_AT, ((-3.9, 0.45), (-2.15, 0.33), (-1.3, 0.55), (-0.5, 1.5)), strict=True):
        path = study.curves[mu]
        branches(axes, path, path.load, path.central_gap)
        _name(axes, mu, place)
        if fe := study.elements.get(mu):
            style.elements(axes, fe, fe.load, fe.central_gap, rf"finite elements, $\mu = {mu:g}$")
    style.stability_key(axes)
    dress(axes, style.LOAD, style.CENTRAL_GAP, legend="upper left", xlim=(-6, 1), ylim=(-0.2, 4.5))
    return figure


def _figure_3c(study: Greenwood1997) -> Figure:
    path, folds = study.curves[WINDING_AT], study.states.folds
    figure, (whole, close) = panels(2)
    for axes in (whole, close):
        branches(axes, path, path.approach, path.central_gap)
        axes.plot(folds[:, 0], folds[:, 2], "o", color="black", markersize=5, label="folds")
    style.stability_key(whole)
    for number, fold in enumerate(folds):
        axes, offset = FOLD_NUMBERS[min(number, len(FOLD_NUMBERS) - 1)]
        note((whole, close)[axes], str(number + 1), (fold[0], fold[2]), offset)
    dress(whole, style.APPROACH, style.CENTRAL_GAP, legend="upper right", xlim=(-9, 0), ylim=(-0.3, 6))
    dress(close, style.APPROACH, style.CENTRAL_GAP, legend=None, xlim=(-4.56, -4.42), ylim=(-0.05, 1.3))
    whole.set_title(rf"$\mu = {WINDING_AT:g}$")
    close.set_title("enlarged around the inner folds")
    return figure


def _figure_4(study: Greenwood1997, quantity: str, label: str, ylim: tuple[float, float]) -> Figure:
    figure, (axes,) = panels(height=5.8)
    for profile, (colour, dashes) in zip(study.states.profiles, PROFILE_STYLES, strict=False):
        values = getattr(profile, quantity)
        text = f"$H(0) = {profile.central_gap:.4g}$" if abs(profile.central_gap) > 1e-9 else "$H(0) = 0$"
        axes.plot(profile.radii, values, color=colour, linestyle=dashes, linewidth=1.8, label=text)
    dress(axes, style.RADIUS, label, legend="below", xlim=(0, 3), ylim=ylim)
    axes.set_title(rf"$\mu = {WINDING_AT:g}$")
    return figure


def _figure_4a(study: Greenwood1997) -> Figure:
    return _figure_4(study, "gap", "gap $H$", (-0.3, 8))


def _figure_4b(study: Greenwood1997) -> Figure:
    return _figure_4(study, "pressure", "pressure $P$", (-5.6, 1.4))


def _figure_5(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels(height=6.4)
    radius = np.linspace(1e-3, 2.9, 400)
    for mu in RADII_AT:
        path = study.curves[mu]
        curve(axes, mu, path.load, path.contact_radius)
        if fe := study.elements.get(mu):
            style.elements(axes, fe, fe.load, fe.contact_radius, rf"finite elements, $\mu = {mu:g}$")
    theory(axes, "JKR", jkr_load(radius), radius)
    theory(axes, "Hertz", hertz_load(radius), radius)
    for mu in THEORIES_AT:
        _maugis(axes, mu, radius)
    dress(axes, style.LOAD, r"contact radius $a^* = a/\beta$", legend="below", xlim=(-6.5, 5), ylim=(0, 2.8))
    return figure


def _maugis(axes: Any, tabor: float, radius: Array) -> None:
    """Maugis-Dugdale of the same largest tension, and the interpolation of it by Carpick and others, as thin lines."""
    theory = MaugisDugdale.matched(tabor)
    load = np.linspace(theory.pull_off().load, 5, 400)
    thin = {"color": style.OF_TABOR[tabor], "linewidth": 1.0}
    axes.plot(theory.load(radius), radius, label=rf"Maugis-Dugdale, $\mu = {tabor:g}$", **thin)
    label = rf"Carpick et al., $\mu = {tabor:g}$"
    axes.plot(load, carpick_radius(load, MAUGIS.of(tabor)), linestyle=style.DOTTED, label=label, **thin)


STATE_PLOTS = (
    Plot(
        "3a",
        "Central gap against approach",
        captions.figure_3a,
        _figure_3a,
    ),
    Plot(
        "3b",
        "Central gap against load",
        captions.figure_3b,
        _figure_3b,
    ),
    Plot(
        "3c",
        f"Central gap against approach at mu = {WINDING_AT:g}, and its folds",
        captions.figure_3c,
        _figure_3c,
    ),
    Plot(
        "4a",
        f"Gap profiles along the curve at mu = {WINDING_AT:g}",
        captions.figure_4a,
        _figure_4a,
    ),
    Plot(
        "4b",
        "Pressure profiles of the same states",
        captions.figure_4b,
        _figure_4b,
    ),
    Plot(
        "5",
        "Contact radius against load",
        captions.figure_5,
        _figure_5,
    ),
)
