"""What a contact asks of the law of tension between two surfaces.

Gaps enter as H = h/eps - 1, eps the spacing at which the tension vanishes. Pressures leave as P = mu eps p/dgamma,
positive in compression, so that they are mu times what depends on the law alone. The work of adhesion dgamma is the
integral of the tension from there to infinity.
"""

from __future__ import annotations

from typing import Protocol

from halfspace.values import Array


class Law(Protocol):
    """Pressure between two surfaces as a function of their gap."""

    @property
    def edge_gap(self) -> float:
        """H at which the tension is largest: it defines the contact edge."""
        ...

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P at gaps H."""
        ...

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        ...

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi(H) with -dPhi/dH = P and Phi = 0 far apart; multiply by R dgamma eps for an energy per beta^2."""
        ...
