"""A body as it is held, and Newton's linear equations on it.

What the surface law changes at once is its tangent on the m unknowns of the contact surface, m a twentieth of all; so
the body's tangent is condensed to these, to the stiffness C and the forces g, and with the law's tangent S, its
derivative b by the approach and the row (r, r_a) of a control

    [[C + S, b], [r, r_a]] (s, alpha) = (g, g_a),

whence all others are recovered: see `fem_adhesion.elasticity.elimination`. Those interior to a cell go before.

Each state has a tangent of its own. Solving by that of a state near by and iterating halved their number, 202 to 92 on
a curve of tabor 1 and R/eps 100 to 1e-5, and saved a tenth of the time there, a fifth at R/eps 12.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dgetrf, dgetrs

from fem_adhesion.elasticity.condensation import Dissection
from fem_adhesion.elasticity.elimination import Factors
from fem_adhesion.elasticity.exterior import Exterior
from fem_adhesion.finite_strain.body import Body
from fem_adhesion.finite_strain.settings import USUAL, Settings
from halfspace.equilibrium.contact import Solver, count_negative
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Tangent(Factors):
    """The tangent of a held body at one state y (n,), factorised, and condensed to the contact surface.

    What is left are the reduced unknowns of the surface, (m,), and the stiffness (m, m) is C.
    """

    y: Array

    def surface_change(self, forces: Array) -> Array:
        """Change of the surface's unknowns, (m,), under forces on all, (n,)."""
        return np.asarray(self.flexibility @ self.carried(forces)[self.left])

    def bordered(self, change: Array, row: Array) -> Callable[[Array], Array]:
        """Solver of the equations with the law's tangent, for right-hand sides (n + 1,).

        The change (m, m + 1) is (S, b), the row (m + 1,) that of the control. All nan if they make it singular.
        """
        matrix = np.vstack([change, row])
        matrix[:-1, :-1] += self.stiffness
        lu, pivots, singular = dgetrf(matrix, overwrite_a=True)
        if singular:
            lu[:] = np.nan

        def solve(rhs: Array) -> Array:
            x = self.carried(rhs[:-1])
            ends = dgetrs(lu, pivots, np.append(x[self.left], rhs[-1]))[0]
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

    The exterior leads from all of the body's unknowns to the reduced ones, the interior ones of its space first. On the
    reduced unknowns `surface` (m,) the surface law and the controls may depend.
    """

    body: Body
    exterior: Exterior
    surface: Index
    settings: Settings = USUAL

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

    def tangent_product(self, y: Array, change: Array) -> Callable[[Array], Array]:
        """Derivative of the forces along any change of y and the approach, with the law's (m, m + 1) on the surface."""
        product = self.body.tangent_product(self.unknowns(y))

        def along(v: Array) -> Array:
            forces = self._transposed @ product(self.unknowns(v[:-1])) + self.exterior.stiffness @ v[:-1]
            forces[self.surface] += change @ np.append(v[self.surface], v[-1])
            return np.asarray(forces)

        return along

    def energy(self, y: Array) -> float:
        """Elastic energy of body and exterior in R dgamma mu eps."""
        return self.body.energy(self.unknowns(y)) + float(y @ (self.exterior.stiffness @ y)) / 2

    def solver(self, y: Array, change: Array, row: Array) -> Solver:
        """Solver of the bordered equations of a state, see `Tangent.bordered`; its tangent is made when asked for."""
        bordered = cache(lambda: self.tangent(y).bordered(change, row))
        return lambda rhs, accuracy=0.0: bordered()(rhs)  # noqa: ARG005 (it is exact)

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

    def forget(self) -> None:
        """Free the memory of what is kept between states; it is made anew when asked for."""
        for name in ("undeformed", "_dissection"):
            self.__dict__.pop(name, None)
        self._made.clear()

    def _exact(self, tangent: Tangent, y: Array) -> bool:
        return not self.body.stretch or np.array_equal(tangent.y, y)

    def _factorised(self, y: Array) -> Tangent:
        factors = self._dissection.factorised(self.body.cell_tangents(self.unknowns(y)))
        return Tangent(factors.fronts, factors.left, factors.stiffness, y.copy())

    @cached_property
    def _dissection(self) -> Dissection:
        return Dissection(self.body.space, self.body.cell_dofs.T, self.exterior, self.surface)

    @cached_property
    def _transposed(self) -> sparse.csr_array:
        return sparse.csr_array(self.exterior.reduction.T)
