"""Axisymmetric displacements on a mesh: their unknowns, and the functions that these belong to.

Lengths are in beta and E* = 1, so Young's modulus is E = 1 - nu^2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from skfem import Dofs

from fem_adhesion.elasticity.reference import quadrature, reference_functions
from fem_adhesion.materials import Elastic
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Space(Valued):
    """Displacements (u_r, u_z), both expanded in one scalar element on one mesh.

    The mesh has the boundaries "axis", "contact" and "far", see `fem_adhesion.mesh.block`; the element n functions per
    cell: ElementTriP1, P2, P3, ElementQuad1, ElementQuad2 or ElementQuadP(p).
    """

    mesh: Any
    element: Any

    @cached_property
    def scalar_dofs(self) -> Any:
        """Numbering of the scalar element's unknowns, that of skfem.Basis(mesh, element)."""
        return Dofs(self.mesh, self.element)

    @cached_property
    def components(self) -> Index:
        """Unknowns u_r (row 0) and u_z (row 1) that belong to each scalar function, (2, functions): by turns."""
        return np.arange(2 * int(self.scalar_dofs.N)).reshape(-1, 2).T

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (2 n, cells): first u_r of all n functions, then u_z."""
        return np.concatenate(list(self.components[:, self.scalar_dofs.element_dofs]))

    @property
    def interior_dofs(self) -> Index:
        """Unknowns that belong to one cell only: both components of the n_i last functions of each."""
        return self.components[:, self.scalar_dofs.interior_dofs].ravel()

    @property
    def inside(self) -> Index:
        """Positions of these among the 2 n of each cell, ascending."""
        positions = np.arange(len(self.cell_dofs)).reshape(2, -1)
        return positions[:, positions.shape[1] - self.element.interior_dofs :].ravel()

    def boundary_functions(self, name: str) -> Index:
        """Return the numbers of the scalar functions that do not vanish on the named boundary, ascending."""
        return np.asarray(self.scalar_dofs.get_facet_dofs(self.mesh.boundaries[name]).flatten(), dtype=np.intp)

    @cached_property
    def constant(self) -> Array:
        """Coefficients of the field 1, (functions,): which functions those are differs between elements."""
        X, _ = quadrature(self.element, 2 * self.degree)
        values = reference_functions(self.element, X)[0]
        coefficients = np.empty(self.scalar_dofs.N)
        coefficients[self.scalar_dofs.element_dofs] = np.linalg.lstsq(values.T, np.ones(X.shape[1]))[0][:, None]
        return coefficients

    def regions(self, materials: Sequence[Elastic]) -> list[Index]:
        """Cells of each material: all of one, or the subdomains of the mesh, in their order."""
        if len(materials) == 1:
            return [np.arange(self.mesh.nelements)]
        return [np.asarray(self.mesh.subdomains[str(n)], dtype=np.intp) for n in range(len(materials))]

    @property
    def unknowns(self) -> int:
        """Number of unknowns before any is constrained."""
        return 2 * int(self.scalar_dofs.N)

    @property
    def degree(self) -> int:
        """Polynomial degree p of the element."""
        return int(self.element.facet_dofs) + 1


def lame_parameters(poisson: float) -> tuple[float, float]:
    """Return Lamé's (lambda, G) of the material with E* = E/(1 - nu^2) = 1; InputError unless 0 <= poisson < 0.5."""
    if not 0.0 <= poisson < 0.5:
        raise InputError(f"poisson = {poisson} must lie in [0, 0.5); displacements alone lock at 0.5, use 0.49 or less")
    E = 1.0 - poisson**2
    return E * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), E / (2.0 * (1.0 + poisson))


def ring_measure(r: Array) -> Array:
    """Return 2 pi r, the area of revolution per unit area (or length) of the r-z plane."""
    return 2.0 * np.pi * r


def scatter(blocks: Array, dofs: Index, size: int) -> sparse.csc_array:
    """Add up the (cells, n, n) blocks of the (n, cells) unknowns in a sparse matrix of the given size."""
    rows = np.broadcast_to(dofs.T[:, :, None], blocks.shape).ravel()
    columns = np.broadcast_to(dofs.T[:, None, :], blocks.shape).ravel()
    return sparse.csc_array((blocks.ravel(), (rows, columns)), shape=(size, size))
