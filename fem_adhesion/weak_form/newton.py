"""Newton's method, the determinant of its tangent, and where that changes its sign."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from fem_adhesion.weak_form.body import Array
from fem_adhesion.weak_form.contact import LENNARD_JONES, Contact
from halfspace.errors import NotConverged
from halfspace.values import Valued


@dataclass(frozen=True, eq=False, repr=False)
class Tangent(Valued):
    """How a contact yields to a small change of a state, with the law's straight line in the place of the law.

    Gaps h (q,) of the state are in eps, the slope (q,) there is sigma' in dgamma/eps^2, and the matrix is that of
    a(u, v) + mu^2 int sigma' u_z v_z dA, see `Body.softened`. The gaps' rate is dh/dalpha and the stiffness dW/dalpha
    in R dgamma/eps, along the equilibria.
    """

    gap: Array
    slope: Array
    matrix: Array
    gap_rate: Array
    stiffness: float

    @classmethod
    def at(cls, contact: Contact, h: Array, approach: float) -> Tangent:
        """Tangent of a contact at the gaps h."""
        body, mu, slope = contact.body, contact.tabor, contact.law.slope(h)
        matrix = body.softened(mu**2 * slope)
        gap_rate = -1 + mu**2 * body.softened_rise(matrix, slope)
        return cls(h, slope, matrix, gap_rate, contact.load_slope(slope * -gap_rate, approach))


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Valued):
    """A state of equilibrium of a contact: h at the points and alpha in eps, W in R dgamma, and a tangent nearby."""

    contact: Contact
    gap: Array
    approach: float
    load: float
    nearby: Tangent

    @cached_property
    def tangent(self) -> Tangent:
        """The tangent at the state itself; steps from state to state are too short for one nearby."""
        return Tangent.at(self.contact, self.gap, self.approach)

    @cached_property
    def determinant(self) -> tuple[float, float]:
        """Sign of that of the tangent, and the logarithm of its magnitude."""
        sign, magnitude = np.linalg.slogdet(self.tangent.matrix)
        return float(sign), float(magnitude)

    @property
    def unstable(self) -> int:
        """Number of directions in which the energy falls at this approach: negative eigenvalues of the tangent."""
        unit = np.sqrt(
            self.contact.body.surface.diagonal()
        )  # they keep their signs, and cells of any size their digits
        return int((np.linalg.eigvalsh(self.tangent.matrix / np.outer(unit, unit)) < 0).sum())

    @property
    def energy(self) -> float:
        """Potential energy in R dgamma eps, see `Contact.energy`."""
        return self.contact.energy(self.contact.displacement(self.gap), self.approach)

    @property
    def central_gap(self) -> float:
        """H(0) in eps: the displacement is even and smooth across the axis, as the profile need not be."""
        return float(even(self.contact.body.radii, self._displaced)(0.0)) - self.approach

    @property
    def ripple(self) -> float:
        """What gaps next to the axis have in eps that a polynomial of the radius squared has not.

        Or displacements, whichever have less: the gaps are smooth in contact, the displacements apart, where a profile
        need not be.
        """
        first = np.argsort(self.contact.body.radii)[:INNERMOST]
        x = self.contact.body.radii[first] ** 2
        fields = self.gap[first], self._displaced[first]
        return min(float(np.max(np.abs(f - np.polynomial.Polynomial.fit(x, f, 2)(x)))) for f in fields)

    @property
    def _displaced(self) -> Array:
        """What the points have come down in eps."""
        return self.gap - self.contact.gap(None, self.approach)

    @property
    def contact_radius(self) -> float:
        """Largest radius in beta at which the tension is largest; nan if there is none."""
        radii = even(self.contact.body.radii, self.gap - self.contact.law.edge).roots(extrapolate=False)
        return float(radii[-1]) if radii.size and radii[-1] > 0 else float("nan")

    def past(self, step: float, *, under_load: bool) -> Equilibrium:
        """Equilibrium a step in approach or load farther, from what the tangent nearby predicts."""
        near, load = self.nearby, None if under_load else self.load + step
        change = step if under_load else step / near.stiffness
        start = self.gap + change * near.gap_rate, self.approach + change
        return newton(self.contact, *start, load=load, tangent=near)


INNERMOST = 20  # points, those of about two cells


def even(radii: Array, values: Array) -> CubicSpline:
    """Spline through values at radii, and at these on the other side of the axis."""
    order = np.argsort(radii)
    r, f = radii[order], values[order]
    return CubicSpline(np.concatenate([-r[::-1], r]), np.concatenate([f[::-1], f]))


MOST_STEPS, NEAR = 20, 1e-9  # relative change of the gaps by one step more
KEPT = 0.2  # of the step before: one that is shorter may be followed by one along the same tangent


def newton(
    contact: Contact, h: Array, approach: float, *, load: float | None = None, tangent: Tangent | None = None
) -> Equilibrium:
    """Solve for the equilibrium at an approach, or at a load if one is given, from gaps nearby.

    Each step solves the problem with the law's straight line, sigma(h) + sigma' (h_new - h), in the place of the law.
    While each is much shorter than the one before, they keep its slope and with it the factors of the tangent, from
    that given on; none is kept any more as soon as a step is longer, as where the law ends by a step. NotConverged if
    the steps run out.
    """
    before: float | None = None
    kept = KEPT
    for _ in range(MOST_STEPS):
        if tangent is None:
            tangent, before = Tangent.at(contact, h, approach), 1.0  # its error falls as the square
        change, d = _step(contact, h, approach, load, tangent)
        size = contact.law.size(h)
        part = min(1.0, 0.75 / max(float((-change / size).max()), 0.75))  # lest the surfaces pass through each other
        h, approach, moved = h + part * change, approach + part * d, float(np.abs(change / size).max())
        contraction = KEPT if before is None else moved / before  # along the tangent given, a guess
        if moved * contraction < NEAR:
            return Equilibrium(contact, h, approach, contact.load(contact.law.tension(h), approach), tangent)
        kept = 0.0 if contraction > 1 else kept
        tangent, before = (tangent if contraction <= kept else None), moved
    raise NotConverged(f"no equilibrium in {MOST_STEPS} Newton steps of the weak form; try a nearer start")


def _step(contact: Contact, h: Array, approach: float, load: float | None, tangent: Tangent) -> tuple[Array, float]:
    """Changes of the gaps and of the approach towards the equilibrium at this approach, or at a load."""
    body, mu, tension = contact.body, contact.tabor, contact.law.tension(h)
    straight = tension + tangent.slope * (contact.gap(None, approach) - h)
    change = contact.gap(None, approach) - mu * body.softened_rise(tangent.matrix, mu * straight) - h
    missing = 0.0 if load is None else load - contact.load(tension + tangent.slope * change, approach)
    d = missing / tangent.stiffness
    return change + d * tangent.gap_rate, d


def from_afar(contact: Contact, far: float, approach: float) -> Equilibrium:
    """Equilibrium at an approach that is reached from undeformed surfaces at one far apart, by steps in approach.

    In each the gaps change by less than a part of them; NotConverged if that leads nowhere, as past a fold.
    """
    state = newton(contact, contact.gap(None, far), far)
    for _ in range(MOST_STEPS):
        left, rate = approach - state.approach, state.tangent.gap_rate
        part = OPENING / max(OPENING, float(np.max(np.abs(left * rate) / contact.law.size(state.gap))))
        if left == 0:
            return state
        state = newton(contact, state.gap + part * left * rate, approach if part == 1 else state.approach + part * left)
    raise NotConverged(f"no way from afar to alpha = {approach:.4g} eps in {MOST_STEPS} steps of the weak form")


OPENING = 0.3  # of each gap, what it may change by in a step of approach

# Turning points


@dataclass(frozen=True)
class Turn:
    """Where a determinant changes its sign: load in R dgamma, approach in eps."""

    load: float
    approach: float


FLAT, NEARBY = 1e-2, 2e-3  # first steps, of approach and load
FOLLOWED = 0.25  # of the grain of a law, what a gap may change by in one, or Newton's method may not follow
FARTHEST, TRIES = 50.0, 6  # the farthest in such steps, how many are tried


def turning_point(middle: Equilibrium, *, under_load: bool, finer: float = 1.0) -> Turn | None:
    """Where the equilibria near one turn, or None where they do not.

    Under fixed grips, at the fold of a jump, the determinant of the tangent changes its sign; that is passed at given
    loads. Under a dead load, at an extremum of the load, that of the tangent bordered by the load does, det A times
    dW/dalpha; it is passed at given approaches. Where they turn, the cubic through the states on either side does; it
    errs by a power of the steps, which may be that much finer.
    """
    # The extremum of the load is flat; along the load an edge moves by a spike's width soon.
    contact = middle.contact
    step = FLAT * min(1.0, contact.law.grain / LENNARD_JONES.grain) if under_load else NEARBY
    step *= (1 + abs(middle.approach if under_load else middle.load)) * min(1.0, 9 / contact.sharpness**2) / finer
    if under_load:  # past the edge of a contact that turns early gaps open much faster than the rest
        fastest = float(np.max(np.abs(middle.nearby.gap_rate) / contact.law.size(middle.gap)))
        step = min(step, FOLLOWED * contact.law.grain / fastest)
    a, b = (middle.past(d, under_load=under_load) for d in (-step, step))
    step = 2 * step
    for _ in range(TRIES):
        signs, logs = np.transpose([a.determinant, b.determinant])
        values = signs * np.exp(logs - logs[0]) * ([a.tangent.stiffness, b.tangent.stiffness] if under_load else 1.0)
        part = float(values[0] / (values[0] - values[1]))
        if 0 <= part <= 1:
            slopes = [(s, s.tangent.stiffness) for s in (a, b)]
            ends = [(s.load, k) if under_load else (s.approach, 1 / k) for s, k in slopes]
            part, turned = _extremum(step, *ends)
            place = (a.approach if under_load else a.load) + part * step
            return Turn(turned, place) if under_load else Turn(place, turned)
        if not abs(part) < FARTHEST:
            return None
        step *= 1.3 * part  # past the root
        b = a.past(step, under_load=under_load)
    return None


def _extremum(length: float, a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    """Part of a length at which the cubic with given values and slopes of opposite signs at its ends turns; its value.

    Of its derivative, A t^2 + 2 B t + C, the root between 0 and 1.
    """
    rise, first, second = b[0] - a[0], length * a[1], length * b[1]
    A, B, C = 3 * (first + second - 2 * rise), 3 * rise - 2 * first - second, first
    t = -C / (B + np.copysign(np.sqrt(B**2 - A * C), second - first))
    return float(t), float(a[0] + t * (C + t * (B + t * A / 3)))
