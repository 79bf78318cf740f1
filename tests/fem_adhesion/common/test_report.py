"""The report: everything in one page, what is missing named, bad input refused before any work."""

import csv
import re
from base64 import b64decode
from dataclasses import replace
from html import unescape

import numpy as np
import pytest
from made_up import ENDINGS
from page_tables import data_of

from fem_adhesion import Scene, cli
from fem_adhesion.common.page import symbols
from fem_adhesion.crosscheck import scenes as beside
from fem_adhesion.curve.solve import Question, solve
from fem_adhesion.fields import Beside, state_at
from fem_adhesion.report import page as report_page
from fem_adhesion.report.page import MOST_ROWS, WORDS, cell, page, read_table
from fem_adhesion.report.walk import SEEN, _station, walk
from halfspace.errors import NotConverged
from halfspace.laws import LENNARD_JONES


@pytest.fixture(scope="module")
def walked():
    return walk(solve(Question(Scene(2.0), "both", 1e-3)), states=20)


@pytest.fixture(scope="module")
def html(walked):
    return page(ENDINGS["agree"], walked, {})


@pytest.fixture(scope="module", autouse=True)
def _drawn_once():
    """Curves of which there are several pages are drawn once."""
    drawn, draw = {}, report_page._curves_section
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            report_page, "_curves_section", lambda one: drawn.get(id(one)) or drawn.setdefault(id(one), draw(one))
        )
        yield


def test_the_page_holds_everything_and_needs_no_network(html):
    assert "The two solvers agree." in html
    assert "pull_off load" in html
    assert len(re.findall('<img [^>]*alt="Load against approach at Tabor parameter 2 by finite elements', html)) == 1
    assert not re.search('<img src="(?!data:)', html)
    assert not re.search(r"(src|href)=\"(https?:)?//", html)
    assert len(html.encode()) < 5 * 2**20


HOSTILE = b"""<svg xmlns="http://www.w3.org/2000/svg" onload="alert(1)"><script>alert(2)</script></svg>"""


def speed_left(directory, picture):
    """What the speed study leaves, with one of its pictures."""
    (directory / "captions.csv").write_text('figure,caption\npull_off,see "this" & that\n')
    (directory / "pull_off.svg").write_bytes(picture)
    for stem in ("speed", "growth"):
        (directory / f"{stem}.csv").write_text("a\n1\n")


def test_a_picture_enters_the_page_as_an_image(walked, tmp_path):
    speed_left(tmp_path, HOSTILE)
    html = page(ENDINGS["agree"], walked, {"speed": tmp_path})
    (shown,) = re.findall(r'<img src="data:image/svg\+xml;base64,([^"]*)" alt="see &#34;this&#34; &amp; that">', html)
    assert b64decode(shown) == HOSTILE
    assert "alert" not in html


@pytest.mark.parametrize(
    ("written", "shown"),
    [("3.8573291370920526e-11", "3.857e-11"), ("1.6118266845", "1.6118266845"), ("mu = 2", "μ = 2"), ("", "")],
)
def test_numbers_of_the_machine_are_rounded_and_others_left(written, shown):
    assert symbols(cell(written)) == shown


def test_the_title_of_a_long_table_says_what_is_left_out(tmp_path):
    with (tmp_path / "long.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows([["n"], *([k] for k in range(MOST_ROWS + 1))])
    table = read_table(tmp_path / "long.csv", "Long")
    assert len(table.rows) == MOST_ROWS
    assert table.title == f"Long (first {MOST_ROWS} of {MOST_ROWS + 1} lines; all are in long.csv)"
    (tmp_path / "long.csv").write_text("")
    with pytest.raises(ValueError, match=r"long\.csv is empty"):
        read_table(tmp_path / "long.csv", "Long")


def test_sections_not_computed_say_how_to(html):
    lines = {name: f"fem-adhesion {name} --out {name}" for name in ("speed", "greenwood", "finite-sphere")}
    for name, line in {**lines, "hard": "make hard", "peers": "make peers"}.items():
        assert f"<code>{line}</code>, then this with <code>--{name} {name}</code>" in html


def test_the_stations_of_a_walk_balance(walked):
    """Both solvers' profiles agree, and the surface rises by what closes the gap: H = -alpha* + mu u^2/2 - rise."""
    mu = walked.curves.question.scene.tabor
    for station in walked.stations[::3]:
        elements, half_space = station.pressure
        assert elements == pytest.approx(half_space, abs=2e-2)
        undeformed = mu * walked.radii[::15] ** 2 / 2 - station.approach
        rise = station.lines[0][::8]  # the same radii
        assert undeformed - rise == pytest.approx(station.gap[0][::15], abs=2e-2)
    assert walked.places[::8] == pytest.approx(walked.radii[::15], abs=1e-12)


@pytest.mark.parametrize(
    ("option", "name", "content", "words"),
    [
        ("--speed", "captions.csv", None, "captions.csv is not there; give the directory that fem-adhesion speed"),
        ("--speed", "captions.csv", b"stem,words\na,b\n", "has the columns stem, words, but not figure; "),
        ("--hard", "hard.csv", b"name,ended\na,b\n", "has the columns name, ended, but not outcome; "),
        ("--hard", "hard.csv", b"name,outcome\na\n", "line 2: 1 cells, not 2; "),
        ("--hard", "hard.csv", b"name,outcome\n\xff,b\n", "cannot be read as CSV: "),
        ("--speed", "pull_off.svg", b"<html/>", "is no SVG picture: its first element is html; "),
        ("--speed", "pull_off.svg", b"not", "is no SVG picture: syntax error"),
    ],
)
def test_what_cannot_be_read_is_refused_before_any_work(option, name, content, words, tmp_path, refused):
    (tmp_path / "locking.csv").write_text("poisson,error\n0.3,1e-5\n")
    if name.endswith("svg"):
        speed_left(tmp_path, content)
    if content is not None:
        (tmp_path / name).write_bytes(content)
    error = refused("report", "--html", tmp_path / "report.html", option, tmp_path, words=words)
    assert str(tmp_path / name) in error
    assert error.endswith("; run its command again\n") or content is None


def test_the_page_has_what_other_commands_left(walked, tmp_path, monkeypatch, capsys):
    """Solved before; `test_readme` has it solve for itself, with all that the other commands left."""
    hard = tmp_path / "hard"
    hard.mkdir()
    (hard / "hard.csv").write_text("name,outcome\ntabor <50>,converged\n")
    (hard / "locking.csv").write_text("poisson,error\n0.3,1e-5\n")
    file = tmp_path / "report.html"
    asked = solved_before(monkeypatch, walked, ENDINGS["agree"])
    options = ["--tabor", "1", "3", "--rtol", "1e-2", "--walk", "2", "--hard", str(hard)]
    assert cli.main(["report", "--html", str(file), *options]) == 0
    assert asked == [([Scene(1.0), Scene(3.0)], 1e-2), Question(Scene(2.0), "both", 1e-2), walked.curves]
    assert "verdict: agree" in capsys.readouterr().out
    html = file.read_text()
    assert "<td>tabor &lt;50&gt;</td>" in html
    assert "Of 1 cases: 1 converged." in html
    assert "make hard" not in html
    line = f"fem-adhesion report --html {file} {' '.join(options)}"
    assert f"<p>To repeat: <code>{line}</code></p>" in html


def solved_before(monkeypatch, walked, cases):
    """Let the command find what was solved before, and keep what it asks for."""
    asked = []

    def told(question, found):
        asked.append(question)
        return found

    monkeypatch.setattr(beside, "run", lambda scenes, rtol, **_: told((scenes, rtol), cases))
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", lambda question, _: told(question, walked.curves))
    monkeypatch.setattr("fem_adhesion.report.walk.walk", lambda curves, **_: told(curves, walked))
    return asked


# --- what is said, and its negation ---


def words_of(html):
    """The page as it is read: no markup, one space between words."""
    shown = re.sub(r"<(script|style).*?</\1>", "", html, flags=re.S)
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]*>", " ", shown)))


@pytest.mark.parametrize("verdict", ENDINGS)
def test_page_and_exit_code_tell_the_verdict_of_the_cases(walked, verdict, tmp_path, monkeypatch, capsys):
    solved_before(monkeypatch, walked, ENDINGS[verdict])
    code = cli.main(["report", "--html", str(tmp_path / "a.html"), "--tabor", "2"])
    assert code == (0 if verdict == "agree" else 1)
    assert capsys.readouterr().out == f"verdict: {verdict}\nwritten: {tmp_path / 'a.html'}\n"
    html = (tmp_path / "a.html").read_text()
    assert html.count(f'<p class="verdict {verdict}">') == 1
    said = unescape(re.search(r'<p class="verdict.*?</p>', html, re.S)[0])
    assert (WORDS["agree"] + "." in said) == (verdict == "agree")
    assert WORDS[verdict] in said
    for name in ("agree", "inconclusive", "disagree"):
        count = sum(row.verdict == name for case in ENDINGS[verdict] for row in case.rows)
        assert (f"; {count} quantities: {name}" in said) == bool(count)
    if verdict == "failed":
        assert "A solver failed at Tabor parameter 3. The two solvers agree at Tabor parameter 2." in said
        assert "no convergence in 40 steps; try a nearer start" in html


def test_a_curve_that_cannot_be_solved_is_said_to_be_missing(tmp_path, monkeypatch, capsys):
    def fail(*_):
        raise NotConverged("no convergence on purpose; try another day")

    monkeypatch.setattr(beside, "run", lambda *_, **__: ENDINGS["agree"])
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", fail)
    assert cli.main(["report", "--html", str(tmp_path / "a.html"), "--tabor", "2"]) == 1
    assert "verdict: failed" in capsys.readouterr().out
    html = (tmp_path / "a.html").read_text()
    assert '<p class="verdict failed">' in html
    assert "The curve was not solved." in html
    assert "Not solved: no convergence on purpose; try another day." in html
    assert "Walk along the curve</a> (not solved)" in html
    assert 'id="walk-data"' not in html


def test_what_is_said_of_the_states_is_counted(walked, html):
    unstable = sum(not station.stable for station in walked.stations)
    total = len(walked.stations)
    assert 0 < unstable < total
    said = words_of(html)
    assert f"Of {total} states {unstable} are unstable under fixed grips: hollow points." in said
    assert "unstable branch" in said
    assert "the half-space has no such state" not in said
    turned = replace(walked, stations=tuple(replace(one, stable=not one.stable) for one in walked.stations))
    assert f"Of {total} states {total - unstable} are unstable" in words_of(page(ENDINGS["agree"], turned, {}))
    none = np.full_like(walked.radii, np.nan)
    alone = [replace(one, pressure=np.array([one.pressure[0], none])) for one in walked.stations[:3]]
    missing = replace(walked, stations=(*alone, *walked.stations[3:]))
    assert "At 3 of them the half-space has no such state." in words_of(page(ENDINGS["agree"], missing, {}))


def test_a_curve_without_jumps_is_not_said_to_have_any():
    walked = walk(solve(Question(Scene(0.5), "both", 1e-2)), states=3)
    html = page(ENDINGS["agree"], walked, {})
    said = words_of(html)
    assert f"All {len(walked.stations)} states are stable under fixed grips." in said
    assert "unstable branch" not in said
    caption = unescape(re.search(r'alt="(Load against approach at .*?)"', html)[1])
    assert not re.search("unstable|jump|fold", caption)
    assert "Pressure and gap at pull-off, zero load;" in caption


def test_the_caption_names_what_the_figure_shows(html):
    caption = unescape(re.search(r'alt="(Load against approach at .*?)"', html)[1])
    for name in (
        "JKR",
        "Maugis-Dugdale",
        "unstable",
        "half-space",
        "fold",
        "jumps under fixed grips",
        "the deformed mesh",
    ):
        assert name in caption
    assert "Pressure and gap at jump on, jump off, pull-off, zero load;" in caption


@pytest.mark.parametrize(("outcomes", "warning"), [("converged refused", ""), ("converged wrong wrong", "2 wrong.")])
def test_hard_cases_that_ended_wrong_are_said_to_have(outcomes, warning, walked, tmp_path):
    lines = [f"case {k},{outcome}" for k, outcome in enumerate(outcomes.split())]
    (tmp_path / "hard.csv").write_text("\n".join(["name,outcome", *lines, ""]))
    (tmp_path / "locking.csv").write_text("poisson,error\n0.3,1e-5\n")
    html = page(ENDINGS["agree"], walked, {"hard": tmp_path})
    assert ("Hard cases</a> (with failures)" in html) == bool(warning)
    assert ('<p class="warning">' in html) == bool(warning)
    assert warning in html


# --- the walk ---


def test_each_number_of_a_station_stands_under_its_name(walked, html):
    shown, path = data_of(html)["stations"], walked.curves.path
    assert {one["name"] for one in shown} == {"", *(name.replace("_", " ") for name in path.events)}
    stable = dict(zip(path.arclength.tolist(), path.stable.tolist(), strict=True))
    for one, station in zip(shown, walked.stations, strict=True):
        assert one["stable"] == station.stable == (station.stable if station.name else stable[station.arclength])
        for name in ("arclength", "approach", "load", "central_gap"):
            assert one[name] == pytest.approx(getattr(station, name), rel=1e-4)
        assert (one["contact_radius"] is None) == np.isnan(station.contact_radius)
    told = path.central_gap_error.max()  # gaps are drawn by polynomials in the radius, the central one is not
    for station in walked.stations:  # the gap on the axis, and the contact radius where the tension is largest
        assert station.gap[0][0] == pytest.approx(station.central_gap, abs=told)
        if not np.isnan(station.contact_radius):
            inside = station.gap[0] < LENNARD_JONES.edge_gap
            assert walked.radii[inside].max() == pytest.approx(station.contact_radius, abs=2 * walked.radii[1])


def test_profiles_are_of_elements_then_of_the_half_space(walked, monkeypatch):
    found = walked.curves.path.stages[-1]["pull_off"]
    state = state_at(Scene(2.0), found.problem, found.point, how=SEEN)
    other = Beside(np.full(state.surface.radii.size, 7.0), np.full(state.surface.radii.size, 9.0), np.zeros(4))
    monkeypatch.setattr("fem_adhesion.report.walk.half_space_beside", lambda _: other)
    radii = np.array([0.0, 0.5, 1.0])
    station = _station(state, radii, radii)
    assert station.pressure[1] == pytest.approx([7.0] * 3)
    assert station.gap[1] == pytest.approx([9.0] * 3)
    assert station.pressure[0] == pytest.approx(LENNARD_JONES.pressure(station.gap[0], 2.0), abs=1e-3)
