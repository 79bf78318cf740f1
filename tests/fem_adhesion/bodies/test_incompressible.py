"""The elements that do not lock are stable on any mesh; how little they err the hard cases tell."""

import numpy as np
import pytest
from numpy.polynomial.legendre import legvander2d
from references import scatter_pairs
from skfem import ElementQuadP

from fem_adhesion.elasticity.cells import Cells, cell_quadrature, of_gradient, pressure_modes, shear_matrix
from fem_adhesion.elasticity.exterior import clamped, with_interiors
from fem_adhesion.elasticity.space import Space, scatter
from fem_adhesion.mesh.block import tensor_grid


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


@pytest.mark.parametrize("degree", [2, 4])
def test_the_pressures_are_stable_however_fine_the_mesh(degree):
    meshes = [tensor_grid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1)) for n in (2, 5)]
    coarse, fine = (Space(mesh, ElementQuadP(degree)) for mesh in meshes)
    assert inf_sup(fine, pressure_modes(fine)) > 0.95 * inf_sup(coarse, pressure_modes(coarse))
    x, y = 2 * cell_quadrature(fine)[0] - 1
    full = legvander2d(x, y, [degree - 1, degree - 1])  # with the product of the two highest
    assert inf_sup(fine, full) < 0.6 * inf_sup(coarse, full)
