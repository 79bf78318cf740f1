"""
Stress under the contact
========================

How large is the stress inside the body when the contact tears off? One command draws the body cut open at pull-off,
deformed and coloured by its stress, and writes the stress along the surface, or the axis, as a table::

    fem-adhesion curve --tabor 2 --render body.png --stress surface stress.csv

Stress is in units of E* β/R = Δγ/(μ ε), tension is positive; given a material it is in pascals. ``--vtk`` writes all
fields for ParaView.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from fem_adhesion import cli

with tempfile.TemporaryDirectory() as folder:
    table = Path(folder) / "stress.csv"
    cli.main(["curve", "--tabor", "2", "--rtol", "1e-3", "--render", "body.png", "--stress", "surface", str(table)])
    stress = np.genfromtxt(table, delimiter=",", names=True)

for name, label in (("zz", "vertical"), ("rr", "radial"), ("hoop", "hoop")):
    plt.plot(stress["r_beta"], stress[f"stress_{name}_dgamma_per_mu_eps"], label=label)
plt.xlim(0, 3)
plt.xlabel("radius (β)")
plt.ylabel("stress at the surface (E* β/R)")
plt.legend()
