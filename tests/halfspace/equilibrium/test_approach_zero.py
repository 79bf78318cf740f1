"""Approaches have no natural zero: no verdict may depend on where they are counted from."""

from dataclasses import replace

import pytest

import halfspace
from fem_adhesion.crosscheck import study as crosscheck
from halfspace.equilibrium.events import approach_scale

ZEROS = (0.0, 1e3, -1e3)  # eps


@pytest.fixture(scope="module")
def path():
    return halfspace.trace(2.0, rtol=1e-4)


def _counted_from(path, zero, more=0.0):
    """The same path, its approaches counted from elsewhere, and some of them off by a part of eps."""
    events = {
        name: replace(event, approach=event.approach - zero + (more if name == "jump_on" else 0.0))
        for name, event in path.events.items()
    }
    return replace(path, events=events)


def test_the_scale_is_the_spacing_and_the_events_range():
    assert approach_scale([-3.0, 1.5, -0.5]) == 5.5
    assert approach_scale([7.0]) == 1.0
    assert approach_scale([2e-9, -1e-9], 0.2e-9) == pytest.approx(3.2e-9, rel=1e-12, abs=0)


def test_the_cross_check(path):
    """Budget and verdict of every row, with a difference that the estimates do not hold."""
    tables = [
        {
            row.quantity: (row.budget, row.difference, row.verdict)
            for row in crosscheck._compare_events(_counted_from(path, z), _counted_from(path, z, 1e-3), 1e-4)
        }
        for z in ZEROS
    ]
    assert tables[0]["jump_on approach"][2] == "disagree"
    for quantity, (*numbers, verdict) in tables[0].items():
        for table in tables[1:]:
            assert table[quantity] == (*(pytest.approx(n, rel=1e-9, abs=1e-9) for n in numbers), verdict)
