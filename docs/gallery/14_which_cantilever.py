"""
Energy lost on a cantilever
===========================

Each jump turns elastic energy into heat. A stiff apparatus loses less of it than a soft one, and below a certain
Tabor parameter a stiff one does not jump at all. How much is lost in one cycle, on your cantilever?

`cycle` finds both jumps, from where each takes off to where it lands, and the energy lost, with their errors.
"""

import matplotlib.pyplot as plt
import numpy as np

import halfspace
from halfspace.equilibrium import devices

stiffnesses = np.geomspace(2, 200, 7)  # R dgamma/eps
for tabor in (0.5, 1.0, 2.0):
    path = halfspace.trace(tabor, rtol=1e-3)
    cycles = [devices.cycle(path, stiffness) for stiffness in stiffnesses]
    lost = [cycle.energy_lost.value if cycle else 0.0 for cycle in cycles]
    plt.semilogx(stiffnesses, lost, "o-", label=f"Tabor parameter {tabor:g}")
plt.xlabel("stiffness of the apparatus (R Δγ/ε)")
plt.ylabel("energy lost in a cycle (R Δγ ε)")
plt.legend()
