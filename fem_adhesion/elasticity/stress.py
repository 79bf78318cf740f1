"""Strains and stresses inside a body: from the displacement of an element, and as a continuous field recovered from it.

Ordered (rr, zz, hoop, rz), tension positive. With the displacement in beta^2/R and lengths in beta, strains are in
beta/R and stresses in E* beta/R = dgamma/(mu eps), the unit of the pressure P.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse.linalg import splu

from fem_adhesion.elasticity.cells import STRAINS, Cells, elastic_matrix, projects, shear_matrix
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
    return np.asarray(space.mesh.mapping().F(places))


def strains(cells: Cells, displacement: Array) -> Array:
    """Return the strains e_rr, e_zz, u_r/r and gamma_rz of a displacement (N,) at the points, (4, c, q), in beta/R."""
    return np.tensordot(STRAINS, cells.gradient(displacement), 1)


def stresses(cells: Cells, poisson: float, displacement: Array, *, projected_dilatation: bool = False) -> Array:
    """Return the stresses of a displacement at the points of the cells, (4, c, q), in E* beta/R, tension positive.

    The displacement (N,) has all unknowns, in beta^2/R. The stresses are discontinuous from cell to cell. With
    projected dilatation the displacement is that of `fem_adhesion.elasticity.cells.projected_stiffness`, whose mean
    stress is lambda times the projection of div u, not div u itself.
    """
    strain = strains(cells, displacement)
    stress, dilatation = np.tensordot(shear_matrix(poisson), strain, 1), strain[:3].sum(axis=0)
    stress[:3] += lame_parameters(poisson)[0] * (cells.projection(dilatation) if projected_dilatation else dilatation)
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
    cells = Cells.of(cut)
    stress = np.empty((4, *cells.radii.shape))
    for own, (poisson, modulus) in zip(parts, materials, strict=True):
        found = stresses(cells, poisson, u, projected_dilatation=projects(cut, poisson))
        stress[:, own] = modulus * found[:, own]
    return cut, u, projection(cells, stress)


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


def projection(cells: Cells, values: Array) -> Array:
    """Return the coefficients (m, functions) of the fields nearest to values (m, c, q) at the points of the cells.

    The least-squares projection on the functions of the displacement itself, each cell weighted by the inverse of its
    area, so that a large cell does not outvote a small, more accurate neighbour. O. C. Zienkiewicz and J. Z. Zhu,
    Int. J. Numer. Methods Eng. 24 (1987) 337-357.
    """
    space, N, dA = cells.space, cells.functions[0], cells.measure / cells.radii
    dA = dA / dA.sum(axis=1, keepdims=True)
    dofs, size = np.asarray(space.scalar_dofs.element_dofs, dtype=np.intp), int(space.scalar_dofs.N)
    mass = scatter(np.einsum("ik,ck,jk->cij", N, dA, N, optimize=True), dofs, size)
    loads = np.einsum("mck,ck,ik->mic", values, dA, N, optimize=True)
    right = np.array([np.bincount(dofs.ravel(), load.ravel(), size) for load in loads])
    factors = splu(mass, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factors.solve(right.T).T)


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
