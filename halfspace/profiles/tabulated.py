"""Profiles that are known by a table: as of a tip from blind reconstruction, or of a body that is given as a mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from halfspace.errors import InputError
from halfspace.limits import require_radius_ratio
from halfspace.profiles.profile import Surface
from halfspace.values import Array, Valued, keep, read_columns

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, CubicHermiteSpline


FEWEST = 12  # points of a piece of the spline, at least
DEGREE = 5  # degree of the spline in the square of the radius


@dataclass(frozen=True)
class Tabulated:
    """Smooth spline through a table of radii and heights, even in the radius; it ends where the table does.

    Estimates of a curve's error are those of this spline: what the table leaves open is told by `radius_error`, in
    which units of load go, and by `residual`.

    Parameters
    ----------
    path : Path
        CSV file with two columns, radius and height in one unit, say m, and any header.
    radius_ratio : float
        R/eps, of the radius at the apex; R is `radius` in the table's unit.

    Raises
    ------
    InputError
        If it cannot be read, turns back, or does not tell the radius of its apex.
    """

    path: Path
    radius_ratio: float

    def __post_init__(self) -> None:
        keep(self, path=Path(self.path), radius_ratio=require_radius_ratio(self.radius_ratio))
        near, whole = self._steepness
        if near > max(whole, 1.0):
            value = f"it rises by {near:.3g} for each unit of radius near the axis, {whole:.3g} on the whole"
            remedy = "give the radius in the first column, the height in the second"
            raise InputError(f"{self.path}: {value}, limit: less near a rounded apex; {remedy}")
        r = np.linspace(0, 1, 1000) * self.end
        falls = r[self._spline(r**2, 1) <= 0]
        if falls.size:
            where = f"{self.path} turns back at radius {falls[0]:.4g}"
            raise InputError(f"{where}, limit: a height that rises; cut it there")
        if not self.radius_error < self.radius:
            value = f"the apex radius is {self.radius:.3g} +- {self.radius_error:.1g}"
            raise InputError(f"{self.path}: {value}, limit: an error below it; give more points near the axis")

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        r, z = read_columns(self.path, FEWEST)
        if not r[0] >= 0:
            raise InputError(f"{self.path}: the first radius is {r[0]:g}, limit: 0 or more; measure it from the axis")
        return r, z

    @property
    def _steepness(self) -> tuple[float, float]:
        """Mean slope near the axis and of all; a table whose columns are exchanged is a root, steepest on the axis."""
        r, z = self._table
        near = max(int(np.searchsorted(r, r[0] + 0.25 * (r[-1] - r[0]), side="right")), 3)
        return float(np.polyfit(r[:near], z[:near], 1)[0]), float(np.polyfit(r, z, 1)[0])

    @cached_property
    def _fits(self) -> tuple[BSpline, BSpline]:
        """Height by the square of the radius, so that it is even, and the same by one piece more.

        Bayes's criterion chooses the pieces: cross-validation follows the noise in one table of ten, and its slope at
        the axis, where two squares of radii are closest, then gives any radius.
        """
        r, z = self._table
        splines = [_fitted(r**2, z, pieces) for pieces in range(1, min(r.size // FEWEST, 30) + 2)]
        squares = [float(np.mean((s(r**2) - z) ** 2)) + np.finfo(float).tiny for s in splines[:-1]]
        told = [
            math.log(left) + len(s.c) * math.log(r.size) / r.size for left, s in zip(squares, splines, strict=False)
        ]
        best = int(np.argmin(told))
        return splines[best], splines[best + 1]

    @property
    def _spline(self) -> BSpline:
        return self._fits[0]

    @property
    def end(self) -> float:
        """Radius at which it ends, in the table's unit."""
        return float(self._table[0][-1])

    @cached_property
    def radius(self) -> float:
        """R at the apex, in the table's unit."""
        return _radius(self._spline)

    @cached_property
    def radius_error(self) -> float:
        """Two standard deviations of it, rows being off by the residual each, and its change by one piece.

        Each row is taken to be off by itself; where neighbours err alike, as of a tip reconstructed blind, it is more.
        """
        from scipy.interpolate import BSpline  # it takes as long to load as all else, and few need it

        r, _ = self._table
        t, count = self._spline.t, len(self._spline.c)
        by_coefficient = BSpline(t, np.eye(count), DEGREE)
        weights = by_coefficient(0.0, 1) @ np.linalg.pinv(by_coefficient(r**2))  # of the heights in the slope at 0
        deviation = self.residual * math.sqrt(r.size / (r.size - count)) * float(np.linalg.norm(weights))
        return 2 * deviation * 2 * self.radius**2 + abs(_radius(self._fits[1]) - self.radius)

    @cached_property
    def residual(self) -> float:
        """Root mean square of what the spline leaves of the table, in its unit."""
        r, z = self._table
        return float(np.sqrt(np.mean((self._spline(r**2) - z) ** 2)))

    @property
    def findings(self) -> tuple[str, ...]:
        """What the table has, in words."""
        error = f" +- {self.radius_error:.1g}" if self.radius_error > 1e-6 * self.radius else ""  # six digits are told
        return (
            f"apex radius {self.radius:.6g}{error} in the table's unit",
            f"residual {self.residual * self.radius_ratio / self.radius:.2g} eps",
        )

    def surface(self, tabor: float) -> Surface:
        """Heights in beta^2/R; raise InputError where the tip is as small as its contact."""
        return Tip(self, self.radius / math.sqrt(require_radius_ratio(self.radius_ratio, tabor) / tabor))


def _radius(spline: BSpline) -> float:
    """Radius at the apex of a height by the square of the radius."""
    return float(0.5 / spline(0.0, 1))


def _fitted(x: Array, z: Array, pieces: int) -> BSpline:
    """Spline of least squares of so many pieces, of as many points each."""
    from scipy.interpolate import make_lsq_spline  # it takes as long to load as all else, and few need it

    inner = x[np.linspace(0, x.size - 1, pieces + 1).astype(int)[1:-1]]
    return make_lsq_spline(x, z, np.concatenate([[x[0]] * (DEGREE + 1), inner, [x[-1]] * (DEGREE + 1)]), DEGREE)


@dataclass(frozen=True, eq=False, repr=False)
class Tip(Valued, Surface):
    """A table's surface.

    Parameters
    ----------
    table : Tabulated
        In its own unit.
    beta : float
        In that unit.
    """

    table: Tabulated
    beta: float

    end: float = field(init=False)
    pieced = True  # the fifth derivative of its spline leaps

    def __post_init__(self) -> None:
        keep(self, end=self.table.end / self.beta)

    def height(self, radii: Array) -> Array:
        """Height over the apex."""
        spline = self.table._spline
        return np.asarray((spline((radii * self.beta) ** 2) - spline(0.0)) * self.table.radius / self.beta**2)

    def slope(self, radii: Array) -> Array:
        """Its derivative."""
        return np.asarray(2 * radii * self.table._spline((radii * self.beta) ** 2, 1) * self.table.radius)


@dataclass(frozen=True, eq=False, repr=False)
class TabulatedSurface(Valued, Surface):
    """Heights (n,) at ascending radii (n,), with their slopes: the surface of a body that is given as a mesh."""

    radii: Array
    heights: Array
    slopes: Array
    end: float = field(init=False)

    def __post_init__(self) -> None:
        keep(self, end=float(self.radii[-1]))

    def height(self, radii: Array) -> Array:
        """Cubic between the points."""
        return np.asarray(self._spline(radii))

    def slope(self, radii: Array) -> Array:
        """Its derivative."""
        return np.asarray(self._spline(radii, 1))

    @cached_property
    def _spline(self) -> CubicHermiteSpline:
        from scipy.interpolate import CubicHermiteSpline  # it takes as long to load as all else, and few need it

        return CubicHermiteSpline(self.radii, self.heights, self.slopes)
