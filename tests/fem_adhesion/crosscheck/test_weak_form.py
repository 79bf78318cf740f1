"""The public weak form: the whole curve by full Newton, beside the solvers that share nothing with it."""

import json

import numpy as np
import pytest
from agreement import differing
from page_tables import rows_of

import fem_adhesion
import halfspace
from fem_adhesion import Coated, Hemisphere, Scene, cli
from fem_adhesion.crosscheck import elimination
from fem_adhesion.mesh.block import block_grid
from fem_adhesion.weak_form import trace
from fem_adhesion.weak_form.body import discretise
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.curve import Path
from halfspace.errors import InputError
from halfspace.laws import Morse
from halfspace.profiles import Power

RTOL = 6e-2


@pytest.mark.parametrize("wrong", [False, True])
def test_compare_tells_whether_condensing_is_exact(wrong, monkeypatch):
    if wrong:  # a ten thousandth of one modulus
        exact = elimination.condense
        monkeypatch.setattr(elimination, "condense", lambda space, nu, **rest: exact(space, nu * (1 + 1e-4), **rest))
    for tabor in (0.05, 1.0):
        rows = elimination.rows(Scene(tabor), fem_adhesion.trace(Scene(tabor), rtol=1e-3))
        assert {row.verdict for row in rows} == {"disagree" if wrong else "agree"}


@pytest.fixture(scope="module")
def path():
    """A path on coarse cells: 20 beta wide and fine up to 3 beta."""
    contact = Contact(discretise(block_grid(0.4, 3.0, 20.0), 3, [(0.3, 1.0)]), 1.0)
    return Path(contact)


def test_the_path_turns_where_its_conditions_vanish(path):
    points = path.follow(-6.0, 1.0)
    found = path.events(points)
    assert set(found) == {"pull_off", "jump_on", "jump_off", "zero_load"}
    assert abs(found["pull_off"].rates[1]) < 1e-6
    assert max(abs(found[name].rates[0]) for name in ("jump_on", "jump_off")) < 1e-6
    assert abs(found["zero_load"].state.load) < 1e-6
    assert found["pull_off"].state.load == min(point.state.load for point in [*points, found["pull_off"]])
    signs = np.array([point.rates[0] > 0 for point in points])
    assert (signs == [point.state.unstable == 0 for point in points]).all()  # inertia and turning of the path agree


def test_a_point_has_the_contact_radius_or_the_gap_that_was_asked_for(path):
    edge = path.contact.law.edge
    apart = path.at(-2.0, path.contact.undeformed(-2.0))
    assert apart.state.central_gap == pytest.approx(edge + 2.0 - 1, abs=1e-6)
    points = path.follow(-6.0, 0.0)
    assert [point.s for point in points] == sorted(point.s for point in points)
    for point in points[-3:]:
        assert point.state.contact_radius == pytest.approx(np.sqrt(point.s), rel=1e-3)


@pytest.fixture(scope="module")
def curve():
    return trace(Scene(0.8), rtol=RTOL)


def test_every_number_agrees_with_the_integral_equation(curve):
    other = halfspace.trace(0.8, rtol=1e-7)
    assert curve.met
    assert set(curve.events) == {"pull_off", "jump_on", "jump_off", "zero_load"}
    assert differing(curve, other) == []
    contact = curve.stable & (curve.central_gap < 0)
    on_other = other.at(approach=curve.approach[contact], branch="contact")
    assert (np.abs(on_other.load - curve.load[contact]) < 1e-2 * abs(curve.event("pull_off").load)).all()


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (Scene(1.0, Hemisphere(radius_ratio=100.0)), "body = hemisphere by the weak form, limit: half-space"),
        (Scene(1.0, Coated(1.0, 5.0)), "by the weak form, limit: half-space"),
        (Scene(1.0, law=Morse(3)), "limit: the 3-9 law"),
        (Scene(1.0, profile=Power(4)), "limit: paraboloid"),
        (Scene(30.0), "tabor = 30 of the weak form is outside 0.02 <= tabor <= 5"),
    ],
)
def test_a_scene_that_it_does_not_serve_is_refused(scene, message):
    with pytest.raises(InputError, match=message):
        trace(scene)
    with pytest.raises(InputError, match="rtol"):
        trace(Scene(1.0), rtol=1e-8)


def test_the_command_writes_what_it_found(curve, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("fem_adhesion.weak_form.curve.trace", lambda *_, **__: curve)
    files = [tmp_path / name for name in ("curve.json", "curve.csv", "curve.svg")]
    options = [
        part for option, file in zip(("--json", "--csv", "--plot"), files, strict=True) for part in (option, file)
    ]
    assert cli.main(["curve", "--tabor", "0.8", "--solver", "weak-form", *map(str, options)]) == 0
    assert "weak form: " in capsys.readouterr().out
    solution = json.loads(files[0].read_text())["solutions"]["weak form"]
    rows = rows_of(files[1])
    event = next(row for row in rows if row["event"] == "pull_off")
    assert float(event["load_R_dgamma"]) == solution["events"]["pull_off"]["load"]
    assert float(event["load_R_dgamma"]) == pytest.approx(halfspace.trace(0.8).event("pull_off").load, rel=1e-3)
    assert sum(not row["event"] for row in rows) == len(solution["curve"]["load"])
    assert "stable under fixed grips" in files[2].read_text()


@pytest.mark.parametrize("option", ["--vtk x", "--other-laws morse:3", "--points 9", "--stiffness 1"])
def test_what_the_weak_form_has_not_is_refused(option, refused):
    words = "the weak form gives points and events alone"
    refused("curve --tabor 1 --solver weak-form", option, words=words)
