"""Exponential attraction with a power-law core, as of solvation and of screened charges of unlike sign."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import expn

from halfspace.errors import InputError
from halfspace.laws.law import Law
from halfspace.limits import require_between, require_number
from halfspace.values import Array, keep

LEAST, MOST = 0.1, 50.0
SOFTEST, HARDEST = 2, 60
OF = " of the exponential law"


@dataclass(frozen=True)
class Exponential(Law):
    """Tension c dgamma/eps e^(-k H) (1 - (eps/h)^m), 1/c = 1/k - e^k E_m(k) with the exponential integral E_m.

    The inverse range k of the attraction is in units of 1/eps, 0.1 to 50, the core's power m 2 to 60, or InputError.
    """

    k: float
    core: int = 9

    def __post_init__(self) -> None:
        k, m = require_between(self.k, "k", LEAST, MOST, "take 3", OF), require_number(self.core, "core")
        if not (SOFTEST <= m <= HARDEST and m.is_integer()):
            limit = f"a whole number, {SOFTEST} <= core <= {HARDEST}"
            raise InputError(f"core = {m:g}{OF} is outside {limit}; take 9")
        keep(self, k=k, core=int(m))

    @property
    def amplitude(self) -> float:
        """Factor c by which the work of adhesion is dgamma."""
        return 1 / (1 / self.k - math.exp(self.k) * float(expn(self.core, self.k)))

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P = c mu e^(-k H) (h^-m - 1)."""
        return np.asarray(self.amplitude * tabor * np.exp(-self.k * gap) * ((gap + 1) ** -float(self.core) - 1))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        h, k, m = gap + 1, self.k, float(self.core)
        return np.asarray(self.amplitude * tabor * np.exp(-k * gap) * (k - (k + m / h) * h**-m))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi = c mu (e^k h^(1-m) E_m(k h) - e^(-k H)/k)."""
        h, k, m = gap + 1, self.k, self.core
        core = math.exp(k) * h ** (1 - float(m)) * expn(m, k * h)
        return np.asarray(self.amplitude * tabor * (core - np.exp(-k * gap) / k))
