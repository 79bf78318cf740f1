"""Profiles of the undeformed surfaces, one a module: the gap's height over that on the axis against the radius.

`profile` says what each must know of itself. `paraboloid` is the default and `sphere` the true shape of one sphere or
two; `tabulated` is read from a file, or the surface of a body that is given as a mesh.
"""

from halfspace.profiles.hyperboloid import Hyperboloid
from halfspace.profiles.paraboloid import PARABOLOID, Paraboloid
from halfspace.profiles.power import Power
from halfspace.profiles.profile import Endless, Profile, Surface
from halfspace.profiles.rounded_punch import RoundedPunch
from halfspace.profiles.sphere import Sphere
from halfspace.profiles.tabulated import Tabulated

__all__ = [
    "PARABOLOID",
    "Endless",
    "Hyperboloid",
    "Paraboloid",
    "Power",
    "Profile",
    "RoundedPunch",
    "Sphere",
    "Surface",
    "Tabulated",
]
