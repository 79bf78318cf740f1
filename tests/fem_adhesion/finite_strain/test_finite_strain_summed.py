"""The wall's potential on every particle of the body, and no surface law: what lies underneath the ways of counting."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import ElementQuadP

from fem_adhesion.elasticity.cells import cell_quadrature
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import sliding
from fem_adhesion.elasticity.reference import reference_functions
from fem_adhesion.elasticity.space import Space, scatter
from fem_adhesion.finite_strain.body import material_body
from fem_adhesion.finite_strain.problem import finite_strain_problem
from fem_adhesion.finite_strain.traction import convention_of
from fem_adhesion.mesh import spheres
from halfspace.elastic import grid
from halfspace.equilibrium.charts import Chart, moved, trace_charts
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.equilibrium.search import find_events
from halfspace.profiles.formulas import SphereSurface

TABOR, POISSON = 1.0, 0.3


def potential(H):
    """Minus the tension, which is the energy per volume, and its first two derivatives; in the units of P."""
    h = H + 1
    return (
        8 / 3 * TABOR * (h**-9 - h**-3),
        8 / 3 * TABOR * (3 * h**-4 - 9 * h**-10),
        8 / 3 * TABOR * (90 * h**-11 - 12 * h**-5),
    )


def hemisphere(ratio):
    """A hemisphere with cells fine at the contact edge and in the attracted layer, and its linear pull-off."""
    R = np.sqrt(ratio / TABOR)
    lines = grid.graded(1.35, 0.25, spheres.CORE * R, until=1.6)
    depths = grid.graded(0.0, 0.35 / (TABOR * R), spheres.DEPTH * R, growth=2.0)
    space = Space(spheres.hemisphere(R, lines, depths), ElementQuadP(4))
    condensed = condense(space, POISSON, far_field=sliding)
    linear = ContactProblem(condensed.operator, TABOR, profile=SphereSurface(R))
    event = find_events(trace_charts((Chart(linear, condensed.unknowns),), 0.5))["pull_off"]
    exterior, body = sliding(space, POISSON), material_body(space, POISSON, 1 / R)
    convention = convention_of("projected", POISSON)
    problem = finite_strain_problem(body, exterior, TABOR, profile=SphereSurface(R), convention=convention)
    return SimpleNamespace(problem=problem, event=event, stretch=1 / R)


def pull_off_by(case, traction):
    """Pull-off on the same cells by a surface law."""
    problem = replace(case.problem, convention=convention_of(traction, POISSON))
    return moved(case.event, problem).point


class Summed:
    """Equilibrium of the body's reduced unknowns and the approach under the wall's potential in its volume."""

    def __init__(self, problem):
        self.problem, self.T = problem, problem.held.exterior.reduction
        self.scale = TABOR / problem.stretch  # eps per beta
        space = problem.body.space
        points, _ = cell_quadrature(space)
        self.values, _ = reference_functions(space.element, points)
        self.depth = -self.scale * space.mesh.mapping().F(points)[1]  # of the undeformed body, in eps
        self.volume = problem.body.cells.measure
        self.dofs = problem.body.cells.displacements[:, len(self.values) :]

    def derivatives(self, x):
        """All displacements, and the potential's first two derivatives by the gap at every point, times its volume."""
        u = self.T @ x[:-1]
        H = -x[-1] + self.depth - TABOR * (u[self.dofs] @ self.values)
        _, slope, curvature = (self.scale * self.volume * part for part in potential(H))
        return u, slope, curvature

    def vector(self, amounts):
        """Of the reduced unknowns, from amounts per unit u_z at every point."""
        return self.T.T @ np.bincount(
            self.dofs.ravel(), weights=(amounts @ self.values.T).ravel(), minlength=self.T.shape[0]
        )

    def load(self, slope, approach):
        """Of the wall on all particles, and on those that would go on beyond the mid-plane, which move no more."""
        R = 1 / self.problem.stretch
        beyond, _, _ = potential(-approach + self.scale * R)
        return -slope.sum() + np.pi * R**2 * beyond

    def step(self, x, row, rest):
        """Newton's step to a value of the control, and the tangent along it with the load's rate."""
        u, slope, curvature = self.derivatives(x)
        residual = self.T.T @ self.problem.body.forces(u) - self.vector(slope)
        products = np.einsum("cq,iq,jq->cij", TABOR * curvature, self.values, self.values, optimize=True)
        pairs = [np.broadcast_to(d, products.shape).ravel() for d in (self.dofs[:, :, None], self.dofs[:, None])]
        body = self.problem.body
        K = scatter(body.cell_tangents(u), body.cell_dofs.T, u.size)
        K += sparse.csc_array((products.ravel(), pairs), shape=K.shape)
        by_approach = self.vector(curvature)
        matrix = sparse.block_array([[self.T.T @ K @ self.T, by_approach[:, None]], [row[None, :-1], row[None, -1:]]])
        symmetric = {"permc_spec": "MMD_AT_PLUS_A", "options": {"SymmetricMode": True}}
        factors = splu(matrix.tocsc(), diag_pivot_thresh=0.01, **symmetric)
        tangent = factors.solve(np.append(np.zeros(x.size - 1), 1.0))
        rate = TABOR * by_approach @ tangent[:-1] + curvature.sum() * tangent[-1]
        return factors.solve(-np.append(residual, rest)), rate, self.load(slope, x[-1])

    def at(self, x, gap):
        """State of a central gap, with its load and the load's rate."""
        row = self.problem.gradient(x, np.array([0.0, 0.0, 1.0, 0.0]))
        while True:
            dx, rate, load = self.step(x, row, self.problem.observables(x)[2] - gap)
            if np.abs(dx).max() < 1e-7 * (1 + np.abs(x).max()):
                return x, rate, load
            x = x + self.problem.longest_step(x, dx) * dx

    def pull_off(self, point):
        """Least load, by secants from a state near it."""
        gap = point.observables[2]
        x, rate, _ = self.at(point.x, gap)
        shift = 1e-3
        while abs(shift) > 1e-6:
            x, new, load = self.at(x, gap + shift)
            gap, rate, shift = gap + shift, new, -new * shift / (new - rate)
        return load


def by_yield(case):
    """First order of the yield of the attracted layer in the linear pull-off load: the change of the law, Delta Phi."""
    linear, x, tangent = case.event.problem, case.event.point.x, case.event.point.tangent
    H, law = x[:-2], linear.law
    Phi, P, slope = law.energy(H, TABOR), law.pressure(H, TABOR), law.slope(H, TABOR)
    by_gap = case.stretch * (1 - 2 * POISSON) / (1 - POISSON) ** 2 * (Phi * slope - P**2 / 2)
    return float(linear.operator_at(x).weights * by_gap @ tangent[:-2] / tangent[-2])


@pytest.fixture(scope="module")
def compared():
    """Stretch, and per stretch what the summed model has beyond each way of counting, over what the yield takes."""
    found = []
    for ratio in (1000.0, 3000.0):
        case = hemisphere(ratio)
        points = {name: pull_off_by(case, name) for name in ("projected", "reference", "normal", "vertical")}
        summed = Summed(case.problem).pull_off(points["projected"])
        rest = {name: (summed - point.observables[LOAD]) / by_yield(case) for name, point in points.items()}
        found.append((case.stretch, rest))
    return found


def test_the_summed_model_tends_to_the_blend_alone(compared):
    """To the first order in beta/R, once the yield of the attracted layer is taken out."""
    (d1, coarse), (d2, fine) = compared
    limits = {name: fine[name] + (fine[name] - coarse[name]) * d2 / (d1 - d2) for name in fine}
    assert limits["projected"] == pytest.approx(1, abs=0.005)
    for name in ("reference", "normal", "vertical"):
        assert abs(limits[name] - 1) > 0.04
