"""The figures of the paper, [G97] Figs 1a to 7, as lines of data; what they show of its claims, the claims tell."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.greenwood.drawing import (
    APPROACH,
    CONTACT_RADIUS,
    ELEMENTS,
    HALF_SPACE,
    LOAD,
    LOAD_OF_RIGID,
    MARKS,
    OF_TABOR,
    RADIUS,
    SCALED_APPROACH,
    TABOR,
    Axis,
    Line,
    Note,
    Plot,
    ends,
    half_space,
    points,
    theory,
)
from fem_adhesion.greenwood.study import DrawnState, Greenwood1997, PullOff
from halfspace.scaling import MYD
from halfspace.theories import dmt
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, bradley_load, jkr_approach, jkr_load
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array, Estimate

Made = Callable[[Greenwood1997], Plot]
TWO_PI = 2 * np.pi
GAP = Axis("gap", "eps", "gap $H$")
PRESSURE = Axis("pressure", "dgamma_per_mu_eps", "pressure $P$")
PULL_OFF = Axis("pull_off_force", "R_dgamma", r"pull-off force $-W_\mathrm{min}/R\Delta\gamma$")
ATTARD_PARKER = np.array([[1.0, 1.6], [6.7, 3.4]])  # mu and force over pi, the two values that [G97] quotes
BEFORE_AND_AFTER = ((style.BLUE, "-"), (style.RED, style.DASHED))
OFFSETS = {  # in points, of the letters in Fig. 2a
    "A": (7.0, -5.0), "B": (-15.0, -6.0), "C": (-15.0, -4.0), "D": (-15.0, 2.0),
    "A'": (9.0, -2.0), "B'": (6.0, -14.0), "C'": (7.0, -2.0), "D'": (-4.0, 8.0),
}  # fmt: skip


def curves(
    study: Greenwood1997, x: Axis, y: Axis, tabors: Sequence[float], *others: Line, elements: bool = False, **more: Any
) -> Plot:
    """Computed curves at some Tabor parameters, finite-element points on those that have any, and other lines."""
    lines = [half_space(study.curves[mu], x, y) for mu in tabors]
    if elements:
        lines += [points(ELEMENTS, study.elements[mu], mu, x, y) for mu in tabors if mu in study.elements]
    return Plot(x, y, [*lines, *others], **more)


def bradley(low: float, high: float) -> Line:
    """Bradley's load between two approaches in eps."""
    approach = np.linspace(low, high, 300)
    return theory("Bradley", approach, bradley_load(approach))


def jkr(tabor: float, load_unit: float = 1.0) -> Line:
    """JKR's whole curve, from no contact on."""
    radius = np.linspace(0, 4.2, 800)
    return theory("JKR", jkr_approach(radius, tabor), jkr_load(radius) / load_unit)


def dmt_m(approach: Array, tabor: float, load_unit: float = 1.0) -> Line:
    """DMT-M at approaches."""
    return theory("DMT-M", approach, dmt.maugis_load(approach, tabor) / load_unit)


def maugis_radius(tabor: float, radius: Array) -> Line:
    """Maugis's theory of the same largest tension, as a thin line."""
    look = {"color": OF_TABOR[tabor], "linewidth": 1.0}
    return Line("Maugis-Dugdale", tabor, MaugisDugdale.matched(tabor).load(radius), radius, look)


def profiles(
    study: Greenwood1997,
    axis: Axis,
    states: Sequence[DrawnState],
    looks: Sequence[tuple[str, Any]],
    legend: str,
) -> Plot:
    """Gap or pressure of states along the radius."""
    mu, lines = study.settings.winding_at, []
    for state, (colour, dashes) in zip(states, looks, strict=False):
        values, errors = getattr(state, axis.quantity), getattr(state, f"{axis.quantity}_error")
        gap = round(state.central_gap, 9) + 0.0  # not -0
        look = {"color": colour, "linestyle": dashes, "linewidth": 1.8}
        label = f"$H(0) = {gap:.4g}$"
        lines.append(Line(f"H(0) = {gap:g}", mu, state.radii, values, look, None, errors, label=label))
    return Plot(RADIUS.within(0, 3), axis, lines, title=rf"$\mu = {mu:g}$", legend=legend)


def _fig_2a(study: Greenwood1997) -> Plot:
    """The vertical tangent at mu near 1, and the jumps at fixed grips and in an apparatus, along its load lines."""
    arrows, notes, lines = [], [], []
    mu, k = study.settings.jumps_at, study.settings.apparatus
    for letters, jump in study.jumps.items():
        primed = "'" in letters[0]
        look = {"color": style.PINK if primed else "black", "linewidth": 1.4}
        line, arrow = ends(f"jump {' to '.join(letters)}", mu, jump, look)
        lines.append(line)
        arrows.append(arrow)
        notes += [
            Note(letter, at, OFFSETS[letter]) for letter, at in zip(letters, (arrow.tail, arrow.head), strict=True)
        ]
        if primed:
            approach = np.array([line.x.min() - 0.35, line.x.max() + 0.35])
            label = rf"load lines, $k = {k:g}\,R\Delta\gamma/\epsilon$" if letters[0] == "A'" else ""
            look = {"color": style.PINK, "linestyle": style.DOTTED, "linewidth": 1.2}
            load = line.y[0] - k * (approach - line.x[0])
            lines.append(Line(f"load line of {letters[0]}", mu, approach, load, look, label=label))
    x, y = APPROACH.within(-3.6, 0.8), LOAD.within(-6.2, 0.4)
    return curves(study, x, y, (0.5, 0.7, mu), *lines, arrows=arrows, notes=notes, legend="lower left")


def _fig_3(tabor: float, low: float, high: float, *others: Line) -> Made:
    """The S-shaped curve, and states found by prescribing the central gap."""

    def made(study: Greenwood1997) -> Plot:
        specified = points("central gap specified", study.specified[tabor], tabor, APPROACH, LOAD)
        x, y, title = APPROACH.within(low, high), LOAD.within(-5.6, 1.0), rf"$\mu = {tabor:g}$"
        return curves(study, x, y, (tabor,), specified, *others, title=title, legend="lower right")

    return made


def _fig_5(study: Greenwood1997) -> Plot:
    radius = np.linspace(1e-3, 2.9, 400)
    theories = theory("JKR", jkr_load(radius), radius), *(maugis_radius(mu, radius) for mu in (0.5, 2.0))
    x, y = LOAD.within(-6.5, 5), CONTACT_RADIUS.within(0, 2.8)
    return curves(study, x, y, (0.5, 2.0, 5.0), *theories, elements=True, legend="below")


def _fig_6a(_: Greenwood1997) -> Plot:
    """The recalculated DMT theory: Bradley's load apart, Hertz's and that of the surface forces in contact."""
    scaled = np.concatenate([np.linspace(-4, 0, 120), np.geomspace(1e-6, 4, 200)])
    lines = []
    for mu in (0.1, 0.2, 0.5, 1.0):
        apart, contact = bradley_load(mu * scaled[scaled <= 0]), dmt.force_load(mu * scaled[scaled > 0], mu)
        look, loads = {"color": OF_TABOR[mu], "linewidth": 1.9}, np.concatenate([apart, contact]) / TWO_PI
        lines.append(Line("DMT force method", mu, scaled, loads, look, label=rf"$\mu = {mu:g}$"))
    lines.append(dmt_m(np.linspace(0, 4, 200), 1.0, TWO_PI))
    return Plot(SCALED_APPROACH.within(-3, 3), LOAD_OF_RIGID.within(-1.45, 0.4), lines)


def _fig_6b(study: Greenwood1997) -> Plot:
    x, y = SCALED_APPROACH.within(-4, 4), LOAD_OF_RIGID.within(-1.15, 0.6)
    return curves(study, x, y, (0.05, 0.1, 0.2, 0.5, 1.0), dmt_m(np.linspace(0, 4, 200), 1.0, TWO_PI))


def forces(
    found: Sequence[PullOff],
    get: Callable[[PullOff], Estimate | None],
    curve: str,
    look: Mapping[str, Any],
    label: str | None,
) -> Line:
    """Pull-off forces with their errors against the Tabor parameter."""
    rows = [(p.tabor, -load.value, load.error) for p in found if (load := get(p))]
    tabor, force, error = np.reshape(rows, (-1, 3)).T
    return Line(curve, None, tabor, force, {"color": style.BLUE, **look}, None, error, label=label)


def _fig_7(study: Greenwood1997) -> Plot:
    """Pull-off force against the Tabor parameter: the solvers, Maugis, and Attard & Parker."""
    label, line = "half-space; Muller et al. solved the same equations", {"linewidth": 2, "marker": "."}
    solved = forces(study.pull_offs, lambda p: p.half_space, HALF_SPACE, line, label)
    tabor = solved.x
    attard: dict[str, Any] = {"color": style.RED, "linestyle": style.DASHED, "marker": "s"}
    maugis = np.array([-MaugisDugdale.matched(mu).pull_off().load for mu in tabor])
    lines = [
        solved,
        forces(study.pull_offs, lambda p: p.finite_element, ELEMENTS, MARKS, None),
        theory("Maugis-Dugdale", tabor, maugis, color=style.GREEN, linestyle=style.CHAIN),
        theory("Attard & Parker, the two values quoted", ATTARD_PARKER[:, 0], np.pi * ATTARD_PARKER[:, 1], **attard),
        theory("Bradley", tabor, np.full_like(tabor, -BRADLEY_PULL_OFF), linewidth=1.0),
        theory("JKR", tabor, np.full_like(tabor, -JKR_PULL_OFF), linewidth=1.0),
    ]
    above = (r"parameter of Muller et al., $\mu_D$", float(MYD.of(1.0)))
    return Plot(TABOR, PULL_OFF.within(4.4, 11.2), lines, above=above)


FIGURES: Mapping[str, tuple[str, Made]] = {
    "1a": (
        "Load against approach at low Tabor parameters, with Bradley's equation",
        lambda s: curves(
            s,
            APPROACH.within(-2.2, 0.8),
            LOAD.within(-6.8, 1.5),
            (0.05, 0.1, 0.2, 0.5),
            bradley(-2.5, 0.24),
            legend="below",
        ),
    ),
    "1b": (
        "The numerical results at mu = 0.05 compared with Bradley's equation",
        lambda s: curves(s, APPROACH.within(-3, 0.4), LOAD.within(-6.8, 2.5), (0.05,), bradley(-4, 0.3)),
    ),
    "1c": (
        "Compressive loads at mu = 0.02, with the theories of Bradley, JKR and DMT-M",
        lambda s: curves(
            s,
            APPROACH.within(-0.3, 0.5),
            LOAD.within(-8, 50),
            (0.02,),
            *(bradley(-0.4, 0.36), jkr(0.02), dmt_m(np.linspace(0, 0.26, 200), 0.02)),
        ),
    ),
    "2a": ("Near mu = 1 the tangent becomes vertical: jumps at fixed grips and in an apparatus", _fig_2a),
    "2b": (
        "Load against approach at higher Tabor parameters, with JKR's theory",
        lambda s: curves(
            s,
            SCALED_APPROACH.within(-3.2, 3.2),
            LOAD_OF_RIGID.within(-0.95, 0.5),
            (1.0, 2.0, 3.0, 5.0),
            jkr(1.0, TWO_PI),
            elements=True,
        ),
    ),
    "3a": ("Load against approach with the central gap specified, mu = 1", _fig_3(1.0, -3.5, 2.5)),
    "3b": ("Load against approach with the central gap specified, mu = 2", _fig_3(2.0, -5.5, 5.0)),
    "3c": (
        "Load against approach with the central gap specified, mu = 3, with JKR's theory",
        _fig_3(3.0, -7.0, 7.0, jkr(3.0)),
    ),
    "4a": (
        "The jump into contact at mu = 5: pressures before and after",
        lambda s: profiles(s, PRESSURE.within(-5.6, 1.4), s.profiles, BEFORE_AND_AFTER, "best"),
    ),
    "4b": (
        "The jump into contact at mu = 5: shape before and after",
        lambda s: profiles(s, GAP.within(-0.3, 8), s.profiles, BEFORE_AND_AFTER, "best"),
    ),
    "5": ("Contact radius against load, with the theories of JKR and Maugis", _fig_5),
    "6a": ("The recalculated DMT theory against alpha*/mu, with its limit DMT-M", _fig_6a),
    "6b": ("Numerical results at low Tabor parameters against alpha*/mu, with the limit of the DMT theory", _fig_6b),
    "7": ("Pull-off force against Tabor parameter, with Maugis's theory and Attard & Parker's values", _fig_7),
}
