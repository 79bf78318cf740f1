"""Axisymmetric isotropic elasticity: strains, elastic matrix, measure and cell stiffness matrices.

Lengths in beta and E* = 1, so Young's modulus is E = 1 - nu^2. Strains and stresses are ordered
(rr, zz, hoop, rz) with the engineering shear gamma_rz = du_r/dz + du_z/dr.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy import sparse
from skfem import Dofs, ElementQuadP, ElementVector
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fem_adhesion.elasticity.tensor import Products, integrated, products
from fem_adhesion.materials import Elastic
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued

BATCH = 400_000
"""Numbers held in one batch of strain-displacement matrices: 16 MB, small enough for the cache to help."""


@dataclass(frozen=True, eq=False, repr=False)
class Space(Valued):
    """Displacements (u_r, u_z), both expanded in one scalar element on one mesh.

    The mesh has the boundaries "axis", "contact" and "far", see `fem_adhesion.mesh.block`; the element n functions per
    cell: ElementTriP1, P2, P3, ElementQuad1 or ElementQuadP(p).
    """

    mesh: Any
    element: Any

    @cached_property
    def dofs(self) -> Any:
        """Numbering of the vector unknowns, that of skfem.Basis(mesh, ElementVector(element))."""
        return Dofs(self.mesh, ElementVector(self.element))

    @cached_property
    def scalar_dofs(self) -> Any:
        """Numbering of the scalar element's unknowns, that of skfem.Basis(mesh, element)."""
        return Dofs(self.mesh, self.element)

    @cached_property
    def components(self) -> Index:
        """Unknowns u_r (row 0) and u_z (row 1) that belong to each scalar function, (2, functions): by turns."""
        return np.arange(2 * int(self.scalar_dofs.N)).reshape(-1, 2).T

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (2 n, cells): first u_r of all n functions, then u_z."""
        return np.concatenate(list(self.components[:, self.scalar_dofs.element_dofs]))

    @property
    def interior_dofs(self) -> Index:
        """Unknowns that belong to one cell only: both components of the n_i last functions of each."""
        return self.components[:, self.scalar_dofs.interior_dofs].ravel()

    @property
    def inside(self) -> Index:
        """Positions of these among the 2 n of each cell, ascending."""
        positions = np.arange(len(self.cell_dofs)).reshape(2, -1)
        return positions[:, positions.shape[1] - self.element.interior_dofs :].ravel()

    def boundary_functions(self, name: str) -> Index:
        """Return the numbers of the scalar functions that do not vanish on the named boundary, ascending."""
        dofs, facets = self.scalar_dofs, self.mesh.boundaries[name]
        corners = np.unique(self.mesh.facets[:, facets])
        along = dofs.facet_dofs[:, facets] if self.element.facet_dofs else dofs.facet_dofs
        return np.sort(np.concatenate([dofs.nodal_dofs[:, corners].ravel(), along.ravel()]).astype(np.intp))

    @cached_property
    def constant(self) -> Array:
        """Coefficients of the field 1, (functions,): which functions those are differs between elements."""
        X, _ = quadrature(self.element, 2 * self.degree)
        n = len(self.scalar_dofs.element_dofs)
        values = np.array([self.element.lbasis(X, i)[0] for i in range(n)])
        coefficients = np.empty(self.scalar_dofs.N)
        coefficients[self.scalar_dofs.element_dofs] = np.linalg.lstsq(values.T, np.ones(X.shape[1]))[0][:, None]
        return coefficients

    def regions(self, materials: Sequence[Elastic]) -> list[Index]:
        """Cells of each material: all of one, or the subdomains of the mesh, in their order."""
        if len(materials) == 1:
            return [np.arange(self.mesh.nelements)]
        return [np.asarray(self.mesh.subdomains[str(n)], dtype=np.intp) for n in range(len(materials))]

    @property
    def unknowns(self) -> int:
        """Number of unknowns before any is constrained."""
        return 2 * int(self.scalar_dofs.N)

    @property
    def degree(self) -> int:
        """Polynomial degree p of the element."""
        return int(self.element.facet_dofs) + 1


CellStiffness = Callable[[Space, float], Array]
"""Stiffness matrices of all cells of a space at a Poisson's ratio, as `cell_stiffness` returns them."""


def lame_parameters(poisson: float) -> tuple[float, float]:
    """Return Lamé's (lambda, G) of the material with E* = E/(1 - nu^2) = 1; InputError unless 0 <= poisson < 0.5."""
    if not 0.0 <= poisson < 0.5:
        raise InputError(f"poisson = {poisson} must lie in [0, 0.5); displacements alone lock at 0.5, use 0.49 or less")
    E = 1.0 - poisson**2
    return E * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), E / (2.0 * (1.0 + poisson))


def shear_matrix(poisson: float) -> Array:
    """Return the (4, 4) part of the elastic matrix that goes with G, in units of E*."""
    _, G = lame_parameters(poisson)
    return np.diag([2.0 * G, 2.0 * G, 2.0 * G, G])


def elastic_matrix(poisson: float) -> Array:
    """Return the (4, 4) matrix D of stress = D strain, in units of E*."""
    D = shear_matrix(poisson)
    D[:3, :3] += lame_parameters(poisson)[0]
    return D


def ring_measure(r: Array) -> Array:
    """Return 2 pi r, the area of revolution per unit area (or length) of the r-z plane."""
    return 2.0 * np.pi * r


def strain_displacement(value: Array, grad: Array, r: Array) -> Array:
    """Return the strains e_rr, e_zz, u_r/r, gamma_rz of the unit displacements of a cell, (cells, 4, q, 2 n).

    First are those of unit u_r of all n functions, then of unit u_z. Values (n, cells, q) are of the scalar functions
    at q quadrature points, grad (n, 2, cells, q) their derivatives by r and z, and r (cells, q) the points' radii, none
    of them zero.
    """
    n, cells, q = value.shape
    d_dr, d_dz = grad.transpose(1, 2, 3, 0)
    B = np.zeros((cells, 4, q, 2, n))
    B[:, 0, :, 0] = d_dr
    B[:, 1, :, 1] = d_dz
    B[:, 2, :, 0] = (value / r).transpose(1, 2, 0)
    B[:, 3, :, 0] = d_dz
    B[:, 3, :, 1] = d_dr
    return B.reshape(cells, 4, q, 2 * n)


def cell_quadrature(space: Space) -> tuple[Array, Array]:
    """Return points and weights on the reference cell, enough for r times the product of two shape functions.

    Exact for all strains but the hoop term u_r v_r / r: that is a polynomial in cells with a side on the axis,
    where u_r = 0, and rational elsewhere. Its error is below a thousandth of the element's own: six more points in each
    direction change the deflection by quadrilaterals of degree 6 by 2e-12, which is in error by 1e-7.
    """
    return quadrature(space.element, _order(space))


@lru_cache(maxsize=100)
def quadrature(domain: Any, order: int) -> tuple[Array, Array]:
    """Points and weights on an element's reference cell, or on a reference side; kept, and not to be written to."""
    rule = get_quadrature(domain, order)
    for numbers in rule:
        numbers.flags.writeable = False
    return rule[0], rule[1]


def cell_points(space: Space) -> tuple[Array, Array, Array]:
    """Radii (cells, q) of these points, the reference cell's coordinates by r and z, and 2 pi r dr dz, (cells, q).

    The derivatives (2, 2, cells, q) are the inverse of the Jacobian.
    """
    (points, weights), mapping = cell_quadrature(space), space.mesh.mapping()
    r, (inverse, area) = np.asarray(mapping.F(points)[0]), inverted(mapping.DF(points))
    return r, inverse, ring_measure(r) * area * weights


def cell_products(space: Space) -> Products:
    """Products of the functions of a space of ElementQuadP at these points."""
    return products(space.element, _order(space))


def _order(space: Space) -> int:
    return 2 * space.degree + (2 if space.element.refdom is RefTri else 1)


def cell_stiffness(space: Space, poisson: float) -> Array:
    """Return the stiffness matrix of every cell, (cells, 2 n, 2 n), in E* beta, ordered as in ``space.cell_dofs``."""
    D = elastic_matrix(poisson)
    if isinstance(space.element, ElementQuadP):
        return _product_stiffness(space, D)
    return np.concatenate([strain_products(D, B, dA) for _, B, dA in cell_strains(space)])


def _product_stiffness(space: Space, D: Array) -> Array:
    """Return the same of quadrilaterals, where a sum over points is one of products."""
    functions, (r, inverse, dA) = cell_products(space), cell_points(space)
    K = np.empty((space.mesh.nelements, *functions.places.shape))
    for cells in _batches(space, r.shape[1]):
        # Of a function whose value or one of whose slopes is 1.
        value, grad = np.zeros((3, *dA[cells].shape)), np.zeros((3, 2, *dA[cells].shape))
        value[0], grad[1:] = 1.0, inverse[:, :, cells]
        B = np.ascontiguousarray(strain_displacement(value, grad, r[cells]).transpose(1, 3, 0, 2))
        stress = np.tensordot(D, B, axes=1) * dA[cells]
        u_r, u_z = slice(0, 3), slice(3, 6)
        pairs = (u_r, u_r), (u_z, u_r), (u_z, u_z)
        work = [sum(b[one, None] * s[other] for b, s in zip(B, stress, strict=True)) for one, other in pairs]
        K[cells] = integrated(np.array(work), functions)
    return K


def strain_products(D: Array, B: Array, dA: Array) -> Array:
    """Return int B' D B dA of every cell, (cells, 2 n, 2 n), from `cell_strains`."""
    stress = (D @ B.reshape(*B.shape[:2], -1)).reshape(B.shape) * dA[:, None, :, None]
    rows = (len(B), -1, B.shape[-1])
    products: Array = B.reshape(rows).transpose(0, 2, 1) @ stress.reshape(rows)
    return products


def cell_strains(space: Space) -> Iterator[tuple[slice, Array, Array]]:
    """Cut the cells into batches: their numbers, their strains B, (cells, 4, q, 2 n), and 2 pi r dr dz, (cells, q)."""
    value, slopes = reference_functions(space.element, cell_quadrature(space)[0])
    radii, inverse, dA = cell_points(space)
    for cells in _batches(space, radii.shape[1]):
        r = radii[cells]
        grad = np.einsum("ijcq,niq->njcq", inverse[:, :, cells], slopes, optimize=True)
        yield cells, strain_displacement(np.broadcast_to(value[:, None], (len(value), *r.shape)), grad, r), dA[cells]


def inverted(jacobian: Array) -> tuple[Array, Array]:
    """Inverses of Jacobian matrices (2, 2, ...) and the sizes of their determinants (...)."""
    (a, b), (c, d) = jacobian
    determinant = a * d - b * c
    return np.array([[d, -b], [-c, a]]) / determinant, np.abs(determinant)


def reference_functions(element: Any, points: Array) -> tuple[Array, Array]:
    """Values (n, q) and derivatives (n, 2, q) of an element's functions at points (2, q) of the reference cell.

    They are kept, and not to be written to: all meshes of the same element ask for the same.
    """
    return _functions(element, points.shape, points.tobytes())


@lru_cache(maxsize=100)
def _functions(element: Any, shape: tuple[int, ...], places: bytes) -> tuple[Array, Array]:
    points = np.frombuffer(places).reshape(shape)
    count = (
        element.refdom.nnodes * element.nodal_dofs + element.refdom.nfacets * element.facet_dofs + element.interior_dofs
    )
    found = [element.lbasis(points, i) for i in range(count)]
    values = np.array([np.broadcast_to(value, points.shape[1:]) for value, _ in found])
    slopes = np.array([np.broadcast_to(slope, points.shape) for _, slope in found])
    values.flags.writeable = slopes.flags.writeable = False
    return values, slopes


def scatter(blocks: Array, dofs: Index, size: int) -> sparse.csc_array:
    """Add up the (cells, n, n) blocks of the (n, cells) unknowns in a sparse matrix of the given size."""
    return scatter_pairs(blocks, dofs, dofs, (size, size))


def scatter_pairs(blocks: Array, row_dofs: Index, column_dofs: Index, shape: tuple[int, int]) -> sparse.csc_array:
    """Add up (cells, m, n) blocks that couple the (m, cells) unknowns of one space with the (n, cells) of another."""
    rows = np.broadcast_to(row_dofs.T[:, :, None], blocks.shape).ravel()
    columns = np.broadcast_to(column_dofs.T[:, None, :], blocks.shape).ravel()
    return sparse.csc_array((blocks.ravel(), (rows, columns)), shape=shape)


def _batches(space: Space, points: int) -> list[slice]:
    """Cut the cells into batches, given their quadrature points."""
    step = max(1, BATCH // (4 * points * len(space.cell_dofs)))
    return [slice(first, first + step) for first in range(0, space.mesh.nelements, step)]
