"""Hard cases end as was declared for them: in a number within its estimate, or in a refusal of a given kind."""

import json
from functools import partial
from pathlib import Path

import hard
import pytest
from attempts import CASES
from hard import Case, Locking, Measured, Refusal
from page_tables import rows_of

from fem_adhesion.common.fold_birth import FIRST, SECOND, tabor_of
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from halfspace.values import Estimate

pytestmark = pytest.mark.hard


@pytest.fixture(scope="module")
def command(whole):
    """The target of the Makefile, with all cases."""
    return whole("make hard OUT=hard")


@pytest.fixture(scope="module")
def record(command):
    return json.loads((command / "hard/hard.json").read_text())


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_hard_case(case, record):
    (found,) = [row for row in record["cases"] if row["name"] == case.name]
    assert found["outcome"] != "wrong", found
    assert found["expected"] == case.expected


def test_the_command_tells_how_every_case_ended(command, record):
    assert (command.code, command.err.strip()) == (0, "")
    outcomes = [row["outcome"] for row in record["cases"]]
    assert len(outcomes) == len(CASES)
    assert f"{len(CASES)} hard cases" in (Path(__file__).parents[2] / "CONTRIBUTING.md").read_text()
    told = f"{outcomes.count('converged')} converged, {outcomes.count('refused')} refused, 0 wrong"
    assert record["summary"] == told
    assert told in command.out
    for name, rows in (("hard", record["cases"]), ("locking", record["locking"])):
        assert rows_of(command / f"hard/{name}.csv") == [
            {key: "" if v is None else str(v) for key, v in row.items()} for row in rows
        ]


def test_the_births_of_folds():
    """Four grids of 13 to 16 nodes a panel and of other gradings agree in 0.69721461383."""
    assert tabor_of(FIRST) == pytest.approx(0.69721461383, abs=2e-8)
    assert tabor_of(FIRST, rtol=1e-9) == pytest.approx(0.69721461383, abs=2e-9)
    assert tabor_of(SECOND) == pytest.approx(3.974273, abs=1e-6)


def test_displacements_lock_and_the_remedies_do_not(record):
    rows = {(row["poisson"], row["element"]): row for row in record["locking"]}
    for element, locked, remedied in (("P2", 10, 1), ("Q3", 5, 2), ("Q4", 5, 1.5), ("Q6", 3, 1.2)):
        soft, rubber = rows[0.3, element], rows[0.4999, element]
        assert rubber["error"] > locked * soft["error"]
        assert rubber["remedied"] < remedied * soft["remedied"]
        assert soft["remedied"] < 2 * soft["error"]


# The harness can tell

REFUSAL = Refusal(InputError, "a = 3", "a <= 2", "take b")
MESSAGE = "a = 3 is outside a <= 2; take b"


def solved(error, estimate=1.0, known=0.0):
    return lambda: Measured({"load": Estimate(1.0 + error, estimate)}, {"load": Estimate(1.0, known)}, "truth", 7)


def raising(error):
    def attempt():
        raise error

    return attempt


def ended(attempt, *refusals, **more):
    (row,) = hard.run([Case("case", attempt, refusals, **more)])
    return row.outcome, row.found


@pytest.mark.parametrize(
    ("attempt", "end"),
    [
        (solved(0.9), ("converged", "converged")),
        (solved(1.1), ("wrong", "beyond the estimate")),
        (raising(InputError(MESSAGE)), ("wrong", "InputError")),
    ],
)
def test_a_number_counts_within_its_estimate(attempt, end):
    assert ended(attempt) == end


def test_a_refusal_counts_if_it_is_of_the_kind_declared_and_names_all_that_it_must():
    assert ended(raising(InputError(MESSAGE)), REFUSAL) == ("refused", "InputError")
    for missing in ("a = 3", "a <= 2", "take b"):
        found = ended(raising(InputError(MESSAGE.replace(missing, "..."))), REFUSAL)
        assert found == ("wrong", f"InputError without {missing!r}")
    assert ended(raising(NotConverged(MESSAGE)), REFUSAL) == ("wrong", "NotConverged")
    assert ended(raising(GridTooCoarse(MESSAGE)), REFUSAL._replace(kind=NotConverged)) == ("wrong", "GridTooCoarse")
    assert ended(solved(0.5), REFUSAL) == ("wrong", "converged")
    for attempt in (solved(0.5), raising(InputError(MESSAGE))):
        assert ended(attempt, REFUSAL, solvable=True)[0] != "wrong"


def test_the_number_worst_off_is_reported():
    numbers = {"a": Estimate(1.0, 2.0), "b": Estimate(1e-9, 1e-10), "c": Estimate(5.0, 9.0)}
    found = Measured(numbers, dict.fromkeys(numbers, Estimate(0.0, 0.0)), "truth", 7)
    (row,) = hard.run([Case("case", lambda: found)])
    assert (row.name, row.outcome, row.message) == ("case", "wrong", "b, against: truth")
    assert (row.error, row.estimate, row.newton_steps) == (1e-9, 1e-10, 7)


LOCKED = [Locking(0.49, "P2", "Taylor-Hood P2-P1", 1e-3, 2e-4)]


@pytest.mark.parametrize(("refusals", "code"), [((), 0), ((REFUSAL,), 1)])
def test_the_exit_code_and_the_tables_say_whether_all_ended_as_declared(refusals, code, tmp_path, capsys):
    cases = [Case("odd [one]", solved(0.5, 2.0), refusals), Case("lost", raising(InputError(MESSAGE)), (REFUSAL,))]
    assert hard.attempt_all(tmp_path / "hard", cases, partial(iter, LOCKED)) == code
    shown = capsys.readouterr().out
    assert all(
        word in shown for word in ("odd [one]", "5.0e-01", "2.0e+00", "Taylor-Hood P2-P1", "2.0e-04", MESSAGE[-6:])
    )
    assert f"{1 - code} converged, 1 refused, {code} wrong" in shown


def test_a_defect_in_a_case_shows_its_traceback_and_leaves_nothing(tmp_path):
    with pytest.raises(KeyError):
        hard.attempt_all(tmp_path / "hard", [Case("one", raising(KeyError("x")))], partial(iter, LOCKED))
    assert list(tmp_path.iterdir()) == []
