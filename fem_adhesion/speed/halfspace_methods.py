"""Half-space methods of the speed study: the iterations of 1997, fixed grids, and the adaptive solver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize_scalar

import halfspace
from fem_adhesion.mesh.block import graded_breaks
from fem_adhesion.speed.methods import Method, Solved, Step, from_chart, from_path, unit, widest
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium import newton, relaxation
from halfspace.equilibrium.contact import APPROACH, LOAD, ContactProblem
from halfspace.equilibrium.newton import Control
from halfspace.equilibrium.relaxation import Relaxed
from halfspace.errors import InputError
from halfspace.scales import Scales
from halfspace.values import Array

MOST_NODES = 3000  # of a dense operator: 70 MB, and as much again for each factorisation


def halfspace_methods() -> list[Method]:
    """Every half-space method."""
    return [*_relaxations(), *_fixed_grids(), Method("half-space", "adaptive", _adaptive_steps(), 5)]


def _affordable(nodes: Array) -> Array:
    """Nodes of a grid, or raise InputError if they are too many for a dense operator."""
    if nodes.size > MOST_NODES:
        raise InputError(f"{nodes.size} nodes exceed {MOST_NODES} of a dense operator; take another Tabor parameter")
    return nodes


def _uniform(tabor: float, f: float, U: float) -> Array:
    return _affordable(grid.uniform(max(U * unit(tabor), 1.5 * widest(tabor)), f * Scales(tabor).spike_width))


def _graded(tabor: float, f: float, U: float, growth: float, fine_radius: float | None = None) -> Array:
    fine = widest(tabor) if fine_radius is None else fine_radius
    return _affordable(graded_breaks(f * Scales(tabor).spike_width, fine, fine + U * unit(tabor), growth=growth))


def _fixed(operator: ElasticOperator, tabor: float) -> Solved:
    return from_chart(ContactProblem(operator, tabor), operator.radii.size)


def _fixed_grids() -> list[Method]:
    """Methods on one grid that does not follow the contact."""
    uniform = [(0.2, 6.0), (0.1, 8.0), (0.07, 9.5), (0.05, 11.0), (0.035, 13.0), (0.025, 16.0)]
    graded = [(0.2, 8.0, 1.4), (0.1, 10.0, 1.2), (0.05, 20.0, 1.1), (0.025, 40.0, 1.05), (0.0125, 80.0, 1.025)]
    panels = [(4, 8.0), (5, 12.0), (6, 20.0), (8, 50.0), (10, 120.0), (12, 300.0), (14, 800.0)]
    return [
        Method("half-space", "uniform bands", [_uniform_step(compliance.bands, *s) for s in uniform], 4),
        Method("half-space", "uniform triangles", [_uniform_step(compliance.triangles, *s) for s in uniform], 4),
        Method("half-space", "graded triangles", [_graded_step(*s) for s in graded], 4),
        Method("half-space", "panels, fixed grid", [_panel_step(*s) for s in panels], 4),
    ]


def _uniform_step(make: Callable[[Array], ElasticOperator], f: float, U: float) -> Step:
    return Step(f"f={f:g} U={U:g}", lambda tabor: _fixed(make(_uniform(tabor, f, U)), tabor))


def _graded_step(f: float, U: float, growth: float) -> Step:
    def run(tabor: float) -> Solved:
        return _fixed(compliance.triangles(_graded(tabor, f, U, growth)), tabor)

    return Step(f"f={f:g} U={U:g} growth={growth:g}", run)


def _panel_step(nodes: int, U: float) -> Step:
    def run(tabor: float) -> Solved:
        return _fixed(compliance.panels(_graded(tabor, 0.8, U, 2.0), nodes), tabor)

    return Step(f"nodes={nodes} U={U:g}", run)


def _adaptive_steps() -> list[Step]:
    """Tolerances of the adaptive half-space."""
    return [_adaptive_step(10.0**-k) for k in range(2, 10)]


def _adaptive_step(rtol: float) -> Step:
    return Step(f"rtol={rtol:.0e}", lambda tabor: from_path(halfspace.trace(tabor, rtol=rtol)))


# The iterations of 1997


def _relaxations() -> list[Method]:
    """Simple relaxation and Greenwood's on graded triangles, which need the fewest nodes; pull-off load only."""
    grids = [(0.2, 5.0, 1.4), (0.1, 7.0, 1.3), (0.07, 9.0, 1.2), (0.05, 12.0, 1.15), (0.025, 24.0, 1.08)]
    simple = [_relaxation_step(_simple, *s) for s in grids]
    local = [_relaxation_step(_greenwood, *s) for s in grids[:-1]]  # on the finest the sweeps run out
    return [
        Method("half-space", "simple relaxation", simple, 4, may_diverge=True),
        Method("half-space", "Greenwood's iteration", local, 2, may_diverge=True),
    ]


Relaxation = Callable[[ContactProblem, Array, Control], Relaxed]


def _simple(problem: ContactProblem, start: Array, control: Control) -> Relaxed:
    c = float(np.clip(0.02 / problem.tabor**2, 0.005, 0.2))
    return relaxation.simple(problem, start, control, relaxation=c, tolerance=1e-8)


def _greenwood(problem: ContactProblem, start: Array, control: Control) -> Relaxed:
    return relaxation.greenwood(problem, start, control, tolerance=1e-5)


def _relaxation_step(relax: Relaxation, f: float, U: float, growth: float) -> Step:
    def run(tabor: float) -> Solved:
        nodes = _graded(tabor, f, U, growth, fine_radius=2.2)
        problem = ContactProblem(compliance.triangles(nodes), tabor)
        return Solved(nodes.size, {"pull_off": pull_off_by_sweep(problem, relax)})

    return Step(f"f={f:g} U={U:g} growth={growth:g}", run)


def pull_off_by_sweep(problem: ContactProblem, relax: Relaxation) -> float:
    """Least load met under fixed grips, refined by parabolas, from a start with zero central gap.

    An iteration that cannot pass a fold finds the pull-off load where it is stable under fixed grips, and
    no other event.
    """
    first = relax(problem, problem.undeformed(0.0), newton.central_gap(0.0))
    states = {float(first.observables[APPROACH]): first.x}

    def load(approach: float) -> float:
        nearest = min(states, key=lambda known: abs(known - approach))
        state = relax(problem, states[nearest], newton.approach(approach))
        problem.require_resolution(state.x)
        states[approach] = state.x
        return float(state.observables[LOAD])

    step = 0.2 * (1 + problem.tabor)
    bounds = _downhill(load, next(iter(states)), step)
    return float(minimize_scalar(load, bounds=bounds, method="bounded", options={"xatol": 1e-2 * step}).fun)


def _downhill(function: Callable[[float], float], start: float, step: float) -> tuple[float, float]:
    """Bounds of a minimum, found by equal steps downhill."""
    before, here = function(start), function(start + step)
    if here > before:
        start, step, before, here = start + step, -step, here, before
    at = start + step
    while (after := function(at + step)) < here:
        at, here = at + step, after
    return min(at - step, at + step), max(at - step, at + step)
