"""Theories against the paper's table, against integrals done another way, and against each other in their limits."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from page_tables import rows_of
from scipy.integrate import quad
from scipy.optimize import brentq

import halfspace
from halfspace.laws import LENNARD_JONES
from halfspace.theories import closed_forms, dmt, maugis
from halfspace.theories.maugis import MaugisDugdale

DATA = Path(__file__).parents[2] / "data"


@pytest.mark.parametrize("row", rows_of(DATA / "greenwood1997_table1.csv"), ids=lambda row: row["alpha_star"])
def test_table_1_to_its_last_printed_digit(row):
    alpha, printed = float(row["alpha_star"]), row["f_over_alpha_star_1_5"]
    assert f"{dmt.force_excess(alpha) / alpha**1.5:.3f}" == f"{float(printed):.3f}"


def _outside(alpha, integrand):
    """Integral of integrand(x, H) x dx from 1 to infinity around a Hertz contact in the paper's variable x = r/a."""
    scale = max(1.0, alpha**-0.5)

    def over(x):
        return integrand(x, closed_forms.hertz_gap(x, 1.0, alpha)) * x

    ends = 1 + scale * np.array([0, 0.1, 1, 3, 10, 100, 1e5])
    return sum(quad(over, *pair, epsrel=1e-11, limit=200)[0] for pair in pairwise(ends))


@pytest.mark.parametrize("alpha", [1e-3, 0.1, 3.0, 100.0])
def test_force_method_by_adaptive_quadrature(alpha):
    tension = alpha * _outside(alpha, lambda _, H: -LENNARD_JONES.pressure(H, 1.0))
    assert dmt.force_excess(alpha) == pytest.approx(tension - 1, abs=1e-8)


@pytest.mark.parametrize("alpha", [1e-2, 0.3, 5.0])
def test_thermodynamic_tension_is_the_surface_energys_slope(alpha):
    def energy(a):
        return 2 * np.pi * a * _outside(a, lambda _, H: LENNARD_JONES.energy(H, 1.0)) - np.pi * a

    d = 1e-3 * alpha
    slope = (energy(alpha + d) - energy(alpha - d)) / (2 * d)
    assert dmt.thermodynamic_tension(alpha) == pytest.approx(-slope, rel=1e-5)


def test_the_three_dmt_theories_part_under_compression():
    alpha, tabor = np.array([0.0, 1e-3, 0.1, 1.0, 100.0]), 0.1
    by_force, simplest = dmt.force_load(alpha, tabor), dmt.maugis_load(alpha, tabor)
    thermodynamic = dmt.thermodynamic_load(alpha, tabor)
    assert by_force[0] == pytest.approx(closed_forms.BRADLEY_PULL_OFF, abs=1e-12)
    assert simplest[0] == pytest.approx(closed_forms.bradley_load(0.0), abs=1e-12)
    assert thermodynamic[0] == pytest.approx(closed_forms.BRADLEY_PULL_OFF, abs=1e-5)
    assert np.all(by_force[1:] < simplest[1:])
    assert np.all(simplest[1:] < thermodynamic[1:])
    np.testing.assert_allclose(simplest, 4 / 3 * (alpha / tabor) ** 1.5 - 2 * np.pi)


def test_no_contact_is_nan_and_shapes_are_kept():
    alpha = np.array([[-3.5, -0.1], [0.0, 2.0]])
    for load in (dmt.force_load, dmt.maugis_load, dmt.thermodynamic_load, closed_forms.jkr_load_at):
        assert load(alpha, 2.0).shape == alpha.shape
        assert load(1.0, 2.0).shape == ()
    np.testing.assert_array_equal(np.isnan(dmt.force_load(alpha, 2.0)), alpha < 0)
    np.testing.assert_array_equal(np.isnan(dmt.thermodynamic_load(alpha, 2.0)), alpha < 0)
    np.testing.assert_array_equal(np.isnan(closed_forms.jkr_load_at(alpha, 2.0)), alpha < -3.3)
    np.testing.assert_array_equal(np.isnan(closed_forms.jkr_radius([-5.0, closed_forms.JKR_PULL_OFF])), [True, False])


def test_jkr_by_load_by_approach_and_by_radius_agree():
    off = closed_forms.jkr_jump_off(3.0)
    radius = np.geomspace(off.contact_radius, 1e4, 300)
    np.testing.assert_allclose(
        closed_forms.jkr_radius_at(closed_forms.jkr_approach(radius, 3.0), 3.0)[1:], radius[1:], rtol=1e-9
    )
    assert closed_forms.jkr_radius_at(off.approach, 3.0) == pytest.approx(off.contact_radius, rel=1e-7)
    wide = radius[radius > closed_forms.jkr_pull_off(3.0).contact_radius]
    np.testing.assert_allclose(closed_forms.jkr_radius(closed_forms.jkr_load(wide)), wide, rtol=1e-7)


def test_turning_points_and_landings_of_jkr():
    pull_off, off = closed_forms.jkr_pull_off(2.0), closed_forms.jkr_jump_off(2.0)
    assert pull_off.load == pytest.approx(closed_forms.JKR_PULL_OFF)
    assert off.approach == pytest.approx(-0.75 * np.pi ** (2 / 3) * 2)
    assert off.load == pytest.approx(-5 * np.pi / 6)
    radius = np.linspace(0.1, 4, 40001)
    assert pull_off.contact_radius == pytest.approx(radius[np.argmin(closed_forms.jkr_load(radius))], abs=1e-4)
    assert off.contact_radius == pytest.approx(radius[np.argmin(closed_forms.jkr_approach(radius, 2.0))], abs=1e-4)
    assert closed_forms.jkr_zero_load(2.0).load == 0
    assert closed_forms.jkr_zero_load(2.0).approach == pytest.approx(
        2 / 3 * closed_forms.hertz_approach(np.cbrt(4.5 * np.pi), 1.0)
    )
    assert closed_forms.jkr_zero_approach(2.0).load == pytest.approx(-4 * np.pi / 3)
    assert closed_forms.jkr_zero_approach(2.0).approach == pytest.approx(0, abs=1e-12)


def test_gap_around_a_hertz_contact():
    """It closes at the edge and is the undeformed one, lifted by the load on a point, far away."""
    a, r = 1.5, 200.0
    load = float(closed_forms.hertz_load(a))
    undeformed = r**2 / 2 - closed_forms.hertz_approach(a, 1.0)
    assert closed_forms.hertz_gap(a, a, 2.0) == 0
    assert closed_forms.hertz_gap(r, a, 2.0) == pytest.approx(2 * (undeformed + load / (np.pi * r)), rel=1e-9)


@pytest.mark.parametrize("lam", [1e-6, 0.3, 100.0])
def test_maugis_equations_as_he_printed_them(lam):
    """In his variables A, m, P, Delta, normalised by K = 4 E*/3 and pi dgamma."""
    theory = MaugisDugdale(lam, tabor=1.3)
    radius = np.geomspace(1e-3, 30, 50)
    A, m = radius / np.cbrt(3 * np.pi / 4), theory.cohesive_radius(radius) / radius
    z = np.sqrt((m - 1) * (m + 1))
    t = np.arctan(z)
    opening = lam * A**2 / 2 * (z + (m**2 - 2) * t) + 4 / 3 * lam**2 * A * (z * t - m + 1)
    load = A**3 - lam * A**2 * (z + m**2 * t)
    approach = A**2 - 4 / 3 * lam * A * z
    np.testing.assert_allclose(opening, 1, rtol=1e-6)
    np.testing.assert_allclose(theory.load(radius), np.pi * load, rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(
        theory.approach(radius), 1.3 * np.cbrt(9 * np.pi**2 / 16) * approach, rtol=1e-6, atol=1e-3
    )


@pytest.mark.parametrize("lam", [1e-4, 1.0, 100.0])
def test_turning_points_of_maugis_are_minima(lam):
    theory = MaugisDugdale(lam, tabor=1.0)
    pull_off, off = theory.pull_off(), theory.jump_off()
    around = pull_off.contact_radius * (1 + np.array([-1e-2, 1e-2]))
    assert np.all(theory.load(around) > pull_off.load)
    assert theory.load(pull_off.contact_radius) == pytest.approx(pull_off.load, rel=1e-12)
    if np.isnan(off.contact_radius):
        assert np.all(theory.separated_approach(4 * theory.tension / np.pi * np.array([0.9, 1.1])) > off.approach)
    else:
        assert np.all(theory.approach(off.contact_radius * np.array([0.9, 1.1])) > off.approach)
        assert theory.load(off.contact_radius) == pytest.approx(off.load, rel=1e-12)


@pytest.mark.parametrize("lam", [0.05, 1.0, 20.0])
def test_maugis_separated_branch_runs_into_contact(lam):
    theory = MaugisDugdale(lam, tabor=1.0)
    on = theory.jump_on()
    assert on.load == 0
    assert on.approach == pytest.approx(-1 / theory.tension)  # where the closest points are dgamma/sigma0 apart
    assert theory.separated_approach(1e-6) < on.approach
    touching, barely = theory.touching_radius, 1e-9
    assert theory.cohesive_radius(barely) == pytest.approx(touching, rel=1e-6)
    assert theory.load(barely) == pytest.approx(float(theory.separated_load(touching)), rel=1e-6)
    assert theory.approach(barely) == pytest.approx(float(theory.separated_approach(touching)), rel=1e-6)
    assert np.isnan(theory.separated_load(1.1 * touching))


def test_maugis_keeps_its_contact_up_to_the_jump_above_0_938():
    critical = brentq(
        lambda lam: MaugisDugdale(lam, 1.0).touching_radius - 4 / np.pi * MaugisDugdale(lam, 1.0).tension, 0.5, 2
    )
    assert critical == pytest.approx(0.938, abs=5e-4)  # Johnson & Greenwood 1997
    below, above = MaugisDugdale(critical - 1e-7, 1.0).jump_off(), MaugisDugdale(critical + 1e-7, 1.0).jump_off()
    assert np.isnan(below.contact_radius)
    assert above.contact_radius < 1e-2
    assert above.approach == pytest.approx(below.approach, rel=1e-6)
    assert above.load == pytest.approx(below.load, rel=1e-3)


@pytest.mark.parametrize("lam", np.geomspace(1e-3, 1e3, 5))
def test_carpick_fits_maugis(lam):
    """About a per cent in the load at pull-off and the radius under no load, which set the scales of the fit."""
    theory = MaugisDugdale(lam, tabor=1.0)
    pull_off = theory.pull_off()
    assert maugis.carpick_pull_off(lam) == pytest.approx(pull_off.load, rel=0.017)
    unloaded = brentq(lambda a: float(theory.load(a)), pull_off.contact_radius, 5)
    assert maugis.carpick_zero_load_radius(lam) == pytest.approx(unloaded, rel=0.014)
    compressed = np.linspace(unloaded, 6, 50)
    np.testing.assert_allclose(maugis.carpick_radius(theory.load(compressed), lam), compressed, rtol=0.022)
    assert np.isnan(maugis.carpick_radius(-7.0, lam))


def test_carpicks_transition_parameter_is_as_printed():
    """Their (13), lambda = -0.924 ln(1 - 1.02 alpha)."""
    alpha = np.linspace(0, 0.95, 20)
    np.testing.assert_allclose(maugis.carpick_transition(-0.924 * np.log(1 - 1.02 * alpha)), alpha, atol=1e-14)


def test_matched_maugis_against_the_converged_contact():
    """The best constant tension errs by at most 5.5 % in the pull-off force, most where the theories change over."""
    for row in rows_of(DATA / "reference_events.csv"):
        if row["event"] == "pull_off":
            theory = MaugisDugdale.matched(float(row["tabor"]))
            assert theory.pull_off().load == pytest.approx(float(row["load"]), rel=0.055)


def test_soft_sphere_follows_jkr_and_maugis():
    path = halfspace.trace(20.0, rtol=1e-4)
    fine = np.isfinite(path.contact_radius) & (path.contact_radius > 1)
    jkr = closed_forms.jkr_load_at(path.approach[fine], 20.0)
    np.testing.assert_allclose(path.load[fine], jkr, atol=0.06)
    pull_off, off = path.event("pull_off"), path.event("jump_off")
    matched = MaugisDugdale.matched(20.0)
    assert matched.pull_off().load == pytest.approx(pull_off.load, rel=3e-3)
    assert matched.jump_off().approach == pytest.approx(off.approach, rel=3e-3)
    assert closed_forms.jkr_jump_off(20.0).contact_radius == pytest.approx(off.contact_radius, rel=1e-2)
