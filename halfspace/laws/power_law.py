"""Attraction and repulsion by inverse powers of the gap, 3 and 9 for Lennard-Jones solids ([G97] 1.2, 2.5, 2.9)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from halfspace.errors import InputError
from halfspace.laws.law import Law
from halfspace.limits import require_number
from halfspace.values import Array

STEEPEST = 60.0


@dataclass(frozen=True)
class PowerLaw(Law):
    """Attraction and repulsion by inverse powers of the gap, normalised to the work of adhesion.

    sigma(h) = c dgamma/eps [(eps/h)^n - (eps/h)^m] is the tension, zero at h = eps; the amplitude c makes the integral
    of sigma from eps to infinity equal to dgamma. The exponents are 2 < n < m <= 60, or InputError; 3 and 9 for
    Lennard-Jones solids.
    """

    attraction: float = 3
    repulsion: float = 9

    def __post_init__(self) -> None:
        n, m = (require_number(getattr(self, name), name) for name in ("attraction", "repulsion"))
        if not n > 2:
            raise InputError(
                f"attraction = {n:g} of the power law is outside 2 < attraction: so slow a decay leaves profiles that "
                "widen as a cone without a load; take 3"
            )
        if not n < m <= STEEPEST:
            raise InputError(
                f"repulsion = {m:g} of the power law is outside attraction = {n:g} < repulsion <= {STEEPEST:g}; "
                "the surfaces need a core that the attraction does not reach, take 9"
            )

    @property
    def amplitude(self) -> float:
        """c: 8/3 for the 3-9 law [G97] (1.2)."""
        return 1 / (1 / (self.attraction - 1) - 1 / (self.repulsion - 1))

    @cached_property
    def edge_gap(self) -> float:
        """H at which the tension is largest, 3^(1/6) - 1 for the 3-9 law."""
        return float((self.repulsion / self.attraction) ** (1 / (self.repulsion - self.attraction)) - 1)

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P = c mu [(H+1)^-m - (H+1)^-n], [G97] (2.9) with its sign corrected."""
        h = gap + 1
        return self.amplitude * tabor * (h**-self.repulsion - h**-self.attraction)

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        h, n, m = gap + 1, self.attraction, self.repulsion
        return self.amplitude * tabor * (n * h ** -(n + 1) - m * h ** -(m + 1))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi(H) with -dPhi/dH = P and Phi = 0 far apart."""
        h, n, m = gap + 1, self.attraction, self.repulsion
        return self.amplitude * tabor * (h ** -(m - 1) / (m - 1) - h ** -(n - 1) / (n - 1))


def LennardJones() -> PowerLaw:
    """Return the 3-9 law, that of two half-spaces whose particles attract by the Lennard-Jones potential."""
    return PowerLaw(3, 9)


LENNARD_JONES = LennardJones()
