"""The same formulas in Python, C and Fortran, fitted to the atlas; adapters beside what the codes compute."""

import importlib.util
import re
import shutil
import subprocess

import numpy as np
import pytest

from fem_adhesion import cli
from fem_adhesion.formulas import emit, fit, fit_force
from halfspace import atlas
from halfspace.atlas import sphere
from halfspace.theories import closed_forms, fits

BIRTH = atlas.birth_of_folds().value
TABORS = np.append(np.geomspace(0.01, 300, 10_000), BIRTH + np.geomspace(1e-3, 1, 1000))
NAMES = {name: getattr(fits, name) for name in ("zero_load_radius", "jump_on_approach", "jump_off_approach")}
NAMES |= {"pull_off": fits.pull_off_load, "energy_lost": fits.energy_lost}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    directory = tmp_path_factory.mktemp("formulas") / "out"
    assert cli.main(["formulas", "--out", str(directory)]) == 0
    assert sorted(file.name for file in directory.iterdir()) == sorted(emit.NAMES)
    return directory


@pytest.fixture(scope="module")
def python(made):
    spec = importlib.util.spec_from_file_location("adhesion", made / "adhesion.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_coefficients_are_what_the_fit_gives():
    found = fit.constants()
    assert found.keys() == fits.CONSTANTS.keys()
    for name, value in found.items():
        np.testing.assert_allclose(value, fits.CONSTANTS[name], rtol=1e-3, atol=0)


def test_coefficients_of_the_load_are_what_the_fit_gives():
    stored = fits.FORCE[-1]
    for name, value in fit_force.piece(stored["from"], stored["to"]).items():
        np.testing.assert_allclose(value, stored[name], rtol=1e-3, atol=1e-4)


C = """#include <stdio.h>
#include "adhesion.h"
double {declared};
int main(void) {{ while (scanf("{form}", {read}) == {count}) printf("{out}\\n", {called}); return 0; }}
"""
FORTRAN = """program main
use adhesion
use iso_c_binding
{declared}
integer :: s
do
read (*, *, iostat=s) {read}
if (s /= 0) exit
print '({count}es26.17e3)', {called}
end do
end program
"""
COMPILERS = {  # with the file of a program
    "c99": ("gcc", "main.c", "-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function"),
    "c++": ("g++", "main.cpp", "-std=c++11", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function"),
    "fortran": ("gfortran", "main.f90", "-ffree-line-length-none"),
}


@pytest.fixture
def computed(made, tmp_path):
    """Values of functions at rows of inputs by a compiled program."""

    def compute(language, functions, inputs, rows):
        name, file, *options = COMPILERS[language]
        if not (compiler := shutil.which(name)):
            pytest.skip(f"no {name} here")
        called = ", ".join(f"adhesion_{function}({', '.join(inputs)})" for function in functions)
        if language == "fortran":
            declared, sources = f"real(c_double) :: {', '.join(inputs)}", [made / "adhesion.c", made / "adhesion.f90"]
            text = FORTRAN.format(declared=declared, read=", ".join(inputs), count=len(functions), called=called)
        else:
            sources, out, form = [], " ".join(["%.17g"] * len(functions)), " ".join(["%lf"] * len(inputs))
            declared, read = ", ".join(inputs), ", ".join(f"&{one}" for one in inputs)
            text = C.format(declared=declared, form=form, read=read, count=len(inputs), out=out, called=called)
        (tmp_path / file).write_text(text)
        command = [compiler, *options, f"-I{made}", *map(str, sources), file, "-o", "main", "-lm"]
        subprocess.run(command, check=True, cwd=tmp_path)
        lines = "".join(" ".join(f"{value:.17g}" for value in row) + "\n" for row in rows)
        done = subprocess.run([tmp_path / "main"], input=lines, capture_output=True, text=True, check=True)
        return np.array(done.stdout.split(), float).reshape(len(rows), len(functions))

    return compute


@pytest.mark.parametrize("language", ["python", *COMPILERS])
def test_every_language_has_the_same_formulas(python, computed, language):
    """Those of `halfspace.theories.fits`, which are as close as they say; there are no jumps below their birth."""
    if language == "python":
        found = np.array([[getattr(python, name)(mu) for name in NAMES] for mu in TABORS.tolist()])
    else:
        found = computed(language, NAMES, ["mu"], TABORS[:, None])
    for name, values in zip(NAMES, found.T, strict=True):
        np.testing.assert_allclose(values, NAMES[name](TABORS), rtol=1e-11, err_msg=name)


def test_fortran_has_every_function_that_c_gives_it(made):
    """Where no compiler is, at least the names meet."""
    bound = set(re.findall(r"bind\(c, name='(\w+)'\)", (made / "adhesion.f90").read_text()))
    assert bound == set(re.findall(r"double (\w+)\(", (made / "adhesion.c").read_text()))
    assert bound == {f"adhesion_{name}_f" for name in (*NAMES, "sphere_factor", "load", "force")}


@pytest.fixture(scope="module")
def spheres():
    """Tabor parameters, R/eps and Poisson's ratios (10,000, 3) within the atlas, and at its ends."""
    random, count = np.random.default_rng(2), 10_000
    ratio = np.exp(random.uniform(np.log(5), np.log(1e5), count))
    ratio[::2] = random.uniform(5, 60, count // 2)
    most = np.minimum(10, ratio / 2.25 * (1 - 1e-12))
    tabor = 0.05 * (most / 0.05) ** random.random(count)
    poisson = random.uniform(0, 0.49, count)
    tabor[::10], poisson[1::10], poisson[2::10] = most[::10], 0.49, 0
    return np.column_stack([tabor, ratio, poisson])


@pytest.mark.parametrize("language", ["python", "c99", "fortran"])
def test_sphere_factor_is_as_close_as_it_says(python, computed, spheres, language):
    if language == "python":
        found = np.array([python.sphere_factor(*row) for row in spheres.tolist()])
    else:
        found = computed(language, ["sphere_factor"], ["a", "b", "c"], spheres)[:, 0]
    np.testing.assert_allclose(found, fits.sphere_factor(*spheres.T), rtol=1e-12)
    worst = np.max(np.abs(found / sphere.pull_off(*spheres.T).load_ratio - 1))
    assert 0.5 * float(emit.worst_errors()["sphere_factor"]) < worst <= float(emit.worst_errors()["sphere_factor"])


@pytest.mark.parametrize(
    "inputs", [(0.04, 50.0, 0.3), (1.0, 2e5, 0.3), (1.0, 4.0, 0.3), (4.0, 8.9, 0.3), (1.0, 50.0, 0.5)]
)
def test_there_is_no_sphere_factor_outside(python, inputs):
    assert np.isnan(python.sphere_factor(*inputs))
    assert np.isnan(fits.sphere_factor(*inputs))


@pytest.fixture(scope="module")
def states():
    """Rows (3,000, 4) of approach, Tabor, whether unloading, load over that of the pull-off."""
    random, rows = np.random.default_rng(1), []
    for mu in np.exp(random.uniform(np.log(0.01), np.log(300), 10)).tolist():
        curve, least = atlas.curve(mu), atlas.pull_off(mu).load
        stable = {name: ends for name, ends in curve.branches("approach").items() if not name.startswith("unstable")}
        for name, (first, last) in stable.items():
            approach = random.uniform(max(first, -4 * (1 + mu)), last, 320 // len(stable))
            load = curve.at(approach=approach, branch=name).load
            row = np.column_stack([approach, 0 * load + mu, 0 * load + (name != "separated"), load / -least])
            rows.append(row[load < 5])
    return np.concatenate(rows)


def test_load_is_as_close_as_it_says_down_to_tear_off(python, computed, states):
    approach, mu, unloading, load = states.T
    assert len(states) > 2500
    found = fits.load(approach, mu, unloading=unloading > 0)
    assert np.max(np.abs(found / -fits.pull_off_load(mu) - load)) < float(emit.worst_errors()["load"])
    by_python = [python.load(*row) for row in states[:, :3].tolist()]
    np.testing.assert_allclose(by_python, found, rtol=1e-7, atol=1e-7)
    by_c = computed("c99", ["load"], ["x", "mu", "back"], states[:, :3])[:, 0]
    np.testing.assert_allclose(by_c, found, rtol=1e-7, atol=1e-7)


def test_load_past_tear_off_is_that_of_surfaces_apart(python):
    off = float(atlas.jump_off(5.0).take_off.approach)
    apart = float(atlas.curve(5.0).at(approach=off - 1, branch="separated").load)
    assert fits.load(off - 1, 5.0, unloading=True) == pytest.approx(apart, abs=0.0375)
    assert fits.load(0.0, 5.0, unloading=False) == fits.load(0.0, 5.0, unloading=True)  # it has jumped on
    assert np.isnan(fits.load(0.0, 301.0, unloading=True))
    eps = np.cbrt(R * 0.04**2 / E**2) / 5
    own = python.force(-2 * eps, R, E, 0.04, 5.0, True)
    assert own == pytest.approx(R * 0.04 * float(fits.load(-2.0, 5.0, unloading=True)), rel=1e-9, abs=0)


@pytest.mark.parametrize("tabor", [0.5, 0.6, 0.69])
def test_a_pair_of_complex_folds_tends_to_both_folds(tabor):
    """Below their birth the middle of both goes on as it was above, and the square of their distance too."""
    fold, birth = fit_force.complex_fold(tabor), BIRTH
    above = birth + (birth - tabor)
    on, off = (float(jump(above).take_off.approach) for jump in (atlas.jump_on, atlas.jump_off))
    middle = float(atlas.jump_on(birth + 1e-9).take_off.approach)
    assert fold.real - middle == pytest.approx(middle - (on + off) / 2, rel=0.1)
    assert 2 * abs(fold.imag) == pytest.approx(on - off, rel=0.35)


R1, R2, E, GAMMA = 2.0e-6, 3.0e-6, 5.0e9, 0.02
R = R1 * R2 / (R1 + R2)
JKR, DMT = 1.5 * np.pi, 2 * np.pi  # pull-off in R dgamma


@pytest.mark.parametrize(
    ("code", "inputs", "coefficient", "force"),
    [
        ("lammps", (GAMMA, R1, R2, E), JKR, 3 * np.pi * GAMMA * R),
        ("lammps", (GAMMA, R1, R2, E), DMT, 4 * np.pi * GAMMA * R),
        ("cabanapd", (GAMMA, R1, E, 0.3), JKR, 3 / 2 * np.pi * (0.5 * R1) * (2.0 * GAMMA)),
        ("yade", (GAMMA, R1, R2, E), DMT, 4 * np.pi * R * GAMMA),
        ("woo", (GAMMA, 1.0, R1, R2, 4 / 3 * E), JKR, 6 * np.pi * R * GAMMA / 4),
        ("woo", (GAMMA, 1e-9, R1, R2, 4 / 3 * E), DMT, 6 * np.pi * R * GAMMA / 3),
        ("woo", (GAMMA, 0.0, R1, R2, 4 / 3 * E), DMT, 4 * np.pi * R * GAMMA),
    ],
)
def test_the_pull_off_is_that_of_the_code(python, code, inputs, coefficient, force):
    reduced, modulus, work = getattr(python, f"from_{code}")(*inputs)
    assert coefficient * reduced * work == pytest.approx(force, rel=1e-12, abs=0)
    assert code != "woo" or modulus == pytest.approx(E, rel=1e-12)


def test_lammps_ends_a_contact_at_the_approach_of_the_pull_off_under_dead_load(python):
    reduced, modulus, work = python.from_lammps(GAMMA, R1, R2, E)
    unit = np.cbrt(reduced * work**2 / modulus**2)  # mu eps
    ends = 1.2277228507842888 * np.cbrt(reduced * GAMMA**2 / modulus**2)
    assert -closed_forms.jkr_pull_off(1.0).approach * unit == pytest.approx(ends, rel=1e-9, abs=0)


def test_the_work_of_adhesion_of_lethe(python):
    gamma1, gamma2 = 0.01, 0.04
    effective = gamma1 + gamma2 - (np.sqrt(gamma1) - np.sqrt(gamma2)) ** 2
    assert python.from_lethe(gamma1, gamma2, R1, R2, E)[2] == pytest.approx(effective, rel=1e-12)


def test_cabanapd_tears_off_where_jkr_jumps_off(python):
    nu = 0.3
    reduced, modulus, work = python.from_cabanapd(GAMMA, R1, E, nu)
    theirs = E / (2 * (1 - nu) ** 2)  # the modulus of its tear-off
    a0 = (9 / 2 * 2 * GAMMA * np.pi / theirs * reduced**2) ** (1 / 3)
    tear = 1 / 2 * 6 ** (-1 / 3) * a0**2 / reduced
    unit = np.cbrt(reduced * work**2 / theirs**2)
    assert -closed_forms.jkr_jump_off(1.0).approach * unit == pytest.approx(tear, rel=1e-12, abs=0)
    assert modulus == pytest.approx(theirs * (1 - nu) ** 2 / (1 - nu**2), rel=1e-12)


def test_the_force_of_musen_at_a_contact_radius_is_jkrs(python):
    """Whatever overlap it has it from."""
    reduced, modulus, work = python.from_musen(0.01, 0.04, R1, R2, E)
    a = 1e-7
    theirs = 4 * a**3 * E / (3 * R) - np.sqrt(8 * np.pi * E * np.sqrt(0.01 * 0.04) * a**3)
    beta = np.cbrt(reduced**2 * work / modulus)
    assert closed_forms.jkr_load(a / beta) * reduced * work == pytest.approx(theirs, rel=1e-9, abs=0)


@pytest.mark.parametrize(
    ("words", "factor"),
    [
        ("Maugis's λ", 16 / (9 * np.sqrt(3)) * np.cbrt(9 / (2 * np.pi))),
        ("μ_MYD", 32 / (3 * np.pi) * np.cbrt(2 / np.pi)),
    ],
)
def test_parameters_of_others(made, words, factor):
    line = next(line for line in (made / "formulas.md").read_text().splitlines() if words in line)
    assert f"{factor:.4g}" in line
