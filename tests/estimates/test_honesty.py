"""Error estimates hold the truth, and are not much larger than it: how `make honesty` judges, and what it judges.

The run itself, over a coarse net, is a test of the Makefile's targets.
"""

import math
from dataclasses import replace
from functools import cache, partial
from itertools import pairwise

import drawn_layers
import honesty
import numpy as np
import pytest
import side_by_side
import truths
from honesty import FAMILIES, Judged, Net, Row

import fem_adhesion
import halfspace
from fem_adhesion import Hemisphere, Scene
from halfspace.accuracy.grids import Resolution, half_space_charts
from halfspace.equilibrium.charts import trace_charts
from halfspace.equilibrium.search import energy_released, find_events
from halfspace.errors import NotConverged
from halfspace.laws import Dugdale
from halfspace.scales import Scales
from halfspace.values import Estimate


def _number(estimate, error, known=0.0, what="a number"):
    return Judged(what, estimate, error, known, 1.0)


def _numbers(count, error):
    return [_number(1.0, error, what=f"number {k} at rtol 0.1") for k in range(count)]


@pytest.mark.parametrize(
    ("number", "held", "close"),
    [
        (_number(1e-3, 0.9e-3), True, True),
        (_number(1e-3, 1.1e-3), False, True),
        (_number(1e-3, 1.1e-3, 2e-4), True, True),
        (_number(1e-3, 0.9e-5), True, False),
        (_number(1e-3, 0.0, 1.1e-5), True, True),
        (_number(1e-9, 0.0), True, True),
    ],
)
def test_a_number_is_held_and_close_up_to_what_its_truth_is_known_to(number, held, close):
    assert (number.held, number.close) == (held, close)


@pytest.mark.parametrize(
    ("outside", "wide", "honest"), [(0, 0, True), (2, 20, True), (3, 0, False), (0, 21, False), (1, 20, True)]
)
def test_a_family_is_honest_up_to_a_hundredth_outside_and_a_tenth_that_are_wide(outside, wide, honest):
    numbers = _numbers(outside, 2.0) + _numbers(wide, 1e-3)
    row = Row("a family", numbers + _numbers(200 - len(numbers), 0.5), 0.0)
    assert row.honest("full") == honest


def test_what_two_tolerances_give_alike_is_one_number():
    """Of a hundred and fifty one may lie outside, at two tolerances alike, but not two that differ."""
    inside, one = _numbers(148, 0.5), _number(1.0, 2.0, what="x at rtol 0.1")
    double, other = replace(one, what="x at rtol 0.01"), replace(one, what="y at rtol 0.01")
    assert Row("a family", [*inside, one, double], 0.0).honest("quick")
    assert not Row("a family", [*inside, one, other], 0.0).honest("quick")


def test_a_number_that_is_not_told_or_has_no_truth_lies_outside():
    told = {"a": Estimate(1.0, 0.1), "b": Estimate(2.0, 0.1)}
    found = {
        n.what.split()[0]: n.held for n in honesty._judged(told, {"a": 1.05, "c": 3.0}, {"a": 1.05, "c": 3.0}, "x", 0.1)
    }
    assert found == {"a": True, "b": False, "c": False}


def _smaller(path, part):
    return {what: Estimate(n.value, part * n.error) for what, n in honesty.of_path(path).items()}


@pytest.mark.parametrize(("part", "honest"), [(1.0, True), (0.03, False), (1e3, False)])
def test_a_family_whose_estimates_are_too_small_or_too_large_is_not_honest(part, honest, monkeypatch):
    few = Net((0.5, 2.0), (1e-3, 1e-5))
    changed = replace(FAMILIES["half-space"], quick=few, numbers=partial(_smaller, part=part))
    monkeypatch.setitem(FAMILIES, "half-space", changed)
    (row,) = honesty.rows_of("quick", ["half-space"], jobs=1)
    assert row.honest("quick") == honest


def test_scenes_side_by_side_are_those_of_the_seed():
    assert side_by_side.drawn(7, 3) == side_by_side.drawn(7, 3)
    assert side_by_side.drawn(7, 3) != side_by_side.drawn(8, 3)


def test_what_is_refused_of_drawn_scenes_is_told_and_of_others_ends_the_run(monkeypatch):
    def refuse(_scene, rtol):
        raise NotConverged(f"no grid at {rtol}")

    drawn = replace(FAMILIES["layers, drawn"], solve=refuse)
    monkeypatch.setitem(FAMILIES, "layers, drawn", drawn)
    (row,) = honesty.rows_of("quick", ["layers, drawn"], jobs=1)
    assert [why.endswith("at rtol 0.0001: no grid at 0.0001") for why in row.refused] == [True]
    assert not row.honest("quick")
    monkeypatch.setitem(FAMILIES, "layers", replace(FAMILIES["layers"], solve=refuse))
    with pytest.raises(NotConverged, match="no grid"):
        list(honesty.rows_of("quick", ["layers"], jobs=1))


@pytest.mark.parametrize("seed", range(30))
def test_contacts_on_layers_are_drawn_for_any_seed(seed):
    """What is refused when it is made, law or body, is drawn again."""
    scenes = _drawn(seed)
    assert len(scenes) == 12
    assert drawn_layers.drawn(seed, 12) == scenes != _drawn(seed + 1)


@cache
def _drawn(seed):
    return drawn_layers.drawn(seed, 12)


@pytest.mark.parametrize(
    ("solve", "part"), [(halfspace.trace, 2.0), (lambda tabor, rtol: fem_adhesion.trace(Scene(tabor), rtol=rtol), 1.0)]
)
@pytest.mark.parametrize("tabor", [0.5, 2.0])
def test_the_error_of_the_energy_is_that_part_of_its_changes_which_may_be_left(solve, part, tabor):
    """On the half-space the changes from the twin, which has other cells, may be larger."""
    path = solve(tabor, rtol=1e-3)
    energies = [energy_released(stage) for stage in path.stages]
    assert energies[-1] == path.energy.value
    left = part * np.sum(np.abs(np.diff(energies)))
    assert left <= path.energy.error <= 3 * left + 1e-11 * (1 + path.energy.value)


def test_an_estimate_is_no_less_than_twice_the_change_from_a_grid_as_coarse_as_the_one_below_with_other_cells():
    """A number that two grids of one family share by accident is not taken for exact."""
    path = halfspace.trace(0.8, rtol=1e-4)
    last = path.settings["events"]
    twin = Resolution(last["nodes"] - 1, 0.75 * last["finest"], 0.87 * last["growth"], 0.8 * last["extent"])
    others = find_events(trace_charts(half_space_charts(Scales(0.8), twin)))
    counted = 0
    for name, event in path.events.items():
        best, other = (state[name].point.observables for state in (path.stages[-1], others))
        chain = [state[name].point.observables for state in path.stages]
        along = sum(np.abs(b - a) for a, b in pairwise(chain))
        for k, quantity in enumerate(("approach", "load", "central_gap")):
            change = abs(other[k] - best[k])
            assert getattr(event, f"{quantity}_error") >= 2.0 * change * (1 - 1e-6)
            counted += change > 1.5 * along[k]
    assert counted > 0


def test_a_tolerance_is_met_in_loads_relative_and_in_approaches_to_their_range():
    path = halfspace.trace(1.0, rtol=1e-1)

    def missed(load, approach, name="jump_on"):
        event = path.event(name)
        errors = {"load_error": load * abs(event.load), "approach_error": approach * path.approach_scale}
        exact = {n: replace(e, load_error=0.0, approach_error=0.0) for n, e in path.events.items()}
        asked = replace(path, events=exact | {name: replace(event, **errors)}, settings={"rtol": 1e-4})
        assert asked.met is not bool(asked.missed)
        return asked.missed

    assert missed(0.99e-4, 0.99e-4) == {}
    assert missed(1.01e-4, 0.99e-4) == {"jump_on": ("load",)}
    assert missed(0.99e-4, 1.01e-4) == {"jump_on": ("approach",)}
    assert missed(math.nan, 1.01e-4) == {"jump_on": ("approach", "load")}
    assert missed(math.inf, 0.99e-4, "zero_load") == {}
    assert missed(1.0, 1.01e-4, "zero_load") == {"zero_load": ("approach",)}


@pytest.mark.parametrize(
    ("tabor", "rtol", "limit"), [(0.5, 1e-8, 1e-8), (1, 1e-8, 1e-8), (2, 1e-8, 1e-8), (5, 1e-7, 1e-7), (20, 1e-6, 1e-6)]
)
def test_finite_elements_reach_far(tabor, rtol, limit):
    path = fem_adhesion.trace(Scene(tabor=tabor), rtol=rtol)
    truth = truths.relocated(path.stages[-1], truths.half_space(tabor)[1:])[-1]
    load = truth["pull_off"].point.observables[1]
    assert abs(path.event("pull_off").load / load - 1) <= limit
    for name in {"jump_on", "jump_off"} & set(truth):
        assert abs(path.event(name).approach / truth[name].point.observables[0] - 1) <= limit


def test_estimates_hold_where_the_tension_ends_by_a_step_within_a_cell_of_a_sphere():
    """Both degrees have the step at one place of a cell: they agreed to a seventh of what the numbers erred."""
    scene = Scene(3.2, Hemisphere(radius_ratio=1290.0, poisson=0.45), law=Dugdale(0.232))
    path = fem_adhesion.trace(scene, rtol=1e-5)
    rough, best = honesty.relocated(truths.elements, scene, path)
    assert all(number.held for number in honesty._judged(honesty.of_path(path), rough, best, scene, 1e-5))


def test_the_jumps_of_a_block_have_errors_in_which_its_size_and_degree_do_not_cancel():
    path = fem_adhesion.trace(Scene(1.0), rtol=1e-3)
    assert path.twin is not None
    rough, best = honesty.sprung(truths.half_space, 1.0, path)
    told = honesty.of_springs(path)
    assert set(told) <= set(best)
    for what, number in told.items():
        assert abs(number.value - best[what]) <= number.error + abs(rough[what] - best[what]), what


def test_an_event_that_lies_no_further_off_than_the_root_finder_resolves_is_not_lost():
    """On grids that both know it to 1e-11 the interval around it is as short as the tolerance of arclength."""
    path = halfspace.trace(0.3, profile=halfspace.profiles.Sphere(30.0), rtol=1e-6)
    first, second = truths.relocated(path.stages[-1], truths.under_sphere(0.3, 30.0))
    change = first["pull_off"].point.observables - second["pull_off"].point.observables
    assert np.max(np.abs(change)) < 1e-9
