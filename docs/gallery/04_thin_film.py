"""
A thin film on a rigid base
===========================

A film that is hardly thicker than the contact is wide cannot give way, so the sphere sees a stiffer sample and
sticks more strongly. How thick must the film be until it behaves like a half-space? Thickness is in units of β =
(R² Δγ/E*)^(1/3), here with E* of the film; the base holds the film fast.
"""

import matplotlib.pyplot as plt
import numpy as np

import halfspace

thicknesses = np.geomspace(0.5, 20, 8)
films = [halfspace.Layer(thickness=thickness, poisson=0.45) for thickness in thicknesses]
events = [halfspace.trace(1.0, body=film, rtol=1e-3).event("pull_off") for film in films]
thick = halfspace.trace(1.0).event("pull_off")

plt.semilogx(thicknesses, [-event.load for event in events], "o-", label="film")
plt.axhline(-thick.load, color="0.6", label="half-space")
plt.xlabel("thickness of the film (β)")
plt.ylabel("pull-off force (R Δγ)")
plt.legend()
