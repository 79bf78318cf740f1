"""The terms by which a deviation of the finite sphere begins, in beta/R = sqrt(mu/rho) and eps/R = 1/rho.

The curved body deforms in proportion to beta/R otherwise than a half-space. What it yields as a whole shifts the
approaches, and moves the jumps under fixed grips, by (kappa_0 + kappa_1 ln(beta/R)) beta/R, see
`fem_adhesion.finite_sphere.bulk`; dead load does not feel it. The undeformed surface is even in r/R, so profile and
area make a difference from (r/R)^2 on only, r being some beta or sqrt(R eps). A distant grip bends the surface by
(beta/R)^3, beside shifting it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from halfspace.values import Array

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
    """Terms of a deviation.

    Parameters
    ----------
    cause, quantity : str
        Which deviation, as in `fem_adhesion.finite_sphere.table.Row`.
    one_tabor : bool
        For points of one Tabor parameter, where (beta/R)^2 and eps/R are one term.
    """
    if cause in OF_THE_SHAPE:
        return EVEN_POWERS if one_tabor else EVEN
    if quantity not in FIXED_GRIPS:
        return ODD_POWERS if cause == "grip" else POWERS if one_tabor else TERMS
    powers = {name: TERMS[name] for name in ("beta/R", "(beta/R)^2")} if one_tabor else TERMS
    return {**powers, **LOGARITHM} if cause in YIELDING else powers
