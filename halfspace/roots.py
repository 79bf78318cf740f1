"""Roots between two places: the one way to Brent's method, whose complaints are a solver's honest end here."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.optimize import brentq

from halfspace.errors import NotConverged

MOST_ITERATIONS = 100  # of Brent's method, which halves its interval at worst every third


def root(function: Callable[[float], float], first: float, last: float, what: str, **tolerances: Any) -> float:
    """Root of a function between two places at which its signs differ.

    Parameters
    ----------
    function : callable
        Continuous between them.
    first, last : float
        The places.
    what : str
        What is sought and what to do if it is not there, for the error message: "the contact edge; refine the grid".
    **tolerances
        ``xtol`` and ``rtol`` of `scipy.optimize.brentq`.

    Raises
    ------
    NotConverged
        If the signs are the same, a value is not a number, or the interval does not shrink.
    """
    sought, _, remedy = what.partition("; ")

    def number(x: float) -> float:
        value = float(function(x))
        if math.isnan(value):
            raise NotConverged(f"{sought} is lost at {x:.6g}, where it cannot be told; {remedy}")
        return value

    at = number(first), number(last)
    if at[0] and at[1] and (at[0] < 0) == (at[1] < 0):
        raise NotConverged(
            f"{sought} is not between {first:.6g} and {last:.6g}, where the signs are the same ({at[0]:.2g} and "
            f"{at[1]:.2g}); {remedy}"
        )
    found, how = brentq(number, first, last, maxiter=MOST_ITERATIONS, full_output=True, disp=False, **tolerances)
    if not how.converged:
        raise NotConverged(f"{sought} is not pinned down in {MOST_ITERATIONS} steps, limit: xtol; {remedy}")
    return float(found)
