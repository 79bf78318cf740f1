"""What the test files share: whole runs of commands, and an `approx` that does not swallow small numbers."""

import gc
import os
from collections.abc import Mapping
from functools import partial

import numpy as np
import pytest
from longest import LONGEST
from whole_runs import whole_run

from fem_adhesion import cli
from fem_adhesion.crosscheck import from_scratch

ORIGINAL, RELATIVE, ABSOLUTE = pytest.approx, 1e-6, 1e-12


def pytest_collection_modifyitems(items):
    """Begin with the files that take longest."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))


def pytest_collection_finish():
    """Let the collector pass over all that is loaded by now, which stays, and look at the rest less often."""
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


@pytest.fixture(autouse=True)
def _wide(monkeypatch):
    """Let tables be as wide as where there is no terminal, whatever terminal the tests are run in."""
    monkeypatch.setenv("COLUMNS", "150")


@pytest.fixture
def two_solvers(monkeypatch):
    """No fourth level: what it shows of a defect is asked of it in `test_from_scratch` and `test_compare_bodies`."""
    for rows in ("closed_forms", "equations", "events"):
        monkeypatch.setattr(from_scratch, rows, lambda *_: ())


@pytest.fixture
def refused(capsys):
    """See that a command line, in one or more parts, ends in one line of error with some words, and give that line."""

    def see(*parts, words="", code=2):
        arguments = [word for part in parts for word in (part.split() if isinstance(part, str) else [str(part)])]
        try:
            ended = cli.main(arguments)
        except SystemExit as by_parser:
            ended = by_parser.code
        out, err = capsys.readouterr()
        assert (ended, out, err.count("\n")) == (code, "", 1)
        assert words in err
        return err

    return see


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """Run a command line whole, as ``whole("fem-adhesion curve --tabor 2")``; see `whole_runs`."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return partial(whole_run, shared / "whole")


def approx(expected, rel=None, abs=None, nan_ok=False):  # noqa: A002  pytest's own name
    """As pytest's, but its absolute tolerance is 1e-12 of what is expected: alone it passes any two lengths in metres.

    A tolerance of 1e-12 itself is kept where zero is expected.
    """
    if abs is None:
        values = list(expected.values()) if isinstance(expected, Mapping) else expected
        sizes = np.abs(np.asarray(values, float))
        largest = np.max(sizes[np.isfinite(sizes)], initial=0.0)
        rel, abs = RELATIVE if rel is None else rel, ABSOLUTE * (min(1.0, largest) or 1.0)  # noqa: A001
    return ORIGINAL(expected, rel=rel, abs=abs, nan_ok=nan_ok)


pytest.approx = approx
