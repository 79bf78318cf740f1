"""What the claims of the paper are measured on: curves, jumps, criteria and experiments, with their errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import halfspace
from fem_adhesion.common.fold_birth import critical_stiffness
from fem_adhesion.greenwood.criteria import CriteriaStudy
from fem_adhesion.greenwood.numerics_1997 import Attempt, Rise, false_rise, ripple, without_singular_point
from fem_adhesion.greenwood.tables import PROFILE_CHECKS, Tables
from halfspace.elastic.compliance import triangles
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, cycle
from halfspace.errors import NotConverged
from halfspace.laws import LENNARD_JONES, Law
from halfspace.theories import closed_forms, criteria
from halfspace.values import Array, Estimate, Valued

ROUNDING = 1e-14  # relative error of closed forms
STIFF, RISEN, SOFT = (0.02, 0.05, 0.1, 0.2, 0.5, 0.9), 1.25, 6.7  # Tabor parameters, beside those of Table 2
JUMPING = (1.0, 2.0, 3.0, 5.0, 6.0)  # of Table 2
HIGHEST = (1.0, 2.0, 3.0, 5.0)  # of Fig. 2b
DEEP, DEEPER = 20.0, 25.0  # load of claims on Fig. 1c, and to which the curve goes, R dgamma
COARSE, WIDEST = (0.02, 0.01), 0.5  # spacings in beta: 300, 600 and 12 nodes up to 6 beta
COARSE_GRIDS = (  # Tabor parameters and spacings of forces that are wrong on purpose
    (3.0, COARSE[0]),
    (5.0, COARSE[0]),
    (5.0, COARSE[1]),
    *((mu, WIDEST) for mu in (0.5, 0.9, 1.0, RISEN)),
)
NODES_APART = 0.025  # beta, 240 nodes, for a sum without the singular point
MORE_WORK = 0.5  # part by which another core raises the work of adhesion


@dataclass(frozen=True)
class OtherCore(Law):
    """The 3-9 law with more tension at gaps below one in eps, by a part of its work of adhesion.

    The law is scaled to a work of adhesion of one, as every law here: divided by 1 + more, with a Tabor parameter
    raised by (1 + more)^(2/3), it is beyond that gap the 3-9 law of the same sphere. What is added is a polynomial in
    t = H/gap, 140 t^3 (1 - t)^3/gap, whose integral is 1.
    """

    gap: float
    more: float

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P at gaps H."""
        t = self._t(gap)
        added = self.more * 140 / self.gap * t**3 * (1 - t) ** 3
        return np.asarray((LENNARD_JONES.pressure(gap, tabor) - tabor * added) / (1 + self.more))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        t = self._t(gap)
        added = self.more * 420 / self.gap**2 * t**2 * (1 - t) ** 2 * (1 - 2 * t)
        return np.asarray((LENNARD_JONES.slope(gap, tabor) - tabor * added) / (1 + self.more))

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi(H) with -dPhi/dH = P and Phi = 0 far apart."""
        t = self._t(gap)
        left = 1 - t**4 * (35 - 84 * t + 70 * t**2 - 20 * t**3)
        return np.asarray((LENNARD_JONES.energy(gap, tabor) - tabor * self.more * left) / (1 + self.more))

    def _t(self, gap: Array) -> Array:
        return np.clip(np.asarray(gap, float) / self.gap, 0, 1)


@dataclass(frozen=True, eq=False, repr=False)
class Facts(Valued):
    """What claims are measured on.

    Paths are by Tabor parameter, cycles those under fixed grips, pull-offs by rising Tabor parameter in R dgamma.
    `cores` has, by the gap in eps above which another law is the same, how far its jump-on at mu = 5 is from that of
    the 3-9 law, in eps; `coarse` the pull-off force on uniform triangles by Tabor parameter and spacing; `omitted` the
    forces with the singular point of the kernel left out, and on the same grid with it; stiffnesses those below which a
    contact jumps, in R dgamma/eps.
    """

    paths: Mapping[float, EquilibriumPath]
    cycles: Mapping[float, Cycle]
    criteria: CriteriaStudy
    pull_offs: Mapping[float, Estimate]
    tables: Tables
    relaxations: Sequence[Attempt]
    rises: Mapping[float, Rise]
    critical_tabor: Estimate
    omitted: tuple[Rise, Rise]
    cores: Mapping[float, Estimate]
    coarse: Mapping[tuple[float, float], float]
    stiffnesses: Mapping[float, float]

    def number(self, tabor: float, event: str, quantity: str) -> Estimate:
        """A number of an event; approach and gaps in eps, load in R dgamma, contact radius in beta."""
        found = self.paths[tabor].events.get(event)
        return found.estimate(quantity) if found else UNKNOWN

    def force(self, tabor: float) -> Estimate:
        """Pull-off force in R dgamma."""
        return self.number(tabor, "pull_off", "load") * -1

    def scaled(self, tabor: float, event: str) -> Estimate:
        """Approach over the Tabor parameter, in beta^2/R."""
        return self.number(tabor, event, "approach") / tabor

    def load(self, tabor: float, approach: float, branch: str | None = None) -> Estimate:
        """Load at an approach in eps, on a branch where there are several."""
        state = self.paths[tabor].at(approach=approach, branch=branch)
        return Estimate(float(state.load), float(state.load_error))

    def bulge(self, tabor: float) -> Estimate:
        """Central displacement at the jump-on in eps, -alpha* - H0."""
        approach, gap = (self.number(tabor, "jump_on", name) for name in ("approach", "central_gap"))
        return (approach + gap) * -1

    def criterion(self, tabor: float, event: str) -> Estimate:
        """Value of w sigma'/sigma at the centre, (4.3), with the error that its approach and gap leave."""
        approach, gap = (self.number(tabor, event, name) for name in ("approach", "central_gap"))
        return spread(lambda a, h: float(criteria.fundamental_criterion(a, h)), approach, gap)

    def from_bradley(self, tabor: float, low: float, high: float) -> Estimate:
        """Largest distance of the load from Bradley's between two approaches in eps, in R dgamma."""
        approach = np.linspace(low, high, 121)
        states = self.paths[tabor].at(approach=approach)
        off = np.abs(states.load - closed_forms.bradley_load(approach))
        return Estimate(float(off.max()), float(np.max(states.load_error)))


UNKNOWN = Estimate(float("nan"), float("nan"))


def exact(value: float) -> Estimate:
    """A number known to rounding."""
    return Estimate(float(value), ROUNDING * abs(float(value)))


def count(number: int) -> Estimate:
    """A number of things."""
    return Estimate(float(number), 0.0)


def spread(function: Callable[..., float], *arguments: Estimate) -> Estimate:
    """Return a function of numbers with errors: the error is the sum of what each changes it by."""
    values = [a.value for a in arguments]
    value = function(*values)
    errors = (abs(function(*values[:i], a.value + a.error, *values[i + 1 :]) - value) for i, a in enumerate(arguments))
    return Estimate(value, sum(errors))


def most(numbers: Sequence[Estimate]) -> Estimate:
    """The largest of numbers with errors; not a number if there are none."""
    return max(numbers, key=lambda number: number.value, default=UNKNOWN)


def least(numbers: Sequence[Estimate]) -> Estimate:
    """The smallest of numbers with errors; not a number if there are none."""
    return min(numbers, key=lambda number: number.value, default=UNKNOWN)


def steps(numbers: Sequence[Estimate]) -> list[Estimate]:
    """Changes from each number to the next."""
    return [after - before for before, after in pairwise(numbers)]


def traced(rtol: float, known: Mapping[float, EquilibriumPath]) -> dict[float, EquilibriumPath]:
    """Paths of all the claims' Tabor parameters, beside those that are known."""
    missing = sorted({*STIFF, RISEN, *JUMPING, SOFT} - set(known))
    paths = {mu: halfspace.trace(mu, rtol=rtol, to_load=DEEPER if mu == STIFF[0] else 5.0) for mu in missing}
    return {**known, **paths}


def cycles(paths: Mapping[float, EquilibriumPath]) -> dict[float, Cycle]:
    """Cycles under fixed grips of the curves that fold."""
    found = ((mu, cycle(paths[mu])) for mu in (*STIFF, *HIGHEST))
    return {mu: c for mu, c in found if c}


def cores(path: EquilibriumPath, rtol: float) -> dict[float, Estimate]:
    """How far the jump-on of laws with another core is from that of a path of the 3-9 law.

    By the gap below which they differ: that of the jump-on itself, and the one that the paper has for it.
    """
    gaps = path.events["jump_on"].central_gap, float(PROFILE_CHECKS[0][0])
    return {gap: _moved(path, gap, rtol) for gap in gaps}


def _moved(path: EquilibriumPath, gap: float, rtol: float) -> Estimate:
    other = halfspace.trace(path.tabor * (1 + MORE_WORK) ** (2 / 3), rtol=rtol, law=OtherCore(gap, MORE_WORK))
    return other.events["jump_on"].estimate("approach") - path.events["jump_on"].estimate("approach")


def omitted(paths: Mapping[float, EquilibriumPath]) -> tuple[Rise, Rise]:
    """Pull-off with the singular point of the kernel left out, and by triangles on the same nodes."""
    known = [paths[mu] for mu in (0.2, 0.5, 1.0)]
    without, whole = (false_rise(known, NODES_APART, body) for body in (without_singular_point, triangles))
    return without, whole


def coarse(paths: Mapping[float, EquilibriumPath]) -> dict[tuple[float, float], float]:
    """Pull-off forces on uniform triangles by Tabor parameter and spacing, wrong on purpose.

    Left out where the coarse grid has no state near the resolved one.
    """
    return dict(_coarse(paths))


def _coarse(paths: Mapping[float, EquilibriumPath]) -> Iterator[tuple[tuple[float, float], float]]:
    for tabor, spacing in COARSE_GRIDS:
        try:
            yield (tabor, spacing), -ripple(paths[tabor], spacing, 1.5 * spacing, 8).pull_off
        except NotConverged:
            continue


def stiffnesses() -> dict[float, float]:
    """Stiffness below which a contact jumps that fixed grips hold, at two Tabor parameters."""
    return {mu: critical_stiffness(mu, rtol=1e-6) for mu in (0.02, 0.5)}


def gathered(
    known: Mapping[float, EquilibriumPath],
    rtol: float,
    study: CriteriaStudy,
    pull_offs: Mapping[float, Estimate],
    printed: Tables,
    relaxations: Sequence[Attempt],
    rises: Mapping[float, Rise],
    critical_tabor: Estimate,
) -> Facts:
    """Compute what is not known yet: paths at further Tabor parameters, cycles, other laws, wrong numerics."""
    paths = traced(rtol, known)
    return Facts(
        paths,
        cycles(paths),
        study,
        pull_offs,
        printed,
        relaxations,
        rises,
        critical_tabor,
        omitted(paths),
        cores(paths[5.0], rtol),
        coarse(paths),
        stiffnesses(),
    )
