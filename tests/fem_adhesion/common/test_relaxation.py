"""The iterations of 1997 against Newton's method on the same grid."""

import numpy as np
import pytest

from fem_adhesion.common.relaxation import USUAL, greenwood, simple
from halfspace.elastic import compliance, grid
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import ContactProblem
from halfspace.errors import NotConverged


def problem_at(tabor, nodes=60):
    extent = 6 / np.sqrt(min(tabor, 1))
    return ContactProblem(compliance.triangles(grid.uniform(extent, extent / nodes)), tabor)


@pytest.mark.parametrize(("tabor", "relaxation"), [(0.05, 0.2), (1.0, 0.01)])
@pytest.mark.parametrize("control", [newton.approach(-0.5), newton.central_gap(0.3)], ids=["approach", "central gap"])
def test_simple_relaxation_finds_newtons_state(tabor, relaxation, control):
    problem = problem_at(tabor)
    found = simple(problem, problem.undeformed(0.0), control, relaxation=relaxation, tolerance=1e-11)
    expected = newton.solve(problem, found.x, control)
    np.testing.assert_allclose(found.observables[:3], expected.observables[:3], atol=1e-8)
    np.testing.assert_allclose(found.x, expected.x, atol=1e-8)
    assert found.residual < 1e-11
    assert found.sweeps % USUAL.checked == 0


@pytest.mark.parametrize(("tabor", "gap"), [(0.5, 1.0), (2.0, 0.0)], ids=["apart", "in contact"])
def test_greenwoods_iteration_finds_newtons_state(tabor, gap):
    """The residual is one sweep's share of the error, so the tolerance is three decades below what is asked."""
    problem = problem_at(tabor, nodes=30)
    control = newton.central_gap(gap)
    found = greenwood(problem, problem.undeformed(0.0), control, tolerance=1e-12)
    expected = newton.solve(problem, found.x, control)
    np.testing.assert_allclose(found.observables, expected.observables, atol=1e-8)
    np.testing.assert_allclose(found.x, expected.x, atol=1e-8)


def test_simple_relaxation_fails_at_a_large_tabor_parameter():
    problem = problem_at(5.0)
    with pytest.raises(NotConverged, match=r"simple relaxation .* sweeps at relaxation 0\.005 .*take .*Newton"):
        simple(problem, problem.undeformed(0.0), newton.approach(-1.0), relaxation=0.005)


@pytest.mark.parametrize("iteration", [simple, greenwood])
def test_sweeps_that_run_out_say_so(iteration):
    problem = problem_at(0.5)
    with pytest.raises(NotConverged, match=r"did not converge in 20 sweeps .*relative residual .*limit 1e-10"):
        iteration(problem, problem.undeformed(0.0), newton.approach(-0.5), most_sweeps=20)


@pytest.mark.parametrize("iteration", [simple, greenwood])
def test_other_controls_and_breathing_grids_are_refused(iteration):
    problem = problem_at(0.5)
    with pytest.raises(ValueError, match=r"newton\.approach or newton\.central_gap only"):
        iteration(problem, problem.undeformed(0.0), newton.load(-1.0))
    breathing = ContactProblem(Homogeneous(problem_at(0.5).operator), 0.5)
    with pytest.raises(ValueError, match="need a fixed one"):
        iteration(breathing, breathing.undeformed(0.0), newton.approach(0.0))
