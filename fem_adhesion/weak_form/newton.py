"""Newton's method with a border, and the equilibria that it finds.

A state y (q + 1,) has the gaps h at the points in eps and, last, the approach alpha.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from fem_adhesion.weak_form.body import Array, Body
from fem_adhesion.weak_form.contact import Contact
from halfspace.errors import NotConverged
from halfspace.values import Valued

Condition = Callable[[Array], tuple[float, Callable[[Array], float]]]
"""What a state lacks of the last equation, and by how much that falls as the state changes by (q + 1,)."""


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Valued):
    """An equilibrium of a contact, and how it yields to a small change.

    Attributes
    ----------
    contact : Contact
        What is in equilibrium.
    y : (q + 1,) array
        Gaps and approach.
    u : (n,) array
        Displacements.
    rate : (q + 1,) array
        Change of the state along the equilibria, by approach.
    unstable : int
        Number of directions in which the energy falls at this approach: negative eigenvalues of the tangent.
    """

    contact: Contact
    y: Array
    u: Array
    rate: Array
    unstable: int

    @property
    def approach(self) -> float:
        """Approach in eps."""
        return float(self.y[-1])

    @property
    def load(self) -> float:
        """W in R dgamma."""
        return self.contact.load(self.y)

    @property
    def stiffness(self) -> float:
        """Return dW/dalpha along the equilibria in R dgamma/eps."""
        return self.contact.load_rate(self.y, self.rate)

    @property
    def central_gap(self) -> float:
        """H(0) in eps: the displacement is even and smooth across the axis, as the profile need not be."""
        return -self.approach - self.contact.tabor * float(even(self.contact.body, self.contact.body.rise(self.u))(0.0))

    @property
    def contact_radius(self) -> float:
        """Largest radius in beta at which the tension is largest; nan if there is none."""
        radii = even(self.contact.body, self.y[:-1] - self.contact.law.edge).roots(extrapolate=False)
        return float(radii[-1]) if radii.size and radii[-1] > 0 else float("nan")

    def nearby(self, condition: Condition) -> Equilibrium:
        """Equilibrium nearby that meets a condition, from what the tangent predicts."""
        missing, along = condition(self.y)
        return newton(self.contact, self.y + missing / along(self.rate) * self.rate, condition)


def even(body: Body, values: Array) -> CubicSpline:
    """Spline through values at the points that yield, and at these on the other side of the axis."""
    order = np.flatnonzero(body.yields)[np.argsort(body.radii[body.yields])]
    r, f = body.radii[order], values[order]
    return CubicSpline(np.concatenate([-r[::-1], r]), np.concatenate([f[::-1], f]))


def at_approach(approach: float) -> Condition:
    """The condition that the approach is given."""
    return lambda y: (approach - y[-1], lambda change: change[-1])


def at_load(contact: Contact, load: float) -> Condition:
    """The condition that the load is given."""
    return lambda y: (load - contact.load(y), lambda change: contact.load_rate(y, change))


def newton(contact: Contact, y: Array, condition: Condition, most: int = 20, closing: float = 0.75) -> Equilibrium:
    """Equilibrium with one more condition, from a state nearby; NotConverged if there is none after `most` steps.

    A step closes no gap by more than a part of it, `closing`, lest the surfaces pass through each other. The last one
    follows on one that changed no gap by more than 3e-5 of it, so that it changes none by more than some 1e-9.
    """
    body, law, mu = contact.body, contact.law, contact.tabor
    moved = np.inf
    for _ in range(most):
        h, alpha = y[:-1], y[-1]
        slope = law.slope(h)
        factors = body.factors(mu**2 * slope)
        # Displacements that balance the tensions by the law's straight lines, and their change with the approach.
        straight = law.tension(h) + slope * (contact.undeformed(alpha)[:-1] - h)
        u, du = factors.solve(np.column_stack([mu * body.forces(straight), -mu * body.forces(slope)])).T
        rate = np.append(-1 - mu * body.rise(du), 1.0)
        change = np.append(contact.left_by(u, alpha) - h, 0.0)
        missing, along = condition(y)
        change += (missing - along(change)) / along(rate) * rate
        if moved**2 < 1e-9:
            return Equilibrium(contact, y + change, u, rate, int((factors.U.diagonal() < 0).sum()))
        relative = change[:-1] / law.size(h)
        moved = float(np.abs(relative).max())
        y = y + min(1.0, closing / max(-float(relative.min()), closing)) * change
        if not np.isfinite(moved):
            break
    raise NotConverged(f"no equilibrium in {most} Newton steps of the weak form; try a nearer start")
