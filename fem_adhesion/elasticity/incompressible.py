"""Elements that do not lock as Poisson's ratio nears 1/2: the dilatation gets a space of its own.

The energy density is that of shear plus lambda (div u)^2/2. As lambda grows, div u must vanish at every point, which
costs a displacement of degree p its accuracy. If Pi div u takes the place of div u, Pi the projection on polynomials of
a lower degree, no more conditions are left than the displacement can meet. The pressure of the mixed form is
lambda Pi div u, eliminated cell by cell.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.polynomial.legendre import legvander2d

from fem_adhesion.elasticity.cells import (
    Cells,
    CellStiffness,
    cell_quadrature,
    cell_stiffness,
    of_gradient,
    shear_matrix,
)
from fem_adhesion.elasticity.space import Space, lame_parameters
from fem_adhesion.materials import Elastic
from halfspace.errors import InputError
from halfspace.values import Array

REMEDY_FROM = 0.4
"""Poisson's ratio from which the projection earns its cost, a tenth more time to condense a block. Of the error of the
pull-off load at tabor 1 it leaves half at 0.4, a third at 0.45 and a tenth or less at 0.4999, at degrees 3 to 9."""


def stiffness_for(poisson: float) -> CellStiffness:
    """Stiffness of quadrilaterals that fits the material."""
    return projected_stiffness if poisson >= REMEDY_FROM else cell_stiffness


def projects(space: Space, poisson: float) -> bool:
    """Whether `stiffness_for` a material is that of projected dilatations, where the cells are quadrilaterals."""
    return space.element.refdom.nnodes == 4 and stiffness_for(poisson) is projected_stiffness


def stiffness_of(materials: Sequence[Elastic]) -> CellStiffness:
    """Stiffness of quadrilaterals each of which is of the material of its region."""
    return stiffness_for(materials[0].poisson) if len(materials) == 1 else partial(_by_region, tuple(materials))


def _by_region(materials: Sequence[Elastic], space: Space, _: float) -> Array:
    """Stiffness of every cell, from meshes of the regions apart."""
    K = np.empty((space.mesh.nelements, *2 * [len(space.cell_dofs)]))
    for cells, (poisson, modulus) in zip(space.regions(materials), materials, strict=True):
        part = Space(space.mesh.restrict(cells), space.element)
        K[cells] = modulus * stiffness_for(poisson)(part, poisson)
    return K


def projected_stiffness(space: Space, poisson: float) -> Array:
    """Return the stiffness matrix of every quadrilateral with its dilatation projected; see `pressure_modes`.

    Parameters and result as of `fem_adhesion.elasticity.space.cell_stiffness`.
    """
    cells, modes = Cells.of(space), pressure_modes(space)
    K = cells.stiffness(of_gradient(shear_matrix(poisson)))
    for own, part in cells.batches():
        root = np.sqrt(part.measure)[:, :, None]
        orthonormal = np.linalg.qr(root * modes)[0]
        projected = part.dilatations() @ (root * orthonormal)
        K[own] += lame_parameters(poisson)[0] * projected @ projected.transpose(0, 2, 1)
    return K


def pressure_modes(space: Space) -> Array:
    """Return the pressures of a quadrilateral of degree p >= 2 at its quadrature points, (q, p^2 - 1).

    Products of Legendre polynomials of degrees below p, without the product of the two highest. With that one, the
    interior displacements, (1 - x^2)(1 - y^2) times any polynomial of degree p - 2 in each direction, would do no work
    on the pressure L_p'(x) L_p'(y), which they do on every other but a constant. So the pair is stable as Q2 with P1
    is, the case p = 2: its inf-sup constant stands at 0.54 for p = 2 to 5 however fine the mesh, and at 0.3 or more for
    cells a million times as long as thick, while that of the full set falls with the mesh. InputError unless the cells
    are quadrilaterals of degree 2 or more.
    """
    if space.degree < 2 or space.element.refdom.nnodes != 4:
        raise InputError(f"{type(space.element).__name__} has no projected dilatation; use ElementQuadP(2) or more")
    x, y = 2.0 * cell_quadrature(space)[0] - 1.0
    modes: Array = legvander2d(x, y, [space.degree - 1, space.degree - 1])[:, :-1]
    return modes
