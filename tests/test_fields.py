"""Fields inside a body: stresses against closed forms, their order, and states that balance."""

import numpy as np
import pytest
from skfem import ElementQuadP

import fem_adhesion
from fem_adhesion import Scene, stress
from fem_adhesion.condensed import condense
from fem_adhesion.elasticity import Space, lame_parameters
from fem_adhesion.fields import State, require_fields, state_at, states_along
from fem_adhesion.incompressible import projected_stiffness
from fem_adhesion.mesh import tensor_grid
from fem_adhesion.sized import Discretisation
from halfspace import grid

NU = 0.3
ON_AXIS = np.array([[0.2, 0.6], [0.0, 0.0]])  # of cells beside the axis; their first coordinate is the height
PLACES = np.array([[0.2, 0.7, 0.5], [0.4, 0.1, 0.9]])


def space_of(cells, degree):
    lines = np.linspace(0.0, 1.0, cells + 1)
    return Space(tensor_grid(lines, lines), ElementQuadP(degree))


def coefficients(space, field):
    """Least-squares coefficients of a smooth field (r, z) -> (2, ...)."""
    from fem_adhesion.elasticity import cell_quadrature

    points, _ = cell_quadrature(space)
    values = field(*stress.positions(space, points))
    u = np.zeros(space.unknowns)
    u[space.components] = stress.projection(space, values)
    return u


def smooth(r, z):
    return np.array([np.sin(r) * np.exp(z), np.cos(r) * np.exp(2 * z)])


def exact_stress(r, z, poisson=NU):
    lam, G = lame_parameters(poisson)
    rr, zz, hoop = np.cos(r) * np.exp(z), 2 * np.cos(r) * np.exp(2 * z), np.sin(r) / r * np.exp(z)
    shear = np.sin(r) * (np.exp(z) - np.exp(2 * z))
    mean = lam * (rr + zz + hoop)
    return np.array([mean + 2 * G * rr, mean + 2 * G * zz, mean + 2 * G * hoop, G * shear])


def recovery_error(cells, degree):
    space = space_of(cells, degree)
    found = stress.sampled(space, stress.recovered_stresses(space, NU, coefficients(space, smooth)), PLACES)
    return np.abs(found - exact_stress(*stress.positions(space, PLACES))).max()


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_recovered_stress_converges_at_the_order_of_the_gradient_or_better(degree):
    """In the largest error: 1.83, 2.99 and 3.83 here, on the way to the degree."""
    coarse, fine = recovery_error(8, degree), recovery_error(16, degree)
    assert np.log2(coarse / fine) > degree - 0.2
    assert fine < 0.4 * 16.0**-degree


def test_a_uniform_strain_has_its_stress_everywhere_and_on_the_axis():
    space = space_of(2, 3)
    u = coefficients(space, lambda r, z: np.array([0.01 * r, -0.02 * z]))
    _lam, G = lame_parameters(NU)
    wanted = np.array([2 * G * 0.01, -2 * G * 0.02, 2 * G * 0.01, 0.0])
    corners = np.array([[0.0, 1.0], [0.0, 1.0]])  # some of them on the axis
    found = stress.stresses(space, NU, u, corners)
    np.testing.assert_allclose(found, np.broadcast_to(wanted[:, None, None], found.shape), atol=1e-12)
    assert stress.hydrostatic(wanted) == pytest.approx(0.0, abs=1e-15)
    assert stress.von_mises(wanted) == pytest.approx(0.06 * G)
    assert stress.principal(wanted) == pytest.approx([0.02 * G, 0.02 * G, -0.04 * G])
    assert stress.energy_density(wanted, NU) == pytest.approx(G * (2 * 0.01**2 + 0.02**2))


def test_the_projected_dilatation_gives_the_pressure_of_rubber():
    """At poisson 0.4999 the mean stress of the plain displacement is nonsense, that of the projected one is Hertz's."""
    poisson, lines = 0.4999, grid.graded(1.0, 0.1, 40.0, growth=2.0)
    space = Space(tensor_grid(lines, grid.graded(0.0, 0.1, 40.0, growth=2.0)), ElementQuadP(4))
    body = condense(space, poisson, stiffness=projected_stiffness)
    r = body.operator.radii
    u = body.displacement(np.sqrt(np.maximum(1 - r**2, 0)))
    axis = np.abs(stress.positions(space, ON_AXIS)[0]) < 1e-12
    depth = -stress.positions(space, ON_AXIS)[1]
    near = axis & (depth > 0.2) & (depth < 3)
    found = stress.stresses(space, poisson, u, ON_AXIS, projected_dilatation=True)
    wrong = stress.stresses(space, poisson, u, ON_AXIS)
    zeta = depth[near]
    zz = -1 / (1 + zeta**2)  # K. L. Johnson, Contact Mechanics (1985), eq. (3.45), E* irrelevant
    assert np.abs(found[1][near] - zz).max() < 2e-3
    assert np.abs(wrong[1][near] - zz).max() > 10 * np.abs(found[1][near] - zz).max()


@pytest.fixture(scope="module")
def traced():
    scene = Scene(2.0)
    return scene, fem_adhesion.trace(scene, rtol=1e-4)


def test_states_along_a_curve_reproduce_it_through_its_folds(traced):
    scene, path = traced
    found = list(states_along(scene, path, points=9, how=Discretisation(4)))
    assert [state.arclength for state in found] == sorted(state.arclength for state in found)
    assert {state.name for state in found} >= {"pull_off", "jump_on", "jump_off", "zero_load"}
    for state in found:
        if state.name:
            event = path.events[state.name]
            assert state.observables[:2] == pytest.approx([event.approach, event.load], abs=2e-3)
    unstable = [state for state in found if path.event("jump_on").approach > state.observables[0] and not state.stable]
    assert all(state.observables[0] > path.event("jump_off").approach - 1e-2 for state in unstable)


@pytest.mark.parametrize(
    "scene",
    [
        Scene(1.0, poisson=0.45),
        Scene(1.0, body="hemisphere", profile="sphere", radius_ratio=30.0),
        Scene(1.0, body="hemisphere", profile="sphere", radius_ratio=30.0, traction="surface"),
    ],
    ids=["rubbery block", "hemisphere", "traction on the surface"],
)
def test_the_traction_inside_is_the_laws_pressure_also_in_the_spike(scene):
    path = fem_adhesion.trace(scene, rtol=1e-3)
    event = path.stages[-1]["pull_off"]
    state = state_at(scene, event.problem, event.point, name="pull_off")
    assert isinstance(state, State)
    inner = state.radii < 3
    largest = np.abs(state.pressure).max()
    assert np.abs(state.recovered_pressure() - state.pressure)[inner].max() < 5e-3 * largest
    deflection = -(state.surface.values @ state.displacement[state.surface.unknowns])
    height = state.problem.profile.height(state.radii)
    wanted = state.observables[0] + state.gap - scene.tabor * height
    np.testing.assert_allclose(scene.tabor * deflection, wanted, atol=1e-8)


def test_scenes_without_fields_are_refused():
    with pytest.raises(ValueError, match=r'body = "sphere" has no fields here; '):
        require_fields(Scene(1.0, body="sphere", profile="sphere", radius_ratio=30.0))
    with pytest.raises(ValueError, match=r'strain = "finite" has no fields here, limit: small strain; '):
        require_fields(Scene(1.0, body="hemisphere", profile="sphere", radius_ratio=30.0, strain="finite"))
