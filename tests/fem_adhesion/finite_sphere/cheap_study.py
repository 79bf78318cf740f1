"""A study of cheap cases whose progress is seen from outside; a module of its own, which workers load at once."""

import os
import time
from pathlib import Path

from fem_adhesion.common.files import open_store
from fem_adhesion.finite_sphere import cases
from fem_adhesion.finite_sphere.cases import SphereCase

CASES = [SphereCase("half_space", tabor, rtol=1e-2) for tabor in (0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0)]


def cheap(case):
    """Half-space at a low accuracy; notes in the directory STUDY_LOG that it was begun.

    From the third on it then waits for the file STUDY_GATE, if there is to be one.
    """
    if log := os.environ.get("STUDY_LOG"):
        (Path(log) / f"{case.tabor:g}-{time.monotonic_ns()}").touch()
    gate = os.environ.get("STUDY_GATE")
    while gate and case not in CASES[:3] and not Path(gate).exists():
        time.sleep(0.01)
    return cases.compute(case)


def opened(directory, **options):
    """Store of code that does not change."""
    return open_store(directory, "code of the test", **options)
