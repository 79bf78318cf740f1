"""Fields inside the body: stress recovery against closed forms, and states solved for again against their curve."""

import math

import numpy as np
import pytest
from scenes import hemisphere, pair
from scipy.sparse.linalg import spsolve
from skfem import CellBasis, ElementQuad2, ElementQuadP

import fem_adhesion
from fem_adhesion import HeldSphere, Hemisphere, Layer, LinearElastic, NeoHookean, fields
from fem_adhesion.elasticity import stress
from fem_adhesion.elasticity.cells import Cells, cell_quadrature, cell_stiffness, projected_stiffness
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import boussinesq_displacement, boussinesq_stress, point_load
from fem_adhesion.elasticity.space import Space, ring_measure, scatter
from fem_adhesion.elasticity.surface import boundary_points
from fem_adhesion.fields import half_space_beside
from fem_adhesion.materials import Elastic
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.scene import Scene
from halfspace.elastic import grid
from halfspace.laws import Morse
from halfspace.profiles import Power

PLACES = np.stack(np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 5))).reshape(2, -1)


def buried(space, poisson, stiffness=cell_stiffness):
    """Displacement of a block on whose whole boundary that of a point load at a distance of 1 above is imposed."""
    u, held = np.zeros(space.unknowns), np.zeros(space.unknowns, bool)
    for name in ("contact", "far"):
        unknowns = space.components[:, space.boundary_functions(name)]
        trace = boundary_points(space, name, space.degree + 6)
        u[unknowns] = trace.projection(lambda r, z: boussinesq_displacement(r, z - 1, poisson))
        held[unknowns] = True
    axis = space.components[0, space.boundary_functions("axis")]
    u[axis], held[axis] = 0, True
    K = scatter(stiffness(Cells.of(space), poisson), space.cell_dofs, space.unknowns).tocsr()
    u[~held] = spsolve(K[~held][:, ~held].tocsc(), -K[~held] @ u)
    return u


def recovery_error(element, cells, poisson=0.3, projected=False):
    """Root mean square error of the recovered stress, relative to the largest stress."""
    lines = 2 * np.linspace(0, 1, cells + 1)
    space = Space(tensor_grid(lines, lines), element)
    u = buried(space, poisson, projected_stiffness if projected else cell_stiffness)
    cells_of = Cells.of(space)
    inside = stress.stresses(cells_of, poisson, u, projected_dilatation=projected)
    found = stress.sampled(space, stress.projection(cells_of, inside), PLACES)
    r, z = stress.positions(space, PLACES)
    exact = boussinesq_stress(r, z - 1, poisson)
    return np.sqrt(np.mean((found - exact) ** 2)) / np.abs(exact).max()


@pytest.mark.parametrize(("element", "order"), [(ElementQuad2(), 2), (ElementQuadP(4), 4)])
def test_recovered_stress_converges_with_the_elements_order(element, order):
    coarse, fine = (recovery_error(element, cells) for cells in (8, 16))
    assert np.log2(coarse / fine) > order - 0.2


def test_recovered_stress_holds_near_incompressibility():
    assert recovery_error(ElementQuadP(4), 8, 0.4999, projected=True) < 2e-5
    assert recovery_error(ElementQuadP(4), 8, 0.4999) > 1e-4  # what is left if the dilatation is not projected


def test_hertz_stress_on_the_axis():
    """Johnson (1985), eqs (3.45): zz = -1/(1 + s^2), rr = -(1 + nu)(1 - s arctan 1/s) + 1/(2 (1 + s^2))."""
    nu, depths = 0.3, np.array([0.1, 0.3, 0.5, 1.0, 2.0])
    lines, z_lines = grid.graded(1.0, 0.02, 100.0), grid.graded(0.0, 0.02, 100.0)
    z_lines = np.unique(np.concatenate([z_lines, depths]))
    body = condense(Space(tensor_grid(lines, z_lines), ElementQuadP(5)), nu, far_field=point_load)
    pressure = np.sqrt(np.maximum(1 - body.operator.radii**2, 0))
    _, _, coefficients = stress.recovered_stresses(body.space, [Elastic(nu)], body.displacement(pressure))
    r, z = stress.positions(body.space, PLACES)
    values = stress.sampled(body.space, coefficients, PLACES)
    for s in depths:
        here = (r == 0) & (np.abs(z + s) < 1e-9)
        rr, zz, hoop, rz = values[:, here].mean(axis=1)
        radial = -(1 + nu) * (1 - s * np.arctan(1 / s)) + 0.5 / (1 + s**2)
        assert (rr, zz, hoop, rz) == pytest.approx((radial, -1 / (1 + s**2), radial, 0), abs=2e-4)


# --- states ---


def test_states_are_those_of_the_curve_through_its_folds():
    path = fem_adhesion.trace(Scene(5.0), rtol=1e-3)
    states = list(fields.states_along(Scene(5.0), path, points=4))
    assert [s.name for s in states if s.name] == ["jump_on", "jump_off", "pull_off", "zero_load"]
    assert np.all(np.diff([s.point.arclength for s in states]) > 0)
    for state in states:
        if state.name:
            wanted = path.stages[-1][state.name].point.observables
            np.testing.assert_allclose(state.observables, wanted, atol=2e-3)
        else:
            nearest = np.abs(path.arclength - state.point.arclength).argmin()
            assert state.observables[:2] == pytest.approx([path.approach[nearest], path.load[nearest]], abs=5e-3)
            assert state.stable == path.stable[nearest]
            assert state.stable_under_dead_load == path.stable_under_dead_load[nearest]
        error = np.abs(state.recovered_traction() - state.traction)
        assert np.max(error) < 3e-4 * np.max(np.abs(state.pressure))
        np.testing.assert_array_equal(state.traction, state.pressure)  # on a flat surface


@pytest.mark.parametrize(("radius_ratio", "poisson", "grip"), [(10.0, 0.45, "bonded"), (40.0, 0.3, "sliding")])
def test_traction_of_the_stress_is_the_laws_up_to_the_equator(radius_ratio, poisson, grip):
    """Where the surface is upright and what is on its projected area is nothing; in a singular corner it is none."""
    scene = hemisphere(1.0, radius_ratio, poisson=poisson, grip=grip)
    for state in fields.states_along(scene, fem_adhesion.trace(scene, rtol=1e-3), points=0):
        r, largest = state.surface.radii / scene.sphere_radius, np.max(np.abs(state.pressure))
        error = np.abs(state.recovered_traction() - state.traction) / largest
        assert np.nanmax(error) < 5e-4
        np.testing.assert_array_equal(np.isnan(error), (r > math.cos(0.0779)) if grip == "bonded" else False)
        np.testing.assert_allclose(state.traction, state.pressure * np.sqrt(1 - r**2), atol=1e-6 * largest)


def test_traction_per_true_area_is_that_of_the_stress():
    """Where the surface is steep, and still away from the corner at the mid-plane; R is 3.2 beta."""
    scene = Scene(1.0, Hemisphere(radius_ratio=10.0, material=LinearElastic(0.3, "surface")))
    for state in fields.states_along(scene, fem_adhesion.trace(scene, rtol=1e-2), points=0):
        steep = (state.surface.radii > 1.0) & (state.surface.radii < 2.5)
        error = np.abs(state.recovered_traction() - state.traction)[steep]
        assert np.max(error) < 5e-3 * np.max(np.abs(state.pressure[steep]))


@pytest.mark.parametrize(
    "scene",
    [Scene(1.0, Layer(2.0)), Scene(1.0, law=Morse(3.0)), Scene(1.0, profile=Power(4))],
    ids=["strata", "law", "profile"],
)
def test_the_half_space_beside_has_the_scenes_parts(scene):
    for state in fields.states_along(scene, fem_adhesion.trace(scene, rtol=1e-3), points=0):
        assert half_space_beside(state).observables[:2] == pytest.approx(state.observables[:2], abs=2e-3)


def energy_inside(state):
    """Energy in the body, in E* beta^5/R^2, from the recovered stress."""
    points = cell_quadrature(state.space)
    basis = CellBasis(state.space.mesh, state.space.element, quadrature=points, disable_doflocs=True)
    density = stress.energy_density(stress.sampled(state.space, state.stress, points[0]), state.scene.poisson)
    return state.share * np.sum(density * ring_measure(np.asarray(basis.global_coordinates())[0]) * basis.dx)


def test_the_energy_of_the_stress_is_the_work_of_the_pressure():
    scene = hemisphere(1.0, 100.0, poisson=0.49)
    for state in fields.states_along(scene, fem_adhesion.trace(scene, rtol=1e-2), points=0):
        functions = state.space.boundary_functions("contact")
        deflection = -(state.surface.values @ state.components[1, functions])
        work = np.sum(state.surface.weights() * state.pressure * deflection) / 2
        assert energy_inside(state) == pytest.approx(work, rel=1e-4)


def test_two_bodies_share_the_energy_by_their_compliance():
    scene = pair(1.0, 100.0, 0.25)
    path = fem_adhesion.trace(scene, rtol=1e-1)
    zero_load = path.stages[-1]["zero_load"]
    state = fields.state_at(scene, zero_load.problem, zero_load.point)
    functions = state.space.boundary_functions("contact")
    own = -(state.surface.values @ state.components[1, functions])
    both = (state.gap + state.observables[0]) / scene.tabor - state.problem.profile.height(state.surface.radii)
    weighted = state.surface.weights() * state.pressure / 2
    assert energy_inside(state) == pytest.approx(weighted @ own, rel=1e-4)
    assert weighted @ own == pytest.approx(0.75 * (weighted @ both), rel=0.01)  # but for the shapes of the bodies


@pytest.mark.parametrize(
    "body", [Hemisphere(radius_ratio=100.0, material=NeoHookean()), HeldSphere(radius_ratio=100.0)], ids=type
)
def test_bodies_without_fields_are_refused(body):
    with pytest.raises(ValueError, match="no fields here"):
        list(fields.states_along(Scene(1.0, body), None))
