"""A neo-Hookean body by finite elements: stress and tangent at a point, and forces, tangent and energy of its unknowns.

Axisymmetric without twist, total Lagrangian, and scaled so that no strain is too small. Displacements ubar are in
beta^2/R and coordinates in beta, so the deformation gradient is F = I + delta A with A = grad ubar and the stretch
parameter delta = beta/R = sqrt(mu/rho). The energy per reference volume

    psi = G/2 (F : F - 3 - 2 ln J) + lambda/2 (ln J)^2

is divided by delta^2 and the first Piola-Kirchhoff stress by delta, both in E*; they tend to those of the linear
body as delta -> 0 and are finite and exact at delta = 0: wherever a difference of nearly equal numbers would have to
be divided by delta, it is written out. J. Bonet and R. D. Wood, Nonlinear Continuum Mechanics for Finite Element
Analysis, 2nd ed. (2008), eqs (6.27)-(6.31). The components of A, and of the stress conjugate to it, are ordered as in
`fem_adhesion.elasticity.cells`. Forces are in R dgamma, energies in R dgamma mu eps.

Displacements alone lock as Poisson's ratio nears 1/2. Then a continuous pressure joins them (Taylor and Hood): the
energy density

    psi = psi_shear(F) + p ln J - p^2/(2 lambda)

is stationary at p = lambda ln J, where it is that of the displacements alone; but p comes from a space one degree below
theirs, so that no more conditions on J are left at nu -> 1/2 than the displacements can meet. Pressures are in
E* beta/R and positive in tension. The same book, section 8.6, with ln J for J - 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from skfem import Dofs

from fem_adhesion.elasticity.cells import Cells, cell_quadrature, summed
from fem_adhesion.elasticity.reference import reference_functions
from fem_adhesion.elasticity.space import Space, lame_parameters, scatter
from halfspace.elastic.grid import gauss_legendre
from halfspace.errors import InputError
from halfspace.limits import require_between
from halfspace.values import Array, Index, Valued


def in_plane(components: Array) -> Array:
    """Those in the r-z plane of five, as a matrix (2, 2, ...): A[i][j] = du_i/dX_j."""
    return components[1:].reshape(2, 2, *components.shape[1:])


@dataclass(frozen=True, eq=False, repr=False)
class Deformation(Valued):
    """Deformation at points, from the displacement gradient A, (5, ...); delta is zero for infinitesimal strains."""

    gradient: Array
    stretch: float

    @cached_property
    def plane_dilatation(self) -> Array:
        """Change of area in the r-z plane over delta."""
        _, rr, rz, zr, zz = self.gradient
        return np.asarray(rr + zz + self.stretch * (rr * zz - rz * zr))

    @cached_property
    def dilatation(self) -> Array:
        """(J - 1)/delta, without cancellation."""
        hoop, plane = self.gradient[0], self.plane_dilatation
        return np.asarray(hoop + plane + self.stretch * hoop * plane)

    @cached_property
    def log_volume(self) -> Array:
        """ln(J)/delta, which tends to the trace of A as delta -> 0; nan where the material is turned inside out."""
        v = self.dilatation
        with np.errstate(invalid="ignore", divide="ignore"):  # a trial of Newton's method, refused for being nan
            return np.asarray(np.log1p(self.stretch * v) / self.stretch if self.stretch else v)

    @cached_property
    def inverse_transpose(self) -> Array:
        """F^-T, (5, ...): the derivative of ln J by F."""
        delta, (hoop, rr, rz, zr, zz) = self.stretch, self.gradient
        plane = 1 + delta * self.plane_dilatation
        in_plane = np.array([1 + delta * zz, -delta * zr, -delta * rz, 1 + delta * rr]) / plane
        return np.concatenate([(1 / (1 + delta * hoop))[None], in_plane])


def shear_energy(state: Deformation, shear: float) -> Array:
    """G/2 (F : F - 3 - 2 ln J) over delta^2, in E*, without cancellation.

    With J = 1 + delta v it is G (A : A/2 + (tr A - v)/delta + v^2 (x - ln(1 + x))/x^2), x = delta v.
    """
    hoop, rr, rz, zr, zz = state.gradient
    v, plane = state.dilatation, rr * zz - rz * zr
    second_order = plane + hoop * state.plane_dilatation  # (v - tr A)/delta
    norm = np.sum(state.gradient**2, axis=0)
    return np.asarray(shear * (norm / 2 - second_order + v**2 * _log_remainder(state.stretch * v)))


def _log_remainder(x: Array) -> Array:
    """(x - ln(1 + x))/x^2 = int_0^1 t/(1 + x t) dt, 1/2 at x = 0."""
    t, weight = gauss_legendre(10)  # which give all digits up to a change of volume of a half
    small = np.abs(x) < 0.5
    t, weight = (1 + t) / 2, weight / 2
    near = np.where(small, x, 0.0)
    by_quadrature = np.sum(weight * t / (1 + near[..., None] * t), axis=-1)
    far = np.where(small, 1.0, x)
    return np.asarray(np.where(small, by_quadrature, (far - np.log1p(far)) / far**2))


def stress(state: Deformation, shear: float, pressure: Array | float) -> Array:
    """First Piola-Kirchhoff stress over delta, (5, ...), in E*: G (A + F^-T A^T) of the shear energy and p F^-T.

    The pressure p is lambda ln(J)/delta, or that of the mixed form: positive in tension.
    """
    A, f = state.gradient, state.inverse_transpose
    turned = f * A  # F^-T A^T, of the hoop
    in_plane(turned)[:] = np.einsum("ik...,jk...->ij...", in_plane(f), in_plane(A))
    return np.asarray(shear * (A + turned) + pressure * f)


def moduli(state: Deformation, shear: float, pressure: Array | float) -> Array:
    """Derivative of the stress by A at a fixed pressure, (5, 5, ...), in E*: symmetric.

    Minus the derivative of F^-T by F is f_iL f_kJ, f = F^-T.
    """
    f = state.inverse_transpose
    result = np.zeros((5, *f.shape))
    result[0, 0] = f[0] ** 2
    result[1:, 1:] = np.einsum("im...,kj...->ijkm...", in_plane(f), in_plane(f)).reshape(4, 4, *f.shape[1:])
    result *= shear - state.stretch * np.asarray(pressure)
    for k in range(5):
        result[k, k] += shear
    return result


# The body


@dataclass(frozen=True, eq=False, repr=False)
class Body(Valued):
    """A neo-Hookean body of N displacement and M pressure unknowns, in this order; M = 0 for displacements alone.

    Poisson's ratio is that of small strains; the stretch delta = beta/R = sqrt(mu/rho) is zero for the linear body. A
    cell has m functions of pressure: `pressure_functions` (m, q) at its q quadrature points, the same in every cell,
    whose numbers `pressures` (cells, m) are from 0; `products` (M, M) are those of two pressures, integrated over the
    body.
    """

    cells: Cells
    poisson: float
    stretch: float
    pressure_functions: Array
    pressures: Index
    products: sparse.csc_array

    @property
    def space(self) -> Space:
        """Of the displacements."""
        return self.cells.space

    @property
    def unknowns(self) -> int:
        """Number of unknowns N + M."""
        return self.space.unknowns + self.products.shape[0]

    @cached_property
    def cell_dofs(self) -> Index:
        """Unknowns of each cell, (cells, k): displacements, then pressures."""
        return np.concatenate([self.cells.displacements, self.space.unknowns + self.pressures], axis=1)

    def deformation(self, u: Array) -> Deformation:
        """Deformation at the points under all unknowns."""
        return Deformation(self.cells.gradient(u), self.stretch)

    def forces(self, u: Array) -> Array:
        """Forces on the displacements, in R dgamma, and what is left of p = lambda ln J in each pressure, (N + M,)."""
        (lam, G), state = self._lame, self.deformation(u)
        forces = self.cells.works(stress(state, G, self._pressure(state, u)))
        volumes = self._of_pressures(state.log_volume)
        return np.append(forces, volumes - self.products @ u[self.space.unknowns :] / lam)

    def tangent_product(self, u: Array) -> Callable[[Array], Array]:
        """Derivative of the forces along any change of the unknowns."""
        (lam, _), state, N = self._lame, self.deformation(u), self.space.unknowns
        D, f = self._moduli(state, u), state.inverse_transpose

        def product(v: Array) -> Array:
            A = self.cells.gradient(v)
            change = np.einsum("abcq,bcq->acq", D, A)
            work = self._of_pressures(np.sum(f * A, axis=0)) - self.products @ v[N:] / lam
            return np.append(self.cells.works(change + f * self._at_points(v[N:])), work)

        return product

    def cell_tangents(self, u: Array) -> Array:
        """The same, symmetric, cell by cell, (cells, k, k): with pressures each a saddle point."""
        state, values = self.deformation(u), self.pressure_functions
        K = self.cells.stiffness(self._moduli(state, u))
        if not self._mixed:
            return K
        beside = self.cells.densities(state.inverse_transpose * self.cells.measure) @ values.T
        own = (self.cells.measure[:, None] * values) @ values.T / -self._lame[0]
        return np.block([[K, beside], [beside.transpose(0, 2, 1), own]])

    def energy(self, u: Array) -> float:
        """Elastic energy in R dgamma mu eps."""
        (lam, G), state = self._lame, self.deformation(u)
        p = self._pressure(state, u)
        volumetric = p * state.log_volume - p**2 / (2 * lam) if self._mixed else p * state.log_volume / 2
        return float(np.sum(self.cells.measure * (shear_energy(state, G) + volumetric)))

    def least_volume_ratio(self, u: Array) -> float:
        """Least J at any quadrature point; the body is turned inside out where it is not positive."""
        return 1 + self.stretch * float(self.deformation(u).dilatation.min())

    @property
    def _mixed(self) -> bool:
        return len(self.pressure_functions) > 0

    @property
    def _lame(self) -> tuple[float, float]:
        return lame_parameters(self.poisson)

    def _pressure(self, state: Deformation, u: Array) -> Array:
        """Pressure at the points."""
        if self._mixed:
            return self._at_points(u[self.space.unknowns :])
        return self._lame[0] * state.log_volume

    def _moduli(self, state: Deformation, u: Array) -> Array:
        """Derivative of the stress by grad u, at fixed pressure unknowns, (5, 5, cells, q)."""
        lam, G = self._lame
        D, f = moduli(state, G, self._pressure(state, u)), state.inverse_transpose
        return D if self._mixed else D + lam * f[:, None] * f

    def _at_points(self, p: Array) -> Array:
        return np.asarray(p[self.pressures] @ self.pressure_functions)

    def _of_pressures(self, amounts: Array) -> Array:
        """Amounts at the points, integrated with each pressure function, (M,)."""
        integrals = (self.cells.measure * amounts) @ self.pressure_functions.T
        return summed(self.pressures, integrals, self.products.shape[0])


def material_body(space: Space, poisson: float, stretch: float, pressure: Any = None) -> Body:
    """Prepare a body of displacements, or of these and pressures, needed where displacements alone would lock.

    The pressure's element is one degree below the displacement's: ElementTriP1 with ElementTriP2, ElementQuadP(p - 1)
    with ElementQuadP(p). InputError if poisson is out of range, or zero with a pressure, which it leaves undetermined,
    or the stretch of 0 to 2: a larger one is of a sphere smaller than its own contact.
    """
    if lame_parameters(poisson)[0] == 0.0 and pressure:
        raise InputError("poisson = 0 leaves the pressure undetermined; leave the pressure out, nothing locks there")
    require_between(stretch, "stretch", 0.0, 2.0, "give beta/R = sqrt(tabor/radius_ratio)")
    cells = Cells.of(space)
    if not pressure:
        none = np.zeros((0, cells.radii.shape[1])), np.zeros((len(cells.radii), 0), dtype=np.intp)
        return Body(cells, poisson, stretch, *none, sparse.csc_array((0, 0)))
    dofs = Dofs(space.mesh, pressure)
    by_cell = np.asarray(dofs.element_dofs, dtype=np.intp)
    values, _ = reference_functions(pressure, cell_quadrature(space)[0])
    products = scatter((cells.measure[:, None] * values) @ values.T, by_cell, dofs.N)
    return Body(cells, poisson, stretch, values, by_cell.T, products)
