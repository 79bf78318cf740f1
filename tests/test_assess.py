"""The assessment of a real contact: units, refusals, levers, closed theories, and the answer as a whole."""

import io
import json
import math

import numpy as np
import pytest
from rich.console import Console
from scipy.optimize import brentq

import halfspace
from fem_adhesion.output import assess_plot
from fem_adhesion.output.assess_report import engineering, record, report, with_error
from fem_adhesion.output.files import written_aside
from fem_adhesion.studies import assess_theories
from fem_adhesion.studies.assess import assess
from fem_adhesion.studies.assess_contact import Contact
from fem_adhesion.studies.assess_predictions import QUANTITIES, computed, large_tabor
from fem_adhesion.studies.quantities import KINDS, Quantity, parse
from halfspace import theories
from halfspace.devices import cycle
from halfspace.maugis import MaugisDugdale
from halfspace.scaling import Units
from halfspace.sphere_theories import JKRSphere

SILICA = {"radius": 100e-9, "modulus": 70e9, "poisson": 0.17, "work_of_adhesion": 0.1, "spacing": 0.3e-9}
BEAD = {"radius": 50e-6, "modulus": 2e6, "poisson": 0.49, "work_of_adhesion": 0.05, "spacing": 0.3e-9}


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("100nm", "radius", 1e-7),
        ("0.1 µm", "radius", 1e-7),
        ("1e-7 m", "counter_radius", 1e-7),
        ("3 Å", "spacing", 3e-10),
        ("70GPa", "modulus", 7e10),
        ("70 kN/mm^2", "counter_modulus", 7e10),
        ("0.1J/m^2", "work_of_adhesion", 0.1),
        ("50 mN/m", "work_of_adhesion", 0.05),
        ("50 dyn/cm", "work_of_adhesion", 0.05),
        ("0.2 N m^-1", "stiffness", 0.2),
        ("200 pN/nm", "stiffness", 0.2),
    ],
)
def test_quantities_are_read_into_si(text, name, value):
    assert parse(text, name) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize("name", KINDS)
def test_the_example_of_every_kind_is_read(name):
    assert parse(KINDS[name][1], name) > 0


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("100", "radius", "radius = 100 has no unit, limit: a multiple of m; write it as 100nm"),
        ("nm", "radius", "radius = 'nm' is not a number with a unit; write it as 100nm"),
        ("", "spacing", "spacing = '' is not a number with a unit; write it as 0.3nm"),
        ("-3nm", "spacing", "spacing = -3nm is outside 0 < spacing < inf; write it as 0.3nm"),
        ("0nm", "spacing", "spacing = 0nm is outside"),
        ("nan nm", "spacing", "spacing = nan nm is outside"),
        ("inf N/m", "stiffness", "stiffness = inf N/m is outside"),
        ("1e400nm", "radius", "radius = 1e400nm is outside"),
        ("3 kg", "spacing", "spacing = 3 kg has a unit of the wrong kind, limit: a multiple of m; as in 0.3nm"),
        ("3 degC", "spacing", "wrong kind"),
        ("70 GPa", "work_of_adhesion", "a multiple of J/m"),
        ("3 bananas", "spacing", "spacing = 3 bananas has the unknown unit 'bananas'; write it as 0.3nm"),
        ("3 nm)", "spacing", "unknown unit"),
        ("3 2**9**9**9 m", "spacing", "unknown unit"),
    ],
)
def test_what_is_no_quantity_is_refused_in_one_line(text, name, message):
    with pytest.raises(ValueError, match=r"^[^\n]*$") as refused:
        parse(text, name)
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": -1e-9}, "curvature 1/R1 . 1/R2 outside 0 < 1/R"),
        ({"radius": math.nan}, "outside 0 < 1/R"),
        ({"modulus": 0.0}, "young = 0 Pa is outside 0 < young < inf"),
        ({"poisson": 0.5}, "poisson = 0.5 is outside 0 <= poisson < 0.5; take 0.4999 for rubber"),
        ({"poisson": -0.1}, "poisson = -0.1 is outside"),
        ({"work_of_adhesion": -0.1}, "work_of_adhesion = -0.1 J/m.2 is outside"),
        ({"spacing": math.inf}, "spacing = inf m is outside"),
        ({"stiffness": 0.0}, "stiffness = 0 N/m is outside 0 < stiffness; leave it out for fixed grips"),
        ({"stiffness": math.nan}, "stiffness = nan N/m"),
        ({"counter_modulus": 1e9}, "counter_poisson = None, limit: with both or none of"),
        ({"counter_poisson": 0.3}, "counter_modulus = None"),
        ({"counter_modulus": 1e9, "counter_poisson": 0.7}, "poisson = 0.7 is outside"),
    ],
)
def test_a_contact_that_cannot_be_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        Contact(**(SILICA | change))


def test_two_bodies_enter_by_their_contact_modulus_and_equivalent_radius():
    pair = Contact(**SILICA, counter_modulus=70e9, counter_poisson=0.17, counter_radius=100e-9, stiffness=0.2)
    assert pair.units.modulus == pytest.approx(70e9 / (2 * (1 - 0.17**2)))
    assert pair.units.radius == pytest.approx(50e-9)
    assert pair.reduced_stiffness == pytest.approx(0.2 * 0.3e-9 / (50e-9 * 0.1))


# Closed theories ------------------------------------------------------------------------------------------------------


def _loop(make, tabor, stiffness):
    return assess_theories.loop(make(tabor, stiffness), stiffness)


def _jkr_energy(a):
    """Integral of W d(alpha*) from a point contact, over mu."""
    return 8 / 15 * a**5 - (4 / 3 * np.sqrt(np.pi / 2) + 2 * np.sqrt(8 * np.pi)) / 3.5 * a**3.5 + np.pi * a**2


def test_jkr_under_fixed_grips():
    tabor = 7.0
    found = _loop(assess_theories.jkr, tabor, math.inf)
    off, landed = theories.jkr_jump_off(tabor), theories.jkr_zero_approach(tabor)
    assert found.jump_off[0].approach == pytest.approx(off.approach, rel=1e-8)
    assert found.jump_on[1].load == pytest.approx(landed.load, rel=1e-4)
    lost = tabor * (_jkr_energy(off.contact_radius) - _jkr_energy(landed.contact_radius))
    assert found.energy_lost == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("stiffness", [5.0, 0.3, 1e-3])
def test_a_rigid_sphere_on_a_cantilever(stiffness):
    def slope(h):
        return 16 * np.pi / 3 * (h**-3 - h**-9) - stiffness

    def energy(h):
        load = float(theories.bradley_load(1 - h))
        return -8 * np.pi / 3 * (1 / h - h**-7 / 28) + load**2 / (2 * stiffness)

    def base(h):
        return 1 - h + float(theories.bradley_load(1 - h)) / stiffness

    outer, inner = brentq(slope, 3 ** (1 / 6), 100), brentq(slope, 0.9, 3 ** (1 / 6))
    landed = brentq(lambda h: base(h) - base(outer), 0.5, inner)
    parted = brentq(lambda h: base(h) - base(inner), outer, 1e5)
    found = _loop(assess_theories.bradley, 1.0, stiffness)
    assert found.jump_on[0].approach == pytest.approx(1 - outer, abs=found.spacing)
    assert found.jump_off[0].approach == pytest.approx(1 - inner, abs=found.spacing)
    assert found.jump_off[1].approach == pytest.approx(1 - parted, rel=1e-6)
    lost = energy(outer) - energy(landed) + energy(inner) - energy(parted)
    assert found.energy_lost == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("tabor", [0.1, 1.0, 10.0])
def test_maugis_dugdale_under_fixed_grips(tabor):
    theory, found = MaugisDugdale.matched(tabor), _loop(assess_theories.maugis_dugdale, tabor, math.inf)
    assert found.jump_on[0].approach == pytest.approx(theory.jump_on().approach, abs=found.spacing)
    assert found.jump_off[0].approach == pytest.approx(theory.jump_off().approach, abs=1e-6)
    curve = assess_theories.maugis_dugdale(tabor, 1.0)
    assert assess_theories.pull_off(curve).load == pytest.approx(theory.pull_off().load, rel=1e-8)


def test_a_stiff_apparatus_follows_a_rigid_sphere_smoothly():
    assert _loop(assess_theories.bradley, 0.1, 7.0) is None
    assert _loop(assess_theories.dmt_maugis, 0.1, math.inf) is None


@pytest.fixture(scope="module")
def soft_path():
    return halfspace.trace(300.0, rtol=1e-5)


@pytest.mark.parametrize("stiffness", [math.inf, 1.0, 0.006, 1e-4])
def test_jkr_with_reach_is_as_near_the_half_space_as_its_errors_say(soft_path, stiffness):
    units = Units(1.0, 1.0, 1.0, 1.0)
    truth = computed("half-space", soft_path, stiffness, units)
    theory = large_tabor(300.0, stiffness, units)
    assert set(theory.values) == set(truth.values) == set(QUANTITIES)
    for name, quantity in theory.values.items():
        assert abs(quantity.value - truth.values[name].value) < quantity.error + truth.values[name].error, name


# The answer -----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def silica():
    return assess(Contact(**SILICA, stiffness=0.2))


@pytest.fixture(scope="module")
def bead():
    return assess(Contact(**BEAD, stiffness=0.2))


def test_the_half_space_in_si(silica):
    units, path = silica.contact.units, halfspace.trace(silica.contact.units.tabor, rtol=1e-7)
    values = silica.half_space.values
    assert units.tabor == pytest.approx(0.19245, abs=1e-5)
    assert values["pull_off_force"].value == pytest.approx(-path.event("pull_off").load * 1e-8, rel=1e-6)
    assert values["pull_off_force"].unit == "N"
    beta = (1e-14 * 0.1 / (70e9 / (1 - 0.17**2))) ** (1 / 3)
    assert values["zero_load_radius"].value == pytest.approx(path.event("zero_load").contact_radius * beta, rel=1e-6)
    on = cycle(path, 0.2 * 0.3e-9 / 1e-8).jump_on.take_off
    assert values["jump_on_separation"].value == pytest.approx((1 - on.approach) * 0.3e-9, rel=1e-6)
    assert values["jump_on_base"].value == pytest.approx(on.approach * 0.3e-9 + on.load * 1e-8 / 0.2, rel=1e-6)


def test_every_quantity_has_its_error_and_unit(silica):
    assert [model.model for model in silica.models] == [
        "half-space",
        "sphere's profile",
        "finite sphere",
        "JKR",
        "Maugis-Dugdale",
        "DMT-M",
        "rigid",
    ]
    for model in silica.models:
        for name, quantity in model.values.items():
            assert 0 < quantity.error < 0.02 * abs(quantity.value) + 1e-11 * (quantity.unit == "m"), (model.model, name)
    assert silica.seconds < 8


def test_the_theories_stand_where_they_should(silica):
    force = {model.model: model.values["pull_off_force"].value for model in silica.models}
    assert force["JKR"] == pytest.approx(1.5 * np.pi * 1e-8)
    assert force["rigid"] == pytest.approx(2 * np.pi * 1e-8)
    assert force["JKR"] < force["Maugis-Dugdale"] < force["half-space"] < force["rigid"]
    assert any("within 10 %: Maugis-Dugdale, DMT-M, rigid" in line for line in silica.verdict)
    assert any("within 1 % in pull-off force" in line and "true profile" in line for line in silica.verdict)
    assert "transition" in silica.regime


def test_a_sphere_pulls_less_than_a_paraboloid_by_its_profile(silica):
    """The rigid law takes (9/7) eps/R off the pull-off force, and so it nearly is at this small Tabor parameter."""
    deviation = next(d for d in silica.deviations if d.quantity == "pull_off_force")
    rho = silica.contact.units.radius_ratio
    assert deviation.profile.value == pytest.approx(-9 / 7 / rho, rel=0.02)
    assert abs(deviation.body.value) < abs(deviation.profile.value)
    assert deviation.profile.value + deviation.body.value == pytest.approx(deviation.total.value)
    assert deviation.total.error < 1e-3


def test_a_rubber_bead_is_left_to_the_closed_theories(bead):
    units = bead.contact.units
    assert units.tabor > 300
    assert bead.half_space.model == "JKR with reach"
    assert bead.half_space.values["pull_off_force"].value == pytest.approx(1.5 * np.pi * 50e-6 * 0.05, rel=1e-4)
    assert bead.finite is None
    assert any("finite sphere not solved: tabor = 874.3 is outside tabor <= 10" in line for line in bead.cautions)
    deviation = next(d for d in bead.deviations if d.quantity == "pull_off_force")
    sphere = JKRSphere(units.tabor, units.radius_ratio).pull_off().load
    assert deviation.profile.value == pytest.approx(sphere / theories.JKR_PULL_OFF - 1, rel=1e-3)
    assert bead.half_space.values["jump_on_separation"].value > 10e-9


def test_cautions_name_value_and_limit():
    jelly = assess(Contact(1e-6, 1e4, 0.49, 0.05, 1e-9, counter_modulus=1e4, counter_poisson=0.49))
    text = "\n".join(jelly.cautions)
    assert "contact radius over R is" in text
    assert "limit 0.3: linear elasticity no longer holds" in text
    assert "strain beta/R is" in text
    assert "both bodies are elastic" in text


def test_progress_is_told():
    told = []
    assess(Contact(**BEAD), lambda *step: told.append(step))
    assert [step[1:] for step in told] == [(i, 4) for i in range(4)]


def test_the_record_is_plain_data_without_infinities(silica, bead):
    for assessment in (silica, bead):
        data = json.loads(json.dumps(record(assessment), allow_nan=False))
        assert data["models"][0]["values"]["pull_off_force"]["unit"] == "N"
        assert data["input"]["counter_modulus"] is None
        assert data["verdict"] == list(assessment.verdict)


def test_the_report_shows_all(silica):
    console = Console(width=150, file=io.StringIO())
    console.print(report(silica))
    text = console.file.getvalue()
    for word in (
        "pull-off force",
        "60.4440(1)",
        "nN",
        "finite body",
        "base, jump off",
        "trust the finite sphere",
        "0.2227",
    ):
        assert word in text


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (60.44403, 6e-8, "60.4440(1)"),
        (60.44403, 0.00123, "60.444(2)"),
        (-302.26, 4.2, "-302(5)"),
        (0.0, 0.002, "0.000(2)"),
        (5.0, 0.0, "5.00000(1)"),
        (1.5, 0.11, "1.5(2)"),
    ],
)
def test_numbers_with_errors(value, error, text):
    assert with_error(Quantity(value, error, "1")) == text


def test_engineering_prefixes():
    assert engineering(72.08e9, "Pa") == "72.08 GPa"
    assert engineering(0.2, "N/m") == "200 mN/m"
    assert engineering(3e-7, "m") == "300 nm"


def test_the_figure_is_drawn(silica, bead, tmp_path):
    for assessment, form, magic in ((silica, "png", b"\x89PNG"), (bead, "svg", b"<?xml")):
        path = tmp_path / f"curve.{form}"
        with written_aside(path) as file:
            assess_plot.write(assessment, file, assess_plot.require_suffix(path))
        assert path.read_bytes().startswith(magic)
    with pytest.raises(ValueError, match=r"limit: one of \.png, \.svg, \.pdf; rename it"):
        assess_plot.require_suffix(tmp_path / "curve.gif")


def test_the_arrows_of_the_figure_are_the_two_jumps(silica):
    figure = assess_plot.draw(silica)
    arrows = figure.axes[0].texts
    on = silica.half_space.values["jump_on_separation"].value * 1e9
    off = silica.half_space.values["jump_off_separation"].value * 1e9
    assert [arrow.arrow_patch is not None for arrow in arrows] == [True, True]
    assert [arrow.xyann[0] for arrow in arrows] == pytest.approx([on, off])
