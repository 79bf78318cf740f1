"""A tip of another shape in an assessment: each profile and mesh against what the solvers give of it apart."""

import numpy as np
import pytest
from assessed import LINE, SILICA, Said, assert_alike
from whole_runs import ROOT

import halfspace
from fem_adhesion import Hemisphere, Scene, convergence
from fem_adhesion.assess.predictions import Quantity, computed
from fem_adhesion.assess.study import assess
from fem_adhesion.common.contact import Contact
from halfspace import profiles
from halfspace.scaling import Units

UNITS, STIFFNESS = Units(100e-9, 70e9 / (1 - 0.17**2), 0.1, 0.3e-9), 0.2
MESH = ROOT / "meshes/hemisphere.msh"


def told(record, name):
    """Values of a model of the record."""
    values = next(model["values"] for model in record["models"] if model["model"] == name)
    return {quantity: Quantity(**found) for quantity, found in values.items()}


def table(folder):
    """Blunted cone as a table in nm."""
    r = np.linspace(0, 60, 300)
    rows = np.stack([r, 30**2 / 100 * (np.hypot(1, r / 30) - 1)], axis=1)
    np.savetxt(folder / "tip.csv", rows, fmt="%.17g", delimiter=",", header="r_nm,z_nm", comments="")
    return str(folder / "tip.csv")


@pytest.mark.parametrize(
    ("word", "profile"),
    [
        ("sphere", profiles.Sphere(UNITS.radius_ratio)),
        ("hyperboloid:30nm", profiles.Hyperboloid(30e-9 / UNITS.length)),
        ("tabulated:{table}", None),
    ],
)
def test_a_profile_gives_what_its_curve_does(word, profile, tmp_path):
    found = Said(f"{LINE} --profile {word.format(table=table(tmp_path))}", tmp_path)
    said = " ".join(found.text.split())
    profile = profile or profiles.Tabulated(table(tmp_path), UNITS.radius_ratio)
    path = halfspace.trace(UNITS.tabor, profile=profile, rtol=1e-7, to_load=2.0)
    truth = computed("truth", path, STIFFNESS / UNITS.stiffness, UNITS)
    assert_alike(told(found.record, "given profile"), truth.values)
    assert said.startswith("trust the given profile;")
    assert "assume a paraboloid, and the tip is given as" in said
    blunted = "hyperboloid" in word or "tabulated" in word
    assert ("no other model is within" in said) == blunted
    assert "stretching of the attracted surface" not in said


def test_a_profile_on_a_thin_sample_is_traced_on_it():
    layer = Contact(**SILICA, thickness=20e-9).layer
    profile = profiles.Hyperboloid(15.0)
    found = assess(Contact(**SILICA, thickness=20e-9, profile=profile, stiffness=STIFFNESS))
    path = halfspace.trace(UNITS.tabor, profile=profile, body=layer, rtol=1e-6, to_load=2.0)
    truth = computed("truth", path, STIFFNESS / UNITS.stiffness, UNITS)
    assert_alike(found.finite.values, truth.values)
    assert [model.model for model in found.models[:3]] == ["half-space", "given profile", "thin sample"]
    assert found.sample is None  # Hertz's theory and the series know no such tip


def test_the_mesh_of_a_hemisphere_is_the_hemisphere(tmp_path):
    record = Said(f"{LINE} --mesh {MESH}", tmp_path).record
    body = Hemisphere(radius_ratio=UNITS.radius_ratio, poisson=0.17)
    path = convergence.trace(Scene(UNITS.tabor, body), rtol=1e-4, to_load=2.0)
    assert_alike(told(record, "mesh"), computed("truth", path, STIFFNESS / UNITS.stiffness, UNITS).values)
    assert record["input"]["mesh"] == str(MESH)


def test_the_spread_of_a_radius_keeps_the_length_of_the_tip(tmp_path):
    """The cone's length stays 30 nm while the radius and the unit of length vary: a difference of two curves."""
    spread = Said(f"{LINE} --radius 100+-10nm --profile hyperboloid:30nm", tmp_path).record["spreads"]
    forces = []
    for R in (97.5e-9, 102.5e-9):
        units = Units(R, UNITS.modulus, 0.1, 0.3e-9)
        path = halfspace.trace(units.tabor, profile=profiles.Hyperboloid(30e-9 / units.length), rtol=1e-6)
        forces.append(-path.events["pull_off"].load * units.load)
    assert spread["model"] == "given profile"
    found = spread["quantities"]["pull_off_force"]["deviation"]
    assert found == pytest.approx(abs(forces[1] - forces[0]) * 2, rel=1e-4)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("--profile power:3 --grip bonded", "--grip would have no effect, limit: without --profile"),
        ("--profile power:3 --counter-radius 1um", "does not go with another round body"),
        (f"--profile power:3 --mesh {MESH}", "does not go with a mesh, which has its own surface"),
        (f"--mesh {MESH} --thickness 9nm", "does not go with another body or a thin sample"),
        (f"--mesh {MESH} --modulus 70MPa", "limit: 0 <= tabor <= 10 with --mesh"),
        (f"--mesh {MESH} --poisson 0.2+-0.01", "poisson has a standard deviation, limit: none with --mesh"),
        ("--profile power:3 --modulus 0.1MPa", "<= tabor <= 300 with --profile"),
        ("--profile tabulated:{table} --radius 90nm", "apex has 100 in its table's unit"),
        ("--profile tabulated:{table} --radius 100+-9nm", "limit: none with a tip's table"),
    ],
)
def test_what_does_not_go_with_a_shape_is_refused_in_a_line(more, words, tmp_path, refused):
    refused("assess", LINE, more.format(table=table(tmp_path)), words=words)
