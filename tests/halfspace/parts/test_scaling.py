"""SI units and other people's parameters, there and back."""

import math

import numpy as np
import pytest

from halfspace import scaling
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import IN_SI, Units

SILICA = {"radius": 1e-6, "modulus": 40e9, "work_of_adhesion": 0.05, "spacing": 0.3e-9}


def si(value, rel=1e-12):
    """Equal but for rounding, however small: an absolute tolerance would swallow numbers in SI units."""
    return pytest.approx(value, rel=rel, abs=0)


def test_units_one_by_one():
    """Powers of the four inputs that no two units share, so that one in another's place is seen."""
    R, E, dgamma, eps = 2.0, 3.0, 5.0, 7.0
    units, beta = Units(R, E, dgamma, eps), (R**2 * dgamma / E) ** (1 / 3)
    assert units.tabor == si((R * dgamma**2 / (E**2 * eps**3)) ** (1 / 3))
    assert units.radius_ratio == si(R / eps)
    assert units.hamaker == si(16 * math.pi * dgamma * eps**2)
    assert {name: units.si(name) for name in IN_SI} == {
        "approach": (si(eps), "m"),
        "central_gap": (si(eps), "m"),
        "gap": (si(eps), "m"),
        "contact_radius": (si(beta), "m"),
        "radius": (si(beta), "m"),
        "displacement": (si(beta**2 / R), "m"),
        "load": (si(R * dgamma), "N"),
        "pressure": (si(E * beta / R), "Pa"),
        "energy": (si(R * dgamma * eps), "J"),
        "energy_density": (si(E * (beta / R) ** 2), "J/m^3"),
        "stiffness": (si(R * dgamma / eps), "N/m"),
    }


@pytest.mark.parametrize("material", [SILICA, SILICA | {"work_of_adhesion": 0.4, "spacing": 0.14e-9}])
def test_the_hamaker_constant_is_the_laws_far_away(material):
    """The law's tension at a wide gap against A/(6 pi h^3), in SI."""
    units, gap = Units(**material), 1e3
    tension = -float(LENNARD_JONES.pressure(np.array(gap - 1), units.tabor)) * units.pressure
    assert tension == pytest.approx(units.hamaker / (6 * math.pi * (gap * units.spacing) ** 3), rel=1e-9)
    assert scaling.spacing_of(units.hamaker, units.work_of_adhesion) == pytest.approx(units.spacing, rel=1e-14)


def test_contact_modulus():
    assert scaling.contact_modulus(70e9, 0.2) == pytest.approx(70e9 / 0.96)
    assert scaling.contact_modulus(70e9, 0.2, 70e9, 0.2) == pytest.approx(70e9 / 1.92)
    assert scaling.contact_modulus(70e9, 0.2, 50e9, 0.4) == si(1 / (0.96 / 70e9 + 0.84 / 50e9))
    soft_on_hard = scaling.contact_modulus(1e6, 0.5, 200e9, 0.3)
    assert soft_on_hard == pytest.approx(1e6 / 0.75, rel=1e-5)
    assert soft_on_hard == scaling.contact_modulus(200e9, 0.3, 1e6, 0.5)


def test_equivalent_radius():
    assert scaling.equivalent_radius(2.0) == 2.0
    assert scaling.equivalent_radius(2.0, 2.0) == 1.0
    assert scaling.equivalent_radius(1.0, -2.0) == 2.0


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (lambda: Units(**SILICA | {"radius": 0.0}), r"^radius = 0 m is outside 0 < radius < inf; give it in m$"),
        (lambda: Units(**SILICA | {"modulus": math.inf}), r"^modulus = inf Pa is outside 0 < modulus < inf"),
        (lambda: Units(**SILICA | {"spacing": math.nan}), r"^spacing = nan m is outside"),
        (lambda: scaling.spacing_of(-1e-20, 0.063), r"^hamaker = -1e-20 J is outside 0 < hamaker < inf; give it in J$"),
        (lambda: scaling.spacing_of(6.5e-20, 0.0), r"^work_of_adhesion = 0 J/m\^2 is outside"),
        (lambda: scaling.contact_modulus(-1.0, 0.3), r"young = -1 Pa is outside 0 < young < inf; give it in Pa"),
        (lambda: scaling.contact_modulus(1e9, 0.6), r"poisson = 0.6 is outside -1 < poisson <= 0.5; take"),
        (lambda: scaling.contact_modulus(math.inf, 0.3), r"young = inf for both bodies is outside .*; give"),
        (lambda: scaling.equivalent_radius(1.0, -0.5), r"radius = 1 m and -0.5 m .* outside 0 < 1/R; let"),
        (lambda: scaling.equivalent_radius(0.0), r"radius = 0 m"),
    ],
)
def test_bad_bodies_are_refused(bad, message):
    with pytest.raises(ValueError, match=message):
        bad()


@pytest.mark.parametrize(
    ("parameter", "at_one"),
    [(scaling.MYD_AMPLIFICATION, 3.898), (scaling.MYD, 2.9208), (scaling.MAUGIS, 1.1570), (scaling.ATTARD_PARKER, 0.5)],
)
def test_parameters_of_appendix_a_there_and_back(parameter, at_one):
    assert parameter.of(1.0) == pytest.approx(at_one, rel=1e-4)
    tabor = np.geomspace(1e-3, 1e2, 20)
    np.testing.assert_allclose(parameter.tabor(parameter.of(tabor)), tabor, rtol=1e-14)
