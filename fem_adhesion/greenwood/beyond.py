"""What the paper does not draw: gaps along the curves, criteria for jumping, grids that are too coarse, apparatus."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.common.numbers import digits, listed, plus_minus, told
from fem_adhesion.greenwood.criteria import words_on
from fem_adhesion.greenwood.drawing import (
    APPROACH,
    CENTRAL_GAP,
    CONTACT_RADIUS,
    HALF_SPACE,
    LOAD,
    MARKS,
    OF_TABOR,
    RADIUS,
    TABOR,
    Arrow,
    Axis,
    Line,
    Note,
    Plot,
    by_elements,
    elements_beside,
    half_space,
    rises,
    theory,
)
from fem_adhesion.greenwood.numerics_1997 import Ripple
from fem_adhesion.greenwood.state_figures import (
    GAP,
    NEAR,
    PRESSURE,
    PULL_OFF,
    RADII_AT,
    largest_tension,
    maugis_radius,
    profile_line,
)
from fem_adhesion.greenwood.study import DEVICES_AT, RIPPLE_AT, WINDING_AT, Greenwood1997
from halfspace.equilibrium.devices import Cycle
from halfspace.scaling import MAUGIS
from halfspace.theories import dmt
from halfspace.theories.closed_forms import bradley_load, hertz_load, hertz_radius_at
from halfspace.theories.maugis import carpick_pull_off, carpick_radius
from halfspace.values import Array

DMT = {"DMT force method": dmt.force_load, "DMT thermodynamic": dmt.thermodynamic_load, "DMT-M": dmt.maugis_load}
DMT_AT = 0.1  # Tabor parameter at which they are shown
GAPS_AT = (0.5, 1.0, 2.0, 5.0)
CARPICK_AT = (0.5, 2.0)
INSIDE = 0.8  # of the contact radius: where the gap is looked at for being flat
STEADY = 5.0  # Tabor parameter from which the scaled gap at jump-on is looked at for being constant
CONSTANT = 0.01  # relative spread below which it is called so
PROFILE_LOOKS = (
    (style.SKY, "-"),
    (style.BLUE, style.DASHED),
    (style.GREEN, style.CHAIN),
    (style.PINK, style.LONG),
    (style.ORANGE, style.DOTTED),
    (style.RED, style.DASHED),
    ("black", "-"),
)
CRITERIA_LOOKS: dict[str, tuple[str, Any]] = {
    "Attard & Parker": (style.RED, style.DASHED),
    "Pethica & Sutton": (style.ORANGE, style.CHAIN),
    "App. C": (style.PINK, style.LONG),
    "fit (4.5)": (style.BLUE, "-"),
    "fit of App. C": (style.GREEN, "-"),
}
SPACING_LOOKS: dict[float, tuple[str, Any]] = {
    0.2: (style.RED, style.CHAIN),
    0.1: (style.ORANGE, style.DASHED),
    0.05: (style.PINK, style.LONG),
    0.025: (style.SKY, "-"),
}
STIFFNESS_LOOKS = {math.inf: (style.RED, "-"), 3.0: (style.GREEN, style.DASHED), 1.0: (style.ORANGE, style.CHAIN)}
GAP_AT_JUMP = Axis("central_gap_at_jump_on", "over_mu_3_7_eps", r"$(H_0 + 1)/\mu^{3/7}$")
APPROACH_AT_JUMP = Axis("approach_at_jump_on", "over_mu_3_7_eps", r"$(|\alpha^*| + 1)/\mu^{3/7}$")
STIFFNESS = Axis(
    "stiffness", "R_dgamma_per_eps", r"stiffness $k\,\epsilon/R\Delta\gamma$", (1, 1000), (1, 3, 10, 30, 100, 300), True
)


def theories(study: Greenwood1997) -> Plot:
    """The DMT theories and Hertz's at a low Tabor parameter."""
    path, approach = study.curves[DMT_AT], np.linspace(0, 0.6, 200)
    apart = np.linspace(-2.5, 0.2, 300)
    lines = [half_space(path, APPROACH, LOAD), theory("Bradley", apart, bradley_load(apart))]
    lines += [theory(name, approach, load(approach, DMT_AT), DMT_AT) for name, load in DMT.items()]
    lines.append(theory("Hertz", approach, hertz_load(hertz_radius_at(approach, DMT_AT)), DMT_AT))
    see = ""
    if event := path.event("zero_load"):
        loads = np.array([float(load(event.approach, DMT_AT)) for load in DMT.values()])
        trend = "they rise sooner" if loads.min() > 0 else "not all of them rise sooner"
        text = (
            f"At mu = {DMT_AT:g} and alpha* = {event.approach:.3f}, where the solution's load is zero, the DMT "
            f"theories have {loads.min():.2f} to {loads.max():.2f} R dgamma: {trend}."
        )
        see = told(text, event.approach, loads)
    return Plot(APPROACH.within(-1.8, 0.6), LOAD.within(-6.8, 1.5), lines, [see], legend="below")


def gap_approach(study: Greenwood1997) -> Plot:
    """Central gap against approach."""
    lines = [half_space(study.curves[mu], APPROACH, CENTRAL_GAP) for mu in GAPS_AT]
    turns = [f"{_turns(line)} at mu = {line.tabor:g}" for line in lines]
    falling = all(rises(-study.curves[mu].central_gap) for mu in GAPS_AT)
    finite = all(np.all(np.isfinite(line.x)) for line in lines)
    see = [
        f"The approach turns so many times: {listed(turns)}." if finite else "",
        f"The central gap {'falls all along every curve' if falling else 'does not fall all along'}.",
    ]
    return Plot(APPROACH.within(-9, 2), CENTRAL_GAP.within(-0.4, 6), lines, see, legend="upper right")


def _turns(line: Line) -> int:
    """How often the direction along the horizontal axis changes."""
    return int(np.sum(np.diff(np.sign(np.diff(line.x))) != 0))


def gap_load(study: Greenwood1997) -> Plot:
    """Central gap against load."""
    lines = [half_space(study.curves[mu], LOAD, CENTRAL_GAP) for mu in GAPS_AT]
    fe = by_elements(study.elements, GAPS_AT, LOAD, CENTRAL_GAP)
    gaps = np.array([study.curves[mu].events["pull_off"].central_gap for mu in GAPS_AT])
    negative = "negative at each" if np.all(gaps < 0) else "not negative at each"
    text = f"At pull-off it is {gaps.min():.4f} to {gaps.max():.4f} eps, {negative} mu."
    see = [told(text, gaps), elements_beside([*lines, *fe])]
    return Plot(LOAD.within(-6, 1), CENTRAL_GAP.within(-0.2, 4.5), [*lines, *fe], see)


def folds(study: Greenwood1997) -> Plot:
    """Enlarged, the folds between jump-on and jump-off where the curve winds."""
    states, green = study.specified[WINDING_AT], OF_TABOR[WINDING_AT]
    (x, dx), (y, dy) = (axis.values(states, WINDING_AT) for axis in (APPROACH, CENTRAL_GAP))
    look = {"color": green, "linestyle": style.DOTTED, "linewidth": 1.9}
    line = Line("unstable branch", WINDING_AT, x, y, look, dx, dy)
    places = [(fold.approach, fold.central_gap) for fold in study.folds]
    x, y = np.reshape(places, (-1, 2)).T
    errors = [np.array([getattr(f, name) for f in study.folds]) for name in ("approach_error", "central_gap_error")]
    marks = Line("folds", WINDING_AT, x, y, {**MARKS, "color": "black"}, errors[0], errors[1], label="folds")
    inner = study.folds[1:-1]
    notes = [Note(str(n), (f.approach, f.central_gap)) for n, f in enumerate(inner, 2)]
    count = len(study.folds)
    between = f", {count - 2} of them between jump-on and jump-off" if count > 2 else ""
    see = [f"The approach has {count} folds{between}.", told(f"They are at alpha* = {_listed(x)}.", x)]
    axes = APPROACH.within(-4.56, -4.42), CENTRAL_GAP.within(-0.05, 1.3)
    return Plot(*axes, [line, marks], see, notes=notes)


def _listed(values: Array) -> str:
    return listed([f"{value:.4f}" for value in values])


def profiles(study: Greenwood1997) -> Plot:
    """Pressures of more states on the way through contact."""
    states = study.more_profiles
    lines = [profile_line(state, PRESSURE, look) for state, look in zip(states, PROFILE_LOOKS, strict=False)]
    touching = [state for state in states if np.isfinite(state.contact_radius)]
    see = ""
    if touching:
        heights = np.array([-state.pressure.min() for state in touching]) / WINDING_AT
        places = np.array([state.radii[state.pressure.argmin()] for state in touching])
        strength = largest_tension()
        same = "is" if np.all(np.abs(heights / strength - 1) < NEAR) else "is not"
        outwards = "moves outwards" if rises(places) else "does not always move outwards"
        text = (
            f"In contact the largest tension {same} the strength of the surface law, {strength:.3f} mu: it is "
            f"{heights.min():.3f} to {heights.max():.3f} mu. Its place {outwards}, from {places[0]:.2f} to "
            f"{places[-1]:.2f} beta."
        )
        see = told(text, heights, places)
    title = rf"$\mu = {WINDING_AT:g}$"
    return Plot(RADIUS.within(0, 3), PRESSURE.within(-5.6, 1.4), lines, [see], title=title, legend="below")


def shapes(study: Greenwood1997) -> Plot:
    """Gaps of the same states."""
    states = study.more_profiles
    lines = [profile_line(state, GAP, look) for state, look in zip(states, PROFILE_LOOKS, strict=False)]
    see = ""
    if states:
        last = states[-1]
        inside = last.gap[last.radii < INSIDE * last.contact_radius]
        spread = float(np.ptp(inside)) if inside.size else math.nan
        text = (
            f"In the last state the gap varies by {spread:.2g} eps inside {INSIDE:g} of the contact radius, "
            f"{last.contact_radius:.3f} beta."
        )
        see = told(text, spread)
    title = rf"$\mu = {WINDING_AT:g}$"
    return Plot(RADIUS.within(0, 3), GAP.within(-0.3, 8), lines, [see], title=title, legend="below")


def radius(study: Greenwood1997) -> Plot:
    """Contact radius against load, with further theories."""
    at = np.linspace(1e-3, 2.9, 400)
    lines = [half_space(study.curves[mu], LOAD, CONTACT_RADIUS) for mu in RADII_AT]
    lines += [theory("Hertz", hertz_load(at), at), *(maugis_radius(mu, at) for mu in CARPICK_AT)]
    off = []
    for mu in CARPICK_AT:
        load = np.linspace(float(carpick_pull_off(MAUGIS.of(mu))), 5, 400)
        radii, look = carpick_radius(load, MAUGIS.of(mu)), {"color": OF_TABOR[mu], "linestyle": style.DOTTED}
        lines.append(Line("Carpick et al.", mu, load, radii, look))
        event = study.curves[mu].event("zero_load")
        off.append(float(carpick_radius(0.0, MAUGIS.of(mu))) / event.contact_radius - 1 if event else math.nan)
    listing = listed([f"{100 * value:+.1f} % at mu = {mu:g}" for value, mu in zip(off, CARPICK_AT, strict=True)])
    see = told(f"At zero load the radius of Carpick et al. is off the solution's by {listing}.", np.array(off))
    return Plot(LOAD.within(-6.5, 5), CONTACT_RADIUS.within(0, 2.8), lines, [see], legend="below")


def criteria_gap(study: Greenwood1997) -> Plot:
    """Central gap at jump-on, over mu^(3/7)."""
    jumps = study.criteria
    scaled = (jumps.central_gap + 1) / jumps.tabor ** (3 / 7)
    see = [*words_on(jumps), *_steady_words(jumps.tabor, scaled)]
    errors = np.array([jump.central_gap.error for jump in jumps.jumps]) / jumps.tabor ** (3 / 7)
    return Plot(TABOR, GAP_AT_JUMP.within(1.2, 2.35), _criteria(study, scaled, errors), see, legend="lower right")


def criteria_approach(study: Greenwood1997) -> Plot:
    """Approach at jump-on, over mu^(3/7)."""
    jumps = study.criteria
    scaled = (1 - jumps.approach) / jumps.tabor ** (3 / 7)
    errors = np.array([jump.approach.error for jump in jumps.jumps]) / jumps.tabor ** (3 / 7)
    see = [
        told(f"It is {scaled[0]:.4f} to {scaled[-1]:.4f} at mu = {_ends(jumps.tabor)}.", scaled) if scaled.size else ""
    ]
    lines = _criteria(study, scaled, errors, of_approach=True)
    return Plot(TABOR, APPROACH_AT_JUMP.within(2.55, 2.72), lines, see, legend="lower right")


def _ends(values: Array) -> str:
    return f"{values[0]:.3g} to {values[-1]:.3g}"


def _criteria(study: Greenwood1997, scaled: Array, errors: Array, *, of_approach: bool = False) -> list[Line]:
    """True jumps as markers, and what the criteria predict for gap or approach."""
    lines = [Line("true jumps", None, study.criteria.tabor, scaled, {**MARKS, "color": "black"}, None, errors)]
    tabor = np.geomspace(0.72, max(study.criteria.tabor, default=1.0), 200)
    for criterion in study.criteria.criteria:
        if criterion.predict and criterion.of_approach == of_approach:
            colour, dashes = CRITERIA_LOOKS[criterion.name]
            predicted = (1 + (-1 if of_approach else 1) * criterion.predict(tabor)) / tabor ** (3 / 7)
            lines.append(Line(criterion.name, None, tabor, predicted, {"color": colour, "linestyle": dashes}))
    return lines


def _steady_words(tabor: Array, scaled: Array) -> Iterator[str]:
    """Whether the gap at jump-on goes as mu^(3/7)."""
    steady, below = scaled[tabor >= STEADY], scaled[tabor < STEADY]
    spread = float(np.ptp(steady) / steady.mean()) if steady.size > 1 else math.nan
    power = f"the power 3/7 of the criteria {'holds' if spread < CONSTANT else 'does not hold'}"
    yield told(f"From mu = {STEADY:g} on the scaled gap varies by {100 * spread:.2g} %: {power} there.", spread)
    if below.size:
        falls = "falls" if below[0] < steady.min(initial=np.inf) else "does not fall"
        yield told(f"Below it {falls}, to {below[0]:.3f} at mu = {tabor[0]:.3g}.", scaled)


def coarse(study: Greenwood1997) -> Plot:
    """The pull-off force on uniform grids that are too coarse."""
    tabor = np.array([p.tabor for p in study.pull_offs if p.tabor > 0.5])
    force = np.array([-p.half_space.value for p in study.pull_offs if p.tabor > 0.5])
    errors = np.array([p.half_space.error for p in study.pull_offs if p.tabor > 0.5])
    lines = [
        Line(HALF_SPACE, None, tabor, force, {"color": style.BLUE, "linewidth": 2}, None, errors, label="resolved")
    ]
    for spacing, rise in study.rises.items():
        x, y = np.reshape([(r.tabor, -r.pull_off) for r in rise.ripples], (-1, 2)).T
        lines.append(_spacing(spacing, None, x, y))
    see = [_turn(spacing, rise.ripples) for spacing, rise in study.rises.items()]
    return Plot(TABOR.within(0.7, 20), PULL_OFF.within(4.5, 7), lines, see)


def _spacing(spacing: float, tabor: float | None, x: Array, y: Array) -> Line:
    colour, dashes = SPACING_LOOKS[spacing]
    look = {"color": colour, "linestyle": dashes, "linewidth": 1.4}
    return Line(
        f"uniform triangles {spacing:g} beta", tabor, x, y, look, label=rf"uniform triangles, ${spacing:g}\,\beta$"
    )


def _turn(spacing: float, ripples: Sequence[Ripple]) -> str:
    """Where the pull-off force on one spacing turns upwards."""
    forces = np.array([-r.pull_off for r in ripples])
    if forces.size < 2 or not np.all(np.isfinite(forces)):
        return ""
    if forces[-1] <= forces.min():
        return f"On uniform triangles of {spacing:g} beta it does not rise up to mu = {ripples[-1].tabor:.3g}."
    return f"On uniform triangles of {spacing:g} beta it rises from mu = {ripples[int(forces.argmin())].tabor:.3g} on."


def ripple(study: Greenwood1997) -> Plot:
    """The ripple of the curve on the same grids, through pull-off."""
    path = study.curves[RIPPLE_AT]
    lines = [_spacing(r.spacing, r.tabor, r.approach, r.load) for r in study.ripples]
    lines.append(half_space(path, APPROACH, LOAD))
    least = [f"{-r.pull_off:.3f} at {r.spacing:g} beta" for r in study.ripples]
    true = -path.events["pull_off"].load
    see = told(f"The largest tension is {listed(least)}, where it is {true:.3f} R dgamma.", true) if least else ""
    axes = APPROACH.within(-3.2, 1.2), LOAD.within(-6.3, -2.6)
    return Plot(*axes, lines, [see], title=rf"$\mu = {RIPPLE_AT:g}$", legend="below")


def devices(study: Greenwood1997) -> Plot:
    """Jumps in apparatus of several stiffnesses."""
    cycles = study.devices.cycles
    lines, arrows = [half_space(study.curves[DEVICES_AT], APPROACH, LOAD)], []
    for cycle in cycles:
        if cycle.stiffness in STIFFNESS_LOOKS:
            colour, dashes = STIFFNESS_LOOKS[cycle.stiffness]
            look = {"color": colour, "linestyle": dashes, "linewidth": 1.7}
            lines += _cycle_lines(cycle, look)
            for jump in (cycle.jump_on, cycle.jump_off):
                tail, head = ((state.approach, state.load) for state in jump.ends)
                arrows.append(Arrow(tail, head, look))
    lost = np.array([c.energy_lost.value for c in cycles])
    away = np.array([-c.jump_on.take_off.approach for c in cycles])
    pull = np.array([-c.jump_off.take_off.load for c in cycles])
    words = [
        "jumps on from farther away" if rises(away) else "does not always jump on from farther away",
        "jumps off at a larger pull" if rises(pull) else "does not always jump off at a larger pull",
        "loses more" if rises(lost) else "does not always lose more",
    ]
    see = told(f"At mu = {study.devices.tabor:g} a softer apparatus {listed(words)}.", lost, away, pull)
    axes = APPROACH.within(-8, 3), LOAD.within(-5.6, 0.5)
    return Plot(*axes, lines, [see], arrows, legend="lower left")


def _cycle_lines(cycle: Cycle, look: dict[str, Any]) -> list[Line]:
    """Both jumps of a cycle as lines under their arrows."""
    fixed = math.isinf(cycle.stiffness)
    name = "fixed grips" if fixed else f"apparatus {cycle.stiffness:g} R dgamma/eps"
    label = name if fixed else rf"$k = {cycle.stiffness:g}\,R\Delta\gamma/\epsilon$"
    lines = []
    for way, jump, key in (("on", cycle.jump_on, label), ("off", cycle.jump_off, "")):
        approach, dx, load, dy = np.transpose(
            [(state.approach, state.approach_error, state.load, state.load_error) for state in jump.ends]
        )
        lines.append(Line(f"{name}, jump {way}", DEVICES_AT, approach, load, look, dx, dy, label=key))
    return lines


def stiffness(study: Greenwood1997) -> Plot:
    """Stiffness below which a contact jumps, against the Tabor parameter."""
    tabor, least = study.devices.border.T
    critical = study.critical_tabor
    lines = [Line("border", None, tabor, least, {"color": style.BLUE, "linewidth": 2}, label="least without a jump")]
    notes = [Note("follows smoothly", (0.15, 60.0)), Note("jumps", (0.35, 2.2))]
    notes.append(Note(rf"fixed grips jump from $\mu = {digits(critical)}$", (0.14, 550.0)))
    see = [_follows(study.devices.border)]
    see.append(told(f"Fixed grips jump from mu = {plus_minus(critical)} on.", critical.value, critical.error))
    axis = Axis("tabor", "", TABOR.label)
    return Plot(axis, STIFFNESS, lines, see, notes=notes)


def _follows(border: Array) -> str:
    if not border.size:
        return ""
    tabor, least = border.T
    grows = "grows" if rises(least) else "does not grow all along"
    text = (
        f"The stiffness below which a contact jumps is {least[0]:.4g} R dgamma/eps at mu = {tabor[0]:.2g} and {grows} "
        f"with mu, to {least[-1]:.3g} at mu = {tabor[-1]:.4g}."
    )
    return told(text, border)


FIGURES = {
    "theories": (f"the DMT theories at mu = {DMT_AT:g}", theories),
    "gap_approach": ("central gap against approach", gap_approach),
    "gap_load": ("central gap against load", gap_load),
    "folds": (f"the inner folds at mu = {WINDING_AT:g}, enlarged", folds),
    "profiles": (f"pressures of more states at mu = {WINDING_AT:g}", profiles),
    "shapes": (f"gaps of more states at mu = {WINDING_AT:g}", shapes),
    "radius": ("contact radius with the theories of Hertz and of Carpick et al.", radius),
    "criteria": ("central gap at jump-on, scaled, with the criteria", criteria_gap),
    "criteria_approach": ("approach at jump-on, scaled, with the fit of App. C", criteria_approach),
    "coarse": ("pull-off force on grids that are too coarse", coarse),
    "ripple": ("load against approach on the same grids", ripple),
    "devices": ("jumps in apparatus of several stiffnesses", devices),
    "stiffness": ("stiffness below which a contact jumps", stiffness),
}
