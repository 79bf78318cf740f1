"""Results as values: pickled and read back, compared, shown in a few lines; and what the packages show."""

import ast
import importlib
import itertools
import pickle
import re
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scenes import hemisphere, pair
from scipy import sparse
from skfem import ElementQuadP

import fem_adhesion
import halfspace
from fem_adhesion import Meshed, NeoHookean, Scene
from fem_adhesion.finite_strain.scene import LITTLE
from fem_adhesion.mesh.block import block_grid
from halfspace.equilibrium.events import approach_scale
from halfspace.errors import InputError
from halfspace.values import Estimate, Valued, same

ROOT = Path(__file__).parents[3]

PATHS = {
    "half-space": partial(halfspace.trace, 1.0, rtol=1e-2),
    "pair": partial(fem_adhesion.trace, pair(0.1, 10.0, 0.3, 0.3, 2.0), rtol=1e-1),
    "mesh": partial(
        fem_adhesion.trace, Scene(0.1, Meshed(ROOT / "meshes" / "hemisphere.msh", radius_ratio=2.0)), rtol=1e-1
    ),
    "finite strain": partial(
        fem_adhesion.trace, hemisphere(0.1, 2.0, material=NeoHookean()), rtol=1e-1, to_load=LITTLE
    ),
}


@pytest.fixture(scope="module", params=PATHS)
def path(request):
    return PATHS[request.param]()


# --- results of every body ---


def test_a_result_is_the_same_after_it_was_pickled_and_goes_on_to_work(path):
    """Its factors and operators are made again: stability, and the event on the discretisation it was found on."""
    again = pickle.loads(pickle.dumps(path))
    assert again == path
    assert hash(again) == hash(path)
    np.testing.assert_array_equal(again.resampled(3).load, path.resampled(3).load)
    few = [segment.problem.negative_directions(segment.points[-1].x) for segment in path.segments]
    assert [segment.problem.negative_directions(segment.points[-1].x) for segment in again.segments] == few
    event = again.stages[-1]["pull_off"]
    residual = event.problem.residual(event.point.x)
    np.testing.assert_array_equal(residual, path.stages[-1]["pull_off"].problem.residual(event.point.x))
    assert again.finest(event).unknowns == path.finest(event).unknowns > 0


def test_another_result_is_another_value(path):
    event = path.stages[-1]["pull_off"]
    moved = replace(event.point, x=np.nextafter(event.point.x, np.inf))
    others = [
        replace(path, tabor=2 * path.tabor),
        replace(path, stages=({"pull_off": replace(event, point=moved)},)),
        replace(path, settings={**path.settings, "rtol": 1e-9}),
        replace(path, segments=path.segments[:-1] or (replace(path.segments[0], points=()),)),
        "a curve",
    ]
    assert not any(path == other for other in others)
    assert replace(path, seconds=1e9) == path


def test_a_result_is_shown_in_a_few_lines_that_say_what_it_is(path):
    text = repr(path)
    assert len(text) < 1000
    pull_off = path.events["pull_off"]
    assert f"pull_off at approach {pull_off.approach:.6g} +- {pull_off.approach_error:.1g} eps, load" in text
    assert f"load {pull_off.load:.6g} +- {pull_off.load_error:.1g} R dgamma" in text
    assert f"tabor {path.tabor:g}: {path.count} points" in text
    assert f"; rtol {path.rtol:g} met; {path.unknowns} unknowns" in text
    missed = replace(path, settings={**path.settings, "rtol": 0.5 * pull_off.load_error / abs(pull_off.load)})
    assert re.search(rf"; rtol {missed.rtol:g} not met by pull_off (approach and )?load", repr(missed))
    found = path.stages[-1]["pull_off"]
    for part in (found, found.point, found.problem, path.segments[0], path.finest, found.problem.interface.operator):
        assert len(repr(part)) < 2000
        assert repr(part).startswith(type(part).__name__ + "(")


def test_an_event_is_asked_for_by_its_name(path):
    assert path.event("pull_off") is path.events["pull_off"]
    assert path.event("jump_on") is path.events.get("jump_on")
    with pytest.raises(InputError, match=r'event = "pulloff" is none of .*jump_on.*zero_load; did you mean "pull_off"'):
        path.event("pulloff")
    with pytest.raises(InputError, match=r'event = "xyz" is none of pull_off, jump_on, jump_off, zero_load; take one'):
        path.event("xyz")


def test_all_numbers_are_to_be_had_as_plain_data(path):
    path = path.resampled(3)
    plain, frame = path.to_dict(), path.to_frame()
    assert plain["events"].keys() == path.events.keys()
    assert plain["events"]["pull_off"]["load_error"] == path.events["pull_off"].load_error
    assert list(frame) == list(plain["curve"])
    for name in ("load", "contact_radius_error"):
        np.testing.assert_array_equal(frame[name], getattr(path, name))
    assert np.array_equal(frame["stable_under_fixed_grips"], path.stable)


# --- how values are compared ---


@dataclass(frozen=True, eq=False, repr=False)
class Sample(Valued):
    """A value that holds anything."""

    array: object
    scalar: float = 0.0


@pytest.mark.parametrize(
    "make",
    [
        lambda: np.array([1.0, np.nan]),
        lambda: sparse.csr_array(np.eye(3)),
        lambda: (np.ones(2), [np.zeros(3)], {"a": np.ones(1)}, Sample(np.ones(2))),
        lambda: partial(max, np.ones(2), key=float),
        lambda: (ElementQuadP(3), block_grid(0.5, 1.5, 10.0)),
    ],
)
def test_equal_parts_make_equal_values(make):
    assert Sample(make()) == Sample(make())
    assert Sample(make(), float("nan")) == Sample(make(), float("nan"))
    assert Sample(make()) != Sample(make(), 1.0)
    assert Sample(make()) in {Sample(make())}
    assert len(repr(Sample(make()))) < 300


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (np.ones(2), np.array([1.0, 2.0])),
        (np.ones(2), np.ones(2, dtype=int)),
        (sparse.csr_array(np.eye(3)), 2 * sparse.csr_array(np.eye(3))),
        ([np.ones(2)], (np.ones(2),)),
        ([np.ones(2)], [np.ones(2)] * 2),
        ({"a": 1.0}, {"b": 1.0}),
        (partial(max, 1), partial(min, 1)),
        (ElementQuadP(3), ElementQuadP(4)),
        (block_grid(0.5, 1.5, 10.0), block_grid(0.5, 1.5, 11.0)),
    ],
)
def test_other_parts_make_other_values(one, other):
    assert not same(one, other)
    assert Sample(one) != Sample(other)


# --- what the packages show ---


@pytest.mark.parametrize("room", ["laws", "profiles", "scaling", "theories", "atlas"])
def test_a_room_shows_what_is_public_and_nothing_else(room):
    module = getattr(halfspace, room)
    assert sorted(dir(module)) == sorted(module.__all__)
    assert all(getattr(module, name) is not None for name in dir(module))


@pytest.mark.parametrize("package", [halfspace, fem_adhesion])
def test_what_is_public_is_listed_found_and_typed(package):
    assert sorted(dir(package)) == sorted(package.__all__)
    tree = ast.parse(Path(package.__file__).read_text())
    typed = {
        alias.name: node.module
        for block in tree.body
        if isinstance(block, ast.If)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert typed.keys() == set(package.__all__)
    for name, module in typed.items():
        assert getattr(package, name) is getattr(importlib.import_module(module), name)
    with pytest.raises(AttributeError, match="nothing"):
        _ = package.nothing


# --- numbers with errors ---


def test_the_scale_of_approaches_is_the_spacing_and_the_events_range():
    assert approach_scale([-3.0, 1.5, -0.5]) == 5.5
    assert approach_scale([2e-9, -1e-9], 0.2e-9) == pytest.approx(3.2e-9, rel=1e-12, abs=0)


def test_estimates_agree_within_both_errors():
    near, far = Estimate(1.0, 0.25), Estimate(1.75, 0.5)
    assert near.agrees(far)
    assert far.agrees(near)
    assert not near.agrees(Estimate(1.75, 0.25))
    assert not near.agrees(Estimate(float("nan"), 1.0))
    assert Estimate.refined(2.0, 1.5) == Estimate(1.5, 0.5)


@pytest.mark.parametrize("signs", [*itertools.product((-1, 1), repeat=2)], ids=str)
def test_bounds_of_sums_and_products_hold(signs):
    """At the ends of both intervals; what products leave out is the product of both errors."""
    a, b = Estimate(3.0, 1e-4), Estimate(-0.5, 2e-5)
    x, y = (number.value + sign * number.error for number, sign in zip((a, b), signs, strict=True))
    left_out = 10 * a.error * b.error
    for found, exact, more in (
        (a + b, x + y, 1e-15),
        (a - b, x - y, 1e-15),
        (a - 2.0, x - 2.0, 1e-15),
        (abs(b), abs(y), 1e-15),
        (a * b, x * y, left_out),
        (b * -4.0, -4.0 * y, 1e-15),
        (a / b, x / y, 100 * left_out),
    ):
        assert abs(found.value - exact) <= found.error + more
    assert max(abs((a + b).error - (a.error + b.error)), abs((a * b).error - 1.1e-4)) < 1e-16
    assert (Estimate(3.0, 0.0) / Estimate(1.0, 0.5)).error >= 3.0  # 3/0.5 - 3
