"""Pressure and gap along the surface at the events of a curve, and the spike of tension at the edge of contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.curve.solve import Curves, scales
from halfspace.equilibrium.contact import CONTACT_RADIUS, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array, Valued

POINTS = 1500
WIDER = 1.6  # radii shown, in those of the widest contact
HIGHEST_GAP = 3.3  # shown outside the contact, in gaps at its rim on an undeformed sphere
SPIKES = 5  # widths of the spike shown on either side of the edge
LEGEND = {"fontsize": 8, "handlelength": 3.2, "framealpha": 0.9, "edgecolor": "none"}


@dataclass(frozen=True)
class Look:
    """How a state is drawn: its name, and what tells it from the others."""

    words: str
    color: str
    linestyle: Any
    marker: str


STATES: Mapping[str, Look] = {
    "jump_on": Look("jump on", style.GREEN, style.CHAIN, "^"),
    "jump_off": Look("jump off", style.RED, style.DASHED, "v"),
    "pull_off": Look("pull-off", style.BLUE, "-", "o"),
    "zero_load": Look("zero load", style.ORANGE, style.LONG, "D"),
}


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceState(Valued):
    """A state along the surface: radii in beta, pressure in dgamma/(mu eps), gap H in eps, each (n,)."""

    radii: Array
    pressure: Array
    gap: Array


def state_of(path: EquilibriumPath, name: str) -> tuple[ContactProblem, Array]:
    """Return the problem and the state x of an event, on the finest discretisation."""
    found = path.stages[-1][name]
    return found.problem.interface, found.problem.surface_state(found.point.x)


def profile(path: EquilibriumPath, name: str, radii: Array) -> SurfaceState:
    """State of an event at radii (beta), by the polynomials of its discretisation; none beyond its end.

    The deflection goes through the polynomials, not the gap, in which the equator of a sphere is vertical.
    """
    problem, x = state_of(path, name)
    body = problem.operator_at(x)
    inside = radii[radii <= body.extent]
    undeformed, nodal = (problem.tabor * problem.profile.height(r) for r in (inside, body.radii))
    gap = undeformed + body.values_at(inside, x[:-2] - nodal)
    return SurfaceState(inside, problem.law.pressure(gap, problem.tabor), gap)


def nodes(path: EquilibriumPath, name: str) -> SurfaceState:
    """State of an event at the nodes of its grid."""
    problem, x = state_of(path, name)
    return SurfaceState(problem.radii(x), problem.pressure(x), x[:-2])


def widest(path: EquilibriumPath) -> float:
    """Contact radius at zero load, the widest of the events."""
    return float(path.stages[-1]["zero_load"].point.observables[CONTACT_RADIUS])


def draw_pressure(axes: Any, curves: Curves) -> str:
    """Pressure against radius at the events; returns the title."""
    units = scales(curves)
    x, y = units["radius"], units["pressure"]
    _draw(axes, curves, "pressure")
    axes.axhline(0, color="0.8", linewidth=0.7, zorder=0)
    style.dress(axes, x.label, y.label, legend=None, xlim=(0, x.size * WIDER * widest(curves.path)))
    return "pressure, lines as in (c)"


def draw_gap(axes: Any, curves: Curves) -> str:
    """Gap against radius at the events; the edge of contact is where the tension is largest. Returns the title."""
    units, path = scales(curves), curves.path
    x, y = units["radius"], units["gap"]
    _draw(axes, curves, "gap")
    edge = state_of(path, "zero_load")[0].law.edge_gap
    axes.axhline(y.size * edge, color="0.5", linewidth=0.8, linestyle=style.DOTTED, label="edge of contact")
    right = WIDER * widest(path)
    top = max(2.0, HIGHEST_GAP * path.tabor * widest(path) ** 2 / 2)
    style.dress(axes, x.label, y.label, legend=None, xlim=(0, x.size * right), ylim=(-0.6 * y.size, top * y.size))
    axes.legend(loc="upper left", **LEGEND)
    return "gap"


def _draw(axes: Any, curves: Curves, quantity: str) -> None:
    """A quantity along the surface at each event."""
    units, radii = scales(curves), np.linspace(0, WIDER * widest(curves.path), POINTS)
    for name, look in STATES.items():
        if curves.path.event(name):
            state = profile(curves.path, name, radii)
            line = {"color": look.color, "linestyle": look.linestyle, "linewidth": 1.6, "label": look.words}
            axes.plot(units["radius"].of(state.radii), units[quantity].of(getattr(state, quantity)), **line)


def draw_spike(axes: Any, curves: Curves) -> str:
    """Pressure around the edge of contact where it is lost, with the nodes of the grid on it; returns the title."""
    units, path = scales(curves), curves.path
    x, y = units["radius"], units["pressure"]
    name = "jump_off" if path.event("jump_off") else "pull_off"
    edge, look = state_of(path, name)[0].contact_radius(state_of(path, name)[1]), STATES[name]
    reach = SPIKES * path.segments[0].problem.interface.scales.spike_width
    low, high = max(0.0, edge - reach), edge + reach
    line, points = profile(path, name, np.linspace(low, high, POINTS)), nodes(path, name)
    shown = (points.radii >= low) & (points.radii <= high)
    axes.plot(x.of(line.radii), y.of(line.pressure), color=look.color, linewidth=1.3)
    dots = {"linestyle": "none", "marker": "o", "markersize": 3, "color": "black", "zorder": 3}
    axes.plot(x.of(points.radii[shown]), y.of(points.pressure[shown]), label="nodes of the grid", **dots)
    axes.axvline(x.size * edge, color="0.5", linewidth=0.8, linestyle=style.DOTTED, label="edge of contact")
    style.dress(axes, x.label, y.label, legend=None, xlim=(x.size * low, x.size * high))
    axes.legend(loc="best", **LEGEND)
    return f"spike at the edge, {look.words}"
