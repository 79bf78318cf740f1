"""Whether condensing is exact: one small discretisation solved by the condensed solver and by full Newton.

Cells, elements, quadrature and clamp are the same, all else is not: what both find may differ by rounding alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.crosscheck.comparison import WEAK_FORM, Row
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


@dataclass(frozen=True)
class Settings:
    """The block that is solved both ways.

    Attributes
    ----------
    degree : int
        Of the elements.
    cell, fine, size : float
        Its finest cells, as far as these go, and its edge, in beta.
    rounding : float
        Relative difference that rounding may make; tabor 0.02 to 20 differ by 2e-12 at most.
    before : float
        How far before the jump on, or the first touch, in eps: the state is found from undeformed surfaces there.
    """

    degree: int = 3
    cell: float = 0.4
    fine: float = 3.0
    size: float = 20.0
    rounding: float = 1e-9
    before: float = 1.0


USUAL = Settings()


def rows(scene: Scene, path: EquilibriumPath) -> Iterator[Row]:
    """Load and gap beside the axis before the surfaces jump into contact, by both, of a scene that full Newton serves.

    The path tells the approach.
    """
    if not (scene.body.name == "half-space" and scene.law == LENNARD_JONES and scene.shape == Paraboloid()):
        return
    approach = (path.events["jump_on"].approach if "jump_on" in path.events else 0.0) - USUAL.before
    mesh = block_grid(USUAL.cell, USUAL.fine, USUAL.size)
    contact = Contact(discretise(mesh, USUAL.degree, [(scene.poisson, 1.0)]), scene.tabor, endless=False)
    start = contact.undeformed(approach)
    whole = newton(contact, start, at_approach(start))
    whole = newton(contact, whole.y, at_approach(start))  # its Newton ends at the square of its last step
    body = condense(
        Space(mesh, ElementQuadP(USUAL.degree)), scene.poisson, far_field=clamped, points=2 * USUAL.degree + 2
    )
    condensed = ContactProblem(body.operator, scene.tabor)
    part = condensed_newton.solve(condensed, condensed.undeformed(approach), condensed_newton.approach(approach))
    numbers = {
        ("load", "R dgamma"): (float(part.observables[LOAD]), whole.load),
        ("gap beside the axis", "eps"): (float(part.x[0]), float(whole.y[np.argmin(contact.body.radii)]) - 1),
    }
    for (name, unit), (first, second) in numbers.items():
        budget = USUAL.rounding * abs(second)
        both = Estimate(second, budget / 2), Estimate(first, budget / 2)
        yield Row(f"elimination: {name}", unit, *both, abs(first - second), budget, WEAK_FORM)
