"""What the deviations of the finite sphere are governed by: their leading terms in beta/R = sqrt(mu/rho) and 1/rho.

A deviation is fitted by weighted least squares on all points up to the largest beta/R at which the fit is within its
tolerance: at all Tabor parameters together, and at each alone. Two coefficients are known, for the profile's part in
the pull-off: -9/7 of 1/rho for a rigid sphere, and that of mu/rho by JKR's theory on the exact sphere (Maugis 1995).

The curved body deforms in proportion to beta/R otherwise than a half-space. What it yields as a whole shifts the
approaches, and moves the jumps under fixed grips, by (kappa_0 + kappa_1 ln(beta/R)) beta/R, see `Bulk`; dead load does
not feel it. The undeformed surface is even in r/R, so profile and
area make a difference from (r/R)^2 on only, r being some beta or sqrt(R eps). A distant grip bends the surface by
(beta/R)^3, beside shifting it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import chain
from math import log, pi

import numpy as np

from fem_adhesion.bodies.body import Discretisation, GripName
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.discretise import sized_body
from fem_adhesion.finite_sphere.table import DeviationRow, Samples, samples
from fem_adhesion.scene import Scene
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.errors import InputError
from halfspace.values import Array, Estimate

TOLERANCE = 0.1  # of the sum of the terms' sizes
DEVIATIONS = 2.0  # standard deviations that bound an error
RIGID_PULL_OFF = -9 / 7
"""Of 1/rho in the relative change of the pull-off load by the profile, as mu -> 0 (theory of the rigid sphere)."""

SOFT_PULL_OFF = -(8 / 15) * (9 * np.pi / 8) ** (5 / 3) / (3 * np.pi / 2)
"""Of mu/rho as mu -> infinity: Maugis' load exceeds JKR's by 8 a^5/(15 X^2), and JKR's least has a^3 = 9 pi/8."""

Term = Callable[[Array, Array], Array]
"""Of Tabor parameters and R/eps."""


def _power(exponent: float) -> Term:
    """(beta/R) to a power."""
    return lambda mu, rho: np.asarray((mu / rho) ** (exponent / 2))


TERMS: Mapping[str, Term] = {
    "beta/R": _power(1),
    "(beta/R)^2": _power(2),
    "eps/R": lambda mu, rho: 1 / rho,  # noqa: ARG005 - every term is a function of both
}
POWERS: Mapping[str, Term] = {
    "beta/R": _power(1),
    "(beta/R)^2": _power(2),
    "(beta/R)^3": _power(3),
}
LOGARITHM: Mapping[str, Term] = {"beta/R ln(beta/R)": lambda mu, rho: np.sqrt(mu / rho) * np.log(mu / rho) / 2}
EVEN = {"(beta/R)^2": _power(2), "eps/R": TERMS["eps/R"]}
EVEN_POWERS = {"(beta/R)^2": _power(2), "(beta/R)^4": _power(4)}
ODD_POWERS = {"(beta/R)^3": _power(3), "(beta/R)^5": _power(5)}

OF_THE_SHAPE = ("profile", "traction")  # causes that are of the shape of the undeformed surface alone
YIELDING = ("body", "all")  # causes that let the body yield as a whole
FIXED_GRIPS = ("jump_on_approach", "jump_on_load", "jump_off_approach", "jump_off_load", "hysteresis")
"""Quantities that the body's yield changes to first order."""


def leading_terms(cause: str, quantity: str, *, one_tabor: bool = False) -> Mapping[str, Term]:
    """Terms of a deviation; among points of one Tabor parameter (beta/R)^2 and eps/R are one term."""
    if cause in OF_THE_SHAPE:
        return EVEN_POWERS if one_tabor else EVEN
    if quantity not in FIXED_GRIPS:
        return ODD_POWERS if cause == "grip" else POWERS if one_tabor else TERMS
    powers = {name: TERMS[name] for name in ("beta/R", "(beta/R)^2")} if one_tabor else TERMS
    return {**powers, **LOGARITHM} if cause in YIELDING else powers


@dataclass(frozen=True)
class Fit:
    """Leading terms of a deviation.

    Coefficients are by the names of the terms, their errors two standard deviations and the change when the points of
    more than half the largest beta/R are left out. So far, `holds_to`, the fit is within the tolerance, the part of the
    sum of the terms' sizes by which a point may be off beyond its own error; `worst` is the largest residual in so many
    points, in relative deviation.
    """

    coefficients: Mapping[str, Estimate]
    holds_to: float
    tolerance: float
    points: int
    worst: float


@dataclass(frozen=True)
class Finding:
    """What governs one deviation at a Tabor parameter, None for all together: leading terms, or why there are none."""

    cause: str
    quantity: str
    tabor: float | None
    fit: Fit | None
    reason: str = ""


@dataclass(frozen=True)
class TheoryCheck:
    """The leading coefficient of the pull-off's deviation by the profile beside a theory's, in that theory's limit.

    It is fitted at the Tabor parameter nearest to that limit.
    """

    theory: str
    expected: float
    tabor: float
    fitted: Estimate


def findings(rows: Sequence[DeviationRow], poisson: float = 0.3) -> tuple[Finding, ...]:
    """Fits of every quantity for every cause, at all Tabor parameters together and at each."""
    keys = dict.fromkeys((row.cause, row.quantity, row.poisson) for row in rows if row.poisson in (None, poisson))
    found = (_findings(cause, quantity, samples(rows, cause, quantity, poisson=nu)) for cause, quantity, nu in keys)
    return tuple(chain.from_iterable(found))


def _findings(cause: str, quantity: str, data: Samples) -> Iterator[Finding]:
    yield _finding(cause, quantity, None, data, leading_terms(cause, quantity))
    for tabor in np.unique(data.tabor):
        terms = leading_terms(cause, quantity, one_tabor=True)
        yield _finding(cause, quantity, float(tabor), data.where(data.tabor == tabor), terms)


def _finding(cause: str, quantity: str, tabor: float | None, data: Samples, terms: Mapping[str, Term]) -> Finding:
    try:
        return Finding(cause, quantity, tabor, fit(data, terms))
    except InputError as error:
        return Finding(cause, quantity, tabor, None, str(error))


def compare(rows: Sequence[DeviationRow]) -> tuple[TheoryCheck, ...]:
    """Compare the profile's part in the pull-off with the rigid sphere's and Maugis'; InputError of too few points."""
    data = samples(rows, "profile", "pull_off_load", poisson=None)
    if not data.tabor.size:
        raise InputError(
            "0 deviations of the pull-off by the profile, limit 4; solve for some at small tabor/radius_ratio"
        )
    hard, soft = float(data.tabor.min()), float(data.tabor.max())
    return (
        _compared("rigid sphere: eps/R", RIGID_PULL_OFF, data, hard, lambda _, rho: 1 / rho),
        _compared("Maugis (1995): (beta/R)^2", SOFT_PULL_OFF, data, soft, lambda mu, rho: mu / rho),
    )


def _compared(theory: str, expected: float, data: Samples, tabor: float, leading: Term) -> TheoryCheck:
    terms: dict[str, Term] = {"leading": leading, "square": lambda mu, rho: leading(mu, rho) ** 2}
    found = fit(data.where(data.tabor == tabor), terms, tolerance=TOLERANCE / 10)
    return TheoryCheck(theory, expected, tabor, found.coefficients["leading"])


def fit(data: Samples, terms: Mapping[str, Term] = TERMS, *, tolerance: float = TOLERANCE) -> Fit:
    """Fit terms, functions of the Tabor parameter and R/eps, on all points up to the largest beta/R that allows it.

    A point may be off by its own error and the tolerance, a part of the sum of the terms' sizes. InputError if no fit
    does so on at least twice as many points as there are terms.
    """
    functions = list(terms.values())
    for limit in np.unique(data.stretch)[::-1]:
        part = data.where(data.stretch <= limit)
        if part.tabor.size < 2 * len(terms):
            break
        found, residual, allowed = _least_squares(part, functions, tolerance)
        if np.all(np.abs(residual) <= allowed):
            found = _with_bias(found, part.where(part.stretch <= limit / 2), functions, tolerance)
            coefficients = dict(zip(terms, found, strict=True))
            return Fit(coefficients, float(limit), tolerance, part.tabor.size, float(np.abs(residual).max()))
    raise InputError(
        f"{data.tabor.size} points leave no {2 * len(terms)} or more within tolerance = {tolerance:g} of a fit; "
        "give more points of small tabor/radius_ratio"
    )


def _with_bias(found: Sequence[Estimate], nearer: Samples, terms: Sequence[Term], tolerance: float) -> list[Estimate]:
    """Coefficients whose errors include their changes when only the points nearer to the limit are fitted.

    What the terms leave out pulls at them, which no scatter shows.
    """
    if nearer.tabor.size < 2 * len(terms):
        return list(found)
    others, _, _ = _least_squares(nearer, terms, tolerance)
    return [Estimate(c.value, c.error + abs(c.value - d.value)) for c, d in zip(found, others, strict=True)]


def _least_squares(data: Samples, terms: Sequence[Term], tolerance: float) -> tuple[list[Estimate], Array, Array]:
    """Coefficients, residuals, and the residuals allowed.

    A point's weight is its error and the tolerance together: what the terms leave out weighs on the large deviations.
    """
    A = np.column_stack([term(data.tabor, data.radius_ratio) for term in terms])
    sigma = data.error + tolerance * np.abs(data.deviation)
    sigma = np.maximum(sigma, 1e-14 + 1e-9 * np.abs(data.deviation).max())
    scaled = A / sigma[:, None]
    sizes = np.linalg.norm(scaled, axis=0)
    c = np.linalg.lstsq(scaled / sizes, data.deviation / sigma, rcond=None)[0] / sizes
    residual = data.deviation - A @ c
    spread = np.sum((residual / sigma) ** 2) / (data.deviation.size - len(terms))
    variance = spread * np.diag(np.linalg.pinv((scaled / sizes).T @ (scaled / sizes))) / sizes**2
    found = [Estimate(float(v), float(DEVIATIONS * np.sqrt(s))) for v, s in zip(c, variance, strict=True)]
    return found, residual, data.error + tolerance * (np.abs(A) @ np.abs(c))


SMALL, LARGE = 10.0, 100.0  # R/beta of the spheres that are solved
FINE, COARSE = Discretisation(6), Discretisation(5)
FINEST = 1e-2  # beta: cells at the edge of the pressure, which ends as a square root
HERTZ_MEAN = 0.6  # E* beta/W: approach of the load on the half-space, 3/4 at the pole less 3/8 <r^2>, <r^2> = 2/5


@dataclass(frozen=True)
class Bulk:
    """What a held body yields more than the half-space under a load: the linear part of the approach.

    A sphere under a load W on a small circle of its surface approaches by W kappa/(E* R) more than the half-space does,

        kappa = kappa_0 + kappa_1 ln(beta/R) + O(beta/R),    kappa_1 = -(1 - 2 nu)^2/(2 pi (1 - nu)).

    The logarithm is that of the shell, r^2/2R thick, by which the sphere falls short of the half-space. Boussinesq's
    load stretches the surface by (1 - 2 nu) W/(2 pi r^2) along r and compresses it as much across: an energy of
    W^2 (1 - 2 nu)^2/(4 pi^2 (1 - nu) E* r^4) per volume, whose integral over the shell is W^2/(2 E* R) times that term.
    Here kappa_0 is of the grip, and of how the load is spread: as Hertz's pressure on the circle r < beta of the
    projected area. The approach is that of the load, the mean of the deflection weighted with the pressure.

    The constant kappa_0 is measured, its error by the order of the elements and by what is left of the linear term,
    whose coefficient is measured where beta/R is 0.1. The logarithm's, kappa_1, is exact.
    """

    constant: Estimate
    logarithm: float
    linear: float


def bulk_compliance(grip: GripName, poisson: float, sphere_radius: float) -> Estimate:
    """What a hemisphere of R/beta yields more than the half-space, per load: kappa in 1/(E* R).

    It is positive if the body is the softer one, and without its part that vanishes with beta/R, which is in the error.
    As an approach in eps it is kappa mu W/(R/beta). InputError if grip or poisson is out of range.
    """
    terms = coefficients(grip, poisson)
    return terms.constant - terms.logarithm * log(sphere_radius) + Estimate(0.0, terms.linear / sphere_radius)


@cache
def coefficients(grip: GripName, poisson: float) -> Bulk:
    """Coefficients of the bulk compliance, from finite-element solutions at R = 10 and 100 beta."""
    logarithm = -((1 - 2 * poisson) ** 2) / (2 * pi * (1 - poisson))
    small, large = (excess_compliance(grip, poisson, R, FINE) + logarithm * log(R) for R in (SMALL, LARGE))
    coarse = excess_compliance(grip, poisson, LARGE, COARSE) + logarithm * log(LARGE)
    linear = abs(small - large) / (1 / SMALL - 1 / LARGE)
    return Bulk(Estimate(large, abs(large - coarse) + linear / LARGE), logarithm, linear)


def excess_compliance(grip: GripName, poisson: float, sphere_radius: float, how: Discretisation) -> float:
    """Approach under Hertz's pressure on r < beta, less the half-space's, over the load, in 1/(E* R)."""
    operator = _operator(grip, poisson, sphere_radius, how)
    pressure = np.sqrt(np.maximum(1 - operator.radii**2, 0))
    force = operator.weights * pressure
    mean = force @ operator.compliance @ pressure / force.sum() ** 2
    return (float(mean) - HERTZ_MEAN) * sphere_radius


def _operator(grip: GripName, poisson: float, R: float, how: Discretisation) -> ElasticOperator:
    """Compliance of the hemisphere's surface, its cells fine at r = beta."""
    scene = Scene(1.0, Hemisphere(radius_ratio=R**2, grip=grip, poisson=poisson))
    body = sized_body(scene, how)
    lines = grid.graded(body.coordinate.of(1.0), FINEST, float(body.outer[0]), growth=how.growth)
    return body.make(np.concatenate([lines, body.outer[1:]]))[0]
