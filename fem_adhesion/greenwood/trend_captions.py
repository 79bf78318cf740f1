"""What is to be seen in the figures against the Tabor parameter: measured on the data that they show."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.greenwood.criteria import CriteriaStudy, Criterion
from fem_adhesion.greenwood.ripple import Ripple
from fem_adhesion.greenwood.study import Greenwood1997
from fem_adhesion.greenwood.text import joined, rises, told
from halfspace.theories import criteria
from halfspace.values import Array

CLOSED = ("Attard & Parker", "Pethica & Sutton", "App. C")
STEADY = 5.0  # Tabor parameter from which the scaled gap at jump-on is looked at for being constant
CONSTANT = 0.01  # relative spread below which it is called so


def figure_6a(study: Greenwood1997) -> str:
    """Too wide or too narrow a gap by the closed criteria, and how far the fits are off."""
    return joined(_closed(study.criteria), *(_fit(study.criteria, c) for c in study.criteria.criteria))


def closed_ratios(study: CriteriaStudy) -> Array:
    """(H0 + 1)^(7/2) by each closed criterion over that of the true jumps; shape (criteria, jumps)."""
    predicted = [c.predict(study.tabor) for c in study.criteria if c.name in CLOSED and c.predict]
    return (np.reshape(predicted, (len(predicted), study.tabor.size)) + 1) ** 3.5 / (study.central_gap + 1) ** 3.5


def _closed(study: CriteriaStudy) -> str:
    ratio = closed_ratios(study)
    if not ratio.size:
        return ""
    wide = (
        "too wide a gap"
        if ratio.min() > 1
        else "too narrow a gap"
        if ratio.max() < 1
        else "now too wide, now too narrow a gap"
    )
    text = (
        f"Attard & Parker, Pethica & Sutton and App. C expect the jump at {wide}, by factors of {ratio.min():.2f} to "
        f"{ratio.max():.2f} in (H0 + 1)^(7/2)."
    )
    return told(text, ratio)


def _fit(study: CriteriaStudy, criterion: Criterion) -> str:
    """Largest deviation of an empirical fit as printed."""
    if criterion.predict is None or criterion.name in CLOSED:
        return ""
    use = study.tabor >= criteria.FIT_LEAST_TABOR
    true = study.approach if criterion.of_approach else study.central_gap
    off = np.abs(criterion.predict(study.tabor[use]) - true[use])
    what = "approach" if criterion.of_approach else "gap"
    return told(f"The {criterion.name} is off by up to {np.max(off, initial=0):.1g} eps in the {what}.", off)


def figure_6b(study: Greenwood1997) -> str:
    """Whether the gap at jump-on goes as mu^(3/7)."""
    jumps = study.criteria
    scaled = (jumps.central_gap + 1) / jumps.tabor ** (3 / 7)
    steady, below = scaled[jumps.tabor >= STEADY], scaled[jumps.tabor < STEADY]
    spread = float(np.ptp(steady) / steady.mean()) if steady.size > 1 else math.nan
    power = (
        "the power 3/7 of the criteria holds" if spread < CONSTANT else "the power 3/7 of the criteria does not hold"
    )
    falls = "falls" if below.size and below[0] < steady.min(initial=np.inf) else "does not fall"
    return joined(
        told(f"From mu = {STEADY:g} on the scaled gap varies by {100 * spread:.2g} %: {power} there.", spread),
        told(f"Below it {falls}, to {below[0]:.3f} at mu = {jumps.tabor[0]:.3g}." if below.size else "", below, scaled),
    )


def figure_7(study: Greenwood1997) -> str:
    """The true trend, what finite elements say of it, and where coarse grids turn upwards."""
    forces = np.array([-p.half_space.value for p in study.pull_offs])
    trend = "falls" if rises(-forces) else "does not fall"
    ends = f"from {forces[0]:.4f} to {forces[-1]:.4f} R dgamma" if forces.size else ""
    range_ = f"mu = {study.pull_offs[0].tabor:.3g} to {study.pull_offs[-1].tabor:.3g}" if forces.size else ""
    return joined(
        told(f"The true force {trend} all along, {ends} at {range_}.", forces),
        _elements(study),
        *(_turn(spacing, rise.ripples) for spacing, rise in study.rises.items()),
    )


def _elements(study: Greenwood1997) -> str:
    both = [p for p in study.pull_offs if p.finite_element]
    agreeing = sum(p.agree for p in both)
    return f"Finite elements agree within both errors at {agreeing} of {len(both)} Tabor parameters." if both else ""


def _turn(spacing: float, ripples: Sequence[Ripple]) -> str:
    """Where the pull-off force on one spacing turns upwards."""
    forces = np.array([-r.pull_off for r in ripples])
    if forces.size < 2 or not np.all(np.isfinite(forces)):
        return ""
    if forces[-1] <= forces.min():
        return f"On uniform triangles of {spacing:g} beta it does not rise up to mu = {ripples[-1].tabor:.3g}."
    return f"On uniform triangles of {spacing:g} beta it rises from mu = {ripples[int(forces.argmin())].tabor:.3g} on."


def figure_8(study: Greenwood1997) -> str:
    """What a softer apparatus does, and from what stiffness a contact jumps."""
    cycles = study.devices.cycles
    lost = np.array([c.energy_lost.value for c in cycles])
    away = np.array([-c.jump_on.take_off.approach for c in cycles])
    pull = np.array([-c.jump_off.take_off.load for c in cycles])
    words = [
        f"{'jumps on from farther away' if rises(away) else 'does not always jump on from farther away'}",
        f"{'jumps off at a larger pull' if rises(pull) else 'does not always jump off at a larger pull'}",
        f"{'loses more' if rises(lost) else 'does not always lose more'}",
    ]
    critical = study.critical_tabor
    return joined(
        told(
            f"At mu = {study.devices.tabor:g} a softer apparatus {words[0]}, {words[1]} and {words[2]}.",
            lost,
            away,
            pull,
        ),
        _border(study.devices.border),
        told(f"Fixed grips jump from mu = {plus_minus(critical)} on.", critical.value, critical.error),
    )


def _border(border: Array) -> str:
    if not border.size:
        return ""
    tabor, stiffness = border.T
    grows = "grows" if rises(stiffness) else "does not grow all along"
    text = (
        f"The stiffness below which a contact jumps is {stiffness[0]:.4g} R dgamma/eps at mu = {tabor[0]:.2g} and "
        f"{grows} with mu, to {stiffness[-1]:.3g} at mu = {tabor[-1]:.4g}."
    )
    return told(text, border)
