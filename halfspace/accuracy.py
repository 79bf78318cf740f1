"""The load-approach curve to an accuracy asked for: a ladder of discretisations, and the half-space's.

The curve is traced on the lowest rung and each event solved for again on the next, and on more if need be. An event's
error estimate is its change from the last rung but one to the last: nearly the lower rung's error, and so a safe bound
for the higher one's.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise

import numpy as np

from halfspace import compliance, grid
from halfspace.contact import ContactProblem, spike_width
from halfspace.curve import (
    COMPRESSION,
    Chart,
    EquilibriumPath,
    Estimate,
    energy_released,
    find_events,
    metric_for,
    trace_charts,
    transfer,
)
from halfspace.events import EVENTS, ROUND_OFF, Event, Located, estimate_event, relocate
from halfspace.limits import require_rtol, require_tabor
from halfspace.theories import jkr_radius

FINER = 30  # ratio of the tolerances for which two successive rungs are made
MOST_RUNGS = 3  # above the lowest

Charts = Sequence[Chart]
State = Mapping[str, Located]


@dataclass(frozen=True)
class Rung:
    """One step up: chart sets that each differ from the one before in one respect, the last being the finest.

    Attributes
    ----------
    stages : tuple of chart sets
        On each of which every event is solved for; the changes add up to the error.
    settings : mapping
        How the last stage is discretised.
    """

    stages: tuple[Charts, ...]
    settings: Mapping[str, object]


def climb(
    rtol: float, rung: Callable[[int], Rung], *, to_load: float = COMPRESSION, most_rungs: int = MOST_RUNGS
) -> EquilibriumPath:
    """Trace the curve on the lowest rung of a ladder and solve for its events on higher ones until `rtol` is met.

    Parameters
    ----------
    rtol : float
        Relative accuracy asked of loads and approaches.
    rung : callable
        Makes the rung of a level: 0 for the curve, 1, 2 ... for the events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.
    most_rungs : int
        Levels after which the estimates stand as they are.

    Raises
    ------
    halfspace.newton.NotConverged
        If the curve cannot be traced or an event not be found again.
    GridTooCoarse
        If a grid cannot carry the spike at the contact edge.
    """
    began = time.perf_counter()
    lowest = rung(0)
    segments = trace_charts(lowest.stages[-1], to_load)
    state: State = find_events(segments)
    for level in range(1, most_rungs + 1):
        higher = rung(level)
        states = [state]
        for charts in higher.stages:
            states.append({name: _on_charts(event, charts) for name, event in states[-1].items()})
        state = states[-1]
        events = _estimate(states)
        if all(_meets(event, rtol) for event in events.values()):
            break
    return EquilibriumPath(
        segments[0].problem.tabor,
        segments,
        events,
        _energy(states),
        tuple(states),
        max(chart.unknowns for chart in higher.stages[-1]),
        time.perf_counter() - began,
        {"rtol": rtol, "curve": lowest.settings, "events": higher.settings},
    )


def _on_charts(event: Located, charts: Charts) -> Located:
    """Solve for an event again on the chart of its kind."""
    source = event.problem
    assert isinstance(source, ContactProblem)
    target = charts[-1 if source.follows_contact else 0].problem
    return relocate(event, target, transfer(source, event.point.x, target), metric_for(target.tabor))


def _estimate(states: Sequence[State]) -> dict[str, Event]:
    """Events of the last state, with their changes from each to the next as errors."""
    return {
        name: estimate_event(name, best, [(b[name], a[name]) for a, b in pairwise(states)])
        for name, best in states[-1].items()
        if name in EVENTS
    }


def _energy(states: Sequence[State]) -> Estimate:
    values = [energy_released(state) for state in states]
    return Estimate(values[-1], float(np.sum(np.abs(np.diff(values)))) + ROUND_OFF * (1 + abs(values[-1])))


def _meets(event: Event, rtol: float) -> bool:
    """Whether the estimates are within the tolerance; approaches count relative to 1 + |alpha*|."""
    load = event.load_error <= rtol * abs(event.load) or event.name == "zero_load"
    return load and event.approach_error <= rtol * (1 + abs(event.approach))


@dataclass(frozen=True)
class Resolution:
    """How finely the half-space is discretised.

    Attributes
    ----------
    nodes : int
        Nodes per panel; the error falls about a decade a node.
    finest : float
        Length of the panels at the contact edge, in widths of the spike of tension there.
    growth : float
        Ratio of neighbouring panels.
    extent : float
        Outer end of the grid, in units of beta/sqrt(mu), the width of a rigid paraboloid's attraction.
    """

    nodes: int
    finest: float
    growth: float
    extent: float


def resolution_for(tabor: float, rtol: float) -> Resolution:
    """Resolution whose events are right to about `rtol`."""
    nodes = int(np.clip(np.ceil(3.5 - 0.75 * np.log10(rtol)), 5, 16))
    return Resolution(nodes, finest=0.6, growth=3.0, extent=extent_for(tabor, rtol))


def extent_for(tabor: float, rtol: float) -> float:
    """Outer end of the surface law, in beta/sqrt(mu).

    The load left out beyond it, 11 pi/extent^4, is kept below rtol of the load at jump_on, about 2 mu^(-6/7).
    """
    return float(2.5 * rtol**-0.25 * max(1.0, tabor) ** (6 / 28))


@dataclass(frozen=True)
class Rings:
    """Breakpoints of two charts: centred on the axis up to a contact radius, then on the edge, whose radius is 1."""

    centred: grid.Array
    edge: grid.Array
    until: float


def rings(tabor: float, finest: float, growth: float, extent: float, to_load: float = COMPRESSION) -> Rings:
    """Breakpoints fine enough for the spike of tension at every contact radius up to that under the load `to_load`.

    `finest` is in widths of the spike, `extent` in beta/sqrt(mu), as in `Resolution`.
    """
    length = finest * spike_width(tabor) / 2
    outer = extent / np.sqrt(tabor)
    widest = float(np.hypot(jkr_radius(to_load), 0.7 / np.sqrt(tabor)))
    return Rings(
        grid.graded(0.0, length, outer, growth=growth),
        grid.graded(1.0, 2 * length / widest, outer / length, growth=growth),
        until=length,
    )


def half_space_charts(tabor: float, resolution: Resolution, to_load: float = COMPRESSION) -> tuple[Chart, Chart]:
    """Panel grids centred on the axis and following the contact edge."""
    lines = rings(tabor, resolution.finest, resolution.growth, resolution.extent, to_load)
    centred = compliance.panels(lines.centred, resolution.nodes)
    edge = compliance.panels(lines.edge, resolution.nodes)
    return (
        Chart(ContactProblem(centred, tabor), centred.radii.size, lines.until),
        Chart(ContactProblem(edge, tabor, follows_contact=True), edge.radii.size),
    )


def trace(tabor: float, *, rtol: float = 1e-6, to_load: float = COMPRESSION) -> EquilibriumPath:
    """Trace the load-approach curve of a rigid paraboloid on the adhesive half-space and solve for its events.

    Parameters
    ----------
    tabor : float
        Tabor parameter mu, mu^3 = R dgamma^2/(E*^2 eps^3).
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 1e-1.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.

    Returns
    -------
    EquilibriumPath
        The curve, its events and their error estimates.

    Raises
    ------
    ValueError
        If an input is out of range.
    halfspace.newton.NotConverged
        If the curve cannot be traced.
    """
    require_tabor(tabor)
    require_rtol(rtol)

    def rung(level: int) -> Rung:
        resolution = resolution_for(tabor, rtol / FINER**level)
        return Rung((half_space_charts(tabor, resolution, to_load),), asdict(resolution))

    return climb(rtol, rung, to_load=to_load)
