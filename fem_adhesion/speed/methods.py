"""What a method is to the speed study; those on the half-space, from the iterations of 1997 on, and by finite elements.

A method is a ladder of resolutions, each computed from the set-up to the events. Grids scale with the contact: spacings
f are in widths of the spike of tension at the contact edge, extents U and sizes of blocks L in beta/sqrt(mu).
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np
from scipy.optimize import minimize_scalar
from skfem import ElementQuad2, ElementQuadP, ElementTriP1, ElementTriP2, ElementTriP3

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common import relaxation
from fem_adhesion.common.page import data_text
from fem_adhesion.common.relaxation import Relaxed
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.exterior import FarField, clamped, point_load
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.problem import assemble
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc
from fem_adhesion.scene import Scene
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import COMPRESSION, Chart, trace_charts
from halfspace.equilibrium.contact import APPROACH, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle, energy_lost
from halfspace.equilibrium.newton import Control, Traceable
from halfspace.equilibrium.search import find_events
from halfspace.scales import Scales
from halfspace.theories.closed_forms import jkr_radius
from halfspace.values import Array, Estimate

QUANTITIES = ("pull_off", "jump_on", "hysteresis")
POISSON = Scene(1.0).poisson  # of the finite elements

Family = Literal["half-space", "finite elements"]
Variant = Literal["", "clamped", "monolithic"]


Solved = tuple[int, Mapping[str, float]]
"""What one rung yields: unknowns, elastic ones included, and those of `QUANTITIES` that the method gives."""


Step = tuple[str, Callable[[float], Solved]]
"""One rung of a ladder: its resolution in words, and the computation at a Tabor parameter."""


@dataclass(frozen=True)
class Method:
    """A ladder of resolutions, from coarse to fine, of a family of elasticity.

    The basis is how the pressure or the displacement is represented, or solved for, the variant what differs from the
    family's usual: for finite elements, condensed with a point load's far field. So many of the steps, the coarsest,
    make up the quick ladder: a budget of work, the same on every machine. An iteration that is known to run away from
    stiff attraction `may_diverge`: that it does is then a finding, not a failure.
    """

    family: Family
    basis: str
    steps: Sequence[Step]
    quick: int
    variant: Variant = ""
    may_diverge: bool = False

    @property
    def name(self) -> str:
        """Unique name."""
        prefix = "FE " if self.family == "finite elements" else ""
        return f"{prefix}{self.basis}" + (f", {self.variant}" if self.variant else "")


def estimates(path: EquilibriumPath) -> dict[str, Estimate]:
    """Quantities of a path with their errors; jump and hysteresis only where it folds."""
    found = {"pull_off": path.events["pull_off"].estimate("load")}
    if grips := cycle(path):
        found |= {"jump_on": grips.jump_on.take_off.estimate("approach"), "hysteresis": grips.energy_lost}
    return found


def from_chart(problem: Traceable, unknowns: int) -> Solved:
    """Quantities from one discretisation, whose events are found once and taken as they are."""
    segments = trace_charts([Chart(problem, unknowns)])
    found = find_events(segments)
    values = {"pull_off": float(found["pull_off"].point.observables[LOAD])}
    if loss := energy_lost(segments):
        values |= {"jump_on": float(found["jump_on"].point.observables[APPROACH]), "hysteresis": loss}
    return unknowns, values


def unit(tabor: float) -> float:
    """Width of a rigid paraboloid's attraction, in beta."""
    return float(1 / np.sqrt(tabor))


def widest(tabor: float) -> float:
    """Contact radius at the end of the curve, in beta."""
    return float(np.hypot(jkr_radius(COMPRESSION), 0.7 * unit(tabor)))


def _graded(tabor: float, f: float, U: float, growth: float, fine_radius: float | None = None) -> Array:
    fine = widest(tabor) if fine_radius is None else fine_radius
    finest, extent = f * Scales(tabor).spike_width, fine + U * unit(tabor)
    return grid.graded(0.0, finest, extent, growth=growth, until=fine)


def _on_grid(
    make: Callable[[Array], ElasticOperator], tabor: float, f: float, U: float, growth: float | None = None
) -> Solved:
    """Uniform grid, or one that grows beyond the contact; up to a Tabor parameter of 2 it has 1812 nodes at most."""
    if growth is not None:
        nodes = _graded(tabor, f, U, growth)
    else:
        nodes = grid.uniform(max(U * unit(tabor), 1.5 * widest(tabor)), f * Scales(tabor).spike_width)
    operator = make(nodes)
    return from_chart(ContactProblem(operator, tabor), operator.radii.size)


def _on_panels(tabor: float, nodes: int, U: float) -> Solved:
    operator = compliance.panels(_graded(tabor, 0.8, U, 2.0), nodes)
    return from_chart(ContactProblem(operator, tabor), operator.radii.size)


Relaxation = Callable[[ContactProblem, Array, Control], Relaxed]


def _relaxed(relax: Relaxation, tabor: float, f: float, U: float, growth: float) -> Solved:
    nodes = _graded(tabor, f, U, growth, fine_radius=2.2)
    problem = ContactProblem(compliance.triangles(nodes), tabor)
    return nodes.size, {"pull_off": pull_off_by_sweep(problem, relax)}


def _simple(problem: ContactProblem, start: Array, control: Control) -> Relaxed:
    c = float(np.clip(0.02 / problem.tabor**2, 0.005, 0.2))
    return relaxation.simple(problem, start, control, relaxation=c, tolerance=1e-8)


def pull_off_by_sweep(problem: ContactProblem, relax: Relaxation) -> float:
    """Least load met under fixed grips, refined by parabolas, from a start with zero central gap.

    An iteration that cannot pass a fold finds the pull-off load where it is stable under fixed grips, and
    no other event.
    """
    first = relax(problem, problem.undeformed(0.0), newton.central_gap(0.0))
    states = {float(first.observables[APPROACH]): first.x}

    def load(approach: float) -> float:
        nearest = min(states, key=lambda known: abs(known - approach))
        state = relax(problem, states[nearest], newton.approach(approach))
        problem.require_resolution(state.x)
        states[approach] = state.x
        return float(state.observables[LOAD])

    step = 0.2 * (1 + problem.tabor)
    at = next(iter(states))
    before, here = load(at), load(at + step)
    if here > before:
        at, step, here = at + step, -step, before
    at += step
    while (after := load(at + step)) < here:
        at, here = at + step, after
    bounds = min(at - step, at + step), max(at - step, at + step)
    return float(minimize_scalar(load, bounds=bounds, method="bounded", options={"xatol": 1e-2 * abs(step)}).fun)


def _adaptive(path: EquilibriumPath) -> Solved:
    """What a solver with error control finds."""
    return path.unknowns, {name: estimate.value for name, estimate in estimates(path).items()}


# Finite elements


Solver = Callable[[Space, float], Solved]


def _condensed(space: Space, tabor: float, far_field: FarField = point_load) -> Solved:
    body = condense(space, POISSON, far_field=far_field)
    return from_chart(ContactProblem(body.operator, tabor), body.unknowns)


def _monolithic(space: Space, tabor: float) -> Solved:
    return from_chart(assemble(space, POISSON, tabor, far_field=point_load), space.unknowns)


def _on_disc(element: Any, tabor: float, f: float, L: float, solve: Solver = _condensed) -> Solved:
    """Quarter disc of triangles whose edges grow by the fraction f of the distance."""
    size = graded_size(f * Scales(tabor).spike_width, widest(tabor), f)
    return solve(Space(quarter_disc(max(L * unit(tabor), 2 * widest(tabor)), size), element), tabor)


def _on_block(tabor: float, p: int, f: float, L: float, growth: float, solve: Solver = _condensed) -> Solved:
    """Box of quadrilaterals of degree p between graded lines."""
    extent = max(L * unit(tabor), 2 * widest(tabor))
    mesh = block_grid(f * Scales(tabor).spike_width, widest(tabor), extent, growth=growth)
    return solve(Space(mesh, ElementQuad2() if p == 2 else ElementQuadP(p)), tabor)


SOLVERS: Mapping[Variant, Solver] = {"clamped": partial(_condensed, far_field=clamped), "monolithic": _monolithic}
BASES: Mapping[str, Callable[..., Solved]] = {
    "simple relaxation": partial(_relaxed, _simple),
    "Greenwood's iteration": partial(_relaxed, partial(relaxation.greenwood, tolerance=1e-5)),
    "uniform bands": partial(_on_grid, compliance.bands),
    "uniform triangles": partial(_on_grid, compliance.triangles),
    "graded triangles": partial(_on_grid, compliance.triangles),
    "panels, fixed grid": _on_panels,
    "adaptive": lambda tabor, rtol: _adaptive(halfspace.trace(tabor, rtol=rtol)),
    "P1": partial(_on_disc, ElementTriP1()),
    "P2": partial(_on_disc, ElementTriP2()),
    "P3": partial(_on_disc, ElementTriP3()),
    "Q2": _on_block,
    "hp": _on_block,
}
"""What solves a rung of a basis, given the Tabor parameter and its settings."""


def _solver(basis: str, variant: Variant) -> Callable[..., Solved]:
    """What solves a rung of a method: by hp elements as a user has them, they are chosen by an accuracy."""
    if (basis, variant) == ("hp", ""):
        return lambda tabor, rtol: _adaptive(convergence.trace(Scene(tabor), rtol=rtol))
    return partial(BASES[basis], solve=SOLVERS[variant]) if variant else BASES[basis]


def all_methods() -> list[Method]:
    """Every method of ``data/methods.toml``, in its order."""

    def step(solve: Callable[..., Solved], names: str, settings: Sequence[float]) -> Step:
        named = zip(names.split(), settings, strict=False)
        told = [f"{name}={value:.0e}" if name == "rtol" else f"{name}={value:g}" for name, value in named]
        return " ".join(told), lambda tabor: solve(tabor, *settings)

    methods = []
    for row in tomllib.loads(data_text("speed", "methods.toml"))["method"]:
        names, rungs = row.pop("settings"), row.pop("rungs")
        solve = _solver(row["basis"], row.get("variant", ""))
        methods.append(Method(steps=[step(solve, names, settings) for settings in rungs], **row))
    return methods
