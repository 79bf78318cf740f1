"""Bodies of scenes on meshes graded about one contact radius, with all that is needed for the fields inside them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from skfem import ElementQuad2, ElementQuadP, ElementTriP2, MeshTri

from fem_adhesion.bodies.pair import radii_of
from fem_adhesion.bodies.sized import GRIPS, Discretisation, block_under_sphere, corner_rings, sized_body
from fem_adhesion.convergence import FAR_FIELDS, size_for
from fem_adhesion.elasticity.condensation import CondensedBody, condense
from fem_adhesion.elasticity.far_field import FarField, point_load
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.mesh.file import read_body
from fem_adhesion.mesh.refinement import refined
from fem_adhesion.scene import Counter, Scene
from halfspace.accuracy.finite_bodies import SizedBody
from halfspace.elastic import grid
from halfspace.equilibrium.contact import ContactProblem, spike_width
from halfspace.profiles import PARABOLOID, Surface
from halfspace.profiles.table import TabulatedSurface
from halfspace.values import Array, Valued

RTOL = 1e-5
"""Of the load left out beyond a block that goes on as a half-space: it is then 15 to 80 beta wide."""

BEYOND = 10.0
"""Size of the block under a sphere, in R: its far field errs by O(L^-5)."""


@dataclass(frozen=True, eq=False, repr=False)
class Discretised(Valued):
    """A body and the contact problem on its surface.

    Attributes
    ----------
    body : CondensedBody
        The body, the first of two, as if it had the whole compliance 1/E*; see `share_of`.
    problem : ContactProblem
        With the compliance of both bodies; its first nodes are those of the body, any more are on a rim that is rigid.
    """

    body: CondensedBody
    problem: ContactProblem


def share_of(scene: Scene) -> float:
    """Part of the compliance 1/E* that is the body's: its displacement is that of a body of modulus E* times this."""
    return 1.0 if scene.counter is None else 1.0 - scene.counter.share


def discretised(scene: Scene, source: ContactProblem, contact_radius: float, how: Discretisation) -> Discretised:
    """Discretise the body of a scene finest about a contact radius.

    Parameters
    ----------
    scene : Scene
        Of small strain: a block, a hemisphere or a mesh.
    source : ContactProblem
        Another discretisation of the scene, whose size a block held at its far boundary takes over.
    contact_radius : float
        In beta; nan without contact, the mesh is then finest on the axis.
    how : Discretisation
        How finely; without meaning for a user's mesh.
    """
    radius = 0.0 if np.isnan(contact_radius) else contact_radius
    if isinstance(scene.body, Path):
        return _meshed(scene, source)
    if not scene.sized:
        finest = how.finest * spike_width(scene.tabor) / 2
        edge = radius if radius > finest else 0.0
        lines = grid.graded(edge, finest, _size_of_block(scene, source), growth=how.growth)
        return _block(scene, how, lines, FAR_FIELDS[scene.far_field])
    body = sized_body(scene, how)
    edge = body.coordinate.of(radius)
    lines = body.lines(edge if edge > body.length else 0.0)
    inner = lines[: len(lines) - len(body.outer) + 1]
    if scene.body == "block":
        return _block_under_sphere(scene, how, lines, body.profile)
    if scene.counter is None:
        return _of(scene, _hemisphere(scene, how, scene.sphere_radius, inner), body.profile)
    return _first_of_pair(scene, scene.counter, how, lines, inner, body)


def _size_of_block(scene: Scene, source: ContactProblem) -> float:
    """Size L of a block in beta: its own, or what the load left out allows."""
    if scene.radius is not None:
        return scene.radius
    if scene.far_field != "point_load":
        return source.operator.at(1.0).extent
    return size_for(scene.tabor, RTOL)


def _block(scene: Scene, how: Discretisation, lines: Array, far_field: FarField) -> Discretised:
    depths = grid.graded(0.0, np.diff(lines).min(), float(lines[-1]), growth=how.growth)
    return _of(scene, _condensed(scene, how, tensor_grid(lines, depths), far_field), PARABOLOID)


def _block_under_sphere(scene: Scene, how: Discretisation, lines: Array, profile: Surface) -> Discretised:
    """Block whose surface the law acts on as far as the sphere reaches."""
    mesh = block_under_sphere(scene, how, lines, BEYOND)
    return _of(scene, _condensed(scene, how, mesh, point_load), profile)


def _hemisphere(scene: Scene, how: Discretisation, R: float, core: Array) -> CondensedBody:
    depths = grid.graded(0.0, np.diff(core).min(), spheres.DEPTH * R, growth=how.growth)
    mesh = spheres.hemisphere(R, core, depths, rings=corner_rings(scene, how))
    if scene.counter is not None:
        mesh = spheres.with_contact_to(mesh, float(spheres.Stereographic(R).radius(core[-1:])[0][0]))
    return _condensed(scene, how, mesh, GRIPS[scene.grip])


def _first_of_pair(
    scene: Scene, counter: Counter, how: Discretisation, lines: Array, core: Array, pair: SizedBody
) -> Discretised:
    R1, _ = radii_of(scene.sphere_radius, counter)
    body = _hemisphere(scene, how, R1, core)
    return Discretised(body, ContactProblem(pair.make(lines)[0], scene.tabor, profile=pair.profile))


def _meshed(scene: Scene, source: ContactProblem) -> Discretised:
    """The mesh of a file, cut as often as that of the source."""
    R, facets = scene.sphere_radius, len(source.operator.at(1.0).cells) - 1
    mesh = read_body(str(scene.body)).scaled(R)
    while len(mesh.boundaries["contact"]) < facets:
        mesh = refined(mesh)
    triangles = isinstance(mesh, MeshTri)
    space = Space(mesh, ElementTriP2() if triangles else ElementQuad2())
    stiffness = stiffness_for(0.0 if triangles else scene.poisson)
    body = condense(space, scene.poisson, far_field=GRIPS[scene.grip], stiffness=stiffness)
    surface = body.surface
    return _of(scene, body, TabulatedSurface(surface.radii, R * surface.depths, R * surface.slopes))


def _condensed(scene: Scene, how: Discretisation, mesh: Any, far_field: FarField) -> CondensedBody:
    space = Space(mesh, ElementQuadP(how.degree))
    stiffness = stiffness_for(scene.poisson)
    return condense(space, scene.poisson, far_field=far_field, stiffness=stiffness, traction=scene.traction)


def _of(scene: Scene, body: CondensedBody, profile: Surface) -> Discretised:
    return Discretised(body, ContactProblem(body.operator, scene.tabor, profile=profile))
