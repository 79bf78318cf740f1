"""The fields inside a body at chosen states of its load-approach curve, each on a mesh made for that state.

The curve is traced on the surface alone. Here a state of it is solved for again on a body whose cells are finest at
its contact edge, in the plane across the curve through it, so that folds are no obstacle, and the displacement inside
follows from the pressure. Beside it stands the half-space at the same contact radius or central gap.

Units: lengths in beta, displacement in beta^2/R = mu eps, strain in beta/R, stress and pressure in E* beta/R =
dgamma/(mu eps). `halfspace.scaling.Units` has the SI values of beta (`length`), of the stress (`pressure`) and of eps
(`approach`), which times mu is that of the displacement.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import discretised_about
from fem_adhesion.elasticity.space import Space
from fem_adhesion.elasticity.stress import recovered_stresses
from fem_adhesion.elasticity.surface import BoundaryPoints
from fem_adhesion.scene import Scene
from halfspace.elastic.layered import panels_of
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import metric_for, transfer
from halfspace.equilibrium.conditions import Located, same_place
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import usual
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.path import Point
from halfspace.errors import InputError, required
from halfspace.values import Array, Mask, Valued

FIELDS = Discretisation(degree=6)  # displacement and stress are those of degree 9 to 5e-5 and 1e-3 of their maxima


@dataclass(frozen=True, eq=False, repr=False)
class State(Valued):
    """An equilibrium of a scene with the fields inside the body, the first of two.

    Attributes
    ----------
    scene : Scene
        What was asked.
    name : str
        Of the event that the state is, or "".
    space : Space
        Mesh, in beta, and element; regions of different materials do not share nodes.
    displacement : (N,) array
        All displacement unknowns, in beta^2/R.
    stress : (4, functions) array
        Coefficients of the recovered stress (rr, zz, hoop, rz), in E* beta/R, tension positive; for
        `fem_adhesion.elasticity.stress.sampled`.
    surface : BoundaryPoints
        Quadrature points of the contact surface, by their radii, ascending, q in all.
    problem : ContactProblem
        The surface law on this body.
    point : Point
        The state's gaps, observables, and its place on the curve, see `halfspace.equilibrium.path`.
    """

    scene: Scene
    name: str
    space: Space
    displacement: Array
    stress: Array
    surface: BoundaryPoints
    problem: ContactProblem
    point: Point

    @property
    def observables(self) -> Array:
        """Approach (eps), load (R dgamma), central gap (eps), contact radius (beta, nan if none), shape (4,)."""
        return self.point.observables

    @property
    def gap(self) -> Array:
        """H = h/eps - 1 at the nodes, shape (q,)."""
        return np.asarray(self.point.x[: self.surface.radii.size])

    @property
    def pressure(self) -> Array:
        """P at the nodes in E* beta/R, positive in compression, shape (q,)."""
        return np.asarray(self.problem.pressure(self.point.x)[: self.surface.radii.size])

    @property
    def share(self) -> float:
        """The body's part of the compliance 1/E*: its own modulus is E*/share."""
        return self.scene.shares[0]

    @cached_property
    def stable(self) -> bool:
        """Stability under fixed grips; at a fold, where it changes, rounding decides."""
        return self.problem.negative_directions(self.point.x) == 0

    @property
    def stable_under_dead_load(self) -> bool:
        """Stability under a dead load: stable under fixed grips and dW/dalpha positive."""
        rates = self.point.rates
        return self.stable and bool(rates[LOAD] * rates[APPROACH] > 0)

    @property
    def components(self) -> Array:
        """Coefficients (2, functions) of u_r and u_z."""
        return self.displacement[self.space.components]

    @property
    def surface_displacement(self) -> Array:
        """u_r and u_z at the nodes of the surface, shape (2, q)."""
        functions = self.space.boundary_functions("contact")
        return np.asarray((self.surface.values @ self.components[:, functions].T).T)

    @property
    def traction(self) -> Array:
        """Force at the nodes by the law, downwards per area of the undeformed surface, in E* beta/R, shape (q,)."""
        n_z = self.surface.normals.reshape(2, -1)[1]
        return self.pressure * (n_z if self.scene.material.area == "projected" else 1.0)

    def recovered_traction(self) -> Array:
        """Traction that the stress inside exerts, shape (q,): to be compared with the law's.

        It is nan on the facets at a singular corner, see `_at_corner`: the stress is infinite there, and polynomials
        err by up to 20 times the largest pressure. On other facets they err by 2e-4 of the largest pressure, and on a
        user's mesh of quadratic cells by 3e-3.
        """
        functions = self.space.boundary_functions("contact")
        _, zz, _, rz = (self.surface.values @ self.stress[:, functions].T).T
        n_r, n_z = self.surface.normals.reshape(2, -1)
        corner = np.repeat(self._at_corner, self.surface.lengths.shape[1])
        return np.where(corner, np.nan, -(rz * n_r + zz * n_z))

    @property
    def _at_corner(self) -> Mask:
        """Facets of the contact, outwards, whose stress is spoiled where the contact meets a clamped boundary.

        They are the facet that ends at this corner and the rings that lead to it: there each facet is less than half as
        long as the one before.
        """
        lengths, mesh = self.surface.lengths.sum(axis=1), self.space.mesh
        contact, far = (mesh.facets[:, mesh.boundaries[name]] for name in ("contact", "far"))
        if self.scene.body.held != "clamped" or not np.intersect1d(contact, far).size:
            return np.zeros(lengths.size, dtype=bool)
        shrinking = np.append(lengths[:-1] > 2 * lengths[1:], True)
        return np.asarray(np.logical_and.accumulate(shrinking[::-1])[::-1])


def state_at(scene: Scene, problem: Traceable, point: Point, *, name: str = "", how: Discretisation = FIELDS) -> State:
    """Solve for a state of a curve again on a mesh of its own, with the fields inside.

    Problem and point are of a path of the scene, at small strain, traced by `fem_adhesion.trace`, and on which it was
    found: that of its segment or event. The name is to go with the state; `how` says how finely. InputError if the
    scene's body is a sphere held over a cap, or its strain finite; NotConverged if the state does not exist on the new
    mesh, as GridTooCoarse if a user's mesh does not carry the spike of tension at the contact edge.
    """
    require_fields(scene)
    made = discretised_about(scene, float(point.observables[CONTACT_RADIUS]), how)
    body, own = made.first, made.problem
    new = required(same_place(point, own, transfer(problem, point.x, own), metric_for(own)))
    own.require_resolution(new.x)
    u = body.displacement(own.pressure(new.x)[: body.surface.radii.size])
    space, u, stress = recovered_stresses(body.space, scene.body.regions, u)
    return State(scene, name, space, scene.shares[0] * u, stress, body.surface, own, new)


def states_along(
    scene: Scene, path: EquilibriumPath, *, points: int | None = None, how: Discretisation = FIELDS
) -> Iterator[State]:
    """Solve for states of a traced curve and its events one by one, in order of their arclength.

    The path is the scene's, from `fem_adhesion.trace`; scene, `how` and errors are as of `state_at`. So many of the
    curve's points are taken, nearly equidistant in arclength with both ends; all unless given, none if 0, InputError if
    negative.
    """
    require_fields(scene)
    chosen = [("", *path_point) for path_point in _spread(path, points)]
    chosen += [(name, event.problem, event.point) for name, event in usual(path.stages[-1]).items()]
    for name, problem, point in sorted(chosen, key=lambda entry: entry[2].arclength):
        yield state_at(scene, problem, point, name=name, how=how)


def require_fields(scene: Scene) -> None:
    """Raise InputError for a scene whose fields inside the body are not to be had."""
    if scene.material.finite:
        raise InputError(f"material = {scene.material} has no fields here, limit: small strain; take LinearElastic")
    if not scene.body.has_fields:
        raise InputError(f"body = {scene.body.name} has no fields here; take hemisphere")


def _spread(path: EquilibriumPath, count: int | None) -> list[tuple[Traceable, Point]]:
    """Points of a path, nearly equidistant in arclength."""
    every: list[tuple[Traceable, Point]] = [(s.problem, point) for s in path.segments for point in s.points]
    if count is None:
        return every
    if count < 0:
        raise InputError(f"points = {count} is outside 0 <= points; give how many states of the curve to take")
    arclength = np.array([point.arclength for _, point in every])
    wanted = np.linspace(arclength[0], arclength[-1], count)
    nearest = np.abs(arclength - wanted[:, None]).argmin(axis=1) if count else []
    return [every[number] for number in np.unique(nearest).astype(int)]


@dataclass(frozen=True, eq=False, repr=False)
class Beside(Valued):
    """The half-space beside a state: P and H at its radii, (q,), and the half-space's own observables.

    These are its approach, load, central gap and contact radius, (4,).
    """

    pressure: Array
    gap: Array
    observables: Array


def half_space_beside(state: State) -> Beside:
    """Solve for the half-space by the integral equation where a body of finite elements was solved for.

    Its rings end where the elements do, except at the contact edge, but its compliance is that of the ring kernel; on a
    layered body it has the strata, too.
    The contact radius is prescribed, or the central gap if there is no contact; approach and load are its own.
    NotConverged if the half-space has no such state.
    """
    source, tabor = state.problem.operator.at(1.0), state.scene.tabor
    gap, radius = (float(value) for value in state.observables[[CENTRAL_GAP, CONTACT_RADIUS]])
    cells = _clear_of(source.cells, radius)
    operator = panels_of(state.scene.body.layered, cells, min(source.cell_nodes.shape[1], 16))
    problem = ContactProblem(operator, tabor, state.problem.law, state.problem.profile)
    start = np.append(source.values_at(operator.radii, state.gap), state.point.x[-2:])
    control = newton.central_gap(gap) if np.isnan(radius) else newton.contact_radius(radius)
    solution = newton.solve(problem, start, control)
    P, H = problem.pressure(solution.x), solution.x[:-2]
    radii = state.surface.radii
    return Beside(operator.values_at(radii, P), operator.values_at(radii, H), solution.observables)


def _clear_of(cells: Array, radius: float) -> Array:
    """Ends of rings none of which is at the contact edge: gaps jump there, by the error of their polynomials.

    Newton's method would go to and fro between the two sides of such a jump for ever.
    """
    if np.isnan(radius):
        return cells
    nearest = int(np.clip(np.abs(cells - radius).argmin(), 1, cells.size - 2))
    other = nearest - 1 if cells[nearest] <= radius else nearest + 1
    moved = cells.copy()
    moved[nearest] = (cells[nearest] + cells[other]) / 2
    return moved


def gaps_at(event: Located, radii: Array) -> Array:
    """Gaps H of a state at radii on its cells.

    It is the deflection that is interpolated, whereas the profile is exact.
    """
    problem, x = event.problem.interface, event.problem.surface_state(event.point.x)
    operator, mu, profile = problem.operator_at(x), problem.tabor, problem.profile
    within = np.minimum(radii, operator.extent)
    deflection = operator.values_at(within, x[:-2] - mu * profile.height(operator.radii))
    return np.asarray(deflection + mu * profile.height(within))
