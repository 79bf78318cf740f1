"""Numbers with their error and unit, as text."""

from __future__ import annotations

import math

from fem_adhesion.common.units import Quantity
from halfspace.values import Estimate

PREFIXES = {
    -24: "y",
    -21: "z",
    -18: "a",
    -15: "f",
    -12: "p",
    -9: "n",
    -6: "µ",
    -3: "m",
    0: "",
    3: "k",
    6: "M",
    9: "G",
    12: "T",
}
DIGITS = 6  # significant, at most


def with_error(quantity: Quantity, scale: float = 1.0, digits: int = DIGITS) -> str:
    """Number with the error of its last digit in brackets, rounded up: 60.4440(1).

    Parameters
    ----------
    quantity : Quantity
        With its error.
    scale : float
        By which both are multiplied first.
    digits : int
        Significant ones, at most.
    """
    value, error = quantity.value * scale, quantity.error * scale
    most = digits - 1 - _decade(value)
    decimals = max(0, min(most, -_decade(error)) if error else most)
    uncertain = max(1, math.ceil(error * 10**decimals * (1 - 1e-9)))
    return f"{value:.{decimals}f}({uncertain})"


def plus_minus(estimate: Estimate) -> str:
    """Value with its error behind it."""
    return f"{digits(estimate)} +- {estimate.error:.1g}"


def digits(estimate: Estimate) -> str:
    """Value to one digit beyond the first uncertain one, ten decimals at most; what is not finite as such."""
    if not (math.isfinite(estimate.value) and math.isfinite(estimate.error)):
        return f"{estimate.value:g}"
    decimals = 1 - math.floor(math.log10(estimate.error)) if estimate.error > 0 else 10
    return f"{estimate.value:.{min(max(decimals, 1), 10)}f}"


def engineering(value: float, unit: str, digits: int = 4) -> str:
    """Number with an engineering prefix: 57.1 GPa."""
    exponent = exponent_of(value)
    return f"{value / 10.0**exponent:.{digits}g} {PREFIXES[exponent]}{unit}"


def exponent_of(value: float) -> int:
    """Power of 1000 below a value, as an exponent of ten, among those that have a prefix."""
    return min(max(3 * (_decade(value) // 3), min(PREFIXES)), max(PREFIXES))


def _decade(value: float) -> int:
    return math.floor(math.log10(abs(value))) if value else 0
