"""
A soft bead on a cantilever
===========================

A silicone bead of 2.5 µm radius is pressed on glass and pulled off by a cantilever. The bead is so soft that it
follows JKR's theory closely, but the surfaces still jump into contact before they touch, which that theory does not
have.

The atlas knows the whole curve for any Tabor parameter up to 300 without solving. `base` is the height of the far
end of the cantilever, in units of the spacing; the force follows from it, on the way in and on the way out.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfspace import atlas, scaling

bead = scaling.Units(radius=2.5e-6, modulus=scaling.contact_modulus(10e6, 0.49), work_of_adhesion=0.05, spacing=0.4e-9)
stiffness = 40 / bead.stiffness  # of the cantilever, 40 N/m
curve = atlas.curve(bead.tabor)
print(f"Tabor parameter {bead.tabor:.0f}, pull-off force {-atlas.pull_off(bead.tabor).load * bead.load * 1e9:.1f} nN")

branches = curve.branches("base", stiffness=stiffness)
(far, on), (off, _) = branches["separated"], branches["contact"]


def draw(label, *parts):
    """Draw the force along parts of the curve, one after the other, with the jump between them."""
    bases = [np.linspace(start, end, 300) for start, end, _ in parts]
    forces = [
        curve.at(base=base, stiffness=stiffness, branch=part[2]).load for base, part in zip(bases, parts, strict=True)
    ]
    plt.plot(np.concatenate(bases) * bead.approach * 1e9, np.concatenate(forces) * bead.load * 1e9, label=label)


draw("in", (far, on, "separated"), (on, 100, "contact"))
draw("out", (100, off, "contact"), (off, far, "separated"))
plt.xlabel("height of the cantilever's base, pressed down is positive (nm)")
plt.ylabel("force (nN)")
plt.legend()
