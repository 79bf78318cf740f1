"""A tip of silicon nitride on a plate: a real curve, whose slope in contact shows that more yields than the spring."""

import math
from pathlib import Path

import pytest

import fem_adhesion
from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting import words

DATA = Path(__file__).parents[2] / "data" / "afm"
SLOPES = (0.43, 0.47)  # in contact over the spring constant, by eye


def test_a_real_curve_gives_its_pull_off_and_what_yields_besides_the_spring():
    free = Measured(0.5, math.inf)
    found = fem_adhesion.fit(
        DATA / "sin_plate.ibw", radius=20e-9, modulus=160e9, poisson=0.27, compliance=free, models=()
    )
    assert found.prepared.pull_off == pytest.approx(12.85e-9, rel=0.01)
    # So small and stiff a contact is rigid: its pull-off is Bradley's, 2 pi R dgamma. The least squares miss the
    # deepest samples by 1.3 %, as the residuals in contact are four times the noise, which is told below.
    pull_off = -found.best.problem.branches(found.best.apparatus).contact[1].min()
    assert found.values["work_of_adhesion"].value == pytest.approx(pull_off / (2 * math.pi * 20e-9), rel=5e-3)
    assert pull_off == pytest.approx(found.prepared.pull_off, rel=0.02)
    stiff, soft = ((1 / slope - 1) / found.prepared.curve.stiffness for slope in reversed(SLOPES))
    assert stiff < found.values["compliance"].value < soft
    assert 0.3e-9 < found.values["spacing"].low < found.values["spacing"].high < 3e-9
    assert found.misfit
    assert any("does not fit" in line for line in words.warnings(found))


def test_a_fit_that_misses_keeps_to_the_measured_pull_off():
    pytest.importorskip("NSFopen")
    found = fem_adhesion.fit(
        DATA / "spectroscopy_two.nid", radius=10e-9, modulus=70e9, poisson=0.17, stiffness=2.724, models=()
    )
    assert found.misfit
    rigid = found.prepared.pull_off / (2 * math.pi * 10e-9)
    assert found.values["work_of_adhesion"].value == pytest.approx(rigid, rel=0.5)
