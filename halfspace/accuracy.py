"""The load-approach curve to an accuracy asked for: a ladder of discretisations, and the half-space's.

The curve is traced on the lowest rung and each event solved for again on the next, and on more if need be. An event's
error estimate is half its change from the last rung but one to the last: the change is nearly the lower
rung's error, of which the higher rung is made to leave a tenth or less.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

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
from halfspace.events import EVENTS, REMAINING, ROUND_OFF, Event, Located, estimate_event, relocate
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.newton import NotConverged
from halfspace.theories import jkr_radius

FINER = 30  # ratio of the errors of two successive rungs
MOST_RUNGS = 3  # above the lowest
TWIN = (0.75, 0.87)  # finest cells and growth of a twin, in those of its sibling: no cell of the two is the same

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
    twin : chart set or None
        As fine as the rung below, with other cells: it errs as much, but not by the same accident of sign.
    remaining : float
        Part of the changes that may be left as error; above 1 where the error falls slowly from stage to stage.
    """

    stages: tuple[Charts, ...]
    settings: Mapping[str, object]
    twin: Charts | None = None
    remaining: float = REMAINING


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
    for start in range(most_rungs):
        try:
            return _climb_from(start, rtol, rung, to_load, most_rungs)
        except NotConverged:  # as where two folds about to merge exist on one grid but not on the next
            if start == most_rungs - 1:
                raise
    raise ValueError(f"most_rungs = {most_rungs} leaves nothing to climb; allow 1 or more")


def _climb_from(
    start: int, rtol: float, rung: Callable[[int], Rung], to_load: float, most_rungs: int
) -> EquilibriumPath:
    """Trace the curve on the rung `start` and climb from there."""
    began = time.perf_counter()
    lowest = rung(start)
    segments = trace_charts(lowest.stages[-1], to_load)
    state: State = find_events(segments)
    for level in range(start + 1, start + most_rungs + 1):
        higher = rung(level)
        chains = _step_up(state, higher)
        state = chains[0][-1]
        events = _estimate(chains, higher.remaining)
        if all(_meets(event, rtol) for event in events.values()):
            break
    return EquilibriumPath(
        segments[0].problem.tabor,
        segments,
        events,
        _energy(chains, higher.remaining),
        tuple(chains[0]),
        max(chart.unknowns for chart in higher.stages[-1]),
        time.perf_counter() - began,
        {"rtol": rtol, "curve": lowest.settings, "events": higher.settings},
    )


def _step_up(state: State, higher: Rung) -> list[list[State]]:
    """Chains of states from the rung below, and from its twin, to the last stage of a rung."""
    chain = [state]
    for charts in higher.stages:
        chain.append(_on_all(chain[-1], charts))
    return [chain, [_on_all(chain[-1], higher.twin), chain[-1]]] if higher.twin else [chain]


def _on_charts(event: Located, charts: Charts) -> Located:
    """Solve for an event again on the chart of its kind."""
    source = event.problem
    assert isinstance(source, ContactProblem)
    target = charts[-1 if source.follows_contact else 0].problem
    return relocate(event, target, transfer(source, event.point.x, target), metric_for(target.tabor))


def _on_all(state: State, charts: Charts) -> State:
    return {name: _on_charts(event, charts) for name, event in state.items()}


def _estimate(chains: Sequence[Sequence[State]], remaining: float) -> dict[str, Event]:
    """Events of the last state, with their changes along the chains as errors."""
    names = [name for name in EVENTS if name in chains[0][-1]]
    return {
        name: estimate_event(name, [[state[name] for state in chain] for chain in chains], remaining) for name in names
    }


def _energy(chains: Sequence[Sequence[State]], remaining: float) -> Estimate:
    values = [[energy_released(state) for state in chain] for chain in chains]
    best = values[0][-1]
    change = max(float(np.sum(np.abs(np.diff(chain)))) for chain in values)
    return Estimate(best, remaining * change + ROUND_OFF * (1 + abs(best)))


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


def resolution_for(tabor: float, rtol: float, level: int = 0) -> Resolution:
    """Resolution whose events are right to about `rtol` at level 0, and some 30 times better at each level above it."""
    nodes = int(np.clip(np.ceil(3.5 - 0.75 * np.log10(rtol)) + 2 * level, 5, 16))
    return Resolution(nodes, finest=0.6, growth=3.0, extent=extent_for(tabor, rtol) * FINER ** (level / 4))


def extent_for(tabor: float, rtol: float) -> float:
    """Outer end of the surface law, in beta/sqrt(mu).

    The load left out beyond it, 11 pi/extent^4, is kept below rtol of the load at jump_on, about 2 mu^(-6/7), and
    below a per cent of it for any rtol, lest it decide whether the curve folds.
    """
    return float(2.5 * min(rtol, 0.01) ** -0.25 * max(1.0, tabor) ** (6 / 28))


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
    widest = widest_radius(tabor, to_load)
    return Rings(
        grid.graded(0.0, length, outer, growth=growth),
        grid.graded(1.0, 2 * length / widest, outer / length, growth=growth),
        until=length,
    )


def widest_radius(tabor: float, to_load: float) -> float:
    """Contact radius in beta that a curve up to a load hardly exceeds: a soft and a rigid contact's together."""
    return float(np.hypot(jkr_radius(to_load), 0.7 / np.sqrt(tabor)))


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
    require_load(to_load)

    def rung(level: int) -> Rung:
        resolution, below = (resolution_for(tabor, rtol, max(n, 0)) for n in (level, level - 1))
        if not level:
            return Rung((half_space_charts(tabor, resolution, to_load),), asdict(resolution))
        wider = replace(below, extent=resolution.extent)
        twin = replace(wider, finest=TWIN[0] * below.finest, growth=TWIN[1] * below.growth)
        charts = [half_space_charts(tabor, r, to_load) for r in (wider, resolution, twin)]
        return Rung((charts[0], charts[1]), asdict(resolution), charts[2])

    return climb(rtol, rung, to_load=to_load)
