"""What is to be seen in each figure after Greenwood's: measured on the data that it shows, whatever they are."""

from __future__ import annotations

import numpy as np

from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.greenwood.study import JUMPS_AT, WINDING_AT, Greenwood1997
from fem_adhesion.greenwood.text import farthest, gap_falls, joined, listed, rises, told
from halfspace.accuracy.fold_birth import count_folds
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.laws import LENNARD_JONES
from halfspace.theories import dmt
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, bradley_load, jkr_zero_load
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array

DMT = {"force method": dmt.force_load, "thermodynamic": dmt.thermodynamic_load, "DMT-M": dmt.maugis_load}
RIGID = (0.02, 0.1, 0.3)  # Tabor parameters of Fig. 1a
SCALED = (0.1, 0.3, 0.5, 1.0)  # of Fig. 1b
SOFT = (1.0, 2.0, 3.0, 5.0)  # of Fig. 2b
DMT_TABOR = 0.1  # at which Fig. 1a shows the DMT theories
GAPS_AT = (0.5, 1.0, 2.0, 5.0)  # of Figs 3a and 3b
RADII_AT = (0.5, 2.0, 5.0)  # of Fig. 5
NEAR = 0.01  # relative difference below which two heights are called the same
INSIDE = 0.8  # of the contact radius: where the gap is looked at for being flat


def figure_1a(study: Greenwood1997) -> str:
    """Bradley's curve far from contact, the DMT theories at zero load."""
    path = study.curves[RIGID[0]]
    apart = (path.approach > -1.8) & (path.approach < 0)
    off = np.abs(path.load - bradley_load(path.approach))[apart]
    rigid = (
        f"Apart, at -1.8 < alpha* < 0, the load at mu = {RIGID[0]:g} is within {np.max(off, initial=0):.2g} R dgamma "
    )
    return joined(told(f"{rigid}of Bradley's.", off), _dmt_at_zero_load(study.curves[DMT_TABOR]))


def _dmt_at_zero_load(path: EquilibriumPath) -> str:
    event = path.event("zero_load")
    if event is None:
        return ""
    loads = _dmt_loads(event.approach, path.tabor)
    trend = "they rise sooner" if loads.min() > 0 else "not all of them rise sooner"
    text = (
        f"At mu = {path.tabor:g} and alpha* = {event.approach:.3f}, where the solution's load is zero, the DMT "
        f"theories have {loads.min():.2f} to {loads.max():.2f} R dgamma: {trend}."
    )
    return told(text, event.approach, loads)


def _dmt_loads(approach: float, tabor: float) -> Array:
    return np.array([float(load(approach, tabor)) for load in DMT.values()])


def figure_1b(study: Greenwood1997) -> str:
    """Pull-off force between the limits."""
    forces = np.array([-study.curves[mu].events["pull_off"].load for mu in SCALED])
    between = np.all((forces < -BRADLEY_PULL_OFF) & (forces > -JKR_PULL_OFF))
    trend = "falls all along" if rises(-forces) else "does not fall all along"
    text = (
        f"From mu = {SCALED[0]:g} to {SCALED[-1]:g} the computed pull-off force goes from {forces[0]:.4f} to "
        f"{forces[-1]:.4f} R dgamma: it {trend}, {'' if between else 'not '}between DMT-M's 2 pi and JKR's 3 pi/2."
    )
    return joined("Scaled by mu, Hertz, DMT-M and JKR are one curve each.", told(text, forces))


def figure_1c(study: Greenwood1997) -> str:
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
    return told(text, approach, load, loads) or joined()


def figure_2a(study: Greenwood1997) -> str:
    """Jumps, and the finite elements on the curve."""
    path, fe = study.curves[JUMPS_AT], study.elements.get(JUMPS_AT)
    ends = [
        told(
            f"from {j.take_off} to {j.landing} at alpha* = {j.approach.value:.4f}",
            j.approach.value,
            j.load.value,
            j.landing_load.value,
        )
        for j in study.states.jumps
    ]
    jumps = f"The surfaces jump {listed([end for end in ends if end])}." if any(ends) else ""
    unstable = "Between the folds the branch is unstable." if np.any(~path.stable) else "No branch is unstable."
    return joined(jumps or "No jump was found.", unstable, _beside(fe, path, "approach", "load"))


def _beside(fe: EquilibriumPath | None, path: EquilibriumPath, x: str, y: str) -> str:
    """How far finite-element points lie from the half-space's curve."""
    if fe is None:
        return ""
    seen = (fe.load <= path.load.max(initial=-np.inf)) & (fe.approach >= path.approach.min(initial=np.inf))
    if x == "contact_radius" or y == "contact_radius":
        seen &= np.isfinite(fe.contact_radius)
    line = np.isfinite(getattr(path, x)) & np.isfinite(getattr(path, y))
    off = farthest((getattr(fe, x)[seen], getattr(fe, y)[seen]), (getattr(path, x)[line], getattr(path, y)[line]))
    text = (
        f"At mu = {path.tabor:g} the finite-element points are within {off:.1e} of the line, in units of their extent."
    )
    return told(text, off)


def figure_2b(study: Greenwood1997) -> str:
    """How the curves close in on JKR's at zero load, and where they jump on."""
    ends = np.array([_scaled(study, mu, "zero_load") for mu in SOFT])
    starts = np.array([_scaled(study, mu, "jump_on") for mu in SOFT])
    jkr = jkr_zero_load(1.0).approach
    closing = "closes in" if rises(-np.abs(ends - jkr)) else "does not close in"
    coming = "towards" if rises(-np.abs(starts)) else "not towards"
    span = f"from mu = {SOFT[0]:g} to {SOFT[-1]:g}"
    return joined(
        told(
            f"At zero load alpha*/mu goes from {ends[0]:.4f} to {ends[-1]:.4f} {span}: it {closing} on JKR's "
            f"{jkr:.4f}.",
            ends,
        ),
        told(f"The jump on goes from alpha*/mu = {starts[0]:.3f} to {starts[-1]:.3f}, {coming} 0.", starts),
    )


def _scaled(study: Greenwood1997, tabor: float, name: str) -> float:
    event = study.curves[tabor].event(name)
    return event.approach / tabor if event else float("nan")


def figure_3a(study: Greenwood1997) -> str:
    """Folds of each curve, and the first of all."""
    folds = [f"{count_folds(study.curves[mu])} at mu = {mu:g}" for mu in GAPS_AT]
    finite = all(np.all(np.isfinite(study.curves[mu].approach)) for mu in GAPS_AT)
    critical = study.critical_tabor
    return joined(
        f"The approach turns so many times: {listed(folds)}." if finite else "",
        told(f"It first turns at mu = {plus_minus(critical)}.", critical.value, critical.error),
    )


def figure_3b(study: Greenwood1997) -> str:
    """The gap as a control, at pull-off, and by finite elements."""
    gaps = np.array([study.curves[mu].events["pull_off"].central_gap for mu in GAPS_AT])
    falling = [gap_falls(study.curves[mu]) for mu in GAPS_AT]
    told_of = "negative at each" if np.all(gaps < 0) else "not negative at each"
    every = [_beside(study.elements.get(mu), study.curves[mu], "load", "central_gap") for mu in GAPS_AT]
    return joined(
        "The central gap falls all along every curve." if all(falling) else "The central gap does not fall all along.",
        told(f"At pull-off it is {gaps.min():.4f} to {gaps.max():.4f} eps, {told_of} mu.", gaps),
        *every,
    )


def figure_3c(study: Greenwood1997) -> str:
    """How many folds there are, and what falls."""
    path, count = study.curves[WINDING_AT], len(study.states.folds)
    between = f", {count - 2} of them between jump-on and jump-off" if count > 2 else ""
    falls = "falls" if gap_falls(path) else "does not fall"
    return joined(
        f"The approach has {count} folds{between}.",
        told(f"The central gap {falls} all along the curve.", path.central_gap),
    )


def figure_4a(study: Greenwood1997) -> str:
    """How flat the gap is inside the last contact."""
    shown = study.states.profiles
    if not shown:
        return joined()
    last = shown[-1]
    inside = last.gap[last.radii < INSIDE * last.contact_radius]
    spread = float(np.ptp(inside)) if inside.size else float("nan")
    text = (
        f"From the first to the last state the central gap goes from {shown[0].central_gap:.4g} to "
        f"{last.central_gap:.4g} eps; in the last the gap varies by {spread:.2g} eps inside {INSIDE:g} of the contact "
        f"radius, {last.contact_radius:.3f} beta."
    )
    return told(text, spread, shown[0].central_gap, last.central_gap) or joined()


def figure_4b(study: Greenwood1997) -> str:
    """Height and place of the largest tension."""
    touching = [p for p in study.states.profiles if np.isfinite(p.contact_radius)]
    if not touching:
        return joined()
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
    return told(text, heights, places) or joined()


def figure_5(study: Greenwood1997) -> str:
    """Radius at zero load beside JKR's and Maugis-Dugdale's."""
    radii = np.array([_zero_load_radius(study.curves[mu]) for mu in RADII_AT])
    jkr = jkr_zero_load(1.0).contact_radius
    closing = "closes in" if rises(-np.abs(radii - jkr)) else "does not close in"
    maugis = float(MaugisDugdale.matched(RADII_AT[0]).load(radii[0])) if np.isfinite(radii[0]) else float("nan")
    size = "smaller" if maugis > 0 else "not smaller"
    sizes = listed([f"{radius:.3f} at mu = {mu:g}" for mu, radius in zip(RADII_AT, radii, strict=True)])
    return joined(
        told(
            f"At zero load the radius is {sizes}, in beta: it {closing} on JKR's {jkr:.3f} all along.",
            radii,
        ),
        told(f"Maugis-Dugdale's, the inner edge of its ring of tension, is {size} at mu = {RADII_AT[0]:g}.", maugis),
        *(_beside(study.elements.get(mu), study.curves[mu], "load", "contact_radius") for mu in RADII_AT),
    )


def _zero_load_radius(path: EquilibriumPath) -> float:
    event = path.event("zero_load")
    return event.contact_radius if event else float("nan")
