"""The condensed block against closed forms, and the laws of mechanics."""

import numpy as np
import pytest
from facets import far_reaction
from references import deflection_error, smooth_pressure, strain_energy
from skfem import ElementQuadP, ElementTriP1, ElementTriP3

from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, free, point_load
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc

NU = 0.3


def error(space, far_field=point_load, poisson=NU):
    return deflection_error(condense(space, poisson, far_field=far_field).operator)


# --- closed forms ---


@pytest.mark.parametrize("poisson", [0.0, 0.45])
def test_smooth_pressure_to_seven_digits(poisson):
    assert error(Space(block_grid(0.3, 3.0, 50.0), ElementQuadP(6)), poisson=poisson) < 2e-7


@pytest.mark.parametrize(("element", "accuracy"), [(ElementTriP1(), 2e-2), (ElementTriP3(), 1e-5)])
def test_triangles_on_the_quarter_disc(element, accuracy):
    space = Space(quarter_disc(50.0, graded_size(0.125, 2.0, 0.2)), element)
    assert error(space) < accuracy


# --- far fields ---


@pytest.mark.parametrize(
    ("far_field", "lengths", "lowest", "highest"),
    [
        (clamped, (5.0, 10.0, 20.0), 0.9, 1.1),
        (point_load, (5.0, 10.0, 20.0), 4.0, 5.5),
        (free, (20.0, 40.0, 80.0), 1.0, 2.0),
    ],
)
def test_truncation_order_of_the_far_field(far_field, lengths, lowest, highest):
    """Order 5 with the point load: c carries the load, and the next moment of P meets itself reflected."""
    errors = [error(Space(block_grid(0.3, 1.5, L), ElementQuadP(6)), far_field) for L in lengths]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > lowest)
    assert np.all(orders < highest)


# --- condensation ---

BODIES = [
    pytest.param(mesh, element, far_field, id=f"{name}-{far_field.__name__}")
    for name, mesh, element in [
        ("P1", quarter_disc(10.0, graded_size(0.3, 1.0, 0.3)), ElementTriP1()),
        ("P3", quarter_disc(10.0, graded_size(0.5, 1.0, 0.5)), ElementTriP3()),
        ("Q4", block_grid(0.5, 1.5, 10.0), ElementQuadP(4)),
    ]
    for far_field in (clamped, point_load, free)
]


@pytest.mark.parametrize(("mesh", "element", "far_field"), BODIES)
def test_the_operator_obeys_mechanics_and_describes_its_surface(mesh, element, far_field):
    body = condense(Space(mesh, element), NU, far_field=far_field)
    operator = body.operator
    pressure = np.cos(operator.radii) * smooth_pressure(operator.radii)  # of both signs
    deflection = operator.compliance @ pressure
    load = operator.weights @ pressure
    symmetric = operator.compliance / operator.weights
    assert np.max(np.abs(symmetric - symmetric.T)) < 1e-12 * np.max(np.abs(symmetric))
    assert far_reaction(body, pressure) == pytest.approx(load, rel=1e-10)
    assert strain_energy(body, pressure) == pytest.approx(0.5 * (operator.weights * pressure) @ deflection, rel=1e-10)
    u_z = body.displacement(pressure)[body.space.components[1, body.surface.functions]]
    np.testing.assert_allclose(-(body.surface.values @ u_z), deflection, atol=1e-12)
    assert np.sum(operator.weights) == pytest.approx(np.pi * 10.0**2, rel=1e-12)
    assert (operator.cells[0], operator.extent) == (0.0, pytest.approx(10.0))


def test_a_block_twice_as_large_is_the_operator_scaled():
    small = condense(Space(block_grid(0.5, 1.5, 10.0), ElementQuadP(4)), NU).operator.scaled(2.0)
    large = condense(Space(block_grid(1.0, 3.0, 20.0), ElementQuadP(4)), NU).operator
    for name in ("radii", "weights", "compliance", "cells"):
        np.testing.assert_allclose(getattr(small, name), getattr(large, name), rtol=1e-10, atol=1e-14)


def test_too_few_surface_points_are_refused():
    with pytest.raises(ValueError, match="points = 4 must exceed the degree p = 4; use 5 or more"):
        condense(Space(block_grid(0.5, 1.5, 10.0), ElementQuadP(4)), NU, points=4)
