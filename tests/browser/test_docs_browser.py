"""The documentation in a real browser: nothing is fetched, it fits a telephone, and anyone can read it."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from test_report_browser import browser, pytestmark  # noqa: F401  a fixture, and what skips where there is none

PAGES = [
    "index.html",
    "start.html",
    "python.html",
    "generated/gallery/index.html",
    "generated/gallery/01_afm_tip.html",
    "reference/commands.html",
    "reference/files.html",
    "reference/api/halfspace.html",
    "theory/model.html",
    "theory/checks.html",
    "theory/greenwood.html",
]


@pytest.fixture(scope="module")
def site(whole):
    return whole("make docs OUT=docs") / "docs"


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_whole_narrow_and_for_everyone(name, scheme, site, browser):  # noqa: F811
    context = browser.new_context(viewport={"width": 360, "height": 800}, color_scheme=scheme)
    shown, requests = context.new_page(), []
    shown.on("request", lambda request: requests.append(request.url))
    shown.goto((site / name).as_uri())
    assert shown.evaluate("document.documentElement.scrollWidth") <= 360
    found = Axe().run(shown)
    assert found.violations_count == 0, found.generate_report()
    assert [url for url in requests if not url.startswith(("file:", "data:"))] == []
    context.close()
