"""Thin samples: Hertz's and JKR's theories on layers, the published series, and `assess --thickness`."""

import csv
import json
import math
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from assessed import Said, assert_alike, shown
from scipy.optimize import brentq, minimize_scalar

import halfspace
from fem_adhesion import cli
from fem_adhesion.assess import study
from fem_adhesion.assess.predictions import QUANTITIES, WORDS, computed, large_tabor, relative
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.terminal import enough_table, indentations_table, report
from fem_adhesion.assess.thin_sample import hertz_until
from fem_adhesion.common.contact import Contact
from fem_adhesion.common.numbers import DIGITS
from halfspace.elastic import grid
from halfspace.elastic.layers import Layer, Layers, Stratum, Substrate, surface_compliance
from halfspace.scaling import Units
from halfspace.theories.layered import OnLayers, hertz_ratio, thin_sample_series

SAMPLE = {"radius": 100e-9, "modulus": 1e9, "poisson": 0.3, "work_of_adhesion": 0.05, "spacing": 0.3e-9}
GIVEN = "--radius 100nm --modulus 1GPa --poisson 0.3 --work-of-adhesion 50mJ/m^2 --spacing 0.3nm --stiffness 0.5N/m"
LINE = f"{GIVEN} --thickness 30nm"


def _rows(kind):
    with (Path(__file__).parents[2] / "data" / "layer_limits.csv").open() as file:
        return [tuple(map(float, row[1:])) for row in csv.reader(file) if row[0].startswith(kind)]


@pytest.mark.parametrize(("poisson", "chi", "ratio"), _rows("hertz"))
def test_hertz_on_a_layer(poisson, chi, ratio):
    """The reference is incompressible, and a wide contact on a layer feels a change of 1e-6 by as much as 2e-5."""
    found = hertz_ratio(Layer(1.0, min(poisson, 0.499999)), chi**2)
    assert found.value == pytest.approx(ratio, rel=3e-6 if poisson < 0.5 else 2.5e-5)
    assert found.error < 1e-9 * found.value


@pytest.mark.parametrize(("poisson", "thickness", "pull_off"), _rows("jkr"))
def test_jkr_on_a_layer(poisson, thickness, pull_off):
    theory = OnLayers(Layer(thickness, min(poisson, 0.499999)))
    least = minimize_scalar(lambda a: theory.jkr(a).load, bounds=(0.8, 2.0), method="bounded")
    assert -least.fun / np.pi == pytest.approx(pull_off, rel=5e-7 if poisson < 0.5 else 3e-6)


@pytest.mark.parametrize("radius", [0.1, 3.0])
def test_theories_on_a_stack_do_not_depend_on_nodes_or_on_cuts(radius):
    whole = Layers([Stratum(0.4, 0.3), Stratum(0.5, 0.45, 0.2)], Substrate(5.0, 0.1))
    cut = Layers([Stratum(0.4, 0.3), Stratum(0.2, 0.45, 0.2), Stratum(0.3, 0.45, 0.2)], Substrate(5.0, 0.1))
    states = [OnLayers(whole).jkr(radius), OnLayers(whole, 1.3).jkr(radius), OnLayers(cut).jkr(radius)]
    for name in ("approach", "load"):
        values = [getattr(state, name) for state in states]
        assert values == pytest.approx([values[0]] * 3, rel=1e-9)


def test_the_series_has_the_coefficients_that_are_in_use():
    powers = np.array([1, 0.2, 0.04, 0.008, 0.0016])
    assert thin_sample_series(0.2, 0.5, "bonded") == pytest.approx(powers @ [1, 1.133, 1.283, 0.769, 0.0975], rel=1e-4)
    assert thin_sample_series(0.2, 0.5, "sliding") == pytest.approx(powers @ [1, 0.884, 0.781, 0.386, 0.0048], rel=1e-4)


def _moments(poisson, foundation):
    x, w = grid.gauss_legendre(200)
    left_out = 10 * w * (surface_compliance(Layer(1.0, poisson, foundation), 10 * (1 + x)) - 1)
    return [float(left_out @ (10 * (1 + x)) ** power) for power in (0, 2)]


@pytest.mark.parametrize(("poisson", "foundation"), [(0.0, "bonded"), (0.499999, "bonded"), (0.3, "sliding")])
def test_series_by_moments_is_that_of_the_integral_equation(poisson, foundation):
    A, B = _moments(poisson, foundation)
    cubic = -8 * (200 * A**3 - 9 * np.pi**2 * B) / (135 * np.pi**3)
    quartic = 2 * A * (715 * A**3 - 72 * np.pi**2 * B) / (45 * np.pi**4)
    body, chi = Layer(1.0, poisson, foundation), np.array([0.01, 0.02, 0.04])
    series = 1 - 2 * A / np.pi * chi + 14 / 3 * (A / np.pi) ** 2 * chi**2 + cubic * chi**3 + quartic * chi**4
    off = np.array([hertz_ratio(body, c**2).value for c in chi]) - series
    assert np.abs(off / chi**5).max() < 2  # the next term; at chi = 0.01 that is 2e-10


@pytest.mark.parametrize(("poisson", "foundation"), [(0.3, "bonded"), (0.499, "sliding")])
def test_hertz_is_off_by_a_hundredth_where_that_is_said(poisson, foundation):
    until = hertz_until(Contact(**SAMPLE | {"poisson": poisson}, thickness=1e-6, foundation=foundation))
    for chi, sign in ((until.value - until.error, 1), (until.value + until.error, -1)):
        off = 1 - 1 / hertz_ratio(Layer(1.0, poisson, foundation), chi**2).value
        assert sign * (USUAL.wrong - off) > 0


@pytest.fixture(scope="module")
def said(tmp_path_factory):
    return Said(LINE, tmp_path_factory.mktemp("thin"))


@pytest.fixture(scope="module")
def sample(said):
    return said.assessment.sample


def _cells(text, first):
    """Cells behind that which names their row."""
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in text.splitlines()]
    (row,) = [row for row in rows if row[:1] == [first]]
    return row[1:]


def test_the_sphere_is_traced_on_its_layer(said):
    """Against a trace of its own: pull-off, jumps, energy, in SI."""
    units = Units(100e-9, 1e9 / (1 - 0.3**2), 0.05, 0.3e-9)
    layer = Layer(30e-9 / units.length, 0.3)
    profile = halfspace.profiles.Sphere(units.radius_ratio)
    path = halfspace.trace(units.tabor, body=layer, profile=profile, rtol=1e-5, to_load=2.0)
    truth = computed("truth", path, 0.5 / units.stiffness, units)
    assert_alike(said.assessment.finite.values, truth.values)
    assert said.assessment.finite.model == "thin sample"


def test_what_is_printed_of_the_sample_is_what_was_found(sample):
    text = shown(indentations_table(sample, DIGITS))
    for row in sample.indentations:
        cells = _cells(text, f"{row.indentation * 1e9:.4g}")
        found = [float(cell.partition("(")[0]) for cell in cells]
        expected = [row.chi, row.force.value * 1e9, 100 * row.half_space.value, 100 * row.series.value]
        assert found == pytest.approx(expected, rel=2e-3)
    text = shown(enough_table(sample, DIGITS))
    for row in sample.enough:
        thickness, worst = _cells(text, WORDS.get(row.quantity, row.quantity))[:2]
        assert float(thickness.partition("(")[0]) == pytest.approx(
            row.thickness.value * 1e9, abs=row.thickness.error * 1e9
        )
        assert worst == WORDS[row.worst]


def test_the_reach_of_hertz_is_told_as_an_indentation(said):
    text, chi = " ".join(shown(report(said.assessment)).split()), said.assessment.sample.hertz_until.value
    told = text[text.index("here an indentation of ") :].split()[4:6]
    assert told[1] == "pm."
    assert float(told[0]) == pytest.approx(1e12 * (chi * 30e-9) ** 2 / 100e-9, rel=1e-3)


def test_the_record_has_all_of_it(said, sample):
    record = said.record
    assert record["thin_sample"] == json.loads(json.dumps(asdict(sample)))
    assert record["input"]["thickness"] == pytest.approx(30e-9)
    assert record["input"]["foundation"] == "bonded"
    assert record["thickness_in_beta"] == pytest.approx(30e-9 / said.assessment.contact.units.length)
    assert "<!-- thin sample -->" in said.drawn


def test_forces_without_adhesion_are_hertzs_times_the_layers(sample):
    """By the contact radius."""
    theory, h = OnLayers(Layer(1.0, 0.3)), 30e-9
    for row in sample.indentations:
        a = brentq(lambda a, row=row: theory.hertz(a).approach - row.chi**2, 1e-3, 3.0)
        force = theory.hertz(a).load * 1e9 / (1 - 0.3**2) * h**3 / 100e-9
        assert row.force.value == pytest.approx(force, rel=1e-9)
        assert row.chi == pytest.approx(math.sqrt(100e-9 * row.indentation) / h)
        hertz = 4 / 3 * 1e9 / (1 - 0.3**2) * math.sqrt(100e-9) * row.indentation**1.5
        assert row.half_space.value == pytest.approx(hertz / force - 1, rel=1e-9)
        series = hertz * thin_sample_series(row.chi, 0.3, "bonded")
        assert row.series.value == pytest.approx(series / force - 1, rel=1e-8, abs=1e-12)


def test_the_half_space_is_right_from_the_thickness_told(said, sample):
    contact = said.assessment.contact
    half_space = study._half_space(contact)
    force, every = sample.enough
    assert (force.quantity, every.quantity) == ("pull_off_force", "every quantity")
    for row, names in ((force, ["pull_off_force"]), (every, QUANTITIES)):
        for sign in (-1, 1):
            thickness = (row.thickness.value + sign * 2 * row.thickness.error) / contact.units.length
            model = study._on_layer(contact, Layer(thickness, 0.3), halfspace.profiles.Paraboloid())
            off = max(abs(relative(model, half_space, name, contact.spacing).value) for name in names)
            assert sign * (USUAL.wrong - off) > 0, (row.quantity, sign)


def test_a_soft_film_has_jumps_and_loss_within_errors():
    """At the Tabor parameter from which on the film is JKR's with a bulge of its own: beside the computed one."""
    units, layer = Units(2.0, 3.0, 5.0, 7.0), Layer(0.25, 0.49)
    path = halfspace.trace(300.0, body=layer, rtol=1e-4, to_load=2.0)
    for stiffness in (math.inf, 0.006):
        truth = computed("truth", path, stiffness, units)
        theory = large_tabor(300.0, stiffness, units, layer)
        assert_alike(theory.values, truth.values)
        half_space = large_tabor(300.0, stiffness, units).values["jump_on_separation"].value
        jump = theory.values["jump_on_separation"]
        assert half_space - jump.value > 2 * jump.error  # stiff, the film comes closer before it jumps


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("--foundation sliding", "--foundation would have no effect, limit: with --thickness"),
        ("--thickness 1pm", "m, 0.01 to 1000 beta; give metres or a unit, as 500nm"),
        ("--thickness 1m", "m, 0.01 to 1000 beta; leave it out: it is a half-space"),
        ("--thickness 30nm --grip bonded", "--grip would have no effect, limit: without --thickness"),
        ("--thickness 30nm --counter-radius 1um", "--counter-radius would have no effect, limit: without"),
    ],
)
def test_what_does_not_go_with_a_thin_sample_is_refused(more, words, refused):
    refused("assess", GIVEN, more, words=words)


def test_a_thickness_is_in_si_with_a_material_else_in_beta(monkeypatch, refused):
    asked, line = [], f"curve {GIVEN} --body"
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", lambda question, _: asked.append(question))
    with pytest.raises(AttributeError):
        cli.main([*line.split(), "layer:30nm"])
    assert asked[0].scene.body.thickness == pytest.approx(30e-9 / Contact(**SAMPLE).units.length)
    for length, words in (("30", "has no unit"), ("0.3nm", "outside 3e-10 m < thickness")):
        refused(line, f"layer:{length}", words=words)
    refused("curve", "--tabor", "1", "--body", "layer:30nm", words="thickness = 30nm is not a plain number in beta")


def test_thickness_and_foundation_are_heeded(monkeypatch):
    asked = []
    monkeypatch.setattr(study, "assess", lambda contact, *_: asked.append(contact))
    with pytest.raises(AttributeError):
        cli.main(["assess", *LINE.split(), "--foundation", "sliding"])
    layer = asked[0].layer
    assert (layer.strata[0].poisson, layer.base) == (0.3, "sliding")
    assert layer.thickness == pytest.approx(30e-9 / asked[0].units.length, rel=1e-12)
