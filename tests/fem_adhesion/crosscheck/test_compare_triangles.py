"""The comparison's level of overlapping triangles: they agree with the finite elements, and wrong triangles do not."""

from functools import cache, partial

import pytest

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, Hemisphere, Layer, Scene
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


def _integrals_of(wrong, targets, nodes, ends):
    return wrong(panel_integrals(targets, nodes, ends))


def _without_one_half(halves):
    return halves * [1.0, 0.0]


def _uniform_over_both_intervals(halves):
    """App. B's uniform band without the triangle that is to be taken off it."""
    return halves.sum(axis=-1, keepdims=True) * [1.0, 1.0]


WRONG = {
    "half a triangle": partial(_integrals_of, _without_one_half),
    "uniform for linear": partial(_integrals_of, _uniform_over_both_intervals),
}


@pytest.mark.parametrize("defect", WRONG)
def test_wrong_triangles_are_rejected_and_nothing_else_is(defect, monkeypatch):
    triangles = compliance.triangles

    def wrong(nodes):
        with monkeypatch.context() as patch:
            patch.setattr(compliance, "panel_integrals", WRONG[defect])
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


# --- what is told ---


@pytest.mark.parametrize("body", [HalfSpace(), Layer(thickness=2.0), Hemisphere(radius_ratio=100.0)], ids=str)
def test_bodies_that_triangles_do_not_know_have_no_such_level(body):
    scene = Scene(1.0, body)
    path = fem_adhesion.trace(scene, rtol=1e-2)
    assert bool(list(study._by_triangles(scene, path, 1e-2))) == isinstance(body, HalfSpace)
