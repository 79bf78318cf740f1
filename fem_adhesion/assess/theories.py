"""Closed theories on a cantilever: their curves as dense samples, on which states, jumps and losses are read off.

A theory's curve is one line from far separation to compression; it may leap, as from a branch that ends. The base of a
cantilever of stiffness k stands at b = alpha* + W/k. Loads in R dgamma, approaches in eps, radii in beta.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebfit, chebpts1, chebval

from halfspace.elastic.layers import LayeredBody
from halfspace.roots import root
from halfspace.theories import closed_forms, dmt
from halfspace.theories.closed_forms import ContactState
from halfspace.theories.layered import OnLayers
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array, Estimate, Valued

REACH = 3 * math.pi**2 / (2.5 * 1.4**3.5)  # in the bulge of `jkr_with_reach`, so that the fit of [G97] App. C comes out


@dataclass(frozen=True)
class Samples:
    """How the curves of theories are sampled."""

    number: int = 100_001  # of each stretch; odd, so that every second sample has the same ends
    nodes: int = 48  # of the polynomial through JKR's theory on layers
    compressed: float = 2.0  # load to which the curves go
    pressed: float = 0.25  # approach to which a rigid sphere's curve goes; it bears no load at 0.206
    rounded: float = 1e-3  # root of the contact radius below which Maugis's approach is a sum of rounding errors
    smallest: float = 1e-4  # of the coordinate along a stretch


SAMPLES = Samples()


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Valued):
    """Samples along the curve of a theory, each array of shape (n,).

    Approach in eps, load in R dgamma, and contact radius in beta, nan where there is none.
    """

    approach: Array
    load: Array
    radius: Array

    @classmethod
    def apart(cls, approach: Array, load: Array) -> Curve:
        """Stretch without contact."""
        return cls(approach, load, np.full_like(load, np.nan))

    def then(self, other: Curve) -> Curve:
        """Curve that goes on with another, whose first sample repeats this one's last or lies across a leap."""
        return Curve(*(np.append(a, b[1:]) for a, b in zip(self.columns, other.columns, strict=True)))

    def part(self, samples: slice) -> Curve:
        """Some of the samples."""
        return Curve(*(column[samples] for column in self.columns))

    def state(self, index: int) -> ContactState:
        """State at a sample."""
        return ContactState(*(float(column[index]) for column in self.columns))

    def state_where(self, quantity: Array, value: float) -> ContactState:
        """State where a quantity of the samples last rises through a value; linear in between."""
        i = int(np.flatnonzero((quantity[:-1] <= value) & (quantity[1:] > value))[-1])
        t = (value - quantity[i]) / (quantity[i + 1] - quantity[i])
        return ContactState(*(float((1 - t) * column[i] + t * column[i + 1]) for column in self.columns))

    @property
    def columns(self) -> tuple[Array, Array, Array]:
        """Approach, load and radius."""
        return self.approach, self.load, self.radius


@dataclass(frozen=True)
class Loop:
    """A cycle on a curve: take-off and landing of both jumps, and the energy lost in R dgamma eps.

    The spacing is that of the samples at the take-offs, in eps: they may lie that far beside the true ones.
    """

    jump_on: tuple[ContactState, ContactState]
    jump_off: tuple[ContactState, ContactState]
    energy_lost: float
    spacing: float


def bradley(tabor: float, stiffness: float) -> Curve:
    """Rigid sphere, [G97] (1.3), at any Tabor parameter."""
    del tabor
    return _rigid(stiffness, SAMPLES.pressed)


def dmt_maugis(tabor: float, stiffness: float) -> Curve:
    """Rigid until it touches, then after Hertz with a constant tension, [G97] (4.2b)."""
    a = np.linspace(0.0, float(closed_forms.hertz_radius(SAMPLES.compressed + 2 * np.pi)), SAMPLES.number)
    alpha = closed_forms.hertz_approach(a, tabor)
    return _rigid(stiffness, 0.0).then(Curve(alpha, dmt.maugis_load(alpha, tabor), a))


def jkr(tabor: float, stiffness: float) -> Curve:
    """JKR: no attraction before contact."""
    return _free(tabor, stiffness, 0.0).then(_jkr_contact(tabor))


def jkr_with_reach(tabor: float, stiffness: float) -> Curve:
    """JKR in contact; before it the far attraction and the bulge that it raises. Fit for large Tabor parameters.

    With y = h0/eps the gap at the pole, B mu^(3/2) y^(-5/2) is the bulge, as in `halfspace.theories.criteria`, and

        alpha* = 1 - y - B mu^(3/2) y^(-5/2),    W = -(8 pi/3) y^-2.

    B makes the jump under fixed grips that of [G97]'s fit, (|alpha*| + 1)^(7/2) = 3 pi^2 mu^(3/2).
    """
    bulge = REACH * tabor**1.5
    past_the_jump = 0.5 * (2.5 * bulge) ** (2 / 7)
    y = np.geomspace(_beyond(tabor, stiffness), past_the_jump, SAMPLES.number)
    return Curve.apart(1 - y - bulge * y**-2.5, -8 * np.pi / 3 * y**-2).then(_jkr_contact(tabor))


def maugis_dugdale(tabor: float, stiffness: float) -> Curve:
    """Maugis-Dugdale with the largest tension of the Lennard-Jones law."""
    theory = MaugisDugdale.matched(tabor)
    c = theory.touching_radius * np.linspace(0.0, 1.0, SAMPLES.number)
    disc = Curve.apart(theory.separated_approach(c), theory.separated_load(c))
    a = _widest() * np.linspace(SAMPLES.rounded, 1.0, SAMPLES.number) ** 2
    contact = Curve(theory.approach(a), theory.load(a), a)
    return _free(tabor, stiffness, float(disc.approach[0])).then(disc).then(contact)


def jkr_on(body: LayeredBody, tabor: float, stiffness: float) -> Curve:
    """JKR on a layered body; the contact is smooth in the root of its radius, by which it is interpolated."""
    theory = OnLayers(body)
    what = "the widest contact; take a half-space"
    widest = root(lambda a: theory.jkr(a).load - SAMPLES.compressed, SAMPLES.smallest, _widest(), what)
    nodes = chebpts1(SAMPLES.nodes)
    states = [theory.jkr(widest * float(1 + x) ** 2 / 4) for x in nodes]
    through = chebfit(nodes, np.array([[state.approach, state.load] for state in states]), SAMPLES.nodes - 1)
    s = np.linspace(0.0, 1.0, SAMPLES.number)
    approach, load = chebval(2 * s - 1, through)
    return _free(tabor, stiffness, 0.0).then(Curve(tabor * approach, load, widest * s**2))


def _jkr_contact(tabor: float) -> Curve:
    """Contact branch from a point contact on."""
    a = _widest() * np.linspace(0.0, 1.0, SAMPLES.number) ** 2
    return Curve(closed_forms.jkr_approach(a, tabor), closed_forms.jkr_load(a), a)


def _widest() -> float:
    """Contact radius at which every theory is in compression."""
    return float(closed_forms.jkr_radius(SAMPLES.compressed))


def _beyond(tabor: float, stiffness: float) -> float:
    """Gap wider than any at which a jump off lands, which is (|W|/k - alpha*) at most."""
    return 10 + 4 * tabor + 10 / stiffness


def _free(tabor: float, stiffness: float, last: float) -> Curve:
    """Approach without attraction up to a value."""
    approach = _towards(last, _beyond(tabor, stiffness))
    return Curve.apart(approach, np.zeros(SAMPLES.number))


def _rigid(stiffness: float, last: float) -> Curve:
    """Rigid sphere up to an approach."""
    approach = _towards(last, _beyond(0.0, stiffness))
    return Curve.apart(approach, closed_forms.bradley_load(approach))


def _towards(last: float, distance: float) -> Array:
    """Approaches from afar to a value, the closer the nearer to it."""
    approach = last - np.geomspace(distance, SAMPLES.smallest, SAMPLES.number)
    approach[-1] = last
    return np.asarray(approach)


def estimated(curve: Curve, quantity: Callable[[Curve], float]) -> Estimate:
    """Number read off a curve, its error taken to be its change from half the samples."""
    value = quantity(curve)
    return Estimate(value, abs(value - quantity(half(curve))) + 1e-12 * abs(value))


def half(curve: Curve) -> Curve:
    """Every other sample."""
    return curve.part(slice(None, None, 2))


def pull_off(curve: Curve) -> ContactState:
    """State of least load."""
    return curve.state(int(np.argmin(curve.load)))


def zero_load(curve: Curve) -> ContactState:
    """State in contact that bears no load."""
    return curve.state_where(curve.load, 0.0)


def loop(curve: Curve, stiffness: float) -> Loop | None:
    """Cycle on a cantilever of a stiffness in R dgamma/eps, or None where the contact follows it smoothly."""
    base = curve.approach + curve.load / stiffness
    falls = np.diff(base) < 0
    tops = np.flatnonzero(~falls[:-1] & falls[1:]) + 1
    bottoms = np.flatnonzero(falls[:-1] & ~falls[1:]) + 1
    if not tops.size:
        return None
    on, off = int(tops[0]), int(bottoms[-1])
    apart, contact = curve.part(slice(on + 1)), curve.part(slice(off, None))
    landed = contact.state_where(base[off:], base[on])
    parted = apart.state_where(base[: on + 1], base[off])
    ends = float(base[off]), float(base[on])
    lost = _work(apart, base[: on + 1], *ends) - _work(contact, base[off:], *ends)
    spacing = float(np.max(np.abs(np.diff(curve.approach)[[on - 1, off]])))
    return Loop((curve.state(on), landed), (curve.state(off), parted), lost, spacing)


def _work(branch: Curve, base: Array, low: float, high: float) -> float:
    """Integral of W db between two bases along a branch on which the base rises."""
    inside = base[(base > low) & (base < high)]
    b = np.concatenate([[low], inside, [high]])
    return float(np.trapezoid(np.interp(b, base, branch.load), b))
