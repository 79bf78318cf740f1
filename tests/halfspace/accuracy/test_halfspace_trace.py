"""The half-space curve and its events against converged references, limits, and itself."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from page_tables import rows_of
from references import charted_rung

import halfspace
from fem_adhesion.common.fold_birth import critical_stiffness
from halfspace.accuracy.finite_bodies import ChartSettings
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.accuracy.refinement import climb
from halfspace.elastic.kernel import RingRules
from halfspace.equilibrium.contact import CONTACT_RADIUS, ContactProblem
from halfspace.equilibrium.devices import cycle
from halfspace.errors import NotConverged
from halfspace.laws import LENNARD_JONES, Dugdale
from halfspace.profiles import Sphere
from halfspace.scales import Scales
from halfspace.theories import closed_forms

DATA = Path(__file__).parents[2] / "data"


def _reference():
    rows = rows_of(DATA / "reference_events.csv")
    return [{key: value if key == "event" else float(value or "nan") for key, value in row.items()} for row in rows]


@pytest.fixture(scope="module")
def curves():
    return {tabor: halfspace.trace(tabor) for tabor in (0.02, 0.05, 0.5, 0.69, 0.7, 0.71, 1, 2, 3, 5, 10)}


@pytest.mark.parametrize("tabor", [0.02, 10])
def test_the_curve_goes_on_from_grid_to_grid(curves, tabor):
    """The same state on two grids, of which each is right to some 1e-5 where the edge leaves the one for the other."""
    separated, contact = curves[tabor].segments
    last, first = separated.points[-1], contact.points[0]
    assert first.arclength == last.arclength
    assert first.observables[CONTACT_RADIUS] == pytest.approx(last.observables[CONTACT_RADIUS], rel=1e-9, abs=0)
    np.testing.assert_allclose(first.observables, last.observables, rtol=2e-4)
    np.testing.assert_allclose(first.rates, last.rates, rtol=1e-2, atol=1e-3)


@pytest.mark.parametrize("row", _reference(), ids=lambda row: f"{row['tabor']:g}-{row['event']}")
def test_events_against_the_converged_reference(curves, row):
    event = curves[row["tabor"]].event(row["event"])
    load_error = abs(event.load - row["load"])
    approach_error = abs(event.approach - row["approach"])
    assert load_error <= 1e-6 * abs(row["load"])
    if row["event"] != "pull_off":  # a flat extremum, whose place is less certain than its depth
        assert approach_error <= 1e-6 * abs(row["approach"])
    assert load_error <= event.load_error + row["err_load"]
    assert approach_error <= event.approach_error + row["err_approach"]


def test_the_unstable_branch_lies_between_the_jumps(curves):
    path = curves[5]
    unstable = np.flatnonzero(~path.stable)
    assert np.all(np.diff(unstable) == 1)
    on, off = path.event("jump_on"), path.event("jump_off")
    assert path.approach[unstable].max() <= on.approach
    assert path.approach[unstable].min() >= off.approach
    assert not path.stable_under_dead_load[~path.stable].any()
    assert path.stable_under_dead_load[-1]
    pull_off = path.event("pull_off").load
    assert path.load.min() >= pull_off
    falling = np.diff(path.load) < 0
    assert not (path.stable_under_dead_load[1:] & path.stable_under_dead_load[:-1])[falling].any()


def test_the_curve_runs_from_separation_to_compression(curves):
    for tabor, path in curves.items():
        assert abs(path.load[0]) < 0.03
        assert path.load[-1] >= 5
        assert path.central_gap[0] > 19
        assert np.isnan(path.contact_radius[0])
        touching = np.isfinite(path.contact_radius)
        radius, error = path.contact_radius[touching], path.contact_radius_error[touching]
        assert np.all(np.diff(radius) >= -error[1:] - error[:-1]), tabor  # where one grid hands over to the next
        assert np.all(np.diff(path.arclength) >= 0)


def test_the_neck_outside_a_soft_contact_is_jkrs():
    """Gap outside the contact: Hertz's and that of a flat punch pulled by sqrt(2 pi a dgamma/E*)."""
    mu = 100.0
    state = halfspace.trace(mu, rtol=1e-4).stages[-1]["zero_load"]
    a = float(closed_forms.jkr_radius(0.0))
    r = np.linspace(1.1, 2.0, 10) * a
    gap = state.problem.operator_at(state.point.x).values_at(r, state.point.x[:-2])
    jkr = closed_forms.hertz_gap(r, a, mu) + mu * np.sqrt(2 * np.pi * a) * 2 / np.pi * np.arccos(a / r)
    np.testing.assert_allclose(gap, jkr, rtol=0.02)


@pytest.mark.parametrize(
    ("code", "unneeded"),
    [
        ("", ("scipy",)),
        ("halfspace.trace(1.0)", ("scipy.optimize", "scipy.interpolate", "scipy.sparse", "scipy.spatial")),
    ],
    ids=["import", "trace"],
)
def test_what_loads_slowly_is_loaded_if_needed(code, unneeded):
    """By the modules that are there afterwards, not by the clock."""
    code = f"import sys, halfspace; {code or None}; print([m for m in {unneeded} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


@pytest.mark.parametrize(
    ("tabor", "law", "points", "factorisations"),
    [(1, LENNARD_JONES, 35, 155), (300, LENNARD_JONES, 95, 400), (1, Dugdale(0.1), 55, 265)],
)
def test_a_curve_takes_few_points_and_factorisations(monkeypatch, tabor, law, points, factorisations):
    """A fold is found in four or five, a state in three or four: the tangent uses the factors at hand."""
    made = []
    factorise = ContactProblem.bordered_solver
    monkeypatch.setattr(ContactProblem, "bordered_solver", lambda *args: made.append(1) or factorise(*args))
    path = halfspace.trace(tabor, law=law, rtol=1e-6)
    assert path.count <= points
    assert len(made) <= factorisations


def test_what_the_lowest_grid_cannot_carry_goes_to_the_next():
    """As where two folds about to merge exist on one grid, but not on another."""
    asked = []

    def rung(level):
        asked.append(level)
        if level == 0:
            raise NotConverged("the event is not found again; refine both grids")
        return charted_rung(half_space_charts(Scales(1.0), resolution_for(Scales(1.0), 1e-3, level)))

    path = climb(1e-2, rung)
    assert asked == [0, 1, 2]
    assert path.event("jump_on").approach == pytest.approx(-1.629216712, abs=1e-4)


# --- near the Tabor parameter at which the curve begins to fold ---

CRITICAL = 0.69721461383  # `fem_adhesion.common.fold_birth` at rtol 1e-10
BY_TABOR = 0.459  # R dgamma/eps by which the margin falls with the Tabor parameter there


@pytest.mark.parametrize("rtol", [1e-1, 1e-8])
@pytest.mark.parametrize("tabor", [0.6970, 0.697214614, 0.69721462])
def test_a_curve_about_to_fold_says_how_far_its_folds_are(tabor, rtol):
    path = halfspace.trace(tabor, rtol=rtol)
    margin, truth = path.margin, BY_TABOR * (CRITICAL - tabor)
    assert abs(margin.value - truth) <= margin.error + 0.01 * abs(truth)
    certain = abs(margin.value) > margin.error
    assert path.jumps is ((tabor > CRITICAL) if certain else None)
    assert margin.error < 1e-4
    if rtol == 1e-8:
        assert certain is (tabor != 0.697214614)  # which is 1.7e-10 from it


def test_the_margin_is_that_of_the_stiffest_apparatus():
    """By a golden search under prescribed central gaps, in `fem_adhesion.common.fold_birth`."""
    path = halfspace.trace(0.69, rtol=1e-8)
    assert path.margin.value == pytest.approx(1 / critical_stiffness(0.69), rel=1e-5, abs=0)
    assert halfspace.trace(0.5).margin is halfspace.trace(1.0).margin is None
    assert (halfspace.trace(0.5).jumps, halfspace.trace(1.0).jumps) == (False, True)


def test_folds_that_a_finer_grid_loses_are_left_in_doubt():
    """On the lowest rung two folds, on all above none: nobody is told to refine a grid."""
    tabor = CRITICAL - 1e-5  # on the finer grid folds are born 4e-6 below the exact place

    def rung(level):
        resolution = resolution_for(Scales(tabor), 1e-1, level)
        return charted_rung(half_space_charts(Scales(tabor if level else tabor + 1e-4), resolution))

    path = climb(1e-2, rung, most_rungs=1)
    assert "jump_on" not in path.events
    assert path.jumps is None
    assert path.margin.error > 1e-5
    assert cycle(path) is None


def test_a_grid_beyond_memory_is_refused_by_its_input(monkeypatch):
    monkeypatch.setattr(halfspace.elastic.kernel, "RULES", RingRules(largest=2e4))
    with pytest.raises(NotConverged, match=r"^rtol = 1e-06 takes grids of \d+ nodes, .*, limit: 2e-05 GB; take a lar"):
        halfspace.trace(2.0, rtol=1e-6)


def test_the_last_rung_that_fits_memory_has_its_errors(monkeypatch):
    asked = {"law": Dugdale(0.1), "profile": Sphere(30.0), "rtol": 3e-5}
    full = halfspace.trace(5.0, **asked)
    lowest, highest = (full.settings[rung]["nodes"] for rung in ("curve", "events"))
    assert highest > lowest + 1
    monkeypatch.setattr(halfspace.elastic.kernel, "RULES", RingRules(largest=2e6))
    monkeypatch.setattr(halfspace.accuracy.finite_bodies, "CHARTS", ChartSettings(together=1))  # the curve takes less
    path = halfspace.trace(5.0, **asked)
    assert lowest < path.settings["events"]["nodes"] < highest
    assert path.missed
    for name, event in full.events.items():
        assert abs(path.events[name].load - event.load) <= path.events[name].load_error


def test_kernels_that_made_room_are_made_as_they_were(monkeypatch):
    asked = {"profile": Sphere(30.0), "rtol": 1e-3}
    kept = halfspace.trace(1.0, **asked)
    monkeypatch.setattr(halfspace.elastic.operators.STORE, "room", 0.0)
    for name, event in halfspace.trace(1.0, **asked).events.items():
        assert (event.load, event.load_error) == (kept.events[name].load, kept.events[name].load_error)


def test_kernels_that_the_store_has_no_room_for_are_refused(monkeypatch):
    """Each state would take all of them anew."""
    monkeypatch.setattr(halfspace.accuracy.finite_bodies, "ROOM", 5e4)
    with pytest.raises(NotConverged, match=r"^rtol = 0.001 takes .* at \d+ contact radii, .* GB; take a larger rtol"):
        halfspace.trace(1.0, profile=Sphere(100.0), rtol=1e-3)
