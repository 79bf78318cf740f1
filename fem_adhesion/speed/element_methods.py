"""Finite-element methods of the speed study: degrees, far fields, condensed and monolithic solvers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from skfem import ElementQuad2, ElementQuadP, ElementTriP1, ElementTriP2, ElementTriP3

from fem_adhesion import convergence
from fem_adhesion.bodies.half_space import HalfSpace
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.far_field import FarField, clamped, point_load
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.assembly import assemble
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc
from fem_adhesion.scene import Scene
from fem_adhesion.speed.methods import Method, Solved, from_chart, from_path, ladder, unit, widest
from halfspace.equilibrium.contact import ContactProblem
from halfspace.scales import Scales

POISSON = 0.3


def element_methods() -> list[Method]:
    """Every finite-element method: triangles and quadrilaterals on graded meshes, and degrees that rise.

    Degrees rise with the resolution, adaptively, and on fixed meshes for the other far field and solver.
    """
    method = partial(Method, "finite elements")
    P1, P2, P3 = (partial(_on_disc, element) for element in (ElementTriP1(), ElementTriP2(), ElementTriP3()))
    tri = [(0.6, 16.0), (0.4, 24.0), (0.28, 34.0), (0.2, 48.0), (0.14, 68.0), (0.1, 96.0)]
    quad = [(0.6, 16.0, 2.0), (0.4, 24.0, 1.7), (0.28, 34.0, 1.45), (0.2, 48.0, 1.3), (0.14, 68.0, 1.2)]
    boxes = [(4, 0.8, 1e2, 2.5), (5, 0.8, 1e3, 2.5), (6, 0.8, 1e4, 2.5), (7, 0.8, 1e5, 2.5), (8, 0.8, 1e6, 2.5)]
    small = [(2, 0.8, 20.0, 2.5), (3, 0.8, 40.0, 2.5), (4, 0.8, 80.0, 2.5)]
    tolerances = [(10.0**-k,) for k in range(3, 9)]  # looser ones choose the same degree
    return [
        method("P1", ladder(P1, "f L", tri), 4),
        method("P2", ladder(P2, "f L", tri), 3),
        method("P3", ladder(P3, "f L", tri), 3),
        method("Q2", ladder(_on_block, "p f L", [(2, *s) for s in quad]), 4),
        method("P1", ladder(partial(P1, far_field=clamped), "f L", tri), 4, "clamped"),
        method("P2", ladder(partial(P2, far_field=clamped), "f L", tri), 3, "clamped"),
        method("P2", ladder(partial(P2, solve=_monolithic), "f L", tri[:3]), 1, "monolithic"),
        method("hp", ladder(_adaptive, "rtol", tolerances), 4),
        method("hp", ladder(partial(_on_block, far_field=clamped), "p f L", boxes), 3, "clamped"),
        method("hp", ladder(partial(_on_block, solve=_monolithic), "p f L", small), 2, "monolithic"),
    ]


Solver = Callable[[Space, float, FarField], Solved]


def _condensed(space: Space, tabor: float, far_field: FarField) -> Solved:
    body = condense(space, POISSON, far_field=far_field)
    return from_chart(ContactProblem(body.operator, tabor), body.unknowns)


def _monolithic(space: Space, tabor: float, far_field: FarField) -> Solved:
    problem = assemble(space, POISSON, tabor, far_field=far_field)
    return from_chart(problem, space.unknowns)


def _adaptive(tabor: float, rtol: float) -> Solved:
    return from_path(convergence.trace(Scene(tabor, HalfSpace(poisson=POISSON)), rtol=rtol))


def _on_disc(
    element: Any, tabor: float, f: float, L: float, far_field: FarField = point_load, solve: Solver = _condensed
) -> Solved:
    """Quarter disc of triangles whose edges grow by the fraction f of the distance."""
    size = graded_size(f * Scales(tabor).spike_width, widest(tabor), f)
    return solve(Space(quarter_disc(_box(L, tabor), size), element), tabor, far_field)


def _on_block(
    tabor: float,
    p: int,
    f: float,
    L: float,
    growth: float,
    far_field: FarField = point_load,
    solve: Solver = _condensed,
) -> Solved:
    """Box of quadrilaterals of degree p between graded lines."""
    mesh = block_grid(f * Scales(tabor).spike_width, widest(tabor), _box(L, tabor), growth=growth)
    return solve(Space(mesh, ElementQuad2() if p == 2 else ElementQuadP(p)), tabor, far_field)


def _box(L: float, tabor: float) -> float:
    """Size of a block in beta."""
    return max(L * unit(tabor), 2 * widest(tabor))
