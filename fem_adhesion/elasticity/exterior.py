"""What holds the far boundary of a body: a clamp, a plane without friction, what goes on beyond, or nothing.

Each is a linear map u = T x from the reduced unknowns x to all unknowns u and a stiffness S on x, so that the body's
stiffness K becomes T' K T + S. T also imposes u_r = 0 on the axis, and leaves out the unknowns interior to a cell,
which are eliminated before.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from fem_adhesion.elasticity.space import Space, lame_parameters, ring_measure
from fem_adhesion.elasticity.surface import BoundaryPoints, boundary_points
from fem_adhesion.materials import Elastic
from halfspace.values import Array, Index, Valued

MORE_POINTS = 6  # Gauss points on a facet beyond the degree where a smooth field that is no polynomial is integrated


@dataclass(frozen=True, eq=False, repr=False)
class Exterior(Valued):
    """The far boundary's condition, reduced to matrices; N unknowns in all, n of them reduced.

    The reduction T (N, n) gives displacement unknowns from reduced ones; the stiffness S (n, n), symmetric, is in
    E* beta. The rigid compliance is the deflection per unit load, in 1/(E* beta), that S adds to the body's own and
    that must be taken off again.
    """

    reduction: sparse.csc_array
    stiffness: sparse.csc_array
    rigid_compliance: float = 0.0


FarField = Callable[[Space, float], Exterior]
"""A kind of far boundary, at a Poisson's ratio: `clamped`, `sliding`, `sheet`, `point_load` or `free`."""


def of_material(far_field: FarField, material: Elastic) -> FarField:
    """The same where what goes on beyond is of another material than the body's surface."""

    def condition(space: Space, poisson: float) -> Exterior:  # noqa: ARG001 (it has its own)
        exterior = far_field(space, material.poisson)
        return replace(exterior, stiffness=material.modulus * exterior.stiffness)

    return condition


def with_interiors(exterior: Exterior, space: Space, more: int = 0) -> Exterior:
    """Return the condition for a body whose interior unknowns are not eliminated: they lead the reduced ones.

    Of the unknowns beyond the displacements, such as pressures, each is a reduced one: so many `more`, the last.
    """
    inner, none = space.interior_dofs, sparse.csc_array((more, more))
    own = sparse.eye_array(space.unknowns, format="csc")[:, inner]
    T = sparse.block_diag([sparse.hstack([own, exterior.reduction]), sparse.eye_array(more)])
    S = sparse.block_diag([sparse.csc_array((len(inner), len(inner))), exterior.stiffness, none])
    return Exterior(sparse.csc_array(T), sparse.csc_array(S), exterior.rigid_compliance)


def clamped(space: Space, poisson: float) -> Exterior:  # noqa: ARG001 (a clamp is one for every material)
    """Hold the far boundary: u = 0. The deflection is too small by O(W/L)."""
    T = _selection(space, dropped=space.components[:, space.boundary_functions("far")].ravel())
    return Exterior(T, sparse.csc_array((T.shape[1], T.shape[1])))


def sliding(space: Space, poisson: float) -> Exterior:  # noqa: ARG001
    """Hold the far boundary by its vertical displacement alone: u_z = 0, u_r free; on a plane, without friction.

    By symmetry a hemisphere held so is also half of a sphere that is squeezed between two equal walls.
    """
    T = _selection(space, dropped=space.components[1, space.boundary_functions("far")])
    return Exterior(T, sparse.csc_array((T.shape[1], T.shape[1])))


def sheet(space: Space, poisson: float) -> Exterior:
    """Hold the base of a layer as `sliding` does, and let it go on beyond its edge, which moves outwards as a whole.

    A layer that is pressed spreads, far from there as a sheet under no load does: u_r = c L/r, u_z = 0. What goes on
    beyond the edge, r = L, stores 2 pi G t c^2, G the shear modulus and t the thickness; the one added unknown c is the
    last. All else has died out if the edge is some thicknesses away. A free edge would let it yield by O(1/L^2) more.
    """
    moved, held = space.boundary_functions("edge"), space.components[1, space.boundary_functions("far")]
    unknowns, thickness = space.components[0, moved], float(np.ptp(space.mesh.p[1]))
    column = sparse.csc_array((space.constant[moved], (unknowns, 0 * moved)), shape=(space.unknowns, 1))
    T = sparse.csc_array(sparse.hstack([_selection(space, dropped=np.append(held, unknowns)), column]))
    n, stiffness = T.shape[1], 4 * np.pi * lame_parameters(poisson)[1] * thickness
    return Exterior(T, sparse.csc_array(([stiffness], ([n - 1], [n - 1])), shape=(n, n)))


def point_load(space: Space, poisson: float) -> Exterior:
    """Let the far boundary move as in a half-space under a point load at the origin: u = c u_B.

    u_B is Boussinesq's displacement for a unit load, and the one added unknown c is the last. Beyond the
    boundary goes on the half-space, which stores c^2 k_B / 2 with k_B = -oint u_B . sigma_B n dA. So the
    equation of c says that the body pulls on the boundary with the force of a point load c, in the mean weighted by
    u_B, and the matrix stays symmetric. c tends to the load W as L^-2; the deflection near a pressure that ends
    within the block is in error by O(L^-5), both measured in tests/fem_adhesion/bodies/test_fem_condensed.py.
    """
    far = boundary_points(space, "far", space.degree + MORE_POINTS)
    unknowns = space.components[:, far.functions].ravel()
    u_B = far.projection(lambda r, z: boussinesq_displacement(r, z, poisson)).ravel()
    u_B[np.isin(unknowns, _axis_unknowns(space))] = 0.0

    column = sparse.csc_array((u_B, (unknowns, 0 * unknowns)), shape=(space.unknowns, 1))
    T = sparse.csc_array(sparse.hstack([_selection(space, dropped=unknowns), column]))
    n = T.shape[1]
    return Exterior(T, sparse.csc_array(([exterior_stiffness(far, poisson)], ([n - 1], [n - 1])), shape=(n, n)))


def exterior_stiffness(far: BoundaryPoints, poisson: float) -> float:
    """Return k_B = -oint u_B . sigma_B n dA over the far boundary, n pointing out of the block, in 1/(E* beta)."""
    (r, z), (n_r, n_z) = far.places, far.normals
    u_r, u_z = boussinesq_displacement(r, z, poisson)
    rr, zz, _, rz = boussinesq_stress(r, z, poisson)
    work = u_r * (rr * n_r + rz * n_z) + u_z * (rz * n_r + zz * n_z)
    return -float(np.sum(work * ring_measure(r) * far.lengths))


def free(space: Space, poisson: float) -> Exterior:  # noqa: ARG001 (nothing is outside, whatever the material)
    """Leave the far boundary free but for the uniform vertical traction that balances the load; its mean u_z is zero.

    A spring on the mean of u_z holds the body; it carries the whole load, so that its deflection is known and
    taken off: the result does not depend on the spring's stiffness.
    """
    far = boundary_points(space, "far", space.degree + 1)
    r = far.places[0]
    area = (ring_measure(r) * far.lengths).ravel()
    parts = far.values.T @ area / np.sum(area)
    mean = sparse.csc_array((parts, (space.components[1, far.functions], 0 * far.functions)), shape=(space.unknowns, 1))
    T = _selection(space, dropped=np.array([], dtype=np.intp))
    spring = float(np.max(r))  # of the order of the block's own stiffness E* L
    return Exterior(T, sparse.csc_array(spring * (T.T @ mean) @ (T.T @ mean).T), 1.0 / spring)


def boussinesq_displacement(r: Array, z: Array, poisson: float) -> Array:
    """Return (u_r, u_z), in W/(E* beta), in the half-space z <= 0 under a unit load pressing down at the origin.

    The points r and z, other than the origin, are in beta, and 0 <= poisson < 0.5; u_z < 0, since the load presses into
    the body. K. L. Johnson, Contact Mechanics (1985), eqs (3.18a, b).
    """
    nu, G, zeta = poisson, lame_parameters(poisson)[1], -z
    rho = np.hypot(r, zeta)
    u_r = r * zeta / rho**3 - (1.0 - 2.0 * nu) * r / (rho * (rho + zeta))
    u_zeta = 2.0 * (1.0 - nu) / rho + zeta**2 / rho**3
    return np.array([u_r, -u_zeta]) / (4.0 * np.pi * G)


def boussinesq_stress(r: Array, z: Array, poisson: float) -> Array:
    """Return the stresses (rr, zz, hoop, rz), in W/beta^2, that belong to `boussinesq_displacement`.

    Tension is positive. K. L. Johnson, Contact Mechanics (1985), eqs (3.19); the sign of rz is turned with the axis z.
    """
    nu, zeta = poisson, -z
    rho = np.hypot(r, zeta)
    surface = (1.0 - 2.0 * nu) / (rho * (rho + zeta))
    rr = surface - 3.0 * r**2 * zeta / rho**5
    zz = -3.0 * zeta**3 / rho**5
    hoop = (1.0 - 2.0 * nu) * zeta / rho**3 - surface
    rz = 3.0 * r * zeta**2 / rho**5
    return np.array([rr, zz, hoop, rz]) / (2.0 * np.pi)


def _axis_unknowns(space: Space) -> Index:
    """Return the unknowns that must vanish: u_r on the axis."""
    return np.asarray(space.components[0, space.boundary_functions("axis")], dtype=np.intp)


def _selection(space: Space, dropped: Index) -> sparse.csc_array:
    """Return the columns of the identity for all unknowns but those dropped, held by the axis or interior to a cell."""
    kept = np.ones(space.unknowns, dtype=bool)
    kept[np.concatenate([dropped, _axis_unknowns(space), space.interior_dofs])] = False
    return sparse.eye_array(space.unknowns, format="csc")[:, np.flatnonzero(kept)]
