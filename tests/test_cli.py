import json
import os
import subprocess
import sys

import pytest

from fem_adhesion import cli
from fem_adhesion.output.files import written_aside
from halfspace.errors import NotConverged


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "fem_adhesion.cli", *arguments], capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    file = tmp_path_factory.mktemp("record") / "record.json"
    done = run("compare", "--tabor", "0.5", "1", "--poisson", "0.2", "--rtol", "1e-3", "--json", str(file))
    return done, json.loads(file.read_text()), file


def test_agreement_exits_with_0_and_prints_a_table_for_each_value(compared):
    done, _, _ = compared
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("poisson 0.2: agree") == 2
    assert "verdict: agree" in done.stdout
    assert "pull_off load" in done.stdout
    assert "unknowns" in done.stdout


def test_the_record_has_all_it_promises(compared):
    _, record, _ = compared
    assert record["verdict"] == "agree"
    assert set(record["versions"]) == {"python", "fem-adhesion", "numpy", "scipy", "scikit-fem"}
    flat, folded = record["cases"]
    assert set(flat) == {"tabor", "poisson", "verdict", "halfspace", "finite_element", "comparison"}
    assert set(flat["halfspace"]["events"]) == {"pull_off"}
    for side in ("halfspace", "finite_element"):
        assert set(folded[side]) == {"events", "unknowns", "seconds", "settings"}
        assert set(folded[side]["events"]) == {"pull_off", "jump_on", "jump_off"}
        for event in folded[side]["events"].values():
            assert set(event) == {"approach", "load", "central_gap", "contact_radius", "approach_error", "load_error"}
    assert folded["halfspace"]["events"]["jump_on"]["contact_radius"] is None
    keys = {"quantity", "halfspace", "finite_element", "difference", "error", "budget", "verdict"}
    assert all(keys <= set(row) for row in folded["comparison"])
    quantities = {row["quantity"] for row in folded["comparison"]}
    assert {"operator: Hertz", "cross-residual: jump_off", "jump_on central_gap", "energy released"} <= quantities


def test_nothing_else_is_left_beside_the_record(compared):
    _, _, file = compared
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tabor", "0"], "tabor = 0 is outside 0 < tabor"),
        (["--tabor", "nan"], "tabor = nan"),
        (["--tabor", "1", "inf"], "tabor = inf"),
        (["--tabor"], "argument --tabor: expected at least one argument"),
        (["--tabor", "soft"], "invalid float value: 'soft'"),
        (["--poisson", "0.5"], "poisson = 0.5 is outside 0 <= poisson < 0.5"),
        (["--poisson", "-0.1"], "poisson = -0.1"),
        (["--rtol", "1e-10"], "rtol = 1e-10 is outside 1e-9 <= rtol <= 1e-1"),
        (["--rtol", "nan"], "rtol = nan"),
        (["--json", "/no/such/folder/record.json"], "cannot be written"),
        (["--json", "."], "is a directory; give the name of a file"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_any_work(arguments, message):
    done = run("compare", *arguments)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


@pytest.mark.parametrize("command", ["speed", "hard", "greenwood"])
def test_an_output_that_is_in_use_or_cannot_be_written_is_refused_before_any_work(command, tmp_path):
    (tmp_path / "precious").write_text("kept")
    for out, message in ((tmp_path, "use --force"), ("/no/such/place", "cannot be written")):
        done = run(command, "--out", str(out))
        assert done.returncode == 2
        assert message in done.stderr
        assert done.stderr.count("\n") == 1
    assert [file.name for file in tmp_path.iterdir()] == ["precious"]


def test_no_command_is_refused():
    done = run()
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_disagreement_exits_with_1(monkeypatch, capsys):
    """An elastic body twice as stiff: the finite elements solve another problem."""
    from fem_adhesion import elasticity

    original = elasticity.elastic_matrix
    monkeypatch.setattr(elasticity, "elastic_matrix", lambda nu: 2 * original(nu))
    assert cli.main(["compare", "--tabor", "0.5", "--rtol", "1e-2"]) == 1
    assert "verdict: disagree" in capsys.readouterr().out


def test_a_failure_is_reported_with_its_reason_and_exits_with_1(monkeypatch, capsys, tmp_path):
    from fem_adhesion.studies import crosscheck
    from halfspace.errors import NotConverged

    def fail(*_args, **_kwargs):
        raise NotConverged("on purpose; try another day")

    monkeypatch.setattr(crosscheck, "compare", fail)
    file = tmp_path / "record.json"
    assert cli.main(["compare", "--tabor", "0.5", "--rtol", "1e-2", "--json", str(file)]) == 1
    assert "failed: on purpose; try another day" in capsys.readouterr().out
    record = json.loads(file.read_text())
    assert record["cases"][0] == {
        "tabor": 0.5,
        "poisson": 0.3,
        "verdict": "failed",
        "reason": "on purpose; try another day",
    }


def test_an_interrupt_leaves_no_file(monkeypatch, tmp_path, capsys):
    from fem_adhesion.studies import crosscheck

    def interrupt(*_args, **_kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(crosscheck, "run", interrupt)
    assert cli.main(["compare", "--tabor", "0.5", "--json", str(tmp_path / "record.json")]) == 130
    assert list(tmp_path.iterdir()) == []
    assert "interrupted; nothing was written" in capsys.readouterr().err


def test_a_file_keeps_its_old_content_until_the_new_one_is_whole(tmp_path):
    file = tmp_path / "record.json"
    file.write_text("old")
    with pytest.raises(ZeroDivisionError), written_aside(file) as aside:
        aside.write(f"half {1 / 0}")
    assert file.read_text() == "old"
    with written_aside(file) as aside:
        aside.write("new")
    assert file.read_text() == "new"
    assert list(tmp_path.iterdir()) == [file]
    mask = os.umask(0)
    os.umask(mask)
    assert file.stat().st_mode & 0o777 == 0o666 & ~mask


def test_help_does_not_load_the_solvers():
    code = (
        "import sys; from fem_adhesion import cli\n"
        "try: cli.main(['--help'])\nexcept SystemExit: pass\n"
        "print([m for m in ('skfem', 'numpy', 'scipy', 'rich') if m in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "compare" in done.stdout
    assert done.stderr.strip() == "[]"


def test_a_device_is_never_replaced_by_a_file(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(ValueError, match=r"is a device or a pipe, limit: a file; "), written_aside(pipe):
        raise AssertionError
    assert pipe.is_fifo()


def test_what_does_not_converge_is_one_line_and_exit_code_1(monkeypatch, capsys):
    def fail(*_, **__):
        raise NotConverged("no convergence in 40 Newton steps; try a nearer start")

    monkeypatch.setattr("fem_adhesion.studies.curves.solve", fail)
    assert cli.main(["curve", "--tabor", "1"]) == 1
    said = capsys.readouterr().err.strip()
    assert said == "fem-adhesion: no convergence in 40 Newton steps; try a nearer start; nothing was written"
