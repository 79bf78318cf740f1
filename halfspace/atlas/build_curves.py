"""How the curves of the atlas are made: tensors of Chebyshev coefficients through states that `halfspace.trace` finds.

A state's central gap is known less well than the curve on which it lies, by its place along that. Load and approach of
a state go with one another, so that such a shift leaves the series on the curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from halfspace.accuracy.trace import trace
from halfspace.atlas.build import BUILD, EVENTS, fitted
from halfspace.atlas.curves import PIECES, Curve, layout
from halfspace.atlas.series import Series
from halfspace.equilibrium.events import usual
from halfspace.values import Array


@dataclass(frozen=True)
class NodeSettings:
    """Pieces of the curves, and their nodes."""

    tabors: int = 18  # nodes of a piece in ln(tabor)
    places: int = 28  # nodes of a piece of a curve
    to_load: float = 60.0  # R dgamma, beyond the ends of all curves
    steps: float = 2.0**38  # units in the largest coefficient of a piece, which are stored as whole numbers


CURVES = NodeSettings()


States = Mapping[str, Array]


def states(tabor: float, gap: Series) -> dict[str, Array]:
    """Numbers (3, pieces, nodes) of a curve, by the central gap under no load as it is in the atlas.

    They are approach + central gap, load and the square of the contact radius.

    Their errors, (4,), the third that of the central gap, are those of the least known event: those of a state with a
    given central gap are larger, but along the curve.
    """
    width, ends = layout(tabor, gap)
    t = chebyshev.chebpts1(CURVES.places)
    gaps = width * np.sinh(np.array([(a + b) / 2 + (b - a) / 2 * t for a, b in pairwise(ends)]))
    path = trace(tabor, rtol=BUILD.rtol, to_load=CURVES.to_load)
    found = path.at(central_gap=gaps)
    events = [path.events[name] for name in EVENTS]
    numbers = found.approach + gaps, found.load, found.contact_radius**2
    errors = [(e.approach_error, e.load_error, e.central_gap_error) for e in usual(path.events).values()]
    square = max(2 * event.contact_radius * event.contact_radius_error for event in events)
    return {"numbers": np.array(numbers), "errors": np.array([*np.max(errors, axis=0), square])}


def built(node: Callable[[float], States]) -> dict[str, NDArray[Any]]:
    """Content of the file of curves."""
    ends = np.log(BUILD.whole)
    pieces = [piece(node, *part) for part in pairwise(ends.tolist())]
    coefficients, units, errors = (np.array(of_all) for of_all in zip(*pieces, strict=True))
    return {"ends": ends, "coefficients": coefficients, "units": units, "errors": errors}


def piece(node: Callable[[float], States], low: float, high: float) -> tuple[NDArray[np.int64], Array, Array]:
    """Coefficients on a piece of ln(tabor) as whole numbers, (terms, 3, pieces, terms), their units and errors."""
    places = (low + high) / 2 + (high - low) / 2 * chebyshev.chebpts1(CURVES.tabors)
    nodes = [node(tabor) for tabor in np.exp(places).tolist()]
    by_tabor = fitted([found["numbers"] for found in nodes])
    c = np.moveaxis(fitted(np.moveaxis(by_tabor, -1, 0)), 0, -1)
    c[:, 2, : PIECES.parts] = np.nan_to_num(c[:, 2, : PIECES.parts])  # no radius without contact
    tails = np.abs(c[-2:]).sum(axis=(0, 3)) + np.abs(c[..., -2:]).sum(axis=(0, 3))
    unit = np.abs(c).max(axis=(0, 3)) / CURVES.steps
    approach, load, square = tails + unit * c.shape[0] * c.shape[3] / 2
    source = np.max([found["errors"] for found in nodes], axis=0)
    errors = np.array([approach, load, 0 * load, square]) + source[:, None]
    whole = np.round(c / np.where(unit, unit, 1)[..., None]).astype(np.int64)
    unit[2, : PIECES.parts] = math.nan
    return whole, unit, errors


def deviations(tabor: float, curve: Curve, seed: int = 0) -> tuple[float, float]:
    """How far random states of a curve are from the source at the same approach: relative, and in both errors.

    The scale of a load is 2 pi R dgamma, that of a contact radius beta.
    """
    random = np.random.default_rng(seed)
    path = trace(tabor, rtol=BUILD.rtol, to_load=CURVES.to_load)
    relative, of_errors = [0.0], [0.0]
    ours, theirs = curve.branches("approach"), path.branches("approach")
    for branch in [name for name in ours if name in theirs]:
        low, high = max(ours[branch][0], theirs[branch][0]), min(ours[branch][1], theirs[branch][1])
        approach = low + (high - low) * random.uniform(0.02, 0.98, 4)
        one, other = curve.at(approach=approach, branch=branch), path.at(approach=approach, branch=branch)
        for name, scale in (("load", 2 * np.pi), ("contact_radius", 1.0)):
            off = np.abs(getattr(one, name) - getattr(other, name))
            error = getattr(one, f"{name}_error") + getattr(other, f"{name}_error")
            relative += (off / scale)[np.isfinite(off)].tolist()
            of_errors += (off / error)[np.isfinite(off)].tolist()
    return max(relative), max(of_errors)
