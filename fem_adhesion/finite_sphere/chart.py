"""The chart of the finite sphere: where in the plane of Tabor parameter and R/eps the half-space errs by how much.

Along R/eps at each Tabor parameter the deviation is a power law between neighbouring points, or where its sign changes
linear in ln(R/eps). A contour is the largest R/eps at which the deviation has a given size, above which it is smaller.

Of the materials on it the work of adhesion and the Hamaker constant A are what is known. The spacing of the surface law
follows, eps^2 = A/(16 pi dgamma), so that law and source have the same attraction from afar: 0.14 to 0.15 nm, near the
cut-off D0 = 0.165 nm between two continua and not the diameter of an atom, of which the law between planes knows
nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.common.page import data_rows
from fem_adhesion.finite_sphere.table import DeviationRow
from halfspace.errors import InputError
from halfspace.scaling import Units, contact_modulus, spacing_of
from halfspace.values import Array, Valued

LEVELS = (0.1, 0.01, 0.001)  # relative deviations of the contours
MISFIT = 0.25  # largest relative difference of a rule from its contour


@dataclass(frozen=True, eq=False, repr=False)
class Field(Valued):
    """A deviation over the plane of Tabor parameter and R/eps, (m,) and (n,), both ascending.

    Deviation and error (m, n) are those of the sphere from the half-space, relative to it, and its bound; nan where
    there is none. The ending (m, n) says how each contact on the sphere ended: ``solved``, ``absent`` if it does not
    have the quantity, ``died``, the kind of error that refused it, ``left out``, or empty where none was asked for.
    """

    tabor: Array
    radius_ratio: Array
    deviation: Array
    error: Array
    ending: NDArray[np.str_]

    @property
    def largest(self) -> Array:
        """Largest size, (m, n), that the deviation can have; nan where there is none."""
        return np.asarray(np.abs(self.deviation) + self.error)


@dataclass(frozen=True)
class Rule:
    """The half-space errs by less than a level if R/eps > constant + slope mu.

    Constant and slope are fitted to the contour, to two digits; `misfit` is the largest relative difference between
    contour and rule, `tabor` the least and largest Tabor parameter of the contour.
    """

    level: float
    constant: float
    slope: float
    misfit: float
    tabor: tuple[float, float]


def field_of(rows: Sequence[DeviationRow], quantity: str, poisson: float | None) -> Field:
    """Whole deviation of a quantity at a Poisson's ratio, from the table."""
    chosen = [r for r in rows if (r.cause, r.quantity, r.poisson) == ("all", quantity, poisson) and r.radius_ratio]
    tabor = np.unique([row.tabor for row in chosen])
    ratio = np.unique([float(row.radius_ratio or 0) for row in chosen])
    deviation, error = np.full((2, tabor.size, ratio.size), np.nan)
    ending = np.full(deviation.shape, "", dtype="<U40")
    for row in chosen:
        at = np.searchsorted(tabor, row.tabor), np.searchsorted(ratio, float(row.radius_ratio or 0))
        ending[at] = row.kind if row.status == "refused" else row.status
        if row.deviation and np.isfinite([row.deviation.value, row.deviation.error]).all():
            deviation[at], error[at] = row.deviation.value, row.deviation.error
    return Field(tabor, ratio, deviation, error, ending)


def contour(field: Field, level: float) -> Array:
    """R/eps at which a deviation has a level, (m,); nan where no two neighbours of the points have it between them."""
    return np.array([_last_crossing(field.radius_ratio, deviation, level) for deviation in field.deviation])


def _last_crossing(ratio: Array, deviation: Array, level: float) -> float:
    known = np.isfinite(deviation)
    x, y = np.log(ratio[known]), deviation[known]
    size = np.abs(y)
    crossed = np.flatnonzero((size[:-1] >= level) & (size[1:] < level))
    if not crossed.size or size[-1] >= level:
        return np.nan
    i = crossed[-1]
    a, b, goal = (y[i], y[i + 1], np.sign(y[i]) * level) if y[i] * y[i + 1] <= 0 else np.log([*size[i : i + 2], level])
    return float(np.exp(x[i] + (x[i + 1] - x[i]) * (goal - a) / (b - a)))


def safe_from(field: Field, level: float) -> float:
    """Least R/eps of the points from which on all deviations are known to be below a level; nan if the last are not.

    Tabor parameters without any deviation, as those without jumps, do not count.
    """
    known = np.isfinite(field.deviation)
    size = np.where(known, field.largest, np.inf)[known.any(axis=1)].max(axis=0, initial=0.0)
    above = np.flatnonzero(size >= level)
    first = above[-1] + 1 if above.size else 0
    return float(field.radius_ratio[first]) if known.any() and first < field.radius_ratio.size else np.nan


def rule(field: Field, level: float) -> Rule:
    """Rule in words for a contour, R/eps = a + b mu, by least squares of its relative differences from the contour.

    InputError if the contour passes fewer than three Tabor parameters, or is no line.
    """
    ratio = contour(field, level)
    known = np.isfinite(ratio)
    if known.sum() < 3:
        raise InputError(
            f"the contour of {level:g} passes {known.sum()} Tabor parameters, limit 3; "
            "take more of tabor or radius_ratio"
        )
    mu, ratio = field.tabor[known], ratio[known]
    fitted = np.linalg.lstsq(np.column_stack([1 / ratio, mu / ratio]), np.ones_like(mu), rcond=None)[0]
    a, b = (float(f"{value:.2g}") for value in fitted)
    misfit = float(np.abs((a + b * mu) / ratio - 1).max())
    if misfit > MISFIT:
        raise InputError(
            f"the contour of {level:g} is {100 * misfit:.0f} % off a line, limit {100 * MISFIT:.0f} %; read the chart"
        )
    found = Rule(level, a, b, misfit, (float(mu[0]), float(mu[-1])))
    _require_true(field, found)
    return found


def _require_true(field: Field, found: Rule) -> None:
    """Refuse a rule that a point of its range contradicts: above the line, and the deviation is not below the level."""
    rho, mu = field.radius_ratio, field.tabor[:, None]
    line = found.constant + found.slope * mu
    within = (mu >= found.tabor[0]) & (mu <= found.tabor[1])
    above = rho > line * (1 + found.misfit)
    known = np.isfinite(field.deviation)
    last = known & (known[:, ::-1].cumsum(axis=1)[:, ::-1] == 1)  # beyond which nothing is known
    wrong = within & (above | last) & (field.largest >= found.level)
    if wrong.any():
        i, j = np.argwhere(wrong)[0]
        raise InputError(
            f"the deviation at tabor {field.tabor[i]:g}, R/eps {rho[j]:g} is {field.deviation[i, j]:.2g}, "
            f"limit {found.level:g} for a rule; read the chart"
        )


@dataclass(frozen=True)
class Material:
    """An elastic sphere against a rigid wall: what it is, and how large; its Poisson's ratio.

    Its units have the Tabor parameter, R/eps and the Hamaker constant; source and note say where the values are from,
    and what was assumed.
    """

    name: str
    units: Units
    poisson: float
    source: str
    note: str


def materials() -> tuple[Material, ...]:
    """All materials of the file ``data/materials.csv``."""
    return tuple(map(_material, data_rows("finite_sphere", "materials.csv")))


def _material(line: dict[str, str]) -> Material:
    poisson = float(line["poisson"])
    modulus = contact_modulus(float(line["young_Pa"]), poisson)
    adhesion = float(line["work_of_adhesion_J_per_m2"])
    spacing = spacing_of(float(line["hamaker_J"]), adhesion)
    units = Units(float(line["radius_m"]), modulus, adhesion, spacing)
    return Material(line["name"], units, poisson, line["source"], line["note"])
