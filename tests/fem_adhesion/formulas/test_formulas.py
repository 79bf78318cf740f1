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
ALL = np.geomspace(0.01, 300, 10_000)
FOLDED = BIRTH + np.geomspace(1e-3, 300 - BIRTH, 10_000)
EXACT = {
    "pull_off": (ALL, "pull_off_load", lambda mu: atlas.pull_off(mu).load),
    "zero_load_radius": (ALL, "zero_load_radius", lambda mu: atlas.zero_load(mu).contact_radius),
    "jump_on_approach": (FOLDED, "jump_on_approach", lambda mu: atlas.jump_on(mu).take_off.approach),
    "jump_off_approach": (FOLDED, "jump_off_approach", lambda mu: atlas.jump_off(mu).take_off.approach),
    "energy_lost": (FOLDED, "energy_lost", lambda mu: atlas.energy_lost(mu).energy),
}


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


def _within(name, values):
    tabor, in_fits, exact = EXACT[name]
    true = exact(tabor)
    worst = np.max(np.abs(values - true) / (np.abs(true) + (name == "jump_on_approach")))
    assert worst <= float(emit.worst_errors()[in_fits])
    np.testing.assert_allclose(values, getattr(fits, in_fits)(tabor), rtol=1e-11)


@pytest.mark.parametrize("name", EXACT)
def test_python_is_as_close_as_it_says(python, name):
    _within(name, np.array([getattr(python, name)(mu) for mu in EXACT[name][0].tolist()]))


def _compiler(name):
    found = shutil.which(name)
    if not found:
        pytest.skip(f"no {name} here")
    return found


def _run(program, tabors):
    text = "\n".join(map(repr, tabors.tolist()))
    out = subprocess.run([program], input=f"{len(tabors)}\n{text}\n", capture_output=True, text=True, check=True).stdout
    return np.array(out.split(), float)


@pytest.mark.parametrize("language", ["c99", "c++"])
@pytest.mark.parametrize("name", EXACT)
def test_c_is_as_close_as_it_says(made, tmp_path, name, language):
    compiler = _compiler("gcc" if language == "c99" else "g++")
    source = tmp_path / ("main.c" if language == "c99" else "main.cpp")
    source.write_text(
        '#include <stdio.h>\n#include "adhesion.h"\nint main(void) { int n; double mu;'
        ' if (scanf("%d", &n) != 1) return 1;'
        f' while (scanf("%lf", &mu) == 1) printf("%.17g\\n", adhesion_{name}(mu)); return 0; }}\n'
    )
    standard = ["-std=c99", "-pedantic-errors"] if language == "c99" else ["-std=c++11"]
    program = tmp_path / "main"
    strict = [*standard, "-Wall", "-Wextra", "-Werror", "-Wno-unused-function"]
    subprocess.run([compiler, *strict, f"-I{made}", str(source), "-o", str(program), "-lm"], check=True)
    _within(name, _run(program, EXACT[name][0]))


@pytest.mark.parametrize("name", EXACT)
def test_fortran_is_as_close_as_it_says(made, tmp_path, name):
    fortran = _compiler("gfortran")
    (tmp_path / "main.f90").write_text(
        "program main\nuse adhesion\nuse iso_c_binding\ninteger :: n, i\nreal(c_double) :: mu\nread *, n\n"
        f"do i = 1, n\nread *, mu\nprint '(es25.17)', adhesion_{name}(mu)\nend do\nend program\n"
    )
    sources = [str(made / "adhesion.c"), str(made / "adhesion.f90"), "main.f90"]
    subprocess.run([fortran, *sources, "-o", "main", "-lm"], check=True, cwd=tmp_path)
    _within(name, _run(tmp_path / "main", EXACT[name][0]))


def test_fortran_has_every_function_that_c_gives_it(made):
    """Where no compiler is, at least the names meet."""
    bound = set(re.findall(r"bind\(c, name='(\w+)'\)", (made / "adhesion.f90").read_text()))
    assert bound == set(re.findall(r"double (\w+)\(", (made / "adhesion.c").read_text()))
    assert bound == {f"adhesion_{name}_f" for name in (*EXACT, "sphere_factor", "load", "force")}


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


MAIN = {
    "adhesion.h": (
        '#include <stdio.h>\n#include "adhesion.h"\nint main(void) { double a, b, c;'
        ' while (scanf("%lf %lf %lf", &a, &b, &c) == 3) printf("%.17g\\n", adhesion_sphere_factor(a, b, c));'
        " return 0; }\n"
    ),
    "adhesion.f90": (
        "program main\nuse adhesion\nuse iso_c_binding\nreal(c_double) :: a, b, c\ninteger :: s\ndo\n"
        "read (*, *, iostat=s) a, b, c\nif (s /= 0) exit\nprint '(es25.17)', adhesion_sphere_factor(a, b, c)\nend do\n"
        "end program\n"
    ),
}


@pytest.mark.parametrize("language", ["python", *MAIN])
def test_sphere_factor_is_as_close_as_it_says(python, made, tmp_path, spheres, language):
    if language == "python":
        found = np.array([python.sphere_factor(*row) for row in spheres.tolist()])
    else:
        by_c = language == "adhesion.h"
        compiler = (
            [_compiler("gcc"), "-std=c99", "-Wall", "-Werror", "-Wno-unused-function"]
            if by_c
            else [_compiler("gfortran")]
        )
        source = tmp_path / ("main.c" if by_c else "main.f90")
        source.write_text(MAIN[language])
        sources = [str(source)] if by_c else [str(made / "adhesion.c"), str(made / "adhesion.f90"), str(source)]
        subprocess.run([*compiler, f"-I{made}", *sources, "-o", "main", "-lm"], check=True, cwd=tmp_path)
        text = "\n".join(" ".join(map(repr, row)) for row in spheres.tolist())
        out = subprocess.run([tmp_path / "main"], input=text + "\n", capture_output=True, text=True, check=True).stdout
        found = np.array(out.split(), float)
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
    """Rows (10,000, 4) of approach, Tabor, whether unloading, load over that of the pull-off."""
    random, rows = np.random.default_rng(1), []
    for mu in np.exp(random.uniform(np.log(0.01), np.log(300), 80)).tolist():
        curve, least = atlas.curve(mu), atlas.pull_off(mu).load
        stable = {name: ends for name, ends in curve.branches("approach").items() if not name.startswith("unstable")}
        for name, (first, last) in stable.items():
            approach = random.uniform(max(first, -4 * (1 + mu)), last, 160 // len(stable))
            load = curve.at(approach=approach, branch=name).load
            row = np.column_stack([approach, 0 * load + mu, 0 * load + (name != "separated"), load / -least])
            rows.append(row[load < 5])
    return np.concatenate(rows)


def test_load_is_as_close_as_it_says_down_to_tear_off(python, made, tmp_path, states):
    approach, mu, unloading, load = states.T
    assert len(states) > 10_000
    found = fits.load(approach, mu, unloading=unloading > 0)
    assert np.max(np.abs(found / -fits.pull_off_load(mu) - load)) < float(emit.worst_errors()["load"])
    by_python = [python.load(*row) for row in states[:, :3].tolist()]
    np.testing.assert_allclose(by_python, found, rtol=1e-7, atol=1e-7)
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "adhesion.h"\nint main(void) { int n, back; double x, mu;'
        ' if (scanf("%d", &n) != 1) return 1; while (scanf("%lf %lf %d", &x, &mu, &back) == 3)'
        ' printf("%.17g\\n", adhesion_load(x, mu, back)); return 0; }\n'
    )
    program = str(tmp_path / "main")
    command = [_compiler("gcc"), "-std=c99", f"-I{made}", str(tmp_path / "main.c"), "-o", program, "-lm"]
    subprocess.run(command, check=True)
    lines = "\n".join(f"{x!r} {m!r} {int(back)}" for x, m, back in states[:, :3].tolist())
    out = subprocess.run(
        [program], input=f"{len(states)}\n{lines}\n", capture_output=True, text=True, check=True
    ).stdout
    np.testing.assert_allclose(np.array(out.split(), float), found, rtol=1e-7, atol=1e-7)


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


def _pull_off(parameters, coefficient):
    reduced, _, work = parameters
    return coefficient * reduced * work


def test_lammps(python):
    """F_pulloff of jkr and dmt; the contact ends at the approach of JKR's pull-off under dead load."""
    own = python.from_lammps(GAMMA, R1, R2, E)
    assert _pull_off(own, JKR) == pytest.approx(3 * np.pi * GAMMA * R, rel=1e-12, abs=0)
    assert _pull_off(own, DMT) == pytest.approx(4 * np.pi * GAMMA * R, rel=1e-12, abs=0)
    reduced, modulus, work = own
    unit = np.cbrt(reduced * work**2 / modulus**2)  # mu eps
    ends = 1.2277228507842888 * np.cbrt(reduced * GAMMA**2 / modulus**2)
    assert -closed_forms.jkr_pull_off(1.0).approach * unit == pytest.approx(ends, rel=1e-9, abs=0)


def test_lethe(python):
    gamma1, gamma2 = 0.01, 0.04
    effective = gamma1 + gamma2 - (np.sqrt(gamma1) - np.sqrt(gamma2)) ** 2
    assert python.from_lethe(gamma1, gamma2, R1, R2, E)[2] == pytest.approx(effective, rel=1e-12)


def test_cabanapd(python):
    radius, nu = 1e-6, 0.3
    own = python.from_cabanapd(GAMMA, radius, E, nu)
    assert _pull_off(own, JKR) == pytest.approx(3 / 2 * np.pi * (0.5 * radius) * (2.0 * GAMMA), rel=1e-12, abs=0)
    reduced, modulus, work = own
    theirs = E / (2 * (1 - nu) ** 2)  # the modulus of its tear-off
    a0 = (9 / 2 * 2 * GAMMA * np.pi / theirs * reduced**2) ** (1 / 3)
    tear = 1 / 2 * 6 ** (-1 / 3) * a0**2 / reduced
    unit = np.cbrt(reduced * work**2 / theirs**2)
    assert -closed_forms.jkr_jump_off(1.0).approach * unit == pytest.approx(tear, rel=1e-12, abs=0)
    assert modulus == pytest.approx(theirs * (1 - nu) ** 2 / (1 - nu**2), rel=1e-12)


def test_yade(python):
    assert _pull_off(python.from_yade(GAMMA, R1, R2, E), DMT) == pytest.approx(4 * np.pi * R * GAMMA, rel=1e-12, abs=0)


@pytest.mark.parametrize(("alpha", "coefficient"), [(1.0, JKR), (1e-9, DMT)])
def test_woo(python, alpha, coefficient):
    K = 4 / 3 * E
    own = python.from_woo(GAMMA, alpha, R1, R2, K)
    assert _pull_off(own, coefficient) == pytest.approx(6 * np.pi * R * GAMMA / (alpha**2 + 3), rel=1e-12, abs=0)
    assert own[1] == pytest.approx(E, rel=1e-12)
    assert _pull_off(python.from_woo(GAMMA, 0.0, R1, R2, K), DMT) == pytest.approx(
        4 * np.pi * R * GAMMA, rel=1e-12, abs=0
    )


def test_musen(python):
    """Its force at a contact radius is JKR's at that radius, whatever overlap it has it from."""
    reduced, modulus, work = python.from_musen(0.01, 0.04, R1, R2, E)
    a = 1e-7
    theirs = 4 * a**3 * E / (3 * R) - np.sqrt(8 * np.pi * E * np.sqrt(0.01 * 0.04) * a**3)
    beta = np.cbrt(reduced**2 * work / modulus)
    assert closed_forms.jkr_load(a / beta) * reduced * work == pytest.approx(theirs, rel=1e-9, abs=0)


@pytest.mark.parametrize(("words", "factor"), [("Maugis's λ", 1.1570), ("μ_MYD", 2.921)])
def test_parameters_of_others(made, words, factor):
    line = next(line for line in (made / "formulas.md").read_text().splitlines() if words in line)
    mydian = 32 / (3 * np.pi) * np.cbrt(2 / np.pi)
    maugis = 16 / (9 * np.sqrt(3)) * np.cbrt(9 / (2 * np.pi))
    assert f"{factor:g}" in line.replace("1.1570", "1.157")
    assert factor == pytest.approx(mydian if "MYD" in words else maugis, rel=2e-4)
