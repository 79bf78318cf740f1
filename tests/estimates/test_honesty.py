"""Error estimates hold the truth, and are not much larger: how `make honesty` judges, and what it judges.

The run itself, over a coarse net, is a test of the Makefile's targets.
"""

import math
import os
from dataclasses import dataclass, replace
from functools import partial
from types import SimpleNamespace

import constants
import families
import numpy as np
import pytest
import truths
from families import FAMILIES, of_path, relocated
from judging import Answered, Family, Judged, Net, Row, judge, rows_of

import fem_adhesion
import halfspace
from fem_adhesion import Scene
from fem_adhesion.crosscheck import comparison
from halfspace.accuracy.grids import Resolution, half_space_charts
from halfspace.equilibrium.charts import trace_charts
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import Event
from halfspace.equilibrium.search import energy_released, find_events
from halfspace.errors import InputError, NotConverged
from halfspace.laws import Morse
from halfspace.profiles import Power
from halfspace.scales import Scales
from halfspace.values import Estimate


def number(estimate, error, known=0.0, what="a number"):
    return Judged(what, "a scene", 0.1, estimate, error, known, 1.0)


@pytest.mark.parametrize(
    ("one", "ratio", "width"),
    [
        (number(1e-3, 0.5e-3), 0.5, 2),
        (number(1e-3, 2e-3), 2, 0.5),
        (number(1e-3, 2e-3, 1.5e-3), 0.5, 0.5),
        (number(1e-3, 0.0, 1e-5), 0, 100),
        (number(math.inf, 1.0), 0, math.inf),
        (number(0.0, 1e-20), math.inf, 0.0),
        (number(1e-3, math.inf), math.inf, 0.0),
    ],
)
def test_a_number_is_held_up_to_what_its_truth_is_known_to(one, ratio, width):
    assert one.ratio == pytest.approx(ratio)
    assert one.width == pytest.approx(width, abs=1e-8)


def test_a_number_that_is_not_told_or_has_no_truth_lies_outside():
    told = {"a": Estimate(1.0, 0.1), "b": Estimate(2.0, 0.1), "open": Estimate(2.0, 0.1)}
    truth = {"a": Estimate(1.05, 0.0), "c": Estimate(3.0, 0.0), "open": Estimate(2.0, math.inf)}
    assert {n.what: n.ratio for n in judge(told, truth)} == {
        "a": pytest.approx(0.5), "b": math.inf, "c": math.inf, "open": 0.0,
    }  # fmt: skip


def test_a_radius_that_one_of_two_true_grids_lacks_is_not_judged():
    """Beside a fold one grid of a block was in contact and the other was not."""
    told = {"gap": Estimate(0.15, 0.01), "contact_radius": Estimate(0.3, 0.01)}
    one, other = {"gap": 0.2, "contact_radius": math.nan}, {"gap": 0.1, "contact_radius": 0.3}
    for pair in ((one, other), (other, one)):
        judged = {n.what: n.ratio for n in judge(told, families.by_two(pair))}
        assert judged == {"gap": 0.0, "contact_radius": 0.0}
    assert judge({"gap": told["gap"]}, families.by_two(({}, {"gap": 0.15})))[0].ratio == math.inf


@pytest.mark.parametrize(("error", "ratio"), [(math.inf, 0.0), (math.nan, math.inf)])
def test_a_radius_told_to_be_open_may_be_any(error, ratio):
    """Not so one that is told not to be there."""
    numbers = {f"{q}{part}": 1.0 for q in OBSERVABLES for part in ("", "_error")}
    jump = Event("jump_on", **numbers | {"contact_radius": math.nan, "contact_radius_error": error})
    told = of_path(SimpleNamespace(events={"jump_on": jump}, energy=Estimate(1.0, 0.1)))
    judged = judge(told, {"jump_on contact_radius": Estimate(0.16, 0.0)})
    assert {n.what: n.ratio for n in judged}["jump_on contact_radius"] == ratio


def test_a_true_state_is_on_the_branch_of_the_one_asked_for():
    """By the central gap alone, which hardly differs there, it was the one before the jump off."""
    steep = Scene(18.4, profile=Power(5.83), law=Morse(2.72))
    path = fem_adhesion.trace(steep, rtol=0.034)
    state = truths.state_of(path, "approach", "contact", -3.89)
    assert state.point.observables[1] == pytest.approx(float(path.at(approach=-3.89, branch="contact").load), abs=0.1)


def test_a_comparison_is_bad_where_a_row_is_or_where_it_failed():
    """Every case counted as failed, of which no run of these families had told."""
    one = Estimate(1.0, 0.0)
    rows = [comparison.Row(what, "eps", one, one, off, 1.0) for what, off in (("load", 0.0), ("gap", 1.0))]
    told = families.of_comparison(comparison.Case(Scene(1.0), {}, tuple(rows)))
    assert {what: number.value for what, number in told.items()} == {"load, agree": 0.0, "gap, disagree": 1.0}
    assert families.of_comparison(comparison.Case(Scene(1.0), reason="lost"))["lost"].value == 1.0


def row(*numbers, drawn=False, ends=(), seconds=1.0, memory=1.0):
    one = Row("a family", drawn=drawn)
    one.add(Answered(numbers, ends, seconds, memory, 1.0))
    return one


def several(count, error):
    return [number(1.0, error, what=f"number {k}") for k in range(count)]


@pytest.mark.parametrize(("outside", "honest"), [(0, True), (2, True), (3, False)])
def test_a_family_may_have_half_a_percent_of_its_numbers_outside(outside, honest):
    assert row(*several(outside, 2.0), *several(400, 0.5)[outside:]).honest == honest


@pytest.mark.parametrize(("wide", "honest"), [(199, True), (201, False)])
def test_the_median_estimate_may_be_a_hundred_times_the_error(wide, honest):
    assert row(*several(wide, 1e-3), *several(400, 0.5)[wide:]).honest == honest


def test_what_two_tolerances_give_alike_is_one_number():
    inside, one = several(148, 0.5), number(1.0, 2.0, what="x")
    assert row(*inside, one, one._replace(rtol=0.01)).honest
    assert not row(*inside, one, one._replace(what="y")).honest


@pytest.mark.parametrize(
    ("told", "fixed", "drawn"),
    [
        ({"ends": ["NotConverged: x"]}, False, True),
        ({"ends": ["DEFECT: x"]}, False, False),
        ({"ends": ["WARNED: x"]}, False, False),
        ({"seconds": 61.0}, False, False),
        ({"memory": 1025.0}, False, False),
    ],
)
def test_a_scene_that_ends_otherwise_or_takes_too_much_is_a_fault(told, fixed, drawn):
    assert row(*several(10, 0.5), **told).honest == fixed
    assert row(*several(10, 0.5), **told, drawn=True).honest == drawn


def family(solve, scenes=("one", "two"), **more):
    def truth(*_):
        return {"x": Estimate(1.0, 0.0)}

    return Family(Net(scenes, [0.1]), Net(scenes, [0.1]), solve, lambda found: {"x": found}, truth, **more)


def raising(error):
    def solve(*_):
        raise error

    return solve


@pytest.mark.parametrize(
    ("error", "end"),
    [(InputError("no"), "InputError: no"), (NotConverged("no"), "NotConverged: no"), (KeyError("no"), "DEFECT: ")],
)
def test_how_a_scene_ended_is_told(error, end):
    (found,) = rows_of({"f": family(raising(error), ["one"])}, jobs=1)
    assert found.ends[0].startswith(end)
    assert found.ends[0].endswith("one at rtol 0.1")


def test_a_scene_whose_process_dies_is_told():
    (found,) = rows_of({"f": family(lambda *_: os._exit(1), ["one"])}, jobs=1)
    assert found.faults == ["DIED: one"]


def test_scenes_in_the_file_are_not_solved_again(tmp_path):
    file = tmp_path / "scenes.jsonl"
    (first,) = rows_of({"f": family(lambda *_: Estimate(1.5, 1.0))}, seed=3, file=file, jobs=1)
    (again,) = rows_of({"f": family(raising(KeyError("solved")))}, seed=3, file=file, jobs=1)
    (other,) = rows_of({"f": family(raising(KeyError("solved")))}, seed=4, file=file, jobs=1)
    assert again.numbers == first.numbers
    assert len(first.numbers) == 2
    assert len(other.faults) == 2


def test_scenes_are_those_of_the_seed_and_the_count():
    for net in (FAMILIES[name].full for name in FAMILIES if callable(FAMILIES[name].full.scenes)):
        three = net.of(7, "name", 3)
        assert list(map(str, net.of(7, "name", 5)[:3])) == list(map(str, three))
        assert list(map(str, three)) != list(map(str, net.of(8, "name", 3)))
        assert list(map(str, three)) != list(map(str, net.of(7, "other", 3)))


def test_a_random_scene_is_a_line_of_python_that_repeats_it():
    random = np.random.default_rng(1)
    line = next(one for one in (families.half_space_line(random) for _ in range(99)) if "body" not in one.text)
    line = line._replace(rtol=1.0)
    path = line.solved(1e-2)
    assert str(line) == line.text.format(rtol=line.rtol)
    assert (path.settings["rtol"], path.tabor) == (1e-2, float(str(line).split("(")[1].split(",")[0]))


@dataclass(frozen=True)
class OwnSettings:
    """Numbers of every kind."""

    ratio: float = 1.5
    count: int = 3
    ends: tuple[float, float] = (0.5, 4.0)


def test_a_setting_is_replaced_in_every_instance_by_its_half_or_double():
    one, other = OwnSettings(), OwnSettings(1.2)
    assert len(constants.replaced(OwnSettings, "ratio", 2.0)) >= 2
    assert [one.ratio, other.ratio] == pytest.approx([2.0, 1.4])
    assert constants.changed(3, 0.5) == 2
    assert constants.changed((0.5, 4.0), 2.0) == (1.0, 8.0)
    assert constants._numbers(OwnSettings) == ["OwnSettings.ratio", "OwnSettings.count", "OwnSettings.ends"]


def test_there_are_settings_and_each_has_families_that_are_measured():
    known = constants.settings()
    assert known
    for kind in known.values():
        assert all(FAMILIES[name].quick.scenes for name in constants.families_of(kind))


def smaller(path, part):
    return {what: Estimate(n.value, part * n.error) for what, n in of_path(path).items()}


@pytest.mark.parametrize(("part", "honest"), [(1.0, True), (0.02, False), (1e3, False)])
def test_a_family_whose_estimates_are_too_small_or_too_large_is_not_honest(part, honest):
    few = Net((Scene(0.5), Scene(2.0)), (1e-3, 1e-5))
    changed = replace(FAMILIES["half-space"], quick=few, numbers=partial(smaller, part=part))
    (found,) = rows_of({"half-space": changed}, jobs=1)
    assert found.honest == honest


@pytest.mark.parametrize("solve", [halfspace.trace, lambda tabor, rtol: fem_adhesion.trace(Scene(tabor), rtol=rtol)])
def test_the_error_of_the_energy_is_no_less_than_its_last_change(solve):
    """On the half-space the changes from the twin, which has other cells, may be larger."""
    path = solve(2.0, rtol=1e-3)
    energies = [energy_released(stage["separated"], stage["zero_approach"]) for stage in path.stages]
    assert energies[-1] == path.energy.value
    changes = np.abs(np.diff(energies))
    assert changes[-1] <= path.energy.error <= 10 * np.sum(changes) + 1e-11 * (1 + path.energy.value)


def test_an_estimate_is_no_less_than_the_change_from_other_cells_as_coarse_as_those_below():
    """A number that two grids of one family share by accident is not taken for exact."""
    path = halfspace.trace(0.8, rtol=1e-4)
    last = path.settings["events"]
    twin = Resolution(last["nodes"] - 1, 0.75 * last["finest"], 0.87 * last["growth"], 0.8 * last["extent"])
    others = find_events(trace_charts(half_space_charts(Scales(0.8), twin)))
    counted = 0
    for name, event in path.events.items():
        best, other = (state[name].point.observables for state in (path.stages[-1], others))
        below, fine = (state[name].point.observables for state in path.stages[-2:])
        along = np.abs(fine - below)
        for k, quantity in enumerate(("approach", "load", "central_gap")):
            change = abs(other[k] - best[k])
            assert getattr(event, f"{quantity}_error") >= change * (1 - 1e-6)
            counted += change > 1.5 * along[k]
    assert counted > 0


def test_a_tolerance_is_met_in_loads_relative_and_in_approaches_to_their_range():
    path = halfspace.trace(1.0, rtol=1e-1)
    scale = 1 + np.ptp([event.approach for event in path.events.values()])

    def missed(load, approach, name="jump_on"):
        event = path.event(name)
        errors = {"load_error": load * abs(event.load), "approach_error": approach * scale}
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


@pytest.mark.parametrize(("tabor", "rtol"), [(1, 1e-8), (5, 1e-7)])
def test_finite_elements_reach_far(tabor, rtol):
    path = fem_adhesion.trace(Scene(tabor=tabor), rtol=rtol)
    truth = relocated(truths.half_space_of, Scene(tabor), path)
    assert abs(path.event("pull_off").load / truth["pull_off load"].value - 1) <= rtol
    for name in {"jump_on", "jump_off"} & path.events.keys():
        assert abs(path.event(name).approach / truth[f"{name} approach"].value - 1) <= rtol


def test_an_event_that_lies_no_further_off_than_the_root_finder_resolves_is_not_lost():
    """On grids that both know it to 1e-11 the interval around it is as short as the tolerance of arclength."""
    path = halfspace.trace(0.3, profile=halfspace.profiles.Sphere(30.0), rtol=1e-6)
    first, second = truths.relocated(path.stages[-1], truths.under_sphere(0.3, 30.0))
    change = first["pull_off"].point.observables - second["pull_off"].point.observables
    assert np.max(np.abs(change)) < 1e-9
