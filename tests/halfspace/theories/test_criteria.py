"""Criteria for jumping on, against the paper and against converged jumps."""

from pathlib import Path

import numpy as np
import pytest
from page_tables import rows_of

from halfspace.theories import criteria

DATA = Path(__file__).parents[2] / "data"
JUMPS = [row for row in rows_of(DATA / "reference_events.csv") if row["event"] == "jump_on"]
TABOR, APPROACH, GAP = (np.array([float(row[name]) for row in JUMPS]) for name in ("tabor", "approach", "central_gap"))


def test_attard_and_parkers_load_to_its_last_printed_digit():
    row = next(row for row in rows_of(DATA / "greenwood1997_table2.csv") if row["quantity"].endswith("_AP"))
    printed = {float(key[3:]): value for key, value in row.items() if key.startswith("mu=")}
    loads = criteria.undeformed_load(criteria.closed_gap(list(printed), criteria.ATTARD_PARKER))
    assert [f"{-load:.3f}" for load in loads] == list(printed.values())


@pytest.mark.parametrize(
    ("k", "printed"),
    [
        (criteria.ATTARD_PARKER, 3 * np.sqrt(2) * np.pi),
        (criteria.PETHICA_SUTTON, 16 * np.pi / 3),
        (criteria.APPENDIX_C, 5 * np.pi / np.sqrt(2)),
    ],
)
def test_closed_criteria_have_the_factors_of_their_authors(k, printed):
    """(H0 + 1)^(7/2) in mu^(3/2)."""
    assert (criteria.closed_gap(4.0, k) + 1) ** 3.5 == pytest.approx(8 * printed, rel=1e-12)


def test_closed_criteria_follow_from_the_undeformed_gap():
    """With the bulge b of the module's docstring, App. C is the fold of H0 + b and Attard & Parker's b 3/h = 1."""
    mu = 2.0

    def bulge(H0):
        return np.pi * np.sqrt(2) * mu**1.5 * (H0 + 1) ** -2.5

    fold = criteria.closed_gap(mu, criteria.APPENDIX_C)
    nearby = fold + np.array([-0.01, 0.0, 0.01])
    assert np.argmin(nearby + bulge(nearby)) == 1
    H0 = criteria.closed_gap(mu, criteria.ATTARD_PARKER)
    assert bulge(H0) * 3 / (H0 + 1) == pytest.approx(1)


def test_fits_of_the_paper_hold_at_the_converged_jumps():
    np.testing.assert_allclose(criteria.fitted_gap(TABOR), GAP, atol=1.5e-3)
    np.testing.assert_allclose(criteria.fitted_approach(TABOR), APPROACH, rtol=5e-3)


def test_fitted_gap_solves_its_equation_down_to_where_it_ends():
    tabor = np.append(criteria.FIT_LEAST_TABOR * (1 + 1e-12), np.geomspace(0.72, 100, 50))
    y = criteria.fitted_gap(tabor) + 1
    np.testing.assert_allclose(y**3.5, 6.233 * tabor**1.5 * (1 - 1.6 / y**6), rtol=1e-10)
    assert np.all(np.diff(y) > 0)
    assert np.isnan(criteria.fitted_gap(0.7099))
    assert pytest.approx(0.7100, abs=1e-4) == criteria.FIT_LEAST_TABOR


def test_fundamental_criterion_calls_stable_states_unstable():
    """At the true jump it reads well below the -1 at which it lets a state be unstable."""
    at_jump = criteria.fundamental_criterion(APPROACH, GAP)
    assert np.all((at_jump > -1.75) & (at_jump < -1.55))
