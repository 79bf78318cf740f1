"""A neo-Hookean body by finite elements: forces, tangent and energy of its unknowns, total Lagrangian.

Displacements are in beta^2/R, stresses in E* beta/R, forces in R dgamma, energies in R dgamma mu eps; see
`fem_adhesion.neo_hookean`. Displacements alone lock as Poisson's ratio nears 1/2; `fem_adhesion.finite_strain_mixed`
does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, Self

import numpy as np
from scipy import sparse

from fem_adhesion import neo_hookean as material
from fem_adhesion.elasticity import Space, lame_parameters
from fem_adhesion.finite_strain_cells import (
    Cells,
    Pattern,
    cells_of,
    displacement_pattern,
    interior_positions,
    least_volume_ratio,
    states,
    summed,
)
from halfspace.compliance import Array, Index
from halfspace.errors import InputError
from halfspace.values import Valued


class Body(Protocol):
    """A hyperelastic body: N displacement unknowns, numbered as in its space, and any others after them."""

    @property
    def space(self) -> Space:
        """Mesh and element of the displacements."""
        ...

    @property
    def stretch(self) -> float:
        """Stretch parameter delta = beta/R, zero for the linear body."""
        ...

    @property
    def unknowns(self) -> int:
        """Number of all unknowns."""
        ...

    def stretched(self, stretch: float) -> Self:
        """Return the same body at another delta."""
        ...

    def lifted(self, displacement: Array) -> Array:
        """Return all unknowns from the N displacements."""
        ...

    @property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (cells, k)."""
        ...

    @property
    def inside(self) -> Index:
        """Positions among the k of displacements interior to a cell, in the order of the space's `interior_dofs`."""
        ...

    def forces(self, u: Array) -> Array:
        """Forces with which the body resists, in R dgamma."""
        ...

    def cell_tangents(self, u: Array) -> Array:
        """Their derivative, symmetric, cell by cell, (cells, k, k)."""
        ...

    def tangent(self, u: Array) -> sparse.csc_array:
        """Sum of these."""
        ...

    def energy(self, u: Array) -> float:
        """Elastic energy in R dgamma mu eps."""
        ...

    def least_volume_ratio(self, u: Array) -> float:
        """Least J at any quadrature point; the body is turned inside out where it is not positive."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class DisplacementBody(Valued):
    """A neo-Hookean body described by its displacements alone.

    Attributes
    ----------
    space : Space
        Mesh and element.
    poisson : float
        Poisson's ratio of small strains.
    stretch : float
        delta = beta/R = sqrt(mu/rho).
    cells : tuple of Cells
        From `finite_strain_cells.cells_of`.
    pattern : Pattern
        Of the tangent.
    """

    space: Space
    poisson: float
    stretch: float
    cells: tuple[Cells, ...]
    pattern: Pattern

    @property
    def unknowns(self) -> int:
        """Number of displacement unknowns N."""
        return self.space.unknowns

    @property
    def _lame(self) -> tuple[float, float]:
        return lame_parameters(self.poisson)

    def stretched(self, stretch: float) -> DisplacementBody:
        """Return the same body at another delta."""
        return DisplacementBody(self.space, self.poisson, stretch, self.cells, self.pattern)

    def lifted(self, displacement: Array) -> Array:
        """Return the displacements, which are all there is."""
        return displacement

    def forces(self, u: Array) -> Array:
        """Forces with which the body resists, (N,), in R dgamma."""
        cells = states(self.cells, u, self.stretch)
        return summed(((c.dofs, c.forces(material.stress(state, *self._lame))) for c, state in cells), self.unknowns)

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (cells, k)."""
        return np.concatenate([cells.dofs for cells in self.cells])

    @property
    def inside(self) -> Index:
        """Positions among the k of displacements interior to a cell."""
        return interior_positions(self.space)

    def cell_tangents(self, u: Array) -> Array:
        """Derivative of the forces, cell by cell, (cells, k, k)."""
        cells = states(self.cells, u, self.stretch)
        return np.concatenate([c.products(material.tangent(state, *self._lame)) for c, state in cells])

    def tangent(self, u: Array) -> sparse.csc_array:
        """Derivative of the forces, (N, N), symmetric."""
        return self.pattern.assemble(self.cell_tangents(u))

    def energy(self, u: Array) -> float:
        """Elastic energy in R dgamma mu eps."""
        cells = states(self.cells, u, self.stretch)
        return float(sum(np.sum(c.measure * material.energy(state, *self._lame)) for c, state in cells))

    def least_volume_ratio(self, u: Array) -> float:
        """Least J at any quadrature point."""
        return least_volume_ratio(self.cells, u, self.stretch)


def displacement_body(space: Space, poisson: float, stretch: float) -> DisplacementBody:
    """Prepare a body of displacements.

    Raises
    ------
    InputError
        If poisson or stretch is out of range.
    """
    lame_parameters(poisson)
    cells = cells_of(space)
    return DisplacementBody(space, poisson, require_stretch(stretch), cells, displacement_pattern(space, cells))


def require_stretch(stretch: float) -> float:
    """Return delta = beta/R, or raise InputError unless 0 <= stretch <= 2: a sphere smaller than its own contact."""
    if not 0.0 <= stretch <= 2.0:
        raise InputError(f"stretch = {stretch} is outside 0 <= stretch <= 2; give beta/R = sqrt(tabor/radius_ratio)")
    return stretch
