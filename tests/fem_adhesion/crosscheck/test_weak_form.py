"""The public weak form: the whole curve by full Newton, beside the solvers that share nothing with it."""

import csv
import json

import numpy as np
import pytest
from skfem import ElementQuadP, FacetBasis

import fem_adhesion
import halfspace
from fem_adhesion import Coated, Hemisphere, Scene, cli
from fem_adhesion.crosscheck import elimination
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import block_grid
from fem_adhesion.weak_form import path, trace
from fem_adhesion.weak_form.problem import Problem
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.errors import InputError
from halfspace.laws import Morse
from halfspace.profiles import Power

MU, NU, DEGREE, APPROACH = 1.0, 0.3, 3, 0.5
RTOL = 1e-2


@pytest.fixture(scope="module")
def mesh():
    return block_grid(0.4, 3.0, 20.0)


@pytest.fixture(scope="module")
def problem(mesh):
    return Problem(mesh, DEGREE, MU, NU, 3.0)


@pytest.fixture(scope="module")
def points(problem):
    return path.follow(problem, -6.0, 1.0)


def at_approach(problem, points, approach):
    near = min(points, key=lambda point: abs(point.x[-1] - approach))
    row = np.eye(1, near.x.size, near.x.size - 1)[0]
    for _ in range(2):  # Newton's method ends at the square of its last step: once more, to round-off
        near, _ = path.equilibrium(problem, near.x, row, approach)
    return near


def test_the_condensed_solver_is_its_exact_elimination(mesh, problem, points):
    """One discretisation both ways: cells, elements, quadrature and clamp are the same, all else is not."""
    body = condense(Space(mesh, ElementQuadP(DEGREE)), NU, far_field=clamped, points=2 * DEGREE + 2)
    condensed = ContactProblem(body.operator, MU)
    whole = at_approach(problem, points, APPROACH)
    h = problem.gap(whole.x).ravel()
    radii = np.asarray(problem.surface.global_coordinates()[0]).ravel()
    order = np.argsort(radii)
    start = condensed.undeformed(APPROACH)
    start[:-2] = (h[order] - 1) * 1.01
    found = newton.solve(condensed, start, newton.approach(APPROACH))
    np.testing.assert_allclose(condensed.operator_at(found.x).radii, radii[order], rtol=1e-12)
    np.testing.assert_allclose(found.x[:-2], h[order] - 1, rtol=1e-10, atol=1e-10)
    assert problem.load(problem.gap(whole.x)) == pytest.approx(found.observables[LOAD], rel=1e-10, abs=0)


@pytest.mark.parametrize("wrong", [False, True])
def test_compare_tells_whether_condensing_is_exact(wrong, monkeypatch):
    if wrong:  # a ten thousandth of one modulus
        exact = elimination.condense
        monkeypatch.setattr(elimination, "condense", lambda space, nu, **rest: exact(space, nu * (1 + 1e-4), **rest))
    for tabor in (0.05, 1.0, 10.0):
        rows = elimination.rows(Scene(tabor), fem_adhesion.trace(Scene(tabor), rtol=1e-3))
        assert {row.verdict for row in rows} == {"disagree" if wrong else "agree"}


def test_the_tangent_and_its_border_are_derivatives_of_the_residual(problem, points):
    x = at_approach(problem, points, APPROACH).x
    dx = np.append(np.random.default_rng(1).normal(size=problem.free.size) * 1e-3, 0.7)
    h, d = problem.gap(x), 1e-4
    quotient = (problem.residual(x + d * dx) - problem.residual(x - d * dx)) / (2 * d)
    along = problem.tangent(h).solve(quotient - dx[-1] * problem.by_approach(h))
    np.testing.assert_allclose(along, dx[:-1], rtol=0, atol=1e-4 * np.abs(dx[:-1]).max())
    loads = [problem.load(problem.gap(x + step * dx)) for step in (-d, d)]
    assert problem.load_rate(h, problem.gap_change(dx)) == pytest.approx((loads[1] - loads[0]) / (2 * d), rel=1e-5)


def test_a_state_on_finer_elements_has_the_same_surface(mesh, problem, points):
    finer = Problem(mesh, DEGREE + 1, MU, NU, 3.0)
    x = finer.taken_over(problem, points[-1].x)
    same = FacetBasis(mesh, finer.basis.elem, facets="contact", intorder=4 * DEGREE + 3)
    coarse, fine = (
        np.asarray(basis.interpolate(each.displacement(state)))[1]
        for basis, each, state in ((problem.surface, problem, points[-1].x), (same, finer, x))
    )
    np.testing.assert_allclose(fine, coarse, rtol=0, atol=1e-13)


def test_the_path_turns_where_its_conditions_vanish(problem, points):
    found = path.events(problem, points)
    assert list(found) == ["pull_off", "jump_on", "jump_off", "zero_load"]
    assert abs(found["pull_off"].rates[1]) < 1e-6
    assert max(abs(found[name].rates[0]) for name in ("jump_on", "jump_off")) < 1e-6
    assert abs(found["zero_load"].observables[1]) < 1e-6
    assert found["pull_off"].observables[1] == min(point.observables[1] for point in [*points, found["pull_off"]])
    signs = np.array([point.rates[0] > 0 for point in points])
    assert (signs == [point.stable for point in points]).all()  # inertia and turning of the path agree


@pytest.fixture(scope="module")
def curve():
    return trace(Scene(1.0), rtol=RTOL)


def test_every_number_is_that_of_the_integral_equation_within_its_error(curve):
    other = halfspace.trace(1.0, rtol=1e-7)
    assert curve.met
    assert set(curve.events) == {"pull_off", "jump_on", "jump_off", "zero_load"}
    for name, event in curve.events.items():
        for quantity in ("approach", "load", "central_gap"):
            assert event.estimate(quantity).agrees(other.event(name).estimate(quantity)), (name, quantity)
        assert not event.contact_radius > 0 or event.estimate("contact_radius").agrees(
            other.event(name).estimate("contact_radius")
        ), name
    contact = curve.stable & (curve.central_gap < 0)
    on_other = other.at(approach=curve.approach[contact], branch="contact")
    assert (np.abs(on_other.load - curve.load[contact]) < 1e-2 * abs(curve.event("pull_off").load)).all()


def test_a_curve_has_arrays_by_name_and_says_what_it_found(curve):
    assert curve.load.shape == curve.approach_error.shape == curve.stable.shape
    assert np.isnan(curve.contact_radius[0])
    assert curve.event("fold_2") is None
    assert "pull_off" in repr(curve)
    with pytest.raises(AttributeError):
        _ = curve.loads


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (Scene(1.0, Hemisphere(radius_ratio=100.0)), "body = hemisphere by the weak form, limit: half-space"),
        (Scene(1.0, Coated(1.0, 5.0)), "by the weak form, limit: half-space"),
        (Scene(1.0, law=Morse(3)), "limit: the 3-9 law"),
        (Scene(1.0, profile=Power(4)), "limit: paraboloid"),
        (Scene(30.0), "tabor = 30 of the weak form is outside 0.02 <= tabor <= 5"),
    ],
)
def test_a_scene_that_it_does_not_serve_is_refused(scene, message):
    with pytest.raises(InputError, match=message):
        trace(scene)
    with pytest.raises(InputError, match="rtol"):
        trace(Scene(1.0), rtol=1e-8)


def test_the_command_writes_what_it_found(tmp_path, capsys):
    files = [tmp_path / name for name in ("curve.json", "curve.csv", "curve.svg")]
    options = [
        part for option, file in zip(("--json", "--csv", "--plot"), files, strict=True) for part in (option, file)
    ]
    assert cli.main(["curve", "--tabor", "0.5", "--solver", "weak-form", "--rtol", "0.02", *map(str, options)]) == 0
    assert "weak form: " in capsys.readouterr().out
    solution = json.loads(files[0].read_text())["solutions"]["weak form"]
    rows = list(csv.DictReader(files[1].read_text().splitlines()))
    event = next(row for row in rows if row["event"] == "pull_off")
    assert float(event["load_R_dgamma"]) == solution["events"]["pull_off"]["load"]
    assert float(event["load_R_dgamma"]) == pytest.approx(halfspace.trace(0.5).event("pull_off").load, rel=1e-3)
    assert sum(not row["event"] for row in rows) == len(solution["curve"]["load"])
    assert "stable under fixed grips" in files[2].read_text()


@pytest.mark.parametrize("option", [["--vtk", "x"], ["--beside", "morse:3"], ["--points", "9"], ["--stiffness", "1"]])
def test_what_the_weak_form_has_not_is_refused(option, capsys):
    assert cli.main(["curve", "--tabor", "1", "--solver", "weak-form", *option]) == 2
    assert "the weak form gives points and events alone" in capsys.readouterr().err
