"""Piecewise Chebyshev series of the Tabor parameter: read from the atlas's file and evaluated by NumPy alone."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from halfspace.errors import InputError
from halfspace.limits import require_numbers
from halfspace.values import Array, Index, Valued

LEAST, MOST = 0.01, 300.0  # Tabor parameters that the atlas covers
EDGE = 3 ** (1 / 6) - 1  # central gap in eps where a contact begins: that of the largest tension of the 3-9 law


@dataclass(frozen=True, eq=False, repr=False)
class Series(Valued):
    """A number as a function of the Tabor parameter, by a Chebyshev series on each piece of a variable x.

    A number that every curve has is smooth in x = ln(tabor). A fold that is born at a Tabor parameter moves from there
    as the root of the distance, and is smooth in x = sqrt(ln(tabor/birth)).

    Attributes
    ----------
    ends : (pieces + 1,) array
        Of the pieces, in x, ascending; there is no such number, nan, below the first.
    coefficients : (terms, pieces) array
        Of the Chebyshev polynomials on each piece.
    errors : (pieces,) array
        Estimated largest error on each piece: that of the numbers it was made of, and what the series leaves out.
    birth : float
        Tabor parameter where x is zero; 1 without a birth.
    birth_errors : (pieces,) array
        Error by that of the birth itself, times x: the number moves as the root, and faster without limit towards it.
    power : int
        Power of the number that the series holds: 2 for a contact radius, which begins as a root.
    """

    ends: Array
    coefficients: Array
    errors: Array
    birth: float
    birth_errors: Array
    power: int = 1

    def __call__(self, tabor: Array, derivative: int = 0) -> tuple[Array, Array]:
        """Values and errors at Tabor parameters (n,), or those of the derivative by the Tabor parameter."""
        x = np.log(tabor / self.birth)
        if self.is_born:
            x = np.sqrt(np.where(x >= 0, x, np.nan))
        piece = np.clip(np.searchsorted(self.ends, x, side="right") - 1, 0, self.errors.size - 1)
        half = np.diff(self.ends) / 2
        t = (x - self.ends[piece]) / half[piece] - 1
        t[x < self.ends[0]] = np.nan
        with np.errstate(divide="ignore", invalid="ignore"):
            value = summed(self.coefficients, piece, t) ** (1 / self.power)
            scale = self.power * value ** (self.power - 1)  # of a change of the series to one of the number
            error = self.errors[piece] + (self.birth_errors[piece] / x if self.is_born else 0 * t)
            if not derivative:
                return value, error / scale
            rate = 1 / (half[piece] * tabor * (2 * x if self.is_born else 1.0)) / scale
            slope = summed(self._slopes, piece, t)
            # A polynomial of degree n within 1 has a slope within n/sqrt(1 - t^2) (Bernstein) and n^2 (Markov).
            n = len(self.coefficients) - 1
            steepest = n / np.maximum(np.sqrt(np.maximum(1 - t**2, 0)), 1 / n)
            by_scale = (self.power - 1) * np.abs(slope) / (scale * value)
        return rate * slope, rate * (steepest + by_scale) * error

    @property
    def is_born(self) -> bool:
        """Whether the number begins at the birth of folds."""
        return self.birth != 1.0

    @cached_property
    def _slopes(self) -> Array:
        """Coefficients of the derivative by the place t on a piece, -1 to 1."""
        return np.asarray(np.polynomial.chebyshev.chebder(self.coefficients))


def summed(coefficients: Array, piece: Index, t: Array) -> Array:
    """Sum of the series of a piece at places t; coefficients (terms, pieces). By Clenshaw's recurrence."""
    b1 = b2 = np.zeros_like(t)
    for c in coefficients[:0:-1]:
        b1, b2 = c[piece] + 2 * t * b1 - b2, b1
    return np.asarray(coefficients[0][piece] + t * b1 - b2)


@cache
def stored() -> dict[str, Any]:
    """Content of the atlas's file."""
    content: dict[str, Any] = json.loads(Path(__file__).with_name("atlas.json").read_text(encoding="utf-8"))
    return content


@cache
def series(name: str) -> Series:
    """Series of a number, as ``pull_off.load``."""
    return series_of(stored()["series"][name])


def series_of(entry: dict[str, Any]) -> Series:
    """Series of an entry of the file."""
    numbers = (np.array(entry[name]) for name in ("ends", "coefficients", "errors", "birth_errors"))
    ends, coefficients, errors, birth_errors = numbers
    return Series(ends, coefficients.T.copy(), errors, float(entry["birth"]), birth_errors, entry["power"])


def require_tabors(tabor: ArrayLike) -> Array:
    """Tabor parameters as an array, or InputError if one is outside the atlas."""
    values = require_numbers(tabor, "tabor")
    outside = ~((values >= LEAST) & (values <= MOST))
    if outside.any():
        worst = values[outside].flat[0]
        remedy = "give the Tabor parameter of the contact"  # of what is none: zero, negative or nan
        if worst > 0:
            remedy = "halfspace.trace serves down to 1e-12"
        if worst > MOST:
            remedy = "use JKR's theory in halfspace.theories above"
        raise InputError(f"tabor = {worst:.9g} is outside the atlas, {LEAST:g} <= tabor <= {MOST:g}; {remedy}")
    return values
