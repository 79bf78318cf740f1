"""Curves with a known truth: what an apparatus would record, with noise, offset, drift."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fem_adhesion.fitting.measured import ForceCurve
from fem_adhesion.fitting.model import Apparatus, Theory, by_atlas, recorded


def synthetic(
    truth: Apparatus,
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
) -> ForceCurve:
    """`noise` and `offset` in N, `drift` in N per segment, `pressed` in pull-off forces, `baseline` of the travel."""
    found = recorded(theory(truth.units), truth)
    base, force = found.contact
    pull_off = -force.min()
    last = np.interp(pressed * pull_off, force[np.argmin(force) :], base[np.argmin(force) :])
    nearest = min(found.off, found.on) - 0.05 * (last - found.off)
    first = last - (last - nearest) / (1 - baseline)
    way_in = np.linspace(first, last, count) + rng.uniform() * (last - first) / count
    travel, jump = np.concatenate([way_in, way_in[::-1]]), np.repeat([found.on, found.off], count)
    clean = np.where(travel < jump, np.interp(travel, *found.separated), np.interp(travel, *found.contact))
    shocks = rng.normal(size=2 * count + 200) * noise * np.sqrt(1 - correlation**2)
    for i in range(1, shocks.size):
        shocks[i] += correlation * shocks[i - 1]
    slope = offset + drift * (travel - first) / (last - first)
    return ForceCurve("base", travel, clean + shocks[200:] + slope, slice(0, count), slice(count, 2 * count), False)


def write(path: Path, curve: ForceCurve) -> None:
    """Write a curve as CSV."""
    lines = ["piezo_m,force_N,segment"]
    for way in ("approach", "retract"):
        samples = (values[getattr(curve, way)].tolist() for values in (curve.travel, curve.force))
        lines += [f"{x!r},{force!r},{way}" for x, force in zip(*samples, strict=True)]
    path.write_text("\n".join(lines))
