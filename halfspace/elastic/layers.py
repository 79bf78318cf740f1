"""Layers on a base, or a coating on a half-space: how far their surface yields to waves of pressure of any length.

A pressure p J0(k r), frictionless, deflects the surface of a half-space by 2 p J0(k r)/(E* k), and that of a layered
body by S(k) times as much, E* being that of its first stratum. All strata are one recursion. In each, with zeta = k z
at the depth z, displacements U J1(k r), W J0(k r) and stresses sigma_rz = 2 G k T J1, sigma_zz = 2 G k N J0 are

    U =  e^-zeta [a + b zeta]                   + e^zeta [c - d zeta]
    W =  e^-zeta [a + b (zeta + 3 - 4 nu)]      - e^zeta [c - d (zeta - 3 + 4 nu)]
    T = -e^-zeta [a + b (zeta + 1 - 2 nu)]      + e^zeta [c - d (zeta - 1 + 2 nu)]
    N = -e^-zeta [a + b (zeta + 2 - 2 nu)]      - e^zeta [c - d (zeta - 2 + 2 nu)],

so that what holds below a stratum, displacement = M stress, becomes the same above it: there what comes back, c and d,
is told by what goes down, a and b, e^(-2 zeta) times smaller, zeta that of the whole stratum. Sources: the solutions
are Muki's (1960) for axial symmetry; of one bonded stratum the recursion is

    S(x) = [(3 - 4 nu) sinh 2x - 2x]/[(3 - 4 nu) cosh 2x + 2x^2 + 5 - 12 nu + 8 nu^2], x = k t,

and of one that slides (cosh 2x - 1)/(sinh 2x + 2x); both are tests.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, get_args, runtime_checkable

import numpy as np

from halfspace.errors import InputError
from halfspace.limits import require_film, require_one_of, require_poisson, require_stiffness, require_thickness
from halfspace.values import Array, keep

Foundation = Literal["bonded", "sliding"]

DEEP = 30.0  # wave number times depth from which what is below moves the surface by e^-60
WAVES = 300  # lengths of waves at which the yield of a body is looked at


@dataclass(frozen=True)
class Substrate:
    """An elastic half-space under the strata; InputError if a value is out of range.

    Parameters
    ----------
    modulus : float
        Young's, in units of that of the first stratum, 0.01 to 1000.
    poisson : float
        Poisson's ratio, 0 to 0.499999.
    """

    modulus: float
    poisson: float

    def __post_init__(self) -> None:
        keep(self, modulus=require_stiffness(self.modulus), poisson=require_poisson(self.poisson))


@dataclass(frozen=True)
class Stratum:
    """A homogeneous layer; InputError if a value is out of range.

    Parameters
    ----------
    thickness : float
        In beta, 0.01 to 1000.
    poisson : float
        Poisson's ratio, 0 to 0.499999.
    modulus : float
        Young's, in units of that of the first stratum, 0.01 to 1000.
    """

    thickness: float
    poisson: float = 0.3
    modulus: float = 1.0

    def __post_init__(self) -> None:
        keep(
            self,
            thickness=require_thickness(self.thickness),
            poisson=require_poisson(self.poisson),
            modulus=require_stiffness(self.modulus),
        )


@runtime_checkable
class LayeredBody(Protocol):
    """What the surface of a layered body follows from; E* is that of its first stratum."""

    @property
    def strata(self) -> tuple[Stratum, ...]:
        """From the surface down."""

    @property
    def base(self) -> Foundation | Substrate:
        """What carries the last: rigid and bonded to it, rigid and without friction, or elastic and bonded."""


@dataclass(frozen=True)
class Layers:
    """Strata on a base: a graded or many-layered body; InputError unless the strata and the base are as below.

    Parameters
    ----------
    strata : sequence of Stratum
        One or more, from the surface down; the modulus of the first, 1, is the unit of all.
    base : {"bonded", "sliding"} or Substrate
        A rigid one to which the last stratum is bonded, or on which it slides, or an elastic half-space.
    """

    strata: tuple[Stratum, ...]
    base: Foundation | Substrate = "bonded"

    def __init__(self, strata: Sequence[Stratum], base: Foundation | Substrate = "bonded") -> None:
        keep(self, strata=tuple(strata), base=base if isinstance(base, Substrate) else require_foundation(base))
        if not self.strata or self.strata[0].modulus != 1:
            first = f"modulus = {self.strata[0].modulus:g} of the first stratum" if self.strata else "strata = []"
            raise InputError(f"{first} does not serve, limit: one stratum or more, the first of modulus 1; see Stratum")

    @property
    def thickness(self) -> float:
        """Of all strata, in beta."""
        return total_thickness(self)


def Layer(thickness: float, poisson: float = 0.3, foundation: Foundation = "bonded") -> Layers:
    """Return a layer on a rigid base, which it is bonded to, or slides on; values and errors as of `Stratum`."""
    return Layers([Stratum(thickness, poisson)], foundation)


def Coated(thickness: float, modulus_ratio: float, poisson: float = 0.3, substrate_poisson: float = 0.3) -> Layers:
    """Return a half-space under a coating that is bonded to it; E*, in the Tabor parameter and beta, is the coating's.

    The ratio is of Young's modulus of the coating to that of the half-space, 0.001 to 100 or InputError; the rest is as
    of `Stratum` and `Substrate`.
    """
    return Layers([Stratum(thickness, poisson)], Substrate(1 / require_film(modulus_ratio), substrate_poisson))


def total_thickness(body: LayeredBody) -> float:
    """Thickness of all strata in beta."""
    return sum(stratum.thickness for stratum in body.strata)


def surface_compliance(body: LayeredBody, wave_numbers: Array) -> Array:
    """S, (n,): the deflection by waves of pressure over that of a half-space of the first stratum's E*.

    The wave numbers k (n,) are positive, in 1/beta.
    """
    first, k = body.strata[0], np.asarray(wave_numbers, float)
    held, free = _at_base(body.base)  # A and B: A displacement + B stress = 0
    for stratum in reversed(body.strata):
        depth, unit = np.minimum(k * stratum.thickness, DEEP), stratum.modulus / (1 + stratum.poisson)  # 2 G
        below, on_top = (_waves(zeta, stratum.poisson) for zeta in (depth, np.array(0.0)))
        going = held @ below[..., :2, :] + unit * free @ below[..., 2:, :]
        back = -np.exp(-2 * depth)[:, None, None] * np.linalg.solve(going[..., 2:], going[..., :2])
        displacement, stress = (part[:, :2] + part[:, 2:] @ back for part in (on_top[:2], unit * on_top[2:]))
        held, free = np.eye(2), -displacement @ np.linalg.inv(stress)
    return np.asarray(free[..., 1, 1] * first.modulus / (1 - first.poisson**2) / 2)


def softest(body: LayeredBody) -> float:
    """Largest yield to waves of any length, in that of a half-space of the first stratum's E*: 1 or more."""
    waves = np.geomspace(1e-7 / total_thickness(body), DEEP / body.strata[0].thickness, WAVES)
    return max(1.0, float(surface_compliance(body, waves).max()))


def stiff_as(body: LayeredBody, length: float) -> float:
    """Length l in beta over which strata are as stiff as a half-space of the first stratum over a given one, or that.

    A pressure p deflects them by 2 p l S(1/l)/E*. A thin stiff film on something softer bends over a shorter one, as a
    plate on it: t^3/(12 l^4) + E_2/(2 l) = 1/(2 l_0), moduli in those of the film.
    """
    lengths = length * np.geomspace(1e-4, 1, WAVES)
    soft = lengths * surface_compliance(body, 1 / lengths) >= length
    return float(lengths[np.argmax(soft)]) if soft.any() else length


def _at_base(base: Foundation | Substrate) -> tuple[Array, Array]:
    """Matrices A, B of the condition A (U, W) + B (T, N) = 0 under the strata."""
    if base == "bonded":
        return np.eye(2), np.zeros((2, 2))
    if base == "sliding":
        return np.diag([0.0, 1.0]), np.diag([1.0, 0.0])
    if isinstance(base, Substrate):
        decaying = _waves(np.array(0.0), base.poisson)[:, :2]
        shear = base.modulus / (2 * (1 + base.poisson))
        return np.eye(2), -decaying[:2] @ np.linalg.inv(decaying[2:]) / (2 * shear)
    raise InputError(f"base = {base!r} is none of bonded, sliding, Substrate(modulus, poisson); take one of these")


def _waves(zeta: Array, nu: float) -> Array:
    """U, W, T, N (rows) of the four solutions a, b, c, d (columns) at the depth zeta, but for e^-+zeta, (..., 4, 4)."""
    one = np.ones_like(zeta)
    rows = [
        [one, zeta, one, -zeta],
        [one, zeta + 3 - 4 * nu, -one, zeta - 3 + 4 * nu],
        [-one, -(zeta + 1 - 2 * nu), one, -(zeta - 1 + 2 * nu)],
        [-one, -(zeta + 2 - 2 * nu), -one, zeta - 2 + 2 * nu],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def require_foundation(foundation: Foundation) -> Foundation:
    """Return how a layer stands on its base, or raise InputError for no such way."""
    require_one_of(foundation, "foundation", get_args(Foundation))
    return foundation
