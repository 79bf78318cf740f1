"""The whole study as a user runs it, once, for all tests of this folder."""

import pytest
from page_tables import rows_of
from whole_runs import GREENWOOD


@pytest.fixture(scope="session")
def ran(whole):
    """The command line, and what it wrote."""
    return whole(GREENWOOD)


@pytest.fixture(scope="session")
def study(ran):
    """What it computed."""
    return ran.kept[0]


@pytest.fixture(scope="session")
def judged(ran):
    """The claims of the paper, each with its verdict."""
    return ran.kept[1]


@pytest.fixture(scope="session")
def report(ran):
    """The directory that it wrote."""
    return ran / "greenwood"


@pytest.fixture(scope="session")
def rows(report):
    """Read a table of the directory."""
    return lambda stem: rows_of(report / f"{stem}.csv")
