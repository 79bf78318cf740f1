"""A real contact in SI, checked, and its passage to the dimensionless one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from halfspace.errors import InputError
from halfspace.limits import require_poisson
from halfspace.scaling import Units, contact_modulus, equivalent_radius


@dataclass(frozen=True)
class Contact:
    """A sphere against a wall or another sphere, in SI.

    Parameters
    ----------
    radius, modulus, poisson : float
        Radius in m, Young's modulus in Pa and Poisson's ratio of the sphere, 0 <= poisson <= 0.499999.
    work_of_adhesion : float
        In J/m^2.
    spacing : float
        Equilibrium spacing of the surface law in m.
    counter_modulus, counter_poisson : float, optional
        Of the other body; rigid unless both are given.
    counter_radius : float
        Of the other body in m; flat by default.
    stiffness : float
        Of the cantilever in N/m; infinite for fixed grips.

    Raises
    ------
    InputError
        If a value is out of range or one of the other body's two is missing.
    """

    radius: float
    modulus: float
    poisson: float
    work_of_adhesion: float
    spacing: float
    counter_modulus: float | None = None
    counter_poisson: float | None = None
    counter_radius: float = math.inf
    stiffness: float = math.inf

    def __post_init__(self) -> None:
        require_poisson(self.poisson)
        if not self.stiffness > 0:
            raise InputError(
                f"stiffness = {self.stiffness:g} N/m is outside 0 < stiffness; leave it out for fixed grips"
            )
        given = {"counter_modulus": self.counter_modulus, "counter_poisson": self.counter_poisson}
        missing = [name for name, value in given.items() if value is None]
        if len(missing) == 1:
            raise InputError(f"{missing[0]} = None, limit: with both or none of {' and '.join(given)}; give it too")
        self.units  # noqa: B018  it refuses what is not positive

    @cached_property
    def units(self) -> Units:
        """Units of the contact."""
        both = self.counter_modulus is not None and self.counter_poisson is not None
        other = (self.counter_modulus, self.counter_poisson) if both else ()
        modulus = contact_modulus(self.modulus, self.poisson, *other)
        return Units(equivalent_radius(self.radius, self.counter_radius), modulus, self.work_of_adhesion, self.spacing)

    @property
    def reduced_stiffness(self) -> float:
        """Stiffness of the cantilever in R dgamma/eps."""
        return self.stiffness / self.units.stiffness

    @property
    def both_elastic(self) -> bool:
        """Whether the other body deforms too."""
        return self.counter_modulus is not None
