"""The atlas says what its source says, as closely as it claims, and needs no solver for it."""

import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import halfspace
from halfspace import atlas
from halfspace.atlas import build
from halfspace.atlas.__main__ import main
from halfspace.atlas.series import stored
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.errors import InputError
from halfspace.theories import closed_forms
from halfspace.values import Estimate

ROOT = Path(__file__).parents[3]
FILE = ROOT / "halfspace/atlas/atlas.json"
BIRTH = atlas.birth_of_folds()
STATES = {
    "pull_off": atlas.pull_off,
    "zero_load": atlas.zero_load,
    **{
        f"{jump}.{end}": lambda tabor, jump=jump, end=end, **asked: getattr(getattr(atlas, jump)(tabor, **asked), end)
        for jump in ("jump_on", "jump_off")
        for end in ("take_off", "landing")
    },
}


@pytest.fixture(scope="module")
def known():
    """Numbers by the source at random Tabor parameters, those beside both births of folds among them."""
    return {tabor: build.solved(tabor) for tabor in build.sample(8, 2, BIRTH.value).tolist()}


# --- against its source ---


@pytest.mark.parametrize("event", STATES)
def test_states_are_those_of_the_source(known, event):
    """Within their errors, loads and approaches to nine digits."""
    for tabor, numbers in known.items():
        approaches = [number.value for name, number in numbers.items() if name.endswith("approach")]
        state, taken_off = STATES[event](tabor), numbers.get(f"{event.replace('landing', 'take_off')}.load")
        for quantity in OBSERVABLES:
            found = Estimate(getattr(state, quantity), getattr(state, f"{quantity}_error"))
            number = numbers.get(f"{event}.{quantity}")
            if number is None:
                assert np.isnan(found.value), (tabor, quantity)
                continue
            assert found.agrees(number), (tabor, quantity)
            # A landing's load counts by that from which it has jumped, as in a cycle's tolerance.
            size = 1 + np.ptp(approaches) if quantity == "approach" else max(abs(number.value), abs(taken_off.value))
            if quantity in ("approach", "load") and (event, quantity) != ("zero_load", "load"):
                assert abs(found.value - number.value) <= 1e-9 * size + (number.error if tabor < 0.699 else 0)


def test_a_check_looks_at_every_number_that_is_stored(known):
    for tabor, numbers in known.items():
        not_stored = {"zero_load.load", "jump_on.landing.approach", "jump_off.landing.approach"}
        points = build.compared(stored()["series"], numbers, tabor)
        assert {point["number"] for point in points} == numbers.keys() - not_stored


def test_energies_are_those_of_the_source(known):
    for tabor, numbers in known.items():
        on, off = (numbers.get(f"{jump}.energy") for jump in ("jump_on", "jump_off"))
        pairs = [(atlas.energy_released(tabor), numbers["energy_released"])]
        pairs += [(atlas.energy_lost(tabor), on + off if on else Estimate(0, 0))]
        pairs += [(atlas.jump_on(tabor), on), (atlas.jump_off(tabor), off)] if on else []
        for found, number in pairs:
            assert Estimate(found.energy, found.energy_error).agrees(number), tabor


def test_estimates_are_no_larger_than_the_accuracy_needs():
    """An estimate that is right because it is huge says nothing."""
    tabor = np.geomspace(0.72, 300, 50)
    for event, states in STATES.items():
        state = states(tabor)
        assert (state.approach_error < 3e-9 * (1 + 2 * tabor)).all(), event
        assert (state.load_error < 3e-9).all(), event


# --- births and limits ---


def test_folds_are_born_where_the_source_says():
    for side in (-1, 1):
        assert halfspace.trace(BIRTH.value * (1 + side * 1e-7), rtol=1e-9).jumps is (side > 0)
    assert BIRTH.error < 1e-10


def test_jumps_begin_at_the_birth_of_folds():
    tabor = np.array([0.01, BIRTH.value * (1 - 1e-9), BIRTH.value * (1 + 1e-12), 0.8])
    for jump in (atlas.jump_on(tabor), atlas.jump_off(tabor)):
        for number in (jump.energy, jump.take_off.load, jump.landing.load, jump.take_off.approach_error):
            assert np.isnan(number).tolist() == [True, True, False, False]
        assert abs(jump.energy[2]) <= jump.energy_error[2]
    assert atlas.energy_lost(tabor).energy[:2].tolist() == [0, 0]
    on, off = (jump(tabor).take_off for jump in (atlas.jump_on, atlas.jump_off))
    assert on.load[2] == pytest.approx(off.load[2], abs=on.load_error[2])


def test_a_contact_begins_as_the_root_where_the_central_gap_is_the_edges():
    edge = halfspace.laws.LENNARD_JONES.edge_gap
    tabor = np.linspace(BIRTH.value * 1.0001, 0.75, 400)
    for state in (atlas.jump_on(tabor).landing, atlas.jump_off(tabor).take_off):
        closed = state.central_gap < edge
        np.testing.assert_array_equal(np.isfinite(state.contact_radius), closed)
        radius = state.contact_radius[closed]
        assert radius[0] < 0.2 * radius[-1]
        assert (np.diff(radius) > 0).all()


def _order(deviation, tabor):
    return np.log(deviation[1] / deviation[0]) / np.log(tabor[1] / tabor[0])


def test_the_least_tabors_tend_to_a_rigid_sphere_as_its_bulge_does():
    """The half-space bulges by pi sqrt2 mu^(3/2) eps, see `halfspace.theories.criteria`: so much changes the load."""
    tabor = np.array([0.01, 0.012])
    pull_off, zero_load = atlas.pull_off(tabor), atlas.zero_load(tabor)
    assert _order(pull_off.load - closed_forms.BRADLEY_PULL_OFF, tabor) == pytest.approx(1.5, abs=0.01)
    assert _order(-pull_off.approach, tabor) == pytest.approx(1.5, abs=0.01)
    assert _order(zero_load.approach - (1 - 4 ** (-1 / 6)), tabor) == pytest.approx(1.5, abs=0.04)


@pytest.mark.parametrize("event", ["pull_off", "zero_load", "jump_off.take_off"])
def test_the_largest_tabors_tend_to_jkr_as_the_law_s_tail_does(event):
    """The tension over an opening crack falls as h^-3, h as the root of the distance: the correction is mu^-2 ln(mu).

    In units of mu eps, as approaches are in JKR's theory, that of the approach too.
    """
    tabor = np.array([100.0, 173.2, 300.0])
    limit = [getattr(closed_forms, f"jkr_{event.split('.')[0]}")(one) for one in tabor]
    for quantity, unit in (("load", 1.0), ("approach", tabor), ("contact_radius", 1.0)):
        if (event, quantity) == ("zero_load", "load"):
            continue
        value = getattr(STATES[event](tabor), quantity)
        deviation = np.abs(value - [getattr(state, quantity) for state in limit]) / unit * tabor**2
        first, second = np.diff(deviation) / np.diff(np.log(tabor))
        assert second == pytest.approx(first, rel=0.05)  # linear in ln(mu)


def test_the_jump_on_tends_to_the_attraction_of_a_thin_layer_of_gap():
    """(|alpha*| + 1)^(7/2) grows as mu^(3/2): see `halfspace.theories.criteria`."""
    tabor = np.array([200.0, 300.0])
    assert _order(1 - atlas.jump_on(tabor).take_off.approach, tabor) == pytest.approx(3 / 7, abs=1e-6)


# --- as functions ---


def test_pieces_join_within_their_errors():
    for name, entry in stored()["series"].items():
        series, birth = build.series_of(entry), entry["birth"]
        x = np.array(entry["ends"][1:-1])
        ends = birth * np.exp(x if birth == 1 else x**2)
        (before, error), (after, other) = (series(ends * (1 + side * 1e-13)) for side in (-1, 1))
        np.testing.assert_array_less(np.abs(after - before), error + other + 1e-11 * np.abs(before), err_msg=name)


@pytest.mark.parametrize("event", STATES)
def test_derivatives_are_those_of_the_values(event):
    tabor, d = np.array([0.0123, 0.3, 0.75, 1.7, 3.974, 25.0, 250.0]), 2e-5
    rates = STATES[event](tabor, derivative=1)
    low, high = (STATES[event](tabor * (1 + side * d)) for side in (-1, 1))
    for quantity in ("approach", "load", "central_gap", "contact_radius"):
        difference = (getattr(high, quantity) - getattr(low, quantity)) / (2 * tabor * d)
        scale = (np.abs(getattr(high, quantity)) + 1e-6) / tabor
        np.testing.assert_allclose(getattr(rates, quantity) / scale, difference / scale, rtol=3e-6, atol=1e-7)


def test_derivatives_of_energies_are_those_of_the_values():
    tabor, d = np.array([0.05, 0.9, 7.0]), 1e-4
    for energy in (atlas.energy_released, atlas.energy_lost):
        low, high = (energy(tabor * (1 + side * d)).energy for side in (-1, 1))
        assert energy(tabor, derivative=1).energy == pytest.approx((high - low) / (2 * d * tabor), rel=1e-5, abs=1e-9)


def test_shapes_are_those_asked_for():
    for asked in (2.0, [2.0, 3.0], [[2.0], [3.0]], []):
        for found in (atlas.pull_off(asked).load, atlas.zero_load(asked).load, atlas.energy_lost(asked).energy):
            assert np.shape(found) == np.shape(asked)
    assert isinstance(atlas.pull_off(2.0).load, float)
    assert atlas.pull_off([2.0, 3.0]).load[1] == atlas.pull_off(3.0).load


@pytest.mark.parametrize("event", [atlas.pull_off, atlas.jump_on, atlas.energy_lost])
def test_what_is_outside_is_refused(event):
    for outside, remedy in (
        (0.009, "halfspace.trace"),
        (300.1, "JKR"),
        (np.nan, "give the Tabor parameter"),
        ([1.0, -2.0], "give the Tabor parameter"),
    ):
        with pytest.raises(InputError, match=rf"outside the atlas, 0.01 <= tabor <= 300; .*{remedy}"):
            event(outside)
    with pytest.raises(InputError, match="tabor = 'one' of type str, limit: a real number"):
        event("one")
    for inside in (0.01, 300.0):
        event(inside)


# --- the package ---


def test_it_needs_numpy_alone():
    others = "scipy", "skfem", "fem_adhesion", "halfspace.acc", "halfspace.equ", "halfspace.el"
    code = "import sys; from halfspace import atlas; from halfspace.atlas import sphere; "
    code += "atlas.jump_on(2.0), sphere.jump_on(2.0, 50.0); "
    code += f"print([m for m in sys.modules if m.startswith({others})])"
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"


def test_the_files_are_small_and_packed():
    files = [FILE, FILE.with_name("curves.npz"), FILE.with_name("sphere.json")]
    assert sum(file.stat().st_size for file in files) < 300_000
    packed = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]["halfspace"]
    assert {*files} <= {file for pattern in packed for file in (ROOT / "halfspace").glob(pattern)}


# --- how it is made ---


def test_a_build_goes_on_from_the_nodes_that_are_solved(tmp_path, capsys):
    solved = []

    def solve(at):
        solved.append(at)
        return {"load": Estimate(len(solved), 0.5)}

    for _ in range(2):
        node = build.Store(tmp_path / "nodes.jsonl", solve, lambda pair: Estimate(*pair))
        assert [node(at)["load"] for at in (0.1, (0.2, 5.0), 0.1)] == [Estimate(one, 0.5) for one in (1, 2, 1)]
    assert solved == [0.1, (0.2, 5.0)]
    told = capsys.readouterr().out.split("\r")
    assert [one.strip() for one in told] == ["", "nodes: 1, the last at tabor 0.1", "nodes: 2, the last at tabor 0.2"]


def test_a_series_through_a_known_number_is_that_number():
    entry = build.whole(lambda tabor: {"number": Estimate(np.sin(np.log(tabor)), 1e-12)}, "number")
    tabor = np.geomspace(0.01, 300, 101)
    value, error = build.series_of(entry)(tabor)
    assert (np.abs(value - np.sin(np.log(tabor))) <= error).all()
    assert (error < 1e-10).all()


def test_a_check_fails_where_the_file_is_off(monkeypatch, capsys, tmp_path):
    numbers = build.solved(1.0)
    monkeypatch.setattr(build, "sample", lambda *_: np.array([1.0]))
    for off, wrong in (({}, 0), ({"pull_off.load": numbers["pull_off.load"] * (1 + 1e-8)}, 1)):
        monkeypatch.setattr(build, "solved", lambda _, off=off: numbers | off)
        assert main(["--check", "1", "--nodes", str(tmp_path / str(wrong))]) == wrong
    assert "pull_off.load" in capsys.readouterr().out
