"""A contact problem of a whole body from its parts: a body for the material, its exterior, and its surface."""

from __future__ import annotations

from scipy import sparse

from fem_adhesion.elasticity.far_field import Exterior, FarField, point_load, with_interiors
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.body import Body, displacement_body
from fem_adhesion.finite_strain.held import HeldBody
from fem_adhesion.finite_strain.problem import FiniteStrainProblem
from fem_adhesion.finite_strain.surface import contact_surface
from fem_adhesion.finite_strain.traction import Convention
from halfspace.equilibrium.contact import ContactProblem
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.profiles import PARABOLOID, Surface


def finite_strain_problem(
    body: Body,
    exterior: Exterior,
    tabor: float,
    *,
    profile: Surface = PARABOLOID,
    convention: Convention,
    points: int | None = None,
    law: Law = LENNARD_JONES,
) -> FiniteStrainProblem:
    """Put a body under a rigid flat wall that attracts it.

    The body is a `displacement_body` or `mixed_body` of `fem_adhesion.finite_strain.body`; the exterior is of all
    displacement unknowns of its space, interior ones included: see `fem_adhesion.elasticity.far_field.with_interiors`.
    tabor and law are as in `halfspace.equilibrium.contact.ContactProblem`. The profile is the height of the body's
    undeformed surface over its pole, carried along by its points; that of a block is a perturbation of its flat
    surface, as in the linear body. The convention says what the law's traction is counted per, and its direction. Of
    Gauss's points there are p + 2 on each contact facet unless given. InputError if the exterior holds the body by a
    spring that has to be taken off again (`free`).
    """
    if exterior.rigid_compliance:
        raise InputError("a far field with a rigid_compliance is known to `condense` only; use point_load or clamped")
    whole = _with_pressures(exterior, body)
    space = body.space
    surface = contact_surface(space, whole, space.degree + 2 if points is None else points)
    interface = ContactProblem(surface.rigid, tabor, law, profile)
    return FiniteStrainProblem(HeldBody(body, whole, surface.unknowns), surface, interface, convention)


def assemble(
    space: Space,
    poisson: float,
    tabor: float,
    *,
    far_field: FarField = point_load,
    points: int | None = None,
    law: Law = LENNARD_JONES,
) -> FiniteStrainProblem:
    """Contact problem of a linear block under a rigid paraboloid, none of its unknowns condensed but in the solver.

    Space, poisson and points are as in `fem_adhesion.elasticity.condensation.condense`, whose problem has the same
    solutions, the rest and the errors as of `finite_strain_problem`; the far field is `point_load` or `clamped`.
    InputError, too, if poisson is out of range.
    """
    body, exterior = displacement_body(space, poisson, 0.0), with_interiors(far_field(space, poisson), space)
    return finite_strain_problem(body, exterior, tabor, convention=Convention(0.0, 0.0), points=points, law=law)


def _with_pressures(exterior: Exterior, body: Body) -> Exterior:
    """Let the unknowns beyond the displacements be reduced unknowns themselves."""
    more = body.unknowns - body.space.unknowns
    T = sparse.block_diag([exterior.reduction, sparse.eye_array(more)])
    S = sparse.block_diag([exterior.stiffness, sparse.csc_array((more, more))])
    return Exterior(sparse.csc_array(T), sparse.csc_array(S))
