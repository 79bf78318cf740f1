"""Extension of a curve to far separation: a soft apparatus jumps on from beyond the curve's first point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.charts import metric_for, separated
from halfspace.equilibrium.contact import APPROACH, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Segment
from halfspace.equilibrium.states import measured

FARTHER, NEARER = 1.5, 1.1  # margins by which the points added to a curve reach past the jump and past its beginning
POINTS = 12  # so added
WIDTHS = 1.7  # of the attraction, where the undeformed gap has doubled: what cells should cover but the infinite one


def reaching(path: EquilibriumPath, stiffness: float) -> EquilibriumPath:
    """Extend a curve to the separation from which an apparatus of the given stiffness jumps on, if it has to be."""
    first = path.segments[0]
    jump = first.problem.interface.scales.rigid_jump_on(stiffness)
    if jump > float(first.points[0].observables[APPROACH]) / NEARER:
        return path
    return replace(path, segments=(_far_segment(first, jump), *path.segments))


def widened(problem: Traceable, approach: float) -> Traceable:
    """Problem whose cells cover the attraction at a separation, which widens as its root: the same if they do already.

    So are those whose grid follows the contact, or whose surface law does not act to infinity.
    """
    if not isinstance(problem, ContactProblem) or not isinstance(problem.operator, ElasticOperator):
        return problem
    body, h, scales = problem.operator, 1 - approach, problem.scales
    reach = max(scales.radius_at(WIDTHS**2 * max(h, 0.0)) / body.extent, scales.tail_reach)
    if not body.beyond.size or reach <= scales.tail_reach:
        return problem
    nodes = min(body.beyond.size, body.cell_nodes.shape[1])
    return replace(problem, operator=body.widened(nodes, reach))


def _far_segment(first: Segment, jump: float) -> Segment:
    """Points of the separated branch from beyond a jump to past the first point of a curve."""
    far, near = 1 - FARTHER * jump, 1 - float(first.points[0].observables[APPROACH]) / NEARER
    problem = widened(first.problem, 1 - far)
    metric = metric_for(problem)
    points = [separated(problem, approach, metric) for approach in (1 - np.geomspace(far, near, POINTS)).tolist()]
    return measured(problem, points, metric)
