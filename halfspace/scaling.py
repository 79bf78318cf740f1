"""SI units to the dimensionless ones of the project and back, and the parameters that others use for Tabor's.

This is the one place where SI units enter and leave: divide by a unit on the way in, multiply by it on the way out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from halfspace.errors import InputError
from halfspace.limits import require_positive
from halfspace.values import Array

__all__ = [
    "ATTARD_PARKER",
    "HAMAKER",
    "IN_SI",
    "MAUGIS",
    "MYD",
    "MYD_AMPLIFICATION",
    "Parameter",
    "Units",
    "contact_modulus",
    "equivalent_radius",
    "spacing_of",
]

HAMAKER = 16 * math.pi  # A/(dgamma eps^2) of the 3-9 law


@dataclass(frozen=True)
class Units:
    """Units of a contact, in SI.

    Parameters
    ----------
    radius : float
        Equivalent radius R of the spheres in m, see `equivalent_radius`.
    modulus : float
        Contact modulus E* in Pa, see `contact_modulus`.
    work_of_adhesion : float
        Work of adhesion dgamma in J/m^2.
    spacing : float
        Equilibrium spacing eps of the surface law in m. Not an atom's diameter: of work of adhesion, spacing and
        Hamaker constant two are independent, see `hamaker`, and `spacing_of` for the constant in the spacing's place.

    Examples
    --------
    A pull-off force in newtons is ``-pull_off.load * units.load``.
    """

    radius: float
    modulus: float
    work_of_adhesion: float
    spacing: float

    def __post_init__(self) -> None:
        """Refuse what is not finite and positive."""
        for field, unit in zip(fields(self), ("m", "Pa", "J/m^2", "m"), strict=True):
            require_positive(getattr(self, field.name), field.name, f"give it in {unit}", unit)

    @property
    def tabor(self) -> float:
        """Tabor parameter, mu^3 = R dgamma^2/(E*^2 eps^3)."""
        return math.cbrt(self.radius * (self.work_of_adhesion / self.modulus) ** 2) / self.spacing

    @property
    def radius_ratio(self) -> float:
        """Ratio rho = R/eps of a finite sphere."""
        return self.radius / self.spacing

    @property
    def hamaker(self) -> float:
        """Hamaker constant A = 16 pi dgamma eps^2 in J that the surface law implies.

        Far apart the 3-9 law is (8 dgamma/3 eps)(eps/h)^3, and van der Waals' attraction of half-spaces A/(6 pi h^3).
        """
        return HAMAKER * self.work_of_adhesion * self.spacing**2

    @property
    def length(self) -> float:
        """Unit beta of radii along the surface, beta^3 = R^2 dgamma/E*, in m."""
        return math.cbrt(self.radius**2 * self.work_of_adhesion / self.modulus)

    @property
    def approach(self) -> float:
        """Unit eps of gaps and approach in m."""
        return self.spacing

    @property
    def load(self) -> float:
        """Unit R dgamma of loads in N."""
        return self.radius * self.work_of_adhesion

    @property
    def pressure(self) -> float:
        """Unit dgamma/(mu eps) of pressures in Pa."""
        return self.work_of_adhesion / (self.tabor * self.spacing)

    @property
    def stiffness(self) -> float:
        """Unit R dgamma/eps of stiffness, of the contact and of the apparatus, in N/m."""
        return self.load / self.approach

    @property
    def energy(self) -> float:
        """Unit R dgamma eps of energies in J."""
        return self.load * self.approach

    @property
    def displacement(self) -> float:
        """Unit beta^2/R = mu eps of displacements in m."""
        return self.tabor * self.approach

    @property
    def energy_density(self) -> float:
        """Unit E* (beta/R)^2 of energies per volume in J/m^3."""
        return self.pressure**2 / self.modulus

    def si(self, quantity: str) -> tuple[float, str]:
        """Size in SI of the unit of one of the quantities `IN_SI`, and its unit there."""
        name, unit = IN_SI[quantity]
        return float(getattr(self, name)), unit


IN_SI: Mapping[str, tuple[str, str]] = {
    "approach": ("approach", "m"),
    "central_gap": ("approach", "m"),
    "gap": ("approach", "m"),
    "contact_radius": ("length", "m"),
    "radius": ("length", "m"),
    "displacement": ("displacement", "m"),
    "load": ("load", "N"),
    "pressure": ("pressure", "Pa"),
    "energy": ("energy", "J"),
    "energy_density": ("energy_density", "J/m^3"),
    "stiffness": ("stiffness", "N/m"),
}
"""Quantities, the property of `Units` that is their unit's size, and their unit in SI."""


def spacing_of(hamaker: float, work_of_adhesion: float) -> float:
    """Equilibrium spacing eps in m of the surface law with a Hamaker constant in J and a work of adhesion in J/m^2."""
    require_positive(hamaker, "hamaker", "give it in J", "J")
    require_positive(work_of_adhesion, "work_of_adhesion", "give it in J/m^2", "J/m^2")
    return math.sqrt(hamaker / work_of_adhesion / HAMAKER)


def contact_modulus(young: float, poisson: float, other_young: float = math.inf, other_poisson: float = 0.0) -> float:
    """Contact modulus E* in Pa of two bodies: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2; the other is rigid by default."""
    compliance = _plane_strain_compliance(young, poisson) + _plane_strain_compliance(other_young, other_poisson)
    if compliance == 0:
        raise InputError("young = inf for both bodies is outside young < inf for one; give the modulus of the softer")
    return 1 / compliance


def equivalent_radius(radius: float, other_radius: float = math.inf) -> float:
    """Equivalent radius R in m of two spheres: 1/R = 1/R1 + 1/R2; flat if infinite, a socket if negative."""
    curvature = 1 / radius + 1 / other_radius if radius and other_radius else math.nan
    if not 0 < curvature < math.inf:
        raise InputError(
            f"radius = {radius:g} m and {other_radius:g} m have a curvature 1/R1 + 1/R2 outside 0 < 1/R; "
            "let a socket (negative) be wider than its ball, and a flat infinite"
        )
    return 1 / curvature


def _plane_strain_compliance(young: float, poisson: float) -> float:
    if young != math.inf:
        require_positive(young, "young", "give it in Pa", "Pa")
    if not -1 < poisson <= 0.5:
        raise InputError(f"poisson = {poisson:g} is outside -1 < poisson <= 0.5; take 0.5 for rubber")
    return (1 - poisson**2) / young


@dataclass(frozen=True)
class Parameter:
    """A parameter in use for the Tabor parameter mu, [G97] App. A: factor mu^power.

    Pass from one to another by way of mu: ``MAUGIS.of(ATTARD_PARKER.tabor(0.5))``.
    """

    factor: float
    power: float = 1.0

    def of(self, tabor: ArrayLike) -> Array:
        """Value at a Tabor parameter."""
        return np.asarray(self.factor * np.asarray(tabor, float) ** self.power)

    def tabor(self, value: ArrayLike) -> Array:
        """Tabor parameter at a value."""
        return np.asarray((np.asarray(value, float) / self.factor) ** (1 / self.power))


MYD_AMPLIFICATION = Parameter(math.cbrt(6 * math.pi**2))  # mu_T = 3.898 mu, Muller, Yushchenko & Derjaguin
MYD = Parameter(32 / (3 * math.pi) * math.cbrt(2 / math.pi))  # mu_D = 2.9208 mu, the same (1980), Pashley (1984)
MAUGIS = Parameter(16 / (9 * math.sqrt(3)) * math.cbrt(9 / (2 * math.pi)))  # lambda = 1.1570 mu at the same tension
ATTARD_PARKER = Parameter(0.5, 1.5)  # sigma_AP = mu^(3/2)/2


def __dir__() -> list[str]:
    return __all__
