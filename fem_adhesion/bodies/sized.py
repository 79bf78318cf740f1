"""Finite-element bodies with a length of their own, from a scene: hemisphere, sphere, and the block under a sphere."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.bodies.pair import gap_of, pair_operator, radii_of, with_rigid_rim
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.far_field import clamped, point_load, sliding
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.block import tensor_grid
from fem_adhesion.mesh.held_sphere import held_sphere, rings_at_equator
from fem_adhesion.scene import Counter, Scene
from halfspace.accuracy.finite_bodies import AroundEvents, Made, SizedBody, at_equator, surroundings
from halfspace.accuracy.refinement import Rung
from halfspace.accuracy.trace import TWIN
from halfspace.elastic import grid
from halfspace.elastic.operators import FlatCoordinate
from halfspace.equilibrium.contact import spike_width
from halfspace.profiles import Paraboloid, Surface
from halfspace.profiles.sphere import SphereSurface
from halfspace.values import Array

GRIPS = {"sliding": sliding, "bonded": clamped}

FINEST, GROWTH = 0.6, 2.5  # of the cells: at the contact edge in widths of the spike of tension, and of their lengths
CURVE_DEGREE = 4  # of the elements for the curve, whose operator is interpolated to some 1e-4
FOURTH = 1.5e-5  # estimated error of the events from degree 4 to 5
PER_DEGREE = 15.0  # what each degree divides it by
REMAINING = 0.5  # of the change by one degree: a degree leaves a tenth of it, or a fifth at worst
RINGS, MOST_RINGS = 0.2, 6  # ratio of the rings around a singular corner's, and as many as rounding allows
BEYOND = 1e3  # size of the block under a sphere, in R: nothing acts on it beyond R, and its far field errs by O(L^-5)
PAST_EQUATOR = 0.02  # length of its first cell there, in R


@dataclass(frozen=True)
class Discretisation:
    """How finely a body is discretised.

    Attributes
    ----------
    degree : int
        Of the quadrilateral elements; the error falls by an order of magnitude a degree.
    finest : float
        Length of the cells at the contact edge, in widths of the spike of tension there.
    growth : float
        Ratio of neighbouring cells.
    rings : int
        Of cells around the corner where a mid-plane meets the free surface, if it is bonded.
    """

    degree: int
    finest: float = FINEST
    growth: float = GROWTH
    rings: int = MOST_RINGS - 1


def ladder(scene: Scene, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level: the events on elements of a degree that suits the tolerance, one more on each level.

    Where a body is held the stress may be singular, which a degree more does not tell: other cells are a twin there.
    """
    degree = degree_for(rtol) + level
    how, below, curve = (with_rings(d) for d in (degree, degree - 1, CURVE_DEGREE + level))
    settings = asdict(how) | {"curve_degree": curve.degree, "rings": len(corner_rings(scene, how))}
    twin = replace(below, finest=TWIN[0] * below.finest, growth=TWIN[1] * below.growth)
    other = AroundEvents(sized_body(scene, twin), *surroundings(rtol, level - 1), to_load)
    return Rung(
        partial(sized_body(scene, curve).curve, to_load),
        (AroundEvents(sized_body(scene, how), *surroundings(rtol, level), to_load),),
        settings,
        other if level and _singular(scene) else None,
        remaining=REMAINING,
        along=True,
    )


def degree_for(rtol: float) -> int:
    """Degree of the elements on the lowest rung."""
    return int(np.clip(4 + np.ceil(np.log(FOURTH / rtol) / np.log(PER_DEGREE) - 1e-9), 4, 8))


def with_rings(degree: int) -> Discretisation:
    """Discretisation whose rings leave less than its degree does."""
    return Discretisation(degree, rings=min(degree - 2, MOST_RINGS))


def _singular(scene: Scene) -> bool:
    return scene.body == "sphere" or (scene.body == "hemisphere" and scene.grip == "bonded")


def sized_body(scene: Scene, how: Discretisation) -> SizedBody:
    """Body of a scene, to be discretised on any grid of its surface."""
    R, profile = scene.sphere_radius, profile_of(scene)
    if scene.body == "block":
        make, last = partial(_block, scene, how), at_equator(scene.tabor, profile, how.degree + 2)
        return SizedBody(scene.tabor, profile, make, how.finest, how.growth, np.array([R]), FlatCoordinate(), last)
    return _pair(scene, how, R, scene.counter) if scene.counter else _sphere(scene, how, R, profile)


def profile_of(scene: Scene) -> Surface:
    """Undeformed gap under a rigid wall."""
    return SphereSurface(scene.sphere_radius) if scene.profile == "sphere" else Paraboloid(scene.sphere_radius)


def _pair(scene: Scene, how: Discretisation, R: float, counter: Counter) -> SizedBody:
    """Hemisphere and counter-body; beyond the smaller one's core, 0.987 of its radius, both are taken as rigid."""
    R1, _ = radii_of(R, counter)
    make, profile = partial(_made_pair, scene, how, R, counter), gap_of(R, counter, scene.profile)
    outer = spheres.contact_ends(R1, spheres.NO_RINGS)
    return SizedBody(scene.tabor, profile, make, how.finest, how.growth, outer, spheres.Stereographic(R1))


def _sphere(scene: Scene, how: Discretisation, R: float, profile: Surface) -> SizedBody:
    """Hemisphere held at its mid-plane, or sphere held over a cap."""
    whole = scene.body == "sphere"
    rings = rings_at_equator(R, scene.cap_angle) if whole else corner_rings(scene, how)
    outer = spheres.contact_ends(R, rings)
    make = partial(_made_sphere, scene, how, len(outer))
    return SizedBody(
        scene.tabor, profile, make, how.finest, how.growth, outer, spheres.Stereographic(R, scene.traction)
    )


def _made_pair(scene: Scene, how: Discretisation, R: float, counter: Counter, lines: Array) -> Made:
    """Both bodies, and beyond their cells the rigid rim."""
    core = lines[: -spheres.LAYERS]
    depths = partial(grid.graded, 0.0, np.diff(core).min(), growth=how.growth)
    rings = corner_rings(scene, how)
    operator, unknowns = pair_operator(core, depths, R, counter, scene.poisson, how.degree, GRIPS[scene.grip], rings)
    coordinate = spheres.Stereographic(radii_of(R, counter)[0])
    return with_rigid_rim(operator, lines[-spheres.LAYERS - 1 :], coordinate), unknowns


def _made_sphere(scene: Scene, how: Discretisation, outer: int, lines: Array) -> Made:
    """Sphere or hemisphere whose last `outer` lines stand still."""
    core, R = lines[: len(lines) - outer + 1], scene.sphere_radius
    depths = grid.graded(0.0, np.diff(core).min(), spheres.DEPTH * R, growth=how.growth)
    whole = scene.body == "sphere"
    if whole:
        return _condensed(scene, how, held_sphere(R, core, depths, scene.cap_angle))
    return _condensed(scene, how, spheres.hemisphere(R, core, depths, rings=corner_rings(scene, how)))


def corner_rings(scene: Scene, how: Discretisation) -> Array:
    """Sizes of the rings around the equator of a hemisphere, where stress is singular if the mid-plane is bonded.

    There u ~ d^s, with d the distance and sin^2(s pi/2) = [4 (1 - nu)^2 - s^2]/(3 - 4 nu) (Williams 1952): s falls from
    1 at nu = 0 to 0.6 at 1/2, and each ring takes the error it leaves, as d^(2 s), down by a factor of 25 to 7.
    """
    return np.asarray(RINGS ** np.arange(1.0, how.rings + 1)) if scene.grip == "bonded" else spheres.NO_RINGS


def _block(scene: Scene, how: Discretisation, lines: Array) -> Made:
    """Block whose surface the law acts on as far as the sphere reaches."""
    space = Space(block_under_sphere(scene, how, lines, BEYOND), ElementQuadP(how.degree))
    body = condense(space, scene.poisson, far_field=point_load, stiffness=stiffness_for(scene.poisson))
    return body.operator, body.unknowns


def block_under_sphere(scene: Scene, how: Discretisation, lines: Array, size: float) -> Any:
    """Mesh of a block whose surface cells have these ends up to the sphere's equator, of a size in R."""
    R = float(lines[-1])
    beyond = grid.geometric((size - 1) * R, PAST_EQUATOR * R, how.growth)[1:]
    depths = grid.graded(0.0, how.finest * spike_width(scene.tabor) / 2, size * R, growth=how.growth)
    return spheres.with_contact_to(tensor_grid(np.concatenate([lines, R + beyond]), depths), R)


def _condensed(scene: Scene, how: Discretisation, mesh: object) -> Made:
    space = Space(mesh, ElementQuadP(how.degree))
    body = condense(
        space,
        scene.poisson,
        far_field=GRIPS[scene.grip],
        stiffness=stiffness_for(scene.poisson),
        traction=scene.traction,
    )
    return body.operator, body.unknowns
