"""Morse's potential: attraction and repulsion that both fall exponentially (P. M. Morse, Phys. Rev. 34 (1929) 57)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from halfspace.laws.law import Law
from halfspace.limits import require_between
from halfspace.values import Array, keep

LEAST, MOST = 0.1, 50.0


@dataclass(frozen=True)
class Morse(Law):
    """Tension 2 k dgamma/eps (e^(-k H) - e^(-2 k H)); as stiff as the 3-9 law at k = sqrt 8, as strong at k = 2.05.

    It is 2 k^2 dgamma/eps^2 stiff and k dgamma/(2 eps) strong, at H = ln 2/k. It has no core: of nearly rigid bodies in
    compression the gap falls below zero. The inverse range k is in units of 1/eps, 0.1 to 50, or InputError.
    """

    k: float

    def __post_init__(self) -> None:
        keep(self, k=require_between(self.k, "k", LEAST, MOST, "take 3", " of Morse's law"))

    @property
    def edge_gap(self) -> float:
        """Ln 2/k."""
        return math.log(2) / self.k

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P = 2 k mu (e^(-2 k H) - e^(-k H))."""
        e = np.exp(-self.k * gap)
        return np.asarray(2 * self.k * tabor * e * (e - 1))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        e = np.exp(-self.k * gap)
        return np.asarray(2 * self.k**2 * tabor * e * (1 - 2 * e))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi = mu (e^(-2 k H) - 2 e^(-k H))."""
        e = np.exp(-self.k * gap)
        return np.asarray(tabor * e * (e - 2))

    def room(self, gap: Array) -> Array:
        """As for other laws, but over two lengths of the potential at least."""
        return np.maximum(gap + 1, 4 / self.k)
