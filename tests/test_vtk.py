"""Files for ParaView, read back with VTK's own readers and held against the solver."""

import sys
from xml.etree import ElementTree

import numpy as np
import pytest

import fem_adhesion
from fem_adhesion import Scene
from fem_adhesion.fields import states_along
from fem_adhesion.output.lattice import Lattice, cut_for
from fem_adhesion.output.revolve import revolved
from fem_adhesion.output.vtk import TOLERANCE, write_path
from fem_adhesion.sized import Discretisation
from fem_adhesion.stress import sampled
from halfspace.scaling import Units

vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

DEGREE = Discretisation(degree=5)
QUAD9 = 28


@pytest.fixture(scope="module")
def states():
    scene = Scene(1.0)
    return list(states_along(scene, fem_adhesion.trace(scene, rtol=1e-4), points=0, how=DEGREE))


@pytest.fixture(scope="module")
def units():
    """A material of Tabor parameter 1."""
    radius, spacing, work = 1e-7, 3e-10, 0.1
    return Units(radius, np.sqrt(radius * work**2 / spacing**3), work, spacing)


@pytest.fixture(scope="module")
def folder(states, units, tmp_path_factory):
    directory = tmp_path_factory.mktemp("vtk") / "curve"
    write_path(states, directory, units=units, revolve=90.0)
    return directory


def read(file):
    kinds = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtp": vtk.vtkXMLPolyDataReader}
    reader = kinds[file.suffix]()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def array(grid, name):
    return vtk_to_numpy(grid.GetPointData().GetArray(name))


def points(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())


def note(grid, name):
    found = grid.GetFieldData().GetAbstractArray(name)
    return found.GetValue(0)


def numbered(states, name):
    return next((k, state) for k, state in enumerate(states) if state.name == name)


def test_the_collections_name_their_files_relatively_and_by_arclength(folder, states):
    for kind, suffix in (("body", "vtu"), ("contact", "vtp"), ("solid", "vtu")):
        entries = list(ElementTree.parse(folder / f"{kind}.pvd").getroot().iter("DataSet"))
        assert [entry.get("file") for entry in entries] == [f"{kind}_{k:04d}.{suffix}" for k in range(len(states))]
        assert [float(entry.get("timestep")) for entry in entries] == [state.arclength for state in states]
        assert all((folder / entry.get("file")).is_file() for entry in entries)


def test_the_section_is_in_biquadratic_cells_and_no_name_has_a_space(folder):
    grid = read(folder / "body_0000.vtu")
    assert {grid.GetCellType(k) for k in range(grid.GetNumberOfCells())} == {QUAD9}
    data = (grid.GetPointData(), grid.GetFieldData())
    assert all(" " not in one.GetArrayName(k) for one in data for k in range(one.GetNumberOfArrays()))


def test_displacement_and_stress_are_the_solvers(folder, states):
    number, state = numbered(states, "pull_off")
    grid = read(folder / f"body_{number:04d}.vtu")
    cut = cut_for(state.space, state.components, TOLERANCE)
    u = array(grid, "displacement")
    np.testing.assert_allclose(u[:, [0, 2]].T, cut.values(state.components), rtol=0, atol=1e-12)
    assert np.all(u[:, 1] == 0)
    rr, tt, zz, _, _, rz = array(grid, "stress_cylindrical").T
    np.testing.assert_allclose([rr, zz, tt, rz], cut.values(state.stress), rtol=0, atol=1e-12)
    mises = np.sqrt(((rr - zz) ** 2 + (zz - tt) ** 2 + (tt - rr) ** 2) / 2 + 3 * rz**2)
    np.testing.assert_allclose(array(grid, "von_mises"), mises, atol=1e-12)
    np.testing.assert_allclose(array(grid, "hydrostatic"), (rr + zz + tt) / 3, atol=1e-12)
    principal = array(grid, "principal_stresses")
    np.testing.assert_allclose(principal.sum(axis=1), rr + zz + tt, atol=1e-12)
    assert np.all(np.diff(principal, axis=1) <= 1e-14)
    scale = note(grid, "magnified_beta_per_displacement_unit")
    np.testing.assert_allclose(array(grid, "displacement_magnified"), scale * u, atol=1e-12)


def test_nothing_visible_is_lost_between_the_nodes(states):
    """At random places in every cell the biquadratic interpolation is within the tolerance of the element's field."""
    state = states[-1]
    cut = cut_for(state.space, state.components, TOLERANCE)
    assert cut.error <= TOLERANCE
    assert cut_for(state.space, state.components, 1e-2).lattice.cuts < cut.lattice.cuts
    places = np.random.default_rng(0).uniform(0, 1, (2, 6))
    wanted = sampled(state.space, state.components, places)
    lattice, m = Lattice(cut.lattice.cuts, triangular=False), cut.lattice.cuts
    nodes = sampled(state.space, state.components, lattice.places).reshape(2, -1, 2 * m + 1, 2 * m + 1)
    shown = np.stack([_biquadratic(nodes, m, x, y) for x, y in places.T], axis=-1)
    assert np.abs(shown - wanted).max() <= 2 * TOLERANCE * np.abs(wanted).max()


def _biquadratic(nodes, m, x, y):
    (i, s), (j, t) = ((int(min(z * m, m - 1)), z * m - int(min(z * m, m - 1))) for z in (x, y))
    quadratic = lambda s: np.array([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)])  # noqa: E731
    return np.einsum("kcab,a,b->kc", nodes[:, :, 2 * i : 2 * i + 3, 2 * j : 2 * j + 3], quadratic(s), quadratic(t))


def test_the_contact_line_carries_both_solvers(folder, states):
    number, state = numbered(states, "jump_off")
    line = read(folder / f"contact_{number:04d}.vtp")
    assert line.GetNumberOfLines() == 1
    np.testing.assert_allclose(points(line)[:, 0], state.radii, rtol=1e-7)
    pressure, beside = array(line, "pressure"), array(line, "pressure_of_half_space")
    np.testing.assert_allclose(pressure, state.pressure, rtol=1e-12)
    largest = np.abs(pressure).max()
    assert 0 < np.abs(pressure - beside).max() < 2e-3 * largest
    assert np.abs(array(line, "pressure_from_stress") - pressure).max() < 5e-3 * largest
    np.testing.assert_allclose(array(line, "gap"), array(line, "H") + 1, atol=1e-12)
    assert np.abs(array(line, "H") - array(line, "H_of_half_space"))[state.radii < 5].max() < 2e-3


def test_units_signs_and_scene_are_in_the_field_data(folder, states, units):
    grid = read(folder / "body_0001.vtu")
    assert note(grid, "tabor") == 1.0
    assert note(grid, "scene_body") == "block"
    assert note(grid, "load") == states[1].observables[1]
    assert "tension" in note(grid, "signs")
    assert note(grid, "unit_of_displacement") == "beta^2/R = mu eps"
    assert note(grid, "SI_stress_unit_in_Pa") == pytest.approx(units.pressure)
    assert note(grid, "SI_load_unit_in_N") == pytest.approx(units.load)


def test_the_solid_is_the_section_revolved(folder, states):
    number, _state = numbered(states, "zero_load")
    solid, section = (read(folder / f"{kind}_{number:04d}.vtu") for kind in ("solid", "body"))
    assert {solid.GetCellType(k) for k in range(solid.GetNumberOfCells())} == {29, 32}
    L = points(section)[:, 0].max()
    chord = np.sinc(7.5 / 180)  # VTK measures the cells by plane pieces between nodes 7.5 degrees apart
    assert volume(solid) == pytest.approx(np.pi * L**3 / 4 * chord, rel=1e-5)
    x, y, _ = points(solid).T
    u = array(solid, "displacement")
    off = np.hypot(x, y) > 1e-6
    assert np.abs((u[:, 0] * y - u[:, 1] * x)[off] / np.hypot(x, y)[off]).max() < 1e-6 * np.abs(u).max()
    stress, turned = array(solid, "stress_cylindrical"), array(solid, "stress")
    np.testing.assert_allclose(stress[:, :3].sum(axis=1), turned[:, :3].sum(axis=1), atol=1e-12)
    assert np.allclose(stress[:, 2], turned[:, 2])


def volume(grid):
    """Volume of the cells."""
    size = vtk.vtkCellSizeFilter()
    triangulated = vtk.vtkDataSetTriangleFilter()
    triangulated.SetInputData(grid)
    size.SetInputConnection(triangulated.GetOutputPort())
    size.Update()
    return np.abs(vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume"))).sum()


def test_a_closed_solid_has_no_seam():
    square = np.array([[0.0, 1, 1, 0, 0.5, 1, 0.5, 0, 0.5], [0.0, 0, 1, 1, 0, 0.5, 1, 0.5, 0.5]])
    whole, half = (revolved(square, np.arange(9)[None], angle) for angle in (360.0, 180.0))
    around = 2 * 24
    assert whole.points.shape[0] == 6 * around + 3
    assert half.points.shape[0] == 6 * (around // 2 + 1) + 3


def test_what_cannot_be_written_is_refused_and_leaves_nothing(states, units, tmp_path, monkeypatch):
    folder = tmp_path / "curve"
    with pytest.raises(ValueError, match=r"no states to write, limit: 1 or more; "):
        write_path([], folder)
    with pytest.raises(ValueError, match=r"revolve = 400 is outside 0 < revolve <= 360; "):
        write_path(states, folder, revolve=400.0)
    other = Units(units.radius, 2 * units.modulus, units.work_of_adhesion, units.spacing)
    with pytest.raises(ValueError, match=r"the material's tabor = .* is not the scene's 1; "):
        write_path(states, folder, units=other)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ValueError, match=r"pyvista is not installed.*; pip install 'fem-adhesion\[view\]'"):
        write_path(states, folder)
    assert not list(tmp_path.iterdir())
