"""Ring kernel of the elastic half-space and its integrals over bands and polynomial panels.

A ring of pressure p at radius s deflects the surface at radius r by (1/E*) p G(r, s) s ds. G is homogeneous
of degree -1 and has a logarithmic singularity at r = s. It is integrated by Gauss's rule where the target
is at least a panel's length away, and else by Gauss's rule in t after s - e = l t^q, e being the panel's
point nearest to the target: the powers of t smother the logarithm, on the panel or just off it.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray
from scipy.special import ellipe, ellipkm1, elliprd, elliprf

from halfspace.elastic.grid import gauss_legendre
from halfspace.values import Array

GRADING = 7  # q of the substitution; with NEAR_POINTS it leaves 5e-13 for panels of up to 16 nodes
NEAR_POINTS = 48
FAR_POINTS = 8  # and half as many as a panel has nodes: they leave 3e-14 of polynomials from one length away
FAR_DISTANCE = 1.0  # in panel lengths
BATCH = 2_000_000  # points at which the kernel is evaluated at a time: 16 MB an array


def ring_kernel(r: Array, s: Array) -> Array:
    """Deflection at radius r by a ring of unit pressure times radius at s: G = 4/(pi max) K(min/max), [G97] (2.6)."""
    return _kernel(r, s, s - r)


def _kernel(r: Array, s: Array, offset: Array) -> Array:
    """G(r, s), given s - r to full relative accuracy: 1 - k^2 must not be formed by cancellation."""
    larger = np.maximum(r, s)
    complement = np.minimum(np.abs(offset) * (r + s) / larger**2, 1.0)  # (1 - k)(1 + k)
    return np.asarray(4 / (np.pi * larger) * ellipkm1(complement))


def band_deflection(r: Array, c: Array) -> Array:
    """Deflection at radius r under unit pressure on the disc of radius c: (4/pi) F(c, r), [G97] App. B.

    F = c E(r/c) inside and (c^2/r) B(c/r) outside, B(k) = [E - (1 - k^2) K]/k^2 (the paper exchanges the two).
    A band is the difference of two discs. Arrays broadcast.
    """
    r, c = np.broadcast_arrays(np.asarray(r, float), np.asarray(c, float))
    F = np.zeros(r.shape)
    inside = (r <= c) & (c > 0)
    F[inside] = c[inside] * ellipe((r[inside] / c[inside]) ** 2)
    outside = r > c
    F[outside] = c[outside] ** 2 / r[outside] * _elliptic_b(c[outside] / r[outside])
    return 4 / np.pi * F


def _elliptic_b(k: Array) -> Array:
    """B(k) = K(k) - D(k) by Carlson's forms, which do not cancel as k goes to 0."""
    complement = (1 - k) * (1 + k)
    zero = np.zeros_like(k)
    one = np.ones_like(k)
    return np.asarray(elliprf(zero, complement, one) - elliprd(zero, complement, one) / 3)


@cache
def graded_rule(points: int, q: int = GRADING) -> tuple[Array, Array]:
    """Points and weights on (0, 1) for integrands with a logarithm at, or just below, 0."""
    x, w = gauss_legendre(points)
    t = (1 + x) / 2
    return t**q, w / 2 * q * t ** (q - 1)


def panel_integrals(targets: Array, breakpoints: Array, nodes: Array) -> Array:
    """Integrate G(r_i, s) s l(s) over each panel for each Lagrange polynomial l of the panel's nodes.

    The targets (n,) are the radii r_i >= 0 at which the deflection is wanted, anywhere on or off the panels, whose
    ends, the breakpoints (m + 1,), ascend from at least 0; the nodes (k,) are those of a panel on [-1, 1]. The
    deflection (n, m, k) at r_i (E* = 1) is by the pressure l_k on panel j, to an absolute accuracy of 1e-12 of the
    panel's scale.
    """
    targets = np.asarray(targets, float)
    batches = -(-targets.size * (breakpoints.size - 1) * _far_points(nodes.size) // BATCH)
    moments = [_moments(some, breakpoints, nodes.size) for some in np.array_split(targets, batches)]
    return np.concatenate(moments) @ np.linalg.inv(legvander(nodes, nodes.size - 1))


def _moments(targets: Array, breakpoints: Array, k: int) -> Array:
    """Integrals of G(r_i, s) s against the first k Legendre polynomials of each panel, (n, m, k)."""
    left, right = breakpoints[:-1], breakpoints[1:]
    r = targets[:, None]
    nearest = np.clip(r, left, right)
    near = np.abs(r - nearest) < FAR_DISTANCE * (right - left)
    moments = np.empty((r.size, left.size, k))
    moments[~near] = _far_moments(r, left, right, ~near, k)
    i, j = np.nonzero(near)
    moments[i, j] = sum(_near_moments(r[i, 0], left[j], right[j], nearest[i, j], end[j], k) for end in (left, right))
    return moments


def _far_points(nodes: int) -> int:
    return FAR_POINTS + nodes // 2


def _far_moments(r: Array, left: Array, right: Array, far: NDArray[np.bool_], k: int) -> Array:
    """Legendre moments of G s on panels far from their targets, for the pairs marked in `far`."""
    x, w = gauss_legendre(_far_points(k))
    i, j = np.nonzero(far)
    half = (right - left)[j] / 2
    s = ((right + left)[j] / 2)[:, None] + half[:, None] * x
    values = ring_kernel(r[i], s) * s
    return np.asarray((values * w * half[:, None]) @ legvander(x, k - 1))


def _near_moments(r: Array, left: Array, right: Array, nearest: Array, end: Array, k: int) -> Array:
    """Legendre moments of G s between the point of each panel nearest to its target and one of the panel's ends."""
    moments = np.zeros((r.size, k))
    some = nearest != end
    r, left, right, nearest, end = (v[some, None] for v in (r, left, right, nearest, end))
    t, w = graded_rule(NEAR_POINTS)
    step = (end - nearest) * t
    s = nearest + step
    x = (s - left - (right - s)) / (right - left)
    values = _kernel(r, s, (nearest - r) + step) * s * w * np.abs(end - nearest)
    moments[some] = np.einsum("pq,pqk->pk", values, legvander(x, k - 1))
    return moments
