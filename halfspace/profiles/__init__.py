"""Profiles of the undeformed surfaces: the gap's height over that on the axis against the radius.

`profile` says what each must know of itself. `formulas` has the paraboloid, which is the default, its like, and the
true shape of one sphere or two; `tabulated` is read from a file, or the surface of a body that is given as a mesh.
"""

from halfspace.profiles.formulas import PARABOLOID, Hyperboloid, Paraboloid, Power, RoundedPunch, Sphere
from halfspace.profiles.profile import Endless, Profile, Surface, require_profile
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


def __dir__() -> list[str]:
    return __all__
