"""The comparison's level of overlapping triangles: they agree with the finite elements, and wrong triangles do not."""

from functools import cache

import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Scene
from fem_adhesion.crosscheck import study
from fem_adhesion.crosscheck.comparison import TRIANGLES
from halfspace.elastic import compliance
from halfspace.elastic.kernel import panel_integrals
from halfspace.errors import NotConverged

QUANTITIES = ["pull_off load", "jump_on approach", "jump_on load", "jump_off approach", "jump_off load"]

pytestmark = pytest.mark.usefixtures("two_solvers")


@cache
def elements(tabor, rtol):
    return fem_adhesion.trace(Scene(tabor), rtol=rtol)


def _case(tabor, rtol):
    """Comparison whose finite elements are solved once for all of its tests."""
    return study.compare(Scene(tabor), rtol=rtol, before=(), solve=lambda _, rtol: elements(tabor, rtol))


def _rows(case):
    return {row.quantity.removeprefix("triangles: "): row for row in case.rows if row.between == TRIANGLES}


@pytest.mark.parametrize("tabor", [0.05, 1.0])
def test_triangles_agree_with_elements_to_five_digits(tabor):
    rows = _rows(_case(tabor, 1e-5))
    assert list(rows) == (QUANTITIES if tabor > 0.697 else QUANTITIES[:1])
    scale = elements(tabor, 0.9 * 1e-5).approach_scale
    for name, row in rows.items():
        size = scale if name.endswith("approach") else abs(row.second.value)
        assert row.verdict == "agree"
        assert row.difference <= row.error <= 1e-5 * size == pytest.approx(row.budget)
        assert row.first.value != row.second.value


# --- wrong triangles ---


def test_wrong_triangles_are_rejected_and_nothing_else_is(monkeypatch):
    """Half a triangle."""
    triangles = compliance.triangles

    def wrong(nodes):
        with monkeypatch.context() as patch:
            patch.setattr(compliance, "panel_integrals", lambda *of: panel_integrals(*of) * [1.0, 0.0])
            return triangles(nodes)

    monkeypatch.setattr(compliance, "triangles", wrong)
    case = _case(1.0, 1e-4)
    verdicts = {name: row.verdict for name, row in _rows(case).items()}
    assert verdicts == dict.fromkeys(QUANTITIES, "disagree")
    assert {row.verdict for row in case.rows if row.between != TRIANGLES} == {"agree"}
    assert case.verdict == "disagree"


def test_triangles_that_do_not_converge_disagree(monkeypatch):
    def fails(*_, kernel="panels", **others):
        if kernel == "triangles":
            raise NotConverged("too coarse")
        return original(*_, kernel=kernel, **others)

    original = halfspace.trace
    monkeypatch.setattr(halfspace, "trace", fails)
    rows = _rows(_case(1.0, 1e-4))
    assert {name: (row.first, row.verdict) for name, row in rows.items()} == dict.fromkeys(
        QUANTITIES, (None, "disagree")
    )
