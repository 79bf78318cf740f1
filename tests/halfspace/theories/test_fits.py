"""Closed expressions are as close to the atlas as they say, no closer than that, and right in both limits."""

import re

import numpy as np
import pytest

from halfspace import atlas
from halfspace.theories import closed_forms, fits

BIRTH = atlas.birth_of_folds().value
STATED = {name: float(worst) for name, worst in re.findall(r"^    (\w+) +(\S+) of", fits.__doc__, re.M)}
ALL = np.geomspace(0.01, 300, 10_000)
FOLDED = BIRTH + np.geomspace(1e-7, 300 - BIRTH, 10_000)
LOSING = BIRTH + np.geomspace(1e-5, 300 - BIRTH, 10_000)  # nearer, the atlas has few digits of the loss


@pytest.mark.parametrize(
    ("name", "tabor", "exact"),
    [
        ("pull_off_load", ALL, lambda mu: atlas.pull_off(mu).load),
        ("zero_load_radius", ALL, lambda mu: atlas.zero_load(mu).contact_radius),
        ("jump_on_approach", FOLDED, lambda mu: atlas.jump_on(mu).take_off.approach),
        ("jump_off_approach", FOLDED, lambda mu: atlas.jump_off(mu).take_off.approach),
        ("energy_lost", LOSING, lambda mu: atlas.energy_lost(mu).energy),
    ],
)
def test_errors_are_as_stated(name, tabor, exact):
    true = exact(tabor)
    scale = np.abs(true) + (name == "jump_on_approach")
    worst = np.max(np.abs(getattr(fits, name)(tabor) - true) / scale)
    assert 0.9 * STATED[name] < worst <= STATED[name]


def test_both_limits_are_exact():
    least, most = 1e-5, 1e8
    assert fits.pull_off_load(least) == pytest.approx(
        closed_forms.BRADLEY_PULL_OFF + fits.SOFTENING * least**1.5, rel=1e-9
    )
    assert fits.pull_off_load(most) == pytest.approx(closed_forms.JKR_PULL_OFF, rel=1e-12)
    assert fits.zero_load_radius(least) * np.sqrt(least) == pytest.approx(fits.RIGID_RADIUS, rel=1e-3)
    assert fits.zero_load_radius(most) == pytest.approx(closed_forms.ZERO_LOAD_RADIUS, rel=1e-3)
    assert fits.jump_off_approach(most) == pytest.approx(closed_forms.jkr_jump_off(most).approach, rel=1e-6)
    assert fits.energy_lost(most) / most == pytest.approx(fits.JKR_LOST, rel=1e-3)


def test_jkr_s_loss_is_the_work_along_its_curve():
    off, zero = closed_forms.jkr_jump_off(1.0), closed_forms.jkr_zero_approach(1.0)
    approach = np.linspace(off.approach, zero.approach, 200_001)
    load = closed_forms.jkr_load_at(approach, 1.0)
    assert -np.trapezoid(load, approach) == pytest.approx(fits.JKR_LOST, rel=1e-6)


def test_constants_of_the_limits_are_the_atlas_s():
    tabor = np.array([0.01, 0.0101])
    softened = (atlas.pull_off(tabor).load - closed_forms.BRADLEY_PULL_OFF) / tabor**1.5
    towards_rigid = softened[0] - tabor[0] ** 1.5 * np.diff(softened)[0] / np.diff(tabor**1.5)[0]
    assert towards_rigid == pytest.approx(fits.SOFTENING, rel=1e-4)
    assert (1 - atlas.jump_on(300.0).take_off.approach) / 300 ** (3 / 7) == pytest.approx(fits.ATTRACTION, rel=3e-8)
    assert pytest.approx(BIRTH, abs=1e-11) == fits.BIRTH


def test_there_are_no_jumps_below_the_birth_of_folds():
    for jump in (fits.jump_on_approach, fits.jump_off_approach, fits.energy_lost):
        assert np.isnan(jump(0.69))
        assert np.isfinite(jump([0.7, 5.0])).all()
