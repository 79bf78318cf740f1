"""A law that is known by a table of tensions, measured or from a finer model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from halfspace.laws.law import Law
from halfspace.limits import require_all
from halfspace.roots import root
from halfspace.values import Array, keep, read_columns

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

FEWEST = 12  # rows of a table


@dataclass(frozen=True)
class Tabulated(Law):
    """Cubic spline through a table of gaps and tensions, in any units: spacing and work of adhesion are its own.

    Beyond the last gap the tension falls as the power of the gap that it ends with, before the first the pressure rises
    as the exponential that it begins with. In a table that ends with zeros it ends at the first of them, without a
    kink. The path is of a CSV file with two columns, gap and tension (negative where the surfaces repel), and any
    header; InputError if it cannot be read, has holes, no repulsive core or no decay.
    """

    path: Path

    pieced: ClassVar[bool] = True  # the third derivative of its spline leaps

    def __post_init__(self) -> None:
        keep(self, path=Path(self.path))
        h, tension = self._table
        strength, core = float(tension.max()), "begin in the core, where the surfaces repel and the tension is negative"
        require_all(
            self.path,
            (f"the largest tension is {strength:g}", strength > 0, "above 0", "let the surfaces attract"),
            (f"the first tension is {tension[0]:g}", bool(tension[0] <= -strength), f"{-strength:g}", core),
            (f"the last tension is {tension[-1]:g}", bool(tension[-1] >= 0), "0 or above", "end where they attract"),
        )
        signs = np.sign(tension[tension != 0])
        own = "a table with a barrier or two minima is served by a law of one's own"
        require_all(self.path, ("the tension changes sign again", np.count_nonzero(np.diff(signs)) == 1, "once", own))
        before, beyond = self._beside_equilibrium
        flat = f"there is no tension from gap {h[before + 1]:g} to {h[beyond - 1]:g}"
        middle, straight = (h[1:] + h[:-1]) / 2, (tension[1:] + tension[:-1]) / 2
        bend = np.abs(self._spline(middle) - straight) / np.maximum(strength, np.abs(straight))
        worst = int(np.argmax(bend))
        place = f"{bend[worst]:.2g} of the tension between gaps {h[worst]:g} and {h[worst + 1]:g}"
        tail = f"it ends as gap^{-self._fall:.3g}"
        require_all(
            self.path,
            (flat, beyond - before <= 2, "one gap in equilibrium", "give more digits there"),
            (tail, self._fall > 2, "below -2", "give it a tail"),
            (f"the spline bends by {place}", bool(bend[worst] < 0.1), "0.1", "give more points there"),
        )

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Gaps and tensions, but for zeros beyond the first of those that end them."""
        h, tension = read_columns(self.path, FEWEST)
        first = f"the first gap is {h[0]:g}"
        require_all(self.path, (first, bool(h[0] > 0), "above 0", "gaps are distances of the surfaces"))
        until = int(np.flatnonzero(tension).max(initial=-1)) + 2
        return h[:until], tension[:until]

    @cached_property
    def _spline(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline  # it takes as long to load as all else, and few need it

        h, tension = self._table
        return CubicSpline(h, tension, bc_type=("not-a-knot", "not-a-knot" if tension[-1] else "clamped"))

    @cached_property
    def _fall(self) -> float:
        """Exponent of the tension beyond the last gap, infinite where it is nothing."""
        h, tension = self._table
        return float(-h[-1] * self._spline(h[-1], 1) / tension[-1]) if tension[-1] else np.inf

    @cached_property
    def _rise(self) -> float:
        """Inverse length of the pressure before the first gap."""
        first = self._table[0][0]
        return float(-self._spline(first, 1) / self._spline(first))

    @property
    def _beside_equilibrium(self) -> tuple[int, int]:
        """The last row where the surfaces repel and the first where they attract."""
        tension = self._table[1]
        return int(np.flatnonzero(tension < 0)[-1]), int(np.flatnonzero(tension > 0)[0])

    @cached_property
    def spacing(self) -> float:
        """Gap without tension, in the table's unit."""
        h, (core, attraction) = self._table[0], self._beside_equilibrium
        if attraction - core > 1:
            return float(h[core + 1])
        between = float(h[core]), float(h[attraction])
        return root(lambda gap: float(self._spline(gap)), *between, "equilibrium; mend the table", xtol=1e-300)

    @cached_property
    def work_of_adhesion(self) -> float:
        """Integral of the tension from there to infinity, in the table's units."""
        return self._left(np.array([self.spacing])).item()

    @cached_property
    def open_between_rows(self) -> Array:
        """About what the spline may be off by between two rows (n - 1,), in the table's unit of tension.

        5/384 of the width to the fourth times the fourth derivative (Hall and Meyer 1976), which is the change of the
        third from piece to piece: what the table leaves open, and no estimate of a curve's error holds.
        """
        width, third = np.diff(self._table[0]), 6 * self._spline.c[0]
        fourth = np.abs(np.diff(third)) / (width[1:] + width[:-1]) * 2
        fourth = np.concatenate([fourth[1:2], fourth[1:2], fourth[1:-1], fourth[-2:-1], fourth[-2:-1]])  # not a knot
        return np.asarray(5 / 384 * width**4 * np.maximum(fourth[1:], fourth[:-1]))

    @property
    def findings(self) -> tuple[str, ...]:
        """What the table has, in words."""
        h, tension = self._table
        part = self.open_between_rows / np.maximum(tension.max(), np.maximum(np.abs(tension[1:]), np.abs(tension[:-1])))
        worst = int(np.argmax(part))
        between = f"between gaps {h[worst]:.4g} and {h[worst + 1]:.4g}"
        return (
            f"spacing {self.spacing:.6g}",
            f"work of adhesion {self.work_of_adhesion:.6g} in the units of the table",
            f"which leaves about {part[worst]:.1g} of the tension open {between}",
        )

    def _tension(self, h: Array, order: int = 0) -> Array:
        """Tension at gaps, or its derivative, in the table's units."""
        (first, last), gaps = self._ends, np.asarray(h, float)
        before, beyond = gaps < first, gaps > last
        found = np.asarray(self._spline(np.clip(gaps, first, last), order))
        core = float(self._spline(first)) * np.exp(self._rise * (first - np.minimum(gaps, first)))
        tail = float(self._spline(last, order)) * (np.maximum(gaps, last) / last) ** -(self._fall + order)
        if order:
            core = -self._rise * core
        return np.where(before, core, np.where(beyond, tail, found))

    def _left(self, h: Array) -> Array:
        """Integral of the tension from gaps to infinity, in the table's units."""
        (first, last), gaps = self._ends, np.asarray(h, float)
        integral = self._spline.antiderivative()
        at_end = float(self._spline(last)) * last / (self._fall - 1)
        inside = at_end + integral(last) - integral(np.clip(gaps, first, last))
        core = float(self._spline(first)) * np.expm1(self._rise * (first - np.minimum(gaps, first))) / self._rise
        tail = at_end * (np.maximum(gaps, last) / last) ** (1 - self._fall)
        return np.asarray(np.where(gaps > last, tail, inside + core))

    @property
    def _ends(self) -> tuple[float, float]:
        return float(self._table[0][0]), float(self._table[0][-1])

    def pressure(self, gap: Array, tabor: float) -> Array:
        """P, in dgamma/eps of the table."""
        return -tabor * self.spacing / self.work_of_adhesion * self._tension(self.spacing * (1 + gap))

    def slope(self, gap: Array, tabor: float) -> Array:
        """dP/dH."""
        return -tabor * self.spacing**2 / self.work_of_adhesion * self._tension(self.spacing * (1 + gap), 1)

    def energy(self, gap: Array, tabor: float) -> Array:
        """Phi."""
        return -tabor / self.work_of_adhesion * self._left(self.spacing * (1 + gap))

    def room(self, gap: Array) -> Array:
        """As for other laws, but over four lengths of the core at least."""
        return np.maximum(gap + 1, 4 / (self._rise * self.spacing))
