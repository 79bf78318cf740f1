"""The plane of Tabor parameter and R/eps: a deviation over it with its contours, and real materials in it.

Along R/eps at each Tabor parameter the deviation is a power law between neighbouring points, or where its sign changes
linear in ln(R/eps). A contour is the largest R/eps at which the deviation has a given size, above which it is smaller.

Of the materials the work of adhesion and the Hamaker constant A are what is known. The spacing of the surface law
follows, eps^2 = A/(16 pi dgamma), so that law and source have the same attraction from afar: 0.14 to 0.15 nm, near the
cut-off D0 = 0.165 nm between two continua and not the diameter of an atom, of which the law between planes knows
nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.common.page import data_rows
from fem_adhesion.finite_sphere.table import DeviationRow
from halfspace.scaling import Units, contact_modulus, spacing_of
from halfspace.values import Array, Valued


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

    def at(self, tabor: float) -> Field:
        """The part at one Tabor parameter."""
        one = self.tabor == tabor
        return Field(self.tabor[one], self.radius_ratio, self.deviation[one], self.error[one], self.ending[one])


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


def materials() -> Iterator[Material]:
    """All materials of the file ``data/materials.csv``."""
    for line in data_rows("finite_sphere", "materials.csv"):
        poisson, adhesion = float(line["poisson"]), float(line["work_of_adhesion_J_per_m2"])
        modulus = contact_modulus(float(line["young_Pa"]), poisson)
        units = Units(float(line["radius_m"]), modulus, adhesion, spacing_of(float(line["hamaker_J"]), adhesion))
        yield Material(line["name"], units, poisson, line["source"], line["note"])
