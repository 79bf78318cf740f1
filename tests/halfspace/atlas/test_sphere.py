"""The finite sphere's atlas says what finite elements say, as closely as it claims, and refuses the rest."""

import numpy as np
import pytest

from fem_adhesion.finite_sphere import atlas as built
from halfspace import atlas
from halfspace.atlas import sphere
from halfspace.errors import InputError
from halfspace.theories.exact_sphere import RigidSphere

EVENTS = {"pull_off": sphere.pull_off, "jump_on": sphere.jump_on, "jump_off": sphere.jump_off}
POINTS = sphere.stored()["check_points"]


@pytest.fixture(scope="module")
def solved():
    """By finite elements: where the body is deformed most, where it hardly is, close past the birth of its folds."""
    return {point: built.solved(point) for point in ((4.0, 9.1, 0.43), (0.07, 12.0, 0.2), (0.9055, 5.5, 0.3))}


def test_numbers_are_those_of_finite_elements_where_none_was_fitted(solved):
    for point, numbers in solved.items():
        deviations = list(built.compared(point, numbers))
        assert len(deviations) == (2 if point[0] < 0.1 else 6)
        for deviation in deviations:
            assert deviation["of_errors"] <= 1, deviation
            assert deviation["relative"] <= 1e-4, deviation


def test_check_points_are_met():
    assert {point["number"] for point in POINTS} == {f"{name}.{number}" for name in EVENTS for number in sphere.NUMBERS}
    assert max(point["of_errors"] for point in POINTS) <= 1
    assert max(point["relative"] for point in POINTS) <= 1e-4


def test_a_source_that_has_changed_is_found(solved):
    inputs, numbers = next(iter(solved.items()))
    changed = numbers | {"jump_on.load": numbers["jump_on.load"] * 1.0005}
    off = [deviation["number"] for deviation in built.compared(inputs, changed) if deviation["of_errors"] > 1]
    assert off == ["jump_on.load"]


def test_large_spheres_are_half_spaces():
    """The less they differ, the larger they are; and a rigid one's load falls by 9/7 eps/R."""
    ratio = np.geomspace(1e3, 1e5, 9)
    for name, event in EVENTS.items():
        for tabor in (1.0, 8.0):
            found = event(tabor, ratio)
            off = np.abs(np.array([found.load_ratio - 1, found.approach_excess]))
            assert (np.diff(off) < 0).all(), name
            assert (off[:, -1] < 3e-2 * (1 + tabor) ** 2 * np.sqrt(tabor / 1e5) * 10).all()
    rigid = sphere.pull_off(0.05, 40.0).load_ratio - 1
    assert rigid == pytest.approx(RigidSphere(40.0).pull_off().load / (-2 * np.pi) - 1, rel=0.1)


def test_pieces_join_within_their_errors():
    tabor, nu = np.meshgrid(np.geomspace(0.05, 9.9, 30), np.linspace(0, 0.49, 7))
    for ratio in sphere.RATIOS[1:-1]:
        before, after = (sphere.pull_off(tabor, ratio * (1 + side * 1e-12), nu) for side in (-1, 1))
        for number in sphere.NUMBERS:
            gap = np.abs(getattr(after, number) - getattr(before, number))
            assert (gap <= getattr(after, f"{number}_error") + getattr(before, f"{number}_error")).all()
    ratio, nu = np.meshgrid(np.geomspace(5, 1e5, 30), np.linspace(0, 0.49, 7))
    birth, error = sphere.birth_of_folds(ratio, nu)
    assert (error < 1e-5).all()
    before, after = (sphere.pull_off(birth * (1 + side * 1e-9), ratio, nu) for side in (-1, 1))
    assert (np.abs(after.load - before.load) <= after.load_error + before.load_error).all()


def test_beside_the_half_space_it_is_its_own():
    found, half = sphere.jump_off(3.0, 60.0), atlas.jump_off(3.0).take_off
    assert found.load_ratio * half.load == pytest.approx(found.load, rel=1e-14)
    assert found.approach_excess + half.approach == pytest.approx(found.approach, rel=1e-14)
    assert found.load_ratio_error * -half.load == pytest.approx(found.load_error, rel=1e-12)


def test_shapes_are_those_of_the_inputs_together():
    found = sphere.jump_on([[1.5], [3.0]], [50.0, 80.0, 1e4], 0.2)
    assert all(getattr(found, name).shape == (2, 3) for name in vars(found))
    assert isinstance(sphere.pull_off(1.0, 50.0).load, float)
    assert found.load[1, 2] == sphere.jump_on(3.0, 1e4, 0.2).load


@pytest.mark.parametrize(
    ("event", "inputs", "limit"),
    [
        ("pull_off", (0.04, 50.0), "0.05 <= tabor <= 10"),
        ("pull_off", (1.0, 4.9), "5 <= radius_ratio"),
        ("pull_off", ([1.0, 8.0], 17.9), "18 <= radius_ratio"),
        ("pull_off", (1.0, 50.0, 0.495), "poisson <= 0.49"),
        ("pull_off", (np.nan, 50.0), "tabor"),
        ("jump_on", (0.85, 5.0), r"0.8960\d* <= tabor"),
        ("jump_off", ([2.0, 0.6], 1e5), r"0.6985\d* <= tabor"),
    ],
)
def test_what_is_outside_is_refused(event, inputs, limit):
    with pytest.raises(InputError, match=f"is outside .*{limit}.*fem_adhesion.trace"):
        EVENTS[event](*inputs)
