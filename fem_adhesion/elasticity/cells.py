"""The cells of a body at their quadrature points, and matrices from them: strains and work of displacements, stiffness.

The five components of grad u, and of the stress conjugate to it, are ordered

    (hoop, rr, rz, zr, zz) = (u_r/r, du_r/dr, du_r/dz, du_z/dr, du_z/dz);

strains and stresses of small strain (rr, zz, hoop, rz) with the engineering shear gamma_rz = du_r/dz + du_z/dr. Lengths
are in beta and E* = 1.

Displacements alone lock as Poisson's ratio nears 1/2. The energy density is that of shear plus lambda (div u)^2/2. As
lambda grows, div u must vanish at every point, which costs a displacement of degree p its accuracy. If Pi div u takes
the place of div u, Pi the projection on polynomials of a lower degree, no more conditions are left than a displacement
can meet. The pressure of the mixed form is lambda Pi div u, eliminated cell by cell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import legvander2d
from skfem.refdom import RefTri

from fem_adhesion.elasticity.reference import quadrature, reference_functions
from fem_adhesion.elasticity.space import Space, lame_parameters, ring_measure
from fem_adhesion.materials import Elastic
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued

BATCH = 400_000  # numbers held in one batch of cells: 3 MB, and a few times that on the way, for the cache to help

STRAINS = np.array([[0.0, 1, 0, 0, 0], [0, 0, 0, 0, 1], [1, 0, 0, 0, 0], [0, 0, 1, 1, 0]])
"""Strains (rr, zz, hoop, rz) from the components of grad u."""

DILATATION = np.array([1.0, 1.0, 0.0, 0.0, 1.0])  # of grad u: the relative change of volume
BY_Z = np.array([0.0, 0.0, 1.0, 0.0, 1.0])  # its derivatives by z


@dataclass(frozen=True, eq=False, repr=False)
class Cells(Valued):
    """Cells of a space, c of them, with q quadrature points each, where they have n scalar functions.

    The functions (3, n, q) are these with their derivatives on the reference cell, `inverse` (2, 2, c, q) the
    derivatives of the reference cell's coordinates by r and z, radii (c, q) r, none of them zero, and the measure
    (c, q) 2 pi r dr dz.
    """

    space: Space
    functions: Array
    inverse: Array
    radii: Array
    measure: Array

    @classmethod
    def of(cls, space: Space) -> Cells:
        """All cells of a space."""
        (points, weights), mapping = cell_quadrature(space), space.mesh.mapping()
        value, slopes = reference_functions(space.element, points)
        functions = np.ascontiguousarray(np.concatenate([value[None], slopes.transpose(1, 0, 2)]))
        r, (inverse, area) = np.ascontiguousarray(mapping.F(points)[0]), inverted(mapping.DF(points))
        return cls(space, functions, np.ascontiguousarray(inverse), r, ring_measure(r) * area * weights)

    def batches(self) -> Iterator[tuple[slice, Cells]]:
        """Parts of the cells, with their numbers, for matrices; `displacements` and `works` are of all cells alone."""
        step = max(1, BATCH // (4 * self.radii.shape[1] * len(self.space.cell_dofs)))
        for first in range(0, len(self.radii), step):
            own = slice(first, first + step)
            yield own, self.some(own)

    def some(self, own: slice | Index) -> Cells:
        """Those of some numbers."""
        return Cells(self.space, self.functions, self.inverse[:, :, own], self.radii[own], self.measure[own])

    @cached_property
    def upright(self) -> Array:
        """Sense, 1 or -1, in which a reference coordinate goes along z, 0 for the other, (2, c), of columns' cells.

        Empty unless all are quadrilaterals in which z goes with one of these in proportion, and r with the other alone.
        """
        smaller, larger = np.sort(np.abs(self.inverse), axis=0)
        in_proportion = np.ptp(larger[1], axis=-1) < 1e-9 * larger[1, :, 0]  # but for rounding
        if self.space.element.refdom.nnodes != 4 or not np.all(smaller < 1e-9 * larger) or not np.all(in_proportion):
            return np.empty((2, 0))
        return np.asarray(np.rint(self.inverse[:, 1, :, 0] / larger[1, :, 0]))

    @cached_property
    def displacements(self) -> Index:
        """Displacement unknowns of each cell, (c, 2 n): u_r of the n functions, then u_z."""
        return np.ascontiguousarray(self.space.cell_dofs.T)

    def gradient(self, u: Array) -> Array:
        """Components of grad u at the points, (5, c, q)."""
        cells = u[self.displacements].reshape(len(self.displacements), 2, -1)
        value, *slopes = (cells.transpose(1, 0, 2)[:, None] @ self.functions).transpose(1, 0, 2, 3)
        plane = slopes[0][:, None] * self.inverse[0] + slopes[1][:, None] * self.inverse[1]
        return np.concatenate([value[:1] / self.radii, plane.reshape(4, *self.radii.shape)])

    def works(self, stress: Array) -> Array:
        """Work of a stress, (5, c, q), in each unit displacement, (N,)."""
        amounts = self.by_functions(stress * self.measure)
        cells = (amounts @ self.functions.transpose(0, 2, 1)).sum(axis=1)
        return summed(self.displacements, cells.transpose(1, 0, 2), self.space.unknowns)

    def by_functions(self, stress: Array) -> Array:
        """What of a stress, (5, ..., c, q), works in a value and in slopes on the reference cell, of u_r and u_z.

        These are the factors, (2, 3, ..., c, q), of the `functions` of a unit displacement.
        """
        plane, amounts = stress[1:].reshape(2, 2, *stress.shape[1:]), np.zeros((2, 3, *stress.shape[1:]))
        amounts[0, 0] = stress[0] / self.radii
        for i in range(2):
            amounts[:, 1 + i] = plane[:, 0] * self.inverse[i, 0] + plane[:, 1] * self.inverse[i, 1]
        return amounts

    def densities(self, stress: Array) -> Array:
        """Work of a stress, (5, c, q), at each point in each unit displacement of its cell, (c, 2 n, q)."""
        found = np.einsum("iacq,anq->cinq", self.by_functions(stress), self.functions)
        return np.asarray(found.reshape(len(self.radii), -1, found.shape[-1]))

    @cached_property
    def pressures(self) -> Array:
        """The pressures of `pressure_modes` made orthonormal in each cell, times the measure, (c, q, modes)."""
        root = np.sqrt(self.measure)[:, :, None]
        return np.asarray(root * np.linalg.qr(root * pressure_modes(self.space))[0])

    def projection(self, field: Array) -> Array:
        """The sum of these pressures in each cell that is nearest to a field at the points, (c, q)."""
        amounts = field[:, None] @ self.pressures
        return np.asarray((amounts @ self.pressures.transpose(0, 2, 1))[:, 0] / self.measure)

    def dilatations(self, terms: Array = DILATATION) -> Array:
        """Relative change of volume, or parts of it, at each point by each unit displacement of a cell, (c, 2 n, q)."""
        return self.densities(np.broadcast_to(terms[:, None, None], (5, *self.radii.shape)))

    def stiffness(self, moduli: Array) -> Array:
        """Matrices (c, 2 n, 2 n) by moduli, the symmetric derivative of the stress by grad u.

        Moduli are (5, 5, c, q), or (5, 5) where they are the same at all points.
        """
        K = np.empty((len(self.radii), *2 * [len(self.space.cell_dofs)]))
        for own, part in self.batches():
            D = moduli[:, :, own] if moduli.ndim > 2 else moduli[:, :, None, None]
            by_one = part.by_functions(D * part.measure)
            by_both = part.by_functions(np.moveaxis(by_one, 2, 0))
            K[own] = part._integrated(np.stack([by_both[0, :, 0], by_both[1, :, 0], by_both[1, :, 1]]))
        return K

    def _integrated(self, factors: Array) -> Array:
        """Matrices (c, 2 n, 2 n): sums over the points of factors times products of two functions.

        The factors (3, 3, 3, c, q) are of u_r with u_r, u_z with u_r and u_z with u_z.
        """
        c, n = len(self.radii), self.functions.shape[1]
        K, by_point = np.empty((c, 2, n, 2, n)), self.functions.transpose(1, 0, 2).reshape(n, -1)
        for both, (i, j) in zip(factors, ((0, 0), (1, 0), (1, 1)), strict=True):
            K[:, i, :, j] = np.einsum("abcq,anq->cnbq", both, self.functions).reshape(c, n, -1) @ by_point.T
        K[:, 0, :, 1] = K[:, 1, :, 0].transpose(0, 2, 1)
        return K.reshape(c, 2 * n, -1)


def cell_stiffness(cells: Cells, poisson: float) -> Array:
    """Return the stiffness matrix of every cell, (c, 2 n, 2 n), in E* beta, ordered as in `Cells.displacements`."""
    return cells.stiffness(of_gradient(elastic_matrix(poisson)))


def of_gradient(D: Array) -> Array:
    """Derivative of the stress by grad u, (5, 5), from that by the strains, (4, 4)."""
    return np.asarray(STRAINS.T @ D @ STRAINS)


def summed(dofs: Index, values: Array, size: int) -> Array:
    """Add up values to the unknowns of the same order, (size,)."""
    return np.asarray(np.bincount(dofs.ravel(), weights=values.ravel(), minlength=size), dtype=np.float64)


def shear_matrix(poisson: float) -> Array:
    """Return the (4, 4) part of the elastic matrix that goes with G, in units of E*."""
    _, G = lame_parameters(poisson)
    return np.diag([2.0 * G, 2.0 * G, 2.0 * G, G])


def elastic_matrix(poisson: float) -> Array:
    """Return the (4, 4) matrix D of stress = D strain, in units of E*."""
    D = shear_matrix(poisson)
    D[:3, :3] += lame_parameters(poisson)[0]
    return D


def cell_quadrature(space: Space) -> tuple[Array, Array]:
    """Return points and weights on the reference cell, enough for r times the product of two shape functions.

    Exact for all strains but the hoop term u_r v_r / r: that is a polynomial in cells with a side on the axis,
    where u_r = 0, and rational elsewhere. Its error is below a thousandth of the element's own: six more points in each
    direction change the deflection by quadrilaterals of degree 6 by 2e-12, which is in error by 1e-7.
    """
    return quadrature(space.element, 2 * space.degree + (2 if space.element.refdom is RefTri else 1))


def inverted(jacobian: Array) -> tuple[Array, Array]:
    """Inverses of Jacobian matrices (2, 2, ...) and the sizes of their determinants (...)."""
    (a, b), (c, d) = jacobian
    determinant = a * d - b * c
    return np.array([[d, -b], [-c, a]]) / determinant, np.abs(determinant)


# Without locking

# Poisson's ratio from which the projection earns its cost, a tenth more time to condense a block. Of the error of the
# pull-off load at tabor 1 it leaves half at 0.4, a third at 0.45 and a tenth or less at 0.4999, at degrees 3 to 9.
REMEDY_FROM = 0.4


def projects(space: Space, poisson: float) -> bool:
    """Whether dilatations of a material are projected: on quadrilaterals, of one that is nearly incompressible."""
    return space.element.refdom.nnodes == 4 and poisson >= REMEDY_FROM


Stiffness = Callable[[], Iterator[tuple[Index, Array]]]
"""Gives the stiffness (k, 2 n, 2 n) of all cells, few at a time, with their numbers (k,): whole it fills the memory."""


def stiffness_of(space: Space, materials: Sequence[Elastic], *, remedy: bool = True) -> Iterator[tuple[Index, Array]]:
    """Stiffness of every cell, of the material of its region, see `Stiffness`; displacements alone without `remedy`."""
    for cells, (poisson, modulus) in zip(space.regions(materials), materials, strict=True):
        part = space if len(materials) == 1 else Space(space.mesh.restrict(cells), space.element)
        every, remedied = Cells.of(part), remedy and projects(space, poisson)
        by = _by_columns if every.upright.size else _by_batches
        for own, K in by(every, poisson, remedied):
            yield cells[own], modulus * K


def _by_batches(cells: Cells, poisson: float, remedied: bool) -> Iterator[tuple[Index | slice, Array]]:
    """Stiffness of every cell with its dilatation projected or not, and their numbers."""
    for own, few in cells.batches():
        yield own, (projected_stiffness if remedied else cell_stiffness)(few, poisson)


def _by_columns(cells: Cells, poisson: float, remedied: bool) -> Iterator[tuple[Index | slice, Array]]:
    """The same of upright cells, those above one another at once: a half-space under a sphere takes half of the time.

    The measure is in proportion to their height, derivatives by z to its reciprocal: of the stiffness a part without
    these grows as the height, one with two of them falls as it grows, and one with one is the same for all.
    """
    D = of_gradient((shear_matrix if remedied else elastic_matrix)(poisson))
    others, lam = 1 - BY_Z, lame_parameters(poisson)[0]
    pairs = np.outer(others, others), np.outer(others, BY_Z) + np.outer(BY_Z, others), np.outer(BY_Z, BY_Z)
    heights = 1 / np.abs(cells.inverse[:, 1, :, 0]).max(axis=0)
    alike = np.hstack([cells.radii[:, [0, -1]], cells.upright.T])
    _, first, column = np.unique(alike, axis=0, return_index=True, return_inverse=True)
    for numbers, few in cells.some(first).batches():
        parts = np.stack([few.stiffness(D * pair) for pair in pairs])
        if remedied:
            r, z = (few.dilatations(DILATATION * which) @ few.pressures for which in (others, BY_Z))
            r_T, z_T = r.transpose(0, 2, 1), z.transpose(0, 2, 1)
            parts += lam * np.stack([r @ r_T, r @ z_T + z @ r_T, z @ z_T])
        for k, one in enumerate(first[numbers]):
            own = np.flatnonzero(column == numbers.start + k)
            times = heights[own] / heights[one]
            yield own, np.tensordot(np.stack([times, np.ones(own.size), 1 / times], axis=1), parts[:, k], 1)


def projected_stiffness(cells: Cells, poisson: float) -> Array:
    """Return the stiffness matrix of every quadrilateral with its dilatation projected; see `pressure_modes`.

    Parameters and result as of `cell_stiffness`.
    """
    K = cells.stiffness(of_gradient(shear_matrix(poisson)))
    projected = cells.dilatations() @ cells.pressures
    K += lame_parameters(poisson)[0] * projected @ projected.transpose(0, 2, 1)
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
    return np.asarray(legvander2d(x, y, [space.degree - 1, space.degree - 1])[:, :-1])
