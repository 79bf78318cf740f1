"""Hard cases end as was declared for them: in a number within its estimate, or in a refusal of a given kind."""

import csv
import json
import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from hard import __main__ as command_line
from hard import cases as hard_cases
from hard import run as hard_run
from hard.bodies import Locking, flattened
from hard.measured import Measured, compare_events, worst
from hard.run import WITHIN, Case, Refusal, Row
from hard.table import cases_table, locking_table, summary, write_hard
from rich.console import Console
from skfem import MeshTri

from fem_adhesion.common.fold_birth import FIRST, SECOND, tabor_of
from fem_adhesion.mesh.block import graded_size, quarter_disc
from halfspace.errors import GridTooCoarse, InputError, NotConverged

CASES = {case.name: case for case in hard_cases.cases()}


@pytest.fixture(scope="module")
def command(whole):
    """The target of the Makefile, with all cases."""
    return whole("make hard OUT=hard")


@pytest.fixture(scope="module")
def record(command):
    return json.loads((command / "hard/hard.json").read_text())


@pytest.mark.hard
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_a_hard_case(case, record):
    (found,) = [row for row in record["cases"] if row["name"] == case.name]
    assert found["outcome"] != "wrong", found
    assert found["expected"] == case.expected
    if found["outcome"] == "converged":
        assert found["found"] == "converged"
        assert found["error"] >= 0
        assert WITHIN in case.endings
    else:
        assert found["error"] is None
        (refusal,) = [ending for ending in case.endings if isinstance(ending, Refusal)]
        assert found["found"] == refusal.kind.__name__
        assert all(part in found["message"] for part in (refusal.value, refusal.limit, refusal.remedy))


@pytest.mark.hard
def test_the_command_runs_every_case_and_says_how_each_ended(command, record):
    assert command.code == 0
    assert command.err.strip() == ""
    assert [row["name"] for row in record["cases"]] == list(CASES)
    outcomes = [row["outcome"] for row in record["cases"]]
    assert outcomes.count("wrong") == 0
    assert record["summary"] == (
        f"{outcomes.count('converged')} converged, {outcomes.count('refused')} refused, 0 wrong"
    )
    assert record["summary"] in command.out
    with (command / "hard/hard.csv").open() as file:
        lines = list(csv.DictReader(file))
    assert [line["name"] for line in lines] == list(CASES)
    for line, row in zip(lines, record["cases"], strict=True):
        assert line == {key: "" if value is None else str(value) for key, value in row.items()}


def test_the_readme_says_how_many_there_are():
    assert f"{len(CASES)} hard cases" in (Path(__file__).parents[2] / "README.md").read_text()


def test_a_refusal_says_value_limit_and_remedy_apart():
    refusals = [ending for case in CASES.values() for ending in case.endings if isinstance(ending, Refusal)]
    assert len(refusals) > 15
    for refusal in refusals:
        assert len({refusal.value, refusal.limit, refusal.remedy} - {""}) == 3


def test_one_case_only_may_end_in_either_way():
    """At a triple root Newton's method crawls, and rounding says whether it arrives in its 40 steps."""
    assert [name for name, case in CASES.items() if len(case.endings) > 1] == ["spring tangent to third order"]


@pytest.mark.hard
def test_the_births_of_folds():
    """Four grids of 13 to 16 nodes a panel and of other gradings agree in 0.69721461383."""
    assert tabor_of(FIRST) == pytest.approx(0.69721461383, abs=2e-8)
    assert tabor_of(FIRST, rtol=1e-9) == pytest.approx(0.69721461383, abs=2e-9)
    assert tabor_of(SECOND) == pytest.approx(3.974273, abs=1e-6)


@pytest.mark.hard
def test_displacements_lock_and_the_remedies_do_not(record, command):
    rows = {(row["poisson"], row["element"]): row for row in record["locking"]}
    for element, locked, remedied in (("P2", 10, 1), ("Q3", 5, 2), ("Q4", 5, 1.5), ("Q6", 3, 1.2)):
        soft, rubber = rows[0.3, element], rows[0.4999, element]
        assert rubber["error"] > locked * soft["error"]
        assert rubber["remedied"] < remedied * soft["remedied"]
        assert soft["remedied"] < 2 * soft["error"]
    with (command / "hard/locking.csv").open() as file:
        assert [(float(line["poisson"]), line["element"]) for line in csv.DictReader(file)] == list(rows)


# --- the harness can tell ---

REFUSAL = Refusal(InputError, "a = 3", "a <= 2", "take b")
MESSAGE = "a = 3 is outside a <= 2; take b"
FINE = Measured("load", 0.9, 1.0, "tighter", newton_steps=7)


def _raises(error):
    raise error


def _ended(attempt, *endings):
    (row,) = hard_run.run([Case("case", attempt, endings or (WITHIN,))])
    return row.outcome, row.found


def test_a_number_counts_within_its_estimate_and_that_of_the_reference():
    assert _ended(lambda: FINE) == ("converged", "converged")
    assert _ended(lambda: Measured("load", 1.0, 0.9, "", 0.2)) == ("converged", "converged")
    assert _ended(lambda: Measured("load", 1.0, 0.9, "", 0.0999)) == ("wrong", "beyond the estimate")
    assert _ended(lambda: Measured("load", 1.0, 0.9, "")) == ("wrong", "beyond the estimate")
    assert _ended(lambda: Measured("load", math.nan, 0.9, "")) == ("wrong", "beyond the estimate")
    assert _ended(lambda: Measured("load", 1.0, math.nan, "")) == ("wrong", "beyond the estimate")


def test_a_refusal_counts_if_it_is_of_the_kind_declared_and_names_all_that_it_must():
    assert _ended(lambda: _raises(InputError(MESSAGE)), REFUSAL) == ("refused", "InputError")
    for missing in ("a = 3", "a <= 2", "take b"):
        message = MESSAGE.replace(missing, "...")
        found = _ended(lambda message=message: _raises(InputError(message)), REFUSAL)
        assert found == ("wrong", f"InputError without {missing!r}")
    assert _ended(lambda: _raises(NotConverged(MESSAGE)), REFUSAL) == ("wrong", "NotConverged")
    coarse = Refusal(NotConverged, "a = 3", "a <= 2", "take b")
    assert _ended(lambda: _raises(GridTooCoarse(MESSAGE)), coarse) == ("wrong", "GridTooCoarse")


def test_what_was_not_declared_is_wrong_however_good():
    assert _ended(lambda: FINE, REFUSAL) == ("wrong", "converged")
    assert _ended(lambda: _raises(InputError(MESSAGE))) == ("wrong", "InputError")
    for ended in (lambda: FINE, lambda: _raises(InputError(MESSAGE))):
        assert _ended(ended, WITHIN, REFUSAL)[0] != "wrong"


@pytest.mark.parametrize("defect", [ZeroDivisionError, ValueError, FloatingPointError, RuntimeError])
def test_a_defect_is_no_refusal(defect):
    with pytest.raises(defect, match="take b"):
        _ended(lambda: _raises(defect(MESSAGE)), REFUSAL)


def test_a_row_carries_each_number_under_its_name():
    found = Measured("jump_on load", 1e-9, 3e-9, "two decades tighter", 5e-9, 17)
    (row,) = hard_run.run([Case("soft", lambda: found)])
    assert (row.name, row.expected, row.error, row.estimate, row.newton_steps) == ("soft", "converged", 1e-9, 3e-9, 17)
    assert row.message == "jump_on load, against: two decades tighter"
    (row,) = hard_run.run([Case("odd", lambda: _raises(InputError(MESSAGE)), (WITHIN, REFUSAL))])
    assert (row.expected, row.message, row.newton_steps) == ("converged or InputError", MESSAGE, 0)
    assert math.isnan(row.error)
    assert math.isnan(row.estimate)


def test_the_worst_measure_is_that_beyond_its_estimate():
    good, bad, lost = Measured("a", 1.0, 2.0, ""), Measured("b", 1e-9, 1e-10, ""), Measured("c", math.nan, 1.0, "")
    assert worst([good, bad]) is bad
    assert worst([good, bad, lost]) is lost


def _made_up(points=7, **events):
    """A path with what is compared of it: by event (load, load error, approach, approach error)."""
    names = ("load", "load_error", "approach", "approach_error")
    numbers = {name: SimpleNamespace(**dict(zip(names, event, strict=True))) for name, event in events.items()}
    steps = [SimpleNamespace(iterations=2)] * points
    return SimpleNamespace(events=numbers, event=numbers.get, segments=[SimpleNamespace(points=steps)])


@pytest.mark.parametrize(
    ("other", "quantity", "error", "estimates"),
    [
        ((-4.0, 0.03, -2.5, 0.05), "pull_off load", 1.0, (0.01, 0.03)),
        ((-5.0, 0.03, -9.0, 0.05), "pull_off approach", 6.5, (0.02, 0.05)),
    ],
)
def test_the_number_worst_off_of_two_curves_is_reported(other, quantity, error, estimates):
    path, truth = _made_up(pull_off=(-5.0, 0.01, -2.5, 0.02)), _made_up(points=99, pull_off=other)
    assert compare_events(path, truth, "truth") == Measured(quantity, error, estimates[0], "truth", estimates[1], 14)


@pytest.mark.parametrize("turned", [False, True])
def test_an_event_that_one_curve_lacks_is_infinitely_wrong(turned):
    both = [_made_up(pull_off=(-5, 1, -2, 1)), _made_up(pull_off=(-5, 1, -2, 1), jump_on=(-1, 1, -1, 1))]
    found = compare_events(*(reversed(both) if turned else both), "truth")
    assert (found.quantity, found.error, found.within) == ("jump_on", math.inf, False)


def test_a_triangle_is_flattened_but_none_turned_over():
    mesh = quarter_disc(10.0, graded_size(0.3, 1.0, 0.3))
    flat = flattened(mesh, 0.5, math.radians(170))
    assert isinstance(flat, MeshTri)
    assert flat.boundaries.keys() == mesh.boundaries.keys()
    with pytest.raises(InputError, match="turns a neighbouring triangle over; move it"):
        flattened(mesh, 0.5, math.radians(5))


# --- the report, and the exit code ---

ROWS = [
    Row("soft", "converged", "converged", "converged", "load", 1e-9, 2e-8, 7, 0.5),
    Row("odd [one]", "refused", "InputError", "InputError", "x = 1 is outside; take 0", math.nan, math.nan, 0, 0.25),
    Row("lost", "wrong", "NotConverged", "converged", "gap", 3e-7, 4e-6, 11, 0.75),
]
LOCKING = [Locking(0.49, "P2", "Taylor-Hood P2-P1", 1e-3, 2e-4)]


def test_the_files(tmp_path):
    write_hard(tmp_path, ROWS, LOCKING)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["hard.csv", "hard.json", "locking.csv"]
    with (tmp_path / "hard.csv").open() as file:
        read = list(csv.DictReader(file))
    assert read[0] == {
        "name": "soft",
        "outcome": "converged",
        "expected": "converged",
        "found": "converged",
        "message": "load",
        "error": "1e-09",
        "estimate": "2e-08",
        "newton_steps": "7",
        "seconds": "0.5",
    }
    assert (read[1]["error"], read[2]["expected"], read[2]["found"]) == ("", "NotConverged", "converged")
    record = json.loads((tmp_path / "hard.json").read_text())
    assert record["summary"] == "1 converged, 1 refused, 1 wrong"
    assert record["cases"][1]["error"] is None
    assert record["locking"][0] == {
        "poisson": 0.49,
        "element": "P2",
        "remedy": "Taylor-Hood P2-P1",
        "error": 1e-3,
        "remedied": 2e-4,
    }


def _cells(table):
    """Texts of a table by the header of their column."""
    return {column.header: [str(cell) for cell in column.cells] for column in table.columns}


def test_the_tables_show_each_number_under_its_header():
    cells = _cells(cases_table(ROWS))
    assert cells["case"] == ["soft", r"odd \[one]", "lost"]
    assert cells["expected"] == ["converged", "InputError", "NotConverged"]
    assert cells["found"] == ["[green]converged[/]", "[cyan]InputError[/]", "[bold red]converged[/]"]
    assert cells["error"] == ["1.0e-09", "-", "3.0e-07"]
    assert cells["estimate"] == ["2.0e-08", "-", "4.0e-06"]
    assert cells["Newton steps"] == ["7", "-", "11"]
    assert cells["seconds"] == ["0.50", "0.25", "0.75"]
    assert cells["compared, or refused because"] == ["load", "x = 1 is outside; take 0", "gap"]
    assert _cells(locking_table(LOCKING)) == {
        "poisson": ["0.49"],
        "element": ["P2"],
        "error": ["1.0e-03"],
        "with the remedy": ["2.0e-04"],
        "remedy": ["Taylor-Hood P2-P1"],
    }
    console = Console(width=150, record=True)
    console.print(cases_table(ROWS))
    assert "odd [one]" in console.export_text()
    assert summary(ROWS) == "1 converged, 1 refused, 1 wrong"


@pytest.mark.parametrize(
    ("endings", "code", "found"), [((WITHIN,), 0, "converged"), ((REFUSAL,), 1, "converged")], ids=["well", "otherwise"]
)
def test_the_exit_code_says_whether_all_ended_as_declared(endings, code, found, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(command_line, "cases", lambda: (Case("one", lambda: FINE, endings),))
    monkeypatch.setattr(command_line, "locking", lambda: iter(LOCKING))
    assert command_line.main(tmp_path / "hard") == code
    (row,) = json.loads((tmp_path / "hard/hard.json").read_text())["cases"]
    assert (row["found"], row["outcome"]) == (found, "wrong" if code else "converged")
    assert ("1 wrong" in capsys.readouterr().out) == bool(code)


def test_a_defect_in_a_case_shows_its_traceback_and_leaves_nothing(monkeypatch, tmp_path):
    monkeypatch.setattr(command_line, "cases", lambda: (Case("one", lambda: 1 / 0),))
    with pytest.raises(ZeroDivisionError):
        command_line.main(tmp_path / "hard")
    assert list(tmp_path.iterdir()) == []
