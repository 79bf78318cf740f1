"""`compare` of bodies with a length: each agrees with what shares no operator with it, and a defect is rejected."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scenes import hemisphere, pair

from fem_adhesion import HeldSphere, Hemisphere, LinearElastic, Meshed, Scene, cli, discretise, harmonics
from fem_adhesion.crosscheck import definitions, from_scratch
from fem_adhesion.crosscheck import study as crosscheck
from fem_adhesion.crosscheck.comparison import HARMONICS, SOLVERS, WEAK_FORM
from fem_adhesion.crosscheck.weak_bodies import contacts
from fem_adhesion.elasticity import cells
from halfspace.errors import InputError
from halfspace.profiles import Paraboloid, Sphere

MESH = Path(__file__).parents[3] / "meshes" / "hemisphere.msh"


def sphere(profile=None, **of_body):
    return hemisphere(1.0, 30.0, profile, **of_body)


def facing(*counter, **of_body):
    return pair(1.0, 30.0, *counter, **of_body)


@pytest.fixture
def _without_limits(monkeypatch):
    """Closed forms are those of the half-space, whatever the body, and definitions have tests of their own."""
    monkeypatch.setattr(from_scratch, "closed_forms", lambda _: [])
    monkeypatch.setattr(definitions, "rows", lambda _: [])


# --- the command ---

HEMISPHERE = ["--profile", "sphere", "--body", "hemisphere:10"]


def test_a_hemisphere_is_compared_with_the_whole_sphere(tmp_path, capsys):
    file = tmp_path / "result.json"
    assert cli.main(["compare", "--tabor", "1", *HEMISPHERE, "--json", str(file)]) == 0
    (case,), out = json.loads(file.read_text())["cases"], capsys.readouterr().out
    assert "tabor 1; poisson 0.3; hemisphere; R/eps 10: agree" in out
    assert "harmonics" in out
    rows = {row["quantity"]: row for row in case["comparison"] if row["between"] == list(HARMONICS)}
    assert {"operator: spike", "cross-residual: pull_off", "jump_off load", "energy released"} <= rows.keys()
    for quantity, row in rows.items():
        event, _, number = quantity.partition(" ")
        if event in case["finite_element"]["events"]:
            assert row["first"] == pytest.approx(row["second"], rel=1e-4, abs=1e-4)
            if number in ("load", "approach"):
                assert row["first"] == case["harmonics"]["events"][event][number]
                assert row["budget"] <= 1e-4
    assert {row["verdict"] for row in case["comparison"]} == {"agree"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([*HEMISPHERE, "--strain", "finite"], "is compared with nothing, limit: small strain"),
        (["--body", "hemisphere:1e6", "--tabor", "5"], "radius_ratio = 1e+06 at tabor 5 takes"),
    ],
)
def test_the_command_refuses_in_one_line(arguments, message, refused):
    refused("compare", "--tabor", "1", *arguments, words=message)


# --- what needs no solution ---

BODIES = {
    "under a sphere": (Scene(1.0, profile=Sphere(30.0)), SOLVERS),
    "nearly incompressible": (sphere(poisson=0.4999), HARMONICS),
    "under a paraboloid": (sphere(Paraboloid()), HARMONICS),
    "two spheres": (facing(0.3, 0.45, 2.0), HARMONICS),
    "sphere on a half-space": (facing(0.5, 0.2), HARMONICS),
    "traction on the surface": (sphere(material=LinearElastic(traction="surface")), None),
    "bonded pair": (facing(0.3, 0.45, 2.0, grip="bonded"), None),
    "held over a cap": (Scene(1.0, HeldSphere(radius_ratio=30.0)), None),
    "a mesh": (Scene(1.0, Meshed(MESH, radius_ratio=30.0, grip="bonded")), None),
}


@pytest.mark.usefixtures("_without_limits")
@pytest.mark.parametrize("body", BODIES)
def test_operators_and_equations_agree(body):
    scene, between = BODIES[body]
    rows = crosscheck.unsolved(scene, rtol=1e-4)
    assert {row.quantity: row.verdict for row in rows if row.verdict != "agree"} == {}
    assert {row.between for row in rows} == {WEAK_FORM} | ({between} if between else set())
    assert len(rows) == (6 if between else 4)


def test_a_bonded_hemisphere_agrees_with_the_weak_form():
    case = crosscheck.compare(hemisphere(0.3, 30.0, grip="bonded"), rtol=1e-4, before=())
    assert case.verdict == "agree"
    assert list(case.solutions) == ["finite elements"]
    assert {row.between for row in case.rows} == {WEAK_FORM}
    assert len(case.rows) == 10
    for row in case.rows:  # it knows a body with a length better than its budget
        assert row.first.error < row.budget / 5, row.quantity


# --- defects of the finite elements ---


def _stiffer(monkeypatch):
    original = cells.elastic_matrix
    monkeypatch.setattr(cells, "elastic_matrix", lambda nu: 1.01 * original(nu))


def _another(profile=None, **change):
    """Finite elements that solve another scene."""

    def inject(monkeypatch):
        def other(scene):
            return replace(scene, profile=profile, body=replace(scene.body, **change))

        original = discretise.sized_body
        monkeypatch.setattr(discretise, "sized_body", lambda scene, how: original(other(scene), how))

    return inject


DEFECTS = {
    "1 % stiffer": (_stiffer, {"operator: ring", "equations: residual", "equations: tangent"}),
    "R/eps 1 % larger": (_another(radius_ratio=30.3), {"operator: ring", "equations: residual"}),
    "Poisson's ratio 0.31": (_another(material=LinearElastic(0.31)), {"operator: ring", "equations: residual"}),
    "profile of the paraboloid": (_another(Paraboloid()), {"equations: residual"}),
    "another grip": (None, {"operator: ring", "equations: residual", "equations: tangent"}),
}


@pytest.mark.usefixtures("_without_limits")
@pytest.mark.parametrize(("defect", "grip"), [*((each, "sliding") for each in DEFECTS), ("another grip", "bonded")])
def test_a_defect_of_the_finite_elements_is_rejected(defect, grip, monkeypatch):
    """Bonded by the weak form alone."""
    inject, shown_by = DEFECTS[defect]
    inject = inject or _another(grip="sliding" if grip == "bonded" else "bonded")
    inject(monkeypatch)
    rows = crosscheck.unsolved(sphere(grip=grip), rtol=1e-4)
    rejecting = {row.quantity for row in rows if row.verdict == "disagree"}
    assert {name for name in shown_by if grip == "sliding" or not name.startswith("operator")} <= rejecting


# --- the solvers they are compared with ---


def test_harmonics_refuse_a_spike_that_takes_too_many():
    with pytest.raises(InputError, match="harmonics of the sphere, limit 5000; take a smaller one"):
        harmonics.trace(Scene(5.0, Hemisphere(radius_ratio=1e5)))


@pytest.mark.parametrize("counter", [None, (0.4, 0.3, 3.0)])
def test_the_weak_form_of_a_sphere_has_its_whole_surface(counter):
    scene = sphere() if counter is None else facing(*counter)
    R = scene.sphere_radius * (1 if counter is None else 1 + 1 / 3)
    for contact in (make(1.2, 1.2) for make in contacts(scene)):
        assert contact.body.area.sum() == pytest.approx(np.pi * R**2, rel=1e-9)
        assert contact.body.yields.all() == (counter is None)
