"""Functions on an element's reference cell, and its quadrature points."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from skfem.quadrature import get_quadrature

from halfspace.values import Array


@lru_cache(maxsize=100)
def quadrature(domain: Any, order: int) -> tuple[Array, Array]:
    """Points and weights on an element's reference cell, or on a reference side; kept, and not to be written to."""
    rule = get_quadrature(domain, order)
    for numbers in rule:
        numbers.flags.writeable = False
    return rule[0], rule[1]


def reference_functions(element: Any, points: Array) -> tuple[Array, Array]:
    """Values (n, q) and derivatives (n, 2, q) of an element's functions at points (2, q) of the reference cell.

    They are kept, and not to be written to: all meshes of the same element ask for the same.
    """
    return _functions(element, points.shape, points.tobytes())


@lru_cache(maxsize=100)
def _functions(element: Any, shape: tuple[int, ...], places: bytes) -> tuple[Array, Array]:
    points = np.frombuffer(places).reshape(shape)
    found = [element.lbasis(points, i) for i in range(len(element.doflocs))]
    values = np.array([np.broadcast_to(value, points.shape[1:]) for value, _ in found])
    slopes = np.array([np.broadcast_to(slope, points.shape) for _, slope in found])
    values.flags.writeable = slopes.flags.writeable = False
    return values, slopes
