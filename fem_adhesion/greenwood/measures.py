"""What claims of the paper are measured on that need solutions, asked of the facts of a study."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from fem_adhesion.common.fold_birth import count_folds
from fem_adhesion.greenwood.facts import (
    UNKNOWN,
    Facts,
    count,
    crossings,
    exact,
    least,
    most,
    spread,
    steps,
)
from fem_adhesion.greenwood.formulas import JKR_AT_REST, JKR_JUMP_OFF, RIGID, maugis_radius
from fem_adhesion.greenwood.tables import LAST_DIGIT, PROFILE_CHECKS, TABORS, Printed
from halfspace.equilibrium.conditions import Condition
from halfspace.equilibrium.contact import CONTACT_RADIUS, LOAD
from halfspace.laws import LENNARD_JONES
from halfspace.theories import closed_forms, criteria, dmt
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Estimate

BELOW_NOSE = -4.0  # load in R dgamma at which Fig. 5 is compared on the unstable branch
BELOW_NOSE_RADIUS = float(
    np.cbrt(3 / 4 * (BELOW_NOSE + 3 * np.pi - np.sqrt(6 * np.pi * BELOW_NOSE + (3 * np.pi) ** 2)))
)
"""JKR's contact radius there, in beta."""


def _extreme(which: str, numbers: Iterable[Estimate]) -> Estimate:
    """The most or the least of some numbers."""
    return {"most": most, "least": least}[which](list(numbers))


# Events


def number(f: Facts, tabor: float, event: str, quantity: str) -> Estimate:
    """A number of an event; approach and gaps in eps, load in R dgamma, contact radius in beta."""
    return f.number(tabor, event, quantity)


def force(f: Facts, tabor: float) -> Estimate:
    """Pull-off force in R dgamma."""
    return f.number(tabor, "pull_off", "load") * -1


def force_over_pi(f: Facts, tabor: float) -> Estimate:
    """Pull-off force over pi."""
    return force(f, tabor) / np.pi


def force_over_bradley(f: Facts, which: str, *tabors: float) -> Estimate:
    """The most or the least pull-off force over Bradley's, at some Tabor parameters or at all."""
    return _extreme(which, (force(f, mu) for mu in tabors or f.paths)) / -BRADLEY_PULL_OFF


def force_change(f: Facts, which: str, *tabors: float) -> Estimate:
    """The most or the least change of the pull-off force from one Tabor parameter to the next."""
    return _extreme(which, steps([force(f, mu) for mu in tabors]))


def way_to_jkr(f: Facts, lower: float, upper: float) -> Estimate:
    """Part of the way from Bradley's pull-off force to JKR's that is gone between two Tabor parameters."""
    return (force(f, lower) - force(f, upper)) / (JKR_PULL_OFF - BRADLEY_PULL_OFF)


def nearer_to_bradley(f: Facts, tabor: float) -> Estimate:
    """Distance of the pull-off force from Bradley's over that from JKR's."""
    return abs(force(f, tabor) + BRADLEY_PULL_OFF) / abs(force(f, tabor) + JKR_PULL_OFF)


def separation(f: Facts, which: str, *tabors: float) -> Estimate:
    """The most or the least separation -alpha* at pull-off."""
    return _extreme(which, (f.number(mu, "pull_off", "approach") * -1 for mu in tabors))


def separation_change(f: Facts, which: str, *tabors: float) -> Estimate:
    """The most or the least change of the separation at pull-off from one Tabor parameter to the next."""
    return _extreme(which, steps([f.number(mu, "pull_off", "approach") * -1 for mu in tabors]))


def scaled_approach(f: Facts, tabor: float, event: str) -> Estimate:
    """Approach of an event over the Tabor parameter, in beta^2/R."""
    return f.number(tabor, event, "approach") / tabor


def power_of_separation(f: Facts, lower: float, upper: float) -> Estimate:
    """Size of the power of mu of alpha*/mu at pull-off, between two Tabor parameters."""
    ends = (scaled_approach(f, mu, "pull_off") for mu in (lower, upper))
    return abs(spread(lambda a, b: np.log(b / a) / np.log(upper / lower), *ends))


def zero_load_change(f: Facts, which: str, *tabors: float) -> Estimate:
    """The most or the least change of the distance of alpha*/mu at zero load from JKR's."""
    return _extreme(which, steps([abs(scaled_approach(f, mu, "zero_load") - JKR_AT_REST.approach) for mu in tabors]))


def farthest_from_jkr(f: Facts, tabor: float) -> Estimate:
    """Largest deviation of events from JKR's, relative, in loads, radii and scaled approaches."""
    off = closed_forms.jkr_pull_off(1.0)
    pairs = (
        (f.number(tabor, "pull_off", "load"), off.load),
        (scaled_approach(f, tabor, "pull_off"), off.approach),
        (scaled_approach(f, tabor, "zero_load"), JKR_AT_REST.approach),
        (f.number(tabor, "zero_load", "contact_radius"), JKR_AT_REST.contact_radius),
    )
    return most([abs(ours / theirs - 1) for ours, theirs in pairs])


def jump_off_over_jkr(f: Facts, tabor: float) -> Estimate:
    """Load at the jump off over JKR's."""
    return f.number(tabor, "jump_off", "load") / JKR_JUMP_OFF.load


def width_of_the_fold(f: Facts, tabor: float) -> Estimate:
    """Range of approaches between the jumps, in eps."""
    return f.number(tabor, "jump_on", "approach") - f.number(tabor, "jump_off", "approach")


def fewest_folds(f: Facts, *tabors: float) -> Estimate:
    """Least number of folds at some Tabor parameters."""
    return count(min(count_folds(f.paths[mu]) for mu in tabors))


def critical_tabor(f: Facts) -> Estimate:
    """Tabor parameter of the first vertical tangent."""
    return f.critical_tabor


def pulled_off(f: Facts, sign: float) -> Estimate:
    """At how many Tabor parameters the approach at pull-off has a sign: apart -1, pressed together +1."""
    return count(sum(sign * path.events["pull_off"].approach > 0 for path in f.paths.values()))


def pull_off_change(f: Facts) -> Estimate:
    """Largest change of the pull-off force of Fig. 7 from one Tabor parameter to the next."""
    return most(steps([f.pull_offs[mu] * -1 for mu in sorted(f.pull_offs)]))


# Jumps


def left_after_jump_off(f: Facts, tabor: float) -> Estimate:
    """Force left after the jump off, as a part of that before."""
    if tabor not in f.cycles:
        return UNKNOWN
    before, after = (state.estimate("load") for state in f.cycles[tabor].jump_off.ends)
    return after / before


def energy_lost(f: Facts, tabor: float) -> Estimate:
    """Energy lost in a cycle, in R dgamma eps."""
    return f.cycles[tabor].energy_lost if tabor in f.cycles else UNKNOWN


def landing_gap(f: Facts, tabor: float) -> Estimate:
    """Central gap where the jump on lands, in eps."""
    return f.cycles[tabor].jump_on.landing.estimate("central_gap") if tabor in f.cycles else UNKNOWN


def tension_after_jump(f: Facts, which: str) -> Estimate:
    """The most or the least tension just after the jump on, over the pull-off force, mu = 1 to 5."""
    landings = {mu: f.cycles[mu].jump_on.landing for mu in TABORS[:-1] if mu in f.cycles}
    return _extreme(which, [end.estimate("load") / -force(f, mu).value for mu, end in landings.items()])


def landing_under_load(f: Facts, tabor: float) -> Estimate:
    """Approach in contact under the load at which the surfaces jump on."""
    state = f.paths[tabor].at(load=f.number(tabor, "jump_on", "load").value, branch="contact")
    return Estimate(float(state.approach), float(state.approach_error))


def approaches_apart(f: Facts, tabor: float) -> Estimate:
    """Distance in the approach of the states of the two printed gaps of Fig. 4."""
    before, after = (f.paths[tabor].at(central_gap=float(gap)) for gap, _ in PROFILE_CHECKS)
    return Estimate(float(after.approach - before.approach), float(after.approach_error + before.approach_error))


def other_core(f: Facts, which: str) -> Estimate:
    """How far a law with another core moves the jump on: below the most or the least of the gaps tried, in eps."""
    return f.cores[{"most": max, "least": min}[which](f.cores)] if f.cores else UNKNOWN


# Loads along the curve


def from_bradley(f: Facts, tabor: float, low: float, high: float) -> Estimate:
    """Largest distance of the load from Bradley's between two approaches in eps, in R dgamma."""
    approach = np.linspace(low, high, 121)
    states = f.paths[tabor].at(approach=approach)
    off = np.abs(states.load - closed_forms.bradley_load(approach))
    return Estimate(float(off.max()), float(np.max(states.load_error)))


def nearing_bradley(f: Facts, lower: float, upper: float) -> Estimate:
    """That distance apart at a Tabor parameter, over that at another."""
    return from_bradley(f, lower, -6.0, 0.0) / from_bradley(f, upper, -6.0, 0.0)


def far_from_bradley(f: Facts, times: float) -> Estimate:
    """Largest relative deviation from Bradley's load at so many jump-on separations, mu = 1 to 6."""
    ratios = []
    for mu in TABORS:
        event = f.paths[mu].events.get("jump_on")
        approach = times * event.approach if event else -5.0
        ratios.append(abs(f.load(mu, approach, "separated") / float(closed_forms.bradley_load(approach)) - 1))
    return most(ratios)


def compression_exponent(f: Facts, tabor: float) -> Estimate:
    """Power n of W = k (alpha* - alpha0)^n through loads of 5, 10 and 20.

    As alpha* = alpha0 + (W/k)^(1/n), successive differences grow by 2^(1/n).
    """
    states = f.paths[tabor].at(load=np.array([5.0, 10.0, 20.0]), branch="contact")
    first, second = steps(
        [Estimate(*map(float, pair)) for pair in zip(states.approach, states.approach_error, strict=True)]
    )
    return spread(lambda ratio: np.log(2) / np.log(abs(ratio)), second / first)


def nearest_theory(f: Facts, tabor: float) -> Estimate:
    """Least relative deviation of Bradley's, JKR's and DMT-M's loads from the computed, W = 20."""
    state = f.paths[tabor].at(load=20.0, branch="contact")
    x = float(state.approach)
    theories = (closed_forms.bradley_load(x), closed_forms.jkr_load_at(x, tabor), dmt.maugis_load(x, tabor))
    return Estimate(min(abs(float(W) / 20 - 1) for W in theories), float(state.load_error) / 20)


def load_at_touch_over_jkr(f: Facts, tabor: float) -> Estimate:
    """Load at zero approach over JKR's."""
    return f.load(tabor, 0.0, "contact") / closed_forms.jkr_zero_approach(1.0).load


def crossings_of_jkr(f: Facts, tabor: float) -> Estimate:
    """How often the curve crosses JKR's, both as polygons."""
    path, radius = f.paths[tabor].resampled(400), np.linspace(1e-4, 4, 4000)
    jkr = closed_forms.jkr_approach(radius, tabor), closed_forms.jkr_load(radius)
    return count(len(crossings(np.column_stack([path.approach, path.load]), np.column_stack(jkr))))


def dmt_spread(f: Facts, what: str) -> Estimate:
    """Spread of the DMT loads from mu = 0.1 to 0.5 at alpha*/mu = 1 over that of the computed; its size or sign."""
    theirs = [exact(float(dmt.force_load(mu, mu))) for mu in (0.1, 0.5)]
    ratio = exact((theirs[1] - theirs[0]).value) / (f.load(0.5, 0.5) - f.load(0.1, 0.1))
    return abs(ratio) if what == "size" else ratio


def off_dmt_m(f: Facts, tabor: float, approach: float) -> Estimate:
    """Relative deviation of the load of DMT-M at an approach in eps."""
    return abs(exact(float(dmt.maugis_load(approach, tabor))) / f.load(tabor, approach) - 1)


def nearer_bradley_than_dmt(f: Facts, tabor: float, approach: float) -> Estimate:
    """Distance of the load from Bradley's over that from the DMT theory's, at an approach in eps."""
    load, bradley = f.load(tabor, approach), float(closed_forms.bradley_load(approach))
    return abs(load - bradley) / abs(load - float(dmt.force_load(approach, tabor)))


# Contact radius and pressure


def radius_over_jkr(f: Facts, tabor: float) -> Estimate:
    """Contact radius at zero load over JKR's."""
    return f.number(tabor, "zero_load", "contact_radius") / JKR_AT_REST.contact_radius


def radius_below_nose(f: Facts, tabor: float) -> Estimate:
    """Contact radius on the unstable branch over JKR's."""
    found = f.paths[tabor].states(Condition(LOAD, value=BELOW_NOSE))
    radii = [float(s.point.observables[CONTACT_RADIUS]) for s in found]
    return Estimate(min(radii, default=float("nan")) / BELOW_NOSE_RADIUS, 1e-4)


def radius_below_nose_over_maugis(f: Facts, tabor: float) -> Estimate:
    """Distance of the contact radius from JKR's there, over that of Maugis's."""
    nose = MaugisDugdale.matched(tabor).pull_off().contact_radius
    his = abs(maugis_radius(tabor, BELOW_NOSE, 0.05, nose) / BELOW_NOSE_RADIUS - 1)
    return abs(radius_below_nose(f, tabor) - 1) / his


def central_pressure_over_jkr(f: Facts, tabor: float) -> Estimate:
    """Pressure at the centre under no load, over JKR's 2 a/pi - sqrt(2/(pi a))."""
    a, gap = JKR_AT_REST.contact_radius, f.number(tabor, "zero_load", "central_gap")
    P = spread(lambda H: float(LENNARD_JONES.pressure(np.array(H), tabor)), gap)
    return P / float(2 * a / np.pi - np.sqrt(2 / (np.pi * a)))


# Printed numbers


def asymptote(f: Facts, index: float) -> Estimate:
    """A constant of f = a alpha*^(3/2) - b alpha*^2, fitted."""
    return f.tables.asymptote[int(index)]


def _entries(f: Facts, start: str, end: str = "") -> list[Printed]:
    """Entries of Table 2 whose row begins and ends so."""
    return [p for p in f.tables.table_2 if p.row.startswith(start) and p.row.endswith(end)]


def worst_digit(f: Facts, table: str, end: str = "") -> Estimate:
    """Largest deviation from a table, or from rows that end so, in units of the third decimal."""
    entries: list[Printed] = getattr(f.tables, table)
    return most([abs(p.computed - float(p.printed)) * 1e3 for p in entries if p.row.endswith(end)])


def right_digits(f: Facts, jump: str) -> Estimate:
    """How many numbers of Table 2 at a jump, but for Attard & Parker's row, are right to the last digit."""
    return count(sum(p.note == LAST_DIGIT for p in _entries(f, jump) if not p.row.endswith("_AP")))


def earlier(f: Facts, jump: str, side: float) -> Estimate:
    """How many printed approaches are met before the fold: from afar with side 1, from contact with -1."""
    return count(
        sum(side * (float(p.printed) - p.computed.value) > 0 for p in _entries(f, f"{jump} minus_alpha_star", "star"))
    )


def load_worse_than_place(f: Facts) -> Estimate:
    """Largest relative deviation of a printed load from ours over that of a printed approach."""
    load, place = (
        max((abs(p.deviation) for p in _entries(f, "", end)), default=np.nan)
        for end in ("minus_W_over_R_dgamma", "minus_alpha_star")
    )
    return exact(load / place)


# Criteria


def gap(f: Facts, tabor: float, event: str = "jump_on") -> Estimate:
    """Central h at a jump, in eps."""
    return f.number(tabor, event, "central_gap") + 1


def power_of_gap(f: Facts, lower: float, upper: float) -> Estimate:
    """Power of mu of H0 + 1 at the jump on, between two Tabor parameters."""
    return spread(lambda a, b: np.log(b / a) / np.log(upper / lower), gap(f, lower), gap(f, upper))


def criterion(f: Facts, tabor: float, event: str) -> Estimate:
    """Value of w sigma'/sigma at the centre, (4.3), with the error that its approach and gap leave."""
    ends = (f.number(tabor, event, name) for name in ("approach", "central_gap"))
    return spread(lambda a, h: float(criteria.fundamental_criterion(a, h)), *ends)


def largest_criterion(f: Facts, divisor: float) -> Estimate:
    """Largest size of (4.3) at the jump on, mu = 1 to 6, over a divisor."""
    return most([abs(criterion(f, mu, "jump_on")) for mu in TABORS]) / divisor


def criterion_before_jump(f: Facts) -> Estimate:
    """Half the size of (4.3) in the state before the jump of Fig. 4."""
    state = f.paths[5.0].at(central_gap=float(PROFILE_CHECKS[0][0]))
    value = float(criteria.fundamental_criterion(state.approach, state.central_gap))
    return Estimate(abs(value) / 2, float(state.approach_error + state.central_gap_error))


def criterion_has_value(f: Facts, equation: float) -> Estimate:
    """At how many jumps on of Table 2 equation (4.2), for alpha* > 0, or (4.3) has a value."""
    if equation == 4.2:
        return count(sum(f.number(mu, "jump_on", "approach").value > 0 for mu in TABORS))
    return count(sum(bool(np.isfinite(criterion(f, mu, "jump_on").value)) for mu in TABORS))


def closed_criterion(f: Facts, name: str, tabor: float, event: str) -> Estimate:
    """(H0 + 1)^(7/2) by a closed criterion over the true one."""
    k = float(getattr(criteria, name))
    return spread(lambda h: k * RIGID * tabor**1.5 / h**3.5, gap(f, tabor, event))


def refitted(f: Facts, name: str, index: float) -> Estimate:
    """A refitted constant with its standard error; underscores stand for blanks in the name of its criterion."""
    found = [c.constants[int(index)][2] for c in f.criteria.criteria if c.name == name.replace("_", " ")]
    return found[0] if found else UNKNOWN


def fitted_gap(f: Facts, tabor: float, event: str) -> Estimate:
    """Gap h by (4.5) over the true one."""
    return exact(float(criteria.fitted_gap(tabor)) + 1) / gap(f, tabor, event)


def worst_fit(f: Facts) -> Estimate:
    """Largest relative deviation of h by (4.5) at the jump on, mu = 1 to 6."""
    return most([abs(fitted_gap(f, mu, "jump_on") - 1) for mu in TABORS])


def repulsion(f: Facts, tabor: float) -> Estimate:
    """Part of (H0 + 1)^(7/2) by the term of repulsion in (4.5)."""
    return spread(lambda h: criteria.FIT_REPULSION / h**6, gap(f, tabor))


def fitted_approach(f: Facts, tabor: float, event: str) -> Estimate:
    """|alpha*| + 1 by the fit of Appendix C over the true one."""
    return exact(1 - float(criteria.fitted_approach(tabor))) / (f.number(tabor, event, "approach") * -1 + 1)


def attard_parker_loads(f: Facts) -> Estimate:
    """Largest relative deviation of Attard & Parker's loads from those of the true jumps, mu = 1 to 6."""
    gaps = (float(criteria.closed_gap(mu, criteria.ATTARD_PARKER)) for mu in TABORS)
    theirs = [exact(float(criteria.undeformed_load(h))) for h in gaps]
    return most([abs(w / f.number(mu, "jump_on", "load") - 1) for w, mu in zip(theirs, TABORS, strict=True)])


def displacement(f: Facts, tabor: float) -> Estimate:
    """Central displacement at the jump on in eps, -alpha* - H0."""
    return (f.number(tabor, "jump_on", "approach") + f.number(tabor, "jump_on", "central_gap")) * -1


def gap_over_displacement(f: Facts, *tabors: float) -> Estimate:
    """Largest h0/w(0) at the jump on, of some Tabor parameters."""
    return most([gap(f, mu) / displacement(f, mu) for mu in tabors])


def displacement_over_rigid(f: Facts, tabor: float) -> Estimate:
    """Central displacement at the jump on over that by the attraction across undeformed surfaces."""
    return displacement(f, tabor) / spread(lambda h: RIGID * tabor**1.5 / h**2.5, gap(f, tabor))


# Numerics of 1997


def _converged(f: Facts, c: float) -> set[float]:
    """Tabor parameters at which simple relaxation with a factor c converged."""
    return {a.tabor for a in f.relaxations if a.method.endswith(f"c = {c:g}") and a.sweeps}


def failures_of_simple(f: Facts, c: float, limit: float) -> Estimate:
    """At how many Tabor parameters below a limit simple relaxation failed."""
    tried = {a.tabor for a in f.relaxations if a.tabor < limit}
    return count(len(tried - _converged(f, c))) if tried else UNKNOWN


def successes_of_simple(f: Facts, c: float, limit: float) -> Estimate:
    """At how many Tabor parameters from a limit on simple relaxation converged."""
    return count(sum(mu >= limit for mu in _converged(f, c)))


def needed_small_steps(f: Facts, slow: float, fast: float) -> Estimate:
    """At how many Tabor parameters simple relaxation converged with the smaller of two factors only."""
    return count(len(_converged(f, slow) - _converged(f, fast)))


def most_sweeps(f: Facts) -> Estimate:
    """Most sweeps that Greenwood's own iteration took where it converged."""
    return exact(max((a.sweeps for a in f.relaxations if a.sweeps and "Greenwood" in a.method), default=np.nan))


def coarse_ratio(f: Facts, tabor: float, spacing: float, other: float, wide: float) -> Estimate:
    """Ratio of two pull-off forces on uniform triangles."""
    return exact(f.coarse.get((tabor, spacing), np.nan) / f.coarse.get((other, wide), np.nan))


def coarse_over_pi(f: Facts, tabor: float, spacing: float) -> Estimate:
    """Pull-off force on uniform triangles over pi."""
    return exact(f.coarse.get((tabor, spacing), np.nan) / np.pi)


def least_coarse_force(f: Facts) -> Estimate:
    """Least pull-off force over pi on the widest triangles of Fig. 7, before it rises."""
    rises = f.rises[max(f.rises)].ripples if f.rises else ()
    return exact(min((-r.pull_off / np.pi for r in rises), default=np.nan))


def singular_point_omitted(f: Facts) -> Estimate:
    """Largest ratio of the force with the singular point left out to that with it, on the same nodes."""
    pairs = zip(*(rise.ripples for rise in f.omitted), strict=False)
    return most([exact(without.pull_off / whole.pull_off) for without, whole in pairs])
