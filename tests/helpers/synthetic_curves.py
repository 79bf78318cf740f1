"""Curves with a known truth: what an apparatus would record, with noise, offset, drift."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_adhesion.fitting.measured import ForceCurve
from fem_adhesion.fitting.model import Apparatus, Other, Theory, by_atlas, recorded


@dataclass(frozen=True)
class Synthetic:
    """Travel in m and force in N of approach and retract, and the samples of each."""

    travel: np.ndarray
    force: np.ndarray
    count: int

    @property
    def curve(self) -> ForceCurve:
        """As a measured curve."""
        return ForceCurve(
            "base", self.travel, self.force, slice(0, self.count), slice(self.count, 2 * self.count), False
        )


def synthetic(
    truth: Apparatus,
    other: Other,
    rng: np.random.Generator,
    *,
    noise: float,
    correlation: float = 0.0,
    count: int = 1000,
    baseline: float = 0.5,
    pressed: float = 1.0,
    offset: float = 0.0,
    drift: float = 0.0,
    theory: Theory = by_atlas,
) -> Synthetic:
    """`noise` and `offset` in N, `drift` in N per segment, `pressed` in pull-off forces, `baseline` of the travel."""
    units = other.units(truth)
    found = recorded(theory(units), truth, units)
    base, force = found.contact
    pull_off = -force.min()
    last = np.interp(pressed * pull_off, force[np.argmin(force) :], base[np.argmin(force) :])
    nearest = min(found.off, found.on) - 0.05 * (last - found.off)
    first = last - (last - nearest) / (1 - baseline)
    way_in = np.linspace(first, last, count) + rng.uniform() * (last - first) / count
    way_out = way_in[::-1]
    f_in = np.where(way_in < found.on, np.interp(way_in, *found.separated), np.interp(way_in, *found.contact))
    f_out = np.where(way_out < found.off, np.interp(way_out, *found.separated), np.interp(way_out, *found.contact))
    travel, clean = np.concatenate([way_in, way_out]), np.concatenate([f_in, f_out])
    shocks = rng.normal(size=2 * count + 200) * noise * np.sqrt(1 - correlation**2)
    for i in range(1, shocks.size):
        shocks[i] += correlation * shocks[i - 1]
    slope = offset + drift * (travel - first) / (last - first)
    return Synthetic(travel, clean + shocks[200:] + slope, count)
