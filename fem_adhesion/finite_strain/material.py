"""Compressible neo-Hookean solid at finite strain, axisymmetric without twist, scaled so that no strain is too small.

Displacements ubar are in beta^2/R and coordinates in beta, so the deformation gradient is F = I + delta A with
A = grad ubar and the stretch parameter delta = beta/R = sqrt(mu/rho). The energy per reference volume

    psi = G/2 (F : F - 3 - 2 ln J) + lambda/2 (ln J)^2

is divided by delta^2 and the first Piola-Kirchhoff stress by delta, both in E*; they tend to those of the linear
body as delta -> 0 and are finite and exact at delta = 0: wherever a difference of nearly equal numbers would have to
be divided by delta, it is written out. Reference: J. Bonet and R. D. Wood, Nonlinear Continuum Mechanics for Finite
Element Analysis, 2nd ed. (2008), eqs (6.27)-(6.31).

The five components of A, and of the stress conjugate to it, are ordered

    (hoop, rr, rz, zr, zz) = (u_r/r, du_r/dr, du_r/dz, du_z/dr, du_z/dz).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from halfspace.elastic.grid import gauss_legendre
from halfspace.values import Array, Valued

SMALL = 0.5
"""Change of volume below which x - ln(1 + x) is integrated rather than subtracted; ten Gauss points give all digits."""

TRANSPOSED = ((1, 2), (3, 4))
"""Positions of the components of A in the r-z plane: A[i][j] = du_i/dX_j."""


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

    @property
    def volume_ratio(self) -> Array:
        """J; the material is turned inside out where it is not positive."""
        return np.asarray(1 + self.stretch * self.dilatation)

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
    t, weight = gauss_legendre(10)
    t, weight = (1 + t) / 2, weight / 2
    near = np.where(np.abs(x) < SMALL, x, 0.0)
    by_quadrature = np.sum(weight * t / (1 + near[..., None] * t), axis=-1)
    far = np.where(np.abs(x) < SMALL, 1.0, x)
    return np.asarray(np.where(np.abs(x) < SMALL, by_quadrature, (far - np.log1p(far)) / far**2))


def stress(state: Deformation, shear: float, pressure: Array | float) -> Array:
    """First Piola-Kirchhoff stress over delta, (5, ...), in E*: G (A + F^-T A^T) of the shear energy and p F^-T.

    The pressure p is lambda ln(J)/delta, or that of the mixed form: positive in tension.
    """
    A, f = state.gradient, state.inverse_transpose
    stress = np.empty_like(A)
    stress[0] = A[0] * (1 + f[0])
    for i in range(2):
        for j in range(2):
            turned = sum(f[TRANSPOSED[i][k]] * A[TRANSPOSED[j][k]] for k in range(2))
            stress[TRANSPOSED[i][j]] = A[TRANSPOSED[i][j]] + turned
    return np.asarray(shear * stress + pressure * f)


def geometric_moduli(state: Deformation) -> Array:
    """f_iL f_kJ, f = F^-T: minus the derivative of F^-T by F, (5, 5, ...)."""
    f = state.inverse_transpose
    moduli = np.zeros((5, *f.shape))
    moduli[0, 0] = f[0] ** 2
    for i, j, k, m in np.ndindex(2, 2, 2, 2):
        moduli[TRANSPOSED[i][j], TRANSPOSED[k][m]] = f[TRANSPOSED[i][m]] * f[TRANSPOSED[k][j]]
    return moduli


def moduli(state: Deformation, shear: float, pressure: Array | float) -> Array:
    """Derivative of the stress by A at a fixed pressure, (5, 5, ...), in E*: symmetric."""
    result = (shear - state.stretch * np.asarray(pressure)) * geometric_moduli(state)
    for k in range(5):
        result[k, k] += shear
    return result
