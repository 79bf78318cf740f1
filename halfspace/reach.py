"""Extension of a curve to far separation: a soft apparatus jumps on from beyond the curve's first point."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from halfspace import newton
from halfspace.contact import APPROACH
from halfspace.curve import EquilibriumPath, Segment, metric_for
from halfspace.newton import Traceable
from halfspace.path import Metric, Point, make_point

FARTHER, NEARER = 1.5, 1.1  # margins by which the points added to a curve reach past the jump and past its beginning
POINTS = 12  # so added


def reaching(path: EquilibriumPath, stiffness: float) -> EquilibriumPath:
    """Extend a curve to the separation from which an apparatus of the given stiffness jumps on, if it has to be."""
    jump = rigid_jump_on(stiffness)
    first = path.segments[0]
    if jump > float(first.points[0].observables[APPROACH]) / NEARER:
        return path
    return replace(path, segments=(_far_segment(first, jump), *path.segments))


def rigid_jump_on(stiffness: float) -> float:
    """Approach in eps at which a rigid sphere jumps on from afar, where the attraction is (8 pi/3) h^-2."""
    return 1 - float(np.cbrt(16 * math.pi / 3 / stiffness))


def _far_segment(first: Segment, jump: float) -> Segment:
    """Points of the separated branch from beyond a jump to past the first point of a curve."""
    problem, near = first.problem, float(first.points[0].observables[APPROACH])
    metric = metric_for(problem.tabor)
    points: list[Point] = []
    for approach in 1 - np.geomspace(1 - FARTHER * jump, 1 - near / NEARER, POINTS):
        points.append(_separated(problem, float(approach), metric, points[-1] if points else None))
    return Segment(problem, tuple(points))


def _separated(problem: Traceable, approach: float, metric: Metric, before: Point | None) -> Point:
    """State on the separated branch; its arclength goes along the tangent of the point before, as a step's does."""
    control = newton.approach(approach)
    solution = newton.solve(problem, problem.undeformed(approach), control)
    point = make_point(problem, solution, metric, control.weights, 0.0)
    if before is None:
        return point
    used = metric.weights != 0
    change = (point.observables - before.observables)[used]
    return replace(point, arclength=before.arclength + float((metric.weights * before.rates)[used] @ change))
