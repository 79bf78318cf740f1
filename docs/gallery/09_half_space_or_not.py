"""
Half-space or not?
==================

Theories of adhesion put an elastic half-space in the place of the sphere. For a small or soft sphere that is wrong.
The atlas holds the pull-off force of finite spheres: how far off is the half-space, for your Tabor parameter and
your R/ε?

The line of 1 % is what most measurements need.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfspace import atlas

tabors, ratios = np.meshgrid(np.geomspace(0.05, 10, 80), np.geomspace(25, 1e4, 80))
sphere = atlas.sphere.pull_off(tabors, ratios, poisson=0.3)
off = 100 * np.abs(1 / sphere.load_ratio - 1)

lines = plt.contour(tabors, ratios, off, levels=[0.1, 0.3, 1, 3, 10], colors="0.2")
plt.clabel(lines, fmt="%g %%")
plt.loglog()
plt.xlabel("Tabor parameter")
plt.ylabel("R/ε")
plt.title("error of the half-space's pull-off force")
