"""A load-approach curve as lines to be drawn: smooth between the computed points, and cut where stability changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, LOAD
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
    segments = path.finest_curve.segments
    firsts = np.cumsum([0, *(len(segment.points) for segment in segments)])
    values, found = [], []
    for segment, first in zip(segments, firsts, strict=False):
        between, rates = segment.between(BETWEEN)
        stable = path.stable[first : first + len(segment.points)]
        before, after = (np.repeat(part, BETWEEN) for part in (stable[:-1], stable[1:]))
        values.append(between[:, [APPROACH, LOAD, CENTRAL_GAP]])
        found.append(kinds(rates, *(np.append(part, stable[-1]) for part in (before, after))))
    approach, load, central_gap = np.concatenate(values).T
    return Line(approach, load, central_gap, np.concatenate(found))


def kinds(rates: Array, before: NDArray[np.bool_], after: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Kind of each point by the rates of approach and load along the curve, and what the computed points beside are.

    Between one that is stable under fixed grips and one that is not, what is stable are the states before the approach
    turns: along them it rises.
    """
    rising, loaded = rates[:, APPROACH] >= 0, rates[:, LOAD] * rates[:, APPROACH] > 0
    stable = np.where(before == after, before, rising)
    return np.where(stable, np.where(loaded, STABLE, GRIPS_ONLY), UNSTABLE).astype(np.int8)


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
