"""``fem-adhesion curve --stress``: the stress inside as numbers, held against Boussinesq's point loads and the law."""

import csv
import io

import numpy as np
import pytest

import halfspace
from fem_adhesion import cli
from fem_adhesion.common import record

STRESS = ("rr", "zz", "hoop", "rz")


def _table(capsys, *arguments):
    assert cli.main(["curve", "--rtol", "1e-3", *arguments]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_on_the_axis_it_is_that_of_point_loads(capsys):
    found = _table(capsys, "--tabor", "1", "--solver", "fem", "--stress", "axis", "-", "--at", "jump_on")
    deep = found["depth_beta"] > 0.5  # there the rings' loads are as good as point loads
    located = halfspace.trace(1.0).stages[-1]["jump_on"]
    acting = located.problem.operator_at(located.point.x)
    pressure, z = located.problem.pressure(located.point.x), found["depth_beta"][deep, None]
    loads, radii = acting.weights * pressure, acting.radii
    zz = -np.sum(3 * loads * z**3 / (2 * np.pi * (radii**2 + z**2) ** 2.5), axis=1)  # Johnson (1985), eq. 3.19
    error = found["stress_error_dgamma_per_mu_eps"][deep]
    assert np.all(np.abs(found["stress_zz_dgamma_per_mu_eps"][deep] - zz) < 2 * error + 1e-5)
    assert error.max() < 3e-3 * np.abs(pressure).max()


def test_a_file_of_points_in_si_is_the_line_again(capsys, tmp_path):
    scene = ("--radius", "100nm", "--modulus", "1GPa", "--poisson", "0.3", "--work-of-adhesion", "50mJ/m^2")
    scene = (*scene, "--spacing", "0.3nm", "--body", "hemisphere", "--rtol", "1e-2")
    line = _table(capsys, *scene, "--stress", "surface", "-")
    points = tmp_path / "points.csv"
    rows = zip(line["r_m"] * 1e9, line["depth_m"] * 1e9, strict=True)
    points.write_text("r_nm,depth_nm\n" + "\n".join(f"{r:.17g},{d:.17g}" for r, d in rows))
    again = _table(capsys, *scene, "--stress", str(points), "-")
    for name in STRESS:
        unit = np.abs(line[f"stress_{name}_Pa"]).max()
        assert again[f"stress_{name}_Pa"] == pytest.approx(line[f"stress_{name}_Pa"], abs=1e-6 * unit)


def test_a_table_beside_that_of_the_curve_has_a_record_of_its_own(tmp_path):
    curve, stress = tmp_path / "curve.csv", tmp_path / "stress.csv"
    arguments = ("--tabor", "0.1", "--solver", "fem", "--rtol", "1e-2", "--csv", str(curve))
    assert cli.main(["curve", *arguments, "--stress", "axis", str(stress)]) == 0
    for table in (curve, stress):
        assert record.beside(table).exists()
        assert f"--stress axis {stress}" in record.read(table)["command"]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("r_beta,depth_beta\n0,-1\n", "outside the mesh"),
        ("r_nm,depth_nm\n0,1\n", "limit: beta"),
        ("r,z\n0,1\n", "no column r"),
        ("r_beta,depth_beta\n0,deep\n", "no number"),
    ],
)
def test_points_that_are_none_are_refused(refused, tmp_path, text, why):
    points = tmp_path / "points.csv"
    points.write_text(text)
    out = tmp_path / "stress.csv"
    refused("curve", "--tabor", "1", "--solver", "fem", "--stress", points, out, words=why)
    assert not out.exists()
