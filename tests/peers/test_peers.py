"""Codes that nobody here wrote, as `make peers` found them, beside our values, and what refining them shows."""

from pathlib import Path

import pytest
from page_tables import rows_of
from table import COLUMNS, judged, problem_of
from with_halfspace import dugdale_limit

ROWS = rows_of(Path(__file__).parent / "peers.csv")
PEERS = ("adhesion", "ngsolve", "tamaas")


def of(code, **columns):
    return [row for row in ROWS if row["code"] == code and all(row[name] == text for name, text in columns.items())]


@pytest.mark.parametrize("code", [*PEERS, "halfspace"])
def test_the_table_is_what_the_benchmark_says(code):
    assert tuple(ROWS[0]) == COLUMNS
    first = of(code)[0]
    rows = of(code, refinement=first["refinement"], problem=first["problem"])
    found = judged(rows)
    assert [f"{row.deviation:.1e}" for row in found.rows] == [row["deviation"] for row in rows]
    assert {" or ".join(found.causes)} == {row["cause"] for row in rows}


def test_the_closed_solution_of_maugis_is_met_to_its_digits():
    assert len(of("maugis")) == 6
    for row in of("maugis"):
        assert float(row["value"]) == pytest.approx(problem_of(row["problem"]).values["pull_off_load"].value, rel=1e-9)


@pytest.mark.parametrize("row", of("maugis"), ids=lambda row: row["problem"])
def test_dugdales_law_in_its_limit_meets_the_closed_solution(row):
    (ours,) = of("halfspace", problem=row["problem"])
    assert abs(float(ours["value"]) - float(row["value"])) <= float(ours["error"]) < 1e-3 * abs(float(row["value"]))


def test_the_limit_in_the_table_is_that_of_the_law():
    (row,) = of("halfspace", problem="maugis-0.5785")
    limit = dugdale_limit(0.5785)
    assert float(row["value"]) == pytest.approx(limit.value, rel=1e-7)
    assert float(row["error"]) == pytest.approx(limit.error, rel=1e-2)


# Code, problem, cause, quantity, a coarse run, the run refined by what the cause says, and one refined otherwise.
GRADES = [
    ("adhesion", "half-space-0.5", "domain-too-small", "pull_off_load", "64-8", "96-12", "32-8"),
    ("adhesion", "half-space-2", "grid-too-coarse", "pull_off_load", "64-12", "96-12", ""),
    ("tamaas", "exponential-0.5", "domain-too-small", "pull_off_approach", "64-8", "128-16", ""),
    ("tamaas", "exponential-2", "grid-too-coarse", "pull_off_load", "64-16", "128-16", ""),
    ("ngsolve", "half-space-0.5", "domain-too-small", "pull_off_approach", "16-2-16", "16-2-64", "8-2-16"),
]


@pytest.mark.parametrize(("code", "problem", "cause", "quantity", "coarse", "refined", "otherwise"), GRADES)
def test_refining_shows_that_a_grade_is_right(code, problem, cause, quantity, coarse, refined, otherwise):
    def error(refinement):
        (row,) = of(code, problem=problem, refinement=refinement, quantity=quantity)
        return abs(float(row["deviation"]))

    assert all(cause in row["cause"].split(" or ") for row in of(code, problem=problem, refinement=coarse))
    assert error(refined) < 0.6 * error(coarse)  # half or less where the domain or the grid is twice as good
    assert not otherwise or error(otherwise) > 0.9 * error(coarse)
