"""Static condensation: the block's stiffness, reduced exactly to the compliance of its contact surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy.linalg.blas import dtrsm

from fem_adhesion.elasticity.cells import Stiffness, stiffness_of
from fem_adhesion.elasticity.elimination import (
    Factors,
    Region,
    dissected,
    eliminate,
    eliminated_by,
    factor,
    mirrored,
    reduced_cells,
    reduced_unknowns,
)
from fem_adhesion.elasticity.exterior import Exterior, FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import Space
from fem_adhesion.elasticity.surface import BoundaryPoints, boundary_points
from fem_adhesion.materials import Elastic
from halfspace.elastic.compliance import ElasticOperator
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Dissection(Valued):
    """How all unknowns of a body are eliminated but those of a surface, whatever the stiffness of its cells.

    The cells have the unknowns dofs (k, cells), first those of the space. The exterior leads from all of them to the n
    reduced ones, interior ones included, see `with_interiors`; the surface (m,) are those that are left.
    """

    space: Space
    dofs: Index
    exterior: Exterior
    surface: Index

    def factorised(self, cells: Array) -> Factors:
        """Eliminate the interior unknowns of all cells, (cells, k, k), then all others but those of the surface."""
        (regions, beside), inside, outside = self._regions, self.space.inside, self._outside
        unknowns, gathered = self._unknowns
        cells = reduced_cells(cells, gathered)
        own, shared = cells[:, inside], cells[:, outside]
        interiors, cells = eliminated_by(
            own[..., inside], own[..., outside], shared[..., outside], unknowns[inside].T, unknowns[outside].T
        )
        fronts, K = regions.factorised(cells)
        done, left = (np.searchsorted(regions.unknowns, part) for part in (beside, self.surface))
        K = with_exterior(regions, K, self.exterior)
        last, stiffness = eliminated_by(K[done][:, done], K[done][:, left], K[left][:, left], beside, self.surface)
        return Factors([interiors, *fronts, last], self.surface, stiffness)

    def forget(self) -> None:
        """Let go of the regions, which are dissected anew when asked for."""
        self.__dict__.pop("_regions", None)

    @cached_property
    def _regions(self) -> tuple[Region, Index]:
        """In which the shared unknowns are eliminated, but for the surface's and others that the exterior holds."""
        kept = np.diff(self.exterior.stiffness.indptr) > 0
        beside = np.setdiff1d(np.flatnonzero(kept), self.surface)
        kept[self.surface] = True
        return dissected(self.space.mesh, self._unknowns[0][self._outside], kept), beside

    @cached_property
    def _unknowns(self) -> tuple[Index, Array]:
        return reduced_unknowns(self.dofs, self.exterior.reduction)

    @cached_property
    def _outside(self) -> Index:
        return np.setdiff1d(np.arange(len(self._unknowns[0])), self.space.inside)


@dataclass(frozen=True, eq=False, repr=False)
class CondensedBody(Valued):
    """A block factorised once: its surface compliance, and the fields inside for a given surface pressure.

    Pressures are (q,) arrays at ``operator.radii``, positive in compression; all is dimensionless, E* = 1. The operator
    gives the deflection of the surface from the pressure on it.
    """

    operator: ElasticOperator
    space: Space
    stiffness: Stiffness
    exterior: Exterior
    surface: BoundaryPoints

    @cached_property
    def cells(self) -> Array:
        """Stiffness of all cells, (cells, 2 n, 2 n)."""
        K = np.empty((self.space.mesh.nelements, *2 * [len(self.space.cell_dofs)]))
        for own, part in self.stiffness():
            K[own] = part
        return K

    @cached_property
    def factors(self) -> Factors:
        """The reduced stiffness, factorised for fields inside."""
        none = np.zeros(0, dtype=np.intp)
        return Dissection(self.space, self.space.cell_dofs, self._whole, none).factorised(self.cells)

    @cached_property
    def _whole(self) -> Exterior:
        return with_interiors(self.exterior, self.space)

    @property
    def unknowns(self) -> int:
        """Number of displacement unknowns of the block."""
        return self.space.unknowns

    @property
    def translation(self) -> Array:
        """The (N,) unknowns of the rigid motion u_z = 1."""
        motion = np.zeros(self.unknowns)
        motion[self.space.components[1]] = self.space.constant
        return motion

    def nodal_forces(self, pressure: Array) -> Array:
        """Return the (N,) forces, in E* beta^2, that do the same work as the pressure: negative, downwards."""
        forces = np.zeros(self.unknowns)
        vertical = self.space.components[1, self.surface.functions]
        forces[vertical] = -(self.surface.values.T @ (self.operator.weights * pressure))
        return forces

    def reduced_displacement(self, pressure: Array) -> Array:
        """Return the reduced unknowns, interior ones first; the last is the point load c if the far field is one."""
        return self.factors.solve(self._whole.reduction.T @ self.nodal_forces(pressure))

    def displacement(self, pressure: Array) -> Array:
        """Return all (N,) displacement unknowns, in beta, interior ones included."""
        sunk = self.exterior.rigid_compliance * (self.operator.weights @ pressure)
        return np.asarray(self._whole.reduction @ self.reduced_displacement(pressure) + sunk * self.translation)


def condense(
    space: Space,
    poisson: float,
    *,
    far_field: FarField = point_load,
    points: int | None = None,
    stiffness: Stiffness | None = None,
    traction: str = "projected",
) -> CondensedBody:
    """Factorise the block once and condense it to its contact surface.

    The compliance is N K^-1 N' diag(w): N evaluates the surface deflection -u_z at the Gauss points of the contact
    facets and w are the weights of 2 pi r dr, so a surface law assembled by quadrature at them is condensed exactly.

    The far field is one of `fem_adhesion.elasticity.exterior`. Gauss's points on a contact facet are more than the
    degree p of the element, p + 2 unless given. The stiffness of the cells is
    that of displacements alone unless given; that of projected dilatations does not lock. With the traction
    "projected" the pressure, which is vertical, acts on the area projected on the plane of the contact, with "surface"
    on that of the surface. InputError unless 0 <= poisson < 0.5 and the points are enough.
    """
    points = space.degree + 2 if points is None else points
    if points <= space.degree:
        raise InputError(f"points = {points} must exceed the degree p = {space.degree}; use {space.degree + 1} or more")
    surface, exterior = boundary_points(space, "contact", points), far_field(space, poisson)
    stiffness = stiffness or partial(stiffness_of, space, [Elastic(poisson)], remedy=False)
    yielding = flexibility(space, stiffness, exterior, space.components[1, surface.functions])
    operator = surface_operator(surface, exterior, yielding, traction)
    return CondensedBody(operator, space, stiffness, exterior, surface)


def eliminate_interiors(space: Space, stiffness: Stiffness) -> Array:
    """Eliminate the interior unknowns of every cell, (cells, 2 m, 2 m): the m functions that cells share are left."""
    n, interior = len(space.cell_dofs) // 2, space.element.interior_dofs
    shared, own = slice(n - interior), slice(n - interior, n)
    inner, outer = 2 * interior, 2 * (n - interior)
    reduced = np.empty((space.mesh.nelements, outer, outer))
    for numbers, K in stiffness():
        for number, cell in zip(numbers, K.reshape(-1, 2, n, 2, n), strict=True):
            done = cell[:, own][..., own].reshape(inner, inner)
            reduced[number] = cell[:, shared][..., shared].reshape(outer, outer)
            eliminate(done, cell[:, own][..., shared].reshape(inner, outer), reduced[number])
    return mirrored(reduced)


def flexibility(space: Space, stiffness: Stiffness, exterior: Exterior, surface: Index) -> Array:
    """Displacements (m, m) of the m unknowns on the surface under unit forces on each of them.

    Unknowns that the exterior couples, or that move more than one of the body's, are kept to the last with these.
    """
    T = exterior.reduction
    column = np.repeat(np.arange(T.shape[1]), np.diff(T.indptr))
    number = np.full(T.shape[0], -1)
    number[surface] = np.arange(surface.size)
    row = number[T.indices]
    moving = row >= 0
    shared = np.delete(space.cell_dofs, space.inside, axis=0)
    unknowns, gathered = reduced_unknowns(shared, T)
    cells = reduced_cells(eliminate_interiors(space, stiffness), gathered)
    last = np.diff(exterior.stiffness.indptr) > 0
    last[column[moving]] = True
    region = dissected(space.mesh, unknowns, last)
    lower = factor(with_exterior(region, region.stiffness(cells), exterior))
    place = np.full(T.shape[1], -1)
    place[region.unknowns] = np.arange(region.unknowns.size)
    motion = np.zeros((region.unknowns.size, surface.size), order="F")
    motion[place[column[moving]], row[moving]] = T.data[moving]
    half = dtrsm(1.0, lower, motion, lower=1, overwrite_b=1)
    return np.asarray(half.T @ half)


def with_exterior(region: Region, stiffness: Array, exterior: Exterior) -> Array:
    """Stiffness of the unknowns that are left of a body, with that of its exterior."""
    left = region.unknowns
    if not exterior.stiffness.nnz:
        return stiffness
    return np.asarray(stiffness + exterior.stiffness[left][:, left].toarray())


def surface_operator(
    surface: BoundaryPoints, exterior: Exterior, flexibility: Array, traction: str = "projected"
) -> ElasticOperator:
    """Return the compliance of the surface, from the displacements of its vertical unknowns under unit forces."""
    N, weights = surface.values, surface.weights(traction)
    C = (N @ (N @ flexibility).T).T * weights
    C -= exterior.rigid_compliance * weights
    return ElasticOperator(surface.radii, weights, surface.ends, surface.facet_points, compliance=C)
