"""A body from a file, solved like any other."""

from pathlib import Path

import numpy as np
import pytest
from skfem import CellBasis, ElementQuad2, MeshQuad, MeshQuad2

import fem_adhesion
from fem_adhesion import Scene
from fem_adhesion.refinement import refined
from halfspace.errors import GridTooCoarse

MESHES = Path(__file__).parents[1] / "meshes"


def meshed(name, radius_ratio, **changes):
    return Scene(1.0, body=MESHES / f"{name}.msh", radius_ratio=radius_ratio, **changes)


def test_a_meshed_hemisphere_agrees_with_ours_within_the_estimates():
    theirs = fem_adhesion.trace(meshed("hemisphere", 30.0), rtol=1e-3)
    ours = fem_adhesion.trace(Scene(1.0, body="hemisphere", profile="sphere", radius_ratio=30.0), rtol=1e-4)
    for name, a in theirs.events.items():
        b = ours.events[name]
        assert abs(a.load - b.load) <= a.load_error + b.load_error
        assert abs(a.approach - b.approach) <= a.approach_error + b.approach_error
        assert a.approach_error < 1e-3


def test_a_tip_pulls_as_its_cap_does_and_yields_more():
    """A slender tip is softer in bulk, so that its grip is further away under tension; the force is local."""
    tip = fem_adhesion.trace(meshed("tip", 100.0, grip="bonded"), rtol=1e-3).events
    cap = fem_adhesion.trace(meshed("hemisphere", 100.0, grip="bonded"), rtol=1e-3).events
    assert tip["pull_off"].load == pytest.approx(cap["pull_off"].load, rel=5e-3)
    assert tip["jump_off"].approach < cap["jump_off"].approach - 0.1


def test_a_mesh_that_cannot_carry_the_spike_is_refused():
    with pytest.raises(GridTooCoarse, match=r"grid spacing .* beta at the contact edge"):
        fem_adhesion.trace(meshed("hemisphere", 1e4), rtol=1e-3)


def test_refinement_keeps_the_shape_of_curved_quadrilaterals():
    mesh = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.linspace(0, 1, 3), np.linspace(-1, 0, 3)))
    points = mesh.doflocs.copy()
    points[1] += 0.1 * points[0] ** 2
    mesh = MeshQuad2(points, mesh.t)
    fine = refined(mesh)
    assert fine.nelements == 4 * mesh.nelements

    def moments(m):
        basis = CellBasis(m, ElementQuad2(), intorder=8)
        x, y = np.asarray(basis.global_coordinates())
        return np.sum(basis.dx), np.sum(x * y * basis.dx), np.sum(y**2 * basis.dx)

    assert moments(fine) == pytest.approx(moments(mesh), rel=1e-13)
