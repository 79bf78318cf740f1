"""Elimination of a body's unknowns down to those that are kept: exact, by ever larger regions of cells.

A region is a few cells, or two neighbouring regions joined. What no cell outside of it shares is eliminated as soon as
it is complete, so that a region is left with the unknowns on its rim and those that are kept: nested dissection, A.
George, SIAM J. Numer. Anal. 10 (1973) 345-363. All matrices on the way are dense and of some hundred unknowns, and what
is left at last is the stiffness of the surface itself; fields below are recovered from front to front.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg.blas import dtrsm
from scipy.linalg.lapack import dpotrf

from halfspace.errors import NotConverged
from halfspace.values import Array, Index, Mask, Valued

LEAST = 8  # cells of the smallest regions: with fewer there are more steps, with more they are longer
SINGULAR = "the stiffness is singular; hold the body, and mesh it without empty cells"


@dataclass(frozen=True, eq=False, repr=False)
class Region(Valued):
    """Some cells, and how their stiffness is put together; the same for all meshes whose cells meet alike.

    A region joins two parts, or consists of cells and has none; it has the cells of the numbers (m,). Of the unknowns
    that are left, (k,), `shares` (k,) says how many of the cells have each. The entries are the places of those of the
    cells', or the parts', matrices in its own, which is of the size; `complete` (c,) are the numbers of the unknowns
    that are eliminated, its first.
    """

    parts: tuple[Region, ...]
    cells: Index
    unknowns: Index
    shares: Index
    entries: Index
    size: int
    complete: Index

    def stiffness(self, K: Array) -> Array:
        """Stiffness (k, k) of the unknowns that are left, from that of all cells, positive definite."""
        return eliminated(
            self._joined([part.stiffness(K) for part in self.parts] or [K[self.cells]]), self.complete.size
        )

    def factorised(self, K: Array) -> tuple[list[Front], Array]:
        """What the unknowns of all its regions are recovered by, the smallest first, and the stiffness left, (k, k)."""
        parts = [part.factorised(K) for part in self.parts]
        joined = self._joined([left for _, left in parts] or [K[self.cells]])
        own, left = eliminated_by(joined, self.complete, self.unknowns)
        return [*(front for fronts, _ in parts for front in fronts), own], left

    def _joined(self, matrices: list[Array]) -> Array:
        """Stiffness of the complete unknowns and those left, from those of the parts or the cells."""
        joined = np.bincount(self.entries, np.concatenate([matrix.ravel() for matrix in matrices]), self.size**2)
        used = self.complete.size + self.unknowns.size
        return np.asarray(joined, dtype=np.float64).reshape(self.size, self.size)[:used, :used]


@dataclass(frozen=True, eq=False, repr=False)
class Front(Valued):
    """Unknowns `done` (c,) that are eliminated together, by their stiffness K_cc, and K_ck with those left, (k,).

    `inverse` (c, c) is K_cc^-1, `recovery` (c, k) K_cc^-1 K_ck.
    """

    done: Index
    left: Index
    inverse: Array
    recovery: Array

    def carry(self, forces: Array) -> None:
        """Carry the forces on its unknowns over to those left, in place."""
        forces[self.left] -= forces[self.done] @ self.recovery

    def recover(self, u: Array) -> None:
        """Turn the forces on its unknowns into their displacements, in place, where those left are known."""
        u[self.done] = self.inverse @ u[self.done] - self.recovery @ u[self.left]


@dataclass(frozen=True, eq=False, repr=False)
class Interiors(Front):
    """The same of many cells at once, (cells, c) and (cells, k): of each the unknowns that no other one shares."""

    def carry(self, forces: Array) -> None:
        """Carry the forces on its unknowns over to those left, in place."""
        np.subtract.at(forces, self.left, (forces[self.done][:, None] @ self.recovery)[:, 0])

    def recover(self, u: Array) -> None:
        """Turn the forces on its unknowns into their displacements, in place, where those left are known."""
        u[self.done] = (self.inverse @ u[self.done][..., None] - self.recovery @ u[self.left][..., None])[..., 0]


@dataclass(frozen=True, eq=False, repr=False)
class Factors(Valued):
    """A factorised stiffness of n unknowns: fronts that are eliminated one after the other, and that of those left.

    Vectors on the way have a last number for all unknowns that are held, (n + 1,).
    """

    fronts: list[Front]
    left: Index
    stiffness: Array

    @cached_property
    def flexibility(self) -> Array:
        """Inverse of the stiffness (k, k) of those left."""
        return inverses(self.stiffness)

    def carried(self, forces: Array) -> Array:
        """Forces (n,) with those on eliminated unknowns carried over to those left, (n + 1,)."""
        x = np.append(forces, 0.0)
        for front in self.fronts:
            front.carry(x)
        return x

    def recover(self, x: Array, ends: Array) -> None:
        """Turn what was carried into displacements, in place, where those left have the displacements `ends`."""
        x[self.left], x[-1] = ends, 0.0
        for front in reversed(self.fronts):
            front.recover(x)

    def solve(self, forces: Array) -> Array:
        """Displacements (n,) under forces (n,)."""
        x = self.carried(forces)
        self.recover(x, self.flexibility @ x[self.left])
        return x[:-1]


def dissected(mesh: Any, unknowns: Index, kept: Mask) -> Region:
    """All cells of a mesh, which has the boundaries "axis" and "contact", as a tree of regions.

    The unknowns (k, cells) of the cells are below 0 where they are held; kept (n,) says which of all are in no region
    eliminated.
    """
    steps = np.array([_steps(mesh, mesh.f2t[0, mesh.boundaries[name]]) for name in ("axis", "contact")])
    shares = np.bincount(unknowns[unknowns >= 0], minlength=kept.size).astype(np.intp)
    shares[kept] = 0  # in no region is it complete
    return _dissected(unknowns.tobytes(), steps.tobytes(), shares.tobytes(), steps.shape[1])


def eliminated_by(K: Array, done: Index, left: Index) -> tuple[Front, Array]:
    """What the first unknowns are recovered by, and the stiffness without them; it need not be positive definite.

    Or those of each of many cells, K (cells, n, n).
    """
    count, kind = done.shape[-1], Interiors if done.ndim > 1 else Front
    inverse = inverses(K[..., :count, :count])
    recovery = inverse @ K[..., :count, count:]
    return kind(done, left, inverse, recovery), K[..., count:, count:] - K[..., count:, :count] @ recovery


def inverses(blocks: Array) -> Array:
    """Inverses of symmetric matrices, (..., n, n), definite or not; raise NotConverged if one is singular."""
    try:
        return np.asarray(np.linalg.inv(blocks), dtype=np.float64)
    except np.linalg.LinAlgError as error:
        raise NotConverged(f"{SINGULAR}; of a tangent: try another control or a nearer start") from error


def eliminated(K: Array, count: int) -> Array:
    """Stiffness without the first unknowns, so many; raise NotConverged unless it is positive definite in them."""
    if not count:
        return K
    W = dtrsm(1.0, factor(K[:count, :count]), K[count:, :count], side=1, lower=1, trans_a=1)
    return np.asarray(K[count:, count:] - W @ W.T)


def factor(matrix: Array) -> Array:
    """Cholesky's lower factor of a symmetric matrix; raise NotConverged unless it is positive definite."""
    lower, info = dpotrf(matrix, lower=1)
    if info:
        raise NotConverged(SINGULAR)
    return np.asarray(lower)


def reduced_cells(K: Array, dofs: Index, T: sparse.csc_array) -> tuple[Array, Index]:
    """Cell matrices T' K T (cells, k + g, k + g) and the unknowns x (k + g, cells) they couple, where u = T x.

    K (cells, k, k) is of the unknowns u of the numbers dofs (k, cells); the numbers of x are -1 where there is no
    unknown. Most columns of T (N, n) select one unknown; any other becomes an unknown of all cells that it moves.
    """
    unknowns, t = reduced_unknowns(dofs, T)
    if not t.size:
        return K, unknowns
    Kt = K @ t
    return np.block([[K, Kt], [Kt.transpose(0, 2, 1), t.transpose(0, 2, 1) @ Kt]]), unknowns


def reduced_unknowns(dofs: Index, T: sparse.csc_array) -> tuple[Index, Array]:
    """Of these the numbers of x, (k + g, cells), and the columns of T that select none, cell by cell, (cells, k, g)."""
    selects = (np.diff(T.indptr) == 1) & (np.add.reduceat(T.data, T.indptr[:-1]) == 1)
    number, gathering = np.full(T.shape[0], -1), np.flatnonzero(~selects)
    number[T.indices[T.indptr[:-1][selects]]] = np.flatnonzero(selects)
    t = T[:, gathering].toarray()[dofs].transpose(1, 0, 2)
    return np.vstack([number[dofs], np.where(t.any(axis=1), gathering, -1).T]), t


@lru_cache(maxsize=1)
def _dissected(unknowns: bytes, steps: bytes, shares: bytes, cells: int) -> Region:
    """All cells as a tree of regions; kept, as bodies are meshed for several contact radii near each other."""
    numbers, away = (np.frombuffer(data, dtype=np.intp).reshape(-1, cells) for data in (unknowns, steps))
    complete = np.frombuffer(shares, dtype=np.intp)

    def region(chosen: Index) -> Region:
        if chosen.size <= LEAST:
            own = numbers[:, chosen].T
            return _region((), chosen, own, np.ones_like(own), complete)
        first = _half(away[:, chosen])
        parts = region(chosen[first]), region(chosen[~first])
        return _region(parts, chosen, [part.unknowns for part in parts], [part.shares for part in parts], complete)

    return region(np.arange(cells))


def _region(
    parts: tuple[Region, ...], cells: Index, unknowns: Iterable[Index], shares: Iterable[Index], complete: Index
) -> Region:
    """Region of matrices with these unknowns: first those that are complete, then those left, then those held."""
    unknowns = list(unknowns)
    numbers, places = np.unique(np.concatenate(unknowns), return_inverse=True)
    shared = np.bincount(places, np.concatenate(list(shares))).astype(np.intp)
    held = numbers < 0
    done = ~held & (shared == complete[numbers])
    order = np.argsort(np.where(held, 2, ~done), kind="stable")
    places = np.argsort(order)[places]
    rows = np.split(places, np.cumsum([own.size for own in unknowns])[:-1])
    entries = np.concatenate([(row[:, None] * numbers.size + row).ravel() for row in rows])
    left = order[done.sum() : numbers.size - np.count_nonzero(held)]
    return Region(parts, cells, numbers[left], shared[left], entries, numbers.size, numbers[order[: done.sum()]])


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
