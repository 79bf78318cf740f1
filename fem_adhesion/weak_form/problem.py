"""The discrete problem: the forms of the textbook, assembled by scikit-fem with every displacement among the unknowns.

An unknown vector x (n + 1,) has the free displacements u in beta^2/R and, last, the approach alpha in eps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuadP, ElementVector, FacetBasis, Functional, LinearForm, MeshQuad

from fem_adhesion.weak_form.body import Array, strains
from fem_adhesion.weak_form.contact import LENNARD_JONES, Law, paraboloid
from halfspace.values import Valued


def elasticity(u: Any, v: Any, w: Any) -> Any:
    """a(u, v) = int strains(v) : stresses(u) dV of an isotropic body of revolution with E* = 1."""
    G, r = (1 - w.poisson) / 2, w.x[0]
    bulk = 2 * G * w.poisson / (1 - 2 * w.poisson)
    e_r, e_z, e_hoop, shear = strains(u, r)
    d_r, d_z, d_hoop, d_shear = strains(v, r)
    volume = (e_r + e_z + e_hoop) * (d_r + d_z + d_hoop)
    return 2 * np.pi * r * (2 * G * (e_r * d_r + e_z * d_z + e_hoop * d_hoop) + G * shear * d_shear + bulk * volume)


def traction(v: Any, w: Any) -> Any:
    """Work int t v_z dA of a vertical traction t on the surface."""
    return w.t * v[1] * 2 * np.pi * w.x[0]


def spring(u: Any, v: Any, w: Any) -> Any:
    """Form int k u_z v_z dA of a bed of springs of stiffness k on the surface."""
    return w.k * u[1] * v[1] * 2 * np.pi * w.x[0]


def integral(w: Any) -> Any:
    """Integral int t dA over the surface."""
    return w.t * 2 * np.pi * w.x[0]


@dataclass(frozen=True, eq=False, repr=False)
class Problem(Valued):
    """Equilibrium F(x) = 0 of an elastic body on a mesh under a rigid paraboloid that attracts it.

    Attributes
    ----------
    mesh : MeshQuad
        In beta, with boundaries axis, contact and far, where the body is clamped.
    degree : int
        Of the elements.
    tabor, poisson : float
        Tabor parameter mu and Poisson's ratio.
    disc : float
        Radius in beta of the disc on which the mean square of a change of the gap measures the arclength.
    law : Law
        Of the tension between the surfaces.
    """

    mesh: Any
    degree: int
    tabor: float
    poisson: float
    disc: float
    law: Law = LENNARD_JONES

    @cached_property
    def basis(self) -> Any:
        """Displacements on the cells."""
        return Basis(self.mesh, ElementVector(ElementQuadP(self.degree)), intorder=2 * self.degree + 1)

    @cached_property
    def surface(self) -> Any:
        """Displacements on the contact surface; the law is steeper than any polynomial, hence the points."""
        return FacetBasis(self.mesh, self.basis.elem, facets="contact", intorder=4 * self.degree + 3)

    @cached_property
    def free(self) -> Any:
        """Displacements that are free: no radial ones on the axis, none at the far clamp."""
        held = self.basis.get_dofs("axis").all(["u^1"]), self.basis.get_dofs("far").all()
        return np.setdiff1d(np.arange(self.basis.N), np.concatenate(held))

    @cached_property
    def stiffness(self) -> sparse.csc_array:
        """Matrix of a(u, v) on the free displacements."""
        return sparse.csc_array(self._among_free(BilinearForm(elasticity).assemble(self.basis, poisson=self.poisson)))

    def _among_free(self, matrix: Any) -> Any:
        return matrix[self.free][:, self.free]

    def displacement(self, x: Array) -> Array:
        """All displacements, the held ones zero."""
        u = np.zeros(self.basis.N)
        u[self.free] = x[:-1]
        return u

    def _work(self, t: Array) -> Array:
        """Integral int t v_z dA for each free displacement v."""
        work: Array = np.asarray(LinearForm(traction).assemble(self.surface, t=t))[self.free]
        return work

    def _integral(self, t: Array) -> float:
        return float(Functional(integral).assemble(self.surface, t=t))

    @cached_property
    def _radii(self) -> Array:
        return np.asarray(self.surface.global_coordinates()[0])

    def gap(self, x: Array) -> Array:
        """Gap h = 1 - alpha + mu (z(r) - u_z) in eps at the quadrature points, (facets, points)."""
        return 1 + self.tabor * paraboloid(self._radii) + self.gap_change(x)

    def gap_change(self, dx: Array) -> Array:
        """Change of the gap along dx."""
        u_z = np.asarray(self.surface.interpolate(self.displacement(dx)))[1]
        return np.asarray(-dx[-1] - self.tabor * u_z)

    def residual(self, x: Array) -> Array:
        """F(x) = a(u, v) - mu int sigma(h) v_z dA for each free v."""
        return np.asarray(self.stiffness @ x[:-1] - self.tabor * self._work(self.law.tension(self.gap(x))))

    def residual_along(self, h: Array, dx: Array) -> Array:
        """Change of F(x) along dx."""
        return np.asarray(self.stiffness @ dx[:-1] - self.tabor * self._work(self.law.slope(h) * self.gap_change(dx)))

    def tangent(self, h: Array) -> Any:
        """Factors of dF/du: the form a(u, v) + mu^2 int sigma'(h) u_z v_z dA.

        It is symmetric and factorised without row exchanges, so that the signs of the pivots are those of its
        eigenvalues (Sylvester's law of inertia).
        """
        law = self._among_free(BilinearForm(spring).assemble(self.surface, k=self.tabor**2 * self.law.slope(h)))
        how: dict[str, Any] = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return splu(sparse.csc_array(self.stiffness + law), permc_spec="MMD_AT_PLUS_A", **how)

    def by_approach(self, h: Array) -> Array:
        """dF/dalpha = mu int sigma'(h) v_z dA."""
        return self.tabor * self._work(self.law.slope(h))

    def row(self, direction: Array) -> Array:
        """Row of the inner product with a direction: <x, y> = alpha alpha' + mean over the disc of h h'."""
        mean = np.where(self._radii < self.disc, self.gap_change(direction), 0.0) / (np.pi * self.disc**2)
        return np.append(-self.tabor * self._work(mean), direction[-1] - self._integral(mean))

    def load(self, h: Array) -> float:
        """W = -mu int sigma(h) dA in R dgamma, positive in compression."""
        return -self.tabor * self._integral(self.law.tension(h))

    def load_rate(self, h: Array, dh: Array) -> float:
        """Change of the load with the gap."""
        return -self.tabor * self._integral(self.law.slope(h) * dh)

    def central_gap(self, x: Array) -> float:
        """H(0) = h(0) - 1 in eps, or its change along a direction: it is linear in x."""
        (pole,) = np.flatnonzero((self.mesh.p == 0).all(axis=0))
        return float(-x[-1] - self.tabor * self.displacement(x)[self.basis.nodal_dofs[1, pole]])

    def observables(self, x: Array) -> Array:
        """Approach and load, central gap H(0) = h(0) - 1 in eps, contact radius in beta (nan without contact)."""
        h = self.gap(x)
        return np.array([x[-1], self.load(h), self.central_gap(x), self.contact_radius(h)])

    def contact_radius(self, h: Array) -> float:
        """Outermost radius at which the gap is that of the largest tension, by its polynomial on the facet there."""
        inside = np.where(h < self.law.edge, self._radii, -1.0)
        last = float(inside.max())
        if last < 0:
            return np.nan
        facet = np.argmax(inside.max(axis=1))
        gap = Polynomial.fit(self._radii[facet], h[facet] - self.law.edge, self.degree)
        roots = np.asarray(gap.roots(), complex)
        beyond = roots.real[(roots.real >= last) & (np.abs(roots.imag) < 1e-9 * last)]
        return float(beyond.min()) if beyond.size else last

    def taken_over(self, coarse: Problem, x: Array) -> Array:
        """State with the surface of one on elements of lower degree, whose functions are among these.

        The law sees the surface alone: wherever Newton's method begins below it, its first step ends at the same state.
        """
        u, old = np.zeros(self.basis.N), coarse.displacement(x)
        u[self.basis.nodal_dofs] = old[coarse.basis.nodal_dofs]
        functions = len(coarse.basis.facet_dofs)
        u[self.basis.facet_dofs[:functions]] = old[coarse.basis.facet_dofs]
        return np.append(u[self.free], x[-1])


# The mesh

GROWTH = 3.0  # ratio of the lengths of neighbouring cells beyond the fine ones
CELLS = 0.3  # length of the fine cells in the width of the spike of tension, or of the attraction


def half_space_mesh(tabor: float, load: float, far: float) -> tuple[Any, float]:
    """Box of a half-space as wide and deep as `far` (beta), and the radius up to which its cells are fine.

    That is the contact radius by JKR at the load (R dgamma): the edge, whose spike of tension is as wide as
    1/mu^2 beta, passes by all of it. Attraction is as wide as mu^(-1/2) beta at least.
    """
    swept = (0.75 * (load + 3 * np.pi + np.sqrt(6 * np.pi * load + (3 * np.pi) ** 2))) ** (1 / 3)
    length = CELLS / max(tabor**2, tabor**0.5)
    count = int(np.ceil(swept / length))
    growing = np.cumsum(swept / count * GROWTH ** np.arange(np.ceil(np.log(far / length) / np.log(GROWTH))))
    r = np.concatenate([np.linspace(0, swept, count + 1), swept + GROWTH * growing])
    mesh = MeshQuad.init_tensor(r, np.append(-growing[::-1], 0.0))
    beyond = {"far": lambda x: (x[0] == r[-1]) | (x[1] == -growing[-1])}
    sides = {"axis": lambda x: x[0] == 0, "contact": lambda x: x[1] == 0, **beyond}
    return mesh.with_boundaries(sides), float(swept)
