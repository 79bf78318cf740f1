"""Laws and profiles from files: a table of what is known is what it was made of, and what is no table is refused."""

import numpy as np
import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Scene, cli
from fem_adhesion.registry import part_from, record_of
from halfspace import laws, profiles
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES
from halfspace.laws.law import require_law

EPS, WORK, R = 0.165, 23.0, 20e-9  # nm and mJ/m^2 of the law, m of the tip


def lennard_jones(h):
    return -WORK / EPS * LENNARD_JONES.pressure(h / EPS - 1, 1.0)


def written(path, x, y, head="x,y\n"):
    path.write_text(head + "".join(f"{a:.15g},{b:.15g}\n" for a, b in zip(x, y, strict=True)))
    return path


@pytest.fixture
def table(tmp_path):
    h = EPS * np.geomspace(0.7, 30, 600)
    return laws.Tabulated(written(tmp_path / "law.csv", h, lennard_jones(h), "gap (nm),tension (MPa)\n"))


def test_a_table_of_the_3_9_law_is_it(table):
    assert require_law(table) is table
    assert table.spacing == pytest.approx(EPS, rel=1e-6)
    assert table.work_of_adhesion == pytest.approx(WORK, rel=1e-6)
    H = np.array([-0.2, 0.0, 0.2, 3.0, 28.0, 300.0])  # the last beyond the table
    for name in ("pressure", "slope", "energy"):
        expected = getattr(LENNARD_JONES, name)(H, 0.7)
        size = 0.7 * LENNARD_JONES.stiffness * 1e-5
        np.testing.assert_allclose(getattr(table, name)(H, 0.7), expected, rtol=2e-3, atol=size)
    ours, known = halfspace.trace(1.0, law=table, rtol=1e-5), halfspace.trace(1.0)
    for name, event in known.events.items():
        assert ours.event(name).load == pytest.approx(event.load, abs=2e-6)
        assert ours.event(name).approach == pytest.approx(event.approach, abs=1e-5)


def test_both_solvers_agree_on_a_table(table):
    ours, theirs = halfspace.trace(0.5, law=table, rtol=1e-5), fem_adhesion.trace(Scene(0.5, law=table), rtol=1e-4)
    a, b = (path.event("pull_off") for path in (ours, theirs))
    assert abs(a.load - b.load) <= a.load_error + b.load_error


def test_a_table_of_a_sphere_is_it(tmp_path):
    """Cut short of its equator: the loads are those of a sphere without what it attracts beyond."""
    r = np.linspace(0, 15e-9, 200)
    tip = profiles.Tabulated(written(tmp_path / "tip.csv", r, 3e-9 + R - np.sqrt(R**2 - r**2)), 100.0)
    assert tip.radius == pytest.approx(R, rel=1e-7, abs=0)
    assert tip.residual < 1e-9 * r[-1]
    ours, whole = tip.surface(1.0), profiles.Sphere(100.0).surface(1.0)
    u = np.linspace(0, ours.end, 50)
    np.testing.assert_allclose(ours.height(u), whole.height(u), rtol=1e-7, atol=1e-8)
    np.testing.assert_allclose(ours.slope(u), whole.slope(u), rtol=1e-4, atol=1e-6)
    event, known = (halfspace.trace(1.0, profile=p, rtol=1e-5).event("pull_off") for p in (tip, profiles.Sphere(100.0)))
    assert event.approach == pytest.approx(known.approach, abs=1e-4)
    assert 0 < event.load - known.load < 5e-3


def test_noise_is_smoothed_and_told(tmp_path):
    r = np.linspace(0, 15e-9, 1000)
    noise = 2e-11 * np.random.default_rng(1).normal(size=r.size)
    tip = profiles.Tabulated(written(tmp_path / "tip.csv", r, r**2 / (2 * R) + noise), 100.0)
    assert tip.residual == pytest.approx(2e-11, rel=0.1, abs=0)
    assert tip.radius == pytest.approx(R, rel=0.05, abs=0)
    assert Scene(1.0, profile=tip).told[-1].endswith(f"residual {tip.residual:.2g} in the table's unit")


H = EPS * np.geomspace(0.7, 30, 300)


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (H[::12], lennard_jones(H)[::12], "of the tension between gaps"),
        (H[50:], lennard_jones(H)[50:], "limit: -"),
        (H[:120], lennard_jones(H)[:120] + 40, "it ends as gap^-"),
        (H, lennard_jones(H) - 3, "the last tension is -"),
        (H, lennard_jones(H) * np.cos(H), "the tension changes sign again, limit: once"),
        (H, -abs(lennard_jones(H)), "the largest tension is -"),
        (H[::-1], lennard_jones(H), "the first column does not rise"),
        (H[:5], lennard_jones(H)[:5], "has 5 rows, limit: 12"),
        (H - H[0], lennard_jones(H), "the first gap is 0, limit: above 0"),
        (H * np.nan, lennard_jones(H), "the first column does not rise"),
    ],
)
def test_what_is_no_law_is_refused_in_one_line(x, y, message, tmp_path, capsys):
    path = written(tmp_path / "law.csv", x, y)
    assert cli.main(["curve", "--tabor", "1", "--law", "tabulated", "--law-parameter", str(path)]) == 2
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("text", [None, "a,b\n1,2,3\n2\n", "no numbers\n"])
def test_what_is_no_table_is_refused(text, tmp_path):
    if text:
        (tmp_path / "tip.csv").write_text(text)
    with pytest.raises(InputError, match=r"tip\.csv (cannot be read|has \d+ rows)"):
        profiles.Tabulated(tmp_path / "tip.csv", 100.0)


def test_a_material_with_another_radius_than_its_tip_is_refused_in_one_line(tmp_path, capsys):
    r = np.linspace(0, 15e-9, 100)
    tip = str(written(tmp_path / "tip.csv", r, r**2 / 40e-9))
    material = ["--modulus", "70GPa", "--poisson", "0.2", "--work-of-adhesion", "50mJ/m^2", "--spacing", "0.3nm"]
    curve = ["curve", *material, "--profile", "tabulated", "--profile-parameter", tip, "--rtol", "1e-2"]
    assert cli.main([*curve, "--radius", "20.1nm"]) == 0
    assert "apex radius 2e-08" in capsys.readouterr().out
    assert cli.main([*curve, "--radius", "20.3nm"]) == 2
    err = capsys.readouterr().err
    assert "radius = 2.03e-08 m under a tip whose apex has 2e-08, limit: the same to 1 %" in err
    assert err.count("\n") == 1


def test_a_tip_that_turns_back_is_refused(tmp_path):
    r = np.linspace(0, 1, 100)
    with pytest.raises(InputError, match=r"turns back at radius 0\.7\d*, limit: a height that rises; cut it there"):
        profiles.Tabulated(written(tmp_path / "tip.csv", r, r**2 - r**4), 100.0)


def test_files_of_parts_are_recorded(table, tmp_path):
    r = np.linspace(0, 15e-9, 100)
    tip = profiles.Tabulated(written(tmp_path / "tip.csv", r, r**2), 100.0)
    for kind, part in (("law", table), ("profile", tip)):
        assert part_from(kind, record_of(part)) == part
