"""Wall times of what users wait for, run by `make bench`."""

import os
import resource
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from scipy.linalg.lapack import dgesv

import fem_adhesion
import halfspace
from fem_adhesion import Hemisphere, Scene
from fem_adhesion.crosscheck import study as crosscheck

QUICK = bool(os.environ.get("QUICK"))  # one of each solver, once
full = pytest.mark.skipif(QUICK, reason="not in the quick form")


def _all(*values):
    return values[:1] if QUICK else values


def _rounds(number):
    return 1 if QUICK else number


def test_yardstick_dgesv_of_200(benchmark):
    rng = np.random.default_rng(0)
    matrix, rhs = rng.normal(size=(200, 200)), rng.normal(size=200)
    *_, info = benchmark(dgesv, matrix, rhs)
    assert info == 0


@pytest.mark.parametrize("tabor", _all(1, 0.05, 2, 5, 50, 100, 300))
@pytest.mark.parametrize("rtol", _all(1e-6, 1e-8))
def test_halfspace_trace(benchmark, tabor, rtol):
    path = benchmark.pedantic(halfspace.trace, (tabor,), {"rtol": rtol}, rounds=_rounds(5), warmup_rounds=1)
    assert path.event("pull_off").load_error < rtol * 10


PARTS = {
    "sphere": {"profile": halfspace.profiles.Sphere(100)},
    "layer": {"body": halfspace.Layer(thickness=2.0, poisson=0.3)},
    "morse": {"law": halfspace.laws.Morse(10)},
    "power-1.5": {"profile": halfspace.profiles.Power(1.5)},
}


@full
@pytest.mark.parametrize("parts", PARTS)
def test_halfspace_trace_of_other_parts(benchmark, parts):
    path = benchmark.pedantic(halfspace.trace, (1.0,), PARTS[parts], rounds=_rounds(3), warmup_rounds=1)
    assert path.met


@pytest.mark.parametrize("tabor", _all(1, 0.05, 5))
@pytest.mark.parametrize("rtol", _all(1e-5, 1e-4, 1e-7, 1e-8))
def test_finite_element_trace(benchmark, tabor, rtol):
    path = benchmark.pedantic(fem_adhesion.trace, (Scene(tabor=tabor),), {"rtol": rtol}, rounds=_rounds(3))
    assert path.event("pull_off").load_error < rtol * 10


BODIES = {
    "tabor-20": Scene(20.0),
    "tabor-50": Scene(50.0),
    "layer": Scene(1.0, fem_adhesion.Layer(2.0)),
    "held-sphere": Scene(1.0, fem_adhesion.HeldSphere(radius_ratio=100)),
}


@full
@pytest.mark.parametrize("name", BODIES)
def test_finite_element_trace_of_larger_and_other_bodies(benchmark, name):
    path = benchmark.pedantic(fem_adhesion.trace, (BODIES[name],), {"rtol": 1e-5}, rounds=1)
    assert path.event("pull_off").load_error < 1e-5 * abs(path.event("pull_off").load)


@full
def test_pull_off_curve_of_60_tabor_parameters(benchmark):
    """The curve of [G97] Fig. 7 to 1e-6, on one core."""

    def curve():
        tabors = np.geomspace(0.02, 10, 60)
        return [halfspace.trace(tabor, rtol=1e-6).event("pull_off").load for tabor in tabors]

    loads = benchmark.pedantic(curve, rounds=1)
    assert np.all(np.diff(loads) > 0)


@full
def test_sweep_of_200_tabor_parameters_on_all_cores(benchmark):
    """By a pool of processes, which is made before."""
    with ProcessPoolExecutor() as pool:
        list(pool.map(abs, range(100)))
        tabors = np.geomspace(0.05, 50, 200)
        found = benchmark.pedantic(halfspace.sweep, (tabors,), {"rtol": 1e-6, "map": pool.map}, rounds=1)
    assert not found.reasons
    assert found.met.mean() > 0.99


@full
def test_comparison(benchmark):
    case = benchmark.pedantic(crosscheck.compare, (Scene(tabor=1.0),), {"rtol": 1e-5}, rounds=_rounds(3))
    assert case.verdict == "agree"


def test_peak_memory_of_a_finite_element_trace(benchmark, capsys):
    code = "from fem_adhesion import Scene, trace; trace(Scene(tabor=1.0), rtol=1e-5)"
    benchmark.pedantic(subprocess.run, ([sys.executable, "-c", code],), {"check": True}, rounds=1)
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    with capsys.disabled():
        print(f"\npeak memory of one process: {peak:.0f} MiB")
    assert peak < 1024


@full
@pytest.mark.parametrize("tabor", [1, 0.2, 3])
@pytest.mark.parametrize("radius_ratio", [100, 10, 30, 1000, 10000])
def test_finite_sphere_trace(benchmark, tabor, radius_ratio):
    """Hemisphere on a sliding mid-plane, true profile, poisson 0.3."""
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio))
    path = benchmark.pedantic(fem_adhesion.trace, (scene,), {"rtol": 1e-5}, rounds=1)
    assert path.event("pull_off").load_error < 1e-5 * abs(path.event("pull_off").load)


@full
@pytest.mark.parametrize(("tabor", "radius_ratio"), [(1.0, 100), (3.0, 100)])
def test_finite_strain_trace(benchmark, tabor, radius_ratio):
    """The same of a neo-Hookean one."""
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio, material=fem_adhesion.NeoHookean()))
    path = benchmark.pedantic(fem_adhesion.trace, (scene,), {"rtol": 1e-3}, rounds=1)
    assert path.met
