"""The curve at finite strain over a sequence of meshes, each fine for a window of contact radii.

The unknowns of a body at finite strain are not carried from mesh to mesh. Each mesh is entered from the linear body's
state at the same contact radius, which is near, delta = beta/R being raised in as many parts as Newton's method asks
for. Within a mesh the curve is followed by its arclength.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fem_adhesion.finite_strain import FiniteStrainProblem
from fem_adhesion.finite_strain_events import raised, same_contact, undeformed_radius
from fem_adhesion.finite_strain_meshes import FARTHEST, Discretised, ScenesBody
from halfspace import newton
from halfspace.curve import metric_for, separated_approach
from halfspace.path import Metric, Point, Segment, follow, loaded_to, make_point

WINDOW = 8
"""Fine cells in a mesh: more cost more unknowns, fewer more meshes."""


def trace_windows(body: ScenesBody, linear: Sequence[Segment], to_load: float) -> tuple[Segment, ...]:
    """Trace the curve from far separation to a compressive load.

    Parameters
    ----------
    body : ScenesBody
        How its meshes are made.
    linear : sequence of Segment
        Curve of the linear body, on any discretisation, at least as far.
    to_load : float
        In R dgamma.

    Raises
    ------
    NotConverged
        If a mesh cannot be entered, or the continuation gets stuck.
    """
    metric, width = metric_for(body.scene.tabor), WINDOW * body.length
    on, segments = body.meshed(0.0, width), list[Segment]()
    point, end = _far_separation(on, metric), width
    while True:
        widest = FARTHEST * body.scene.sphere_radius
        until = _ended(on.problem, to_load, min(end, widest))
        points = follow(on.problem, point, metric, until)
        segments.append(Segment(on.chart.problem, tuple(points)))
        start = undeformed_radius(on.problem, points[-1])
        if loaded_to(to_load)(points[-1]) or start > widest:
            return tuple(segments)
        end = start + width
        on = body.meshed(start, end)
        point = _entered(on, linear, segments[-1], metric)


def _ended(problem: FiniteStrainProblem, to_load: float, radius: float) -> Callable[[Point], bool]:
    loaded = loaded_to(to_load)
    return lambda point: loaded(point) or undeformed_radius(problem, point) > radius


def _far_separation(on: Discretised, metric: Metric) -> Point:
    """First point of the curve, heading towards contact."""
    control = newton.approach(separated_approach(on.problem.tabor) - 10)
    solution = newton.solve(on.problem, on.problem.undeformed(control.target), control)
    return make_point(on.problem, solution, metric, control.weights, 0.0)


def _entered(on: Discretised, linear: Sequence[Segment], before: Segment, metric: Metric) -> Point:
    """Point of the next mesh with the contact radius of the last point of the one before."""
    last = before.points[-1]
    start = on.near(linear, before.problem, last)
    solution = raised(on.problem, start, same_contact(last.observables))
    return make_point(on.problem, solution, metric, metric.weights * last.rates, last.arclength)
