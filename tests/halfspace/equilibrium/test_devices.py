"""Apparatus of any stiffness: where it jumps, where it lands, what it loses."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from agreement import apart
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq

import halfspace
from fem_adhesion.common.fold_birth import critical_stiffness
from halfspace import Layer
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import moved
from halfspace.equilibrium.contact import LOAD
from halfspace.equilibrium.devices import cycle, energy_lost, jumps
from halfspace.scales import Scales
from halfspace.theories import closed_forms


@pytest.fixture(scope="module")
def path():
    return halfspace.trace(2.0, rtol=1e-6)


def _base(event, stiffness):
    return event.approach + event.load / stiffness


@pytest.mark.parametrize("stiffness", [np.inf, 10.0, 1.0])
def test_a_jump_lands_at_the_base_it_took_off_from(path, stiffness):
    found = cycle(path, stiffness)
    for jump in (found.jump_on, found.jump_off):
        assert _base(jump.landing, stiffness) == pytest.approx(_base(jump.take_off, stiffness), abs=1e-9)
        assert jump.energy.value > 0
    assert found.jump_on.landing.contact_radius > found.jump_off.take_off.contact_radius
    assert np.isnan(found.jump_off.landing.contact_radius)


def test_a_take_off_has_the_errors_of_the_event_that_it_is(path):
    """Under fixed grips that of the fold, under a soft spring that of pull-off, where a radius is shifted at once."""
    grips, soft = cycle(path), cycle(path, 1e-8)
    for name, jump in (("jump_on", grips.jump_on), ("jump_off", grips.jump_off), ("pull_off", soft.jump_off)):
        assert jump.take_off.load == pytest.approx(path.event(name).load, abs=1e-7)
        for quantity in ("approach", "load", "central_gap", "contact_radius"):
            own, event = (getattr(state, f"{quantity}_error") for state in (jump.take_off, path.event(name)))
            assert own == pytest.approx(event, rel=0.05, abs=1e-10, nan_ok=True), (name, quantity)
    assert grips.jump_on.take_off.approach == pytest.approx(path.event("jump_on").approach, abs=1e-9)
    assert grips.jump_off.take_off.load == pytest.approx(path.event("jump_off").load, abs=1e-8)
    assert cycle(path, 1e9).energy_lost.value == pytest.approx(grips.energy_lost.value, rel=1e-6)
    assert energy_lost(path.segments) == pytest.approx(grips.energy_lost.value, rel=1e-5)


def test_a_contact_radius_is_known_as_the_gap_ripples():
    rippling = halfspace.trace(5.0, rtol=1e-3)
    for name, event in rippling.events.items():
        located = rippling.stages[-1][name]
        if math.isfinite(event.contact_radius):
            surface, point = located.problem.interface, located.point
            ripple = surface.ripples(located.problem.surface_state(point.x))[1]
            assert event.contact_radius_error >= ripple > 0, name


def test_a_soft_apparatus_that_lands_far_away_is_accurate(path):
    """Where nearly no load is left: its rounding is of the load before, and the approach has errors of the load's."""
    found = cycle(path, 1e-3)
    assert found.jump_off.landing.approach < -1000
    assert found.met
    assert not replace(found, tolerance=replace(found.tolerance, rtol=1e-13)).met


def test_the_work_round_the_loop_is_what_its_jumps_free(path):
    stiffness = 0.5
    found = cycle(path, stiffness)
    low, high = (_base(jump.take_off, stiffness) for jump in (found.jump_off, found.jump_on))
    # The load has a square root at the fold where each branch ends, so the nodes are graded towards it.
    approaching = _work(path, stiffness, low, high, contact=False)
    separating = _work(path, stiffness, low, high, contact=True)
    assert approaching - separating == pytest.approx(found.energy_lost.value, rel=1e-6)


def _work(path, stiffness, low, high, *, contact):
    """Integral of W db along one stable branch, b from low to high."""
    x, w = leggauss(40)
    t = (1 + x) / 2
    distance, weights = (high - low) * t**2, (high - low) * t * w
    bases = low + distance if contact else high - distance
    stage = path.stages[-1]
    state = stage["zero_approach" if contact else "separated"]
    problem, start = state.problem, state.point.x
    total = 0.0
    for i in np.argsort(bases)[:: -1 if contact else 1]:
        start = newton.solve(problem, start, newton.spring(stiffness, bases[i]), max_iterations=60).x
        total += weights[i] * problem.observables(start)[LOAD]
    return total


@pytest.mark.parametrize("tabor", [0.05, 0.65])
def test_below_its_critical_stiffness_an_apparatus_jumps(tabor):
    path, stiffness = halfspace.trace(tabor, rtol=1e-5), critical_stiffness(tabor)
    assert cycle(path, 1.001 * stiffness) is None
    assert cycle(path, 0.999 * stiffness).energy_lost.value > 0


def test_critical_stiffness_tends_to_bradleys_steepest_fall():
    h = 3 ** (1 / 6)  # where the third derivative of the energy vanishes
    assert critical_stiffness(1e-4) == pytest.approx(16 * np.pi / 3 * (h**-3 - h**-9), rel=1e-4)
    assert critical_stiffness(0.697) > 5000


@pytest.mark.parametrize(("tabor", "stiffness"), [(0.75, 0.5), (8.0, 3.0)])
def test_the_error_of_an_energy_is_by_its_change_over_grids(tabor, stiffness):
    """Or from a twin, or a coarser grid, if that is more; it holds the truth of a tighter curve."""
    path, truth = halfspace.trace(tabor, rtol=1e-2), cycle(halfspace.trace(tabor, rtol=1e-6), stiffness)
    found, rough = cycle(path, stiffness), jumps(path.segments, 1 / stiffness)
    both, known = (found.jump_on, found.jump_off), (truth.jump_on, truth.jump_off)
    for jump, before, true in zip(both, rough, known, strict=True):
        left = max(path.ladder.rule.remaining, 1) * abs(jump.energy.value - before.energy(1 / stiffness))
        rounding = 2e-11 * (1 + jump.energy.value)
        least = path.ladder.rule.least * abs(jump.energy.value)
        assert left - rounding <= jump.energy.error <= max(10 * left + rounding, least)
        assert abs(jump.energy.value - true.energy.value) <= jump.energy.error
    assert abs(found.energy_lost.value - truth.energy_lost.value) <= found.energy_lost.error
    assert found.energy_lost == found.jump_on.energy + found.jump_off.energy


def test_the_errors_of_a_take_off_count_a_twin():
    """A number that the curve's grid and the finest share by accident is not taken for exact."""
    counted = 0
    for tabor, stiffness in itertools.product((0.3, 0.8, 2.0), (0.3, 1.0)):
        path = halfspace.trace(tabor, rtol=1e-6)
        for rough, jump in zip(jumps(path.segments, 1 / stiffness), ("jump_on", "jump_off"), strict=True):
            before, found = rough.take_off, getattr(cycle(path, stiffness), jump).take_off
            best, twin = (
                moved(before, stage(before).problem).point.observables for stage in (path.finest, path.ladder.twin)
            )
            for k, quantity in enumerate(("approach", "load", "central_gap")):
                change = abs(twin[k] - best[k])
                assert getattr(found, f"{quantity}_error") >= 0.99 * path.ladder.rule.remaining * change
                counted += change > 1.5 * abs(before.point.observables[k] - best[k])
    assert counted > 0


@pytest.mark.parametrize("stiffness", [0.0, float("nan")])
def test_an_apparatus_has_a_positive_stiffness(path, stiffness):
    with pytest.raises(ValueError, match="outside 0 < stiffness; a dead load jumps off at pull_off"):
        cycle(path, stiffness)


def test_coarse_states_on_a_hemisphere_hold_their_errors():
    """Of few operators for all events the change by one more tells little: it was up to 4.6 times the estimate."""
    import fem_adhesion

    scene = fem_adhesion.Scene(1.0, fem_adhesion.Hemisphere(radius_ratio=20.0))
    coarse, fine = (fem_adhesion.trace(scene, rtol=rtol) for rtol in (1e-2, 1e-4))
    told, expected = (
        [*path.events.values(), *cycle(path, 0.5).jump_on.ends, *cycle(path, 0.1).jump_on.ends]
        for path in (coarse, fine)
    )
    for ours, theirs in zip(told, expected, strict=True):
        assert apart(ours, theirs, ("approach", "load", "contact_radius")) == []
    assert coarse.energy.agrees(fine.energy)


def test_a_soft_cantilever_jumps_on_beyond_the_curve():
    path = halfspace.trace(1e-3, rtol=1e-6)
    stiffness = 1e-4
    found = cycle(path, stiffness)
    gap = brentq(lambda h: 16 * np.pi / 3 * (h**-3 - h**-9) - stiffness, 2, 200)
    assert 1 - gap < path.approach[0]
    on = found.jump_on.take_off
    assert abs(on.approach - (1 - gap)) < on.approach_error + 1e-6 * gap
    assert abs(on.load - float(closed_forms.bradley_load(1 - gap))) < on.load_error + 1e-6 * abs(on.load)
    assert Scales(path.tabor).rigid_jump_on(stiffness) == pytest.approx(1 - gap, rel=1e-6)


def test_jumps_of_a_very_soft_apparatus_hold_their_errors():
    """Against a tight tolerance and, as the jump on lies far out, a rigid sphere."""
    stiffness = 1e-12
    found, expected = (cycle(halfspace.trace(1.0, rtol=rtol), stiffness) for rtol in (1e-2, 1e-8))
    for jump in ("jump_on", "jump_off"):
        for place in ("take_off", "landing"):
            ours, theirs = (getattr(getattr(c, jump), place) for c in (found, expected))
            assert apart(ours, theirs, ("approach", "load")) == [], (jump, place)
    assert found.energy_lost.agrees(expected.energy_lost)
    on, gap = found.jump_on.take_off, np.cbrt(16 * np.pi / 3 / stiffness)
    assert on.approach == pytest.approx(1 - gap, rel=1e-6)
    assert on.load == pytest.approx(-8 * np.pi / 3 / gap**2, rel=2e-6, abs=0)
    assert on.load_error < 2e-5 * abs(on.load) + 1.1e-11


def test_take_offs_are_found_a_fifth_farther_out():
    """On a thin, nearly incompressible layer that slides; the grids around jump_off know its radius alone."""
    path = halfspace.trace(219.0, body=Layer(0.01, 0.499, "sliding"), rtol=1e-3)
    stiff, soft, event = cycle(path).jump_off, cycle(path, 10.0).jump_off, path.event("jump_off")
    assert apart(stiff.take_off, event, ("approach", "load", "contact_radius")) == []
    assert event.contact_radius < soft.take_off.contact_radius < 1.02 * event.contact_radius
    assert _base(soft.landing, 10) == pytest.approx(_base(soft.take_off, 10), rel=1e-9)
