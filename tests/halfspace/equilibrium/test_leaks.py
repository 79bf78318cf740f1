"""What SciPy and NumPy complain of ends as NotConverged with cause and remedy, or is an answer."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem_adhesion.elasticity.elimination import factor, inverses
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.equilibrium.charts import trace_charts
from halfspace.equilibrium.conditions import ZERO_LOAD, locate
from halfspace.equilibrium.contact import LOAD
from halfspace.equilibrium.devices import jumps
from halfspace.equilibrium.path import Metric
from halfspace.equilibrium.search import find_events
from halfspace.errors import ContactTooWide, NotConverged
from halfspace.profiles import Paraboloid
from halfspace.roots import root
from halfspace.scales import Scales


def ended(call):
    """What a call returns, or None and what it says."""
    try:
        return call(), ""
    except NotConverged as error:
        return None, str(error)


NUMBERS = st.floats(allow_nan=True, allow_infinity=True, width=64)


@given(at=st.tuples(NUMBERS, NUMBERS, NUMBERS), bend=NUMBERS)
@settings(max_examples=200, deadline=None, derandomize=True, database=None)
def test_a_root_is_found_or_said_not_to_be_there(at, bend):
    """Values at the ends and in the middle, joined anyhow; also so small that their product is zero."""

    def function(x):
        value = {0.0: at[0], 1.0: at[2]}.get(x)
        return (at[1] if x < 0.5 else bend) if value is None else value

    found, said = ended(lambda: root(function, 0.0, 1.0, "a thing; do this", xtol=1e-12))
    assert re.fullmatch(r"a thing .*; do this", said) if found is None else 0 <= found <= 1


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda x: 1 + x, "a thing is not between 0 and 1, where the signs are the same (1 and 2); do this"),
        (lambda x: 1e-200 + x * 1e-200, "a thing is not between 0 and 1, where the signs are the same (1e-200 and"),
        (lambda x: math.nan if x == 1 else -1.0, "a thing is lost at 1, where it cannot be told; do this"),
        (lambda x: math.nan if 0 < x < 1 else x - 0.3, "a thing is lost at 0.3, where it cannot be told; do this"),
    ],
)
def test_a_missing_root_is_said_with_values_and_remedy(function, said):
    with pytest.raises(NotConverged, match=re.escape(said)):
        root(function, 0.0, 1.0, "a thing; do this")


@pytest.fixture(scope="module")
def segments():
    return trace_charts(half_space_charts(Scales(1.0), resolution_for(Scales(1.0), 1e-1)))


def test_a_curve_that_ends_too_soon_says_which_event_it_lacks(segments):
    first, last = segments
    pulled = replace(last, points=tuple(p for p in last.points if p.observables[LOAD] < 0))
    for cut, missing in (((first,), "pull_off"), ((first, pulled), "zero_load")):
        with pytest.raises(NotConverged, match=f"no {missing} before it ends at .*; take a larger to_load"):
            find_events(cut)
    filled = replace(pulled, problem=replace(pulled.problem, profile=Paraboloid(1.0)))
    with pytest.raises(ContactTooWide, match="before zero_load is reached; take a larger radius_ratio"):
        find_events((first, filled))


def test_a_point_that_is_the_root_is_found_once(segments):
    """Where the product of the conditions at two points is zero, and no less."""
    last = segments[-1]
    metric = Metric(4.0)
    (there,) = locate(last.problem, last.points, metric, ZERO_LOAD)
    at = replace(there.point, observables=np.where(np.arange(4) == 1, 0.0, there.point.observables))
    before = [p for p in last.points if p.arclength < at.arclength]
    after = [p for p in last.points if p.arclength > at.arclength]
    found = locate(last.problem, [*before, at], metric, ZERO_LOAD) + locate(
        last.problem, [at, *after], metric, ZERO_LOAD
    )
    assert len(found) == 1


def test_a_landing_beyond_the_end_of_the_curve_says_so(segments):
    first, last = segments
    cut = (first, replace(last, points=tuple(p for p in last.points if p.observables[1] < -4.0)))
    with pytest.raises(NotConverged, match=r"landing of the jump on lies beyond .* at load -[\d.]+ R dgamma; trace it"):
        jumps(cut, 100.0)


def test_singular_matrices_are_a_solvers_end():
    with pytest.raises(NotConverged, match=r"stiffness is singular; hold the body.* of a tangent: try"):
        inverses(np.zeros((1, 2, 2)))
    with pytest.raises(NotConverged, match="stiffness is singular; hold the body"):
        factor(np.zeros((2, 2)))
