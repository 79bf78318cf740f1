"""Overlapping triangles and uniform bands of pressure at two intervals, extrapolated to none.

The deflection and the load under a pressure err as the square of the interval when it is interpolated by straight lines
or taken at the middle of bands. The body is linear, so that Richardson's extrapolation may be applied to the operator
itself: with intervals n times as long as h the operator (n^2 C_h - C_nh)/(n^2 - 1) errs by between h^3, which the
kernel's logarithm leaves of a node's own neighbours, and h^4, which is left of all else. Its load by triangles is
Simpson's rule.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from halfspace.elastic.compliance import ElasticOperator
from halfspace.values import Array


def divided(lines: Array, parts: int) -> Array:
    """Lines (m parts + 1,) with each interval between the lines (m + 1,) divided into equal parts."""
    places = np.arange(parts) / parts
    return np.append((lines[:-1, None] + np.diff(lines)[:, None] * places).ravel(), lines[-1])


def extrapolated(make: Callable[[Array], ElasticOperator], lines: Array, parts: int) -> ElasticOperator:
    """Operator of third order, nearly of fourth, from one of second order.

    `make` takes the intervals between lines (m + 1,), from 0 outwards, in beta. It is asked for the operator on these
    intervals, and on intervals with as many parts in each, whose nodes must include the former's: two parts for
    triangles, three for bands. The nodes are the latter's. The error of the deflection is smooth, and linearly
    interpolated between the nodes that both have. On the axis triangles have no weight then, as in Simpson's rule.
    """
    fine, coarse = make(divided(lines, parts)), make(lines)
    shared = np.abs(fine.radii[:, None] - coarse.radii).argmin(axis=0)
    off = fine.compliance[shared]
    off[:, shared] -= coarse.compliance
    weights = parts**2 * fine.weights
    weights[shared] -= coarse.weights
    compliance = fine.compliance + _between(coarse.radii, fine.radii) @ off / (parts**2 - 1)
    return replace(fine, weights=weights / (parts**2 - 1), compliance=compliance)


def _between(nodes: Array, radii: Array) -> Array:
    """Rows (n, m) that interpolate values at nodes (m,) linearly at radii (n,), and beyond the first and the last."""
    left = np.clip(np.searchsorted(nodes, radii, side="right") - 1, 0, nodes.size - 2)
    part = (radii - nodes[left]) / (nodes[left + 1] - nodes[left])
    rows = np.zeros((radii.size, nodes.size))
    np.put_along_axis(rows, left[:, None], (1 - part)[:, None], axis=1)
    np.put_along_axis(rows, left[:, None] + 1, part[:, None], axis=1)
    return rows
