"""Closed theories on a cantilever: their curves as dense samples, on which states, jumps and losses are read off.

A theory's curve is one line from far separation to compression; it may leap, as from a branch that ends. Its samples
are an array (3, n) of approaches in eps, loads in R dgamma and contact radii in beta, nan where there is no contact.
The base of a cantilever of stiffness k stands at b = alpha* + W/k.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebfit, chebpts1, chebval
from scipy.interpolate import CubicSpline
from scipy.special import kv

from fem_adhesion.assess.settings import USUAL
from halfspace import atlas
from halfspace.elastic import grid
from halfspace.elastic.layers import LayeredBody, surface_compliance
from halfspace.roots import root
from halfspace.theories import closed_forms, curves
from halfspace.theories.closed_forms import ContactState
from halfspace.theories.layered import OnLayers
from halfspace.values import Array, Estimate

WIDEST = float(closed_forms.jkr_radius(USUAL.compressed))  # contact radius at which every theory is in compression


@dataclass(frozen=True)
class Loop:
    """A cycle on a curve: take-off and landing of both jumps, and the energy lost in R dgamma eps.

    The spacing is that of the samples at the take-offs, in eps: they may lie that far beside the true ones.
    """

    jump_on: tuple[ContactState, ContactState]
    jump_off: tuple[ContactState, ContactState]
    energy_lost: float
    spacing: float


# Curves


def sampling(tabor: float, stiffness: float) -> curves.Sampling:
    """Where curves are sampled: from a gap wider than any at which a jump off lands, which is (|W|/k - alpha*) at most.

    The stiffness k is in R dgamma/eps.
    """
    return curves.Sampling(10 + 4 * tabor + 10 / stiffness, WIDEST, USUAL.number)


def jkr_on(body: LayeredBody, tabor: float, how: curves.Sampling) -> Array:
    """JKR on a layered body, and before contact the far attraction as in `halfspace.theories.curves.attracted`.

    The contact is smooth in the root of its radius, by which it is interpolated. The attraction falls with the radius u
    as (1 + u^2/s^2)^-3, s^2 = 2 y/mu, whose waves k have the amplitude (k s)^2 K_2(k s) dk: the bulge is a half-space's
    times the mean of the layers' yield S(k) by these.
    """
    theory = OnLayers(body)
    what = "the widest contact; take a half-space"
    widest = root(lambda a: theory.jkr(a).load - USUAL.compressed, curves.SMALLEST, WIDEST, what)
    nodes = chebpts1(USUAL.nodes)
    states = [theory.jkr(widest * float(1 + x) ** 2 / 4) for x in nodes]
    through = chebfit(nodes, np.array([[state.approach, state.load] for state in states]), USUAL.nodes - 1)
    s = np.linspace(0.0, 1.0, how.number)
    approach, load = chebval(2 * s - 1, through)

    first, last = math.log(2 / tabor) / 2, math.log(2 * how.beyond / tabor) / 2
    widths = np.linspace(first, last, 100)  # the spline between them errs by less than 1e-4
    waves, weights = (part.ravel() for part in grid.gauss_points(np.array([0.0, 40.0]), 200))  # e^-40 is left out
    weights = weights * waves**2 * kv(2, waves)
    yields = surface_compliance(body, np.outer(np.exp(-widths), waves).ravel()).reshape(widths.size, -1) @ weights
    raised = CubicSpline(widths, yields / weights.sum())
    apart = curves.attracted(tabor, how, lambda y: raised(np.log(2 * y / tabor) / 2))
    return curves.joined(apart, np.stack([tabor * approach, load, widest * s**2]))


def far_end(curve: atlas.Curve) -> tuple[float, float]:
    """Separation 1 - alpha* in eps where a curve of the atlas begins, and the part of the load there by the bulge."""
    end = curve.states(places=np.zeros(1))
    s = 1 - float(end.approach[0])
    return s, -float(end.load[0]) * s**2 * 3 / (8 * np.pi) - 1


def half_space(tabor: float, stiffness: float, number: int = USUAL.sampled) -> Array:
    """Paraboloid on the half-space by the atlas, 0.01 <= tabor <= 300, with samples close to where the base turns.

    Farther than the atlas goes, with s = 1 - alpha*, the load is -(8 pi/3) s^-2 (1 + c s^-7/2): the attraction of the
    undeformed gap and the first order of the bulge that it raises, whose c is that of `far_end`.
    """
    curve = atlas.curve(tabor)
    last = curve.ends.size - 1
    s0, bulge = far_end(curve)
    decades = math.log10(max(sampling(tabor, stiffness).beyond / s0, 10.0))

    def sampled(places: Array) -> Array:
        """Samples at places on the curve, which are negative farther away: -1 a decade."""
        near, s = curve.states(places=places[places >= 0]), s0 * 10.0 ** -places[places < 0]
        far = curves.apart(1 - s, -8 * np.pi / 3 * s**-2 * (1 + bulge * (s / s0) ** -3.5))
        return np.concatenate([far, np.stack([near.approach, near.load, near.contact_radius])], axis=1)

    places = np.concatenate([np.linspace(-decades, 0, number, endpoint=False), np.linspace(0, last, number)])
    found = sampled(places)
    for _ in range(USUAL.zooms):
        rises = np.diff(found[0] + found[1] / stiffness)
        turns = np.flatnonzero(rises[:-1] * rises[1:] < 0)
        beside = (i + j for i in (*turns[:1], *turns[-1:]) for j in (0, 1))  # no place twice: rounding is no turn
        added = [np.linspace(places[i], places[i + 1], USUAL.zoomed)[1:-1] for i in dict.fromkeys(beside)]
        new, order = np.unique(np.concatenate([places, *added]), return_index=True)
        found = np.concatenate([found, *(sampled(part) for part in added)], axis=1)[:, order]
        places = new
    return found


# What is read off


def estimated(curve: Array, quantity: Callable[[Array], float]) -> Estimate:
    """Number read off a curve, its error taken to be its change from half the samples."""
    value = quantity(curve)
    return Estimate(value, abs(value - quantity(curve[:, ::2])) + 1e-12 * abs(value))


def pull_off(curve: Array) -> ContactState:
    """State of least load."""
    return ContactState(*curve[:, np.argmin(curve[1])].tolist())


def zero_load(curve: Array) -> ContactState:
    """State in contact that bears no load."""
    return _rising(curve, curve[1], 0.0)


def _rising(curve: Array, quantity: Array, value: float) -> ContactState:
    """State where a quantity of the samples last rises through a value; linear in between."""
    i = int(np.flatnonzero((quantity[:-1] <= value) & (quantity[1:] > value))[-1])
    t = (value - quantity[i]) / (quantity[i + 1] - quantity[i])
    return ContactState(*((1 - t) * curve[:, i] + t * curve[:, i + 1]).tolist())


def loop(curve: Array, stiffness: float) -> Loop | None:
    """Cycle on a cantilever of a stiffness in R dgamma/eps, or None where the contact follows it smoothly."""
    approach, load, _ = curve
    base = approach + load / stiffness
    falls = np.diff(base) < 0
    tops = np.flatnonzero(~falls[:-1] & falls[1:]) + 1
    bottoms = np.flatnonzero(falls[:-1] & ~falls[1:]) + 1
    if not tops.size:
        return None
    on, off = int(tops[0]), int(bottoms[-1])
    apart, contact = slice(on + 1), slice(off, None)
    landed = _rising(curve[:, contact], base[contact], base[on])
    parted = _rising(curve[:, apart], base[apart], base[off])
    ends = float(base[off]), float(base[on])
    lost = _work(base[apart], load[apart], *ends) - _work(base[contact], load[contact], *ends)
    spacing = float(np.max(np.abs(np.diff(approach)[[on - 1, off]])))
    took_off, left = (ContactState(*curve[:, at].tolist()) for at in (on, off))
    return Loop((took_off, landed), (left, parted), lost, spacing)


def _work(base: Array, load: Array, low: float, high: float) -> float:
    """Integral of W db between two bases along a branch on which the base rises."""
    b = np.concatenate([[low], base[(base > low) & (base < high)], [high]])
    return float(np.trapezoid(np.interp(b, base, load), b))
