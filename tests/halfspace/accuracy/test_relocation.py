"""Events found on one discretisation and solved for again on another, far from the first."""

from types import SimpleNamespace

import numpy as np
import pytest
from agreement import differing

import fem_adhesion
import halfspace
from fem_adhesion import Block, Layers, LinearElastic, Scene
from halfspace import Stratum
from halfspace.accuracy.grids import Resolution, half_space_charts
from halfspace.accuracy.stages import Rung
from halfspace.equilibrium import conditions, events
from halfspace.equilibrium.charts import moved, trace_charts
from halfspace.equilibrium.conditions import Condition
from halfspace.equilibrium.contact import APPROACH
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.search import find_events
from halfspace.errors import NotConverged, Unsolved
from halfspace.laws import LENNARD_JONES, Dlvo
from halfspace.profiles import Hyperboloid, Paraboloid, RoundedPunch
from halfspace.scales import Scales


def test_events_are_found_on_a_block_three_times_as_large():
    """The smaller one is only two attractions wide: its pull-off load is a sixth less, all events lie elsewhere."""
    path = fem_adhesion.trace(Scene(0.1, Block(radius=20.0, far_field="clamped")), rtol=1e-1)
    for stage in path.stages:
        for name, event in stage.items():
            assert abs(event.condition.of(event.point)) < 1e-9, name
    small, large = (path.stages[k]["pull_off"].point.observables[1] for k in (0, -1))
    assert small / large < 0.9


@pytest.mark.parametrize(
    ("tabor", "radius", "far_field", "law", "rtol"),
    [
        (0.148, 40.2, "free", LENNARD_JONES, 5e-3),
        (0.0741, 21.3, "clamped", LENNARD_JONES, 5e-3),
        (2.84, 21.2, "free", Dlvo(-0.38, 0.591), 9e-2),
    ],
)
def test_a_number_that_two_blocks_share_by_accident_is_not_taken_for_exact(tabor, radius, far_field, law, rtol):
    """While an event moved along the path its approach or radius stood still, and was up to 4 times outside."""
    block = Block(radius=radius, far_field=far_field, poisson=0.0)
    found = fem_adhesion.trace(Scene(tabor, block, law=law), rtol=rtol)
    assert differing(found, halfspace.trace(tabor, law=law, rtol=1e-6)) == []


@pytest.mark.parametrize(
    ("tabor", "radius", "far_field", "profile"),
    [
        (15.0, 30.0, "free", Paraboloid()),  # a landing far off on the other sizes
        (15.0, 50.0, "clamped", Paraboloid()),  # and beyond the fine cells of its grid
        (1.0, 10.0, "free", Paraboloid()),  # a contact that in the end the smallest does not carry
        (1.0, 50.0, "clamped", RoundedPunch(0.5)),  # whose height far away is no number
    ],
)
def test_a_held_block_has_the_jumps_of_a_half_space_within_its_errors(tabor, radius, far_field, profile):
    found = fem_adhesion.trace(Scene(tabor, Block(radius=radius, far_field=far_field), profile), rtol=1e-2)
    true = halfspace.trace(tabor, profile=profile, rtol=1e-6)
    assert differing(found, true) == []
    assert cycle(found).energy_lost.agrees(cycle(true).energy_lost)


def test_whether_there_is_a_contact_may_be_left_open():
    """The contact radius was told to be none without an error; it is 0.0026 beta on a larger block's finer cells."""
    block = Block(radius=82.6, far_field="clamped", material=LinearElastic(0.23))
    path = fem_adhesion.trace(Scene(11.3, block), rtol=0.00547)
    open_still, known = (
        path.at(approach=at, branch=name) for at, name in ((-6.75183, "unstable 2"), (-20, "separated"))
    )
    assert open_still.central_gap > LENNARD_JONES.edge_gap > open_still.central_gap - open_still.central_gap_error
    assert np.isnan([open_still.contact_radius, known.contact_radius, known.contact_radius_error]).all()
    assert open_still.contact_radius_error == np.inf
    assert np.isnan(path.at(central_gap=1.0).contact_radius_error)
    apart = np.isnan(path.contact_radius)
    doubtful = apart & (path.central_gap - path.central_gap_error < LENNARD_JONES.edge_gap)
    np.testing.assert_array_equal(path.contact_radius_error[apart], np.where(doubtful, np.inf, np.nan)[apart])


@pytest.mark.parametrize(("before", "error"), [(0.9, np.nan), (0.0, np.inf)], ids=["known", "open"])
def test_an_event_tells_whether_its_contact_is_open(before, error):
    values = [np.array([0.0, -1.0, gap, np.nan]) for gap in (before, 1.0)]
    event = events.estimate_event("jump_on", [_chain(Condition(APPROACH), np.ones(4), values)], events.ErrorRule(1.0))
    np.testing.assert_equal(event.contact_radius_error, error)


def test_the_pull_off_of_a_wide_contact_does_not_stay_where_its_grid_was_made():
    """A grid that stands still turned the path wherever it was made, on every rung: 4.3 times outside the estimate."""
    layer, cone = Layers((Stratum(1.0),)), Hyperboloid(1.0)
    found = fem_adhesion.trace(Scene(12.0, layer, cone), rtol=1e-2)
    true = halfspace.trace(12.0, body=halfspace.Layers((Stratum(1.0),)), profile=cone, rtol=1e-4)
    assert differing(found, true) == []


@pytest.mark.parametrize(
    ("name", "first", "second"), [("jump_off", 1.2, 1.5), ("pull_off", 1.2, 2.0), ("zero_load", 2.0, 1.2)]
)
def test_an_event_far_off_is_found_back_along_the_path(name, first, second):
    """Steps of a secant lost such a fold; on clamped blocks under a steep law so a curve was told not to jump."""
    before, after = (half_space_charts(Scales(tabor), Resolution(7, 0.6, 3.0, 8.0)) for tabor in (first, second))
    event, expected = (find_events(trace_charts(charts))[name] for charts in (before, after))
    found = moved(event, after[-1].problem)
    assert found.point.observables == pytest.approx(expected.point.observables, rel=1e-9, abs=1e-9)
    assert found.slope * expected.slope > 0
    assert found.point.rates == pytest.approx(expected.point.rates, abs=1e-9)
    assert found.point.arclength < event.point.arclength


def test_a_curve_whose_folds_no_finer_grid_has_is_not_told_to_slide(monkeypatch):
    chains_of = Rung.chains_of
    lost = Unsolved("lost", NotConverged)
    monkeypatch.setattr(Rung, "chains_of", lambda r, e: lost if e.condition == conditions.FOLD else chains_of(r, e))
    path = fem_adhesion.trace(Scene(2.0, Block(radius=30.0, far_field="clamped")), rtol=0.1)
    assert set(path.events) == {"pull_off", "zero_load"}
    assert path.jumps is None
    assert len(path.unconfirmed) == 2


def point(arclength, approach):
    return SimpleNamespace(arclength=arclength, observables=np.array([approach, 0.0, 0.0, np.nan]), rates=np.zeros(4))


@pytest.mark.parametrize(("leap", "found"), [(0.0, True), (0.2, False)])
def test_a_sign_that_changes_where_states_leap_is_no_event(monkeypatch, leap, found):
    def state(arclength):
        at = arclength - 0.3
        return point(arclength, at + leap * (1 if at > 0 else -1))

    def part_way(_problem, a, b, part, _metric):
        return state(a.arclength + part * (b.arclength - a.arclength))

    monkeypatch.setattr(conditions, "part_way", part_way)
    monkeypatch.setattr(conditions, "_by_cubic", lambda *_: None)
    root = conditions.between(None, state(0.0), state(1.0), Condition(0), None)
    if found:
        assert root.point.observables[0] == pytest.approx(0.0, abs=1e-9)
    else:
        assert "different branches; take a smaller rtol" in root.reason


def test_a_fold_under_a_step_is_known_as_its_place_is():
    """By the radius' shift: a load that three grids had alike by accident was 3.4 times outside at jump_off."""
    values = np.array([[0.0, 5.0, 0.0, 1.0], [0.0, 5.0, 0.0, 1.0 + 1e-5]])
    chain = _chain(conditions.FOLD, np.array([0.0, -6.0, 0.03, 1.5]), values)
    still, shifted = (
        events.estimate_event("any", [chain], events.ErrorRule(2.0, steps=steps)) for steps in (False, True)
    )
    assert still.load_error < 1e-10
    assert shifted.load_error == pytest.approx(2.0 * 2 * 1e-5 / 1.5 * 6.0, rel=1e-6)
    assert shifted.contact_radius_error == pytest.approx(still.contact_radius_error)
    assert shifted.approach_error == still.approach_error


def test_a_gap_is_known_no_better_than_those_beside_it():
    values = np.array([[0.0, 5.0, 1.0, np.nan], [0.0, 5.0, 1.0, np.nan]])
    chain = _chain(conditions.ZERO_LOAD, np.ones(4), values, near_axis=((1.0, 2.0), (1.0, 2.0 + 1e-6)))
    event = events.estimate_event("any", [chain], events.ErrorRule(2.0))
    assert event.central_gap_error == pytest.approx(2e-6, rel=1e-4)


SOFT = Condition(APPROACH, stationary=True, compliance=1e6)


@pytest.mark.parametrize(
    ("own", "still", "rate"), [(conditions.FOLD, 0, 0), (conditions.EXTREMUM, 1, 0), (SOFT, 1, 2e-6)]
)
def test_a_radius_is_known_no_better_than_the_place_on_the_path(own, still, rate):
    """A radius that stands still by accident, while the approach or the load that is not stationary says otherwise.

    With a soft apparatus, as at the load's extremum, it is the approach: by the load, a jump's radius was told to 130.
    """
    rates, other = np.array([2.0, 2.0, 1.0, 0.5]), 1 - still
    rates[still] = -rate
    values = np.array([[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]])
    values[0, other] = 4e-6
    event = events.estimate_event("any", [_chain(own, rates, values)], events.ErrorRule(along=True))
    assert event.contact_radius_error == pytest.approx(0.5 * 4e-6 / 2.0 * 0.5, rel=1e-4)
    assert event.central_gap_error == pytest.approx(0.5 * 4e-6 / 2.0 * 1.0, rel=1e-4)
    assert (event.approach_error, event.load_error)[still] < 1e-10


def test_shift_and_rest_do_not_cancel_in_an_error():
    """A load at a fold that stands still by accident, as under Dugdale's law on a coating: told to half of it."""
    rates = np.array([0.0, -5.0, -1e-3, 1.0])
    values = np.array([[2e-4, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0 - 1e-5]])
    for steps, times in ((True, 2), (False, 1)):
        rule = events.ErrorRule(along=True, steps=steps)
        event = events.estimate_event("any", [_chain(conditions.FOLD, rates, values)], rule)
        assert event.load_error == pytest.approx(0.5 * times * 5.0 * 1e-5, rel=1e-4)
        assert event.approach_error == pytest.approx(0.5 * 2e-4, rel=1e-4)


@pytest.mark.parametrize(
    ("own", "errors"), [(conditions.FOLD, [0, 1e-3, 0, 0]), (conditions.ZERO_LOAD, [4e-4, 2e-3, 2e-4, 1e-4])]
)
def test_a_tension_that_no_grid_counts_shifts_loads_and_what_is_at_a_load(own, errors):
    chain = _chain(own, np.array([2.0, -5.0, 1.0, 0.5]), np.ones((2, 4)))
    event = events.estimate_event("any", [chain], events.ErrorRule(beyond=1e-3))
    found = [event.approach_error, event.load_error, event.central_gap_error, event.contact_radius_error]
    assert found == pytest.approx(errors, rel=1e-9, abs=1e-10)


def _chain(condition, rates, values, near_axis=((0.0,), (0.0,))):
    """An event on grids on which its numbers, and the gaps near the axis, are these."""
    interface = SimpleNamespace(
        ripples=lambda _: np.zeros(2),
        sizes=lambda _: np.zeros(4),
        scales=Scales(1.0),
        law=LENNARD_JONES,
        beside_axis=lambda _: np.zeros(1),
        near_axis=lambda number, _: np.array(near_axis[number]),
    )
    problem = SimpleNamespace(interface=interface, surface_state=lambda x: x)
    points = [SimpleNamespace(observables=v, rates=rates, x=number) for number, v in enumerate(values)]
    return [conditions.Located(condition, problem, point, 1.0) for point in points]
