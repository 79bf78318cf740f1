"""The elastic body: the form a on a mesh, its contact surface, and what holds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    BilinearForm,
    ElementQuad2,
    ElementQuadP,
    ElementTriP3,
    ElementTriP4,
    FacetBasis,
    MeshQuad,
    MeshTri,
)

from fem_adhesion.weak_form.settings import USUAL
from halfspace.values import Valued

Array = NDArray[np.float64]
Materials = Sequence[tuple[float, float]]
"""Poisson's ratio and E/(1 - nu^2), in E*, of each region of a body; its cells are a subdomain of the mesh."""

TRIANGLES = {3: ElementTriP3, 4: ElementTriP4}  # by the degree; the vertices of each cell ascend

# The weak form


def radial(u: Any, r: Array) -> tuple[Any, ...]:
    """Radial, vertical and hoop strain, and twice the shear strain, of the displacement (u, 0)."""
    return u.grad[0], 0, u / r, u.grad[1]


def vertical(u: Any, r: Array) -> tuple[Any, ...]:  # noqa: ARG001
    """The same strains of the displacement (0, u)."""
    return 0, u.grad[1], 0, u.grad[0]


def work(e: Any, d: Any, w: Any) -> Any:
    """Work of the stresses of the strains e in the strains d, times 2 pi r: lame tr(e) tr(d) + 2 G e : d."""
    alike = e[0] * d[0] + e[1] * d[1] + e[2] * d[2] + e[3] * d[3] / 2
    return (w.lame * sum(e[:3]) * sum(d[:3]) + 2 * w.G * alike) * 2 * np.pi * w.x[0]


def sheet(u: Any, v: Any, w: Any) -> Any:
    """Work at the edge r = L of a sliding layer that goes on as a sheet: it moves as c/r, under the tension 2 G u/L."""
    return 2 * w.G * u * v * 2 * np.pi


def elasticity(basis: Any, **moduli: Array) -> sparse.csr_array:
    """Matrix of a(u, v) = int work dr dz: all radial displacements come first, then all vertical ones."""

    def block(of_u: Callable[..., Any], of_v: Callable[..., Any]) -> Any:
        form = BilinearForm(lambda u, v, w: work(of_u(u, w.x[0]), of_v(v, w.x[0]), w))
        return form.assemble(basis, **moduli)

    mixed = block(vertical, radial)
    rows = [[block(radial, radial), mixed], [mixed.T, block(vertical, vertical)]]
    return sparse.csr_array(sparse.block_array(rows))


# The body


@dataclass(frozen=True, eq=False, repr=False)
class Body(Valued):
    """An elastic body of revolution on a mesh, with n unknowns and q points on its contact surface.

    Points beyond the mesh attract and do not yield, see `with_rigid`.

    Attributes
    ----------
    stiffness : (n, n) sparse array
        Of the form a, in E* beta.
    values : (q, n) sparse array
        u_z at the points from the unknowns.
    radii, area : (q,) array
        Of the points, in beta, and their parts of dA, see `discretise`.
    depths : (q,) array
        How deep the points are under the pole, in beta; zero at those beyond the mesh.
    rim : float
        Radius at which the mesh ends.
    """

    stiffness: sparse.csc_array
    values: sparse.csr_array
    radii: Array
    area: Array
    depths: Array
    rim: float

    @cached_property
    def _factors(self) -> Any:
        return factorise(self.stiffness)

    def displaced(self, tension: Array) -> Array:
        """Unknowns (n,) under a tension at the points: a(u, v) = int tension v_z dA for all v."""
        return np.asarray(self._factors.solve(self.forces(tension)))

    def rise(self, u: Array) -> Array:
        """u_z at the points of the surface."""
        return np.asarray(self.values @ u)

    def integral(self, density: Array) -> float:
        """Integral of a density by dA."""
        return float(self.area @ density)

    def forces(self, tension: Array) -> Array:
        """Forces (n,) of a tension on the surface: int tension v_z dA."""
        return np.asarray(self.values.T @ (self.area * tension))

    def softened(self, slope: Array) -> Any:
        """Factors of the matrix of a(u, v) + int slope u_z v_z dA."""
        return factorise(self.stiffness + self.values.T @ sparse.diags_array(self.area * slope) @ self.values)

    @property
    def yields(self) -> NDArray[np.bool_]:
        """Which of the points move with the mesh, (q,)."""
        return np.asarray(np.diff(self.values.indptr) > 0)

    def scaled(self, a: float) -> Body:
        """The same body a times as large: its stiffness grows as its size."""
        return Body(self.stiffness * a, self.values, self.radii * a, self.area * a**2, self.depths * a, self.rim * a)


def factorise(matrix: Any) -> Any:
    """Factors of a symmetric matrix without row exchanges: the pivots have the signs of its eigenvalues."""
    how: dict[str, Any] = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    return splu(sparse.csc_array(matrix), permc_spec="MMD_AT_PLUS_A", **how)


def discretise(
    mesh: Any, degree: int, materials: Materials, *, slides: bool = False, plate: bool = False, on_surface: bool = False
) -> Body:
    """Assemble a body on a mesh that names its boundaries axis, contact and far, and is held at the far one.

    The mesh is in beta, the body below its contact surface, of quadrilaterals or triangles; the materials are of its
    regions, see `Materials`. The degree of the elements is 1 or more, of triangles 3 or 4. If the body slides, the
    far boundary may move along r, and it goes on beyond the boundary edge, if there is one. On a plate the far boundary
    may move as a whole along z, on a spring of stiffness 1; that is then the last unknown. If `on_surface`, dA is the
    area of the surface itself, not that projected on the plane of the contact.
    """
    element = (
        TRIANGLES[degree]() if isinstance(mesh, MeshTri) else ElementQuad2() if degree == 2 else ElementQuadP(degree)
    )
    basis = Basis(mesh, element, intorder=2 * degree + 1)
    # The law is steeper than any polynomial: 2 p + 2 points on each facet.
    surface = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="contact", intorder=4 * degree + 3)
    lame, G = np.empty((2, mesh.nelements, 1))
    for n, (poisson, modulus) in enumerate(materials):
        cells = mesh.subdomains[str(n)] if len(materials) > 1 else slice(None)
        G[cells] = modulus * (1 - poisson) / 2  # E/(2 (1 + nu))
        lame[cells] = 2 * G[cells] * poisson / (1 - 2 * poisson)
    K = elasticity(basis, lame=lame, G=G)
    if slides and "edge" in mesh.boundaries:
        edge = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="edge", intorder=2 * degree)
        held_by = BilinearForm(sheet).assemble(edge, G=G[mesh.f2t[0, edge.find]])
        K += sparse.block_diag([held_by, sparse.csr_array(held_by.shape)])
    unknowns, far = np.arange(2 * basis.N), basis.get_dofs("far")
    held = [basis.get_dofs("axis").all(), basis.N + far.all(), *([] if slides else [far.all()])]
    T = sparse.eye_array(unknowns.size, format="csc")[:, np.setdiff1d(unknowns, np.concatenate(held))]
    if plate:  # of hierarchical functions those of the vertices alone add up to 1
        upwards = basis.N + (far.nodal["u"] if isinstance(element, ElementQuadP) else far.all())
        T = sparse.hstack([T, sparse.csc_array(np.isin(unknowns, upwards).astype(float)[:, None])])
    (radii, heights), rim = surface.global_coordinates(), float(mesh.p[0, mesh.facets[:, surface.find]].max())
    area = 2 * np.pi * radii * surface.dx * (1.0 if on_surface else surface.normals[1])
    values = sparse.csr_array(surface_values(surface) @ T)
    body = Body(sparse.csc_array(T.T @ K @ T), values, radii.ravel(), area.ravel(), -heights.ravel(), rim)
    return on_spring(body, 1.0) if plate else body


def _mapping(mesh: Any) -> Any:
    """Mapping of the mesh, inverted only as far as the rounded coordinates of thin cells allow."""
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=1e-6)
    return mapping


def surface_values(surface: Any) -> sparse.csr_array:
    """u_z at the points of a boundary basis, facet by facet, from all radial and vertical displacements."""
    functions = np.array([np.broadcast_to(one, surface.dx.shape) for (one,) in surface.basis])
    rows = np.broadcast_to(np.arange(surface.dx.size).reshape(surface.dx.shape), functions.shape)
    columns = np.broadcast_to(surface.N + surface.element_dofs[:, :, None], functions.shape)
    entries = functions.ravel(), (rows.ravel(), columns.ravel())
    values = sparse.csr_array(entries, shape=(surface.dx.size, 2 * surface.N))
    values.eliminate_zeros()
    return values


def on_spring(body: Body, stiffness: float) -> Body:
    """Add a spring under the last unknown, the plate that the body stands on."""
    K = body.stiffness + sparse.diags_array(stiffness * last(body.stiffness.shape[0]))
    return replace(body, stiffness=sparse.csc_array(K))


def on_ground(body: Body, pressure: Array, load: float, work: float) -> Body:
    """A body on a plate, on a spring with which a pressure of this load does the work that it does on a half-space."""
    missed = 1 + (work - body.integral(pressure * body.rise(body.displaced(pressure)))) / load**2
    return on_spring(body, 1 / missed - 1)


def opposed(first: Body, second: Body, share: float) -> Body:
    """Two bodies that face each other at points of the same radii, the second with this share of the compliance."""
    a, b = (np.argsort(body.radii) for body in (first, second))
    values = sparse.csr_array(sparse.hstack([first.values[a], second.values[b]]))
    stiffness = sparse.csc_array(sparse.block_diag([first.stiffness / (1 - share), second.stiffness / share]))
    return Body(stiffness, values, first.radii[a], first.area[a], first.depths[a], first.rim)


def with_rigid(body: Body, radii: Array, area: Array) -> Body:
    """Add points beyond the mesh, at radii and with parts of dA, that attract and do not yield."""
    values = sparse.vstack([body.values, sparse.csr_array((radii.size, body.values.shape[1]))])
    r, dA, depths = np.append(body.radii, radii), np.append(body.area, area), np.append(body.depths, 0 * radii)
    return replace(body, values=sparse.csr_array(values), radii=r, area=dA, depths=depths)


def to_infinity(body: Body) -> Body:
    """Let the surface go on beyond the mesh for ever: Gauss's rule in s on r = rim/s^4, where little is far away."""
    s, ds = np.polynomial.legendre.leggauss(40)
    s, ds = (1 + s) / 2, ds / 2
    r = body.rim / s**4
    return with_rigid(body, r, 2 * np.pi * r**2 * 4 * ds / s)


def last(size: int) -> Array:
    """Unit vector of the last of some unknowns."""
    return np.asarray(np.eye(1, size, size - 1)[0])


# The mesh of a half-space


def half_space(
    finest: float,
    size: float,
    degree: int,
    poisson: float,
    tip: float = np.inf,
    reach: float = 1.0,
) -> Body:
    """Box of a half-space as wide and deep as its size, whose cells grow from `finest` at radius 1 of the surface on.

    They are fine up to the radius `reach`; under a sharp tip the one on the axis is `tip` long, or less.

    It stands on a spring that yields as what is beyond would: Hertz's pressure sqrt(1 - r^2), of the load 2 pi/3, does
    the work 4 pi^2/15 on a half-space, and what it falls short of that on the box is done on the spring.
    """
    steps = growing(finest, size, USUAL.growth, USUAL.even)
    inner = 1 - steps[steps < USUAL.inner][::-1]
    core = inner[0] * USUAL.growth ** -np.arange(
        1.0, np.ceil(np.log(max(inner[0] / tip, 1.0)) / np.log(USUAL.growth)) + 1
    )
    r = fine_within(reach, np.concatenate([[0.0], core[::-1], inner, [1.0], 1 + steps]))
    mesh = box(r, growing(min(finest, tip), size, USUAL.growth))
    body = discretise(mesh, degree, [(poisson, 1.0)], plate=True)
    body = on_ground(body, np.sqrt(np.maximum(1 - body.radii**2, 0)), 2 * np.pi / 3, 4 * np.pi**2 / 15)
    return to_infinity(body)


def box(r: Array, z: Array) -> Any:
    """Mesh between radii, from 0 on, and depths beyond 0."""
    mesh = MeshQuad.init_tensor(r, np.append(-z[::-1], 0.0))
    far = {"far": lambda x: (x[0] == r[-1]) | (x[1] == -z[-1])}
    return mesh.with_boundaries({"axis": lambda x: x[0] == 0, "contact": lambda x: x[1] == 0} | far)


def growing(finest: float, size: float, growth: float, even: int = 1) -> Array:
    """Ends of cells up to a size or beyond, some equal and then growing."""
    count = even + int(np.ceil(np.log(size / finest) / np.log(growth)))
    return np.asarray(np.cumsum(finest * growth ** np.maximum(np.arange(count) - even + 1, 0)))


def fine_within(reach: float, lines: Array) -> Array:
    """Ends of cells, cut into equal parts where they are longer than a part of a distance within it."""
    counts = np.where(lines[:-1] < reach, np.ceil(np.diff(lines) / (USUAL.within * reach)), 1).astype(int)
    cells = zip(lines[:-1], lines[1:], counts, strict=True)
    return np.append(np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in cells]), lines[-1])
