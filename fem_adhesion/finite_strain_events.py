"""Events at finite strain, from states of the linear body or of another discretisation at the same contact radius."""

from __future__ import annotations

import numpy as np

from fem_adhesion.finite_strain import FiniteStrainProblem
from halfspace import newton
from halfspace.compliance import Array
from halfspace.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD
from halfspace.errors import NotConverged
from halfspace.events import Located
from halfspace.newton import Control, Traceable
from halfspace.path import Metric, Point, make_point

SMALLEST_PART = 1 / 32
"""Of delta, in which it is raised from zero where the linear body's events are too far away."""

STEP_TOLERANCE = 1e-8  # of arclength: the next step of the secant would be smaller by as much again
FARTHEST = 1.0  # of arclength, that an event may lie from where it is looked for
MOST_SECANTS, MOST_ITERATIONS = 20, 15
UPDATE = 1e-6  # last step of Newton's method, relative: what is left is of the order of its square


def corrected(event: Located, problem: FiniteStrainProblem, start: Array, metric: Metric) -> Located:
    """Solve for an event, from a state at its contact radius or central gap.

    Parameters
    ----------
    event : Located
        On any discretisation, of the linear body or not.
    problem : FiniteStrainProblem
        On which it is sought.
    start : array
        State vector, of the linear body or not.
    metric : Metric
        What arclength means.

    Raises
    ------
    NotConverged
        If the event is lost on the way.
    """
    try:
        solution = raised(problem, start, same_contact(event.point.observables))
        origin = make_point(problem, solution, metric, metric.weights * event.point.rates, event.point.arclength)
        return _by_secants(event, problem, origin, metric)
    except NotConverged as error:
        approach, load = event.point.observables[[APPROACH, LOAD]]
        raise NotConverged(
            f"the event at approach {approach:.6g} eps, load {load:.6g} R dgamma is lost at beta/R = "
            f"{problem.stretch:.3g} ({error}); take a larger radius_ratio"
        ) from error


def same_contact(observables: Array) -> Control:
    """Control of the contact radius of a state, or of its central gap while there is none."""
    if np.isfinite(observables[CONTACT_RADIUS]):
        return newton.contact_radius(float(observables[CONTACT_RADIUS]))
    return newton.central_gap(float(observables[CENTRAL_GAP]))


def undeformed_radius(problem: Traceable, point: Point) -> float:
    """Radius in beta that the point at the contact edge had before the body was deformed; nan without contact."""
    return problem.interface.contact_radius(problem.surface_state(point.x))


def raised(problem: FiniteStrainProblem, start: Array, control: Control) -> newton.Solution:
    """Solve under a control that the path does not turn back from, raising delta from zero if it cannot be at once.

    Raises
    ------
    NotConverged
        If a small part of delta is too much.
    """
    x, done, part = start, 0.0, 1.0
    while True:
        at = problem.stretched((done + part) * problem.stretch) if done + part < 1 else problem
        try:
            _require_volume(at, x)
            solution = newton.solve(at, x, control, tolerance=UPDATE, max_iterations=MOST_ITERATIONS)
        except NotConverged:
            part /= 2
            if part < SMALLEST_PART:
                raise
            continue
        x, done = solution.x, done + part
        if done >= 1:
            return solution


def _require_volume(problem: FiniteStrainProblem, x: Array) -> None:
    """Refuse a start at which the material is turned inside out, as a linear body's may be."""
    least = problem.body.least_volume_ratio(problem.exterior.reduction @ x[:-1])
    if least <= 0:
        raise NotConverged(f"the start is turned inside out, volume ratio {least:.2g}; start from a smaller stretch")


def _by_secants(event: Located, problem: FiniteStrainProblem, origin: Point, metric: Metric) -> Located:
    """Find the root of an event's condition by secants along the path, shortened where Newton's method fails."""
    point, slope, part = origin, event.slope, 1.0
    for _ in range(MOST_SECANTS):
        step = -part * event.condition.of(point) / slope
        place = point.arclength - origin.arclength + step
        if abs(step) < STEP_TOLERANCE * part:
            return Located(event.condition, problem, point, slope)
        if not abs(place) < FARTHEST:
            break
        try:
            last, point = point, _onwards(origin, problem, point, step, place, metric)
        except NotConverged:
            part /= 4
            continue
        slope, part = (event.condition.of(point) - event.condition.of(last)) / step, 1.0
    raise NotConverged("no root of its condition is near")


def _onwards(
    origin: Point, problem: FiniteStrainProblem, last: Point, step: float, place: float, metric: Metric
) -> Point:
    """Solve in the plane across the path at a distance `place` from the origin, a step after the last point."""
    weights = metric.weights * origin.rates
    used = weights != 0
    control = Control(weights, float(weights[used] @ origin.observables[used]) + place)
    guess = last.x + problem.longest_step(last.x, step * last.tangent) * step * last.tangent
    solution = newton.solve(problem, guess, control, tolerance=UPDATE, max_iterations=MOST_ITERATIONS)
    return make_point(problem, solution, metric, weights, origin.arclength + place)
