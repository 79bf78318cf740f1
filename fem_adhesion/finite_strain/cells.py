"""Sums over the cells of a body at finite strain: shape functions, cell matrices and where they go.

Displacements are in beta^2/R, stresses in E* beta/R, forces in R dgamma; see `fem_adhesion.finite_strain.material`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from fem_adhesion.elasticity.space import Space, cell_strains
from fem_adhesion.finite_strain.material import Deformation
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Cells(Valued):
    """A batch of cells, with their shape functions at their quadrature points.

    Attributes
    ----------
    dofs : (cells, 2 n) int array
        Unknowns u_r of the n functions, then u_z.
    radial, vertical : (cells, q, 3, n) and (cells, q, 2, n) array
        Components (hoop, rr, rz) of A of unit u_r, and (zr, zz) of unit u_z.
    measure : (cells, q) array
        2 pi r dr dz.
    """

    dofs: Index
    radial: Array
    vertical: Array
    measure: Array

    def deformation(self, u: Array, stretch: float) -> Deformation:
        """Deformation at the points, (5, cells, q), under all displacement unknowns."""
        n = self.radial.shape[-1]
        U = u[self.dofs][:, None, :, None]
        A = np.concatenate([self.radial @ U[:, :, :n], self.vertical @ U[:, :, n:]], axis=2)
        return Deformation(A[..., 0].transpose(2, 0, 1), stretch)

    def forces(self, stress: Array) -> Array:
        """Work of a stress, (5, cells, q), in each unit displacement, (cells, 2 n)."""
        return self.works(stress, np.ones((1, stress.shape[-1])))[..., 0]

    def products(self, moduli: Array) -> Array:
        """Return int A' D A of unit displacements, (cells, 2 n, 2 n), for moduli (5, 5, cells, q)."""
        D = (moduli * self.measure).transpose(2, 3, 0, 1)
        parts, n = (slice(0, 3), slice(3, 5)), self.radial.shape[-1]
        K = np.empty((len(self.dofs), 2 * n, 2 * n))
        for i, B_i in enumerate(self.shapes):
            for j, B_j in enumerate(self.shapes):
                DB = np.ascontiguousarray(D[..., parts[i], parts[j]]) @ B_j
                K[:, i * n : (i + 1) * n, j * n : (j + 1) * n] = _rows(B_i).transpose(0, 2, 1) @ _rows(DB)
        return K

    def works(self, stress: Array, amounts: Array) -> Array:
        """Work in unit displacements of a stress, (5, cells, q), times each of (m, q) amounts, (cells, 2 n, m)."""
        weighted = (stress * self.measure).transpose(1, 2, 0)[..., None] * amounts.T[:, None, :]
        parts = (weighted[:, :, :3], weighted[:, :, 3:])
        return np.concatenate(
            [_rows(B).transpose(0, 2, 1) @ _rows(s) for B, s in zip(self.shapes, parts, strict=True)], axis=1
        )

    @property
    def shapes(self) -> tuple[Array, Array]:
        """Radial and vertical shape functions."""
        return self.radial, self.vertical


def _rows(values: Array) -> Array:
    """Merge points and components, (cells, q, c, n) to (cells, q c, n)."""
    return values.reshape(len(values), values.shape[1] * values.shape[2], values.shape[3])


def cells_of(space: Space) -> tuple[Cells, ...]:
    """Evaluate the shape functions of all cells, in batches."""
    return tuple(_batches(space))


def _batches(space: Space) -> Iterator[Cells]:
    for cells, B, measure in cell_strains(space):
        n = B.shape[-1] // 2
        rr, zz, hoop = B[:, 0, :, :n], B[:, 1, :, n:], B[:, 2, :, :n]
        yield Cells(space.cell_dofs[:, cells].T, np.stack([hoop, rr, zz], axis=2), np.stack([rr, zz], axis=2), measure)


def summed(parts: Iterable[tuple[Index, Array]], size: int) -> Array:
    """Add up values of any shape to the unknowns of the same shape, (size,)."""
    total = np.zeros(size)
    for dofs, values in parts:
        total += np.bincount(dofs.ravel(), weights=values.ravel(), minlength=size)
    return total
