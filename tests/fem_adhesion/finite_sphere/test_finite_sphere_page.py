"""The finite sphere's page: its answer, chart and files, and the yield of the body that is taken out of the jumps."""

import math
import sys
from dataclasses import replace
from math import log, pi

import numpy as np
import pytest
from page_tables import rows_of
from whole_sphere import sphere_operator

from fem_adhesion.common import style
from fem_adhesion.finite_sphere import page as finite_sphere_page
from fem_adhesion.finite_sphere.bulk import bulk_compliance, excess_compliance
from fem_adhesion.finite_sphere.cases import APPROACH_SCALE, CRITICAL, MODELS, Record, case_of
from fem_adhesion.finite_sphere.chart import chart, contour, in_plane, safe_from
from fem_adhesion.finite_sphere.page import SHOWN
from fem_adhesion.finite_sphere.study import Study, plan
from fem_adhesion.finite_sphere.table import CAUSES, NO_PARQUET, DeviationRow, borders, rows, write_tables
from halfspace.elastic import grid
from halfspace.values import Estimate

TABORS, RATIOS = (0.3, 1.0, 3.0), (10.0, 100.0, 1e3, 1e4)


PICTURES = {picture.stem: picture for picture in finite_sphere_page.PICTURES}


def law(mu, rho):
    return -(1 + mu / 2) / rho


def made(case):
    """Record of a case whose pull-off deviates from the half-space's by the law; the hardest sphere has no jump."""
    if case.tabor == 3.0 and case.radius_ratio == 10.0:
        reason = "the contact is as wide as its sphere; take a larger one"
        return Record(case, "refused", {}, reason, 0.1, "ContactTooWide")
    if case.model.startswith("first_jump"):
        return Record(case, "solved", {CRITICAL: Estimate(0.6 + 1 / (case.radius_ratio or 1e9), 1e-6)}, "", 0.1)
    deviation = law(case.tabor, case.radius_ratio) if case.radius_ratio else 0.0
    values = {"pull_off_load": Estimate(-5.0 * (1 + deviation), 1e-7), APPROACH_SCALE: Estimate(3.0, 0.0)}
    if case.tabor > 0.5:
        values |= {f"jump_{way}_approach": Estimate(-3.0 * (1 + 3 * deviation), 1e-7) for way in ("on", "off")}
        values |= {f"jump_{way}_load": Estimate(-2.0 * (1 + deviation), 1e-7) for way in ("on", "off")}
    return Record(case, "solved", values, "", 2.0)


@pytest.fixture(scope="module")
def records():
    return [made(case) for case in plan(TABORS, RATIOS, [0.0, 0.3, 0.45])[0]]


@pytest.fixture(scope="module", autouse=True)
def coarse_pixels():
    """Images of few pixels, which are drawn faster."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(style, "DOTS_PER_INCH", 30)
        yield


@pytest.fixture(scope="module")
def table(records):
    return rows(records)


def plane(deviations, error=0.0):
    """Rows of deviations at each of TABORS and RATIOS; absent where they are nan."""
    blank = ("all", "pull_off_load", "R dgamma", None, None, None)
    return [
        DeviationRow(mu, rho, 0.3, *blank, Estimate(value, error), "solved", "", 1.0)
        if np.isfinite(value)
        else DeviationRow(mu, rho, 0.3, *blank, None, "absent", "why", 1.0)
        for mu, line in zip(TABORS, np.asarray(deviations, float), strict=True)
        for rho, value in zip(RATIOS, line.tolist(), strict=True)
    ]


# --- the page ---


@pytest.fixture(scope="module")
def written(records, tmp_path_factory):
    """Directory of the study, with one of its pictures, that of fitted lines; the quick form has all."""
    directory, begun = tmp_path_factory.mktemp("study"), []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(finite_sphere_page, "PICTURES", [PICTURES["causes"]])
        finite_sphere_page.write(Study(records), directory, begun.append)
    assert begun == [part for part in finite_sphere_page.PARTS if part in ("table", "figure causes", "page")]
    return directory


def test_the_page_answers(written):
    page = (written / "index.html").read_text()
    assert "<strong>pull-off force</strong> if R/ε is 1000 or more (points solved, μ from 0.3 to 3)" in page
    assert "<strong>energy lost in a cycle</strong> nowhere that is known" in page
    assert "take a larger one" in page


def test_the_table_tells_from_where_on_a_deviation_is_small(written):
    """The law is (1 + mu/2)/rho; at tabor 3 the smallest sphere is refused, and at 0.3 none jumps."""
    table = rows_of(written / "safe.csv")
    lines = {(line["quantity"], line["half-space errs less than"]): line for line in table}
    for level in (0.1, 0.01, 0.001):
        for tabor in TABORS:
            least = next((f"{rho:g}" for rho in RATIOS if abs(law(tabor, rho)) < level), "none")
            least = "100" if (tabor, least) == (3.0, "10") else least
            assert lines["pull-off force", f"{100 * level:g} %"][f"R/eps at mu = {tabor:g}"] == least
    assert not any([*lines["energy lost in a cycle", "1 %"].values()][2:])


# --- the chart ---


def test_a_contour_is_the_last_crossing():
    found = plane([[-0.3, 0.001, -0.3, -0.003], [0.3, 0.1, 0.07, -0.03], [0.3, 0.1, np.nan, 0.02]])
    assert contour(found, 0.03)[1][0] == pytest.approx(1e3 * 10**0.5)  # half-way from 0.3 to 0.003, as logarithms
    assert contour(found, 0.04)[1][1] == pytest.approx(10**3.3)  # 0.3 of the way from 0.07 to -0.03
    assert contour(found, 0.05)[1][2] == pytest.approx(100 * 100 ** (log(2) / log(5)))  # over the gap
    assert np.isnan(contour(found, 0.01)[1][1])


def test_the_least_safe_ratio_is_after_the_last_point_above():
    found = plane([[-0.3, 0.001, -0.002, -0.003], [0.3, 0.1, np.nan, -0.003], [np.nan] * 4])
    assert safe_from(found, 0.01) == 1e4  # what is not known at 1e3 is not known to be safe
    assert safe_from(found, 0.5) == 1e4
    assert np.isnan(safe_from(found, 0.003))
    known = plane([[-0.3, 0.001, -0.002, -0.003], [0.3, 0.1, 0.001, -0.003], [np.nan] * 4])
    assert safe_from(known, 0.01) == 1e3
    assert safe_from(known, 0.5) == 10.0
    assert np.isnan(safe_from(plane([[0.009] * 4] * 3, error=0.002), 0.01)), "within its error it may be above"
    assert np.isnan(safe_from(plane([[np.nan] * 4] * 3), 0.01))


def test_the_drawn_contour_is_that_of_the_deviations(records):
    figure = chart(Study(records))
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


def test_a_point_is_marked_by_how_it_ended(records):
    endings = {  # by Tabor parameter and R/eps
        (0.3, 10.0): ("refused", "ContactTooWide", "no solution: contact as wide as the sphere"),
        (1.0, 100.0): ("refused", "NotConverged", "not solved: NotConverged"),
        (3.0, 1e3): ("left out", "InputError", r"not tried: $R < 1.5\,\beta$"),
        (3.0, 10.0): ("died", "", "not solved: its process died"),
    }
    changed = [
        Record(r.case, *endings[at][:1], {}, "why", 0.0, endings[at][1])
        if (at := (r.case.tabor, r.case.radius_ratio)) in endings
        else r
        for r in records
    ]
    axes = chart(Study(changed)).axes[0]
    for at, (*_, label) in endings.items():
        assert np.transpose(line_of(axes, label)).tolist() == [list(at)]
    assert {tuple(point) for point in np.transpose(line_of(axes, "solved"))} == {
        (mu, rho) for mu in TABORS for rho in RATIOS if (mu, rho) not in endings
    }


def test_the_border_of_the_jumps_is_drawn_where_it_is(records):
    axes = chart(Study(records)).axes[1]
    half_space, *spheres = borders(records)
    assert (half_space.case.radius_ratio, half_space.values[CRITICAL].value) == (None, pytest.approx(0.6))
    assert [border.case.radius_ratio for border in spheres] == [*RATIOS] * 3
    tabor, ratio = line_of(axes, "jumps begin, fixed grips")
    np.testing.assert_allclose(ratio, RATIOS)
    np.testing.assert_allclose(tabor, 0.6 + 1 / np.array(RATIOS))


# --- figures: what an axis says is what is drawn along it ---


LOADS_AND_JUMPS = ("pull_off_load", "jump_on_approach", "jump_on_load", "jump_off_approach", "jump_off_load")


def values_of(case):
    """Every number of the study another, by model and point."""
    model = list(MODELS).index(case.model) + 1
    size = 1e-3 * model * (1 + (case.tabor or 0.0)) * (1 + (case.poisson or 0.0)) / np.sqrt(case.radius_ratio or 1.0)
    names = (*LOADS_AND_JUMPS, "hysteresis", "zero_load_radius")
    scale = 1.0 if case.radius_ratio else 0.0
    return {APPROACH_SCALE: Estimate(11.0, 0.0)} | {
        name: Estimate(-(2 + n) * (1 - scale * size * (1 + 0.1 * n)), 1e-9 * (1 + n)) for n, name in enumerate(names)
    }


def study_of(values):
    """Study of which each case has its values, and nothing is known of where the jumps begin."""
    cases = [case for case in plan(TABORS, RATIOS, [0.0, 0.3])[0] if not case.model.startswith("first_jump")]
    return Study([Record(case, "solved", values(case), "", 1.0) for case in cases])


@pytest.fixture(scope="module")
def distinct():
    """Results whose values are all distinct."""
    return study_of(values_of)


def expected_deviation(cause, quantity, tabor, ratio, poisson):
    model, baseline = MADE_OF[cause]
    value, base, scale = (
        values_of(case_of(name, tabor, ratio, poisson, 1e-5))[quantity].value
        for name in (model, baseline, "half_space")
    )
    return (value - base) / (11.0 if quantity.endswith("_approach") else scale)


MADE_OF = {
    "profile": ("true_profile", "half_space"),
    "body": ("finite_body", "half_space"),
    "all": ("sphere", "half_space"),
    "grip": ("bonded", "sphere"),
    "traction": ("surface_traction", "sphere"),
    "strain": ("finite_strain", "sphere"),
    "normal": ("finite_strain_normal", "finite_strain"),
    "reference": ("finite_strain_reference", "finite_strain"),
}


def test_each_cause_compares_the_models_that_differ_by_it(distinct):
    assert set(CAUSES) == set(MADE_OF)
    seen = set()
    for row in distinct.rows:
        if row.quantity.endswith("_less_bulk"):
            continue
        at = row.tabor, row.radius_ratio, row.poisson
        assert row.deviation.value == pytest.approx(expected_deviation(row.cause, row.quantity, *at), rel=1e-9)
        assert row.value == values_of(case_of(CAUSES[row.cause].model, *at, 1e-5))[row.quantity]
        seen.add(row.cause)
    assert seen == set(MADE_OF)


TEXTS = ("cause", "quantity", "unit", "status", "reason", "kind")


def test_csv_and_parquet_hold_each_number_with_its_error(distinct, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    assert write_tables(distinct.rows, tmp_path) == ""
    lines = rows_of(tmp_path / "finite_sphere.csv")
    plain = [{name: x if name in TEXTS else float(x) if x else None for name, x in line.items()} for line in lines]
    assert parquet.read_table(tmp_path / "finite_sphere.parquet").to_pylist() == plain
    for row, line in zip(distinct.rows, lines, strict=True):
        for name in ("value", "baseline", "half_space", "deviation"):
            number = getattr(row, name)
            assert (float(line[name]), float(line[f"{name}_error"])) == (number.value, number.error), name
        assert (float(line["tabor"]), float(line["radius_ratio"])) == (row.tabor, row.radius_ratio)
        assert line["poisson"] == ("" if row.poisson is None else str(row.poisson))
        assert [line[name] for name in TEXTS] == [getattr(row, name) for name in TEXTS]


def test_without_the_library_the_csv_alone_is_written(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert write_tables([], tmp_path) == NO_PARQUET
    assert [file.name for file in tmp_path.iterdir()] == ["finite_sphere.csv"]


def drawn(results, stem):
    assert not PICTURES[stem].lacks(results)
    return PICTURES[stem].draw(results).axes


ILL_POSED = {("strain", 3.0, 10.0)}
"""Cause and sphere too small for its Tabor parameter at finite strain, as `fem_adhesion.finite_sphere.cases` says."""


def test_the_axes_of_the_causes_say_what_is_drawn(distinct):
    axes = drawn(distinct, "causes")
    assert [panel.get_title() for panel in axes] == [rf"$\mu = {mu:g}$" for mu in TABORS]
    for mu, panel in zip(TABORS, axes, strict=True):
        assert panel.get_xlabel() == r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
        assert panel.get_ylabel() in ("|relative deviation from the half-space|", "")
        for cause in ("all", "profile", "body", "grip", "traction", "strain"):
            label = CAUSES[cause].label
            assert label.startswith(f"{cause}: ")
            at = sorted(np.transpose(line_of(panel, label)).tolist(), reverse=True)
            wanted = [
                (np.sqrt(mu / rho), abs(expected_deviation(cause, "pull_off_load", mu, rho, 0.3)))
                for rho in RATIOS
                if (cause, mu, rho) not in ILL_POSED
            ]
            np.testing.assert_allclose(at, wanted, rtol=1e-9)
        low, high = panel.get_ylim()
        for line in panel.lines:
            shown = np.asarray(line.get_ydata())
            assert (shown <= high).all(), "cut off"
            assert (shown >= low).all(), "cut off"


def test_the_axes_of_poissons_ratio_say_what_is_drawn(distinct):
    axes = drawn(distinct, "poisson")
    for panel, quantity in zip(axes, ("pull_off_load", "jump_on_approach"), strict=True):
        assert panel.get_xlabel() == r"Poisson's ratio $\nu$"
        assert quantity.replace("_load", "").replace("_", "-").split("-approach")[0] in panel.get_title()
        for mu in TABORS:
            for rho in RATIOS:
                nu, size = line_of(panel, rf"$\mu = {mu:g}$, $R/\epsilon = {rho:g}$")
                np.testing.assert_allclose(nu, (0.0, 0.3))
                wanted = [abs(expected_deviation("all", quantity, mu, rho, poisson)) for poisson in nu]
                np.testing.assert_allclose(size, wanted, rtol=1e-9)


def test_the_axes_of_the_bulk_say_what_is_drawn(distinct):
    for panel, way in zip(drawn(distinct, "bulk"), ("on", "off"), strict=True):
        assert panel.get_title() == f"approach at jump-{way}"
        assert panel.get_xlabel() == r"$\beta/R = \sqrt{\mu\,\epsilon/R}$"
        quantity = f"jump_{way}_approach"
        for mu in TABORS:
            found = {
                (r.radius_ratio, r.quantity): r
                for r in distinct.rows
                if (r.tabor, r.cause, r.poisson) == (mu, "all", 0.3)
            }
            for suffix in ("", "_less_bulk"):
                wanted = [
                    (np.sqrt(mu / rho), abs(found[rho, quantity + suffix].deviation.value)) for rho in RATIOS[::-1]
                ]
                assert any(
                    len(line.get_xdata()) == len(RATIOS)
                    and np.allclose(np.transpose(line.get_data()), wanted, rtol=1e-9)
                    for line in panel.lines
                )


# --- sentences: true of absurd data, or not said ---


def deviating(law):
    """Study in which the pull-off and the approaches of a model deviate by law(case) from the half-space's."""

    def values(case):
        value = Estimate(-4.0 * (1 + (law(case) if case.radius_ratio else 0.0)), 1e-9)
        return {APPROACH_SCALE: Estimate(4.0, 0.0)} | dict.fromkeys(LOADS_AND_JUMPS, value)

    return study_of(values)


def share(case, **of_models):
    """Deviation by model, the whole falling with the size of the sphere."""
    return of_models.get(case.model, 1.0) * -0.5 / case.radius_ratio


@pytest.mark.parametrize(
    ("stem", "of_models", "told"),
    [
        ("causes", {"bonded": -7.0}, "The grip changes the force by 800 % of the whole deviation (12 points)."),
        ("causes", {"finite_body": 3.0}, "the larger part is the body's at R/eps = 10 (15 %), and the body's at"),
        ("causes", {"true_profile": 3.0}, "At mu = 1 the larger part is the profile's at R/eps = 10 (15 %)"),
        ("causes", {"surface_traction": 0.5}, "The law per true area changes it by -50 % of what the profile does"),
        ("bulk", dict.fromkeys(MODELS, -10.0), "the compression is most of it at 0 of them"),
    ],
)
def test_a_caption_tells_what_the_numbers_are(stem, of_models, told):
    assert told in PICTURES[stem].see(deviating(lambda case: share(case, **of_models)))


def test_nothing_is_concluded_from_numbers_that_are_none(tmp_path):
    found = deviating(lambda _: math.nan)
    for picture in PICTURES.values():
        assert picture.see(found)
        assert picture.lacks(found)
    finite_sphere_page.write(found, tmp_path)
    page = (tmp_path / "index.html").read_text()
    assert page.count("nowhere that is known") == len(SHOWN)
    assert "nan" not in page.partition("<footer>")[0].replace("nancy", "")


def test_a_half_space_never_good_enough_is_not_said_to_be(tmp_path, monkeypatch):
    monkeypatch.setattr(finite_sphere_page, "PICTURES", ())
    finite_sphere_page.write(deviating(lambda _: 5.0), tmp_path)
    page = (tmp_path / "index.html").read_text()
    assert page.count("at no R/ε up to 10000 for all μ from 0.3 to 3") >= 3
    assert "</strong> if R/ε" not in page


# --- the yield of the body ---


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.499])
def test_the_sliding_body_yields_as_legendre_polynomials_do(poisson):
    R = 5.0
    sphere = sphere_operator(R, poisson, 500, grid.graded(1.0, 0.02, R))
    force = sphere.weights * np.sqrt(np.maximum(1 - sphere.radii**2, 0))
    mean = force @ sphere.compliance @ (force / sphere.weights) / force.sum() ** 2
    assert excess_compliance("sliding", poisson, R) == pytest.approx((mean - 0.6) * R, abs=2e-3)


@pytest.mark.parametrize("grip", ["sliding", "bonded"])
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_the_yield_of_larger_spheres_goes_as_the_logarithm(grip, poisson):
    found = bulk_compliance(grip, poisson, 1000.0)
    step = (1 - 2 * poisson) ** 2 / (2 * pi * (1 - poisson)) * log(10)
    assert found.error < 0.05 * step
    assert abs(excess_compliance(grip, poisson, 1000.0) - found.value) < found.error
    assert found.value - bulk_compliance(grip, poisson, 100.0).value == pytest.approx(step)


def test_the_yield_of_a_small_sphere_is_within_its_error():
    for R in (3.0, 30.0):
        found = bulk_compliance("sliding", 0.3, R)
        assert abs(excess_compliance("sliding", 0.3, R) - found.value) < found.error


def test_a_deviation_whose_error_is_not_known_is_not_known(table):
    """Were it kept, no comparison with a level would find it unsafe."""
    chosen = [row for row in table if (row.cause, row.quantity, row.poisson) == ("all", "pull_off_load", 0.3)]
    unknown = [replace(row, deviation=Estimate(1e-9, math.nan)) for row in chosen if row.deviation]
    found = in_plane(unknown, "pull_off_load", 0.3)
    assert len(found) == len(unknown)
    assert not any(row.known for row in found)
    assert np.isnan(safe_from(found, 0.01))
