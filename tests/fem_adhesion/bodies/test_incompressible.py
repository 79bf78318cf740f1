"""The elements that do not lock: exact where they should be, stable on any mesh, right up to Poisson's ratio 1/2."""

import numpy as np
import pytest
from attempts import smooth_deflection, smooth_pressure
from numpy.polynomial.legendre import legvander2d
from skfem import ElementQuadP

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, Scene
from fem_adhesion.elasticity.cells import (
    Cells,
    cell_quadrature,
    of_gradient,
    pressure_modes,
    projected_stiffness,
    shear_matrix,
)
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, with_interiors
from fem_adhesion.elasticity.space import Space, scatter, scatter_pairs
from fem_adhesion.mesh.block import block_grid, tensor_grid


def deflection_error(operator):
    near = operator.radii < 2.0
    w = operator.compliance @ smooth_pressure(operator.radii)
    return np.max(np.abs(w - smooth_deflection(operator.radii))[near])


def quads(degree, fine=0.3):
    return Space(block_grid(fine, 3.0, 50.0), ElementQuadP(degree))


def inf_sup(space, modes):
    """Smallest over pressures p of the largest over displacements v of int p div v/(|p| |v|), |v| that of strain."""
    blocks = []
    for _, cells in Cells.of(space).batches():
        root = np.sqrt(cells.measure)[:, :, None]
        q = np.linalg.qr(root * modes)[0]
        work = q.transpose(0, 2, 1) @ (root * cells.dilatations().transpose(0, 2, 1))
        blocks.append((cells.stiffness(of_gradient(shear_matrix(0.0))), work))
    K, coupling = (np.concatenate(part) for part in zip(*blocks, strict=True))
    T = with_interiors(clamped(space, 0.3), space).reduction
    numbers = np.arange(coupling.shape[0] * coupling.shape[1]).reshape(coupling.shape[:2]).T
    A = (T.T @ scatter(K, space.cell_dofs, space.unknowns) @ T).toarray()
    C = (scatter_pairs(coupling, numbers, space.cell_dofs, (numbers.size, space.unknowns)) @ T).toarray()
    return np.sqrt(max(np.linalg.eigvalsh(C @ np.linalg.solve(A, C.T))[0], 0.0))


# --- the projection ---


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_the_pressures_are_stable_however_fine_the_mesh(degree):
    meshes = [tensor_grid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1)) for n in (2, 5)]
    coarse, fine = (Space(mesh, ElementQuadP(degree)) for mesh in meshes)
    assert inf_sup(fine, pressure_modes(fine)) > 0.95 * inf_sup(coarse, pressure_modes(coarse))
    x, y = 2 * cell_quadrature(fine)[0] - 1
    full = legvander2d(x, y, [degree - 1, degree - 1])  # with the product of the two highest
    assert inf_sup(fine, full) < 0.6 * inf_sup(coarse, full)


@pytest.mark.parametrize(("degree", "accuracy"), [(3, 8e-4), (4, 1.5e-5), (6, 1e-7)])
@pytest.mark.parametrize("poisson", [0.3, 0.499999])
def test_quadrilaterals_do_not_lock(degree, accuracy, poisson):
    space = quads(degree)
    K = projected_stiffness(Cells.of(space), poisson)
    body = condense(space, poisson, stiffness=lambda: [(range(len(K)), K)])
    assert deflection_error(body.operator) < accuracy


def test_quadrilaterals_of_displacements_alone_lock():
    assert deflection_error(condense(quads(4), 0.4999).operator) > 10 * deflection_error(
        condense(quads(4), 0.3).operator
    )


# --- where it is used ---


@pytest.mark.parametrize("poisson", [0.4999])
def test_a_rubber_block_answers_as_the_half_space(poisson):
    path, truth = fem_adhesion.trace(Scene(1.0, HalfSpace(poisson=poisson)), rtol=1e-4), halfspace.trace(1.0)
    for name, event in path.events.items():
        assert abs(event.load - truth.event(name).load) <= event.load_error + 1e-9
        assert abs(event.approach - truth.event(name).approach) <= event.approach_error + 1e-9
        assert event.approach_error < 1e-4 * truth.approach_scale
