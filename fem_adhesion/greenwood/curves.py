"""Curves of Greenwood's figures: finely stepped paths, states on them, jumps under fixed grips or of an apparatus."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

import halfspace
from fem_adhesion.common.numbers import told
from halfspace.accuracy.fold_birth import FIRST, critical_stiffness, tabor_of
from halfspace.accuracy.trace import half_space_charts, resolution_for
from halfspace.equilibrium.charts import COMPRESSION, trace_charts
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, Jump, cycle
from halfspace.equilibrium.path import Steps
from halfspace.scales import Scales
from halfspace.values import Array, Valued

FINE = Steps(first=0.02, longest=0.08, turn=0.06)  # a polygon through the points looks smooth
FINEST = Steps(first=0.02, longest=0.03, turn=0.02)  # even enlarged
SEEN = 1e-4  # relative accuracy of what is only drawn

# States of [G97] Fig. 4 at mu = 5: the central gap, and whether it is met first or last along the path.
PROFILES = ((2.554, 0), (1.0, 0), (0.3, 0), (0.02, 0), (0.0, -1), (-0.0036, -1), (-0.01, -1))
PROFILE_RADII = np.concatenate([[0.0], np.geomspace(1e-3, 0.05, 30), np.linspace(0.052, 4.0, 1200)])

STIFFNESSES = (math.inf, 100.0, 10.0, 3.0, 1.0, 0.3, 0.1)  # R dgamma/eps, of an apparatus


@dataclass(frozen=True, eq=False, repr=False)
class DrawnState(Valued):
    """Shape and pressure of one state.

    Central gap and approach in eps, load in R dgamma, contact radius in beta, nan where the central gap exceeds 3^(1/6)
    eps; radii in beta, gap in eps and pressure in dgamma/(mu eps), (n,) arrays.
    """

    central_gap: float
    approach: float
    load: float
    contact_radius: float
    radii: Array
    gap: Array
    pressure: Array


def fine_path(tabor: float, *, to_load: float = COMPRESSION, steps: Steps = FINE) -> EquilibriumPath:
    """Trace a curve and put points on it that are close enough to be drawn; its events are the trace's."""
    scales = Scales(tabor)
    charts = half_space_charts(scales, resolution_for(scales, SEEN), to_load)
    path = halfspace.trace(tabor, rtol=SEEN, to_load=to_load)
    return replace(path, segments=trace_charts(charts, to_load, steps))


def jumps(tabor: float) -> dict[str, Jump]:
    """Jumps under fixed grips by the letters of their ends in [G97] Fig. 2a; none where the curve does not fold."""
    grips = cycle(halfspace.trace(tabor, rtol=1e-6))
    return {"AB": grips.jump_on, "CD": grips.jump_off} if grips else {}


def profiles(path: EquilibriumPath) -> Iterator[DrawnState]:
    """States of Fig. 4 on a path, in order along it."""
    for gap, which in PROFILES:
        found = path.states(Condition(CENTRAL_GAP, value=gap))
        if found:
            yield _profile(found[which])


def _profile(state: Located) -> DrawnState:
    """State as a field; the gap is interpolated, the pressure is what the law gives for it."""
    problem, x = state.problem.interface, state.problem.surface_state(state.point.x)
    edge = state.point.observables[CONTACT_RADIUS]  # where the tension is largest
    radii = np.union1d(PROFILE_RADII, edge[np.isfinite(edge)])
    gap = problem.operator_at(x).values_at(radii, x[:-2])
    approach, load, central_gap, radius = state.point.observables
    pressure = problem.law.pressure(gap, problem.tabor)
    return DrawnState(central_gap, approach, load, radius, radii, gap, pressure)


def gap_falls(path: EquilibriumPath) -> bool:
    """Whether the central gap falls at every point of a curve, by the tangents: grids hand over with a small step."""
    return all(point.rates[CENTRAL_GAP] < 0 for point in path.points)


def elements_beside(fe: EquilibriumPath | None, path: EquilibriumPath, x: str, y: str) -> str:
    """How far finite-element points lie from the half-space's curve."""
    if fe is None:
        return ""
    seen = (fe.load <= path.load.max(initial=-np.inf)) & (fe.approach >= path.approach.min(initial=np.inf))
    if x == "contact_radius" or y == "contact_radius":
        seen &= np.isfinite(fe.contact_radius)
    line = np.isfinite(getattr(path, x)) & np.isfinite(getattr(path, y))
    off = _farthest((getattr(fe, x)[seen], getattr(fe, y)[seen]), (getattr(path, x)[line], getattr(path, y)[line]))
    text = (
        f"At mu = {path.tabor:g} the finite-element points are within {off:.1e} of the line, in units of their extent."
    )
    return told(text, off)


def _farthest(points: tuple[Array, Array], line: tuple[Array, Array]) -> float:
    """Largest distance of points from a polygon, in units of its width and height where the points are."""
    at, corners = np.stack(points), np.stack(line)
    if at.size == 0 or corners.shape[1] < 2:
        return math.nan
    size = np.maximum(np.ptp(at, axis=1), 1e-12)[:, None]
    at, corners = at / size, corners / size
    start, step = corners[:, :-1], np.diff(corners)
    length = np.maximum(np.sum(step**2, axis=0), 1e-30)
    offsets = at[:, :, None] - start[:, None]
    t = np.clip(np.sum(offsets * step[:, None], axis=0) / length, 0, 1)
    return float(np.hypot(*(offsets - t * step[:, None])).min(axis=1).max())


@dataclass(frozen=True, eq=False, repr=False)
class DeviceStudy(Valued):
    """Cycles at a Tabor parameter by falling stiffness, fixed grips first, and the border of jumping and following.

    `border` (n, 2) has Tabor parameters below the critical one, and the stiffness in R dgamma/eps below which they
    jump.
    """

    tabor: float
    cycles: tuple[Cycle, ...]
    border: Array


def devices(path: EquilibriumPath) -> DeviceStudy:
    """Cycles on a traced curve, which must fold, and the border at every Tabor parameter."""
    cycles = (cycle(path, stiffness) for stiffness in STIFFNESSES)
    critical = tabor_of(FIRST)
    tabors = critical * (1 - np.geomspace(0.999, 1e-3, 40))
    border = np.array([[tabor, critical_stiffness(float(tabor))] for tabor in tabors])
    return DeviceStudy(path.tabor, tuple(c for c in cycles if c is not None), border)
