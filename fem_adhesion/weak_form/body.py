"""The elastic body: the form a on a mesh, its contact surface, and what holds it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import skfem
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from halfspace.values import Valued

Array = NDArray[np.float64]
Materials = Sequence[tuple[float, float]]
"""Poisson's ratio and E/(1 - nu^2), in E*, of each region of a body; its cells are a subdomain of the mesh."""

TRIANGLES = {3: skfem.ElementTriP3, 4: skfem.ElementTriP4}  # by the degree; the vertices of each cell ascend

# The weak form


def strain(u: Any, r: Array) -> tuple[Array, Array, Array, Array]:
    """Radial, vertical and hoop strain, and twice the shear strain."""
    (u_rr, u_rz), (u_zr, u_zz) = u.grad
    return u_rr, u_zz, u[0] / r, u_rz + u_zr


def elasticity(u: Any, v: Any, w: Any) -> Any:
    """Integrand of a(u, v): stresses of u by strains of v, times 2 pi r."""
    r, G = w.x[0], w.G
    e, d = strain(u, r), strain(v, r)
    normal = w.lame * (e[0] + e[1] + e[2]) * (d[0] + d[1] + d[2]) + 2 * G * (e[0] * d[0] + e[1] * d[1] + e[2] * d[2])
    return (normal + G * e[3] * d[3]) * 2 * np.pi * r


def sheet(u: Any, v: Any, w: Any) -> Any:
    """Work at the edge r = L of a sliding layer that goes on as a sheet: it moves as c/r, under the tension 2 G u/L."""
    return 2 * w.G * u[0] * v[0] * 2 * np.pi


# The body


@dataclass(frozen=True, eq=False, repr=False)
class Body(Valued):
    """An elastic body of revolution on a mesh, with n unknowns and q points on its contact surface.

    Attributes
    ----------
    stiffness : (n, n) sparse array
        Of the form a, in E* beta.
    values : (q, n) sparse array
        u_z at the points from the unknowns; points beyond the mesh do not yield.
    radii, area : (q,) array
        Of the points, in beta, and their parts of dA, see `discretise`.
    depths : (q,) array
        How deep the points are under the pole, in beta.
    rim : float
        Radius at which the mesh ends.
    """

    stiffness: sparse.csc_array
    values: sparse.csr_array
    radii: Array
    area: Array
    depths: Array
    rim: float

    def rise(self, u: Array) -> Array:
        """u_z at the points of the surface."""
        return np.asarray(self.values @ u)

    def integral(self, density: Array) -> float:
        """Integral of a density by dA."""
        return float(self.area @ density)

    def forces(self, tension: Array) -> Array:
        """Forces (n,) of a tension on the surface: int tension v_z dA."""
        return np.asarray(self.values.T @ (self.area * tension))

    def factors(self, slope: Array) -> Any:
        """Factors of a(u, v) + int slope u_z v_z dA, whose pivots have the signs of its eigenvalues."""
        matrix = self.stiffness + self.values.T @ sparse.diags_array(self.area * slope) @ self.values
        symmetric: dict[str, Any] = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return splu(sparse.csc_array(matrix), permc_spec="MMD_AT_PLUS_A", **symmetric)

    @property
    def yields(self) -> NDArray[np.bool_]:
        """Which of the points move with the mesh, (q,)."""
        return np.asarray(np.diff(self.values.indptr) > 0)


def discretise(
    mesh: Any, degree: int, materials: Materials, *, slides: bool = False, plate: bool = False, on_surface: bool = False
) -> Body:
    """Assemble a body on a mesh that names its boundaries axis, contact and far, and is held at the far one.

    The mesh is in beta, the body below its contact surface, of quadrilaterals or triangles; the materials are of its
    regions, see `Materials`. The degree of the elements is 2 or more, of triangles 3 or 4. If the body slides, the
    far boundary may move along r, and it goes on beyond the boundary edge, if there is one. On a plate the far boundary
    of quadrilaterals may move as a whole along z, on a spring of stiffness 1; that is then the last unknown. If
    `on_surface`, dA is the area of the surface itself, not that projected on the plane of the contact.
    """
    square = skfem.ElementQuad2() if degree == 2 else skfem.ElementQuadP(degree)
    element = skfem.ElementVector(TRIANGLES[degree]() if isinstance(mesh, skfem.MeshTri) else square)
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=1e-6)  # as far as the rounded coordinates of thin cells allow
    basis = skfem.Basis(mesh, element, mapping=mapping, intorder=2 * degree + 1)
    lame, G = np.empty((2, mesh.nelements, 1))
    for n, (poisson, modulus) in enumerate(materials):
        cells = mesh.subdomains[str(n)] if len(materials) > 1 else slice(None)
        G[cells] = modulus * (1 - poisson) / 2  # E/(2 (1 + nu))
        lame[cells] = 2 * G[cells] * poisson / (1 - 2 * poisson)
    K = skfem.BilinearForm(elasticity).assemble(basis, lame=lame, G=G)
    if slides and "edge" in mesh.boundaries:
        edge = skfem.FacetBasis(mesh, element, mapping=mapping, facets="edge", intorder=2 * degree)
        K += skfem.BilinearForm(sheet).assemble(edge, G=G[mesh.f2t[0, edge.find]])

    # T makes all displacements of those that are not held.
    axis, far, every = basis.get_dofs("axis"), basis.get_dofs("far"), np.arange(basis.N)
    T = sparse.eye_array(basis.N, format="csc")
    T = T[:, np.setdiff1d(every, np.append(axis.all("u^1"), far.all("u^2" if slides else ["u^1", "u^2"])))]
    if plate:  # of hierarchical functions those of the vertices alone add up to 1
        upwards = far.all("u^2") if degree == 2 else far.nodal["u^2"]
        T = sparse.hstack([T, sparse.csc_array(np.isin(every, upwards).astype(float)[:, None])])
    stiffness = sparse.csc_array(T.T @ K @ T)
    if plate:
        stiffness[-1, -1] += 1.0

    # The law is steeper than any polynomial: 2 p + 2 points on each facet.
    surface = skfem.FacetBasis(mesh, element, mapping=mapping, facets="contact", intorder=4 * degree + 3)
    functions = np.array([function[1] for (function,) in surface.basis])  # u_z of each at the points, facet by facet
    rows = np.broadcast_to(np.arange(surface.dx.size).reshape(surface.dx.shape), functions.shape)
    columns = np.broadcast_to(surface.element_dofs[:, :, None], functions.shape)
    used = functions != 0
    entries = functions[used], (rows[used], columns[used])
    values = sparse.csr_array(sparse.csr_array(entries, shape=(surface.dx.size, basis.N)) @ T)

    (radii, heights), rim = surface.global_coordinates(), float(mesh.p[0, mesh.facets[:, surface.find]].max())
    area = 2 * np.pi * radii * surface.dx * (1.0 if on_surface else surface.normals[1])
    return Body(stiffness, values, radii.ravel(), area.ravel(), -heights.ravel(), rim)


def box(r: Array, z: Array) -> Any:
    """Mesh between radii, from 0 on, and depths beyond 0."""
    mesh = skfem.MeshQuad.init_tensor(r, np.append(-z[::-1], 0.0))
    far = {"far": lambda x: (x[0] == r[-1]) | (x[1] == -z[-1])}
    return mesh.with_boundaries({"axis": lambda x: x[0] == 0, "contact": lambda x: x[1] == 0} | far)
