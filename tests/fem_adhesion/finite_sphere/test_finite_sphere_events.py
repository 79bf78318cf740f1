"""Events of the elastic sphere against a converged table, a solver of its own, and the limits of rho = R/eps.

The table is checked by the whole sphere in Legendre polynomials, `fem_adhesion.harmonics`, which shares with the finite
elements that made it the surface law and the continuation alone.
"""

import csv
from pathlib import Path

import numpy as np
import pytest
from whole_sphere import surface_deflection

import fem_adhesion
import halfspace
from fem_adhesion import Hemisphere, Scene, harmonics
from halfspace.theories.exact_sphere import RigidSphere

POISSON = 0.3
DATA = Path(__file__).parents[2] / "data" / "finite_sphere_events.csv"


def _table():
    with DATA.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    rows = [{key: value if key == "event" else float(value or "nan") for key, value in row.items()} for row in rows]
    return {(row["tabor"], row["radius_ratio"], row["event"]): row for row in rows}


TABLE = _table()
EVENTS = ("pull_off", "jump_on", "jump_off", "zero_load")


def events_of(tabor, radius_ratio):
    """Rows of the table, by the event's name."""
    return {name: TABLE[tabor, radius_ratio, name] for name in EVENTS if (tabor, radius_ratio, name) in TABLE}


@pytest.mark.parametrize(("tabor", "radius_ratio"), [(0.2, 10), (1, 30)])
def test_the_table_against_the_sphere_in_legendre_polynomials(tabor, radius_ratio):
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio, poisson=POISSON))
    path, table = harmonics.trace(scene, rtol=1e-7), events_of(tabor, radius_ratio)
    assert path.met
    assert set(table) == set(path.events)
    for name, row in table.items():
        event = path.event(name)
        assert abs(event.approach - row["approach"]) <= event.approach_error + row["err_approach"], name
        assert abs(event.load - row["load"]) <= event.load_error + row["err_load"], name
        if not np.isnan(row["contact_radius"]):
            assert event.contact_radius == pytest.approx(row["contact_radius"], abs=1e-5)


CASES = [(1, 10000)]


@pytest.fixture(scope="module", params=CASES, ids=lambda case: f"{case[0]:g}-{case[1]:g}")
def traced(request):
    tabor, radius_ratio = request.param
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio, poisson=POISSON))
    return fem_adhesion.trace(scene, rtol=1e-5), events_of(tabor, radius_ratio)


def test_events_are_right_within_estimates(traced):
    path, table = traced
    assert set(path.events) == set(table)
    for name, row in table.items():
        event = path.event(name)
        assert abs(event.approach - row["approach"]) <= event.approach_error + row["err_approach"], name
        assert abs(event.load - row["load"]) <= event.load_error + row["err_load"], name
        assert event.approach_error <= 1e-5 * path.approach_scale, name
        assert name == "zero_load" or event.load_error <= 1e-5 * abs(event.load), name


@pytest.fixture(scope="module")
def half_space():
    """Events of the half-space under a paraboloid."""
    return {tabor: halfspace.trace(tabor, rtol=1e-7).events for tabor in (0.2, 1.0, 3.0)}


def deviation(half_space, tabor, radius_ratio, name):
    """Approach and load of the sphere's event less those of the half-space."""
    row, event = TABLE[tabor, radius_ratio, name], half_space[tabor][name]
    return np.array([row["approach"] - event.approach, row["load"] - event.load])


def logarithm(poisson):
    """Factor kappa of a point load's deflection beside the half-space's: W/(R E*) [kappa ln(R/r) + constant + ...]."""
    return (1 - 2 * poisson) ** 2 / (2 * np.pi * (1 - poisson))


@pytest.mark.parametrize("tabor", [1.0, 3.0])
@pytest.mark.parametrize("name", ["jump_on", "jump_off"])
def test_the_shift_of_a_jump_has_the_bulks_logarithm(half_space, tabor, name):
    """At a fold d alpha* = mu W s [kappa ln(1/s) + constant + O(s)], s = beta/R = sqrt(mu/rho): fitted to three rho."""
    ratios = np.array([1e2, 1e3, 1e4])
    s = np.sqrt(tabor / ratios)
    shifts = [deviation(half_space, tabor, rho, name)[0] for rho in ratios]
    fitted = np.linalg.solve(np.stack([-np.log(s), np.ones(3), s], axis=1), shifts / s)
    assert fitted[0] == pytest.approx(tabor * half_space[tabor][name].load * logarithm(POISSON), rel=0.05)


@pytest.mark.parametrize("poisson", [0.2, 0.4999])
def test_bulk_compliance_is_logarithmic_but_for_rubber(poisson):
    """Under Gaussian pressures of width b, R = 1: (w(0) - sqrt(pi) b)/W grows by kappa ln 2 as b halves."""
    excess = []
    for b in (0.04, 0.02):
        w = surface_deflection(1.0, poisson, lambda r, b=b: np.exp(-((r / b) ** 2)), np.zeros(1), int(8 / b) + 60)[0]
        excess.append((w - np.sqrt(np.pi) * b) / (np.pi * b**2))
    assert excess[1] - excess[0] == pytest.approx(logarithm(poisson) * np.log(2), abs=0.12 * 0.02)


@pytest.mark.parametrize("tabor", [0.2, 1.0, 3.0])
def test_the_pull_off_load_tends_to_the_half_spaces(half_space, tabor):
    shifts = [abs(deviation(half_space, tabor, rho, "pull_off")[1]) for rho in (10.0, 100.0, 1e3, 1e4)]
    assert np.all(np.diff(shifts) < 0)
    assert shifts[-1] < 0.01 * abs(half_space[tabor]["pull_off"].load)


def test_a_nearly_rigid_hemisphere_pulls_off_as_the_rigid_one():
    """W/(2 pi R dgamma) = -1 + (9/7)/rho - ...: what is left falls as mu^(3/2), as it does on the half-space."""
    rigid = RigidSphere(30.0).pull_off().load
    assert rigid / (2 * np.pi) == pytest.approx(-1 + 9 / 7 / 30, abs=2 / 30**2)
    left = []
    for tabor in (0.02, 0.01):
        scene = Scene(tabor, Hemisphere(radius_ratio=30.0, poisson=POISSON))
        left.append(fem_adhesion.trace(scene, rtol=1e-3).event("pull_off").load - rigid)
    assert 0 < left[1] < 0.02 * abs(rigid)
    assert np.log2(left[0] / left[1]) == pytest.approx(1.5, abs=0.03)
