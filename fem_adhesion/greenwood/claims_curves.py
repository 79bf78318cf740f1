"""Claims of section 3 and of the conclusion: curves, jumps of the whole curve, contact radius."""

from __future__ import annotations

import numpy as np

from fem_adhesion.common.fold_birth import count_folds
from fem_adhesion.greenwood.claims_model import AFTER, BEFORE, as_printed, pressure_at
from fem_adhesion.greenwood.facts import (
    DEEP,
    HIGHEST,
    JUMPING,
    MORE_WORK,
    STIFF,
    UNKNOWN,
    Facts,
    count,
    exact,
    least,
    most,
    spread,
    steps,
)
from fem_adhesion.greenwood.tables import PROFILE_CHECKS
from fem_adhesion.greenwood.verdicts import Claim, above, below, between, digits, formula, within
from halfspace.equilibrium.conditions import Condition
from halfspace.equilibrium.contact import CONTACT_RADIUS, LOAD
from halfspace.laws import LENNARD_JONES
from halfspace.roots import root
from halfspace.theories import closed_forms, dmt
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Estimate

LOW = STIFF[:4]  # up to 0.2
BEYOND_LOAD = -4.0  # R dgamma, below the nose of Fig. 5
WIDE = 100.0  # beta, a contact radius at high loads
LINE = 0.02 * 2 * np.pi  # R dgamma, a line's width
JUMP_OFF = closed_forms.jkr_jump_off(1.0)
ZERO_LOAD = closed_forms.jkr_zero_load(1.0)
PULL_OFF = closed_forms.jkr_pull_off(1.0)


def _separation(f: Facts, tabor: float) -> Estimate:
    """Separation -alpha* at pull-off, in eps."""
    return f.number(tabor, "pull_off", "approach") * -1


def _offset_of_jkr(_: Facts) -> Estimate:
    """What must be added to JKR's load so that Hertz's equation gives JKR's approach, at a wide contact."""
    approach = closed_forms.jkr_approach(WIDE, 1.0)
    hertz = float(closed_forms.hertz_load(closed_forms.hertz_radius_at(approach, 1.0)))
    return Estimate(hertz - float(closed_forms.jkr_load(WIDE)), 1e-13 * hertz)


def _offset_of_maugis(_: Facts) -> Estimate:
    hertz = float(closed_forms.hertz_load(closed_forms.hertz_radius_at(1.0, 1.0)))
    return exact(hertz - float(dmt.maugis_load(1.0, 1.0)))


def _exponent(f: Facts) -> Estimate:
    """Power n of W = k (alpha* - alpha0)^n through three loads, each twice the one before, at mu = 0.02.

    As alpha* = alpha0 + (W/k)^(1/n), successive differences grow by 2^(1/n).
    """
    states = f.paths[STIFF[0]].at(load=DEEP * np.array([0.25, 0.5, 1.0]), branch="contact")
    points = [Estimate(float(x), float(e)) for x, e in zip(states.approach, states.approach_error, strict=True)]
    first, second = steps(points)
    return spread(lambda ratio: np.log(2) / np.log(abs(ratio)), second / first)


def _nearest_theory(f: Facts) -> Estimate:
    """Least relative deviation of Bradley's, JKR's and Maugis's loads from the computed, deep in compression."""
    mu, load = STIFF[0], DEEP
    state = f.paths[mu].at(load=load, branch="contact")
    x = float(state.approach)
    theories = (closed_forms.bradley_load(x), closed_forms.jkr_load_at(x, mu), dmt.maugis_load(x, mu))
    return Estimate(min(abs(float(W) / load - 1) for W in theories), float(state.load_error) / load)


def _two_loads(f: Facts) -> Estimate:
    return f.number(1.0, "jump_on", "approach") - f.number(1.0, "jump_off", "approach")


def _left_after_jump_off(f: Facts) -> Estimate:
    """Force left after the jump off at mu = 1, as a part of that before."""
    if 1.0 not in f.cycles:
        return UNKNOWN
    before, after = (state.estimate("load") for state in f.cycles[1.0].jump_off.ends)
    return after / before


def _power_of_separations(f: Facts) -> Estimate:
    """Power of mu of alpha*/mu at pull-off, between mu = 1 and 5."""
    return abs(spread(lambda a, b: np.log(b / a) / np.log(5), f.scaled(1.0, "pull_off"), f.scaled(5.0, "pull_off")))


def _from_jkr(f: Facts, tabor: float) -> Estimate:
    return abs(f.scaled(tabor, "zero_load") - ZERO_LOAD.approach)


def _printed(f: Facts, row: str) -> list[tuple[float, Estimate]]:
    """Printed and computed numbers of a row of Table 2."""
    return [(float(p.printed), p.computed) for p in f.tables.table_2 if p.row == row]


def _printed_scaled(f: Facts) -> Estimate:
    """Printed separation at the jump off at mu = 5, in beta^2/R, with the error of its rounding."""
    printed = [p.printed for p in f.tables.table_2 if p.row == "jump_off minus_alpha_star_over_mu" and p.column == 5]
    return Estimate(float(printed[0]), 0.5e-3) if printed else UNKNOWN


def _earlier(f: Facts, jump: str, *, on: bool) -> Estimate:
    """How many printed approaches are met before the fold: from afar if `on`, from contact otherwise."""
    pairs = _printed(f, f"{jump} minus_alpha_star")
    return count(sum(printed > ours.value if on else printed < ours.value for printed, ours in pairs))


def _crossings(f: Facts) -> Estimate:
    """How often the curve at mu = 3 crosses JKR's, both as polygons."""
    path = f.paths[3.0].resampled(400)
    radius = np.linspace(1e-4, 4, 4000)
    one = path.approach + 1j * path.load
    other = closed_forms.jkr_approach(radius, 3.0) + 1j * closed_forms.jkr_load(radius)
    p, d = one[:-1, None], np.diff(one)[:, None]
    q, e = other[None, :-1], np.diff(other)[None]
    cross = np.imag(np.conj(d) * e)
    with np.errstate(all="ignore"):
        t, u = (np.imag(np.conj(q - p) * v) / cross for v in (e, d))
    return count(int(np.sum((t >= 0) & (t < 1) & (u >= 0) & (u < 1))))


def _landing_under_load(f: Facts) -> Estimate:
    """Approach in contact under the load at which the surfaces jump on, mu = 2."""
    load = f.number(2.0, "jump_on", "load")
    state = f.paths[2.0].at(load=load.value, branch="contact")
    return Estimate(float(state.approach), float(state.approach_error))


def _apart(f: Facts) -> Estimate:
    """Distance in the approach of both states of Fig. 4, mu = 5."""
    before, after = (f.paths[5.0].at(central_gap=float(gap)) for gap, _ in PROFILE_CHECKS)
    return Estimate(float(after.approach - before.approach), float(after.approach_error + before.approach_error))


def _landing_gap(f: Facts) -> Estimate:
    return f.cycles[5.0].jump_on.landing.estimate("central_gap") if 5.0 in f.cycles else UNKNOWN


def _radius_at_zero_load(f: Facts, tabor: float) -> Estimate:
    return f.number(tabor, "zero_load", "contact_radius") / ZERO_LOAD.contact_radius


def _maugis_radius(load: float, low: float, high: float) -> float:
    """Maugis's contact radius at mu = 3 under a load, between two radii."""
    theory = MaugisDugdale.matched(3.0)
    return root(lambda a: float(theory.load(a)) - load, low, high, "Maugis's radius")


def _below_the_nose(f: Facts) -> Estimate:
    """Contact radius at mu = 3 on the unstable branch, over JKR's."""
    found = f.paths[3.0].states(Condition(LOAD, value=BEYOND_LOAD))
    radii = [float(s.point.observables[CONTACT_RADIUS]) for s in found]
    return Estimate(min(radii, default=float("nan")) / _jkr_below(), 1e-4)


def _jkr_below() -> float:
    """JKR's contact radius on the branch below the nose."""
    W = BEYOND_LOAD
    return float(np.cbrt(3 / 4 * (W + 3 * np.pi - np.sqrt(6 * np.pi * W + (3 * np.pi) ** 2))))


def _nearer_than_maugis(f: Facts) -> Estimate:
    """Distance of the contact radius from JKR's below the nose, over that of Maugis's, at mu = 3."""
    nose = MaugisDugdale.matched(3.0).pull_off().contact_radius
    his = abs(_maugis_radius(BEYOND_LOAD, 0.05, nose) / _jkr_below() - 1)
    return abs(_below_the_nose(f) - 1) / his


def _central_pressure(f: Facts, tabor: float) -> Estimate:
    """Pressure at the centre under no load, over JKR's 2 a/pi - sqrt(2/(pi a))."""
    a, gap = ZERO_LOAD.contact_radius, f.number(tabor, "zero_load", "central_gap")
    P = spread(lambda H: float(LENNARD_JONES.pressure(np.array(H), tabor)), gap)
    return P / float(2 * a / np.pi - np.sqrt(2 / (np.pi * a)))


def _hybrid(f: Facts) -> Estimate:
    """Load at zero approach at mu = 3, over JKR's."""
    return f.load(3.0, 0.0, "contact") / closed_forms.jkr_zero_approach(1.0).load


def _far(f: Facts) -> Estimate:
    """Largest deviation from Bradley's load three jump-on separations away, relative, at any mu of Table 2."""
    ratios = []
    for mu in JUMPING:
        approach = 3 * f.paths[mu].events["jump_on"].approach if "jump_on" in f.paths[mu].events else -5.0
        ratios.append(abs(f.load(mu, approach, "separated") / float(closed_forms.bradley_load(approach)) - 1))
    return most(ratios)


SECTION_3 = (
    Claim[Facts](
        "3, Fig. 1b",
        "At mu = 0.05 the curve is almost indistinguishable from Bradley's (largest distance in load, apart).",
        below(LINE, "almost indistinguishable", "2 % of 2 pi, a line's width, our reading"),
        lambda f: f.from_bradley(0.05, -6.0, 0.0),
        "R dgamma",
        "fig_1b",
    ),
    Claim[Facts](
        "3, Fig. 1a",
        "Bradley's equation is the limit of vanishing mu (that distance at mu = 0.02 over that at 0.05).",
        below(0.4, "limit", "at least in proportion to mu"),
        lambda f: f.from_bradley(0.02, -6.0, 0.0) / f.from_bradley(0.05, -6.0, 0.0),
        "1",
        "fig_1a",
    ),
    Claim[Facts](
        "3, Fig. 1a",
        "The largest tension is below Bradley's in all cases (largest over 2 pi, mu = 0.02 to 6).",
        below(1, "below"),
        lambda f: most([f.force(mu) for mu in f.paths]) / -BRADLEY_PULL_OFF,
        "1",
        "fig_1a, pull_off",
    ),
    Claim[Facts](
        "3, Fig. 1a",
        "It is only slightly below (least over 2 pi, mu up to 0.2).",
        above(0.95, "slightly", "5 %, our reading"),
        lambda f: least([f.force(mu) for mu in LOW]) / -BRADLEY_PULL_OFF,
        "1",
        "fig_1a, pull_off",
    ),
    Claim[Facts](
        "3, Fig. 1a",
        "It occurs at a positive separation (least -alpha*, mu up to 0.2).",
        above(0, "positive"),
        lambda f: least([_separation(f, mu) for mu in LOW]),
        "eps",
        "fig_1a",
    ),
    Claim[Facts](
        "3, Fig. 1a",
        "That separation is small (largest -alpha*, mu up to 0.2).",
        below(0.2, "small", "a fifth of eps, our reading"),
        lambda f: most([_separation(f, mu) for mu in LOW]),
        "eps",
        "fig_1a",
    ),
    Claim[Facts](
        "3, Fig. 1c",
        "Under large loads the computed curve rises more or less as alpha^(3/2), with an offset (power through loads "
        "of 5, 10 and 20 at mu = 0.02).",
        between(1.2, 1.8, "3/2, more or less", "20 %, our reading"),
        _exponent,
        "1",
        "fig_1c",
    ),
    Claim[Facts](
        "3, Fig. 1c",
        "DMT-M is Hertz's equation with 2 pi R dgamma added to the load.",
        formula(2 * np.pi, "2 pi"),
        _offset_of_maugis,
        "R dgamma",
        "fig_1c",
    ),
    Claim[Facts](
        "3, Fig. 1c",
        "JKR's curve at high loads is almost that with pi R dgamma added (at a contact radius of 100 beta).",
        within(np.pi, 0.01, "pi, almost", "1 %, our reading"),
        _offset_of_jkr,
        "R dgamma",
        "fig_1c",
    ),
    Claim[Facts](
        "3, Fig. 2a",
        "A vertical tangent first appears at mu about 1.",
        digits("1"),
        lambda f: f.critical_tabor,
        "1",
        "fig_2a",
    ),
    Claim[Facts](
        "3, Fig. 2a",
        "For mu > 1 a range of separations has two loads (its width at mu = 1).",
        above(0, "a range"),
        _two_loads,
        "eps",
        "fig_2a",
    ),
    Claim[Facts](
        "3",
        "At the jump off the force drops to a lower value and not to zero (what is left at mu = 1, as a part).",
        between(0.01, 0.99, "lower, not zero"),
        _left_after_jump_off,
        "1",
        "fig_2a",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "For higher mu the largest tension continues to fall (largest change between mu = 1, 2, 3, 5).",
        below(0, "falls"),
        lambda f: most(steps([f.force(mu) for mu in HIGHEST])),
        "R dgamma",
        "fig_2b",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "It occurs at steadily larger separations (least change of -alpha* between mu = 1, 2, 3, 5).",
        above(0, "increases"),
        lambda f: least(steps([_separation(f, mu) for mu in HIGHEST])),
        "eps",
        "fig_2b",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "These are almost one value of alpha*/mu (size of the power of mu by which that changes from mu = 1 to 5).",
        below(0.1, "almost constant", "a tenth, our reading"),
        _power_of_separations,
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "The high-load branches condense on JKR's curve (largest change of the distance at zero load from JKR's "
        "alpha*/mu, between mu = 1, 2, 3, 5).",
        below(0, "condense"),
        lambda f: most(steps([_from_jkr(f, mu) for mu in HIGHEST])),
        "beta^2/R",
        "fig_2b",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "At mu = 5 the pull-off force is within 2 % of JKR's.",
        within(-JKR_PULL_OFF, 0.02, "2 %", "2 % of 3 pi/2"),
        lambda f: f.force(5.0),
        "R dgamma",
        "fig_2b, pull_off",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "At mu = 5 pull-off occurs at JKR's separation (alpha*/mu).",
        within(PULL_OFF.approach, 0.02, "at the JKR separation", "2 %, as for the force, our reading"),
        lambda f: f.scaled(5.0, "pull_off"),
        "beta^2/R",
        "fig_2b",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "At mu = 5 the separation at the jump off is within 1 % of JKR's (alpha*/mu).",
        within(JUMP_OFF.approach, 0.01, "1 %", "1 % of (3/4) pi^(2/3)"),
        lambda f: f.scaled(5.0, "jump_off"),
        "beta^2/R",
        "fig_2b, table_2",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "The same of the number that Table 2 prints for it.",
        within(-JUMP_OFF.approach, 0.01, "1 %", "1 % of (3/4) pi^(2/3)"),
        _printed_scaled,
        "beta^2/R",
        "table_2",
    ),
    Claim[Facts](
        "3, Fig. 2b",
        "The tension at the jump off is perhaps slightly above JKR's (over JKR's, mu = 5).",
        between(1, 1.05, "slightly higher", "up to 5 %, our reading"),
        lambda f: f.number(5.0, "jump_off", "load") / JUMP_OFF.load,
        "1",
        "fig_2b, table_2",
    ),
    Claim[Facts](
        "3, footnote",
        "JKR's least scaled approach is -0.75 pi^(2/3), at s = 6^(-2/3) (least of the printed curve).",
        formula(-0.75 * np.pi ** (2 / 3), "-0.75 pi^(2/3)"),
        lambda _: exact(
            float(np.min(closed_forms.jkr_approach(JUMP_OFF.contact_radius + np.linspace(-0.1, 0.1, 2001), 1.0)))
        ),
        "beta^2/R",
        "fig_2b",
    ),
    Claim[Facts](
        "3, footnote",
        "Before a jump only the law beyond h of about 2 eps acts (central h at the jump on, mu = 2).",
        digits("2"),
        lambda f: f.number(2.0, "jump_on", "central_gap") + 1,
        "eps",
        "table_2",
    ),
    Claim[Facts](
        "3, Fig. 3",
        "With the central gap prescribed the curves for mu = 1 and 2 are S-shaped (folds at mu = 2).",
        between(2, 2, "S-shaped", "two folds"),
        lambda f: count(count_folds(f.paths[2.0])),
        "folds",
        "fig_3a, fig_3b",
    ),
    Claim[Facts](
        "3, Fig. 3c",
        "At mu = 3 the curve crosses JKR's, twists round and recrosses it (number of crossings).",
        above(2, "crosses and recrosses", "two at least"),
        _crossings,
        "crossings",
        "fig_3c",
    ),
    Claim[Facts](
        "3",
        "Jumps on computed with the approach prescribed occur slightly earlier than the fold (printed ones that do, of "
        "five).",
        above(5, "earlier", "all five"),
        lambda f: _earlier(f, "jump_on", on=True),
        "jumps",
        "table_2",
    ),
    Claim[Facts](
        "3",
        "Jumps off computed so occur slightly earlier than the fold (printed ones that do, of four).",
        above(4, "earlier", "all four"),
        lambda f: _earlier(f, "jump_off", on=False),
        "jumps",
        "table_2",
    ),
    Claim[Facts](
        "3",
        "Below mu of about 1 loading is smooth and reversible (folds at mu = 0.5).",
        below(0, "smooth", "no fold"),
        lambda f: count(count_folds(f.paths[0.5])),
        "folds",
        "fig_3a",
    ),
    Claim[Facts](
        "3",
        "In fixed grips nothing pulls off for mu < 1 (folds at mu = 0.9).",
        below(0, "no pull-off force", "no fold"),
        lambda f: count(count_folds(f.paths[0.9])),
        "folds",
        "beyond_folds",
    ),
    Claim[Facts](
        "3",
        "For higher mu a cycle loses energy (at mu = 1).",
        above(0, "energy losses"),
        lambda f: f.cycles[1.0].energy_lost if 1.0 in f.cycles else UNKNOWN,
        "R dgamma eps",
        "fig_2a, devices",
    ),
    Claim[Facts](
        "3",
        "Under constant load the jump on lands where the separation has become an approach (alpha* after it, mu = 2).",
        above(0, "an approach"),
        _landing_under_load,
        "eps",
        "fig_3b",
    ),
    Claim[Facts](
        "3, Fig. 4",
        "Before the jump on at mu = 5 the centre is at H = 2.554 and P = -0.2968 (P at that gap by the law).",
        as_printed(*BEFORE),
        lambda _: pressure_at(BEFORE[0]),
        "dgamma/(mu eps)",
        "fig_4a, fig_4_checks",
    ),
    Claim[Facts](
        "3, Fig. 4",
        "After it the centre is at H = -0.0036 and P = +0.2943 (P at that gap by the law).",
        as_printed(*AFTER),
        lambda _: pressure_at(AFTER[0]),
        "dgamma/(mu eps)",
        "fig_4a, fig_4_checks",
    ),
    Claim[Facts](
        "3, Fig. 4",
        "After it the centre is at H = -0.0036 (where the jump lands).",
        digits("-0.0036"),
        _landing_gap,
        "eps",
        "fig_4b",
    ),
    Claim[Facts](
        "3, Fig. 4",
        "Before it the central gap is 2.554 (at the fold; Table 2 prints 2.361).",
        digits("2.554"),
        lambda f: f.number(5.0, "jump_on", "central_gap"),
        "eps",
        "fig_4b, table_2",
    ),
    Claim[Facts](
        "3, Fig. 4",
        "Both states of Fig. 4 belong to one approach (difference of theirs).",
        between(-1e-3, 1e-3, "0.000", "last digit of the approaches of Table 2"),
        _apart,
        "eps",
        "fig_4b",
    ),
    Claim[Facts](
        "3",
        f"The jump on does not depend on dgamma: a law with {100 * MORE_WORK:.0f} % more, added at gaps below that of "
        "the jump alone, jumps on at the same approach (change, mu = 5).",
        between(-1e-6, 1e-6, "cannot depend", "a millionth of eps, our reading"),
        lambda f: f.cores[min(f.cores)] if f.cores else UNKNOWN,
        "eps",
        "claims_numbers",
    ),
    Claim[Facts](
        "3",
        "The same with dgamma added below the paper's gap of 2.554.",
        between(-1e-6, 1e-6, "cannot depend", "a millionth of eps, our reading"),
        lambda f: f.cores[max(f.cores)] if f.cores else UNKNOWN,
        "eps",
        "claims_numbers",
    ),
    Claim[Facts](
        "3a",
        "The tension is largest where the gap h is 1.2009 eps.",
        digits("1.2009"),
        lambda _: exact(LENNARD_JONES.edge_gap + 1),
        "eps",
        "fig_4a",
    ),
    Claim[Facts](
        "3a",
        "For large mu it lies at the edge of JKR's contact (radius over JKR's at zero load, mu = 5).",
        within(1, 0.01, "same location", "1 %, our reading"),
        lambda f: _radius_at_zero_load(f, 5.0),
        "1",
        "fig_5",
    ),
    Claim[Facts](
        "3a, Fig. 5",
        "Above the nose the radius is slightly below JKR's (over JKR's at zero load, mu = 3).",
        between(0.95, 1, "slightly below", "5 %, our reading"),
        lambda f: _radius_at_zero_load(f, 3.0),
        "1",
        "fig_5",
    ),
    Claim[Facts](
        "3a, Fig. 5",
        "So it is in Maugis's model (his over JKR's at zero load, mu = 3).",
        between(0.95, 1, "slightly below", "5 %, our reading"),
        lambda _: exact(_maugis_radius(0.0, 1.5, 3.5) / ZERO_LOAD.contact_radius),
        "1",
        "fig_5",
    ),
    Claim[Facts](
        "3a, Fig. 5",
        "Below the nose it is distinctly lower than JKR's (over JKR's at W = -4 on the unstable branch, mu = 3).",
        below(0.95, "distinctly lower", "5 %, our reading"),
        _below_the_nose,
        "1",
        "fig_5",
    ),
    Claim[Facts](
        "3a, Fig. 5",
        "There it is closer to JKR's than Maugis's is (distance over his, lambda = 1.157 mu, mu = 3).",
        below(1, "closer"),
        _nearer_than_maugis,
        "1",
        "fig_5",
    ),
)
SECTION_5 = (
    Claim[Facts](
        "5",
        "Above mu = 2 the curve is JKR's where the approach is positive or only slightly negative (load at alpha* = 0, "
        "mu = 3, over JKR's).",
        within(1, 0.05, "approximate", "5 %, our reading"),
        _hybrid,
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "5",
        "At large separations it is Bradley's for all mu (largest relative deviation at three times the separation of "
        "the jump on, mu = 1 to 6).",
        below(0.05, "describes", "5 %, our reading"),
        _far,
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "5",
        "For mu up to 0.2 it is Bradley's in the tensile region (largest distance apart, mu = 0.2).",
        below(0.1 * np.pi, "approximate", "5 % of 2 pi, our reading"),
        lambda f: f.from_bradley(0.2, -6.0, 0.0),
        "R dgamma",
        "fig_1a",
    ),
    Claim[Facts](
        "5",
        "So it is even for negative separations at small mu (largest distance for alpha* up to 0.1, mu = 0.05).",
        below(0.1 * np.pi, "accurately", "5 % of 2 pi, our reading"),
        lambda f: f.from_bradley(0.05, 0.0, 0.1),
        "R dgamma",
        "fig_1b",
    ),
    Claim[Facts](
        "5",
        "The same up to alpha* = 0.206, where Bradley's tension ends, mu = 0.05.",
        below(0.1 * np.pi, "accurately", "5 % of 2 pi, our reading"),
        lambda f: f.from_bradley(0.05, 0.0, 0.206),
        "R dgamma",
        "fig_1b",
    ),
    Claim[Facts](
        "5",
        "When the load becomes compressive none of the theories is adequate (least deviation of Bradley's, JKR's and "
        "DMT-M's load at W = 20, mu = 0.02).",
        above(0.1, "none adequate", "10 %, our reading"),
        _nearest_theory,
        "1",
        "fig_1c",
    ),
    Claim[Facts](
        "5",
        "Above mu = 3 pressures in contact are close to JKR's (at the centre under no load, over JKR's, mu = 5).",
        within(1, 0.05, "close", "5 %, our reading"),
        lambda f: _central_pressure(f, 5.0),
        "1",
        "beyond_profiles",
    ),
    Claim[Facts](
        "5",
        "The contact radius agrees well with JKR's (over JKR's at zero load, mu = 3).",
        within(1, 0.02, "well", "2 %, our reading"),
        lambda f: _radius_at_zero_load(f, 3.0),
        "1",
        "fig_5",
    ),
)
