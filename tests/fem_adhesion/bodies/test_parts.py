"""A new body is one class and one line: a toy one goes through trace, compare and the command line with its files."""

import json
from dataclasses import dataclass

import meshio
import numpy as np
import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Coated, Hemisphere, Layers, LinearElastic, NeoHookean, Scene, cli, registry
from fem_adhesion.bodies.body import Held
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.registry import name_of, part_from, record_of
from halfspace import Stratum, Substrate
from halfspace.elastic import grid
from halfspace.elastic.grid import FLAT
from halfspace.profiles import Paraboloid, Sphere


@dataclass(frozen=True, kw_only=True)
class Drum(Held):
    """Cylinder on its base, as wide and high as the radius of the sphere whose profile is over it."""

    def layout(self, R, how):  # noqa: ARG002
        """Flat, up to its rim."""
        return np.array([R]), FLAT

    def mesh(self, R, lines, length, how):
        """Free at its side."""
        mesh = tensor_grid(lines, grid.graded(0.0, length, R, growth=how.growth))
        return mesh.with_boundaries({"far": lambda x: x[1] == -R})


@pytest.fixture(autouse=True)
def _registered(monkeypatch):
    monkeypatch.setitem(
        registry.PARTS["body"],
        "drum",
        registry.Part(__name__, "Drum", {"radius_ratio": "R/eps", "grip": "sliding or bonded"}),
    )


def test_a_toy_body_is_softer_than_a_half_space():
    drum = fem_adhesion.trace(Scene(1.0, Drum(radius_ratio=10.0)), rtol=1e-3)
    endless = halfspace.trace(1.0, profile=Sphere(10.0), rtol=1e-3)
    assert drum.met
    for name in ("jump_on", "jump_off"):
        assert abs(drum.event(name).approach - endless.event(name).approach) > 1e-2


def test_a_toy_body_agrees_with_the_weak_form():
    case = fem_adhesion.compare(Scene(0.3, Drum(radius_ratio=10.0)), rtol=1e-3)
    assert {row.quantity: row.verdict for row in case.rows if row.verdict != "agree"} == {}
    assert list(case.solutions) == ["finite elements"]


def test_a_toy_body_is_known_to_the_command_line(tmp_path):
    record, states = tmp_path / "drum.json", tmp_path / "states"
    asked = ["--tabor", "0.3", "--body", "drum:10,bonded", "--rtol", "1e-2"]
    assert cli.main(["curve", *asked, "--json", str(record), "--vtk", str(states), "--points", "0"]) == 0
    scene = json.loads(record.read_text())["scene"]
    assert part_from("body", scene["body"]) == Drum(radius_ratio=10.0, grip="bonded")
    mesh = meshio.read(sorted(states.glob("body*.vtu"))[0])
    assert np.abs(mesh.points).max() == pytest.approx(np.sqrt(10.0 / 0.3), rel=1e-9)


def test_a_part_and_its_name_are_translated_both_ways():
    parts = [
        ("body", Hemisphere(radius_ratio=30.0, grip="bonded", material=NeoHookean(0.4, "normal"))),
        ("body", Coated(2.0, 10.0, poisson=0.45)),
        ("body", Layers([Stratum(0.4, 0.45), Stratum(3, 0.2, 2.0)], Substrate(5.0, 0.1))),
        ("body", Layers([Stratum(0.4, 0.3)], "sliding")),
        ("material", LinearElastic(0.45, "surface")),
        ("profile", Sphere(100.0)),
        ("profile", Paraboloid()),
    ]
    for kind, part in parts:
        record = record_of(part)
        assert part_from(kind, record) == part
        assert registry.class_of(kind, record["name"]) is type(part)
        assert name_of(part) == record["name"]
