"""Events of the elastic sphere against a converged table, a solver of its own, and the limits of rho = R/eps.

The table is checked by the whole sphere in Legendre polynomials, `fem_adhesion.harmonics`, which shares with the finite
elements that made it the surface law and the continuation alone.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

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


def require_agreement(path, table):
    """Events of a path are those of the table within the errors of both."""
    assert set(table) == set(path.events)
    for name, row in table.items():
        event = path.event(name)
        assert abs(event.approach - row["approach"]) <= event.approach_error + row["err_approach"], name
        assert abs(event.load - row["load"]) <= event.load_error + row["err_load"], name


@pytest.mark.parametrize(("tabor", "radius_ratio"), [(0.2, 10), (1, 30)])
def test_the_table_against_the_sphere_in_legendre_polynomials(tabor, radius_ratio):
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio, poisson=POISSON))
    path, table = harmonics.trace(scene, rtol=1e-7), events_of(tabor, radius_ratio)
    assert path.met
    require_agreement(path, table)
    for name, row in table.items():
        radius = pytest.approx(row["contact_radius"], abs=1e-5, nan_ok=True)
        assert path.event(name).contact_radius == radius or np.isnan(row["contact_radius"])


def test_events_are_right_within_estimates():
    scene = Scene(1.0, Hemisphere(radius_ratio=1e4, poisson=POISSON))
    path, table = fem_adhesion.trace(scene, rtol=1e-5), events_of(1.0, 1e4)
    require_agreement(path, table)
    for name, event in path.events.items():
        assert event.approach_error <= 1e-5 * path.approach_scale, name
        assert name == "zero_load" or event.load_error <= 1e-5 * abs(event.load), name


@pytest.mark.parametrize("tabor", [1.0, 3.0])
def test_the_shift_of_a_jump_has_the_bulks_logarithm(tabor):
    """At a fold d alpha* = mu W s [kappa ln(1/s) + constant + O(s)], s = beta/R = sqrt(mu/rho): fitted to three rho.

    A point load's deflection beside the half-space's is W/(R E*) [kappa ln(R/r) + constant + ...].
    """
    kappa, events = (1 - 2 * POISSON) ** 2 / (2 * np.pi * (1 - POISSON)), halfspace.trace(tabor, rtol=1e-7).events
    ratios = np.array([1e2, 1e3, 1e4])
    s = np.sqrt(tabor / ratios)
    for name in ("jump_on", "jump_off"):
        shifts = [TABLE[tabor, ratio, name]["approach"] - events[name].approach for ratio in ratios]
        fitted = np.linalg.solve(np.stack([-np.log(s), np.ones(3), s], axis=1), shifts / s)
        assert fitted[0] == pytest.approx(tabor * events[name].load * kappa, rel=0.05), name


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
