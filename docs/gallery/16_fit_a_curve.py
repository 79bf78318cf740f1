r"""
Fit a measured curve
====================

Your AFM has recorded force against the travel of the piezo, on the way in and on the way out. What are the work of
adhesion and the range of the attraction? Give the curve as CSV, its units in the header, or as the file of the
instrument, with what you know of the tip and the cantilever::

    fem-adhesion fit curve.csv --radius 50nm --modulus 5GPa --poisson 0.3 \
        --stiffness 2N/m --plot fit.png

Here the curve is made up, with noise, so that the truth is known: 0.05 J/m², and a spacing of 0.3 nm.
"""

import tempfile
from pathlib import Path

import numpy as np

from fem_adhesion import cli
from halfspace import atlas, scaling
from halfspace.theories import closed_forms

tip = scaling.Units(radius=50e-9, modulus=scaling.contact_modulus(5e9, 0.3), work_of_adhesion=0.05, spacing=0.3e-9)
curve, stiffness = atlas.curve(tip.tabor), 2.0 / tip.stiffness
branches = curve.branches("base", stiffness=stiffness)
(far, on), (off, pressed) = branches["separated"], branches["contact"]
travel = np.linspace(-100, min(pressed, 25), 200)  # of the cantilever's base, in units of the spacing

lines, noise = ["piezo_m,force_N,segment"], np.random.default_rng(1)
for segment, jump, bases in (("approach", on, travel), ("retract", off, travel[::-1])):
    loads = closed_forms.bradley_load(bases)  # beyond the atlas, where it is rigid
    for branch, there in (("separated", (far <= bases) & (bases < jump)), ("contact", jump <= bases)):
        loads[there] = curve.at(base=bases[there], stiffness=stiffness, branch=branch).load
    forces = loads * tip.load + noise.normal(0, 5e-11, loads.size)
    lines += [f"{base * tip.approach:.6e},{force:.6e},{segment}" for base, force in zip(bases, forces, strict=True)]

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "curve.csv"
    file.write_text("\n".join(lines) + "\n")
    known = "--radius 50nm --modulus 5GPa --poisson 0.3 --stiffness 2N/m --models jkr --plot fit.png"
    cli.main(["fit", str(file), *known.split()])
