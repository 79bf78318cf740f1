"""The browser in which pages are tested, if there is one."""

import shutil
from contextlib import contextmanager

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
QUIET = ["disable-gpu", "disable-quic", "no-first-run", "disable-background-networking", "disable-component-update"]
FLAGS = ["--no-sandbox", *(f"--{flag}" for flag in QUIET), "--disable-sync"]

END = 600_000
"""Milliseconds after which a wait has gone wrong; a page is ready in one, on a machine that has nothing else to do."""

needed = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine; .ci/run installs it")


@contextmanager
def launched():
    """Launch it, and close it in the end."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, timeout=END)
        yield chromium
        chromium.close()
