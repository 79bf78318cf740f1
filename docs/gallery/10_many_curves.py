"""
Two hundred curves
==================

For a fit, a map or a learning set you need many curves. Where the sphere is a paraboloid under the 3-9 law, the
atlas has them all: two hundred take a blink. Here they are drawn at once.

For other laws, profiles and bodies `halfspace.sweep` solves for each curve, with its own error estimates; with
``map`` of a pool of processes it uses all cores. A few of its curves stand beside the atlas. In a terminal::

    fem-adhesion sweep --tabor 0.05:50:200 --law morse:3 --csv sweep.csv
"""

import matplotlib.pyplot as plt
import numpy as np

import halfspace

tabors = np.geomspace(0.05, 50, 200)
known = halfspace.atlas.pull_off(tabors)
few = halfspace.sweep(np.geomspace(0.05, 50, 10), rtol=1e-3)

left, right = plt.subplots(1, 2, figsize=(9, 4))[1]
for tabor in tabors:
    states = halfspace.atlas.curve(tabor).states(200)
    left.plot(
        states.approach / (1 + tabor), states.load, linewidth=0.3, color=plt.cm.viridis(np.log10(tabor) / 3 + 0.43)
    )
left.set(xlim=(-5, 3), ylim=(-6.5, 3), xlabel="approach/(1 + Tabor parameter) (ε)", ylabel="load (R Δγ)")
right.semilogx(tabors, -known.load, label="atlas")
right.semilogx(few.tabor, -few.events["pull_off"].load, "o", label="sweep")
right.set(xlabel="Tabor parameter", ylabel="pull-off force (R Δγ)")
right.legend()
