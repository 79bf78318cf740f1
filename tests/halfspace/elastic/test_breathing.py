"""Operators that follow the contact: against operators made afresh, their rates against finite differences."""

import numpy as np
import pytest
from skfem import ElementQuadP

from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import sliding
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh import spheres
from halfspace.elastic import compliance, grid
from halfspace.elastic.grid import FLAT, SurfaceCoordinate
from halfspace.elastic.operators import Interpolated, MovingGrid, Piecewise, chebyshev_lengths, kernels_of
from halfspace.equilibrium.contact import ContactProblem
from halfspace.profiles.formulas import SphereSurface

R = 4.0
EDGE = 1.5  # contact radius at which operators are compared, between those that are known


def half_space_grid():
    """Cells that follow the edge and end at R, fixed: so that the kernel on them is not homogeneous."""
    inner, outer = np.array([0.0, 0.6, 0.9, 1.0]), np.array([0.1, 0.3, 1.0])
    return MovingGrid(np.concatenate([0 * inner, R * outer]), np.concatenate([inner, 1 - outer]), FLAT)


def half_space(lines):
    return compliance.panels(lines, 5)


def hemisphere_grid(area):
    core, outer = spheres.CORE * R, R * np.linspace(spheres.CORE, 2, spheres.LAYERS + 1)[1:]
    inner, beyond = np.array([0.0, 0.6, 1.0]), np.array([0.1, 0.25, 0.5, 1.0])
    fixed = np.concatenate([0 * inner, core * beyond, outer])
    moving = np.concatenate([inner, 1 - beyond, 0 * outer])
    return MovingGrid(fixed, moving, SurfaceCoordinate(R, area))


def hemisphere(area):
    depths = grid.graded(0.0, 0.5, spheres.DEPTH * R, growth=2.5)

    def make(lines):
        mesh = spheres.hemisphere(R, lines[: -spheres.LAYERS], depths)
        return condense(Space(mesh, ElementQuadP(4)), 0.3, far_field=sliding, traction=area).operator

    return make


BODIES = {
    "half-space": lambda: (half_space_grid(), half_space),
    "hemisphere, surface area": lambda: (hemisphere_grid("surface"), hemisphere("surface")),
}


@pytest.fixture(scope="module", params=BODIES)
def body(request):
    return BODIES[request.param]()


def _between(scales, operators, moving):
    edges = np.array([moving.coordinate.of(float(a)) for a in scales])
    kernel = Piecewise(edges[[0, -1]], [edges], lambda _: kernels_of(operators))
    return Interpolated(kernel, operators[0].cell_nodes, moving)


def interpolated(body, count, ratio=1.7):
    moving, make = body
    scales = chebyshev_lengths(1.4 / np.sqrt(ratio), 1.4 * np.sqrt(ratio), count)
    return _between(scales, [make(moving.lines(float(a))) for a in scales], moving)


def pressure(radii):
    return np.cos(radii) * np.exp(-radii / 3)


def test_interpolation_errors_fall_geometrically_with_radii(body):
    moving, make = body
    fresh = make(moving.lines(EDGE))
    known = interpolated(body, 2).at(EDGE)
    np.testing.assert_allclose(known.radii, fresh.radii, rtol=1e-7)  # as far as the cells of degree 8 are the sphere
    np.testing.assert_allclose(known.weights, fresh.weights, rtol=1e-7)
    np.testing.assert_allclose(known.cells, fresh.cells, atol=1e-12)
    P = pressure(fresh.radii)
    errors = [np.max(np.abs((interpolated(body, m).at(EDGE).compliance - fresh.compliance) @ P)) for m in (2, 4, 6)]
    assert errors[1] < errors[0] / 10
    assert errors[2] < errors[1] / 10
    assert errors[2] < 1e-4 * np.max(fresh.compliance @ P)


def test_rates_against_finite_differences(body):
    operator, h = interpolated(body, 4), 1e-5
    P = pressure(operator.at(EDGE).radii)
    above, below = operator.at(EDGE + h), operator.at(EDGE - h)
    rates = operator.rates(EDGE, P)
    for rate, quantity in zip(rates, ("radii", "weights"), strict=False):
        np.testing.assert_allclose(rate, (getattr(above, quantity) - getattr(below, quantity)) / (2 * h), atol=1e-8)
    slope = (above.compliance - below.compliance) @ P / (2 * h)
    np.testing.assert_allclose(rates[2], slope, atol=1e-8 * np.max(np.abs(above.compliance @ P)))


def test_the_jacobian_on_a_sphere_against_differences(body):
    problem = ContactProblem(interpolated(body, 3), 0.5, profile=SphereSurface(R))
    x = problem.undeformed(-0.2, EDGE)
    x[:-2] += 0.3 * np.cos(np.arange(x.size - 2))
    J, h = problem.jacobian(x), 1e-6
    steps = h * np.eye(x.size)
    differences = np.array([(problem.residual(x + dx) - problem.residual(x - dx)) / (2 * h) for dx in steps]).T
    np.testing.assert_allclose(J, differences, atol=1e-6 * (1 + np.max(np.abs(J[:, -1]))), rtol=1e-6)
