"""The study after Greenwood (1997) through the command line, quick: files read back, printed numbers met."""

import contextlib
import csv
import dataclasses
import io
import math
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from fem_adhesion import cli
from fem_adhesion.studies import greenwood1997
from fem_adhesion.studies.greenwood_criteria import JumpOn, fit
from fem_adhesion.studies.greenwood_tables import LAST_DIGIT, ROUNDED
from halfspace import criteria
from halfspace.contact import CENTRAL_GAP
from halfspace.curve import Estimate

DATA = Path(__file__).parent / "data"
FIGURES = ("1a", "1b", "1c", "2a", "2b", "3a", "3b", "3c", "4a", "4b", "5", "6a", "6b", "7", "8")
TABLES = (
    "table_1",
    "table_2",
    "fig_4_checks",
    "jumps",
    "devices",
    "relaxation",
    "pull_off",
    "coarse_grids",
    "criteria",
    "criteria_constants",
)


@dataclasses.dataclass(frozen=True)
class Run:
    """What one quick run left."""

    code: int
    printed: str
    out: Path
    study: greenwood1997.Greenwood1997
    told: list


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """The whole study as a user runs it."""
    kept, told, out, printed = [], [], tmp_path_factory.mktemp("greenwood") / "out", io.StringIO()
    compute = greenwood1997.compute

    def keeping(*, quick, progress):
        kept.append(compute(quick=quick, progress=lambda part: (told.append(part), progress(part))))
        return kept[-1]

    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(printed):
        patch.setattr(greenwood1997, "compute", keeping)
        code = cli.main(["greenwood", "--out", str(out), "--quick"])
    return Run(code, printed.getvalue(), out, kept[0], told)


@pytest.fixture(scope="module")
def study(ran):
    return ran.study


@pytest.fixture(scope="module")
def report(ran):
    return ran.out


def rows(report, stem):
    return list(csv.DictReader((report / f"{stem}.csv").read_text().splitlines()))


def test_the_quick_run_ends_well(ran):
    assert ran.code == 0
    assert ran.printed == f"written: {ran.out / 'index.html'}\n"
    assert list(ran.study.troubles()) == []


# --- printed numbers ---


@pytest.mark.parametrize("number", [1, 2])
def test_the_packaged_tables_are_those_of_the_tests(number):
    name = f"greenwood1997_table{number}.csv"
    assert (Path(greenwood1997.__file__).parent / "data" / name).read_text() == (DATA / name).read_text()


def test_table_1_to_its_last_printed_digit(study):
    assert len(study.tables.table_1) == 10
    assert {p.note for p in study.tables.table_1} == {LAST_DIGIT}


def test_the_asymptote_of_table_1(study):
    a, b = study.tables.asymptote
    assert a.value == pytest.approx(1.84, abs=0.005)
    assert b.value == pytest.approx(7.7, abs=0.1)


def test_table_2_within_what_the_paper_is_off_by(study):
    """Loads and approaches to 1.2 %; gap and radius at the fold, which err by a square root, to 2.1 %."""
    assert len(study.tables.table_2) == 45
    for p in study.tables.table_2:
        fold = p.row in ("jump_off H0", "jump_off a_star")
        assert abs(p.deviation) < (0.0215 if fold else 0.0122), p
        assert p.computed.error < 1e-4 * abs(p.computed.value), p


def test_attard_and_parkers_row_to_its_last_printed_digit(study):
    notes = [p.note for p in study.tables.table_2 if p.row.endswith("_AP")]
    assert notes == [LAST_DIGIT] * 5


def test_the_row_of_the_jump_off_at_5_is_one_state_beside_the_fold(study):
    """Printed load 2.708, central gap 0.00630 and radius 0.700 belong together; no fold lies there."""
    note = next(p.note for p in study.tables.table_2 if p.row == "jump_off H0" and p.column == 5)
    assert note.startswith("a state beside the fold")
    assert "H0 = 0.00630, a* = 0.701" in note


def test_no_separated_state_exists_at_the_printed_jump_on(study):
    """The paper's approaches lie beyond the fold, at every Tabor parameter."""
    printed = [p for p in study.tables.table_2 if p.row == "jump_on minus_alpha_star"]
    assert [p.column for p in printed] == [1, 2, 3, 5, 6]
    assert all(float(p.printed) < p.computed.value - p.computed.error for p in printed)


def test_pressures_printed_with_figure_4(study):
    assert [p.note for p in study.tables.profile_checks] == [ROUNDED] * 2
    for p in study.tables.profile_checks:
        assert abs(p.computed.value - float(p.printed)) <= p.computed.error
    gaps = [profile.central_gap for profile in study.states.profiles]
    assert len(gaps) == 7
    assert gaps == pytest.approx([2.554, 1, 0.3, 0.02, 0, -0.0036, -0.01], abs=1e-9)


# --- states ---


def test_the_central_gap_falls_all_along_the_winding_curve(study):
    """Approach and load turn, the central gap never does."""
    assert all(point.rates[CENTRAL_GAP] < 0 for point in study.curves[5.0].points)


def test_jumps_land_on_the_other_branch(study):
    on, off = study.states.jumps
    assert on.landing_load.value < on.load.value < 0
    assert off.load.value < off.landing_load.value < 0
    assert max(on.landing_load.error, off.landing_load.error) < 1e-3


def test_the_winding_curve_has_four_folds(study):
    assert study.states.folds[:, 0] == pytest.approx([-4.26358, -4.52082, -4.50476, -8.18977], abs=1e-4)


def test_finite_elements_agree_with_the_half_space(study):
    both = [p for p in study.pull_offs if p.finite_element]
    assert both
    for p in both:
        allowed = p.half_space.error + p.finite_element.error
        assert abs(p.half_space.value - p.finite_element.value) < allowed < 1e-2


def test_the_pull_off_force_falls_from_bradleys_to_jkrs(study):
    loads = np.array([p.half_space.value for p in study.pull_offs])
    assert np.all(np.diff(loads) > 0)
    assert -2 * np.pi < loads[0]
    assert loads[-1] < -1.5 * np.pi


def test_coarse_uniform_triangles_raise_the_pull_off_force(study):
    """The false rise: it starts later the finer the grid, and comes with a ripple."""
    turns = []
    for rise in study.rises.values():
        forces = [-r.pull_off for r in rise.ripples]
        assert forces[-1] > min(forces)
        turns.append(rise.ripples[int(np.argmin(forces))].tabor)
    assert turns == sorted(turns)
    upward = [np.sum(np.maximum(np.diff(r.load[: r.load.argmin()]), 0)) for r in study.ripples]
    assert upward[0] > 10 * upward[-1]


def test_the_critical_tabor_parameter_to_six_digits(study):
    assert study.critical_tabor.value == pytest.approx(0.697215, abs=1e-6)
    assert study.critical_tabor.error < 5e-7


# --- criteria ---


def test_refitted_constants(study):
    fitted = {c.name: c for c in study.criteria.criteria}
    values = [e.value for c in fitted.values() for _, _, e in c.constants]
    errors = [e.error for c in fitted.values() for _, _, e in c.constants]
    assert np.all(np.isfinite(values))
    assert np.all(np.isfinite(errors))
    assert fitted["Attard & Parker"].constants[0][2].value < 3 / 2
    c, n = (constant[2].value for constant in fitted["fit (4.5)"].constants)
    assert c == pytest.approx(criteria.FIT, rel=2e-3)
    assert n == pytest.approx(criteria.FIT_REPULSION, rel=2e-2)
    assert fitted["fit of App. C"].constants[0][2].value == pytest.approx(3 * np.pi**2, rel=2e-2)


def test_a_fit_returns_the_constants_that_made_the_jumps():
    tabor = np.geomspace(1, 100, 9)
    gaps, approaches = criteria.fitted_gap(tabor), criteria.fitted_approach(tabor)
    made = fit(JumpOn(m, Estimate(a, 0.0), Estimate(g, 0.0)) for m, a, g in zip(tabor, approaches, gaps, strict=True))
    fitted = {c.name: c for c in made.criteria}
    assert [e.value for _, _, e in fitted["fit (4.5)"].constants] == pytest.approx([6.233, 1.6])
    assert fitted["fit of App. C"].constants[0][2].value == pytest.approx(3 * np.pi**2)
    assert fitted["fit of App. C"].scatter < 1e-12


# --- the report ---


def test_every_file_is_there(report):
    expected = {f"fig_{number}.{suffix}" for number in FIGURES for suffix in ("svg", "png")}
    expected |= {f"{stem}.csv" for stem in (*TABLES, "captions")} | {"index.html"}
    assert {file.name for file in report.iterdir()} == expected
    assert all((report / f"fig_{number}.png").stat().st_size > 10_000 for number in FIGURES)


def test_tables_have_printed_and_computed_side_by_side(report):
    for stem, count in (("table_1", 10), ("table_2", 45)):
        table = rows(report, stem)
        assert len(table) == count
        for row in table:
            deviation = float(row["computed"]) / float(row["printed"]) - 1
            assert float(row["relative deviation"]) == pytest.approx(deviation, rel=0.06, abs=1e-6)
            assert 0 < float(row["error"]) < 1e-3
            assert row["note"]


class Page(HTMLParser):
    """Collects images, identifiers and links, and checks that elements nest."""

    def __init__(self):
        super().__init__()
        self.images, self.ids, self.links, self.open = [], set(), [], []

    def handle_starttag(self, tag, attrs):
        """Note an element that opens."""
        attributes = dict(attrs)
        self.ids |= {attributes["id"]} if "id" in attributes else set()
        self.links += [attributes["href"]] if tag == "a" else []
        if tag == "img":
            self.images.append(attributes)
        elif tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        """Check that it is the one that opened last."""
        assert self.open.pop() == tag


def test_the_page_shows_everything(report):
    page = Page()
    page.feed((report / "index.html").read_text(encoding="utf-8"))
    assert page.open == []
    assert len(page.images) == len(FIGURES)
    assert all(len(image["alt"]) > 40 and image["src"].startswith("data:image/svg+xml") for image in page.images)
    assert {f"fig_{number}" for number in FIGURES} | set(TABLES) <= page.ids
    for link in page.links:
        assert link.startswith("https://doi.org/") or link.lstrip("#") in page.ids or (report / link).exists()


def test_progress_names_every_subject_once(study, ran):
    assert ran.told == list(greenwood1997.SUBJECTS)
    assert math.isfinite(study.seconds)
