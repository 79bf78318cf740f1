"""Roots between two places, whose absence is a solver's honest end here."""

from __future__ import annotations

import math
from collections.abc import Callable

from halfspace.errors import NotConverged

MOST_ITERATIONS = 100  # of which few are halvings
ROUNDING = 4 * 2.0**-52  # relative


def root(
    function: Callable[[float], float],
    first: float,
    last: float,
    what: str,
    *,
    xtol: float = 2e-12,
    rtol: float = ROUNDING,
) -> float:
    """Root of a function between two places at which its signs differ.

    By inverse quadratic interpolation where three values allow it, else by halving: Chandrupatla, A new hybrid
    quadratic/bisection algorithm for finding the zero of a nonlinear function, Adv. Eng. Softw. 28 (1997) 145. SciPy
    has it too, among so much else that loading it takes as long as a curve.

    Parameters
    ----------
    function : callable
        Continuous between them.
    first, last : float
        The places.
    what : str
        What is sought and what to do if it is not there, for the error message: "the contact edge; refine the grid".
    xtol, rtol : float
        How near the root is known, absolutely and in parts of it, the one or the other.

    Raises
    ------
    NotConverged
        If the signs are the same, a value is not a number, or the interval does not shrink.
    """
    sought, _, remedy = what.partition("; ")

    def value_at(x: float) -> float:
        value = float(function(x))
        if math.isnan(value):
            raise NotConverged(f"{sought} is lost at {x:.6g}, where it cannot be told; {remedy}")
        return value

    a, b = first, last
    fa, fb = value_at(a), value_at(b)
    if fa and fb and (fa < 0) == (fb < 0):
        raise NotConverged(
            f"{sought} is not between {a:.6g} and {b:.6g}, where the signs are the same ({fa:.2g} and {fb:.2g}); "
            f"{remedy}"
        )
    t = 0.5  # of the way from a to b, which stay at the root's two sides
    for _ in range(MOST_ITERATIONS):
        best, least = (a, fa) if abs(fa) < abs(fb) else (b, fb)
        near = xtol + rtol * abs(best)
        if least == 0 or abs(b - a) <= near:
            return best
        nearest = near / abs(b - a) / 2
        x = a + min(max(t, nearest), 1 - nearest) * (b - a)
        fx = value_at(x)
        c, fc, b, fb = (a, fa, b, fb) if (fx < 0) == (fa < 0) else (b, fb, a, fa)
        a, fa = x, fx
        t = _interpolated(a, b, c, fa, fb, fc)
    raise NotConverged(f"{sought} is not pinned down in {MOST_ITERATIONS} steps, limit: xtol; {remedy}")


def _interpolated(a: float, b: float, c: float, fa: float, fb: float, fc: float) -> float:
    """Where the parabola x(f) through three points crosses zero, in parts of the way from a to b; else half of it."""
    xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
    if not (phi * phi < xi and (1 - phi) * (1 - phi) < 1 - xi):  # it would turn between them
        return 0.5
    return fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
