"""Claims of the abstract, of sections 1 and 2, and of Appendices A and B: limits, model, kernel, iterations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import ellipe, ellipk

from fem_adhesion.common.fold_birth import count_folds
from fem_adhesion.greenwood.facts import (
    JUMPING,
    SOFT,
    Facts,
    count,
    exact,
    most,
    steps,
)
from fem_adhesion.greenwood.tables import PROFILE_CHECKS
from fem_adhesion.greenwood.verdicts import Allowed, Claim, Reading, above, below, digits, formula
from halfspace import scaling
from halfspace.elastic import compliance, grid
from halfspace.elastic.kernel import ring_kernel
from halfspace.laws import LENNARD_JONES
from halfspace.theories import closed_forms
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Estimate

RADII = ((1.0, 0.5), (0.5, 1.0), (2.0, 0.3), (0.3, 2.0))  # r and s, beta
ROUNDED = below(1e-12, "the same", "rounding")


def tension(gap: float) -> float:
    """Tension of the law in dgamma/eps at a gap H in eps."""
    return -float(LENNARD_JONES.pressure(np.array(gap), 1.0))


def work_beyond(gap: float) -> Estimate:
    """2 pi times the integral of the tension from a gap on: the force between rigid spheres, in R dgamma."""
    value, error = quad(tension, gap, np.inf, epsabs=1e-13, epsrel=1e-13)
    return Estimate(2 * np.pi * value, 2 * np.pi * error)


def _bradley(_: Facts) -> Estimate:
    """Largest deviation of (1.3) from the integral of the law, relative."""
    gaps = (-0.1, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0)
    pairs = ((work_beyond(gap), -float(closed_forms.bradley_load(-gap))) for gap in gaps)
    return most([abs(integral - printed) / abs(printed) for integral, printed in pairs])


def _least_jkr(_: Facts) -> Estimate:
    return exact(
        minimize_scalar(lambda a: float(closed_forms.jkr_load(a)), bounds=(0.5, 2.4), method="bounded").fun * -1
    )


def _jkr_is_near(f: Facts) -> Estimate:
    """Largest deviation of the events at mu = 3 from JKR's, relative, in loads, radii and scaled approaches."""
    off, rest = closed_forms.jkr_pull_off(1.0), closed_forms.jkr_zero_load(1.0)
    pairs = (
        (f.number(3.0, "pull_off", "load"), off.load),
        (f.scaled(3.0, "pull_off"), off.approach),
        (f.scaled(3.0, "zero_load"), rest.approach),
        (f.number(3.0, "zero_load", "contact_radius"), rest.contact_radius),
    )
    return most([abs(ours / theirs - 1) for ours, theirs in pairs])


def _nearer_to_bradley(f: Facts) -> Estimate:
    return abs(f.force(0.2) + BRADLEY_PULL_OFF) / abs(f.force(0.2) + JKR_PULL_OFF)


def _hertz(_: Facts) -> Estimate:
    """Central deflection under Hertz's pressure on a disc of radius 1, by the ring kernel; s = sin t."""
    r = np.array(0.0)

    def integrand(t: float) -> float:
        s = np.array(np.sin(t))
        return float(2 / np.pi * np.cos(t) ** 2 * ring_kernel(r, s) * s)

    value, error = quad(integrand, 0, np.pi / 2)
    return Estimate(value, error)


def _maugis_rise(_: Facts) -> Estimate:
    """Largest rise of Maugis's pull-off force between successive values of lambda."""
    forces = [exact(-MaugisDugdale(float(la), 1.0).pull_off().load) for la in np.geomspace(0.01, 100, 30)]
    return most(steps(forces))


def _deviation(values: Callable[[float, float], float], known: Callable[[float, float], float]) -> Estimate:
    return exact(max(abs(values(r, s) / known(r, s) - 1) for r, s in RADII))


def _points_on_a_ring(r: float, s: float) -> float:
    """Mean of the deflections 1/(pi distance) by points on a ring, times 2 pi: the trapezoidal rule is exact here."""
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    return float(2 * np.mean(1 / np.sqrt(r**2 + s**2 - 2 * r * s * np.cos(angle))))


def _printed_kernel(r: float, s: float) -> float:
    larger = max(r, s)
    return float(4 / np.pi / larger * ellipk((min(r, s) / larger) ** 2))


def _landen(r: float, s: float) -> float:
    return float(4 / np.pi / (r + s) * ellipk(4 * r * s / (r + s) ** 2))


def _largest_tension(_: Facts) -> Estimate:
    return exact(-minimize_scalar(lambda H: -tension(H), bounds=(0.1, 0.4), method="bounded").fun)


def _homogeneous(_: Facts) -> Estimate:
    """Largest deviation of the matrix of twice the interval from twice the matrix, relative to the largest entry."""
    fine, wide = (compliance.triangles(grid.uniform(*lengths)).compliance for lengths in ((3.0, 0.1), (6.0, 0.2)))
    return exact(np.abs(wide - 2 * fine).max() / wide.max())


def pressure_at(gap: str) -> Estimate:
    """Pressure of the law at a printed gap, mu = 5."""
    return exact(float(LENNARD_JONES.pressure(np.array(float(gap)), 5.0)))


def as_printed(gap: str, pressure: str) -> Allowed:
    """Allow what the rounding of a printed gap and of the pressure beside it leaves open, mu = 5."""
    slope = abs(float(LENNARD_JONES.slope(np.array(float(gap)), 5.0)))
    rounded = digits(pressure)
    open_ = slope * 0.5 * 10.0 ** -len(gap.partition(".")[2])
    return replace(rounded, low=rounded.low - open_, high=rounded.high + open_, words="last digits of P and H")


BEFORE, AFTER = PROFILE_CHECKS


def converged(f: Facts, c: str, tabors: Callable[[float], bool]) -> list[float]:
    """Tabor parameters at which simple relaxation with a factor c converged."""
    return [a.tabor for a in f.relaxations if a.method.endswith(f"c = {c}") and a.sweeps and tabors(a.tabor)]


def _failed_when_small(f: Facts) -> Estimate:
    tried = {a.tabor for a in f.relaxations if a.tabor < 1}
    return count(len(tried) - len(converged(f, "0.005", lambda mu: mu < 1))) if tried else exact(np.nan)


def _needs_small_steps(f: Facts) -> Estimate:
    slow, fast = (set(converged(f, c, lambda _: True)) for c in ("0.005", "0.05"))
    return count(len(slow - fast))


def _most_sweeps(f: Facts) -> Estimate:
    return count(max((a.sweeps or 0 for a in f.relaxations), default=0))


def _of_disc(closed: Callable[[float, float], float], c: float, r: float) -> Callable[[Facts], Estimate]:
    """Return a closed form of F over the integral of App. B; s = min(c, r) sin t takes its roots away."""

    def integrand(t: float) -> float:
        s = min(c, r) * np.sin(t)
        return float((c * np.cos(t)) ** 2 / np.sqrt(r**2 - s**2) if c < r else np.sqrt(c**2 - s**2))

    value, error = quad(integrand, 0, np.pi / 2, epsrel=1e-12)
    return lambda _: Estimate(closed(c, r) / value, error / value)


def r_first(c: float, r: float) -> float:
    """R E(c/r), which is F for c > r with c and r exchanged."""
    return float(r * ellipe((c / r) ** 2))


def c_first(c: float, r: float) -> float:
    """(c^2/r) B(c/r), B(k) = [E(k) - (1 - k^2) K(k)]/k^2, which is F for c < r."""
    k = (c / r) ** 2
    return float(c**2 / r * (ellipe(k) - (1 - k) * ellipk(k)) / k)


EXCHANGED = "with c and r exchanged in both forms"
INTEGRAL = formula(1.0, "the integral F")

ABSTRACT = (
    Claim[Facts](
        "abstract",
        "Two rigid spheres hold together with 2 pi R dgamma (Bradley).",
        formula(-BRADLEY_PULL_OFF, "2 pi"),
        lambda _: work_beyond(0.0),
        "R dgamma",
        "fig_1a",
    ),
    Claim[Facts](
        "abstract",
        "JKR's theory has a pull-off force of (3/2) pi R dgamma, whatever the modulus.",
        formula(-JKR_PULL_OFF, "(3/2) pi"),
        _least_jkr,
        "R dgamma",
        "fig_2b",
    ),
    Claim[Facts](
        "abstract",
        "Tabor's parameter governs the transition between the two: from mu = 0.05 to 5 the force goes nearly the whole "
        "way (as a part of it).",
        above(0.9, "governs", "nine tenths, our reading"),
        lambda f: (f.force(0.05) - f.force(5.0)) / (JKR_PULL_OFF - BRADLEY_PULL_OFF),
        "1",
        "fig_7",
    ),
    Claim[Facts](
        "abstract",
        "Curves are S-shaped for mu above one (least number of folds at mu = 1, 2, 3, 5, 6).",
        above(2, "S-shaped", "two folds make an S"),
        lambda f: count(min(count_folds(f.paths[mu]) for mu in JUMPING)),
        "folds",
        "beyond_folds",
    ),
    Claim[Facts](
        "abstract",
        "JKR's equations describe the contact well from mu = 3 on (largest deviation at mu = 3 of pull-off load and "
        "approach, and of approach and radius at zero load).",
        below(0.05, "well", "5 %, our reading"),
        _jkr_is_near,
        "1",
        "fig_2b",
    ),
    Claim[Facts](
        "abstract",
        "At low mu Bradley's equation is the better one under negative loads (distance of the pull-off force from his "
        "over that from JKR's, mu = 0.2).",
        below(1, "better"),
        _nearer_to_bradley,
        "1",
        "fig_1a",
    ),
)
SECTION_1 = (
    Claim[Facts](
        "1",
        "The integral of the 3-9 law (1.2) is Bradley's equation (1.3) (largest relative deviation, gaps h of 0.9 to 5 "
        "eps).",
        below(1e-10, "equal", "a formula"),
        _bradley,
        "1",
        "fig_1a",
    ),
    Claim[Facts](
        "1",
        "Hertz's contact (1.4) approaches by a^2/R (at a = 1: deflection under his pressure by the kernel (2.4)).",
        formula(1.0, "a^2/R"),
        _hertz,
        "beta^2/R",
        "fig_1c",
    ),
    Claim[Facts](
        "1",
        "Attard & Parker: the pull-off force has a least value of about 1.6 pi near mu = 1 (ours at mu = 1, over pi).",
        digits("1.6"),
        lambda f: f.force(1.0) / np.pi,
        "R dgamma",
        "fig_7, pull_off",
    ),
    Claim[Facts](
        "1",
        "Attard & Parker: it then rises, to 3.4 pi at mu = 6.7 (ours there, over pi).",
        digits("3.4"),
        lambda f: f.force(SOFT) / np.pi,
        "R dgamma",
        "fig_7, pull_off",
    ),
    Claim[Facts](
        "1",
        "Their largest parameter sigma = mu^(3/2)/2 is 8.7, which is mu = 6.7 (sigma at 6.7).",
        digits("8.7"),
        lambda _: exact(float(scaling.ATTARD_PARKER.of(SOFT))),
        "1",
        "fig_7",
    ),
    Claim[Facts](
        "1",
        "Maugis's pull-off force decreases all along with lambda (largest rise between 30 values, 0.01 to 100).",
        below(0, "decreases"),
        _maugis_rise,
        "R dgamma",
        "fig_7",
    ),
)
SECTION_2 = (
    Claim[Facts](
        "2",
        "The deflection by a ring is 4/(pi r) K(s/r) for s < r and 4/(pi s) K(r/s) for r < s, (2.4) (largest deviation "
        "from a ring of point forces).",
        ROUNDED,
        lambda _: _deviation(_printed_kernel, _points_on_a_ring),
        "1",
        "claims",
    ),
    Claim[Facts](
        "2",
        "Landen's transformation turns it into the form of Johnson and of Muller et al. (largest deviation).",
        ROUNDED,
        lambda _: _deviation(_landen, _printed_kernel),
        "1",
        "claims",
    ),
    Claim[Facts](
        "2",
        "The largest tension of the law (2.5) is 16/(9 sqrt3) dgamma/eps.",
        formula(16 / (9 * np.sqrt(3)), "16/(9 sqrt3)"),
        _largest_tension,
        "dgamma/eps",
        "claims",
    ),
    Claim[Facts](
        "2a",
        "With equal intervals the matrix of overlapping triangles is proportional to the interval (largest deviation "
        "for twice the interval).",
        ROUNDED,
        _homogeneous,
        "1",
        "claims",
    ),
    Claim[Facts](
        "2b",
        "Equation (2.9) is the pressure, positive in compression (its value at the gap 2.554 of Fig. 4, mu = 5).",
        as_printed(*BEFORE),
        lambda _: pressure_at(BEFORE[0]) * -1,
        "dgamma/(mu eps)",
        "fig_4a, fig_4_checks",
        Reading("with the other sign of (2.9)", lambda _: pressure_at(BEFORE[0]), as_printed(*BEFORE)),
    ),
    Claim[Facts](
        "2c",
        "Simple relaxation solves contacts of small mu with c down to 0.005 (failures at mu = 0.05, 0.2, 0.5; ours "
        "starts undeformed and ends at H(0) = 0, on 200 nodes).",
        below(0, "adequate", "no failure"),
        _failed_when_small,
        "failures",
        "relaxation",
    ),
    Claim[Facts](
        "2c",
        "So small a c is necessary at times (Tabor parameters at which 0.05 fails and 0.005 does not).",
        above(1, "necessary", "one at least"),
        _needs_small_steps,
        "cases",
        "relaxation",
    ),
    Claim[Facts](
        "2c",
        "For larger mu simple relaxation fails (successes at mu = 1, 2, 3 with c = 0.005).",
        below(0, "failed", "no success"),
        lambda f: count(len(converged(f, "0.005", lambda mu: mu >= 1))),
        "successes",
        "relaxation",
    ),
)
APPENDIX_A = (
    Claim[Facts](
        "App. A",
        "Muller et al. amplify Tabor's parameter by 3.898.",
        digits("3.898"),
        lambda _: exact(float(scaling.MYD_AMPLIFICATION.of(1.0))),
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. A",
        "The parameter of Muller et al. and of Pashley is 2.9208 mu.",
        digits("2.9208"),
        lambda _: exact(float(scaling.MYD.of(1.0))),
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. A",
        "Maugis's lambda is 1.1570 mu at the same largest tension (the law's own, found by search).",
        digits("1.1570"),
        lambda f: _largest_tension(f) * float(np.cbrt(9 / (2 * np.pi))),
        "1",
        "claims",
    ),
    Claim[Facts](
        "App. A",
        "Attard & Parker's sigma is 0.5 mu^(3/2) (sigma at mu = 1).",
        digits("0.5"),
        lambda _: exact(float(scaling.ATTARD_PARKER.of(1.0))),
        "1",
        "claims",
    ),
)
APPENDIX_B = (
    Claim[Facts](
        "App. B",
        "A band deflects by differences of F(c, r) = r E(c/r) where c < r (at c = 0.5, r = 1, over the integral F).",
        INTEGRAL,
        _of_disc(r_first, 0.5, 1.0),
        "1",
        "claims",
        Reading(EXCHANGED, _of_disc(c_first, 0.5, 1.0), INTEGRAL),
    ),
    Claim[Facts](
        "App. B",
        "F(c, r) = (r^2/c) B(r/c) where c > r (at c = 1, r = 0.5, over the integral F).",
        INTEGRAL,
        _of_disc(lambda c, r: c_first(r, c), 1.0, 0.5),
        "1",
        "claims",
        Reading(EXCHANGED, _of_disc(lambda c, r: r_first(r, c), 1.0, 0.5), INTEGRAL),
    ),
)
