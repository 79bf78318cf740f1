"""Attempts at contacts that are hard for the path, the events and Newton's method, on the half-space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

import halfspace
from fem_adhesion.common.fold_birth import Birth, approached, at_gap, count_folds, tabor_of
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import Rung
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import COMPRESSION, metric_for, trace_charts, transfer
from halfspace.equilibrium.conditions import ROUND_OFF, Condition, Located, locate
from halfspace.equilibrium.contact import APPROACH, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.equilibrium.path import Metric, Point, Segment, Steps
from halfspace.equilibrium.search import find_events
from halfspace.scales import Scales
from halfspace.values import Array
from hard.measured import Measured, compare_events, newton_steps, worst
from hard.references import charted_rung

TIGHTER = "half-space, two decades tighter"
GRID = 1e-6  # tolerance of the grids on which single states are solved for, and so their error


def traced(tabor: float, *, rtol: float = 1e-6, to_load: float = COMPRESSION) -> Measured:
    """Trace a curve, and again on grids for a tolerance two decades tighter, be it one that is not on offer."""
    path = halfspace.trace(tabor, rtol=rtol, to_load=to_load)

    def rung(level: int) -> Rung:
        return charted_rung(half_space_charts(Scales(tabor), resolution_for(Scales(tabor), rtol / 100, level), to_load))

    return compare_events(path, climb(rtol, rung, to_load=to_load, most_rungs=1), TIGHTER)


def compressed(tabor: float, load: float) -> Measured:
    """Solve for approach and contact radius under a compressive load, on three grids."""
    coarse, fine, truth = (_under_load(tabor, load, rtol) for rtol in (GRID * 30, GRID, GRID / 100))
    change, error = (np.abs(other.observables - fine.observables) for other in (coarse, truth))
    names = {APPROACH: "approach", CONTACT_RADIUS: "contact radius"}
    return worst(
        Measured(f"{name} under load", error[k], change[k] + ROUND_OFF, TIGHTER, newton_steps=fine.iterations)
        for k, name in names.items()
    )


def _under_load(tabor: float, load: float, rtol: float) -> Point:
    segment = trace_charts(
        half_space_charts(Scales(tabor), resolution_for(Scales(tabor), rtol), 1.1 * load), 1.1 * load
    )[-1]
    return locate(segment.problem, segment.points, metric_for(segment.problem), Condition(LOAD, value=load))[-1].point


def located_birth(birth: Birth) -> Measured:
    """Find the Tabor parameter at which a pair of folds is born, on three grids."""
    coarse, fine, truth = (tabor_of(birth, rtol=rtol) for rtol in (1e-5, 1e-7, 1e-9))
    return Measured("tabor", abs(fine - truth), abs(fine - coarse), TIGHTER)


def near_birth(birth: Birth, offset: float, folds: int) -> Measured:
    """Trace a curve whose folds are about to merge or to be born; it is wrong if their number is."""
    tabor = tabor_of(birth) + offset
    path, truth = (halfspace.trace(tabor, rtol=rtol) for rtol in (1e-4, GRID))
    if count_folds(path) != folds:
        missed = abs(count_folds(path) - folds)
        return Measured("number of folds", missed, 0.0, "theory of cusps", newton_steps=newton_steps(path))
    return compare_events(path, truth, TIGHTER)


def long_steps(tabor: float, factor: float) -> Measured:
    """Trace a curve with first and longest step `factor` times too long: it must meet the same events."""
    charts = half_space_charts(Scales(tabor), resolution_for(Scales(tabor), GRID))
    usual = Steps()
    steps = Steps(first=factor * usual.first, longest=factor * usual.longest)
    segments = trace_charts(charts, steps=steps)
    found, expected = find_events(segments), find_events(trace_charts(charts))
    taken = sum(point.iterations for segment in segments for point in segment.points)
    return worst(_same_events(found, expected, taken))


def _same_events(found: dict[str, Located], expected: dict[str, Located], taken: int) -> list[Measured]:
    if found.keys() != expected.keys():
        return [Measured("events", np.inf, 0.0, "usual steps", newton_steps=taken)]
    return [
        Measured(f"{name} load", abs(_load(found[name]) - _load(at)), 10 * ROUND_OFF, "usual steps", newton_steps=taken)
        for name, at in expected.items()
    ]


def _load(event: Located) -> float:
    return float(event.point.observables[LOAD])


def gaps_below_equilibrium(tabor: float, approach: float, gap: float) -> Measured:
    """Start Newton's method from surfaces pressed to a gap below eps everywhere, as far as they reach."""
    problem = _centred(tabor)
    start = problem.undeformed(approach)
    start[:-2] = gap
    return _judged(problem, newton.solve(problem, start, newton.approach(approach)), approach)


def from_other_branch(tabor: float, start: float, approach: float) -> Measured:
    """Start Newton's method at one approach from the state in contact, or the only one, at another."""
    problem = _centred(tabor)
    metric = metric_for(problem)
    found = _states_at(_curve(tabor, GRID), start, metric)[-1]
    x = transfer(found.problem, found.point.x, problem)
    return _judged(problem, newton.solve(problem, x, newton.approach(approach)), approach)


def _centred(tabor: float) -> ContactProblem:
    return half_space_charts(Scales(tabor), resolution_for(Scales(tabor), GRID))[0].problem.interface


def _curve(tabor: float, rtol: float) -> Sequence[Segment]:
    return trace_charts(half_space_charts(Scales(tabor), resolution_for(Scales(tabor), rtol)))


def _states_at(curve: Sequence[Segment], approach: float, metric: Metric) -> list[Located]:
    condition = Condition(APPROACH, value=approach)
    return [state for s in curve for state in locate(s.problem, s.points, metric, condition)]


def _judged(problem: ContactProblem, solution: newton.Solution, approach: float) -> Measured:
    """Hold a state against the nearest of all branches at its approach, if its grid can carry it at all."""
    problem.require_resolution(solution.x)
    branches = _states_at(_curve(problem.tabor, GRID / 100), approach, metric_for(problem))
    load = solution.observables[LOAD]
    error = min(abs(_load(state) - load) for state in branches)
    return Measured("load", error, GRID * (1 + abs(load)), "nearest branch", newton_steps=solution.iterations)


def tangent_spring(tabor: float, gaps: tuple[float, float], *, stiffer: float, start: float) -> Measured:
    """Solve under a spring whose load line hugs the curve where that is straightest, from a central gap nearby.

    Parameters
    ----------
    gaps : (2,) tuple
        Central gaps in eps between which dW/d(alpha*) has a minimum, and a negative one.
    stiffer : float
        Stiffness in that of the tangent; at 1 three solutions are one, which Newton's method meets at a crawl.
    start : float
        Central gap of the first state.
    """
    problem = _centred(tabor)
    x = approached(problem, gaps[1])
    touch = minimize_scalar(lambda gap: _slope(problem, x, gap), bounds=gaps, method="bounded", options={"xatol": 1e-6})
    at = at_gap(problem, x, touch.x).observables
    stiffness = -stiffer * touch.fun
    control = newton.spring(stiffness, at[APPROACH] + at[LOAD] / stiffness)
    solution = newton.solve(problem, at_gap(problem, x, start).x, control)
    problem.require_resolution(solution.x)
    return _off_the_curve(tabor, solution)


def _slope(problem: ContactProblem, x: Array, gap: float) -> float:
    rates = at_gap(problem, x, gap).rates
    return float(rates[LOAD] / rates[APPROACH])


def _off_the_curve(tabor: float, solution: newton.Solution) -> Measured:
    """Distance in load from the curve on a finer grid, at the same central gap."""
    finer = half_space_charts(Scales(tabor), resolution_for(Scales(tabor), GRID / 100))[0].problem
    gap = float(solution.observables[2])
    truth = at_gap(finer, approached(finer, gap), gap).observables
    error, load = abs(truth[LOAD] - solution.observables[LOAD]), solution.observables[LOAD]
    return Measured("load", error, GRID * (1 + abs(load)), TIGHTER, newton_steps=solution.iterations)
