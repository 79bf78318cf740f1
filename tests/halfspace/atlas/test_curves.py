"""Curves of the atlas are those of its source, on every branch, and meet the events of the atlas."""

import numpy as np
import pytest

import halfspace
from halfspace import atlas
from halfspace.atlas import build_curves
from halfspace.atlas.series import EDGE
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES

BIRTH = atlas.birth_of_folds().value
TABORS = (0.0137, 0.71, 3.99)


@pytest.mark.parametrize("tabor", TABORS)
def test_states_on_every_branch_are_those_of_the_source(tabor):
    off, of_errors = build_curves.deviations(tabor, atlas.curve(tabor), seed=5)
    assert off < 1e-7
    assert of_errors <= 1


@pytest.mark.parametrize("tabor", TABORS)
def test_curves_turn_at_the_events_of_the_atlas(tabor):
    curve = atlas.curve(tabor)
    branches, scale = curve.branches("approach"), 1 + 2 * tabor
    pull_off, zero_load = atlas.pull_off(tabor), atlas.zero_load(tabor)
    assert curve.branches("load")["contact"][0] == pytest.approx(pull_off.load, abs=1e-7)
    assert curve.at(load=0.0, branch="contact").approach == pytest.approx(zero_load.approach, abs=1e-7 * scale)
    assert len(branches) == (1 if tabor < BIRTH else len(halfspace.trace(tabor).branches("approach")))
    if tabor > BIRTH:
        jump_on, jump_off = atlas.jump_on(tabor), atlas.jump_off(tabor)
        assert branches["separated"][1] == pytest.approx(jump_on.take_off.approach, abs=1e-7 * scale)
        assert branches["contact"][0] == pytest.approx(jump_off.take_off.approach, abs=1e-7 * scale)
        landing = curve.at(approach=jump_on.take_off.approach, branch="contact")
        assert landing.load == pytest.approx(jump_on.landing.load, abs=1e-7)
        assert landing.contact_radius == pytest.approx(jump_on.landing.contact_radius, abs=1e-6)
        assert curve.at(approach=jump_off.take_off.approach, branch="separated").load == pytest.approx(
            jump_off.landing.load, abs=1e-7
        )


def test_curves_join_where_the_series_change():
    for end in (0.1, 0.5, 2.0, 10.0, 60.0):
        before, after = (atlas.curve(end * (1 + side * 1e-12)) for side in (-1, 1))
        for branch, (low, high) in before.branches("approach").items():
            approach = low + (high - low) * np.linspace(0.01, 0.99, 10)
            one, other = (curve.at(approach=approach, branch=branch) for curve in (before, after))
            np.testing.assert_allclose(one.load, other.load, rtol=1e-8, atol=1e-8)
            np.testing.assert_allclose(one.contact_radius, other.contact_radius, rtol=0, atol=1e-7)


@pytest.mark.parametrize("tabor", [0.4, 2.5])
def test_a_spring_s_base_turns_where_an_apparatus_jumps(tabor):
    stiffness = 1.5
    jumps, curve = cycle(halfspace.trace(tabor, rtol=1e-8), stiffness), atlas.curve(tabor)
    branches = curve.branches("base", stiffness=stiffness)
    for jump, branch, end in ((jumps.jump_on, "separated", 1), (jumps.jump_off, "contact", 0)):
        base = jump.take_off.approach + jump.take_off.load / stiffness
        assert branches[branch][end] == pytest.approx(base, abs=1e-6)
        other = {"separated": "contact", "contact": "separated"}[branch]
        state = curve.at(base=base, stiffness=stiffness, branch=other)
        assert state.approach == pytest.approx(jump.landing.approach, abs=1e-6)
        assert state.load == pytest.approx(jump.landing.load, abs=1e-6)


def test_a_stiff_spring_is_fixed_grips_and_a_soft_one_a_dead_load():
    curve = atlas.curve(2.0)
    assert curve.branches("base") == curve.branches("approach")
    soft = curve.branches("base", stiffness=1e-9)["contact"][0] * 1e-9
    assert soft == pytest.approx(curve.branches("load")["contact"][0], abs=1e-7)


def test_errors_grow_towards_a_fold_as_the_root_of_those_of_the_approach():
    curve = atlas.curve(2.0)
    low, _ = curve.branches("approach")["contact"]
    far, close = (curve.at(approach=low + by, branch="contact").load_error for by in (1.0, 1e-12))
    assert far < 1e-7
    assert 3 * far < close < 1e-3


def test_states_go_from_separation_to_compression():
    states = atlas.curve(5.0).states(300)
    assert (np.diff(states.central_gap) < 0).all()
    assert np.isnan(states.contact_radius[states.central_gap > EDGE]).all()
    assert (states.contact_radius[states.central_gap < EDGE] >= 0).all()
    assert states.load[-1] > 5
    for name in ("approach", "load", "central_gap"):
        assert (getattr(states, f"{name}_error") < 1e-6).all()
    assert pytest.approx(LENNARD_JONES.edge_gap, abs=1e-15) == EDGE


def test_shapes_are_those_asked_for():
    curve = atlas.curve(2.0)
    for asked in (1.0, [1.0, 2.0], [[1.0], [2.0]], []):
        assert np.shape(curve.at(approach=asked).load) == np.shape(asked)
    assert curve.at(approach=[1.0, 2.0]).load[1] == pytest.approx(curve.at(approach=2.0).load, abs=1e-13)
    # one array may have states of several branches, if each value is met on one alone
    assert (np.diff(curve.at(approach=[-5.0, 1.0]).load) < 0).all()


def test_what_there_is_not_is_refused():
    curve = atlas.curve(2.0)
    for asked, told in (
        ({}, "asked for by nothing, limit: one of approach, load, base"),
        ({"approach": 1, "load": 0}, "asked for by approach and load"),
        ({"approach": -3.0}, "approach = -3 eps is met on separated, unstable, contact, limit: one"),
        ({"approach": [1.0, 999.0]}, r"approach = 999 is outside .* eps on this curve; take one inside"),
        ({"load": "none"}, "load = 'none' of type str, limit: a real number; give a float"),
        ({"approach": 1.0, "branch": "separated"}, r"outside .* on separated"),
        ({"approach": 1.0, "branch": "middle"}, 'branch = "middle" is none of separated, unstable, contact'),
        ({"base": 1.0, "stiffness": 0.0}, "stiffness = 0 is outside 0 < stiffness"),
    ):
        with pytest.raises(InputError, match=told):
            curve.at(**asked)
    with pytest.raises(InputError, match="coordinate = 'gap' is not one of"):
        curve.branches("gap")
    for outside in (0.0099, 301.0):
        with pytest.raises(InputError, match="outside the atlas"):
            atlas.curve(outside)


def test_a_curve_that_does_not_fold_is_whole_and_serves_either_end():
    curve = atlas.curve(0.5)
    assert list(curve.branches("approach")) == ["whole"]
    assert curve.at(approach=0.0, branch="contact").load == curve.at(approach=0.0).load
