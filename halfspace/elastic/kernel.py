"""Ring kernel of the elastic half-space and its integrals over bands and polynomial panels.

A ring of pressure p at radius s deflects the surface at radius r by (1/E*) p G(r, s) s ds. G is homogeneous
of degree -1 and has a logarithmic singularity at r = s. It is integrated by Gauss's rule where the target
is at least a quarter of the panel's length away, and else by Gauss's rule in t after s - e = l t^q, e being the
panel's point nearest to the target: the powers of t smother the logarithm, on the panel or just off it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.special import ellipe, ellipkm1, elliprd, elliprf

from halfspace.elastic.grid import gauss_legendre
from halfspace.errors import GridTooLarge
from halfspace.values import Array


@dataclass(frozen=True)
class RingRules:
    """Rules by which a ring's kernel is integrated over panels of up to 16 nodes.

    From so many panel lengths away, the first of ``far``, Gauss's rule serves with so many points, the second, and half
    as many as a panel has nodes. These leave 3e-14 of polynomials; the graded rule, next to the target, is then a
    decade worse. As many bytes as ``largest`` are made at once. Of the integrals on one grid there are eight at a time,
    as the solver's matrices and what they are made from: 3137 triangles take 0.73 GB, 5041 took 1.76 GB, and 1 GB is
    what a computation may take.
    """

    near: tuple[int, int] = (48, 7)  # points and power q of the rule near a target: they leave 5e-13
    far: tuple[tuple[float, int], ...] = ((0.25, 16), (1.0, 8))
    batch: int = 2_000_000  # points at which the kernel is evaluated at a time: 16 MB an array
    largest: float = 1.25e8  # bytes of the integrals made at once


RULES = RingRules()

# Deflection at x by unit pressure on a ring at y, by y: of x, y and |y - x|, which are broadcast. Both are radii, or in
# the coordinate in which the pressure of a panel is a polynomial.
Ring = Callable[[Array, Array, Array], Array]


def ring_kernel(r: Array, s: Array) -> Array:
    """Deflection at radius r by a ring of unit pressure times radius at s: G = 4/(pi max) K(min/max), [G97] (2.4)."""
    return _kernel(r, s, np.abs(s - r))


def _kernel(r: Array, s: Array, distance: Array) -> Array:
    """G(r, s) by Landen's K(2 sqrt(r s)/(r + s)), given |s - r|: 1 - k^2 must not be formed by cancellation."""
    both = r + s
    return np.asarray(4 / np.pi / both * ellipkm1((distance / both) ** 2))


def flat_ring(r: Array, s: Array, distance: Array) -> Array:
    """Deflection at r by unit pressure on a ring at s, by s: G(r, s) s."""
    return np.asarray(_kernel(r, s, distance) * s)


def stereographic_ring(R: float) -> Ring:
    """Return the same under a sphere of radius R by the coordinate x = 2 R tan(theta/2), r = x/(1 + x^2/4R^2).

    Its gap is smooth in it, and s - r = (y - x)(1 - x y/4R^2)/[(1 + x^2/4R^2)(1 + y^2/4R^2)].
    """
    if np.isinf(R):
        return flat_ring
    k = 1 / (4 * R**2)

    def ring(x: Array, y: Array, distance: Array) -> Array:
        p, q = 1 + k * x**2, 1 + k * y**2
        s = y / q
        return np.asarray(_kernel(x / p, s, distance * (1 - k * x * y) / (p * q)) * (s * (2 - q) / q**2))

    return ring


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


def require_room(nodes: int, integrals: int) -> None:
    """Raise GridTooLarge if so many integrals for each node of some grids take more memory than they may."""
    require_memory(8 * nodes * integrals, RULES.largest, f"{nodes} nodes, whose integrals")


def require_memory(size: int, most: float, whose: str) -> None:
    """Raise GridTooLarge if what is named takes more bytes than it may."""
    if size > most:
        raise GridTooLarge(f"{whose} take {size / 1e9:.2g} GB, limit: {most / 1e9:.3g} GB")


def panel_integrals(targets: Array, breakpoints: Array, nodes: Array, ring: Ring = flat_ring) -> Array:
    """Integrate G(r_i, s) s l(s) over each panel for each Lagrange polynomial l of the panel's nodes.

    The targets (..., n) are the radii r_i >= 0 at which the deflection is wanted, anywhere on or off the panels, whose
    ends, the breakpoints (..., m + 1), ascend from at least 0; the nodes (k,) are those of a panel on [-1, 1]. The
    deflection (..., n, m, k) at r_i (E* = 1) is by the pressure l_k on panel j, to an absolute accuracy of 1e-12 of the
    panel's scale. By another ring all radii are in its coordinate.
    """
    targets = np.asarray(targets, float)
    require_room(targets.size, (breakpoints.shape[-1] - 1) * nodes.size)
    ends = breakpoints[..., None, :-1], breakpoints[..., None, 1:]
    pairs = np.broadcast_arrays(targets[..., None], *ends)
    shape, batches = pairs[0].shape, -(-pairs[0].size * _points(RULES.far[-1][1], nodes.size) // RULES.batch)
    some = zip(*(np.array_split(part.ravel(), batches) for part in pairs), strict=True)
    moments = np.concatenate([_moments(ring, r, left, right, nodes.size) for r, left, right in some])
    return of_lagrange(moments, nodes).reshape(*shape, nodes.size)


def before_equator(targets: Array, lines: Array, nodes: Array, R: float) -> Array:
    """Integrals (..., k, k) as of `panel_integrals` by the stereographic ring over the last panel, at its own nodes.

    The targets (..., k) are these, the lines (..., m + 1) the ends of all panels. A target and its mirror image beyond
    the equator have the same radius: what is between is cut into halves, the rule of the one from the target on, of the
    other from the equator.
    """
    ring, k, rule = stereographic_ring(R), nodes.size, RULES.near
    t, polynomials = _graded_polynomials(*rule, k)
    shape, (left, right) = targets.shape, (np.repeat(lines[..., end], k) for end in (-2, -1))
    targets = targets.ravel()
    middle = (targets + right) / 2
    y = right[:, None] - (right - middle)[:, None] * t
    last = ring(targets[:, None], y, y - targets[:, None]) @ polynomials * (right - middle)[:, None]
    last[:, 1::2] *= -1  # odd polynomials, seen from the right end
    first = (off_moments(ring, targets, *ends, k, rule) for ends in ((left, targets), (targets, middle)))
    cut = np.tile((1 + nodes) / 2, targets.size // k)
    parts = [_of_a_part(*between, k) for between in pairwise([0 * cut, cut, (1 + cut) / 2, 1 + 0 * cut])]
    return of_lagrange(_of_parts([*first, last], parts), nodes).reshape(*shape, k)


def of_lagrange(moments: Array, nodes: Array) -> Array:
    """Integrals against Lagrange's polynomials of some nodes from those against Legendre's, (n, k)."""
    return np.asarray(moments @ _to_lagrange(nodes.tobytes()))


@cache
def _to_lagrange(nodes: bytes) -> Array:
    x = np.frombuffer(nodes)
    return np.asarray(np.linalg.inv(legvander(x, x.size - 1)))


def _moments(ring: Ring, r: Array, left: Array, right: Array, k: int) -> Array:
    """Integrals of G(r, s) s against the first k Legendre polynomials of a panel for each target, (n, k)."""
    distance = np.searchsorted([least for least, _ in RULES.far], np.maximum(left - r, r - right) / (right - left))
    moments = np.empty((r.size, k))
    for i in range(len(RULES.far) + 1):
        some = np.flatnonzero(distance == i)
        integrals, rule = (off_moments, (_points(RULES.far[i - 1][1], k), 1)) if i else (near_moments, RULES.near)
        moments[some] = integrals(ring, r[some], left[some], right[some], k, rule)
    return moments


def _points(least: int, nodes: int) -> int:
    return least + nodes // 2


def near_moments(ring: Ring, r: Array, left: Array, right: Array, k: int, rule: tuple[int, int]) -> Array:
    """Integrate a ring against the first k Legendre polynomials of a panel for each target, on the panel or off it.

    A panel with the target r (n,) on it is cut in two there. The rule is as of `_graded_polynomials`, from the target
    on, or the end of the panel next to it. Return (..., n, k), with the leading axes that the ring's values have.
    """
    on = (left < r) & (r < right)
    off = off_moments(ring, r[~on], left[~on], right[~on], k, rule)
    moments = np.empty((*off.shape[:-2], r.size, k))
    moments[..., ~on, :] = off
    r, left, right = r[on], left[on], right[on]
    parts = [off_moments(ring, r, left, r, k, rule), off_moments(ring, r, r, right, k, rule)]
    cuts = (r - left) / (right - left)
    moments[..., on, :] = _of_parts(parts, [_of_a_part(0 * cuts, cuts, k), _of_a_part(cuts, 1 + 0 * cuts, k)])
    return moments


def _of_parts(moments: Sequence[Array], polynomials: Sequence[Array]) -> Array:
    """Moments of a panel (..., n, k) from those of its parts, by its polynomials in theirs, (n, k, k) each."""
    return np.asarray(sum(np.einsum("...nk,nkl->...nl", *part) for part in zip(moments, polynomials, strict=True)))


def off_moments(ring: Ring, r: Array, left: Array, right: Array, k: int, rule: tuple[int, int]) -> Array:
    """Moments as of `near_moments` on panels that have none of the targets within."""
    t, polynomials = _graded_polynomials(*rule, k)
    above = r <= left
    end, inwards = np.where(above, left, right), np.where(above, right - left, left - right)
    s = end[:, None] + inwards[:, None] * t
    values = ring(r[:, None], s, np.abs(end - r)[:, None] + np.abs(inwards)[:, None] * t)
    moments = values @ polynomials * np.abs(inwards)[:, None]
    moments[..., ~above, 1::2] *= -1  # odd polynomials, seen from the right end
    return np.asarray(moments)


@cache
def _graded_polynomials(points: int, q: int, k: int) -> tuple[Array, Array]:
    """Points (n,) on (0, 1) of a graded rule, and its weights times the first k Legendre polynomials there, (n, k).

    The rule is for integrands with a logarithm at, or just below, 0.
    """
    x, w = gauss_legendre(points)
    t = (1 + x) / 2
    places, weights = t**q, w / 2 * q * t ** (q - 1)
    return places, weights[:, None] * legvander(2 * places - 1, k - 1)


def _of_a_part(first: Array, last: Array, k: int) -> Array:
    """Legendre polynomials of (0, 1), the last axis of (n, k, k), by those of a part between two places (n,)."""
    x, w = gauss_legendre(k)
    there = legvander((first + last)[:, None] - 1 + (last - first)[:, None] * x, k - 1)
    own = (np.arange(k) + 0.5)[:, None] * legvander(x, k - 1).T * w
    return np.asarray(own @ there)
