"""The hemisphere of finite elements: its shape, uniform states, and an elastic sphere in Legendre polynomials."""

import numpy as np
import pytest
from facets import boundary_basis, far_reaction
from references import strain_energy
from skfem import CellBasis, ElementQuadP
from whole_sphere import sphere_operator, surface_deflection

import fem_adhesion
from fem_adhesion import Block, Scene
from fem_adhesion.elasticity.cells import cell_quadrature, cell_stiffness, stiffness_of
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, sliding
from fem_adhesion.elasticity.space import Space, ring_measure, scatter
from fem_adhesion.harmonics import legendre
from fem_adhesion.materials import Elastic
from fem_adhesion.mesh import curved, spheres
from halfspace.elastic import grid
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.profiles.formulas import SphereSurface

R = 2.5
GRIPS = {"sliding": sliding, "bonded": clamped}


def space(degree, *, finest=0.15, growth=2.0):
    """Hemisphere graded to the pole with cells of a length there, in R."""
    lines, depths = (grid.graded(0.0, finest * R, size * R, growth=growth) for size in (spheres.CORE, spheres.DEPTH))
    return Space(spheres.hemisphere(R, lines, depths), ElementQuadP(degree))


def condensed(degree, poisson=0.3, grip="sliding", traction="projected", **mesh):
    body = space(degree, **mesh)
    K = stiffness_of(body, [Elastic(poisson)])
    return condense(body, poisson, far_field=GRIPS[grip], stiffness=K, traction=traction)


def gaussian(radii):
    return np.exp(-8 * (radii / R) ** 2)


def cosine(radii):
    return np.sqrt((1 - radii / R) * (1 + radii / R))


@pytest.fixture(scope="module")
def fine():
    return space(10)


def test_volume(fine):
    points = cell_quadrature(fine)
    basis = CellBasis(fine.mesh, fine.element, quadrature=points, disable_doflocs=True)
    volume = np.sum(ring_measure(basis.global_coordinates()[0]) * basis.dx)
    assert volume == pytest.approx(2 / 3 * np.pi * R**3, rel=1e-9)


@pytest.mark.parametrize(("traction", "area"), [("projected", 1), ("surface", 2)])
def test_areas(traction, area):
    weights = condensed(6, traction=traction).operator.weights
    assert np.sum(weights) == pytest.approx(area * np.pi * R**2, rel=1e-9)


def test_the_mid_plane_is_flat_and_the_axis_straight(fine):
    assert np.max(np.abs(surface_points(fine, "far")[1] + R)) < 1e-12 * R
    assert np.max(np.abs(surface_points(fine, "axis")[0])) < 1e-15 * R


def test_the_contact_surface_is_the_sphere_below_the_wall(fine):
    r, z = surface_points(fine, "contact")
    assert np.max(np.abs(np.hypot(r, z + R) - R)) < 1e-8 * R
    inside = r < 0.9 * R  # the profile has a vertical tangent at the equator
    assert np.max(np.abs(z + SphereSurface(R).height(r * inside) / R)[inside]) < 1e-8 * R
    assert np.max(z) < 0


def test_the_boundaries_are_whole(fine):
    named = np.concatenate(list(fine.mesh.boundaries.values()))
    np.testing.assert_array_equal(np.sort(named), np.sort(fine.mesh.boundary_facets()))


def test_normals_point_out_of_the_body(fine):
    basis = boundary_basis(fine, "contact", 8)
    r, z = basis.global_coordinates()
    np.testing.assert_allclose(np.asarray(basis.normals), np.array([r, z + R]) / R, atol=1e-7)


def test_the_meridian_map_is_that_of_the_sphere():
    x = np.linspace(0.01, 2 * R, 50)
    r, z = spheres.stereographic(x + 0j, R)
    np.testing.assert_allclose(np.hypot(r, z + R), R, rtol=1e-14)
    radius, slope = SurfaceCoordinate(R).radius(x)
    np.testing.assert_allclose(radius, r, rtol=1e-14)
    h = 1e-5
    ahead, behind = (SurfaceCoordinate(R).radius(x + s)[0] for s in (h, -h))
    np.testing.assert_allclose(slope, (ahead - behind) / (2 * h), atol=1e-9)


@pytest.mark.parametrize("area", ["projected", "surface"])
def test_the_density_of_a_ring_and_its_derivative(area):
    x, h = np.linspace(0.01, 2 * R, 50), 1e-5
    coordinate = SurfaceCoordinate(R, area)
    (r, slope), (ring, bend) = coordinate.radius(x), coordinate.ring(x)
    arc = slope if area == "projected" else 1 / (1 + (x / (2 * R)) ** 2)  # dr/dx or ds/dx
    np.testing.assert_allclose(ring, r * arc, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(bend, (coordinate.ring(x + h)[0] - coordinate.ring(x - h)[0]) / (2 * h), atol=1e-9)
    np.testing.assert_allclose([coordinate.of(float(v)) for v in r[:-1]], x[:-1], rtol=1e-7)


def surface_points(body, name):
    return boundary_basis(body, name, 8).global_coordinates()


# Linear displacements are in the space of cells whose shape has the element's degree or less.


@pytest.fixture(scope="module")
def patch():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(curved, "DEGREE", 4)  # so that quadrature is exact, which curved cells of 8 would not let it be
        return space(8)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.49])
def test_no_force_is_left_inside(patch, poisson):
    """Hydrostatic, uniaxial along the axis, and equal biaxial across it."""
    basis = CellBasis(patch.mesh, patch.element, dofs=patch.scalar_dofs, quadrature=cell_quadrature(patch))
    r, z = basis.project(lambda x: x[0]), basis.project(lambda x: x[1])
    K = scatter(cell_stiffness(patch, poisson), patch.cell_dofs, patch.unknowns)
    outside = [patch.components[:, patch.boundary_functions(name)] for name in ("contact", "far")]
    free = np.setdiff1d(np.arange(patch.unknowns), np.concatenate([part.ravel() for part in outside]))
    free = np.setdiff1d(free, patch.components[0, patch.boundary_functions("axis")])
    for c_r, c_z in ((1.0, 1.0), (-poisson, 1.0), (1.0, 0.0)):
        u = np.zeros(patch.unknowns)
        u[patch.components] = np.array([c_r * r, c_z * z])
        forces = K @ u
        assert np.max(np.abs(forces[free])) < 1e-9 * np.max(np.abs(forces))


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.49])
def test_uniform_pressure_on_the_projected_area_shortens_the_body_uniaxially(patch, poisson):
    """u_z = -p (z + R)/E above the sliding mid-plane, E = 1 - nu^2."""
    body = condense(patch, poisson, far_field=sliding)
    r, z = (x.ravel() for x in boundary_basis(patch, "contact", patch.degree + 2).global_coordinates())
    deflection = body.operator.compliance @ np.ones(r.size)
    np.testing.assert_allclose(deflection, (z + R)[np.argsort(r)] / (1 - poisson**2), atol=1e-10 * R)


def test_a_bonded_mid_plane_is_a_sliding_one_for_what_does_not_spread(patch):
    """Uniaxial compression at nu = 0."""
    one = np.ones(condense(patch, 0.0, far_field=sliding).operator.radii.size)
    first, second = (condense(patch, 0.0, far_field=grip).operator.compliance @ one for grip in GRIPS.values())
    np.testing.assert_allclose(second, first, atol=1e-10 * R)


# The independent solver against closed forms, before it is trusted.


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45, 0.4999])
def test_uniaxial_compression(poisson):
    operator = sphere_operator(R, poisson, 40)
    exact = R * cosine(operator.radii) / (1 - poisson**2)
    np.testing.assert_allclose(operator.compliance @ np.ones(operator.radii.size), exact, atol=1e-11)


def test_the_load_of_a_gaussian():
    operator = sphere_operator(R, 0.3, 40)
    assert operator.weights @ gaussian(operator.radii) == pytest.approx(np.pi * R**2 * (1 - np.exp(-8)) / 8, rel=1e-13)


def test_reciprocity():
    """Each of two pressures does the same work in the deflection under the other."""
    operator = sphere_operator(R, 0.3, 100)
    force, other = (operator.weights * pressure(operator.radii) for pressure in (gaussian, cosine))
    deflected, by_other = (operator.compliance @ (f / operator.weights) for f in (force, other))
    assert other @ deflected == pytest.approx(force @ by_other, rel=1e-8)


def test_the_polynomials_and_their_derivatives():
    theta, h = np.linspace(0.1, 1.5, 20), 1e-6
    P, D = legendre(15, np.cos(theta))
    exact = np.array([np.polynomial.legendre.Legendre.basis(n)(np.cos(theta)) for n in range(0, 30, 2)])
    np.testing.assert_allclose(P, exact, atol=1e-12)
    above, below = (legendre(15, np.cos(theta + s))[0] for s in (h, -h))
    np.testing.assert_allclose(D, (above - below) / (2 * h), atol=1e-6)


def test_a_small_contact_sees_a_half_space():
    """Under Hertz's pressure of radius a the deflection falls from the pole as the half-space's, but for O(a/R)."""
    for a in (0.1, 0.05):
        bowl = lambda r, a=a: np.exp(-((r / (a * R)) ** 2))  # noqa: E731
        w = surface_deflection(R, 0.3, bowl, np.array([1e-9, a * R]), 400)
        exact = np.sqrt(np.pi) * a * R * (1 - np.exp(-0.5) * np.i0(0.5))  # w(0) - w(a), G[97] (2.4) in closed form
        assert w[0] - w[1] == pytest.approx(exact, rel=3 * a**2)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45, 0.4999])
def test_deflection_under_a_smooth_pressure(poisson):
    operator = condensed(11, poisson, finest=0.2).operator
    exact = surface_deflection(R, poisson, gaussian, operator.radii)
    error = operator.compliance @ gaussian(operator.radii) - exact
    assert np.max(np.abs(error)) < 1e-7 * np.max(exact)


def test_deflection_when_the_pressure_acts_on_the_surface():
    """The force on its area, p cos(theta) dA, is that of p on the projected one."""
    operator = condensed(11, traction="surface", finest=0.2).operator
    exact = surface_deflection(R, 0.3, gaussian, operator.radii)
    error = operator.compliance @ (gaussian(operator.radii) * cosine(operator.radii)) - exact
    assert np.max(np.abs(error)) < 1e-7 * np.max(exact)


def test_energy_and_pole_converge_spectrally_in_the_degree():
    """Algebraic decay would mean cells that do not fit together along their sides."""
    exact = surface_deflection(R, 0.3, gaussian, np.array([1e-9]))[0]
    series = sphere_operator(R, 0.3, 100)
    P = gaussian(series.radii)
    work = series.weights @ (P * (series.compliance @ P)) / 2
    errors = np.array([pole_and_energy_errors(degree, exact, work) for degree in (3, 5, 7, 9)])
    assert np.all(errors[1:] < errors[:-1] / 5)
    assert np.all(errors[-1] < 1e-6)


def pole_and_energy_errors(degree, pole, work):
    body = condensed(degree)
    P = gaussian(body.operator.radii)
    deflection = body.operator.compliance @ P
    energy = strain_energy(body, P)
    assert energy == pytest.approx(body.operator.weights @ (P * deflection) / 2, rel=1e-9)
    return abs(body.operator.axis_row @ deflection / pole - 1), abs(energy / work - 1)


@pytest.mark.parametrize("grip", GRIPS)
def test_the_mid_plane_carries_the_load(grip):
    body = condensed(6, grip=grip)
    P = gaussian(body.operator.radii)
    assert far_reaction(body, P) == pytest.approx(body.operator.weights @ P, rel=1e-9)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.49])
def test_a_bonded_body_is_the_stiffer(poisson):
    work = []
    for grip in GRIPS:
        operator = condensed(6, poisson, grip).operator
        P = gaussian(operator.radii)
        work.append(operator.weights @ (P * (operator.compliance @ P)))
    assert work[1] < work[0]
    assert work[1] > 0.7 * work[0]


def test_a_block_is_as_large_as_asked_for():
    """Half as large its far side, which is clamped, takes twice as much off the approach."""
    approaches = [
        fem_adhesion.trace(Scene(0.3, Block(radius=size, far_field="clamped")), rtol=1e-2).event("pull_off").approach
        for size in (10.0, 20.0, 40.0)
    ]
    first, second = np.abs(np.diff(approaches))
    assert first > 1e-3
    assert first == pytest.approx(2 * second, rel=0.2)
