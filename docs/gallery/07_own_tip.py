r"""
Your own tip
============

You have measured the profile of your tip: radius and height, in one unit, as two columns of a CSV file. The table
is read as a smooth surface of revolution. The radius of curvature at its apex is found from the table, and R/ε says
how large it is.

Of a contact in SI, the command says what the tip does, and how far a paraboloid is from it, with the table in the unit
that its header says, ``r_nm,z_nm``::

    fem-adhesion assess --radius 100nm --modulus 72GPa --poisson 0.17 \
        --work-of-adhesion 0.063J/m^2 --spacing 0.2nm --profile tabulated:tip.csv

Here the table is that of a tip that steepens faster than a sphere; a sphere of the same radius at the apex stands
beside it.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import halfspace

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "tip.csv"
    radius = np.linspace(0, 60, 61)  # nm
    height = radius**2 / 200 + radius**4 / 2e5  # nm: 100 nm of radius at the apex, steeper outside
    np.savetxt(file, np.transpose([radius, height]), delimiter=",", header="radius_nm,height_nm")
    tip = halfspace.profiles.Tabulated(file, radius_ratio=500.0)
    worn = halfspace.trace(1.0, profile=tip, rtol=1e-4)

sphere = halfspace.trace(1.0, profile=halfspace.profiles.Sphere(500.0), rtol=1e-4)
for path, label in ((worn, "measured tip"), (sphere, "sphere")):
    curve = path.resampled(150)
    plt.plot(curve.approach, curve.load, label=f"{label}: {-path.event('pull_off').load:.3f} R Δγ")
plt.xlim(-4, 4)
plt.xlabel("approach (ε)")
plt.ylabel("load (R Δγ)")
plt.legend(title="pull-off force")
