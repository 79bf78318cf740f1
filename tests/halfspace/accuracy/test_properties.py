"""Over the whole space of inputs: finite results, balance, energy, bounds and monotony."""

import math

import numpy as np
from hypothesis import Phase, assume, example, given, settings
from hypothesis import strategies as st

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, Scene
from halfspace.equilibrium.contact import APPROACH, LOAD, ContactProblem
from halfspace.equilibrium.path import correct
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF

tabors = st.floats(-12, math.log10(200)).map(lambda x: 10.0**x) | st.floats(0.05, 10)
poissons = st.floats(0, 0.499999)
rtols = st.floats(-3, -1).map(lambda x: 10.0**x)
loads = st.floats(-2, 2).map(lambda x: 10.0**x)


def over_inputs(examples):
    """The same examples at every run, as many as are worth their time; none is shrunk, which takes minutes."""
    phases = (Phase.explicit, Phase.generate)
    return settings(max_examples=examples, derandomize=True, deadline=None, database=None, phases=phases)


def require_finite(path):
    assert np.all(np.isfinite([path.approach, path.load, path.central_gap]))
    assert np.isfinite([path.energy.value, path.energy.error]).all()
    for event in path.events.values():
        numbers = (event.approach, event.load, event.central_gap)
        errors = (event.approach_error, event.load_error, event.central_gap_error)
        assert np.all(np.isfinite(numbers))
        assert np.all(np.isfinite(errors))
        assert min(errors) >= 0


def require_bounds(path):
    """The pull-off load lies between those of the rigid and of the soft limit."""
    pull_off = path.event("pull_off")
    assert BRADLEY_PULL_OFF - pull_off.load_error <= pull_off.load <= JKR_PULL_OFF + pull_off.load_error
    assert path.event("zero_load").approach > pull_off.approach
    if path.event("jump_on"):
        assert path.event("jump_on").approach >= path.event("jump_off").approach


def require_balance_and_energy(path):
    """At the finest states the equations hold, and the energy changes by the load's work, roughly on coarse grids."""
    metric = path.metric
    for located in path.stages[-1].values():
        problem, point = located.problem, located.point
        assert isinstance(problem, ContactProblem)
        assert problem.misfit(point.x, problem.residual(point.x)) < 1e-7
        assert problem.operator_at(point.x).weights @ problem.pressure(point.x) == point.observables[LOAD]
        h = 1e-3
        before, after = (correct(problem, point, s, metric) for s in (-h, h))
        mean_load = (before.observables[LOAD] + after.observables[LOAD]) / 2
        work = mean_load * (after.observables[APPROACH] - before.observables[APPROACH])
        change = problem.energy(after.x) - problem.energy(before.x)
        assert abs(change - work) <= 0.05 * h * (1 + path.tabor)


# --- the half-space ---


@over_inputs(6)
@given(tabor=tabors, factor=st.floats(1.001, 3), rtol=rtols, to_load=loads)
@example(tabor=0.6972, factor=0.6973 / 0.6972, rtol=1e-2, to_load=5.0)  # about the critical value
@example(tabor=3.9743, factor=1.001, rtol=1e-2, to_load=5.0)  # where a second pair of folds is born
@example(tabor=200.0, factor=1.5, rtol=1e-1, to_load=5.0)
def test_every_half_space_is_solved_softer_ones_pull_less(tabor, factor, rtol, to_load):
    assume(tabor * factor <= 300)
    paths = [halfspace.trace(value, rtol=rtol, to_load=to_load) for value in (tabor, tabor * factor)]
    for path in paths:
        require_finite(path)
        require_bounds(path)
        require_balance_and_energy(path)
        assert path.load[-1] >= to_load
    hard, soft = (path.event("pull_off") for path in paths)
    assert soft.load >= hard.load - hard.load_error - soft.load_error


# --- finite elements ---


@over_inputs(6)
@given(tabor=tabors, poisson=poissons, rtol=st.floats(-2, -1).map(lambda x: 10.0**x), to_load=st.floats(0.1, 20))
@example(tabor=1.0, poisson=0.499999, rtol=1e-2, to_load=5.0)
@example(tabor=1e-12, poisson=0.0, rtol=1e-2, to_load=5.0)
def test_every_contact_with_a_body_is_solved(tabor, poisson, rtol, to_load):
    assume(tabor <= 50)
    path = fem_adhesion.trace(Scene(tabor, HalfSpace(poisson=poisson)), rtol=rtol, to_load=to_load)
    require_finite(path)
    require_bounds(path)
    require_balance_and_energy(path)
