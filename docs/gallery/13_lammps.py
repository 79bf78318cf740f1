"""
Drop a formula into LAMMPS
==========================

Codes of many particles have JKR or DMT built in. ``fem-adhesion formulas`` writes closed expressions that hold for
any Tabor parameter, in Python, C, Fortran and LaTeX, and says what each code means by its parameters. Two files of
C go into your pair style; the Python file shows the numbers.

Here a granular pair of LAMMPS with ``cohesion`` 0.05 N/m is turned into our parameters.
"""

import runpy
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from fem_adhesion import cli

with tempfile.TemporaryDirectory() as folder:
    cli.main(["formulas", "--out", f"{folder}/formulas"])
    ours = runpy.run_path(str(Path(folder) / "formulas/adhesion.py"))

R, E, dgamma = ours["from_lammps"](cohesion=0.05, r1=1e-6, r2=1e-6, emix=1e9)
tabor = (R * dgamma**2 / E**2) ** (1 / 3) / 0.3e-9  # the surfaces rest 0.3 nm apart
print(f"Tabor parameter {tabor:.2f}, pull-off force {-ours['pull_off'](tabor) * R * dgamma * 1e9:.1f} nN")
for unloading, label in ((False, "loading"), (True, "unloading")):
    depth = np.linspace(-6e-9, 6e-9, 300)
    plt.plot(depth * 1e9, [ours["force"](d, R, E, dgamma, tabor, unloading) * 1e9 for d in depth], label=label)
plt.xlabel("indentation (nm)")
plt.ylabel("force (nN)")
plt.legend()
