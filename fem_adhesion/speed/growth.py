"""How the time of the solvers with error control grows: with digits, with Tabor's parameter, with R/eps.

Cells are graded towards the contact edge, whose spike is as wide as 1/mu^2: their number grows as ln(mu), where that of
a uniform grid grows as mu^2 and more. So no power of mu or R/eps is expected, but those of logarithms. Each digit asks
for a degree more: the half-space has then so many more unknowns, whose dense factors cost their third power, and a cell
of finite elements of degree p has p^2 inside, whose elimination costs p^6.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.bodies.half_space import HalfSpace
from fem_adhesion.bodies.hemisphere import Hemisphere
from fem_adhesion.scene import Scene
from fem_adhesion.speed.element_methods import POISSON
from halfspace.values import Array

TABOR = 1.0  # where digits and R/eps grow
RTOL = 1e-5  # where the Tabor parameter and R/eps grow
LOGARITHMIC = 0.0


@dataclass(frozen=True)
class Growth:
    """What grows for which solver, and how long that then takes.

    The time is expected to go as a power of what grows, `expected` at most, 0 if only logarithms are. Its values go
    from small to large; each is solved for, and has its seconds once it is timed.
    """

    solver: str
    grows: str
    expected: float
    at: tuple[float, ...]
    solve: Callable[[float], object]
    seconds: tuple[float, ...] = ()

    @property
    def exponent(self) -> float:
        """Exponent b of seconds ~ x^b; nan of fewer than two values."""
        return slope(np.array(self.at), np.array(self.seconds))


def _block(tabor: float, rtol: float) -> object:
    return convergence.trace(Scene(tabor, HalfSpace(poisson=POISSON)), rtol=rtol)


def _hemisphere(radius_ratio: float) -> object:
    return convergence.trace(Scene(TABOR, Hemisphere(radius_ratio=radius_ratio, poisson=POISSON)), rtol=RTOL)


def _rtol(digits: float) -> float:
    return float(10**-digits)


DIGITS = tuple(map(float, range(3, 9)))
GROWTHS = (
    Growth("half-space", "digits", 3.0, DIGITS, lambda x: halfspace.trace(TABOR, rtol=_rtol(x))),
    Growth("finite elements", "digits", 6.0, DIGITS, lambda x: _block(TABOR, _rtol(x))),
    Growth("half-space", "mu", LOGARITHMIC, (1.0, 3.0, 10.0, 30.0, 100.0), lambda x: halfspace.trace(x, rtol=RTOL)),
    Growth("finite elements", "mu", LOGARITHMIC, (1.0, 3.0, 10.0, 30.0), lambda x: _block(x, RTOL)),
    Growth("hemisphere", "R/eps", LOGARITHMIC, (10.0, 100.0, 1e3, 1e4), _hemisphere),
)


def growths_for(*, quick: bool) -> tuple[Growth, ...]:
    """All growths, yet to be timed; each of the two smallest values only if it is to be quick."""
    return tuple(replace(growth, at=growth.at[:2]) for growth in GROWTHS) if quick else GROWTHS


def timed(growth: Growth, seconds_of: Callable[[Callable[[], object]], float]) -> Growth:
    """Time a growth at each of its values."""
    return replace(growth, seconds=tuple(seconds_of(partial(growth.solve, x)) for x in growth.at))


def slope(x: Array, y: Array) -> float:
    """Exponent b of y ~ x^b by least squares of the logarithms; nan from fewer than two different points."""
    use = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    if np.unique(x[use]).size < 2:
        return float("nan")
    return float(np.polyfit(np.log(x[use]), np.log(y[use]), 1)[0])
