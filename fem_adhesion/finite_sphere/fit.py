"""What the deviations of the finite sphere are governed by: their leading terms in beta/R = sqrt(mu/rho) and 1/rho.

A deviation is fitted by weighted least squares on all points up to the largest beta/R at which the fit is within its
tolerance: at all Tabor parameters together, and at each alone. Two coefficients are known, for the profile's part in
the pull-off: -9/7 of 1/rho for a rigid sphere, and that of mu/rho by JKR's theory on the exact sphere (Maugis 1995).

The curved body deforms in proportion to beta/R otherwise than a half-space. What it yields as a whole shifts the
approaches, and moves the jumps under fixed grips, by (kappa_0 + kappa_1 ln(beta/R)) beta/R, see
`fem_adhesion.finite_sphere.bulk`; dead load does not feel it. The undeformed surface is even in r/R, so profile and
area make a difference from (r/R)^2 on only, r being some beta or sqrt(R eps). A distant grip bends the surface by
(beta/R)^3, beside shifting it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fem_adhesion.finite_sphere.table import DeviationRow, Samples, samples
from halfspace.errors import InputError, Unsolved, tried
from halfspace.values import Array, Estimate

TOLERANCE = 0.1  # of the sum of the terms' sizes
DEVIATIONS = 2.0  # standard deviations that bound an error
RIGID_PULL_OFF = -9 / 7
"""Of 1/rho in the relative change of the pull-off load by the profile, as mu -> 0 (theory of the rigid sphere)."""

SOFT_PULL_OFF = -(8 / 15) * (9 * np.pi / 8) ** (5 / 3) / (3 * np.pi / 2)
"""Of mu/rho as mu -> infinity: Maugis' load exceeds JKR's by 8 a^5/(15 X^2), and JKR's least has a^3 = 9 pi/8."""

Term = Callable[[Array, Array], Array]
"""Of Tabor parameters and R/eps."""


ALL: Mapping[str, Term] = {
    "beta/R": lambda mu, rho: (mu / rho) ** 0.5,
    "(beta/R)^2": lambda mu, rho: mu / rho,
    "(beta/R)^3": lambda mu, rho: (mu / rho) ** 1.5,
    "(beta/R)^4": lambda mu, rho: (mu / rho) ** 2,
    "(beta/R)^5": lambda mu, rho: (mu / rho) ** 2.5,
    "eps/R": lambda mu, rho: 1 / rho,  # noqa: ARG005 - every term is a function of both
    "(eps/R)^2": lambda mu, rho: 1 / rho**2,  # noqa: ARG005
    "beta/R ln(beta/R)": lambda mu, rho: np.sqrt(mu / rho) * np.log(mu / rho) / 2,
}
TERMS = ("beta/R", "(beta/R)^2", "eps/R")

FIXED_GRIPS = ("jump_on_approach", "jump_on_load", "jump_off_approach", "jump_off_load", "hysteresis")
"""Quantities that the body's yield changes to first order."""


def leading_terms(cause: str, quantity: str, *, one_tabor: bool = False) -> Mapping[str, Term]:
    """Terms of a deviation; among points of one Tabor parameter (beta/R)^2 and eps/R are one term."""
    names: tuple[str, ...]
    if cause in ("profile", "traction"):  # of the shape of the undeformed surface alone
        names = ("(beta/R)^2", "(beta/R)^4") if one_tabor else ("(beta/R)^2", "eps/R")
    elif quantity in FIXED_GRIPS:
        names = TERMS[:2] if one_tabor else TERMS
        names += ("beta/R ln(beta/R)",) if cause in ("body", "all") else ()  # the body yields as a whole
    elif cause == "grip":
        names = ("(beta/R)^3", "(beta/R)^5")
    else:
        names = (*TERMS[:2], "(beta/R)^3") if one_tabor else TERMS
    return {name: ALL[name] for name in names}


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
    points: int
    worst: float


Finding = tuple[str, str, float | None, Fit | Unsolved]
"""Cause, quantity and Tabor parameter of a deviation, None for all, and its leading terms, or why there are none."""


def findings(rows: Sequence[DeviationRow], poisson: float) -> Iterator[Finding]:
    """Fits of every quantity for every cause, at all Tabor parameters together and at each."""
    keys = dict.fromkeys((row.cause, row.quantity, row.poisson) for row in rows if row.poisson in (None, poisson))
    for cause, quantity, nu in keys:
        data = samples(rows, cause, quantity, poisson=nu)
        parts = {None: data} | {float(mu): data[data.tabor == mu] for mu in np.unique(data.tabor)}
        for tabor, part in parts.items():
            terms = leading_terms(cause, quantity, one_tabor=tabor is not None)
            yield cause, quantity, tabor, tried(fit, part, terms, refusals=True)


def compare(rows: Sequence[DeviationRow]) -> Iterator[tuple[str, float, float, Estimate]]:
    """Compare the profile's part in the pull-off with the rigid sphere's and Maugis'; InputError of too few points.

    Each theory has its name, the leading coefficient in its limit, the nearest Tabor parameter, and that fitted there.
    """
    data = samples(rows, "profile", "pull_off_load", poisson=None)
    if not data.size:
        raise InputError(
            "0 deviations of the pull-off by the profile, limit 4; solve for some at small tabor/radius_ratio"
        )
    for theory, name, square, expected, tabor in (
        ("rigid sphere: eps/R", "eps/R", "(eps/R)^2", RIGID_PULL_OFF, float(data.tabor.min())),
        ("Maugis (1995): (beta/R)^2", "(beta/R)^2", "(beta/R)^4", SOFT_PULL_OFF, float(data.tabor.max())),
    ):
        terms = {"leading": ALL[name], "square": ALL[square]}
        found = fit(data[data.tabor == tabor], terms, tolerance=TOLERANCE / 10)
        yield theory, expected, tabor, found.coefficients["leading"]


def fit(data: Samples, terms: Mapping[str, Term], *, tolerance: float = TOLERANCE) -> Fit:
    """Fit terms, functions of the Tabor parameter and R/eps, on all points up to the largest beta/R that allows it.

    A point may be off by its own error and the tolerance, a part of the sum of the terms' sizes. InputError if no fit
    does so on at least twice as many points as there are terms.
    """
    functions = list(terms.values())
    for limit in np.unique(data.stretch)[::-1]:
        part = data[data.stretch <= limit]
        if part.size < 2 * len(terms):
            break
        found, residual, allowed = _least_squares(part, functions, tolerance)
        if np.all(np.abs(residual) <= allowed):
            nearer = part[part.stretch <= limit / 2]
            if nearer.size >= 2 * len(terms):  # what the terms leave out pulls at them, which no scatter shows
                others, _, _ = _least_squares(nearer, functions, tolerance)
                found = [
                    Estimate(c.value, c.error + abs(c.value - d.value)) for c, d in zip(found, others, strict=True)
                ]
            coefficients = dict(zip(terms, found, strict=True))
            return Fit(coefficients, float(limit), part.size, float(np.abs(residual).max()))
    raise InputError(
        f"{data.size} points leave no {2 * len(terms)} or more within tolerance = {tolerance:g} of a fit; "
        "give more points of small tabor/radius_ratio"
    )


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
    spread = np.sum((residual / sigma) ** 2) / (data.size - len(terms))
    variance = spread * np.diag(np.linalg.pinv((scaled / sizes).T @ (scaled / sizes))) / sizes**2
    found = [Estimate(float(v), float(DEVIATIONS * np.sqrt(s))) for v, s in zip(c, variance, strict=True)]
    return found, residual, data.error + tolerance * (np.abs(A) @ np.abs(c))
