"""Two elastic bodies: their compliances add, on nodes that both have, and so do the heights of their surfaces.

The nodes are those of the first, smaller sphere, given by its coordinate s. The cells of the second body are mapped so
that they end at the same radii and have their nodes there too. E* and 1/R are those of the pair, so that a body's own
compliance counts by its share of 1/E*.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.far_field import FarField, point_load
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh import spheres
from fem_adhesion.mesh.curved import Block, joined
from fem_adhesion.scene import Counter
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.profiles import Paraboloid, Surface
from halfspace.profiles.sphere import between_spheres
from halfspace.values import Array

BEYOND = 1e3  # size of a block, in radii of the sphere that meets it


def radii_of(R: float, counter: Counter) -> tuple[float, float]:
    """Radii R1 and R2 of the bodies in beta from the pair's, 1/R = 1/R1 + 1/R2."""
    return R * (1 + 1 / counter.radius), R * (1 + counter.radius)


def gap_of(R: float, counter: Counter, profile: str) -> Surface:
    """Undeformed gap of the pair."""
    return Paraboloid(radii_of(R, counter)[0]) if profile == "paraboloid" else between_spheres(R, counter.radius)


def pair_operator(
    lines: Array,
    depths: Callable[[float], Array],
    R: float,
    counter: Counter,
    poisson: float,
    degree: int,
    grip: FarField,
    rings: Array,
) -> tuple[ElasticOperator, int]:
    """Operator of both bodies and the number of their unknowns.

    Parameters
    ----------
    lines : (m + 1,) array
        Ends of the cells in the first sphere's coordinate, from 0 to CORE R1; the compliance is known as far.
    depths : callable
        From a size in beta, the lines below the surface.
    R : float
        Radius of the pair in beta.
    counter : Counter
        The second body.
    poisson : float
        Of the first.
    degree : int
        Of the elements.
    grip : FarField
        How spheres are held at their mid-planes.
    rings : (k,) array
        Sizes of the rings around their equators.
    """
    first, second = pair_meshes(lines, depths, R, counter, rings)
    held = point_load if np.isinf(counter.radius) else grip
    one, other = (
        condense(Space(mesh, ElementQuadP(degree)), nu, far_field=far, stiffness=stiffness_for(nu))
        for mesh, nu, far in ((first, poisson, grip), (second, counter.poisson, held))
    )
    a, b = one.operator, other.operator
    compliance = (1 - counter.share) * a.compliance + counter.share * b.compliance
    return ElasticOperator(a.radii, a.weights, compliance, a.cells, a.cell_nodes), one.unknowns + other.unknowns


def pair_meshes(
    lines: Array, depths: Callable[[float], Array], R: float, counter: Counter, rings: Array
) -> tuple[Any, Any]:
    """Meshes of both bodies for `pair_operator`, whose contact ends with the cells that are given."""
    R1, R2 = radii_of(R, counter)
    end = float(spheres.Stereographic(R1).radius(lines[-1:])[0][0])
    first = spheres.hemisphere(R1, lines, depths(spheres.DEPTH * R1), rings=rings)
    second = _block(lines, R1, depths) if np.isinf(R2) else _larger(lines, R1, R2, depths, rings)
    return spheres.with_contact_to(first, end), spheres.with_contact_to(second, end)


def with_rigid_rim(operator: ElasticOperator, lines: Array, coordinate: spheres.Stereographic) -> ElasticOperator:
    """Extend an operator by nodes that attract and do not yield.

    Parameters
    ----------
    operator : ElasticOperator
        Of q nodes.
    lines : (m + 1,) array
        Ends of m more cells in the coordinate, the first where the operator's end.
    coordinate : Stereographic
        Of the surface.
    """
    k = operator.cell_nodes.shape[1]
    t, w = grid.gauss_legendre(k)
    half = np.diff(lines)[:, None] / 2
    x = (lines[:-1, None] + half * (1 + t)).ravel()
    q, more = operator.radii.size, x.size
    compliance = np.zeros((q + more, q + more))
    compliance[:q, :q] = operator.compliance
    return ElasticOperator(
        np.concatenate([operator.radii, coordinate.radius(x)[0]]),
        np.concatenate([operator.weights, 2 * np.pi * coordinate.ring(x)[0] * (half * w).ravel()]),
        compliance,
        np.concatenate([operator.cells, coordinate.radius(lines[1:])[0]]),
        np.arange(q + more).reshape(-1, k),
    )


def _larger(lines: Array, R1: float, R2: float, depths: Callable[[float], Array], rings: Array) -> Any:
    """Hemisphere of radius R2 whose cells end where those of R1 do, and beyond at its own core's end."""
    along = partial(_along, coordinate=_coordinate_on(R1, R2), last=float(lines[-1]))
    rest = spheres.CORE * R2 - float(along(lines[-1:])[0])
    beyond = (
        float(lines[-1]) + grid.geometric(rest, float(lines[-1] - lines[-2]), 2.5)[1:]
        if rest > 1e-9 * R2
        else lines[:0]
    )
    return spheres.hemisphere(R2, np.concatenate([lines, beyond]), depths(spheres.DEPTH * R2), along, rings)


def _block(lines: Array, R1: float, depths: Callable[[float], Array]) -> Any:
    """Block whose cells end where those of the sphere do, and beyond at ever larger distances."""
    along = partial(_along, coordinate=_coordinate_on(R1, np.inf), last=float(lines[-1]))
    beyond = float(lines[-1]) + grid.geometric(BEYOND * R1, float(lines[-1] - lines[-2]), 2.5)[1:]
    s, d = np.concatenate([lines, beyond]), depths(BEYOND * R1)
    mesh = joined(
        [Block(s, d, lambda s, d: np.array([along(s), -d]))], [np.arange(s.size * d.size).reshape(s.size, -1)]
    )
    return spheres.named_block(mesh)


def _coordinate_on(R1: float, R2: float) -> Callable[[Array], Array]:
    """Coordinate on the second surface, flat if R2 is infinite, of points at the first one's coordinate s."""

    def coordinate(s: Array) -> Array:
        r = spheres.Stereographic(R1).radius(s)[0]
        sine = r / R2
        return np.asarray(2 * r / (1 + np.sqrt((1 - sine) * (1 + sine))))

    return coordinate


def _along(s: Array, *, coordinate: Callable[[Array], Array], last: float) -> Array:
    """The second surface's coordinate: shared with the first up to `last`, then as long as s is."""
    return coordinate(np.minimum(s, last)) + np.maximum(s - last, 0.0)
