"""Error estimates hold the truth, and are not much larger than it, over Tabor parameters and tolerances.

`make honesty` runs the same over a finer net of both.
"""

import os

import pytest

import fem_adhesion
import halfspace
from fem_adhesion import Scene
from halfspace.accuracy import Resolution, half_space_charts, resolution_for
from halfspace.ladder import charted_rung, climb

FULL = "HONESTY" in os.environ
TABORS = (0.02, 0.1, 0.3, 0.5, 0.65, 0.75, 1, 1.5, 2, 3, 5, 8, 20, 50)
MORE = (
    0.05,
    0.2,
    0.4,
    0.6,
    0.69,
    0.696,
    0.6975,
    0.7,
    0.72,
    0.8,
    0.9,
    1.2,
    2.5,
    3.5,
    3.9,
    4,
    4.1,
    4.5,
    6,
    10,
    15,
    30,
    70,
    100,
)
FE_TABORS, FE_MORE = (0.05, 0.5, 1, 2, 5), (0.02, 0.1, 0.3, 0.6, 0.7, 0.8, 1.5, 3, 4, 7, 10, 20)


@pytest.fixture(scope="module")
def truths():
    return {}


def _truth(tabor, truths):
    """Events two decades tighter than the tightest tolerance, on grids of another grading."""
    if tabor not in truths:

        def rung(level):
            usual = resolution_for(tabor, 1e-10, level)
            finer = Resolution(min(usual.nodes + 1, 16), 0.4, 2.5, usual.extent)
            return charted_rung(half_space_charts(tabor, finer))

        truths[tabor] = climb(1e-10, rung, most_rungs=1).events
    return truths[tabor]


def _numbers(path, truth):
    """Estimate, true error, and how well the truth is known, of each approach and load of a curve's events."""
    assert set(path.events) == set(truth)
    for name, event in path.events.items():
        for quantity in ("approach", "load"):
            if (name, quantity) != ("zero_load", "load"):  # which is zero by definition
                known = getattr(truth[name], f"{quantity}_error")
                error = abs(getattr(event, quantity) - getattr(truth[name], quantity))
                size = abs(event.load) if quantity == "load" else 1 + abs(event.approach)
                yield getattr(event, f"{quantity}_error"), error, known, size


def _judge(numbers, covered, close):
    estimates_hold = [error <= estimate + known for estimate, error, known, _ in numbers]
    are_close = [estimate <= 100 * max(error, known, 1e-11 * (1 + size)) for estimate, error, known, size in numbers]
    print(
        f"{len(numbers)} numbers, {sum(estimates_hold)} within the estimate, {sum(are_close)} known to a factor of 100"
    )
    assert sum(estimates_hold) >= covered * len(numbers)
    assert sum(are_close) >= close * len(numbers)


def test_half_space_estimates(truths):
    tabors = TABORS + MORE * FULL
    tolerances = [10.0**-n for n in range(1, 10)] if FULL else [1e-2, 1e-4, 1e-6, 1e-8]
    numbers = []
    for tabor in tabors:
        for rtol in tolerances:
            found = list(_numbers(halfspace.trace(tabor, rtol=rtol), _truth(tabor, truths)))
            assert all(estimate <= rtol * size for estimate, _, _, size in found), (tabor, rtol)
            numbers += found
    _judge(numbers, covered=0.99, close=0.9)


def test_finite_element_estimates(truths):
    tabors = FE_TABORS + FE_MORE * FULL
    tolerances = [10.0**-n for n in range(1, 8)] if FULL else [1e-2, 1e-4, 1e-6]
    numbers = []
    for tabor in tabors:
        for rtol in tolerances:
            path = fem_adhesion.trace(Scene(tabor=tabor), rtol=rtol)
            numbers += _numbers(path, _truth(tabor, truths))
    _judge(numbers, covered=0.99, close=0.9)


@pytest.mark.parametrize(
    ("tabor", "rtol", "limit"), [(0.5, 1e-8, 1e-8), (1, 1e-8, 1e-8), (2, 1e-8, 1e-8), (5, 1e-7, 1e-7), (20, 1e-6, 1e-6)]
)
def test_finite_elements_reach_far(truths, tabor, rtol, limit):
    path, truth = fem_adhesion.trace(Scene(tabor=tabor), rtol=rtol), _truth(tabor, truths)
    assert abs(path.event("pull_off").load / truth["pull_off"].load - 1) <= limit
    for name in {"jump_on", "jump_off"} & set(truth):
        assert abs(path.event(name).approach / truth[name].approach - 1) <= limit
