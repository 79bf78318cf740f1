"""Van der Waals attraction, screened charges and a core: Derjaguin, Landau, Verwey and Overbeek (1941, 1948)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from halfspace.errors import InputError
from halfspace.laws.law import Law
from halfspace.limits import require_between, require_number
from halfspace.values import Array, keep

LEAST, MOST = 0.02, 50.0


@dataclass(frozen=True)
class Dlvo(Law):
    """Tension c dgamma/eps [(eps/h)^3 - q e^(-kappa H) - (1 - q) (eps/h)^9], 1/c = 1/2 - q/kappa - (1 - q)/8.

    The charge q is the double layer's part of the repulsion at equilibrium: positive of like, negative of unlike
    charges. The screening kappa is the inverse Debye length in units of 1/eps, 0.02 to 50. InputError if one is out of
    range, or the charges leave no adhesion or no core.
    """

    charge: float
    screening: float

    def __post_init__(self) -> None:
        q = require_number(self.charge, "charge")
        kappa = require_between(self.screening, "screening", LEAST, MOST, "take 1")
        if not (q < 1 and 9 * (1 - q) + kappa * q > 3):
            limit = "charge < 1 and 9 (1 - charge) + screening charge > 3"
            raise InputError(f"charge = {q:g} leaves no core at screening = {kappa:g}, limit: {limit}; take 0.3")
        if not 3 / 8 + q / 8 - q / kappa > 0:
            most = 3 / (8 / kappa - 1)
            raise InputError(f"charge = {q:g} leaves no work of adhesion, limit: charge < {most:.3g} at this screening")
        keep(self, charge=q, screening=kappa)

    @property
    def amplitude(self) -> float:
        """Factor c by which the work of adhesion is dgamma."""
        return 1 / (3 / 8 + self.charge / 8 - self.charge / self.screening)

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P = c mu [q e^(-kappa H) + (1 - q) h^-9 - h^-3]."""
        h, q = gap + 1, self.charge
        return np.asarray(self.amplitude * tabor * (q * np.exp(-self.screening * gap) + (1 - q) * h**-9.0 - h**-3.0))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        h, q, kappa = gap + 1, self.charge, self.screening
        layer = -q * kappa * np.exp(-kappa * gap)
        return np.asarray(self.amplitude * tabor * (layer - 9 * (1 - q) * h**-10.0 + 3 * h**-4.0))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi = c mu [q e^(-kappa H)/kappa + (1 - q) h^-8/8 - h^-2/2]."""
        h, q, kappa = gap + 1, self.charge, self.screening
        layer = q * np.exp(-kappa * gap) / kappa
        return np.asarray(self.amplitude * tabor * (layer + (1 - q) * h**-8.0 / 8 - h**-2.0 / 2))
