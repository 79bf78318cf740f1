"""The report: everything in one page, what is missing named, bad input refused before any work."""

import csv
import json
import re

import pytest

from fem_adhesion import Scene, cli
from fem_adhesion.output.report import Contents, page, walk_data
from fem_adhesion.output.report_figures import figure
from fem_adhesion.output.report_parts import MOST_LINES, cell, read_table
from fem_adhesion.studies import crosscheck
from fem_adhesion.studies.curves import Question, solve
from fem_adhesion.studies.walk import walk


@pytest.fixture(scope="module")
def contents():
    cases = list(crosscheck.run([Scene(1.0)], rtol=1e-2))
    curves = solve(Question(Scene(2.0), "both", 1e-3))
    return Contents(cases, curves, walk(2.0, rtol=1e-3), {})


@pytest.fixture(scope="module")
def html(contents):
    return page(contents)


def data_of(html):
    return json.loads(re.search(r'id="walk-data">(.*?)</script>', html, re.S)[1])


def test_the_page_holds_verdict_tables_and_figures_and_needs_no_network(html):
    assert "The two solvers agree." in html
    assert "pull_off load" in html
    assert "<img" not in html
    assert html.count('role="img" aria-label="Load against approach at Tabor parameter 2 by finite elements') == 1
    assert not re.search(r"(src|href)=\"(https?:)?//", html)
    assert len(html.encode()) < 5 * 2**20


def test_the_levels_hold_every_quantity_with_its_verdict(contents, html):
    (case,) = contents.cases
    levels = html[html.index('id="levels"') : html.index('id="speed"')]
    assert levels.count("<td>agree</td>") == len(case.rows)
    summary = re.search(r"<td>The events</td><td>(\d+)</td><td>(\d+)</td><td>([\d.e-]+)</td>", levels)
    events = [row for row in case.rows if ":" not in row.quantity]
    assert int(summary[1]) == int(summary[2]) == len(events)
    assert float(summary[3]) == pytest.approx(max(row.difference / row.error for row in events), rel=0.05)


def test_pictures_keep_to_themselves():
    svg = b"""<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" height="9pt">
    <metadata>by</metadata><defs><style>*{color:red}</style><path id="p" d="M0 0"/></defs><script>1</script>
    <use xlink:href="#p" clip-path="url(#c)"/></svg>"""
    markup = figure(svg, "one", 'see "this" & that').markup
    assert 'id="one-p"' in markup
    assert 'xlink:href="#one-p"' in markup
    assert 'clip-path="url(#one-c)"' in markup
    assert 'role="img" aria-label="see &quot;this&quot; &amp; that"' in markup
    assert not re.search("style|script|metadata|height", markup)
    with pytest.raises(ValueError, match="the picture one is not SVG"):
        figure(b"<html/>", "one", "")


@pytest.mark.parametrize(
    ("written", "shown"),
    [("3.8573291370920526e-11", "3.857e-11"), ("1.6118266845", "1.6118266845"), ("mu = 2", "μ = 2"), ("", "")],
)
def test_numbers_of_the_machine_are_rounded_and_others_left(written, shown):
    assert cell(written) == shown


def test_lines_left_out_are_owned_to(tmp_path):
    with (tmp_path / "long.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows([["n"], *([k] for k in range(MOST_LINES + 1))])
    table = read_table(tmp_path / "long.csv", "Long")
    assert len(table.lines) == MOST_LINES
    assert table.title == f"Long (first {MOST_LINES} of {MOST_LINES + 1} lines; all are in long.csv)"
    (tmp_path / "long.csv").write_text("")
    with pytest.raises(ValueError, match=r"long\.csv is empty"):
        read_table(tmp_path / "long.csv", "Long")


def test_sections_not_computed_say_how_to(html):
    for name in ("speed", "hard", "greenwood", "finite-sphere"):
        assert f"<code>fem-adhesion {name} --out {name}</code>, then this with <code>--{name} {name}</code>" in html


def test_the_moving_figure_shows_the_path(contents, html):
    data, walked = data_of(html), contents.walk
    assert len(data["stations"]) == len(walked.path.points) + len(walked.path.events)
    shown = {station["name"]: station for station in data["stations"] if station["name"]}
    for name, event in walked.path.events.items():
        station = shown[name.replace("_", " ")]
        assert station["approach"] == pytest.approx(event.approach, abs=2e-3)
        assert station["load"] == pytest.approx(event.load, abs=2e-3)
    assert any(not station["stable"] for station in data["stations"])
    assert data_of(f'id="walk-data">{walk_data(walked, contents.curves)}</script>') == data


def test_the_stations_of_a_walk_balance(contents):
    """Both solvers' profiles agree, and the surface rises by what closes the gap: H = -alpha* + mu u^2/2 - rise."""
    walked, mu = contents.walk, contents.walk.scene.tabor
    for station in walked.stations[::5]:
        elements, half_space = station.pressure
        assert elements == pytest.approx(half_space, abs=2e-2)
        undeformed = mu * walked.radii[::15] ** 2 / 2 - station.approach
        rise = station.lines[0][::8]  # the same radii
        assert undeformed - rise == pytest.approx(station.gap[0][::15], abs=2e-2)
    assert walked.places[::8] == pytest.approx(walked.radii[::15], abs=1e-12)


def test_a_directory_of_another_kind_is_refused_before_any_work(tmp_path, capsys):
    assert cli.main(["report", "--out", str(tmp_path / "report.html"), "--speed", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert "pull_off.svg is not there; give the directory that fem-adhesion speed --out wrote" in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_the_command_writes_the_page_with_what_other_commands_left(tmp_path, capsys):
    hard = tmp_path / "hard"
    hard.mkdir()
    (hard / "hard.csv").write_text("name,outcome\ntabor <50>,converged\n")
    (hard / "locking.csv").write_text("poisson,error\n0.3,1e-5\n")
    file = tmp_path / "report.html"
    arguments = ["report", "--out", str(file), "--tabor", "1", "--rtol", "1e-2", "--walk", "1", "--hard", str(hard)]
    assert cli.main(arguments) == 0
    assert "verdict: agree" in capsys.readouterr().out
    html = file.read_text()
    assert "<td>tabor &lt;50&gt;</td>" in html
    assert "Of 1 cases: 1 converged." in html
    assert "fem-adhesion hard --out hard" not in html
