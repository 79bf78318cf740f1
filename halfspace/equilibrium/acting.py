"""What acts in a state of a contact: pressures, deflections, the contact's edge, and how all that changes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from halfspace.elastic.compliance import Operator, SurfaceNodes
from halfspace.laws import Law
from halfspace.profiles import Surface
from halfspace.roots import root
from halfspace.values import Array, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Acting(Valued):
    """All that acts in a state x at the nodes, each (q,), when it is first asked for."""

    state: bytes
    law: Law
    tabor: float
    profile: Surface
    operator: Operator
    far_energy: bool = False

    @cached_property
    def x(self) -> Array:
        """The state: gaps, approach and scale, (q + 2,)."""
        return np.frombuffer(self.state)

    @cached_property
    def body(self) -> SurfaceNodes:
        """Nodes at its scale."""
        return self.operator.nodes(float(self.x[-1]))

    @property
    def compliance(self) -> Array:
        """Compliance at its scale, which the operator keeps as long as there is room."""
        return self.operator.at(float(self.x[-1])).compliance

    @cached_property
    def pressure(self) -> Array:
        """P at its gaps."""
        return self.law.pressure(self.x[:-2], self.tabor)

    @cached_property
    def slope(self) -> Array:
        """dP/dH."""
        return self.law.slope(self.x[:-2], self.tabor)

    @cached_property
    def room(self) -> Array:
        """Sizes by which changes of its gaps are measured."""
        return self.law.room(self.x[:-2])

    @cached_property
    def deflection(self) -> Array:
        """Of the nodes in eps, H + alpha* - mu z(u)."""
        return np.asarray(self.x[:-2] + self.x[-2] - self.tabor * self.profile.height(self.body.radii))

    @cached_property
    def rates(self) -> tuple[Array, Array, Array]:
        """By the scale: of the undeformed gaps in eps, the weights, and the equations."""
        d_radii, d_weights, d_deflection = self.operator.rates(float(self.x[-1]), self.pressure)
        rising = self.tabor * self.profile.slope(self.body.radii) * d_radii
        return rising, d_weights, -rising - self.tabor * d_deflection

    @property
    def approach(self) -> float:
        """Alpha* in eps."""
        return float(self.x[-2])

    @cached_property
    def load(self) -> float:
        """W in R dgamma, positive in compression."""
        return float(self.body.weights @ self.pressure)

    @cached_property
    def central_gap(self) -> float:
        """H(0) in eps: the deflection is smooth across the axis, as the profile need not be."""
        return float(self.operator.axis_row @ self.deflection - self.x[-2])

    @cached_property
    def contact_radius(self) -> float:
        """Largest radius in beta at which the gap is that of the edge, nan if there is none."""
        if self.operator.follows_contact:
            return float(self.x[-1])
        return _edge(self.body, self.x[:-2], self.law.edge_gap)

    @cached_property
    def sizes(self) -> Array:
        """Sums of the sizes of the terms of approach, load, central gap and contact radius, which may cancel, (4,)."""
        approach = abs(self.approach)
        gaps = np.abs(self.x[:-2]) + approach + self.tabor * np.abs(self.profile.height(self.body.radii))
        load = np.abs(self.body.weights) @ np.abs(self.pressure)
        return np.array([approach, load, np.abs(self.operator.axis_row) @ gaps, self.contact_radius])

    @cached_property
    def energies(self) -> tuple[float, float]:
        """Total potential energy in R dgamma eps, elastic and surface, and the sum of the sizes of its terms.

        That of the undeformed surfaces in touch is taken off where it may be infinite, as of the 3-9 law on a cone.
        """
        H, mu = self.x[:-2], self.tabor
        terms = np.array([self.law.energy(H, mu), self.pressure * self.deflection / 2])
        if self.far_energy:
            terms[0] -= self.law.energy(mu * self.profile.height(self.body.radii), mu)
        weights = self.body.weights
        return float(weights @ terms.sum(axis=0)), float(np.abs(weights) @ np.abs(terms).sum(axis=0))

    @cached_property
    def gradients(self) -> Array:
        """Derivatives by x of approach, load and central gap, (3, q + 2)."""
        rows, axis = np.zeros((3, self.x.size)), self.operator.axis_row
        by_approach, by_load, by_gap = rows
        by_approach[-2] = 1
        np.multiply(self.body.weights, self.slope, out=by_load[:-2])
        by_gap[:-2] = axis
        if self.operator.follows_contact:
            rising, d_weights, _ = self.rates
            by_load[-1] = d_weights @ self.pressure
            by_gap[-1] = -(axis @ rising)
        return rows

    @cached_property
    def radius_gradient(self) -> Array:
        """Derivative by x of the contact radius, (q + 2,)."""
        row = np.zeros(self.x.size)
        if self.operator.follows_contact:
            row[-1] = 1
        else:
            value, slope = self.body.continuous(self.contact_radius)
            row[:-2] = -value / (slope @ self.x[:-2])
        return row


def _edge(body: SurfaceNodes, H: Array, edge: float) -> float:
    """Largest radius at which the gaps H are those of the edge, on a grid that stands still."""
    inside = np.flatnonzero(edge > H)
    if inside.size == 0 and not body.interpolation(0.0) @ H <= edge:
        return float("nan")
    if inside.size and inside[-1] == H.size - 1 and body.continuous_value(body.extent, H)[0] <= edge:
        return body.extent
    radii = [0.0, *body.radii.tolist(), body.extent]
    below, above = radii[inside[-1] + 1 :][:2] if inside.size else radii[:2]
    by_straight_line = np.interp(edge, H[inside[-1] :][:2], body.radii[inside[-1] :][:2]) if inside.size else 0.0
    radius = float(by_straight_line) or above
    for _ in range(TRIES):
        gap, slope = body.continuous_value(radius, H)
        step = (edge - gap) / slope if slope else math.inf
        radius += step
        if not below <= radius <= above:
            break
        if abs(step) < PINNED * (above - below):
            return radius
    what = "the contact edge; refine the grid"
    return root(lambda r: body.continuous_value(r, H)[0] - edge, below, above, what, xtol=1e-14)


TRIES, PINNED = 6, 1e-8  # Newton's steps towards a contact edge; part of the nodes' distance: the next is its square
