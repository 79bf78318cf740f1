"""Files for ParaView, read back by VTK, through pyvista, and by meshio, and held against closed forms."""

import json
import sys
from dataclasses import replace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

import fem_adhesion
from fem_adhesion import HalfSpace, Hemisphere, Scene
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.common.files import directory_written_aside
from fem_adhesion.curve.stress import values_at
from fem_adhesion.elasticity import stress
from fem_adhesion.elasticity.cells import Cells, cell_quadrature
from fem_adhesion.elasticity.exterior import boussinesq_displacement, boussinesq_stress
from fem_adhesion.fields import states_along
from fem_adhesion.paraview.arrays import MEANINGS, UNITS, inside, unit_of
from fem_adhesion.paraview.cells import cut_for, lattice, revolved
from fem_adhesion.paraview.write import TOLERANCE, in_plane, write_states
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import Units

vtk = pytest.importorskip("vtk")
pyvista = pytest.importorskip("pyvista")

DEGREE = Discretisation(degree=5)
RADIUS, SPACING, WORK = 1e-7, 3e-10, 0.1
MODULUS = np.sqrt(RADIUS * WORK**2 / SPACING**3)  # so that the Tabor parameter is 1
FILES = {"body": "vtu", "contact": "vtp", "solid": "vtu"}


def write_path(states, directory, **how):
    with directory_written_aside(directory) as aside:
        write_states(states, aside, directory, **how)


@pytest.fixture(scope="module")
def states():
    scene = Scene(1.0)
    return list(states_along(scene, fem_adhesion.trace(scene, rtol=1e-4), points=0, how=DEGREE))


@pytest.fixture(scope="module")
def units():
    return Units(RADIUS, MODULUS, WORK, SPACING)


@pytest.fixture(scope="module")
def folder(states, tmp_path_factory):
    directory = tmp_path_factory.mktemp("vtk") / "curve"
    write_path(states, directory, revolve=90.0)
    return directory


@pytest.fixture(scope="module")
def si(states, units, tmp_path_factory):
    directory = tmp_path_factory.mktemp("vtk") / "si"
    write_path(states, directory, units=units, revolve=90.0)
    return directory


@pytest.fixture(scope="module")
def hemisphere():
    """Zero load of a sphere, which has a radius in beta and a shape of its own."""
    scene = Scene(1.0, Hemisphere(radius_ratio=50.0, poisson=0.2))
    path = fem_adhesion.trace(scene, rtol=1e-2)
    return next(state for state in states_along(scene, path, points=0, how=DEGREE) if state.name == "zero_load")


def read(folder, kind, number=0):
    """File of a kind of a state, by its number."""
    return pyvista.read(folder / f"{kind}_{number:04d}.{FILES[kind]}")


def labels(grid, name):
    """Labels of the components of an array."""
    found = grid.GetPointData().GetArray(name)
    return [found.GetComponentName(k) for k in range(found.GetNumberOfComponents())]


def component(grid, name, label):
    """Values of the component that carries a label."""
    return grid[name][:, labels(grid, name).index(label)]


def note(grid, name):
    return grid.field_data[name][0]


def numbered(states, name):
    return next((k, state) for k, state in enumerate(states) if state.name == name)


# --- every reader ---


@pytest.mark.parametrize("file", ["body_0000.vtu", "solid_0001.vtu"])
def test_every_reader_finds_the_same(si, file):
    one, other = pyvista.read(si / file), meshio.read(si / file)
    np.testing.assert_array_equal(one.points, other.points)
    assert sum(len(block.data) for block in other.cells) == one.n_cells
    for ours, theirs in ((one.point_data, other.point_data), (one.field_data, other.field_data)):
        assert set(ours) == set(theirs)
        for name in ours:
            np.testing.assert_array_equal(ours[name], theirs[name])


def test_no_file_holds_words_and_no_name_a_space(si):
    """Readers that do not know arrays of strings end at one."""
    for file in [*si.glob("*.vtu"), *si.glob("*.vtp")]:
        found = list(ElementTree.parse(file).getroot().iter("DataArray"))
        assert found
        assert not list(ElementTree.parse(file).getroot().iter("Array"))
        assert {one.get("type") for one in found} <= {"Float64", "Int64", "UInt8"}
        assert not any(" " in one.get("Name", "") for one in found)


def test_the_collections_name_their_files_by_arclength(folder, states):
    for kind, suffix in FILES.items():
        entries = list(ElementTree.parse(folder / f"{kind}.pvd").getroot().iter("DataSet"))
        assert [entry.get("file") for entry in entries] == [f"{kind}_{k:04d}.{suffix}" for k in range(len(states))]
        assert [float(entry.get("timestep")) for entry in entries] == [state.point.arclength for state in states]
        assert all((folder / entry.get("file")).is_file() for entry in entries)


# --- what the cells are ---


@pytest.mark.parametrize(("triangular", "kind"), [(False, 28), (True, 22)])
def test_the_nodes_of_a_cell_are_where_vtk_has_them(triangular, kind):
    """VTK's own shape functions are one at the places that the nodes are given, each at its own."""
    cell = {28: vtk.vtkBiQuadraticQuad, 22: vtk.vtkQuadraticTriangle}[kind]()
    wanted = np.reshape([cell.GetParametricCoords()[k] for k in range(3 * cell.GetNumberOfPoints())], (-1, 3))
    cut = lattice(2, triangular=triangular)
    for nodes in cut.element_dofs.T:
        places = cut.doflocs[:, nodes]
        first, along, across = (places[:, [k]] for k in ((0, 1, 3) if not triangular else (0, 1, 2)))
        np.testing.assert_allclose(places, first + (along - first) * wanted[:, 0] + (across - first) * wanted[:, 1])


def test_the_section_is_in_biquadratic_cells_that_cover_it_once(folder):
    grid = read(folder, "body")
    assert set(grid.celltypes) == {28}
    areas = grid.compute_cell_sizes(length=False, volume=False)["Area"]
    assert areas.sum() == pytest.approx(grid.points[:, 0].max() ** 2, rel=1e-6)


def test_nothing_visible_is_lost_between_the_nodes(states, folder):
    """At random places VTK shows the element's field within the tolerance, on no more cells than that takes."""
    number, state = len(states) - 1, states[-1]
    r, depth = np.random.default_rng(0).uniform(0, 4, (2, 2000)) ** 2
    shown = pyvista.PolyData(in_plane(r, -depth)).sample(read(folder, "body", number))
    assert shown["vtkValidPointMask"].all()
    wanted = values_at(state, state.components, r, depth)
    assert np.abs(shown["displacement"].T[[0, 2]] - wanted).max() <= 2e-4 * np.abs(wanted).max()
    fine, coarse = (cut_for(state.space, state.components, tolerance).lattice for tolerance in (1e-4, 1e-2))
    assert coarse.nelems < fine.nelems


# --- what the arrays hold ---


@pytest.fixture(scope="module")
def buried(states, tmp_path_factory):
    """A state whose displacement and stress are those of a point load one beta above the surface, which is known."""
    state = states[-1]
    space, nu = state.space, state.scene.poisson
    u = np.zeros(space.unknowns)
    values = np.stack([_projected(space, k, lambda r, z: boussinesq_displacement(r, z - 1, nu)) for k in (0, 1)])
    u[space.components] = values
    tensor = np.stack([_projected(space, k, lambda r, z: boussinesq_stress(r, z - 1, nu)) for k in range(4)])
    directory = tmp_path_factory.mktemp("buried") / "fields"
    write_path([replace(state, displacement=u, stress=tensor)], directory, revolve=90.0)
    return directory


def _projected(space, number, function):
    """Coefficients of a component of a field of (r, z) in the element's functions."""
    places = cell_quadrature(space)[0]
    return stress.projection(Cells.of(space), function(*stress.positions(space, places))[number][None])[0]


def tensors(rr, zz, tt, rz):
    """Tensors (n, 3, 3) of components along r, theta and z."""
    none = np.zeros_like(rr)
    return np.array([[rr, none, rz], [none, tt, none], [rz, none, zz]]).transpose(2, 0, 1)


def test_the_components_are_those_of_a_known_field(buried):
    """Away from the load the cells are too wide for it: what is held against the closed form is near."""
    grid = read(buried, "body")
    r, y, z = grid.points.T
    assert np.all(y == 0)
    near = np.hypot(r, z) < 2
    u_r, u_z = boussinesq_displacement(r, z - 1, 0.3)
    for label, wanted in (("r", u_r), ("theta", 0 * r), ("z", u_z)):
        found = component(grid, "displacement", label)
        np.testing.assert_allclose(found[near], wanted[near], rtol=0, atol=3e-3)
    rr, zz, tt, rz = boussinesq_stress(r, z - 1, 0.3)
    wanted = {"rr": rr, "tt": tt, "zz": zz, "rz": rz, "rt": 0 * r, "tz": 0 * r}
    for label, values in wanted.items():
        found = component(grid, "stress_cylindrical", label)
        np.testing.assert_allclose(found[near], values[near], rtol=0, atol=5e-3)
    full = tensors(rr, zz, tt, rz)
    least, middle, largest = np.linalg.eigvalsh(full).T
    for label, values in (("largest", largest), ("middle", middle), ("least", least)):
        np.testing.assert_allclose(component(grid, "principal_stresses", label)[near], values[near], atol=5e-3)
    np.testing.assert_allclose(grid["hydrostatic"][near], (rr + tt + zz)[near] / 3, atol=5e-3)
    mises = np.sqrt(((rr - zz) ** 2 + (zz - tt) ** 2 + (tt - rr) ** 2) / 2 + 3 * rz**2)
    np.testing.assert_allclose(grid["von_mises"][near], mises[near], atol=5e-3)
    E, nu = 1 - 0.3**2, 0.3
    work = ((1 + nu) * np.einsum("nij,nij->n", full, full) - nu * (rr + tt + zz) ** 2) / (2 * E)
    np.testing.assert_allclose(grid["strain_energy_density"][near], work[near], atol=5e-3)


def test_the_solid_has_the_known_fields_in_cartesian_components(buried):
    grid = read(buried, "solid")
    x, y, z = grid.points.T
    r = np.hypot(x, y)
    near = (np.hypot(r, z) < 2) & (r > 1e-9)
    c, s = x[near] / r[near], y[near] / r[near]
    assert s.min() >= 0
    assert s.max() == pytest.approx(1)
    u_r, u_z = boussinesq_displacement(r[near], z[near] - 1, 0.3)
    for number, wanted in enumerate((u_r * c, u_r * s, u_z)):
        np.testing.assert_allclose(grid["displacement"][near, number], wanted, atol=3e-3)
    rr, zz, tt, rz = boussinesq_stress(r[near], z[near] - 1, 0.3)
    turn = np.array([[c, -s, 0 * c], [s, c, 0 * c], [0 * c, 0 * c, 1 + 0 * c]]).transpose(2, 0, 1)
    own = tensors(rr, zz, tt, rz)
    turned = turn @ own @ turn.transpose(0, 2, 1)
    for label in ("xx", "yy", "zz", "xy", "yz", "xz"):
        wanted = turned[:, "xyz".index(label[0]), "xyz".index(label[1])]
        np.testing.assert_allclose(component(grid, "stress", label)[near], wanted, atol=2e-2)


def test_the_contact_line_satisfies_surface_law_and_geometry(folder, states):
    """Its columns satisfy the surface law, and gap, deflection, approach and the sphere's height add up."""
    for number, state in enumerate(states):
        line = read(folder, "contact", number)
        assert line.n_lines == 1
        u = line.points[:, 0]
        np.testing.assert_allclose(u, state.surface.radii, rtol=1e-12)
        near = u < 8
        H, w = line["H"], line["deflection"]
        np.testing.assert_array_equal(line["gap"], H + 1)
        np.testing.assert_allclose(line["pressure"], LENNARD_JONES.pressure(H, 1.0), atol=1e-9)
        np.testing.assert_allclose(component(line, "displacement", "z"), -w, atol=0)
        closed = -note(line, "approach") + u**2 / 2 + w
        np.testing.assert_allclose(H[near], closed[near], atol=2e-3)
        largest = np.abs(line["pressure"]).max()
        assert np.abs(line["traction_from_stress"] - line["traction"]).max() < 5e-3 * largest
        P, beside = line["pressure_of_half_space"], line["H_of_half_space"]
        np.testing.assert_allclose(P[near], LENNARD_JONES.pressure(beside, 1.0)[near], atol=2e-3 * largest)
        assert 0 < np.abs(line["pressure"] - P).max() < 2e-3 * largest
        np.testing.assert_array_equal(line["gap_of_half_space"], beside + 1)
        assert note(line, "approach_of_half_space") == pytest.approx(state.observables[0], abs=2e-3)
        assert note(line, "load_of_half_space") == pytest.approx(state.observables[1], abs=2e-3)


def test_the_field_data_are_the_state(folder, states):
    for number, state in enumerate(states):
        for kind in FILES:
            grid = read(folder, kind, number)
            found = [note(grid, name) for name in ("approach", "load", "central_gap", "contact_radius")]
            np.testing.assert_array_equal(found, state.observables)
            asked = [note(grid, name) for name in ("tabor", "poisson", "arclength")]
            assert asked == [1.0, 0.3, state.point.arclength]
            flags = {name: note(grid, f"is_{name}") for name in ("pull_off", "jump_on", "jump_off", "zero_load")}
            assert flags == {name: float(name == state.name) for name in flags}
            assert note(grid, "stable_under_fixed_grips") == state.stable
            assert note(grid, "stable_under_dead_load") == state.stable_under_dead_load
    _, zero_load = numbered(states, "zero_load")
    assert zero_load.stable_under_dead_load


def test_the_notes_say_what_each_name_means(folder, states):
    notes = json.loads((folder / "notes.json").read_text())
    assert [entry["event"] for entry in notes["states"]] == [state.name for state in states]
    assert all((folder / entry["body"]).is_file() for entry in notes["states"])
    assert notes["scene"]["tabor"] == 1.0
    for kind in FILES:
        assert all(unit_of(name)[0] in notes["units"].values() for name in read(folder, kind).point_data)
    assert set(MEANINGS) - {"arclength"} <= set(UNITS)
    assert "tension" in notes["signs"]


# --- SI ---

WANTED = {
    "displacement": ("m", "displacement"),
    "displacement_magnified": ("m", "length"),
    "stress_cylindrical": ("Pa", "pressure"),
    "stress": ("Pa", "pressure"),
    "von_mises": ("Pa", "pressure"),
    "hydrostatic": ("Pa", "pressure"),
    "principal_stresses": ("Pa", "pressure"),
    "strain_energy_density": ("J_per_m3", "density"),
    "pressure": ("Pa", "pressure"),
    "traction": ("Pa", "pressure"),
    "traction_from_stress": ("Pa", "pressure"),
    "pressure_of_half_space": ("Pa", "pressure"),
    "gap": ("m", "gap"),
    "gap_of_half_space": ("m", "gap"),
    "deflection": ("m", "displacement"),
}


BETA = np.cbrt(RADIUS**2 * WORK / MODULUS)
SIZES = {
    "length": BETA,
    "displacement": BETA**2 / RADIUS,
    "pressure": MODULUS * BETA / RADIUS,
    "density": MODULUS * (BETA / RADIUS) ** 2,
    "gap": SPACING,
}
"""SI sizes of the paper's units from the material alone."""


def test_with_a_material_points_and_fields_are_in_si(folder, si, states):
    for kind in FILES:
        for number in range(len(states)):
            plain, real = (read(one, kind, number) for one in (folder, si))
            np.testing.assert_allclose(real.points, plain.points * BETA, rtol=1e-12)
            names = set(plain.point_data)
            assert names <= {*WANTED, "H", "H_of_half_space"}
            assert len(real.point_data) == len(names)
            for name in names & set(WANTED):
                unit, size = WANTED[name]
                np.testing.assert_allclose(real[f"{name}_{unit}"], plain[name] * SIZES[size], rtol=1e-9)
                assert labels(real, f"{name}_{unit}") == labels(plain, name)


def test_with_a_material_the_state_is_in_si_too(si, states):
    number, state = numbered(states, "zero_load")
    grid = read(si, "body", number)
    alpha, load, gap, radius = state.observables
    wanted = {
        "approach_m": alpha * SPACING,
        "load_N": load * RADIUS * WORK,
        "central_gap_m": gap * SPACING,
        "contact_radius_m": radius * BETA,
        "radius_m": RADIUS,
        "spacing_m": SPACING,
        "work_of_adhesion_J_per_m2": WORK,
        "contact_modulus_Pa": MODULUS,
    }
    assert {name: note(grid, name) for name in wanted} == pytest.approx(wanted, rel=1e-12, abs=0)
    true = note(grid, "magnification_of_true_displacement")
    np.testing.assert_allclose(grid["displacement_magnified_m"], true * grid["displacement_m"], rtol=1e-9)


def test_a_sphere_has_its_displacement_in_beta_too(hemisphere, tmp_path, units):
    write_path([hemisphere], tmp_path / "sphere")
    grid = read(tmp_path / "sphere", "body")
    R = note(grid, "sphere_radius_in_beta")
    assert pytest.approx(np.sqrt(50.0)) == R
    np.testing.assert_allclose(grid["displacement_in_beta"], grid["displacement"] / R, rtol=1e-12)
    assert note(grid, "radius_ratio") == 50.0
    assert grid.points[:, 2].min() == pytest.approx(-R, rel=1e-6)
    line = read(tmp_path / "sphere", "contact")
    assert "pressure_of_half_space_which_is_another_body" in line.point_data
    r, _, z = line.points.T
    np.testing.assert_allclose(np.hypot(r, z + R), R, rtol=1e-6)
    write_path([hemisphere], tmp_path / "si", units=units)
    data = read(tmp_path / "si", "body").point_data
    assert "displacement_in_beta" in data
    assert "displacement_in_beta_m" not in data


def test_the_energy_is_that_of_the_body_s_own_modulus(hemisphere):
    """A counter-body that takes a quarter of the compliance leaves three quarters of the energy to the body."""
    cut = cut_for(hemisphere.space, hemisphere.components, TOLERANCE)
    shared = replace(hemisphere, scene=replace(hemisphere.scene, counter=HalfSpace(), share=0.25))
    alone, both = (inside(state, cut, 1.0)["strain_energy_density"] for state in (hemisphere, shared))
    np.testing.assert_allclose(both, 0.75 * alone)


# --- the solid ---


def test_the_solid_is_the_section_revolved(folder, states):
    number, _state = numbered(states, "zero_load")
    solid, section = (read(folder, kind, number) for kind in ("solid", "body"))
    assert set(solid.celltypes) == {29, 32}
    L = section.points[:, 0].max()
    chord = np.sinc(7.5 / 180)  # VTK measures the cells by plane pieces between nodes 7.5 degrees apart
    volumes = solid.triangulate().compute_cell_sizes(length=False, area=False)["Volume"]  # they have no sign
    assert np.abs(volumes).sum() == pytest.approx(np.pi * L**3 / 4 * chord, rel=1e-5)
    for k in range(solid.n_cells):
        assert _jacobian(solid.GetCell(k), np.array([0.3, 0.3, 0.5]), step=1e-3) > 0


SQUARE = np.array([[0.0, 1, 1, 0, 0.5, 1, 0.5, 0, 0.5], [0.0, 0, 1, 1, 0, 0.5, 1, 0.5, 0.5]])
BESIDE = SQUARE + np.array([[1.0], [0.0]])
TRIANGLE = np.array([[0.0, 1, 0, 0.5, 0.5, 0], [0.0, 0, 1, 0, 0.5, 0.5]]) + np.array([[1.0], [0.0]])


@pytest.mark.parametrize("section", [SQUARE, BESIDE, TRIANGLE], ids=["on the axis", "off it", "triangle"])
@pytest.mark.parametrize("mirrored", [False, True])
def test_no_cell_of_a_solid_is_inside_out(section, mirrored):
    """The Jacobian of VTK's own shape functions is positive inside every cell, which a volume's size cannot tell."""
    cells = np.arange(section.shape[1])[None]
    if mirrored:
        order = {9: [1, 0, 3, 2, 4, 7, 6, 5, 8], 6: [1, 0, 2, 3, 5, 4]}[section.shape[1]]
        cells = cells[:, order]
    solid = revolved(section, cells, 30.0)
    grid = pyvista.UnstructuredGrid({kind: nodes for kind, nodes in solid.cells.items() if len(nodes)}, solid.points)
    assert grid.n_cells == 2
    for k in range(grid.n_cells):
        cell = grid.GetCell(k)
        assert min(_jacobian(cell, np.array(place)) for place in _inside(cell)) > 0


def _inside(cell):
    wedge = cell.GetCellType() == 32
    plane = [(0.2, 0.2), (0.6, 0.2), (0.2, 0.6)] if wedge else [(0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.7, 0.7)]
    return [(*place, t) for place in plane for t in (0.1, 0.5, 0.9)]


def _jacobian(cell, place, step=1e-5):
    def at(where):
        x, sub, weights = [0.0] * 3, vtk.reference(0), [0.0] * cell.GetNumberOfPoints()
        cell.EvaluateLocation(sub, list(where), x, weights)
        return np.array(x)

    columns = [(at(place + step * axis) - at(place - step * axis)) / (2 * step) for axis in np.eye(3)]
    return np.linalg.det(np.stack(columns, axis=1))


def test_a_closed_solid_has_no_seam():
    whole, half = (revolved(SQUARE, np.arange(9)[None], angle) for angle in (360.0, 180.0))
    around = 2 * 24
    assert whole.points.shape[0] == 6 * around + 3
    assert half.points.shape[0] == 6 * (around // 2 + 1) + 3


# --- what cannot be written ---


def test_what_cannot_be_written_leaves_nothing(states, units, tmp_path, monkeypatch):
    folder = tmp_path / "curve"
    with pytest.raises(ValueError, match=r"no states to write, limit: 1 or more; "):
        write_path([], folder)
    with pytest.raises(ValueError, match=r"revolve = 400 is outside 0 < revolve <= 360; "):
        write_path(states, folder, revolve=400.0)
    other = Units(units.radius, 2 * units.modulus, units.work_of_adhesion, units.spacing)
    with pytest.raises(ValueError, match=r"the material's tabor = .* is not the scene's 1; "):
        write_path(states, folder, units=other)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ValueError, match=r"pyvista is not installed.*; pip install '\.\[view\]' in a clone"):
        write_path(states, folder)
    assert not list(tmp_path.iterdir())
