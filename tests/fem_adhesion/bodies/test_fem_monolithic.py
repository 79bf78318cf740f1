"""The problem of a whole linear body against the condensed one."""

import numpy as np
import pytest
from skfem import ElementQuadP

from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, point_load
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.problem import assemble
from fem_adhesion.mesh.block import block_grid
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import ContactProblem

NU = 0.3
SMALL = Space(block_grid(0.6, 2.0, 20.0), ElementQuadP(4))


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


@pytest.mark.parametrize(("far_field", "points"), [(clamped, 5), (point_load, 7)])
def test_every_far_field_and_quadrature_condenses_exactly(far_field, points):
    condensed = ContactProblem(condense(SMALL, NU, far_field=far_field, points=points).operator, 1.3)
    whole = assemble(SMALL, NU, 1.3, far_field=far_field, points=points)
    for control in (newton.approach(-0.5), newton.load(-4.8), newton.central_gap(-0.01)):
        a = solved(condensed, control)
        b = newton.solve(whole, transferred(a.x, whole), control)
        np.testing.assert_allclose(b.observables, a.observables, rtol=1e-11, atol=1e-11)
