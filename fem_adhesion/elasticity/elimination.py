"""Elimination of a body's unknowns down to those that are kept: exact, by ever larger regions of cells.

A region is a few cells, or two neighbouring regions joined. What no cell outside of it shares is eliminated as soon as
it is complete, so that a region is left with the unknowns on its rim and those that are kept: nested dissection, A.
George, SIAM J. Numer. Anal. 10 (1973) 345-363. All matrices on the way are dense and of some hundred unknowns, and what
is left at last is the stiffness of the surface itself: no right-hand side is solved for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg.blas import dtrsm
from scipy.linalg.lapack import dpotrf

from halfspace.errors import NotConverged
from halfspace.values import Array, Index

Mask = NDArray[np.bool_]

LEAST = 8  # cells of the smallest regions: with fewer there are more steps, with more they are longer
SINGULAR = "the stiffness is singular; hold the body, and mesh it without empty cells"


@dataclass(frozen=True)
class Region:
    """Stiffness of some cells, as that of one or more parts.

    Attributes
    ----------
    unknowns : (parts, k) int array
        Numbers of the unknowns that are left, below 0 where they are held.
    shares : (parts, k) int array
        How many of the cells have each of them.
    stiffness : (parts, k, k) array
        Symmetric.
    """

    unknowns: Index
    shares: Index
    stiffness: Array


def condensed_to(mesh: Any, K: Array, unknowns: Index, kept: Mask) -> tuple[Index, Array]:
    """Stiffness of a body, condensed to some of its unknowns.

    Parameters
    ----------
    mesh : skfem.Mesh
        With the boundaries "axis" and "contact".
    K : (cells, k, k) array
        Stiffness of its cells, symmetric.
    unknowns : (k, cells) int array
        Numbers of their unknowns, below 0 where they are held.
    kept : (n,) bool array
        Which of all unknowns are kept.

    Returns
    -------
    (m,) int array, (m, m) array
        Numbers of those kept that some cell has, and their stiffness.

    Raises
    ------
    NotConverged
        If the stiffness is singular.
    """
    complete = np.bincount(unknowns[unknowns >= 0], minlength=kept.size)
    complete[kept] = 0  # as it is in no region
    steps = np.array([_steps(mesh, mesh.f2t[0, mesh.boundaries[name]]) for name in ("axis", "contact")])

    def region(cells: Index) -> Region:
        if cells.size <= LEAST:
            own = unknowns[:, cells].T
            return _joined([Region(own, np.ones(own.shape, dtype=np.intp), K[cells])], complete)
        first = _half(steps[:, cells])
        return _joined([region(cells[first]), region(cells[~first])], complete)

    whole = region(np.arange(len(K)))
    return whole.unknowns[0], whole.stiffness[0]


def factor(matrix: Array) -> Array:
    """Cholesky's lower factor of a symmetric matrix; raise NotConverged unless it is positive definite."""
    lower, info = dpotrf(matrix, lower=1)
    if info:
        raise NotConverged(SINGULAR)
    return np.asarray(lower)


def reduced_cells(K: Array, dofs: Index, T: sparse.csc_array) -> tuple[Array, Index]:
    """Cell matrices T' K T and the unknowns x they couple, where u = T x.

    Parameters
    ----------
    K : (cells, k, k) array
        Of the unknowns u.
    dofs : (k, cells) int array
        Their numbers.
    T : (N, n) sparse array
        Most columns select one unknown; any other becomes an unknown of all cells that it moves.

    Returns
    -------
    (cells, k + g, k + g) array, (k + g, cells) int array
        Numbers are -1 where there is no unknown.
    """
    selects = (np.diff(T.indptr) == 1) & (np.add.reduceat(T.data, T.indptr[:-1]) == 1)
    number = np.full(T.shape[0], -1)
    number[T.indices[T.indptr[:-1][selects]]] = np.flatnonzero(selects)
    unknowns, gathering = number[dofs], np.flatnonzero(~selects)
    if not gathering.size:
        return K, unknowns
    t = T[:, gathering].toarray()[dofs].transpose(1, 0, 2)
    Kt = K @ t
    extended = np.block([[K, Kt], [Kt.transpose(0, 2, 1), t.transpose(0, 2, 1) @ Kt]])
    return extended, np.vstack([unknowns, np.where(t.any(axis=1), gathering, -1).T])


def _joined(regions: Sequence[Region], complete: Index) -> Region:
    """Regions joined to one part, without the unknowns that are complete then."""
    numbers, places = np.unique(np.concatenate([r.unknowns.ravel() for r in regions]), return_inverse=True)
    shares = np.bincount(places, np.concatenate([r.shares.ravel() for r in regions])).astype(np.intp)
    held = numbers < 0
    done = ~held & (shares == complete[numbers])
    order = np.argsort(np.where(held, 2, ~done), kind="stable")
    n, k = numbers.size, np.count_nonzero(done)
    places, left = np.argsort(order)[places], order[k : n - np.count_nonzero(held)]
    splits = np.split(places, np.cumsum([r.unknowns.size for r in regions])[:-1])
    rows = [part.reshape(r.unknowns.shape) for part, r in zip(splits, regions, strict=True)]
    entries = np.concatenate([(row[:, :, None] * n + row[:, None, :]).ravel() for row in rows])
    values = np.concatenate([r.stiffness.ravel() for r in regions])
    K = np.asarray(np.bincount(entries, values, n * n), dtype=np.float64).reshape(n, n)
    rest = slice(k, k + left.size)
    condensed = K[rest, rest]
    if k:
        W = dtrsm(1.0, factor(K[:k, :k]), K[rest, :k], side=1, lower=1, trans_a=1)
        condensed = condensed - W @ W.T
    return Region(numbers[left][None], shares[left][None], condensed[None])


def _half(steps: Index) -> Mask:
    """Which cells are one half of a region, cut where it has most steps across."""
    across = int(np.argmax([np.unique(row).size for row in steps]))
    values, counts = np.unique(steps[across], return_counts=True)
    if values.size == 1:
        return np.asarray(np.arange(steps.shape[1]) < steps.shape[1] // 2)
    middle = np.argmin(np.abs(np.cumsum(counts)[:-1] - steps.shape[1] / 2))
    return np.asarray(steps[across] <= values[middle])


def _steps(mesh: Any, first: Index) -> Index:
    """Steps from cell to cell, over facets, from the first ones."""
    steps = np.full(mesh.nelements, -1)
    steps[first] = 0
    pairs = mesh.f2t[:, mesh.f2t[1] >= 0]
    for step in range(1, mesh.nelements):
        reached = steps[pairs] == step - 1
        new = pairs[::-1][reached & (steps[pairs[::-1]] < 0)]
        if not new.size:
            break
        steps[new] = step
    return steps
