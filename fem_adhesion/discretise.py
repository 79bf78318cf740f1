"""The one road from a scene to an elastic operator: mesh, space, condensation; of two bodies their compliances add.

The nodes of a pair are those of the first, smaller sphere. Beyond its core, 0.987 of its radius, both are rigid. E* and
1/R are those of the pair, so that a body's own compliance counts by its share of 1/E*.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np
from skfem import ElementQuad2, ElementQuadP, ElementTriP2, MeshTri

from fem_adhesion.bodies.body import Body, Discretisation, FarFieldName, Layout
from fem_adhesion.elasticity import exterior
from fem_adhesion.elasticity.cells import stiffness_of
from fem_adhesion.elasticity.condensation import CondensedBody, condense
from fem_adhesion.elasticity.exterior import FarField
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.spheres import with_contact_to
from fem_adhesion.scene import Scene
from halfspace.accuracy.finite_bodies import Made, SizedBody, at_equator, at_tip, of_sequence
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.elastic.grid import FLAT, SurfaceCoordinate
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.contact import ContactProblem
from halfspace.profiles import Surface
from halfspace.profiles.tabulated import TabulatedSurface
from halfspace.scales import Scales
from halfspace.values import Array, Valued

FAR_FIELDS: Mapping[FarFieldName, FarField] = {
    "point_load": exterior.point_load,
    "substrate": exterior.point_load,
    "clamped": exterior.clamped,
    "free": exterior.free,
    "sliding": exterior.sliding,
    "sheet": exterior.sheet,
}


TRIANGLE = ElementTriP2()


@dataclass(frozen=True)
class ElementSettings:
    """How fine elements are, how large blocks, and what a degree leaves.

    The elements for a curve, whose operator is interpolated to 0.01, see `ChartSettings`, find its events within 2e-3
    of their places, as starts: at degree 4 the curve of three strata took twice as long, a third of the whole. Of the
    radii of a block on two successive rungs the load left out beyond one that goes on as a half-space falls as L^-4: a
    decade. Held blocks err by O(1/L), which a change from L/3 to L exceeds twice.
    """

    lengths: int = 50  # of cells at the contact edge to a factor of e, so that charts of like contacts share
    curve_degree: int = 3  # of the elements for a curve
    larger_endless: float = 10**0.25  # ratio of the radii of a block that goes on as a half-space
    larger_held: float = 3.2  # and of one that is held
    fourth: float = 1.5e-5  # estimated error of the events from degree 4 to 5
    per_degree: float = 15.0  # what each degree divides it by
    remaining: float = 0.5  # of the change by one degree: a degree leaves a tenth of it, or a fifth at worst
    by_step: float = 2.0  # times as much by a law whose tension ends by a step: a degree may leave half of it
    left_out: float = 1e-5  # of the load, beyond a block for fields that goes on as a half-space: 44 beta at tabor 1
    fields_beyond: float = 10.0  # `Discretisation.beyond` for fields inside a half-space under a sphere


ELEMENTS = ElementSettings()


@cache
def quadrilateral(degree: int) -> Any:
    """Element of a degree, one for all meshes, so that its functions are evaluated once."""
    return ElementQuad2() if degree == 2 else ElementQuadP(degree)


@dataclass(frozen=True, eq=False, repr=False)
class Discretised(Valued):
    """The bodies of a scene and the contact problem on their surface.

    The first is as if it had the whole compliance 1/E*, see `Scene.shares`. Operator and number of unknowns are of both
    bodies: the operator's first nodes are those of the first body, any more are on a rim that is rigid. The surface is
    that of the undeformed gap.
    """

    first: CondensedBody
    operator: ElasticOperator
    surface: Surface
    scene: Scene
    unknowns: int

    @property
    def problem(self) -> ContactProblem:
        """On a grid that stands still."""
        return ContactProblem(self.operator, self.scene.tabor, self.scene.law, self.surface)


def discretise(scene: Scene, lines: Array, how: Discretisation) -> Discretised:
    """Discretise the bodies of a scene at small strain, as finely as `how` says.

    Lines (m + 1,) are the ends of the cells of the contact surface, in its coordinate; a given mesh has its own.
    """
    outer, coordinate = layout_of(scene, how)
    core = lines[: len(lines) - len(outer) + 1] if scene.sized else lines
    rim, meshes = lines[len(core) - 1 :], meshes_of(scene, core, how)
    first, *second = (_condensed(body, mesh, how) for body, mesh in zip(scene.bodies, meshes, strict=True))
    operator, surface = first.operator, scene.surface
    if scene.body.file:
        own, R = first.surface, scene.sphere_radius
        surface = TabulatedSurface(own.radii, R * own.depths, R * own.slopes)
    for other in second:
        part, rest = scene.shares
        operator = replace(operator, compliance=part * operator.compliance + rest * other.operator.compliance)
    if len(rim) > 1 and (second or scene.body.layered):  # what is far out is rigid
        operator = with_rigid_rim(operator, rim, coordinate)
    return Discretised(first, operator, surface, scene, sum(body.unknowns for body in (first, *second)))


def meshes_of(scene: Scene, core: Array, how: Discretisation) -> list[Any]:
    """Meshes of the bodies, from the ends of the cells that move with the contact, with which that of a pair ends."""
    (R, *others), length = scene.radii, finest_length(scene, how)
    mesh = scene.body.mesh(R, core, length, how)
    if scene.counter is None:
        return [mesh]
    end = float(layout_of(scene, how)[1].radius(core[-1:])[0][0])
    return [with_contact_to(each, end) for each in (mesh, scene.counter.facing(others[0], core, length, R, how))]


def finest_length(scene: Scene, how: Discretisation) -> float:
    """Length of the cells at the contact edge in beta; of bodies with a length the nearest of a sequence."""
    length = scene.scales.edge_cell(how.finest)
    return of_sequence(length, ELEMENTS.lengths, np.round) if scene.sized else length


def layout_of(scene: Scene, how: Discretisation) -> Layout:
    """Cells of the surface that stand still, and the coordinate along it; a pair has no rings, as its rim is rigid."""
    return scene.body.layout(scene.radii[0], replace(how, rings=0) if scene.counter else how)


def sized_body(scene: Scene, how: Discretisation, to_load: float = COMPRESSION) -> SizedBody:
    """Bodies of a scene with a length, to be discretised on any grid of their surface, see `SizedBody`."""
    outer, coordinate = layout_of(scene, how)
    ends = coordinate == FLAT and np.isfinite(scene.surface.end)
    last = at_equator(scene.tabor, scene.surface, how.degree + 2) if ends else np.inf
    first = at_tip(scene.surface, how.degree + 2)
    finest = finest_length(scene, how) / scene.scales.edge_cell(1.0)
    make, strip = partial(_made, scene, how), scene.body.strip
    return SizedBody(
        scene.scales, make, finest, how.growth, outer, coordinate, last=last, to_load=to_load, first=first, strip=strip
    )


def _made(scene: Scene, how: Discretisation, lines: Array) -> Made:
    found = discretise(scene, lines, how)
    return found.operator, found.unknowns


def discretised_about(scene: Scene, contact_radius: float, how: Discretisation) -> Discretised:
    """Discretise the bodies of a scene finest about a contact radius, with all that fields inside them need.

    The radius is in beta, nan without contact, where the mesh is finest on the axis. A mesh that is given, to which
    `how` means nothing, is cut as often as for the events.
    """
    how = replace(how, beyond=ELEMENTS.fields_beyond, refined=1)
    if scene.body.file:
        return discretise(scene, np.empty(0), how)
    radius, length = 0.0 if np.isnan(contact_radius) else contact_radius, finest_length(scene, how)
    if scene.sized:
        body = sized_body(scene, how)
        edge = body.coordinate.of(radius)
        return discretise(scene, body.lines(edge if edge > length else 0.0), how)
    size = scene.body.cut_off or size_for(scene.scales, ELEMENTS.left_out)
    return discretise(scene, grid.graded(radius if radius > length else 0.0, length, size, growth=how.growth), how)


def size_for(scales: Scales, rtol: float) -> float:
    """Size in beta of a block whose far field, that of a point load, leaves errors of rtol in the events."""
    return scales.radius_at((2.5 * min(rtol, 0.01) ** -0.25 * scales.widened) ** 2 / 2)


def _condensed(body: Body, mesh: Any, how: Discretisation) -> CondensedBody:
    """Condense a body; quadratic triangles, which have no projected dilatation, lose accuracy from poisson 0.45 on."""
    material = body.material
    space = Space(mesh, TRIANGLE if isinstance(mesh, MeshTri) else quadrilateral(how.degree))
    held = exterior.of_material(FAR_FIELDS[body.held], body.beyond)
    stiffness = partial(stiffness_of, space, body.regions)
    return condense(space, material.poisson, far_field=held, stiffness=stiffness, traction=material.area)


def with_rigid_rim(operator: ElasticOperator, lines: Array, coordinate: SurfaceCoordinate) -> ElasticOperator:
    """Extend an operator by nodes that attract and do not yield.

    Lines (m + 1,) are the ends of m more cells in the surface's coordinate, the first where the operator's end.
    """
    k = operator.cell_nodes.shape[1]
    x, w = (part.ravel() for part in grid.gauss_points(lines, k))
    q, more = operator.radii.size, x.size
    compliance = np.zeros((q + more, q + more))
    compliance[:q, :q] = operator.compliance
    return ElasticOperator(
        np.concatenate([operator.radii, coordinate.radius(x)[0]]),
        np.concatenate([operator.weights, 2 * np.pi * coordinate.ring(x)[0] * w]),
        np.concatenate([operator.cells, coordinate.radius(lines[1:])[0]]),
        np.arange(q + more).reshape(-1, k),
        compliance=compliance,
    )
