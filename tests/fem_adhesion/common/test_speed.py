"""The speed study: its quick form through the command line, figures of merit on made-up data, and absurd results."""

import dataclasses
import math
import re

import numpy as np
import pytest
from page_tables import rows_of

import halfspace
from fem_adhesion import HalfSpace, Hemisphere, cli, convergence
from fem_adhesion.common.page import markdown
from fem_adhesion.speed import page as speed_page
from fem_adhesion.speed import study as speed
from fem_adhesion.speed.methods import QUANTITIES, Method, all_methods
from fem_adhesion.speed.page import read_earlier
from fem_adhesion.speed.study import GROWTHS, SpeedStudy, Timing, Truth, measure, pareto_front
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from halfspace.values import Estimate

METHODS = all_methods()
PREFIX = {"half-space": "", "finite elements": "FE "}
FILES = {"speed.csv", "growth.csv", "captions.csv", "speed.md", "csv-metadata.json"} | {
    f"{q}.{suffix}" for q in QUANTITIES for suffix in ("svg", "png")
}
TRUE = {"pull_off": -5.24854818839, "jump_on": -1.62921671169, "hysteresis": 0.2507086026}  # at a Tabor parameter of 1
SIZES = {"pull_off": 5.24854818839, "jump_on": 4.81849957889, "hysteresis": 0.2507086026}
REACHED = {  # best relative error of the pull-off load on the quick ladder, at most
    "simple relaxation": 1e-3,
    "Greenwood's iteration": 3e-3,
    "uniform bands": 1e-3,
    "uniform triangles": 1e-3,
    "graded triangles": 1e-4,
    "panels, fixed grid": 2e-6,
    "adaptive": 1e-9,
    "FE P1": 3e-3,
    "FE P2": 1e-4,
    "FE P3": 2e-5,
    "FE Q2": 1e-4,
    "FE P1, clamped": 3e-3,
    "FE P2, clamped": 1e-4,
    "FE P2, monolithic": 1e-3,
    "FE hp": 1e-8,
    "FE hp, clamped": 1e-5,
    "FE hp, monolithic": 1e-3,
}


LINE = "fem-adhesion speed --out speed --quick"


@pytest.fixture(scope="module")
def run(whole):
    """Every method on its quick ladder, through the command line."""
    return whole(LINE)


@pytest.fixture(scope="module")
def rows(run):
    return rows_of(run / "speed/speed.csv")


@pytest.fixture(scope="module")
def page(run):
    return (run / "speed/speed.md").read_text()


JUDGES = {"half-space": "finite elements", "finite elements": "half-space"}


def rung(seconds, error, method="some", **more):
    return Timing(method, "", "converged", seconds, "", 1, 1.0, {"pull_off": error}, **more)


FAILED = Timing("some", "", "failed", 0.1, "on purpose")


# --- every method, as a user runs it ---


def test_the_quick_run_ends_well_and_its_files_are_there(run, page, rows):
    assert run.code == 0, run.err
    assert {file.name for file in (run / "speed").iterdir()} == FILES
    assert run.out == f"{page}written: speed/ ({len(FILES)} files)\n"
    assert "FAILED" not in page
    rungs = [(method.name, setting) for method in METHODS for setting, _ in method.steps[: method.quick]]
    assert [(row["method"], row["setting"]) for row in rows] == rungs


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
def test_each_method_is_as_accurate_as_it_is_known_to_be(method, rows):
    solved = [r for r in rows if r["method"] == method.name and r["outcome"] == "converged"]
    errors = [float(r["pull_off_error"]) for r in solved]
    assert min(errors) < REACHED[method.name]
    assert errors[-1] <= errors[0]
    assert all(float(r["seconds"]) > 0 and int(r["unknowns"]) > 20 for r in solved)
    assert [int(r["unknowns"]) for r in solved] == sorted(int(r["unknowns"]) for r in solved)


def test_clamping_tells_and_solving_whole_does_not(rows):
    """A clamped box is another body; the monolithic solver finds what the condensed one finds on the same mesh."""
    of = {(r["method"], r["setting"]): r for r in rows}
    free, clamped, whole = (of[name, "f=0.6 L=16"] for name in ("FE P2", "FE P2, clamped", "FE P2, monolithic"))
    assert float(clamped["jump_on_error"]) > 100 * float(free["jump_on_error"])
    for quantity in QUANTITIES:
        assert float(whole[f"{quantity}_error"]) == pytest.approx(float(free[f"{quantity}_error"]), rel=1e-3, abs=0)


def test_a_grid_too_coarse_is_recorded_with_its_reason(rows):
    coarse = next(r for r in rows if r["method"] == "uniform bands")
    assert coarse["outcome"] == "too coarse"
    assert re.match(r"grid spacing \S+ beta at the contact edge, radius \S+ beta, exceeds [\d.]+", coarse["reason"])
    assert {coarse[key] for key in ("unknowns", *(f"{quantity}_error" for quantity in QUANTITIES))} == {""}
    assert all(bool(r["reason"]) == (r["outcome"] != "converged") for r in rows)


def test_each_family_is_judged_by_the_other(page, rows):
    """Each row carries the uncertainty that the page gives for the other family's solution."""
    for family, judge in JUDGES.items():
        names = {m.name for m in METHODS if m.family == family}
        for truth in section(page, "The truths"):
            quantity = truth["quantity"]
            value, error = truth[f"judge of the {family}: {judge}, rtol 1e-09"].split(", error ")
            assert float(value) == pytest.approx(TRUE[quantity], abs=1e-9)
            floors = {float(r[f"{quantity}_truth_uncertainty"]) for r in rows if r["method"] in names and r["unknowns"]}
            assert [f * SIZES[quantity] for f in floors] == [pytest.approx(float(error), rel=0.5, abs=0)]


def test_a_wrong_half_space_is_not_its_own_judge(monkeypatch):
    """Every half-space solution 1 % off: the half-space is found to be off, and the truths to disagree."""
    true = halfspace.trace

    def off(tabor, **keywords):
        path = true(tabor, **keywords)
        wrong = dataclasses.replace(path.events["pull_off"], load=1.01 * path.events["pull_off"].load)
        return dataclasses.replace(path, events={**path.events, "pull_off": wrong})

    monkeypatch.setattr(halfspace, "trace", off)
    monkeypatch.setattr(speed, "TIGHTEST", 1e-5)
    adaptive = next(m for m in METHODS if m.name == "adaptive")
    found = measure(0.5, quick=True, methods=[dataclasses.replace(adaptive, quick=1)], growths=[])
    assert found.rungs[0].error("pull_off") == pytest.approx(0.01, rel=1e-2)
    assert any("the truths disagree in pull_off" in trouble for trouble in found.troubles())


def counted_method(runs, quick):
    steps = [(str(n), lambda tabor, n=n: runs.append(n) or (n, {"pull_off": tabor})) for n in range(3)]
    return Method("half-space", "counted", steps, quick)


@pytest.mark.parametrize(("quick", "expected"), [(True, [0, 1]), (False, [0, 0, 1, 1, 2])])
def test_what_is_run_depends_on_the_ladder_alone(monkeypatch, quick, expected):
    truth = Truth("finite elements", 1e-9, {"pull_off": Estimate(1.0, 1e-10)}, 1.0)
    monkeypatch.setattr(speed, "find_truths", lambda _tabor: dict.fromkeys(PREFIX, truth))
    runs = []
    measure(1.0, quick=quick, methods=[counted_method(runs, 2)], growths=[])
    assert runs == expected


@pytest.mark.parametrize(
    ("error", "status"), [(GridTooCoarse, "too coarse"), (InputError, "refused"), (NotConverged, "failed")]
)
def test_a_rung_is_recorded_by_how_it_ended(monkeypatch, error, status):
    def end(_tabor):
        raise error("on purpose")

    truth = Truth("finite elements", 1e-9, {"pull_off": Estimate(1.0, 1e-10)}, 1.0)
    monkeypatch.setattr(speed, "find_truths", lambda _tabor: dict.fromkeys(PREFIX, truth))
    found = measure(1.0, methods=[Method("half-space", "some", [("", end)], 1)], growths=[]).rungs[0]
    assert (found.status, found.reason) == (status, "on purpose")


def test_a_tabor_parameter_out_of_range_is_refused():
    with pytest.raises(InputError, match=r"tabor = .* is outside 0\.05 <= tabor <= 2; take 1"):
        measure(5.0)


# --- figures of merit ---


def test_the_front_has_what_nothing_beats():
    fast, mid, slow = rung(1, 1e-1), rung(2, 1e-2), rung(9, 1e-5)
    beaten = [rung(3, 1e-2), rung(2, 5e-2), rung(1, 2e-1), rung(10, 1e-5)]
    assert pareto_front([slow, *beaten, FAILED, fast, mid], "pull_off") == [fast, mid, slow]
    assert pareto_front([FAILED], "pull_off") == []


def test_errors_that_the_truth_cannot_tell_are_equally_accurate():
    sooner = rung(1, 2e-9, floors={"pull_off": 2e-9})
    later = rung(2, 1e-9, floors={"pull_off": 1e-9})
    assert pareto_front([rung(0.5, 1e-3), later, sooner], "pull_off") == [rung(0.5, 1e-3), sooner]


def test_each_cost_grows_by_its_own_exponent():
    """Of n unknowns: n^2 seconds, n^1.5 MiB, but for what is too little to tell, and an error of n^-3."""
    made = [
        Timing("some", "", "converged", n**2.0, "", n, n**1.5 if n > 2 else 3.9, {"pull_off": n**-3.0})
        for n in (2, 10, 100, 1000)
    ]
    assert made_study(rungs=made).exponents("some") == pytest.approx(
        {
            "time, x = unknowns": 2,
            "peak memory, x = unknowns": 1.5,
            "time, x = 1/error": 2 / 3,
            "peak memory, x = 1/error": 0.5,
        }
    )


def test_errors_below_the_truth_s_do_not_bend_the_exponents():
    made = [Timing("some", "", "converged", 10.0**n, "", 10**n, 1.0, {"pull_off": 10.0**-n}) for n in (1, 2, 3)]
    floor = {"pull_off": 1e-3}
    made = [dataclasses.replace(r, floors=floor) for r in (*made, dataclasses.replace(made[-1], seconds=1e9))]
    assert made_study(rungs=made).exponents("some")["time, x = 1/error"] == pytest.approx(1)


# --- a made-up result is read back from every table and picture ---


def made_study(rungs, truths=None, *, quick=False, methods=None):
    some = methods or (Method("half-space", "some", [(str(n), None) for n in range(4)], 2),)
    estimate = {"pull_off": Estimate(-5.0, 1e-9), "jump_on": Estimate(-1.5, 2e-9), "hysteresis": Estimate(0.25, 3e-9)}
    default = {
        "half-space": Truth("finite elements", 1e-9, estimate, 1.0),
        "finite elements": Truth("half-space", 1e-8, estimate, 1.0),
    }
    return SpeedStudy(1.0, quick, truths or default, 1e-3, tuple(some), tuple(rungs))


@pytest.fixture
def distinct():
    """Four rungs of two methods; no two values are the same."""
    methods = tuple(Method(f, "some", [("a", None), ("b", None)], 1) for f in PREFIX)
    rungs = []
    for m, method in enumerate(methods):
        for n in range(2):
            at = 2 * m + n
            errors = {q: (1 + at) * 10.0 ** -(3 + k) for k, q in enumerate(QUANTITIES)}
            floors = {q: (1 + at) * 10.0 ** -(8 + k) for k, q in enumerate(QUANTITIES)}
            rungs.append(Timing(method.name, "ab"[n], "converged", 0.5 + at, "", 100 + at, 7.0 + at, errors, floors))
    return made_study(rungs, methods=methods)


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Write a study and give its table; its figures are drawn by the quick run."""
    monkeypatch.setattr(speed_page, "draw", lambda *_: None)

    def write(made):
        speed_page.write(made, tmp_path)
        return tmp_path / "speed.csv"

    return write


def test_each_value_stands_under_its_name_in_the_csv(distinct, written):
    table = rows_of(written(distinct))
    assert len(table) == 4
    for row, made in zip(table, distinct.rungs, strict=True):
        assert (row["method"], row["setting"], row["outcome"]) == (made.method, made.setting, "converged")
        assert int(row["unknowns"]) == made.unknowns
        assert float(row["seconds"]) == made.seconds
        assert float(row["yardsticks"]) == made.seconds / 1e-3
        assert float(row["peak_mebibytes"]) == made.memory
        for q in QUANTITIES:
            assert float(row[f"{q}_error"]) == pytest.approx(made.errors[q], rel=1e-3, abs=0)
            assert float(row[f"{q}_truth_uncertainty"]) == pytest.approx(made.floors[q], rel=1e-3, abs=0)


def test_an_earlier_run_is_shown_beside_in_yardsticks(distinct, written):
    """Twice as slow a run on a machine half as fast took as many yardsticks: only what is known to differ counts."""
    slower = [dataclasses.replace(made, seconds=4 * made.seconds) for made in distinct.rungs]
    table = written(dataclasses.replace(distinct, rungs=tuple(slower), yardstick=2e-3))
    beside = read_earlier(table, 1.0)
    assert [rung.seconds for rung in beside[1]] == [2 * made.seconds / 1e-3 for made in distinct.rungs]
    study = dataclasses.replace(distinct, earlier=beside)
    text = "\n".join(lines_of_page(study))
    cells = section(text, f"The front of pull_off beside that of {table}")
    assert cells[0] == {
        "tolerance": "1e-02",
        "earlier": "1000 (some, a)",
        "now": "500 (some, a)",
        "now / earlier": "0.50",
    }
    assert cells[2] == {"tolerance": "1e-04", "earlier": "-", "now": "-", "now / earlier": "-"}
    assert "beside that of" not in "\n".join(lines_of_page(distinct))
    for axes in speed_page.error_against_time(study, "pull_off").axes:
        now, before = (next(x for x in axes.lines if word in x.get_label()) for word in ("all methods", "earlier"))
        np.testing.assert_allclose(before.get_xdata(), 2 * np.array(now.get_xdata()))
        np.testing.assert_allclose(before.get_ydata(), now.get_ydata(), rtol=1e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("yardsticks", "ells"), "cannot be read as the table of a speed study: KeyError 'yardsticks'; give speed.csv"),
        ((",500,", ",much,"), "cannot be read as the table of a speed study: ValueError"),
        ((",500,", ",inf,"), "has no time or no error"),
        (("converged", "failed"), "has 0 rungs with a result"),
    ],
)
def test_what_is_no_earlier_run_is_refused(distinct, written, change, told):
    file = written(distinct)
    with pytest.raises(InputError, match="at tabor 1, limit: some at 2"):
        read_earlier(file, 2.0)
    with pytest.raises(InputError, match="cannot be read as CSV: No such file"):
        read_earlier(file.with_name("other.csv"), 1.0)
    file.write_text(file.read_text().replace(*change))
    with pytest.raises(InputError, match=told):
        read_earlier(file, 1.0)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_axes_are_labelled_with_what_is_drawn_along_them(distinct, quantity):
    figure = speed_page.error_against_time(distinct, quantity)
    words = {"pull_off": "pull-off load", "jump_on": "jump-on approach", "hysteresis": "energy lost"}
    assert words[quantity] in figure.axes[0].get_ylabel()
    assert "error" in figure.axes[0].get_ylabel()
    assert "Tabor parameter 1" in figure._suptitle.get_text()
    for axes, family in zip(figure.axes, PREFIX, strict=True):
        assert axes.get_title().startswith(family + ", judged by the ")
        assert axes.get_title().endswith(distinct.truths[family].family)
        assert "time" in axes.get_xlabel()
        assert axes.get_xlabel().endswith(", s")
        line = next(x for x in axes.lines if x.get_label() == f"{PREFIX[family]}some")
        made = distinct.of(f"{PREFIX[family]}some")
        assert list(line.get_xdata()) == [r.seconds for r in made]
        assert list(line.get_ydata()) == [r.errors[quantity] for r in made]
        floor = next(x for x in axes.lines if "uncertainty of the truth" in x.get_label())
        truth, size = distinct.truths[family], {"pull_off": 5.0, "jump_on": 1.0, "hysteresis": 0.25}[quantity]
        assert set(floor.get_ydata()) == {truth.values[quantity].error / size}


def lines_of_page(study):
    """The page of a study."""
    return markdown(list(speed_page.parts(study)))


def section(page, title):
    lines = page[page.index(f"## {title}") :].split("\n\n")[1].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [dict(zip(cells[0], row, strict=True)) for row in cells[2:]]


def test_the_page_gives_each_cost_and_each_truth(distinct):
    text = "\n".join(lines_of_page(distinct))
    for quantity, error in zip(QUANTITIES, ("1e-03", "1e-04", "1e-05"), strict=True):
        row = section(text, f"What it costs to have {quantity}")[0]
        assert row["method"] == "some"
        assert row["to 1e-03"].startswith("0.50 s = 500 yardsticks (a)")
        assert row["best reached"] == f"{error} in 0.50 s (a)"
    costs = {q: section(text, f"What it costs to have {q}")[1]["to 1e-03"] for q in QUANTITIES}
    assert costs == {"pull_off": "-", **dict.fromkeys(QUANTITIES[1:], "2.50 s = 2500 yardsticks (a)")}
    row = section(text, "What it costs to have every")[1]
    assert (row["method"], row["to 1e-03"], row["best reached"]) == ("FE some", "-", "3e-03 in 2.50 s (a)")
    truth = section(text, "The truths")[1]
    assert truth["quantity"] == "jump_on"
    assert truth["unit"] == "eps"
    assert truth["judge of the half-space: finite elements, rtol 1e-09"] == "-1.5, error 2e-09"
    assert truth["within both errors"] == "yes"
    units = {row["quantity"]: row["unit"] for row in section(text, "The truths")}
    assert units == {"pull_off": "R dgamma", "jump_on": "eps", "hysteresis": "R dgamma eps"}


def test_an_error_below_the_truths_uncertainty_is_shown_as_such():
    hidden = rung(1.0, 2e-9, floors={"pull_off": 2e-9})
    study = made_study([hidden])
    assert "<2e-09 in 1.00 s" in "\n".join(lines_of_page(study))
    axes = speed_page.error_against_time(study, "pull_off").axes[0]
    arrows = next(line for line in axes.lines if line.get_label() == "within that uncertainty")
    assert list(arrows.get_xdata()) == [1.0]
    told = made_study([rung(1.0, 3e-9, floors={"pull_off": 2e-9})])
    assert "<" not in "\n".join(lines_of_page(told)).split("What it costs")[1]
    labels = [line.get_label() for line in speed_page.error_against_time(told, "pull_off").axes[0].lines]
    assert "within that uncertainty" not in labels


# --- absurd results find absurd sentences, or none ---


def judged(method, *statuses):
    return made_study([Timing("some", str(n), s, 1.0, f"why {n}") for n, s in enumerate(statuses)], methods=[method])


SOME = Method("half-space", "some", [("a", None)], 1)


@pytest.mark.parametrize(
    ("statuses", "troubles"),
    [
        (("too coarse", "converged"), ["some at 1: a result that is not a number"]),
        (("failed",), ["some at 0: why 0", "some: no rung has a result"]),
        (("too coarse",), ["some: no rung has a result"]),
        (("refused",), ["some: no rung has a result"]),
    ],
)
def test_what_failed_that_should_not_have(statuses, troubles):
    assert list(judged(SOME, *statuses).troubles()) == troubles
    assert list(judged(dataclasses.replace(SOME, may_diverge=True), "failed").troubles()) == []
    good, coarse = rung(1.0, 1e-3), Timing("some", "finer", "too coarse", 1.0, "spacing")
    assert list(made_study([coarse, good]).troubles()) == []
    assert list(made_study([good, coarse]).troubles()) == ["some at finer: spacing"]


def test_truths_that_disagree_are_told_first():
    truths = {
        "half-space": Truth("finite elements", 1e-9, {"pull_off": Estimate(-5.0, 1e-9)}, 1.0),
        "finite elements": Truth("half-space", 1e-9, {"pull_off": Estimate(-6.0, 1e-9)}, 1.0),
    }
    page = list(lines_of_page(made_study([rung(1.0, 1e-3)], truths)))
    assert page[3] == "FAILED where it should not have, 1 times:"
    assert page[4] == "* the truths disagree in pull_off: -5 and -6"
    assert section("\n".join(page), "The truths")[0]["within both errors"] == "NO"
    nan = {family: Truth(family, 1e-9, {"pull_off": Estimate(math.nan, 1e-9)}, 1.0) for family in PREFIX}
    assert section("\n".join(lines_of_page(made_study([], nan))), "The truths")[0]["within both errors"] == "NO"


def test_a_result_that_is_no_number_is_not_best_nor_drawn():
    absurd = made_study([rung(0.1, math.nan), rung(0.2, math.inf)])
    text = "\n".join(lines_of_page(absurd))
    assert section(text, "What it costs to have pull_off")[0]["best reached"] == "-"
    assert "FAILED" in text
    lines = speed_page.error_against_time(absurd, "pull_off").axes[0].lines
    assert [line.get_label() for line in lines] == ["uncertainty of the truth"]


def test_a_failure_is_told_first_and_ends_in_1(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(speed, "measure", lambda *_a, **_k: judged(SOME, "failed"))
    monkeypatch.setattr(speed_page, "draw", lambda *_: None)
    assert cli.main(["speed", "--out", str(tmp_path / "out")]) == 1
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "2 failed that should not have, the first: some at 0: why 0"
    page = (tmp_path / "out" / "speed.md").read_text()
    assert "FAILED where it should not have, 2 times:\n* some at 0: why 0" in page


# --- how time grows ---


def test_the_time_of_each_solver_is_told_for_all_that_grows(run, page):
    """The quick run's table has each growth's exponent, of the times in the file."""
    told = {(row["solver"], row["x"]): row for row in section(page, "How the time of the solvers")}
    rows = rows_of(run / "speed/growth.csv")
    assert set(told) == {(growth.solver, growth.grows) for growth in GROWTHS}
    for growth in GROWTHS:
        mine = [row for row in rows if (row["solver"], row["grows"]) == (growth.solver, growth.grows)]
        assert [float(row["at"]) for row in mine] == list(growth.at[:2])
        (x, y), (s, t) = growth.at[:2], (float(row["seconds"]) for row in mine)
        found = float(told[growth.solver, growth.grows]["b"])
        assert found == pytest.approx(math.log(t / s) / math.log(y / x), abs=0.02)


def test_each_growth_solves_what_it_says(monkeypatch):
    """Digits are -log10 rtol; mu and R/eps go where they should."""
    seen = []
    monkeypatch.setattr(halfspace, "trace", lambda tabor, *, rtol: seen.append((tabor, rtol)))
    monkeypatch.setattr(convergence, "trace", lambda scene, *, rtol: seen.append((scene.tabor, scene.body, rtol)))
    for growth in GROWTHS:
        growth.solve(4.0)
    block, sphere = HalfSpace(poisson=0.3), Hemisphere(radius_ratio=4.0, poisson=0.3)
    assert seen == [(1.0, 1e-4), (1.0, block, 1e-4), (4.0, 1e-5), (4.0, block, 1e-5), (1.0, sphere, 1e-5)]
