"""Strains and stresses inside a body: from the displacement of an element, and as a continuous field recovered from it.

Ordered (rr, zz, hoop, rz), tension positive. With the displacement in beta^2/R and lengths in beta, strains are in
beta/R and stresses in E* beta/R = dgamma/(mu eps), the unit of the pressure P.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.polynomial.legendre import legvander2d
from scipy.sparse.linalg import splu
from skfem import CellBasis

from fem_adhesion.elasticity.cells import (
    DILATATION,
    Cells,
    cell_quadrature,
    elastic_matrix,
    pressure_modes,
    projects,
    shear_matrix,
)
from fem_adhesion.elasticity.reference import reference_functions
from fem_adhesion.elasticity.space import Space, lame_parameters, scatter
from fem_adhesion.materials import Elastic
from halfspace.values import Array, Index


def sampled(space: Space, coefficients: Array, places: Array) -> Array:
    """Return the values (..., cells, k) of scalar fields at points of each cell.

    Coefficients (..., functions) are those of the scalar functions of the space; places (2, k) are points of the
    reference cell.
    """
    dofs = space.scalar_dofs.element_dofs
    values = reference_functions(space.element, places)[0]
    return np.asarray(np.einsum("...nc,nk->...ck", coefficients[..., dofs], values, optimize=True))


def positions(space: Space, places: Array) -> Array:
    """Return r and z, (2, cells, k), of points (2, k) of the reference cell in each cell."""
    return np.asarray(_basis(space, places).global_coordinates())


def strains(space: Space, displacement: Array, places: Array) -> Array:
    """Return the strains e_rr, e_zz, u_r/r and gamma_rz of a displacement, (4, cells, k), in beta/R.

    The displacement (N,) has all its unknowns, in beta^2/R; places (2, k) are points of the reference cell. On the axis
    u_r/r is du_r/dr.
    """
    basis = _basis(space, places)
    u_r, u_z = (basis.interpolate(displacement[row]) for row in space.components)
    r = np.asarray(basis.global_coordinates())[0]
    off_axis = r > 1e-12 * r.max()
    hoop = np.where(off_axis, np.asarray(u_r) / np.where(off_axis, r, 1.0), u_r.grad[0])
    return np.array([u_r.grad[0], u_z.grad[1], hoop, u_r.grad[1] + u_z.grad[0]])


def stresses(
    space: Space, poisson: float, displacement: Array, places: Array, *, projected_dilatation: bool = False
) -> Array:
    """Return the stresses of a displacement at points of each cell, (4, cells, k), in E* beta/R, tension positive.

    They are discontinuous from cell to cell; the arguments are those of `strains`. With projected dilatation the
    displacement is that of `fem_adhesion.elasticity.cells.projected_stiffness`, whose mean stress is lambda
    times the projection of div u, not div u itself.
    """
    strain = strains(space, displacement, places)
    if not projected_dilatation:
        return np.asarray(np.einsum("ij,jck->ick", elastic_matrix(poisson), strain))
    stress = np.einsum("ij,jck->ick", shear_matrix(poisson), strain)
    stress[:3] += lame_parameters(poisson)[0] * _projected_dilatation(space, displacement, places)
    return np.asarray(stress)


def recovered_stresses(space: Space, materials: Sequence[Elastic], displacement: Array) -> tuple[Space, Array, Array]:
    """Return the stresses nearest to those of the elements that are continuous in each region of a body.

    Materials are those of the regions. The stresses are coefficients (4, functions) in E* beta/R, for `sampled`, after
    the body cut at the interfaces between its regions and its displacement (N,).
    """
    parts = space.regions(materials)
    cut = space if len(materials) == 1 else Space(torn(space.mesh, parts), space.element)
    u = np.empty(cut.unknowns)
    u[cut.cell_dofs] = displacement[space.cell_dofs]
    places = cell_quadrature(cut)[0]
    stress = np.empty((4, cut.mesh.nelements, places.shape[1]))
    for cells, (poisson, modulus) in zip(parts, materials, strict=True):
        found = stresses(cut, poisson, u, places, projected_dilatation=projects(cut, poisson))
        stress[:, cells] = modulus * found[:, cells]
    return cut, u, projection(cut, stress)


def torn(mesh: Any, parts: Sequence[Index]) -> Any:
    """A mesh of straight cells whose parts have vertices of their own, with the same boundaries and subdomains."""
    t, vertices, count = np.empty_like(mesh.t), [], 0
    for cells in parts:
        own, numbers = np.unique(mesh.t[:, cells], return_inverse=True)
        t[:, cells] = count + numbers.reshape(len(t), -1)
        vertices.append(own)
        count += own.size
    cut = type(mesh)(mesh.p[:, np.concatenate(vertices)], t)
    facets = np.empty(mesh.nfacets, dtype=np.intp)
    facets[mesh.t2f] = cut.t2f  # of those between two parts the last; no boundary has them
    boundaries = {name: facets[own] for name, own in mesh.boundaries.items()}
    return cut.with_boundaries(boundaries).with_subdomains(mesh.subdomains)


def projection(space: Space, values: Array) -> Array:
    """Return the coefficients (m, functions) of the fields nearest to values (m, cells, k) at `cell_quadrature`.

    The least-squares projection on the functions of the displacement itself, each cell weighted by the inverse of its
    area, so that a large cell does not outvote a small, more accurate neighbour. O. C. Zienkiewicz and J. Z. Zhu,
    Int. J. Numer. Methods Eng. 24 (1987) 337-357.
    """
    points, weights = cell_quadrature(space)
    N, dA = reference_functions(space.element, points)[0], _basis(space, points, weights).dx
    dA = dA / dA.sum(axis=1, keepdims=True)
    dofs, size = np.asarray(space.scalar_dofs.element_dofs, dtype=np.intp), int(space.scalar_dofs.N)
    mass = scatter(np.einsum("ik,ck,jk->cij", N, dA, N, optimize=True), dofs, size)
    loads = np.einsum("mck,ck,ik->mic", values, dA, N, optimize=True)
    right = np.array([np.bincount(dofs.ravel(), load.ravel(), size) for load in loads])
    factors = splu(mass, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factors.solve(right.T).T)


def _projected_dilatation(space: Space, displacement: Array, places: Array) -> Array:
    """Projection of div u, cell by cell, on `pressure_modes`, at points (2, k): (cells, k)."""
    cells = Cells.of(space)
    root, dilatation = np.sqrt(cells.measure), np.tensordot(DILATATION, cells.gradient(displacement), 1)
    Q, triangle = np.linalg.qr(root[:, :, None] * pressure_modes(space))
    parts = np.einsum("ckm,ck->cm", Q, root * dilatation)
    coefficients = np.linalg.solve(triangle, parts[:, :, None])[:, :, 0]
    x, y = 2.0 * places - 1.0
    modes = legvander2d(x, y, [space.degree - 1, space.degree - 1])[:, :-1]
    return np.asarray(coefficients @ modes.T)


def hydrostatic(stress: Array) -> Array:
    """Return the mean of the three normal stresses (4, ...), tension positive."""
    return np.asarray(stress[:3].mean(axis=0))


def von_mises(stress: Array) -> Array:
    """Return von Mises' equivalent stress of (4, ...), sqrt(3/2) times the norm of the deviator."""
    deviator = stress[:3] - hydrostatic(stress)
    return np.asarray(np.sqrt(1.5 * np.sum(deviator**2, axis=0) + 3.0 * stress[3] ** 2))


def principal(stress: Array) -> Array:
    """Return the principal stresses (3, ...) of (4, ...), descending; the hoop stress is one of them."""
    rr, zz, hoop, rz = stress
    middle, radius = (rr + zz) / 2, np.hypot((rr - zz) / 2, rz)
    return np.asarray(np.sort([middle - radius, middle + radius, hoop], axis=0)[::-1])


def energy_density(stress: Array, poisson: float, modulus: float = 1.0) -> Array:
    """Return the strain energy per volume of (4, ...), half stress times the strain that goes with it.

    In E* (beta/R)^2 for stresses in E* beta/R, of a material as `fem_adhesion.materials.Elastic` says it.
    """
    compliance = np.linalg.inv(modulus * elastic_matrix(poisson))
    return np.asarray(np.einsum("i...,ij,j...->...", stress, compliance, stress) / 2)


def _basis(space: Space, places: Array, weights: Array | None = None) -> Any:
    """Basis of scikit-fem's scalar element at points of all cells."""
    quadrature = places, np.ones(places.shape[1]) if weights is None else weights
    return CellBasis(space.mesh, space.element, quadrature=quadrature, dofs=space.scalar_dofs, disable_doflocs=True)
