"""Approaches have no natural zero: no verdict may depend on where they are counted from."""

from dataclasses import replace

import pytest

import halfspace
from fem_adhesion.assess.predictions import Prediction, Quantity
from fem_adhesion.assess.verdict import ranked
from fem_adhesion.crosscheck import study as crosscheck
from fem_adhesion.finite_sphere.cases import Record, case_of, quantities_of
from fem_adhesion.finite_sphere.table import rows
from fem_adhesion.greenwood.tables import table_2
from fem_adhesion.speed.study import TIGHTEST, Truth, estimates
from halfspace.equilibrium.events import Tolerance, approach_scale

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


def _alike(values):
    first, *others = values
    assert others == [pytest.approx(first, rel=1e-9, abs=1e-12) for _ in others]


def test_the_scale_is_the_spacing_and_the_range_between_the_events():
    assert approach_scale([-3.0, 1.5, -0.5]) == 5.5
    assert approach_scale([7.0]) == 1.0
    assert approach_scale([2e-9, -1e-9], 0.2e-9) == pytest.approx(3.2e-9, rel=1e-12, abs=0)


def test_the_scale_is_that_of_the_shift_of_no_zero(path):
    _alike([_counted_from(path, zero).approach_scale for zero in ZEROS])


@pytest.mark.parametrize(("error", "met"), [(0.99e-4, True), (1.01e-4, False)])
def test_whether_a_tolerance_is_met(path, error, met):
    for zero in ZEROS:
        events = dict(_counted_from(path, zero).events)
        events["jump_on"] = replace(events["jump_on"], approach_error=error * path.approach_scale)
        assert bool(Tolerance.on(events, 1e-4).missed(events)) is not met


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


def test_the_table_of_the_finite_sphere(path):
    tables = []
    for zero in ZEROS:
        cases = [case_of(model, 2.0, 100.0, 0.3, 1e-4) for model in ("half_space", "true_profile")]
        paths = _counted_from(path, zero), _counted_from(path, zero, 0.05)
        found = [Record(case, "solved", _without_energy(one, path)) for case, one in zip(cases, paths, strict=True)]
        tables.append({row.quantity: row.deviation for row in rows(found) if row.cause == "profile" and row.deviation})
    _alike([table["jump_on_approach"].value for table in tables])
    assert tables[0]["jump_on_approach"].value == pytest.approx(0.05 / path.approach_scale, rel=1e-9)
    assert tables[0]["jump_off_approach"].value == 0


def _without_energy(path, whole):
    """Quantities of a path whose events were moved, which has no cycle of its own."""
    values = quantities_of(replace(whole, events=path.events))
    return {name: value for name, value in values.items() if name != "hysteresis"}


def test_the_speed_study(path):
    moved = [_counted_from(path, zero) for zero in ZEROS]
    truths = [Truth("half-space", TIGHTEST, estimates(one), one.approach_scale) for one in moved]
    _alike([truth.relative("jump_on", 1e-3) for truth in truths])


def test_the_assessment():
    """A soft cantilever whose base stands far from zero, another model half a spacing off at jump-on."""
    spacing, found = 0.2e-9, []
    for zero in (0.0, 1e-6, -1e-6):
        bases = {"jump_on_base": -2e-9 - zero, "jump_off_base": -30e-9 - zero}
        ours, best = (
            Prediction(name, {k: Quantity(v + (more if "on" in k else 0), 0.0, "m") for k, v in bases.items()})
            for name, more in (("half-space", 0.5 * spacing), ("finite sphere", 0.0))
        )
        found.append(ranked((ours, None, best), spacing)[0].size)
    _alike(found)
    assert found[0] == pytest.approx(0.5 * spacing / (28e-9 + spacing), rel=1e-9)


def test_greenwoods_printed_approaches(path):
    printed = [p for p in table_2({2.0: path}) if "alpha_star" in p.row]
    assert printed
    for p in printed:
        size = path.approach_scale / (2.0 if p.row.endswith("over_mu") else 1.0)
        assert p.deviation == pytest.approx((p.computed.value - float(p.printed)) / size, rel=1e-9, abs=0)
