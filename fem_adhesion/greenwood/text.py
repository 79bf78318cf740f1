"""Sentences of the Greenwood study: each is made of numbers, and is left unsaid where one of them is missing."""

from __future__ import annotations

import math

import numpy as np

from halfspace.equilibrium.contact import CENTRAL_GAP
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array

NOTHING = "No numbers were found to tell of."


def told(text: str, *numbers: float | Array) -> str:
    """The text, or nothing if a number that it rests on is missing or not finite."""
    known = all(np.size(number) and np.all(np.isfinite(number)) for number in numbers)
    return text if known else ""


def joined(*sentences: str) -> str:
    """Sentences that have something to tell, as one paragraph."""
    return " ".join(filter(None, sentences)) or NOTHING


def listed(names: list[str]) -> str:
    """Names with commas and an `and`."""
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


def rises(values: Array) -> bool:
    """Whether each value exceeds the one before it; there must be two."""
    return values.size > 1 and bool(np.all(np.diff(values) > 0))


def gap_falls(path: EquilibriumPath) -> bool:
    """Whether the central gap falls at every point of a curve, by the tangents: grids hand over with a small step."""
    return all(point.rates[CENTRAL_GAP] < 0 for point in path.points)


def farthest(points: tuple[Array, Array], line: tuple[Array, Array]) -> float:
    """Largest distance of points from a polygon, in units of its width and height where the points are."""
    at, corners = np.stack(points), np.stack(line)
    if at.size == 0 or corners.shape[1] < 2:
        return math.nan
    size = np.maximum(np.ptp(at, axis=1), 1e-12)[:, None]
    at, corners = at / size, corners / size
    start, step = corners[:, :-1], np.diff(corners)
    length = np.maximum(np.sum(step**2, axis=0), 1e-30)
    offsets = at[:, :, None] - start[:, None]
    t = np.clip(np.sum(offsets * step[:, None], axis=0) / length, 0, 1)
    return float(np.hypot(*(offsets - t * step[:, None])).min(axis=1).max())
