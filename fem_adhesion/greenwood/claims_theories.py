"""Claims of sections 4a and 4b: the DMT theories, and Attard & Parker's results."""

from __future__ import annotations

import numpy as np

from fem_adhesion.greenwood.facts import (
    COARSE,
    HIGHEST,
    RISEN,
    UNKNOWN,
    WIDEST,
    Facts,
    count,
    exact,
    least,
    most,
    steps,
)
from fem_adhesion.greenwood.verdicts import Claim, Reading, above, below, between, digits, within
from halfspace import scaling
from halfspace.theories import closed_forms, dmt
from halfspace.values import Estimate

APPROACHES = np.geomspace(1e-3, 5, 200)  # eps
SPREAD = (0.1, 0.5)  # Tabor parameters of Fig. 6 between which curves spread
EQUAL = 1.0  # alpha*/mu at which they are compared
LIMIT = 2 / (3 * np.pi)  # of Hertz's load over 2 pi R dgamma (alpha*/mu)^(3/2)


def _thermodynamic_rise(_: Facts) -> Estimate:
    return exact(float(np.max(np.diff(dmt.thermodynamic_tension(APPROACHES)))))


def _least_excess(_: Facts) -> Estimate:
    return exact(float(np.min(dmt.force_excess(APPROACHES))))


def _leading(_: Facts) -> Estimate:
    """Limit of f/alpha*^(3/2), from two small approaches whose roots are as 1 to 2; b alpha*^(1/2) drops out."""
    near, far = (float(dmt.force_excess(x)) / x**1.5 for x in (1e-6, 4e-6))
    return Estimate(2 * near - far, abs(near - far) / 10)


def _worst_of_table_1(f: Facts) -> Estimate:
    """Largest deviation from Table 1 in units of its last digit."""
    return most([abs(p.computed - float(p.printed)) * 1e3 for p in f.tables.table_1])


def _threshold(f: Facts) -> Estimate:
    """Tabor parameter at which Hertz's load and the excess tension grow alike at first touch."""
    leading = _leading(f)
    value = (LIMIT / leading.value) ** (2 / 3)
    return Estimate(value, 2 / 3 * value * leading.error / leading.value)


def _spread(f: Facts) -> Estimate:
    """Spread of the DMT loads at one alpha*/mu over that of the computed, both from mu = 0.1 to 0.5."""
    theirs = [float(dmt.force_load(EQUAL * mu, mu)) for mu in SPREAD]
    ours = [f.load(mu, EQUAL * mu) for mu in SPREAD]
    return exact(theirs[1] - theirs[0]) / (ours[1] - ours[0])


def _pulled_off(f: Facts, *, apart: bool) -> Estimate:
    """At how many Tabor parameters pull-off occurs apart, alpha* < 0, or pressed together."""
    return count(sum((path.events["pull_off"].approach < 0) is apart for path in f.paths.values()))


def _beside_dmt(f: Facts) -> Estimate:
    """Distance of the load from Bradley's over that from the DMT theory's, just past touch at mu = 0.02."""
    load = f.load(0.02, 0.05)
    bradley, force = float(closed_forms.bradley_load(0.05)), float(dmt.force_load(0.05, 0.02))
    return abs(load - bradley) / abs(load - force)


def _after_jump(f: Facts) -> list[Estimate]:
    """Tension just after the jump on, over the pull-off force."""
    return [f.cycles[mu].jump_on.landing.estimate("load") / -f.force(mu).value for mu in HIGHEST if mu in f.cycles]


def _false(f: Facts) -> list[float]:
    """Forces over pi on the widest triangles, by rising Tabor parameter."""
    return [-r.pull_off / np.pi for r in f.rises[max(f.rises)].ripples] if f.rises else []


def _omitted(f: Facts) -> Estimate:
    """Largest ratio of the force with the singular point left out to that with it, on the same nodes."""
    pairs = zip(*(rise.ripples for rise in f.omitted), strict=False)
    return most([exact(without.pull_off / whole.pull_off) for without, whole in pairs])


def _ratio(f: Facts, above_: tuple[float, float], below_: tuple[float, float]) -> Estimate:
    """Ratio of two forces on coarse grids."""
    return exact(f.coarse[above_] / f.coarse[below_]) if {above_, below_} <= set(f.coarse) else UNKNOWN


def _most_sweeps(f: Facts) -> Estimate:
    """Most sweeps that Greenwood's own iteration took where it converged."""
    return exact(max((a.sweeps for a in f.relaxations if a.sweeps and "Greenwood" in a.method), default=np.nan))


SECTION_4A = (
    Claim[Facts](
        "4a",
        "The DMT theory of 1975 has a tension that falls all along from 2 pi R dgamma (largest rise, alpha* up to 5).",
        below(0, "decreases"),
        _thermodynamic_rise,
        "R dgamma",
        "fig_6a",
    ),
    Claim[Facts](
        "4a",
        "By the force method the tension is always above Bradley's (least excess f, alpha* up to 5).",
        above(0, "greater"),
        _least_excess,
        "1",
        "fig_6a, table_1",
    ),
    Claim[Facts](
        "4a, (4.1)",
        "At small approach the excess is 1.84 alpha*^(3/2) (limit of the ratio).",
        digits("1.84"),
        _leading,
        "1",
        "table_1",
    ),
    Claim[Facts](
        "4a",
        "Fitted between 2e-5 and 1e-4 it is 1.839 alpha*^(3/2) - 7.7 alpha*^2 (first constant).",
        digits("1.839"),
        lambda f: f.tables.asymptote[0],
        "1",
        "table_1",
    ),
    Claim[Facts](
        "4a",
        "The same (second constant).",
        digits("7.7"),
        lambda f: f.tables.asymptote[1],
        "1",
        "table_1",
    ),
    Claim[Facts](
        "4a, Table 1",
        "Table 1 has f/alpha*^(3/2) to three decimals (largest deviation in units of the last).",
        below(0.5 + 1e-9, "Table 1", "half of the last digit"),
        _worst_of_table_1,
        "1",
        "table_1",
    ),
    Claim[Facts](
        "4a",
        "The tension by (4.2) grows with the approach at first, except for mu below 0.237.",
        digits("0.237"),
        _threshold,
        "1",
        "fig_6a",
    ),
    Claim[Facts](
        "4a, footnote",
        "Pashley's limit 0.8 of his parameter is mu = 0.27.",
        digits("0.27"),
        lambda _: exact(float(scaling.MYD.tabor(0.8))),
        "1",
        "fig_6a",
    ),
    Claim[Facts](
        "4a, footnote",
        "Pashley: the tension is largest at first touch for mu below 0.27 (where that is so by (4.2)).",
        digits("0.27"),
        _threshold,
        "1",
        "fig_6a",
    ),
    Claim[Facts](
        "4a, Fig. 6",
        "Against alpha*/mu the DMT theory spreads its curves too little (spread from mu = 0.1 to 0.5 at alpha*/mu = 1 "
        "over that of the computed, size).",
        below(0.5, "inadequate", "half, our reading"),
        lambda f: abs(_spread(f)),
        "1",
        "fig_6a, fig_6b",
    ),
    Claim[Facts](
        "4a, Fig. 6",
        "It spreads them in the wrong order (the same with its sign).",
        below(0, "wrong order"),
        _spread,
        "1",
        "fig_6a, fig_6b",
    ),
    Claim[Facts](
        "4a",
        "In the numerical solutions pull-off never occurs with alpha < 0, alpha counted positive when pressed together "
        "(Tabor parameters, of all tried from 0.02 to 6.7, at which it does).",
        below(0, "never", "none"),
        lambda f: _pulled_off(f, apart=True),
        "cases",
        "fig_6b",
        Reading(
            "with alpha > 0, as section 3 has it", lambda f: _pulled_off(f, apart=False), below(0, "never", "none")
        ),
    ),
    Claim[Facts](
        "4a",
        "DMT-M is the limit of the DMT theory for vanishing mu at a given alpha*/mu (excess f at alpha*/mu = 1, mu = "
        "0.02).",
        below(0.01, "limit", "1 %, our reading"),
        lambda _: exact(float(dmt.force_excess(0.02))),
        "1",
        "fig_6a",
    ),
    Claim[Facts](
        "4a, Fig. 6b",
        "DMT-M does not agree with the numerical solution either (relative deviation of its load at alpha*/mu = 2, mu "
        "= 0.1).",
        above(0.05, "does not agree", "5 %, our reading"),
        lambda f: abs(exact(float(dmt.maugis_load(0.2, 0.1))) / f.load(0.1, 0.2) - 1),
        "1",
        "fig_6b",
    ),
    Claim[Facts](
        "4a",
        "The DMT theory has no rigid limit: at a given approach its load grows without end as mu falls (load at mu = "
        "0.01 less that at 0.02, alpha* = 0.05).",
        above(2 * np.pi, "no limit", "more than all tension"),
        lambda _: exact(float(dmt.force_load(0.05, 0.01) - dmt.force_load(0.05, 0.02))),
        "R dgamma",
        "fig_6a",
    ),
    Claim[Facts](
        "4a",
        "Near touch the limit of stiff solids is Bradley's and not the DMT theory (distance from his load over that "
        "from DMT's at alpha* = 0.05, mu = 0.02).",
        below(0.1, "Bradley", "a tenth, our reading"),
        _beside_dmt,
        "1",
        "fig_1b, fig_1c",
    ),
)
SECTION_4B = (
    Claim[Facts](
        "4b, Fig. 7",
        "The pull-off force decreases steadily with mu (largest change between successive mu).",
        below(0, "decreases"),
        lambda f: most(steps([f.pull_offs[mu] * -1 for mu in sorted(f.pull_offs)])),
        "R dgamma",
        "fig_7, pull_off",
    ),
    Claim[Facts](
        "4b",
        "Unloading right after the jump on finds a lower force (tension there over the pull-off force, largest of mu = "
        "1, 2, 3, 5).",
        below(1, "lower"),
        lambda f: most(_after_jump(f)),
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "4b",
        "It is only slightly lower (least of the same).",
        above(0.95, "slightly", "5 %, our reading"),
        lambda f: least(_after_jump(f)),
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "4b",
        "An early, wider interval gave more force at mu = 5 than at 3, far less more than Attard & Parker's, who go "
        "from 1.6 pi to 3.4 pi (ratio on uniform triangles of 0.02 beta; a converged one is 0.98).",
        between(1, 3.4 / 1.6, "higher, much less than A & P"),
        lambda f: _ratio(f, (5.0, COARSE[0]), (3.0, COARSE[0])),
        "1",
        "claims_numbers, beyond_ripple",
    ),
    Claim[Facts](
        "4b",
        "Half the interval gave considerably less (force at 0.01 beta over that at 0.02, mu = 5).",
        below(0.98, "considerably lower", "2 %, our reading"),
        lambda f: _ratio(f, (5.0, COARSE[1]), (5.0, COARSE[0])),
        "1",
        "claims_numbers, beyond_ripple",
    ),
    Claim[Facts](
        "beyond 4b",
        "Attard & Parker's least force, 1.6 pi, is what intervals too wide give (least force over pi on the widest "
        "uniform triangles of fig_7, 0.2 beta, before it rises).",
        digits("1.6"),
        lambda f: exact(min(_false(f), default=np.nan)),
        "R dgamma",
        "fig_7, coarse_grids",
    ),
    Claim[Facts](
        "beyond 4b",
        "So is a rise above Bradley's 2 pi like theirs, who reach 3.4 pi at mu = 6.7 (force over pi at mu = 1.25 on "
        "triangles of half a beta; larger mu were not asked for).",
        above(2, "above 2 pi"),
        lambda f: exact(f.coarse.get((RISEN, WIDEST), np.nan) / np.pi),
        "R dgamma",
        "claims_numbers",
    ),
    Claim[Facts](
        "4b",
        "A sum that omits the kernel's singular point may be why their forces are too large (force without it over "
        "that by triangles on the same 240 nodes, largest ratio at the mu up to 1 that have a solution).",
        above(1, "would raise the force"),
        _omitted,
        "1",
        "claims_numbers",
    ),
    Claim[Facts](
        "4b",
        "The iteration of 1997 takes some 20 000 sweeps (most that it took here, relaxation 1.5, 200 nodes).",
        within(20_000, 0.5, "20 000", "a factor of about two, our reading"),
        _most_sweeps,
        "sweeps",
        "relaxation",
    ),
)
