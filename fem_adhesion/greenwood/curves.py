"""Curves of Greenwood's figures: finely stepped paths, where jumps under fixed grips land, states along a path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

import halfspace
from halfspace.accuracy.trace import half_space_charts, resolution_for
from halfspace.equilibrium import devices
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.curve import COMPRESSION, EquilibriumPath, metric_for, trace_charts
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import FOLD, Condition, Located, locate
from halfspace.equilibrium.path import Steps
from halfspace.values import Array, Estimate, Valued

FINE = Steps(first=0.02, longest=0.08, turn=0.06)  # a polygon through the points looks smooth
FINEST = Steps(first=0.02, longest=0.03, turn=0.02)  # even enlarged
SEEN = 1e-4  # relative accuracy of what is only drawn

# States of [G97] Fig. 4 at mu = 5: the central gap, and whether it is met first or last along the path.
PROFILES = ((2.554, 0), (1.0, 0), (0.3, 0), (0.02, 0), (0.0, -1), (-0.0036, -1), (-0.01, -1))
PROFILE_RADII = np.concatenate([[0.0], np.geomspace(1e-3, 0.05, 30), np.linspace(0.052, 4.0, 1200)])


@dataclass(frozen=True)
class Jump:
    """A jump under fixed grips.

    Attributes
    ----------
    take_off, landing : str
        Letters of [G97] Fig. 2a.
    approach : Estimate
        In eps, the same before and after.
    load, landing_load : Estimate
        Before and after, in R dgamma.
    """

    take_off: str
    landing: str
    approach: Estimate
    load: Estimate
    landing_load: Estimate


@dataclass(frozen=True, eq=False, repr=False)
class Profile(Valued):
    """Shape and pressure of one state.

    Attributes
    ----------
    central_gap, approach, load : float
        In eps, eps and R dgamma.
    contact_radius : float
        In beta, nan where the central gap exceeds 3^(1/6) eps.
    radii, gap, pressure : (n,) arrays
        In beta, eps and dgamma/(mu eps).
    """

    central_gap: float
    approach: float
    load: float
    contact_radius: float
    radii: Array
    gap: Array
    pressure: Array


def fine_path(
    tabor: float, *, rtol: float = SEEN, to_load: float = COMPRESSION, steps: Steps = FINE
) -> EquilibriumPath:
    """Trace a curve and put points on it that are close enough to be drawn; its events are the trace's."""
    charts = half_space_charts(tabor, resolution_for(tabor, rtol), to_load)
    path = halfspace.trace(tabor, rtol=rtol, to_load=to_load)
    return replace(path, segments=trace_charts(charts, to_load, steps))


def folds(path: EquilibriumPath) -> list[Located]:
    """Every fold in the approach, in order along the path."""
    return states(path, FOLD)


def states(path: EquilibriumPath, condition: Condition) -> list[Located]:
    """Every state of the path that meets a condition, in order."""
    metric = metric_for(path.tabor)
    return [e for s in path.segments for e in locate(s.problem, s.points, metric, condition)]


def jumps(tabor: float, *, rtol: float = 1e-6) -> tuple[Jump, ...]:
    """Jumps A to B, into contact, and C to D, out of it; empty where the curve does not fold."""
    grips = cycle(halfspace.trace(tabor, rtol=rtol))
    return (_lettered("AB", grips.jump_on), _lettered("CD", grips.jump_off)) if grips else ()


def _lettered(letters: str, jump: devices.Jump) -> Jump:
    before, after = jump.take_off, jump.landing
    approach = before.estimate("approach")
    load, landing_load = (event.estimate("load") for event in (before, after))
    return Jump(letters[0], letters[1], approach, load, landing_load)


def profiles(path: EquilibriumPath) -> Iterator[Profile]:
    """States of Fig. 4 on a path, in order along it."""
    for gap, which in PROFILES:
        found = states(path, Condition(CENTRAL_GAP, value=gap))
        if found:
            yield _profile(found[which])


def _profile(state: Located) -> Profile:
    """State as a field; the gap is interpolated, the pressure is what the law gives for it."""
    problem, x = state.problem.interface, state.problem.surface_state(state.point.x)
    edge = state.point.observables[CONTACT_RADIUS]  # where the tension is largest
    radii = np.union1d(PROFILE_RADII, edge[np.isfinite(edge)])
    gap = problem.operator_at(x).values_at(radii, x[:-2])
    approach, load, central_gap, radius = state.point.observables
    pressure = problem.law.pressure(gap, problem.tabor)
    return Profile(central_gap, approach, load, radius, radii, gap, pressure)
