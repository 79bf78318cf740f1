"""Laws by a formula for the tension at the gap H: powers of it, exponentials, both, and constant up to a range."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from halfspace.errors import InputError
from halfspace.laws.law import Law
from halfspace.limits import require_between, require_number
from halfspace.values import Array, keep

HARDEST = 60  # largest power of a core


@dataclass(frozen=True)
class PowerLaw(Law):
    """Attraction and repulsion by inverse powers of the gap, normalised to the work of adhesion ([G97] 1.2, 2.5, 2.9).

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
        if not n < m <= HARDEST:
            raise InputError(
                f"repulsion = {m:g} of the power law is outside attraction = {n:g} < repulsion <= {HARDEST}; "
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


def _inverse_range(k: float, of: str) -> float:
    """The inverse range k of an exponential, in 1/eps."""
    return require_between(k, "k", 0.1, 50.0, "take 3", of)


@dataclass(frozen=True)
class Morse(Law):
    """Attraction and repulsion that both fall exponentially (P. M. Morse, Phys. Rev. 34 (1929) 57).

    The tension is 2 k dgamma/eps (e^(-k H) - e^(-2 k H)); as stiff as the 3-9 law at k = sqrt 8, as strong at k = 2.05.
    It is 2 k^2 dgamma/eps^2 stiff and k dgamma/(2 eps) strong, at H = ln 2/k. It has no core: of nearly rigid bodies in
    compression the gap falls below zero. The inverse range k is in units of 1/eps, 0.1 to 50, or InputError.
    """

    k: float

    def __post_init__(self) -> None:
        keep(self, k=_inverse_range(self.k, " of Morse's law"))

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


@dataclass(frozen=True)
class Exponential(Law):
    """Exponential attraction with a power-law core, as of solvation and of screened charges of unlike sign.

    The tension is c dgamma/eps e^(-k H) (1 - (eps/h)^m), 1/c = 1/k - e^k E_m(k) with the exponential integral E_m. The
    inverse range k of the attraction is in units of 1/eps, 0.1 to 50, the core's power m 2 to 60, or InputError.
    """

    k: float
    core: int = 9

    def __post_init__(self) -> None:
        of = " of the exponential law"
        k, m = _inverse_range(self.k, of), require_number(self.core, "core")
        if not (2 <= m <= HARDEST and m.is_integer()):
            raise InputError(f"core = {m:g}{of} is outside a whole number, 2 <= core <= {HARDEST}; take 9")
        keep(self, k=k, core=int(m))

    @property
    def amplitude(self) -> float:
        """Factor c by which the work of adhesion is dgamma."""
        from scipy.special import expn  # it takes as long to load as all else, and few need it

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
        from scipy.special import expn  # as above

        h, k, m = gap + 1, self.k, self.core
        core = math.exp(k) * h ** (1 - float(m)) * expn(m, k * h)
        return np.asarray(self.amplitude * tabor * (core - np.exp(-k * gap) / k))


@dataclass(frozen=True)
class Dlvo(Law):
    """Van der Waals attraction, screened charges and a core: Derjaguin, Landau, Verwey and Overbeek (1941, 1948).

    The tension is c dgamma/eps [(eps/h)^3 - q e^(-kappa H) - (1 - q) (eps/h)^9], 1/c = 1/2 - q/kappa - (1 - q)/8. The
    charge q is the double layer's part of the repulsion at equilibrium: positive of like, negative of unlike
    charges. The screening kappa is the inverse Debye length in units of 1/eps, 0.02 to 50. InputError if one is out of
    range, or the charges leave no adhesion or no core.
    """

    charge: float
    screening: float

    def __post_init__(self) -> None:
        q = require_number(self.charge, "charge")
        kappa = require_between(self.screening, "screening", 0.02, 50.0, "take 1")
        if not (q < 1 and 9 * (1 - q) + kappa * q > 3):
            limit = "charge < 1 and 9 (1 - charge) + screening charge > 3"
            raise InputError(f"charge = {q:g} leaves no core at screening = {kappa:g}, limit: {limit}; take 0.3")
        if not 3 / 8 + q / 8 - q / kappa > 0:
            limit = f"{'<' if kappa < 8 else '>'} {3 / (8 / kappa - 1):.3g}"
            raise InputError(f"charge = {q:g} leaves no work of adhesion, limit: charge {limit} at this screening")
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


@dataclass(frozen=True)
class Dugdale(Law):
    """A constant tension up to a range (D. Maugis, J. Colloid Interface Sci. 150 (1992)), smoothed.

    The tension is c dgamma/eps [S(H) - S(0) e^(-H/w^2)], S = 1/(1 + e^((H - 1)/w)), 1/c = w ln(1 + e^(1/w)) - S(0) w^2.
    It rises within w^2 and falls within w about the range eps. In the limit w = 0 it is Maugis's, of the tension
    dgamma/eps; his parameter is then (9/2 pi)^(1/3) times the Tabor parameter. Loads and approaches differ from
    his by terms in w^2 and w^4, to be extrapolated from 0.16, 0.11 and 0.08, and so do radii where the gap is open by
    0.2 eps. Those of the contact do in w^(2/3): its edge is where the gap is about w, and it opens as power 3/2 of the
    distance. The width w is in eps, 0.07 to 0.5, or InputError.
    """

    width: float

    def __post_init__(self) -> None:
        remedy = "extrapolate from 0.16, 0.11 and 0.08, or take 0.1"
        keep(self, width=require_between(self.width, "width", 0.07, 0.5, remedy, " of Dugdale's law"))

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
