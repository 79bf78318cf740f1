"""The finite sphere's page: its answer, chart and files, and the yield of the body that is taken out of the jumps."""

import csv
from math import log, pi

import numpy as np
import pytest
from legendre_sphere import sphere_operator

from fem_adhesion.output import finite_sphere_chart, finite_sphere_plots, finite_sphere_report
from fem_adhesion.studies.bulk import FINE, bulk_compliance, coefficients, excess_compliance
from fem_adhesion.studies.finite_sphere import plan
from fem_adhesion.studies.finite_sphere_cases import Record
from fem_adhesion.studies.finite_sphere_chart import Field, contour, refused_below, rule, safe_from
from fem_adhesion.studies.finite_sphere_table import rows
from fem_adhesion.studies.finite_sphere_terms import FIXED_GRIPS, leading_terms
from halfspace.curve import Estimate

TABORS, RATIOS = (0.3, 1.0, 3.0), (10.0, 100.0, 1e3, 1e4)
TABLES = ("rules", "fits", "theories", "bulk", "failures")
FIGURES = ("chart", "causes", "poisson", "bulk")


def law(mu, rho):
    return -(1 + mu / 2) / rho


def made(case):
    """Record of a case whose pull-off deviates from the half-space's by the law; the hardest sphere has no jump."""
    if case.tabor == 3.0 and case.radius_ratio == 10.0:
        return Record(case, "refused", {}, "the sphere is as small as its contact; take a larger one", 0.1)
    deviation = law(case.tabor, case.radius_ratio) if case.radius_ratio else 0.0
    values = {"pull_off_load": Estimate(-5.0 * (1 + deviation), 1e-7)}
    if case.tabor > 0.5:
        values |= {f"jump_{way}_approach": Estimate(-3.0 * (1 + 3 * deviation), 1e-7) for way in ("on", "off")}
        values |= {f"jump_{way}_load": Estimate(-2.0 * (1 + deviation), 1e-7) for way in ("on", "off")}
    return Record(case, "solved", values, "", 2.0)


@pytest.fixture(scope="module")
def records():
    return [made(case) for case in plan(TABORS, RATIOS, [0.0, 0.3, 0.45])]


@pytest.fixture(scope="module", autouse=True)
def coarse_pixels():
    """Images of few pixels, which are drawn faster."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(finite_sphere_plots, "DOTS_PER_INCH", 30)
        yield


@pytest.fixture(scope="module")
def table(records):
    return rows(records, bulk_compliance)


def field(deviation, refused=None, tabors=TABORS, ratios=RATIOS):
    deviation = np.asarray(deviation, float)
    return Field(np.array(tabors), np.array(ratios), deviation, np.zeros_like(deviation, bool) | bool(refused))


# --- the page ---


@pytest.fixture(scope="module")
def written(records, tmp_path_factory):
    """Directory of the study, and what was begun."""
    pytest.importorskip("pyarrow")
    directory, begun = tmp_path_factory.mktemp("study"), []
    assert finite_sphere_report.write(records, directory, begun.append) == ""
    return directory, tuple(begun)


def test_the_page_answers_with_the_rule_and_all_files_are_there(written):
    directory, begun = written
    assert begun == finite_sphere_report.PARTS
    names = {f"{stem}.csv" for stem in TABLES} | {f"{stem}.{kind}" for stem in FIGURES for kind in ("svg", "png")}
    names |= {"index.html", "finite_sphere.csv", "finite_sphere.parquet"}
    assert {file.name for file in directory.iterdir()} == names
    page = (directory / "index.html").read_text()
    assert "<strong>pull-off force</strong> if R/&epsilon; &gt; 100 + 50 &mu;" in page
    assert "<strong>energy lost in a cycle</strong> nowhere that is known" in page
    assert "take a larger one" in page
    assert page.count("data:image/svg+xml;base64,") == len(FIGURES)


def test_the_figures_hold_their_words_as_text(written):
    directory, _ = written
    for stem, words in (
        ("chart", ("Tabor parameter", "toner", "no jump under fixed grips", "no solution: contact as wide")),
        ("causes", ("rigid sphere", "profile: sphere for paraboloid")),
        ("poisson", ("ratio", "pull-off force")),
        ("bulk", ("approach at jump-on", "bulk yield taken out")),
    ):
        text = (directory / f"{stem}.svg").read_text()
        for word in words:
            assert word in text
        assert (directory / f"{stem}.png").read_bytes().startswith(b"\x89PNG")


def test_a_study_in_which_nothing_was_solved_says_so(tmp_path):
    cases = plan([1.0], [10.0], [0.3])
    finite_sphere_report.write([Record(case, "died", {}, "the worker died") for case in cases], tmp_path)
    page = (tmp_path / "index.html").read_text()
    assert "pull-off force</strong> nowhere that is known" in page
    with (tmp_path / "failures.csv").open(newline="") as file:
        assert [line["reason"] for line in csv.DictReader(file)] == ["the worker died"] * len(cases)


# --- the chart ---


def test_a_contour_of_a_power_law_lies_where_the_law_has_its_value():
    mu, rho = np.array(TABORS)[:, None], np.array(RATIOS)
    found = field(0.7 * mu / rho**0.5 * [[-1], [1], [-1]])
    np.testing.assert_allclose(contour(found, 0.05), (0.7 * np.array(TABORS) / 0.05) ** 2, rtol=1e-12)


def test_a_contour_is_the_last_crossing_and_a_change_of_sign_is_no_power_law():
    found = field([[-0.3, 0.001, -0.3, -0.003], [0.3, 0.1, 0.07, -0.03], [0.3, 0.1, np.nan, 0.02]])
    assert contour(found, 0.03)[0] == pytest.approx(1e3 * 10**0.5)  # half-way from 0.3 to 0.003, as logarithms
    assert contour(found, 0.04)[1] == pytest.approx(10**3.3)  # 0.3 of the way from 0.07 to -0.03
    assert contour(found, 0.05)[2] == pytest.approx(100 * 100 ** (log(2) / log(5)))  # over the gap
    assert np.isnan(contour(found, 0.01)[1])


def test_the_least_safe_ratio_is_the_first_after_the_last_point_above():
    found = field([[-0.3, 0.001, -0.002, -0.003], [0.3, 0.1, np.nan, -0.003], [np.nan] * 4])
    assert safe_from(found, 0.01) == 1e3
    assert safe_from(found, 0.5) == 10.0
    assert np.isnan(safe_from(found, 0.003))


def test_a_rule_is_a_line_through_the_contour():
    mu, rho = np.array(TABORS)[:, None], np.array(RATIOS)
    found = rule(field(law(mu, rho)), 0.01)
    assert (found.constant, found.slope) == pytest.approx((100, 50))
    assert found.misfit < 1e-12
    assert found.tabor == (0.3, 3.0)
    with pytest.raises(ValueError, match=r"contour of 1e-06 passes 0 Tabor parameters, limit 3; "):
        rule(field(law(mu, rho)), 1e-6)
    with pytest.raises(ValueError, match=r"contour of 0.01 is \d+ % off a line, limit 25 %; "):
        rule(field(law(mu, rho) * np.array([[1], [5], [1]])), 0.01)


def test_the_drawn_contour_is_that_of_the_deviations(table):
    figure = finite_sphere_chart.chart(table, 0.3)
    pull_off, jump_on = figure.axes
    for level in (0.1, 0.01, 0.001):
        expected = (1 + np.array(TABORS) / 2) / level
        drawn, jumping = (line_of(axes, f"{100 * level:g} %") for axes in (pull_off, jump_on))
        known = np.isfinite(drawn[1])
        assert known.sum() == (2 if level == 0.1 else 3)  # the third is refused below its contour of 10 %
        np.testing.assert_allclose(drawn[1][known], expected[known], rtol=1e-3)
        last = (1 + 3 / 2) * 3 / level
        assert np.isnan(jumping[1][0])
        if level < 0.1:
            assert jumping[1][-1] == pytest.approx(last, rel=1e-3)


def line_of(axes, label):
    (line,) = (line for line in axes.lines if line.get_label() == label)
    return line.get_data()


def test_the_refused_region_ends_midway_to_the_next_point(table):
    found = finite_sphere_chart.field_of(table, "pull_off_load", 0.3)
    assert refused_below(found) == pytest.approx([np.nan, np.nan, 10**1.5], nan_ok=True)


# --- what a deviation begins with ---


def test_the_terms_are_those_of_the_cause():
    assert set(leading_terms("profile", "pull_off_load")) == {"(beta/R)^2", "eps/R"}
    assert "beta/R ln(beta/R)" in leading_terms("all", FIXED_GRIPS[0])
    assert "beta/R ln(beta/R)" not in leading_terms("grip", FIXED_GRIPS[0])
    assert "beta/R" not in leading_terms("grip", "pull_off_load", one_tabor=True)
    assert "eps/R" not in leading_terms("body", "pull_off_load", one_tabor=True)
    mu, rho = np.array([2.0]), np.array([50.0])
    terms = {**leading_terms("all", "jump_on_load"), **leading_terms("grip", "pull_off_load")}
    values = {name: float(term(mu, rho)[0]) for name, term in terms.items()}
    assert values == pytest.approx(
        {
            "beta/R": 0.2,
            "(beta/R)^2": 0.04,
            "eps/R": 0.02,
            "beta/R ln(beta/R)": 0.2 * log(0.2),
            "(beta/R)^3": 0.2**3,
            "(beta/R)^5": 0.2**5,
        }
    )


# --- the yield of the body ---


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.499])
def test_the_sliding_body_yields_as_the_sphere_in_legendre_polynomials(poisson):
    R = 5.0
    sphere = sphere_operator(R, poisson, 500)
    force = sphere.weights * np.sqrt(np.maximum(1 - sphere.radii**2, 0))
    mean = force @ sphere.compliance @ (force / sphere.weights) / force.sum() ** 2
    assert excess_compliance("sliding", poisson, R, FINE) == pytest.approx((mean - 0.6) * R, abs=2e-3)


@pytest.mark.parametrize("grip", ["sliding", "bonded"])
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_the_yield_goes_on_as_the_logarithm_to_larger_spheres(grip, poisson):
    found = bulk_compliance(grip, poisson, 1000.0)
    step = (1 - 2 * poisson) ** 2 / (2 * pi * (1 - poisson)) * log(10)
    assert found.error < 0.05 * step
    assert abs(excess_compliance(grip, poisson, 1000.0, FINE) - found.value) < found.error
    assert found.value - bulk_compliance(grip, poisson, 100.0).value == pytest.approx(step)


def test_the_yield_of_a_small_sphere_is_within_the_error_of_the_asymptote():
    for R in (3.0, 30.0):
        found = bulk_compliance("sliding", 0.3, R)
        assert abs(excess_compliance("sliding", 0.3, R, FINE) - found.value) < found.error


def test_a_bonded_body_is_the_stiffer_one_and_an_incompressible_one_has_no_logarithm():
    for poisson in (0.0, 0.3):
        assert coefficients("bonded", poisson).constant.value < coefficients("sliding", poisson).constant.value
    assert abs(coefficients("sliding", 0.499).logarithm) < 2e-6
