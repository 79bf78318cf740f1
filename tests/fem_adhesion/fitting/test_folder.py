"""Many curves at once: which, resumed, as a table, and how they differ."""

import csv
import io
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from synthetic_curves import synthetic, write

from fem_adhesion import cli
from fem_adhesion.common.files import open_store
from fem_adhesion.common.numbers import engineering
from fem_adhesion.fitting import folder
from fem_adhesion.fitting.folder import Source, code, run, sources, spreads, told, write_csv
from fem_adhesion.fitting.model import Apparatus
from fem_adhesion.report.page import fit_section
from halfspace.errors import InputError

DATA = Path(__file__).parents[2] / "data" / "afm"
READING = {"stiffness": None, "sensitivity": None}
ASKED = {"radius": 10e-9, "modulus": 1e11, "poisson": 0.3}


@pytest.fixture
def curves(tmp_path):
    made = tmp_path / "curves"
    made.mkdir()
    shutil.copy(DATA / "spectroscopy_two.nid", made)
    (made / "first.csv").write_text("piezo_m,force_N\n")
    (made / "README.md").write_text("no curve")
    return made


def test_a_folder_is_all_its_curves(curves):
    nid = curves / "spectroscopy_two.nid"
    assert sources([curves, nid]) == (Source(curves / "first.csv"), Source(nid), Source(nid, 1))
    with pytest.raises(InputError, match="no file of a force curve"):
        sources([curves / "README.md"])


def test_a_study_is_resumed_and_a_changed_file_fitted_again(curves, tmp_path, monkeypatch):
    found, calls = sources([curves]), []

    def outcome(source, *, reading, radius, **_):
        """Stand-in for a fit, which takes seconds: its pull-off force is the radius that was asked for."""
        assert reading == READING
        calls.append(source)
        return source.named | {"pull_off": {"value": radius, "unit": "N"}}

    monkeypatch.setattr(folder, "outcome", outcome)

    def fitted(**asked):
        store = open_store(tmp_path / "kept", code(), resume=True)
        return run(found, READING, ASKED | asked, store, jobs=1)

    first = fitted()
    assert fitted() == first
    assert tuple(calls) == found
    with (curves / "first.csv").open("a") as file:
        file.write("1,2\n")
    assert fitted() == first
    assert calls[3:] == [found[0]]
    assert fitted(radius=20e-9)[0]["pull_off"]["value"] == 20e-9
    assert len(calls) == 7


def test_a_curve_that_cannot_be_used_is_told_and_ends_nothing(curves):
    (bad,) = run([Source(curves / "first.csv")], READING, ASKED, jobs=1)
    assert "0 lines of data" in bad["reason"]
    assert "model" not in bad


def _fitted(value, half):
    return {
        "misfit": {"found": False},
        "spacing": {"value": value, "low": value - half, "high": value + half, "unit": "m"},
    }


def test_the_spread_between_curves_stands_beside_their_intervals():
    outcomes = [_fitted(1e-9 * (1 + i / 100), 1.96e-11) for i in range(101)]
    spacing = next(each for each in spreads(outcomes) if each["name"] == "spacing")
    assert [spacing[name] for name in ("low", "median", "high")] == pytest.approx([1.1e-9, 1.5e-9, 1.9e-9])
    assert (spacing["between"], spacing["within"]) == pytest.approx((0.34e-9, 1e-11), rel=1e-4)
    assert "spacing differs between curves by 34 times" in told(outcomes)
    assert "differs" not in told([_fitted(1e-9 * (1 + i / 100), 1.96e-9) for i in range(101)])


def test_the_table_leaves_open_ends_and_refused_curves_empty():
    spacing = {"value": 1e-9, "low": None, "high": 2e-9, "unit": "m"}
    found = {"model": "jkr", "misfit": {"found": True}, "spacing": spacing, "pull_off": {"value": 3e-9, "unit": "N"}}
    file = io.StringIO()
    write_csv([{"file": "a", "number": 0, **found}, {"file": "b", "number": 7, "reason": "no contact"}], file)
    first, second = csv.DictReader(file.getvalue().splitlines())
    assert (first["spacing_m"], first["spacing_low_m"], first["spacing_high_m"]) == ("1e-09", "", "2e-09")
    assert (first["pull_off_N"], first["model"], first["misfit"]) == ("3e-09", "jkr", "yes")
    assert (second["curve"], second["spacing_m"], second["reason"]) == ("7", "", "no contact")


CONTACT = ["--radius", "50nm", "--modulus", "10GPa", "--poisson", "0.3", "--stiffness", "5N/m"]
TRUTH = Apparatus(50e-9, 10e9, 0.05, 0.3e-9, 2e-7, 5.0, poisson=0.3)


def test_the_command_fits_what_it_can_of_a_folder(curves, tmp_path, capsys):
    table, record, kept = (tmp_path / name for name in ("fits.csv", "fits.json", "kept"))
    (curves / "spectroscopy_two.nid").unlink()
    made = {"noise": 5e-11, "correlation": 0.3, "offset": 1e-9, "count": 80}
    write(curves / "second.csv", synthetic(TRUTH, np.random.default_rng(1), **made))
    names = ["--csv", str(table), "--json", str(record), "--plot", str(tmp_path / "fits.svg"), "--resume", str(kept)]
    asked = ["fit", str(curves), *CONTACT, "--models", "jkr", "--jobs", "1", *names]
    assert cli.main(asked) == 1
    assert "1 of 2 curves fitted, 0 with a misfit" in capsys.readouterr().out
    fits, times = json.loads(record.read_text()), [file.stat().st_mtime_ns for file in (kept / "cases").iterdir()]
    refused, fitted = csv.DictReader(table.read_text().splitlines())
    assert "give more points" in refused["reason"]
    value = fits["curves"][1]["work_of_adhesion"]["value"]
    assert float(fitted["work_of_adhesion_J/m^2"]) == value == pytest.approx(TRUTH.work_of_adhesion, rel=0.05)
    assert {each["name"] for each in fits["spread"]} == {"work_of_adhesion", "spacing", "pull_off", "noise"}
    section = fit_section(record)
    assert len(section.figures) == 1
    (_, told, _, pull_off, model, misfit) = section.tables[0].rows[1]
    assert told.startswith(engineering(value, "J/m^2"))
    assert (pull_off.endswith("nN"), model, misfit) == (True, "atlas", "")
    assert "give more points" in section.tables[0].rows[0][4]
    assert cli.main(asked) == 1
    assert json.loads(record.read_text())["curves"] == fits["curves"]
    assert [file.stat().st_mtime_ns for file in (kept / "cases").iterdir()] == times


def test_the_report_refuses_what_is_no_fit(tmp_path):
    (tmp_path / "other.json").write_text('{"schema": 1}')
    for name in ("other.json", "missing.json"):
        with pytest.raises(InputError, match="is no record of a fit"):
            fit_section(tmp_path / name)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "give a file or a folder"),
        ([str(DATA / "sin_plate.ibw"), "--resume", "x"], "--resume with one curve"),
        ([str(DATA / "workshop.csv")], "give the sensitivity in m/V"),
        ([str(DATA / "workshop.csv"), "--detector", "50nm"], "unit of the wrong kind"),
        ([str(DATA / "missing")], "missing"),
    ],
)
def test_what_the_command_cannot_fit_is_one_line(arguments, words, tmp_path, monkeypatch, refused):
    monkeypatch.chdir(tmp_path)
    refused("fit", *arguments, *CONTACT, words=words)
    assert not list(tmp_path.iterdir())


def test_the_command_writes_a_fit_model(tmp_path):
    assert cli.main(["fit", "--nanite", str(tmp_path / "model_39.py"), *CONTACT]) == 0
    assert 'params.add("R", value=5e-08,' in (tmp_path / "model_39.py").read_text()
