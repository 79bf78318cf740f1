"""Profiles of the undeformed surfaces: the gap's height over that on the axis against the radius.

`profile` says what each must know of itself. `formulas` has the paraboloid, which is the default, and its like;
`sphere` is the true shape of one sphere or two; `tabulated` is read from a file, or the surface of a body that is given
as a mesh.
"""

from halfspace.profiles.formulas import PARABOLOID, Hyperboloid, Paraboloid, Power, RoundedPunch
from halfspace.profiles.profile import Endless, Profile, Surface, require_profile
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
    "require_profile",
]
