"""What a contact asks of the law of tension between two surfaces, and what every law must be before it is solved with.

Gaps enter as H = h/eps - 1, eps the spacing at which the tension vanishes. Pressures leave as P = mu eps p/dgamma,
positive in compression, so that they are mu times what depends on the law alone. The work of adhesion dgamma is the
integral of the tension from there to infinity.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import ClassVar

import numpy as np

from halfspace.limits import off_derivative, require_all, require_part
from halfspace.roots import root
from halfspace.values import Array

GAPS = 10.0 ** np.arange(-4, 8, 0.01)  # gaps H at which a law is looked at
TINY = 1e-9  # tension that counts as none, dgamma/eps


class Law:
    """Pressure between two surfaces as a function of their gap.

    A law of one's own is a class on this one, best a frozen dataclass, with the methods `pressure`, `slope` and
    `energy`; the rest follows.
    """

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P at gaps H."""
        raise NotImplementedError

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        raise NotImplementedError

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi(H) with -dPhi/dH = P and Phi = 0 far apart; multiply by R dgamma eps for an energy per beta^2."""
        raise NotImplementedError

    pieced: ClassVar[bool] = False  # whether some derivative leaps between pieces of it, as of a spline

    def room(self, gap: Array) -> Array:
        """Size by which changes of a gap are measured: h, by which it may shrink until the bodies are one."""
        return gap + 1

    @cached_property
    def edge_gap(self) -> float:
        """H at which the tension is largest: it defines the contact edge."""
        i = int(np.argmin(self.pressure(GAPS, 1.0)))
        around = float(GAPS[max(i - 1, 0)]), float(GAPS[i + 1])
        return root(lambda H: float(self.slope(np.array(H), 1.0)), *around, "the largest tension; mend the law")

    @property
    def strength(self) -> float:
        """Largest tension in dgamma/eps."""
        return -float(self.pressure(np.array(self.edge_gap), 1.0))

    @property
    def stiffness(self) -> float:
        """Slope of the tension at equilibrium in dgamma/eps^2."""
        return -float(self.slope(np.array(0.0), 1.0))

    @cached_property
    def decay(self) -> float:
        """Exponent n of a tension that falls as h^-n far apart; infinite where it falls faster than any power."""
        H = np.array(1e5)
        tension = -float(self.pressure(H, 1.0))
        return float((H + 1) * self.slope(H, 1.0)) / tension if tension > 0 else np.inf

    @cached_property
    def innermost(self) -> float:
        """H up to which the tension rises from the core outwards."""
        return float(GAPS[int(np.argmin(np.diff(self.pressure(GAPS, 1.0)) < 0))])

    @cached_property
    def outermost(self) -> float:
        """H of the outermost tension that makes an edge of its own: that of a second minimum, or beyond a barrier.

        0 for a tension that rises to its largest and falls from there on, as most do.
        """
        tension = -self.pressure(GAPS, 1.0)
        i = int(np.argmax(tension))
        before, beyond = tension[: i + 1], tension[i:]
        before, beyond = np.maximum.accumulate(before) - before, beyond - np.minimum.accumulate(beyond)
        again = 0.05 * tension[i]  # a fall before the maximum, or a rise beyond it, that makes an edge of its own
        if beyond.max() > again:
            return float(GAPS[i + int(np.argmax(beyond))])
        return self.edge_gap if before.max() > again else 0.0

    def range(self, part: float) -> float:
        """H beyond which a part of the work of adhesion is left."""
        return root(lambda H: -float(self.energy(np.array(H), 1.0)) - part, 0.0, 1e12, "the law's range; mend the law")


def require_law(law: Law) -> Law:
    """Return a law, or raise InputError unless it adheres with dgamma, repels closer by and lets go farther away."""
    require_part(law, "law", "pressure", "halfspace.laws.Morse(3)")
    tension, (core, nearer) = -law.pressure(GAPS, 1.0), law.pressure(np.array([-0.3, -0.1]), 1.0)
    strength = max(float(tension.max()), TINY)
    rest, energy = (float(value(np.array(0.0), 1.0)) for value in (law.pressure, law.energy))
    left = float(tension[-1]) / strength
    by_energy = _apart(law.pressure, lambda H: -law.energy(H, 1.0))
    by_pressure = _apart(law.slope, lambda H: law.pressure(H, 1.0))
    mend = "mend either, or smooth the table"
    require_all(
        law,
        (f"the largest tension is {strength:.3g} dgamma/eps", strength > TINY, "above 0", "let the surfaces attract"),
        (f"the pressure at H = 0 is {rest:.3g} dgamma/eps", abs(rest) < 1e-9 * strength, "0", "move its gaps"),
        (f"the energy at H = 0 is {energy:.7g} dgamma", abs(energy + 1) < 1e-6, "-1", "divide the law by it"),
        (f"the pressure at H = -0.3 is {core:.3g} dgamma/eps", core > nearer > 0, "rising", "give it a core"),
        (f"the tension far apart is {left:.3g} of its largest", left < 0.01, "0.01", "let it decay"),
        (f"the pressure is off by {by_energy:.2g} from the energy's derivative", by_energy < 1e-4, "0.0001", mend),
        (f"the slope is off by {by_pressure:.2g} from the pressure's", by_pressure < 1e-4, "0.0001", mend),
    )
    return law


def _apart(derivative: Callable[[Array, float], Array], of: Callable[[Array], Array]) -> float:
    """Largest distance of a derivative from differences of what it is of, in parts of its size at each gap."""
    H = np.concatenate([np.arange(-0.3, 0.0, 0.01), np.geomspace(0.01, 10.0, 350)])
    values = derivative(H, 1.0)
    return off_derivative(values, of, H, 1 + H, np.abs(values) + 1e-3 * np.max(np.abs(values[H > 0])))
