"""Whether condensing is exact: one small discretisation solved by the condensed solver and by full Newton.

Cells, elements, quadrature and clamp are the same, all else is not: what both find may differ by rounding alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.crosscheck.comparison import WEAK_FORM, Row, of_values
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import block_grid
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.body import discretise
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.newton import at_approach, newton
from halfspace.equilibrium import newton as condensed_newton
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.laws import LENNARD_JONES
from halfspace.profiles import Paraboloid
from halfspace.values import Estimate


def rows(scene: Scene, path: EquilibriumPath) -> Iterator[Row]:
    """Load and gap beside the axis before the surfaces jump into contact, by both, of a scene that full Newton serves.

    The path tells the approach.
    """
    if not (scene.body.name == "half-space" and scene.law == LENNARD_JONES and scene.shape == Paraboloid()):
        return
    approach = (path.events["jump_on"].approach if "jump_on" in path.events else 0.0) - USUAL.before
    mesh, degree = block_grid(*USUAL.block), USUAL.block_degree
    contact = Contact(discretise(mesh, degree, [(scene.poisson, 1.0)]), scene.tabor)
    start = contact.undeformed(approach)
    whole = newton(contact, start, at_approach(approach))
    body = condense(Space(mesh, ElementQuadP(degree)), scene.poisson, far_field=clamped, points=2 * degree + 2)
    condensed = ContactProblem(body.operator, scene.tabor)
    part = condensed_newton.solve(condensed, condensed.undeformed(approach), condensed_newton.approach(approach))
    beside = float(whole.y[np.argmin(contact.body.radii)]) - 1
    for name, unit, first, second in (
        ("load", "R dgamma", whole.load, float(part.observables[LOAD])),
        ("gap beside the axis", "eps", beside, float(part.x[0])),
    ):
        budget = USUAL.rounding * abs(first)
        both = Estimate(first, budget / 2), Estimate(second, budget / 2)
        yield of_values(f"elimination: {name}", unit, *both, budget, WEAK_FORM)
