"""
Your own law of attraction
==========================

The surfaces need not attract each other as 1/h³. A law is a class with three formulas: the pressure at a gap, its
slope and its energy. The gap H is counted from equilibrium, in units of ε; the tension must integrate to 1.

Here the tension is 3/2 (e^-H - e^-3H) Δγ/ε. Both solvers take it, and they should agree.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

import fem_adhesion
import halfspace


@dataclass(frozen=True)
class Screened(halfspace.laws.Law):
    """Attraction that is screened: it falls off as e^-H."""

    def pressure(self, gap, tabor):
        """Pressure, positive in compression."""
        return 1.5 * tabor * (np.exp(-3 * gap) - np.exp(-gap))

    def slope(self, gap, tabor):
        """Derivative of the pressure by the gap."""
        return 1.5 * tabor * (np.exp(-gap) - 3 * np.exp(-3 * gap))

    def energy(self, gap, tabor):
        """Integral of the pressure from this gap to infinity."""
        return 1.5 * tabor * (np.exp(-3 * gap) / 3 - np.exp(-gap))


path = halfspace.trace(1.0, law=Screened())
elements = fem_adhesion.trace(fem_adhesion.Scene(1.0, law=Screened()), rtol=1e-4)
for name, solved in (("integral equation", path), ("finite elements", elements)):
    pull_off = solved.event("pull_off")
    print(f"pull-off by {name}: {pull_off.load:.6f} R dgamma, error below {pull_off.load_error:.0e}")

for curve, label in ((path, "own law"), (halfspace.trace(1.0), "3-9 law")):
    curve = curve.resampled(150)
    plt.plot(curve.approach, curve.load, label=label)
plt.xlim(-6, 4)
plt.xlabel("approach (ε)")
plt.ylabel("load (R Δγ)")
plt.legend()
