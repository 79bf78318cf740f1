"""What claims of the paper are measured on: the words of the column ``measure`` of ``data/claims.csv``.

A measure there is an expression of Python. Its words are the functions and names of this module, and `f`, the facts of
a study; what needs no solution, the paper's formulas by quadrature and search, comes first.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import ellipe, ellipk

from fem_adhesion.common.fold_birth import count_folds, critical_stiffness
from fem_adhesion.greenwood.facts import Facts, count, crossings, exact, least, most, power, spread, steps
from fem_adhesion.greenwood.tables import LAST_DIGIT, TABORS
from halfspace import scaling
from halfspace.elastic import compliance, grid
from halfspace.elastic.kernel import ring_kernel
from halfspace.equilibrium.conditions import Condition
from halfspace.equilibrium.contact import CONTACT_RADIUS, LOAD
from halfspace.laws import LENNARD_JONES
from halfspace.roots import root
from halfspace.theories import closed_forms, criteria, dmt
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Estimate

__all__ = ["LAST_DIGIT", "TABORS", "count_folds", "critical_stiffness", "least", "power", "scaling"]

RIGID = np.pi * np.sqrt(2)  # w(0) = pi sqrt2 mu^(3/2) (H0 + 1)^(-5/2) of undeformed surfaces, eps
JKR_AT_REST, JKR_JUMP_OFF = closed_forms.jkr_zero_load(1.0), closed_forms.jkr_jump_off(1.0)
BELOW_NOSE = -4.0  # load in R dgamma at which Fig. 5 is compared on the unstable branch
BELOW_NOSE_RADIUS = float(
    np.cbrt(3 / 4 * (BELOW_NOSE + 3 * np.pi - np.sqrt(6 * np.pi * BELOW_NOSE + (3 * np.pi) ** 2)))
)
"""JKR's contact radius there, in beta."""


def tension(gap: float) -> float:
    """Tension of the law in dgamma/eps at a gap H in eps."""
    return -float(LENNARD_JONES.pressure(np.array(gap), 1.0))


def rigid_force(gap: float = 0.0) -> Estimate:
    """Force between rigid spheres at a gap in eps, in R dgamma: 2 pi times the integral of the tension beyond it."""
    return Estimate(*quad(tension, gap, np.inf, epsabs=1e-13, epsrel=1e-13)) * (2 * np.pi)


def bradley_by_quadrature() -> Estimate:
    """Largest deviation of (1.3) from the integral of the law, relative."""
    pairs = ((rigid_force(gap), float(closed_forms.bradley_load(-gap))) for gap in (-0.1, 0, 0.2, 0.5, 1, 2, 4))
    return most(abs(integral + printed) / abs(printed) for integral, printed in pairs)


def least_jkr_load() -> Estimate:
    """Pull-off force of JKR's load against the contact radius."""
    found = minimize_scalar(lambda a: float(closed_forms.jkr_load(a)), bounds=(0.5, 2.4), method="bounded")
    return exact(-found.fun)


def least_jkr_approach() -> Estimate:
    """Least scaled approach of JKR's printed curve."""
    radii = JKR_JUMP_OFF.contact_radius + np.linspace(-0.1, 0.1, 2001)
    return exact(np.min(closed_forms.jkr_approach(radii, 1.0)))


def hertz_by_kernel() -> Estimate:
    """Central deflection under Hertz's pressure on a disc of radius 1, by the ring kernel; s = sin t."""

    def integrand(t: float) -> float:
        s = np.array(np.sin(t))
        return float(2 / np.pi * np.cos(t) ** 2 * ring_kernel(np.array(0.0), s) * s)

    return Estimate(*quad(integrand, 0, np.pi / 2))


def hertz_at(approach: float) -> float:
    """Hertz's load at an approach in eps, mu = 1."""
    return float(closed_forms.hertz_load(closed_forms.hertz_radius_at(approach, 1.0)))


def hertz_less_jkr(radius: float) -> Estimate:
    """What must be added to JKR's load so that Hertz's equation gives JKR's approach, at a contact radius."""
    hertz = hertz_at(float(closed_forms.jkr_approach(radius, 1.0)))
    return Estimate(hertz - float(closed_forms.jkr_load(radius)), 1e-13 * hertz)


def maugis_rise() -> Estimate:
    """Largest rise of Maugis's pull-off force between successive values of lambda."""
    return most(steps([exact(-MaugisDugdale(float(la), 1.0).pull_off().load) for la in np.geomspace(0.01, 100, 30)]))


def maugis_radius(tabor: float, load: float, low: float, high: float) -> float:
    """Maugis's contact radius under a load, between two radii."""
    theory = MaugisDugdale.matched(tabor)
    return root(lambda a: float(theory.load(a)) - load, low, high, "Maugis's radius")


def ring_by_points() -> Estimate:
    """Largest deviation of (2.4) from the mean of deflections 1/(pi distance) by points on a ring, times 2 pi.

    The trapezoidal rule is exact there.
    """
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    off = []
    for r, s in ((1.0, 0.5), (0.5, 1.0), (2.0, 0.3), (0.3, 2.0)):
        printed = 4 / np.pi / max(r, s) * ellipk((min(r, s) / max(r, s)) ** 2)
        off.append(abs(printed / (2 * np.mean(1 / np.sqrt(r**2 + s**2 - 2 * r * s * np.cos(angle)))) - 1))
    return exact(max(off))


def largest_tension() -> Estimate:
    """Largest tension of the law in dgamma/eps, by search."""
    return exact(-minimize_scalar(lambda H: -tension(H), bounds=(0.1, 0.4), method="bounded").fun)


def matrix_of_twice_the_interval() -> Estimate:
    """Largest deviation of the matrix of twice the interval from twice the matrix, relative to the largest entry."""
    fine, wide = (compliance.triangles(grid.uniform(*lengths)).compliance for lengths in ((3.0, 0.1), (6.0, 0.2)))
    return exact(np.abs(wide - 2 * fine).max() / wide.max())


def disc(form: str, c: float, r: float) -> Estimate:
    """Closed form of F(c, r), App. B, over its integral; s = min(c, r) sin t takes the roots of the integrand away.

    With x the larger and y the smaller of both radii the forms are E, x E(y/x), and B, (y^2/x) B(y/x).
    """

    def integrand(t: float) -> float:
        s = min(c, r) * np.sin(t)
        return float((c * np.cos(t)) ** 2 / np.sqrt(r**2 - s**2) if c < r else np.sqrt(c**2 - s**2))

    value, error = quad(integrand, 0, np.pi / 2, epsrel=1e-12)
    x, y = max(c, r), min(c, r)
    k = (y / x) ** 2
    closed = x * ellipe(k) if form == "E" else y**2 / x * (ellipe(k) - (1 - k) * ellipk(k)) / k
    return Estimate(closed / value, error / value)


def excess_limit() -> Estimate:
    """Limit of f/alpha*^(3/2), from two small approaches whose roots are as 1 to 2; b alpha*^(1/2) drops out."""
    near, far = (float(dmt.force_excess(x)) / x**1.5 for x in (1e-6, 4e-6))
    return Estimate(2 * near - far, abs(near - far) / 10)


def rising_threshold() -> Estimate:
    """Tabor parameter at which Hertz's load and the excess tension grow alike at first touch."""
    leading = excess_limit()
    value = (2 / (3 * np.pi) / leading.value) ** (2 / 3)
    return Estimate(value, 2 / 3 * value * leading.error / leading.value)


def rigid_displacement() -> Estimate:
    """w(0) of undeformed surfaces at h0 = eps, mu = 1, by quadrature: 2 int sigma dr."""
    return Estimate(*quad(lambda r: 2 * 8 / 3 * (1 + r**2 / 2) ** -3, 0, np.inf, epsabs=1e-13, epsrel=1e-13))


def rigid_fold() -> Estimate:
    """h0/w(0) where h0 + w(0) is least, w(0) = h0^(-5/2)."""
    h = float(minimize_scalar(lambda h: h + h**-2.5, bounds=(1, 2), method="bounded", options={"xatol": 1e-12}).x)
    return Estimate(h**3.5, 1e-6)


# What needs solutions


def farthest_from_jkr(f: Facts, tabor: float) -> Estimate:
    """Largest deviation of events from JKR's, relative, in loads, radii and scaled approaches."""
    off, rest = closed_forms.jkr_pull_off(tabor), closed_forms.jkr_zero_load(tabor)
    numbers = [("pull_off", name, getattr(off, name)) for name in ("load", "approach")]
    numbers += [("zero_load", name, getattr(rest, name)) for name in ("approach", "contact_radius")]
    return most(abs(f.number(tabor, event, quantity) / theirs - 1) for event, quantity, theirs in numbers)


def from_bradley(f: Facts, tabor: float, low: float, high: float) -> Estimate:
    """Largest distance of the load from Bradley's between two approaches in eps, in R dgamma."""
    approach = np.linspace(low, high, 121)
    states = f.paths[tabor].at(approach=approach)
    off = np.abs(states.load - closed_forms.bradley_load(approach))
    return Estimate(float(off.max()), float(np.max(states.load_error)))


def far_from_bradley(f: Facts, times: float) -> Estimate:
    """Largest relative deviation from Bradley's load at so many jump-on separations, mu = 1 to 6."""
    ratios = []
    for mu in TABORS:
        event = f.paths[mu].events.get("jump_on")
        approach = times * event.approach if event else -5.0
        load = f.state(mu, "load", approach=approach, branch="separated")
        ratios.append(abs(load / float(closed_forms.bradley_load(approach)) - 1))
    return most(ratios)


def compression_exponent(f: Facts, tabor: float) -> Estimate:
    """Power n of W = k (alpha* - alpha0)^n through loads of 5, 10 and 20.

    As alpha* = alpha0 + (W/k)^(1/n), successive differences grow by 2^(1/n).
    """
    states = f.paths[tabor].at(load=np.array([5.0, 10.0, 20.0]), branch="contact")
    first, second = steps([*map(Estimate, states.approach, states.approach_error)])
    return spread(lambda ratio: np.log(2) / np.log(abs(ratio)), second / first)


def nearest_theory(f: Facts, tabor: float) -> Estimate:
    """Least relative deviation of Bradley's, JKR's and DMT-M's loads from the computed, W = 20."""
    state = f.paths[tabor].at(load=20.0, branch="contact")
    x = float(state.approach)
    theories = (closed_forms.bradley_load(x), closed_forms.jkr_load_at(x, tabor), dmt.maugis_load(x, tabor))
    return Estimate(min(abs(float(W) / 20 - 1) for W in theories), float(state.load_error) / 20)


def crossings_of_jkr(f: Facts, tabor: float) -> Estimate:
    """How often the curve crosses JKR's, both as polygons."""
    path, radius = f.paths[tabor].resampled(400), np.linspace(1e-4, 4, 4000)
    jkr = closed_forms.jkr_approach(radius, tabor), closed_forms.jkr_load(radius)
    return count(crossings(np.column_stack([path.approach, path.load]), np.column_stack(jkr)))


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


def h0(f: Facts, tabor: float, event: str = "jump_on") -> Estimate:
    """Central h at a jump, in eps."""
    return f.number(tabor, event, "central_gap") + 1


def criterion(approach: Estimate, central_gap: Estimate) -> Estimate:
    """Value of w sigma'/sigma at the centre, (4.3), of a state, with the error that its numbers leave."""
    return spread(lambda a, h: float(criteria.fundamental_criterion(a, h)), approach, central_gap)


def criterion_at(f: Facts, tabor: float, event: str = "jump_on") -> Estimate:
    """The same at a jump."""
    return criterion(f.number(tabor, event, "approach"), f.number(tabor, event, "central_gap"))


def closed_criterion(f: Facts, k: float, tabor: float, event: str = "jump_on") -> Estimate:
    """(H0 + 1)^(7/2) by a closed criterion over the true one."""
    return spread(lambda h: k * RIGID * tabor**1.5 / h**3.5, h0(f, tabor, event))


def refitted(f: Facts, name: str, index: int) -> Estimate:
    """A refitted constant of a criterion, with its standard error."""
    return next(c.constants[index][2] for c in f.criteria if c.name == name)


def fit_over_gap(f: Facts, tabor: float, event: str = "jump_on") -> Estimate:
    """Gap h by (4.5) over the true one."""
    return exact(float(criteria.fitted_gap(tabor)) + 1) / h0(f, tabor, event)


def displacement(f: Facts, tabor: float) -> Estimate:
    """Central displacement at the jump on in eps, -alpha* - H0."""
    return (f.number(tabor, "jump_on", "approach") + f.number(tabor, "jump_on", "central_gap")) * -1


def displacement_over_rigid(f: Facts, tabor: float) -> Estimate:
    """Central displacement at the jump on over that by the attraction across undeformed surfaces."""
    return displacement(f, tabor) / spread(lambda h: RIGID * tabor**1.5 / h**2.5, h0(f, tabor))


def converged(f: Facts, c: float) -> set[float]:
    """Tabor parameters at which simple relaxation with a factor c converged."""
    return {a.tabor for a in f.relaxations if a.method.endswith(f"c = {c:g}") and a.sweeps}
