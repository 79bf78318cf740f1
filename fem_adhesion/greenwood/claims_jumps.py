"""Claims of section 4c and Appendix C: where the surfaces jump on and off, and the criteria for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from fem_adhesion.greenwood.facts import JUMPING, UNKNOWN, Facts, count, exact, least, most, spread
from fem_adhesion.greenwood.tables import LAST_DIGIT, PROFILE_CHECKS, Printed, printed_column
from fem_adhesion.greenwood.verdicts import (
    FAILS,
    Allowed,
    Claim,
    Reading,
    above,
    below,
    between,
    digits,
    formula,
    within,
)
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.theories import criteria
from halfspace.values import Estimate

RIGID = np.pi * np.sqrt(2)  # w(0) = pi sqrt2 mu^(3/2) (H0 + 1)^(-5/2) of undeformed surfaces, eps
CRITICAL = between(0.6, 0.8, "0.6-0.8", "as printed")
AT_ONE = within(1, 0.1, "1", "10 %, our reading")
PREDICTED = {
    "Attard & Parker's (4.4)": float(criteria.ATTARD_PARKER),
    "Pethica & Sutton's": float(criteria.PETHICA_SUTTON),
    "Appendix C's": float(criteria.APPENDIX_C),
}


def _right(entries: list[Printed]) -> Estimate:
    return count(sum(p.note == LAST_DIGIT for p in entries))


def _of(f: Facts, jump: str) -> list[Printed]:
    """Entries of Table 2 at a jump, but for Attard & Parker's row."""
    return [p for p in f.tables.table_2 if p.row.startswith(jump) and not p.row.endswith("_AP")]


def _all(number: int) -> Allowed:
    return between(number, number, "Table 2", f"all {number} to the last digit")


def _less_defined(f: Facts) -> Estimate:
    """Largest relative deviation of a printed load from ours over that of a printed approach."""
    worst = [
        max((abs(p.deviation) for p in f.tables.table_2 if p.row.endswith(end)), default=np.nan)
        for end in LOAD_AND_PLACE
    ]
    return exact(worst[0] / worst[1])


LOAD_AND_PLACE = ("minus_W_over_R_dgamma", "minus_alpha_star")


def _ratio_of_rows(approach: str) -> Callable[[Facts], Estimate]:
    return lambda _: exact(float(approach) / 5)


def _gap(f: Facts, tabor: float, event: str = "jump_on") -> Estimate:
    """Central h in eps."""
    return f.number(tabor, event, "central_gap") + 1


def _over_true(k: float, event: str, tabor: float) -> Callable[[Facts], Estimate]:
    """(H0 + 1)^(7/2) by a closed criterion over the true one."""
    return lambda f: spread(lambda h: k * RIGID * tabor**1.5 / h**3.5, _gap(f, tabor, event))


def _fitted(event: str) -> Callable[[Facts], Estimate]:
    """Gap h by (4.5) over the true one, mu = 5."""
    return lambda f: exact(float(criteria.fitted_gap(5.0)) + 1) / _gap(f, 5.0, event)


def _worst_fit(f: Facts) -> Estimate:
    """Largest relative deviation of h by (4.5), Tabor parameters of Table 2."""
    return most([abs(exact(float(criteria.fitted_gap(mu)) + 1) / _gap(f, mu) - 1) for mu in JUMPING])


def _by_approach(f: Facts, event: str, tabor: float) -> Estimate:
    """|alpha*| + 1 by the fit of Appendix C over the true one."""
    true = f.number(tabor, event, "approach") * -1 + 1
    return exact(1 - float(criteria.fitted_approach(tabor))) / true


def _constant(f: Facts, name: str, index: int) -> Estimate:
    """A refitted constant with its standard error."""
    found = [c.constants[index][2] for c in f.criteria.criteria if c.name == name]
    return found[0] if found else UNKNOWN


def _power(f: Facts) -> Estimate:
    """Power of mu of H0 + 1 between mu = 2 and 6."""
    return spread(lambda a, b: np.log(b / a) / np.log(3), _gap(f, 2.0), _gap(f, 6.0))


def over_bulge(f: Facts, tabor: float) -> Estimate:
    """h0/w(0) at the jump on."""
    return _gap(f, tabor) / f.bulge(tabor)


def rigid_bulge(f: Facts, tabor: float) -> Estimate:
    """Central displacement that the attraction across undeformed surfaces would have at the jump on, in eps."""
    return spread(lambda h: RIGID * tabor**1.5 / h**2.5, _gap(f, tabor))


def _criteria(f: Facts) -> list[Estimate]:
    return [abs(f.criterion(mu, "jump_on")) for mu in JUMPING]


def _before(f: Facts) -> Estimate:
    """Half the critical parameter in the state before the jump of Fig. 4."""
    state = f.paths[5.0].at(central_gap=float(PROFILE_CHECKS[0][0]))
    value = float(criteria.fundamental_criterion(state.approach, state.central_gap))
    return Estimate(abs(value) / 2, float(state.approach_error + state.central_gap_error))


def _defined(f: Facts, *, by_load: bool) -> Estimate:
    """At how many jumps on of Table 2 equation (4.2), for alpha* > 0, or (4.3) has a value."""
    approaches = [f.number(mu, "jump_on", "approach") for mu in JUMPING]
    known = [a.value > 0 if by_load else bool(np.isfinite(f.criterion(mu, "jump_on").value))
             for mu, a in zip(JUMPING, approaches, strict=True)]  # fmt: skip
    return count(sum(known))


def _peel(f: Facts) -> Estimate:
    """Radius at which the pressure changes most along the curve at the jump off, over the contact radius, mu = 3."""
    found = f.paths[3.0].stages[-1].get("jump_off")
    if not found:
        return UNKNOWN
    problem, x = found.problem.interface, found.problem.surface_state(found.point.x)
    gaps, radii = x[:-2], problem.operator_at(x).radii
    change = problem.law.slope(gaps, problem.tabor) * found.problem.surface_state(found.point.tangent)[:-2]
    at = int(np.abs(change).argmax())
    apart = max(radii[at + 1] - radii[at], radii[at] - radii[at - 1]) if at else radii[1]
    return Estimate(float(radii[at]), float(apart)) / float(found.point.observables[CONTACT_RADIUS])


def _rigid_factor(_: Facts) -> Estimate:
    """w(0) of undeformed surfaces at h0 = eps, mu = 1, by quadrature: 2 int sigma dr, sigma = (8/3) h^-3."""
    value, error = quad(lambda r: 2 * 8 / 3 * (1 + r**2 / 2) ** -3, 0, np.inf, epsabs=1e-13, epsrel=1e-13)
    return Estimate(value, error)


def _fold_of_rigid(_: Facts) -> Estimate:
    """h0/w(0) where h0 + w(0) is least, w(0) = h0^(-5/2)."""
    h = float(minimize_scalar(lambda h: h + h**-2.5, bounds=(1, 2), method="bounded", options={"xatol": 1e-12}).x)
    return Estimate(h**3.5, 1e-6)


def _worst_of_attard_parker(f: Facts) -> Estimate:
    """Largest deviation of the printed loads of (4.4) from ours, in units of the last digit."""
    return most([abs(p.computed - float(p.printed)) * 1e3 for p in f.tables.table_2 if p.row.endswith("_AP")])


def _merely_fair(f: Facts) -> Estimate:
    """Largest relative deviation of Attard & Parker's loads from those of the true jumps."""
    gap = [float(criteria.closed_gap(mu, criteria.ATTARD_PARKER)) for mu in JUMPING]
    theirs = [exact(float(criteria.undeformed_load(h))) for h in gap]
    return most([abs(w / f.number(mu, "jump_on", "load") - 1) for w, mu in zip(theirs, JUMPING, strict=True)])


def _closed(name: str, k: float, event: str) -> Claim[Facts]:
    """Claim of a closed criterion at a jump: the paper has it too large at the jump on, and no use for it elsewhere."""
    on = event == "jump_on"
    return Claim[Facts](
        "4c" if on else "beyond 4c",
        f"{name} factor of mu^(3/2) is substantially too large (over that of the jump on, mu = 5)."
        if on
        else f"{name} criterion at the jump off, where the paper does not test it ((H0 + 1)^(7/2) over the true, mu = "
        "5).",
        above(1.5, "substantially too large", "a half, our reading") if on else AT_ONE,
        _over_true(k, event, 5.0),
        "1",
        "beyond_criteria, criteria",
    )


SECTION_4C = (
    Claim[Facts](
        "4c",
        "A soft enough apparatus jumps even at mu = 0.5 (stiffness below which it does).",
        above(0, "there may be jumps"),
        lambda f: exact(f.stiffnesses[0.5]) if 0.5 in f.stiffnesses else UNKNOWN,
        "R dgamma/eps",
        "beyond_devices",
    ),
    Claim[Facts](
        "4c",
        "Or less (the same at mu = 0.02).",
        above(0, "or less"),
        lambda f: exact(f.stiffnesses[0.02]) if 0.02 in f.stiffnesses else UNKNOWN,
        "R dgamma/eps",
        "beyond_devices",
    ),
    Claim[Facts](
        "4c, Table 2",
        "The separation at a fold is well defined and the load less so (largest relative deviation of a printed load "
        "over that of a printed separation).",
        above(1, "less well defined"),
        _less_defined,
        "1",
        "table_2",
    ),
    Claim[Facts](
        "4c, Table 2",
        "Table 2 at the jump on (numbers right to the last digit).",
        _all(20),
        lambda f: _right(_of(f, "jump_on")),
        "numbers",
        "table_2",
    ),
    Claim[Facts](
        "4c, Table 2",
        "Table 2 at the jump off (numbers right to the last digit).",
        _all(20),
        lambda f: _right(_of(f, "jump_off")),
        "numbers",
        "table_2",
    ),
    Claim[Facts](
        "4c, Table 2",
        "At mu = 5 the surfaces jump off at 8.178, which over mu is the 1.637 of the next row.",
        digits(printed_column("jump_off", 5.0)["minus_alpha_star_over_mu"]),
        _ratio_of_rows(printed_column("jump_off", 5.0)["minus_alpha_star"]),
        "beta^2/R",
        "table_2",
        Reading("with 8.187, two digits exchanged", _ratio_of_rows("8.187"), digits("1.637")),
    ),
    Claim[Facts](
        "4c",
        "Attard & Parker: surfaces jump where w(0) sigma'/sigma, (4.3), is -1 (at the jump on, mu = 5).",
        digits("-1.0"),
        lambda f: f.criterion(5.0, "jump_on"),
        "1",
        "criteria, claims_numbers",
    ),
    Claim[Facts](
        "4c",
        "The fundamental criterion that is tested is equation (4.2) (jumps of Table 2, of five, at which it has a "
        "value).",
        between(5, 5, "(4.2)", "all five"),
        lambda f: _defined(f, by_load=True),
        "jumps",
        "criteria",
        Reading("for (4.3)", lambda f: _defined(f, by_load=False), between(5, 5, "(4.3)", "all five")),
    ),
    Claim[Facts](
        "4c",
        "At the jump on this critical parameter is 0.6 to 0.8 (largest size, mu = 1 to 6).",
        CRITICAL,
        lambda f: most(_criteria(f)),
        "1",
        "criteria",
    ),
    Claim[Facts](
        "4c",
        "The same with the factor two that the footnote to (4.3) omits (largest half, mu = 1 to 6).",
        CRITICAL,
        lambda f: most(_criteria(f)) / 2,
        "1",
        "criteria",
    ),
    Claim[Facts](
        "4c",
        "The same half in the state of Fig. 4 before the jump, H = 2.554, mu = 5.",
        CRITICAL,
        _before,
        "1",
        "criteria",
    ),
    Claim[Facts](
        "4c",
        "At the jump off (4.3) is simply wrong, far from -1 (its value at mu = 1).",
        above(0, "simply wrong", "not even the sign"),
        lambda f: f.criterion(1.0, "jump_off"),
        "1",
        "claims_numbers",
    ),
    Claim[Facts](
        "4c",
        "The same at mu = 5.",
        above(0, "simply wrong", "not even the sign"),
        lambda f: f.criterion(5.0, "jump_off"),
        "1",
        "claims_numbers",
    ),
    Claim[Facts](
        "4c",
        "The jump off starts by peeling from the edge of the contact (radius at which the pressure changes most along "
        "the curve there, over the contact radius, mu = 3).",
        within(1, 0.15, "from the edge", "15 %, our reading"),
        _peel,
        "1",
        "claims",
    ),
    *(_closed(name, k, "jump_on") for name, k in PREDICTED.items()),
    *(_closed(name, k, "jump_off") for name, k in PREDICTED.items()),
    Claim[Facts](
        "4c",
        "H0 + 1 at the jump on is proportional to mu^(3/7) (power between mu = 2 and 6).",
        within(3 / 7, 0.02, "3/7", "2 %, our reading"),
        _power,
        "1",
        "beyond_criteria, table_2",
    ),
    Claim[Facts](
        "4c, (4.5)",
        "The factor fitted to the gaps is 6.233 (refitted, standard error).",
        within(6.233, 0.005, "6.233", "half a per cent, our reading"),
        lambda f: _constant(f, "fit (4.5)", 0),
        "1",
        "criteria_constants",
    ),
    Claim[Facts](
        "4c, (4.5)",
        "The term of repulsion in it is 1.6 (refitted, standard error).",
        digits("1.6"),
        lambda f: _constant(f, "fit (4.5)", 1),
        "1",
        "criteria_constants",
    ),
    Claim[Facts](
        "4c, (4.5)",
        "The fit is excellent (largest relative deviation of H0 + 1, mu = 1 to 6).",
        below(0.005, "excellent", "half a per cent, our reading"),
        _worst_fit,
        "1",
        "criteria",
    ),
    Claim[Facts](
        "beyond 4c",
        "The fit (4.5) at the jump off, where the paper does not test it (H0 + 1 over the true, mu = 5).",
        AT_ONE,
        _fitted("jump_off"),
        "1",
        "claims",
    ),
    Claim[Facts](
        "4c, (4.5)",
        "The repulsion matters little but for mu = 1 (part of (H0 + 1)^(7/2) by that term at mu = 2).",
        below(0.02, "little importance", "2 %, our reading"),
        lambda f: spread(lambda h: criteria.FIT_REPULSION / h**6, _gap(f, 2.0)),
        "1",
        "criteria",
    ),
    Claim[Facts](
        "4c, (4.5)",
        "At mu = 1 the gap H0 is 1.62.",
        within(1.62, 0.02, "1.62", "2 %, our reading"),
        lambda f: f.number(1.0, "jump_on", "central_gap"),
        "eps",
        "table_2",
        Reading(
            "for H0 + 1",
            lambda f: _gap(f, 1.0),
            within(1.62, 0.02, "1.62", "2 %, our reading"),
        ),
    ),
    Claim[Facts](
        "4c, Table 2",
        "Attard & Parker's criterion predicts the printed critical loads (largest deviation in units of the last "
        "digit).",
        below(0.5 + 1e-9, "Table 2", "half of the last digit"),
        _worst_of_attard_parker,
        "1",
        "table_2",
    ),
    Claim[Facts](
        "4c, Table 2",
        "Their agreement with the true loads is merely fair (largest relative deviation, mu = 1 to 6).",
        between(0.05, 0.2, "merely fair", "5 to 20 %, our reading"),
        _merely_fair,
        "1",
        "table_2",
    ),
)
APPENDIX_C = (
    Claim[Facts](
        "App. C",
        "The separations obey (|alpha*| + 1)^(7/2) = 3 pi^2 mu^(3/2) (|alpha*| + 1 by it over the true, mu = 1).",
        within(1, 0.005, "obey", "half a per cent, our reading"),
        lambda f: _by_approach(f, "jump_on", 1.0),
        "1",
        "criteria",
    ),
    Claim[Facts](
        "App. C",
        "The same at mu = 6.",
        within(1, 0.005, "obey", "half a per cent, our reading"),
        lambda f: _by_approach(f, "jump_on", 6.0),
        "1",
        "criteria",
    ),
    Claim[Facts](
        "beyond App. C",
        "The same at the jump off, where the paper does not test it (mu = 5).",
        AT_ONE,
        lambda f: _by_approach(f, "jump_off", 5.0),
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. C",
        "Its factor is 3 pi^2 (refitted, standard error).",
        within(3 * np.pi**2, 0.02, "3 pi^2", "2 %, our reading"),
        lambda f: _constant(f, "fit of App. C", 0),
        "1",
        "criteria_constants",
    ),
    Claim[Facts](
        "App. C",
        "The attraction across undeformed surfaces displaces the centre by pi sqrt2 mu^(3/2) h0^(-5/2) (factor, by "
        "quadrature).",
        formula(RIGID, "pi sqrt2"),
        _rigid_factor,
        "eps",
        "claims",
    ),
    Claim[Facts](
        "App. C",
        "With that, the approach turns where h0 = (5/2) w(0) (found by search).",
        within(2.5, 1e-5, "5/2", "what the search leaves"),
        _fold_of_rigid,
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. C",
        "Pethica & Sutton's factor 16 pi/3 is h0 = (8 sqrt2/3) w(0).",
        formula(16 * np.pi / 3, "16 pi/3"),
        lambda f: _rigid_factor(f) * float(criteria.PETHICA_SUTTON),
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. C",
        "The numerical result is h0 = 1.403 w(0), w(0) as found numerically (h0/w(0), mu = 5).",
        digits("1.403"),
        lambda f: over_bulge(f, 5.0),
        "1",
        "claims_numbers",
        Reading(
            "with the w(0) of undeformed surfaces: 6.233/(pi sqrt2)",
            lambda _: exact(criteria.FIT / RIGID),
            digits("1.403"),
            FAILS,
        ),
    ),
    Claim[Facts](
        "App. C",
        "The same, least value of mu = 1, 2, 3, 5, 6.",
        digits("1.403"),
        lambda f: least([over_bulge(f, mu) for mu in JUMPING]),
        "1",
        "claims_numbers",
    ),
    Claim[Facts](
        "App. C",
        "The displacement found is appreciably larger than that across undeformed surfaces (ratio, mu = 5).",
        above(1.05, "appreciably larger", "5 %, our reading"),
        lambda f: f.bulge(5.0) / rigid_bulge(f, 5.0),
        "1",
        "claims_numbers",
    ),
    Claim[Facts](
        "App. C",
        "The numerical h0/w(0) is much lower than that of the three criteria, 2.5 to 3.8 (largest, mu = 1 to 6).",
        below(2, "much lower", "a fifth below the lowest, our reading"),
        lambda f: most([over_bulge(f, mu) for mu in JUMPING]),
        "1",
        "claims_numbers",
    ),
)
