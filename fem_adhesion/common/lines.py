"""A load-approach curve as lines to be drawn: smooth between the computed points, and cut where stability changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import is_fold
from halfspace.values import Array, Valued

STABLE, GRIPS_ONLY, UNSTABLE = range(3)
KINDS: Mapping[int, str] = {
    STABLE: "stable under dead load",
    GRIPS_ONLY: "stable under fixed grips only",
    UNSTABLE: "unstable",
}


BETWEEN = 12  # points drawn from one computed point to the next


Range = tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Line(Valued):
    """A curve, dimensionless, all arrays (n,).

    Approach, load and central gap are in eps, R dgamma and eps; the kind is `STABLE`, `GRIPS_ONLY` or `UNSTABLE`.
    """

    approach: Array
    load: Array
    central_gap: Array
    kind: NDArray[np.int8]

    def parts(self, y: Array) -> Iterator[tuple[int, Array]]:
        """Each kind that occurs, with y where the curve is of it and nan elsewhere; the parts join."""
        for kind in KINDS:
            if np.any(self.kind == kind):
                yield kind, _where(self.kind == kind, y)

    def stretches(self, y: Array) -> tuple[Array, Array]:
        """The same where the curve is stable under fixed grips, and where it is not."""
        unstable = self.kind == UNSTABLE
        return _where(~unstable, y), _where(unstable, y)


def _where(mask: NDArray[np.bool_], y: Array) -> Array:
    """Values where the mask holds, and at the next point: there the next part begins."""
    return np.where(mask | np.append(False, mask[:-1]), y, np.nan)


@dataclass(frozen=True)
class Frame:
    """Ranges of approach (eps) and load (R dgamma) that are shown."""

    approach: Range
    load: Range


def smooth(path: EquilibriumPath) -> Line:
    """Lines through the points of a path with their tangents."""
    segments, known = path.finest_curve.segments, iter(path.stable)
    parts = []
    for points in (segment.points for segment in segments):
        s, stable = np.array([point.arclength for point in points]), np.array(list(islice(known, len(points))))
        values, rates = (np.array([getattr(one, name)[:3] for one in points]) for name in ("observables", "rates"))
        parts.append(through(s, values, rates, stable))
    return Line(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Line)))


def through(s: Array, values: Array, rates: Array, stable: NDArray[np.bool_]) -> Line:
    """Line through points at arclengths (n,), with approach, load and central gap there and their rates, (n, 3) each.

    Between a point that is stable under fixed grips and one that is not, what is stable are the states before the
    approach turns: along them it rises.
    """
    forward = np.append(True, np.diff(s) > 0)  # two grids may have one point where one hands over to the next
    s, values, rates, stable = s[forward], values[forward], rates[forward], stable[forward]
    places = np.arange(BETWEEN * (s.size - 1) + 1) / BETWEEN
    spline = CubicHermiteSpline(s, values, rates)
    (approach, load, gap), (rise, more, _) = (spline(np.interp(places, np.arange(s.size), s), k).T for k in (0, 1))
    before, after = stable[np.floor(places).astype(int)], stable[np.ceil(places).astype(int)]
    kept = np.where(before == after, before, rise >= 0)
    kind = np.where(kept, np.where(more * rise > 0, STABLE, GRIPS_ONLY), UNSTABLE).astype(np.int8)
    return Line(approach, load, gap, kind)


def folds(path: EquilibriumPath) -> Array:
    """Approach and load at every fold under fixed grips, in order, (n, 2)."""
    found = [(event.approach, event.load) for name, event in path.events.items() if is_fold(name)]
    return np.array(found).reshape(-1, 2)


def around_events(path: EquilibriumPath) -> Frame:
    """Frame from where attraction is felt to a load about half the pull-off force."""
    return frame(path, -0.5 * path.events["pull_off"].load)


def frame(path: EquilibriumPath, highest: float) -> Frame:
    """Frame from where attraction is felt to a load in R dgamma."""
    lowest, line = path.events["pull_off"].load, smooth(path)
    felt = (line.load < 0.04 * lowest) | (line.load > -1e-9 * lowest)  # attraction, or a load above rounding
    shown = felt & (line.load <= highest)
    x = np.append(line.approach[shown], path.events["zero_load"].approach)
    return Frame(_padded(float(x.min()), float(x.max())), _padded(lowest, highest))


def _padded(low: float, high: float) -> Range:
    margin = 0.08 * (high - low)
    return low - margin, high + margin / 2
