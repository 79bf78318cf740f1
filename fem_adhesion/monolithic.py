"""The whole contact problem by finite elements: Newton's method on every displacement unknown at once.

Unknowns x = (y, alpha*): reduced displacements y with u = T y, see `fem_adhesion.elasticity.far_field`, and the
approach in eps. The equations say that the body's forces balance the pressure P on the contact surface, for all v = T
z:

    a(u, v) + c(u, v) = -int P(H) v_z 2 pi r dr,        H = -alpha* + mu r^2/2 - mu u_z,

a the strain energy's form in the block, c that of the exterior. Displacements are in mu eps = beta^2/R, pressures in
dgamma/(mu eps), so forces come in R dgamma. scikit-fem assembles every form; nothing is condensed, which makes this the
reference for `fem_adhesion.elasticity.condensation`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import BilinearForm, CellBasis, ElementVector, LinearForm
from skfem.helpers import ddot, sym_grad, trace

from fem_adhesion.elasticity.boundaries import boundary_basis
from fem_adhesion.elasticity.condensation import contact_surface
from fem_adhesion.elasticity.far_field import Exterior, FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import Space, cell_quadrature, lame_parameters
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.contact import ContactProblem, Solver
from halfspace.errors import InputError, NotConverged
from halfspace.laws import LENNARD_JONES, Law
from halfspace.values import Array, Valued


def axisymmetric_elasticity(poisson: float) -> Any:
    """Weak form of linear elasticity without twist: 2 pi r stress(u) : strain(v), hoop strain u_r/r, E* = 1."""
    lam, G = lame_parameters(poisson)

    def weakform(u: Any, v: Any, w: Any) -> Any:
        r = w.x[0]
        hoop_u, hoop_v = u[0] / r, v[0] / r
        dilatation_u, dilatation_v = trace(u.grad) + hoop_u, trace(v.grad) + hoop_v
        strains = ddot(sym_grad(u), sym_grad(v)) + hoop_u * hoop_v
        return (lam * dilatation_u * dilatation_v + 2 * G * strains) * 2 * np.pi * r

    return BilinearForm(weakform)


def block_stiffness(space: Space, poisson: float) -> sparse.csc_array:
    """Return the (N, N) stiffness of the block in E* beta, by the quadrature of `fem_adhesion.elasticity.space`."""
    element, quadrature = ElementVector(space.element), cell_quadrature(space)
    basis = CellBasis(space.mesh, element, quadrature=quadrature, dofs=space.dofs, disable_doflocs=True)
    return sparse.csc_array(axisymmetric_elasticity(poisson).assemble(basis))


def _pressure_work(v: Any, w: Any) -> Any:
    """Work of a pressure, which pushes down, in the vertical displacement v."""
    return -w["pressure"] * v * 2 * np.pi * w.x[0]


def _pressure_change_work(u: Any, v: Any, w: Any) -> Any:
    """Work in v of the change -P'(H) u of the pressure as the surface rises by u and the gap closes."""
    return w["slope"] * u * v * 2 * np.pi * w.x[0]


pressure_work, pressure_change_work = LinearForm(_pressure_work), BilinearForm(_pressure_change_work)


@dataclass(frozen=True, eq=False, repr=False)
class MonolithicProblem(Valued):
    """Equilibrium of a surface law with a block of N displacement unknowns; a `halfspace.equilibrium.newton.Traceable`.

    Attributes
    ----------
    space : Space
        Mesh and element.
    block : (N, N) sparse array
        Stiffness of the block, in E* beta.
    exterior : Exterior
        What lies beyond the far boundary; maps the n reduced unknowns to all.
    contact : skfem.FacetBasis
        Of u_z on the contact facets.
    deflection_rows : (q, n) sparse array
        Deflections w = -u_z at the contact facets' Gauss points, by radius, from the reduced unknowns.
    interface : ContactProblem
        The surface law, and what can be said of a contact from the gaps alone. It knows nothing of elasticity: its
        operator is that of a rigid body.
    """

    space: Space
    block: sparse.csc_array
    exterior: Exterior
    contact: Any
    deflection_rows: sparse.csr_array
    interface: ContactProblem

    @property
    def reuse(self) -> float:
        """As of the condensed problem."""
        return self.interface.reuse

    @property
    def tabor(self) -> float:
        """Tabor parameter mu."""
        return self.interface.tabor

    @cached_property
    def stiffness(self) -> sparse.csc_array:
        """Reduced stiffness T' K T + S of block and exterior, (n, n)."""
        T = self.exterior.reduction
        return sparse.csc_array(T.T @ self.block @ T + self.exterior.stiffness)

    @cached_property
    def vertical(self) -> sparse.csr_array:
        """Rows of T that yield u_z, (functions, n)."""
        return sparse.csr_array(self.exterior.reduction.tocsr()[self.space.components[1]])

    @cached_property
    def _factors(self) -> Any:
        """Factors of the stiffness, symmetric and positive definite; for starts and norms."""
        return splu(self.stiffness, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def undeformed(self, approach: float) -> Array:
        """State without deformation, as a start for Newton's method."""
        return np.append(np.zeros(self.stiffness.shape[0]), approach)

    def state_from(self, approach: float, pressure: Array) -> Array:
        """State of the body at an approach (eps) under a pressure, shape (q,), such as that of a condensed state."""
        forces = self.deflection_rows.T @ (self.interface.operator.at(1.0).weights * pressure)
        return np.append(self._factors.solve(forces), approach)

    def residual(self, x: Array) -> Array:
        """Forces on the reduced unknowns that are out of balance, in R dgamma, shape (n,)."""
        return np.asarray(self.stiffness @ x[:-1] - self.vertical.T @ self._forces(x))

    def jacobian(self, x: Array) -> sparse.csc_array:
        """Derivative of the residual, (n, n + 1): symmetric in the displacements, and indefinite where unstable."""
        mu, T_z = self.tabor, self.vertical
        slope = self.interface.law.slope(self._facet_gaps(x), mu)
        contact = sparse.csr_array(pressure_change_work.assemble(self.contact, slope=slope))
        by_approach = T_z.T @ pressure_work.assemble(self.contact, pressure=slope)
        return sparse.csc_array(sparse.hstack([self.stiffness - mu * (T_z.T @ contact @ T_z), by_approach[:, None]]))

    def _facet_gaps(self, x: Array) -> Array:
        """H at scikit-fem's points of the contact facets, (facets, points)."""
        mu, r = self.tabor, self.contact.global_coordinates()[0]
        u_z = self.contact.interpolate(self.vertical @ x[:-1])
        return np.asarray(-x[-1] + mu * r**2 / 2 - mu * u_z)

    def _forces(self, x: Array) -> Array:
        """Vertical nodal forces of the pressure, (functions,)."""
        pressure = self.interface.law.pressure(self._facet_gaps(x), self.tabor)
        return np.asarray(pressure_work.assemble(self.contact, pressure=pressure))

    def bordered_solver(self, x: Array, row: Array) -> Solver:
        """Factorise the Jacobian with the control's `row` below it; regular at folds, unlike the Jacobian alone."""
        J = sparse.csc_array(sparse.vstack([self.jacobian(x), sparse.csr_array(row[None])]))
        try:
            # A symmetric pattern but for the border, indefinite on the unstable branch: ordered as such, yet pivoted.
            factors = splu(J, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True})
        except RuntimeError as error:  # SuperLU's way of saying so
            raise NotConverged("the bordered Jacobian is singular; try another control or a nearer start") from error
        return lambda rhs, _=0.0: np.asarray(factors.solve(rhs))

    def surface_state(self, x: Array) -> Array:
        """State as the interface knows it: H at the q points by radius, alpha*, and the radii's fixed scale 1."""
        state = self.interface.undeformed(x[-1])
        state[:-2] += self.tabor * (self.deflection_rows @ x[:-1])
        return state

    def state_from_surface(self, state: Array, near: Array | None = None) -> Array:  # noqa: ARG002 (it is linear)
        """State under the pressure that the gaps of an interface's state make."""
        return self.state_from(float(state[-2]), self.interface.pressure(state))

    def _surface_change(self, dx: Array) -> Array:
        return np.append(self.tabor * (self.deflection_rows @ dx[:-1]) - dx[-1], [dx[-1], 0.0])

    def observables(self, x: Array) -> Array:
        """Approach, load, central gap and contact radius (nan without contact), shape (4,)."""
        return self.interface.observables(self.surface_state(x))

    def weighted_observables(self, x: Array, weights: Array) -> float:
        """Sum of the observables by the given weights."""
        return self.interface.weighted_observables(self.surface_state(x), weights)

    def gradient(self, x: Array, weights: Array) -> Array:
        """Derivative by x of the weighted sum of the observables, shape (n + 1,)."""
        row = self.interface.gradient(self.surface_state(x), weights)
        by_gap, by_approach = row[:-2], row[-2]
        return np.append(self.tabor * (self.deflection_rows.T @ by_gap), by_approach - by_gap.sum())

    def longest_step(self, x: Array, dx: Array) -> float:
        """Fraction of the step dx that takes no gap h below a quarter of its value."""
        return self.interface.longest_step(self.surface_state(x), self._surface_change(dx))

    def size(self, x: Array, dx: Array) -> float:
        """Relative change of the gaps and the approach: once they stand still, the linear body does too."""
        return self.interface.size(self.surface_state(x), self._surface_change(dx))

    def misfit(self, x: Array, residual: Array) -> float:
        """Norm, relative to the gaps, of the deflection due to the forces out of balance: the condensed misfit."""
        dH = self.tabor * (self.deflection_rows @ self._factors.solve(residual))
        return self.interface.misfit(self.surface_state(x), np.append(dH, 0.0))

    def negative_directions(self, x: Array) -> int:
        """Number of directions in which the energy falls at fixed approach; 0 means stable under fixed grips.

        The negative pivots of the tangent, factorised without exchanges (Sylvester's law of inertia).
        """
        tangent = self.jacobian(x)[:, :-1]
        try:
            factors = splu(tangent, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError as error:  # SuperLU's way of saying so
            raise NotConverged("the tangent is singular, as at a fold; take a point beside it") from error
        return int(np.sum(factors.U.diagonal() < 0))

    def require_resolution(self, x: Array) -> None:
        """Refuse a state whose contact edge stands on facets too long for the spike of tension; raise GridTooCoarse."""
        self.interface.require_resolution(self.surface_state(x))

    def load(self, x: Array) -> float:
        """W in R dgamma as the integral of the pressure, positive in compression."""
        return self.interface.load(self.surface_state(x))

    def far_reaction(self, x: Array) -> float:
        """Upward force of the exterior on the far boundary, in R dgamma: equal to the load in equilibrium."""
        far, vertical = self.space.boundary_functions("far"), self.space.components[1]
        forces = (self.block @ (self.exterior.reduction @ x[:-1]))[vertical] - self._forces(x)
        return float(self.space.constant[far] @ forces[far])

    def energy(self, x: Array) -> float:
        """Total potential energy in R dgamma eps, of block, exterior and surfaces, beyond the block as undeformed.

        Its gradient by y is mu times the residual; along the equilibria its derivative by the approach is the load.
        """
        y, state = x[:-1], self.surface_state(x)
        forces = self.interface.operator_at(state).weights * self.interface.pressure(state)
        elastic, work = y @ (self.stiffness @ y) / 2, forces @ (self.deflection_rows @ y)
        # The interface takes half the work of the pressure for the elastic energy, which holds in equilibrium only.
        return self.interface.energy(state) + self.tabor * float(elastic - work / 2)


def assemble(
    space: Space,
    poisson: float,
    tabor: float,
    *,
    far_field: FarField = point_load,
    points: int | None = None,
    law: Law = LENNARD_JONES,
) -> MonolithicProblem:
    """Assemble the contact problem of a block under a rigid paraboloid.

    Parameters
    ----------
    space, poisson, points
        As in `fem_adhesion.elasticity.condensation.condense`.
    tabor, law
        As in `halfspace.equilibrium.contact.ContactProblem`.
    far_field : callable
        `point_load` or `clamped`.

    Raises
    ------
    InputError
        If poisson is out of range, or the far field holds the body by a spring that has to be taken off again (`free`).
    """
    points = space.degree + 2 if points is None else points
    exterior = with_interiors(far_field(space, poisson), space)
    if exterior.rigid_compliance:
        raise InputError("a far field with a rigid_compliance is known to `condense` only; use point_load or clamped")
    surface = contact_surface(space, points)
    r, weights = surface.radii, surface.weights
    rigid = ElasticOperator(r, weights, np.zeros((r.size, r.size)), surface.cells, surface.cell_nodes)
    rows = sparse.csr_array(-(surface.values @ exterior.reduction.tocsr()[surface.unknowns]))
    block, contact = block_stiffness(space, poisson), boundary_basis(space, "contact", points)
    return MonolithicProblem(space, block, exterior, contact, rows, ContactProblem(rigid, tabor, law))
