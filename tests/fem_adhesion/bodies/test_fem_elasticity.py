"""Meshes, stiffness and boundary points of the finite elements, without any contact."""

import dataclasses

import numpy as np
import pytest
from facets import boundary_basis
from scipy.spatial.distance import cdist
from skfem import Basis, BilinearForm, ElementQuadP, ElementTriP2, ElementTriP3, ElementVector
from skfem.helpers import ddot, div, sym_grad

from fem_adhesion.elasticity.cells import (
    Cells,
    cell_quadrature,
    cell_stiffness,
    elastic_matrix,
    projected_stiffness,
    stiffness_of,
)
from fem_adhesion.elasticity.exterior import boussinesq_displacement, boussinesq_stress
from fem_adhesion.elasticity.space import Space, lame_parameters, scatter
from fem_adhesion.elasticity.surface import boundary_points
from fem_adhesion.materials import Elastic
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc, tensor_grid
from fem_adhesion.mesh.curved import Patch, joined
from fem_adhesion.mesh.file import refined
from fem_adhesion.mesh.spheres import held_sphere

NU = 0.3


# --- meshes ---


@pytest.mark.parametrize("mesh", [block_grid(0.3, 3.0, 50.0), quarter_disc(50.0, graded_size(0.3, 3.0, 0.3))])
def test_boundaries_are_named_and_complete(mesh):
    middles = {name: mesh.p[:, mesh.facets[:, facets]].mean(axis=1) for name, facets in mesh.boundaries.items()}
    assert set(middles) == {"axis", "contact", "far"}
    assert np.all(middles["axis"][0] == 0.0)
    assert np.all(middles["contact"][1] == 0.0)
    assert np.all(np.hypot(*middles["far"]) > 45.0)
    assert sum(m.shape[1] for m in middles.values()) == len(mesh.boundary_facets())
    assert mesh.p[0].min() == 0.0
    assert mesh.p[1].max() == 0.0


@pytest.mark.parametrize("fine", [0.4, 0.01])
def test_quarter_disc_respects_sizes_with_no_sharp_angle(fine):
    size = graded_size(fine, 1.0, 0.25)
    mesh = quarter_disc(50.0, size)
    corners = mesh.p[:, mesh.t]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=0)
    assert np.all(edges.max(axis=0) <= size(*corners.mean(axis=1)))
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    _, middle, longest = np.sort(edges, axis=0)
    smallest_angle = np.arcsin(np.abs(a[0] * b[1] - a[1] * b[0]) / (middle * longest))
    assert np.degrees(smallest_angle.min()) > 18.0  # 19.6 at any fineness


# --- stiffness ---


@BilinearForm
def axisymmetric_elasticity(u, v, w):
    """Isotropic elasticity with the hoop strain, in scikit-fem's own words."""
    lam, G = lame_parameters(NU)
    r = w.x[0]
    hoop_u, hoop_v = u[0] / r, v[0] / r
    shear = 2.0 * G * (ddot(sym_grad(u), sym_grad(v)) + hoop_u * hoop_v)
    return 2.0 * np.pi * r * (shear + lam * (div(u) + hoop_u) * (div(v) + hoop_v))


@pytest.mark.parametrize(
    ("mesh", "element"),
    [(quarter_disc(5.0, graded_size(0.7, 1.0, 0.5)), ElementTriP3()), (block_grid(0.7, 1.4, 5.0), ElementQuadP(3))],
    ids=["P3", "Q3"],
)
def test_stiffness_equals_scikit_fems_assembly(mesh, element):
    space = Space(mesh, element)
    ours = scatter(cell_stiffness(Cells.of(space), NU), space.cell_dofs, space.unknowns)
    basis = Basis(mesh, ElementVector(element), quadrature=cell_quadrature(space))
    theirs = axisymmetric_elasticity.assemble(basis)
    assert abs(ours - theirs).max() < 1e-13 * abs(theirs).max()


@pytest.mark.parametrize(("poisson", "stiffness"), [(0.3, cell_stiffness), (0.4999, projected_stiffness)])
def test_rectangles_above_one_another_have_each_its_own_stiffness(poisson, stiffness):
    """From flat ones, a millionth as high as wide, to tall ones; none that leans or is uneven stands for another.

    Nor where those of a column begin at another corner, or go round the other way.
    """
    upright = tensor_grid(np.array([0.0, 1.0, 1.001, 30.0]), np.array([0.0, 1e-6, 0.5, 100.0]))
    leaning = dataclasses.replace(upright, doflocs=upright.p + [[0.0], [0.1]] * upright.p[0])
    turned = upright.t.copy()
    turned[:, 0], turned[:, 4] = turned[[3, 0, 1, 2], 0], turned[[0, 3, 2, 1], 4]
    unevenly = Patch(np.arange(3.0), np.arange(3.0), lambda s, t: np.array([s, -t - 0.1 * t * (1 - t) * (2 - t)]))
    uneven = joined([unevenly], [np.arange(9).reshape(3, 3)])
    grids = (upright, True), (dataclasses.replace(upright, t=turned), True), (leaning, False), (uneven, False)
    for mesh, are in grids:
        space = Space(mesh, ElementQuadP(4))
        cells = Cells.of(space)
        found = np.empty((mesh.nelements, *2 * [len(space.cell_dofs)]))
        for own, K in stiffness_of(space, [Elastic(poisson)]):
            found[own] = K
        assert bool(cells.upright.size) is are
        wanted = stiffness(cells, poisson)
        sizes = np.sqrt(np.einsum("cii,cjj->cij", wanted, wanted))
        assert np.all(np.abs(found - wanted) <= 1e-12 * sizes)


# --- Boussinesq's closed forms and traces ---


@pytest.mark.parametrize("poisson", [0.0, 0.45])
def test_boussinesq_stress_belongs_to_the_displacement(poisson):
    r, z, step = np.array([0.4, 1.3, 2.0]), np.array([-0.2, -1.0, -3.0]), 1e-5

    def u(dr, dz):
        return boussinesq_displacement(r + dr, z + dz, poisson)

    d_dr = (u(step, 0.0) - u(-step, 0.0)) / (2.0 * step)
    d_dz = (u(0.0, step) - u(0.0, -step)) / (2.0 * step)
    strain = np.array([d_dr[0], d_dz[1], u(0.0, 0.0)[0] / r, d_dz[0] + d_dr[1]])
    np.testing.assert_allclose(elastic_matrix(poisson) @ strain, boussinesq_stress(r, z, poisson), atol=1e-9)


@pytest.mark.parametrize("name", ["contact", "far"])
@pytest.mark.parametrize(
    "space",
    [
        Space(refined(quarter_disc(5.0, graded_size(0.7, 1.0, 0.5))), ElementTriP2()),
        Space(block_grid(0.5, 1.5, 10.0), ElementQuadP(4)),
        Space(held_sphere(3.0, np.linspace(0, 5.1, 5), np.linspace(0, 2.7, 4), 30.0), ElementQuadP(5)),
    ],
    ids=["curved triangles", "rectangles", "held sphere"],
)
def test_boundary_points_are_those_of_scikit_fem(space, name):
    basis, trace = boundary_basis(space, name, 4), boundary_points(space, name, 4)
    places, normals = (np.reshape(vectors, (2, -1)) for vectors in (basis.global_coordinates(), basis.normals))
    same = cdist(trace.places.reshape(2, -1).T, places.T).argmin(axis=1)  # scikit-fem has them in another order
    assert np.array_equal(np.sort(same), np.arange(same.size))
    np.testing.assert_allclose(trace.places.reshape(2, -1), places[:, same], atol=1e-12)
    np.testing.assert_allclose(trace.normals.reshape(2, -1), normals[:, same], atol=1e-9)
    np.testing.assert_allclose(trace.lengths.ravel(), np.ravel(basis.dx)[same], rtol=1e-8)
    u = np.sin(np.arange(1.0, basis.N + 1))
    np.testing.assert_allclose(trace.values @ u[trace.functions], np.ravel(basis.interpolate(u))[same], atol=1e-10)
    (n_r, n_z), grad = basis.normals, basis.interpolate(u).grad
    along = np.ravel(grad[0] * n_z - grad[1] * n_r)[same]
    np.testing.assert_allclose(trace.rates @ u[trace.functions], along, atol=1e-8 * np.abs(along).max())
