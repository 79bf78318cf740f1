"""The report in a real browser: the slider moves everything, nothing is fetched, and anyone can read it."""

import json
import re
from dataclasses import replace

import chromium
import numpy as np
import pytest
from chromium import END
from made_up import ENDINGS
from page_tables import data_of

from fem_adhesion import Scene
from fem_adhesion.common.page import Figure, Section, write_page
from fem_adhesion.curve.solve import Question, solve
from fem_adhesion.report.page import page
from fem_adhesion.report.walk import walk

pytestmark = chromium.needed


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """A page whose half-space is another by far, so that its lines are told from those of the elements."""
    curves = solve(Question(Scene(2.0), "both", 1e-3))
    walked = walk(curves, states=10)
    scaled = [
        replace(one, pressure=one.pressure * [[1.0], [0.5]], gap=one.gap * [[1.0], [0.7]]) for one in walked.stations
    ]
    file = tmp_path_factory.mktemp("report") / "report.html"
    file.write_text(page(ENDINGS["agree"], replace(walked, stations=tuple(scaled)), {}))
    return file


@pytest.fixture(scope="module")
def data(report):
    return data_of(report.read_text())


@pytest.fixture(scope="module")
def stations(data):
    return data["stations"]


@pytest.fixture(scope="module")
def browser():
    with chromium.launched() as opened:
        yield opened


@pytest.fixture
def open_page(browser, report):
    """Open the report in a window of some kind; errors and requests are kept."""

    def opened(**options):
        shown = browser.new_context(**options).new_page()
        shown.set_default_timeout(END)
        shown.set_default_navigation_timeout(END)
        shown.problems, shown.requests = [], []
        shown.on("pageerror", lambda error: shown.problems.append(str(error)))
        shown.on("console", lambda message: shown.problems.append(message.text))
        shown.on("request", lambda request: shown.requests.append(request.url))
        shown.goto(report.as_uri())
        return shown

    return opened


def chosen(shown, number):
    """Wait until a state is chosen."""
    shown.wait_for_function("number => document.getElementById('state').value === String(number)", arg=number)


def numbers(text):
    return [float(found) for found in re.findall(r"= (-?[\d.]+)", text)]


def test_the_slider_walks_the_curve_by_key_and_by_value(open_page, stations):
    shown = open_page()
    slider, readout = shown.locator("#state"), shown.locator("#readout")
    assert slider.get_attribute("max") == str(len(stations) - 1)
    drawn = set()
    for number in (0, len(stations) // 2, len(stations) - 1):
        slider.fill(str(number))
        station = stations[number]
        assert numbers(readout.inner_text()) == pytest.approx(
            [station["approach"], station["load"], station["central_gap"]], abs=1e-4
        )
        drawn.add(tuple(shown.locator(f"#{name} g path.fe").first.get_attribute("d") for name in ("pressure", "body")))
    assert len(drawn) == 3
    slider.focus()
    shown.keyboard.press("ArrowLeft")
    chosen(shown, len(stations) - 2)
    assert numbers(readout.inner_text())[0] == pytest.approx(stations[-2]["approach"], abs=1e-4)
    assert shown.problems == []


def test_pointing_at_the_curve_chooses_a_state(open_page, stations):
    shown = open_page()
    before, last = shown.locator("#state").input_value(), len(stations) - 1
    assert before != str(last)
    shown.locator("#curve circle.station").nth(last).hover(force=True)  # far from all others
    chosen(shown, last)
    assert numbers(shown.locator("#readout").inner_text())[1] == pytest.approx(stations[last]["load"], abs=1e-4)


def test_it_opens_alone(open_page, report):
    shown = open_page()
    shown.wait_for_load_state("networkidle")
    assert [url for url in shown.requests if not url.startswith(("data:", report.as_uri()))] == []
    assert shown.problems == []


def places(path):
    """Points of a path's d."""
    return [tuple(map(float, pair)) for pair in re.findall(r"[ML](-?[\d.]+) (-?[\d.]+)", path)]


def slope(drawn, values):
    """Slope of drawn places along values, of which they are a linear scale."""
    found, start = np.polyfit(values, drawn, 1)
    assert np.abs(found * np.array(values) + start - drawn).max() < 0.1
    return found


def test_the_lines_of_each_solver_are_its_own_numbers(open_page, stations, data):
    shown = open_page()
    number = next(k for k, one in enumerate(stations) if one["name"] == "pull off")
    shown.locator("#state").fill(str(number))
    for panel in ("pressure", "gap"):
        scales = []
        for kind, row in (("fe", 0), ("hs", 1)):
            x, y = zip(*places(shown.locator(f"#{panel} g path.{kind}").first.get_attribute("d")), strict=True)
            assert slope(x, data["radii"]) > 0
            scales.append(slope(y, stations[number][panel][row]))
        assert max(scales) < 0  # pixels count downwards
        assert scales[0] == pytest.approx(scales[1], rel=1e-2)
        x, y = zip(*places(shown.locator(f"#{panel} g path.hs").first.get_attribute("d")), strict=True)
        assert np.polyfit(stations[number][panel][0], y, 1)[0] != pytest.approx(scales[0], rel=0.1)


def test_points_are_load_against_approach_hollow_if_unstable(open_page, stations):
    shown = open_page()
    circles = shown.locator("#curve circle.station")
    assert circles.count() == len(stations)
    found = circles.evaluate_all(
        "all => all.map(c => [+c.getAttribute('cx'), +c.getAttribute('cy'), c.className.baseVal])"
    )
    assert slope([x for x, _, _ in found], [one["approach"] for one in stations]) > 0
    assert slope([y for _, y, _ in found], [one["load"] for one in stations]) < 0
    assert [kind == "station" for _, _, kind in found] == [one["stable"] for one in stations]
    assert not all(one["stable"] for one in stations)
    captions = [text.split("(")[0] for text in shown.locator(".panels figcaption").all_inner_texts()]
    assert captions == ["Load W ", "Sphere and body near the contact: height ", "Pressure P ", "Gap H "]
    against = [text.split(" against ")[1].split()[0] for text in shown.locator(".panels figcaption").all_inner_texts()]
    assert against == ["approach", "radius", "radius", "radius"]


def test_curves_are_load_against_approach_marked_if_unstable(browser, report):
    """On a page whose half-space bears twice the load; along the scales of the points."""
    text, changed = report.read_text(), report.with_name("changed.html")
    data = data_of(text)
    fe, hs = data["curves"]
    hs["load"] = [2 * load for load in hs["load"]]
    before, old, after = re.split(r'(?<=id="walk-data">)(.*?)(?=</script>)', text, maxsplit=1, flags=re.S)
    assert old
    changed.write_text(before + json.dumps(data) + after)
    shown = browser.new_page()
    shown.goto(changed.as_uri())
    scale = "all => all.map(c => [+c.getAttribute('cx'), +c.getAttribute('cy')])"
    at = np.transpose(shown.locator("#curve circle.station").evaluate_all(scale))
    x, y = (
        np.polyfit([one[name] for one in data["stations"]], at[k], 1) for k, name in enumerate(["approach", "load"])
    )
    unstable = shown.locator("#curve path.unstable")
    drawn = [shown.locator("#curve path.fe"), unstable.nth(0), shown.locator("#curve path.hs"), unstable.nth(1)]
    wanted = [(curve, kind) for curve in (fe, hs) for kind in (False, True)]
    for line, (curve, kind) in zip(drawn, wanted, strict=True):
        kept = np.array(curve["unstable"]) == kind
        expected = np.polyval(x, np.array(curve["approach"])[kept]), np.polyval(y, np.array(curve["load"])[kept])
        assert np.transpose(places(line.get_attribute("d"))) == pytest.approx(np.array(expected), abs=0.2)


def test_the_state_is_said_to_be_what_it_is(open_page, stations):
    shown = open_page()
    for number, one in enumerate(stations):
        shown.locator("#state").fill(str(number))
        said = shown.locator("#readout").inner_text()
        assert ("unstable under fixed grips" in said) == (not one["stable"])
        assert ("contact radius none" in said) == (one["contact_radius"] is None)


def test_a_picture_is_shown_and_runs_nothing(browser, report):
    """A picture of another hand: it has a size, and its scripts no effect on the page."""
    title = "parent.document.title = document.title = 'run'"
    picture = f"""<svg xmlns="http://www.w3.org/2000/svg" width="30pt" height="12pt" onload="{title}">
    <script>{title}</script><rect width="9" height="9" onclick="{title}"/></svg>"""
    shown = Section("one", "One", figures=[Figure(picture.encode(), "a square")])
    write_page(report.parent, "A page", [], [shown], "no time")
    opened = browser.new_page()
    opened.goto((report.parent / "index.html").as_uri())
    image = opened.get_by_alt_text("a square")
    image.click()
    assert image.evaluate("one => [one.complete, one.naturalWidth, one.naturalHeight]") == [True, 40, 16]
    assert opened.title() == "A page"


def test_it_fits_a_narrow_screen(open_page):
    shown = open_page(viewport={"width": 360, "height": 800})
    assert shown.evaluate("document.documentElement.scrollWidth") <= 360


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_to_object_to(open_page, scheme):
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(open_page(color_scheme=scheme))
    assert found.violations_count == 0, found.generate_report()
