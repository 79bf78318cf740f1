"""
Stress under the contact
========================

How large is the stress inside the body when the contact tears off? The command draws the body cut open at pull-off,
deformed and coloured by its stress::

    fem-adhesion curve --tabor 2 --render body.png

The second picture has the vertical stress from Python. Its unit is E* β/R, tension is positive; `pressure` of
`halfspace.scaling.Units` turns it into pascals. ``--vtk`` writes all fields for ParaView.
"""

import matplotlib.pyplot as plt
import numpy as np

from fem_adhesion import Scene, cli, fields, trace
from fem_adhesion.elasticity.stress import positions, sampled

cli.main(["curve", "--tabor", "2", "--rtol", "1e-3", "--render", "body.png"])

# %%
# The stress at points of each cell:

scene = Scene(tabor=2.0)
(state,) = [one for one in fields.states_along(scene, trace(scene, rtol=1e-3), points=0) if one.name == "pull_off"]

places = np.reshape(np.meshgrid([0.0, 0.5, 1.0], [0.0, 0.5, 1.0]), (2, -1))  # in the unit square
r, z = positions(state.space, places).reshape(2, -1)
stress = sampled(state.space, state.stress, places)[1].ravel()  # of rr, zz, hoop, rz
near = (r < 3) & (z > -3)
levels = np.linspace(-3, 3, 41)
drawn = plt.tricontourf(r[near], z[near], stress[near], levels=levels, cmap="RdBu_r", extend="both")
plt.colorbar(drawn, label="vertical stress (E* β/R)", ticks=[-3, -2, -1, 0, 1, 2, 3])
plt.xlabel("radius (β)")
plt.ylabel("height (β)")
