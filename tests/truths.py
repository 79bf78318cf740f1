"""Truths that error estimates are held against: the same events on finer grids, graded otherwise, or by another solver.

An event is taken from where it was found and solved for again. Bodies with a length of their own are discretised anew
around each, on a grid that stands still: neither the window of contact radii nor the interpolation in it is shared.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from legendre_sphere import sphere_operator

from fem_adhesion import finite_strain_meshes, sized
from fem_adhesion.finite_strain_scene import softening
from halfspace import compliance
from halfspace.accuracy import Resolution, half_space_charts, widened
from halfspace.breathing import FlatCoordinate
from halfspace.contact import CONTACT_RADIUS, ContactProblem
from halfspace.curve import Chart, find_events, moved, trace_charts
from halfspace.ladder import Charted
from halfspace.profiles import Sphere, between_spheres
from halfspace.sized import SizedBody


@dataclass(frozen=True)
class Standing:
    """Stage of a body on a grid of its own for each event, that stands still and is finest where its contact ends."""

    body: SizedBody

    def __call__(self, event):
        """Chart of an event."""
        body, radius = self.body, float(event.point.observables[CONTACT_RADIUS])
        if not radius > body.length:
            return body.centred()
        operator, unknowns = body.make(body.lines(body.coordinate.of(radius)))
        return Chart(ContactProblem(operator, body.tabor, profile=body.profile), unknowns)


def half_space(tabor, *_):
    """Two grids of other gradings and extents than any that `halfspace.trace` takes; the nodes are nearly the most."""
    extent = 10 * widened(tabor)
    return [
        Charted(half_space_charts(tabor, Resolution(nodes, finest, growth, extent)))
        for nodes, finest, growth in ((14, 0.45, 2.2), (16, 0.4, 2.5))
    ]


def traced(stages):
    """Events of the curve itself, traced on the first stage and solved for again on the second."""
    found = find_events(trace_charts(stages[0].charts))
    return [found, on(stages[1], found)]


def relocated(state, stages):
    """Events of a state on one stage after the other."""
    states = []
    for stage in stages:
        states.append(on(stage, states[-1] if states else state))
    return states


def on(stage, state):
    return {name: moved(event, stage(event).problem) for name, event in state.items()}


def under_sphere(tabor, radius_ratio, counter_radius=np.inf):
    """The half-space under a sphere or two."""
    gap = between_spheres(float(np.sqrt(radius_ratio / tabor)), counter_radius)
    outer = np.array([gap.end])
    return [
        Standing(SizedBody(tabor, gap, partial(_panels, nodes), *how, outer, FlatCoordinate(), last * gap.end))
        for nodes, *how, last in ((14, 0.45, 2.5, 1e-7), (16, 0.35, 2.2, 1e-8))
    ]


def _panels(nodes, lines):
    return compliance.panels(lines, nodes), nodes * (lines.size - 1)


def elements(scene):
    """The body of a scene by finite elements of high degree."""
    return [Standing(sized.sized_body(scene, sized.Discretisation(*how))) for how in ((8, 0.55, 2.0), (9, 0.5, 2.2))]


def finite_strain(scene):
    """A sphere at finite strain by elements of higher degree than its events are given, on cells of its own."""
    finest = 1 - softening(scene)
    hows = ((7, 0.55 * finest, 2.2), (8, 0.45 * finest, 2.0))
    found = [finite_strain_meshes.ScenesBody(scene, sized.Discretisation(*how)) for how in hows]
    return [finite_strain_meshes.AroundEvents(body, finite_strain_meshes.Windows(body)) for body in found]


def along_at_finite_strain(scene):
    """The same on meshes that each serve a stretch of the curve."""
    return [stage.everywhere for stage in finite_strain(scene)]


def harmonics(scene):
    """The whole sphere by spherical harmonics, whose upper half is the hemisphere in the sliding grip."""
    R = scene.sphere_radius
    most = np.clip(60 * np.ceil(R * max(1.0, scene.tabor) ** 2), 240, 600)
    return [
        Charted((Chart(ContactProblem(sphere_operator(R, scene.poisson, n), scene.tabor, profile=Sphere(R)), n),))
        for n in (int(0.75 * most), int(most))
    ]
