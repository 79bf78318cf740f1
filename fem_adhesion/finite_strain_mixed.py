"""A nearly incompressible neo-Hookean body: displacements and a continuous pressure (Taylor and Hood).

The energy density

    psi = psi_shear(F) + p ln J - p^2/(2 lambda)

is stationary at p = lambda ln J, where it is that of the displacements alone; but p comes from a space one degree below
theirs, so that no more conditions on J are left at nu -> 1/2 than the displacements can meet. Pressures are in
E* beta/R and positive in tension. J. Bonet and R. D. Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
2nd ed. (2008), section 8.6, with ln J for J - 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Dofs

from fem_adhesion import neo_hookean as material
from fem_adhesion.elasticity import Space, cell_quadrature, lame_parameters
from fem_adhesion.finite_strain_bodies import require_stretch
from fem_adhesion.finite_strain_cells import (
    Cells,
    Pattern,
    cells_of,
    interior_positions,
    least_volume_ratio,
    states,
    summed,
)
from halfspace.compliance import Array, Index
from halfspace.errors import InputError
from halfspace.values import Valued


@dataclass(frozen=True, eq=False, repr=False)
class MixedBody(Valued):
    """A neo-Hookean body of N displacement and M pressure unknowns, in this order.

    Attributes
    ----------
    space : Space
        Mesh and element of the displacements.
    poisson : float
        Poisson's ratio of small strains, positive.
    stretch : float
        delta = beta/R = sqrt(mu/rho).
    cells : tuple of Cells
        From `finite_strain_cells.cells_of`.
    functions : (m, q) array
        The pressure's m functions at a cell's quadrature points, the same in every cell.
    pressures : tuple of (cells, m) int arrays
        Pressure unknowns of each batch, from 0.
    pattern : Pattern
        Of the tangent.
    products : (M, M) sparse array
        Products of pressures, integrated over the body.
    """

    space: Space
    poisson: float
    stretch: float
    cells: tuple[Cells, ...]
    functions: Array
    pressures: tuple[Index, ...]
    pattern: Pattern
    products: sparse.csc_array

    @property
    def unknowns(self) -> int:
        """Number of unknowns N + M."""
        return self.space.unknowns + self.products.shape[0]

    def stretched(self, stretch: float) -> MixedBody:
        """Return the same body at another delta."""
        parts = (self.cells, self.functions, self.pressures, self.pattern, self.products)
        return MixedBody(self.space, self.poisson, stretch, *parts)

    def lifted(self, displacement: Array) -> Array:
        """Return all unknowns: the pressures are the projection of lambda ln J."""
        factors = splu(self.products, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0)
        return np.append(displacement, self._lame[0] * factors.solve(self._log_volumes(displacement)))

    def forces(self, u: Array) -> Array:
        """Forces on the displacements, in R dgamma, and what is left of p = lambda ln J in each pressure, (N + M,)."""
        lam, G = self._lame
        parts = []
        for batch, (cells, state) in enumerate(states(self.cells, u, self.stretch)):
            stress = material.shear_stress(state, G) + self._pressure(u, batch) * state.inverse_transpose
            parts.append((cells.dofs, cells.forces(stress)))
        residue = self._log_volumes(u) - self.products @ u[self.space.unknowns :] / lam
        return np.append(summed(parts, self.space.unknowns), residue)

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (cells, k): displacements, then pressures."""
        displacements, pressures = np.concatenate([c.dofs for c in self.cells]), np.concatenate(self.pressures)
        return np.concatenate([displacements, self.space.unknowns + pressures], axis=1)

    @property
    def inside(self) -> Index:
        """Positions among the k of displacements interior to a cell."""
        return interior_positions(self.space)

    def cell_tangents(self, u: Array) -> Array:
        """Derivative of the forces, cell by cell, (cells, k, k): each a saddle point."""
        n, blocks = self.cells[0].dofs.shape[1], np.empty((len(self.cell_dofs), *2 * [self.cell_dofs.shape[1]]))
        parts = np.split(blocks, np.cumsum([len(c.dofs) for c in self.cells])[:-1])
        for batch, (cells, state) in enumerate(states(self.cells, u, self.stretch)):
            D = material.moduli(state, self._lame[1], self._pressure(u, batch))
            coupling, part = cells.works(state.inverse_transpose, self.functions), parts[batch]
            part[:, :n, :n], part[:, :n, n:], part[:, n:, :n] = cells.products(D), coupling, coupling.transpose(0, 2, 1)
            part[:, n:, n:] = (cells.measure[:, None] * self.functions) @ self.functions.T / -self._lame[0]
        return blocks

    def tangent(self, u: Array) -> sparse.csc_array:
        """Derivative of the forces, (N + M, N + M): symmetric, a saddle point."""
        return self.pattern.assemble(self.cell_tangents(u))

    def energy(self, u: Array) -> float:
        """Elastic energy in R dgamma mu eps."""
        p = u[self.space.unknowns :]
        cells = states(self.cells, u, self.stretch)
        shear = sum(np.sum(c.measure * material.shear_energy(state, self._lame[1])) for c, state in cells)
        return float(shear + p @ self._log_volumes(u) - p @ (self.products @ p) / (2 * self._lame[0]))

    def least_volume_ratio(self, u: Array) -> float:
        """Least J at any quadrature point."""
        return least_volume_ratio(self.cells, u, self.stretch)

    @property
    def _lame(self) -> tuple[float, float]:
        return lame_parameters(self.poisson)

    def _pressure(self, u: Array, batch: int) -> Array:
        """Pressure at the points of a batch, (cells, q)."""
        return np.asarray(u[self.space.unknowns + self.pressures[batch]] @ self.functions)

    def _log_volumes(self, u: Array) -> Array:
        """Integral of ln(J)/delta with each pressure function, (M,)."""
        cells = zip(self.pressures, states(self.cells, u, self.stretch), strict=True)
        parts = ((dofs, (c.measure * state.log_volume) @ self.functions.T) for dofs, (c, state) in cells)
        return summed(parts, self.products.shape[0])


def mixed_body(space: Space, poisson: float, stretch: float, pressure: Any) -> MixedBody:
    """Prepare a body of displacements and pressures.

    Parameters
    ----------
    space, poisson, stretch
        As in `finite_strain_bodies.displacement_body`.
    pressure : skfem.Element
        One degree below the displacement's: ElementTriP1 with ElementTriP2, ElementQuadP(p - 1) with ElementQuadP(p).

    Raises
    ------
    InputError
        If poisson is zero, at which the pressure is undetermined, or poisson or stretch is out of range.
    """
    if lame_parameters(poisson)[0] == 0.0:
        raise InputError("poisson = 0 leaves the pressure undetermined; use displacement_body, nothing locks there")
    cells, dofs = cells_of(space), Dofs(space.mesh, pressure)
    by_cell = np.asarray(dofs.element_dofs, dtype=np.intp)
    pressures = tuple(np.split(by_cell.T, np.cumsum([len(c.dofs) for c in cells])[:-1]))
    values = _reference_values(pressure, cell_quadrature(space)[0], len(by_cell))
    together = np.concatenate([np.concatenate([c.dofs for c in cells]).T, space.unknowns + by_cell])
    pattern = Pattern.of(together, together, (space.unknowns + dofs.N, space.unknowns + dofs.N))
    blocks = np.concatenate([(c.measure[:, None] * values) @ values.T for c in cells])
    products = Pattern.of(by_cell, by_cell, (dofs.N, dofs.N)).assemble(blocks)
    return MixedBody(space, poisson, require_stretch(stretch), cells, values, pressures, pattern, products)


def _reference_values(element: Any, points: Array, count: int) -> Array:
    """Values of the element's functions at points of the reference cell, (count, points)."""
    return np.array([np.broadcast_to(element.lbasis(points, i)[0], points.shape[1:]) for i in range(count)])
