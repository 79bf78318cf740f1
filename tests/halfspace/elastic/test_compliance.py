import numpy as np
import pytest

from halfspace.elastic import compliance, grid
from halfspace.elastic.kernel import band_deflection


@pytest.fixture(scope="module")
def edge():
    return compliance.panels(grid.graded(1.0, 1e-6, 50.0), 10)


def test_uniform_disc(edge):
    pressure = (edge.radii < 1).astype(float)
    np.testing.assert_allclose(edge.compliance @ pressure, band_deflection(edge.radii, 1.0), atol=1e-13)


def test_hertz(edge):
    r = edge.radii
    deflection = edge.compliance @ np.sqrt(np.maximum(1 - r**2, 0))
    inside = r < 1
    np.testing.assert_allclose(deflection[inside], np.pi / 4 * (2 - r[inside] ** 2), atol=1e-11)
    assert edge.weights @ np.sqrt(np.maximum(1 - r**2, 0)) == pytest.approx(2 * np.pi / 3, abs=1e-11)


# --- the cells up to infinity ---


@pytest.mark.parametrize("reach", [1.0, 100.0])
def test_pressures_without_end_in_closed_form(reach):
    """P = (1 + r^2)^(-3/2), whose Hankel transform is e^-k, and its relative with k e^-k: w = 2 int p(k) J_0 dk."""
    body = compliance.to_infinity(compliance.panels(grid.graded(0.0, 0.5, 6.0), 14), 14, reach)
    h = np.sqrt(1 + body.radii**2)
    inside = body.radii < 6
    for pressure, deflection in ((h**-3, 2 / h), (3 / h**5 - 1 / h**3, 2 / h**3)):
        found = body.compliance @ pressure
        np.testing.assert_allclose(found[inside], deflection[inside], rtol=1e-9)
        np.testing.assert_allclose(
            found[~inside], deflection[~inside], rtol=1e-3, atol=2e-5
        )  # at points; as a mean much closer:
        assert (body.weights * h**-3) @ found == pytest.approx((body.weights * h**-3) @ deflection, rel=1e-7)
    assert body.weights @ h**-3 == pytest.approx(2 * np.pi, rel=1e-11)
    assert body.radii.max() > 50 * reach
    assert body.extent == 6.0


def test_what_is_beyond_is_made_anew_and_obeys_reciprocity():
    inner = compliance.panels(grid.graded(0.0, 0.5, 6.0), 8)
    once = compliance.to_infinity(inner, 8)
    again = compliance.to_infinity(once, 8, 50.0)
    assert again.radii.size - inner.radii.size == 5 * (once.radii.size - inner.radii.size)
    for name in ("radii", "weights", "compliance"):
        np.testing.assert_array_equal(getattr(once.finite, name), getattr(inner, name))
    inside, beyond = again.radii < 6, again.radii > 6
    between = again.weights[:, None] * again.compliance
    np.testing.assert_allclose(between[np.ix_(inside, beyond)], between[np.ix_(beyond, inside)].T, rtol=1e-12)


def test_values_beyond_the_extent_die_out():
    body = compliance.to_infinity(compliance.panels(grid.graded(0.0, 0.5, 6.0), 12), 12)
    radii = np.array([6.5, 10.0, 40.0, 1e4])
    np.testing.assert_allclose(body.values_beyond(radii, 1 / np.sqrt(1 + body.radii**2)), 1 / radii, rtol=0.02)


@pytest.mark.parametrize("build", [lambda g: compliance.panels(g, 5), compliance.triangles, compliance.bands])
def test_homogeneity(build):
    breakpoints = grid.graded(1.0, 0.1, 10.0)
    grown, scaled = build(3.7 * breakpoints), build(breakpoints).scaled(3.7)
    for name in ("radii", "weights", "compliance", "cells"):
        np.testing.assert_allclose(getattr(grown, name), getattr(scaled, name), rtol=1e-12)


@pytest.mark.parametrize(("finest", "last"), [(0.01, 0.001), (0.001, 0.5), (3.0, 0.01), (0.01, 50.0), (20.0, 30.0)])
def test_a_grid_fine_at_both_ends_grows_from_either(finest, last):
    steps = np.diff(ends := grid.geometric(10.0, finest, 3.0, last))
    assert (ends[0], ends[-1]) == (0.0, 10.0)
    assert 0 < steps[0] <= finest
    assert 0 < steps[-1] <= last
    assert np.all(steps <= 2 * np.minimum(ends[:-1] + finest, 10.0 - ends[1:] + last) * (1 + 1e-9))
    assert np.array_equal(ends, grid.geometric(10.0, finest, 3.0)) == (last > 10.0)


def test_interpolation_does_not_leap_where_cells_meet():
    operator = compliance.panels(np.array([0.0, 0.5, 1.5, 4.0]), 4)
    values = np.cos(2 * operator.radii)
    for end in (0.5, 1.5):
        below, at, above = (operator.continuous(r)[0] @ values for r in (end - 1e-9, end, end + 1e-9))
        assert max(abs(below - at), abs(above - at)) < 1e-7
        leap = operator.interpolation(end - 1e-9) - operator.interpolation(end)
        assert abs(leap @ values) > 1e-4
    for radius in (0.0, 0.46, 0.6, 1.49, 4.0):
        row, slope = operator.continuous(radius)
        assert row.sum() == pytest.approx(1.0, abs=1e-12)
        assert row @ operator.radii == pytest.approx(radius, abs=1e-12)
        difference = (operator.continuous(radius + 1e-6)[0] - operator.continuous(radius - 1e-6)[0]) @ values / 2e-6
        assert slope @ values == pytest.approx(difference, rel=1e-6, abs=1e-7)
    for node in (0, 3, 4, 7, 11):
        np.testing.assert_allclose(operator.continuous(operator.radii[node])[0], np.eye(12)[node], atol=1e-12)


@pytest.mark.parametrize("R", [10.0, np.inf])
def test_operators_made_together_are_those_made_alone(R):
    lines = np.array([0.0, 0.3, 0.8, 1.0, 1.1, 1.6, 5.0, 20.0]) * np.array([[0.9], [1.0], [1.0]])
    lines[:, -1] = 20.0
    lines[2, 3] = 1.05
    together = compliance.stacked_panels(lines, 8, R)
    assert len(together) == 3
    for ends, operator in zip(lines, together, strict=True):
        alone = compliance.panels(ends, 8, R)
        for name in ("radii", "weights", "cells", "cell_nodes"):
            np.testing.assert_array_equal(getattr(operator, name), getattr(alone, name))
        np.testing.assert_allclose(operator.compliance, alone.compliance, rtol=1e-12)
