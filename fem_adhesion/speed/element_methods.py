"""Finite-element methods of the speed study: degrees, far fields, condensed and monolithic solvers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
from fem_adhesion.speed.methods import Method, Solved, Step, Variant, from_chart, from_path, unit, widest
from halfspace.equilibrium.contact import ContactProblem
from halfspace.scales import Scales

POISSON = 0.3


def element_methods() -> list[Method]:
    """Every finite-element method."""
    return [*_fixed_degrees(), *_high_orders()]


def _fixed_degrees() -> list[Method]:
    """Triangles and quadrilaterals of a fixed degree on graded meshes."""
    tri = [(0.6, 16.0), (0.4, 24.0), (0.28, 34.0), (0.2, 48.0), (0.14, 68.0), (0.1, 96.0)]
    quad = [(0.6, 16.0, 2.0), (0.4, 24.0, 1.7), (0.28, 34.0, 1.45), (0.2, 48.0, 1.3), (0.14, 68.0, 1.2)]
    P1, P2, P3 = ("P1", ElementTriP1()), ("P2", ElementTriP2()), ("P3", ElementTriP3())
    triangles = ((P1, 4), (P2, 3), (P3, 3))
    methods = [_method(basis, [_disc_step(element, *s) for s in tri], n) for (basis, element), n in triangles]
    methods += [_method("Q2", [_block_step(2, *s) for s in quad], 4)]
    for (basis, element), n in triangles[:2]:
        methods += [_method(basis, [_disc_step(element, *s, far_field=clamped) for s in tri], n, "clamped")]
    methods += [_method("P2", [_disc_step(P2[1], *s, solve=_monolithic) for s in tri[:3]], 1, "monolithic")]
    return methods


def _high_orders() -> list[Method]:
    """Degrees that rise with the resolution: adaptive, and on fixed meshes for the other far field and solver."""
    adaptive = [_fe_step(10.0**-k) for k in range(3, 9)]  # looser tolerances choose the same degree
    far = [(4, 1e2), (5, 1e3), (6, 1e4), (7, 1e5), (8, 1e6)]
    boxes = [_block_step(p, 0.8, L, 2.5, far_field=clamped) for p, L in far]
    whole = [_block_step(p, 0.8, L, 2.5, solve=_monolithic) for p, L in ((2, 20.0), (3, 40.0), (4, 80.0))]
    return [_method("hp", adaptive, 4), _method("hp", boxes, 3, "clamped"), _method("hp", whole, 2, "monolithic")]


def _method(basis: str, steps: Sequence[Step], quick: int, variant: Variant = "") -> Method:
    return Method("finite elements", basis, steps, quick, variant)


def _fe_step(rtol: float) -> Step:
    return Step(
        f"rtol={rtol:.0e}",
        lambda tabor: from_path(convergence.trace(Scene(tabor, HalfSpace(poisson=POISSON)), rtol=rtol)),
    )


Solver = Callable[[Space, float, FarField], Solved]


def _condensed(space: Space, tabor: float, far_field: FarField) -> Solved:
    body = condense(space, POISSON, far_field=far_field)
    return from_chart(ContactProblem(body.operator, tabor), body.unknowns)


def _monolithic(space: Space, tabor: float, far_field: FarField) -> Solved:
    problem = assemble(space, POISSON, tabor, far_field=far_field)
    return from_chart(problem, space.unknowns)


def _disc_step(element: Any, f: float, L: float, far_field: FarField = point_load, solve: Solver = _condensed) -> Step:
    """Quarter disc of triangles whose edges grow by the fraction f of the distance."""

    def run(tabor: float) -> Solved:
        size = graded_size(f * Scales(tabor).spike_width, widest(tabor), f)
        return solve(Space(quarter_disc(_box(L, tabor), size), element), tabor, far_field)

    return Step(f"f={f:g} L={L:g}", run)


def _block_step(
    p: int, f: float, L: float, growth: float, far_field: FarField = point_load, solve: Solver = _condensed
) -> Step:
    """Box of quadrilaterals of degree p between graded lines."""
    element = ElementQuad2() if p == 2 else ElementQuadP(p)

    def run(tabor: float) -> Solved:
        mesh = block_grid(f * Scales(tabor).spike_width, widest(tabor), _box(L, tabor), growth=growth)
        return solve(Space(mesh, element), tabor, far_field)

    return Step(f"p={p} f={f:g} L={L:g}", run)


def _box(L: float, tabor: float) -> float:
    """Size of a block in beta."""
    return max(L * unit(tabor), 2 * widest(tabor))
