"""Everything computed after the paper as one record: curves, jumps, criteria, tables and experiments, with errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.greenwood.numerics_1997 import Attempt, Ripple
from fem_adhesion.greenwood.tables import CREDIBLE, Criterion, Printed
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, Jump
from halfspace.equilibrium.events import Event
from halfspace.laws import LENNARD_JONES, Law
from halfspace.values import Array, Estimate, Valued

# What is computed and how finely


def _spaced(first: float, last: float, number: int) -> tuple[float, ...]:
    """Numbers of equal ratios."""
    return tuple(float(value) for value in np.geomspace(first, last, number))


FEW = np.array([4, 3, 2.5, 2, 1.5, 1, 0.7, 0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0, -0.005, -0.01])


@dataclass(frozen=True, eq=False, repr=False)
class Settings(Valued):
    """What is computed: Tabor parameters, spacings in beta of wrong grids, stiffnesses in R dgamma/eps, accuracies."""

    drawn: tuple[float, ...] = (0.02, 0.05, 0.1, 0.2, 0.5, 0.7, 1.0, 2.0, 3.0, 5.0)  # Tabor parameters of curves
    not_drawn: tuple[float, ...] = (0.9, 1.25, 6.0, 6.7)  # those of further curves that claims are measured on
    loads: Mapping[float, float] = field(default_factory=lambda: {0.02: 50.0})  # load where a curve ends, if not 5
    rtol: float = 1e-7  # relative accuracy of the events of curves; their points carry their own errors
    # Figures
    points: int = 600  # points of a drawn curve, most of them far apart; a polygon through 300 shows corners
    specified: Mapping[float, Array] = field(  # central gaps prescribed, eps: Fig. 3
        default_factory=lambda: {1.0: FEW, 2.0: FEW, 3.0: FEW, 5.0: np.linspace(1.4, 0.05, 120)}
    )
    jumps_at: float = 1.0  # Tabor parameter of Fig. 2a
    apparatus: float = 3.0  # stiffness of the apparatus of Fig. 2a
    winding_at: float = 5.0  # Tabor parameter of Fig. 4
    profile_gaps: tuple[float, ...] = (1.0, 0.3, 0.02, 0.0, -0.01)  # central gaps of further profiles, eps
    devices_at: float = 2.0  # Tabor parameter of the cycles in apparatus
    stiffnesses: tuple[float, ...] = (math.inf, 100.0, 10.0, 3.0, 1.0, 0.3, 0.1)
    border: int = 40  # Tabor parameters at which the stiffness below which a contact jumps is solved for
    elements: tuple[float, ...] = (0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)  # Tabor parameters of finite elements
    # Tables and criteria
    pull_offs: tuple[float, ...] = _spaced(0.005, 100, 41)
    jumps: tuple[float, ...] = _spaced(1, 100, 21)  # Tabor parameters of the true jumps that criteria are fitted to
    # Numerics of 1997
    ripple_at: float = 2.0
    ripples: tuple[float, ...] = (0.2, 0.1, 0.05)  # spacings of the rippling curves
    ripple_window: float = 0.4  # beta on each side of the contact radius at pull-off
    rising: tuple[float, ...] = _spaced(1, 6, 19)  # Tabor parameters of the false rise
    rises: tuple[float, ...] = (0.2, 0.1, 0.05, 0.025)  # spacings of the false rise
    most_sweeps: int = 20_000
    # Claims
    more_work: float = 0.5  # part by which another core raises the work of adhesion
    coarse: tuple[tuple[float, float], ...] = (  # Tabor parameters and spacings of forces that are wrong on purpose
        *((3.0, 0.02), (5.0, 0.02), (5.0, 0.01)),  # 300 and 600 nodes up to 6 beta
        *((0.5, 0.5), (0.9, 0.5), (1.0, 0.5), (1.25, 0.5)),  # 12 nodes
    )
    omitted: tuple[float, ...] = (0.2, 0.5, 1.0)  # Tabor parameters of a sum without the singular point
    omitted_spacing: float = 0.025  # 240 nodes


FULL = Settings()
QUICK = replace(
    FULL,
    rtol=1e-5,
    points=200,
    border=10,
    elements=(0.5, 2.0),
    pull_offs=_spaced(0.005, 20, 5),
    jumps=_spaced(1, 30, 5),
    rising=_spaced(1, 3, 5),
    rises=FULL.rises[:2],
    most_sweeps=200,
)


# What was found

UNKNOWN = Estimate(float("nan"), float("nan"))


@dataclass(frozen=True)
class OtherCore(Law):
    """The 3-9 law with more tension at gaps below one in eps, by a part of its work of adhesion.

    The law is scaled to a work of adhesion of one, as every law here: divided by 1 + more, with a Tabor parameter
    raised by (1 + more)^(2/3), it is beyond that gap the 3-9 law of the same sphere. What is added is a polynomial in
    t = H/gap, 140 t^3 (1 - t)^3/gap, whose integral is 1. It stays in factors: at t = 1 its expanded form has rounding
    errors that keep the path from converging.
    """

    gap: float
    more: float

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P at gaps H."""
        t = np.clip(np.asarray(gap, float) / self.gap, 0, 1)
        added = self.more * 140 / self.gap * t**3 * (1 - t) ** 3
        return np.asarray((LENNARD_JONES.pressure(gap, tabor) - tabor * added) / (1 + self.more))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        t = np.clip(np.asarray(gap, float) / self.gap, 0, 1)
        added = self.more * 420 / self.gap**2 * t**2 * (1 - t) ** 2 * (1 - 2 * t)
        return np.asarray((LENNARD_JONES.slope(gap, tabor) - tabor * added) / (1 + self.more))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi(H) with -dPhi/dH = P and Phi = 0 far apart."""
        t = np.clip(np.asarray(gap, float) / self.gap, 0, 1)
        left = 1 - t**4 * (35 - 84 * t + 70 * t**2 - 20 * t**3)
        return np.asarray((LENNARD_JONES.energy(gap, tabor) - tabor * self.more * left) / (1 + self.more))


@dataclass(frozen=True, eq=False, repr=False)
class DrawnState(Valued):
    """Shape and pressure of one state.

    Central gap in eps; radii in beta, gap in eps and pressure in dgamma/(mu eps) with their errors, (n,) arrays.
    """

    central_gap: float
    radii: Array
    gap: Array
    pressure: Array
    gap_error: Array
    pressure_error: Array


@dataclass(frozen=True, eq=False, repr=False)
class Facts(Valued):
    """Everything computed after the paper: what its figures and tables show, and what its claims are measured on.

    Attributes
    ----------
    paths, curves, elements : by Tabor parameter
        Curves on the half-space; the same in the points that are drawn; curves by finite elements.
    grips, cycles
        Cycles under fixed grips, by Tabor parameter; those in apparatus of falling stiffness, fixed grips first.
    pull_offs
        Pull-off loads on the half-space, in R dgamma, by rising Tabor parameter.
    jumps_on, criteria
        True jumps by rising Tabor parameter, and the criteria fitted to them.
    jumps
        Jumps by the letters of their ends in Fig. 2a, primed in an apparatus.
    profiles, more_profiles
        States of Fig. 4, before the jump and after; further ones in contact and on the way to it.
    table_1, table_2, profile_checks, asymptote
        Printed numbers beside computed ones; constants of f = a alpha*^(3/2) - b alpha*^2 with their standard errors.
    relaxations
        The iterations of 1997 on 200 nodes.
    ripples, rises
        Curves on grids that are too coarse; by spacing, the curves of the false rise of the pull-off force.
    omitted, coarse
        Forces with the singular point of the kernel left out, and on the same grid with it; the pull-off force on
        uniform triangles by Tabor parameter and spacing: wrong on purpose.
    critical_tabor, border
        Where the curve first has a vertical tangent; (n, 2): Tabor parameters below it, and the stiffness in
        R dgamma/eps below which they jump.
    cores
        By the gap in eps above which another law is the same, how far its jump-on at mu = 5 is from that of the 3-9
        law, in eps.
    """

    settings: Settings
    paths: Mapping[float, EquilibriumPath]
    curves: Mapping[float, EquilibriumPath]
    elements: Mapping[float, EquilibriumPath]
    grips: Mapping[float, Cycle]
    cycles: tuple[Cycle, ...]
    jumps_on: Mapping[float, Event]
    criteria: tuple[Criterion, ...]
    jumps: Mapping[tuple[str, str], Jump]
    pull_offs: Mapping[float, Estimate]
    profiles: tuple[DrawnState, ...]
    more_profiles: tuple[DrawnState, ...]
    table_1: Sequence[Printed]
    table_2: Sequence[Printed]
    profile_checks: Sequence[Printed]
    asymptote: tuple[Estimate, Estimate]
    relaxations: Sequence[Attempt]
    ripples: tuple[Ripple, ...]
    rises: Mapping[float, tuple[Ripple, ...]]
    omitted: tuple[tuple[Ripple, ...], tuple[Ripple, ...]]
    coarse: Mapping[tuple[float, float], float]
    critical_tabor: Estimate
    border: Array
    cores: Mapping[float, Estimate]
    seconds: float

    @property
    def element_pull_offs(self) -> dict[float, Estimate]:
        """Pull-off loads by finite elements."""
        return {mu: path.events["pull_off"].estimate("load") for mu, path in self.elements.items()}

    def number(self, tabor: float, event: str, quantity: str) -> Estimate:
        """A number of an event; approach and gaps in eps, load in R dgamma, contact radius in beta."""
        found = self.paths[tabor].events.get(event)
        return found.estimate(quantity) if found else UNKNOWN

    def force(self, tabor: float) -> Estimate:
        """Pull-off force in R dgamma."""
        return self.number(tabor, "pull_off", "load") * -1

    def state(self, tabor: float, quantity: str, **asked: Any) -> Estimate:
        """A number of the state that is asked for, as of `EquilibriumPath.at`."""
        found = self.paths[tabor].at(**asked)
        return Estimate(*(float(getattr(found, name)) for name in (quantity, f"{quantity}_error")))

    def worst(self, row: str) -> float:
        """Largest relative deviation of Table 2 in rows that end so."""
        return max(abs(p.deviation) for p in self.table_2 if p.row.endswith(row))

    def troubles(self) -> Iterator[str]:
        """What failed that should not have, a sentence each."""
        for entry in (*self.table_1, *self.table_2, *self.profile_checks):
            if not abs(entry.deviation) <= CREDIBLE:
                yield f"{entry.row} at {entry.column:g}: {entry.computed.value:.6g}, printed {entry.printed}"
        for mu, load in self.element_pull_offs.items():
            if not load.agrees(self.pull_offs[mu]):
                yield f"the solvers disagree in the pull-off load at mu = {mu:g}"
        yield from (f"no {subject} were found" for subject in ("jumps", "cycles") if not getattr(self, subject))


# Arithmetic of numbers with errors


def exact(value: float) -> Estimate:
    """A number known to rounding."""
    return Estimate(float(value), 1e-14 * abs(float(value)))


def count(number: int) -> Estimate:
    """A number of things."""
    return Estimate(float(number), 0.0)


def spread(function: Callable[..., float], *arguments: Estimate) -> Estimate:
    """Return a function of numbers with errors: the error is the sum of what each changes it by."""
    values = [a.value for a in arguments]
    value = function(*values)
    errors = (abs(function(*values[:i], a.value + a.error, *values[i + 1 :]) - value) for i, a in enumerate(arguments))
    return Estimate(value, sum(errors))


def power(lower: Estimate, upper: Estimate, ratio: float) -> Estimate:
    """Power of mu of two numbers, by the ratio of their Tabor parameters."""
    return spread(lambda a, b: np.log(b / a) / np.log(ratio), lower, upper)


def most(numbers: Iterable[Estimate]) -> Estimate:
    """The largest of numbers with errors; not a number if there are none."""
    return max(numbers, key=lambda number: number.value, default=UNKNOWN)


def least(numbers: Iterable[Estimate]) -> Estimate:
    """The smallest of numbers with errors; not a number if there are none."""
    return min(numbers, key=lambda number: number.value, default=UNKNOWN)


def steps(numbers: Sequence[Estimate]) -> list[Estimate]:
    """Changes from each number to the next."""
    return [after - before for before, after in pairwise(numbers)]


def crossings(a: Array, b: Array) -> int:
    """How often two polygons (k, 2) and (m, 2) cross: each of two pieces parts the ends of the other."""

    def parted(line: Array, points: Array) -> NDArray[np.bool_]:
        """Whether a piece of a line has neighbouring points on both sides, (pieces, pairs)."""
        (x, y), (u, v) = np.diff(line, axis=0).T[..., None], (points[None] - line[:-1, None]).transpose(2, 0, 1)
        return np.asarray(np.diff(x * v > y * u, axis=1))

    return int(np.count_nonzero(parted(a, b) & parted(b, a).T))
