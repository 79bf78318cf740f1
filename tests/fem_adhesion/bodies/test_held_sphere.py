"""The sphere held over a cap: its mesh, the patch test, the hemisphere, punches as small caps, and its convergence."""

import numpy as np
import pytest
from skfem import Basis, ElementQuadP

from fem_adhesion.elasticity.cells import Cells, cell_stiffness
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped, sliding
from fem_adhesion.elasticity.space import Space, ring_measure
from fem_adhesion.elasticity.surface import boundary_points
from fem_adhesion.mesh import spheres as module
from fem_adhesion.mesh.spheres import CORE, DEPTH, held_sphere
from halfspace.elastic import grid

NU, R = 0.3, 30.0
CAPS = (1.0, 30.0, 75.0, 88.0, 90.0)  # by lines, in the core, beside it, by rings about the equator, at the equator


def lines(radius=R, finest=0.6, edge=2.0):
    x = grid.graded(edge, finest, CORE * radius, growth=2.5)
    return x, grid.graded(0.0, finest, DEPTH * radius, growth=2.5)


def sphere(cap_angle, radius=R, **how):
    return held_sphere(radius, *lines(radius, **how), cap_angle)


def coarse_sphere(cap_angle):
    """A sphere of four lines, too few to lead to the rim of a small cap."""
    return sphere(cap_angle, 2.5, finest=0.8, edge=0.0)


def gaussian(radii):
    return np.exp(-((radii / 3.0) ** 2))


def pole_compliance(body, pressure=gaussian):
    """Deflection of the pole per unit load."""
    operator = body.operator
    p = pressure(operator.radii)
    return operator.axis_row @ (operator.compliance @ p) / (operator.weights @ p)


def held(mesh, degree, grip=clamped):
    return condense(Space(mesh, ElementQuadP(degree)), NU, far_field=grip)


# --- the mesh ---


def surface_area(space, name):
    trace = boundary_points(space, name, 10)
    return np.sum(ring_measure(trace.places[0]) * trace.lengths)


@pytest.mark.parametrize(("make", "cap_angle"), [*((sphere, cap) for cap in CAPS), (coarse_sphere, 1.0)])
def test_volume_areas_and_cells_are_those_of_a_sphere(make, cap_angle):
    mesh = make(cap_angle)
    radius, space = -mesh.p[1].min() / 2, Space(mesh, ElementQuadP(6))
    volume = np.sum(Cells.of(space).measure)
    cap = 2 * np.pi * radius**2 * (1 - np.cos(np.radians(cap_angle)))
    assert volume == pytest.approx(4 / 3 * np.pi * radius**3, rel=1e-10)
    assert surface_area(space, "contact") == pytest.approx(2 * np.pi * radius**2, rel=1e-10)
    assert surface_area(space, "far") == pytest.approx(cap, rel=1e-10, abs=1e-11 * 4 * np.pi * radius**2)
    determinants = mesh.mapping().detDF(np.array(np.meshgrid(*2 * [np.linspace(0, 1, 7)])).reshape(2, -1))
    assert np.all(determinants * np.sign(determinants.mean(axis=1))[:, None] > 0)  # no cell is turned over


def test_facets_on_the_axis_are_known_despite_rounding():
    """Else they are the cap's or the contact's, and the sphere is held there: by which processor multiplies."""
    mesh = sphere(1.0)
    known = {name: np.sort(facets) for name, facets in mesh.boundaries.items()}
    mesh.p[0, np.unique(mesh.facets[:, known["axis"]])] = 2e-18
    module.named(
        mesh, lambda r, z: {"axis": r == 0, "contact": (r > 0) & (z > -R), "far": (r > 0) & (r < 0.6) & (z < -R)}
    )
    assert np.array_equal(np.sort(mesh.boundaries["axis"]), known["axis"])
    assert np.array_equal(np.sort(mesh.boundaries["contact"]), known["contact"])
    assert np.all(mesh.p[0, mesh.facets[:, mesh.boundaries["axis"]]] == 2e-18)
    ends = np.hypot(*np.diff(mesh.p[:, mesh.facets[:, known["axis"]]], axis=1)[:, 0])
    assert ends.sum() == pytest.approx(2 * R)


# --- elasticity ---


@pytest.mark.parametrize("cap_angle", CAPS)
def test_uniform_tension_is_exact_in_elements_of_the_cells(cap_angle):
    """Linear fields are in the space only if neighbours agree on their common side, function by function."""
    space = Space(coarse_sphere(cap_angle), ElementQuadP(8))
    basis = Basis(space.mesh, space.element, intorder=18)
    r, z = basis.global_coordinates()
    u = np.empty(space.unknowns)
    for component, field in zip(space.components, (-NU * r, z), strict=True):
        u[component] = basis.project(field)
        assert np.max(np.abs(basis.interpolate(u[component]) - field)) < 1e-9
    cells = u[space.cell_dofs]
    forces = np.zeros(space.unknowns)
    np.add.at(forces, space.cell_dofs, np.einsum("cij,jc->ic", cell_stiffness(Cells.of(space), NU), cells))
    volume = 4 / 3 * np.pi * 2.5**3
    assert u @ forces == pytest.approx((1 - NU**2) * volume, rel=1e-9)

    surface = space.scalar_dofs.get_facet_dofs(space.mesh.boundary_facets()).all()
    inside = np.setdiff1d(np.arange(space.scalar_dofs.N), surface)
    assert np.max(np.abs(forces[space.components[:, inside]])) < 1e-9 * np.max(np.abs(forces))


def test_error_falls_with_the_degree_in_spite_of_the_rim():
    bodies = [held(sphere(30.0), degree) for degree in (3, 4, 5, 8)]
    values = np.array([pole_compliance(body) for body in bodies])
    errors = np.abs(values[:-1] / values[-1] - 1)
    assert np.all(errors[1:] < errors[:-1] / 4)
    assert errors[2] < 1e-6
    assert bodies[2].unknowns < 10_000


@pytest.mark.parametrize(
    ("grip", "stiffer"),
    [(sliding, 1.0), (clamped, (1 - NU) * np.log(3 - 4 * NU) / (1 - 2 * NU))],
    ids=["sliding", "bonded"],
)
def test_small_cap_gives_like_a_flat_punch(grip, stiffer):
    """By 1/(2 b E*), bonded by Mossakovskii's factor less (Johnson 1985, section 3.4); a sphere's is ln b away."""

    def gain(cap_angle):
        first, second = (pole_compliance(held(sphere(cap), 5, grip)) for cap in (cap_angle, 2 * cap_angle))
        b = R * np.sin(np.radians([cap_angle, 2 * cap_angle]))
        return (first - second) / -np.diff(1 / (2 * stiffer * b))[0]

    errors = np.abs([gain(1.0) - 1, gain(2.0) - 1])
    assert errors[0] < 3e-3
    assert errors[0] < errors[1] / 1.5
