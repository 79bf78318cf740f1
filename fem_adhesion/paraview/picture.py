"""The deformed body drawn off-screen: cut open near the contact, coloured by its vertical stress, the wall over it.

Lengths are in beta. A height of beta^2/R, the unit of gaps times mu and of displacement, is drawn as `View.heights`:
the undeformed surface, the vertical displacement and the gap are magnified alike, so that the deformed sphere is as
flat as its wall where they touch, and the rigid sphere as round as the dent it leaves. Radii are true.
"""

from __future__ import annotations

from collections.abc import Sequence
from ctypes.util import find_library
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.fields import State
from fem_adhesion.paraview.cells import cut_for
from fem_adhesion.paraview.write import in_plane, line_through, require_pyvista
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True)
class Look:
    """How the solid is drawn, and from where it is seen; lengths in the radius of what is shown, angles in degrees."""

    tolerance: float = 1e-2  # largest error of the stress as drawn, of its maximum
    wider: float = 1.7  # radius of what is shown, in that of the widest contact
    steepest: float = 0.5  # height of the undeformed sphere at the rim, as drawn
    to_scale: float = 2.0  # magnification of true heights below which they are not magnified at all
    whole: float = 0.8  # part of a body's radius from which on the whole of it is shown, if to scale
    deep: float = 0.6  # depth under the rim of the surface
    strongest: float = 1.0  # stress in E* beta/R at the ends of the colours at most: a spike would leave the rest pale
    open: float = 270.0  # angle of the solid that is left: a quarter is cut away
    sides: int = 120  # plane pieces that the solid is round with
    upwards: float = 16.0  # angle of the camera over the wall
    away: float = 10.0  # distance of the camera
    light: tuple[float, float, float] = (0.0, 1.0, 1.0)  # above the camera, seen from there
    room: tuple[float, float] = (0.55, 0.78)  # part of the picture's width and height that the solid may take
    off_centre: tuple[float, float] = (-0.14, 0.04)  # where, in halves of the picture


LOOK = Look()
LINEAR = {
    9: np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]),
    6: np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]),
}
"""Linear cells into which those of a section are cut, by their nodes."""


@dataclass(frozen=True)
class View:
    """What is shown, of all states of a curve alike.

    Radius, depth under the pole and height of the wall over it are in beta, like `heights`, what a height of beta^2/R
    is drawn as; `limit` is the stress at the ends of the colours in E* beta/R.
    """

    reach: float
    depth: float
    top: float
    heights: float
    limit: float


@dataclass(frozen=True, eq=False, repr=False)
class MeridianSection(Valued):
    """Meridian section of the body: radius and height as drawn, (2, n), and cells, (m, 3 or 4).

    The stress (n,) is the vertical one in E* beta/R, tension positive. The interfaces between its regions are lines
    of such points.
    """

    points: Array
    cells: Index
    stress: Array
    interfaces: tuple[Array, ...]


def view_of(states: Sequence[State]) -> View:
    """View in which all states of one scene are seen: given all, or those that bound them with the widest contact."""
    first = states[0]
    widest = np.nanmax([first.scene.tabor**-0.5, *(state.observables[CONTACT_RADIUS] for state in states)])
    end, R = float(first.surface.radii[-1]), first.scene.sphere_radius
    reach = min(LOOK.wider * float(widest), end)
    heights = LOOK.steepest * reach / float(first.problem.profile.height(np.array([reach]))[0])
    to_scale = heights * R < LOOK.to_scale
    if to_scale:
        heights = 1 / R
        reach = end if reach > LOOK.whole * end else reach
    depth = heights * float(_own_height(first, np.array([reach]))[0]) + LOOK.deep * reach
    if to_scale:
        depth = min(depth, -float(first.space.mesh.p[1].min()))
    largest = max(float(np.abs(state.pressure).max()) for state in states)
    top = max(float(surfaces(state, reach, heights)["wall"][1].max()) for state in states)
    return View(reach, depth, top, heights, min(LOOK.strongest, largest))


def section(state: State, view: View) -> MeridianSection:
    """MeridianSection of the whole body as a view draws it."""
    cut = cut_for(state.space, state.stress, LOOK.tolerance)
    u_r, u_z = cut.values(state.components)
    r, z = cut.points
    scene, own = state.scene, _own_height(state, r)
    moved = view.heights * (u_z - own) + (own / scene.sphere_radius if own.any() else 0.0)
    cells = cut.cells
    linear = cells[:, LINEAR[cells.shape[1]]]
    stress = cut.values(state.stress)[1]
    points = np.stack([r + u_r / scene.sphere_radius, z + moved])
    places = (np.flatnonzero(np.isclose(z, -depth, rtol=1e-9, atol=0)) for depth in scene.body.interfaces)
    interfaces = tuple(points[:, nodes[np.argsort(r[nodes])]] for nodes in places)
    return MeridianSection(points, linear.reshape(-1, linear.shape[2]), stress, interfaces)


def surfaces(state: State, reach: float, heights: float) -> dict[str, Array]:
    """Lines (2, n) of radius and height as drawn: the surface, ``undeformed`` and ``deformed``, and the ``wall``.

    They go out to a radius in beta; beta^2/R of height is drawn as `heights` in beta.
    """
    u_r, u_z = state.surface_displacement
    r = state.surface.radii
    own = _own_height(state, r)
    levels = np.array([-own, u_z - own, u_z - own + (state.gap + 1) / state.scene.tabor])
    shown = np.concatenate([[0.0], r[r < reach], [reach]])
    undeformed, deformed, wall = (np.stack([shown, heights * np.interp(shown, r, level)]) for level in levels)
    deformed[0] += np.interp(shown, r, u_r, left=0.0) / state.scene.sphere_radius
    return {"undeformed": undeformed, "deformed": deformed, "wall": wall}


def _own_height(state: State, radii: Array) -> Array:
    """Depth of the undeformed body's surface under its pole in beta^2/R, zero for a block."""
    surface = state.surface
    if not surface.depths.any():
        return np.zeros_like(radii)
    r, depth = np.append(0.0, surface.radii), np.append(0.0, surface.depths)
    return np.asarray(state.scene.sphere_radius * np.interp(radii, r, depth))


Pixels = NDArray[np.uint8]

COLOURS = "RdBu_r"
"""Blue in compression, red in tension: told apart by every kind of colour-blind eye, and white where there is none."""

OSMESA = "OSMesa"  # library that VTK draws with where it finds neither a display nor EGL
OUTLINE = "#606060"
LINES = {"undeformed": ("#009E73", 4), "deformed": ("black", 6), "wall": ("#505050", 6)}
"""Colours and widths of the lines along the cut."""


def solid_image(state: State, view: View, size: tuple[int, int]) -> Pixels:
    """Picture (height, width, 3) of the solid and the wall, without words; InputError as by `require_drawing`."""
    pyvista = require_drawing()
    with pyvista.vtk_verbosity("error"):  # VTK warns that there is no display, for which it has a remedy itself
        plotter = pyvista.Plotter(off_screen=True, window_size=list(size), lighting="none")
        plotter.add_light(pyvista.Light(position=LOOK.light, light_type="camera light"))
        plotter.set_background("white")
        _add_body(plotter, state, view)
        _add_surfaces(plotter, state, view)
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
    with pyvista.vtk_verbosity("error"):
        last_resort = vtkRenderWindow().GetClassName() == "vtkOSOpenGLRenderWindow"
    if last_resort and find_library(OSMESA) is None:
        remedy = "apt-get install libegl1 libgl1-mesa-dri"
        raise InputError(f"OpenGL is not installed, which draws off-screen pictures; {remedy}")
    return pyvista


def _add_body(plotter: Any, state: State, view: View) -> None:
    """The cut in its true colours, and the skin lit, so that its shape is seen."""
    shown = section(state, view)
    cells = np.insert(shown.cells, 0, shown.cells.shape[1], axis=1)
    whole = require_pyvista().PolyData(in_plane(*shown.points), faces=cells.ravel())
    whole.point_data["stress"] = shown.stress
    plane = _in_view(whole, view)
    colours = {"scalars": "stress", "cmap": COLOURS, "clim": (-view.limit, view.limit), "show_scalar_bar": False}
    outline = plane.extract_feature_edges(feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    for angle in (0.0, LOOK.open):
        plotter.add_mesh(plane.rotate_z(angle), lighting=False, **colours)
        plotter.add_mesh(outline.rotate_z(angle), color=OUTLINE, line_width=2)
        for line in shown.interfaces:
            seen = _in_view(line_through(*line), view)
            plotter.add_mesh(seen.rotate_z(angle), color=OUTLINE, line_width=3, lighting=False)
    light = {"ambient": 0.55, "diffuse": 0.5, "specular": 0.0, "smooth_shading": True, "split_sharp_edges": True}
    plotter.add_mesh(_turned(plane), **colours, **light)


def _in_view(plane: Any, view: View) -> Any:
    return plane.clip("x", origin=(view.reach, 0, 0)).clip("-z", origin=(0, 0, -view.depth))


def _add_surfaces(plotter: Any, state: State, view: View) -> None:
    """The wall, translucent, and along the cut the lines of wall, body and undeformed body."""
    shown = surfaces(state, view.reach, view.heights)
    wall = _turned(line_through(*shown["wall"]))
    plotter.add_mesh(wall, color="#a0a0a0", opacity=0.3, smooth_shading=True)
    for name, (colour, width) in LINES.items():
        for angle in (0.0, LOOK.open):
            line = line_through(*shown[name]).rotate_z(angle)
            plotter.add_mesh(line, lighting=False, color=colour, line_width=width)


def _turned(plane: Any) -> Any:
    return plane.extrude_rotate(angle=LOOK.open, resolution=LOOK.sides, capping=False, rotation_axis=(0, 0, 1))


def _look(plotter: Any, view: View, size: tuple[int, int]) -> None:
    """Look into the quarter that is cut away, a little from above, and leave room for words, bar and curve."""
    away, up = np.radians(LOOK.open / 2 + 180), np.radians(LOOK.upwards)
    direction = np.array([np.cos(away) * np.cos(up), np.sin(away) * np.cos(up), np.sin(up)])
    middle = np.array([0.0, 0.0, (view.top - view.depth) / 2])
    high = ((view.top + view.depth) * np.cos(up) + 2 * view.reach * np.sin(up)) / LOOK.room[1]
    wide = 2 * view.reach / LOOK.room[0] * size[1] / size[0]
    camera, distance = plotter.camera, LOOK.away * view.reach
    plotter.camera_position = [middle + distance * direction, middle, (0, 0, 1)]
    camera.view_angle = np.degrees(2 * np.arctan(max(high, wide) / 2 / distance))
    camera.SetWindowCenter(*LOOK.off_centre)
