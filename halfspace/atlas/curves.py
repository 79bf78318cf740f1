"""Whole curves at any Tabor parameter, by Chebyshev series in the central gap and the Tabor parameter.

The central gap falls all along a curve, from separation to compression, so that load and approach are smooth functions
of it through every fold. A place on a curve is x with H0 = w sinh(x), w the size of the central gap under no load: far
apart x is the logarithm of the gap, in contact it goes as the pressure. The curve is cut where the contact begins, and
both parts in `PARTS` pieces of equal length in x.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from halfspace.atlas.series import EDGE, Series, require_tabors, series, summed
from halfspace.branches import branch_names, chosen_branch
from halfspace.errors import InputError
from halfspace.limits import require_number, require_numbers, require_one_of
from halfspace.values import Array, Index, States, Valued


@dataclass(frozen=True)
class CurveSettings:
    """Pieces of a curve, and how places on it are sought."""

    parts: int = 3  # pieces of a curve without contact, and as many with
    farthest: float = 1.9  # central gap at the other end, in (10 + tabor) eps: a contact under fixed grips lands nearer
    compressed: float = 1.3  # central gap at the end in compression, in that under no load: over 5 R dgamma
    samples: int = 128  # places on a piece among which turns are looked for
    halvings: int = 50  # of an interval in which a place is sought


PIECES = CurveSettings()


OWN = {"approach": 4, "load": 5}  # row of the error of a coordinate, which is zero where that is asked for
UNITS = {"approach": "eps", "load": "R dgamma", "base": "eps"}


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Valued):
    """The curve of a Tabor parameter, from separation to compression.

    A place on it is a number from 0, where the surfaces are apart, to that of the pieces, where they are compressed.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    width : float
        Unit w of the central gap in eps, H0 = w sinh(x).
    ends : (pieces + 1,) array
        Ends of the pieces in x, descending.
    coefficients : (3, terms, pieces) array
        Of approach + central gap, load and the square of the contact radius, nan without contact.
    errors : (4, pieces) array
        Estimated largest errors on each piece of approach, load, central gap and the square of the contact radius.
    """

    tabor: float
    width: float
    ends: Array
    coefficients: Array
    errors: Array

    def states(self, count: int = 500, *, places: ArrayLike | None = None) -> States:
        """States at so many places from separation to compression, evenly spaced, or at the places (n,) given."""
        return States(*self._numbers(np.linspace(0, self._last, count) if places is None else np.asarray(places)))

    def branches(self, coordinate: str, *, stiffness: float = math.inf) -> dict[str, tuple[float, float]]:
        """Parts of the curve in order along which a coordinate goes in one direction, and its range on each.

        The coordinate is "approach", "load" or "base", alpha* + W/stiffness, with the stiffness in R dgamma/eps.
        """
        way = _way(coordinate, stiffness)
        return self._ranges(way, self._parts(way))

    def at(
        self,
        *,
        approach: ArrayLike | None = None,
        load: ArrayLike | None = None,
        base: ArrayLike | None = None,
        stiffness: float = math.inf,
        branch: str | None = None,
    ) -> States:
        """States that have a given approach or load, or a base of a spring.

        Parameters
        ----------
        approach, load, base : array_like
            One of them, in eps, R dgamma or eps: the base of a spring on which the contact hangs is alpha* + W/k.
        stiffness : float
            Stiffness k of the spring, in R dgamma/eps.
        branch : str, optional
            As of `halfspace.EquilibriumPath.at`: ``separated``, ``unstable``, ``contact``; see `branches`.

        Raises
        ------
        InputError
            If there is no such state, or there are several.
        """
        asked = {"approach": approach, "load": load, "base": base}
        given = [(name, require_numbers(values, name)) for name, values in asked.items() if values is not None]
        if len(given) != 1:
            names = " and ".join(name for name, _ in given) or "nothing"
            raise InputError(f"a state is asked for by {names}, limit: one of {', '.join(asked)}; give that one")
        ((coordinate, values),) = given
        way, wanted = _way(coordinate, stiffness), np.atleast_1d(values)
        parts = self._parts(way)
        ranges = self._ranges(way, parts)
        unit, numbers = UNITS[coordinate], np.empty((8, *wanted.shape))
        chosen = [chosen_branch(ranges, coordinate, unit, value, branch) for value in wanted.ravel().tolist()]
        for name in {*chosen}:
            here = np.reshape([one == name for one in chosen], wanted.shape)
            numbers[:, here] = self._met(way, wanted[here], parts[name], ranges[name])
        if coordinate in OWN:
            numbers[OWN[coordinate]] = 0.0
        return States(*(number.reshape(values.shape)[()] for number in numbers))

    @property
    def _last(self) -> int:
        return self.ends.size - 1

    def _met(self, way: Array, values: Array, part: tuple[float, float], limits: tuple[float, float]) -> Array:
        """Numbers and errors, (8, n), where a coordinate has given values on a part of the curve.

        The errors are those across the curve, and what others change if the coordinate changes by its own.
        """
        first, last = self._along(way, np.array(part))
        rising = np.sign(last - first)

        def solved(wanted: Array) -> Array:
            ends = (np.full(wanted.shape, end) for end in part)
            return self._numbers(_bisected(lambda places: rising * (self._along(way, places) - wanted), *ends))

        found = solved(values)
        own = np.abs(way) @ found[4:6]
        changes = (np.abs(solved(np.clip(values + side * own, *limits))[:4] - found[:4]) for side in (-1, 1))
        found[4:] += np.fmax(*changes)
        return found

    def _parts(self, way: Array) -> dict[str, tuple[float, float]]:
        """Places between which a coordinate goes in one direction."""
        places = np.linspace(0, self._last, self._last * PIECES.samples + 1)
        rates = self._rate(way, places)
        turns = np.flatnonzero(rates[1:] * rates[:-1] < 0)
        sign = np.sign(rates[turns + 1])
        at = _bisected(lambda trial: sign * self._rate(way, trial), places[turns], places[turns + 1])
        ends = [0.0, *at.tolist(), float(self._last)]
        return dict(zip(branch_names(len(ends) - 1), pairwise(ends), strict=True))

    def _ranges(self, way: Array, parts: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Least and largest value of a coordinate on each part."""
        ends = {name: self._along(way, np.array(part)) for name, part in parts.items()}
        return {name: (float(values.min()), float(values.max())) for name, values in ends.items()}

    def _along(self, way: Array, places: Array) -> Array:
        """Coordinate, weights (2,) of approach and load, at places (n,)."""
        piece, t, x = self._on_piece(places)
        further, load = (summed(c, piece, t) for c in self.coefficients[:2])
        return np.asarray(way @ [further - self.width * np.sinh(x), load])

    def _numbers(self, places: Array) -> Array:
        """Numbers and their errors across the curve, (8, n), in the order of `States`."""
        piece, t, x = self._on_piece(places)
        further, load, square = (summed(c, piece, t) for c in self.coefficients)
        gap, radius = self.width * np.sinh(x), np.sqrt(np.maximum(square, 0))
        approach_error, load_error, gap_error, square_error = self.errors[:, piece]
        radius_error = square_error / np.maximum(2 * radius, np.sqrt(square_error))
        errors = approach_error, load_error, gap_error, radius_error
        return np.array([further - gap, load, gap, radius, *errors])

    def _rate(self, way: Array, places: Array) -> Array:
        """Derivative of a coordinate by the place."""
        piece, t, x = self._on_piece(places)
        slopes = np.polynomial.chebyshev.chebder(self.coefficients[:2], axis=1)
        further, load = (2 * summed(c, piece, t) for c in slopes)
        return np.asarray(way @ [further - self.width * np.cosh(x) * np.diff(self.ends)[piece], load])

    def _on_piece(self, places: Array) -> tuple[Index, Array, Array]:
        """Piece, place t on it from -1 to 1, and x."""
        piece = np.clip(places.astype(int), 0, self._last - 1)
        return piece, 2 * (places - piece) - 1, self.ends[piece] + (places - piece) * np.diff(self.ends)[piece]


def _way(coordinate: str, stiffness: float) -> Array:
    """Weights (2,) of approach and load in a coordinate."""
    require_one_of(coordinate, "coordinate", tuple(UNITS))
    k = require_number(stiffness, "stiffness")
    if not k > 0:
        raise InputError(f"stiffness = {k:g} is outside 0 < stiffness; ask for a load, which a dead weight holds")
    return np.array({"approach": (1.0, 0.0), "load": (0.0, 1.0), "base": (1.0, 1 / k)}[coordinate])


def _bisected(function: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Places where a function rises through zero, each between its ends."""
    for _ in range(PIECES.halvings):
        middle = (low + high) / 2
        below = function(middle) < 0
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray((low + high) / 2)


def layout(tabor: float, gap: Series) -> tuple[float, Array]:
    """Unit w of central gaps, by the series of that under no load, and the ends of the pieces of a curve in x."""
    width = -float(gap(np.array([tabor]))[0][0])
    ends = np.arcsinh(np.array([PIECES.farthest * (10 + tabor), EDGE, -PIECES.compressed * width]) / width)
    return width, np.concatenate([np.linspace(a, b, PIECES.parts + 1)[i:] for i, (a, b) in enumerate(pairwise(ends))])


@cache
def tensors() -> Mapping[str, Array]:
    """Content of the file of curves."""
    with np.load(Path(__file__).with_name("curves.npz")) as file:
        return dict(file)


def curve(tabor: float) -> Curve:
    """Curve of a paraboloid on a half-space under the 3-9 law; InputError unless 0.01 <= tabor <= 300."""
    (tabor, k, by_tabor), known = _by_tabor(tabor), tensors()
    # Whole numbers of a unit, (terms in tabor, 3, pieces, terms).
    coefficients = np.tensordot(by_tabor, known["coefficients"][k], axes=1) * known["units"][k][..., None]
    width, ends = layout(tabor, series("zero_load.central_gap"))
    return Curve(tabor, width, ends, np.swapaxes(coefficients, 1, 2).copy(), known["errors"][k])


def table(tabor: float, count: int) -> Array:
    """Approach and load, (2, count), at places evenly spaced from separation to compression, as `Curve.states` has.

    For many Tabor parameters: sums over the places are made once for each piece of the Tabor parameter.
    """
    tabor, k, by_tabor = _by_tabor(tabor)
    further, load = np.tensordot(by_tabor, _summed_at_places(k, count), axes=1)
    width, ends = layout(tabor, series("zero_load.central_gap"))
    places = np.linspace(0, ends.size - 1, count)
    return np.array([further - width * np.sinh(np.interp(places, np.arange(ends.size), ends)), load])


@cache
def _summed_at_places(k: int, count: int) -> Array:
    """Coefficients in the Tabor parameter, (terms, 2, count), of approach + central gap and load at places."""
    coefficients = tensors()["coefficients"][k][:, :2] * tensors()["units"][k][:2, :, None]
    pieces = coefficients.shape[2]
    places = np.linspace(0, pieces, count)
    piece = np.clip(places.astype(int), 0, pieces - 1)
    across = np.polynomial.chebyshev.chebvander(2 * (places - piece) - 1, coefficients.shape[3] - 1)
    return np.asarray(np.einsum("tqnc,nc->tqn", coefficients[:, :, piece], across))


def _by_tabor(tabor: float) -> tuple[float, int, Array]:
    """Tabor parameter, or InputError if it is none of the atlas, its piece, and the Chebyshev polynomials there."""
    tabor = require_number(tabor, "tabor")
    require_tabors(tabor)
    x, ends = math.log(tabor), tensors()["ends"]
    k = int(np.clip(np.searchsorted(ends, x, side="right") - 1, 0, ends.size - 2))
    t = (2 * x - ends[k] - ends[k + 1]) / (ends[k + 1] - ends[k])
    return tabor, k, np.polynomial.chebyshev.chebvander(t, len(tensors()["coefficients"][k]) - 1)[0]
