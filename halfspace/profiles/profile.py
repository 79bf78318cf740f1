"""What a contact asks of the profile of the undeformed surfaces.

A `Surface` is what the equations take: heights z in beta^2/R = mu eps against radii in beta. A `Profile` is what is
asked for. Most are the same surface at every Tabor parameter; one with a length of its own, as R/eps, is not.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol, Self

import numpy as np

from halfspace.limits import off_derivative, require_all, require_part
from halfspace.values import Array


class Surface(ABC):
    """Height of the undeformed surface over its pole as a function of the radius, which rises.

    `end` is the radius in beta at which it ends, infinite if it does not. It is as smooth across the axis as a
    paraboloid unless it says otherwise.
    """

    end: float

    @property
    def pointed(self) -> bool:
        """Whether it rises from the axis as a power of the radius that is no polynomial in its square."""
        return False

    @property
    def pieced(self) -> bool:
        """Whether some derivative leaps between pieces of it, as of a spline."""
        return False

    @abstractmethod
    def height(self, radii: Array) -> Array:
        """Height in beta^2/R at radii in beta."""

    @abstractmethod
    def slope(self, radii: Array) -> Array:
        """Derivative of the height by the radius."""

    def first_cell(self, tolerance: float) -> float:  # noqa: ARG002 (smooth)
        """Length in beta of an axis cell of which one node leaves `tolerance`; infinite if a paraboloid's will do."""
        return np.inf


class Profile(Protocol):
    """Shape of the undeformed surfaces."""

    def surface(self, tabor: float) -> Surface:
        """Heights in beta^2/R against radii in beta at a Tabor parameter."""


def require_profile(profile: Profile) -> Profile:
    """Return a profile, or raise InputError for what is none; one of its own length is checked where that is given."""
    require_part(profile, "profile", "surface", "halfspace.profiles.Sphere(100)")
    if isinstance(profile, Endless):
        r = np.geomspace(0.01, 10.0, 700)
        rest, heights, slopes = float(profile.height(np.array(0.0))), profile.height(r), profile.slope(r)
        least = float(np.min(np.diff(heights, prepend=0.0)))
        off = off_derivative(slopes, profile.height, r, r, np.abs(slopes) + np.abs(heights) / r + 1e-12)
        require_all(
            profile,
            (f"the height on the axis is {rest:.3g} beta^2/R", abs(rest) < 1e-12, "0", "subtract it"),
            (f"the height falls by {-least:.3g} beta^2/R", least >= 0 < heights[-1], "rising", "let it rise outwards"),
            (f"the slope is off by {off:.2g} from the height's derivative", off < 1e-4, "0.0001", "mend either"),
        )
    return profile


class Dimensionless(Surface):
    """A profile that is the same surface at every Tabor parameter."""

    def surface(self, tabor: float) -> Self:  # noqa: ARG002 (the same at all)
        """Return the profile itself."""
        return self


class Endless(Dimensionless):
    """One that goes on for ever: a profile of one's own is a class on this one with `height` and `slope`."""

    end: float = np.inf
