"""What uncertain inputs leave of a contact's numbers, and the atlas that the numbers are read from."""

import math

import numpy as np
import pytest
from assessed import LINE, Said

import halfspace
from fem_adhesion.assess import study
from fem_adhesion.assess.predictions import QUANTITIES, Quantity, computed, on_atlas
from fem_adhesion.assess.spread import Spread, spreads
from fem_adhesion.assess.terminal import spread_told
from fem_adhesion.common.contact import Contact, Inputs
from fem_adhesion.common.numbers import Measured, measured
from halfspace import atlas
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Morse
from halfspace.scaling import Units, contact_modulus
from halfspace.values import Estimate

VALUES = {"radius": 1e-7, "modulus": 10e9, "poisson": 0.2, "work_of_adhesion": 0.06, "spacing": 0.15e-9}
BIRTH = atlas.birth_of_folds().value


def _inputs(deviations, law=LENNARD_JONES, **changed):
    quantities = {name: Measured(x, deviations.get(name, 0.0)) for name, x in (VALUES | changed).items()}
    return Inputs(quantities, {"law": law})


def _at_tabor(tabor, part, law=LENNARD_JONES):
    """Inputs at a Tabor parameter with fixed grips, whose modulus has a part of it as standard deviation."""
    modulus = VALUES["modulus"] * (_inputs({}).contact().units.tabor / tabor) ** 1.5
    return _inputs({"modulus": part * modulus}, law, modulus=modulus)


@pytest.mark.parametrize(
    ("text", "name", "value", "deviation"),
    [
        ("100+-20nm", "radius", 1e-7, 2e-8),
        ("0.1um ± 20 nm", "radius", 1e-7, 2e-8),
        ("65 +/- 5 zJ", "hamaker", 6.5e-20, 5e-21),
        ("1e3+-1e2N/m", "stiffness", 1e3, 1e2),
        ("0.30+-0.02", "poisson", 0.3, 0.02),
        ("72GPa", "modulus", 7.2e10, 0.0),
        ("0", "poisson", 0.0, 0.0),
    ],
)
def test_a_standard_deviation_stands_behind_its_value(text, name, value, deviation):
    assert measured(text, name) == pytest.approx((value, deviation), rel=1e-14, abs=0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("10+-20nm", "radius = 10.-20nm may be negative, limit: a standard deviation below the value"),
        ("100+-20", "radius = 20 has no unit"),
        ("100+-20GPa", "unit of the wrong kind"),
        ("100+-nm", "is not a number"),
        ("100nm+-5+-5nm", "unknown unit"),
    ],
)
def test_a_spread_that_cannot_be_is_refused(text, message):
    with pytest.raises(InputError, match=message):
        measured(text, "radius")


def test_other_commands_refuse_a_standard_deviation(refused):
    words = "a value without a standard deviation, which assess alone takes"
    refused(f"curve {LINE} --radius 100+-20nm --csv -", words=words)


def test_the_first_order_is_the_exact_derivative():
    """Of a force, a radius and an energy, by the series' derivatives and the powers of the units."""
    inputs = _inputs({"radius": 1e-9, "modulus": 2e8, "work_of_adhesion": 5e-4, "spacing": 1e-12})
    mu, units = inputs.contact().units.tabor, inputs.contact().units
    found = study._spreads(inputs).quantities
    powers = {"radius": 1 / 3, "modulus": -2 / 3, "work_of_adhesion": 2 / 3, "spacing": -1}
    of_tabor = {
        "pull_off_force": (atlas.pull_off, "load", "load", (1, 0, 1, 0)),
        "zero_load_radius": (atlas.zero_load, "contact_radius", "length", (2 / 3, -1 / 3, 1 / 3, 0)),
        "energy_lost": (atlas.energy_lost, "energy", "energy", (1, 0, 1, 1)),
    }
    for name, (event, number, unit, exponents) in of_tabor.items():
        value, slope = (getattr(event(mu, derivative=order), number) for order in (0, 1))
        parts = {
            x: inputs.deviations[x] / VALUES[x] * (exponent * value + powers[x] * mu * slope) * getattr(units, unit)
            for x, exponent in zip(powers, exponents, strict=True)
        }
        whole = math.sqrt(sum(part**2 for part in parts.values()))
        assert found[name].deviation == pytest.approx(whole, rel=1e-3)
        assert found[name].linear
        for x, part in parts.items():
            assert found[name].shares[x] == pytest.approx(part**2 / whole**2, abs=1e-3)


def test_draws_have_the_spread_of_the_first_order_and_shares_add_up():
    inputs = _inputs({"radius": 5e-9, "modulus": 5e8, "poisson": 0.03, "stiffness": 0.01}, stiffness=0.2)
    found = study._spreads(inputs)
    assert set(found.quantities) == set(QUANTITIES)
    assert found.drawn == study.USUAL.draws
    contact = inputs.contact()
    for name, spread in found.quantities.items():
        low, median, high = spread.quantiles
        assert (high - low) / 2 == pytest.approx(spread.deviation, rel=0.08), name
        assert median == pytest.approx(spread.value, abs=0.1 * spread.deviation)
        assert sum(spread.shares.values()) == pytest.approx(1.0)
        assert spread.value == study._half_space(contact).values[name].value
    assert next(iter(found.quantities["pull_off_force"].shares)) == "radius"


def test_near_the_birth_of_folds_quantiles_stand_for_the_first_order():
    """Energies go as the 3/2 power of the distance; half of the draws have no jump at the birth itself."""
    at, past, far = (study._spreads(_at_tabor(BIRTH * part, 0.03)).quantities for part in (1.0, 1.01, 2.0))
    assert at["energy_lost"].present == pytest.approx(0.5, abs=0.01)
    assert 0.5 < past["energy_lost"].present < 0.9
    assert not at["jump_on_separation"].linear
    assert not past["energy_lost"].linear
    assert at["pull_off_force"].linear
    assert past["pull_off_force"].linear
    assert all(spread.linear for spread in far.values())
    inputs, draws = _at_tabor(BIRTH * 1.01, 0.03), np.random.default_rng(1).normal(1, 0.03, 20_000)
    tabors = inputs.contact().units.tabor * draws ** (-2 / 3)
    energies = atlas.energy_lost(tabors[tabors > BIRTH]).energy * inputs.contact().units.energy
    quantiles = np.quantile(energies, (0.158655, 0.5, 0.841345))
    assert past["energy_lost"].quantiles == pytest.approx(quantiles, rel=0.1)
    assert "% of draws have it" in spread_told(past["energy_lost"])


def test_what_some_draws_lack_is_not_of_the_first_order():
    inputs = _at_tabor(2.0, 0.01)
    given = inputs.quantities["modulus"]

    def numbers(contact):
        there = contact.modulus < given.value + 2 * given.deviation
        return {"pull_off_force": Quantity(contact.modulus, 0.0, "N")} if there else {}

    (spread,) = spreads("made up", inputs, numbers, lambda contacts: [*map(numbers, contacts)]).quantities.values()
    assert spread.deviation == pytest.approx(given.deviation)
    assert spread.present == pytest.approx(0.977, abs=0.004)
    assert not spread.linear


def test_a_hamaker_constant_keeps_its_value_where_the_adhesion_varies():
    quantities = {name: Measured(x) for name, x in VALUES.items() if name != "spacing"} | {"hamaker": Measured(6.5e-20)}
    more = Inputs(quantities, {}).contact(work_of_adhesion=0.07)
    assert more.units.hamaker == pytest.approx(6.5e-20, rel=1e-12)
    assert more.work_of_adhesion == 0.07


def test_without_an_atlas_the_first_order_alone_is_told():
    """Of another law, whose curves are solved for each change of an input."""
    inputs = _at_tabor(2.0, 0.01, Morse(3.0))
    found = study._spreads(inputs)
    assert (found.drawn, found.quantities["pull_off_force"].quantiles) == (0, ())
    ends = (halfspace.trace(2.0 * part, law=Morse(3.0)).event("pull_off").load for part in (0.99, 1.01))
    slope = np.diff([*ends])[0] / 0.02 * inputs.contact().units.load  # by ln(tabor)
    assert found.quantities["pull_off_force"].deviation == pytest.approx(abs(slope) * 0.01 * 2 / 3, rel=0.01)


@pytest.mark.parametrize(
    ("value", "error", "deviation", "told"),
    [
        (37.1039e-9, 1e-15, 7.43e-9, "37.1 +- 7.4 nN"),
        (-1.85555e-7, 1e-15, 4.4e-9, "-185.6 +- 4.4 nN"),
        (9e-9, 1e-15, 3e-7, "9 +- 300 nN"),
        (3.63346789e-7, 2e-11, 7.5e-12, "363.35 +- 0.01 nN"),
        (9e-9, 1e-15, math.nan, "9 nN, spread not known"),
    ],
)
def test_digits_are_those_that_spread_and_error_leave(value, error, deviation, told):
    assert spread_told(Spread(value, error, "N", deviation, {}, (), math.nan, math.isfinite(deviation))) == told


@pytest.mark.parametrize(
    ("tabor", "stiffness"),
    [(0.3, 0.0045), (0.1, 0.1), (2.0, math.inf), (5.0, 0.1), (50.0, 0.01), (0.5, math.inf), (2.0, 1.1e-3)],
)
def test_the_atlas_agrees_with_solved_curves_within_errors(tabor, stiffness):
    units = Units(2.0, 3.0, 5.0, 7.0)
    truth = computed("half-space", halfspace.trace(tabor, rtol=1e-7), stiffness, units)
    found = on_atlas("half-space", tabor, stiffness, units)
    assert found.values.keys() == truth.values.keys()
    for name, quantity in found.values.items():
        assert quantity.agrees(truth.values[name]), name
        place = units.approach * (10 + tabor) if "jump" in name else abs(quantity.value)
        assert quantity.error <= 3e-6 * place


@pytest.mark.parametrize("stiffness", [0.5044672917077176, 0.55])
def test_no_rounding_is_taken_for_a_turn_of_the_base(stiffness):
    """Two samples at one place, but for rounding, were: the jump was off by a sample, by 1e-3 eps."""
    units, tabor = Units(1.0, 1.0, 1.0, 1.0), 0.05109749426451986
    on = cycle(halfspace.trace(tabor), stiffness).jump_on.take_off
    found = on_atlas("half-space", tabor, stiffness, units).values["jump_on_separation"]
    assert found.agrees(Estimate(1.0 - on.approach, on.approach_error))


def test_the_command_tells_value_spread_and_shares(tmp_path):
    line = "--radius 20±2um --modulus 1+-0.1GPa --poisson 0.4 --work-of-adhesion 0.05J/m^2 --spacing 0.3nm"
    said = Said(line, tmp_path)
    spread = said.record["spreads"]["quantities"]["pull_off_force"]
    contact = Contact(20e-6, 1e9, 0.4, 0.05, 0.3e-9)
    force = -atlas.pull_off(contact.units.tabor).load * contact.units.load
    assert contact.units.modulus == contact_modulus(1e9, 0.4)
    assert spread["value"] == pytest.approx(force, rel=1e-9)
    assert spread["deviation"] == pytest.approx(force / 10, rel=0.01)
    assert spread["shares"]["radius"] > 0.99
    text = " ".join(said.text.split())
    assert f"{force * 1e6:.2f} +- {force * 1e5:.2f} µN" in text
    assert "The half-space is read from halfspace.atlas" in text
