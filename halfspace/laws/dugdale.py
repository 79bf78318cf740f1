"""Dugdale's law, a constant tension up to a range (D. Maugis, J. Colloid Interface Sci. 150 (1992)), smoothed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from halfspace.laws.law import Law
from halfspace.limits import require_between
from halfspace.values import Array, keep

NARROWEST, WIDEST = 0.07, 0.5


@dataclass(frozen=True)
class Dugdale(Law):
    """Tension c dgamma/eps [S(H) - S(0) e^(-H/w^2)], S = 1/(1 + e^((H - 1)/w)), 1/c = w ln(1 + e^(1/w)) - S(0) w^2.

    It rises within w^2 and falls within w about the range eps. In the limit w = 0 it is Maugis's, of the tension
    dgamma/eps; his parameter is then (9/2 pi)^(1/3) times the Tabor parameter. Loads and approaches differ from
    his by terms in w^2 and w^4, to be extrapolated from 0.16, 0.11 and 0.08, and so do radii where the gap is open by
    0.2 eps. Those of the contact do in w^(2/3): its edge is where the gap is about w, and it opens as power 3/2 of the
    distance. The width w is in eps, 0.07 to 0.5, or InputError.
    """

    width: float

    def __post_init__(self) -> None:
        remedy = "extrapolate from 0.16, 0.11 and 0.08, or take 0.1"
        keep(self, width=require_between(self.width, "width", NARROWEST, WIDEST, remedy, " of Dugdale's law"))

    @cached_property
    def amplitude(self) -> float:
        """Factor c by which the work of adhesion is dgamma."""
        return -1 / float(self._work(np.array(0.0)))

    def _step(self, gap: Array) -> Array:
        """S."""
        return np.asarray(np.exp(-np.logaddexp(0, (gap - 1) / self.width)))

    def _core(self, gap: Array) -> Array:
        """S(0) e^(-H/w^2)."""
        return np.asarray(self._step_at_rest * np.exp(-gap / self.width**2))

    @cached_property
    def _step_at_rest(self) -> float:
        """S(0)."""
        return float(self._step(np.array(0.0)))

    def _work(self, gap: Array) -> Array:
        """Integral of the tension, without c, from infinity to a gap."""
        w = self.width
        return np.asarray(w**2 * self._core(gap) - w * np.logaddexp(0, (1 - gap) / w))

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P = c mu [S(0) e^(-H/w^2) - S(H)]."""
        return np.asarray(self.amplitude * tabor * (self._core(gap) - self._step(gap)))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        w, S = self.width, self._step(gap)
        return np.asarray(self.amplitude * tabor * (S * (1 - S) / w - self._core(gap) / w**2))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi = c mu [S(0) w^2 e^(-H/w^2) - w ln(1 + e^((1 - H)/w))]."""
        return np.asarray(self.amplitude * tabor * self._work(gap))

    def room(self, gap: Array) -> Array:
        """As for other laws, but over four times the rise at least, as it has no core."""
        return np.maximum(gap + 1, 4 * self.width**2)
