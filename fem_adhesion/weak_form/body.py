"""The elastic body: the form a on a mesh, and the box of a half-space."""

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
    ElementQuadP,
    ElementTriP3,
    ElementTriP4,
    ElementVector,
    FacetBasis,
    MeshQuad,
    MeshTri,
)

from halfspace.values import Valued

Array = NDArray[np.float64]
Materials = Sequence[tuple[float, float]]
"""Poisson's ratio and E/(1 - nu^2), in E*, of each region of a body; its cells are a subdomain of the mesh."""

# The weak form


def strains(u: Any, r: Array) -> tuple[Array, Array, Array, Array]:
    """Radial, vertical and hoop strain, and twice the shear strain, of displacements at radii r."""
    (u_rr, u_rz), (u_zr, u_zz) = u.grad
    return u_rr, u_zz, u[0] / r, u_rz + u_zr


def moduli(mesh: Any, materials: Materials) -> Array:
    """Matrices D (cells, 4, 4) from strains to stresses."""
    D = np.zeros((mesh.nelements, 4, 4))
    for n, (poisson, modulus) in enumerate(materials):
        G = modulus * (1 - poisson) / 2  # E/(2 (1 + nu))
        own = np.diag([2 * G, 2 * G, 2 * G, G])
        own[:3, :3] += 2 * G * poisson / (1 - 2 * poisson)
        D[mesh.subdomains[str(n)] if len(materials) > 1 else slice(None)] = own
    return D


def elasticity(basis: Any, D: Array) -> sparse.csr_array:
    """Matrix of a(u, v) = int strains(v) D strains(u) 2 pi r dr dz: a body of revolution without twist.

    The strains of each function are formed once, times a root of D: each cell's matrix is a weighted product A A^T of
    them, whereas a form in u and v would form them anew for each pair of functions. The unknowns inside a cell, the
    last ones, on which no forces act, are eliminated in it.
    """
    r, _ = basis.global_coordinates()
    cells, functions, outer = len(r), len(basis.basis), len(basis.basis) - basis.elem.interior_dofs
    roots, weights = np.linalg.cholesky(D).transpose(0, 2, 1), 2 * np.pi * r * basis.dx
    A = np.empty((cells, functions, *roots.shape[1:2], r.shape[1]))
    for n, (function,) in enumerate(basis.basis):
        A[:, n] = roots @ np.stack(strains(function, r), axis=1)
    left, right = (part.reshape(cells, functions, -1) for part in (A * weights[:, None, None], A))
    K = left @ right.transpose(0, 2, 1)
    K = K[:, :outer, :outer] - K[:, :outer, outer:] @ np.linalg.solve(K[:, outer:, outer:], K[:, outer:, :outer])
    dofs = basis.element_dofs[:outer].T
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    size = basis.N - cells * (functions - outer)
    return sparse.coo_array((K.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()


def going_on(G: Array) -> Any:
    """What a layer on a plane without friction is held by at its edge r = L, where it goes on as a sheet.

    It moves as c/r there, which takes the tension 2 G u_r/L.
    """
    return BilinearForm(lambda u, v, _: 2 * G * u[0] * v[0] * 2 * np.pi)


# The body


@dataclass(frozen=True, eq=False, repr=False)
class Yielding(Valued):
    """How a body yields to forces.

    Attributes
    ----------
    solve : callable
        Gives the displacements (n,) under given forces.
    surface : callable
        Gives the matrix `Body.surface`.
    """

    solve: Callable[[Array], Array]
    surface: Callable[[], Array]


@dataclass(frozen=True, eq=False, repr=False)
class Body(Valued):
    """An elastic body of revolution on a mesh, with n unknowns and q points on its contact surface.

    Attributes
    ----------
    stiffness : (n, n) sparse array
        Of the form a, in E* beta.
    values : (q, n) sparse array
        u_z at the points from the unknowns.
    radii, area : (q,) array
        Of the points, in beta, and their parts of dA, see `discretise`.
    depths : (q,) array
        How deep the points are under the pole, in beta.
    rim : float
        Radius at which the surface ends.
    reaction : (n,) array
        Upward force, per unknown, of what holds the body.
    borne : (q,) array
        Part of the tension at the points that it bears directly: at the corner where the surface is held.
    known : Yielding, optional
        How it yields, where another body tells.
    """

    stiffness: sparse.csc_array
    values: sparse.csr_array
    radii: Array
    area: Array
    depths: Array
    rim: float
    reaction: Array
    borne: Array
    known: Yielding | None = None

    @cached_property
    def moving(self) -> NDArray[np.intp]:
        """Unknowns (s,) on which the points depend, and the last one, which may be a plate's."""
        return np.union1d(self.values.indices, self.reaction.size - 1)

    @cached_property
    def yielding(self) -> Yielding:
        """How it yields."""
        return self.known or factorise(self.stiffness, self.moving)

    @cached_property
    def surface(self) -> Array:
        """Matrix (s, s) from displacements of these unknowns to the forces on them, while none act on the others."""
        return self.yielding.surface()

    @cached_property
    def _on_surface(self) -> sparse.csr_array:
        """u_z at the points from the unknowns on which they depend, (q, s)."""
        return self.values[:, self.moving]

    def rise(self, u: Array) -> Array:
        """u_z at the points of the surface."""
        return np.asarray(self.values @ u)

    def integral(self, density: Array) -> float:
        """Integral of a density by dA."""
        return float(self.area @ density)

    def forces(self, tension: Array) -> Array:
        """Forces (n,) of a tension on the surface: int tension v_z dA."""
        return np.asarray(self.values.T @ (self.area * tension))

    def softened(self, slope: Array) -> Array:
        """Matrix (s, s) of a(u, v) + int slope u_z v_z dA for the surface, while no forces act on the other unknowns.

        Its determinant is that of the matrix of all unknowns over a positive number, which is the body's.
        """
        V = self._on_surface
        return np.asarray(self.surface + (V.T @ sparse.diags_array(self.area * slope) @ V).toarray())

    def softened_rise(self, matrix: Array, tension: Array) -> Array:
        """u_z at the points under a tension there, by the matrix of such a form."""
        V = self._on_surface
        return np.asarray(V @ np.linalg.solve(matrix, V.T @ (self.area * tension)))

    def scaled(self, a: float) -> Body:
        """The same body a times as large: its stiffness grows as its size."""
        points = self.values, self.radii * a, self.area * a**2, self.depths * a
        known = Yielding(lambda forces: self.yielding.solve(forces) / a, lambda: self.surface * a)
        return Body(self.stiffness * a, *points, self.rim * a, self.reaction * a, self.borne, known)


def discretise(
    mesh: Any, degree: int, materials: Materials, *, slides: bool = False, plate: bool = False, on_surface: bool = False
) -> Body:
    """Assemble a body on a mesh that names its boundaries axis, contact and far, and is held at the far one.

    The mesh is in beta, the body below its contact surface, of quadrilaterals or triangles; the materials are of its
    regions, see `Materials`. The degree of the elements is 3 or more; 4 at most of triangles. If the body slides, the
    far boundary may move along r, and it goes on beyond the boundary edge, if there is one. On a plate the far boundary
    may move as a whole along z, on a spring of stiffness 1; that is then the last unknown. If `on_surface`, dA is the
    area of the surface itself, not that projected on the plane of the contact.
    """
    triangles = isinstance(mesh, MeshTri)
    element = ElementVector(TRIANGLES[degree]() if triangles else ElementQuadP(degree))
    basis = Basis(mesh, element, intorder=2 * degree + 1)
    # The law is steeper than any polynomial: 2 p + 2 points on each facet.
    surface = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="contact", intorder=4 * degree + 3)
    axis, far = basis.get_dofs("axis").all(["u^1"]), basis.get_dofs("far")
    held = np.concatenate([axis, far.all(["u^2"] if slides else ["u^1", "u^2"])])
    D = moduli(mesh, materials)
    K = elasticity(basis, D)
    unknowns = np.arange(K.shape[0])
    T = sparse.eye_array(unknowns.size, format="csc")[:, np.setdiff1d(unknowns, held)]
    # A translation of what is held: of quadrilaterals' functions those of the vertices alone add up to 1.
    upwards = far.all(["u^2"]) if triangles else far.nodal["u^2"]
    moved = sparse.csc_array(np.isin(unknowns, upwards).astype(float)[:, None])
    T = sparse.csc_array(sparse.hstack([T, moved])) if plate else T
    if slides and "edge" in mesh.boundaries:
        edge = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="edge", intorder=2 * degree)
        K += going_on(D[mesh.f2t[0, edge.find], 3, 3][:, None]).assemble(edge)[unknowns][:, unknowns]
    reaction = 0 * last(T.shape[1]) if plate else (moved.T @ K @ T).toarray()[0]
    (radii, heights), rim = surface.global_coordinates(), float(mesh.p[0, mesh.facets[:, surface.find]].max())
    area = 2 * np.pi * radii * surface.dx * (1.0 if on_surface else surface.normals[1])
    values = surface_values(surface)[:, unknowns]
    borne = np.zeros(radii.size) if plate else (values @ moved).toarray()[:, 0]
    points = sparse.csr_array(values @ T), radii.ravel(), area.ravel(), -heights.ravel()
    body = Body(sparse.csc_array(T.T @ K @ T), *points, rim, reaction, borne)
    return on_spring(body, 1.0) if plate else body


TRIANGLES = {3: ElementTriP3, 4: ElementTriP4}  # by the degree; the vertices of each cell ascend


def _mapping(mesh: Any) -> Any:
    """Mapping of the mesh, inverted only as far as the rounded coordinates of thin cells allow."""
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=1e-6)
    return mapping


def surface_values(surface: Any) -> sparse.csr_array:
    """u_z at the points of a boundary basis of displacements, facet by facet, from all unknowns."""
    u_z = [np.asarray(function[0])[1] for function in surface.basis]
    points = np.arange(u_z[0].size).reshape(u_z[0].shape)
    places = [(points, np.broadcast_to(dofs[:, None], points.shape)) for dofs in surface.element_dofs]
    rows, columns = (np.concatenate([place[k].ravel() for place in places]) for k in (0, 1))
    entries = np.concatenate([values.ravel() for values in u_z])
    found = sparse.coo_array((entries, (rows, columns)), shape=(points.size, surface.N)).tocsr()
    found.eliminate_zeros()
    return sparse.csr_array(found)


def on_spring(body: Body, stiffness: float) -> Body:
    """Add a spring under the last unknown, the plate that the body stands on."""
    foot = last(body.reaction.size)
    K = body.stiffness + sparse.diags_array(stiffness * foot)
    return replace(body, stiffness=sparse.csc_array(K), reaction=body.reaction - stiffness * foot)


def half_space(
    finest: float, size: float, degree: int, poisson: float, tip: float = np.inf, reach: float = 1.0
) -> Body:
    """Box of a half-space as wide and deep as its size, whose cells grow from `finest` at radius 1 of the surface on.

    They are fine up to the radius `reach`; under a sharp tip the one on the axis is `tip` long, or less.

    It stands on a spring that yields as what is beyond would: Hertz's pressure sqrt(1 - r^2), of the load 2 pi/3, does
    the work 4 pi^2/15 on a half-space, and what it falls short of that on the box is done on the spring.
    """
    body = discretise(half_space_mesh(finest, size, tip, reach), degree, [(poisson, 1.0)], plate=True)
    return on_ground(body, np.sqrt(np.maximum(1 - body.radii**2, 0)), 2 * np.pi / 3, 4 * np.pi**2 / 15)


def on_ground(body: Body, pressure: Array, load: float, work: float) -> Body:
    """A body on a plate, on a spring with which a pressure of this load does the work that it does on a half-space."""
    forces, foot = body.forces(pressure), last(body.reaction.size)
    missed = 1 + (work - float(forces @ body.yielding.solve(forces))) / load**2
    spring, sunk = 1 / missed - 1, body.yielding.solve(foot)
    pushed = sunk * spring / (1 + spring * sunk[-1])  # by the spring as the plate sinks by 1: no factors anew

    def known(forces: Array) -> Array:
        u = body.yielding.solve(forces)
        return np.asarray(u - u[-1] * pushed)

    held = Yielding(known, lambda: body.surface + np.diag(spring * foot[body.moving]))
    return replace(on_spring(body, spring), known=held)


def opposed(first: Body, second: Body, share: float) -> Body:
    """Two bodies that face each other at points of the same radii, the second with this share of the compliance."""
    (a, K, by_first), (b, L, _) = (
        (np.argsort(body.radii), body.stiffness / part, body.reaction / part)
        for body, part in ((first, 1 - share), (second, share))
    )
    values = sparse.csr_array(sparse.hstack([first.values[a], second.values[b]]))
    points = values, first.radii[a], first.area[a], first.depths[a]
    stiffness = sparse.csc_array(sparse.block_diag([K, L]))
    return Body(stiffness, *points, first.rim, np.append(by_first, 0 * second.reaction), first.borne[a])


def last(size: int) -> Array:
    """Unit vector of the last of some unknowns."""
    return np.asarray(np.eye(1, size, size - 1)[0])


def factorise(matrix: sparse.csc_array, surface: NDArray[np.intp]) -> Yielding:
    """Factors L U of a positive definite matrix, and what it leaves for the unknowns of a surface."""
    how: dict[str, Any] = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factors, count = splu(matrix, permc_spec="MMD_AT_PLUS_A", **how), surface.size

    def left() -> Array:
        """What is left for the surface when all others are eliminated: with it at the end, L U of it alone."""
        few = np.argsort(factors.perm_c)
        order = np.append(few[~np.isin(few, surface)], surface)
        last = splu(sparse.csc_array(matrix[order][:, order]), permc_spec="NATURAL", **how)
        return np.asarray((last.L[-count:, -count:] @ last.U[-count:, -count:]).toarray())

    return Yielding(factors.solve, left)


# The mesh


def half_space_mesh(finest: float, size: float, tip: float = np.inf, reach: float = 1.0) -> Any:
    """Mesh of that box."""
    r_steps, z_steps = _graded(finest, size, EVEN), _graded(min(finest, tip), size, 1)
    inner = 1 - r_steps[r_steps < INNER][::-1]
    core = inner[0] * GROWTH ** -np.arange(1.0, np.ceil(np.log(max(inner[0] / tip, 1.0)) / np.log(GROWTH)) + 1)
    r = fine_within(reach, np.concatenate([[0.0], core[::-1], inner, [1.0], 1 + r_steps]))
    mesh = MeshQuad.init_tensor(r, np.append(-z_steps[::-1], 0.0))
    far = {"far": lambda x: (x[0] == r[-1]) | (x[1] == -z_steps[-1])}
    return mesh.with_boundaries({"axis": lambda x: x[0] == 0, "contact": lambda x: x[1] == 0} | far)


def fine_within(reach: float, lines: Array) -> Array:
    """Ends of cells, cut into equal parts where they are longer than a part of a distance within it."""
    counts = np.where(lines[:-1] < reach, np.ceil(np.diff(lines) / (WITHIN * reach)), 1).astype(int)
    cells = zip(lines[:-1], lines[1:], counts, strict=True)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in cells]
    return np.concatenate([*parts, lines[-1:]])


def _graded(finest: float, size: float, even: int) -> Array:
    """Ends of cells, some equal and then growing."""
    count = even + int(np.ceil(np.log(size / finest) / np.log(GROWTH)))
    return np.asarray(np.cumsum(finest * GROWTH ** np.maximum(np.arange(count) - even + 1, 0)))


# Found by trial, as FLAT and NEARBY below: see tests/estimates/constants.py.
EVEN, GROWTH, INNER = 3, 3.0, 0.7  # cells next to the edge, ratio of the others, and how far they go inwards
WITHIN = 0.3  # of the reach of the attraction, the longest cells in it
