"""Numbers of any type are floats from the door on; what is no number is refused in one line."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Block, HalfSpace, HeldSphere, Hemisphere, LinearElastic, Scene
from halfspace import limits
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError

KINDS = [np.float32, np.uint8, int, Fraction]


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
    def made(kind, half):
        body = Hemisphere(radius_ratio=kind(100), poisson=kind(0))
        counter = Hemisphere(radius_ratio=kind(200), material=LinearElastic(kind(0)))
        return Scene(kind(2), body, counter=counter, share=half)

    held, block = HeldSphere(radius_ratio=kind(200), cap_angle=kind(30)), Block(radius=kind(50))
    scene = made(kind, np.float32(0.5))
    assert scene == made(float, 0.5)
    numbers = (scene.tabor, scene.poisson, scene.body.radius_ratio, scene.share, scene.counter.material.poisson)
    assert {type(number) for number in (*numbers, held.radius_ratio, held.cap_angle, block.radius)} == {float}


def test_tolerances_and_loads_are_floats_too(path):
    other = halfspace.trace(2.0, rtol=np.float64(1e-8), to_load=np.float32(5))
    assert events(other) == events(path)
    assert cycle(path, np.float32(0.5)).energy_lost == cycle(path, 0.5).energy_lost
    one, same = fem_adhesion.trace(Scene(1.0), rtol=0.1), fem_adhesion.trace(Scene(1), rtol=Fraction(1, 10), to_load=5)
    assert events(one) == events(same)


@pytest.mark.parametrize("wrong", ["2", None, 2j, True, np.linspace(1, 2, 1000), Decimal(2)])
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("tabor", halfspace.trace),
        ("rtol", lambda wrong: halfspace.trace(1.0, rtol=wrong)),
        ("to_load", lambda wrong: halfspace.trace(1.0, to_load=wrong)),
        ("tabor", Scene),
        ("poisson", lambda wrong: LinearElastic(poisson=wrong)),
        ("rtol", lambda wrong: fem_adhesion.trace(Scene(1.0), rtol=wrong)),
        ("share", lambda wrong: Scene(1.0, Hemisphere(radius_ratio=9.0), counter=HalfSpace(), share=wrong)),
        ("radius_ratio", lambda wrong: Hemisphere(radius_ratio=wrong)),
    ],
)
def test_what_is_no_number_is_refused_in_one_line(name, call, wrong):
    with pytest.raises(InputError, match=rf"^{name} = .* of type \w+, limit: a real number; give a float$") as refusal:
        call(wrong)
    assert len(str(refusal.value)) < 200


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("law", lambda wrong: halfspace.trace(1.0, law=wrong)),
        ("law", lambda wrong: Scene(1.0, law=wrong)),
        ("law", lambda wrong: halfspace.sweep([1.0], law=wrong)),
        ("profile", lambda wrong: halfspace.trace(1.0, profile=wrong)),
        ("profile", lambda wrong: Scene(1.0, profile=wrong)),
        ("profile", lambda wrong: halfspace.sweep([1.0], profile=wrong)),
        ("scene", fem_adhesion.trace),
        ("scene", fem_adhesion.compare),
    ],
)
@pytest.mark.parametrize("wrong", ["morse", halfspace.laws.Morse, Scene])
def test_what_is_no_part_is_refused_in_one_line(name, call, wrong):
    with pytest.raises(InputError, match=rf"^{name} = .* of type \w+ is no {name}; take .*, say$") as refusal:
        call(wrong)
    assert len(str(refusal.value)) < 200


def test_an_integer_beyond_all_floats_is_refused():
    with pytest.raises(InputError, match=r"tabor has 401 digits, limit: 1\.8e308; give a float"):
        halfspace.trace(10**400)


ENDS = {  # least and most of what each limit lets in
    limits.require_tabor: (1e-12, 300),
    limits.require_poisson: (0, 0.499999),
    limits.require_rtol: (1e-9, 1e-1),
    limits.require_load: (math.ulp(0), 1000),
    limits.require_radius: (math.nextafter(5, 6), 1e9),
    limits.require_radius_ratio: (2, 1e12),
    limits.require_cap_angle: (1, 90),
    limits.require_thickness: (0.01, 1000),
    limits.require_stiffness: (0.01, 1000),
    limits.require_film: (0.001, 100),
}


@pytest.mark.parametrize(("limit", "ends"), ENDS.items(), ids=lambda one: getattr(one, "__name__", ""))
def test_the_ends_of_a_range_are_let_in_and_nothing_beyond(limit, ends):
    for end, beyond in zip(ends, (-math.inf, math.inf), strict=True):
        assert limit(end) == end
        with pytest.raises(InputError):
            limit(math.nextafter(end, beyond))
