"""The report in a real browser: the slider moves everything, nothing is fetched, and anyone can read it."""

import json
import re
import shutil

import pytest

from fem_adhesion import Scene
from fem_adhesion.output.report import Contents, page
from fem_adhesion.studies import crosscheck
from fem_adhesion.studies.curves import Question, solve
from fem_adhesion.studies.walk import walk

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine; .ci/run installs it")
QUIET = ["disable-gpu", "disable-quic", "no-first-run", "disable-background-networking", "disable-component-update"]
FLAGS = ["--no-sandbox", *(f"--{flag}" for flag in QUIET), "--disable-sync"]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    cases = list(crosscheck.run([Scene(1.0)], rtol=1e-2))
    contents = Contents(cases, solve(Question(Scene(2.0), "both", 1e-3)), walk(2.0, rtol=1e-3), {})
    file = tmp_path_factory.mktemp("report") / "report.html"
    file.write_text(page(contents))
    return file


@pytest.fixture(scope="module")
def stations(report):
    found = re.search(r'id="walk-data">(.*?)</script>', report.read_text(), re.S)
    return json.loads(found[1])["stations"]


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def open_page(browser, report):
    """Open the report in a window of some kind; errors and requests are kept."""
    contexts = []

    def opened(**options):
        context = browser.new_context(**options)
        contexts.append(context)
        shown = context.new_page()
        shown.problems, shown.requests = [], []
        shown.on("pageerror", lambda error: shown.problems.append(str(error)))
        shown.on("console", lambda message: shown.problems.append(message.text))
        shown.on("request", lambda request: shown.requests.append(request.url))
        shown.goto(report.as_uri())
        return shown

    yield opened
    for context in contexts:
        context.close()


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
    assert numbers(readout.inner_text())[0] == pytest.approx(stations[-2]["approach"], abs=1e-4)
    assert shown.problems == []


def test_pointing_at_the_curve_chooses_a_state(open_page, stations):
    shown = open_page()
    before, last = shown.locator("#state").input_value(), len(stations) - 1
    assert before != str(last)
    shown.locator("#curve circle.station").nth(last).hover(force=True)  # far from all others
    assert shown.locator("#state").input_value() == str(last)
    assert numbers(shown.locator("#readout").inner_text())[1] == pytest.approx(stations[last]["load"], abs=1e-4)


def test_it_opens_fast_and_alone(open_page, report):
    shown = open_page()
    assert [url for url in shown.requests if not url.startswith(("data:", report.as_uri()))] == []
    assert shown.evaluate("performance.timing.loadEventEnd - performance.timing.navigationStart") < 2000


def test_no_identifier_is_used_twice(open_page):
    shown = open_page()
    assert shown.evaluate("[...document.querySelectorAll('[id]')].map((found) => found.id).length") > 50
    twice = "[...document.querySelectorAll('[id]')].map((e) => e.id).filter((id, k, all) => all.indexOf(id) !== k)"
    assert shown.evaluate(twice) == []


def test_it_fits_a_narrow_screen(open_page):
    shown = open_page(viewport={"width": 360, "height": 800})
    assert shown.evaluate("document.documentElement.scrollWidth") <= 360


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_to_object_to(open_page, scheme):
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(open_page(color_scheme=scheme))
    assert found.violations_count == 0, found.generate_report()


def test_the_dark_page_is_dark(open_page):
    colour = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)"
    light, dark = (sum(open_page(color_scheme=scheme).evaluate(colour)) for scheme in ("light", "dark"))
    assert light > 600
    assert dark < 150
