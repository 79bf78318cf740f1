"""Whole curves of closed theories as samples, each one line from far separation to compression.

A curve is an array (3, n) of approaches in eps, loads in R dgamma and contact radii in beta, nan where there is no
contact. It may leap, as from a branch that ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from halfspace.theories import closed_forms, dmt
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array

REACH = 3 * math.pi**2 / (2.5 * 1.4**3.5)  # in the bulge of `attracted`, so that the fit of [G97] App. C comes out
TOUCHING = 0.25  # approach to which a rigid sphere's curve goes; it bears no load at 0.206
ROUNDED = 1e-3  # root of the contact radius below which Maugis's approach is a sum of rounding errors
SMALLEST = 1e-4  # distance in eps of the last sample but one before a stretch ends


@dataclass(frozen=True)
class Sampling:
    """Where curves are sampled: from a gap in eps, to a contact radius in beta, and on how many places a stretch."""

    beyond: float
    widest: float
    number: int


def bradley(how: Sampling) -> Array:
    """Rigid sphere, [G97] (1.3), at any Tabor parameter."""
    return far(TOUCHING, how, closed_forms.bradley_load)


def dmt_maugis(tabor: float, how: Sampling) -> Array:
    """Rigid until it touches, then after Hertz with a constant tension, [G97] (4.2b)."""
    a = _radii(how)
    alpha = closed_forms.hertz_approach(a, tabor)
    return joined(far(0.0, how, closed_forms.bradley_load), np.stack([alpha, dmt.maugis_load(alpha, tabor), a]))


def jkr(tabor: float, how: Sampling) -> Array:
    """JKR: no attraction before contact."""
    return joined(far(0.0, how), _jkr_contact(tabor, how))


def jkr_with_reach(tabor: float, how: Sampling) -> Array:
    """JKR in contact, and before it the far attraction, see `attracted`. Fit for large Tabor parameters."""
    return joined(attracted(tabor, how), _jkr_contact(tabor, how))


def maugis_dugdale(tabor: float, how: Sampling) -> Array:
    """Maugis-Dugdale with the largest tension of the Lennard-Jones law."""
    theory = MaugisDugdale.matched(tabor)
    c, a = theory.touching_radius * np.linspace(0.0, 1.0, how.number), _radii(how, ROUNDED)
    disc = apart(theory.separated_approach(c), theory.separated_load(c))
    return joined(far(float(disc[0, 0]), how), disc, np.stack([theory.approach(a), theory.load(a), a]))


def _jkr_contact(tabor: float, how: Sampling) -> Array:
    a = _radii(how)
    return np.stack([closed_forms.jkr_approach(a, tabor), closed_forms.jkr_load(a), a])


def _radii(how: Sampling, first: float = 0.0) -> Array:
    """Contact radii, the closer the smaller they are."""
    return how.widest * np.linspace(first, 1.0, how.number) ** 2


def attracted(tabor: float, how: Sampling, raised: Callable[[Array], Array] = np.ones_like) -> Array:
    """Stretch from afar to past its fold: the attraction, and the bulge of the body that it raises.

    With y = h0/eps the gap at the pole, B mu^(3/2) y^(-5/2) is the bulge of a half-space, as in
    `halfspace.theories.criteria`; `raised` is that of another body over it, at gaps in eps. Then

        alpha* = 1 - y - B mu^(3/2) y^(-5/2),    W = -(8 pi/3) y^-2.

    B makes the jump under fixed grips that of [G97]'s fit, (|alpha*| + 1)^(7/2) = 3 pi^2 mu^(3/2).
    """
    y = np.geomspace(how.beyond, 1.0, how.number)
    approach = 1 - y - REACH * tabor**1.5 * raised(y) * y**-2.5
    kept = y > 0.5 * y[np.argmax(approach)]
    return apart(approach[kept], -8 * np.pi / 3 * y[kept] ** -2)


def far(last: float, how: Sampling, load: Callable[[Array], Array] = np.zeros_like) -> Array:
    """Stretch from afar up to an approach, the closer the nearer to it; without attraction unless a load is given."""
    approach = last - np.geomspace(how.beyond, SMALLEST, how.number)
    approach[-1] = last
    return apart(approach, load(approach))


def apart(approach: Array, load: Array) -> Array:
    """Stretch without contact."""
    return np.stack([approach, load, np.full_like(load, np.nan)])


def joined(first: Array, *others: Array) -> Array:
    """Curve of stretches, each of which begins with the last sample of the one before, or across a leap from it."""
    return np.concatenate([first, *(stretch[:, 1:] for stretch in others)], axis=1)
