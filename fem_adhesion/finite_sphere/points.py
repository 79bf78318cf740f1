"""Which points of the study of the finite sphere its figures show and its sentences speak of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_adhesion.finite_sphere.fit import samples
from fem_adhesion.finite_sphere.table import Row
from halfspace.values import Array

FAVOURED = (0.3, 1.0, 3.0)  # Tabor parameters of a panel each
POISSON = 0.3


def reference_poisson(rows: Sequence[Row]) -> float | None:
    """Poisson's ratio of the figures that show one: 0.3, or the nearest to it in the table."""
    known = {row.poisson for row in rows if row.poisson is not None}
    return min(known, key=lambda nu: abs(nu - POISSON), default=None)


def panel_tabors(rows: Sequence[Row]) -> list[float]:
    """Tabor parameters that have a panel: those nearest to 0.3, 1 and 3 in the table."""
    known = {row.tabor for row in rows if row.cause == "all" and row.deviation}
    return sorted({min(known, key=lambda mu: abs(np.log(mu / wanted))) for wanted in FAVOURED} if known else set())


def points_by_poisson(rows: Sequence[Row]) -> list[tuple[float, float]]:
    """Tabor parameters and R/eps whose pull-off is known at two Poisson's ratios or more."""
    points = dict.fromkeys((row.tabor, row.radius_ratio) for row in rows if row.radius_ratio)
    known = ((mu, rho) for mu, rho in points if rho and by_poisson(rows, "pull_off_load", mu, rho)[0].size > 1)
    return sorted(known, key=lambda point: point[::-1])


def by_poisson(rows: Sequence[Row], quantity: str, tabor: float, ratio: float) -> tuple[Array, Array]:
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


def jumping_tabors(rows: Sequence[Row]) -> list[float]:
    """Tabor parameters whose jump-on is known on spheres of two sizes or more."""
    data = samples(rows, "all", "jump_on_approach", reference_poisson(rows))
    tabors, counts = np.unique(data.tabor, return_counts=True)
    return [float(tabor) for tabor in tabors[counts > 1]]
