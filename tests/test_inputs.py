"""Numbers of any type are floats from the door on; what is no number is refused in one line."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Counter, Scene
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError

KINDS = [np.float32, np.float16, np.longdouble, np.int64, np.uint8, int, Fraction]


@pytest.fixture(scope="module")
def path():
    return halfspace.trace(2.0, rtol=1e-8)


def events(path):
    """Every number of every event to its last bit; nan is the same as nan."""
    return repr(path.events)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_a_number_of_any_type_is_as_good_as_a_float(path, kind):
    assert events(halfspace.trace(kind(2), rtol=1e-8)) == events(path)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_a_scene_holds_floats(kind):
    scene = Scene(
        kind(2),
        poisson=kind(0),
        body="hemisphere",
        profile="sphere",
        radius_ratio=kind(200),
        cap_angle=kind(30),
        counter=Counter(0.5, poisson=kind(0), radius=kind(2)),
    )
    assert scene == Scene(
        2.0,
        poisson=0.0,
        body="hemisphere",
        profile="sphere",
        radius_ratio=200.0,
        counter=Counter(0.5, poisson=0.0, radius=2.0),
    )
    numbers = (scene.tabor, scene.poisson, scene.radius_ratio, scene.cap_angle, scene.counter.poisson)
    assert {type(number) for number in (*numbers, scene.counter.radius)} == {float}


def test_tolerances_and_loads_are_floats_too(path):
    other = halfspace.trace(2.0, rtol=np.float64(1e-8), to_load=np.float32(5))
    assert events(other) == events(path)
    assert cycle(path, np.float32(0.5)).energy_lost == cycle(path, 0.5).energy_lost
    one, same = fem_adhesion.trace(Scene(1.0), rtol=0.1), fem_adhesion.trace(Scene(1), rtol=Fraction(1, 10), to_load=5)
    assert events(one) == events(same)


@pytest.mark.parametrize(
    "wrong", ["2", None, 2j, True, np.array([2.0]), np.linspace(1, 2, 1000), Decimal(2), b"2", [2.0], object()]
)
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("tabor", halfspace.trace),
        ("rtol", lambda wrong: halfspace.trace(1.0, rtol=wrong)),
        ("to_load", lambda wrong: halfspace.trace(1.0, to_load=wrong)),
        ("tabor", Scene),
        ("poisson", lambda wrong: Scene(1.0, poisson=wrong)),
        ("rtol", lambda wrong: fem_adhesion.trace(Scene(1.0), rtol=wrong)),
        ("share", Counter),
        ("radius", lambda wrong: Counter(0.5, radius=wrong)),
    ],
)
def test_what_is_no_number_is_refused_in_one_line(name, call, wrong):
    with pytest.raises(InputError, match=rf"^{name} = .* of type \w+, limit: a real number; give a float$") as refusal:
        call(wrong)
    assert len(str(refusal.value)) < 200


def test_an_integer_beyond_all_floats_is_refused():
    with pytest.raises(InputError, match=r"tabor has 401 digits, limit: 1\.8e308; give a float"):
        halfspace.trace(10**400)
