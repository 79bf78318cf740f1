"""Laws and profiles from files: a table of what is known is what it was made of, and what is no table is refused."""

import numpy as np
import pytest
from agreement import differing
from truths import relocated, under_surface

import halfspace
from fem_adhesion import Scene, cli
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


def test_a_curve_of_a_tabulated_tip_is_within_its_errors(tmp_path):
    """Errors fell by less from grid to grid than those of smooth profiles: loads were 1.3 to 2.2 times outside."""
    r = np.linspace(0, 3, 100)
    cone = profiles.Hyperboloid(1 / np.sqrt(3))
    tip = profiles.Tabulated(written(tmp_path / "tip.csv", r, cone.height(r)), 100.0)
    path = halfspace.trace(1.0, profile=tip, rtol=1e-9)
    rough, best = relocated(path.stages[-1], under_surface(1.0, tip.surface(1.0)))
    for name, event in path.events.items():
        known = abs(best[name].point.observables - rough[name].point.observables)
        off = abs(np.array([event.approach, event.load]) - best[name].point.observables[:2])
        assert (off <= np.array([event.approach_error, event.load_error]) + known[:2]).all(), name


def tips(tmp_path, heights, noise, count):
    """Tips by tables of as many rows, each with noise of its own."""
    r = np.linspace(0, 15e-9, count)
    for seed in range(40):
        z = heights(r) + noise * np.random.default_rng(seed).normal(size=count)
        yield profiles.Tabulated(written(tmp_path / "tip.csv", r, z), 100.0)


@pytest.mark.parametrize("heights", [lambda r: r**2 / (2 * R), lambda r: R - np.sqrt(R**2 - r**2)])
def test_noise_is_smoothed_and_told(heights, tmp_path):
    """Noise of a tenth of eps in 200 rows: no table's apex is lost in it, and the error told holds the truth."""
    found = list(tips(tmp_path, heights, 2e-11, 200))
    off = np.array([abs(tip.radius - R) for tip in found])
    told = np.array([tip.radius_error for tip in found])
    assert np.quantile(off, 0.9) < 0.06 * R
    assert np.mean(off <= told) >= 0.95
    assert np.median(told) < 0.1 * R
    assert np.mean([tip.residual for tip in found]) == pytest.approx(2e-11, rel=0.05, abs=0)
    tip, eps = found[0], found[0].radius / 100
    told_last = Scene(1.0, profile=tip).words[-1]
    assert f"apex radius {tip.radius:.6g} +- {tip.radius_error:.1g} in the table's unit" in told_last
    assert told_last.endswith(f"residual {tip.residual / eps:.2g} eps")


def test_a_tip_whose_apex_the_table_does_not_tell_is_refused(tmp_path):
    r = np.linspace(10e-9, 15e-9, 30)
    z = r**2 / (2 * R) + 2e-10 * np.random.default_rng(1).normal(size=r.size)
    with pytest.raises(InputError, match=r"the apex radius is .* \+- .*, limit: an error below it"):
        profiles.Tabulated(written(tmp_path / "tip.csv", r, z), 100.0)


def test_a_tip_with_its_columns_exchanged_is_refused(tmp_path):
    """A root of the radius rises with a vertical tangent, and falls behind it; noise changes nothing of that."""
    r, noise = np.linspace(0, 15e-9, 200), np.random.default_rng(5).normal(0, 1e-11, 200)
    for z in (r**2 / (2 * R), R - np.sqrt(R**2 - r**2), R / 4 * (np.sqrt(1 + 4 * (r / R) ** 2) - 1)):
        assert profiles.Tabulated(written(tmp_path / "tip.csv", r, z), 100.0).radius == pytest.approx(R, rel=1e-3)
        profiles.Tabulated(written(tmp_path / "tip.csv", r, z + noise), 100.0)
        for rows in (z, np.sort(np.abs(z + noise))):
            with pytest.raises(InputError, match=r"it rises by .* near the axis, .*limit: .* in the first column"):
                profiles.Tabulated(written(tmp_path / "tip.csv", rows, r), 100.0)


@pytest.mark.parametrize("nearly", [0.0, -1e-17])
def test_a_row_without_tension_is_equilibrium(nearly, tmp_path):
    h = EPS * np.append(np.linspace(0.8, 0.99, 20), np.geomspace(1.0, 30, 600))
    tension = np.where(h == EPS, nearly, lennard_jones(h))
    law = require_law(laws.Tabulated(written(tmp_path / "law.csv", h, tension)))
    assert law.spacing == pytest.approx(EPS, rel=1e-14)
    metres = laws.Tabulated(written(tmp_path / "law.csv", h * 1e-9, tension))
    assert metres.spacing == pytest.approx(EPS * 1e-9, rel=1e-14, abs=0)


def test_a_table_that_ends_with_zeros_ends_at_the_first_of_them(tmp_path):
    """Nothing acts farther out; what is left there of the 3-9 law's work of adhesion, h^-2 4/3, is not its own."""
    h, cut = EPS * np.geomspace(0.7, 30, 600), 10 * EPS
    tension = np.where(h < cut, lennard_jones(h), 0.0)
    law = require_law(laws.Tabulated(written(tmp_path / "law.csv", h, tension)))
    end = h[h >= cut][0]
    assert law.work_of_adhesion == pytest.approx(WORK * (1 - 4 / 3 / 10**2), rel=1e-4)
    beyond = np.array([1.0, 1.01, 100.0]) * end / law.spacing - 1
    for values in (law.pressure, law.slope, law.energy):
        np.testing.assert_allclose(values(beyond, 0.7), 0.0, rtol=0, atol=1e-12)
    assert law.decay == np.inf
    once = laws.Tabulated(written(tmp_path / "once.csv", h[h <= end], tension[h <= end]))
    np.testing.assert_array_equal(once.pressure(H, 1.0), law.pressure(H, 1.0))
    rough, fine = (halfspace.trace(0.5, law=law, rtol=rtol) for rtol in (1e-2, 1e-5))
    assert rough.met
    assert differing(rough, fine, ["load"]) == []


def with_valley(tmp_path, place, width):
    """A table of the 3-9 law with a valley about a gap."""
    h = np.append(np.linspace(0.753, 4, 131), np.geomspace(4.05, 60, 60))
    tension = (h**-3 - h**-9) * (1 - 0.95 * np.exp(-(((h - place) / width) ** 2)))
    return laws.Tabulated(written(tmp_path / "law.csv", h, tension))


def test_a_narrow_valley_is_resolved_or_refused_before_any_work(tmp_path):
    """On cells as long as the 3-9 law's the curve wound once for each node, at Tabor parameter 3 without an end."""
    law = with_valley(tmp_path, 1.7, 0.25)
    events = halfspace.trace(2.0, law=law, rtol=1e-1).events
    assert list(events) == ["pull_off", "jump_on", "fold_2", "fold_3", "jump_off", "zero_load"]
    with pytest.raises(InputError, match=r"rises again at H = 1.07.* limit: 60; take a smaller tabor than 3"):
        halfspace.trace(3.0, law=law, rtol=1e-2)


def test_estimates_hold_where_the_third_derivative_leaps(tmp_path):
    """Errors fall as a power of the nodes: a pair more leaves so much that jumps were 2.3 times outside at 1e-5."""
    law = with_valley(tmp_path, 2.5, 0.7)
    path, truth = (halfspace.trace(3.0, law=law, rtol=rtol) for rtol in (1e-5, 1e-8))
    for name, event in path.events.items():
        for quantity in ("approach", "load"):
            ours, best = (one.estimate(quantity) for one in (event, truth.event(name)))
            assert abs(ours.value - best.value) <= ours.error + 0.1 * best.error


def test_what_a_table_leaves_open_is_told(tmp_path):
    """Between its rows the spline is off from the law that it was made of by about that; a hole is found."""
    count = 100
    h = EPS * np.geomspace(0.7, 30, count)
    law = laws.Tabulated(written(tmp_path / "law.csv", h, lennard_jones(h)))
    between = h[:-1] + np.diff(h) * np.linspace(0, 1, 9)[1:-1, None]
    off = np.abs(law._tension(between) - lennard_jones(between))
    assert 0.5 < law.open_between_rows.max() / off.max() < 5
    first = count // 7  # of the rows left out, at about 1.2 eps
    rows = np.delete(np.arange(count), np.arange(first, first + 2))
    holed = laws.Tabulated(written(tmp_path / "holed.csv", h[rows], lennard_jones(h[rows])))
    assert f"of the tension open between gaps {h[first - 1]:.4g} and {h[first + 2]:.4g}" in holed.findings[-1]


H = EPS * np.geomspace(0.7, 30, 300)


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (H[::12], lennard_jones(H)[::12], "of the tension between gaps"),
        (H[50:], lennard_jones(H)[50:], "limit: -"),
        (H[:120], lennard_jones(H)[:120] + 40, "it ends as gap^-"),
        (H, lennard_jones(H) - 3, "the last tension is -"),
        (H, np.where(abs(H - EPS) < 0.05 * EPS, 0, lennard_jones(H)), "no tension from gap 0.158"),
        (H, np.where(H < EPS, 0, lennard_jones(H)), "the first tension is 0, limit: -"),
        (H, 0 * H, "the largest tension is 0, limit: above 0"),
        (H, lennard_jones(H) * np.cos(H), "the tension changes sign again, limit: once"),
        (H, -abs(lennard_jones(H)), "the largest tension is -"),
        (H[::-1], lennard_jones(H), "line 3: the first column goes from 4.95 to 4.88818, limit: ascending"),
        (H - H[0], lennard_jones(H), "the first gap is 0, limit: above 0"),
        (H, np.where(H > EPS, lennard_jones(H), np.nan), "law.csv, line 2: '0.1155,nan', limit: two finite numbers"),
        (H, -lennard_jones(H), "begin in the core, where the surfaces repel and the tension is negative"),
    ],
)
def test_what_is_no_law_is_refused_in_one_line(x, y, message, tmp_path, refused):
    refused(f"curve --tabor 1 --law tabulated:{written(tmp_path / 'law.csv', x, y)}", words=message)


ROWS = "".join(f"{r},{r**2 / 8}\n" for r in range(20))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, r"tip\.csv cannot be read: No such file or directory, limit: a file"),
        ("a,b\n1,2,3\n2\n", r"tip\.csv has 2 rows, limit: 12, of two numbers"),
        ("no numbers\n", r"tip\.csv, line 1: 'no numbers', limit: two numbers with a comma between"),
        (ROWS.replace(",", ";"), r"tip\.csv, line 20: '19;45.125', limit: two numbers with a comma .*; save it as CSV"),
        (ROWS + "# 20\n", r"tip\.csv, line 21: '# 20', limit: two finite numbers; mend it or leave it out"),
        (ROWS + "20,\n", r"tip\.csv, line 21: '20,', limit"),
    ],
)
def test_what_is_no_table_is_refused(text, message, tmp_path):
    if text:
        (tmp_path / "tip.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        profiles.Tabulated(tmp_path / "tip.csv", 100.0)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
def test_a_header_may_be_of_any_letters(encoding, tmp_path):
    (tmp_path / "tip.csv").write_bytes(("Radius (µm),Höhe (µm)\n" + ROWS).encode(encoding))
    assert profiles.Tabulated(tmp_path / "tip.csv", 100.0).radius == pytest.approx(4.0)


R_IN_M = np.linspace(0, 15e-9, 100)
CURVE = "curve --modulus 70GPa --poisson 0.2 --work-of-adhesion 50mJ/m^2 --spacing 0.3nm --rtol 1e-2"


def test_a_material_has_the_radius_of_its_tip(tmp_path, capsys, refused):
    tip = f"--profile tabulated:{written(tmp_path / 'tip.csv', R_IN_M, R_IN_M**2 / 40e-9)}"
    words = "radius = 20.3 nm under a tip whose apex has 2e-08 in its table's unit, limit: the same to 1 %"
    refused(CURVE, tip, "--radius 20.3nm", words=words)
    assert cli.main(f"{CURVE} {tip} --radius 20.1nm".split()) == 0
    assert "apex radius 2e-08" in capsys.readouterr().out


def test_a_tip_in_another_unit_is_refused_with_the_factor(tmp_path, refused):
    """In nm, say: with that in its header the same command runs."""
    file = written(tmp_path / "tip.csv", R_IN_M * 1e9, R_IN_M**2 / 40e-9 * 1e9)
    curve = CURVE, "--radius 20nm", f"--profile tabulated:{file}"
    said = refused(*curve, words="the table in m; multiply both columns by 1e-09")
    assert "--radius" not in said
    rows = file.read_text()
    for header, units in (("r_nm,z_um", "nm and um"), ("r_A,z_A", "A"), ("r_nm,z_furlong", "nm and furlong")):
        file.write_text(f"{header}\n{rows}")
        refused(*curve, words=f"has {units} in its header, limit: one unit")
    file.write_text(f"r_nm,z_nm\n{rows}")
    assert cli.main(" ".join(curve).split()) == 0


def test_a_tip_that_turns_back_is_refused(tmp_path):
    r = np.linspace(0, 1, 100)
    with pytest.raises(InputError, match=r"turns back at radius 0\.7\d*, limit: a height that rises; cut it there"):
        profiles.Tabulated(written(tmp_path / "tip.csv", r, r**2 - r**4), 100.0)
