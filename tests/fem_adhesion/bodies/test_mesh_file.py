"""A body from a file: the examples in meshes/, every format and cell that is read, and every refusal."""

import re
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from facets import boundary_basis
from skfem import CellBasis, ElementTriP1, MeshQuad, MeshQuad2, MeshTri, MeshTri2

from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.checks import facet_nodes
from fem_adhesion.mesh.file import read_body, read_scaled

MESHES = Path(__file__).parents[3] / "meshes"
EXAMPLES = ["hemisphere", "sphere", "tip"]

# --- the examples, against solid geometry ---

HALF_ANGLE = np.pi / 9
CAP, CONE = 1 - np.sin(HALF_ANGLE), 3 + np.sin(HALF_ANGLE)  # heights of the two parts of the tip
WIDTHS = np.cos(HALF_ANGLE) + np.array([0.0, CONE * np.tan(HALF_ANGLE)])
TIP_VOLUME = np.pi / 3 * (CAP**2 * (3 - CAP) + CONE * (WIDTHS @ WIDTHS + WIDTHS.prod()))
TIP_LENGTH = np.pi / 2 - HALF_ANGLE + CONE / np.cos(HALF_ANGLE)
SOLIDS = {  # volume, lengths of axis, contact and grip
    "hemisphere": (2 * np.pi / 3, 1.0, np.pi / 2, 1.0),
    "sphere": (4 * np.pi / 3, 2.0, np.pi / 2, np.pi / 6),
    "tip": (TIP_VOLUME, 4.0, TIP_LENGTH, WIDTHS[1]),
}


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request):
    return request.param, read_body(MESHES / f"{request.param}.msh")


def volume(mesh, element=None):
    basis = CellBasis(mesh, element or mesh.elem(), intorder=8)
    return np.sum(2 * np.pi * basis.global_coordinates()[0] * basis.dx)


def length(mesh, name):
    return np.sum(boundary_basis(Space(mesh, mesh.elem()), name, 8).dx)


def test_the_examples_have_the_volume_of_their_solids(example):
    """Curved sides bring the error from that of a polygon, some 1e-3, to the fourth order of the size."""
    name, mesh = example
    polygon = MeshTri(mesh.p[:, : mesh.nvertices], mesh.t)
    error = abs(volume(mesh) / SOLIDS[name][0] - 1)
    assert error < 3e-6
    assert error < 1e-2 * abs(volume(polygon, ElementTriP1()) / SOLIDS[name][0] - 1)


def test_the_examples_have_the_boundaries_of_their_solids(example):
    name, mesh = example
    lengths = [length(mesh, boundary) for boundary in ("axis", "contact", "far")]
    np.testing.assert_allclose(lengths, SOLIDS[name][1:], rtol=5e-7)


# --- a small body to write in all formats and to spoil ---

PARABOLOID_VOLUME = np.pi * (0.64 * 0.8 - 0.64**2 / 4)  # z from -0.8 to -r^2/2, r < 0.8


def paraboloid(kind="triangle6", columns=16, rows=4):
    """Points, cells and lines by group of the body under z = -r^2/2, r < 0.8, held at z = -0.8."""
    s, t = np.meshgrid(np.linspace(0, 1, 2 * columns + 1), np.linspace(0, 1, 2 * rows + 1), indexing="ij")
    top = -0.32 * s**2
    points = np.stack([0.8 * s, top + (-0.8 - top) * t, 0 * s], axis=-1).reshape(-1, 3).copy()
    n = np.arange(len(points)).reshape(s.shape)
    quads = np.array([n[i : i + 3, j : j + 3] for i in range(0, 2 * columns, 2) for j in range(0, 2 * rows, 2)])
    return points, {kind: SHAPES[kind](quads)}, groups_of(n, "line3" if SHAPES[kind](quads).shape[1] > 4 else "line")


def triangles6(quads):
    first, second = [(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)], [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)]
    return np.concatenate([np.stack([quads[:, i, j] for i, j in nodes], axis=1) for nodes in (first, second)])


def quads9(quads):
    order = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    return np.stack([quads[:, i, j] for i, j in order], axis=1)


SHAPES = {
    "triangle": lambda quads: triangles6(quads)[:, :3],
    "triangle6": triangles6,
    "quad": lambda quads: quads9(quads)[:, :4],
    "quad8": lambda quads: quads9(quads)[:, :8],
    "quad9": quads9,
}
CLASSES = {"triangle": MeshTri, "triangle6": MeshTri2, "quad": MeshQuad, "quad8": MeshQuad2, "quad9": MeshQuad2}


def groups_of(n, line):
    """Lines along the sides of a grid of numbers: (kind, cells) by group."""
    sides = {"axis": n[0], "contact": n[:, 0], "grip": n[:, -1], "side": n[-1]}
    nodes = {name: np.stack([side[:-2:2], side[2::2], side[1::2]], axis=1) for name, side in sides.items()}
    return {name: cells if line == "line3" else cells[:, :2] for name, cells in nodes.items()}


def to_meshio(points, cells, groups):
    """With the groups as cell sets and as Gmsh's physical groups."""
    lines = [("line3" if lines.shape[1] == 3 else "line", lines) for lines in groups.values()]
    blocks = [*lines, *cells.items()]
    tags = [np.full(len(data), k + 1) for k, (_, data) in enumerate(blocks)]
    names = {name: np.array([k + 1, 1]) for k, name in enumerate(groups)} | {"body": np.array([len(blocks), 2])}
    sets = {
        name: [
            np.arange(len(data)) if tag[0] == number else np.empty(0, int)
            for tag, (_, data) in zip(tags, blocks, strict=True)
        ]
        for name, (number, _) in names.items()
    }
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    return meshio.Mesh(points, blocks, cell_data=data, field_data=names, cell_sets=sets)


def written(mesh, path, **options):
    mesh.write(path, **options)
    return path


def with_physical_groups(mesh):
    mesh.cell_sets = {}
    return mesh


def with_integer_data(mesh):
    """What ``meshio convert --sets-to-int-data`` does."""
    mesh.cell_data, mesh.field_data = {}, {}
    mesh.cell_sets_to_data("-".join(mesh.cell_sets))
    return mesh


def with_cell_sets(mesh):
    mesh.cell_data, mesh.field_data = {}, {}
    return mesh


FORMATS = [
    ("msh", with_physical_groups, {"file_format": "gmsh22"}),
    ("msh", with_physical_groups, {"file_format": "gmsh22", "binary": False}),
    ("vtu", with_integer_data, {}),
    ("inp", with_cell_sets, {}),
]


@pytest.mark.parametrize(("suffix", "prepare", "options"), FORMATS, ids=lambda x: getattr(x, "__name__", str(x)))
def test_every_format_gives_the_same_body(tmp_path, suffix, prepare, options):
    path = written(prepare(to_meshio(*paraboloid())), tmp_path / f"body.{suffix}", **options)
    mesh = read_body(path)
    assert volume(mesh) == pytest.approx(PARABOLOID_VOLUME, rel=1e-12)
    assert {name: len(facets) for name, facets in mesh.boundaries.items()} == {"axis": 4, "contact": 16, "far": 16}
    assert np.all(mesh.p[1, facet_nodes(mesh, mesh.boundaries["far"])] == -0.8)


@pytest.mark.parametrize("kind", SHAPES)
def test_every_kind_of_cell_is_read(tmp_path, kind):
    """The paraboloid is exact in cells with curved sides; unused nodes, here centres and middles, are dropped."""
    points, cells, groups = paraboloid(kind)
    mesh = read_body(written(to_meshio(points, cells, groups), tmp_path / "body.vtu"))
    curved = "6" in kind or "8" in kind or "9" in kind
    assert type(mesh) is CLASSES[kind]
    assert volume(mesh) == pytest.approx(PARABOLOID_VOLUME, rel=1e-12 if curved else 3e-3)
    assert length(mesh, "axis") == pytest.approx(0.8, rel=1e-14)
    assert mesh.p.shape[1] == len(np.unique(cells[kind])) + (mesh.nelements if kind == "quad8" else 0)


def test_the_ninth_node_is_where_the_file_has_it(tmp_path):
    """Off the place that the other eight give it, it moves what is inside a cell."""
    points, cells, groups = paraboloid("quad9")
    points[cells["quad9"][:, 8]] += [0.003, 0.002, 0.0]
    mesh = read_body(written(to_meshio(points, cells, groups), tmp_path / "body.vtu"))
    centres = mesh.mapping().F(np.array([[0.5], [0.5]]))[:, :, 0].T
    expected = points[cells["quad9"][:, 8], :2]
    assert centres[np.lexsort(centres.T)] == pytest.approx(expected[np.lexsort(expected.T)], abs=1e-12)


def test_a_mesh_that_scikit_fem_saved_is_read(tmp_path):
    mesh = read_body(MESHES / "hemisphere.msh")
    names = mesh.boundaries
    mesh = mesh.with_boundaries({"axis": names["axis"], "contact": names["contact"], "grip": names["far"]})
    mesh.save(tmp_path / "body.vtu")
    again = read_body(tmp_path / "body.vtu")
    assert volume(again) == pytest.approx(volume(mesh), rel=1e-14)
    assert all(set(again.boundaries[name]) == set(facets) for name, facets in names.items())


# --- the unit of length ---


def test_a_mesh_is_scaled_to_the_radius_of_its_pole(tmp_path, example):
    name, known = example
    raw = meshio.read(MESHES / f"{name}.msh")
    raw.points *= 1.04
    raw.points[:, 1] += 3.0
    raw.write(tmp_path / "body.msh", file_format="gmsh22")
    mesh, radius = read_scaled(tmp_path / "body.msh")
    assert radius == pytest.approx(1.04, rel=1e-8, abs=0)
    np.testing.assert_allclose(mesh.p, known.p, rtol=0, atol=5e-8)


def test_the_radius_of_a_coarse_sphere_is_found_to_five_digits(tmp_path):
    """Four nodes beside the pole, the last at 0.28 R: the worst that is read."""
    points, cells, groups = paraboloid("triangle", columns=11)
    points[:, 1] += points[:, 0] ** 2 / 2 - (1 - np.sqrt(1 - points[:, 0] ** 2))
    _, radius = read_scaled(written(to_meshio(points, cells, groups), tmp_path / "body.vtu"))
    assert radius == pytest.approx(1.0, abs=3e-5)


def test_clockwise_cells_are_cells(tmp_path):
    points, cells, groups = paraboloid("triangle")
    cells["triangle"][::2, :2] = cells["triangle"][::2, 1::-1]
    mesh = read_body(written(to_meshio(points, cells, groups), tmp_path / "body.vtu"))
    assert volume(mesh) == pytest.approx(PARABOLOID_VOLUME, rel=3e-3)


# --- refusals ---


def refusal(path):
    with pytest.raises(ValueError, match=f"^mesh {re.escape(str(path))}: ") as caught:
        read_body(path)
    message = str(caught.value).removeprefix(f"mesh {path}: ")
    assert "\n" not in message
    assert ";" in message  # the remedy
    return message


def added(points, more):
    """Append nodes in place; their numbers."""
    numbers = len(points) + np.arange(len(more))
    points.resize((len(points) + len(more), 3), refcheck=False)
    points[numbers] = more
    return numbers


MIDDLE = "triangle6[70]"  # a cell inside the body
TURNED = r"cells are flat or turned inside out, one at \(r, z\) = \("
SPOILT = [  # what is done to a sound mesh, and what is said of it
    ("points[:, 0] -= 0.5", r"r = -0\.5 is outside r >= 0"),
    (
        "grip = added(points, points[grip.ravel()]).reshape(grip.shape)",
        r'16 lines of group "grip" are no sides of cells, limit 0; merge',
    ),
    (
        f"{MIDDLE}[:] = added(points, points[{MIDDLE}])",
        r"6 nodes coincide with another, one at \(r, z\) = \(.*\), limit 0",
    ),
    (f"a, b, c, m = {MIDDLE}[:4]; points[m] = 0.1 * (points[a] + points[b]) + 0.8 * points[c]", TURNED),
    ("triangle6 = np.tile(triangle6, (2, 1))", r"more than two cells.*; remove double cells"),
    ("triangle6 = np.append(triangle6, added(points, ELSEWHERE)[None], 0)", r"falls into 2 pieces, limit 1"),
    (f"grip = np.append(grip, {MIDDLE}[None, [0, 1, 3]], 0)", r"^1 lines of the groups run inside"),
    ("grip = np.append(grip, contact[-2:], 0)", r'^2 lines are both in "contact" and in "g'),
    ("axis = np.append(axis, side, 0)", r'group "axis" reaches r = 0\.8, limit r = 0'),
    ("axis = axis[1:]", r'^1 boundary lines at r = 0 are not in group "axis", one at \(r, z\) = \(0, -0\.1\)'),
    ("contact = np.delete(contact, 7, axis=0)", r'group "contact" has 4 ends, limit 2'),
    ("contact = contact[2:]", r'group "contact" starts at r = 0\.1, limit r = 0'),
    (
        "contact = np.append(contact, side, 0)",
        r"^4 lines of the contact turn back or run upright, one at \(r, z\) = \(0\.8, ",
    ),
    # Narrower in the depth, so that the contact line overhangs between the last three of its nodes.
    (
        "points[:, 0] *= 1 + 1.655 * (points[:, 1] + 0.32)",
        r"^1 lines of the contact turn back .*; z must be a function of r",
    ),
    ("points[:, 1] *= -1.0", r"^16 lines of the contact lie below the body.*turn the body over"),
    ("points *= 1.06", r"radius of curvature at the pole = 1\.06 must be 1 within 5%.*all lengths by 0\.9434 "),
    ("points[:, 1] += points[:, 0] ** 2", r"nodes stand above the pole"),  # as round, on the other side
    (
        "points[:, 1] += 0.5 * points[:, 0] ** 2 - points[:, 0]",
        r"the contact line has 0 nodes beside the pole before its slope exceeds 0\.3, limit 4",
    ),
    (
        "points[:, 1] += 0.5 * points[:, 0] ** 2 - 0.1 * points[:, 0]",
        r"not round at the pole, misfit 0\.\d+, limit 0\.02",
    ),
    (f"points[{MIDDLE}[1], 1] = np.nan", r"^1 coordinates are not finite"),
    ("points[:, 2] = 0.1 * points[:, 0]", r"third coordinate = 0\.08 must be 0"),
    ("bottom = grip; del grip", r'group "grip" is missing, the file has "axis", "contact", "side", "bottom"; name'),
    ("del axis, contact, grip, side", r'group "axis", "contact", "grip" is missing, the file has none'),
    ("quad8 = SHAPES['quad8'](np.arange(9).reshape(1, 3, 3))", r'cells are of 2 types, "quad8", "triangle6", limit 1'),
    ("tetra = np.array([[0, 1, 2, 3]])", r'cells of type "tetra", "triangle6" are none of'),
    (
        "del triangle6; VTK_LAGRANGE_TRIANGLE = np.arange(10)[None]",
        r'cells of type "VTK_LAGRANGE_TRIANGLE" are none of .*; mesh the meridian section, in order 1 or 2',
    ),
    ("del triangle6", "Physical Surface"),
]
ELSEWHERE = np.array([[2, -1, 0], [3, -1, 0], [2, -0.5, 0], [2.5, -1, 0], [2.5, -0.75, 0], [2, -0.75, 0]])


@pytest.mark.parametrize(("edit", "complaint"), SPOILT)
def test_a_bad_mesh_is_refused_with_value_limit_and_remedy(tmp_path, edit, complaint):
    points, cells, groups = paraboloid()
    known = {"points": points, **cells, **groups}
    exec(edit, globals(), known)
    cells = {name: known[name] for name in ("triangle6", "quad8", "tetra", "VTK_LAGRANGE_TRIANGLE") if name in known}
    groups = {name: known[name] for name in ("axis", "contact", "side", "grip", "bottom") if name in known}
    assert re.search(complaint, refusal(written(to_meshio(points, cells, groups), tmp_path / "bad.vtu")))


def test_cells_that_overlap_are_refused(tmp_path):
    """A node pulled through the cells around it."""
    points, cells, groups = paraboloid("triangle")
    inside = np.unique(cells["triangle"])
    points[inside[np.argmin(np.linalg.norm(points[inside] - [0.4, -0.45, 0.0], axis=1))]] += [0.0, 0.3, 0.0]
    message = refusal(written(to_meshio(points, cells, groups), tmp_path / "bad.vtu"))
    assert "lines have both their cells on one side" in message


def test_a_file_that_is_not_there_is_refused(tmp_path):
    assert "there is no such file" in refusal(tmp_path / "none.msh")
    assert "there is no such file" in refusal(tmp_path)


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".inp", ".body"])
def test_a_file_of_no_format_is_refused_in_silence(tmp_path, capfd, suffix):
    path = tmp_path / f"bad{suffix}"
    path.write_text("A mesh\nof words, and of\n1 2 3\n")
    refusal(path)
    assert capfd.readouterr() == ("", "")


def test_a_file_cut_short_anywhere_is_refused(tmp_path):
    whole = (MESHES / "hemisphere.msh").read_bytes()
    path = tmp_path / "cut.msh"
    for end in np.linspace(0, len(whole) - 20, 8).astype(int):
        path.write_bytes(whole[:end])
        refusal(path)


# --- a body from a file, solved ---


def test_scikit_fem_gives_no_advice_to_the_user(tmp_path):
    """On elements that suit straight quadrilaterals, say; in another process, as pytest catches what is logged."""
    mesh = with_physical_groups(to_meshio(*paraboloid("quad", columns=64, rows=16)))
    file = str(written(mesh, tmp_path / "quads.msh", file_format="gmsh22"))
    code = f"import fem_adhesion as f; f.trace(f.Scene(0.3, f.Meshed({file!r}, radius_ratio=5.0)), rtol=1e-2)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == ""
