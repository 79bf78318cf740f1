"""The speed study on a few small rungs, its figures of merit on made-up data, and the report as a reader finds it."""

import csv
import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

import halfspace
from fem_adhesion.output import speed_report
from fem_adhesion.output.files import directory_written_aside
from fem_adhesion.studies import speed
from fem_adhesion.studies.element_methods import element_methods
from fem_adhesion.studies.halfspace_methods import halfspace_methods
from fem_adhesion.studies.methods import QUANTITIES
from fem_adhesion.studies.speed import measure
from fem_adhesion.studies.speed_result import CONVERGED, Rung, best, cheapest, pareto_front, slope
from halfspace import newton
from halfspace.curve import transfer
from halfspace.devices import cycle

METHODS = [*halfspace_methods(), *element_methods()]
SLOW = {"Greenwood's iteration", "FE P2, monolithic", "FE hp, monolithic"}
FILES = {"speed.csv", "speed.md"} | {f"{q}.{suffix}" for q in QUANTITIES for suffix in ("svg", "png")}


@pytest.fixture(scope="module")
def study():
    """Three rungs at most of every method that is quick about them."""
    small = [dataclasses.replace(m, steps=m.steps[:3]) for m in METHODS if m.name not in SLOW]
    return measure(1.0, quick=True, methods=small)


def rung(seconds, error, method="some"):
    return Rung(method, "", CONVERGED, seconds, 1, 1.0, {"pull_off": error})


# --- the energy lost in a cycle ---


def work_along(path, fold, landing_at, problem):
    """Integral of W from one approach to a fold on the branch that ends there, in t: alpha - fold ~ t^2."""
    end = fold.point.observables[0]
    nodes, weights = leggauss(20)
    total, x = 0.0, fold.point.x
    for t, w in zip((1 + nodes) / 2, weights / 2, strict=True):
        alpha = end + (landing_at - end) * t**2
        start = nearest(path, alpha, stable_side=landing_at > end)
        x = newton.solve(problem, transfer(*start, problem), newton.approach(alpha)).x
        total += w * problem.load(x) * 2 * t * (end - landing_at)
    return total


def nearest(path, alpha, stable_side):
    """The problem and state of the stable branch nearest to an approach: past both folds if in contact, else before."""
    stable = [(s.problem, p) for s in path.segments for p in s.points]
    folds = [i for i, ((_, a), (_, b)) in enumerate(pairwise(stable)) if a.rates[0] * b.rates[0] < 0]
    branch = stable[folds[-1] + 1 :] if stable_side else stable[: folds[0] + 1]
    problem, point = min(branch, key=lambda item: abs(item[1].observables[0] - alpha))
    return problem, point.x


@pytest.mark.parametrize("tabor", [1.0, 2.0])
def test_the_energy_lost_is_the_integral_of_the_load_round_the_loop(tabor):
    path = halfspace.trace(tabor, rtol=1e-7)
    on, off = path.stages[-1]["jump_on"], path.stages[-1]["jump_off"]
    a_on, a_off = on.point.observables[0], off.point.observables[0]
    approaching = work_along(path, on, a_off, path.stages[-1]["separated"].problem)
    separating = work_along(path, off, a_on, path.stages[-1]["zero_approach"].problem)
    assert approaching + separating == pytest.approx(cycle(path).energy_lost.value, rel=1e-6)


def test_no_energy_is_lost_without_jumps():
    assert cycle(halfspace.trace(0.5, rtol=1e-3)) is None


# --- the study ---


def test_every_method_reaches_a_result_and_errors_fall_up_the_ladder(study):
    for method in study.methods:
        errors = [r.error("pull_off") for r in study.of(method.name) if r.converged]
        assert errors, method.name
        assert errors[-1] <= errors[0], method.name
    assert all(r.seconds > 0 and r.unknowns > 0 and r.worst_error < 1 for r in study.rungs if r.converged)
    assert study.yardstick > 0


def test_a_grid_too_coarse_is_recorded_with_its_reason(study):
    coarse = study.of("uniform bands")[0]
    assert "grid spacing" in coarse.outcome
    assert not coarse.converged
    assert coarse.errors == {}


def test_a_method_gives_only_what_it_can(study):
    relaxed = [r for r in study.of("simple relaxation") if r.converged]
    assert {tuple(r.errors) for r in relaxed} == {("pull_off",)}
    assert all(tuple(r.errors) == QUANTITIES for r in study.of("adaptive") if r.converged)


def test_no_jumps_below_the_critical_tabor_parameter():
    adaptive = next(m for m in METHODS if m.name == "adaptive")
    found = measure(0.5, quick=True, methods=[dataclasses.replace(adaptive, steps=adaptive.steps[:1])])
    assert set(found.truth) == {"pull_off"}
    assert set(found.rungs[0].errors) == {"pull_off"}


def test_a_method_stops_when_its_share_is_used_up(monkeypatch):
    monkeypatch.setattr(speed, "SHARE", {True: 0.0})
    adaptive = next(m for m in METHODS if m.name == "adaptive")
    first, second = measure(1.0, quick=True, methods=[dataclasses.replace(adaptive, steps=adaptive.steps[:2])]).rungs
    assert first.converged
    assert "left out" in second.outcome
    assert math.isnan(second.seconds)


def test_names_are_unique_and_ladders_long_enough_for_exponents():
    assert len({m.name for m in METHODS}) == len(METHODS)
    assert all(len(m.steps) >= 3 for m in METHODS)


@pytest.mark.parametrize("tabor", [0.0, 5.0, float("nan")])
def test_a_tabor_parameter_out_of_range_is_refused(tabor):
    with pytest.raises(ValueError, match=r"tabor = .* is outside 0\.05 <= tabor <= 2 .*; take 1"):
        measure(tabor)


# --- figures of merit ---


def test_the_pareto_front():
    fast, mid, slow = rung(1, 1e-1), rung(2, 1e-2), rung(9, 1e-5)
    beaten = [rung(3, 1e-2), rung(2, 5e-2), rung(1, 2e-1), rung(10, 1e-5)]
    failed = Rung("some", "", "too coarse", 0.1)
    assert pareto_front([slow, *beaten, failed, fast, mid], "pull_off") == [fast, mid, slow]
    assert pareto_front([failed], "pull_off") == []


def test_what_an_accuracy_costs():
    rungs = [rung(1, 1e-2), rung(5, 1e-4), rung(4, 5e-4), Rung("some", "", "too coarse", 0.1)]
    assert cheapest(rungs, 1e-3).seconds == 4
    assert cheapest(rungs, 1e-6) is None
    assert best(rungs).seconds == 5
    assert best(rungs, "jump_on") is None


def test_exponents():
    n = np.array([10, 20, 40, np.nan])
    assert slope(n, 3 * n**2.5) == pytest.approx(2.5)
    assert math.isnan(slope(n[:1], n[:1]))


# --- the report ---


def test_the_report_is_complete(study, tmp_path):
    out = tmp_path / "report"
    with directory_written_aside(out) as directory:
        speed_report.write(study, directory)
    assert {file.name for file in out.iterdir()} == FILES
    assert all(file.stat().st_size > 1000 for file in out.iterdir())
    assert sorted(file.name for file in tmp_path.iterdir()) == ["report"]
    rows = list(csv.DictReader((out / "speed.csv").read_text().splitlines()))
    assert len(rows) == len(study.rungs)
    for row, made in zip(rows, study.rungs, strict=True):
        assert row["method"] == made.method
        assert row["outcome"] == made.outcome
        if made.converged:
            assert float(row["yardsticks"]) == pytest.approx(made.seconds / study.yardstick, rel=0.01, abs=1)
            assert float(row["pull_off_error"]) == pytest.approx(made.error("pull_off"), rel=1e-3)
    page = (out / "speed.md").read_text()
    for needed in ("processor", "numpy", "scikit-fem", "yardstick", "to 1e-03", "to 1e-06", "exponents"):
        assert needed in page
    assert all(page.count(f"| {method.name} |") >= 4 for method in study.methods)


def test_a_directory_in_use_is_refused_before_any_work(tmp_path):
    (tmp_path / "mine").write_text("kept")
    with pytest.raises(ValueError, match=r"holds 1 files, limit 0; .* --force"), directory_written_aside(tmp_path):
        pytest.fail("the work was begun")
    with directory_written_aside(tmp_path, force=True) as directory:
        (directory / "new").write_text("new")
    assert {file.name for file in tmp_path.iterdir()} == {"mine", "new"}


@pytest.mark.parametrize(("name", "reason"), [("file", "is a file"), ("missing/out", "cannot be written")])
def test_a_directory_that_cannot_be_is_refused_before_any_work(tmp_path, name, reason):
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match=f"{reason}.*; "), directory_written_aside(tmp_path / name):
        pytest.fail("the work was begun")


def interrupted_work(out):
    with directory_written_aside(out) as directory:
        (directory / "half").write_text("")
        raise KeyboardInterrupt


@pytest.mark.parametrize("existing", [True, False])
def test_nothing_is_left_of_work_that_ends_badly(tmp_path, existing):
    out = tmp_path / "out"
    if existing:
        out.mkdir()
    with pytest.raises(KeyboardInterrupt):
        interrupted_work(out)
    assert list(out.iterdir() if existing else tmp_path.iterdir()) == []
