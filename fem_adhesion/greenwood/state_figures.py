"""Central gap, profiles and contact radius: figures after [G97] 3a to 5, each with what is to be seen in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import listed, plus_minus, told
from fem_adhesion.common.style import dress, note, panels
from fem_adhesion.greenwood import drawing
from fem_adhesion.greenwood.drawing import branches, curve, elements_beside, gap_falls, rises, theory
from fem_adhesion.greenwood.study import WINDING_AT, Greenwood1997
from halfspace.accuracy.fold_birth import count_folds
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import MAUGIS
from halfspace.theories.closed_forms import hertz_load, jkr_load, jkr_zero_load
from halfspace.theories.maugis import MaugisDugdale, carpick_radius
from halfspace.values import Array

GAPS_AT = (0.5, 1.0, 2.0, 5.0)  # of Figs 3a and 3b
RADII_AT = (0.5, 2.0, 5.0)  # of Fig. 5
NEAR = 0.01  # relative difference below which two heights are called the same
INSIDE = 0.8  # of the contact radius: where the gap is looked at for being flat
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


def _gaps(study: Greenwood1997, along: str, places: Sequence[tuple[float, float]]) -> tuple[Figure, Any]:
    """Central gaps along the curves, each curve named in its colour at a place."""
    figure, (axes,) = panels()
    for mu, place in zip(GAPS_AT, places, strict=True):
        path = study.curves[mu]
        branches(axes, path, along, "central_gap")
        axes.text(*place, rf"$\mu = {mu:g}$", color=drawing.OF_TABOR[mu], fontsize=11, weight="bold")
    return figure, axes


def _figure_3a(study: Greenwood1997) -> Figure:
    figure, axes = _gaps(study, "approach", ((-0.75, 0.6), (-2.45, 0.4), (-3.45, 0.9), (-5.3, 1.2)))
    drawing.stability_key(axes)
    dress(axes, drawing.APPROACH, drawing.CENTRAL_GAP, legend="upper right", xlim=(-9, 2), ylim=(-0.4, 6))
    return figure


def _see_3a(study: Greenwood1997) -> Iterator[str]:
    """Folds of each curve, and the first of all."""
    folds = [f"{count_folds(study.curves[mu])} at mu = {mu:g}" for mu in GAPS_AT]
    finite = all(np.all(np.isfinite(study.curves[mu].approach)) for mu in GAPS_AT)
    critical = study.critical_tabor
    yield f"The approach turns so many times: {listed(folds)}." if finite else ""
    yield told(f"It first turns at mu = {plus_minus(critical)}.", critical.value, critical.error)


def _figure_3b(study: Greenwood1997) -> Figure:
    figure, axes = _gaps(study, "load", ((-3.9, 0.45), (-2.15, 0.33), (-1.3, 0.55), (-0.5, 1.5)))
    for mu in GAPS_AT:
        if fe := study.elements.get(mu):
            drawing.elements(axes, fe, fe.load, fe.central_gap, rf"finite elements, $\mu = {mu:g}$")
    drawing.stability_key(axes)
    dress(axes, drawing.LOAD, drawing.CENTRAL_GAP, legend="upper left", xlim=(-6, 1), ylim=(-0.2, 4.5))
    return figure


def _see_3b(study: Greenwood1997) -> Iterator[str]:
    """The gap as a control, at pull-off, and by finite elements."""
    gaps = np.array([study.curves[mu].events["pull_off"].central_gap for mu in GAPS_AT])
    falling = all(gap_falls(study.curves[mu]) for mu in GAPS_AT)
    told_of = "negative at each" if np.all(gaps < 0) else "not negative at each"
    yield f"The central gap {'falls all along every curve' if falling else 'does not fall all along'}."
    yield told(f"At pull-off it is {gaps.min():.4f} to {gaps.max():.4f} eps, {told_of} mu.", gaps)
    for mu in GAPS_AT:
        yield elements_beside(study.elements.get(mu), study.curves[mu], "load", "central_gap")


def _figure_3c(study: Greenwood1997) -> Figure:
    path, folds = study.curves[WINDING_AT], study.folds
    figure, (whole, close) = panels(2)
    for axes in (whole, close):
        branches(axes, path, "approach", "central_gap")
        axes.plot(folds[:, 0], folds[:, 2], "o", color="black", markersize=5, label="folds")
    drawing.stability_key(whole)
    for number, fold in enumerate(folds):
        axes, offset = FOLD_NUMBERS[min(number, len(FOLD_NUMBERS) - 1)]
        note((whole, close)[axes], str(number + 1), (fold[0], fold[2]), offset)
    dress(whole, drawing.APPROACH, drawing.CENTRAL_GAP, legend="upper right", xlim=(-9, 0), ylim=(-0.3, 6))
    dress(close, drawing.APPROACH, drawing.CENTRAL_GAP, legend=None, xlim=(-4.56, -4.42), ylim=(-0.05, 1.3))
    whole.set_title(rf"$\mu = {WINDING_AT:g}$")
    close.set_title("enlarged around the inner folds")
    return figure


def _see_3c(study: Greenwood1997) -> Iterator[str]:
    """How many folds there are, and what falls."""
    path, count = study.curves[WINDING_AT], len(study.folds)
    between = f", {count - 2} of them between jump-on and jump-off" if count > 2 else ""
    falls = "falls" if gap_falls(path) else "does not fall"
    yield f"The approach has {count} folds{between}."
    yield told(f"The central gap {falls} all along the curve.", path.central_gap)


def _figure_4(study: Greenwood1997, quantity: str, label: str, ylim: tuple[float, float]) -> Figure:
    figure, (axes,) = panels(height=5.8)
    for profile, (colour, dashes) in zip(study.profiles, PROFILE_STYLES, strict=False):
        values = getattr(profile, quantity)
        text = f"$H(0) = {profile.central_gap:.4g}$" if abs(profile.central_gap) > 1e-9 else "$H(0) = 0$"
        axes.plot(profile.radii, values, color=colour, linestyle=dashes, linewidth=1.8, label=text)
    dress(axes, drawing.RADIUS, label, legend="below", xlim=(0, 3), ylim=ylim)
    axes.set_title(rf"$\mu = {WINDING_AT:g}$")
    return figure


def _see_4a(study: Greenwood1997) -> Iterator[str]:
    """How flat the gap is inside the last contact."""
    shown = study.profiles
    if not shown:
        return
    last = shown[-1]
    inside = last.gap[last.radii < INSIDE * last.contact_radius]
    spread = float(np.ptp(inside)) if inside.size else float("nan")
    text = (
        f"From the first to the last state the central gap goes from {shown[0].central_gap:.4g} to "
        f"{last.central_gap:.4g} eps; in the last the gap varies by {spread:.2g} eps inside {INSIDE:g} of the contact "
        f"radius, {last.contact_radius:.3f} beta."
    )
    yield told(text, spread, shown[0].central_gap, last.central_gap)


def _see_4b(study: Greenwood1997) -> Iterator[str]:
    """Height and place of the largest tension."""
    touching = [p for p in study.profiles if np.isfinite(p.contact_radius)]
    if not touching:
        return
    heights = np.array([-p.pressure.min() for p in touching]) / WINDING_AT
    places = np.array([p.radii[p.pressure.argmin()] for p in touching])
    strength = -float(LENNARD_JONES.pressure(np.array(LENNARD_JONES.edge_gap), 1.0))
    same = "is" if np.all(np.abs(heights / strength - 1) < NEAR) else "is not"
    outwards = "moves outwards" if rises(places) else "does not always move outwards"
    text = (
        f"In contact the largest tension {same} the strength of the surface law, {strength:.3f} mu: it is "
        f"{heights.min():.3f} to {heights.max():.3f} mu. Its place {outwards}, from {places[0]:.2f} to "
        f"{places[-1]:.2f} beta."
    )
    yield told(text, heights, places)


def _figure_5(study: Greenwood1997) -> Figure:
    figure, (axes,) = panels(height=6.4)
    radius = np.linspace(1e-3, 2.9, 400)
    for mu in RADII_AT:
        path = study.curves[mu]
        curve(axes, mu, path.load, path.contact_radius)
        if fe := study.elements.get(mu):
            drawing.elements(axes, fe, fe.load, fe.contact_radius, rf"finite elements, $\mu = {mu:g}$")
    theory(axes, "JKR", jkr_load(radius), radius)
    theory(axes, "Hertz", hertz_load(radius), radius)
    for mu in THEORIES_AT:
        _maugis(axes, mu, radius)
    dress(axes, drawing.LOAD, r"contact radius $a^* = a/\beta$", legend="below", xlim=(-6.5, 5), ylim=(0, 2.8))
    return figure


def _maugis(axes: Any, tabor: float, radius: Array) -> None:
    """Maugis-Dugdale of the same largest tension, and the interpolation of it by Carpick and others, as thin lines."""
    theory = MaugisDugdale.matched(tabor)
    load = np.linspace(theory.pull_off().load, 5, 400)
    thin = {"color": drawing.OF_TABOR[tabor], "linewidth": 1.0}
    axes.plot(theory.load(radius), radius, label=rf"Maugis-Dugdale, $\mu = {tabor:g}$", **thin)
    label = rf"Carpick et al., $\mu = {tabor:g}$"
    axes.plot(load, carpick_radius(load, MAUGIS.of(tabor)), linestyle=style.DOTTED, label=label, **thin)


def _see_5(study: Greenwood1997) -> Iterator[str]:
    """Radius at zero load beside JKR's and Maugis-Dugdale's."""
    radii = np.array([_zero_load_radius(study.curves[mu]) for mu in RADII_AT])
    jkr = jkr_zero_load(1.0).contact_radius
    closing = "closes in" if rises(-np.abs(radii - jkr)) else "does not close in"
    maugis = float(MaugisDugdale.matched(RADII_AT[0]).load(radii[0])) if np.isfinite(radii[0]) else float("nan")
    size = "smaller" if maugis > 0 else "not smaller"
    sizes = listed([f"{radius:.3f} at mu = {mu:g}" for mu, radius in zip(RADII_AT, radii, strict=True)])
    yield told(f"At zero load the radius is {sizes}, in beta: it {closing} on JKR's {jkr:.3f} all along.", radii)
    yield told(f"Maugis-Dugdale's, the inner edge of its ring of tension, is {size} at mu = {RADII_AT[0]:g}.", maugis)
    for mu in RADII_AT:
        yield elements_beside(study.elements.get(mu), study.curves[mu], "load", "contact_radius")


def _zero_load_radius(path: EquilibriumPath) -> float:
    event = path.event("zero_load")
    return event.contact_radius if event else float("nan")


GAPS = partial(_figure_4, quantity="gap", label="gap $H$", ylim=(-0.3, 8))
PRESSURES = partial(_figure_4, quantity="pressure", label="pressure $P$", ylim=(-5.6, 1.4))
FIGURES = (
    ("3a", "Central gap against approach", _figure_3a, _see_3a),
    ("3b", "Central gap against load", _figure_3b, _see_3b),
    ("3c", f"Central gap against approach at mu = {WINDING_AT:g}, and its folds", _figure_3c, _see_3c),
    ("4a", f"Gap profiles along the curve at mu = {WINDING_AT:g}", GAPS, _see_4a),
    ("4b", "Pressure profiles of the same states", PRESSURES, _see_4b),
    ("5", "Contact radius against load", _figure_5, _see_5),
)
