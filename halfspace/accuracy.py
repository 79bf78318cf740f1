"""The load-approach curve on the half-space to an accuracy asked for: chooses the grids, estimates the errors.

The curve is traced on one level of grids and each event solved for again on a finer one, and if need be on a third.
An event's error estimate is its change between the last two levels, which is nearly the error of the coarser one of
them and so a safe bound for the finer's.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass

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

FINER = 30  # ratio of the tolerances of two successive levels of grids
MOST_LEVELS = 3


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
    """Resolution whose events are right to about `rtol`.

    The load left out beyond the grid, 11 pi/extent^4, is kept below rtol of the load at jump_on, about 2 mu^(-6/7).
    """
    nodes = int(np.clip(np.ceil(3.5 - 0.75 * np.log10(rtol)), 5, 16))
    return Resolution(nodes, finest=0.6, growth=3.0, extent=2.5 * rtol**-0.25 * max(1.0, tabor) ** (6 / 28))


def half_space_charts(tabor: float, resolution: Resolution, to_load: float = COMPRESSION) -> tuple[Chart, Chart]:
    """Grids centred on the axis and on the contact edge, fine enough for the spike of tension at every radius."""
    finest = resolution.finest * spike_width(tabor)
    extent = resolution.extent / np.sqrt(tabor)
    widest = np.hypot(jkr_radius(to_load), 0.7 / np.sqrt(tabor))
    k, growth = resolution.nodes, resolution.growth
    centred = compliance.panels(grid.graded(0.0, finest / 2, extent, growth=growth), k)
    edge = compliance.panels(grid.graded(1.0, finest / widest, 2 * extent / finest, growth=growth), k)
    return (
        Chart(ContactProblem(centred, tabor), until=finest / 2),
        Chart(ContactProblem(edge, tabor, follows_contact=True)),
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
    began = time.perf_counter()
    resolution = resolution_for(tabor, rtol)
    segments = trace_charts(half_space_charts(tabor, resolution, to_load), to_load)
    levels = [find_events(segments)]
    for level in range(1, MOST_LEVELS + 1):
        finer = resolution_for(tabor, rtol / FINER**level)
        charts = half_space_charts(tabor, finer, to_load)
        levels.append({name: _on_charts(event, charts) for name, event in levels[-1].items()})
        events = _estimate(levels)
        if all(_meets(event, rtol) for event in events.values()):
            break
    return EquilibriumPath(
        tabor,
        segments,
        events,
        _energy(levels),
        max(chart.problem.operator.radii.size for chart in charts),
        time.perf_counter() - began,
        {"rtol": rtol, "curve": asdict(resolution), "events": asdict(finer)},
    )


Level = dict[str, Located]


def _estimate(levels: list[Level]) -> dict[str, Event]:
    """Events of the last level, with their changes from the one before as errors."""
    last, before = levels[-1], levels[-2]
    return {name: estimate_event(name, last[name], [(last[name], before[name])]) for name in last if name in EVENTS}


def _energy(levels: list[Level]) -> Estimate:
    value, before = energy_released(levels[-1]), energy_released(levels[-2])
    return Estimate(value, abs(value - before) + ROUND_OFF * (1 + abs(value)))


def _meets(event: Event, rtol: float) -> bool:
    """Whether the estimates are within the tolerance; approaches count relative to 1 + |alpha*|."""
    load = event.load_error <= rtol * abs(event.load) or event.name == "zero_load"
    return load and event.approach_error <= rtol * (1 + abs(event.approach))


def _on_charts(event: Located, charts: tuple[Chart, Chart]) -> Located:
    """Solve for an event again on the chart of its kind."""
    source = event.problem
    assert isinstance(source, ContactProblem)
    target = charts[1 if source.follows_contact else 0].problem
    return relocate(event, target, transfer(source, event.point.x, target), metric_for(target.tabor))
