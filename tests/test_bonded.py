"""Bodies bonded at their mid-plane, whose corner with the free surface is singular: exponent, convergence, events."""

import numpy as np
import pytest
from scipy.optimize import brentq
from skfem import ElementQuadP

from fem_adhesion import bodies
from fem_adhesion.condensed import condense
from fem_adhesion.elasticity import Space
from fem_adhesion.far_field import clamped
from fem_adhesion.incompressible import stiffness_for
from halfspace import grid

R = 10.0


def pole_compliance(degree, poisson, rings, finest=0.3, growth=2.5):
    """Deflection of a hemisphere's pole under a pressure as wide as a contact, on cells as short as that asks."""
    x = grid.graded(0.8, finest, bodies.CORE * R, growth=growth)
    depths = grid.graded(0.0, np.diff(x).min(), bodies.DEPTH * R, growth=growth)
    mesh = bodies.hemisphere(R, x, depths, rings=0.2 ** np.arange(1.0, rings + 1))
    space = Space(mesh, ElementQuadP(degree))
    operator = condense(space, poisson, far_field=clamped, stiffness=stiffness_for(poisson)).operator
    return operator.axis_row @ (operator.compliance @ np.exp(-(operator.radii**2)))


def williams(poisson):
    """Exponent s of u ~ d^s where a clamped plane meets a free one at a right angle (Williams 1952), plane strain."""

    def residual(s):
        return (3 - 4 * poisson) * np.sin(s * np.pi / 2) ** 2 - 4 * (1 - poisson) ** 2 + s**2

    return brentq(residual, 0.5, 0.999)


@pytest.mark.parametrize("poisson", [0.2, 0.3, 0.45, 0.4999])
def test_rings_take_the_error_of_the_corner_down_as_its_exponent_says(poisson):
    """What a cell of size h leaves of the energy is as h^(2 s)."""
    values = np.array([pole_compliance(4, poisson, rings) for rings in (1, 2, 3, 6)])
    errors = values[:-1] - values[-1]
    assert errors[1:] / errors[:-1] == pytest.approx(0.2 ** (2 * williams(poisson)), rel=0.03)


@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_the_error_falls_with_the_degree_however_fine_the_contact(poisson):
    """Rings in a corner cell as thin as the contact's would leave 1e-6."""
    best = pole_compliance(10, poisson, 6, 0.1, 2.2)
    errors = [abs(pole_compliance(degree, poisson, 5, 0.1) / best - 1) for degree in (4, 6, 8)]
    assert errors[1] < errors[0] / 50
    assert errors[2] < 3e-9
