"""A layer of finite elements, held against the integral equation, which shares no operator with it."""

import json

import pytest

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, Layer, Scene
from fem_adhesion.cli import main
from fem_adhesion.crosscheck.comparison import difference
from halfspace.errors import InputError
from halfspace.laws import PowerLaw
from halfspace.profiles import Power

QUANTITIES = ("approach", "load", "central_gap", "contact_radius")


@pytest.mark.parametrize(
    ("scene", "rtol"),
    [
        (Scene(1.0, Layer(2.0, poisson=0.3)), 1e-5),
        (Scene(1.0, Layer(2.0, "sliding", poisson=0.3)), 1e-4),
        (Scene(1.0, Layer(0.1, poisson=0.4999)), 1e-4),
        (Scene(5.0, Layer(20.0, poisson=0.45)), 1e-3),
        # What is pressed out of the contact goes on beyond the edge, and a steep tip's attraction ends before the layer
        # has hidden its base.
        (Scene(0.5, Layer(0.5, "sliding"), law=PowerLaw(2.5, 9.5), profile=Power(4)), 1e-4),
        (Scene(1.0, Layer(0.5, "sliding", poisson=0.4999), profile=Power(10)), 1e-4),
        (Scene(1.0, Layer(1.0, poisson=0.4999), profile=Power(10)), 1e-4),
        (Scene(5.0, Layer(1000.0, "sliding")), 1e-3),
    ],
    ids=str,
)
def test_both_solvers_have_the_same_events_on_a_layer(scene, rtol):
    elements = fem_adhesion.trace(scene, rtol=rtol)
    integral = halfspace.trace(scene.tabor, body=scene.body.layered, law=scene.law, profile=scene.shape, rtol=rtol / 10)
    assert elements.met
    assert difference(elements.energy, integral.energy) <= elements.energy.error + integral.energy.error
    assert set(elements.events) == set(integral.events)
    for name, event in elements.events.items():
        for quantity in QUANTITIES:
            one, other = event.estimate(quantity), integral.events[name].estimate(quantity)
            assert one.value == pytest.approx(other.value, rel=0, abs=one.error + other.error, nan_ok=True)


def test_the_pull_off_is_that_of_the_reference():
    event = fem_adhesion.trace(Scene(1.0, body=halfspace.Layer(2.0, 0.3)), rtol=1e-5).events["pull_off"]
    assert abs(event.load + 5.681629017) <= event.load_error + 1e-8
    assert abs(event.approach + 0.095053503) <= event.approach_error + 1e-9
    assert event.load_error <= 1e-5 * 5.7


def test_a_layer_is_the_same_body_in_both_packages():
    assert Scene(1.0, body=halfspace.Layer(2.0, 0.4, "sliding")).body == Layer(2.0, "sliding", poisson=0.4)


@pytest.mark.parametrize("body", [halfspace.Coated(1.0, 10.0), halfspace.Layers([halfspace.Stratum(1.0)])], ids=str)
def test_what_is_not_meshed_says_what_serves(body):
    with pytest.raises(InputError, match=r"is not meshed, limit: one layer on a rigid base; take halfspace\.trace"):
        Scene(1.0, body=body)


def test_compare_on_the_command_line_agrees_with_all_that_it_has(tmp_path):
    record = tmp_path / "record.json"
    contact = ["--tabor", "1", "--body", "layer", "--thickness", "2", "--poisson", "0.3"]
    assert main(["compare", *contact, "--rtol", "1e-4", "--json", str(record)]) == 0
    rows = json.loads(record.read_text())["cases"][0]["comparison"]
    between = {tuple(row["between"]) for row in rows}
    assert {("half-space", "finite elements"), ("weak form", "finite elements")} <= between
    assert all(row["verdict"] == "agree" for row in rows)


@pytest.mark.parametrize("wrong", [{"thickness": 2.1}, {"poisson": 0.33}], ids=str)
def test_compare_rejects_another_layer(wrong):
    """The integral equation is asked for another layer than the elements."""
    asked = {"thickness": 2.0, "foundation": "bonded", "poisson": 0.3}

    def other(*_, **options):
        return fem_adhesion.trace(Scene(1.0, body=Layer(**asked | wrong)), **options)

    case = fem_adhesion.compare(Scene(1.0, body=Layer(**asked)), rtol=1e-4, solve=other)
    assert case.verdict == "disagree"


def test_a_layer_without_a_thickness_is_asked_for_it(capsys):
    assert main(["curve", "--tabor", "1", "--body", "layer"]) == 2
    assert "give --thickness, in beta" in capsys.readouterr().err


def test_the_integral_equation_takes_the_layer_of_the_elements_and_refuses_other_bodies():
    ours, theirs = (halfspace.trace(1.0, body=body(2.0, poisson=0.3), rtol=1e-3) for body in (Layer, halfspace.Layer))
    assert ours.events == theirs.events
    with pytest.raises(InputError, match=r"body = HalfSpace\(.*\), limit: layers on a base; give Layer, Coated or"):
        halfspace.trace(1.0, body=HalfSpace())
