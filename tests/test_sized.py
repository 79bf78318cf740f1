"""Scenes of bodies with a length: what they refuse, and a sphere over the half-space by both solvers."""

import re
from pathlib import Path
from types import SimpleNamespace

import honesty
import numpy as np
import pytest
import truths

import fem_adhesion
import halfspace
from fem_adhesion import Scene
from fem_adhesion.bodies.sized import Discretisation, sized_body
from fem_adhesion.scene import Counter
from halfspace.accuracy.finite_bodies import AroundEvents, surroundings
from halfspace.accuracy.trace import _sized_body, resolution_for
from halfspace.elastic import compliance, grid
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.curve import Chart, moved
from halfspace.equilibrium.devices import cycle
from halfspace.profiles import PARABOLOID, Sphere
from halfspace.profiles.sphere import between_spheres
from halfspace.scales import Scales

HEMISPHERE = {"tabor": 1.0, "body": "hemisphere", "profile": "sphere", "radius_ratio": 30.0}

REFUSED = [
    ({"tabor": 0.0}, "tabor = 0 is outside 0 < tabor"),
    ({"tabor": 301.0}, "tabor = 301 is outside tabor <= 300"),
    ({"tabor": float("nan")}, "tabor = nan"),
    ({"poisson": 0.5}, "poisson = 0.5 is outside 0 <= poisson < 0.5"),
    ({"poisson": -0.1}, "poisson = -0.1"),
    ({"body": "cube"}, "body = 'cube' is not one of block, hemisphere, sphere"),
    ({"body": "body.msh"}, "pathlib.Path"),
    ({"profile": "cone"}, "profile = 'cone' is not one of paraboloid, sphere"),
    ({"grip": "glued"}, "grip = 'glued' is not one of sliding, bonded"),
    ({"body": Path("any.msh")}, "profile = sphere does not go with"),
    ({"traction": "tilted"}, "traction = 'tilted' is not one of projected, surface, reference, normal, vertical"),
    ({"strain": "large"}, "strain = 'large' is not one of small, finite"),
    ({"far_field": "hinged"}, "far_field = 'hinged' is not one of point_load, clamped, free"),
    ({"radius_ratio": None}, 'radius_ratio = None for body = "hemisphere" and profile = "sphere", limit: a number'),
    ({"body": "block", "radius_ratio": None}, 'radius_ratio = None for body = "block" and profile = "sphere"'),
    ({"body": "block", "profile": "paraboloid"}, "radius_ratio = 30 means nothing to a block under a paraboloid"),
    ({"radius_ratio": 1.9}, "radius_ratio = 1.9 is outside 2 <= radius_ratio"),
    ({"radius_ratio": 1e13}, "outside 2 <= radius_ratio <= 1e12"),
    ({"radius_ratio": float("nan")}, "radius_ratio = nan"),
    ({"radius_ratio": float("inf")}, "radius_ratio = inf"),
    ({"tabor": 10.0, "radius_ratio": 22.0}, "radius_ratio = 22 is outside 2.25 tabor = 22.5 or more"),
    ({"cap_angle": 0.5}, "cap_angle = 0.5 is outside 1 <= cap_angle <= 89.99 and is not 90"),
    ({"cap_angle": 91.0}, "cap_angle = 91"),
    ({"radius": 50.0}, "radius = 50.0 does not go with"),
    ({"far_field": "clamped"}, "far_field = clamped does not go with"),
    ({"body": "sphere", "counter": Counter(0.5)}, "does not go with"),
    ({"body": "block", "counter": Counter(0.5)}, "does not go with"),
    ({"body": "block", "strain": "finite"}, "strain = finite does not go with"),
    ({"body": "block", "traction": "surface"}, "traction = surface does not go with"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED, ids=lambda x: x if isinstance(x, str) else "")
def test_a_scene_that_cannot_be_is_refused_with_value_limit_and_remedy(options, message):
    with pytest.raises(ValueError, match=re.escape(message)) as refusal:
        Scene(**(HEMISPHERE | options))
    text = str(refusal.value)
    assert "\n" not in text
    assert ";" in text  # after it, the remedy or the reason


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"share": 0.0}, "share = 0 is outside 0 < share < 1"),
        ({"share": 1.0}, "share = 1 is outside 0 < share < 1"),
        ({"share": 0.5, "radius": 0.5}, "radius = 0.5 of the counter-body is outside 1 <= radius"),
        ({"share": 0.5, "poisson": 0.5}, "poisson = 0.5"),
    ],
)
def test_a_counter_body_that_cannot_be_is_refused(options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        Counter(**options)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"profile": "paraboloid"},
        {"grip": "bonded", "traction": "surface"},
        {"body": "sphere", "cap_angle": 90.0},
        {"body": "block"},
        {"body": Path("any.msh"), "profile": "paraboloid"},
        {"counter": Counter(0.5)},
        {"strain": "finite"},
        {"tabor": 10.0, "radius_ratio": 22.5},
    ],
)
def test_a_scene_that_can_be_is_not_refused(options):
    scene = Scene(**(HEMISPHERE | options))
    assert scene.sized
    assert scene.sphere_radius == pytest.approx(np.sqrt(scene.radius_ratio / scene.tabor))


def test_the_half_space_under_a_paraboloid_has_no_length():
    assert not Scene(1.0).sized
    assert Scene(1.0).sphere_radius == np.inf


@pytest.mark.parametrize("rtol", [0.0, 1.0, float("nan")])
def test_a_tolerance_out_of_range_is_refused_before_any_work(rtol):
    with pytest.raises(ValueError, match="rtol"):
        fem_adhesion.trace(Scene(**HEMISPHERE), rtol=rtol)


@pytest.mark.parametrize("radius_ratio", [1.0, 2.0, float("nan")])
def test_the_half_space_refuses_a_sphere_too_small(radius_ratio):
    with pytest.raises(ValueError, match="radius_ratio"):
        halfspace.trace(1.0, profile=Sphere(radius_ratio))


@pytest.fixture(scope="module")
def spheres():
    """The half-space under true spheres, by R/eps; None is the paraboloid."""
    profiles = {None: PARABOLOID, 10.0: Sphere(10.0), 100.0: Sphere(100.0)}
    return {rho: halfspace.trace(1.0, profile=profile, rtol=1e-5) for rho, profile in profiles.items()}


@pytest.mark.parametrize("name", ["pull_off", "jump_on", "jump_off"])
def test_the_half_space_under_a_sphere_has_the_events_of_finite_elements(spheres, block, name):
    """Both solve the same equations for each event, on grids and by operators of their own."""
    event = spheres[10.0].event(name)
    approach, load = block[name]
    assert abs(event.approach - approach) <= event.approach_error + 3e-6 * (1 + abs(approach))
    assert abs(event.load - load) <= event.load_error + 3e-6 * abs(load)


@pytest.fixture(scope="module")
def block(spheres):
    scene = Scene(1.0, profile="sphere", radius_ratio=10.0)
    stage = AroundEvents(sized_body(scene, Discretisation(6)))
    found = spheres[10.0].stages[-1]
    names = ("pull_off", "jump_on", "jump_off")
    states = {name: moved(found[name], stage(found[name]).problem) for name in names}
    return {name: state.point.observables[:2] for name, state in states.items()}


@pytest.fixture(scope="module")
def small():
    """A sphere on the half-space whose equator the attraction reaches, and what its events are."""
    path = halfspace.trace(1.0, profile=Sphere(6.0), rtol=1e-9)
    return path, truths.relocated(path.stages[-1], truths.under_sphere(1.0, 6.0))


def test_the_vertical_tangent_at_the_equator_leaves_no_more_than_the_estimates(small):
    """At rtol 1e-9 cells that were long beside the equator left four times as much."""
    path, states = small
    rough, best = map(honesty.of_state, states)
    told = honesty.of_path(path)
    assert len(told) == 15
    for what, number in told.items():
        assert abs(number.value - best[what]) <= number.error + abs(rough[what] - best[what]), what


def test_a_degree_more_leaves_a_tenth_where_the_attraction_of_a_block_ends_with_the_sphere(small):
    """A quarter, where cells that are long beside the equator carry the root in its profile."""
    (_, states), scene = small, Scene(1.0, profile="sphere", radius_ratio=6.0)
    event = states[-1]["jump_on"]
    stages = [truths.Standing(sized_body(scene, Discretisation(degree))) for degree in (4, 5)]
    found = [moved(event, stage(event).problem).point.observables for stage in stages]
    fourth, fifth = (np.abs(observables - event.point.observables)[:3] for observables in found)
    assert np.all(fifth < fourth / 10)


@pytest.mark.parametrize(("part", "shared"), [(0.99, True), (1.01, False)])
def test_events_share_an_operator_within_its_window_alone(part, shared):
    """Beyond it the operator is extrapolated, and the error estimate could not tell."""
    made = []
    body = SimpleNamespace(around=lambda radius, window, count: made.append((radius, window, count)) or Chart(None, 1))
    stage = AroundEvents(body, window=2e-3, count=5)
    problem = ContactProblem(Homogeneous(compliance.panels(grid.graded(1.0, 0.5, 10.0), 4)), 1.0)
    for radius in (1.0, 1.0 + part * 2e-3):
        observables = np.array([0.0, 0.0, 0.0, radius])
        stage(SimpleNamespace(problem=problem, point=SimpleNamespace(observables=observables)))
    assert len(made) == (1 if shared else 2)
    assert {(window, count) for _, window, count in made} == {(2e-3, 5)}


def test_the_derivative_of_an_operator_around_an_event_is_as_good_as_the_tolerance():
    """By which a fold is found; against differences of whole operators over ever narrower windows, extrapolated."""
    scales = Scales(2.0, profile=between_spheres(np.sqrt(5.0), np.inf))
    body = _sized_body(scales, None, resolution_for(scales, 1e-8))
    pressure = -np.exp(-8 * (body.around(1.18).problem.operator.at(1.18).radii / 1.18 - 1) ** 2)

    def derivative(window, count):
        return body.around(1.18, window, count).problem.operator.rates(1.18, pressure)[2]

    wide, middle, narrow = (derivative(window, 2) for window in (4e-2, 2e-2, 1e-2))
    exact = (64 * narrow - 20 * middle + wide) / 45
    errors = {rtol: np.abs(derivative(*surroundings(rtol, 1)) - exact).max() for rtol in (1e-6, 1e-9)}
    assert 1e-9 < errors[1e-6] < 1e-6
    assert errors[1e-9] < 1e-10


@pytest.fixture(scope="module")
def tight():
    return halfspace.trace(2.0, profile=Sphere(10.0), rtol=1e-9)


def test_the_tightest_tolerance_is_met_under_a_sphere(tight):
    """The approach at pull-off, the place of a flat extremum, is from operators four times as wide apart."""
    assert tight.met
    assert tight.missed == {}
    pull_off = tight.event("pull_off")
    assert abs(pull_off.approach - -2.083525446222) <= pull_off.approach_error < 1e-9
    folding = halfspace.trace(0.8, profile=Sphere(8.0), rtol=1e-9)  # whose folds are near, and flat
    assert folding.met


def test_jumps_of_a_spring_on_a_sphere_are_as_accurate_as_its_events(tight):
    rough = halfspace.trace(2.0, profile=Sphere(10.0), rtol=1e-5)
    for stiffness in (np.inf, 0.5):
        found, truth = (cycle(path, stiffness) for path in (rough, tight))
        assert found.met
        for ours, exact in ((found.jump_on, truth.jump_on), (found.jump_off, truth.jump_off)):
            for state, known in ((ours.take_off, exact.take_off), (ours.landing, exact.landing)):
                assert abs(state.approach - known.approach) <= state.approach_error + known.approach_error
                assert abs(state.load - known.load) <= state.load_error + known.load_error
            assert abs(ours.energy.value - exact.energy.value) <= ours.energy.error + exact.energy.error


def test_the_sphere_tends_to_the_paraboloid_as_one_over_rho(spheres):
    for name in ("pull_off", "jump_on", "jump_off"):
        far, near = (from_paraboloid(spheres, rho, name) for rho in (10.0, 100.0))
        assert np.log10(np.abs(far / near)) == pytest.approx([1.0, 1.0], abs=0.1)


def from_paraboloid(spheres, rho, name):
    """Approach and load of an event less those of the paraboloid."""
    sphere, paraboloid = spheres[rho].event(name), spheres[None].event(name)
    return np.array([sphere.approach - paraboloid.approach, sphere.load - paraboloid.load])


@pytest.mark.parametrize("ratio", [1.0, 3.0, 100.0])
def test_the_gap_between_two_spheres_ends_with_the_smaller_one(ratio):
    gap = between_spheres(5.0, ratio)
    smaller = 5.0 * (1 + 1 / ratio)
    assert gap.end == pytest.approx(smaller)
    r = np.array([0.0, 0.3, 0.9]) * smaller
    heights = sum(R - np.sqrt(R**2 - r**2) for R in (smaller, 5.0 * (1 + ratio)))
    np.testing.assert_allclose(gap.height(r), 5.0 * heights, rtol=1e-12, atol=1e-12)
