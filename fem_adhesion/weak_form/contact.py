"""The law, the profile, and what they make of a body: gaps, load, energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_adhesion.weak_form.body import Array, Body
from halfspace.values import Valued

Heights = Callable[[Array], Array]
FIRST = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / 840  # weights of differences of eighth order
SECOND = np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / 5040

# The law


@dataclass(frozen=True)
class Law:
    """A law of the tension between two surfaces, by its potential alone; what else it is are differences of that.

    The potential is w = -int_h^inf sigma in dgamma at gaps h in eps; the attraction of two bodies does the work
    -w(1) = 1. The grain, (sigma'(1))^(-1/2), is the part of a gap over which the tension varies. The room is the gap in
    eps that counts as one at least: surfaces without a core may come closer than none. The edge is the gap in eps
    of the largest tension.
    """

    potential: Callable[[Array], Array]
    grain: float = 0.25
    room: float = 1e-6
    edge: float = 3 ** (1 / 6)

    def size(self, h: Array) -> Array:
        """Size by which changes of a gap are measured; a start may have surfaces that overlap."""
        return np.maximum(np.abs(h), self.room)

    def tension(self, h: Array) -> Array:
        """Return sigma = dw/dh in dgamma/eps."""
        return self._difference(h, FIRST, 1)

    def slope(self, h: Array) -> Array:
        """Return sigma' in dgamma/eps^2."""
        return self._difference(h, SECOND, 2)

    def _difference(self, h: Array, weights: Array, order: int) -> Array:
        """Difference at steps that are small beside both the gap and what the tension varies over."""
        d = 4e-3 * self.grain * self.size(h)
        return np.asarray(sum(w * self.potential(h + n * d) for n, w in enumerate(weights, -4)) / d**order)


def lennard_jones(h: Array) -> Array:
    """Potential of the 3-9 law."""
    return 8 / 3 * (h**-8 / 8 - h**-2 / 2)


# The profile


def paraboloid(r: Array) -> Array:
    """Height z of the undeformed surface over its pole in beta^2/R, at radii in beta."""
    return r**2 / 2


# The contact


@dataclass(frozen=True, eq=False, repr=False)
class Contact(Valued):
    """A body under a rigid surface that attracts it.

    The body is in beta, `tabor` is mu, and the heights are z of the undeformed surface at radii in beta.

    A state y (q + 1,) has the gaps h at the points and, last, the approach.
    """

    body: Body
    tabor: float
    heights: Heights = paraboloid
    law: Law = Law(lennard_jones)

    @cached_property
    def height(self) -> Array:
        """Height z at the points."""
        return self.heights(self.body.radii)

    def undeformed(self, approach: float) -> Array:
        """State y (q + 1,) of undeformed surfaces."""
        return np.append(1 - approach + self.tabor * self.height, approach)

    def left_by(self, u: Array, approach: float) -> Array:
        """Gaps (q,) that the displacements u leave."""
        return np.asarray(self.undeformed(approach)[:-1] - self.tabor * self.body.rise(u))

    def load(self, y: Array) -> float:
        """W in R dgamma, positive in compression, of a state."""
        return -self.tabor * self.body.integral(self.law.tension(y[:-1]))

    def load_rate(self, y: Array, rate: Array) -> float:
        """Change of the load with a state that changes at a rate (q + 1,)."""
        return -self.tabor * self.body.integral(self.law.slope(y[:-1]) * rate[:-1])

    def energy(self, u: Array, approach: float) -> float:
        """Potential energy in R dgamma eps, less that of the undeformed surfaces in touch, which may be infinite."""
        released = self.law.potential(self.left_by(u, approach)) - self.law.potential(1 + self.tabor * self.height)
        return self.tabor * (float(u @ (self.body.stiffness @ u)) / 2 + self.body.integral(released))
