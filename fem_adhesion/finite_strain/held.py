"""A body as it is held, and Newton's linear equations on it.

What the surface law changes at once is its tangent on the m unknowns of the contact surface, m a twentieth of all; so
the body's tangent is condensed to these, to the stiffness C and the forces g, and with the law's tangent S, its
derivative b by the approach and the row (r, r_a) of a control

    [[C + S, b], [r, r_a]] (s, alpha) = (g, g_a),

whence all others are recovered: see `fem_adhesion.elasticity.elimination`. Those interior to a cell go before.

Only the surface law is far from linear. The body's tangent changes by a part of the order of the change of strain, so
that the factors made at one state serve others near it: what they leave of a solution is solved for by them again,
until it is as accurate as asked for. Where that converges slowly the state gets factors of its own. For the events of
tabor 1 and R/eps 100 to 1e-6 that leaves 22 factorisations of 58; see `fem_adhesion.finite_strain.settings`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from scipy import sparse

from fem_adhesion.elasticity.condensation import Dissection
from fem_adhesion.elasticity.elimination import Factors
from fem_adhesion.elasticity.exterior import Exterior
from fem_adhesion.finite_strain.body import Body
from fem_adhesion.finite_strain.settings import USUAL, Settings
from halfspace.equilibrium.contact import Solver, count_negative, factorised
from halfspace.values import Array, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Tangent(Factors):
    """The tangent of a held body at one state, factorised, and condensed to the contact surface.

    It depends on the displacement gradients alone, that is on delta y, (n,). What is left are the reduced unknowns of
    the surface, (m,), and the stiffness (m, m) is C.
    """

    stretched: Array

    def surface_change(self, forces: Array) -> Array:
        """Change of the surface's unknowns, (m,), under forces on all, (n,)."""
        return np.asarray(self.flexibility @ self.carried(forces)[self.left])

    def bordered(self, change: Array, row: Array) -> Callable[[Array], Array]:
        """Solver of the equations with the law's tangent, for right-hand sides (n + 1,).

        The change (m, m + 1) is (S, b), the row (m + 1,) that of the control. All nan if they make it singular.
        """
        matrix = np.vstack([change, row])
        matrix[:-1, :-1] += self.stiffness
        solved = factorised(matrix)

        def solve(rhs: Array) -> Array:
            x = self.carried(rhs[:-1])
            ends = solved(np.append(x[self.left], rhs[-1]))
            self.recover(x, ends[:-1])
            x[-1] = ends[-1]
            return x

        return solve

    def negative_directions(self) -> int:
        """Count the negative ones among those of all unknowns but the surface's."""
        shared = sum(count_negative(front.inverse) for front in self.fronts[1:] if front.done.size)
        return int(np.sum(np.linalg.eigvalsh(self.fronts[0].inverse) < 0)) + shared


@dataclass(frozen=True, eq=False, repr=False)
class HeldBody(Valued):
    """A body with what holds it: forces, tangent and energy of its n reduced unknowns y, u = T y.

    The dissection says how all of them are eliminated but those on which the surface law and the controls may depend.
    The tangent made last is `made`; as it depends on delta y alone, bodies of other stretch may share it. It says
    nothing of the body, so it is not compared, but it is pickled: the last digits of what is solved next go by it.
    """

    body: Body
    dissection: Dissection
    settings: Settings = USUAL
    made: list[Tangent] = field(default_factory=list, compare=False, repr=False)

    @property
    def exterior(self) -> Exterior:
        """It leads from all of the body's unknowns to the reduced ones, the interior ones of its space first."""
        return self.dissection.exterior

    @property
    def size(self) -> int:
        """Number n of reduced unknowns."""
        return int(self.exterior.reduction.shape[1])

    def unknowns(self, y: Array) -> Array:
        """All unknowns of the body, (N + M,)."""
        return np.asarray(self.exterior.reduction @ y)

    def forces(self, y: Array) -> Array:
        """Forces of body and exterior, (n,)."""
        return np.asarray(self._transposed @ self.body.forces(self.unknowns(y)) + self.exterior.stiffness @ y)

    def tangent_product(self, y: Array, change: Array) -> Callable[[Array], Array]:
        """Derivative of the forces along any change of y and the approach, with the law's (m, m + 1) on the surface."""
        product, surface = self.body.tangent_product(self.unknowns(y)), self.dissection.surface

        def along(v: Array) -> Array:
            forces = self._transposed @ product(self.unknowns(v[:-1])) + self.exterior.stiffness @ v[:-1]
            forces[surface] += change @ np.append(v[surface], v[-1])
            return np.asarray(forces)

        return along

    def energy(self, y: Array) -> float:
        """Elastic energy of body and exterior in R dgamma mu eps."""
        return self.body.energy(self.unknowns(y)) + float(y @ (self.exterior.stiffness @ y)) / 2

    def solver(self, y: Array, change: Array, row: Array) -> Solver:
        """Solver of the bordered equations of a state, see `Tangent.bordered`, to an accuracy asked for.

        By the tangent at hand as long as each iteration leaves less than a part `slow` of the error.
        """
        product = cache(lambda: self.tangent_product(y, change))
        ends = np.append(self.dissection.surface, -1)

        def solve(rhs: Array, accuracy: float = 0.0) -> Array:
            tangent, how = self.near, self.settings
            nearly = tangent.bordered(change, row)
            x = nearly(rhs)
            last = float(np.abs(x).max())
            enough = max(accuracy, how.solved) * last
            while not np.array_equal(tangent.stretched, self.body.stretch * y):
                left = rhs - np.append(product()(x), row @ x[ends])
                dx = nearly(left)
                x, size = x + dx, float(np.abs(dx).max())
                if size**2 < enough * last:
                    break
                if not size < how.slow * last:
                    return self.tangent(y).bordered(change, row)(rhs)
                last = size
            return x

        return solve

    @property
    def near(self) -> Tangent:
        """The tangent made last, that of the undeformed body before."""
        return self.made[-1] if self.made else self.tangent(np.zeros(self.size))

    def tangent(self, y: Array) -> Tangent:
        """Tangent of a state, made unless it was the last."""
        stretched = self.body.stretch * y
        if not (self.made and np.array_equal(self.made[-1].stretched, stretched)):
            factors = self.dissection.factorised(self.body.cell_tangents(self.unknowns(y)))
            self.made[:] = [Tangent(factors.fronts, factors.left, factors.stiffness, stretched)]
        return self.made[-1]

    def forget(self) -> None:
        """Free the memory of the tangent and of how it is made, which are made anew when asked for."""
        self.made.clear()
        self.dissection.forget()

    @cached_property
    def _transposed(self) -> sparse.csr_array:
        return sparse.csr_array(self.exterior.reduction.T)
