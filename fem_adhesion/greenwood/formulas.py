"""What claims of the paper are measured on that need no solution: its formulas, by quadrature and search."""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import ellipe, ellipk

from fem_adhesion.common import fold_birth
from fem_adhesion.greenwood.facts import exact, most, steps
from halfspace import scaling
from halfspace.elastic import compliance, grid
from halfspace.elastic.kernel import ring_kernel
from halfspace.laws import LENNARD_JONES
from halfspace.roots import root
from halfspace.theories import closed_forms, criteria, dmt
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Estimate

RIGID = np.pi * np.sqrt(2)  # w(0) = pi sqrt2 mu^(3/2) (H0 + 1)^(-5/2) of undeformed surfaces, eps
JKR_AT_REST = closed_forms.jkr_zero_load(1.0)
JKR_JUMP_OFF = closed_forms.jkr_jump_off(1.0)


def tension(gap: float) -> float:
    """Tension of the law in dgamma/eps at a gap H in eps."""
    return -float(LENNARD_JONES.pressure(np.array(gap), 1.0))


def rigid_force(gap: float = 0.0) -> Estimate:
    """Force between rigid spheres at a gap in eps, in R dgamma: 2 pi times the integral of the tension beyond it."""
    value, error = quad(tension, gap, np.inf, epsabs=1e-13, epsrel=1e-13)
    return Estimate(2 * np.pi * value, 2 * np.pi * error)


def bradley_by_quadrature() -> Estimate:
    """Largest deviation of (1.3) from the integral of the law, relative."""
    pairs = ((rigid_force(gap), float(closed_forms.bradley_load(-gap))) for gap in (-0.1, 0, 0.2, 0.5, 1, 2, 4))
    return most([abs(integral + printed) / abs(printed) for integral, printed in pairs])


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


def hertz_less_jkr(radius: float) -> Estimate:
    """What must be added to JKR's load so that Hertz's equation gives JKR's approach, at a contact radius."""
    approach = closed_forms.jkr_approach(radius, 1.0)
    hertz = float(closed_forms.hertz_load(closed_forms.hertz_radius_at(approach, 1.0)))
    return Estimate(hertz - float(closed_forms.jkr_load(radius)), 1e-13 * hertz)


def hertz_less_dmt_m() -> Estimate:
    """What must be added to the load of DMT-M so that Hertz's equation gives its approach."""
    hertz = float(closed_forms.hertz_load(closed_forms.hertz_radius_at(1.0, 1.0)))
    return exact(hertz - float(dmt.maugis_load(1.0, 1.0)))


def parameter(name: str, tabor: float) -> Estimate:
    """Another author's parameter, by its name in `halfspace.scaling`, at a Tabor parameter."""
    return exact(float(getattr(scaling, name).of(tabor)))


def pashley_tabor(value: float) -> Estimate:
    """Tabor parameter of a value of Pashley's."""
    return exact(float(scaling.MYD.tabor(value)))


def maugis_parameter() -> Estimate:
    """Maugis's lambda over mu at the same largest tension."""
    return largest_tension() * float(np.cbrt(9 / (2 * np.pi)))


def maugis_rise() -> Estimate:
    """Largest rise of Maugis's pull-off force between successive values of lambda."""
    forces = [exact(-MaugisDugdale(float(la), 1.0).pull_off().load) for la in np.geomspace(0.01, 100, 30)]
    return most(steps(forces))


def maugis_radius(tabor: float, load: float, low: float, high: float) -> float:
    """Maugis's contact radius under a load, between two radii."""
    theory = MaugisDugdale.matched(tabor)
    return root(lambda a: float(theory.load(a)) - load, low, high, "Maugis's radius")


def maugis_radius_over_jkr(tabor: float) -> Estimate:
    """Maugis's contact radius at zero load over JKR's."""
    return exact(maugis_radius(tabor, 0.0, 1.5, 3.5) / JKR_AT_REST.contact_radius)


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


def edge_gap() -> Estimate:
    """Gap h of the largest tension, in eps."""
    return exact(LENNARD_JONES.edge_gap + 1)


def matrix_of_twice_the_interval() -> Estimate:
    """Largest deviation of the matrix of twice the interval from twice the matrix, relative to the largest entry."""
    fine, wide = (compliance.triangles(grid.uniform(*lengths)).compliance for lengths in ((3.0, 0.1), (6.0, 0.2)))
    return exact(np.abs(wide - 2 * fine).max() / wide.max())


def pressure_at(gap: float, sign: float) -> Estimate:
    """Pressure of the law at a gap, mu = 5, times a sign."""
    return exact(sign * float(LENNARD_JONES.pressure(np.array(gap), 5.0)))


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


def thermodynamic_rise() -> Estimate:
    """Largest rise of the tension of the DMT theory of 1975 with the approach, up to 5 eps."""
    return exact(np.max(np.diff(dmt.thermodynamic_tension(np.geomspace(1e-3, 5, 200)))))


def least_excess() -> Estimate:
    """Least excess f of the force method, up to 5 eps."""
    return exact(np.min(dmt.force_excess(np.geomspace(1e-3, 5, 200))))


def dmt_excess(approach: float) -> Estimate:
    """Excess f of the force method at an approach in eps."""
    return exact(float(dmt.force_excess(approach)))


def excess_limit() -> Estimate:
    """Limit of f/alpha*^(3/2), from two small approaches whose roots are as 1 to 2; b alpha*^(1/2) drops out."""
    near, far = (float(dmt.force_excess(x)) / x**1.5 for x in (1e-6, 4e-6))
    return Estimate(2 * near - far, abs(near - far) / 10)


def rising_threshold() -> Estimate:
    """Tabor parameter at which Hertz's load and the excess tension grow alike at first touch."""
    leading = excess_limit()
    value = (2 / (3 * np.pi) / leading.value) ** (2 / 3)
    return Estimate(value, 2 / 3 * value * leading.error / leading.value)


def dmt_growth(lower: float, upper: float) -> Estimate:
    """Load of the DMT theory at alpha* = 0.05 at a Tabor parameter, less that at another."""
    return exact(float(dmt.force_load(0.05, lower) - dmt.force_load(0.05, upper)))


def quotient(dividend: float, divisor: float) -> Estimate:
    """Quotient of two printed numbers."""
    return exact(dividend / divisor)


def critical_stiffness(tabor: float) -> Estimate:
    """Stiffness in R dgamma/eps below which a contact jumps that fixed grips hold."""
    return exact(fold_birth.critical_stiffness(tabor, rtol=1e-6))


def rigid_displacement(criterion: str = "") -> Estimate:
    """w(0) of undeformed surfaces at h0 = eps, mu = 1, by quadrature: 2 int sigma dr; times a criterion's factor."""
    value, error = quad(lambda r: 2 * 8 / 3 * (1 + r**2 / 2) ** -3, 0, np.inf, epsabs=1e-13, epsrel=1e-13)
    return Estimate(value, error) * (float(getattr(criteria, criterion)) if criterion else 1.0)


def rigid_fold() -> Estimate:
    """h0/w(0) where h0 + w(0) is least, w(0) = h0^(-5/2)."""
    h = float(minimize_scalar(lambda h: h + h**-2.5, bounds=(1, 2), method="bounded", options={"xatol": 1e-12}).x)
    return Estimate(h**3.5, 1e-6)


def fit_over_rigid() -> Estimate:
    """Factor of the fit (4.5) over that of the displacement of undeformed surfaces."""
    return exact(criteria.FIT / RIGID)
