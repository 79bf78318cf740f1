"""Two elastic bodies: what symmetry demands, and the reduction to one body of E* and R."""

import numpy as np
import pytest
from scenes import hemisphere, pair

import fem_adhesion
import halfspace
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import sized_body

RHO = 30.0
RTOL = 1e-4


def against(*counter, radius_ratio=RHO):
    """Pair by the share, Poisson's ratio and relative radius of its counter-body."""
    return pair(1.0, radius_ratio, *counter)


def events(scene):
    return fem_adhesion.trace(scene, rtol=RTOL).events


def operator(scene):
    return sized_body(scene, Discretisation(4)).centred().problem.operator


def test_two_like_spheres_are_one_against_a_wall():
    """The plane between them does not move, so each meets it as a wall at half the distance."""
    both, one = events(against(0.5, 0.3, 1.0)), events(hemisphere(1.0, 4 * RHO))
    for name in one:
        assert both[name].load == pytest.approx(one[name].load, abs=2e-7)
        assert both[name].approach == pytest.approx(one[name].approach, abs=2e-7)


def test_two_spheres_of_one_size_may_change_places():
    pressure_at = lambda op: np.exp(-(op.radii**2))  # noqa: E731
    soft, stiff = (operator(against(share, 0.3, 1.0)) for share in (0.7, 0.3))
    np.testing.assert_allclose(soft.compliance @ pressure_at(soft), stiff.compliance @ pressure_at(stiff), rtol=1e-10)


@pytest.mark.parametrize("counter", [(0.5, 0.3, np.inf), (0.4, 0.45, 3.0)], ids=["block", "larger sphere"])
def test_both_bodies_have_one_grid_and_symmetric_compliances(counter):
    found = operator(against(*counter))
    symmetric = found.weights[:, None] * found.compliance
    np.testing.assert_allclose(symmetric, symmetric.T, atol=1e-10 * np.abs(symmetric).max())
    R1 = np.sqrt(RHO) * (1 + 1 / counter[2])
    assert found.weights.sum() == pytest.approx(np.pi * R1**2, rel=1e-9)


def test_a_stiff_sphere_on_a_soft_block_is_a_rigid_one():
    """All but a hundredth of the compliance is the block's."""
    mixed = events(against(0.99))
    limit = halfspace.trace(1.0, profile=halfspace.profiles.Sphere(RHO)).events
    finite = events(hemisphere(1.0, RHO))
    for name in ("pull_off", "jump_on", "jump_off"):
        expected = limit[name].approach + 0.01 * (finite[name].approach - limit[name].approach)
        assert mixed[name].approach == pytest.approx(expected, abs=2e-4)
        assert abs(mixed[name].approach - finite[name].approach) > 0.05


def test_a_pair_is_as_far_from_one_modulus_as_measured():
    """Its jump on, in eps from that of the pair's half-space, at R/eps = 1e4; solved at rtol 1e-5."""
    found = events(against(0.2, 0.45, 3.0, radius_ratio=1e4))["jump_on"].approach
    assert found - halfspace.trace(1.0).event("jump_on").approach == pytest.approx(0.0028470, abs=1e-5)
