"""What the paper does not draw: gaps along the curves, criteria for jumping, grids that are too coarse, apparatus."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.common.numbers import digits, listed, plus_minus, told
from fem_adhesion.greenwood.drawing import (
    APPROACH,
    CENTRAL_GAP,
    CONTACT_RADIUS,
    HALF_SPACE,
    LOAD,
    MARKS,
    OF_TABOR,
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
from fem_adhesion.greenwood.figures import (
    GAP,
    PRESSURE,
    PULL_OFF,
    Made,
    bradley,
    curves,
    forces,
    maugis_radius,
    profiles,
)
from fem_adhesion.greenwood.study import Greenwood1997
from halfspace.equilibrium.events import is_fold
from halfspace.scaling import MAUGIS
from halfspace.theories import dmt
from halfspace.theories.closed_forms import hertz_load, hertz_radius_at
from halfspace.theories.maugis import carpick_pull_off, carpick_radius
from halfspace.values import Array

GAPS_AT = (0.5, 1.0, 2.0, 5.0)  # Tabor parameters of central gaps
STATES = (
    (style.SKY, "-"),
    (style.BLUE, style.DASHED),
    (style.GREEN, style.CHAIN),
    (style.PINK, style.LONG),
    (style.ORANGE, style.DOTTED),
)
CRITERIA: Mapping[str, tuple[str, Any]] = {
    "Attard & Parker": (style.RED, style.DASHED),
    "Pethica & Sutton": (style.ORANGE, style.CHAIN),
    "App. C": (style.PINK, style.LONG),
    "fit (4.5)": (style.BLUE, "-"),
    "fit of App. C": (style.GREEN, "-"),
}
SPACINGS: Mapping[float, tuple[str, Any]] = {
    0.2: (style.RED, style.CHAIN),
    0.1: (style.ORANGE, style.DASHED),
    0.05: (style.PINK, style.LONG),
    0.025: (style.SKY, "-"),
}
STIFFNESSES = {math.inf: (style.RED, "-"), 3.0: (style.GREEN, style.DASHED), 1.0: (style.ORANGE, style.CHAIN)}
STIFFNESS = Axis(
    "stiffness", "R_dgamma_per_eps", r"stiffness $k\,\epsilon/R\Delta\gamma$", (1, 1000), (1, 3, 10, 30, 100, 300), True
)


def _theories(study: Greenwood1997) -> Plot:
    """The DMT theories and Hertz's at a low Tabor parameter."""
    mu, approach = 0.1, np.linspace(0, 0.6, 200)
    loads = {
        "DMT force method": dmt.force_load(approach, mu),
        "DMT thermodynamic": dmt.thermodynamic_load(approach, mu),
        "DMT-M": dmt.maugis_load(approach, mu),
        "Hertz": hertz_load(hertz_radius_at(approach, mu)),
    }
    lines = [theory(name, approach, load, mu) for name, load in loads.items()]
    x, y = APPROACH.within(-1.8, 0.6), LOAD.within(-6.8, 1.5)
    return curves(study, x, y, (mu,), bradley(-2.5, 0.2), *lines, legend="below")


def _gap_approach(study: Greenwood1997) -> Plot:
    turns = [f"{sum(map(is_fold, study.curves[mu].events))} at mu = {mu:g}" for mu in GAPS_AT]
    x, y, see = (
        APPROACH.within(-9, 2),
        CENTRAL_GAP.within(-0.4, 6),
        f"The approach turns so many times: {listed(turns)}.",
    )
    return curves(study, x, y, GAPS_AT, see=[see], legend="upper right")


def _folds(study: Greenwood1997) -> Plot:
    """Enlarged, the folds between jump-on and jump-off where the curve winds."""
    mu = study.settings.winding_at
    look = {"linestyle": style.DOTTED, "linewidth": 1.9}
    line = points("unstable branch", study.specified[mu], mu, APPROACH, CENTRAL_GAP, look)
    rows = [(f.approach, f.central_gap, f.approach_error, f.central_gap_error) for f in study.folds]
    x, y, dx, dy = np.reshape(rows, (-1, 4)).T
    marks = Line("folds", mu, x, y, {**MARKS, "color": "black"}, dx, dy, label="folds")
    notes = [Note(str(n), (x[n - 1], y[n - 1])) for n in range(2, len(rows))]
    see = f"The approach has {len(rows)} folds, at alpha* = {listed([f'{value:.4f}' for value in x])}."
    axes = APPROACH.within(-4.56, -4.42), CENTRAL_GAP.within(-0.05, 1.3)
    return Plot(*axes, [line, marks], [told(see, x)], notes=notes)


def _radius(study: Greenwood1997) -> Plot:
    """Contact radius against load, with further theories."""
    at, tabors = np.linspace(1e-3, 2.9, 400), (0.5, 2.0)
    lines, off = [theory("Hertz", hertz_load(at), at), *(maugis_radius(mu, at) for mu in tabors)], []
    for mu in tabors:
        load = np.linspace(float(carpick_pull_off(MAUGIS.of(mu))), 5, 400)
        look = {"color": OF_TABOR[mu], "linestyle": style.DOTTED}
        lines.append(Line("Carpick et al.", mu, load, carpick_radius(load, MAUGIS.of(mu)), look))
        radius = study.curves[mu].events["zero_load"].contact_radius
        off.append(f"{100 * (float(carpick_radius(0.0, MAUGIS.of(mu))) / radius - 1):+.1f} % at mu = {mu:g}")
    x, y = LOAD.within(-6.5, 5), CONTACT_RADIUS.within(0, 2.8)
    see = f"At zero load the radius of Carpick et al. is off the solution's by {listed(off)}."
    return curves(study, x, y, (0.5, 2.0, 5.0), *lines, see=[see], legend="below")


def _criteria(quantity: str, label: str, sign: int, low: float, high: float) -> Made:
    """Central gap or approach at jump-on plus one over mu^(3/7): true jumps as markers, and what criteria predict."""
    axis = Axis(f"{quantity}_at_jump_on", "over_mu_3_7_eps", label, (low, high))

    def made(study: Greenwood1997) -> Plot:
        def scaled(values: Array, tabor: Array) -> Array:
            return np.asarray((1 + sign * values) / tabor ** (3 / 7))

        mu, jumps = study.criteria.tabor, study.criteria.jumps
        errors = np.array([getattr(jump, quantity).error for jump in jumps]) / mu ** (3 / 7)
        true = scaled(getattr(study.criteria, quantity), mu)
        lines = [Line("true jumps", None, mu, true, {**MARKS, "color": "black"}, None, errors)]
        tabor = np.geomspace(0.72, max(mu, default=1.0), 200)
        for one in study.criteria.criteria:
            if one.predict and one.of_approach == (quantity == "approach"):
                look = dict(zip(("color", "linestyle"), CRITERIA[one.name], strict=True))
                lines.append(Line(one.name, None, tabor, scaled(one.predict(tabor), tabor), look))
        return Plot(TABOR, axis, lines, legend="lower right")

    return made


def _spacing(spacing: float, tabor: float | None, x: Array, y: Array) -> Line:
    """A line of what uniform triangles give, wrong on purpose, so without an error."""
    colour, dashes = SPACINGS[spacing]
    look, label = {"color": colour, "linestyle": dashes, "linewidth": 1.4}, rf"uniform triangles, ${spacing:g}\,\beta$"
    return Line(f"uniform triangles {spacing:g} beta", tabor, x, y, look, label=label)


def _coarse(study: Greenwood1997) -> Plot:
    """The pull-off force on uniform grids that are too coarse."""
    high = [p for p in study.pull_offs if p.tabor > 0.5]
    lines = [forces(high, lambda p: p.half_space, HALF_SPACE, {"linewidth": 2}, "resolved")]
    for spacing, rise in study.rises.items():
        lines.append(_spacing(spacing, None, *np.reshape([(r.tabor, -r.pull_off) for r in rise.ripples], (-1, 2)).T))
    return Plot(TABOR.within(0.7, 20), PULL_OFF.within(4.5, 7), lines)


def _ripple(study: Greenwood1997) -> Plot:
    """The ripple of the curve on the same grids, through pull-off."""
    mu = study.settings.ripple_at
    path = study.curves[mu]
    lines = [_spacing(r.spacing, r.tabor, r.approach, r.load) for r in study.ripples]
    least = listed([f"{-r.pull_off:.3f} at {r.spacing:g} beta" for r in study.ripples])
    see = f"The largest tension is {least}, where it is {-path.events['pull_off'].load:.3f} R dgamma."
    x, y = APPROACH.within(-3.2, 1.2), LOAD.within(-6.3, -2.6)
    return Plot(x, y, [*lines, half_space(path, x, y)], [see], title=rf"$\mu = {mu:g}$", legend="below")


def _devices(study: Greenwood1997) -> Plot:
    """Jumps in apparatus of several stiffnesses, as lines under their arrows."""
    mu, jumps = study.settings.devices_at, []
    for cycle in study.cycles:
        if cycle.stiffness in STIFFNESSES:
            k, (colour, dashes) = cycle.stiffness, STIFFNESSES[cycle.stiffness]
            look = {"color": colour, "linestyle": dashes, "linewidth": 1.7}
            name, label = f"apparatus {k:g} R dgamma/eps", rf"$k = {k:g}\,R\Delta\gamma/\epsilon$"
            if math.isinf(k):
                name = label = "fixed grips"
            jumps.append(ends(f"{name}, jump on", mu, cycle.jump_on, look, label))
            jumps.append(ends(f"{name}, jump off", mu, cycle.jump_off, look))
    x, y = APPROACH.within(-8, 3), LOAD.within(-5.6, 0.5)
    lines, arrows = [line for line, _ in jumps], [arrow for _, arrow in jumps]
    return curves(study, x, y, (mu,), *lines, arrows=arrows, legend="lower left")


def _stiffness(study: Greenwood1997) -> Plot:
    """Stiffness below which a contact jumps, against the Tabor parameter."""
    tabor, least = study.border.T
    critical = study.critical_tabor
    lines = [Line("border", None, tabor, least, {"color": style.BLUE, "linewidth": 2}, label="least without a jump")]
    notes = [Note("follows smoothly", (0.15, 60.0)), Note("jumps", (0.35, 2.2))]
    notes.append(Note(rf"fixed grips jump from $\mu = {digits(critical)}$", (0.14, 550.0)))
    see = told(f"Fixed grips jump from mu = {plus_minus(critical)} on.", critical.value, critical.error)
    return Plot(Axis("tabor", "", TABOR.label), STIFFNESS, lines, [see], notes=notes)


FIGURES: Mapping[str, tuple[str, Made]] = {
    "theories": ("the DMT theories at mu = 0.1", _theories),
    "gap_approach": ("central gap against approach", _gap_approach),
    "gap_load": (
        "central gap against load",
        lambda s: curves(s, LOAD.within(-6, 1), CENTRAL_GAP.within(-0.2, 4.5), GAPS_AT, elements=True),
    ),
    "folds": ("the inner folds at mu = 5, enlarged", _folds),
    "profiles": (
        "pressures of more states at mu = 5",
        lambda s: profiles(s, PRESSURE.within(-5.6, 1.4), s.more_profiles, STATES, "below"),
    ),
    "shapes": (
        "gaps of more states at mu = 5",
        lambda s: profiles(s, GAP.within(-0.3, 8), s.more_profiles, STATES, "below"),
    ),
    "radius": ("contact radius with the theories of Hertz and of Carpick et al.", _radius),
    "criteria": (
        "central gap at jump-on, scaled, with the criteria",
        _criteria("central_gap", r"$(H_0 + 1)/\mu^{3/7}$", 1, 1.2, 2.35),
    ),
    "criteria_approach": (
        "approach at jump-on, scaled, with the fit of App. C",
        _criteria("approach", r"$(|\alpha^*| + 1)/\mu^{3/7}$", -1, 2.55, 2.72),
    ),
    "coarse": ("pull-off force on grids that are too coarse", _coarse),
    "ripple": ("load against approach on the same grids", _ripple),
    "devices": ("jumps in apparatus of several stiffnesses", _devices),
    "stiffness": ("stiffness below which a contact jumps", _stiffness),
}
