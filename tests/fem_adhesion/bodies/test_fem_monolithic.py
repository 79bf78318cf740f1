"""The problem of a whole linear body against the condensed one."""

import numpy as np
import pytest
from skfem import ElementQuadP, ElementTriP2

from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, point_load
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.problem import assemble
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import Chart, metric_for, trace_charts
from halfspace.equilibrium.conditions import relocate
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, LOAD, ContactProblem
from halfspace.equilibrium.search import find_events

NU = 0.3
EVENTS = {1.0: ["pull_off", "jump_on", "jump_off"]}

SPACES = {
    "Q3": Space(block_grid(0.25, 3.0, 1e3), ElementQuadP(3)),
    "P2": Space(quarter_disc(50.0, graded_size(0.1, 3.0, 0.3)), ElementTriP2()),
}
SMALL = Space(block_grid(0.6, 2.0, 20.0), ElementQuadP(4))


@pytest.fixture(scope="module", params=SPACES)
def body(request):
    return condense(SPACES[request.param], NU)


def solved(problem, control, gaps=(3.0, 2.0, 1.0, 0.5, 0.2, 0.0)):
    """Solve under a control, entering the curve with prescribed central gaps."""
    x = newton.solve(problem, problem.undeformed(-6.0), newton.approach(-6.0)).x
    for gap in gaps:
        x = newton.solve(problem, x, newton.central_gap(gap)).x
    return newton.solve(problem, x, control)


def transferred(x, problem):
    """A start for the whole problem, disturbed lest it be the solution."""
    start = problem.state_from_surface(x)
    start[:-1] *= 1.01
    return start


@pytest.fixture(scope="module")
def curve(body):
    return trace_charts([Chart(ContactProblem(body.operator, 2.0), body.unknowns)])[0]


@pytest.mark.parametrize("tabor", EVENTS)
def test_the_events_of_the_condensed_problem(body, tabor):
    problem = assemble(body.space, NU, tabor)
    metric = metric_for(problem)
    located = find_events(trace_charts([Chart(ContactProblem(body.operator, tabor), body.unknowns)]))
    for name in EVENTS[tabor]:
        condensed = located[name]
        start = transferred(condensed.point.x, problem)
        found = relocate(condensed, problem, start, metric).point.observables
        expected = condensed.point.observables
        assert found[LOAD] == pytest.approx(expected[LOAD], abs=1e-9)
        assert found[CENTRAL_GAP] == pytest.approx(expected[CENTRAL_GAP], abs=1e-9)
        # The approach of an extremum of the load is as well determined as the rate dW/ds, which is what vanishes.
        assert found[APPROACH] == pytest.approx(expected[APPROACH], abs=1e-9)


@pytest.mark.parametrize(("far_field", "points"), [(clamped, 5), (point_load, 7)])
def test_every_far_field_and_quadrature_condenses_exactly(far_field, points):
    condensed = ContactProblem(condense(SMALL, NU, far_field=far_field, points=points).operator, 1.3)
    whole = assemble(SMALL, NU, 1.3, far_field=far_field, points=points)
    for control in (newton.approach(-0.5), newton.load(-4.8), newton.central_gap(-0.01)):
        a = solved(condensed, control)
        b = newton.solve(whole, transferred(a.x, whole), control)
        np.testing.assert_allclose(b.observables, a.observables, rtol=1e-11, atol=1e-11)
