"""Elimination of a body's unknowns down to those that are kept: exact, by ever larger regions of cells.

A region is a few cells, or two neighbouring regions joined. What no cell outside of it shares is eliminated as soon as
it is complete, so that a region is left with the unknowns on its rim and those that are kept: nested dissection, A.
George, SIAM J. Numer. Anal. 10 (1973) 345-363. All matrices on the way are dense and of some hundred unknowns, and what
is left at last is the stiffness of the surface itself; fields below are recovered from front to front.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf

from halfspace.errors import NotConverged
from halfspace.values import Array, Index, Mask, Valued

LEAST = 8  # cells of the smallest regions: with fewer there are more steps, with more the steps are longer
NOWHERE = 2**29  # a place beyond all others, where a zero is read; twice as far is a place, too
SINGULAR = "the stiffness is singular; hold the body, and mesh it without empty cells"


Places = NDArray[np.int32]
"""As many as a region's stiffness has entries, so that they are kept in half of the memory."""

Elimination = Callable[["Region", Array, Array, Array], None]
"""Takes the complete unknowns of a region out of the stiffness of those left, in place; see `Region.blocks`."""


@dataclass(frozen=True, eq=False, repr=False)
class Region(Valued):
    """Some cells, and how their stiffness is put together; the same for all meshes whose cells meet alike.

    A region joins two parts, or consists of cells, (m,), and has none. Its unknowns are (k,) that are left and the
    `complete` (c,), that are eliminated; both are numbered as those of the body. Its stiffness is one array of three
    blocks and a zero at its end, and `places` say where its entries are among the first part's, those of the second
    part, or where the entries of its cells go; see `blocks`.
    """

    parts: tuple[Region, ...]
    cells: Index
    unknowns: Index
    complete: Index
    places: tuple[Places, ...]

    @cached_property
    def nbytes(self) -> int:
        """Memory of its places and those of its parts."""
        return sum(places.nbytes for places in self.places) + sum(part.nbytes for part in self.parts)

    def stiffness(self, K: Array) -> Array:
        """Stiffness (k, k) of the unknowns that are left, from that of all cells, positive definite."""
        return self._reduced(K, lambda _, done, beside, left: eliminate(done, beside, left))

    def factorised(self, K: Array) -> tuple[list[Front], Array]:
        """What the unknowns of all its regions are recovered by, the smallest first, and the stiffness left, (k, k)."""
        fronts = []

        def by_front(region: Region, done: Array, beside: Array, left: Array) -> None:
            front, left[:] = eliminated_by(mirrored(done), beside, left, region.complete, region.unknowns)
            fronts.append(front)

        return fronts, self._reduced(K, by_front)

    def blocks(self, joined: Array) -> tuple[Array, Array, Array]:
        """The complete unknowns' stiffness (c, c), theirs with those left (c, k), and that of those left, (k, k).

        Of the two that are square the upper triangle alone has a meaning.
        """
        c, k = self.complete.size, self.unknowns.size
        beside, left = c * c, c * (c + k)
        return joined[:beside].reshape(c, c), joined[beside:left].reshape(c, k), joined[left:-1].reshape(k, k)

    def _reduced(self, K: Array, elimination: Elimination) -> Array:
        return mirrored(self.blocks(self._eliminated(K, elimination))[2])

    def _eliminated(self, K: Array, elimination: Elimination) -> Array:
        """The three blocks from all cells' stiffness, of those left without the others."""
        if self.parts:
            first, second = (part._eliminated(K, elimination) for part in self.parts)
            joined = first.take(self.places[0], mode="clip")
            joined += second.take(self.places[1], mode="clip")
        else:
            joined = np.bincount(self.places[0], K[self.cells].ravel()).astype(np.float64, copy=False)
            joined[-1] = 0.0
        elimination(self, *self.blocks(joined))
        return joined


@dataclass(frozen=True, eq=False, repr=False)
class Front(Valued):
    """Unknowns `done` (c,) that are eliminated together, by their stiffness K_cc, and K_ck with those left, (k,).

    They are found again by `recovery` (c, c + k): K_cc^-1 on the forces on them, -K_cc^-1 K_ck on those left. Or those
    of many cells at once, (cells, c) and (cells, k), of each the unknowns that no other one shares.
    """

    done: Index
    left: Index
    recovery: Array

    @property
    def inverse(self) -> Array:
        """K_cc^-1."""
        return self.recovery[..., : self.done.shape[-1]]

    @property
    def carried(self) -> Array:
        """What is left of a force, -K_cc^-1 K_ck."""
        return self.recovery[..., self.done.shape[-1] :]

    @cached_property
    def both(self) -> Index:
        """Its unknowns, and then those left."""
        return np.concatenate([self.done, self.left], axis=-1)

    def carry(self, forces: Array) -> None:
        """Carry the forces on its unknowns over to those left, in place."""
        np.add.at(forces, self.left, (forces[self.done][..., None, :] @ self.carried)[..., 0, :])

    def recover(self, u: Array) -> None:
        """Turn the forces on its unknowns into their displacements, in place, where those left are known."""
        u[self.done] = (self.recovery @ u[self.both][..., None])[..., 0]


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


@dataclass(frozen=True, eq=False, repr=False)
class Meeting(Valued):
    """How the cells of a mesh meet: all that their regions depend on.

    Facets between two cells (2, m), the cells at the ends "axis" and "contact", the unknowns (k, cells) of the cells,
    below 0 where they are held, and which of all (n,) are `kept`, in no region eliminated.
    """

    across: Index
    ends: tuple[Index, Index]
    unknowns: Index
    kept: Mask

    def regions(self) -> Region:
        """All cells as a tree of regions."""
        steps = np.array([_steps(self.across, end, self.unknowns.shape[1]) for end in self.ends])
        chosen, regions = _halved(steps)
        numbers = self.unknowns[:, chosen]
        owners = _owners(numbers, regions, self.kept)
        order = np.argsort(owners, kind="stable")  # in which they are eliminated
        rank = np.append(np.argsort(order), -1)
        made: list[Region] = []
        for number, region in enumerate(regions):
            parts = [] if region.stop - region.start <= LEAST else [made.pop(), made.pop()][::-1]
            own = rank[numbers[:, region].T] if not parts else np.concatenate([rank[part.unknowns] for part in parts])
            ranks = np.unique(own[own >= 0])
            known = order[ranks]
            complete, left = known[owners[known] == number], known[owners[known] > number]
            places = _places(parts, rank, own, ranks, complete.size)
            made.append(Region(tuple(parts), chosen[region], left, complete, places))
        return made[0]


DISSECTED: list[tuple[Meeting, Region]] = []  # last: the next operator saves a quarter of its time
DISSECTED_ROOM = 5e7  # bytes of these beside which another, however large, is kept: the spheres of a pair take turns


def dissected(mesh: Any, unknowns: Index, kept: Mask) -> Region:
    """All cells of a mesh, which has the boundaries "axis" and "contact", as a tree of regions.

    Other arguments are as of `Meeting`. The same tree as before where the cells meet alike.
    """
    across = np.asarray(mesh.f2t[:, mesh.f2t[1] >= 0], dtype=np.intp)
    axis, contact = (mesh.f2t[0, mesh.boundaries[name]] for name in ("axis", "contact"))
    meeting = Meeting(across, (axis, contact), unknowns, kept)
    recent = list(DISSECTED)  # another thread may change it
    known = next((region for other, region in recent if other == meeting), None)
    if known is None:
        while sum(region.nbytes for _, region in recent) > DISSECTED_ROOM:
            del recent[0]
        DISSECTED[:] = recent  # before the next is made, since both at once take twice the memory
        known = meeting.regions()
        DISSECTED.append((meeting, known))
    return known


def eliminated_by(K_cc: Array, K_ck: Array, K_kk: Array, done: Index, left: Index) -> tuple[Front, Array]:
    """What unknowns are recovered by, and the stiffness without them; theirs need not be positive definite.

    Or those of each of many cells, K_cc (cells, c, c).
    """
    inverse = inverses(K_cc)
    front = Front(done, left, np.concatenate([inverse, -inverse @ K_ck], axis=-1))
    return front, K_kk + K_ck.swapaxes(-1, -2) @ front.carried


def inverses(blocks: Array) -> Array:
    """Inverses of symmetric matrices, (..., n, n), definite or not; raise NotConverged if one is singular."""
    try:
        return np.asarray(np.linalg.inv(blocks), dtype=np.float64)
    except np.linalg.LinAlgError as error:
        raise NotConverged(f"{SINGULAR}; of a tangent: try another control or a nearer start") from error


def eliminate(done: Array, beside: Array, left: Array) -> None:
    """Take unknowns out of the stiffness (k, k) of those left, in place; raise NotConverged if not positive definite.

    `done` (c, c) is theirs, `beside` (c, k) what couples both. They are contiguous and overwritten; of the square ones
    the upper triangle is used.
    """
    if len(done):
        # By columns, as LAPACK has them, these are the lower triangles.
        lower, info = dpotrf(done.T, lower=1, clean=0, overwrite_a=1)
        if info:
            raise NotConverged(SINGULAR)
        W = dtrsm(1.0, lower, beside.T, side=1, lower=1, trans_a=1, overwrite_b=1)
        dsyrk(-1.0, W, 1.0, left.T, lower=1, overwrite_c=1)


def mirrored(upper: Array) -> Array:
    """Symmetric matrices (..., n, n) of which the upper triangle is given."""
    return np.where(np.tri(upper.shape[-1], dtype=bool), upper.swapaxes(-1, -2), upper)


def factor(matrix: Array) -> Array:
    """Cholesky's lower factor of a symmetric matrix; raise NotConverged unless it is positive definite."""
    lower, info = dpotrf(matrix, lower=1)
    if info:
        raise NotConverged(SINGULAR)
    return np.asarray(lower)


def reduced_cells(K: Array, t: Array) -> Array:
    """Cell matrices T' K T (cells, k + g, k + g) of K (cells, k, k), t (cells, k, g) as of `reduced_unknowns`."""
    if not t.size:
        return K
    Kt = K @ t
    return np.block([[K, Kt], [Kt.transpose(0, 2, 1), t.transpose(0, 2, 1) @ Kt]])


def reduced_unknowns(dofs: Index, T: sparse.csc_array) -> tuple[Index, Array]:
    """Unknowns x (k + g, cells) that cells couple, u = T x, and the columns of T that select none, (cells, k, g).

    The unknowns u have the numbers dofs (k, cells); those of x are -1 where there is none. Most columns of T (N, n)
    select one unknown; any other becomes an unknown of all cells that it moves.
    """
    selects = (np.diff(T.indptr) == 1) & (np.add.reduceat(T.data, T.indptr[:-1]) == 1)
    number, gathering = np.full(T.shape[0], -1), np.flatnonzero(~selects)
    number[T.indices[T.indptr[:-1][selects]]] = np.flatnonzero(selects)
    t = T[:, gathering].toarray()[dofs].transpose(1, 0, 2)
    return np.vstack([number[dofs], np.where(t.any(axis=1), gathering, -1).T]), t


def _halved(steps: Index, start: int = 0) -> tuple[Index, list[slice]]:
    """Cells in the order of the regions, and these as parts of that order, each after those it consists of."""
    count = steps.shape[1]
    if count <= LEAST:
        return np.arange(count), [slice(start, start + count)]
    first = _half(steps)
    order, regions = _halved(steps[:, first], start)
    others, more = _halved(steps[:, ~first], start + order.size)
    both = np.append(np.flatnonzero(first)[order], np.flatnonzero(~first)[others])
    return both, [*regions, *more, slice(start, start + count)]


def _owners(numbers: Index, regions: list[slice], kept: Mask) -> Index:
    """Of each unknown the first region that has all its cells; one more than there are if it is kept."""
    free = numbers >= 0
    first, last = np.full(kept.size, numbers.shape[1]), np.full(kept.size, -1)
    cells = np.broadcast_to(np.arange(numbers.shape[1]), numbers.shape)[free]
    np.minimum.at(first, numbers[free], cells)
    np.maximum.at(last, numbers[free], cells)
    owners = np.full(kept.size, len(regions))
    for number, region in reversed(list(enumerate(regions))):
        owners[(first >= region.start) & (last < region.stop)] = number
    owners[kept] = len(regions)
    return owners


def _places(parts: list[Region], rank: Index, own: Index, ranks: Index, c: int) -> tuple[Places, ...]:
    """Where a region's entries are in its parts, or where those of its cells go, see `Region`.

    The c unknowns that are complete are the first in the ranks, which ascend, as they do in the parts.
    """
    size, k = ranks.size, ranks.size - c
    if not parts:
        at = np.where(own < 0, size, np.searchsorted(ranks, own))
        row, column = at[:, :, None], at[:, None, :]
        places = np.where(column < c, row * c, c * c - c + row * k) + column
        return (np.where((row <= column) & (column < size), places, c * c + size * k).ravel().astype(np.int32),)
    return tuple(_places_in(part, np.searchsorted(ranks, rank[part.unknowns]), size, c) for part in parts)


def _places_in(part: Region, ranks: Index, size: int, c: int) -> Places:
    """Where the entries of a region of some size are in a part, whose unknowns have these ranks among the region's."""
    if size**2 >= NOWHERE:
        raise NotConverged(f"{size} unknowns meet between parts of the body, with more products than are numbered")
    at, rows = np.full((2, size), NOWHERE, dtype=np.int32)
    at[ranks] = np.arange(ranks.size)
    rows[ranks] = ranks.size * at[ranks] + part.complete.size * (part.complete.size + ranks.size)
    places: Places = np.empty(c * size + (size - c) ** 2 + 1, dtype=np.int32)
    done, beside, left = np.split(places[:-1], [c * c, c * size])
    np.add.outer(rows[:c], at[:c], out=done.reshape(c, c))
    np.add.outer(rows[:c], at[c:], out=beside.reshape(c, size - c))
    np.add.outer(rows[c:], at[c:], out=left.reshape(size - c, size - c))
    places[-1] = NOWHERE
    return places


def _half(steps: Index) -> Mask:
    """Which cells are one half of a region, cut where it has most steps across."""
    across = int(np.argmax([np.unique(row).size for row in steps]))
    values, counts = np.unique(steps[across], return_counts=True)
    if values.size == 1:
        return np.asarray(np.arange(steps.shape[1]) < steps.shape[1] // 2)
    middle = np.argmin(np.abs(np.cumsum(counts)[:-1] - steps.shape[1] / 2))
    return np.asarray(steps[across] <= values[middle])


def _steps(pairs: Index, first: Index, cells: int) -> Index:
    """Steps from cell to cell, over the facets between pairs (2, m) of them, from the first ones."""
    steps = np.full(cells, -1)
    steps[first] = 0
    for step in range(1, cells):
        reached = steps[pairs] == step - 1
        new = pairs[::-1][reached & (steps[pairs[::-1]] < 0)]
        if not new.size:
            break
        steps[new] = step
    return steps
