"""Elements that do not lock as Poisson's ratio nears 1/2: the dilatation gets a space of its own.

The energy density is that of shear plus lambda (div u)^2/2. As lambda grows, div u must vanish at every point, which
costs a displacement of degree p its accuracy. If Pi div u takes the place of div u, Pi the projection on polynomials of
a lower degree, no more conditions are left than the displacement can meet. The pressure of the mixed form is
lambda Pi div u, eliminated cell by cell; a continuous pressure remains an unknown (Taylor and Hood).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.polynomial.legendre import legvander2d
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Dofs

from fem_adhesion.elasticity.condensation import contact_surface, surface_operator
from fem_adhesion.elasticity.far_field import FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import (
    CellStiffness,
    Space,
    cell_quadrature,
    cell_stiffness,
    cell_strains,
    lame_parameters,
    reference_functions,
    scatter,
    scatter_pairs,
    shear_matrix,
    strain_products,
)
from fem_adhesion.materials import Elastic
from halfspace.elastic.compliance import ElasticOperator
from halfspace.errors import InputError
from halfspace.values import Array

REMEDY_FROM = 0.4
"""Poisson's ratio from which the projection earns its cost, a tenth more time to condense a block. Of the error of the
pull-off load at tabor 1 it leaves half at 0.4, a third at 0.45 and a tenth or less at 0.4999, at degrees 3 to 9."""


def stiffness_for(poisson: float) -> CellStiffness:
    """Stiffness of quadrilaterals that fits the material."""
    return projected_stiffness if poisson >= REMEDY_FROM else cell_stiffness


def projects(space: Space, poisson: float) -> bool:
    """Whether `stiffness_for` a material is that of projected dilatations, where the cells are quadrilaterals."""
    return space.element.refdom.nnodes == 4 and stiffness_for(poisson) is projected_stiffness


def stiffness_of(materials: Sequence[Elastic]) -> CellStiffness:
    """Stiffness of quadrilaterals each of which is of the material of its region."""
    return stiffness_for(materials[0].poisson) if len(materials) == 1 else partial(_by_region, tuple(materials))


def _by_region(materials: Sequence[Elastic], space: Space, _: float) -> Array:
    """Stiffness of every cell, from meshes of the regions apart."""
    K = np.empty((space.mesh.nelements, *2 * [len(space.cell_dofs)]))
    for cells, (poisson, modulus) in zip(space.regions(materials), materials, strict=True):
        part = Space(space.mesh.restrict(cells), space.element)
        K[cells] = modulus * stiffness_for(poisson)(part, poisson)
    return K


def projected_stiffness(space: Space, poisson: float) -> Array:
    """Return the stiffness matrix of every quadrilateral with its dilatation projected; see `pressure_modes`.

    Parameters and result as of `fem_adhesion.elasticity.space.cell_stiffness`.
    """
    lam, D = lame_parameters(poisson)[0], shear_matrix(poisson)
    modes = pressure_modes(space)
    K = np.empty((space.mesh.nelements, *2 * [len(space.cell_dofs)]))
    for cells, B, dA in cell_strains(space):
        root = np.sqrt(dA)[:, :, None]
        orthonormal = np.linalg.qr(root * modes)[0]
        projected = orthonormal.transpose(0, 2, 1) @ (root * dilatation(B))
        K[cells] = strain_products(D, B, dA) + lam * projected.transpose(0, 2, 1) @ projected
    return K


def pressure_modes(space: Space) -> Array:
    """Return the pressures of a quadrilateral of degree p >= 2 at its quadrature points, (q, p^2 - 1).

    Products of Legendre polynomials of degrees below p, without the product of the two highest. With that one, the
    interior displacements, (1 - x^2)(1 - y^2) times any polynomial of degree p - 2 in each direction, would do no work
    on the pressure L_p'(x) L_p'(y), which they do on every other but a constant. So the pair is stable as Q2 with P1
    is, the case p = 2: its inf-sup constant stands at 0.54 for p = 2 to 5 however fine the mesh, and at 0.3 or more
    for cells a million times as long as thick, while that of the full set falls with the mesh.

    Raises
    ------
    InputError
        Unless the cells are quadrilaterals of degree 2 or more.
    """
    if space.degree < 2 or space.element.refdom.nnodes != 4:
        raise InputError(
            f"{type(space.element).__name__} has no projected dilatation; use ElementQuadP(2) or more, or taylor_hood"
        )
    x, y = 2.0 * cell_quadrature(space)[0] - 1.0
    modes: Array = legvander2d(x, y, [space.degree - 1, space.degree - 1])[:, :-1]
    return modes


def dilatation(B: Array) -> Array:
    """Return the relative change of volume from the strains of `cell_strains`, (cells, q, 2 n)."""
    volume: Array = B[:, :3].sum(axis=1)
    return volume


def taylor_hood(
    space: Space, poisson: float, pressure: Any, *, far_field: FarField = point_load, points: int | None = None
) -> ElasticOperator:
    """Condense a block of displacements and continuous pressures to its surface, as `condense` does.

    The pressure's element is one degree below the displacement's: ElementTriP1 with ElementTriP2, ElementQuadP(p - 1)
    with ElementQuadP(p). InputError if poisson is zero, at which the pressure is undetermined.
    """
    lam = lame_parameters(poisson)[0]
    if lam == 0.0:
        raise InputError("poisson = 0 leaves the pressure undetermined; use condense, nothing locks there")
    exterior = with_interiors(far_field(space, poisson), space)
    T = exterior.reduction
    K, coupling, volume = _mixed_matrices(space, poisson, pressure)
    A = T.T @ K @ T + exterior.stiffness
    # Symmetric and quasi-definite: it can be factorised in any order without pivoting.
    saddle = sparse.block_array([[A, (coupling @ T).T], [coupling @ T, -volume / lam]], format="csc")
    factors = splu(saddle, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    surface = contact_surface(space, space.degree + 2 if points is None else points)
    rows = T.tocsr()[surface.unknowns]
    forces = sparse.vstack([rows.T, sparse.csr_array((volume.shape[0], len(surface.unknowns)))]).toarray()
    return surface_operator(surface, exterior, rows @ factors.solve(forces)[: T.shape[1]])


def _mixed_matrices(
    space: Space, poisson: float, pressure: Any
) -> tuple[sparse.csc_array, sparse.csc_array, sparse.csc_array]:
    """Shear stiffness (N, N), work of each pressure in each dilatation (M, N) and products of pressures (M, M)."""
    dofs, D = Dofs(space.mesh, pressure), shear_matrix(poisson)
    q = reference_functions(pressure, cell_quadrature(space)[0])[0]
    blocks: list[tuple[Array, Array, Array]] = []
    for _, B, dA in cell_strains(space):
        weighted = q * dA[:, None, :]
        blocks.append((strain_products(D, B, dA), weighted @ dilatation(B), weighted @ q.T))
    K, coupling, volume = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
    pressures = np.asarray(dofs.element_dofs, dtype=np.intp)
    return (
        scatter(K, space.cell_dofs, space.unknowns),
        scatter_pairs(coupling, pressures, space.cell_dofs, (dofs.N, space.unknowns)),
        scatter(volume, pressures, dofs.N),
    )
