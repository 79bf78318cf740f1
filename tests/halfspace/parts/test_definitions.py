"""Parts against their definitions, written out: what a curve alone does not tell."""

import numpy as np
import pytest

from halfspace.profiles import Hyperboloid, RoundedPunch, Sphere


@pytest.mark.parametrize("larger", [1.0, 3.0, np.inf])
def test_the_gap_of_two_spheres_is_the_sum_of_their_heights(larger):
    tabor, ratio = 0.5, 40.0
    R, r = np.sqrt(ratio / tabor), np.linspace(0.0, 8.0, 9)
    surface = Sphere(ratio, larger).surface(tabor)
    expected = 0.0
    for radius in (R * (1 + 1 / larger), R * (1 + larger)):
        expected = expected + (R * (radius - np.sqrt(radius**2 - r**2)) if np.isfinite(radius) else 0.0)
    assert surface.height(r) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("tip", "length"), [(Hyperboloid(0.5), 0.5), (RoundedPunch(0.3), 0.3)])
def test_the_cell_on_the_axis_is_as_long_as_a_tip_is_round(tip, length):
    assert [tip.first_cell(tolerance) for tolerance in (1e-2, 1e-8)] == [length, length]
