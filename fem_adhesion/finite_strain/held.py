"""A body as it is held, and Newton's linear equations on it: the body's tangent is kept from a state near by.

Only the surface law is far from linear. A change of the body's state by a part d of its size changes its tangent K by
some delta d only, so that the factors of one state serve many: what they leave of a solution is solved for by them
again, a part of the order of delta d each time. What a step changes at once is the law's tangent on the m unknowns of
the contact surface, m a twentieth of all; so the body is condensed to these, C = E' K^-1 E, and with the law's tangent
S, its derivative b by the approach and the row (r, r_a) of a control

    [[I + C S, C b], [r, r_a]] (s, alpha) = (E' K^-1 f, g),        y = K^-1 (f - E (S s + b alpha)).

The unknowns interior to a cell are eliminated before, as in `fem_adhesion.elasticity.condensation`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dgetrf, dgetrs
from scipy.sparse.linalg import LinearOperator, gmres, splu

from fem_adhesion.elasticity.far_field import Exterior
from fem_adhesion.elasticity.space import scatter
from fem_adhesion.finite_strain.body import Body
from halfspace.equilibrium.contact import Solver
from halfspace.errors import NotConverged
from halfspace.values import Array, Index, Valued

SLOW = 0.1  # part of the error that an iteration may leave; a state that leaves more gets a tangent of its own
SOLVED = 1e-11  # relative accuracy of the linear equations where all digits are asked for


@dataclass(frozen=True, eq=False, repr=False)
class Layout(Valued):
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
        last stands for none.
    weights : (cells, o) array
        And the factor with which it does.
    size : int
        Number of shared unknowns.
    surface : (m,) int array
        Those of the contact surface among them.
    """

    inside: Index
    outside: Index
    inner: Index
    first: int
    columns: Index
    weights: Array
    size: int
    surface: Index


@dataclass(frozen=True, eq=False, repr=False)
class Tangent(Valued):
    """The tangent of a held body at one state, factorised, and condensed to the contact surface.

    Attributes
    ----------
    layout : Layout
        Numbering.
    y : (n,) array
        The state.
    inverse, recovery : (cells, i, i) and (cells, i, o) array
        K_ii^-1 and K_ii^-1 K_io of every cell, the latter from the reduced unknowns.
    factors : scipy.sparse.linalg.SuperLU
        Of the shared unknowns.
    """

    layout: Layout
    y: Array
    inverse: Array
    recovery: Array
    factors: Any

    @cached_property
    def influence(self) -> Array:
        """Displacements of the shared unknowns under unit forces on those of the surface, (shared, m)."""
        forces = np.zeros((self.layout.size, self.layout.surface.size))
        forces[self.layout.surface, np.arange(self.layout.surface.size)] = 1.0
        return np.asarray(self.factors.solve(forces))

    @property
    def flexibility(self) -> Array:
        """C, (m, m)."""
        return self.influence[self.layout.surface]

    def surface_change(self, forces: Array) -> Array:
        """Change of the surface's unknowns, (m,), under forces on all, (n,)."""
        return np.asarray(self.influence.T @ self._shared(forces))

    def bordered(self, change: Array, row: Array) -> Callable[[Array], Array]:
        """Solver of the equations with the law's tangent, for right-hand sides (n + 1,).

        Parameters
        ----------
        change : (m, m + 1) array
            (S, b).
        row : (m + 1,) array
            Of the control.
        """
        surface = self.layout.surface
        matrix = np.vstack([np.eye(*change.shape) + self.flexibility @ change, row])
        lu, pivots, info = dgetrf(matrix, overwrite_a=True)
        if info > 0:
            raise NotConverged("the bordered Jacobian is singular; try another control or a nearer start")

        def solve(rhs: Array) -> Array:
            shared = self._shared(rhs[:-1])
            ends = dgetrs(lu, pivots, np.append(self.influence.T @ shared, rhs[-1]))[0]
            shared[surface] -= change @ ends
            return np.append(self._all(shared, rhs), ends[-1])

        return solve

    def negative_pivots(self) -> int:
        """Count the negative pivots, those of the interior unknowns included."""
        interior = np.linalg.eigvalsh(self.inverse) < 0
        return int(np.sum(interior) + np.sum(self.factors.U.diagonal() < 0))

    def _shared(self, forces: Array) -> Array:
        """Forces on the shared unknowns with those on the interior ones carried over."""
        e = self.layout
        carried = (self.recovery.transpose(0, 2, 1) @ forces[e.inner][..., None])[..., 0]
        sums = np.bincount(e.columns.ravel(), weights=carried.ravel(), minlength=e.size + 1)
        return np.asarray(forces[e.first :] - sums[:-1])

    def _all(self, shared: Array, forces: Array) -> Array:
        """All reduced unknowns, (n,), from the forces on the shared ones and on the interior ones."""
        e, y = self.layout, np.empty(self.y.size)
        y[e.first :] = self.factors.solve(shared)
        outer = np.append(y[e.first :], 0.0)[e.columns][..., None]
        y[e.inner] = (self.inverse @ forces[e.inner][..., None] - self.recovery @ outer)[..., 0]
        return y


@dataclass(frozen=True, eq=False, repr=False)
class HeldBody(Valued):
    """A body with what holds it: forces, tangent and energy of its n reduced unknowns y, u = T y.

    Attributes
    ----------
    body : Body
        The body.
    exterior : Exterior
        From all of the body's unknowns to the reduced ones, the interior ones of its space first: every unknown must
        depend on one reduced unknown at most, as it does for every far field.
    surface : (m,) int array
        Reduced unknowns that the surface law and the controls may depend on.
    """

    body: Body
    exterior: Exterior
    surface: Index

    @property
    def size(self) -> int:
        """Number n of reduced unknowns."""
        return int(self.exterior.reduction.shape[1])

    def unknowns(self, y: Array) -> Array:
        """All unknowns of the body, (N + M,)."""
        return np.asarray(self.exterior.reduction @ y)

    def forces(self, y: Array) -> Array:
        """Forces of body and exterior, (n,)."""
        return np.asarray(
            self._transposed @ self.body.forces(self.unknowns(y)) + self.exterior.stiffness @ y, dtype=np.float64
        )

    def tangent_product(self, y: Array) -> Callable[[Array], Array]:
        """Derivative of the forces along any change of y."""
        product = self.body.tangent_product(self.unknowns(y))
        return lambda dy: np.asarray(self._transposed @ product(self.unknowns(dy)) + self.exterior.stiffness @ dy)

    def energy(self, y: Array) -> float:
        """Elastic energy of body and exterior in R dgamma mu eps."""
        return self.body.energy(self.unknowns(y)) + float(y @ (self.exterior.stiffness @ y)) / 2

    def least_volume_ratio(self, y: Array) -> float:
        """Least J at any quadrature point."""
        return self.body.least_volume_ratio(self.unknowns(y))

    def solver(self, y: Array, change: Array, row: Array) -> Solver:
        """Solver of the bordered equations of a state, see `Tangent.bordered`, by the tangent at hand if it will do."""
        product = cache(lambda: self.tangent_product(y))

        def bordered(x: Array) -> Array:
            ends, forces = np.append(x[self.surface], x[-1]), product()(x[:-1])
            forces[self.surface] += change @ ends
            return np.append(forces, row @ ends)

        def solve(rhs: Array, accuracy: float = 0.0) -> Array:
            tangent = self.near
            nearly = tangent.bordered(change, row)
            x = nearly(rhs)
            if self._exact(tangent, y):
                return x
            operator = LinearOperator(2 * (rhs.size,), matvec=lambda v: nearly(bordered(v)), dtype=np.float64)
            rtol = max(accuracy, SOLVED)
            x, unsolved = gmres(operator, x, rtol=rtol, atol=0.0, restart=math.ceil(math.log(rtol, SLOW)), maxiter=1)
            return self.tangent(y).bordered(change, row)(rhs) if unsolved else np.asarray(x)

        return solve

    @property
    def near(self) -> Tangent:
        """The tangent made last, or else that of the undeformed body."""
        return self._made[-1] if self._made else self.undeformed

    @cached_property
    def undeformed(self) -> Tangent:
        """Tangent of the undeformed body."""
        return self._factorised(np.zeros(self.size))

    def tangent(self, y: Array) -> Tangent:
        """Tangent of a state, made unless it was the last."""
        if not (self._made and self._exact(self._made[-1], y)):
            self._made[:] = [self._factorised(y)]
        return self._made[-1]

    @cached_property
    def _made(self) -> list[Tangent]:
        return []

    def _exact(self, tangent: Tangent, y: Array) -> bool:
        return not self.body.stretch or np.array_equal(tangent.y, y)

    def _factorised(self, y: Array) -> Tangent:
        """Eliminate the interior unknowns and factorise the rest."""
        e, cells = self._layout, self.body.cell_tangents(self.unknowns(y))
        inside, outside = e.inside, e.outside
        K_io = cells[:, inside[:, None], outside] * e.weights[:, None]
        inverse = _inverse(cells[:, inside[:, None], inside])
        recovery: Array = inverse @ K_io
        K_oo = cells[:, outside[:, None], outside] * (e.weights[:, :, None] * e.weights[:, None, :])
        K_oo -= K_io.transpose(0, 2, 1) @ recovery
        shared = scatter(K_oo, e.columns.T, e.size + 1)[:-1, :-1]
        return Tangent(e, y.copy(), inverse, recovery, _factors(shared + self.exterior.stiffness[e.first :, e.first :]))

    @cached_property
    def _transposed(self) -> sparse.csr_array:
        return sparse.csr_array(self.exterior.reduction.T)

    @cached_property
    def _layout(self) -> Layout:
        dofs, inside, T = self.body.cell_dofs, self.body.inside, self.exterior.reduction.tocsr()
        outside, first = np.setdiff1d(np.arange(dofs.shape[1]), inside), self.body.space.interior_dofs.size
        rows, reduced = T.nonzero()
        column, weight = np.full(T.shape[0], self.size, dtype=np.intp), np.zeros(T.shape[0])
        column[rows], weight[rows] = reduced, T.data[T.data != 0]
        shared = (column[dofs[:, outside]] - first, weight[dofs[:, outside]], self.size - first)
        return Layout(inside, outside, column[dofs[:, inside]], first, *shared, self.surface - first)


def _inverse(blocks: Array) -> Array:
    try:
        return np.asarray(np.linalg.inv(blocks), dtype=np.float64)
    except np.linalg.LinAlgError as error:
        raise NotConverged("the tangent of a cell is singular; try another control or a nearer start") from error


def _factors(matrix: sparse.csc_array) -> Any:
    try:  # symmetric: ordered as such, without exchanges, so that the pivots tell the inertia
        return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:  # SuperLU's way of saying so
        raise NotConverged("the body's tangent is singular; try another control or a nearer start") from error
