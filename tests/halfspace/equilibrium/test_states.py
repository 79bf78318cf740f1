"""States anywhere on a curve: what was asked, on the branch that was named, within their own estimates."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from agreement import apart

import halfspace
from fem_adhesion import cli
from halfspace import Coated
from halfspace.equilibrium.charts import metric_for, placed
from halfspace.equilibrium.conditions import EXTREMUM, FOLD, ZERO_LOAD, Condition, Located
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.events import USUAL, ErrorRule, errors_of
from halfspace.equilibrium.path import correct
from halfspace.equilibrium.search import states
from halfspace.errors import InputError
from halfspace.laws import Dlvo, Exponential, Morse
from halfspace.profiles import Hyperboloid, Power, Sphere


@pytest.fixture(scope="module")
def paths():
    """Curves by Tabor parameter: without a fold, with two and with four."""
    return {tabor: halfspace.trace(tabor, rtol=1e-4) for tabor in (0.5, 2.0, 5.0)}


# --- the interface ---


def test_a_state_has_the_value_asked_for_in_the_shape_it_was_asked_in(paths):
    one = paths[2.0].at(approach=-3, branch="contact")
    assert (one.approach, np.shape(one.load)) == (pytest.approx(-3, rel=1e-12), ())
    assert one.load_error > 0
    many = paths[2.0].at(load=np.array([[-4.0, -3.0], [-2.0, 1.0]]), branch="contact")
    np.testing.assert_allclose(many.load, [[-4, -3], [-2, 1]], rtol=0, atol=1e-10)
    assert many.approach_error.shape == (2, 2)
    gaps = paths[2.0].at(central_gap=[3.0, 0.1])
    assert np.isnan(gaps.contact_radius[0])
    assert gaps.contact_radius[1] > gaps.contact_radius_error[1] > 0


def test_a_small_load_of_large_tensions_has_the_value_asked_for_within_its_error():
    """Of tension and pressure 1e8 R dgamma cancel: 20 was met to 3e-6, within 2e-10 by the load alone."""
    path = halfspace.trace(1e-6, law=Exponential(0.36, 30.0), profile=Hyperboloid(0.5614), rtol=1e-5)
    for load in (20.0, -3.0):
        state = path.at(load=load, branch=list(path.branches("load"))[-1])
        assert abs(state.load - load) <= state.load_error <= 1e-10 * (1 + np.abs(path.load).max())


def test_events_are_states_of_the_curve(paths):
    for path in paths.values():
        zero = path.event("zero_load")
        state = path.at(load=0.0, branch="contact")
        assert abs(state.approach - zero.approach) <= state.approach_error + zero.approach_error
        for name, event in path.events.items():
            state = path.at(central_gap=event.central_gap)
            for number in ("approach", "load"):
                bars = getattr(state, f"{number}_error") + getattr(event, f"{number}_error")
                change = event.central_gap_error * abs(np.gradient(getattr(path, number), path.central_gap)).max()
                assert abs(getattr(state, number) - getattr(event, number)) <= bars + change, (path.tabor, name)


def test_branches_are_named_by_what_lies_between_folds(paths):
    assert list(paths[0.5].branches("approach")) == ["whole"]
    assert (
        len({paths[0.5].at(approach=-0.5, branch=name).load for name in (None, "whole", "separated", "contact")}) == 1
    )
    assert list(paths[2.0].branches("approach")) == ["separated", "unstable", "contact"]
    winding = ["separated", "unstable 1", "unstable 2", "unstable 3", "contact"]
    assert list(paths[5.0].branches("approach")) == winding
    on, off = (paths[2.0].event(name).approach for name in ("jump_on", "jump_off"))
    assert paths[2.0].branches("approach")["unstable"] == (pytest.approx(off, abs=1e-3), pytest.approx(on, abs=1e-3))


def test_every_crossing_of_a_winding_curve_is_found(paths):
    """Five states at one approach, the central gap falling from each to the next."""
    path = paths[5.0]
    states = [path.at(approach=-4.51, branch=name) for name in path.branches("approach")]
    np.testing.assert_allclose([state.approach for state in states], -4.51, rtol=1e-12)
    gaps = [state.central_gap for state in states]
    assert gaps == sorted(gaps, reverse=True)
    assert len({round(gap, 3) for gap in gaps}) == 5


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({}, "asked for by nothing, limit: one of approach, load, central_gap"),
        ({"approach": 0, "load": 1}, "asked for by approach and load, limit: one of"),
        ({"approach": -3}, "approach = -3 eps is met on separated, unstable, contact, limit: one; name it by branch"),
        ({"approach": -3, "branch": "stable"}, 'branch = "stable" is none of separated, unstable, contact'),
        ({"approach": -2, "branch": "separated"}, "<= approach <= -2.5519. eps on separated; take one inside"),
        ({"load": [1.0, 1e9]}, r"load = 1e\+09 is outside -4.975.. <= load <= .* R dgamma on this curve"),
        ({"central_gap": np.nan}, "central_gap = nan is outside"),
        ({"load": "none"}, "load = 'none' of type str, limit: a real number; give a float"),
    ],
)
def test_what_is_not_there_is_refused_in_one_line(paths, asked, message):
    with pytest.raises(InputError, match=message) as refusal:
        paths[2.0].at(**asked)
    assert "\n" not in str(refusal.value)


def _parted_at(turn, segments):
    """Segments of a curve, that with a state handing over there: one ends as far before it as the next begins."""
    parted = []
    for segment in segments:
        first, last = (segment.points[end].arclength for end in (0, -1))
        if segment.problem is turn.problem and first < turn.point.arclength < last:
            metric = metric_for(turn.problem)
            before, after = (correct(turn.problem, turn.point, step, metric) for step in (-1e-4, 1e-4))
            parted.append(replace(segment, points=(*_where(segment, last=before), before)))
            parted.append(replace(segment, points=(after, *_where(segment, first=after))))
        else:
            parted.append(segment)
    return tuple(parted)


def _where(segment, first=None, last=None):
    low, high = first.arclength if first else -np.inf, last.arclength if last else np.inf
    return [point for point in segment.points if low < point.arclength < high]


@pytest.mark.parametrize("condition", [FOLD, EXTREMUM, ZERO_LOAD])
def test_a_state_where_one_grid_hands_over_to_the_next_is_counted_once(paths, condition):
    """Before the last point of one and beyond the first of the other it was on neither."""
    segments, curve = paths[2.0].segments, paths[2.0].finest_curve
    known = states(segments, condition)
    for turn in known:
        parted = _parted_at(turn, segments)
        assert len(parted) == len(segments) + 1
        found = states(parted, condition)
        assert len(found) == len(known)
        for ours, theirs in zip(found, known, strict=True):
            np.testing.assert_allclose(ours.point.observables, theirs.point.observables, rtol=1e-9, atol=1e-9)
    if condition.stationary:
        for turn in states(curve.segments, condition):
            parted = replace(curve, segments=_parted_at(turn, curve.segments))
            for name, ends in curve.branches("load").items():
                assert parted.branches("load")[name] == pytest.approx(ends, rel=1e-7)


# --- their errors ---


@pytest.mark.parametrize(
    ("tabor", "rtol", "parts"),
    [
        (0.01, 1e-4, {"profile": Power(10.0)}),
        # The radius at the first point in contact hardly changes by accident, as none is beside it on its grid.
        (4.0, 1e-5, {}),
    ],
    ids=["flat tip", "first point in contact"],
)
def test_points_of_a_curve_are_within_their_errors(tabor, rtol, parts):
    """In the plane across the path, up to gaps from which on the surfaces attract each other from afar alone."""
    path, truth = (halfspace.trace(tabor, **parts, rtol=part) for part in (rtol, 1e-8))
    points = [(segment.problem, point) for segment in path.finest_curve.segments for point in segment.points]
    told, off = [], []
    for errors, (problem, point) in zip(path.finest_curve.errors, points, strict=True):
        exact = placed(truth.finest.everywhere, Located(FOLD, problem, point, 1.0)).point.observables
        here = np.isfinite(exact - point.observables) & (exact[CENTRAL_GAP] < 3.0)
        told += [*(errors + 1e-11 * (1 + np.abs(exact)))[here]]
        off += [*np.abs(exact - point.observables)[here]]
    assert (np.array(off) <= told).all()
    assert np.mean(np.array(told) <= 100 * np.maximum(off, 1e-11)) >= 0.5


def test_a_point_between_two_is_told_the_larger_of_their_errors(monkeypatch):
    path = halfspace.trace(2.0, rtol=1e-3)
    curve, first = path.finest_curve, 0
    all_told = curve.errors
    monkeypatch.setattr("halfspace.equilibrium.states.EVERY", 1)
    own = replace(curve).errors
    for segment in curve.segments:
        here = slice(first, first + len(segment.points))
        told, theirs = all_told[here, :2], own[here, :2]
        np.testing.assert_array_equal(told[::3], theirs[::3])
        for low in range(0, len(told) - 3, 3):
            np.testing.assert_array_equal(told[low + 1], np.maximum(theirs[low], theirs[low + 3]))
        first = here.stop


def test_a_contact_that_is_there_at_once_ends_no_branch():
    """On a flat tip the grid around the edge rippled before the contact was as wide as that."""
    path = halfspace.trace(0.01, profile=Power(10.0), rtol=1e-4)
    assert list(path.branches("load")) == ["separated", "contact"]
    assert path.load_error.max() < 1e-4 * abs(path.event("pull_off").load)


def test_states_on_both_sides_of_a_fold_are_found():
    """Two states between the same points of the path were passed over: neither end lies beyond the value."""
    path = halfspace.trace(2.18, profile=Power(3.45), law=Morse(5.03), rtol=1e-5)
    at = path.branches("approach")
    for value in np.linspace(at["unstable 1"][0], at["unstable 1"][1], 9)[1:-1]:
        on = [low < value < high for low, high in at.values()]
        gaps = [path.at(approach=value, branch=name).central_gap for name, here in zip(at, on, strict=True) if here]
        found = [state.point.observables for state in path.states(Condition(APPROACH, value=value))]
        assert [numbers[2] for numbers in found] == pytest.approx(gaps, abs=1e-2)


def test_ripples_of_a_coarse_grid_are_no_extrema():
    """There were 15 at this tolerance, and are 5 on grids fine enough for any."""
    path = halfspace.trace(4.0, law=Dlvo(0.3, 1.0), body=Coated(0.1, 10.0), rtol=1e-4)
    assert len(path.branches("load")) - 1 == len(path.states(EXTREMUM)) == 5


def test_next_to_a_fold_the_load_errs_by_the_root_of_what_the_approach_does():
    path, truth = halfspace.trace(2.0, rtol=1e-2), halfspace.trace(2.0, rtol=1e-6)
    fold = min(p.branches("approach")["separated"][1] for p in (path, truth))
    for distance in (1e-9, 1e-7, 1e-5, 1e-3):
        ours, theirs = (p.at(approach=fold - distance, branch="separated") for p in (path, truth))
        assert abs(ours.load - theirs.load) <= ours.load_error + theirs.load_error
    assert path.at(approach=fold - 1e-9, branch="separated").load_error > 10 * path.load_error.min()


# --- as many points as wanted ---


def test_a_curve_takes_any_number_of_points(paths):
    path = paths[5.0].resampled(60)
    assert path.approach.shape == path.load_error.shape == path.stable.shape == (60,)
    steps = np.diff([point.arclength for segment in path.segments for point in segment.points])
    np.testing.assert_allclose(steps, steps.mean(), rtol=1e-9)
    metric = path.metric
    chords = np.sqrt(np.diff([p.observables[:3] for p in path.points], axis=0) ** 2 @ metric.weights[:3])
    assert chords.max() < 1.3 * steps.mean()
    np.testing.assert_allclose(
        path.load[1:-1], paths[5.0].at(central_gap=path.central_gap[1:-1]).load, rtol=0, atol=1e-6
    )


def test_both_ends_of_a_curve_with_another_number_of_points_are_on_it():
    """They were solved for anew, and lay beyond the curve by rounding: its own branch refused them."""
    path = halfspace.trace(2.5, rtol=1e-4)
    ends = path.resampled(2)
    for coordinate in ("approach", "load", "central_gap"):
        for end, branch in zip((0, -1), ("separated", "contact"), strict=True):
            value = getattr(ends, coordinate)[end]
            assert value == getattr(path, coordinate)[end]
            assert path.at(**{coordinate: value}, branch=branch).load == ends.load[end]


@pytest.mark.parametrize("count", [1, 2.5, 10_001])
def test_no_curve_has_less_than_two_ends_or_more_points_than_are_waited_for(paths, count):
    with pytest.raises(InputError, match=f"points = {count} is outside 2 <= points"):
        paths[2.0].resampled(count)


def test_the_command_writes_as_many_points_each_with_its_error(tmp_path):
    files, count = (tmp_path / "curve.csv", tmp_path / "curve.json"), 12
    written = f"--points {count} --csv {files[0]} --json {files[1]}"
    assert cli.main(["curve", *f"--tabor 2 --rtol 1e-3 {written}".split()]) == 0
    curve = json.loads(files[1].read_text())["solutions"]["half-space"]["curve"]
    rows = [row for row in csv.DictReader(files[0].read_text().splitlines()) if not row["event"]]
    assert len(rows) == len(curve["load"]) == len(curve["load_error"]) == count
    assert [float(row["load_error_R_dgamma"]) for row in rows] == curve["load_error"]
    path = halfspace.trace(2.0, rtol=1e-3).resampled(count)
    assert curve["load_error"] == path.load_error.tolist()
    assert curve["contact_radius_error"][-1] == path.contact_radius_error[-1]


def test_a_point_that_no_finer_grid_has_does_not_take_the_curve_with_it():
    """The last has a contact nearly as wide as the sphere; on charts of its own it was lost, and all else with it."""
    path = halfspace.trace(28.715, profile=Sphere(100.305), rtol=1e-5, to_load=158.7)
    errors = np.stack([path.approach_error, path.load_error, path.central_gap_error, path.contact_radius_error], axis=1)
    assert (errors[:-1, :2] < 1e-5).all()
    assert not np.isnan(errors[-1]).any()
    assert len(path.load) == len(path.stable) == path.count
    assert path.branches("approach")["contact"][1] == path.approach[-1]
    state = path.at(load=[0.0, 3.0, 5.0, path.load[-1]])
    zero_load = path.event("zero_load")
    assert abs(state.approach[0] - zero_load.approach) <= state.approach_error[0] + zero_load.approach_error
    assert np.isfinite(state.approach_error[:2]).all()
    assert np.all(np.diff(state.approach) > 0)


def test_a_state_between_two_grids_is_solved_for_on_the_one_that_has_an_error():
    """The nearest point was one without a state on the finer grid, so that its error was infinite, or no number."""
    scene = {"law": Dlvo(-0.61, 0.372), "profile": Sphere(28.4, 3.0), "body": halfspace.Layer(9.01, poisson=0.0)}
    curve = halfspace.trace(10.2, **scene, to_load=65.7, rtol=0.04).finest_curve
    assert curve.at("load", -0.535859, "unstable 1").approach_error < 1e-3
    lost = replace(curve, left_behind=tuple(segment.problem for segment in curve.segments))
    for branch, (low, high) in curve.branches("load").items():  # which bend either way
        assert np.isinf(lost.at("load", (low + high) / 2, branch).approach_error), branch


def test_a_state_between_two_grids_is_on_the_branch_that_was_asked_for():
    """Two of forty were on the contact branch, two spacings away, where Newton's method had led from the nearest."""
    path = halfspace.trace(0.7833, body=halfspace.Layer(20.0, 0.3, "sliding"), rtol=1e-4)
    state = path.at(load=np.linspace(-3.34, -3.09, 40), branch="separated")
    assert np.all(np.abs(state.approach + 1.3245) < 0.003)


def test_a_state_is_found_where_two_grids_are_far_apart():
    """Newton's method led to it neither from the last point on one, a turn of the load, nor from the other's first."""
    coarse, fine = (
        halfspace.trace(0.15, law=Dlvo(0.37, 1.14), to_load=7.79, rtol=rtol).at(load=-4.117, branch="unstable 2")
        for rtol in (2e-5, 2e-7)
    )
    assert apart(coarse, fine, ["approach"]) == []


def test_a_contact_that_another_grid_lacks_is_known_to_its_own_size(paths):
    """It was taken to be known to what its polynomials end with, 2,500 times too well. One farther back may lack it."""
    apart, touching = (paths[2.0].stages[-1][name] for name in ("jump_on", "jump_off"))
    radius = touching.point.observables[CONTACT_RADIUS]
    assert errors_of([[apart, touching]], USUAL)[CONTACT_RADIUS] == radius
    assert errors_of([[touching, touching], [apart, touching]], USUAL)[CONTACT_RADIUS] == radius
    assert errors_of([[apart, touching, touching]], USUAL)[CONTACT_RADIUS] == radius
    back = ErrorRule(parts=(0.2, 1.0, 1.0))
    assert errors_of([[apart, touching, touching, touching]], back)[CONTACT_RADIUS] < 1e-3 * radius
    assert errors_of([[touching, apart, touching, touching]], back)[CONTACT_RADIUS] == radius
