"""Bodies that a user has meshed: one mesh for the whole curve, and the same cut finer for the error estimate."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

from skfem import ElementQuad2, ElementTriP2, MeshTri

from fem_adhesion.bodies.sized import GRIPS
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.file import read_scaled
from fem_adhesion.mesh.refinement import refined
from fem_adhesion.scene import Scene
from halfspace.accuracy.refinement import Charted, Charts, Rung, climb
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.curve import Chart, EquilibriumPath
from halfspace.errors import GridTooCoarse
from halfspace.profiles.table import TabulatedSurface


def trace(scene: Scene, rtol: float, to_load: float) -> EquilibriumPath:
    """Trace the curve of a scene whose body is a mesh, on that mesh and once cut finer.

    Raises
    ------
    InputError
        If the file holds no body.
    GridTooCoarse
        If the mesh does not carry the spike of tension at the contact edge: in the file's unit.
    halfspace.errors.NotConverged
        If the curve cannot be traced.
    """
    mesh, unit = read_scaled(str(scene.body))
    try:
        return climb(rtol, partial(ladder, scene, mesh, unit), to_load=to_load, most_rungs=1)
    except GridTooCoarse as error:
        raise _in_the_files_unit(error, scene, unit) from error


def _in_the_files_unit(error: GridTooCoarse, scene: Scene, unit: float) -> GridTooCoarse:
    R = scene.sphere_radius
    radius, length, limit = (value / R * unit for value in (error.radius, error.length, error.limit))
    return GridTooCoarse(
        f"mesh {scene.body}: lines of the contact are {length:.3g} long at r = {radius:.3g}, in the file's unit, limit "
        f"{limit:.3g} for tabor {scene.tabor:g} and radius_ratio {scene.radius_ratio:g}; mesh it finer there (in the "
        f"recipes of meshes/: fine = {_rounded_down(limit):.2g}, or a smaller growth beyond the fine part), or take a "
        "smaller tabor or radius_ratio",
        *(error.radius, error.length, error.limit),
    )


def _rounded_down(length: float) -> float:
    """Two digits and a little less, as Gmsh exceeds the size it is given by some per cents."""
    scale = 10.0 ** (math.floor(math.log10(length)) - 1)
    return math.floor(0.97 * length / scale) * scale


def ladder(scene: Scene, mesh: Any, unit: float, level: int) -> Rung:
    """Rung of a level: the mesh, each cell cut into four as often as the level says, with quadratic elements.

    Parameters
    ----------
    scene : Scene
        Of a body from a file.
    mesh : skfem.Mesh
        From it, in units of R.
    unit : float
        R in the file's unit.
    level : int
        Of the ladder.
    """
    charts = mesh_charts(scene, mesh, level)
    settings = {"mesh": str(scene.body), "pole_radius": unit, "degree": 2, "refined": level}
    return Rung(lambda: charts, (Charted(charts),) if level else (), settings, remaining=1.0)


def mesh_charts(scene: Scene, mesh: Any, times_refined: int = 0) -> Charts:
    """The one chart of a scene whose body is a mesh, given in units of R."""
    mesh = mesh.scaled(scene.sphere_radius)
    for _ in range(times_refined):
        mesh = refined(mesh)
    space = Space(mesh, ElementTriP2() if isinstance(mesh, MeshTri) else ElementQuad2())
    body = condense(space, scene.poisson, far_field=GRIPS[scene.grip], stiffness=_stiffness(scene, mesh))
    surface = body.surface
    R = scene.sphere_radius
    profile = TabulatedSurface(surface.radii, R * surface.depths, R * surface.slopes)
    return (Chart(ContactProblem(body.operator, scene.tabor, profile=profile), body.unknowns),)


def _stiffness(scene: Scene, mesh: Any) -> Any:
    """Only quadrilaterals have a projected dilatation; quadratic triangles lose accuracy from poisson 0.45 on."""
    return stiffness_for(0.0 if isinstance(mesh, MeshTri) else scene.poisson)
