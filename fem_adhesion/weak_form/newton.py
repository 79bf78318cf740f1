"""Newton's method with a border, the equilibria that it finds, and where these turn.

A state y (q + 1,) has the gaps h at the points in eps and, last, the approach alpha.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import BarycentricInterpolator, CubicSpline
from scipy.optimize import newton as secant

from fem_adhesion.weak_form.body import Array, Body, last
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.settings import USUAL
from halfspace.errors import NotConverged
from halfspace.values import Valued

Condition = Callable[[Array], tuple[float, Array]]
"""What a state lacks of the last equation, and the derivative (q + 1,) of that equation by the state."""


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Valued):
    """A state of a contact, and how it yields to a small change, with the law's straight line in the place of the law.

    Newton's method makes of each state another, the last of which is in equilibrium.
    """

    contact: Contact
    y: Array

    @property
    def approach(self) -> float:
        """Approach in eps."""
        return float(self.y[-1])

    @cached_property
    def load(self) -> float:
        """W in R dgamma."""
        return self.contact.load(self.y)

    @cached_property
    def slope(self) -> Array:
        """The slope sigma' at the gaps, (q,), in dgamma/eps^2."""
        return self.contact.law.slope(self.y[:-1])

    @cached_property
    def factors(self) -> Any:
        """Factors of the form a(u, v) + mu^2 int sigma' u_z v_z dA on all displacements."""
        return self.contact.body.softened(self.contact.tabor**2 * self.slope)

    @cached_property
    def rate(self) -> Array:
        """Change (q + 1,) of the state along the equilibria, by approach."""
        body, mu = self.contact.body, self.contact.tabor
        return np.append(-1 - mu * body.rise(self.factors.solve(-mu * body.forces(self.slope))), 1.0)

    @cached_property
    def stiffness(self) -> float:
        """Return dW/dalpha along the equilibria in R dgamma/eps."""
        return float(self.contact.load_row(self.y) @ self.rate)

    @property
    def unstable(self) -> int:
        """Number of directions in which the energy falls at this approach: negative eigenvalues of that form."""
        return int((self.factors.U.diagonal() < 0).sum())

    @cached_property
    def u(self) -> Array:
        """Displacements (n,) that balance the tensions by the law's straight lines: the true ones in equilibrium."""
        body, mu, h = self.contact.body, self.contact.tabor, self.y[:-1]
        flat = self.contact.undeformed(self.approach)[:-1]
        return np.asarray(self.factors.solve(mu * body.forces(self.contact.law.tension(h) + self.slope * (flat - h))))

    @property
    def energy(self) -> float:
        """Potential energy in R dgamma eps, see `Contact.energy`."""
        return self.contact.energy(self.u, self.approach)

    @property
    def central_gap(self) -> float:
        """H(0) in eps: the displacement is even and smooth across the axis, as the profile need not be."""
        return on_axis(self.contact, self._displaced) - self.approach

    @property
    def contact_radius(self) -> float:
        """Largest radius in beta at which the tension is largest; nan if there is none."""
        radii = even(self.contact.body, self.y[:-1] - self.contact.law.edge).roots(extrapolate=False)
        return float(radii[-1]) if radii.size and radii[-1] > 0 else float("nan")

    @property
    def ripple(self) -> float:
        """What gaps next to the axis have in eps that a polynomial of the radius squared has not.

        Or displacements, whichever have less: the gaps are smooth in contact, the displacements apart, where a profile
        need not be.
        """
        first = np.argsort(self.contact.body.radii)[:INNERMOST]
        x = self.contact.body.radii[first] ** 2
        fields = self.y[first], self._displaced[first]
        return min(float(np.max(np.abs(f - np.polynomial.Polynomial.fit(x, f, 2)(x)))) for f in fields)

    @property
    def _displaced(self) -> Array:
        """What the points have come down in eps."""
        return self.y[:-1] - self.contact.undeformed(self.approach)[:-1]

    def past(self, step: float, *, under_load: bool) -> Equilibrium:
        """Equilibrium a step in approach or load farther, from what the tangent predicts."""
        start = self.y + (step if under_load else step / self.stiffness) * self.rate
        reached = at_approach(start) if under_load else at_load(self.contact, self.load + step)
        return newton(self.contact, start, reached)


INNERMOST = 20  # points, those of about two cells
NEAREST = 6  # points of an interpolation, about those of a cell


def even(body: Body, values: Array) -> CubicSpline:
    """Spline through values at the points that yield, and at these on the other side of the axis."""
    order = np.flatnonzero(body.yields)[np.argsort(body.radii[body.yields])]
    r, f = body.radii[order], values[order]
    return CubicSpline(np.concatenate([-r[::-1], r]), np.concatenate([f[::-1], f]))


def on_axis(contact: Contact, values: Array) -> float:
    """Value on the axis of a smooth field at the points."""
    return float(even(contact.body, values)(0.0))


def gap_at(radii: Array, r: float) -> Array:
    """Row (q,) that gives the value at a radius of an even field at the points, by those nearest to it."""
    near, row = np.argsort(np.abs(radii - r))[:NEAREST], np.zeros(radii.size)
    row[near] = BarycentricInterpolator(radii[near] ** 2, np.eye(NEAREST))(r**2)
    return row


def along(row: Array, value: float) -> Condition:
    """The condition that a linear function of the state has a value."""
    return lambda y: (value - float(row @ y), row)


def at_approach(y: Array) -> Condition:
    """The condition that the approach is that of a state."""
    return along(last(y.size), float(y[-1]))


def at_load(contact: Contact, load: float) -> Condition:
    """The condition that the load is given."""
    return lambda y: (load - contact.load(y), contact.load_row(y))


def newton(contact: Contact, y: Array, condition: Condition) -> Equilibrium:
    """Equilibrium with one more condition, from a state nearby; NotConverged if there is none."""
    for _ in range(USUAL.most):
        state = Equilibrium(contact, y)
        change = np.append(contact.left_by(state.u, state.approach) - y[:-1], 0.0)
        missing, row = condition(y)
        change = change + (missing - float(row @ change)) / float(row @ state.rate) * state.rate
        size = contact.law.size(y[:-1])
        # Lest the surfaces pass through each other.
        y = y + min(1.0, USUAL.closing / max(float((-change[:-1] / size).max()), USUAL.closing)) * change
        moved = float(np.abs(change[:-1] / size).max())
        if moved**2 < USUAL.near:
            return Equilibrium(contact, y)
        if not np.isfinite(moved):
            break
    raise NotConverged(f"no equilibrium in {USUAL.most} Newton steps of the weak form; try a nearer start")


def from_afar(contact: Contact, far: float, approach: float) -> Equilibrium:
    """Equilibrium at an approach that is reached from undeformed surfaces at one far apart, by steps in approach.

    In each the gaps change by less than a part of them; NotConverged if that leads nowhere, as past a fold.
    """
    start = contact.undeformed(far)
    state = newton(contact, start, at_approach(start))
    for _ in range(USUAL.most):
        if (left := approach - state.approach) == 0:
            return state
        fastest = float(np.max(np.abs(left * state.rate[:-1]) / contact.law.size(state.y[:-1])))
        start = state.y + USUAL.opening / max(USUAL.opening, fastest) * left * state.rate
        start[-1] = approach if fastest <= USUAL.opening else start[-1]
        state = newton(contact, start, at_approach(start))
    raise NotConverged(f"no way from afar to alpha = {approach:.4g} eps in {USUAL.most} steps of the weak form")


# Turning points


def turning_point(middle: Equilibrium, *, under_load: bool) -> Equilibrium | None:
    """Where the equilibria near one turn, or None where they do not.

    At the fold of a jump d(alpha)/dW vanishes along the load; at the load's own extremum dW/d(alpha) does along the
    approach. The root is found by the secant.
    """
    first = USUAL.aside * (1 + abs(middle.approach if under_load else middle.load))
    first *= min(1.0, 9 / middle.contact.sharpness**2)

    def slope(step: float) -> float:
        stiffness = middle.past(step, under_load=under_load).stiffness
        return stiffness if under_load else 1 / stiffness

    tol, tries = USUAL.turned_at * first, USUAL.tries
    root, found = secant(slope, 0.0, x1=first, tol=tol, maxiter=tries, full_output=True, disp=False)
    near = found.converged and abs(root) < USUAL.farthest * first
    return middle.past(float(root), under_load=under_load) if near else None
