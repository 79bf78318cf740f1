"""The documentation is built once in a session, every script and command in it run; the pages are read here.

They are also opened in a browser: nothing is fetched, they fit a telephone, and anyone can read them.
"""

import ast
import runpy
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import chromium
import pytest
from test_make import TARGETS
from whole_runs import ROOT

import fem_adhesion
import halfspace
from fem_adhesion import cli

SCRIPTS = sorted((ROOT / "docs/gallery").glob("*.py"))
LOADED = {"img": "src", "script": "src", "link": "href", "iframe": "src", "video": "src", "source": "src"}


class Page(HTMLParser):
    """What a page links to, what it loads, and the places in it that can be linked to."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loaded, self.places, self.pictures = [], [], {""}, 0
        self.feed(file.read_text())

    def handle_starttag(self, tag, attrs):
        """Keep what a tag says."""
        found = dict(attrs)
        self.places.add(found.get("id"))
        self.pictures += "sphx-glr-single-img" in (found.get("class") or "")
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        elif found.get("rel") not in ("canonical", "search", "index", "next", "prev", "author") and tag in LOADED:
            self.loaded.append(found.get(LOADED[tag]))


@pytest.fixture(scope="module")
def site(whole):
    run = whole(TARGETS["docs"])
    assert run.code == 0, run.out + run.err
    return run / "docs"


@pytest.fixture(scope="module")
def pages(site):
    return {file: Page(file) for file in site.rglob("*.html")}


def test_every_link_within_the_pages_leads_somewhere(pages):
    for file, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if not parts.scheme:
                assert target.exists(), f"{file.name}: {link}"
                assert parts.fragment in pages[target].places if target in pages else True, f"{file.name}: {link}"


def test_nothing_is_loaded_from_elsewhere(pages, site):
    for file, page in pages.items():
        for name in filter(None, page.loaded):
            assert (file.parent / urlsplit(name).path).exists(), f"{file.name}: {name}"
    for file in (*site.rglob("*.css"), *site.rglob("*.js")):
        assert "@import url(http" not in file.read_text()
        assert "url(http" not in file.read_text()


def test_each_script_of_the_gallery_has_a_page_with_its_picture(pages, site):
    assert len(SCRIPTS) >= 14
    for script in SCRIPTS:
        assert pages[site / f"generated/gallery/{script.stem}.html"].pictures >= 1, script.name
        longest = 40  # lines of code, blank ones and comments not counted
        assert len(ast.unparse(ast.parse(script.read_text()).body[1:]).splitlines()) < longest


@pytest.mark.parametrize("package", [halfspace, fem_adhesion, halfspace.laws, halfspace.profiles, halfspace.atlas])
def test_every_public_name_is_documented(package, pages, site):
    there = pages[site / f"reference/api/{package.__name__.removeprefix('halfspace.')}.html"].places
    names = [name for name in package.__all__ if callable(getattr(package, name))]
    assert [name for name in names if f"{package.__name__}.{name}" not in there] == []


def test_every_command_has_a_section_with_its_help():
    page = (ROOT / "docs/reference/commands.md").read_text()
    for command in cli.COMMANDS:
        assert f"\n## {command.name}\n" in page
        assert f"\nfem-adhesion {command.name} --help\n" in page


def test_no_picture_is_older_than_the_code_that_draws_it():
    kept = runpy.run_path(str(ROOT / "docs/pictures/make.py"))
    assert kept["outdated"]() == [], "make gallery draws them anew"
    drawn = {f"{name}.png" for names, _ in kept["DRAWN"].values() for name in names}
    assert {file.name for file in (ROOT / "docs/pictures").glob("*.png")} == drawn


def test_a_changed_figure_is_known_by_its_digest(tmp_path):
    kept = runpy.run_path(str(ROOT / "docs/pictures/make.py"))
    digest, code = kept["digest"], tmp_path / "figure.py"
    code.write_text("width = 1\n")
    before = digest([str(code)])
    code.write_text("width = 1  # in inches\n")
    assert digest([str(code)]) == before
    code.write_text("width = 2\n")
    assert digest([str(code)]) != before


# --- in a browser ---


@pytest.fixture(scope="module")
def browser():
    with chromium.launched() as opened:
        yield opened


MAIN = [
    "index.html",
    "start.html",
    "generated/gallery/index.html",
    "generated/gallery/01_afm_tip.html",
    "reference/commands.html",
    "reference/api/halfspace.html",
    "theory/model.html",
]


@chromium.needed
@pytest.mark.parametrize(("name", "scheme"), [*((name, "light") for name in MAIN), ("start.html", "dark")])
def test_a_page_fetches_nothing_fits_a_telephone_and_axe_is_content(name, scheme, site, browser):
    from axe_playwright_python.sync_playwright import Axe

    context = browser.new_context(viewport={"width": 360, "height": 800}, color_scheme=scheme)
    shown, requests = context.new_page(), []
    shown.set_default_timeout(chromium.END)
    shown.on("request", lambda request: requests.append(request.url))
    shown.goto((site / name).as_uri())
    assert shown.evaluate("document.documentElement.scrollWidth") <= 360
    found = Axe().run(shown)
    assert found.violations_count == 0, found.generate_report()
    assert [url for url in requests if not url.startswith(("file:", "data:"))] == []
    context.close()
