"""Truths that error estimates are held against: the same events on finer grids, graded otherwise, or by another solver.

An event is taken from where it was found and solved for again. Bodies with a length of their own are discretised anew
around each, on a grid that stands still: neither the window of contact radii nor the interpolation in it is shared. An
event that such a grid turns, see `Standing.moved`, has one that follows the contact, interpolated to `LEFT`.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from fem_adhesion import discretise
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.finite_strain.scene import ScenesBody, Windows, softening
from fem_adhesion.harmonics import Fineness as Series
from fem_adhesion.harmonics import sized_body as series
from halfspace.accuracy.finite_bodies import SizedBody, at_tip
from halfspace.accuracy.grids import Resolution, half_space_charts
from halfspace.accuracy.stages import Charted
from halfspace.accuracy.standing import Standing, standing
from halfspace.elastic import compliance
from halfspace.elastic.grid import FLAT
from halfspace.elastic.layered import images_of, layered_panels
from halfspace.equilibrium.charts import placed, trace_charts
from halfspace.equilibrium.conditions import FOLD, Condition, Located
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import is_event, numbered
from halfspace.equilibrium.search import brackets_of, energy_released, find_events, with_care
from halfspace.errors import required
from halfspace.laws import LENNARD_JONES
from halfspace.profiles.formulas import SphereSurface
from halfspace.scales import Scales

LEFT = 1e-9  # R dgamma or eps


def half_space_of(scene):
    """Two grids of other gradings and extents than any that `halfspace.trace` takes; the nodes are nearly the most."""
    return [
        Charted(half_space_charts(scene.scales, Resolution(nodes, finest, growth, extent * scene.scales.widened)))
        for nodes, finest, growth, extent in ((14, 0.45, 2.2, 10.0), (16, 0.4, 2.5, 100.0))
    ]


def traced(stages):
    """Events of the curve itself, traced on the first stage and solved for again on the second."""
    segments = trace_charts(stages[0].charts)
    found = find_events(segments) | numbered(
        f for pair in brackets_of(segments, FOLD)[1:-1] for f in with_care(pair, FOLD)
    )
    return [found, on(stages[1], found)]


def relocated(state, stages):
    """Events of a state on one stage after the other."""
    states = []
    for stage in stages:
        states.append(on(stage, states[-1] if states else state))
    return states


def on(stage, state):
    """States solved for again on a stage, first on grids that stand still, whatever they were on before."""
    anew = {name: replace(event, followed=False) for name, event in state.items()}
    return {name: required(stage.moved(event, stage(event).problem)) for name, event in anew.items()}


def under_sphere(tabor, radius_ratio):
    """The half-space under a sphere."""
    return under_surface(tabor, SphereSurface(float(np.sqrt(radius_ratio / tabor))))


def under_surface(tabor, surface, law=LENNARD_JONES):
    """The half-space under a surface that ends."""
    scales, outer = Scales(tabor, law, surface), np.array([surface.end])
    return [
        standing(SizedBody(scales, partial(_panels, nodes), *how, outer, FLAT, last * surface.end), LEFT)
        for nodes, *how, last in ((14, 0.45, 2.5, 1e-7), (16, 0.35, 2.2, 1e-8))
    ]


def layered(scene):
    """A layered body with other images, on finer grids that go further, and beyond them as if it were rigid."""
    hows = ((13, 0.45, 2.5, 2000.0, 1.15, 1e-7), (15, 0.35, 2.2, 3000.0, 1.13, 1e-8))
    return [_layered(scene, *how) for how in hows]


def _layered(scene, nodes, finest, growth, far, spacing, last):
    body, profile = scene.body.layered, scene.shape.surface(scene.tabor)
    scales = Scales(scene.tabor, scene.law, profile, body)
    outer = min(profile.end, scales.radius_at((far * scales.widened) ** 2 / 2))
    rim = 18 if np.isinf(profile.end) and np.isfinite(scene.law.decay) else 1
    make = partial(_layered_panels, images_of(body, spacing), nodes, rim)
    last = last * outer if outer == profile.end else np.inf
    first = at_tip(profile, nodes)
    how = finest, growth, np.geomspace(outer, FARTHEST * outer, 18)[:rim], FLAT, last
    return standing(SizedBody(scales, make, *how, first=first, strip=np.pi / 2), LEFT)


FARTHEST = 1e8  # times, to which a tail goes on


def _layered_panels(images, nodes, rim, lines):
    """Of which so many lines, the first of them the last that yields, are far out."""
    operator = layered_panels(images, lines[: len(lines) - rim + 1], nodes)
    if rim > 1:
        operator = discretise.with_rigid_rim(operator, lines[-rim:], FLAT)
    return operator, operator.radii.size


def _panels(nodes, lines):
    return compliance.panels(lines, nodes), nodes * (lines.size - 1)


def elements(scene):
    """The body of a scene by finite elements of high degree."""
    hows = ((8, 0.55, 2.0), (9, 0.5, 2.2))
    return [standing(discretise.sized_body(scene, Discretisation(*how)), LEFT) for how in hows]


def endless(scene):
    """Whether a scene is a half-space's, or of what stands for one, under a surface without an end."""
    return scene.checked_by == "half-space" and not (scene.body.layered or scene.surface.end < np.inf)


def of(scene):
    """Two stages for any scene; by harmonics those of a sphere would take minutes at tabor 10."""
    if endless(scene):
        return half_space_of(scene)
    if scene.material.finite:
        return finite_strain(scene)
    if scene.body.layered:
        return layered(scene)
    if scene.checked_by == "half-space":
        return under_surface(scene.tabor, scene.surface, scene.law)
    return elements(scene)


def finite_strain(scene):
    """A sphere at finite strain by elements of higher degree than its events are given, on cells of its own."""
    finest = 1 - softening(scene)
    hows = ((7, 0.55 * finest, 2.2), (8, 0.45 * finest, 2.0))
    found = [ScenesBody(scene, Discretisation(*how)) for how in hows]
    return [Standing(body, partial(Windows, body)) for body in found]


def along_at_finite_strain(scene):
    """The same on meshes that each serve a stretch of the curve."""
    return [stage.everywhere for stage in finite_strain(scene)]


def harmonics(scene):
    """The whole sphere by spherical harmonics, whose upper half is the hemisphere in the sliding grip."""
    hows = [Series(nodes, number, finest=0.35, growth=1.8) for nodes, number in ((13, 30.0), (15, 40.0))]
    return [standing(series(scene, how), LEFT) for how in hows]


def numbers(state):
    """Numbers of a located state by name."""
    return {name: float(v) for name, v in zip(OBSERVABLES, state.point.observables, strict=True)}


def of_state(state):
    """Numbers of located events, and the energy."""
    found = {name: numbers(state[name]) for name in state if is_event(name)}
    told = {f"{name} {q}": v for name, own in found.items() for q, v in own.items()}
    return told | {"energy": energy_released(state["separated"], state["zero_approach"])}


def state_of(path, coordinate, branch, value):
    """The state at a value of a coordinate on a branch of a path, on the grid on which it was traced."""
    asked = path.at(**{coordinate: value}, branch=branch)
    there = path.states(Condition(OBSERVABLES.index(coordinate), value=value))
    place = np.array([asked.approach, asked.load, asked.central_gap])
    return min(there, key=lambda state: np.abs(state.point.observables[: place.size] - place).sum())


def points_on(stage, path, places):
    """Points of a curve at some places, solved for on a stage in the plane across the path."""
    points = [Located(FOLD, part.problem, point, 1.0) for part in path.finest_curve.segments for point in part.points]
    found = {k: numbers(required(placed(stage, points[k]))) for k in places}
    return {f"point {k} {q}": v for k, own in found.items() for q, v in own.items()}
