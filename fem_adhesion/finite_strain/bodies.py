"""A neo-Hookean body by finite elements: forces, tangent and energy of its unknowns, total Lagrangian.

Displacements are in beta^2/R, stresses in E* beta/R, forces in R dgamma, energies in R dgamma mu eps; see
`fem_adhesion.finite_strain.material`. Displacements alone lock as Poisson's ratio nears 1/2. Then a continuous pressure
joins them (Taylor and Hood): the energy density

    psi = psi_shear(F) + p ln J - p^2/(2 lambda)

is stationary at p = lambda ln J, where it is that of the displacements alone; but p comes from a space one degree below
theirs, so that no more conditions on J are left at nu -> 1/2 than the displacements can meet. Pressures are in
E* beta/R and positive in tension. J. Bonet and R. D. Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
2nd ed. (2008), section 8.6, with ln J for J - 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from skfem import Dofs

from fem_adhesion.elasticity.space import Space, cell_quadrature, lame_parameters, reference_functions, scatter
from fem_adhesion.finite_strain import material
from fem_adhesion.finite_strain.cells import Cells, cells_of, summed
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Body(Valued):
    """A neo-Hookean body of N displacement and M pressure unknowns, in this order; M = 0 for displacements alone.

    Attributes
    ----------
    space : Space
        Mesh and element of the displacements.
    poisson : float
        Poisson's ratio of small strains.
    stretch : float
        Stretch parameter delta = beta/R = sqrt(mu/rho), zero for the linear body.
    cells : tuple of Cells
        From `fem_adhesion.finite_strain.cells.cells_of`.
    functions : (m, q) array
        The pressure's m functions at a cell's quadrature points, the same in every cell.
    pressures : tuple of (cells, m) int arrays
        Pressure unknowns of each batch, from 0.
    products : (M, M) sparse array
        Products of pressures, integrated over the body.
    """

    space: Space
    poisson: float
    stretch: float
    cells: tuple[Cells, ...]
    functions: Array
    pressures: tuple[Index, ...]
    products: sparse.csc_array

    @property
    def unknowns(self) -> int:
        """Number of unknowns N + M."""
        return self.space.unknowns + self.products.shape[0]

    def stretched(self, stretch: float) -> Body:
        """Return the same body at another delta."""
        return replace(self, stretch=stretch)

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (cells, k): displacements, then pressures."""
        displacements, pressures = np.concatenate([c.dofs for c in self.cells]), np.concatenate(self.pressures)
        return np.concatenate([displacements, self.space.unknowns + pressures], axis=1)

    @property
    def inside(self) -> Index:
        """Positions among the k of displacements that no other cell shares, as in the space's `interior_dofs`."""
        n, own = len(self.space.cell_dofs) // 2, self.space.element.interior_dofs
        return np.concatenate([np.arange(n - own, n), np.arange(2 * n - own, 2 * n)])

    def forces(self, u: Array) -> Array:
        """Forces on the displacements, in R dgamma, and what is left of p = lambda ln J in each pressure, (N + M,)."""
        lam, G = self._lame
        works = ((c.dofs, c.forces(material.stress(state, G, p))) for c, state, p in self._states(u))
        forces = summed(works, self.space.unknowns)
        return np.append(forces, self.log_volumes(u) - self.products @ u[self.space.unknowns :] / lam)

    def cell_tangents(self, u: Array) -> Array:
        """Their derivative, symmetric, cell by cell, (cells, k, k): with pressures each a saddle point."""
        lam, G = self._lame
        n, blocks = self.cells[0].dofs.shape[1], np.empty((len(self.cell_dofs), *2 * [self.cell_dofs.shape[1]]))
        parts = np.split(blocks, np.cumsum([len(c.dofs) for c in self.cells])[:-1])
        for part, (cells, state, p) in zip(parts, self._states(u), strict=True):
            D, f = material.moduli(state, G, p), state.inverse_transpose
            if not self._mixed:
                D += lam * f[:, None] * f
            part[:, :n, :n], part[:, :n, n:] = cells.products(D), cells.works(f, self.functions)
            part[:, n:, :n] = part[:, :n, n:].transpose(0, 2, 1)
            part[:, n:, n:] = (cells.measure[:, None] * self.functions) @ self.functions.T / -lam
        return blocks

    def tangent(self, u: Array) -> sparse.csc_array:
        """Sum of these, (N + M, N + M)."""
        return scatter(self.cell_tangents(u), self.cell_dofs.T, self.unknowns)

    def energy(self, u: Array) -> float:
        """Elastic energy in R dgamma mu eps."""
        return float(sum(np.sum(c.measure * self._density(state, p)) for c, state, p in self._states(u)))

    def least_volume_ratio(self, u: Array) -> float:
        """Least J at any quadrature point; the body is turned inside out where it is not positive."""
        return float(min(cells.deformation(u, self.stretch).volume_ratio.min() for cells in self.cells))

    def log_volumes(self, u: Array) -> Array:
        """Integral of ln(J)/delta with each pressure function, (M,)."""
        if not self._mixed:
            return np.zeros(0)
        parts = zip(self.pressures, self.cells, strict=True)
        works = ((p, (c.measure * c.deformation(u, self.stretch).log_volume) @ self.functions.T) for p, c in parts)
        return summed(works, self.products.shape[0])

    @property
    def _mixed(self) -> bool:
        return len(self.functions) > 0

    @property
    def _lame(self) -> tuple[float, float]:
        return lame_parameters(self.poisson)

    def _states(self, u: Array) -> Iterator[tuple[Cells, material.Deformation, Array]]:
        """Batches with deformation and pressure at their points."""
        p = u[self.space.unknowns :]
        for cells, unknowns in zip(self.cells, self.pressures, strict=True):
            state = cells.deformation(u, self.stretch)
            yield cells, state, p[unknowns] @ self.functions if self._mixed else self._lame[0] * state.log_volume

    def _density(self, state: material.Deformation, p: Array) -> Array:
        lam, G = self._lame
        volumetric = p * state.log_volume - p**2 / (2 * lam) if self._mixed else p * state.log_volume / 2
        return np.asarray(material.shear_energy(state, G) + volumetric)


def displacement_body(space: Space, poisson: float, stretch: float) -> Body:
    """Prepare a body of displacements.

    Raises
    ------
    InputError
        If poisson or stretch is out of range.
    """
    lame_parameters(poisson)
    cells = cells_of(space)
    none = tuple(np.zeros((len(c.dofs), 0), dtype=np.intp) for c in cells)
    functions = np.zeros((0, cells[0].measure.shape[1]))
    return Body(space, poisson, require_stretch(stretch), cells, functions, none, sparse.csc_array((0, 0)))


def mixed_body(space: Space, poisson: float, stretch: float, pressure: Any) -> Body:
    """Prepare a body of displacements and pressures.

    Parameters
    ----------
    space, poisson, stretch
        As in `displacement_body`.
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
    values, _ = reference_functions(pressure, cell_quadrature(space)[0])
    pressures = tuple(np.split(by_cell.T, np.cumsum([len(c.dofs) for c in cells])[:-1]))
    products = scatter(np.concatenate([(c.measure[:, None] * values) @ values.T for c in cells]), by_cell, dofs.N)
    return Body(space, poisson, require_stretch(stretch), cells, values, pressures, products)


def require_stretch(stretch: float) -> float:
    """Return delta = beta/R, or raise InputError unless 0 <= stretch <= 2: a sphere smaller than its own contact."""
    if not 0.0 <= stretch <= 2.0:
        raise InputError(f"stretch = {stretch} is outside 0 <= stretch <= 2; give beta/R = sqrt(tabor/radius_ratio)")
    return stretch
