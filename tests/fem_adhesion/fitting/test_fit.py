"""Work of adhesion and spacing from curves with a known truth, and what is said where they cannot be had."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from iminuit import Minuit
from scipy.stats import chi2
from synthetic_curves import synthetic, write

import fem_adhesion
import halfspace
from fem_adhesion import cli
from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting import words
from fem_adhesion.fitting.model import Apparatus, attracted, by_atlas, by_jkr, recorded
from halfspace import Layer
from halfspace.atlas import curve
from halfspace.laws.formulas import Morse
from halfspace.profiles import Sphere

RADIUS, POISSON, WORK = 50e-9, 0.3, 0.05
FREE = Measured(1.0, math.inf)


def _truth(tabor, spacing, stiffness, **more):
    """Apparatus of a Tabor parameter on a spring of a stiffness in R dgamma/eps."""
    modulus = math.sqrt(RADIUS * WORK**2 / (tabor * spacing) ** 3) * (1 - POISSON**2)
    spring = stiffness * RADIUS * WORK / spacing
    return Apparatus(RADIUS, modulus, WORK, spacing, 2e-7, spring, poisson=POISSON, **more)


def _fit(truth, noise, seed=2, theory=by_atlas, models=(), count=250, **more):
    """Fit of a synthetic curve with noise as a part of the pull-off force."""
    size = 2 * np.pi * RADIUS * WORK
    rng = np.random.default_rng(seed)
    made = {"noise": noise * size, "correlation": 0.3, "offset": 0.1 * size, "drift": 0.05 * size, "count": count}
    data = synthetic(truth, rng, **made, theory=theory)
    given = {"radius": RADIUS, "modulus": truth.modulus, "poisson": POISSON, "stiffness": truth.stiffness}
    return fem_adhesion.fit(data, **given | {"sensitivity": FREE} | more, models=models)


def _holds(value, truth):
    return (value.low is None or value.low < truth) and (value.high is None or truth < value.high)


@pytest.mark.parametrize(("tabor", "stiffness"), [(0.1, 3.0), (1.0, 0.05), (5.0, 0.5)])
def test_the_apparatus_records_the_states_of_the_atlas(tabor, stiffness):
    truth = _truth(tabor, 0.3e-9, stiffness, sensitivity=1.1)
    units = truth.units
    found = recorded(by_atlas(units), truth)
    for name, branch in (("separated", found.separated), ("contact", found.contact)):
        turn = found.on if name == "separated" else found.off
        ends = curve(tabor).branches("base", stiffness=stiffness).get(name, (-10.0, 10.0))
        base = np.linspace(*ends, 101)[1:-1]
        states = curve(tabor).at(base=base, stiffness=stiffness, branch=name)
        force = np.interp(truth.contact_point + base * units.approach, *branch)
        assert force * 1.1 / units.load == pytest.approx(states.load, abs=0.02)
        expected = ends[1] if name == "separated" else ends[0]
        assert not found.jumps or (turn - truth.contact_point) / units.approach == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize(("tabor", "stiffness", "noise"), [(0.15, 0.5, 0.002), (1.0, 0.05, 0.005), (4.0, 0.2, 0.01)])
def test_intervals_hold_the_truth(tabor, stiffness, noise):
    truth = _truth(tabor, 0.3e-9, stiffness, sensitivity=0.85)
    found = _fit(truth, noise)
    for name, value in found.values.items():
        assert value.identified, name
        assert _holds(value, getattr(truth, name)), name
    assert not found.misfit


def test_a_valley_of_the_profile_is_found_between_fits_on_a_slope():
    """Between Tabor parameters 0.32 and 1, whose chi square falls on to a plateau from 10 on, 9 above the truth's."""
    found = _fit(_truth(0.5, 0.3e-9, 0.018, sensitivity=0.85), 0.005, seed=6, count=1000)
    assert found.best.tabor == pytest.approx(0.5, rel=0.1)
    assert _holds(found.values["spacing"], 0.3e-9)


def test_jkr_bounds_the_spacing_above_only():
    truth = _truth(50.0, 0.01e-9, 0.05)
    found = _fit(truth, 0.01, theory=by_jkr, models=("jkr", "dmt"))
    work, spacing = found.values["work_of_adhesion"], found.values["spacing"]
    assert work.identified
    assert _holds(work, WORK)
    assert spacing.low is None
    assert not spacing.identified
    assert any("eps is bounded above only: below" in line for line in words.warnings(found))
    assert any("eps" in line for line in words.remedies(found))
    assert found.candidates[-1].name == "dmt"
    assert "dmt is worse by" in words.comparison(found)


def test_rigid_data_give_dgamma_and_leave_the_tabor_parameter_open():
    """On a stiff spring the attraction is followed, so that eps is known; on a soft one in noise it is not."""
    stiff, soft = (_truth(0.02, 0.3e-9, stiffness) for stiffness in (2.0, 0.01))
    known, hidden = _fit(stiff, 0.005), _fit(soft, 0.05)
    for found in (known, hidden):
        assert _holds(found.values["work_of_adhesion"], WORK)
        assert _holds(found.values["spacing"], 0.3e-9)
    assert known.values["spacing"].identified
    assert not hidden.values["spacing"].identified
    assert any("The jump on is inside the noise: eps is" in line for line in words.warnings(hidden))


def test_a_wrong_compliance_is_a_misfit():
    truth = _truth(1.0, 0.3e-9, 0.2, compliance=2.0 / (0.2 * RADIUS * WORK / 0.3e-9))
    found = _fit(truth, 0.005, sensitivity=1.0)
    assert found.misfit
    assert any("does not fit" in line and "widened" in line for line in words.warnings(found))
    assert any("pulls off at" in line for line in words.warnings(found))
    freed = _fit(truth, 0.005, sensitivity=1.0, compliance=Measured(0.0, math.inf))
    assert not freed.misfit
    assert not any("pulls off at" in line for line in words.warnings(freed))
    assert _holds(freed.values["work_of_adhesion"], WORK)


def test_a_wrong_model_does_not_carry_off_a_known_radius():
    truth = _truth(1.0, 0.3e-9, 0.2, compliance=2.0 / (0.2 * RADIUS * WORK / 0.3e-9))
    found = _fit(truth, 0.005, sensitivity=1.0, radius=Measured(RADIUS, 0.05 * RADIUS))
    radius, work = found.values["radius"], found.values["work_of_adhesion"]
    assert (radius.low, radius.value, radius.high) == pytest.approx(
        [RADIUS * math.exp(1.96 * 0.05 * i) for i in (-1, 0, 1)], rel=1e-4
    )
    assert work.high / work.value >= 0.999 * radius.high / radius.value
    assert any("take R more than 5 standard errors from" in line for line in words.warnings(found))


def test_intervals_are_those_of_minos():
    """Of all parameters at once, ln tabor one of them, where each place is as uncertain as a normal error."""
    profile = (found := _fit(_truth(1.0, 0.3e-9, 0.05), 0.005)).profile
    best = profile.best
    minuit = Minuit(
        lambda x: float(np.sum(best.problem.at(x[-1], x[:-1]).residuals(x[:-1]) ** 2)),
        np.append(best.x, best.problem.log_tabor),
        name=(*best.problem.fitted, "tabor"),
    )
    minuit.errordef = best.scale
    minuit.migrad()
    minuit.minos("work_of_adhesion", "sensitivity", cl=chi2.cdf(profile._factor("work_of_adhesion") ** 2, 1))
    for name in ("work_of_adhesion", "sensitivity"):
        ends = minuit.merrors[name]
        assert ends.is_valid
        theirs = [best.problem.value(name, minuit.values[name] + by) for by in (ends.lower, ends.upper)]
        width = theirs[1] - theirs[0]
        assert (found.values[name].low, found.values[name].high) == pytest.approx(theirs, rel=0, abs=0.03 * width)


def _by_trace(**parts):
    """Theory of a contact of tabor 1 that the solver knows and no table."""
    path = halfspace.trace(1.0, rtol=1e-4, to_load=7.0, **parts).resampled(600)
    return lambda _: attracted(np.array([path.approach, path.load]), 1.0, 2)


def test_a_layer_shows_in_the_residuals_on_a_stiff_spring():
    found = _fit(_truth(1.0, 0.3e-9, 2.0), 0.002, theory=_by_trace(body=Layer(2.0, 0.3)))
    assert not _holds(found.values["work_of_adhesion"], WORK)
    assert found.misfit


def test_data_of_a_morse_law_hide_in_another_eps_and_are_fitted_by_their_own_law():
    found = _fit(_truth(1.0, 0.3e-9, 0.1), 0.002, theory=_by_trace(law=Morse(3.0)), models=("morse:3",))
    assert not _holds(found.values["work_of_adhesion"], WORK)
    assert not found.misfit
    assert any("depends on the law" in line for line in words.warnings(found))
    own = next(one for one in found.candidates if one.name == "morse:3")
    assert _holds(own.values["work_of_adhesion"], WORK)
    assert _holds(own.values["spacing"], 0.3e-9)
    assert own.values["spacing"].identified


def test_what_a_finite_sphere_does_to_dgamma_is_told():
    found = _fit(_truth(1.0, RADIUS / 20, 0.1), 0.002, theory=_by_trace(profile=Sphere(20.0)))
    assert found.values["work_of_adhesion"].high < 0.96 * WORK
    (told,) = (line for line in words.warnings(found) if line.startswith("A whole sphere"))
    corrected = float(re.search(r"dgamma is near ([\d.]+) mJ/m\^2", told)[1]) * 1e-3
    assert corrected == pytest.approx(WORK, rel=0.02)
    large = _fit(_truth(1.0, 0.1e-9, 0.1), 0.01)
    assert not any(line.startswith("A whole sphere") for line in words.warnings(large))


def test_what_is_known_before_narrows_what_is_free():
    truth = _truth(1.0, 0.3e-9, 0.05)
    widths = []
    for error in (0.2, 0.01):
        found = _fit(truth, 0.01, radius=Measured(RADIUS, error * RADIUS))
        value, radius = found.values["work_of_adhesion"], found.values["radius"]
        assert _holds(value, WORK)
        assert not any("R ended" in line for line in words.warnings(found))
        drawn = replace(found, values={**found.values, "radius": replace(radius, value=math.exp(-3 * error) * RADIUS)})
        assert any("R ended 3 standard errors from the 50 nm" in line for line in words.warnings(drawn))
        widths.append(value.high - value.low)
    assert widths[1] < widths[0] / 3


def test_the_command_writes_what_it_found(tmp_path, capsys):
    truth = _truth(1.0, 0.3e-9, 0.2)
    file, out, plot = tmp_path / "curve.csv", tmp_path / "out.json", tmp_path / "fit.png"
    write(file, synthetic(truth, np.random.default_rng(3), noise=1e-10, count=200))
    given = f"--radius 50nm --modulus {truth.modulus}Pa --poisson 0.3 --stiffness {truth.stiffness}N/m".split()
    assert cli.main(["fit", str(file), *given, "--models", "jkr", "--json", str(out), "--plot", str(plot)]) == 0
    record = json.loads(out.read_text())
    assert record["work_of_adhesion"]["low"] < WORK < record["work_of_adhesion"]["high"]
    assert record["spacing"]["unit"] == "m"
    assert record["spacing"]["identified"] is True
    assert record["model"] == "atlas"
    assert record["misfit"]["found"] is False
    assert plot.stat().st_size > 10_000
    assert "atlas fits best; jkr is worse by" in " ".join(capsys.readouterr().out.split())


SPHERE = "--radius 50nm --modulus 1GPa --poisson 0.3"
COUNTER = "--counter-modulus 1GPa --counter-poisson 0.3"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--poisson 0.3", "--radius, --modulus missing"),
        (f"{SPHERE} --models hertz", "model = 'hertz', limit: one of atlas, maugis"),
        (f"{SPHERE} --counter-modulus 1GPa", "both or none"),
        (f"{SPHERE} --radius 1e-30nm", "radius = 1e-39 is outside 1e-10 < radius"),
        (f"{SPHERE} --sensitivity 0", "sensitivity = 0 is outside 0.1 < sensitivity < 10"),
        (f"{SPHERE} --models morse:no", "k = 'no' is not a number"),
        (f"{SPHERE} --models layer:2 {COUNTER}", "model = layer:2 with a counter-body"),
    ],
)
def test_bad_input_is_one_line(tmp_path, options, said, refused):
    file = tmp_path / "curve.csv"
    z = np.concatenate([np.linspace(0, 1e-7, 100), np.linspace(1e-7, 0, 100)])
    file.write_text("\n".join(["piezo_m,force_N", *(f"{x},{1e-9 * (x > 8e-8) * (x - 8e-8) * 1e8}" for x in z)]))
    refused("fit", file, options, "--stiffness 1N/m", words=said)


def test_a_part_that_does_not_go_with_a_soft_contact_leaves_the_fit_of_the_atlas():
    found = _fit(_truth(200.0, 0.3e-9, 0.1), 0.01, models=("sphere", "jkr"))
    assert "the sphere is as small as its contact" in found.unsolved["sphere"]
    assert {one.name for one in found.candidates} == {"atlas", "jkr"}
