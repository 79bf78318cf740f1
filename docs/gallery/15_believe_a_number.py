"""
Can I believe a number?
=======================

Every number comes with an estimate of its error. And it can be had by a second solver that shares no elasticity
with the first: an integral equation here, finite elements there. If the two differ by no more than their errors,
believe them.

``fem-adhesion compare`` does this for every quantity, and exits with 1 if one of them disagrees.
"""

import matplotlib.pyplot as plt

import fem_adhesion
import halfspace

integral = halfspace.trace(2.0, rtol=1e-4)
elements = fem_adhesion.trace(fem_adhesion.Scene(tabor=2.0), rtol=1e-4)
for name in ("pull_off", "jump_on", "jump_off", "zero_load"):
    quantity = "load" if name == "pull_off" else "approach"
    one, other = integral.event(name).estimate(quantity), elements.event(name).estimate(quantity)
    agree = abs(one.value - other.value) <= one.error + other.error
    print(f"{name:10} {quantity:9} {one.value:10.5f} {other.value:10.5f}  {'agree' if agree else 'DISAGREE'}")

one, other = integral.resampled(150), elements.resampled(150)
plt.plot(one.approach, one.load, color="0.7", linewidth=5, label="integral equation")
plt.plot(other.approach, other.load, "k--", label="finite elements")
plt.xlim(-6, 6)
plt.xlabel("approach (ε)")
plt.ylabel("load (R Δγ)")
plt.legend()
