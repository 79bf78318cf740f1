"""Numbers and columns that could be exchanged unseen, each by the formula that defines it."""

from types import SimpleNamespace

import pytest

import halfspace
from fem_adhesion import Hemisphere, LinearElastic, Scene, share_of
from fem_adhesion.assess.predictions import Quantity
from fem_adhesion.assess.verdict import cautions
from fem_adhesion.common.contact import Contact


def test_the_counter_bodys_share_grows_as_it_softens():
    assert share_of(1.0, 0.0, 3.0, 0.0) == pytest.approx(0.25)
    assert share_of(2.0, 0.5 - 1e-6, 1.0, 0.0) == pytest.approx(1 / (1 + 0.375), rel=1e-5)


def test_the_indentation_of_a_thin_sample_is_a_squared_over_r():
    contact = Contact(1e-6, 1e6, 0.3, 0.05, 0.3e-9, thickness=1e-6)
    half_space = SimpleNamespace(values={"zero_load_radius": Quantity(0.6e-6, 0.0, "m")})
    (told,) = [text for text in cautions(contact, half_space) if text.startswith("indentation over thickness")]
    assert told.startswith("indentation over thickness is 0.36,")


def test_a_dead_load_is_stable_where_the_load_grows():
    path = halfspace.trace(0.5, rtol=1e-2)
    stable = path.stable_under_dead_load
    assert stable[-1]
    falling = path.load[1:] < path.load[:-1]
    assert not (stable[1:] & stable[:-1])[falling].any()


def test_harmonics_check_no_traction_on_a_spheres_surface():
    usual, other = (
        Hemisphere(radius_ratio=30.0, material=LinearElastic(0.3, area)) for area in ("projected", "surface")
    )
    assert (Scene(1.0, usual).checked_by, Scene(1.0, other).checked_by) == ("harmonics", None)


def test_the_error_of_the_load_along_a_curve_is_its_own():
    """Far apart it is a hundred times that of the central gap, which goes with the approach."""
    path = halfspace.trace(0.5, rtol=1e-3)
    state = path.at(approach=float(path.approach[0]))
    assert path.load_error[0] == pytest.approx(state.load_error, rel=0.5)
    assert path.load_error[0] > 30 * path.central_gap_error[0]
