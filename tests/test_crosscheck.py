"""The harness agrees where it should and, with a defect put into one side, refuses and says which quantity shows it."""

import numpy as np
import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Scene, convergence, elasticity
from fem_adhesion.studies import crosscheck
from fem_adhesion.studies.crosscheck import Case, Failure, Row
from halfspace import limits
from halfspace.contact import ContactProblem
from halfspace.curve import Estimate
from halfspace.errors import NotConverged
from halfspace.lennard_jones import SurfaceLaw

RTOL = 1e-4  # defects change the numbers by per cents: coarse meshes show them as well


def _rejecting(case):
    return {row.quantity: row.verdict for row in case.rows if row.verdict != "agree"}


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
@pytest.mark.parametrize(("tabor", "limit"), [(0.5, 1e-5), (1, 1e-5), (2, 1e-5), (5, 5e-5)])
def test_the_solvers_agree(tabor, poisson, limit):
    case = crosscheck.compare(Scene(tabor=tabor, poisson=poisson), rtol=1e-5, operators=())
    assert _rejecting(case) == {}
    assert case.verdict == "agree"
    for row in case.rows:
        if row.quantity in ("pull_off load", "jump_on approach", "jump_off approach"):
            assert row.difference <= limit * abs(row.halfspace.value)


def test_the_solvers_agree_on_which_states_are_stable():
    paths = halfspace.trace(2.0, rtol=1e-4), fem_adhesion.trace(Scene(tabor=2.0), rtol=1e-3)
    for path in paths:
        unstable = path.approach[~path.stable]
        on, off = path.event("jump_on"), path.event("jump_off")
        assert unstable.size > 5
        assert unstable.max() <= on.approach
        assert unstable.min() >= off.approach


def test_the_solvers_agree_for_a_nearly_rigid_contact():
    assert crosscheck.compare(Scene(tabor=0.05), rtol=1e-5).verdict == "agree"


def _no_hoop_strain(monkeypatch):
    original = elasticity.strain_displacement

    def strain_displacement(value, grad, r):
        B = original(value, grad, r)
        B[:, 2] = 0
        return B

    monkeypatch.setattr(elasticity, "strain_displacement", strain_displacement)


def _young_for_contact_modulus(monkeypatch):
    original = elasticity.elastic_matrix
    monkeypatch.setattr(elasticity, "elastic_matrix", lambda nu: original(nu) / (1 - nu**2))


def _no_ring_measure(monkeypatch):
    monkeypatch.setattr(elasticity, "ring_measure", np.ones_like)


def _half_the_shear_modulus(monkeypatch):
    original = elasticity.elastic_matrix

    def elastic_matrix(nu):
        D = original(nu)
        D[3, 3] /= 2
        return D

    monkeypatch.setattr(elasticity, "elastic_matrix", elastic_matrix)


def _shifted_approach(monkeypatch):
    class Shifted(ContactProblem):
        def residual(self, x):
            F = super().residual(x)
            F[:-1] += 1e-3  # eps
            return F

    monkeypatch.setattr(convergence, "ContactProblem", Shifted)


def _exponents_3_8(monkeypatch):
    monkeypatch.setattr(
        convergence,
        "ContactProblem",
        lambda *args, **kwargs: ContactProblem(*args, law=SurfaceLaw(3, 8), **kwargs),
    )


def _nothing(monkeypatch):
    pass


DEFECTS = {
    "no hoop strain": (_no_hoop_strain, {}, ["operator: Hertz", "zero_load approach"]),
    "E for E*": (_young_for_contact_modulus, {}, ["operator: Hertz", "jump_off load", "zero_load approach"]),
    "no 2 pi r": (_no_ring_measure, {}, ["operator: uniform disc", "operator: Hertz", "operator: ring"]),
    "half the shear modulus": (_half_the_shear_modulus, {}, ["operator: spike", "zero_load contact_radius"]),
    "shifted approach": (_shifted_approach, {}, ["cross-residual: pull_off", "jump_on approach"]),
    "exponents 3-8": (_exponents_3_8, {}, ["cross-residual: jump_on", "pull_off load", "energy released"]),
    "clamped at L = 10": (
        _nothing,
        {"far_field": "clamped", "radius": 10.0},
        ["operator: Hertz", "zero_load approach"],
    ),
}


@pytest.mark.parametrize("defect", DEFECTS)
def test_a_defect_in_the_finite_elements_is_shown(defect, monkeypatch):
    inject, scene, shown_by = DEFECTS[defect]
    inject(monkeypatch)
    (case,) = crosscheck.run([Scene(tabor=1.0, **scene)], rtol=RTOL)
    assert isinstance(case, Failure) or case.verdict != "agree"
    assert set(shown_by) <= set(_rejecting(case))


def test_the_same_scene_without_a_defect_agrees_at_that_tolerance():
    assert crosscheck.compare(Scene(tabor=1.0), rtol=RTOL).verdict == "agree"


def test_a_missing_event_disagrees():
    one, none = Estimate(1.0, 1e-9), None
    assert Row("jump_on load", "R dgamma", one, none, float("nan"), 1e-3).verdict == "disagree"


def test_agreement_by_wide_errors_is_no_agreement():
    wide = Estimate(1.0, 1e-2)
    assert Row("pull_off load", "R dgamma", wide, Estimate(1.001, 1e-2), 1e-3, 1e-3).verdict == "inconclusive"


def test_the_worst_verdict_counts():
    assert crosscheck.worst(["agree", "inconclusive", "disagree"]) == "disagree"
    assert crosscheck.worst(["agree", "inconclusive"]) == "inconclusive"
    assert crosscheck.worst(["agree"]) == "agree"


def test_a_failing_case_does_not_lose_the_others(monkeypatch):
    original = convergence.trace

    def solve(scene, *, rtol):
        if scene.tabor == 1.0:
            raise NotConverged("on purpose; try another day")
        return original(scene, rtol=rtol)

    compare = crosscheck.compare
    monkeypatch.setattr(crosscheck, "compare", lambda *args, **kwargs: compare(*args, **kwargs, solve=solve))
    results = list(crosscheck.run([Scene(tabor=1.0), Scene(tabor=0.5)], rtol=1e-2))
    assert isinstance(results[0], Failure)
    assert results[0].reason == "on purpose; try another day"
    assert isinstance(results[1], Case)


@pytest.mark.parametrize("far_field", ["clamped", "free"])
def test_the_error_estimate_of_a_held_block_covers_its_distance_from_the_half_space(far_field):
    path = fem_adhesion.trace(Scene(tabor=1.0, radius=40.0, far_field=far_field), rtol=1e-3)
    for name, approach, load in (("jump_on", -1.629216712, -2.139717925), ("jump_off", -1.743430144, -3.243484131)):
        event = path.event(name)
        assert 1e-4 < abs(event.approach - approach) <= 1.5 * event.approach_error
        assert abs(event.load - load) <= 1.5 * event.load_error


@pytest.mark.parametrize(
    ("kwargs", "message"),
    [
        ({"tabor": -1}, "tabor = -1 is outside 0 < tabor"),
        ({"tabor": 1, "poisson": 0.5}, r"poisson = 0.5 is outside 0 <= poisson < 0.5; take"),
        ({"tabor": 1, "poisson": float("nan")}, "poisson = nan"),
        ({"tabor": 1, "radius": 2.0}, "radius = 2 is outside 5 < radius"),
        ({"tabor": 1, "far_field": "glued"}, "far_field = 'glued' is not one of"),
    ],
)
def test_bad_scenes_are_refused(kwargs, message):
    with pytest.raises(ValueError, match=message):
        Scene(**kwargs)


def test_limits_are_checked_before_any_work():
    with pytest.raises(ValueError, match="rtol = 1 is outside"):
        crosscheck.compare(Scene(tabor=1.0), rtol=1.0)
    assert limits.require_poisson(0.0) == 0.0
