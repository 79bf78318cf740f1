"""Scenes of bodies with a length: what they refuse, and a sphere over the half-space by both solvers."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import truths
from families import of_path
from scenes import pair

import halfspace
from fem_adhesion import Block, HalfSpace, HeldSphere, Hemisphere, LinearElastic, Meshed, NeoHookean, Scene
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import sized_body
from halfspace import Coated
from halfspace.accuracy.grids import resolution_for
from halfspace.accuracy.layered import layered_body
from halfspace.accuracy.standing import standing
from halfspace.elastic.layered import images_of
from halfspace.equilibrium.charts import moved
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.states import met_again
from halfspace.errors import InputError, Unsolved
from halfspace.profiles import PARABOLOID, Paraboloid, Sphere
from halfspace.scales import Scales

HEMISPHERE = Scene(1.0, Hemisphere(radius_ratio=30.0))


def body(of=Hemisphere, tabor=1.0, radius_ratio=30.0, **more):
    return lambda: Scene(tabor, of(radius_ratio=radius_ratio, **more))


def against(counter, share=0.5, of=HEMISPHERE.body):
    return lambda: Scene(1.0, of, counter=counter, share=share)


REFUSED = [
    (lambda: Scene(0.0), "tabor = 0 is outside 0 < tabor"),
    (lambda: Scene(301.0), "tabor = 301 is outside tabor <= 300"),
    (body(poisson=0.5), "poisson = 0.5 is outside 0 <= poisson < 0.5"),
    (body(poisson=0.2, material=NeoHookean(0.3)), "give one of them, not both"),
    (lambda: Scene(1.0, "cube"), "body = 'cube' is no body; take fem_adhesion.Hemisphere"),
    (lambda: Scene(1.0, Path("body.msh")), "is no body"),
    (lambda: Scene(1.0, HEMISPHERE.body, counter="cube", share=0.5), "counter = 'cube' is no body"),
    (body(grip="glued"), "grip = 'glued' is not one of sliding, bonded"),
    (lambda: Scene(1.0, Meshed("any.msh", radius_ratio=30.0), Sphere(30.0)), "does not go with meshed"),
    (lambda: LinearElastic(traction="normal"), "traction = 'normal' is not one of projected, surface"),
    (lambda: NeoHookean(traction="surface"), "traction = 'surface' is not one of projected, reference"),
    (lambda: Block(radius=50.0, far_field="hinged"), "far_field = 'hinged' is not one of point_load, clamped, free"),
    (body(radius_ratio=None), "radius_ratio = None of type NoneType, limit: a real number"),
    (body(radius_ratio=1.9), "radius_ratio = 1.9 is outside 2 <= radius_ratio"),
    (body(radius_ratio=float("nan")), "radius_ratio = nan"),
    (body(tabor=10.0, radius_ratio=22.0), "radius_ratio = 22 is outside 2.25 tabor = 22.5 or more"),
    (lambda: Scene(10.0, profile=Sphere(22.0)), "radius_ratio = 22 is outside 2.25 tabor = 22.5 or more"),
    (body(HeldSphere, cap_angle=0.5), "cap_angle = 0.5 is outside 1 <= cap_angle <= 89.99 and is not 90"),
    (lambda: Scene(1.0, Block(radius=50.0), Sphere(30.0)), "does not go with block; take a half-space"),
    (against(HalfSpace(), of=HeldSphere(radius_ratio=30.0)), "does not go with body = held-sphere"),
    (against(HalfSpace(), of=HalfSpace()), "does not go with body = half-space"),
    (against(HeldSphere(radius_ratio=60.0)), "counter = held-sphere does not go with"),
    (against(HalfSpace(), of=Hemisphere(radius_ratio=30.0, material=NeoHookean())), "does not go with material"),
    (against(HalfSpace(), of=Hemisphere(radius_ratio=30.0, material=LinearElastic(0.3, "surface"))), "surface"),
    (lambda: HalfSpace(material=NeoHookean()), "does not go with half-space"),
    (lambda: HalfSpace(material=LinearElastic(traction="surface")), "traction = surface does not go with half-space"),
    (against(HalfSpace(), 0.0), "share = 0 is outside 0 < share < 1"),
    (against(HalfSpace(), None), "share = None of type NoneType, limit: a real number"),
    (against(None), "share = 0.5 without a counter-body"),
    (against(Hemisphere(radius_ratio=15.0)), "radius_ratio = 15 of the counter-body is outside 30 <= radius_ratio"),
]


@pytest.mark.parametrize(("make", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_a_scene_that_cannot_be_is_refused_with_value_limit_and_remedy(make, message):
    with pytest.raises(InputError, match=re.escape(message)) as refusal:
        make()
    text = str(refusal.value)
    assert "\n" not in text
    assert ";" in text  # after it, the remedy or the reason


def test_a_scene_says_how_long_its_bodies_are():
    """The R/eps of a pair is that of both, and its bodies have their own in the units of the pair."""
    scene = pair(1.0, 30.0, 0.4, 0.45, 3.0)
    assert (scene.body.radius_ratio, scene.counter.radius_ratio) == (40.0, 120.0)
    assert scene.radius_ratio == pytest.approx(30.0, rel=1e-14)
    assert scene.radii == pytest.approx([np.sqrt(30.0) * 4 / 3, np.sqrt(30.0) * 4], rel=1e-14)
    assert scene.surface.end == pytest.approx(scene.radii[0], rel=1e-14)
    endless = Scene(1.0, Block(radius=50.0))
    assert (endless.sized, endless.sphere_radius, endless.radius_ratio) == (False, np.inf, None)


def test_a_poissons_ratio_is_short_for_a_material():
    assert HalfSpace(poisson=0.45) == HalfSpace(material=LinearElastic(0.45))
    assert HalfSpace(poisson=0.45, material=LinearElastic(0.45)).material.poisson == 0.45
    assert replace(HalfSpace(poisson=0.45), material=LinearElastic(0.2)).material.poisson == 0.2
    assert replace(Hemisphere(radius_ratio=30.0, poisson=0.45), grip="bonded").material.poisson == 0.45


def test_a_surface_ends_where_its_body_does():
    """The paraboloid over a hemisphere is one up to the equator."""
    scene = Scene(3.0, Hemisphere(radius_ratio=30.0), Paraboloid())
    assert scene.surface.end == pytest.approx(np.sqrt(30.0 / 3.0))
    radii = np.linspace(0, 1, 5)
    np.testing.assert_array_equal(scene.surface.height(radii), radii**2 / 2)
    np.testing.assert_array_equal(scene.surface.slope(radii), radii)


def test_the_vertical_tangent_at_the_equator_leaves_no_more_than_the_estimates():
    """The attraction reaches the equator: at rtol 1e-9 cells that were long beside it left four times as much."""
    path = halfspace.trace(1.0, profile=Sphere(6.0), rtol=1e-9)
    rough, best = map(truths.of_state, truths.relocated(path.stages[-1], truths.under_sphere(1.0, 6.0)))
    told = of_path(path)
    assert len(told) == 15
    for what, number in told.items():
        assert abs(number.value - best[what]) <= number.error + abs(rough[what] - best[what]), what


def test_meshes_for_one_chart_have_the_same_cells():
    """By a layer of cells more or less the operators would differ by 1e-7, and so would what lies between them."""
    body = sized_body(Scene(1.0, Hemisphere(radius_ratio=60.0)), Discretisation(6))
    operator = body.over((0.9, 1.6), [9], 1.6).problem.operator
    assert len({body.make(operator.grid.lines(a))[1] for a in operator.scales}) == 1
    exact = body.make(operator.grid.lines(1.3))[0]
    pressure = np.exp(-(exact.radii**2))
    assert np.abs((operator.at(1.3).compliance - exact.compliance) @ pressure).max() < 1e-9


def test_operators_on_a_stiff_coating_are_known_between_their_radii():
    """By fewer than its yield asks for they were a hundred times worse: a curve rippled, its points had no errors."""
    scales = Scales(4.0, profile=Sphere(20.0, 1.0).surface(4.0), body=Coated(0.5, 100.0))
    body = layered_body(scales, images_of(scales.body), resolution_for(scales, 1e-3))
    operator = body.curve(1e-3)[1].problem.operator
    known = operator.kernel.lengths[0]
    for a in np.sqrt(known[1:] * known[:-1])[::3]:
        exact, pressure = body.make(operator.grid.lines(a))[0], np.exp(-((operator.at(a).radii / a) ** 2))
        off = (operator.at(a).compliance - exact.compliance) @ pressure
        assert np.abs(off).max() < 2e-9 * np.abs(exact.compliance @ pressure).max()


def test_the_tightest_tolerance_is_met_under_a_sphere():
    """Between nodes crowding at the equator a polynomial of the radius ran wild, and led to where surfaces overlap."""
    path = halfspace.trace(0.8, profile=Sphere(8.0), rtol=1e-9)
    assert path.met
    assert path.event("jump_on").load == pytest.approx(-2.28260161226, abs=2e-10)


def test_the_sphere_tends_to_the_paraboloid_as_one_over_rho():
    profiles = PARABOLOID, Sphere(10.0), Sphere(100.0)
    paths = [halfspace.trace(1.0, profile=profile, rtol=1e-5) for profile in profiles]
    for name in ("pull_off", "jump_on", "jump_off"):
        at_all, *spheres = (np.array([path.event(name).approach, path.event(name).load]) for path in paths)
        far, near = (sphere - at_all for sphere in spheres)
        assert np.log10(np.abs(far / near)) == pytest.approx([1.0, 1.0], abs=0.1)


def test_an_event_that_its_own_grid_does_not_give_is_found_near_there_by_few_operators(monkeypatch):
    scene, made = Scene(1.0, profile=Sphere(30.0)), []
    body = sized_body(scene, Discretisation(5))
    event = halfspace.trace(1.0, profile=Sphere(30.0), rtol=1e-3).stages[-1]["pull_off"]
    expected = met_again(standing(body, 1e-8), event).point.observables

    def on_what_follows(event, problem):
        follows = problem.interface.follows_contact
        return moved(event, problem) if follows else Unsolved("no convergence")

    monkeypatch.setattr("halfspace.accuracy.standing.moved", on_what_follows)
    counted = replace(body, make=lambda lines: made.append(lines) or body.make(lines))
    found = met_again(standing(counted, 1e-8), event)
    np.testing.assert_allclose(found.point.observables, expected, atol=2e-5)  # the cells are others, of degree 5
    assert found.problem.interface.follows_contact
    assert len(made) < 10


def test_an_event_that_leaves_the_finest_cells_of_its_grid_is_found_where_it_is():
    """From radii 3 to 50 % off it stayed between longer ones, on one grid after another: by up to 1.8 eps."""
    scene = Scene(12.0, profile=Sphere(300.0))
    body = sized_body(scene, Discretisation(4))
    event = halfspace.trace(**scene.for_half_space, rtol=1e-3).stages[-1]["zero_load"]
    expected = met_again(standing(body, 1e-8), event).point.observables
    for part in (0.5, 0.6, 0.97, 1.03):
        apart = moved(event, body.standing(part * event.point.observables[CONTACT_RADIUS]).problem)
        found = met_again(standing(body, 1e-8), apart)
        assert not found.followed
        np.testing.assert_allclose(found.point.observables, expected, rtol=0, atol=2e-6)
