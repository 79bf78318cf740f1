"""The assessment of a real contact: units, refusals, levers, closed theories, and the answer as a whole."""

import json
import math
import re
from dataclasses import asdict, replace
from itertools import chain

import numpy as np
import pytest
from assessed import LINE, SILICA, Said, assert_alike, shown
from page_tables import value_and_error
from scipy.optimize import brentq
from whole_runs import tables_in

import halfspace
from fem_adhesion import convergence
from fem_adhesion.assess import figure as assess_figure
from fem_adhesion.assess import study
from fem_adhesion.assess import theories as assess_theories
from fem_adhesion.assess.predictions import WORDS, Prediction, Quantity, computed, large_tabor
from fem_adhesion.assess.study import assess
from fem_adhesion.assess.terminal import contact_radius, record, report
from fem_adhesion.assess.verdict import Distance, cautions, left_out, ranked, regime, verdict
from fem_adhesion.common.contact import Contact
from fem_adhesion.common.numbers import DIGITS, KINDS, PREFIXES, engineering, exponent_of, parse, with_error
from halfspace.equilibrium.devices import cycle
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from halfspace.laws import Morse
from halfspace.profiles import Power
from halfspace.scaling import Units
from halfspace.theories import closed_forms as theories
from halfspace.theories.exact_sphere import JKRSphere
from halfspace.theories.maugis import MaugisDugdale

BEAD = {"radius": 50e-6, "modulus": 2e6, "poisson": 0.49, "work_of_adhesion": 0.05, "spacing": 0.3e-9}


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("100nm", "radius", 1e-7),
        ("0.1 µm", "radius", 1e-7),
        ("3 Å", "spacing", 3e-10),
        ("70 kN/mm^2", "counter_modulus", 7e10),
        ("50 mN/m", "work_of_adhesion", 0.05),
        ("50 dyn/cm", "work_of_adhesion", 0.05),
        ("200 pN/nm", "stiffness", 0.2),
        ("6.5e-13 erg", "hamaker", 6.5e-20),
    ],
)
def test_quantities_are_read_into_si(text, name, value):
    assert parse(text, name) == pytest.approx(value, rel=1e-14)
    assert parse(KINDS[name][1], name) > 0  # the example that refusals show


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("100", "radius", "radius = 100 has no unit, limit: a multiple of m; write it as 100nm"),
        ("nm", "radius", "radius = 'nm' is not a number with a unit; write it as 100nm"),
        ("", "spacing", "spacing = '' is not a number with a unit; write it as 0.143nm"),
        ("-3nm", "spacing", "spacing = -3nm is outside 0 < spacing < inf; write it as 0.143nm"),
        ("1e400nm", "radius", "radius = 1e400nm is outside"),
        ("3 kg", "spacing", "spacing = 3 kg has a unit of the wrong kind, limit: a multiple of m; as in 0.143nm"),
        ("3 bananas", "spacing", "spacing = 3 bananas has the unknown unit 'bananas'; write it as 0.143nm"),
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
        ({"modulus": 0.0}, "young = 0 Pa is outside 0 < young < inf"),
        ({"poisson": 0.5}, "poisson = 0.5 is outside 0 <= poisson < 0.5; take 0.4999 for rubber"),
        ({"spacing": math.inf}, "spacing = inf m is outside"),
        ({"stiffness": 0.0}, "stiffness = 0 N/m is outside 0 < stiffness; leave it out for fixed grips"),
        ({"counter_modulus": 1e9}, "counter_poisson = None, limit: with both or none of"),
        ({"counter_modulus": 1e9, "counter_poisson": 0.5}, "poisson = 0.5 is outside"),
        ({"thickness": 0.2e-9}, "is outside 3e-10 m < thickness, the equilibrium spacing"),
        ({"thickness": 1e-6, "counter_radius": 1e-6}, "limit: a rigid sphere on a thin sample"),
    ],
)
def test_a_contact_that_cannot_be_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        Contact(**(SILICA | change))


# Closed theories ------------------------------------------------------------------------------------------------------


def _loop(theory, tabor, stiffness):
    """Curve of a theory and its cycle."""
    curve = study.THEORIES[theory](tabor, assess_theories.sampling(tabor, stiffness))
    return curve, assess_theories.loop(curve, stiffness)


def _jkr_energy(a):
    """Integral of W d(alpha*) from a point contact, over mu."""
    return 8 / 15 * a**5 - (4 / 3 * np.sqrt(np.pi / 2) + 2 * np.sqrt(8 * np.pi)) / 3.5 * a**3.5 + np.pi * a**2


def test_jkr_under_fixed_grips():
    tabor = 7.0
    _, found = _loop("JKR", tabor, math.inf)
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
    _, found = _loop("rigid", 1.0, stiffness)
    assert found.jump_on[0].approach == pytest.approx(1 - outer, abs=found.spacing)
    assert found.jump_off[0].approach == pytest.approx(1 - inner, abs=found.spacing)
    assert found.jump_off[1].approach == pytest.approx(1 - parted, rel=1e-6)
    lost = energy(outer) - energy(landed) + energy(inner) - energy(parted)
    assert found.energy_lost == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("tabor", [0.1, 1.0, 10.0])
def test_maugis_dugdale_under_fixed_grips(tabor):
    theory, (curve, found) = MaugisDugdale.matched(tabor), _loop("Maugis-Dugdale", tabor, math.inf)
    assert found.jump_on[0].approach == pytest.approx(theory.jump_on().approach, abs=found.spacing)
    assert found.jump_off[0].approach == pytest.approx(theory.jump_off().approach, abs=1e-6)
    assert assess_theories.pull_off(curve).load == pytest.approx(theory.pull_off().load, rel=1e-8)


def test_a_stiff_apparatus_follows_a_rigid_sphere_smoothly():
    assert _loop("rigid", 0.1, 7.0)[1] is None
    assert _loop("DMT-M", 0.1, math.inf)[1] is None


@pytest.fixture(scope="module")
def soft_path():
    return halfspace.trace(300.0, rtol=1e-5)


@pytest.mark.parametrize("stiffness", [math.inf, 1.0, 0.006, 1e-4])
def test_jkr_with_reach_is_within_its_errors(soft_path, stiffness):
    units = Units(2.0, 3.0, 5.0, 7.0)  # all of its units differ
    truth = computed("half-space", soft_path, stiffness, units)
    assert_alike(large_tabor(300.0, stiffness, units).values, truth.values)


# The scenes -----------------------------------------------------------------------------------------------------------

PAIR = {"counter_modulus": 3e9, "counter_poisson": 0.35, "counter_radius": 250e-9}


@pytest.mark.parametrize(
    ("more", "poisson", "counter"),
    [
        ({}, 0.17, None),
        (PAIR, 0.17, (3e9, 0.35, 2.5)),
        (PAIR | {"counter_radius": 50e-9}, 0.35, (70e9, 0.17, 2.0)),
        ({"counter_modulus": 3e9, "counter_poisson": 0.35}, 0.17, (3e9, 0.35, math.inf)),
        ({"counter_radius": 250e-9}, 0.17, (math.inf, 0.17, 2.5)),
        ({"counter_radius": 50e-9}, 0.17, (70e9, 0.17, 2.0)),
    ],
)
@pytest.mark.parametrize("grip", ["sliding", "bonded"])
def test_the_finite_bodies_are_those_asked_for(more, poisson, counter, grip, monkeypatch):
    """The smaller body is the hemisphere, the larger one its counter-body, a flat one a half-space."""
    asked = []
    monkeypatch.setattr(convergence, "trace", lambda scene, **_: asked.append(scene))
    monkeypatch.setattr(study, "computed", lambda name, *_: name)
    contact = Contact(**SILICA, **more, grip=grip)
    name = study._finite(contact)
    (scene,) = asked
    assert (scene.body.name, scene.profile, scene.body.grip) == ("hemisphere", None, grip)
    assert scene.tabor == contact.units.tabor
    assert scene.radius_ratio == pytest.approx(contact.units.radius_ratio, rel=1e-14)
    assert scene.poisson == poisson
    assert name == ("finite pair" if counter else "finite sphere")
    if counter is None:
        assert scene.counter is None
    else:
        modulus, nu, radius = counter
        share = contact.units.modulus * (1 - nu**2) / modulus
        assert scene.share == pytest.approx(share, rel=1e-12, abs=1e-8)  # 0 and 1 are no shares
        assert scene.counter.size / scene.body.size == pytest.approx(radius, rel=1e-12)
        assert scene.counter.material.poisson == nu or not share  # of a rigid one it does not matter


@pytest.mark.parametrize(("counter_radius", "ratio"), [(math.inf, math.inf), (250e-9, 2.5), (50e-9, 2.0)])
def test_the_true_profile_is_that_of_both_spheres(counter_radius, ratio, monkeypatch):
    asked = []
    monkeypatch.setattr(halfspace, "trace", lambda tabor, **options: asked.append((tabor, options)))
    monkeypatch.setattr(study, "computed", lambda name, *_: name)
    contact = Contact(**SILICA, counter_radius=counter_radius)
    assert study._profile(contact) == "true profile"
    ((tabor, options),) = asked
    assert tabor == contact.units.tabor
    assert options["profile"].radius_ratio == contact.units.radius_ratio
    assert options["profile"].counter_radius == pytest.approx(ratio, rel=1e-12)


@pytest.mark.parametrize("tabor", [1e3, 1e-14])
def test_two_soft_or_rigid_spheres_have_no_true_profile(tabor):
    """JKR's theory and Bradley's on the exact sphere know one sphere only."""
    size = Contact(**SILICA, counter_radius=1e-7)
    soft = replace(size, modulus=size.modulus * (size.units.tabor / tabor) ** 1.5)
    with pytest.raises(InputError, match="of two spheres is outside 1e-12 <= tabor <= 300; the paraboloid serves"):
        study._profile(soft)


# The answer -----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def said(tmp_path_factory):
    return Said(f"{LINE} --digits all", tmp_path_factory.mktemp("assess"))


@pytest.fixture(scope="module")
def silica(said):
    return said.assessment


@pytest.fixture(scope="module")
def bead():
    return assess(Contact(**BEAD, stiffness=0.2))


def _printed(text):
    """Numbers of the tables by row, column and kind, SI or %: value and bound, in SI where there is a unit."""
    found = {}
    for row in chain.from_iterable(tables_in(text)):
        (_, name), *cells = row.items()
        for header, cell in cells:
            if number := value_and_error(cell):
                head, _, unit = header.rpartition(" ")
                size = next((10.0**e for e, p in PREFIXES.items() if unit in (p + "m", p + "N", p + "J")), 1.0)
                found[name, head, "%" if unit == "%" else "SI"] = tuple(size * one for one in number)
    return found


def _check_table(text, assessment):
    """Every value under its row and column, within the error that stands with it, which is no less than its own."""
    printed = _printed(text)
    for model in assessment.models:
        for name, quantity in model.values.items():
            value, bound = printed.pop((model.model, WORDS[name], "SI"))
            assert abs(value - quantity.value) <= bound * (1 + 1e-9), (model.model, name)
            assert quantity.error <= bound * (1 + 1e-9)
    for deviation in assessment.deviations:
        parts = {"true profile": deviation.profile, "finite body": deviation.body, "both": deviation.total}
        for cause, quantity in parts.items():
            if quantity:
                value, bound = printed.pop((WORDS[deviation.quantity], cause, "%"))
                assert abs(value - 100 * quantity.value) <= bound * (1 + 1e-9), (deviation.quantity, cause)
    assert printed == {}


def _check_record(data, assessment):
    for model, found in zip(assessment.models, data["models"], strict=True):
        assert found["model"] == model.model
        assert found["values"] == {name: vars(quantity) for name, quantity in model.values.items()}
    assert data["deviations"] == [asdict(deviation) for deviation in assessment.deviations]
    units = assessment.contact.units
    assert data["hamaker"] == pytest.approx(16 * np.pi * units.work_of_adhesion * units.spacing**2)
    assert (data["equivalent_radius"], data["contact_modulus"]) == (units.radius, units.modulus)
    assert (data["regime"], data["verdict"]) == (assessment.regime, [assessment.verdict])
    assert data["cautions"] == list(assessment.cautions)
    assert data["distances"] == [vars(d) | {"missing": list(d.missing)} for d in assessment.distances]


def test_the_command_prints_and_writes_what_it_computed(said):
    assert f"written: {said.json} {said.plot}\n" in said.text
    _check_table(said.text, said.assessment)
    _check_record(said.record, said.assessment)
    assert said.record["input"]["grip"] == "sliding"
    assert said.record["input"]["stiffness"] == 0.2
    assert "16 pi dgamma eps^2 = 452.4 zJ" in said.text
    drawn = set(re.findall(r"<!-- (.*?) -->", said.drawn))  # what the letters' outlines say
    assert {"separation of the undeformed surfaces, nm", "force (compression positive), nN"} <= drawn
    assert {"half-space", "finite sphere", "JKR"} <= drawn
    for line in (said.assessment.verdict, *said.assessment.cautions):
        assert line in said.text.replace("\n", " ")


@pytest.mark.parametrize("width", [80, 30])
def test_every_number_unit_and_sentence_is_whole_at_any_width(silica, bead, width):
    for assessment in (silica, bead):
        text = shown(report(assessment, DIGITS), width)
        assert "…" not in text
        assert max(map(len, text.splitlines())) <= width
        numbers = set(re.findall(r"-?[\d.]+\(\d+\)", shown(report(assessment, DIGITS))))
        assert set(re.findall(r"-?[\d.]+\(\d+\)", text)) <= numbers
        assert assessment.verdict in text.replace("\n", " ").replace("  ", " ")
        flat = " ".join(text.split())
        for model in assessment.models:  # shown, or said to be left out
            assert model.model in flat


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
    lost = cycle(path, 0.2 * 0.3e-9 / 1e-8).energy_lost.value
    assert values["energy_lost"].value == pytest.approx(lost * 1e-8 * 0.3e-9, rel=1e-6)


def test_the_answer_comes_first_to_four_digits(silica):
    lines = shown(report(silica), 80).splitlines()
    force, on = (silica.finite.values[name].value * 1e9 for name in ("pull_off_force", "jump_on_separation"))
    assert lines[0].startswith("trust the finite sphere")
    assert lines[1:3] == [f"  pull-off force: {force:.4g} nN", f"  separation at jump-on: {on:.4g} nm"]
    assert lines[5].startswith("why: tabor = 0.1925, transition between rigid and JKR")
    assert not re.search(r"\d\(\d+\)", "".join(lines))
    assert any(line.startswith("finite sphere") and f"{force:.4g}" in line for line in lines)
    assert lines[-1].startswith("Muller")


def test_the_theories_stand_where_they_should(silica):
    force = {model.model: model.values["pull_off_force"].value for model in silica.models}
    assert force["JKR"] == pytest.approx(1.5 * np.pi * 1e-8)
    assert force["rigid"] == pytest.approx(2 * np.pi * 1e-8)
    assert force["JKR"] < force["Maugis-Dugdale"] < force["half-space"] < force["rigid"]
    assert "transition" in silica.regime


def test_a_rubber_bead_is_left_to_the_closed_theories(bead):
    units = bead.contact.units
    assert units.tabor > 300
    assert bead.half_space.model == "JKR with attraction"
    assert bead.half_space.values["pull_off_force"].value == pytest.approx(1.5 * np.pi * 50e-6 * 0.05, rel=1e-4)
    assert bead.finite is None
    assert any("finite sphere not solved: tabor = 874.3 is outside tabor <= 10" in line for line in bead.cautions)
    assert bead.verdict == "the finite body is not known: judge JKR with attraction by the cautions"
    deviation = next(d for d in bead.deviations if d.quantity == "pull_off_force")
    sphere = JKRSphere(units.tabor, units.radius_ratio).pull_off().load
    assert deviation.profile.value == pytest.approx(sphere / theories.JKR_PULL_OFF - 1, rel=1e-3)
    assert bead.half_space.values["jump_on_separation"].value > 10e-9


def test_a_sphere_that_is_all_but_rigid_has_bradleys_force():
    """2 pi R dgamma on the half-space, and 9/7 eps/R less by the sphere's profile."""
    rigid = Contact(radius=100e-9, modulus=7e28, poisson=0.17, work_of_adhesion=0.1, spacing=0.3e-9, stiffness=0.2)
    assert rigid.units.tabor < study.USUAL.rigid
    forces = [model(rigid).values["pull_off_force"].value for model in (study._half_space, study._profile)]
    bradley = 2 * np.pi * 100e-9 * 0.1
    assert forces == [pytest.approx(bradley, rel=1e-8), pytest.approx(bradley * (1 - 9 / 7 * 0.003), rel=3e-5)]


# What is said ---------------------------------------------------------------------------------------------------------


def _model(name, force, *, on=1e-9):
    values = {"pull_off_force": Quantity(force, 0.0, "N")}
    if on is not None:
        values["jump_on_separation"] = Quantity(on, 0.0, "m")
    return Prediction(name, values)


def _verdict(half_space, profile, finite, *theories):
    distances = ranked((half_space, profile, finite, *theories), 1e-10)
    return verdict(finite or half_space, distances, computed=finite is not None)


def test_the_verdict_follows_absurd_numbers():
    half_space, rigid = _model("half-space", 1.5), _model("rigid", 1.2)
    near = _verdict(half_space, _model("true profile", -1.0), _model("finite sphere", 1.0), _model("rigid", 1.001))
    assert near == "trust the finite sphere; within 1 % in every quantity: rigid"
    unknown = _verdict(half_space, _model("true profile", 1.1), None)
    assert unknown == "the finite body is not known: judge the half-space by the cautions"
    far = "no other model is within 1 % in every quantity, the rigid sphere is nearest, off by up to 20 %"
    assert _verdict(half_space, None, _model("finite pair", 1.0), rigid) == f"trust the finite pair; {far}"


def test_the_distance_of_a_model_is_what_it_may_be_at_most():
    """Both errors are part of it, and a position near zero is judged by the spacing."""
    (distance,) = ranked((_model("a", 1.0, on=3e-12), None, _model("b", 1.0, on=1e-15)), 1e-10)
    assert distance == Distance("a", "jump_on_separation", pytest.approx(0.02999, rel=1e-6), ())
    one, other = (
        Prediction(name, {"energy_lost": Quantity(*v, "J")}) for name, v in (("a", (3, 0.2)), ("b", (2, 0.4)))
    )
    (distance,) = ranked((one, None, other), 1e-10)
    assert distance.size == pytest.approx((3.0 - 2.0 + 0.2 + 0.4) / 2.0, rel=1e-12)


def test_a_model_that_lacks_a_quantity_is_not_nearest():
    finite = _model("finite sphere", 1.0)
    models = _model("half-space", 1.5), None, finite, _model("JKR", 1.0, on=None)
    assert [distance.model for distance in ranked(models, 1e-10)] == ["half-space", "JKR"]
    assert "the half-space is nearest, off by up to 50 %" in _verdict(*models)
    assert (
        _verdict(_model("half-space", 1.5, on=None), None, finite)
        == "trust the finite sphere; no other model has all its quantities"
    )


def test_theories_are_not_judged_by_another_contact_radius(silica):
    radii = {"pull_off_radius", "zero_load_radius"}
    for distance in silica.distances:
        closed = distance.model not in ("half-space", "true profile")
        assert not (closed and distance.worst in radii)
    jkr = next(d for d in silica.distances if d.model == "JKR")
    assert jkr.missing == ()


@pytest.mark.parametrize(
    ("tabor", "word"), [(0.0999, "rigid:"), (0.1, "transition"), (5.0, "transition"), (5.1, "soft:")]
)
def test_the_regime_is_that_of_its_limits(tabor, word):
    assert regime(tabor).startswith(word)
    assert "below tabor 0.1, JKR above 5" in regime(tabor)


@pytest.mark.parametrize(
    ("what", "contact", "values", "figure"),
    [
        ("spacing over R", {"radius": 1e-9, "spacing": 0.2e-9}, {}, "0.2, limit 0.1"),
        ("strain beta/R", {"radius": 1e-9, "modulus": 1e9, "poisson": 0.4999, "spacing": 1e-11}, {}, "0.42, limit 0.2"),
        ("stretching of the attracted surface over the work of adhesion", {"modulus": 5e8}, {}, "0.17, limit 0.1"),
        ("contact radius over R", {}, {"zero_load_radius": 0.4e-7}, "0.4, limit 0.3"),
        ("jump-on distance over R", {}, {"jump_on_separation": 0.5e-7}, "0.5, limit 0.3"),
    ],
)
def test_a_caution_stands_beyond_its_limit_only(what, contact, values, figure):
    given = {name: Quantity(value, 0.0, "m") for name, value in values.items()}
    said = list(cautions(Contact(**(SILICA | contact)), Prediction("absurd", given)))
    assert [line.split(" is ")[0] for line in said] == [what]
    assert said[0].split(" is ")[1].startswith(figure)
    fine = {name: Quantity(1e-9, 0.0, "m") for name in given}
    assert list(cautions(Contact(**SILICA), Prediction("fine", fine))) == []


@pytest.mark.parametrize(("modulus", "told"), [(1e14, False), (1e12, False), (72e9, True), (1e9, True), (5e8, False)])
def test_yield_is_corrected_from_a_thousandth_to_a_tenth(modulus, told):
    """Of the work of adhesion. Below it is silent, beyond a caution says that the first order is not enough."""
    contact = Contact(**(SILICA | {"modulus": modulus}))
    mu, ratio = contact.units.tabor, contact.units.radius_ratio
    part = 0.273797 * mu * np.sqrt(mu / ratio) * (1 - 2 * 0.17) / (1 - 0.17) ** 2
    lines = list(left_out(contact))
    assert (1e-3 <= part <= 0.1) == told == bool(lines)
    work = 0.1 * (1 + part)
    assert all(f"by {100 * part:.3g} %, to {work:.4g} J/m^2; give" in line for line in lines)
    said = [line for line in cautions(contact, Prediction("absurd", {})) if "attracted surface" in line]
    assert bool(said) == (part > 0.1)
    assert all("raises that by more than its first order tells" in line for line in said)


def test_a_verdict_heeds_the_cautions_that_pass_a_limit(tmp_path):
    """A thin sample pressed in by more than its thickness: it is not to be trusted, only better than the others."""
    thin = "--radius 20nm --modulus 2GPa --poisson 0.3 --work-of-adhesion 0.05J/m^2 --spacing 0.2nm --thickness 1nm"
    text = " ".join(Said(thin, tmp_path).text.split())
    assert "indentation over thickness is 1.2, limit 0.2: finite strain matters" in text
    assert "trust no model as it is: finite strain matters, its base attracts through the sample; of these the" in text
    assert "trust the" not in text


def test_a_loop_that_is_a_ripple_of_the_samples_is_none(tmp_path):
    """Maugis's at a Tabor parameter of 4e-4 was one of 4e-35 J, whose error was not a number: nothing was shown."""
    glass = "--radius 100nm --modulus 72GPa --poisson 0.17 --work-of-adhesion 0.063J/m^2 --spacing 100nm"
    said = Said(glass, tmp_path)
    models = {model["model"]: model["values"] for model in said.record["models"]}
    assert "energy_lost" not in models["Maugis-Dugdale"]
    assert all(math.isfinite(number["error"]) for values in models.values() for number in values.values())
    assert "pull-off force" in said.text


def test_the_yield_by_another_law_is_told_with_its_premise(silica):
    (line,) = left_out(replace(silica.contact, law=Morse(3)))
    (usual,) = left_out(silica.contact)
    parts = [float(re.search(r"adhesion by (\S+) %", said)[1]) for said in (line, usual)]
    assert parts[0] / parts[1] == pytest.approx(1.0 / (2 * 0.273797), rel=5e-3)
    assert "J/m^2, if the law attracts matter and not charges on the surfaces; give that to include it" in line


def test_what_holds_for_the_3_9_law_is_said_of_it_alone(silica):
    other = replace(silica, contact=replace(silica.contact, law=Morse(3)))
    premise = "Maugis lambda and the theories with a range of attraction, Maugis-Dugdale and DMT-M, are the 3-9 law's."
    for assessment, usual in ((silica, True), (other, False)):
        text = " ".join(shown(report(assessment, DIGITS)).split())
        assert ("Hamaker constant 16 pi" in text) == usual
        assert (premise in text) != usual
        assert (record(assessment)["hamaker"] is not None) == usual


def test_the_contact_radius_says_what_it_is_beside_others(silica, bead):
    """Of a computed curve the state at the largest tension, of a theory its own; only of those that stand there."""
    assert contact_radius(bead).startswith("Contact radius: of JKR with attraction, JKR on the sphere, JKR")
    assert "1.20094" not in contact_radius(bead)
    by_morse = replace(silica, contact=replace(silica.contact, law=Morse(3)))
    assert f"where the gap is {1 + np.log(2) / 3:.6g} eps" in contact_radius(by_morse)  # 2 e^(-k H) = 1 there
    assert record(silica)["definitions"]["contact_radius"] == contact_radius(silica)
    assert contact_radius(silica) in " ".join(shown(report(silica)).split())
    bonded = replace(silica, contact=replace(silica.contact, grip="bonded"))
    for assessment, grip in ((silica, "sliding"), (bonded, "bonded")):
        assert f"is an elastic hemisphere held at its mid-plane, {grip}." in " ".join(shown(report(assessment)).split())


@pytest.mark.parametrize("error", [InputError("a; do b"), NotConverged("a; do b"), GridTooCoarse("a; do b")])
def test_what_a_solver_refuses_is_said_with_its_reason(error, monkeypatch):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(convergence, "trace", fail)
    monkeypatch.setattr(study, "_profile", fail)
    found = assess(Contact(**SILICA))
    assert found.cautions[-2:] == ("true profile not solved: a; do b", "finite sphere not solved: a; do b")
    assert (found.profile, found.finite) == (None, None)


def test_a_defect_is_not_taken_for_a_refusal(monkeypatch):
    def fail(*_, **__):
        raise ValueError("on purpose")

    monkeypatch.setattr(convergence, "trace", fail)
    with pytest.raises(ValueError, match="on purpose"):
        assess(Contact(**SILICA))


def test_the_record_is_plain_data_without_infinities(bead):
    data = json.loads(json.dumps(record(bead), allow_nan=False))
    _check_record(data, bead)
    assert data["input"]["counter_modulus"] is None
    assert data["input"]["counter_radius"] is None


# Units and digits -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (60.44403, 6e-8, "60.4440(1)"),
        (60.44403, 0.00123, "60.444(2)"),
        (-302.26, 4.2, "-302(5)"),
        (-1e-5, 0.0014, "0.000(2)"),
        (5.0, 0.0, "5.00000(1)"),
        (1.5, 0.11, "1.5(2)"),
        (-1.2345678, math.inf, "-1.23457(?)"),
        (-1.2345678, math.nan, "-1.23457(?)"),
    ],
)
def test_numbers_with_errors(value, error, text):
    assert with_error(Quantity(value, error, "1")) == text


def test_engineering_prefixes():
    assert engineering(72.08e9, "Pa") == "72.08 GPa"
    assert engineering(0.2, "N/m") == "200 mN/m"
    assert engineering(3e-7, "m") == "300 nm"
    assert engineering(6.5e-20, "J") == "65 zJ"
    for exponent in PREFIXES:
        assert exponent_of(2.5 * 10.0**exponent) == exponent


# The figure -----------------------------------------------------------------------------------------------------------


def test_the_arrows_are_the_jumps_of_a_given_profile():
    found = assess(Contact(**SILICA, profile=Power(3.0), stiffness=0.2))
    assert found.best.model == "given profile"
    jumps = [text for text in assess_figure.draw(found).axes[0].texts if text.arrow_patch]
    for arrow, way in zip(jumps, ("on", "off"), strict=True):
        assert arrow.xyann[0] == pytest.approx(1e9 * found.best.values[f"jump_{way}_separation"].value)


@pytest.fixture(scope="module")
def axes(silica):
    return assess_figure.draw(silica).axes[0]


def test_the_axes_of_the_figure_say_what_is_drawn_along_them(axes, silica):
    """Each model's line under its own label: its least force is its pull-off, where its surfaces are as far apart."""
    assert axes.get_xlabel() == "separation of the undeformed surfaces, nm"
    assert axes.get_ylabel() == "force (compression positive), nN"
    lines = {line.get_label(): line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 2}
    drawn = {model.model: model for model in silica.models if model.model in lines}
    assert set(drawn) == set(lines) == {"half-space", "finite sphere", *study.THEORIES}
    for name, line in lines.items():
        separation, force = line[np.nanargmin(line[:, 1])]
        assert force == pytest.approx(-1e9 * drawn[name].values["pull_off_force"].value, rel=2e-4)
        if name not in study.THEORIES:
            path = halfspace.trace(silica.contact.units.tabor) if name == "half-space" else drawn[name].curve
            at = path.events["pull_off"].approach
            assert separation == pytest.approx((1 - at) * 0.3, abs=0.02)
    assert all(word in axes.get_title() for word in ("= 100 nm", "= 0.1925", "cantilever 200 mN/m"))
    low, high = axes.get_ylim()
    assert low < -1e9 * silica.half_space.values["pull_off_force"].value < 0 < high


def test_the_axes_of_the_figure_are_in_the_units_that_they_name(bead):
    """Other ones than nm and nN: a bead of 50 um pulls with some microN."""
    axes = assess_figure.draw(bead).axes[0]
    unit = {PREFIXES[exponent] + "N": 10.0**exponent for exponent in PREFIXES}[axes.get_ylabel().rpartition(", ")[2]]
    assert unit == 1e-6
    line = next(line for line in axes.lines if line.get_label() == bead.half_space.model)
    force = bead.half_space.values["pull_off_force"].value
    assert np.nanmin(line.get_ydata()) * unit == pytest.approx(-force, rel=1e-3)
    metres = {PREFIXES[exponent] + "m": 10.0**exponent for exponent in PREFIXES}[axes.get_xlabel().rpartition(", ")[2]]
    arrow = next(text for text in axes.texts if text.arrow_patch)
    on = bead.half_space.values["jump_on_separation"].value
    assert arrow.xyann[0] * metres == pytest.approx(on, rel=1e-3)


def test_the_arrows_are_the_jumps_of_the_model_to_trust(axes, silica):
    arrows, notes = ([t for t in axes.texts if bool(t.arrow_patch) is drawn] for drawn in (True, False))
    on, off = (silica.finite.values[f"jump_{way}_separation"].value * 1e9 for way in ("on", "off"))
    assert [arrow.xyann[0] for arrow in arrows] == pytest.approx([on, off])
    jump_off = cycle(silica.finite.curve, silica.contact.reduced_stiffness).jump_off
    assert arrows[1].xyann[1] == pytest.approx(jump_off.take_off.load * silica.contact.units.load * 1e9, rel=1e-6)
    (note,) = notes  # it lands far beyond the frame
    lands = (1 - jump_off.landing.approach) * silica.contact.units.approach * 1e9
    assert note.get_text() == f"lands at {lands:.4g} nm"
