"""The deformed body drawn off-screen: cut open, coloured by its vertical stress, the wall translucent over it."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.fields.state import State
from fem_adhesion.paraview.cutaway import Section, View, section, surfaces
from fem_adhesion.paraview.write import require_pyvista
from halfspace.errors import InputError
from halfspace.values import Array

Pixels = NDArray[np.uint8]

COLOURS = "RdBu_r"
"""Blue in compression, red in tension: told apart by every kind of colour-blind eye, and white where there is none."""

OPEN = 270.0
"""Degrees of the solid that are left: a quarter is cut away."""

SIDES = 120
"""Plane pieces that the solid is round with."""

UPWARDS, AWAY = 16.0, 10.0
"""Where the camera is: degrees over the wall, and its distance in radii of what is shown."""

LIGHT = (0.0, 1.0, 1.0)
"""Where the light is, seen from the camera: above it."""

ROOM, OFF_CENTRE = (0.55, 0.78), (-0.14, 0.04)
"""Part of the picture's width and height that the solid may take, and where: centre, in halves of the picture."""

OSMESA = ("libOSMesa.so", "libOSMesa.so.8", "libOSMesa.so.6")
"""What VTK draws with where it finds neither a display nor EGL."""

BODY, WALL, UNDEFORMED, OUTLINE = "black", "#505050", "#009E73", "#606060"
"""Colours of the lines along the cut."""


def solid_image(state: State, view: View, size: tuple[int, int]) -> Pixels:
    """Picture (height, width, 3) of the solid and the wall, without words.

    Raises
    ------
    InputError
        As `require_drawing`.
    """
    pyvista = require_drawing()
    with _quiet():
        plotter = pyvista.Plotter(off_screen=True, window_size=list(size), lighting="none")
        plotter.add_light(pyvista.Light(position=LIGHT, light_type="camera light"))
        plotter.set_background("white")
        _add_body(pyvista, plotter, state, view)
        _add_surfaces(pyvista, plotter, state, view)
        _look(plotter, view, size)
        plotter.enable_anti_aliasing("ssaa")
        image: Pixels = plotter.screenshot(None, return_img=True)
        plotter.close()
    return image


def require_drawing() -> Any:
    """Return pyvista, or raise InputError where it or what it draws with off-screen is not installed.

    Without OpenGL's libraries VTK crashes when it draws, and says nothing before.
    """
    pyvista = require_pyvista()
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    import_module("vtkmodules.vtkRenderingOpenGL2")  # until then VTK's window is an abstract one
    with _quiet():
        last_resort = vtkRenderWindow().GetClassName() == "vtkOSOpenGLRenderWindow"
    if last_resort and not any(map(_is_installed, OSMESA)):
        raise InputError(
            "OpenGL is not installed, which draws off-screen pictures; apt-get install libegl1 libgl1-mesa-dri"
        )
    return pyvista


def _is_installed(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep VTK's warning that there is no display, for which it has a remedy itself, from the terminal."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _add_body(pyvista: Any, plotter: Any, state: State, view: View) -> None:
    """The cut in its true colours, and the skin lit, so that its shape is seen."""
    plane = _plane(pyvista, section(state, view), view)
    colours = {"scalars": "stress", "cmap": COLOURS, "clim": (-view.limit, view.limit), "show_scalar_bar": False}
    outline = plane.extract_feature_edges(feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    for angle in (0.0, OPEN):
        plotter.add_mesh(plane.rotate_z(angle), lighting=False, **colours)
        plotter.add_mesh(outline.rotate_z(angle), color=OUTLINE, line_width=2)
    light = {"ambient": 0.55, "diffuse": 0.5, "specular": 0.0, "smooth_shading": True, "split_sharp_edges": True}
    plotter.add_mesh(_turned(plane), **colours, **light)


def _plane(pyvista: Any, shown: Section, view: View) -> Any:
    """The section in the plane y = 0, as far as it is in view."""
    r, z = shown.points
    cells = np.insert(shown.cells, 0, shown.cells.shape[1], axis=1)
    plane = pyvista.PolyData(np.stack([r, 0 * r, z], axis=1), faces=cells.ravel())
    plane.point_data["stress"] = shown.stress
    return plane.clip("x", origin=(view.reach, 0, 0)).clip("-z", origin=(0, 0, -view.depth))


def _add_surfaces(pyvista: Any, plotter: Any, state: State, view: View) -> None:
    """The wall, translucent, and along the cut the lines of wall, body and undeformed body."""
    shown = surfaces(state, view.reach, view.heights)
    wall = _turned(_line(pyvista, shown.wall))
    plotter.add_mesh(wall, color="#a0a0a0", opacity=0.3, smooth_shading=True)
    for line, look in (
        (shown.undeformed, {"color": UNDEFORMED, "line_width": 4}),
        (shown.deformed, {"color": BODY, "line_width": 6}),
        (shown.wall, {"color": WALL, "line_width": 6}),
    ):
        for angle in (0.0, OPEN):
            plotter.add_mesh(_line(pyvista, line).rotate_z(angle), lighting=False, **look)


def _line(pyvista: Any, line: Array) -> Any:
    r, z = line
    return pyvista.PolyData(np.stack([r, 0 * r, z], axis=1), lines=np.append(r.size, np.arange(r.size)))


def _turned(plane: Any) -> Any:
    return plane.extrude_rotate(angle=OPEN, resolution=SIDES, capping=False, rotation_axis=(0, 0, 1))


def _look(plotter: Any, view: View, size: tuple[int, int]) -> None:
    """Look into the quarter that is cut away, a little from above, and leave room for words, bar and curve."""
    away, up = np.radians(OPEN / 2 + 180), np.radians(UPWARDS)
    direction = np.array([np.cos(away) * np.cos(up), np.sin(away) * np.cos(up), np.sin(up)])
    middle = np.array([0.0, 0.0, (view.top - view.depth) / 2])
    high = ((view.top + view.depth) * np.cos(up) + 2 * view.reach * np.sin(up)) / ROOM[1]
    wide = 2 * view.reach / ROOM[0] * size[1] / size[0]
    camera, distance = plotter.camera, AWAY * view.reach
    plotter.camera_position = [middle + distance * direction, middle, (0, 0, 1)]
    camera.view_angle = np.degrees(2 * np.arctan(max(high, wide) / 2 / distance))
    camera.SetWindowCenter(*OFF_CENTRE)
