"""Codes that nobody here wrote, as `make peers` found them, beside the atlas and beside Dugdale's law in its limit."""

import csv
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from table import COLUMNS, ours

from halfspace import trace
from halfspace.laws import Dugdale
from halfspace.theories.maugis import TENSION_TO_MAUGIS

with (Path(__file__).parent / "peers.csv").open(newline="") as file:
    ROWS = list(csv.DictReader(file))


def of(code):
    return [row for row in ROWS if row["code"] == code]


def test_each_deviation_of_a_peer_is_that_from_our_value():
    assert tuple(ROWS[0]) == COLUMNS
    for row in ROWS:
        reference = ours(row["problem"], row["quantity"])
        deviation = (float(row["value"]) - reference) / abs(reference)
        assert deviation == pytest.approx(float(row["deviation"]), rel=0.06, abs=1e-9), row


def test_the_closed_solution_of_maugis_is_met_to_its_digits():
    assert len(of("maugis")) == 6
    for row in of("maugis"):
        assert float(row["value"]) == pytest.approx(ours(row["problem"], row["quantity"]), rel=1e-9)


def test_dugdales_law_in_its_limit_meets_the_closed_solution_of_a_peer():
    row = next(row for row in of("maugis") if row["problem"] == "maugis-1.157")
    tabor, widths = 1.157 / TENSION_TO_MAUGIS, np.array([0.16, 0.11, 0.08])
    loads = [trace(tabor, law=Dugdale(width)).events["pull_off"].load for width in widths]
    assert np.all(np.diff(loads) > 0)
    limit = np.linalg.solve(np.vander(widths**2), loads)[-1]  # their terms are of width^2 and width^4
    assert limit == pytest.approx(float(row["value"]), rel=1e-4)  # they leave 6e-5


@pytest.mark.parametrize("code", sorted({row["code"] for row in ROWS} - {"maugis"}))
def test_a_peer_comes_nearer_to_us_as_it_is_refined(code):
    worst = defaultdict(float)  # in the order of refinement
    for row in of(code):
        worst[row["refinement"]] = max(worst[row["refinement"]], abs(float(row["deviation"])))
    first, *_, last = worst.values()
    assert last == min(worst.values())
    assert last < first / 2
