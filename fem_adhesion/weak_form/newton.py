"""Newton's method, the determinant of its tangent, and where that changes its sign."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fem_adhesion.weak_form.body import Array, factorise
from fem_adhesion.weak_form.contact import LENNARD_JONES, Contact
from halfspace.errors import NotConverged
from halfspace.values import Valued


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Valued):
    """A state of equilibrium.

    Attributes
    ----------
    gap, approach, load
        h at the points and alpha in eps, W in R dgamma.
    gap_rate, stiffness
        dh/dalpha, and dW/dalpha in R dgamma/eps, along the equilibria.
    sign, log : float
        Of the tangent's determinant, and the logarithm of its magnitude.
    """

    gap: Array
    approach: float
    load: float
    gap_rate: Array
    stiffness: float
    sign: float
    log: float


MOST_STEPS, NEAR = 20, 1e-5  # relative change of the gaps by the last step; the next would be far less
KEPT = 1e-4  # and that by a step after which the next may keep the tangent


def newton(contact: Contact, h: Array, approach: float, *, load: float | None = None) -> Equilibrium:
    """Solve for the equilibrium at an approach, or at a load if one is given, from gaps nearby.

    Each step solves the problem with the law's straight line, sigma(h) + sigma' (h_new - h), in the place of the law;
    the last ones, close to the solution, keep its slope and with it the factors of the tangent.

    Raises
    ------
    NotConverged
        If the steps run out.
    """
    body, mu, law, moved = contact.body, contact.tabor, contact.law, np.inf
    for _ in range(MOST_STEPS):
        if moved > KEPT:
            slope = law.slope(h)
            factors = factorise(body.softened(mu**2 * slope))
            gap_rate = -1 + mu**2 * body.rise(factors.solve(body.forces(slope)))
            stiffness = contact.load_slope(slope * -gap_rate, approach)
        tension, size = law.tension(h), law.size(h)
        u = factors.solve(mu * body.forces(tension + slope * (contact.gap(None, approach) - h)))
        change = contact.gap(u, approach) - h
        missing = 0.0 if load is None else load - contact.load(tension + slope * change, approach)
        d = missing / stiffness
        change += d * gap_rate
        part = min(1.0, 0.75 / max(float((-change / size).max()), 0.75))  # lest the surfaces pass through each other
        h, approach, moved = h + part * change, approach + part * d, float(np.abs(change / size).max())
        if moved < NEAR:
            found = contact.load(law.tension(h), approach)
            return Equilibrium(h, approach, found, gap_rate, stiffness, *determinant(factors))
    raise NotConverged(f"no equilibrium in {MOST_STEPS} Newton steps of the weak form; try a nearer start")


# The determinant


def determinant(factors: Any) -> tuple[float, float]:
    """Sign of a determinant, and the logarithm of its magnitude, from the factors L U of the permuted matrix."""
    pivots = factors.U.diagonal()
    sign = np.prod(np.sign(pivots)) * _parity(factors.perm_r) * _parity(factors.perm_c)
    return float(sign), float(np.log(np.abs(pivots)).sum())


def _parity(permutation: NDArray[np.int32]) -> int:
    """1 if a permutation is an even number of exchanges, -1 if odd: it has as many as it is short of cycles."""
    size = permutation.size
    links = sparse.csr_array((np.ones(size), (np.arange(size), permutation)), shape=(size, size))
    cycles, _ = connected_components(links)
    return 1 if (size - int(cycles)) % 2 == 0 else -1


# Turning points


@dataclass(frozen=True)
class Turn:
    """Where a determinant changes its sign: load in R dgamma, approach in eps."""

    load: float
    approach: float


FLAT, NEARBY = 1e-2, 2e-3  # first steps, of approach and load
FARTHEST, TRIES = 50.0, 6  # the farthest in such steps, how many are tried


def turning_point(
    contact: Contact, h: Array, approach: float, load: float, *, under_load: bool, finer: float = 1.0
) -> Turn | None:
    """Where the equilibria near a state turn, or None where they do not.

    Under fixed grips, at the fold of a jump, the determinant of the tangent changes its sign; that is passed at given
    loads. Under a dead load, at an extremum of the load, that of the tangent bordered by the load does, det A times
    dW/dalpha; it is passed at given approaches. Where they turn, the cubic through the states on either side does; it
    errs by a power of the steps, which may be that much finer.
    """
    at = partial(_at, contact, under_load=under_load)
    place = approach if under_load else load
    # The extremum of the load is flat; along the load an edge moves by a spike's width soon.
    step = FLAT * min(1.0, contact.law.grain / LENNARD_JONES.grain) if under_load else NEARBY
    step *= (1 + abs(place)) * min(1.0, 9 / contact.sharpness**2) / finer
    middle = at(place, h, approach)
    a, b = (at(place + d, *_predicted(middle, d, under_load=under_load)) for d in (-step, step))
    place, step = place - step, 2 * step
    for _ in range(TRIES):
        values = [state.sign * np.exp(state.log - a.log) * (state.stiffness if under_load else 1) for state in (a, b)]
        part = float(values[0] / (values[0] - values[1]))
        if 0 <= part <= 1:
            ends = [(s.load, s.stiffness) if under_load else (s.approach, 1 / s.stiffness) for s in (a, b)]
            part, turned = _extremum(step, *ends)
            place += part * step
            return Turn(turned, place) if under_load else Turn(place, turned)
        if not abs(part) < FARTHEST:
            return None
        step *= 1.3 * part  # past the root
        b = at(place + step, *_predicted(a, step, under_load=under_load))
    return None


def _at(contact: Contact, place: float, h: Array, approach: float, *, under_load: bool) -> Equilibrium:
    """Equilibrium at an approach or a load, from gaps and an approach nearby."""
    return newton(contact, h, place) if under_load else newton(contact, h, approach, load=place)


def _predicted(state: Equilibrium, step: float, *, under_load: bool) -> tuple[Array, float]:
    """Gaps and approach a step in approach or load from a state, along the tangent."""
    change = step if under_load else step / state.stiffness
    return state.gap + change * state.gap_rate, state.approach + change


def _extremum(length: float, a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    """Part of a length at which the cubic with given values and slopes of opposite signs at its ends turns; its value.

    Of its derivative, A t^2 + 2 B t + C, the root between 0 and 1.
    """
    rise, first, second = b[0] - a[0], length * a[1], length * b[1]
    A, B, C = 3 * (first + second - 2 * rise), 3 * rise - 2 * first - second, first
    t = -C / (B + np.copysign(np.sqrt(B**2 - A * C), second - first))
    return float(t), float(a[0] + t * (C + t * (B + t * A / 3)))
