"""Files of makers: three of the tests of afmformats 0.18.7, two curves of an example of NSFopen 2.2.4, both MIT."""

import sys
from pathlib import Path

import numpy as np
import pytest

from fem_adhesion.fitting import makers
from fem_adhesion.fitting.measured import count, read
from fem_adhesion.fitting.prepare import prepare
from halfspace.errors import InputError

DATA = Path(__file__).parents[2] / "data" / "afm"


@pytest.fixture(autouse=True)
def _opened_anew():
    makers._loaded.cache_clear()


@pytest.mark.parametrize(
    ("name", "number", "stiffness", "pull_off"),
    [
        ("sin_plate.ibw", 0, 1.184, 12.8e-9),
        ("spot3.jpk-force", 0, 0.0435, 0.414e-9),
        ("spectroscopy_two.nid", 0, 2.724, 10.4e-9),
        ("spectroscopy_two.nid", 1, 2.724, None),
    ],
)
def test_a_makers_file_is_read(name, number, stiffness, pull_off):
    curve = read(DATA / name, number=number)
    found = prepare(curve)
    assert curve.stiffness == pytest.approx(stiffness, rel=1e-3)
    for way, part in ((1, curve.approach), (-1, curve.retract)):
        ends = curve.travel[part][[0, -1]] - found.contact
        assert way * ends[0] < 0 < way * ends[1]
        assert np.argmax(curve.force[part]) == pytest.approx((0, curve.travel[part].size)[way > 0], abs=20)
    if pull_off:
        assert found.pull_off == pytest.approx(pull_off, rel=0.02)


def test_the_curves_of_a_file_are_counted():
    path = DATA / "spectroscopy_two.nid"
    assert count(path) == 2
    assert not np.array_equal(read(path).force[:100], read(path, number=1).force[:100])
    with pytest.raises(InputError, match="limit: 0 to 1"):
        read(path, number=2)


@pytest.mark.parametrize("name", ["sin_plate.ibw", "spectroscopy_two.nid"])
def test_a_stiffness_of_ones_own_scales_the_force(name):
    own = read(DATA / name)
    assert read(DATA / name, stiffness=2 * own.stiffness).force == pytest.approx(2 * own.force)


def test_a_file_in_volts_asks_for_what_it_lacks():
    path = DATA / "workshop.csv"
    with pytest.raises(InputError, match="give the stiffness in N/m and sensitivity in m/V"):
        read(path)
    rows = [line.split(",") for line in path.read_text().splitlines()[11:] if line.strip()]
    volts = [float(row[column]) for row in rows for column in (1, 3)]
    curve = read(path, stiffness=0.05, sensitivity=50e-9)
    assert np.ptp(curve.force) == pytest.approx(0.05 * 50e-9 * np.ptp(volts))


@pytest.mark.parametrize("name", ["broken.ibw", "broken.jpk-force", "broken.nid", "missing.nid"])
def test_a_damaged_file_is_refused_in_one_line(name, tmp_path, capfd):
    if name.startswith("broken"):
        (tmp_path / name).write_bytes(bytes(range(256)))
    with pytest.raises(InputError) as refused:
        read(tmp_path / name)
    assert "\n" not in str(refused.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(("name", "extra"), [("sin_plate.ibw", "afm"), ("spectroscopy_two.nid", "nanosurf")])
def test_a_missing_library_is_named_with_its_extra(name, extra, monkeypatch):
    for library in ("afmformats", "NSFopen", "NSFopen.read"):
        monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(InputError, match=rf"pip install '\.\[{extra}\]' in a clone"):
        read(DATA / name)
