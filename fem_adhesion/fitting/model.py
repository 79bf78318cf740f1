"""Force that an apparatus records: a curve of a theory, seen by a spring whose base travels.

The base of a spring of stiffness k stands at b = alpha* + W/k. On the way in the contact follows the separated branch
up to the first turn of b, takes off there and lands on the contact branch; on the way out it follows the contact
branch down to the last turn and tears off. What lies between is unstable: no apparatus of that stiffness records it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from halfspace import atlas
from halfspace.atlas.series import LEAST, MOST
from halfspace.scaling import Units, contact_modulus, equivalent_radius
from halfspace.theories import curves
from halfspace.values import Array


@dataclass(frozen=True)
class ModelSettings:
    """Places on the curves that are fitted, and how far these go."""

    count: int = 801  # places on a curve of the atlas; linear between them, the load is within 1e-3 R dgamma
    beyond: int = 160  # places on each of its two continuations
    farthest: float = 1e5  # approach in (1 + tabor) eps to which the attraction is continued
    widest: float = 25.0  # contact radius in beta to which the compression is continued: a load of 2e4 R dgamma


HOW = ModelSettings()

EVEN = np.linspace(0.0, 1.0, HOW.beyond)
STIFFEST = 1e-4  # Tabor parameter up to which a sphere is rigid
SOFTEST = 1e4  # Tabor parameter from which on curves are JKR's but for a hundredth of tabor eps

Theory = Callable[[Units], Array]
"""Approach in eps and load in R dgamma, (2, n), from separation to compression, of a contact."""


def by_atlas(units: Units) -> Array:
    """Curve of the atlas, continued: the attraction as h^-2, the compression by Hertz with a constant tension.

    Both meet the atlas's end, the latter with its slope: 5 R dgamma and more, where Maugis's theory and it are apart
    by 0.1 tabor eps at most up to 100 R dgamma. Beyond the atlas's Tabor parameters the contact is JKR's, and before
    it the far attraction raises a bulge. Below them the sphere is rigid, and the atlas' least Tabor parameter serves:
    it yields by 0.01 eps under a load of R dgamma.
    """
    tabor = max(units.tabor, LEAST)
    if tabor > MOST:
        return _closed(curves.jkr_with_reach, units)
    curve = atlas.table(tabor, HOW.count)
    last, push = curve[:, -1]
    slope = np.gradient(curve[1, -3:], curve[0, -3:], edge_order=2)[-1]
    a = slope * tabor / 2  # of the Hertz contact that is as stiff, dW/dalpha* = 2 a/mu
    wider = a * (HOW.widest / a) ** EVEN[1:]
    alpha, load = last + tabor * (wider**2 - a**2), push + 4 / 3 * (wider**3 - a**3)
    return attracted(np.hstack([curve, [alpha, load]]), tabor, 2)


def attracted(curve: Array, tabor: float, power: float) -> Array:
    """Curve with the attraction before it, which falls by a power of the gap."""
    first, pull = curve[:, 0]
    h = (1 - first) * (HOW.farthest * (1 + tabor) / (1 - first)) ** EVEN[:0:-1]
    return np.hstack([[1 - h, pull * ((1 - first) / h) ** power], curve])


def _closed(curve: Callable[[float, curves.Sampling], Array], units: Units) -> Array:
    """Curve of a theory in closed form."""
    return curve(units.tabor, curves.Sampling(HOW.farthest * (1 + units.tabor), HOW.widest, HOW.count))[:2]


def by_jkr(units: Units) -> Array:
    """JKR's curve: no attraction before contact, so that eps is but the unit of the approach."""
    return _closed(curves.jkr, units)


THEORIES: Mapping[str, Theory] = {
    "atlas": by_atlas,
    "maugis-dugdale": partial(_closed, curves.maugis_dugdale),  # with the largest tension of the 3-9 law
    "jkr": by_jkr,
    "dmt": partial(_closed, curves.dmt_maugis),  # rigid until it touches, then Hertz's under a constant tension (DMT-M)
}
"""Theories by name."""


@dataclass(frozen=True)
class Branches:
    """The two stable branches on a spring, each as bases and loads (2, n), and the bases of take-off.

    Without a turn both branches are the whole curve, and `on` and `off` where it is steepest: where a jump would be
    born on a softer spring.
    """

    separated: Array
    contact: Array
    on: float
    off: float

    def place(self, segment: int) -> float:
        """Base of the jump of a segment, 0 the approach and 1 the retract."""
        return self.off if segment else self.on

    @property
    def jumps(self) -> bool:
        """Whether the contact jumps."""
        return self.off < self.on


def branches(curve: Array, stiffness: float) -> Branches:
    """Branches of a curve on a spring of a stiffness in R dgamma/eps."""
    load = curve[1]
    base = curve[0] + load / stiffness
    falls = np.diff(base) < 0
    turns = np.flatnonzero(falls[1:] != falls[:-1]) + 1
    tops, bottoms = turns[falls[turns]], turns[~falls[turns]]
    if not tops.size:
        whole = np.array([base, load])
        steepest = int(np.argmax(np.diff(load) / np.maximum(np.diff(base), 1e-12)))
        at = float(base[steepest : steepest + 2].mean())
        return Branches(whole, whole, at, at)
    i, j = int(tops[0]), int(bottoms[-1])
    on, off = _turn(base, load, i), _turn(base, load, j)
    separated = np.column_stack([[base[:i], load[:i]], on])
    contact = np.column_stack([off, [base[j + 1 :], load[j + 1 :]]])
    return Branches(separated, contact, float(on[0]), float(off[0]))


def _turn(base: Array, load: Array, i: int) -> Array:
    """Base and load where the base turns, by the parabola through three places."""
    (before, at, after), w = base[i - 1 : i + 2], load[i - 1 : i + 2]
    rate, bend = (after - before) / 2, after - 2 * at + before
    t = -rate / bend
    return np.array([at + rate * t / 2, w[1] + t * (w[2] - w[0]) / 2 + t**2 * (w[2] - 2 * w[1] + w[0]) / 2])


@dataclass(frozen=True)
class Apparatus:
    """A contact and what records it, in SI.

    Parameters
    ----------
    radius, modulus : float
        Of the sphere, in m and Pa (Young's).
    work_of_adhesion, spacing : float
        In J/m^2 and m.
    contact_point : float
        Travel in m at which alpha* + W/k is zero.
    stiffness : float
        Of the spring, in N/m.
    sensitivity : float
        True deflection over the recorded one.
    compliance : float
        Of what else yields in series with the spring, in m/N.
    poisson : float
        Poisson's ratio of the sphere.
    counter_modulus, counter_poisson, counter_radius : float
        Of the other body, which is rigid and flat unless given.
    """

    radius: float
    modulus: float
    work_of_adhesion: float
    spacing: float
    contact_point: float
    stiffness: float
    sensitivity: float = 1.0
    compliance: float = 0.0
    poisson: float = field(kw_only=True)
    counter_modulus: float = np.inf
    counter_poisson: float = 0.0
    counter_radius: float = np.inf

    @property
    def units(self) -> Units:
        """Units of the contact."""
        modulus = contact_modulus(self.modulus, self.poisson, self.counter_modulus, self.counter_poisson)
        radius = equivalent_radius(self.radius, self.counter_radius)
        return Units(radius, modulus, self.work_of_adhesion, self.spacing)


def recorded(curve: Array, apparatus: Apparatus, nominal: float | None = None) -> Branches:
    """Branches of a theory's curve as an apparatus records it: travels in m, forces in N, without offset and drift.

    A force that was computed from a deflection by a nominal stiffness is wrong as that is.
    """
    units, compliance = apparatus.units, 1 / apparatus.stiffness + apparatus.compliance
    found = branches(curve, 1 / (compliance * units.stiffness))
    force = units.load / apparatus.sensitivity * (nominal / apparatus.stiffness if nominal else 1.0)
    scale, origin = np.array([[units.spacing], [force]]), np.array([[apparatus.contact_point], [0.0]])
    on, off = (apparatus.contact_point + units.spacing * at for at in (found.on, found.off))
    return Branches(origin + scale * found.separated, origin + scale * found.contact, on, off)
