"""``fem-adhesion finite-sphere`` whole: its quick form read back, its exit codes, and how it ends when it is ended."""

import json
import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from html import unescape

import pytest
from page_tables import rows_of
from processes import PATIENCE, alive, started, wait_until

from fem_adhesion import cli
from fem_adhesion.finite_sphere import page as finite_sphere_page
from fem_adhesion.finite_sphere.cases import CRITICAL, MODELS
from halfspace.errors import ContactTooWide
from halfspace.values import Estimate

QUICK = "fem-adhesion finite-sphere --out sphere --quick"
TABLES = ("safe", "first_jumps", "fits", "theories", "bulk", "failures", "captions")


@pytest.fixture(scope="module")
def quick(whole):
    done = whole(QUICK)
    assert done.code == 0, done.err
    return done


# --- the quick form ---


def test_the_quick_study_says_that_it_is_one_and_how_it_went(quick):
    first = quick.out.splitlines()[0]
    assert re.fullmatch(r"quick study, of few points; (\d+) cases, all solved", first)
    assert int(re.search(r"(\d+) cases", first)[1]) == len(list((quick / "sphere/cases").iterdir()))
    page = (quick / "sphere/index.html").read_text()
    assert {file.stem for file in (quick / "sphere").glob("*.csv")} == {"finite_sphere", *TABLES}
    assert f"<strong>{first}.</strong>" in page
    assert f"<p>To repeat: <code>{QUICK}</code></p>" in page
    assert first in (quick / "sphere/chart.svg").read_text()


def test_the_table_holds_what_the_solvers_give(quick):
    table = {
        (row["cause"], row["quantity"], row["tabor"], row["radius_ratio"]): row
        for row in rows_of(quick / "sphere/finite_sphere.csv")
    }
    row = table["all", "pull_off_load", "1.0", "300.0"]
    stored = [json.loads(file.read_text()) for file in (quick / "sphere/cases").iterdir()]
    values = {(c["inputs"]["model"], c["inputs"]["tabor"], c["inputs"]["radius_ratio"]): c["result"] for c in stored}
    for column, key in (("value", ("sphere", 1.0, 300.0)), ("half_space", ("half_space", 1.0, None))):
        kept = values[key]["values"]["pull_off_load"]
        assert (float(row[column]), float(row[f"{column}_error"])) == (kept["value"], kept["error"])
    assert float(row["half_space"]) == pytest.approx(-5.2488, abs=1e-3)


def test_the_border_of_the_jumps_is_solved_for(quick):
    found = {line["R/eps"]: line for line in rows_of(quick / "sphere/first_jumps.csv")}
    assert set(found) == {"half-space", "30", "300", "3000"}
    assert float(found["half-space"]["mu"]) == pytest.approx(0.697214622, abs=float(found["half-space"]["error"]))
    tabors = [float(found[ratio]["mu"]) for ratio in ("30", "300", "3000", "half-space")]
    assert tabors == sorted(tabors, reverse=True)
    assert all(0 < float(line["error"]) < 1e-4 for line in found.values())


def test_a_figure_is_drawn_or_says_what_it_lacks(quick):
    page = (quick / "sphere/index.html").read_text()
    for line in rows_of(quick / "sphere/captions.csv"):
        drawn = (quick / f"sphere/{line['figure']}.svg").exists()
        assert drawn == bool(line["caption"]) == (not line["why not drawn"])
        assert drawn == (quick / f"sphere/{line['figure']}.png").exists()
        assert (f'<figure id="{line["figure"]}">' in page) == drawn
    assert "Not drawn: no point was solved at two Poisson's ratios." in unescape(page)


# --- exit codes ---


def made(case):
    if case.model.startswith("first_jump"):
        return {CRITICAL: Estimate(0.7, 1e-3)}
    return {"pull_off_load": Estimate(-5.0, 1e-3)}


@pytest.fixture
def made_up(monkeypatch):
    """Models that cost nothing, and a page of one picture, which lacks its data; the quick form has all of them."""
    (picture,) = (picture for picture in finite_sphere_page.PICTURES if picture.stem == "poisson")
    monkeypatch.setattr(finite_sphere_page, "PICTURES", (picture,))
    for name, model in MODELS.items():
        monkeypatch.setitem(MODELS, name, replace(model, solve=made))


STUCK = "bonded is stuck; try another"


def refuse(_):
    raise ContactTooWide(STUCK)


ONE = ("finite-sphere", "--tabor", "0.3", "--radius-ratio", "30", "--jobs", "1")


@pytest.mark.usefixtures("made_up")
def test_a_study_that_failed_in_part_says_so(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(MODELS, "bonded", replace(MODELS["bonded"], solve=refuse))
    assert cli.main([*ONE, "--out", str(tmp_path / "out")]) == 1
    said = f"1 of {len(MODELS)} cases not solved (1 ContactTooWide)"
    assert capsys.readouterr().out.startswith(said)
    assert f"<strong>{said}.</strong>" in (tmp_path / "out/index.html").read_text()
    (line,) = rows_of(tmp_path / "out/failures.csv")
    assert [line[name] for name in ("status", "kind", "reason")] == ["refused", "ContactTooWide", STUCK]
    rows = rows_of(tmp_path / "out/finite_sphere.csv")
    assert {(row["status"], row["kind"]) for row in rows if row["cause"] == "grip"} == {("refused", "ContactTooWide")}


@pytest.mark.usefixtures("made_up")
def test_what_is_beyond_the_limits_is_left_out_and_listed(tmp_path, capsys):
    arguments = ["--tabor", "1", "10", "--radius-ratio", "5", "--jobs", "1", "--out", str(tmp_path / "out")]
    assert cli.main(["finite-sphere", *arguments]) == 0
    left = len([model for model in MODELS.values() if {"tabor", "radius_ratio"} <= set(model.inputs)])
    left += 1  # finite_strain_normal, at tabor 1, too
    assert f"{left} cases left out, beyond the limits" in capsys.readouterr().out
    lines = rows_of(tmp_path / "out/failures.csv")
    assert len(lines) == left
    assert {line["status"] for line in lines} == {"left out"}
    assert sum("tabor 10, R/eps 5" in line["case"] for line in lines) == left - 1


@pytest.mark.usefixtures("made_up")
def test_a_figure_of_an_earlier_study_does_not_stay(tmp_path):
    (tmp_path / "poisson.svg").write_text("old")
    (tmp_path / "notes.txt").write_text("mine")
    assert cli.main([*ONE, "--out", str(tmp_path), "--force"]) == 0
    assert not (tmp_path / "poisson.svg").exists()
    assert (tmp_path / "notes.txt").exists()


@pytest.mark.usefixtures("made_up")
def test_cases_may_be_kept_elsewhere(tmp_path, capsys):
    line = [*ONE, "--out", str(tmp_path / "out"), "--resume", str(tmp_path / "kept")]
    assert cli.main(line) == 0
    assert [file.name for file in (tmp_path / "kept").iterdir()] == ["cases"]
    assert not (tmp_path / "out/cases").exists()
    assert cli.main(line) == 2
    assert f"{tmp_path / 'out'} holds" in capsys.readouterr().err
    kept = {file: file.stat().st_mtime_ns for file in (tmp_path / "kept/cases").iterdir()}
    assert cli.main([*line, "--force"]) == 0
    assert {file: file.stat().st_mtime_ns for file in (tmp_path / "kept/cases").iterdir()} == kept


@pytest.fixture
def interruptible():
    """What a shell without job control starts in the background ignores SIGINT, and so would the study."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_a_signal_ends_the_study_and_its_workers(tmp_path):
    """What is done is kept, and --resume goes on with it; the other signal is held by the next test."""
    command = ["finite-sphere", "--out", str(tmp_path / "out"), "--tabor", "0.3", "3", "--radius-ratio", "1000"]
    line = [sys.executable, "-m", "fem_adhesion", *command, "--jobs", "2"]
    with started(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as study:
        wait_until(lambda: list(tmp_path.glob("out/cases/[!.]*.json")) or study.poll() is not None)
        assert study.poll() is None
        os.killpg(study.pid, signal.SIGINT)
        out, error = study.communicate(timeout=PATIENCE)
        wait_until(lambda: not alive(study.pid))
    assert study.returncode == 130
    assert out == ""
    assert (
        error.strip()
        == f"fem-adhesion: interrupted; what is done is kept in {tmp_path / 'out'}, --resume {tmp_path / 'out'} goes on"
    )
    assert not (tmp_path / "out/index.html").exists()
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["cases"]


def test_a_signal_ends_any_command(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", lambda *_: os.kill(os.getpid(), signal.SIGTERM))
    before = signal.getsignal(signal.SIGTERM)
    assert cli.main(["curve", "--tabor", "1", "--json", str(tmp_path / "curve.json")]) == 143
    assert capsys.readouterr().err.strip().endswith("fem-adhesion: terminated; nothing was written")
    assert signal.getsignal(signal.SIGTERM) is before
    assert not list(tmp_path.iterdir())
