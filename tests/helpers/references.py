"""References for the condensed body and for ladders: mixed elements, energies, rungs of charts that are given."""

from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.special import j0, kv
from skfem import Dofs

from fem_adhesion.elasticity.cells import Cells, cell_quadrature, of_gradient, shear_matrix
from fem_adhesion.elasticity.condensation import CondensedBody, surface_operator
from fem_adhesion.elasticity.exterior import FarField, point_load, with_interiors
from fem_adhesion.elasticity.reference import reference_functions
from fem_adhesion.elasticity.space import Space, lame_parameters, scatter
from fem_adhesion.elasticity.surface import boundary_points
from halfspace.accuracy.stages import Charted, Charts, Rung
from halfspace.elastic.compliance import ElasticOperator
from halfspace.values import Array, Index


def charted_rung(*stages: Charts) -> Rung:
    """Rung of given charts, the last of which also serve for the curve."""
    return Rung(lambda: stages[-1], tuple(Charted(charts) for charts in stages), {})


def smooth_pressure(r: Array) -> Array:
    """P = (1 + r^2)^-3, with a tail as that of adhesion."""
    return (1.0 + r**2) ** -3.0


def smooth_deflection(r: Array) -> Array:
    """Deflection under `smooth_pressure`, whose Hankel transform is k^2 K_2(k)/8; the half-space answers it by 2/k."""
    x, w = leggauss(200)
    k = 20.0 * (x + 1.0)
    return (40.0 * w * k**2 * kv(2, k) / 8.0) @ j0(np.outer(k, r))


def deflection_error(operator: ElasticOperator) -> float:
    """Largest error near the axis, in beta, of the deflection of a half-space under `smooth_pressure`."""
    r = operator.radii
    error = operator.compliance @ smooth_pressure(r) - smooth_deflection(r)
    return float(np.max(np.abs(error[r < 2.0])))


def strain_energy(body: CondensedBody, pressure: Array) -> float:
    """Elastic energy of block and exterior under a pressure, in E* beta^3, summed over the cells."""
    x, u = body.reduced_displacement(pressure), body.displacement(pressure)
    cells = u[body.space.cell_dofs].T
    inside = np.einsum("ci,cij,cj->", cells, body.cells, cells, optimize=True)
    outside = x[-body.exterior.stiffness.shape[0] :]
    spring = body.exterior.rigid_compliance * (body.operator.weights @ pressure) ** 2
    return 0.5 * float(inside + outside @ (body.exterior.stiffness @ outside) - spring)


def taylor_hood(space: Space, poisson: float, pressure: Any, *, far_field: FarField = point_load) -> ElasticOperator:
    """Condense a block of displacements and continuous pressures to its surface, as `condense` does.

    The pressure's element is one degree below the displacement's: ElementTriP1 with ElementTriP2, ElementQuadP(p - 1)
    with ElementQuadP(p). The pressure is undetermined where poisson is zero.
    """
    lam = lame_parameters(poisson)[0]
    exterior = with_interiors(far_field(space, poisson), space)
    T = exterior.reduction
    K, coupling, volume = _mixed_matrices(space, poisson, pressure)
    A = T.T @ K @ T + exterior.stiffness
    # Symmetric and quasi-definite: it can be factorised in any order without pivoting.
    saddle = sparse.block_array([[A, (coupling @ T).T], [coupling @ T, -volume / lam]], format="csc")
    factors = splu(saddle, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    surface = boundary_points(space, "contact", space.degree + 2)
    rows = T.tocsr()[space.components[1, surface.functions]]
    forces = sparse.vstack([rows.T, sparse.csr_array((volume.shape[0], len(surface.functions)))]).toarray()
    return surface_operator(surface, exterior, rows @ factors.solve(forces)[: T.shape[1]])


def scatter_pairs(blocks: Array, row_dofs: Index, column_dofs: Index, shape: tuple[int, int]) -> sparse.csc_array:
    """Add up (cells, m, n) blocks that couple the (m, cells) unknowns of one space with the (n, cells) of another."""
    rows = np.broadcast_to(row_dofs.T[:, :, None], blocks.shape).ravel()
    columns = np.broadcast_to(column_dofs.T[:, None, :], blocks.shape).ravel()
    return sparse.csc_array((blocks.ravel(), (rows, columns)), shape=shape)


def _mixed_matrices(
    space: Space, poisson: float, pressure: Any
) -> tuple[sparse.csc_array, sparse.csc_array, sparse.csc_array]:
    """Shear stiffness (N, N), work of each pressure in each dilatation (M, N) and products of pressures (M, M)."""
    dofs, D = Dofs(space.mesh, pressure), of_gradient(shear_matrix(poisson))
    q = reference_functions(pressure, cell_quadrature(space)[0])[0]
    blocks: list[tuple[Array, Array, Array]] = []
    for _, cells in Cells.of(space).batches():
        weighted = q * cells.measure[:, None, :]
        blocks.append((cells.stiffness(D), weighted @ cells.dilatations().transpose(0, 2, 1), weighted @ q.T))
    K, coupling, volume = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
    pressures = np.asarray(dofs.element_dofs, dtype=np.intp)
    return (
        scatter(K, space.cell_dofs, space.unknowns),
        scatter_pairs(coupling, pressures, space.cell_dofs, (dofs.N, space.unknowns)),
        scatter(volume, pressures, dofs.N),
    )
