"""Points of the study of the finite sphere: samples of its table, and those that figures and sentences speak of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.finite_sphere.table import DeviationRow
from halfspace.values import Array, Valued

FAVOURED = (0.3, 1.0, 3.0)  # Tabor parameters of a panel each
POISSON = 0.3


@dataclass(frozen=True, eq=False, repr=False)
class Samples(Valued):
    """Relative deviations of one quantity for one cause.

    Attributes
    ----------
    tabor, radius_ratio, deviation, error : (n,) array
        Points, deviations and the bounds of their errors.
    """

    tabor: Array
    radius_ratio: Array
    deviation: Array
    error: Array

    @property
    def stretch(self) -> Array:
        """beta/R = sqrt(mu/rho)."""
        return np.asarray(np.sqrt(self.tabor / self.radius_ratio))

    @property
    def significant(self) -> Samples:
        """Those that exceed their errors."""
        return self.where(np.abs(self.deviation) > self.error)

    def where(self, chosen: NDArray[np.bool_]) -> Samples:
        """Those chosen."""
        return Samples(self.tabor[chosen], self.radius_ratio[chosen], self.deviation[chosen], self.error[chosen])


def samples(rows: Iterable[DeviationRow], cause: str, quantity: str, poisson: float | None) -> Samples:
    """Deviations of a quantity for a cause, of the rows that have one, and a finite one."""
    chosen = [
        (row.tabor, row.radius_ratio, row.deviation.value, row.deviation.error)
        for row in rows
        if (row.cause, row.quantity, row.poisson) == (cause, quantity, poisson) and row.deviation and row.radius_ratio
    ]
    numbers = np.array(chosen, float).reshape(-1, 4)
    return Samples(*numbers[np.isfinite(numbers).all(axis=1)].T)


def reference_poisson(rows: Sequence[DeviationRow]) -> float | None:
    """Poisson's ratio of the figures that show one: 0.3, or the nearest to it in the table."""
    known = {row.poisson for row in rows if row.poisson is not None}
    return min(known, key=lambda nu: abs(nu - POISSON), default=None)


def panel_tabors(rows: Sequence[DeviationRow]) -> list[float]:
    """Tabor parameters that have a panel: those nearest to 0.3, 1 and 3 in the table."""
    known = {row.tabor for row in rows if row.cause == "all" and row.deviation}
    return sorted({min(known, key=lambda mu: abs(np.log(mu / wanted))) for wanted in FAVOURED} if known else set())


def points_by_poisson(rows: Sequence[DeviationRow]) -> list[tuple[float, float]]:
    """Tabor parameters and R/eps whose pull-off is known at two Poisson's ratios or more."""
    points = dict.fromkeys((row.tabor, row.radius_ratio) for row in rows if row.radius_ratio)
    known = ((mu, rho) for mu, rho in points if rho and by_poisson(rows, "pull_off_load", mu, rho)[0].size > 1)
    return sorted(known, key=lambda point: point[::-1])


def by_poisson(rows: Sequence[DeviationRow], quantity: str, tabor: float, ratio: float) -> tuple[Array, Array]:
    """Poisson's ratios, ascending, and the deviations at a point."""
    wanted = ("all", quantity, tabor, ratio)
    chosen = sorted(
        (row.poisson, row.deviation.value)
        for row in rows
        if (row.cause, row.quantity, row.tabor, row.radius_ratio) == wanted
        and row.poisson is not None
        and row.deviation
        and np.isfinite(row.deviation.value)
    )
    nu, deviation = np.array(chosen, float).reshape(-1, 2).T
    return nu, deviation


def jumping_tabors(rows: Sequence[DeviationRow]) -> list[float]:
    """Tabor parameters whose jump-on is known on spheres of two sizes or more."""
    data = samples(rows, "all", "jump_on_approach", reference_poisson(rows))
    tabors, counts = np.unique(data.tabor, return_counts=True)
    return [float(tabor) for tabor in tabors[counts > 1]]
