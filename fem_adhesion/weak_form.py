"""The contact problem as a textbook writes it: a law, a profile, a weak form, Newton's method and a determinant.

It checks the solvers, so it shares nothing with them: it imports NumPy, SciPy and scikit-fem alone, save an exception
and how results are shown, forms every integral by scikit-fem's quadrature, keeps every displacement among its unknowns,
condenses nothing, and has no far field but a clamp so far away that what it leaves out is small. Clarity comes first:
it is right to 1e-3.

Displacements u = (u_r, u_z) are in beta^2/R = mu eps, radii in beta, the gap h and the approach alpha in eps, E* = 1.
The potential energy over mu, with the elastic form a, the energy w(h) of the surfaces per area and 2 pi r dr = dA,

    a(u, u)/2 + int w(h) dA,        h = 1 - alpha + mu (z(r) - u_z),

is stationary in u where, for all v, with w' = sigma the tension,

    a(u, v) - mu int sigma(h) v_z dA = 0;        tangent:  a(u, v) + mu^2 int sigma'(h) u_z v_z dA.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components
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

from halfspace.errors import NotConverged
from halfspace.values import Valued

Array = NDArray[np.float64]
Heights = Callable[[Array], Array]

# The law


@dataclass(frozen=True)
class Law:
    """A law of the tension between two surfaces, by its potential alone; what else it is are differences of that.

    Attributes
    ----------
    potential : callable
        w = -int_h^inf sigma in dgamma at gaps h in eps; the attraction of two bodies does the work -w(1) = 1.
    grain : float
        Part of a gap over which the tension varies: (sigma'(1))^(-1/2).
    room : float
        Gap in eps that counts as one at least: surfaces without a core may come closer than none.
    """

    potential: Callable[[Array], Array]
    grain: float = 0.25
    room: float = 0.0

    def size(self, h: Array) -> Array:
        """Size by which changes of a gap are measured; a start may have surfaces that overlap."""
        return np.maximum(np.abs(h), max(self.room, CLOSEST))

    def tension(self, h: Array) -> Array:
        """Return sigma = dw/dh in dgamma/eps."""
        return self._difference(h, FIRST, 1)

    def slope(self, h: Array) -> Array:
        """Return sigma' in dgamma/eps^2."""
        return self._difference(h, SECOND, 2)

    def _difference(self, h: Array, weights: Array, order: int) -> Array:
        """Difference of eighth order at steps that are small beside both the gap and what the tension varies over."""
        d = STEP * self.grain * self.size(h)
        places = np.arange(-(weights.size // 2), weights.size // 2 + 1)
        return np.asarray(sum(w * self.potential(h + n * d) for n, w in zip(places, weights, strict=True)) / d**order)


STEP, CLOSEST = 4e-3, 1e-6  # of a gap and its grain; the least gap in eps that counts as one
FIRST = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / 840
SECOND = np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / 5040


def lennard_jones(h: Array) -> Array:
    """Potential of the 3-9 law."""
    return 8 / 3 * (h**-8 / 8 - h**-2 / 2)


LENNARD_JONES = Law(lennard_jones)


# The profile


def paraboloid(r: Array) -> Array:
    """Height z of the undeformed surface over its pole in beta^2/R, at radii in beta."""
    return r**2 / 2


def sphere(r: Array, R: float) -> Array:
    """The same of a sphere of radius R (beta): R (R - sqrt(R^2 - r^2))."""
    return np.asarray(r**2 / (1 + np.sqrt((1 - r / R) * (1 + r / R))))


# The weak form


def strains(u: Any, r: Array) -> tuple[Array, Array, Array, Array]:
    """Radial, vertical and hoop strain, and twice the shear strain, of displacements at radii r."""
    (u_rr, u_rz), (u_zr, u_zz) = u.grad
    return u_rr, u_zz, u[0] / r, u_rz + u_zr


def elasticity(poisson: float) -> Any:
    """a(u, v) of a body of revolution without twist, whose hoop strain is u_r/r."""
    G = shear_modulus(poisson)
    lam = 2 * G * poisson / (1 - 2 * poisson)

    def form(u: Any, v: Any, w: Any) -> Any:
        r = w.x[0]
        (u_r, u_z, hoop_u, shear_u), (v_r, v_z, hoop_v, shear_v) = strains(u, r), strains(v, r)
        dilatations = (u_r + u_z + hoop_u) * (v_r + v_z + hoop_v)
        normal = u_r * v_r + u_z * v_z + hoop_u * hoop_v
        return (lam * dilatations + 2 * G * normal + G * shear_u * shear_v) * 2 * np.pi * r

    return BilinearForm(form)


def going_on(poisson: float) -> Any:
    """What a layer on a plane without friction is held by at its edge r = L, where it goes on as a sheet.

    It moves as c/r there, which takes the tension 2 G u_r/L.
    """
    return BilinearForm(lambda u, v, _: 2 * shear_modulus(poisson) * u[0] * v[0] * 2 * np.pi)


def shear_modulus(poisson: float) -> float:
    """G = E/(2 (1 + nu)), where E* = E/(1 - nu^2) = 1."""
    return (1 - poisson) / 2


# The body


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
        Of the points, in beta, and their parts of dA, projected on the plane of the contact.
    depths : (q,) array
        How deep the points are under the pole, in beta.
    rim : float
        Radius at which the surface ends.
    reaction : (n,) array
        Upward force, per unknown, of what holds the body.
    borne : (q,) array
        Part of the tension at the points that it bears directly: at the corner where the surface is held.
    model, size : Body, float
        The body that this one is so many times as large as, if it is.
    """

    stiffness: sparse.csc_array
    values: sparse.csr_array
    radii: Array
    area: Array
    depths: Array
    rim: float
    reaction: Array
    borne: Array
    model: Body | None = None
    size: float = 1.0

    @cached_property
    def factors(self) -> Any:
        """Of the stiffness."""
        return factorise(self.stiffness)

    def yielding(self, forces: Array) -> Array:
        """Displacements (n,) under given forces."""
        return np.asarray((self.model or self).factors.solve(forces) / self.size)

    def rise(self, u: Array) -> Array:
        """u_z at the points of the surface."""
        return np.asarray(self.values @ u)

    def integral(self, density: Array) -> float:
        """Integral of a density by dA."""
        return float(self.area @ density)

    def forces(self, tension: Array) -> Array:
        """Forces (n,) of a tension on the surface: int tension v_z dA."""
        return np.asarray(self.values.T @ (self.area * tension))

    def softened(self, slope: Array) -> sparse.csc_array:
        """Matrix (n, n) of a(u, v) + int slope u_z v_z dA."""
        return sparse.csc_array(self.stiffness + self.values.T @ sparse.diags_array(self.area * slope) @ self.values)

    def scaled(self, a: float) -> Body:
        """The same body a times as large: its stiffness grows as its size."""
        points = self.values, self.radii * a, self.area * a**2, self.depths * a
        return Body(self.stiffness * a, *points, self.rim * a, self.reaction * a, self.borne, self, a)


def discretise(
    mesh: Any, degree: int, poisson: float, *, slides: bool = False, plate: bool = False, on_surface: bool = False
) -> Body:
    """Assemble a body on a mesh that names its boundaries axis, contact and far, and is held at the far one.

    Parameters
    ----------
    mesh : skfem.Mesh
        In beta, the body below its contact surface, of quadrilaterals or triangles. If it slides, it goes on beyond
        the boundary edge, if there is one.
    degree : int
        Of the elements, 3 or more; 4 at most of triangles.
    poisson : float
        Poisson's ratio.
    slides : bool
        Whether the far boundary may move along r.
    plate : bool
        Whether it may move as a whole along z, on a spring of stiffness 1; that is then the last unknown.
    on_surface : bool
        Whether dA is the area of the surface itself, not that projected on the plane of the contact.
    """
    triangles = isinstance(mesh, MeshTri)
    element = ElementVector(TRIANGLES[degree]() if triangles else ElementQuadP(degree))
    basis = Basis(mesh, element, intorder=2 * degree + 1)
    # The law is steeper than any polynomial: 2 p + 2 points on each facet.
    surface = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="contact", intorder=4 * degree + 3)
    axis, far = basis.get_dofs("axis").all(["u^1"]), basis.get_dofs("far")
    held = np.concatenate([axis, far.all(["u^2"] if slides else ["u^1", "u^2"])])
    T = sparse.eye_array(basis.N, format="csc")[:, np.setdiff1d(np.arange(basis.N), held)]
    # A translation of what is held: of quadrilaterals' functions those of the vertices alone add up to 1.
    upwards = far.all(["u^2"]) if triangles else far.nodal["u^2"]
    moved = sparse.csc_array(np.isin(np.arange(basis.N), upwards).astype(float)[:, None])
    T = sparse.csc_array(sparse.hstack([T, moved])) if plate else T
    K = sparse.csr_array(elasticity(poisson).assemble(basis))
    if slides and "edge" in mesh.boundaries:
        edge = FacetBasis(mesh, element, mapping=_mapping(mesh), facets="edge", intorder=2 * degree)
        K += going_on(poisson).assemble(edge)
    reaction = 0 * last(T.shape[1]) if plate else (moved.T @ K @ T).toarray()[0]
    (radii, heights), rim = surface.global_coordinates(), float(mesh.p[0, mesh.facets[:, surface.find]].max())
    area = 2 * np.pi * radii * surface.dx * (1.0 if on_surface else surface.normals[1])
    values = surface_values(surface)
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
    body = discretise(half_space_mesh(finest, size, tip, reach), degree, poisson, plate=True)
    return on_ground(body, np.sqrt(np.maximum(1 - body.radii**2, 0)), 2 * np.pi / 3, 4 * np.pi**2 / 15)


def on_ground(body: Body, pressure: Array, load: float, work: float) -> Body:
    """A body on a plate, on a spring with which a pressure of this load does the work that it does on a half-space."""
    forces = body.forces(pressure)
    missed = 1 + (work - float(forces @ body.yielding(forces))) / load**2
    return on_spring(body, 1 / missed - 1)


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


# Found by trial, as FLAT and NEARBY below: see tests/constants.py for what each decides at half and at double.
EVEN, GROWTH, INNER = 3, 3.0, 0.7  # cells next to the edge, ratio of the others, and how far they go inwards
WITHIN = 0.3  # of the reach of the attraction, the longest cells in it


# Newton's method

POINTS, FAR = 40, 4  # of the rule from the rim to infinity, and the power by which they crowd there


@dataclass(frozen=True, eq=False, repr=False)
class Contact(Valued):
    """A body under a rigid surface that attracts it.

    Attributes
    ----------
    body : Body
        In beta.
    tabor : float
        Tabor parameter mu.
    heights : callable
        z of the undeformed surface at radii in beta.
    endless : bool
        Whether the surfaces go on for ever beyond the mesh, as over a half-space.
    rim : pair of (k,) arrays
        Radii and parts of dA of points beyond the mesh of a body with an end that attract and do not yield.
    law : Law
        Of the tension between the surfaces.
    """

    body: Body
    tabor: float
    heights: Heights = paraboloid
    endless: bool = True
    rim: tuple[Array, Array] = (np.empty(0), np.empty(0))
    law: Law = LENNARD_JONES

    @property
    def sharpness(self) -> float:
        """Tabor parameter of a contact by the 3-9 law whose edge is as sharp."""
        return self.tabor * LENNARD_JONES.grain / self.law.grain

    @cached_property
    def height(self) -> Array:
        """Height z at the points."""
        return self.heights(self.body.radii)

    @cached_property
    def rigid(self) -> tuple[Array, Array]:
        """Radii and parts of dA of the points beyond the mesh; those on to infinity crowd there, where little is."""
        if not self.endless:
            return self.rim
        s, ds = np.polynomial.legendre.leggauss(POINTS)
        s, ds = (1 + s) / 2, ds / 2
        r = self.body.rim / s**FAR
        return r, 2 * np.pi * r**2 * FAR * ds / s

    def gap(self, u: Array | None, approach: float) -> Array:
        """Gap h at the points under displacements u, or of the undeformed surfaces."""
        return np.asarray(1 - approach + self.tabor * (self.height - (0.0 if u is None else self.body.rise(u))))

    @cached_property
    def _far_height(self) -> Array:
        """Height z at the rigid points."""
        r = self.rigid[0]
        return self.heights(r) if r.size else r

    def _beyond(self, approach: float) -> Array:
        """Gaps at the rigid points."""
        return np.asarray(1 - approach + self.tabor * self._far_height)

    def load(self, tension: Array, approach: float) -> float:
        """W in R dgamma, positive in compression, of the tension at the points."""
        return -self.tabor * self.body.integral(tension) + self.load_beyond(approach)

    def load_beyond(self, approach: float) -> float:
        """Part of the load that is beyond the mesh."""
        return -self.tabor * float(self.rigid[1] @ self.law.tension(self._beyond(approach)))

    def load_slope(self, rate: Array, approach: float) -> float:
        """dW/dalpha in R dgamma/eps of the rate -dsigma/dalpha."""
        rigid = self.rigid[1] @ self.law.slope(self._beyond(approach))
        return self.tabor * (self.body.integral(rate) + float(rigid))

    def displacement(self, h: Array) -> Array:
        """What the tensions of given gaps make of the body, whether or not it leaves those gaps."""
        return np.asarray(self.body.yielding(self.tabor * self.body.forces(self.law.tension(h))))

    def energy(self, u: Array, approach: float) -> float:
        """Potential energy in R dgamma eps, less that of the undeformed surfaces in touch, which may be infinite."""
        inside = float(u @ (self.body.stiffness @ u)) / 2
        inside += self.body.integral(self._released(self.gap(u, approach), self.height))
        return self.tabor * (inside + float(self.rigid[1] @ self._released(self._beyond(approach), self._far_height)))

    def _released(self, h: Array, height: Array) -> Array:
        """Potential per dA at gaps h less that of the undeformed surfaces in touch."""
        return np.asarray(self.law.potential(h) - self.law.potential(1 + self.tabor * height))

    def far_reaction(self, u: Array, h: Array) -> float:
        """Upward force of what holds the body, displaced by the tensions of given gaps: their load, in equilibrium."""
        return float(self.body.reaction @ u) - self.tabor * self.body.integral(self.body.borne * self.law.tension(h))


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Valued):
    """A state of equilibrium.

    Attributes
    ----------
    gap, approach, load
        h at the points and alpha in eps, W in R dgamma.
    gap_rate, stiffness
        dh/dalpha, and dW/dalpha in R dgamma/eps, along the equilibria.
    sign, log : float
        Of the tangent's determinant, and the logarithm of its magnitude.
    """

    gap: Array
    approach: float
    load: float
    gap_rate: Array
    stiffness: float
    sign: float
    log: float


MOST_STEPS, NEAR = 20, 1e-5  # relative change of the gaps by the last step; the next would be its square


def newton(contact: Contact, h: Array, approach: float, *, load: float | None = None) -> Equilibrium:
    """Solve for the equilibrium at an approach, or at a load if one is given, from gaps nearby.

    Each step solves the problem with the law's straight line, sigma(h) + sigma' (h_new - h), in the place of the law.

    Raises
    ------
    NotConverged
        If the steps run out.
    """
    body, mu, law = contact.body, contact.tabor, contact.law
    for _ in range(MOST_STEPS):
        slope, size = law.slope(h), law.size(h)
        factors = factorise(body.softened(mu**2 * slope))
        straight = law.tension(h) + slope * (contact.gap(None, approach) - h)
        u, rate = (factors.solve(mu * body.forces(line)) for line in (straight, -slope))  # rate is du/dalpha
        change, gap_rate = contact.gap(u, approach) - h, -1 - mu * body.rise(rate)
        stiffness = contact.load_slope(slope * -gap_rate, approach)
        missing = 0.0 if load is None else load - contact.load(law.tension(h) + slope * change, approach)
        d = missing / stiffness
        change += d * gap_rate
        part = min(1.0, 0.75 / max(float((-change / size).max()), 0.75))  # lest the surfaces pass through each other
        h, approach = h + part * change, approach + part * d
        if part == 1 and np.abs(change / size).max() < NEAR:
            found = contact.load(law.tension(h), approach)
            return Equilibrium(h, approach, found, gap_rate, stiffness, *determinant(factors))
    raise NotConverged(f"no equilibrium in {MOST_STEPS} Newton steps of the weak form; try a nearer start")


# The determinant


def factorise(matrix: Any) -> Any:
    """Factors L U of a symmetric sparse matrix, with pivots off the diagonal only where those on it are tiny."""
    options = {"SymmetricMode": True}
    return splu(sparse.csc_array(matrix), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options=options)


def determinant(factors: Any) -> tuple[float, float]:
    """Sign of a determinant, and the logarithm of its magnitude, from the factors L U of the permuted matrix."""
    pivots = factors.U.diagonal()
    sign = np.prod(np.sign(pivots)) * _parity(factors.perm_r) * _parity(factors.perm_c)
    return float(sign), float(np.log(np.abs(pivots)).sum())


def _parity(permutation: NDArray[np.int32]) -> int:
    """1 if a permutation is an even number of exchanges, -1 if odd: it has as many as it is short of cycles."""
    size = permutation.size
    links = sparse.csr_array((np.ones(size), (np.arange(size), permutation)), shape=(size, size))
    cycles, _ = connected_components(links)
    return 1 if (size - int(cycles)) % 2 == 0 else -1


# Turning points


@dataclass(frozen=True)
class Turn:
    """Where a determinant changes its sign: load in R dgamma, approach in eps."""

    load: float
    approach: float


FLAT, NEARBY = 1e-2, 2e-3  # first steps, of approach and load
FARTHEST, TRIES = 50.0, 6  # the farthest in such steps, how many are tried


def turning_point(
    contact: Contact, h: Array, approach: float, load: float, *, under_load: bool, finer: float = 1.0
) -> Turn | None:
    """Where the equilibria near a state turn, or None where they do not.

    Under fixed grips, at the fold of a jump, the determinant of the tangent changes its sign; that is passed at given
    loads. Under a dead load, at an extremum of the load, that of the tangent bordered by the load does, det A times
    dW/dalpha; it is passed at given approaches. Where they turn, the cubic through both states does; it errs by a
    power of the steps, which may be that much finer.
    """
    place = approach if under_load else load
    # The extremum of the load is flat; along the load an edge moves by a spike's width soon.
    flat = FLAT * (1 + abs(place)) * min(1.0, contact.law.grain / LENNARD_JONES.grain)
    step = flat if under_load else NEARBY * (1 + abs(place)) * min(1.0, 9 / contact.sharpness**2)
    step /= finer
    a = _at(contact, place - step, h, approach, under_load=under_load)
    place, step = place - step, 2 * step
    for _ in range(TRIES):
        change = step if under_load else step / a.stiffness
        b = _at(contact, place + step, a.gap + change * a.gap_rate, a.approach + change, under_load=under_load)
        values = [state.sign * np.exp(state.log - a.log) * (state.stiffness if under_load else 1) for state in (a, b)]
        part = float(values[0] / (values[0] - values[1]))
        if 0 <= part <= 1:
            ends = [(s.load, s.stiffness) if under_load else (s.approach, 1 / s.stiffness) for s in (a, b)]
            part, turned = _extremum(step, *ends)
            place += part * step
            return Turn(turned, place) if under_load else Turn(place, turned)
        if not abs(part) < FARTHEST:
            return None
        step *= 1.3 * part  # past the root
    return None


def _at(contact: Contact, place: float, h: Array, approach: float, *, under_load: bool) -> Equilibrium:
    """Equilibrium at an approach or a load, from gaps and an approach nearby."""
    return newton(contact, h, place) if under_load else newton(contact, h, approach, load=place)


def _extremum(length: float, a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    """Part of a length at which the cubic with given values and slopes of opposite signs at its ends turns; its value.

    Of its derivative, A t^2 + 2 B t + C, the root between 0 and 1.
    """
    rise, first, second = b[0] - a[0], length * a[1], length * b[1]
    A, B, C = 3 * (first + second - 2 * rise), 3 * rise - 2 * first - second, first
    t = -C / (B + np.copysign(np.sqrt(B**2 - A * C), second - first))
    return float(t), float(a[0] + t * (C + t * (B + t * A / 3)))
