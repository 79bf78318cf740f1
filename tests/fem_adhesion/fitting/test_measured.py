"""Measured curves: read whatever their signs and units, prepared, and refused in one line."""

import numpy as np
import pytest
from synthetic_curves import synthetic

from fem_adhesion.fitting.measured import read
from fem_adhesion.fitting.model import Apparatus
from fem_adhesion.fitting.prepare import prepare
from halfspace import atlas
from halfspace.errors import InputError

STIFFNESS = 10.0  # N/m
TRUTH = Apparatus(100e-9, 10e9, 0.05, 0.3e-9, contact_point=0.0, stiffness=STIFFNESS, poisson=0.0)
UNITS = TRUTH.units
FORCE = UNITS.load
NOISE, CORRELATION = 2e-3 * FORCE, 0.6
OFFSET, SLOPE = 3 * FORCE, 0.002 * FORCE / UNITS.spacing  # of the baseline, which the retract has a tenth higher


def _made(baseline=0.92, count=1000, seed=5):
    """Travel in m and force in N of an approach and of its retract."""
    made = {"noise": NOISE, "correlation": CORRELATION, "count": count, "baseline": baseline, "pressed": 2.0}
    curve = synthetic(TRUTH, np.random.default_rng(seed), **made)
    return curve.travel, curve.force + np.repeat([1.0, 1.1], count) * OFFSET + SLOPE * curve.travel


TRAVEL, LOADED = _made()
SEGMENT = np.repeat(["approach", "retract"], TRAVEL.size // 2)


@pytest.fixture
def written(tmp_path):
    def write(**columns):
        path, lines = tmp_path / "curve.csv", [columns, *zip(*columns.values(), strict=True)]
        path.write_text("\n".join(",".join(map(str, line)) for line in lines))
        return path

    return write


DIALECTS = {
    "falling": ({"piezo_um": -TRAVEL * 1e6, "force_nN": LOADED * 1e9, "segment": SEGMENT}, {}),
    "tension positive": ({"sensor_m": TRAVEL, "force_N": -LOADED, "segment": SEGMENT}, {}),
    "without segments": ({"piezo_nm": TRAVEL * 1e9, "force_pN": LOADED * 1e12}, {}),
    "deflection": ({"piezo_m": TRAVEL, "deflection_nm": LOADED / STIFFNESS * 1e9}, {"stiffness": STIFFNESS}),
    "retract turned round": (
        {
            "piezo_m": np.r_[TRAVEL[:1000], TRAVEL[:999:-1]],
            "force_N": np.r_[LOADED[:1000], LOADED[:999:-1]],
            "segment": SEGMENT,
        },
        {},
    ),
    "with a pause": (
        {
            "piezo_m": np.insert(TRAVEL, 1000, [TRAVEL[1000]] * 80),
            "force_N": np.insert(LOADED, 1000, [LOADED[1000]] * 80),
            "segment": np.insert(SEGMENT.astype("<U9"), 1000, ["pause"] * 80),
        },
        {},
    ),
}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_way_to_write_a_curve_reads_the_same(written, dialect):
    columns, how = DIALECTS[dialect]
    curve = read(written(**columns), **how)
    assert curve.travel == pytest.approx(TRAVEL)
    assert curve.force == pytest.approx(LOADED)
    assert (curve.approach, curve.retract) == (slice(0, 1000), slice(1000, 2000))
    assert curve.deflection_given == (dialect == "deflection")
    assert bool(curve.told) == (dialect != "deflection" or "segment" not in columns)


def test_a_turn_in_tension_is_no_compression(written):
    kept = np.flatnonzero(LOADED[:1000] < OFFSET - 1 * FORCE)[-1]  # in contact after the jump, and pulled
    whole = slice(kept, 2000 - kept)
    travel, force = np.delete(TRAVEL, whole), np.delete(LOADED, whole)
    file = written(piezo_m=travel, force_N=force)
    assert read(file).force == pytest.approx(force)
    with pytest.raises(InputError, match=r"curve 1 of .*csv, limit: 0 to 0; "):
        read(file, number=1)


def test_preparing_finds_what_was_put_in(written):
    found = prepare(read(written(piezo_m=TRAVEL, force_N=LOADED, segment=SEGMENT)))
    ranges = atlas.curve(UNITS.tabor).branches("base", stiffness=STIFFNESS / UNITS.stiffness)
    step, spacing = np.diff(TRAVEL)[0], UNITS.spacing
    zero = atlas.zero_load(UNITS.tabor).approach
    assert found.contact == pytest.approx(zero * spacing, abs=step)
    for jump, turn in ((found.jump_on, ranges["separated"][1]), (found.jump_off, ranges["contact"][0])):
        assert np.mean(TRAVEL[[jump.start, jump.stop]]) == pytest.approx(turn * spacing, abs=2 * step)
    assert found.noise == pytest.approx(NOISE, rel=0.2)
    assert found.correlation == pytest.approx(CORRELATION, abs=0.1)
    assert found.pull_off == pytest.approx(-atlas.pull_off(UNITS.tabor).load * FORCE, abs=STIFFNESS * step)
    for name, factor in (("approach", 1.0), ("retract", 1.1)):
        line = found.baseline[name].line
        assert line(found.contact) == pytest.approx(factor * OFFSET + SLOPE * found.contact, abs=3 * NOISE)
        assert line.deriv()(found.contact) == pytest.approx(SLOPE, rel=0.05)
        assert line.degree() == 1


def test_the_wave_of_interfering_light_is_no_noise(written):
    travel, loaded = _made(baseline=0.99, count=4000)
    amplitude, period, jump = 0.05 * FORCE, 330e-9, -5 * UNITS.spacing
    wave = amplitude * np.sin(2 * np.pi * np.minimum(travel, jump) / period + 1.0)
    flat, found = (prepare(read(written(piezo_m=travel, force_N=force))) for force in (loaded, loaded + wave))
    assert found.noise == pytest.approx(NOISE, rel=0.2)
    assert found.jump_on.start == flat.jump_on.start
    for baseline in found.baseline.values():
        assert baseline.amplitude == pytest.approx(amplitude, rel=0.05)
        assert baseline.period == pytest.approx(period, rel=0.02)
    assert found.background - wave == pytest.approx(flat.background, abs=5 * NOISE)  # in contact too
    assert "a wave of 249.7 pN and a period of 329.3 nm" in found.told[-1]
    assert not any("wave" in line for line in flat.told)


@pytest.mark.parametrize("follows", [False, True])
def test_the_scatter_of_a_travel_that_the_force_does_not_follow_is_the_sensors(written, follows):
    shaken = TRAVEL + np.random.default_rng(7).normal(size=TRAVEL.size) * 0.1 * UNITS.spacing
    loaded = LOADED + follows * STIFFNESS * (shaken - TRAVEL) * (TRAVEL > 0)
    found = prepare(read(written(piezo_m=shaken, force_N=loaded, segment=SEGMENT)))
    assert np.std(found.curve.travel - (shaken if follows else TRAVEL)) < 0.03 * UNITS.spacing
    assert any("smoothed" in line for line in found.told) != follows


@pytest.mark.parametrize("seed", range(2))
def test_no_jump_is_found_in_noise_that_hides_it(written, seed):
    hidden = LOADED + np.random.default_rng(seed).normal(size=LOADED.size) * FORCE
    found = prepare(read(written(piezo_m=TRAVEL, force_N=hidden)))
    assert found.jump_on is None


APART = -15 * UNITS.spacing > TRAVEL
CLOSE = -3 * UNITS.spacing < TRAVEL
SATURATED = np.minimum(LOADED, np.quantile(LOADED, 0.99))
REFUSED = {
    "begin farther away": {"piezo_m": TRAVEL[CLOSE], "force_N": LOADED[CLOSE]},
    "no contact": {"piezo_m": TRAVEL[APART], "force_N": LOADED[APART]},
    "saturated": {"piezo_m": TRAVEL, "force_N": SATURATED},
    "exchange them": {"piezo_m": TRAVEL, "force_N": LOADED, "segment": SEGMENT[::-1]},
    "limit: one sign": {"piezo_m": TRAVEL, "force_N": np.r_[LOADED[:1000], -LOADED[1000:]]},
    "one way only": {"piezo_m": TRAVEL[:1000], "force_N": LOADED[:1000]},
    "0 segments called retract": {"piezo_m": TRAVEL[:1000], "force_N": LOADED[:1000], "segment": SEGMENT[:1000]},
    "no unit": {"piezo_m": TRAVEL, "force": LOADED},
    "unit of the wrong kind": {"piezo_m": TRAVEL, "force_V": LOADED},
    "force_N and deflection_V": {"piezo_m": TRAVEL, "force_N": LOADED, "deflection_V": LOADED},
    "give the stiffness": {"piezo_m": TRAVEL, "deflection_m": LOADED},
    "99 lines of data, limit: 100; give more points": {"piezo_m": TRAVEL[:99], "force_N": LOADED[:99]},
    "line 12": {"piezo_m": TRAVEL, "force_N": np.where(np.arange(2000) == 10, np.nan, LOADED)},
    "a travel": {"time_s": TRAVEL, "force_N": LOADED},
}


@pytest.mark.parametrize("words", REFUSED)
def test_bad_input_is_refused_in_one_line(written, words):
    with pytest.raises(InputError, match=words) as refused:
        prepare(read(written(**REFUSED[words])))
    assert "\n" not in str(refused.value)
