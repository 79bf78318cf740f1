"""Roots between two places: the one way to Brent's method, whose complaints are a solver's honest end here."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

from halfspace.errors import NotConverged, Unsolved, required

MOST_ITERATIONS = 100  # iterations of Brent's method, which halves its interval at worst every third


def root(function: Callable[[float], float], first: float, last: float, what: str, **tolerances: Any) -> float:
    """Root of a continuous function between two places as of `sought`, or raise NotConverged."""
    return required(sought(function, first, last, what, **tolerances))


def sought(
    function: Callable[[float], float], first: float, last: float, what: str, **tolerances: Any
) -> float | Unsolved:
    """Root of a continuous function between two places at which its signs differ; Unsolved else, or of nan.

    The reason says what is sought and what to do if it is not there: "the contact edge; refine the grid". Tolerances
    are ``xtol``, absolute, and ``rtol``, of the place: the root is known to their sum.
    """
    sought, _, remedy = what.partition("; ")
    at = float(function(first)), float(function(last))
    if at[0] and at[1] and (at[0] < 0) == (at[1] < 0) and not math.isnan(sum(at)):
        return Unsolved(
            f"{sought} is not between {first:.6g} and {last:.6g}, where the signs are the same ({at[0]:.2g} and "
            f"{at[1]:.2g}); {remedy}"
        )
    return _brent(function, (first, last), at, what=sought, remedy=remedy, **tolerances)


def rising_root(
    function: Callable[[float], float], what: str, *, start: float = 1.0, end: float = math.inf, farthest: float = 1e150
) -> float:
    """Root of a function that rises from below zero with a length, or the end where it is below zero still.

    It is looked for from a start on, and what is sought as of `root`; NotConverged where it is beyond the farthest.
    """
    sought, _, remedy = what.partition("; ")
    last = min(start, end)
    while function(last) < 0:
        if last >= end:
            return end
        if last > farthest:
            raise NotConverged(f"{sought} is beyond {farthest:g}; {remedy}")
        last = min(2 * last, end)
    first = last
    while function(first) > 0:
        first /= 2
        if first < 1 / farthest:
            raise NotConverged(f"{sought} is below {1 / farthest:g}; {remedy}")
    return root(function, first, last, what, xtol=1e-300, rtol=1e-15)


def _brent(
    function: Callable[[float], float],
    places: tuple[float, float],
    values: tuple[float, float],
    *,
    what: str,
    remedy: str,
    xtol: float = 2e-12,
    rtol: float = 4 * sys.float_info.epsilon,
) -> float | Unsolved:
    """Brent's method (Algorithms for Minimization Without Derivatives, 1973, chapter 4) between two changed signs.

    Of three places b is the best, a the one before it and c beyond the root. SciPy has it in a part that takes longer
    to load than a curve to trace.
    """
    (a, b), (fa, fb) = places, values
    c, fc = a, fa
    step = before = b - a
    for _ in range(MOST_ITERATIONS):
        if math.isnan(fa + fb):
            return Unsolved(f"{what} is lost at {b:.6g}, where it cannot be told; {remedy}")
        if (fb > 0) == (fc > 0):
            c, fc, step, before = a, fa, b - a, b - a
        if abs(fc) < abs(fb):
            a, b, c, fa, fb, fc = b, c, b, fb, fc, fb
        half, tolerance = (c - b) / 2, (xtol + rtol * abs(b)) / 2
        if abs(half) <= tolerance or fb == 0:
            return b
        step, before = _interpolated(a, b, c, fa, fb, fc, before, step, tolerance)
        a, fa = b, fb
        b += step if abs(step) > tolerance else math.copysign(tolerance, half)
        fb = float(function(b))
    return Unsolved(f"{what} is not pinned down in {MOST_ITERATIONS} steps, limit: xtol; {remedy}")


def _interpolated(
    a: float, b: float, c: float, fa: float, fb: float, fc: float, before: float, step: float, tolerance: float
) -> tuple[float, float]:
    """Next step and the one before: by the inverse parabola or the secant if they shrink enough, else by halving."""
    half = (c - b) / 2
    if abs(before) < tolerance or abs(fa) <= abs(fb):
        return half, half
    s, q, r = fb / fa, fa / fc, fb / fc
    if a == c:
        up, down = 2 * half * s, 1 - s
    else:
        up, down = s * (2 * half * q * (q - r) - (b - a) * (r - 1)), (q - 1) * (r - 1) * (s - 1)
    up, down = abs(up), -down if up > 0 else down
    if 2 * up < min(3 * half * down - abs(tolerance * down), abs(before * down)):
        return up / down, step
    return half, half
