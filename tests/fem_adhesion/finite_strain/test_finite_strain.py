"""The body at finite strain: its material, its equations, the linear limit, and its energy."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from references import taylor_hood
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve
from skfem import Basis, ElementQuad1, ElementQuad2, ElementQuadP, ElementTriP1, ElementTriP2

from fem_adhesion.elasticity import cells
from fem_adhesion.elasticity.cells import Cells
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, sliding
from fem_adhesion.elasticity.space import Space, lame_parameters
from fem_adhesion.finite_strain import body as material
from fem_adhesion.finite_strain.body import material_body
from fem_adhesion.finite_strain.problem import finite_strain_problem
from fem_adhesion.finite_strain.traction import Convention, columns, convention_of, yielded_adhesion
from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc, tensor_grid
from halfspace.elastic import grid
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import Chart, moved, trace_charts, transfer
from halfspace.equilibrium.contact import CENTRAL_GAP, ContactProblem
from halfspace.equilibrium.search import find_events
from halfspace.laws import LENNARD_JONES, Dlvo, Exponential, Morse, PowerLaw
from halfspace.profiles.formulas import SphereSurface

LAM, G = 0.7, 0.4
VERTICAL, NORMAL, REFERENCE = Convention(1.0, 0.0), Convention(1.0, 1.0), Convention(0.0, 0.0)
BLEND = Convention(3 / 7, 3 / 7)  # at a Poisson's ratio of 0.3
STRETCHES = [0.0, 1e-8, 0.5]
RNG = np.random.default_rng(7)


def block(degree=3, fine=0.4):
    return Space(block_grid(fine, 1.5, 20.0), ElementQuadP(degree) if degree > 2 else ElementQuad2())


def problem_of(space, stretch, poisson=0.3, convention=VERTICAL, pressure=None, tabor=1.0, far_field=clamped):
    body = material_body(space, poisson, stretch, pressure)
    return finite_strain_problem(body, far_field(space, poisson), tabor, convention=convention)


def entered(problem, gaps=(2.0, 1.0, 0.5, 0.2, 0.0)):
    """A state in contact, on the unstable branch or beyond."""
    x = newton.solve(problem, problem.undeformed(-6.0), newton.approach(-6.0)).x
    for gap in gaps:
        x = newton.solve(problem, x, newton.central_gap(gap)).x
    return x


def directions(problem, x):
    """A direction in which nothing vanishes, smooth enough for difference quotients."""
    dx = problem.bordered_solver(x, np.eye(1, x.size, x.size - 1)[0])(RNG.normal(size=x.size))
    return dx / np.abs(dx).max()


def derivative(problem, x):
    """Of the residual by the reduced unknowns."""
    return np.apply_along_axis(partial(problem.along, x), 0, np.eye(x.size, x.size - 1))


def central_difference(function, x, direction, step=2e-4):
    """Fourth-order difference quotient of a function along a direction."""
    near, far = (function(x + k * step * direction) - function(x - k * step * direction) for k in (1, 2))
    return (8 * near - far) / (12 * step)


def stress(state):
    return material.stress(state, G, LAM * state.log_volume)


def moduli(state):
    f = state.inverse_transpose
    return material.moduli(state, G, LAM * state.log_volume) + LAM * f[:, None] * f


def energy(state):
    return material.shear_energy(state, G) + LAM / 2 * state.log_volume**2


# The material


@pytest.mark.parametrize("stretch", STRETCHES)
def test_stress_and_moduli_are_the_derivatives_of_the_energy(stretch):
    A, dA = RNG.normal(size=(2, 5, 6)) * 0.3

    def along(function):
        return central_difference(lambda t: function(material.Deformation(A + t * dA, stretch)), 0.0, 1.0)

    state = material.Deformation(A, stretch)
    np.testing.assert_allclose(np.sum(stress(state) * dA, axis=0), along(energy), atol=1e-10)
    D = moduli(state)
    np.testing.assert_allclose(np.einsum("abq,bq->aq", D, dA), along(stress), atol=1e-10)
    np.testing.assert_allclose(D, D.transpose(1, 0, 2), rtol=0, atol=1e-14)


def test_energy_is_that_of_the_formula_at_large_strains():
    A, delta = RNG.normal(size=(5, 200)) * 0.4, 0.6
    F = np.zeros((200, 3, 3))
    F[:, 0, 0], F[:, 0, 2], F[:, 2, 0], F[:, 2, 2] = 1 + delta * A[1], delta * A[2], delta * A[3], 1 + delta * A[4]
    F[:, 1, 1] = 1 + delta * A[0]
    J = np.linalg.det(F)
    assert J.min() > 0.1
    assert J.max() > 1.9  # on both sides of where ln(1 + x) is integrated
    invariant = np.einsum("qij,qij->q", F, F)
    expected = (G / 2 * (invariant - 3 - 2 * np.log(J)) + LAM / 2 * np.log(J) ** 2) / delta**2
    np.testing.assert_allclose(energy(material.Deformation(A, delta)), expected, rtol=1e-12)


def test_no_digit_is_lost_as_the_strains_vanish():
    A = RNG.normal(size=(5, 50))
    linear, tiny = (material.Deformation(A, delta) for delta in (0.0, 1e-8))
    for quantity in (energy, stress, moduli):
        np.testing.assert_allclose(quantity(tiny), quantity(linear), rtol=0, atol=3e-7)
    hoop, rr, rz, zr, zz = A
    by_hooke = LAM * (hoop + rr + zz) + 2 * G * np.array([hoop, rr, zz])
    np.testing.assert_allclose(stress(linear)[[0, 1, 4]], by_hooke, atol=1e-14)
    np.testing.assert_allclose(stress(linear)[[2, 3]], [G * (rz + zr)] * 2, atol=1e-14)


def test_a_rigid_rotation_turns_the_stress_and_stores_nothing():
    delta, angle = 0.5, 0.8
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    A = RNG.normal(size=5) * 0.3
    turned = A.copy()
    turned[1:] = ((Q @ (np.eye(2) + delta * A[1:].reshape(2, 2)) - np.eye(2)) / delta).ravel()
    before, after = material.Deformation(A, delta), material.Deformation(turned, delta)
    assert energy(after) == pytest.approx(energy(before), rel=1e-13)
    expected = (Q @ stress(before)[1:].reshape(2, 2)).ravel()
    np.testing.assert_allclose(stress(after)[1:], expected, atol=1e-14)


# Bodies


@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("lateral", ["free", "equal"])
def test_a_stretched_cylinder_has_the_closed_form_stress(mixed, lateral):
    delta, nu, axial = 0.4, 0.3, 1.5
    lam, shear = lame_parameters(nu)

    def principal(own, J):
        return shear * (own - 1 / own) + lam * np.log(J) / own

    uniaxial = brentq(lambda s: principal(s, s**2 * axial), 0.5, 1.5, xtol=1e-15)
    across = uniaxial if lateral == "free" else axial
    space = Space(tensor_grid(np.array([0, 0.7, 2.0]), np.array([0, 0.4, 1.0])), ElementQuadP(3))
    body = material_body(space, nu, delta, ElementQuad2() if mixed else None)
    u = np.zeros(space.unknowns)
    u[space.components] = interpolated(space, (across - 1) / delta, (axial - 1) / delta)
    pressures = (
        spsolve(body.products, lam * body.forces(np.append(u, np.zeros(body.products.shape[0])))[u.size :])
        if mixed
        else []
    )
    forces = body.forces(np.append(u, pressures))
    J, area = across**2 * axial, np.pi * 2.0**2
    top, side = space.boundary_functions("contact"), space.boundary_functions("far")
    pull = space.constant[top] @ forces[space.components[1, top]]
    assert pull == pytest.approx(principal(axial, J) / delta * area, rel=1e-12)
    work = u[: space.unknowns] @ forces[: space.unknowns]  # of both principal stresses, over the volume
    stress_work = 2 * principal(across, J) * (across - 1) + principal(axial, J) * (axial - 1)
    assert work == pytest.approx(stress_work / delta**2 * area, rel=1e-12)
    inside = np.setdiff1d(np.arange(space.scalar_dofs.N), np.concatenate([top, side]))
    np.testing.assert_allclose(forces[space.components[1, inside]], 0, atol=1e-12)
    assert body.least_volume_ratio(u) == pytest.approx(J, rel=1e-12)


def interpolated(space, across, axial):
    """Coefficients of the displacement (across r, axial z)."""
    full = Basis(space.mesh, space.element)
    return np.array([full.project(lambda x: across * x[0]), full.project(lambda x: axial * x[1])])


# The contact problem


@pytest.fixture(
    scope="module",
    params=[
        (False, VERTICAL),
        (False, NORMAL),
        (False, REFERENCE),
        (False, BLEND),
        (True, BLEND),
        (True, Convention(0.9, 0.6)),
    ],
)
def contact(request):
    mixed, convention = request.param
    problem = problem_of(block(), 0.2, convention=convention, pressure=ElementQuad2() if mixed else None)
    return problem, entered(problem)


def test_tangent_is_the_derivative_of_the_residual(contact):
    problem, x = contact
    dx = directions(problem, x)
    expected = central_difference(problem.residual, x, dx)
    np.testing.assert_allclose(problem.along(x, dx), expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("observable", range(4))
def test_gradients_are_the_derivatives_of_the_observables(contact, observable):
    problem, x = contact
    dx, weights = directions(problem, x), np.eye(4)[observable]
    expected = central_difference(lambda y: problem.weighted_observables(y, weights), x, dx)
    assert problem.gradient(x, weights) @ dx == pytest.approx(expected, rel=1e-6)


def test_contact_radius_is_that_of_the_deformed_surface():
    problem = problem_of(block(), 0.2)
    x = entered(problem)
    radius = problem.observables(x)[3]
    r_d = problem.surface.deformed_radii(problem.surface_unknowns(x), 0.2)
    inside = problem.gaps(x) < problem.interface.law.edge_gap
    assert r_d[inside].max() < radius < r_d[~inside].min()


def test_moduli_stay_with_their_cells_in_batches(monkeypatch):
    cells_of = Cells.of(block())
    moduli = RNG.normal(size=(5, 5, *cells_of.radii.shape))
    whole = cells_of.stiffness(moduli + moduli.transpose(1, 0, 2, 3))
    monkeypatch.setattr(cells, "BATCH", 1)
    assert len(list(cells_of.batches())) == len(whole) > 1
    np.testing.assert_array_equal(cells_of.stiffness(moduli + moduli.transpose(1, 0, 2, 3)), whole)


def test_tractions_with_an_energy_have_symmetric_tangents(contact):
    problem, x = contact
    J = derivative(problem, x)
    asymmetry = abs(J - J.T).max() / abs(J).max()
    assert asymmetry < 1e-14 if problem.convention.conservative else asymmetry > 1e-5
    assert np.isnan(problem.energy(x)) == (not problem.convention.conservative)


@pytest.mark.parametrize(
    ("convention", "pressure"), [(VERTICAL, None), (NORMAL, ElementQuad1()), (REFERENCE, None), (BLEND, ElementQuad1())]
)
def test_negative_directions_change_at_the_fold(convention, pressure):
    problem = problem_of(block(2, 0.7), 0.2, convention=convention, pressure=pressure, tabor=1.0)
    counts, rates = [], []
    for gaps in ((2.0,), (2.0, 1.0, 0.5, 0.2)):
        x = entered(problem, gaps)
        eigenvalues = np.linalg.eigvals(derivative(problem, x))
        pressures = problem.body.unknowns - problem.body.space.unknowns
        counts.append(int(np.sum(eigenvalues.real < 0)) - pressures)
        assert problem.negative_directions(x) == counts[-1]
        tangent = problem.bordered_solver(x, problem.gradient(x, np.eye(4)[CENTRAL_GAP]))(np.eye(x.size)[-1])
        rates.append(tangent[-1])
    assert counts == [0, 1]
    assert rates[0] * rates[1] < 0


def test_the_mixed_form_tends_to_taylor_and_hoods():
    space, nu = block(), 0.4
    linear = ContactProblem(taylor_hood(space, nu, ElementQuad2(), far_field=clamped), 1.0)
    problem = problem_of(space, 0.0, nu, pressure=ElementQuad2())
    np.testing.assert_allclose(problem.observables(entered(problem)), linear.observables(entered(linear)), atol=1e-9)


@pytest.mark.parametrize("stretch", [0.0, 0.2])
def test_a_state_made_of_a_surface_bears_its_pressure(stretch):
    """That of an equilibrium is nearly the equilibrium itself, and is so at zero stretch, where bodies are linear."""
    space = block()
    problem = problem_of(space, stretch, convention=BLEND)
    x = entered(problem)
    state = problem.state_from_surface(problem.surface_state(x))
    np.testing.assert_allclose(state, x, rtol=0, atol=2e-4 if stretch else 1e-8)
    linear = problem.stretched(0.0).state_from_surface(problem.surface_state(x))
    assert np.abs(linear - x).max() > 0.01 or not stretch
    condensed = condense(space, 0.3, far_field=clamped)
    of_linear = ContactProblem(condensed.operator, 1.0)
    start = transfer(of_linear, entered(of_linear), problem.stretched(0.0))
    expected = condensed.displacement(of_linear.pressure(entered(of_linear)))
    np.testing.assert_allclose(
        problem.held.unknowns(start[:-1])[: expected.size], expected, rtol=0, atol=1e-8 * np.abs(expected).max()
    )


def events_of(problem, unknowns):
    return find_events(trace_charts((Chart(problem, unknowns),)))


@pytest.fixture(scope="module")
def sphere():
    """Linear events of a hemisphere, condensed; and the problem at finite strain."""
    R, tabor, nu = 10.0, 1.0, 0.3
    lines, depths = (grid.graded(0.0, 0.6, size * R, until=2.4) for size in (spheres.CORE, spheres.DEPTH))
    space = Space(spheres.hemisphere(R, lines, depths), ElementQuadP(3))
    condensed = condense(space, nu, far_field=sliding)
    events = events_of(ContactProblem(condensed.operator, tabor, profile=SphereSurface(R)), condensed.unknowns)
    body, exterior = material_body(space, nu, 1 / R), sliding(space, nu)
    return finite_strain_problem(body, exterior, tabor, profile=SphereSurface(R), convention=BLEND), events


def test_events_tend_to_the_linear_ones_with_the_stretch(sphere):
    problem, events = sphere

    def shifts(stretch):
        return np.array([shift(events[name], problem.stretched(stretch)) for name in ("pull_off", "jump_on")])

    def shift(event, at):
        return moved(event, at).point.observables[:3] - event.point.observables[:3]

    np.testing.assert_allclose(shifts(0.0), 0, atol=1e-9)
    np.testing.assert_allclose(shifts(1e-8), 0, atol=1e-7)
    fine, coarse = shifts(1e-3), shifts(2e-3)
    np.testing.assert_allclose(coarse / fine, 2, rtol=0.05)
    assert np.abs(fine).max() > 1e-5


# Energy


@pytest.mark.parametrize(("pressure", "convention"), [(None, NORMAL), (ElementQuad2(), NORMAL), (None, BLEND)])
def test_total_energy_grows_by_the_load_times_the_approach(pressure, convention):
    """Along the equilibria, by eight Gauss points."""
    problem = problem_of(block(), 0.3, convention=convention, pressure=pressure)
    x = entered(problem, (2.0, 1.0, 0.5, 0.2, 0.0, -0.02, -0.035))
    work, first, last = along_approach(problem, x, problem.load)
    assert abs(work) > 0.05
    assert problem.energy(last) - problem.energy(first) == pytest.approx(work, rel=1e-6)


def along_approach(problem, x, rate):
    """Integral of a rate from an approach of 1 to 1.2, and the states at both ends."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    states = []
    for approach in 1.0 + 0.1 * np.concatenate([[0], 1 + nodes, [2]]):
        x = newton.solve(problem, x, newton.approach(approach)).x
        states.append(x)
    return 0.1 * sum(w * rate(state) for w, state in zip(weights, states[1:-1], strict=True)), states[0], states[-1]


def test_elastic_energy_grows_by_a_vertical_tractions_work():
    """It has no energy of its own."""
    problem = problem_of(block(), 0.3)

    def power(x):
        unit = np.eye(1, x.size, x.size - 1)[0]
        moved = problem.surface.vertical @ problem.surface_unknowns(problem.bordered_solver(x, unit)(unit))
        return -problem.tabor * (problem.areas(x) * problem.pressure(x)) @ moved

    work, first, last = along_approach(problem, entered(problem, (2.0, 1.0, 0.5, 0.2, 0.0, -0.02, -0.035)), power)
    assert abs(work) > 0.05
    elastic = [problem.tabor * problem.held.energy(state[:-1]) for state in (first, last)]
    assert elastic[1] - elastic[0] == pytest.approx(work, rel=1e-8)


# What the traction is counted per


def test_tractions_are_by_name_the_blend_by_poissons_ratio():
    named = {name: convention_of(name, 0.3) for name in ("vertical", "normal", "reference")}
    assert named == {"vertical": VERTICAL, "normal": NORMAL, "reference": REFERENCE}
    for nu, part in ((0.0, 0.0), (0.25, 1 / 3), (0.3, 3 / 7), (0.4999, 0.4999 / 0.5001)):
        blend = convention_of("projected", nu)
        assert (blend.deformed_area, blend.surface_stress) == (pytest.approx(part), pytest.approx(part))
        assert blend.conservative


def test_the_blend_is_the_mean_of_both_energies_by_their_parts():
    blended = problem_of(block(2, 0.7), 0.2, convention=BLEND)
    x = entered(blended)
    energies = [replace(blended, convention=c).energy(x) for c in (REFERENCE, NORMAL)]
    assert abs(energies[1] - energies[0]) > 1e-3
    assert blended.energy(x) == pytest.approx(4 / 7 * energies[0] + 3 / 7 * energies[1], rel=1e-12)


def test_a_convention_fades_at_an_equator_in_one_spacing():
    """With the height d above the equator's plane, in eps, to 1 - exp(-d^2): as d^2 next to it."""
    depths = np.array([0.0, 1e-3, 0.5, 1.0, 3.0, np.inf])
    assert columns(depths) == pytest.approx([0.0, 1e-6, 0.22119922, 0.63212056, 0.99987659, 1.0], rel=1e-6)


def deepening(law, M):
    """M times what the yield of a column adds to its work of adhesion, in eps and dgamma/eps, by minimisation.

    The wall's potential acts on every cell of a column 200 eps deep, of modulus M, that hangs on it alone.
    """
    t = np.geomspace(1, 201, 601) - 1
    cell, w = np.diff(t), np.zeros(t.size)
    lower, upper = np.eye(600, 601), np.eye(600, 601, 1)
    stretch, mean = (upper - lower) / cell[:, None], (upper + lower) / 2

    def energy(w):
        return np.sum(cell * (M / 2 * (stretch @ w) ** 2 + law.pressure(mean @ (t - w), 1.0)))

    for _ in range(10):
        H = mean @ (t - w)
        slope, curvature = -law.slope(H, 1.0), (law.slope(H + 1e-5, 1.0) - law.slope(H - 1e-5, 1.0)) / 2e-5
        force = stretch.T @ (cell * M * (stretch @ w)) + mean.T @ (cell * slope)
        stiffness = stretch.T @ ((cell * M)[:, None] * stretch) + mean.T @ ((cell * curvature)[:, None] * mean)
        w = w - np.linalg.solve(stiffness, force)
    return M * (energy(np.zeros(t.size)) - energy(w))


@pytest.mark.parametrize("law", [LENNARD_JONES, PowerLaw(4, 10), Exponential(3), Morse(3), Dlvo(0.3, 1)], ids=repr)
def test_yield_of_the_layer_deepens_the_well_of_its_columns(law):
    nu, tabor, ratio = 0.3, 1.0, 100.0
    first_order = 2 * deepening(law, 1600.0) - deepening(law, 800.0)
    expected = 1 + first_order * tabor * 0.1 * (1 - 2 * nu) / (1 - nu) ** 2
    assert yielded_adhesion(tabor, ratio, nu, law) - 1 == pytest.approx(expected - 1, rel=2e-3)
    assert yielded_adhesion(tabor, ratio, 0.499999, law) == pytest.approx(1, abs=1e-6)


# Near-incompressible


def pull_of(space, poisson, stretch, pressure=None, gaps=(2.0, 1.0, 0.5, 0.2, 0.0)):
    """Load at the last of some central gaps; at zero it is near the pull-off force."""
    problem = problem_of(space, stretch, poisson, pressure=pressure)
    return problem.load(entered(problem, gaps))


@pytest.mark.parametrize("triangles", [False, True])
def test_mixed_form_agrees_with_displacements_at_small_poisson(triangles):
    space = Space(quarter_disc(20.0, graded_size(0.15, 1.8, 0.4)), ElementTriP2()) if triangles else block(fine=0.3)
    pressure = ElementTriP1() if triangles else ElementQuad2()
    assert pull_of(space, 0.3, 0.2, pressure) == pytest.approx(pull_of(space, 0.3, 0.2), rel=5e-4)


def test_mixed_form_does_not_lock():
    nu, stretch, gaps = 0.49999, 0.2, (2.0, 1.0)
    reference = pull_of(block(4, 0.5), nu, stretch, ElementQuadP(3), gaps)
    space = block(2)
    locked = abs(pull_of(space, nu, stretch, None, gaps) / reference - 1)
    mixed = abs(pull_of(space, nu, stretch, ElementQuad1(), gaps) / reference - 1)
    assert mixed < 2e-3
    assert locked > 5 * mixed
