"""What is left of a convention over matter that has no depth."""

import numpy as np
import pytest

from fem_adhesion.finite_strain.traction import columns


def test_a_convention_fades_at_an_equator_in_one_spacing():
    """With the height d above the equator's plane, in eps, to 1 - exp(-d^2): as d^2 next to it."""
    depths = np.array([0.0, 1e-3, 0.5, 1.0, 3.0, np.inf])
    assert columns(depths) == pytest.approx([0.0, 1e-6, 0.22119922, 0.63212056, 0.99987659, 1.0], rel=1e-6)
