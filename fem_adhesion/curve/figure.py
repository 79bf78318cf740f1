"""One page about a curve: load against approach with its jumps, the states at its events, and the body's mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.common import lines, style
from fem_adhesion.curve.load import LEGEND, STATES, draw_central_gap, draw_line, draw_load, draw_states
from fem_adhesion.curve.settings import USUAL
from fem_adhesion.curve.solve import FINITE_ELEMENTS, WEAK_FORM, Curves
from fem_adhesion.elasticity.stress import positions, sampled
from fem_adhesion.fields import State, gaps_at, require_fields, state_at
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import tried
from halfspace.values import Array

LOOK = {**style.LOOK, "font.size": 9.5}


def has_mesh(curves: Curves) -> bool:
    """Whether the page shows the mesh, of a body of which there is a picture, and not the central gap."""
    scene = curves.question.scene
    return curves.solver == FINITE_ELEMENTS and tried(require_fields, scene, refusals=True) is None


def draw(curves: Curves) -> Figure:
    """Page with the curve on top, the profiles of its states, the edge spike, and the mesh or the central gap.

    The weak form has points and events alone: of it load and central gap are drawn.
    """
    if curves.solver == WEAK_FORM:
        return _draw_weak_form(curves)
    figure = Figure(figsize=(7.3, 10.0), layout="constrained")
    areas = figure.subplot_mosaic("aa;bc;de", height_ratios=[1.6, 1, 1])
    body = draw_mesh if has_mesh(curves) else draw_central_gap
    for letter, paint in zip("abcde", (draw_load, draw_pressure, draw_gap, draw_spike, body), strict=True):
        areas[letter].set_title(f"({letter}) {paint(areas[letter], curves)}", loc="left", fontsize=9.5)
    return figure


def _draw_weak_form(curves: Curves) -> Figure:
    """Load and central gap against approach, by stability, with the events."""
    curve, (figure, axes) = curves.paths[WEAK_FORM], style.panels(2)
    values = np.column_stack([curve.approach, curve.load, curve.central_gap])
    line = lines.through(curve.arclength, values, curve.rates, curve.stable)
    for panel, name in zip(axes, ("load", "central_gap"), strict=True):
        draw_line(panel, curves, line, name)
        draw_states(panel, curves, name)
        style.dress(panel, curves.scales["approach"].label, curves.scales[name].label, legend=None)
    axes[0].legend(loc="best", **LEGEND)
    return figure


EVENT = "pull_off"
MESH = Discretisation(degree=4)


def outlines(state: State, reach: float) -> tuple[Array, Array]:
    """Points round the cells within a distance of the pole in beta, and their displacements, both (cells, points, 2).

    Positions (r, z) are in beta, displacements in beta^2/R.
    """
    mesh, space = state.space.mesh, state.space
    nearest = np.hypot(*mesh.p)[mesh.t].min(axis=0)
    corners = space.element.refdom.p.T
    t = np.linspace(0, 1, 9)[:-1, None]  # points on a side
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    round_cell = np.concatenate([a + t * (b - a) for a, b in sides]).T
    near = np.flatnonzero(nearest <= reach)
    places, moved = np.array(positions(space, round_cell)), sampled(space, state.components, round_cell)
    return places[:, near].transpose(1, 2, 0), moved[:, near].transpose(1, 2, 0)


def draw_mesh(axes: Any, curves: Curves) -> str:
    """Mesh and deformation where the load is least, magnified; over a half-space the rigid sphere, unless too far.

    Returns the title.
    """
    scene, found = curves.question.scene, curves.path.stages[-1][EVENT]
    state = state_at(scene, found.problem, found.point, name=EVENT, how=MESH)
    a, unit = float(state.observables[CONTACT_RADIUS]), curves.scales["radius"]
    a = a if np.isfinite(a) else scene.tabor**-0.5  # the width of a rigid sphere's attraction where there is no contact
    places, moved = outlines(state, 2 * USUAL.shown * a)
    factor = 0.45 * a / float(np.abs(moved).max())
    look: dict[str, Any] = {"facecolors": "0.94", "edgecolors": style.BLUE, "linewidths": 0.35}
    drawn = unit.size * (places + factor * moved)
    axes.add_collection(PolyCollection(list(drawn), **look))
    for depth in scene.body.interfaces:
        line = drawn[np.isclose(places[..., 1], -depth, rtol=1e-9, atol=0)]
        axes.plot(*line[np.argsort(line[:, 0])].T, color=style.BLUE, linewidth=1.3)
    r = np.linspace(0, USUAL.shown * a, 200)
    sphere = factor * _sphere(state, r)
    if np.isinf(scene.body.size) and sphere[0] < USUAL.highest * a:
        axes.plot(unit.size * r, unit.size * sphere, color="black", linewidth=1.3, label="rigid sphere")
        axes.legend(loc="lower right", **LEGEND)
    axes.set(
        xlim=(0, unit.size * USUAL.shown * a),
        ylim=(-unit.size * 1.6 * a, unit.size * USUAL.highest * a),
        aspect="equal",
    )
    axes.set_anchor("W")  # under the beginning of its title, which is wider
    axes.set_xlabel(unit.label)
    axes.set_ylabel(unit.label.replace("radius $r$", "height $z$").replace("radius $u = r/", "height $z/"))
    question, words = curves.question, STATES[EVENT].words
    R = question.units.radius / question.units.length if question.units else scene.sphere_radius
    if np.isfinite(R):
        return f"mesh at {words}, displacement $\\times {factor * R:.3g}$"
    # A half-space has no length of its own: the title says what the unit is drawn as.
    return f"mesh at {words}, $\\beta^2/R$ drawn as {factor:.2g} $\\beta$"


def _sphere(state: State, r: Array) -> Array:
    """Height of the rigid sphere over the undeformed surface, r^2/2R + eps - alpha, in beta^2/R."""
    return np.asarray(state.problem.profile.height(r) + (1 - state.observables[APPROACH]) / state.scene.tabor)


Along = Mapping[str, Array]
"""A state along the surface: radius in beta, pressure in dgamma/(mu eps), gap H in eps, each (n,)."""


def state_of(path: EquilibriumPath, name: str) -> tuple[ContactProblem, Array]:
    """Return the problem and the state x of an event, on the finest discretisation."""
    found = path.stages[-1][name]
    return found.problem.interface, found.problem.surface_state(found.point.x)


def profile(path: EquilibriumPath, name: str, radii: Array) -> Along:
    """State of an event at radii (beta), by the polynomials of its discretisation; none beyond its end."""
    problem, x = state_of(path, name)
    inside = radii[radii <= problem.operator_at(x).extent]
    gap = gaps_at(path.stages[-1][name], inside)
    return {"radius": inside, "pressure": problem.law.pressure(gap, problem.tabor), "gap": gap}


def widest(path: EquilibriumPath) -> float:
    """Contact radius at zero load, the widest of the events."""
    return float(path.stages[-1]["zero_load"].point.observables[CONTACT_RADIUS])


def draw_pressure(axes: Any, curves: Curves) -> str:
    """Pressure against radius at the events; returns the title."""
    x, y = curves.scales["radius"], curves.scales["pressure"]
    _draw(axes, curves, "pressure")
    axes.axhline(0, color="0.8", linewidth=0.7, zorder=0)
    style.dress(axes, x.label, y.label, legend=None, xlim=(0, x.size * USUAL.wider * widest(curves.path)))
    return "pressure, lines as in (c)"


def draw_gap(axes: Any, curves: Curves) -> str:
    """Gap against radius at the events; the edge of contact is where the tension is largest. Returns the title."""
    x, y, path = curves.scales["radius"], curves.scales["gap"], curves.path
    _draw(axes, curves, "gap")
    edge = state_of(path, "zero_load")[0].law.edge_gap
    axes.axhline(y.size * edge, color="0.5", linewidth=0.8, linestyle=style.DOTTED, label="edge of contact")
    right = USUAL.wider * widest(path)
    top = max(2.0, 3.3 * path.tabor * widest(path) ** 2 / 2)  # an undeformed sphere's at the rim
    style.dress(axes, x.label, y.label, legend=None, xlim=(0, x.size * right), ylim=(-0.6 * y.size, top * y.size))
    axes.legend(loc="upper left", **LEGEND)
    return "gap"


def _draw(axes: Any, curves: Curves, quantity: str) -> None:
    """A quantity along the surface at each event."""
    radii = np.linspace(0, USUAL.wider * widest(curves.path), USUAL.points)
    for name, look in STATES.items():
        if curves.path.event(name):
            state = profile(curves.path, name, radii)
            line = {"color": look.color, "linestyle": look.linestyle, "linewidth": 1.6, "label": look.words}
            axes.plot(*curves.shown(**{name: state[name] for name in ("radius", quantity)}), **line)


def draw_spike(axes: Any, curves: Curves) -> str:
    """Pressure around the edge of contact where it is lost, with the nodes of the grid on it; returns the title."""
    x, y, path = curves.scales["radius"], curves.scales["pressure"], curves.path
    name = "jump_off" if path.event("jump_off") else "pull_off"
    (problem, found), look = state_of(path, name), STATES[name]
    edge, radii = problem.contact_radius(found), problem.radii(found)
    reach = 5 * path.segments[0].problem.interface.scales.spike_width
    low, high = max(0.0, edge - reach), edge + reach
    line, shown = profile(path, name, np.linspace(low, high, USUAL.points)), (radii >= low) & (radii <= high)
    axes.plot(*curves.shown(radius=line["radius"], pressure=line["pressure"]), color=look.color, linewidth=1.3)
    dots = {"linestyle": "none", "marker": "o", "markersize": 3, "color": "black", "zorder": 3}
    at = curves.shown(radius=radii[shown], pressure=problem.pressure(found)[shown])
    axes.plot(*at, label="nodes of the grid", **dots)
    axes.axvline(x.size * edge, color="0.5", linewidth=0.8, linestyle=style.DOTTED, label="edge of contact")
    style.dress(axes, x.label, y.label, legend=None, xlim=(x.size * low, x.size * high))
    axes.legend(loc="best", **LEGEND)
    return f"spike at the edge, {look.words}"
