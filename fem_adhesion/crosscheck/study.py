"""The cross-check of the finite-element solver with one that shares no operator with it.

That is the half-space's for half-spaces, blocks and layers, and the whole sphere by harmonics for hemispheres in the
sliding grip, unless the tip is pointed. For other bodies the fourth level stands alone.

Four levels. Operators: both compliances under the same pressures, whole fields compared. Cross-residual: the state
found by one solver put into the equations of the other. Events: pull-off, jumps, the zero-load state, the energy;
pull-off and jumps also by the overlapping triangles of [G97], a solver of its own. The fourth, for what both solvers
share, is in `fem_adhesion.crosscheck.from_scratch`. A quantity agrees only if the difference is within the sum of both
error estimates and that sum is within the budget; the estimates come from refinement and from the size of the block,
never from a choice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.crosscheck import comparison, definitions, elimination, from_scratch
from fem_adhesion.crosscheck.comparison import SOLVERS, TRIANGLES, Case, Pair, Row, of_values
from fem_adhesion.crosscheck.references import PRESSURES, SMOOTH, elements_of, radius_of, reference_for
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.fields import gaps_at
from fem_adhesion.scene import Scene
from halfspace.accuracy.kernels import KERNELS
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.charts import transfer
from halfspace.equilibrium.conditions import ROUND_OFF, Located
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import EVENTS, FOLDS
from halfspace.errors import tried
from halfspace.limits import require_rtol
from halfspace.values import Array, Estimate

Solver = Callable[..., EquilibriumPath]


def compare(
    scene: Scene, *, rtol: float = 1e-5, before: Sequence[Row] | None = None, solve: Solver = convergence.trace
) -> Case:
    """Solve a scene with both solvers and compare on all levels.

    Parameters
    ----------
    scene : Scene
        The contact, at small strain.
    rtol : float
        Accuracy of the comparison: budgets are this relative to each quantity.
    before : sequence of Row, optional
        What `unsolved` found before for the same body.
    solve : callable
        Finite-element solver, ``solve(scene, rtol=...)``.

    Raises
    ------
    InputError
        If an input is out of range, or there is nothing to compare with.
    halfspace.errors.NotConverged
        If a solver fails.
    """
    require_rtol(rtol)
    comparison.require_comparable(scene, rtol)
    known = unsolved(scene, rtol=rtol) if before is None else before
    fe, case = _solved(scene, rtol, rtol, solve)
    for closer in USUAL.closer:
        # A decade of tolerance leaves a tenth of an estimate at best: what is wider than that stays open.
        reach = np.inf if closer == USUAL.closer[-1] else closer
        left = [row for row in case.rows if row.verdict != "agree"]
        wins = not any(row.error > reach * row.budget for row in left)
        if rtol > closer * USUAL.tightest and case.verdict == "inconclusive" and wins:
            fe, case = tried(_solved, scene, rtol, rtol / closer, solve, refusals=True) or (fe, case)
    apart = *_by_triangles(scene, fe, rtol), *elimination.rows(scene, fe), *from_scratch.events(scene, fe)
    return replace(case, rows=(*known, *case.rows, *apart))


def _solved(scene: Scene, rtol: float, asked: float, solve: Solver) -> tuple[EquilibriumPath, Case]:
    """The elements' curve, and a comparison to a tolerance of what both solvers give to that asked of them.

    Theirs is of loads and approaches. Of gaps, which the residuals see, the estimates may be wider than the budget.
    """
    reference = reference_for(scene)
    other = reference.trace(rtol=comparison.tighter(asked)) if reference else None
    fe = solve(scene, rtol=max(0.9 * asked, USUAL.tightest))
    rows: list[Row] = []
    solutions = {"finite elements": comparison.solution_of(fe)}
    if reference and other:
        solutions = {reference.between[0]: comparison.solution_of(other), **solutions}
        rows += [*_cross_residuals(other, fe, rtol, reference.between)]
        rows += [*_compare_events(other, fe, rtol, reference.between)]
    return fe, Case(scene, solutions, tuple(rows))


def unsolved(scene: Scene, *, rtol: float = 1e-5) -> list[Row]:
    """Rows that need no solution of the scene: operators, equations and closed forms."""
    reference, problems, edge = reference_for(scene), elements_of(scene, rtol), radius_of(scene)
    rows: list[Row] = []
    if reference:
        both = reference.operators(rtol), [problem.operator.at(1.0) for problem in problems]
        names = SMOOTH if scene.sized else PRESSURES
        rows = [_compare_fields(name, *both, rtol, edge, reference.between) for name in names]
    rows += from_scratch.equations(scene, problems[-2:], edge)
    rows += definitions.rows(scene)
    rows += from_scratch.closed_forms(scene.law)
    return rows


# Level 1: operators


def _compare_fields(
    name: str, other: Sequence[ElasticOperator], fe: Sequence[ElasticOperator], rtol: float, edge: float, between: Pair
) -> Row:
    """Compare deflections at radii up to three times that of the pressure's edge, root mean square over the area."""
    radii = edge * np.linspace(0.02, 3.0, 150)
    area = radii / radii.sum()

    def rms(w: Array) -> float:
        return float(np.sqrt(area @ w**2))

    def deflections(operators: Sequence[ElasticOperator]) -> tuple[Array, Estimate]:
        w = [op.values_at(radii, op.compliance @ PRESSURES[name](op.radii / edge)) for op in operators]
        return w[-1], Estimate(rms(w[-1]), sum(rms(b - a) for a, b in pairwise(w)) + 1e-12 * rms(w[-1]))

    (w_other, first), (w_fe, second) = deflections(other), deflections(fe)
    budget = USUAL.pointwise * rtol * first.value
    return Row(f"operator: {name}", "beta", first, second, rms(w_fe - w_other), budget, between)


# Level 2: cross-residuals


def _cross_residuals(other: EquilibriumPath, fe: EquilibriumPath, rtol: float, between: Pair) -> Iterator[Row]:
    """Residual, in eps, of each solver's gaps in the other's equations, at every event that both have."""
    for name in other.events:
        if name in fe.events:
            on_other, on_fe = ([stage[name] for stage in path.stages] for path in (other, fe))
            of_other, of_fe = _residual(on_other, on_fe), _residual(on_fe, on_other)
            largest = max(of_other.value, of_fe.value)
            yield Row(f"cross-residual: {name}", "eps", of_other, of_fe, largest, USUAL.residual * rtol, between)


def _residual(found: Sequence[Located], equations: Sequence[Located]) -> Estimate:
    """Mean residual of a state in the other solver's equilibrium, weighted by the magnitude of the pressure, in eps.

    The error is the mean change of the residual from stage to stage, what the state itself is uncertain by, and from
    the last stage but one of the equations to the last: a law that is stiff makes of every ripple of the gap a pressure
    that other nodes see otherwise.
    """
    coarse, fine = (event.problem.interface for event in equations[-2:])
    states = [_carried(event, fine) for event in found]
    residuals = [fine.residual(x)[:-1] for x in states]
    body, before = fine.operator_at(states[-1]), _carried(found[-1], coarse)
    coarser = coarse.operator_at(before)
    by_others = coarser.values_at(np.minimum(body.radii, coarser.extent), coarse.residual(before)[:-1])
    weight = body.weights * np.abs(fine.pressure(states[-1]))
    weight /= weight.sum()
    changes = [weight @ np.abs(b - a) for a, b in pairwise([*residuals, by_others])]
    return Estimate(float(weight @ np.abs(residuals[-1])), float(sum(changes)) + ROUND_OFF)


def _carried(event: Located, target: ContactProblem) -> Array:
    """State of an event on another solver's nodes; on the cells it is its deflection that is carried over."""
    x, source = transfer(event.problem, event.point.x, target), event.problem.interface
    radii = target.operator_at(x).radii
    inside = radii <= source.operator_at(event.problem.surface_state(event.point.x)).extent
    x[:-2][inside] = gaps_at(event, radii[inside])
    return x


# Level 3: events


OF_FOLDS = {"approach": "eps", "load": "R dgamma", "central_gap": "eps"}
COMPARED: Mapping[str, Mapping[str, str]] = {
    "pull_off": {"load": "R dgamma"},
    "jump_on": OF_FOLDS,
    "jump_off": OF_FOLDS,
    "zero_load": {"approach": "eps", "contact_radius": "beta"},
}
"""Quantities compared at each event, and their units; those at every further fold are `OF_FOLDS`."""


def _compare_events(other: EquilibriumPath, fe: EquilibriumPath, rtol: float, between: Pair = SOLVERS) -> Iterator[Row]:
    further = sorted({*other.events, *fe.events} - set(EVENTS), key=lambda name: (len(name), name))
    yield from _at_events({**COMPARED, **dict.fromkeys(further, OF_FOLDS)}, other, fe, rtol, between, other)
    budget = rtol * abs(other.energy.value)
    yield of_values("energy released", "R dgamma eps", other.energy, fe.energy, budget, between)


def _at_events(
    asked: Mapping[str, Mapping[str, str]],
    first: EquilibriumPath | None,
    fe: EquilibriumPath,
    rtol: float,
    between: Pair,
    sized_by: EquilibriumPath,
    prefix: str = "",
) -> Iterator[Row]:
    """Rows of quantities at events; budgets are relative to the numbers of one of the curves.

    Gaps count from the spacing and radii from the axis.
    """
    for event, quantities in asked.items():
        for quantity, unit in quantities.items():
            a, b = (_number(path, event, quantity) if path else None for path in (first, fe))
            known = _number(sized_by, event, quantity)
            value = abs(known.value) if known else 0.0
            sizes = {"load": value, "approach": sized_by.approach_scale}
            budget = rtol * sizes.get(quantity, USUAL.pointwise * (1 + value))
            if any(number and np.isfinite(number.value) for number in (a, b)):
                yield of_values(f"{prefix}{event} {quantity}", unit, a, b, budget, between)


def _number(path: EquilibriumPath, name: str, quantity: str) -> Estimate | None:
    """Number of an event, None if there is none, and one of infinite error where it cannot be told if there is."""
    event = path.event(name)
    if event is None:
        return Estimate(np.nan, np.inf) if name in FOLDS and path.jumps is None else None
    return event.estimate(quantity)


def _by_triangles(scene: Scene, fe: EquilibriumPath, rtol: float) -> Iterator[Row]:
    """Pull-off and jumps by overlapping triangles, a solver of its own, where they know the body and the profile.

    They have no number where they do not converge, so that the row disagrees.
    """
    if scene.checked_by != "half-space" or scene.body.layered or scene.sized:
        return
    rtol = max(rtol, USUAL.share * KERNELS["triangles"].least)
    path = tried(halfspace.trace, **scene.for_half_space, kernel="triangles", rtol=rtol / USUAL.share) or None
    folds = {name: OF_FOLDS[name] for name in ("approach", "load")}
    asked = {"pull_off": COMPARED["pull_off"], **dict.fromkeys(FOLDS, folds)}
    yield from _at_events(asked, path, fe, rtol, TRIANGLES, fe, "triangles: ")
