"""Boundaries of a mesh: scikit-fem's basis on a named one, and the values of its functions there."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from scipy import sparse
from skfem import FacetBasis
from skfem.mapping import MappingIsoparametric
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from fem_adhesion.elasticity.space import Space
from halfspace.values import Index

INVERSION_TOLERANCE = 1e-6
"""Summed over the points of a facet, in units of the reference cell; a cell of 1e-9 of its radius is still resolved."""


def boundary_basis(space: Space, name: str, points: int) -> Any:
    """Return skfem's basis of the scalar element on the named boundary, with Gauss `points` on each facet."""
    quadrature = get_quadrature(RefLine, 2 * points - 1)
    facets = space.mesh.boundaries[name]
    return FacetBasis(
        space.mesh,
        space.element,
        mapping=_forgiving_mapping(space.mesh),
        facets=facets,
        quadrature=quadrature,
        dofs=space.scalar_dofs,
        disable_doflocs=True,
    )


def _forgiving_mapping(mesh: Any) -> Any:
    """The mesh's mapping; inverted on quadrilaterals only as far as rounding allows.

    skfem inverts them by Newton's method to 1e-12 of a cell, which the coordinates of thin cells far from the origin
    cannot resolve. On straight-sided rectangles its first step is exact.
    """
    mapping = mesh.mapping()
    if isinstance(mapping, MappingIsoparametric):
        mapping.invF = partial(mapping.invF, newton_tol=INVERSION_TOLERANCE)
    return mapping


def trace_matrix(basis: Any, functions: Index) -> sparse.csr_array:
    """Return the values of the given functions at the points of a boundary basis.

    Parameters
    ----------
    basis : skfem.FacetBasis
        With k points on each of its facets.
    functions : (m,) int array
        Functions that do not vanish on the boundary, ascending.

    Returns
    -------
    (facets k, m) sparse array
    """
    values = np.array([b[0] for b in basis.basis])
    rows = np.broadcast_to(np.arange(values[0].size).reshape(values[0].shape), values.shape)
    columns = np.searchsorted(functions, basis.element_dofs)
    found = np.isin(basis.element_dofs, functions)
    columns = np.broadcast_to(columns[:, :, None], values.shape)
    return sparse.csr_array(
        (values[found].ravel(), (rows[found].ravel(), columns[found].ravel())), shape=(values[0].size, len(functions))
    )
