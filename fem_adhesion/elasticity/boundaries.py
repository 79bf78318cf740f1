"""Boundaries of a mesh: Gauss's points on a named one and the functions there, and what holds the far one.

That is a clamp, a plane without friction, what goes on beyond, or nothing: each a linear map u = T x from the reduced
unknowns x to all of them and a stiffness S on x, so that the body's stiffness K becomes T' K T + S. T also imposes
u_r = 0 on the axis, and leaves out the unknowns interior to a cell, which are eliminated before.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem.refdom import RefLine

from fem_adhesion.elasticity.reference import quadrature, reference_functions
from fem_adhesion.elasticity.space import Space, lame_parameters, ring_measure
from fem_adhesion.materials import Elastic
from halfspace.values import Array, Index, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Trace(Valued):
    """Gauss's points of a named boundary, k on each of its facets, outwards, and the scalar functions there.

    Places and normals (2, facets, k) are r and z of the points, and of the outward normal there; lengths (facets, k)
    are the weights of the length along the boundary, and the ends (facets + 1,) radii of the facets' ends. Of the
    functions (m,), those that do not vanish on it, ascending, the values (q, m) are at all q = facets k points. Of the
    n functions of each facet's cell, whose numbers are (n, facets), the derivatives (n, facets, k) are by the arclength
    along (n_z, -n_r): on the contact surface, whose normal is upwards at the pole, that is outwards from it.
    """

    places: Array
    normals: Array
    lengths: Array
    ends: Array
    functions: Index
    values: sparse.csr_array
    cell_functions: Index
    derivatives: Array

    @property
    def rates(self) -> sparse.csr_array:
        """Derivatives of the functions at the points, (q, m)."""
        return _rows(self.derivatives, self.cell_functions, self.functions)

    @property
    def radii(self) -> Array:
        """Of the points in beta, (q,); ascending on the contact surface."""
        return np.asarray(self.places[0].ravel())

    @property
    def depths(self) -> Array:
        """Of the points under z = 0, in beta, (q,)."""
        return np.asarray(-self.places[1].ravel())

    @property
    def slopes(self) -> Array:
        """Derivative of the depth by the radius, (q,)."""
        n_r, n_z = self.normals
        return np.asarray((n_r / n_z).ravel())

    @property
    def facet_points(self) -> Index:
        """Points of each facet, (facets, k)."""
        return np.arange(self.lengths.size).reshape(self.lengths.shape)

    def weights(self, traction: str = "projected") -> Array:
        """Of 2 pi r dr, or of the area of the boundary itself with the traction "surface", in beta^2, (q,)."""
        lengths = self.lengths if traction == "surface" else self.normals[1] * self.lengths
        return ring_measure(self.radii) * lengths.ravel()


def trace_on(space: Space, name: str, points: int) -> Trace:
    """Evaluate a space at so many Gauss points on each facet of a named boundary."""
    mesh, functions = space.mesh, space.boundary_functions(name)
    facets = mesh.boundaries[name]
    facets = facets[np.argsort(mesh.p[0, mesh.facets[:, facets]].min(axis=0), kind="stable")]
    cells, (X, weights) = mesh.f2t[0, facets], quadrature(RefLine, 2 * points - 1)
    corners = mesh.facets[:, facets]
    corners = np.take_along_axis(corners, np.argsort(mesh.p[0, corners], axis=0, kind="stable"), axis=0)
    ends = [np.argmax(mesh.t[:, cells] == vertex, axis=0) for vertex in corners]
    places, normals = np.empty((2, 2, cells.size, points))
    lengths = np.empty((cells.size, points))
    values, rates = np.empty((2, len(space.scalar_dofs.element_dofs), *lengths.shape))
    for side in np.unique(ends, axis=1).T:  # all facets between the same corners at once
        alike = np.all(np.transpose(ends) == side, axis=1)
        Y, along, outwards = _side(space.element.refdom.p, side[0], side[1], X[0])
        J = np.asarray(mesh.mapping().DF(Y, tind=cells[alike]))
        tangents = np.einsum("ijfk,j->ifk", J, along)
        lengths[alike] = np.hypot(*tangents)
        turned = outwards * np.sign(J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0])
        normals[:, alike] = turned * np.array([tangents[1], -tangents[0]]) / lengths[alike]
        places[:, alike] = mesh.mapping().F(Y, tind=cells[alike])
        value, slopes = reference_functions(space.element, Y)
        values[:, alike] = value[:, None]
        rates[:, alike] = np.einsum("nik,i->nk", slopes, along)[:, None] * -turned / lengths[alike]
    dofs = np.asarray(space.scalar_dofs.element_dofs)[:, cells]
    radii, values = np.sort(mesh.p[0, np.unique(corners)]), _rows(values, dofs, functions)
    return Trace(places, normals, lengths * weights, radii, functions, values, dofs, rates)


def _side(corners: Array, first: int, second: int, X: Array) -> tuple[Array, Array, float]:
    """Points of the reference cell on a side, its direction, and 1 if outwards is to the right of that, -1 if not."""
    along, inwards = corners[:, second] - corners[:, first], corners.mean(axis=1) - corners[:, first]
    Y = corners[:, first, None] + along[:, None] * X
    return Y, along, float(np.sign(along[0] * inwards[1] - along[1] * inwards[0]))


def _rows(values: Array, dofs: Index, functions: Index) -> sparse.csr_array:
    """Rows of the values (n, facets, k) of the unknowns dofs (n, facets), for some functions."""
    k, found = values.shape[2], np.isin(dofs, functions)
    columns = np.broadcast_to(np.searchsorted(functions, dofs)[:, :, None], values.shape)
    rows = np.broadcast_to(np.arange(values[0].size).reshape(-1, k), values.shape)
    entries = values[found].ravel(), (rows[found].ravel(), columns[found].ravel())
    return sparse.csr_array(entries, shape=(values[0].size, len(functions)))


# What holds the far boundary


TRACE_POINTS = 6
"""Gauss points on a facet beyond the degree p where a smooth field that is no polynomial is integrated."""


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


def made_of(far_field: FarField, material: Elastic) -> FarField:
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
    T = sparse.block_diag([sparse.hstack([_unit_columns(space, inner), exterior.reduction]), sparse.eye_array(more)])
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
    far = trace_on(space, "far", space.degree + TRACE_POINTS)
    unknowns = space.components[:, far.functions].ravel()
    u_B = trace_projection(far, lambda r, z: boussinesq_displacement(r, z, poisson)).ravel()
    u_B[np.isin(unknowns, _axis_unknowns(space))] = 0.0

    column = sparse.csc_array((u_B, (unknowns, 0 * unknowns)), shape=(space.unknowns, 1))
    T = sparse.csc_array(sparse.hstack([_selection(space, dropped=unknowns), column]))
    n = T.shape[1]
    return Exterior(T, sparse.csc_array(([exterior_stiffness(far, poisson)], ([n - 1], [n - 1])), shape=(n, n)))


def exterior_stiffness(far: Trace, poisson: float) -> float:
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
    far = trace_on(space, "far", space.degree + 1)
    r = far.places[0]
    area = (ring_measure(r) * far.lengths).ravel()
    parts = far.values.T @ area / np.sum(area)
    mean = sparse.csc_array((parts, (space.components[1, far.functions], 0 * far.functions)), shape=(space.unknowns, 1))
    T = _selection(space, dropped=np.array([], dtype=np.intp))
    spring = float(np.max(r))  # of the order of the block's own stiffness E* L
    return Exterior(T, sparse.csc_array(spring * (T.T @ mean) @ (T.T @ mean).T), 1.0 / spring)


def trace_projection(trace: Trace, field: Callable[[Array, Array], Array]) -> Array:
    """Return the coefficients (2, m), u_r first, of the best approximation to a vector field on a boundary.

    field(r, z) returns its components (2, ...) at the given points, of which the trace, of m functions, has enough for
    it.
    """
    weighted = trace.values.T * trace.lengths.ravel()
    values = field(*trace.places).reshape(2, -1)
    coefficients: Array = splu(sparse.csc_array(weighted @ trace.values)).solve(weighted @ values.T).T
    return coefficients


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
    unknowns: Index = space.components[0, space.boundary_functions("axis")]
    return unknowns


def _selection(space: Space, dropped: Index) -> sparse.csc_array:
    """Return the columns of the identity for all unknowns but those dropped, held by the axis or interior to a cell."""
    kept = np.ones(space.unknowns, dtype=bool)
    kept[np.concatenate([dropped, _axis_unknowns(space), space.interior_dofs])] = False
    return _unit_columns(space, np.flatnonzero(kept))


def _unit_columns(space: Space, rows: Index) -> sparse.csc_array:
    """Return one column for each of the given unknowns, with a 1 in its row."""
    return sparse.csc_array((np.ones(len(rows)), (rows, np.arange(len(rows)))), shape=(space.unknowns, len(rows)))
