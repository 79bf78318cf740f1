"""Newton's linear equations at finite strain, with the unknowns interior to a cell eliminated from each step.

A cell's tangent is symmetric, K = [[K_ii, K_io], [K_oi, K_oo]], whatever that of the surface law is. Only the shared
unknowns, less than half of all, are left to the sparse factorisation, as in `fem_adhesion.elasticity.condensation`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fem_adhesion.elasticity.far_field import Exterior
from fem_adhesion.finite_strain.bodies import Body
from halfspace.errors import NotConverged
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Step(Valued):
    """The bordered linear equations of one state, factorised.

    Attributes
    ----------
    elimination : Elimination
        Numbering.
    inverse, recovery : (cells, i, i) and (cells, i, o) array
        K_ii^-1 and K_ii^-1 K_io, the latter from the reduced unknowns.
    factors : scipy.sparse.linalg.SuperLU
        Of the shared unknowns and the border.
    """

    elimination: Elimination
    inverse: Array
    recovery: Array
    factors: Any

    def solve(self, rhs: Array) -> Array:
        """Solution (n + 1,) for a right-hand side (n + 1,)."""
        e, solution = self.elimination, np.empty(rhs.size)
        inner = rhs[e.inner][..., None]
        shared = np.append(rhs[e.first :], 0.0)
        carried = (self.recovery.transpose(0, 2, 1) @ inner)[..., 0]
        shared -= np.bincount(e.columns.ravel(), weights=carried.ravel(), minlength=shared.size)
        solution[e.first :] = self.factors.solve(shared[:-1])
        outer = np.append(solution[e.first :], 0.0)[e.columns][..., None]
        solution[e.inner] = (self.inverse @ inner - self.recovery @ outer)[..., 0]
        return solution

    def negative_pivots(self) -> int:
        """Count the negative pivots, those of the interior unknowns included."""
        interior = np.linalg.eigvalsh(self.inverse) < 0
        return int(np.sum(interior) + np.sum(self.factors.U.diagonal() < 0))


@dataclass(frozen=True, eq=False, repr=False)
class Elimination(Valued):
    """Where the entries of cell matrices go once their interior unknowns are eliminated; n reduced unknowns in all.

    Attributes
    ----------
    inside, outside : (i,) and (o,) int array
        Positions of the interior and of the shared unknowns among those of a cell.
    inner : (cells, i) int array
        The reduced unknowns that are interior to a cell.
    first : int
        Their number: the reduced unknowns from there on are shared.
    columns : (cells, o) int array
        The shared reduced unknown, counted from `first`, on which a cell's shared unknown depends; the one past the
        border stands for none.
    weights : (cells, o) array
        And the factor with which it does.
    keys : (entries,) int array
        Places of the bordered matrix's entries, column by column, ascending.
    slots : int array
        For each entry of the cells' matrices its place among the keys; the one past the last stands for none.
    size : int
        Of the bordered matrix.
    """

    inside: Index
    outside: Index
    inner: Index
    first: int
    columns: Index
    weights: Array
    keys: Index
    slots: Index
    size: int

    def factorise(
        self, cells: Array, surface: sparse.csr_array, column: Array, row: Array, *, pivoting: float = 0.01
    ) -> Step:
        """Factorise the tangent, bordered by the derivative by the approach and by a control.

        Parameters
        ----------
        cells : (cells, k, k) array
            Tangents of the cells.
        surface : (n, n) sparse array
            Tangent of the exterior and of the surface law, each entry once.
        column, row : (n,) and (n + 1,) array
            Border; both vanish for interior unknowns.
        pivoting : float
            How small a pivot on the diagonal may be, relative to its column, before it is exchanged.

        Raises
        ------
        halfspace.errors.NotConverged
            If the matrix is singular.
        """
        inside, outside = self.inside, self.outside
        K_io = cells[:, inside[:, None], outside] * self.weights[:, None]
        inverse = _inverse(cells[:, inside[:, None], inside])
        recovery: Array = inverse @ K_io
        K_oo = cells[:, outside[:, None], outside] * (self.weights[:, :, None] * self.weights[:, None, :])
        shared = K_oo - K_io.transpose(0, 2, 1) @ recovery
        sums = np.bincount(self.slots, weights=shared.ravel(), minlength=self.keys.size + 1)
        data = np.asarray(sums[:-1], dtype=np.float64)
        outer, n = surface.tocoo(), column.size
        self._add(data, outer.row.astype(np.intp), outer.col.astype(np.intp), outer.data)
        self._add(data, np.arange(n), np.full(n, n), column)
        self._add(data, np.full(n + 1, n), np.arange(n + 1), row)
        indptr = np.searchsorted(self.keys, np.arange(self.size + 1) * self.size)
        matrix = sparse.csc_array((data, self.keys % self.size, indptr), shape=(self.size, self.size))
        return Step(self, inverse, recovery, _factors(matrix, pivoting))

    def _add(self, data: Array, rows: Index, columns: Index, values: Array) -> None:
        """Add entries, of the reduced unknowns and the border, to the matrix's."""
        used = np.flatnonzero(values)
        keys = (columns[used] - self.first) * self.size + rows[used] - self.first
        data[np.searchsorted(self.keys, keys)] += values[used]


def _inverse(blocks: Array) -> Array:
    try:
        return np.asarray(np.linalg.inv(blocks), dtype=np.float64)
    except np.linalg.LinAlgError as error:
        raise NotConverged("the tangent of a cell is singular; try another control or a nearer start") from error


def _factors(matrix: sparse.csc_array, pivoting: float) -> Any:
    try:
        # A symmetric pattern, indefinite on the unstable branch: ordered as such, yet pivoted.
        return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=pivoting, options={"SymmetricMode": True})
    except RuntimeError as error:  # SuperLU's way of saying so
        raise NotConverged("the bordered Jacobian is singular; try another control or a nearer start") from error


def elimination(body: Body, exterior: Exterior, surface: Index) -> Elimination:
    """Prepare the elimination for a body.

    Parameters
    ----------
    body : Body
        With its pressures, if it has any, among its unknowns.
    exterior : Exterior
        From all of the body's unknowns to the reduced ones, the interior ones of its space first: every unknown must
        depend on one reduced unknown at most, as it does for every far field.
    surface : (m,) int array
        Reduced unknowns that the surface law and the controls may depend on.
    """
    dofs, inside = body.cell_dofs, body.inside
    outside = np.setdiff1d(np.arange(dofs.shape[1]), inside)
    reduced, weight = _by_rows(exterior.reduction.tocsr())
    first = body.space.interior_dofs.size
    size = exterior.reduction.shape[1] - first + 1
    columns = np.where(reduced < 0, size, reduced - first)[dofs[:, outside]]
    coupled = (columns[:, None, :] * size + columns[:, :, None]).ravel()
    kept = (np.broadcast_to(columns[:, None], (*columns.shape, columns.shape[1])) < size) & (columns < size)[..., None]
    kept = kept.ravel()
    keys = np.unique(np.concatenate([coupled[kept], _border(exterior, surface - first, first, size)]))
    slots = np.where(kept, np.searchsorted(keys, coupled), keys.size)
    weights = weight[dofs[:, outside]]
    return Elimination(inside, outside, reduced[dofs[:, inside]], first, columns, weights, keys, slots, size)


def _border(exterior: Exterior, surface: Index, first: int, size: int) -> Index:
    """Places of the exterior's stiffness, of the border and of its corner."""
    S = exterior.stiffness.tocoo()
    rows, columns = (np.asarray(c, dtype=np.intp) - first for c in S.coords)
    ends = np.append(surface, size - 1)
    return np.concatenate([columns * size + rows, (size - 1) * size + ends, ends * size + size - 1])


def _by_rows(T: sparse.csr_array) -> tuple[Index, Array]:
    """Column, -1 if there is none, and value of the one entry of each row."""
    counts = np.diff(T.indptr)
    columns, values = np.full(T.shape[0], -1, dtype=np.intp), np.zeros(T.shape[0])
    columns[counts > 0], values[counts > 0] = T.indices, T.data
    return columns, values
