"""Hertz's and JKR's theories on a layered body, and the series by which thin samples are corrected instead.

A paraboloid presses into a body whose surface yields S(k) times as much to waves of pressure as a half-space, see
`halfspace.elastic.layers`. The pressure within the contact of radius a is that of a density g,

    P(s) = g(a)/(a^2 - s^2)^(1/2) - int_s^a g'(t) dt/(t^2 - s^2)^(1/2),    W = 2 pi int_0^a g dt,

which turns the dual integral equations of the contact into one of the second kind with a smooth kernel (Lebedev &
Ufliand 1958, Dhaliwal & Rau 1970),

    g(x) + (2/pi) int_0^a g(t) int_0^inf (S(k) - 1) cos(k t) cos(k x) dk dt = (alpha - x^2)/pi.

Hertz's theory has g(a) = 0, JKR's g(a) = -(2 a/pi)^(1/2). Radii in beta, approaches in beta^2/R, loads in R dgamma.

An attraction with a range is JKR's of a dgamma wider by a part (1/f' + c pi^2/16) mu^-2 ln mu/(pi a), f' the stiffness
of the law and c that of its tail c H^-3, 0 of one that falls faster; then come terms in mu^-2. So pull-off by the 3-9
law exceeds JKR's by the part 0.368 mu^-2 (ln mu + const.) on a layer of 2 beta, poisson 0.3, which seems mu^-1.7 at 60.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from halfspace.elastic import grid
from halfspace.elastic.layers import Foundation, LayeredBody, surface_compliance, total_thickness
from halfspace.roots import rising_root
from halfspace.theories.closed_forms import ContactState, hertz_load
from halfspace.values import Array, Estimate


@dataclass(frozen=True)
class OnLayers:
    """A rigid paraboloid on a layered body.

    Parameters
    ----------
    body : LayeredBody
        Its strata and base.
    fineness : float
        Nodes, in those that serve; the change by other ones is the error.
    """

    body: LayeredBody
    fineness: float = 1.0
    decayed: float = 20.0  # wave number times the first thickness beyond which S - 1 is below e^-40
    longest: float = 1e-4  # wave number times the thickness of all strata below which S does not change
    points: int = 24  # points of a panel of wave numbers
    phase: float = 12.0  # most phase by which the waves within a contact turn across a panel
    nodes: int = 24  # nodes of the density
    more_nodes: int = 8  # nodes of the density more for each first thickness in the contact radius

    def hertz(self, radius: float) -> ContactState:
        """State of a contact radius without attraction; the approach in beta^2/R."""
        return self._state(radius, 0.0)

    def jkr(self, radius: float) -> ContactState:
        """State of a contact radius with an attraction of no range; the approach in beta^2/R."""
        return self._state(radius, -math.sqrt(2 * radius / math.pi))

    def _state(self, a: float, edge: float) -> ContactState:
        """Where the density at the edge of the contact is `edge`."""
        x, w = self._nodes(a)
        k, dk = self._wave_numbers(a)
        waves = np.cos(np.outer(np.append(x, a), k))
        kernel = 2 / math.pi * (waves * dk) @ waves[:-1].T * w
        punch, bowl = np.linalg.solve(
            np.eye(x.size) + kernel[:-1], np.stack([np.full_like(x, 1 / math.pi), x**2 / math.pi], axis=1)
        ).T
        at_edge = [1 / math.pi - kernel[-1] @ punch, a**2 / math.pi - kernel[-1] @ bowl]
        approach = float((edge + at_edge[1]) / at_edge[0])
        return ContactState(approach, float(2 * math.pi * w @ (approach * punch - bowl)), a)

    def _nodes(self, a: float) -> tuple[Array, Array]:
        """Gauss's points within the contact."""
        thin = self.body.strata[0].thickness
        count = math.ceil(self.fineness * (self.nodes + self.more_nodes * a / thin))
        (points,), (weights,) = grid.gauss_points(np.array([0.0, a]), count)
        return points, weights

    def _wave_numbers(self, a: float) -> tuple[Array, Array]:
        """Wave numbers, and S - 1 times their weights."""
        first, last = self.longest / total_thickness(self.body), self.decayed / self.body.strata[0].thickness
        lines = grid.towards_axis(grid.uniform(last, min(self.phase / (2 * a * self.fineness), last)), first, 2.0)
        k, w = (part.ravel() for part in grid.gauss_points(lines, self.points))
        return k, w * (surface_compliance(self.body, k) - 1)

    def hertz_at(self, approach: float) -> ContactState:
        """State at an approach in beta^2/R without attraction."""
        what, start = "the contact radius; take a thicker sample", math.sqrt(2 * approach)
        return self.hertz(rising_root(lambda a: self.hertz(a).approach - approach, what, start=start))


def hertz_ratio(body: LayeredBody, approach: float) -> Estimate:
    """Load at an approach in beta^2/R without attraction, over Hertz's on a half-space; with its error."""
    whole = float(hertz_load(math.sqrt(approach)))
    found, finer = (OnLayers(body, fineness).hertz_at(approach).load / whole for fineness in (1.0, 1.3))
    return Estimate(finer, abs(finer - found) + 1e-10 * finer)


def thin_sample_series(chi: float, poisson: float, foundation: Foundation) -> float:
    """Load over Hertz's at chi = sqrt(R delta)/h by Dimitriadis et al., Biophys. J. 82 (2002) 2798, its (10) and (12).

    Up to chi = 1, by its authors. On a base that holds the sample, poisson 0.5, it is their
    1 + 1.133 chi + 1.283 chi^2 + 0.769 chi^3 + 0.0975 chi^4; the last sign is that of this (12), by which samples are
    corrected, and not of their (10).

    What they expand is, by the moments A = int (S - 1) dx and B = int (S - 1) x^2 dx of the dual integral equation,

        1 - (2 A/pi) chi + (14/3) (A/pi)^2 chi^2 - 8 (200 A^3 - 9 pi^2 B)/(135 pi^3) chi^3
          + 2 A (715 A^3 - 72 pi^2 B)/(45 pi^4) chi^4,

    1 + 1.127 chi + 1.482 chi^2 + 1.470 chi^3 + 1.005 chi^4 in that case: chi^2 lacks its 7/6. Their alpha is A to 0.6 %
    on a base that holds a sample of poisson 0.3 and more, but 6 % off at 0; on one that does not, where A = -1.168
    whatever poisson is, 2 % at 0.3 and 19 % at 0.5.
    """
    nu = poisson
    if foundation == "bonded":
        alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)
        beta = (0.6387 - 1.0277 * nu + 1.5164 * nu**2) / (1 - nu)
    else:
        alpha, beta = -0.347 * (3 - 2 * nu) / (1 - nu), 0.056 * (5 - 2 * nu) / (1 - nu)
    cubic = -8 / math.pi**3 * (alpha**3 + 4 * math.pi**2 / 15 * beta)
    quartic = abs(16 * alpha / math.pi**4 * (alpha**3 + 3 * math.pi**2 / 5 * beta))
    first = -2 * alpha / math.pi
    return 1 + first * chi + first**2 * chi**2 + cubic * chi**3 + quartic * chi**4
