"""Whether condensing is exact: one small discretisation solved by the condensed solver and by full Newton.

Cells, elements, quadrature and clamp are the same, all else is not: what both find may differ by rounding alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.crosscheck.comparison import WEAK_FORM, Row
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import clamped
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import block_grid
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.path import equilibrium
from fem_adhesion.weak_form.problem import Problem
from halfspace.equilibrium import newton
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.laws import LENNARD_JONES
from halfspace.profiles import Paraboloid
from halfspace.values import Estimate

DEGREE = 3
CELL, FINE, SIZE = 0.4, 3.0, 20.0  # beta, of the block: its finest cells, as far as these go, and its edge
ROUNDING = 1e-9  # relative; tabor 0.02 to 20 differ by 2e-12 at most
BEFORE = 1.0  # eps, before the jump on, or the first touch: Newton's method finds the state from undeformed surfaces


def rows(scene: Scene, path: EquilibriumPath) -> Iterator[Row]:
    """Load and gap beside the axis before the surfaces jump into contact, by both, of a scene that full Newton serves.

    The path tells the approach.
    """
    if not (scene.body.name == "half-space" and scene.law == LENNARD_JONES and scene.shape == Paraboloid()):
        return
    approach = (path.events["jump_on"].approach if "jump_on" in path.events else 0.0) - BEFORE
    mesh = block_grid(CELL, FINE, SIZE)
    problem = Problem(mesh, DEGREE, scene.tabor, scene.poisson, FINE)
    start = np.zeros(problem.free.size + 1)
    start[-1] = approach
    border = np.eye(1, start.size, start.size - 1)[0]
    whole, _ = equilibrium(problem, start, border, approach)
    whole, _ = equilibrium(problem, whole.x, border, approach)  # its Newton ends at the square of its last step
    body = condense(Space(mesh, ElementQuadP(DEGREE)), scene.poisson, far_field=clamped, points=2 * DEGREE + 2)
    condensed = ContactProblem(body.operator, scene.tabor)
    part = newton.solve(condensed, condensed.undeformed(approach), newton.approach(approach))
    gaps = problem.gap(whole.x).ravel() - 1
    nearest = int(np.argmin(np.asarray(problem.surface.global_coordinates()[0]).ravel()))
    numbers = {
        ("load", "R dgamma"): (float(part.observables[LOAD]), float(whole.observables[1])),
        ("gap beside the axis", "eps"): (float(part.x[0]), float(gaps[nearest])),
    }
    for (name, unit), (first, second) in numbers.items():
        budget = ROUNDING * abs(second)
        both = Estimate(second, budget / 2), Estimate(first, budget / 2)
        yield Row(f"elimination: {name}", unit, *both, abs(first - second), budget, WEAK_FORM)
