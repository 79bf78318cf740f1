"""Where the load-approach curve gains a pair of folds as the Tabor parameter grows: the cusps of the fold lines.

With the central gap prescribed the approach is a smooth function of it there. A pair of folds is born where the least
magnitude of its slope reaches zero, so slope and curvature vanish together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import minimize_scalar

from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import metric_for
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, LOAD
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import is_fold
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Point, make_point
from halfspace.errors import NotConverged
from halfspace.roots import root
from halfspace.scales import Scales
from halfspace.values import Array


class NoBirth(NotConverged):
    """No pair of folds is born where it was looked for."""


@dataclass(frozen=True)
class Birth:
    """Where to look for the birth of a pair of folds: between two Tabor parameters, and two central gaps in eps.

    `falling` says whether the approach falls with growing gap on both sides of the pair.
    """

    tabors: tuple[float, float]
    gaps: tuple[float, float]
    falling: bool


FIRST = Birth((0.69, 0.71), (0.15, 0.6), falling=True)
STEEPEST = (0.1, 0.6)  # central gaps in eps between which the curve of a stiff contact falls most steeply
SECOND = Birth((3.8, 4.1), (0.3, 0.6), falling=False)


def tabor_of(birth: Birth, *, rtol: float = 1e-7) -> float:
    """Tabor parameter at which the pair is born, on the half-space discretised for `rtol`."""
    return born(birth, lambda tabor: _centred(tabor, rtol))


def born(birth: Birth, problem_at: Callable[[float], Traceable]) -> float:
    """Tabor parameter at which the pair is born on any body; NoBirth if it is not between those of `birth`.

    problem_at gives the contact problem at a Tabor parameter, on a grid fine on the axis.
    """
    sign = -1 if birth.falling else 1

    @cache
    def least_slope(tabor: float) -> float:
        """Least slope of the approach over the gap, positive before the birth and negative after it."""
        return _least(problem_at(tabor), birth.gaps, lambda rates: sign * rates[APPROACH] / rates[CENTRAL_GAP], 1e-5)

    lower, upper = birth.tabors
    if least_slope(lower) * least_slope(upper) > 0:
        raise NoBirth(f"no folds are born between tabor = {lower:g} and {upper:g}; look elsewhere")
    return root(least_slope, lower, upper, "the birth of folds; look elsewhere", xtol=1e-11)


def _least(problem: Traceable, gaps: tuple[float, float], slope: Callable[[Array], float], xtol: float) -> float:
    """Least slope, of the rates along the curve, between two central gaps, at a gap known to a tolerance."""
    x = approached(problem, gaps[1])

    def at(gap: float) -> float:
        return float(slope(at_gap(problem, x, gap).rates))

    return float(minimize_scalar(at, bounds=gaps, method="bounded", options={"xatol": xtol}).fun)


def critical_stiffness(tabor: float, *, rtol: float = 1e-7) -> float:
    """Stiffness of the apparatus below which the contact jumps, in R dgamma/eps: the steepest fall of the curve.

    It grows from 32 pi/(9 sqrt 3) * 2/sqrt 3 = 6.45 for a rigid contact ([G97] 1.3) to infinity at the critical Tabor
    parameter, `tabor_of` (FIRST), where fixed grips begin to jump as well.
    """
    return -_least(_centred(tabor, rtol), STEEPEST, lambda rates: rates[LOAD] / rates[APPROACH], 1e-7)


def _centred(tabor: float, rtol: float) -> Traceable:
    """Contact with the half-space on a grid centred on the axis."""
    scales = Scales(tabor)
    return half_space_charts(scales, resolution_for(scales, rtol))[0].problem


def approached(problem: Traceable, gap: float) -> Array:
    """State at a central gap below 3 eps, reached from far separation in a dozen steps of it."""
    far = -5 - problem.tabor
    x = newton.solve(problem, problem.undeformed(far), newton.approach(far)).x
    for value in np.geomspace(3 + problem.tabor, gap, 12):
        x = newton.solve(problem, x, newton.central_gap(value)).x
    return x


def at_gap(problem: Traceable, start: Array, gap: float) -> Point:
    """Point of the curve at a central gap, its tangent towards larger gaps."""
    solution = newton.solve(problem, start, newton.central_gap(gap))
    return make_point(problem, solution, metric_for(problem), newton.central_gap(gap).weights, 0.0)


def count_folds(path: EquilibriumPath) -> int:
    """Number of folds in the approach along a curve: two of them may lie between two points."""
    return sum(map(is_fold, path.events))
