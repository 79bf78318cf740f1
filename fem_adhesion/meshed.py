"""Bodies that a user has meshed: one mesh for the whole curve, and the same cut finer for the error estimate."""

from __future__ import annotations

from typing import Any

from skfem import ElementQuad2, ElementTriP2, MeshTri

from fem_adhesion.condensed import condense
from fem_adhesion.elasticity import Space
from fem_adhesion.incompressible import stiffness_for
from fem_adhesion.mesh_file import read_body
from fem_adhesion.refinement import refined
from fem_adhesion.scene import Scene
from fem_adhesion.sized import GRIPS
from halfspace.contact import ContactProblem
from halfspace.curve import Chart
from halfspace.ladder import Charted, Charts, Rung
from halfspace.profiles import Tabulated


def ladder(scene: Scene, level: int) -> Rung:
    """Rung of a level: the mesh, each cell cut into four as often as the level says, with quadratic elements.

    Raises
    ------
    InputError
        If the file holds no body.
    GridTooCoarse
        If the mesh does not carry the spike of tension at the contact edge.
    """
    charts = mesh_charts(scene, level)
    settings = {"mesh": str(scene.body), "degree": 2, "refined": level}
    return Rung(lambda: charts, (Charted(charts),) if level else (), settings, remaining=1.0)


def mesh_charts(scene: Scene, times_refined: int = 0) -> Charts:
    """The one chart of a scene whose body is a mesh."""
    mesh = read_body(str(scene.body)).scaled(scene.sphere_radius)
    for _ in range(times_refined):
        mesh = refined(mesh)
    space = Space(mesh, ElementTriP2() if isinstance(mesh, MeshTri) else ElementQuad2())
    body = condense(space, scene.poisson, far_field=GRIPS[scene.grip], stiffness=_stiffness(scene, mesh))
    surface = body.surface
    R = scene.sphere_radius
    profile = Tabulated(surface.radii, R * surface.depths, R * surface.slopes)
    return (Chart(ContactProblem(body.operator, scene.tabor, profile=profile), body.unknowns),)


def _stiffness(scene: Scene, mesh: Any) -> Any:
    """Only quadrilaterals have a projected dilatation; quadratic triangles lose accuracy from poisson 0.45 on."""
    return stiffness_for(0.0 if isinstance(mesh, MeshTri) else scene.poisson)
