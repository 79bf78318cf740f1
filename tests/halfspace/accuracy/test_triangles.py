"""The half-space by overlapping triangles and by bands of pressure: right within their estimates, whole, refused."""

import json
import math

import numpy as np
import pytest
from agreement import differing
from references import smooth_pressure

import halfspace
from fem_adhesion import cli
from halfspace.accuracy.kernels import KERNELS
from halfspace.elastic import compliance, grid
from halfspace.elastic.extrapolated import extrapolated
from halfspace.errors import InputError
from halfspace.laws import Dugdale, Morse
from halfspace.profiles import PARABOLOID, Power, Sphere

STRAIGHT = ("triangles", "bands")


@pytest.mark.parametrize("kernel", STRAIGHT)
@pytest.mark.parametrize("tabor", [0.05, 5.0])
def test_events_are_right_within_their_estimates_and_as_accurate_as_asked(tabor, kernel):
    truth = halfspace.trace(tabor, rtol=1e-8)
    for rtol in (1e-3, 1e-5):
        path = halfspace.trace(tabor, kernel=kernel, rtol=rtol)
        assert path.met
        assert path.settings["events"]["kernel"] == kernel
        assert differing(path, truth) == []
        assert path.energy.agrees(truth.energy)
        errors = [abs(path.event(name).load - truth.event(name).load) for name in truth.events if name != "zero_load"]
        estimates = [path.event(name).load_error for name in truth.events if name != "zero_load"]
        assert max(estimates) < 100 * max(errors)


@pytest.mark.parametrize(
    ("law", "profile", "kernel"), [(Morse(3.0), Power(4), "bands"), (Dugdale(0.1), PARABOLOID, "triangles")], ids=str
)
def test_other_laws_and_profiles_are_served_by_the_same_grids(law, profile, kernel):
    truth = halfspace.trace(1.0, law=law, profile=profile, rtol=1e-8)
    path = halfspace.trace(1.0, law=law, profile=profile, kernel=kernel, rtol=1e-3)
    assert path.met
    assert differing(path, truth) == []


def test_the_whole_curve_is_there_with_its_branches_states_and_stability():
    truth, path = halfspace.trace(2.0, rtol=1e-7), halfspace.trace(2.0, kernel="triangles", rtol=1e-4)
    assert path.branches("approach").keys() == truth.branches("approach").keys()
    for branch in path.branches("approach"):
        state, true = (of.at(approach=-3.0, branch=branch) for of in (path, truth))
        assert abs(state.load - true.load) <= state.load_error + true.load_error < 1e-3
    unstable = np.flatnonzero(~path.stable)
    assert path.stable[0]
    assert path.stable[-1]
    assert np.all(np.diff(unstable) == 1)


# --- the operators ---


@pytest.mark.parametrize(("make", "parts"), [(compliance.triangles, 2), (compliance.bands, 3)], ids=STRAIGHT)
def test_two_intervals_leave_an_error_of_third_order_or_better(make, parts):
    """Of the load, known for p = 1/(1 + r^2)^3, and of the mean deflection under it by panels, on uniform intervals."""
    known = compliance.panels(grid.uniform(8.0, 0.5), 16)
    true = math.pi / 2 * (1 - (1 + 8**2) ** -2.0)
    assert known.weights @ smooth_pressure(known.radii) == pytest.approx(true, rel=1e-12)
    work = smooth_pressure(known.radii) * known.weights @ known.compliance @ smooth_pressure(known.radii)
    plain, errors = [], []
    for spacing in (0.2, 0.1, 0.05):
        lines = grid.uniform(8.0, spacing)
        for body, off in ((make(lines), plain), (extrapolated(make, lines, parts), errors)):
            pressure, bears = smooth_pressure(body.radii), smooth_pressure(body.radii) * body.weights
            off.append([abs(bears @ body.compliance @ pressure - work), abs(body.weights @ pressure - true)])
    orders, better = (np.log2(np.array(off[:-1]) / off[1:]) for off in (plain, errors))
    np.testing.assert_allclose(orders, 2, atol=0.15)
    assert (better > 2.9).all()


def test_a_node_on_the_axis_sinks_under_what_lies_beyond_the_extent():
    """Of a disc and what is beyond: p = 1/(1 + r^2)^3 deflects the axis by 2 int p dr = 3 pi/8."""
    body, _ = KERNELS["triangles"].make(20, 1.0, grid.graded(0.0, 0.5, 2.0))
    assert body.radii[0] == 0
    assert body.weights[0] == 0
    assert (body.compliance @ smooth_pressure(body.radii))[0] == pytest.approx(3 * math.pi / 8, rel=1e-5)


# --- what is refused ---


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"rtol": 1e-7}, r"rtol = 1e-07 by kernel = triangles is outside 1e-6 <= rtol <= 0.1; take kernel = panels"),
        ({"body": halfspace.Layer(thickness=2.0, poisson=0.3)}, "triangles does not serve body = .*, limit: the half-"),
        ({"profile": Sphere(100.0)}, "triangles does not serve a profile that ends at 10 beta, limit: endless ones"),
        ({"kernel": "hats"}, "kernel = 'hats' is not one of panels, triangles, bands; take panels"),
    ],
)
def test_what_triangles_do_not_serve_is_refused_in_a_sentence(asked, words):
    with pytest.raises(InputError, match=words):
        halfspace.trace(1.0, **{"kernel": "triangles", **asked})


# --- the command ---


def test_the_command_solves_by_triangles(tmp_path, capsys):
    file = tmp_path / "curve.json"
    assert cli.main(["curve", "--tabor", "1", "--kernel", "triangles", "--rtol", "1e-3", "--json", str(file)]) == 0
    told = json.loads(file.read_text())["solutions"]["half-space"]
    assert told["settings"]["events"]["kernel"] == "triangles"
    load = halfspace.trace(1.0, kernel="triangles", rtol=1e-3).event("pull_off").load
    assert told["events"]["pull_off"]["load"] == pytest.approx(load, rel=1e-12)
    for solver in ("fem", "both"):
        line = ["curve", "--tabor", "1", "--kernel", "triangles", "--rtol", "1e-8", "--solver", solver]
        assert cli.main(line) == 2
    assert "--kernel would have no effect" in (refused := capsys.readouterr().err)
    assert "rtol = 1e-08 by kernel = triangles" in refused
