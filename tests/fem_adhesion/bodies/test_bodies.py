"""The hemisphere of finite elements: its shape, uniform states, and an elastic sphere in Legendre polynomials."""

from functools import partial

import numpy as np
import pytest
from facets import boundary_basis
from skfem import ElementQuadP
from whole_sphere import surface_deflection

from fem_adhesion.elasticity.cells import stiffness_of
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, sliding
from fem_adhesion.elasticity.space import Space
from fem_adhesion.materials import Elastic
from fem_adhesion.mesh import curved, spheres
from halfspace.elastic import grid
from halfspace.profiles.formulas import SphereSurface

R = 2.5
GRIPS = {"sliding": sliding, "bonded": clamped}


def space(degree, *, finest=0.15, growth=2.0):
    """Hemisphere graded to the pole with cells of a length there, in R."""
    lines, depths = (grid.graded(0.0, finest * R, size * R, growth=growth) for size in (spheres.CORE, spheres.DEPTH))
    return Space(spheres.hemisphere(R, lines, depths), ElementQuadP(degree))


def condensed(degree, poisson=0.3, grip="sliding", traction="projected", **mesh):
    body = space(degree, **mesh)
    K = partial(stiffness_of, body, [Elastic(poisson)])
    return condense(body, poisson, far_field=GRIPS[grip], stiffness=K, traction=traction)


def gaussian(radii):
    return np.exp(-8 * (radii / R) ** 2)


def cosine(radii):
    return np.sqrt((1 - radii / R) * (1 + radii / R))


@pytest.fixture(scope="module")
def fine():
    return space(10)


@pytest.mark.parametrize(("traction", "area"), [("projected", 1), ("surface", 2)])
def test_areas(traction, area):
    weights = condensed(6, traction=traction).operator.weights
    assert np.sum(weights) == pytest.approx(area * np.pi * R**2, rel=1e-9)


def test_the_contact_surface_is_the_sphere_below_the_wall(fine):
    r, z = surface_points(fine, "contact")
    assert np.max(np.abs(np.hypot(r, z + R) - R)) < 1e-8 * R
    inside = r < 0.9 * R  # the profile has a vertical tangent at the equator
    assert np.max(np.abs(z + SphereSurface(R).height(r * inside) / R)[inside]) < 1e-8 * R
    assert np.max(z) < 0


def surface_points(body, name):
    return boundary_basis(body, name, 8).global_coordinates()


# Linear displacements are in the space of cells whose shape has the element's degree or less.


@pytest.fixture(scope="module")
def patch():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(curved, "DEGREE", 4)  # so that quadrature is exact, which curved cells of 8 would not let it be
        return space(8)


@pytest.mark.parametrize("poisson", [0.0, 0.49])
def test_uniform_pressure_shortens_the_body_uniaxially(patch, poisson):
    """u_z = -p (z + R)/E above the sliding mid-plane, E = 1 - nu^2."""
    body = condense(patch, poisson, far_field=sliding)
    r, z = (x.ravel() for x in boundary_basis(patch, "contact", patch.degree + 2).global_coordinates())
    deflection = body.operator.compliance @ np.ones(r.size)
    np.testing.assert_allclose(deflection, (z + R)[np.argsort(r)] / (1 - poisson**2), atol=1e-10 * R)


# The independent solver against closed forms, before it is trusted.


@pytest.mark.parametrize(("poisson", "traction"), [(0.0, "projected"), (0.4999, "projected"), (0.3, "surface")])
def test_deflection_under_a_smooth_pressure(poisson, traction):
    """On the surface the force on its area, p cos(theta) dA, is that of p on the projected one."""
    operator = condensed(11, poisson, traction=traction, finest=0.2).operator
    exact = surface_deflection(R, poisson, gaussian, operator.radii)
    pressure = gaussian(operator.radii) * (cosine(operator.radii) if traction == "surface" else 1.0)
    assert np.max(np.abs(operator.compliance @ pressure - exact)) < 1e-7 * np.max(exact)
