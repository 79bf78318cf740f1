"""Hard cases end in a number within its estimate or in a refusal that names cause and remedy."""

import csv
import json
import math

import pytest
from rich.console import Console
from skfem import MeshTri

from fem_adhesion.mesh import graded_size, quarter_disc
from fem_adhesion.output.hard_report import cases_table, locking_table, write_hard
from fem_adhesion.studies import hard_cases
from fem_adhesion.studies.fold_birth import FIRST, SECOND, tabor_of
from fem_adhesion.studies.hard_bodies import Locking, flattened, locking
from fem_adhesion.studies.hard_cases import Case, Row
from fem_adhesion.studies.measured import Measured, worst
from halfspace.errors import NotConverged

REFUSALS = {
    "start with gaps of 0.8 eps": "no convergence in 40 Newton steps",
    "start with gaps of 0.01 eps": "no convergence in 40 Newton steps",
    "start from contact, just left of jump_off": "grid spacing .* beta at the contact edge",
    "start from separation, right of jump_on": "no convergence in 40 Newton steps",
    "mesh too coarse by ten": "grid spacing .* beta at the contact edge",
    "block of 5.5 beta, tabor 0.02": "radius = 5.5 is outside 35.4 < radius",
    "clamped block of 10 beta, tabor 5": "tabor = 5 is outside tabor <= 3 for a fixed mesh; take far_field",
    "tabor 1e-300": "tabor = 1e-300 is outside 1e-12 <= tabor; .*bradley_load",
    "tabor 1e12": r"tabor = 1e\+12 is outside tabor <= 300; .*jkr_load",
    "tabor 1e300": r"tabor = 1e\+300 is outside tabor <= 300; .*jkr_load",
    "rtol 1e-10": "rtol = 1e-10 is outside",
    "rtol 1": "rtol = 1 is outside",
    "poisson 0.49999999": "poisson = 0.49999999 is outside poisson <= 0.499999; take 0.4999",
    "load nan": "to_load = nan is outside 0 < to_load <= 1000",
    "load 1e9": r"to_load = 1e\+09 is outside 0 < to_load <= 1000",
    "sphere of R/eps 1e13": r"radius_ratio = 1e\+13 is outside 2 <= radius_ratio <= 1e12",
    "sphere of R/eps 1": "radius_ratio = 1 is outside 2 <= radius_ratio",
    "sphere smaller than its contact": "radius_ratio = 100 is outside 2.25 tabor = 112 or more; .*R < 1.5 beta",
    "sphere of R/eps nan": "radius_ratio = nan is outside",
    "block of 1e300 beta": r"radius = 1e\+300 is outside 5 < radius <= 1e9",
}
EITHER = (
    "spring tangent to third order"  # Newton's method crawls: whether it arrives in 40 steps is for rounding to say
)


@pytest.mark.hard
@pytest.mark.parametrize("case", hard_cases.cases(), ids=lambda case: case.name)
def test_a_hard_case(case):
    (row,) = hard_cases.run([case])
    assert row.outcome != "wrong", row
    assert row.seconds < 20
    if case.name in REFUSALS:
        assert row.outcome == "refused"
        with pytest.raises(NotConverged, match=REFUSALS[case.name]):
            raise NotConverged(row.message)
    elif case.name != EITHER:
        assert row.outcome == "converged", row


@pytest.mark.hard
def test_the_births_of_folds():
    assert tabor_of(FIRST) == pytest.approx(0.69721462, abs=2e-8)
    assert tabor_of(SECOND) == pytest.approx(3.974273, abs=1e-6)


@pytest.mark.hard
def test_displacements_lock_and_the_remedies_do_not():
    error = {(row.poisson, row.element): row for row in locking((0.3, 0.4999))}
    for element, locked, remedied in (("P2", 10, 1), ("Q3", 5, 2), ("Q4", 5, 1.5), ("Q6", 3, 1.2)):
        soft, rubber = error[0.3, element], error[0.4999, element]
        assert rubber.error > locked * soft.error
        assert rubber.remedied < remedied * soft.remedied
        assert soft.remedied < 2 * soft.error


# --- the harness can tell ---


def _ends_in(attempt):
    (row,) = hard_cases.run([Case("case", attempt)])
    return row.outcome


def _raises(error):
    raise error


def test_outcomes():
    assert _ends_in(lambda: Measured("load", 1.0, 0.9, "", 0.2)) == "converged"
    assert _ends_in(lambda: Measured("load", 1.0, 0.9, "")) == "wrong"
    assert _ends_in(lambda: Measured("load", math.nan, 0.9, "")) == "wrong"
    assert _ends_in(lambda: _raises(ValueError("a is too large; take b"))) == "refused"
    assert _ends_in(lambda: _raises(ValueError("f(a) and f(b) must have different signs"))) == "wrong"
    with pytest.raises(ZeroDivisionError):
        _ends_in(lambda: 1 / 0)


def test_the_worst_measure_is_that_beyond_its_estimate():
    good, bad, lost = Measured("a", 1.0, 2.0, ""), Measured("b", 1e-9, 1e-10, ""), Measured("c", math.nan, 1.0, "")
    assert worst([good, bad]) is bad
    assert worst([good, bad, lost]) is lost


def test_a_triangle_is_flattened_but_none_turned_over():
    mesh = quarter_disc(10.0, graded_size(0.3, 1.0, 0.3))
    flat = flattened(mesh, 0.5, math.radians(170))
    assert isinstance(flat, MeshTri)
    assert flat.boundaries.keys() == mesh.boundaries.keys()
    with pytest.raises(ValueError, match="turns a neighbouring triangle over; move it"):
        flattened(mesh, 0.5, math.radians(5))


# --- the report ---


def test_the_report(tmp_path):
    rows = [
        Row("soft", "converged", "load", 1e-9, 2e-9, 7, 0.5),
        Row("odd [one]", "refused", "x = 1 is outside; take 0", math.nan, math.nan, 0, 0.1),
    ]
    write_hard(tmp_path, rows, [Locking(0.49, "P2", "Taylor-Hood P2-P1", 1e-3, 1e-4)])
    assert sorted(file.name for file in tmp_path.iterdir()) == ["hard.csv", "hard.json", "locking.csv"]
    with (tmp_path / "hard.csv").open() as file:
        read = list(csv.DictReader(file))
    assert [row["outcome"] for row in read] == ["converged", "refused"]
    assert read[1]["error"] == ""
    record = json.loads((tmp_path / "hard.json").read_text())
    assert record["summary"] == "1 converged, 1 refused, 0 wrong"
    assert record["cases"][1]["error"] is None
    assert record["locking"][0]["remedied"] == 1e-4
    console = Console(width=150, record=True)
    console.print(cases_table(rows), locking_table([Locking(0.49, "P2", "remedy", 1e-3, 1e-4)]))
    assert "odd [one]" in console.export_text()
