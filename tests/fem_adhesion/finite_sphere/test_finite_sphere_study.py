"""The study of the finite sphere: its plan, what survives a kill, its table, its fits, and the materials."""

import json
import math
import os
import sys
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from cheap_study import CASES, opened
from processes import alive, started, wait_until

import halfspace
from fem_adhesion import Hemisphere, LinearElastic, NeoHookean, Scene
from fem_adhesion.common import files
from fem_adhesion.common.files import open_store
from fem_adhesion.common.jobs import WorkerDied
from fem_adhesion.finite_sphere import cases as finite_sphere_cases
from fem_adhesion.finite_sphere import fit as finite_sphere_fit
from fem_adhesion.finite_sphere.cases import (
    APPROACH_SCALE,
    CRITICAL,
    MODELS,
    QUANTITIES,
    Record,
    SphereCase,
    case_of,
    quantities_of,
    to_plain,
)
from fem_adhesion.finite_sphere.chart import materials
from fem_adhesion.finite_sphere.fit import leading_terms
from fem_adhesion.finite_sphere.page import all_tables
from fem_adhesion.finite_sphere.study import TABORS, Study, plan, run
from fem_adhesion.finite_sphere.table import DeviationRow, rows, sampled
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.profiles import Paraboloid, Sphere
from halfspace.theories.closed_forms import JKR_PULL_OFF
from halfspace.theories.exact_sphere import JKRSphere
from halfspace.values import Estimate


@cache
def remembered(case):
    """Solved for once: what a store does with a record is the same for one that was solved for again."""
    return finite_sphere_cases.compute(case)


def solved(case, **values):
    return Record(case, "solved", {name: Estimate(*pair) for name, pair in values.items()}, "", 2.0)


# --- the plan ---


def test_each_case_is_solved_once_though_many_points_need_it():
    cases = plan()[0]
    assert len(set(cases)) == len(cases)
    assert {case.tabor for case in cases if case.model == "half_space"} == set(TABORS)
    assert sum(case.model == "half_space" for case in cases) == len(TABORS)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        (([-1.0],), "tabor = -1 "),
        ((None, [1.0]), "radius_ratio = 1 is outside 2 <= radius_ratio <= 1e12; "),
        (([3.0, 2.0], [4.0, 100.0]), "radius_ratio = 4 is outside 2.25 tabor = 4.5 or more; "),
        ((None, [math.nan]), "radius_ratio = nan "),
        ((None, None, [0.5]), "poisson = 0.5 is outside 0 <= poisson < 0.5; "),
    ],
)
def test_inputs_out_of_range_are_refused(inputs, message):
    with pytest.raises(InputError, match=message):
        plan(*inputs)


# --- running, killing and resuming ---


ENDLESS = """
import sys; from pathlib import Path; from fem_adhesion.finite_sphere.study import run; import cheap_study as c
run(c.CASES, c.opened(Path(sys.argv[1])), jobs=2, work=c.endless)
"""


def stored_cases(directory):
    return {json.loads(f.read_text())["inputs"]["tabor"]: f for f in directory.glob("cases/[!.]*.json")}


def test_a_study_killed_under_way_computes_nothing_twice(tmp_path):
    """Killed as it had stored three cases, on two workers that are at work and end by themselves."""
    path = os.pathsep.join([str(Path(__file__).parent), *filter(None, sys.path)])  # the helpers, too
    command = [sys.executable, "-c", ENDLESS, str(tmp_path)]
    with started(command, env={**os.environ, "PYTHONPATH": path}) as study:
        wait_until(lambda: len(stored_cases(tmp_path)) == 3)
        study.kill()
        study.wait()
        wait_until(lambda: not alive(study.pid))
    asked = []
    again = run(CASES, opened(tmp_path, resume=True), jobs=1, work=lambda case: asked.append(case) or remembered(case))
    assert asked == CASES[3:]
    assert [(record.case, record.status) for record in again] == [(case, "solved") for case in CASES]


def test_a_case_whose_worker_died_is_tried_again_when_resumed(tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(
            "fem_adhesion.common.jobs.stream", lambda *_, **__: (one for one in [(CASES[0], WorkerDied("killed"))])
        )
        (died,) = run(CASES[:1], opened(tmp_path))
    assert (died.status, died.values, died.reason) == ("died", {}, "killed")
    assert run(CASES[:1], opened(tmp_path, resume=True), jobs=1, work=remembered)[0].status == "solved"


def test_a_defect_of_the_program_is_no_refusal(tmp_path):
    def defective(_):
        raise ValueError("shapes do not fit")

    with pytest.raises(ValueError, match="shapes do not fit"):
        run(CASES[:1], opened(tmp_path), jobs=1, work=defective)
    assert not stored_cases(tmp_path)


# --- the store ---


@pytest.mark.parametrize("damage", ["[1]", '{"result": {}}', "\x00\xff", "value", "error"])
def test_what_is_no_result_or_was_changed_is_computed_again_with_a_note(tmp_path, damage):
    (record,) = run(CASES[:1], opened(tmp_path), jobs=1, work=remembered)
    (file,) = stored_cases(tmp_path).values()
    content, note = json.loads(file.read_text()), f"{file} is computed again: "
    number = content["result"]["values"]["pull_off_load"]
    if damage in number:
        number[damage], note = number[damage] * 1.000001, f"{note}it has been changed"
        damage = json.dumps(content)
    file.write_text(damage, encoding="latin-1")
    asked, study = [], opened(tmp_path, resume=True)
    (again,) = run(CASES[:1], study, jobs=1, work=lambda case: asked.append(case) or remembered(case))
    assert again.values == record.values
    assert [told.startswith(note) for told in study.notes] == [True]
    clean = opened(tmp_path, resume=True)
    assert run(CASES[:1], clean, jobs=1, work=lambda _: pytest.fail("worked")) == (again,)
    assert not clean.notes
    assert asked == CASES[:1]


def test_results_of_other_code_or_format_are_computed_again(tmp_path, monkeypatch):
    run(CASES[:2], opened(tmp_path), jobs=1, work=remembered)
    later, asked = open_store(tmp_path, "edited code", resume=True), []
    run(CASES[:2], later, jobs=1, work=lambda case: asked.append(case) or remembered(case))
    assert list(later.notes) == ["2 cases computed by other code: computed again"]
    assert asked == CASES[:2]
    monkeypatch.setattr(files, "SCHEMA", files.SCHEMA + 1)
    later = open_store(tmp_path, "edited code", resume=True)
    run(CASES[:1], later, jobs=1, work=remembered)
    assert list(later.notes) == ["1 case computed by another format: computed again"]


@pytest.mark.parametrize("fresh", [False, True])
def test_only_a_fresh_study_computes_again_what_the_store_holds(tmp_path, fresh):
    run(CASES[:2], opened(tmp_path), jobs=1, work=remembered)
    seen, study = [], opened(tmp_path, resume=True)
    run(CASES[:2], study, jobs=1, work=remembered, fresh=fresh, progress=lambda *at: seen.append(at))
    assert seen[0] == ("starting", 0 if fresh else 2, 2)


def test_two_tolerances_have_a_file_each(tmp_path):
    loose, tight = SphereCase("half_space", 1.0, rtol=1e-2), SphereCase("half_space", 1.0, rtol=1e-5)
    study = opened(tmp_path)
    for number, case in enumerate((loose, tight)):
        study.put(asdict(case), to_plain(solved(case, pull_off_load=(-5.0 - number, 0.1))))
    found = run((loose, tight), opened(tmp_path, resume=True), jobs=1, work=lambda _: pytest.fail("worked"))
    assert [record.values["pull_off_load"].value for record in found] == [-5.0, -6.0]
    inputs = ("tabor", "radius_ratio", "poisson", "rtol")
    names = {study.path(asdict(replace(SphereCase("sphere", 1.0, 30.0, 0.3), **{name: 7.0}))) for name in inputs}
    assert len(names) == len(inputs)


def test_a_directory_in_use_is_refused_and_left_alone(tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(ValueError, match=r"holds 1 files, limit 0; choose another or use --resume \S+ or --force"):
        opened(tmp_path)
    with pytest.raises(
        ValueError, match=r"holds 1 files, limit 0; it is no study to resume, choose another or --force"
    ):
        opened(tmp_path, resume=True)
    with pytest.raises(InputError, match="is a file; give the name of a directory"):
        opened(tmp_path / "thesis.tex")
    with pytest.raises(InputError, match="cannot be written; choose a folder that exists"):
        opened(tmp_path / "a" / "b")
    assert opened(tmp_path, force=True).get({}) is None
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.tex"]


# --- the table ---


def study_records():
    at = (1.0, 100.0, 0.3)
    return [
        solved(case_of("half_space", *at, 1e-5), pull_off_load=(-5.0, 1e-4), jump_on_load=(-2.0, 1e-4)),
        solved(case_of("true_profile", *at, 1e-5), pull_off_load=(-4.9, 2e-4)),
        solved(case_of("sphere", *at, 1e-5), pull_off_load=(-4.8, 1e-4), jump_on_load=(-2.1, 1e-4)),
        solved(case_of("bonded", *at, 1e-5), pull_off_load=(-4.7, 3e-4), jump_on_load=(-2.2, 1e-4)),
        Record(case_of("finite_body", *at, 1e-5), "refused", {}, 'it is "stuck", so try;\nanother'),
    ]


def row_of(table, cause, quantity):
    (row,) = (row for row in table if (row.cause, row.quantity) == (cause, quantity))
    return row


def test_a_deviation_has_the_errors_of_all_three_or_says_why_there_is_none():
    table = rows(study_records())
    error = row_of(table, "grip", "pull_off_load").deviation.error
    assert error == pytest.approx((3e-4 + 1e-4 + 0.02 * 1e-4) / (5 - 1e-4))
    refused, absent = row_of(table, "body", "pull_off_load"), row_of(table, "profile", "jump_on_load")
    assert (refused.status, refused.reason) == ("refused", 'it is "stuck", so try;\nanother')
    assert (absent.status, absent.reason) == (
        "absent",
        "the case has none: it does not jump, or was solved for pull-off and jumps alone",
    )
    for row in table:
        assert (row.deviation is None) == bool(row.reason) == (row.status != "solved")


def test_the_yield_of_the_body_is_taken_out_of_the_jumps():
    at = (4.0, 100.0, 0.3)
    numbers = {"jump_on_approach": (-3.0, 1e-3), "jump_on_load": (-0.5, 1e-2)}
    records = [solved(case_of(model, *at, 1e-5), **numbers) for model in ("half_space", "sphere")]

    def bulk(grip, poisson, sphere_radius):
        return Estimate({"sliding": 1 + poisson}[grip] + sphere_radius, 0.1)

    row = row_of(rows(records, bulk), "all", "jump_on_approach_less_bulk")
    compliance, inexact = (kappa * 4.0 / 5.0 for kappa in (1.3 + 5.0, 0.1))
    assert row.value.value == pytest.approx(-3 + 0.5 * compliance)
    assert row.value.error == pytest.approx(1e-3 + 1e-2 * compliance + 0.5 * inexact)
    assert row.half_space.value == -3


# --- the fits ---


def fit(data):
    """Leading terms of the whole deviation of the pull-off load."""
    return finite_sphere_fit.fit(data, leading_terms("all", "pull_off_load"))


def synthetic(law, noise=0.0, tabors=(0.1, 0.3, 1.0, 3.0, 10.0)):
    mu, rho = (grid.ravel() for grid in np.meshgrid(tabors, np.geomspace(5, 1e5, 10)))
    exact = law(mu, rho)
    rng = np.random.default_rng(7)
    error = noise * np.abs(exact) + 1e-12
    deviation = exact + noise * np.abs(exact) * rng.uniform(-1, 1, mu.size)
    return sampled(mu, rho, np.full_like(mu, 0.3), deviation, error)


def test_the_fit_recovers_known_coefficients_from_noisy_data():
    truth = {"beta/R": 0.3, "(beta/R)^2": -0.9, "eps/R": -9 / 7}
    found = fit(synthetic(lambda mu, rho: 0.3 * np.sqrt(mu / rho) - 0.9 * mu / rho - 9 / 7 / rho, noise=0.01))
    for name, value in truth.items():
        assert abs(found.coefficients[name].value - value) <= found.coefficients[name].error
        assert found.coefficients[name].error < 0.2 * abs(value)
    assert found.points == 50
    assert found.holds_to == pytest.approx(math.sqrt(2))


def test_the_fit_says_up_to_where_it_holds():
    found = fit(synthetic(lambda mu, rho: 0.5 * np.sqrt(mu / rho) + 20 * (mu / rho) ** 2))
    assert 0.02 < found.holds_to < 0.5
    assert found.coefficients["beta/R"].value == pytest.approx(0.5, rel=0.02)
    assert abs(found.coefficients["beta/R"].value - 0.5) < found.coefficients["beta/R"].error  # what is left out pulls


def test_what_the_terms_cannot_fit_is_refused():
    with pytest.raises(ValueError, match=r"50 points leave no 6 or more within tolerance = 0.1 of a fit; "):
        fit(synthetic(lambda mu, rho: np.cos(37 * np.log(mu)) * np.cos(41 * np.log(rho))))


def made_rows(law, tabors=(0.1, 10.0), cause="profile"):
    data = synthetic(law, tabors=tabors)
    columns = zip(data.tabor, data.radius_ratio, data.deviation, data.error, strict=True)
    blank = (None, cause, "pull_off_load", "R dgamma", None, None, None)
    return [
        DeviationRow(mu, rho, *blank, Estimate(float(value), float(error)), "solved", "", 1.0)
        for mu, rho, value, error in columns
    ]


def test_the_pull_off_is_compared_with_both_theories():
    def law(mu, rho):
        return np.where(mu < 1, -9 / 7 / rho, maugis_deviation(mu, rho)) * (1 + 0.3 / rho)

    hard, soft = finite_sphere_fit.compare(made_rows(law))
    assert (hard[2], soft[2]) == (0.1, 10.0)
    assert hard[3].value == pytest.approx(-9 / 7, rel=1e-3)
    assert soft[3].value == pytest.approx(soft[1], rel=1e-2)
    assert abs(soft[3].value - soft[1]) <= soft[3].error


def maugis_deviation(mu, rho):
    return np.array(
        [JKRSphere(m, max(r, 1.01 * m)).pull_off().load / JKR_PULL_OFF - 1 for m, r in zip(mu, rho, strict=True)]
    )


# --- what a case computes ---


def test_quantities_are_those_of_the_curve():
    path = halfspace.trace(2.0, rtol=1e-4, to_load=finite_sphere_cases.TO_LOAD)
    values = quantities_of(path)
    assert values.keys() == {*QUANTITIES, APPROACH_SCALE}
    assert values[APPROACH_SCALE].value == path.approach_scale
    assert values["pull_off_load"].value == min(path.load.min(), path.events["pull_off"].load)
    events = path.events
    for name in ("pull_off_load", *(f"jump_{way}_{what}" for way in ("on", "off") for what in ("approach", "load"))):
        state, _, quantity = name.rpartition("_")
        error = getattr(events[state], f"{quantity}_error")
        assert values[name] == Estimate(getattr(events[state], quantity), error)
    assert values["zero_load_radius"] == Estimate(
        events["zero_load"].contact_radius, events["zero_load"].contact_radius_error
    )
    assert values[APPROACH_SCALE].error == 2 * max(event.approach_error for event in events.values())
    assert values["hysteresis"] == cycle(path).energy_lost
    # Fig. 2a: the energy lost is what is released less what is won back, and positive.
    assert 0 < values["hysteresis"].value < path.energy.value


SPHERE = Hemisphere(radius_ratio=30.0, poisson=0.2)
SCENES = {
    "finite_body": Scene(0.3, SPHERE, Paraboloid()),
    "sphere": Scene(0.3, SPHERE),
    "bonded": Scene(0.3, replace(SPHERE, grip="bonded")),
    "surface_traction": Scene(0.3, replace(SPHERE, material=LinearElastic(0.2, "surface"))),
}
TRACTIONS = {"finite_strain": "projected", "finite_strain_normal": "normal", "finite_strain_reference": "reference"}
AT = (0.3, 30.0, 0.2, 1e-2)


def test_every_model_solves_its_own_scene(monkeypatch):
    """What each asks of which solver: the scene, and the tolerance that it may have."""
    asked, path = [], halfspace.trace(0.3, rtol=1e-2)

    def asking(solver, found):
        return lambda *scene, **how: asked.append((solver, *scene, how)) or found

    monkeypatch.setattr(halfspace, "trace", asking("half-space", path))
    monkeypatch.setattr(finite_sphere_cases, "trace", asking("elements", path))
    monkeypatch.setattr(finite_sphere_cases, "find_jumps", asking("finite strain", path.events))
    how = {"rtol": 1e-2, "to_load": 0.5}
    rubber = {name: SCENES["sphere"].made_of(NeoHookean(0.2, traction)) for name, traction in TRACTIONS.items()}
    wanted = {
        "half_space": ("half-space", 0.3, {"profile": Paraboloid(), **how}),
        "true_profile": ("half-space", 0.3, {"profile": Sphere(30.0), **how}),
        **{name: ("elements", scene, how) for name, scene in SCENES.items()},
        **{name: ("finite strain", scene, 1e-2, {}) for name, scene in rubber.items()},
    }
    for name in (name for name in MODELS if not name.startswith("first_jump")):
        found = finite_sphere_cases.compute(case_of(name, *AT)).values["pull_off_load"]
        assert found == path.events["pull_off"].estimate("load")
        assert asked.pop() == wanted.pop(name), name
        body = (SCENES | rubber)[name].body if name in SCENES | rubber else None
        assert MODELS[name].grip == getattr(body, "grip", None), "what the body yields as a whole is of this grip"
    assert not wanted


def test_a_small_sphere_may_never_jump():
    never = finite_sphere_cases.compute(case_of("first_jump", None, 2.0, 0.3, 1e-4))
    assert (never.status, never.values) == ("solved", {})
    (table,) = (table for table in all_tables(Study([never])) if table.stem == "first_jumps")
    ((*_, tabor, error, why),) = table.rows
    assert (tabor, error) == ("", "")
    assert why.startswith("it does not jump")


def test_the_border_s_error_holds_what_finer_elements_change():
    case = case_of("first_jump", None, 30.0, 0.2, 1e-4)
    found = finite_sphere_cases.compute(case).values[CRITICAL]
    finer = MODELS["first_jump"].solve(case, degrees=(7, 8))[CRITICAL]
    assert abs(finer.value - found.value) <= found.error
    assert finer.error < found.error < 1e-4


# --- materials ---


def test_a_material_stands_where_its_own_numbers_put_it():
    _, silica = next(materials())
    assert silica.tabor == pytest.approx(
        np.cbrt(1e-8 * (0.063 * (1 - 0.17**2) / 7.2e10) ** 2) / silica.spacing, rel=1e-12
    )
    assert silica.tabor == pytest.approx(0.1353, abs=5e-4)
    assert silica.radius_ratio == pytest.approx(69.8, abs=0.1)
