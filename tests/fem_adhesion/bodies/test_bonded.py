"""Bodies bonded at their mid-plane, whose corner with the free surface is singular: exponent, convergence, events."""

import math
from functools import partial

import numpy as np
import pytest
from scenes import pair
from scipy.optimize import brentq
from skfem import ElementQuadP
from truths import LEFT, on, standing

import fem_adhesion
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import sized_body
from fem_adhesion.elasticity.cells import stiffness_of
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped
from fem_adhesion.elasticity.space import Space
from fem_adhesion.materials import Elastic
from fem_adhesion.mesh import spheres
from halfspace.elastic import grid
from halfspace.equilibrium.events import approach_scale
from halfspace.equilibrium.search import energy_released

R = 10.0


def pole_compliance(poisson, rings):
    """Deflection of a hemisphere's pole under a pressure as wide as a contact, on cells as short as that asks."""
    x = grid.graded(0.8, 0.3, spheres.CORE * R, growth=2.5)
    depths = grid.graded(0.0, np.diff(x).min(), spheres.DEPTH * R, growth=2.5)
    mesh = spheres.hemisphere(R, x, depths, rings=0.2 ** np.arange(1.0, rings + 1))
    space = Space(mesh, ElementQuadP(4))
    stiffness = partial(stiffness_of, space, [Elastic(poisson)])
    operator = condense(space, poisson, far_field=clamped, stiffness=stiffness).operator
    return operator.interpolation(0.0) @ (operator.compliance @ np.exp(-(operator.radii**2)))


def williams(poisson):
    """Exponent s of u ~ d^s where a clamped plane meets a free one at a right angle (Williams 1952), plane strain."""

    def residual(s):
        return (3 - 4 * poisson) * np.sin(s * np.pi / 2) ** 2 - 4 * (1 - poisson) ** 2 + s**2

    return brentq(residual, 0.5, 0.999)


def test_rings_reduce_the_corners_error_by_its_exponent():
    """What a cell of size h leaves of the energy is as h^(2 s)."""
    poisson = 0.4999
    values = np.array([pole_compliance(poisson, rings) for rings in (1, 2, 3, 6)])
    errors = values[:-1] - values[-1]
    assert errors[1:] / errors[:-1] == pytest.approx(0.2 ** (2 * williams(poisson)), rel=0.03)


def test_estimates_of_a_bonded_pair_hold_a_tighter_solution():
    """On elements of a higher degree, shorter cells of another growth and more rings."""
    scene = pair(0.3, 10.0, 0.4, 0.45, 3.0, poisson=0.45, grip="bonded")
    path = fem_adhesion.trace(scene, rtol=1e-5)
    finer = Discretisation(path.settings["events"]["degree"] + 2, finest=0.45, growth=2.1, rings=6)
    truth = on(standing(sized_body(scene, finer), LEFT), path.stages[-1])
    scale = approach_scale(event.approach for event in path.events.values())
    for name, event in path.events.items():
        values = truth[name].point.observables
        for quantity, value in zip(("approach", "load", "central_gap", "contact_radius"), values, strict=True):
            if math.isfinite(value):
                error = abs(getattr(event, quantity) - value)
                assert error <= getattr(event, f"{quantity}_error"), (name, quantity)
        assert event.approach_error <= 1e-5 * scale, name
        assert name == "zero_load" or event.load_error <= 1e-5 * abs(event.load), name
    assert abs(path.energy.value - energy_released(truth["separated"], truth["zero_approach"])) <= path.energy.error
