"""What the test files share."""

import os
from functools import partial

import pytest
from whole_runs import whole_run


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """Run a command line whole, as ``whole("fem-adhesion hard --out hard")``; see `whole_runs`."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return partial(whole_run, shared / "whole")
