"""Files for ParaView: the fields inside the body, its contact surface, and the curve's states as a time series.

Names have no spaces and, in SI, end in their unit. The numbers of the scene and of the state are in the field data of
each file; words, which not every reader knows, are in ``notes.json``. Section and surface lie in the plane y = 0 with
the axis z, so that the solid of revolution passes through them.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from fem_adhesion.common.files import writing
from fem_adhesion.fields import State, half_space_beside
from fem_adhesion.paraview.arrays import (
    COMPONENTS,
    COMPONENTS_OF_SOLID,
    Named,
    in_si,
    inside,
    magnification_for,
    numbers,
    on_surface,
    require_same_scene,
    turned,
    words,
)
from fem_adhesion.paraview.cells import cut_for, require_angle, revolved
from halfspace.errors import InputError
from halfspace.scaling import Units
from halfspace.values import Array, Index

Labels = Mapping[str, Sequence[str]]

TOLERANCE = 1e-4  # largest error of the displacement as drawn, of its maximum, in the section
SOLID_TOLERANCE = 1e-2  # the same in the solid of revolution, which has fifty times as many points
QUADRATIC = {6: 22, 9: 28}
"""VTK's types of cells of the section by their nodes: quadratic triangle, biquadratic quadrilateral."""


def write_states(
    states: Iterable[State], aside: Path, directory: Path, *, units: Units | None = None, revolve: float | None = None
) -> list[str]:
    """Write states of a curve for ParaView into a directory made by `directory_written_aside`, and return the names.

    ``body.pvd`` and ``contact.pvd``, and ``solid.pvd`` if revolved, are the time series: their time is the arclength.
    ``body_0000.vtu`` has the meridian section in second-order cells, ``contact_0000.vtp`` the contact surface with the
    values of both solvers, ``solid_0000.vtu`` the solid. ``notes.json`` says in words what the arrays are.

    The states are of one scene, in order, from `fem_adhesion.fields.states_along`. With the units of a material points
    and arrays are in SI, and the names of arrays end in their unit. There is a solid only if `revolve` gives its angle,
    360 degrees for all round. InputError if there are no states, units or angle do not fit, or pyvista is missing;
    NotWritten if the disk is full.
    """
    if revolve is not None:
        require_angle(revolve)
    require_pyvista()
    held = list(states)
    require_same_scene(held, units)
    scale = magnification_for(held)
    with writing(directory):
        files = list[dict[str, str]]()  # names by kind, of each state
        for number, state in enumerate(held):
            files.append({})
            for kind, suffix, grid in _grids(state, scale, units, revolve):
                _annotate(grid, numbers(state, scale, units))
                files[-1][kind] = f"{kind}_{number:04d}.{suffix}"
                _save(grid, aside / files[-1][kind])
        series = [_write_series(aside, kind, files, held) for kind in files[0]]
        return [*series, _write_notes(aside, files, held), *(name for each in files for name in each.values())]


def require_pyvista() -> Any:
    """Return pyvista, or raise InputError where it is not installed."""
    try:
        import pyvista
    except ImportError as error:
        raise InputError(
            "pyvista is not installed, which writes VTK files; pip install '.[view]' in a clone"
        ) from error
    return pyvista


def _save(grid: Any, file: Path) -> None:
    """Write a grid by way of memory: where the disk is full VTK's own writing ends the process."""
    from vtkmodules import vtkIOXML

    kind = vtkIOXML.vtkXMLPolyDataWriter if file.suffix == ".vtp" else vtkIOXML.vtkXMLUnstructuredGridWriter
    writer = kind()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    file.write_text(writer.GetOutputString(), encoding="utf-8")


def _grids(state: State, scale: float, units: Units | None, revolve: float | None) -> Iterator[tuple[str, str, Any]]:
    """Kind, suffix and grid of each file of a state."""
    cut = cut_for(state.space, state.components, TOLERANCE)
    section = {QUADRATIC[cut.cells.shape[1]]: cut.cells}
    yield "body", "vtu", _grid(section, in_plane(*cut.points), inside(state, cut, scale), units, COMPONENTS)
    yield "contact", "vtp", _surface(state, scale, units)
    if revolve is not None:
        coarse = cut_for(state.space, state.components, SOLID_TOLERANCE)
        solid = revolved(coarse.points, coarse.cells, revolve)
        arrays = turned(inside(state, coarse, scale), solid)
        yield "solid", "vtu", _grid(solid.cells, solid.points, arrays, units, COMPONENTS_OF_SOLID)


def _grid(cells: dict[int, Index], points: Array, arrays: Named, units: Units | None, labels: Labels) -> Any:
    kept = {kind: nodes for kind, nodes in cells.items() if len(nodes)}
    return _with_arrays(require_pyvista().UnstructuredGrid(kept, _placed(points, units)), arrays, units, labels)


def _surface(state: State, scale: float, units: Units | None) -> Any:
    """Contact surface as one line through its nodes."""
    radii, heights = _placed(state.surface.radii, units), _placed(-state.surface.depths, units)
    grid, beside = line_through(radii, heights), half_space_beside(state)
    alpha, load = map(float, beside.observables[:2])
    own = {"approach_of_half_space": alpha, "load_of_half_space": load}
    _annotate(grid, own | in_si(own, units))
    return _with_arrays(grid, on_surface(state, beside, scale), units)


def line_through(r: Array, z: Array) -> Any:
    """One line through points `in_plane`."""
    return require_pyvista().PolyData(in_plane(r, z), lines=np.append(r.size, np.arange(r.size)))


def in_plane(r: Array, z: Array) -> Array:
    """Points (n, 3) in the plane y = 0, radii along x."""
    return np.stack([r, 0 * r, z], axis=1)


def _placed(points: Array, units: Units | None) -> Array:
    """Points in beta, or in m where the material is known."""
    return points * (units.length if units else 1.0)


def _annotate(grid: Any, values: Mapping[str, float]) -> None:
    for name, value in values.items():
        grid.field_data[name] = np.atleast_1d(value)


def _with_arrays(grid: Any, arrays: Named, units: Units | None, labels: Labels = COMPONENTS) -> Any:
    for (name, values), plain in zip(in_si(arrays, units).items(), arrays, strict=True):
        grid.point_data[name] = values
        for number, component in enumerate(labels.get(plain, ())):
            grid.GetPointData().GetArray(name).SetComponentName(number, component)
    return grid


def _write_series(folder: Path, kind: str, files: Sequence[dict[str, str]], states: Sequence[State]) -> str:
    """Write the .pvd collection of a kind of file, whose paths are relative, and return its name."""
    root = ElementTree.Element("VTKFile", type="Collection", version="1.0", byte_order="LittleEndian")
    collection = ElementTree.SubElement(root, "Collection")
    for names, state in zip(files, states, strict=True):
        time = repr(float(state.point.arclength))
        ElementTree.SubElement(collection, "DataSet", timestep=time, group="", part="0", file=names[kind])
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(folder / f"{kind}.pvd", encoding="utf-8", xml_declaration=True)
    return f"{kind}.pvd"


def _write_notes(folder: Path, files: Sequence[dict[str, str]], states: Sequence[State]) -> str:
    """Write in words what the files hold, and which of them are events, and return the name."""
    held = [{"event": state.name or None, **names} for names, state in zip(files, states, strict=True)]
    notes = json.dumps({**words(states[0].scene), "states": held}, indent=1, allow_nan=False)
    (folder / "notes.json").write_text(notes + "\n", encoding="utf-8")
    return "notes.json"
