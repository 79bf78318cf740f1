import gc
import weakref

import numpy as np
import pytest

from fem_adhesion.common.fold_birth import approached
from halfspace.accuracy.grids import Resolution, half_space_charts, resolution_for, rings
from halfspace.elastic import compliance, grid
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import ContactProblem
from halfspace.errors import GridTooCoarse, NotConverged
from halfspace.laws import LENNARD_JONES
from halfspace.scales import Scales

CENTRED = compliance.panels(grid.graded(0.0, 0.3, 400.0), 10)
EDGE = compliance.panels(grid.graded(1.0, 0.1, 400.0), 10)


@pytest.fixture(scope="module")
def problem():
    return ContactProblem(CENTRED, tabor=1.0)


@pytest.fixture(scope="module")
def touching(problem):
    """A state on the unstable branch, with a contact radius of 0.3 beta."""
    return approached(problem, 0.1)


@pytest.mark.parametrize("follows", [False, True])
def test_jacobian_and_gradients_against_finite_differences(problem, touching, follows):
    if follows:
        problem = ContactProblem(Homogeneous(EDGE), 1.0)
        gap = 0.3 + problem.operator.at(1.0).radii ** 2 / 2 - 0.3 * np.exp(-(problem.operator.at(1.0).radii ** 2))
        x = np.concatenate([gap, [-0.1, 1.0]])
    else:
        x = touching
    rng = np.random.default_rng(1)
    direction = rng.uniform(0.5, 1, x.size) * (1 + np.abs(x))
    step = 1e-6
    change = (problem.residual(x + step * direction) - problem.residual(x - step * direction)) / (2 * step)
    size = np.append(1 + np.abs(x[:-2]), 1)
    np.testing.assert_allclose((problem.jacobian(x) @ direction - change) / size, 0, atol=1e-7)
    along = problem.along(x, direction)
    np.testing.assert_allclose(along, problem.jacobian(x) @ direction, rtol=1e-12, atol=1e-12 * np.abs(along).max())
    for index in range(4):
        slope = (problem.observables(x + step * direction) - problem.observables(x - step * direction)) / (2 * step)
        assert problem.gradient(x, np.eye(4)[index]) @ direction == pytest.approx(slope[index], rel=1e-5)


def test_a_state_that_is_written_to_is_another_state(problem, touching):
    x = touching.copy()
    before, pressure = problem.residual(x), problem.pressure(x)
    pressure *= 2
    np.testing.assert_array_equal(problem.residual(x), before)
    x[:-2] += 0.1
    np.testing.assert_array_equal(problem.pressure(x), LENNARD_JONES.pressure(x[:-2], 1.0))
    np.testing.assert_array_equal(problem.residual(x), problem.residual(x.copy()))
    assert np.abs(problem.residual(x) - before).max() > 0.05


def test_every_control_finds_the_same_state(problem, touching):
    alpha, W, H0, a = problem.observables(touching)
    nearby = newton.solve(problem, touching, newton.central_gap(0.11)).x
    for control in (
        newton.approach(alpha),
        newton.load(W),
        newton.central_gap(H0),
        newton.contact_radius(a),
        newton.spring(3.0, alpha + W / 3.0),
    ):
        np.testing.assert_allclose(
            newton.solve(problem, nearby, control).observables, [alpha, W, H0, a], rtol=1e-9, atol=1e-9
        )


def test_a_contact_edge_is_prescribed_where_two_cells_meet():
    """There the polynomials of the gap leap by their error, and Newton's method would go to and fro between them."""
    operator = compliance.panels(grid.graded(1.0, 0.05, 100.0), 5)
    problem = ContactProblem(operator, 2.0)
    x = approached(problem, 0.05)
    for radius in (1.0, 1.4, 1.8, 2.2, 2.5):
        x = newton.solve(problem, x, newton.contact_radius(radius)).x
    ends = operator.cells[(operator.cells > 0.4) & (operator.cells < 2.5)]
    assert len(ends) > 5
    for end in ends[::-1]:
        solution = newton.solve(problem, x, newton.contact_radius(end))
        x = solution.x
        assert solution.observables[3] == pytest.approx(end, rel=1e-9, abs=0)


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 0.04, 0.3, 0.31, 2.0, 40.0])
def test_a_contact_edge_is_pinned_down_to_the_rounding(problem, radius):
    """As steep as a gap is where contact begins, to what rounding leaves of the gaps in its cell, which is no more."""
    slope = 1e3
    gaps = LENNARD_JONES.edge_gap + slope * (CENTRED.radii - radius)
    found = problem.contact_radius(np.concatenate([gaps, [0.0, 1.0]]))
    largest = np.max(np.abs(gaps[CENTRED.cell_nodes[CENTRED.cell_of(radius)]]))
    assert found == pytest.approx(radius, rel=1e-14, abs=np.finfo(float).eps * largest / slope)


@pytest.mark.parametrize("seed", range(8))
def test_a_contact_edge_is_found_between_any_gaps(problem, seed):
    """Where they go up and down from node to node Newton's method leaves the two between which the edge is."""
    u, edge = CENTRED.radii, LENNARD_JONES.edge_gap
    last = 3 + seed
    gaps = edge + np.random.default_rng(seed).normal(size=u.size) * np.where(u > u[last], 0.0, 1.0)
    gaps[last], gaps[last + 1 :] = edge - 1e-3, edge + 1.0
    found = problem.contact_radius(np.concatenate([gaps, [0.0, 1.0]]))
    assert u[last] < found < u[last + 1]
    assert CENTRED.continuous(found)[0] @ gaps == pytest.approx(edge, abs=1e-9)


def test_a_contact_wider_than_its_surface_ends_with_it(problem):
    x = problem.undeformed(1e6)
    assert problem.contact_radius(np.append(np.zeros(x.size - 2), x[-2:])) == CENTRED.extent


def test_negative_directions_are_negative_eigenvalues(problem, touching):
    J = problem.jacobian(touching)[:-1, :-2]
    eigenvalues = np.linalg.eigvals(J)
    assert problem.negative_directions(touching) == np.sum(eigenvalues.real < 0) == 1


def test_newton_never_returns_an_unconverged_state(problem, touching):
    with pytest.raises(NotConverged, match=r"try"):
        newton.solve(problem, touching, newton.approach(-1.0), max_iterations=2)
    with pytest.raises(NotConverged, match=r"try"):
        newton.solve(problem, touching, newton.load(-7.0))  # no state pulls harder than 2 pi


@pytest.mark.parametrize(("tabor", "gap"), [(0.3, 4.0), (3.0, 0.5)])
def test_the_load_does_not_miss_the_attraction_beyond_the_grid(tabor, gap):
    """The same state on grids of any extent."""
    states = []
    for extent in (6.0, 9.0, 60.0):
        lines, *_ = rings(Scales(tabor), Resolution(16, 0.4, 2.0, extent * tabor**0.25))
        problem = ContactProblem(compliance.to_infinity(compliance.panels(lines, 14), 14), tabor)
        x = newton.solve(problem, approached(problem, min(gap, 1.0)), newton.central_gap(gap)).x
        states.append(problem.observables(x)[:3])
    for observables in states[:2]:
        np.testing.assert_allclose(observables, states[2], rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("central_gap", [2.0, 50.0])
def test_the_energy_of_the_surfaces_goes_on_beyond_the_grid(central_gap):
    """Of rigid surfaces it is minus the work of Bradley's load from afar, -(8 pi/3) (1/h - h^-7/28)."""
    tabor = 1e-6
    problem = half_space_charts(Scales(tabor), resolution_for(Scales(tabor), 1e-4))[0].problem
    energy = problem.energy(problem.undeformed(1 - central_gap))
    h = central_gap
    assert energy == pytest.approx(-8 * np.pi / 3 * (1 / h - h**-7 / 28), rel=1e-6)


@pytest.mark.parametrize(("nodes", "widths"), [(2, 0.1), (3, 0.1), (5, 0.336), (10, 0.9)])
@pytest.mark.parametrize(("tabor", "width"), [(2.0, 0.25), (0.1, 0.7 / 0.1**0.5)])
def test_the_grid_must_be_fine_at_the_edge_to_the_limit(nodes, widths, tabor, width):
    """So many widths of the spike, mu^-2 or 0.7 mu^-1/2 of a nearly rigid contact, between the nodes of a panel."""
    limit = widths * width

    def require(spacing):
        panel = spacing * (nodes - 1)
        problem = ContactProblem(compliance.panels(np.arange(8) * panel, nodes), tabor)
        x = problem.undeformed(0.0)
        x[:-2] = 0.1 * (problem.radii(x) - 3.5 * panel) + LENNARD_JONES.edge_gap
        problem.require_resolution(x)

    require(0.999 * limit)
    with pytest.raises(GridTooCoarse, match=f"exceeds {limit:.3g} beta for tabor {tabor:g}; refine the grid there"):
        require(1.001 * limit)


@pytest.mark.parametrize(("edge", "cells"), [(1.0, (0, 1)), (0.7, (0,))])
def test_a_radius_is_known_as_the_gaps_last_coefficients(edge, cells):
    operator = compliance.panels(np.array([0.0, 1.0, 2.0]), 6)
    problem, last = ContactProblem(operator, 0.5), (2e-6, 5e-6)
    places = 2 * (operator.radii % 1.0) - 1
    wave = np.polynomial.legendre.legval(places, [-1, 0, 0, 0, 1, 0])  # none where cells meet
    deflection = 0.3 * (operator.radii - edge) + wave * np.where(operator.radii < 1.0, *last)
    height = problem.profile.height(operator.radii)
    gaps = LENNARD_JONES.edge_gap + deflection + 0.5 * (height - edge**2 / 2)
    ripple = problem.ripples(np.append(gaps, [0.0, 1.0]))[1]
    beside = np.prod([last[k] for k in cells]) ** (1 / len(cells))
    assert ripple == pytest.approx(beside / (0.3 + 0.5 * edge), rel=1e-3, abs=0)


def test_a_problem_that_is_left_frees_its_matrices_at_once():
    """Without the collector of cycles, which does not see how large they are."""
    chart, _ = half_space_charts(Scales(1.0), resolution_for(Scales(1.0), 1e-3))
    problem, freed = chart.problem, weakref.ref(chart.problem)
    problem.residual(problem.undeformed(-5.0))
    gc.disable()
    del problem, chart
    try:
        assert freed() is None
    finally:
        gc.enable()
