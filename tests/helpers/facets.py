"""On boundaries: scikit-fem's own basis, beside which ours is held, and the force that holds the far one."""

from functools import partial

from skfem import FacetBasis
from skfem.mapping import MappingIsoparametric
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from fem_adhesion.elasticity.space import scatter

INVERSION_TOLERANCE = 1e-6
"""Summed over the points of a facet, in units of the reference cell; a cell of 1e-9 of its radius is still resolved."""


def boundary_basis(space, name, points):
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


def _forgiving_mapping(mesh):
    """The mesh's mapping; inverted on quadrilaterals only as far as rounding allows.

    skfem inverts them by Newton's method to 1e-12 of a cell, which the coordinates of thin cells far from the origin
    cannot resolve. On straight-sided rectangles its first step is exact.
    """
    mapping = mesh.mapping()
    if isinstance(mapping, MappingIsoparametric):
        mapping.invF = partial(mapping.invF, newton_tol=INVERSION_TOLERANCE)
    return mapping


def far_reaction(body, pressure):
    """Upward force with which the exterior of a condensed body holds its far boundary, in E* beta^2: the load."""
    K = scatter(body.cells, body.space.cell_dofs, body.unknowns)
    forces = K @ body.displacement(pressure) - body.nodal_forces(pressure)
    far = body.space.components[1, body.space.boundary_functions("far")]
    return float(body.translation[far] @ forces[far])
