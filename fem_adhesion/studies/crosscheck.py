"""The cross-check of the half-space solver with the finite-element solver.

Four levels. Operators: both compliances under the same pressures, whole fields compared. Cross-residual: the state
found by one solver put into the equations of the other. Events: pull-off, jumps, the zero-load state, the energy. The
fourth, for what both solvers share, is in `fem_adhesion.studies.from_scratch`. A quantity agrees only if the difference
is within the sum of both error estimates and that sum is within the budget; the estimates come from refinement and from
the size of the block, never from a choice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from skfem import ElementQuadP

import halfspace
from fem_adhesion import convergence
from fem_adhesion.condensed import condense
from fem_adhesion.elasticity import Space
from fem_adhesion.incompressible import stiffness_for
from fem_adhesion.mesh import tensor_grid
from fem_adhesion.scene import Scene
from fem_adhesion.studies import from_scratch
from fem_adhesion.studies.comparison import Row, Verdict, difference, worst
from halfspace import compliance, grid
from halfspace.compliance import Array, ElasticOperator
from halfspace.curve import EquilibriumPath, Estimate, transfer
from halfspace.errors import NotConverged
from halfspace.events import ROUND_OFF, Located
from halfspace.ladder import FOLDS
from halfspace.limits import require_rtol

Solver = Callable[..., EquilibriumPath]

# Budgets in those of loads, approaches and energies, which are averages over the whole contact:
POINTWISE = 10  # of gaps, radii and deflections
RESIDUAL = 50  # of residuals, which see every wiggle of the pressure


@dataclass(frozen=True)
class Failure:
    """A scene that a solver could not solve, with the reason and the rows that need no solution.

    It does not stop the others. A row that disagrees says what is wrong with the solver.
    """

    scene: Scene
    reason: str
    rows: tuple[Row, ...] = ()

    @property
    def shown_by(self) -> tuple[str, ...]:
        """Rows that disagree."""
        return tuple(row.quantity for row in self.rows if row.verdict == "disagree")


@dataclass(frozen=True)
class Case:
    """Both solutions of one scene and their comparison."""

    scene: Scene
    halfspace: EquilibriumPath
    finite_element: EquilibriumPath
    rows: tuple[Row, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst of the rows' verdicts."""
        return worst([row.verdict for row in self.rows])


def compare(
    scene: Scene,
    *,
    rtol: float = 1e-5,
    before: Sequence[Row] | None = None,
    solve: Solver = convergence.trace,
) -> Case:
    """Solve a scene with both solvers and compare on all four levels.

    Parameters
    ----------
    scene : Scene
        The contact; the half-space solver knows its Tabor parameter only.
    rtol : float
        Accuracy of the comparison: budgets are this relative to each quantity.
    before : sequence of Row, optional
        What `unsolved` found before for the same body.
    solve : callable
        Finite-element solver, ``solve(scene, rtol=...)``.

    Raises
    ------
    InputError
        If an input is out of range.
    halfspace.errors.NotConverged
        If a solver fails.
    """
    require_rtol(rtol)
    hs = halfspace.trace(scene.tabor, rtol=max(rtol / 10, 1e-9))
    fe = solve(scene, rtol=0.9 * rtol)
    before = unsolved(scene, rtol=rtol) if before is None else before
    compared = (*_cross_residuals(hs, fe, rtol), *_compare_events(hs, fe, rtol), *from_scratch.events(scene, fe))
    return Case(scene, hs, fe, (*before, *compared))


def run(scenes: Sequence[Scene], *, rtol: float = 1e-5) -> Iterator[Case | Failure]:
    """Compare scenes of one material one after the other; what needs no solution is the same for all, and done once."""
    before: Sequence[Row] | None = None
    for scene in scenes:
        try:
            if before is None:
                before = unsolved(scene, rtol=rtol)
            yield compare(scene, rtol=rtol, before=before)
        except NotConverged as error:
            yield Failure(scene, str(error), tuple(before or ()))


def unsolved(scene: Scene, *, rtol: float = 1e-5) -> list[Row]:
    """Rows that need no solution of the scene: operators, equations and closed forms."""
    hs, fe = _operators(scene, rtol)
    operators = [_compare_fields(name, pressure, hs, fe, rtol) for name, pressure in PRESSURES.items()]
    return [*operators, *from_scratch.equations(scene, fe[1:]), *from_scratch.closed_forms()]


# Level 1: operators


def _operators(scene: Scene, rtol: float) -> tuple[list[ElasticOperator], list[ElasticOperator]]:
    """Half-spaces and blocks, the finest last, on meshes graded towards the edge of the pressures at radius 1."""
    degree = convergence.resolution_for(scene, rtol, 0).degree
    lines = grid.graded(1.0, FINEST, 40.0 if scene.radius is None else scene.radius)
    wider = grid.graded(1.0, FINEST, 2 * lines[-1])
    fe = [_block_operator(scene, lines, degree), _block_operator(scene, wider, degree)]
    fe.append(_block_operator(scene, wider, degree + 1))
    return [compliance.panels(wider, k) for k in (degree + 3, degree + 5)], fe


FINEST = 1e-4  # cells at the edge, where the deflection under a disc has a vertical tangent

PRESSURES: dict[str, Callable[[Array], Array]] = {
    "uniform disc": lambda r: np.where(r < 1, 1.0, 0.0),
    "Hertz": lambda r: np.sqrt(np.maximum(1 - r**2, 0)),
    "spike": lambda r: -1 / (1 + ((r - 1) / 0.05) ** 2) ** 3,
    "ring": lambda r: r**2 / (1 + r**2) ** 4,
}


def _block_operator(scene: Scene, lines: Array, degree: int) -> ElasticOperator:
    space = Space(tensor_grid(lines, grid.graded(0.0, FINEST, lines[-1])), ElementQuadP(degree))
    far_field, stiffness = convergence.FAR_FIELDS[scene.far_field], stiffness_for(scene.poisson)
    return condense(space, scene.poisson, far_field=far_field, stiffness=stiffness).operator


def _compare_fields(
    name: str,
    pressure: Callable[[Array], Array],
    hs: Sequence[ElasticOperator],
    fe: Sequence[ElasticOperator],
    rtol: float,
) -> Row:
    """Compare deflections at radii up to 3, root mean square over the area."""
    radii = np.linspace(0.02, 3.0, 150)
    area = radii / radii.sum()
    w_hs, w_fe = ([op.values_at(radii, op.compliance @ pressure(op.radii)) for op in ops] for ops in (hs, fe))

    def rms(w: Array) -> float:
        return float(np.sqrt(area @ w**2))

    def estimate(w: Sequence[Array]) -> Estimate:
        return Estimate(rms(w[-1]), sum(rms(b - a) for a, b in pairwise(w)) + 1e-12 * rms(w[-1]))

    budget = POINTWISE * rtol * rms(w_hs[-1])
    return Row(f"operator: {name}", "beta", estimate(w_hs), estimate(w_fe), rms(w_fe[-1] - w_hs[-1]), budget)


# Level 2: cross-residuals


def _cross_residuals(hs: EquilibriumPath, fe: EquilibriumPath, rtol: float) -> Iterator[Row]:
    """Residual, in eps, of each solver's gaps in the other's equations, at every event that both have."""
    for name in hs.events:
        if name in fe.events:
            of_hs = _residual([stage[name] for stage in hs.stages], fe.stages[-1][name])
            of_fe = _residual([stage[name] for stage in fe.stages], hs.stages[-1][name])
            largest = max(of_hs.value, of_fe.value)
            yield Row(f"cross-residual: {name}", "eps", of_hs, of_fe, largest, RESIDUAL * rtol)


def _residual(found: Sequence[Located], equations: Located) -> Estimate:
    """Mean residual of a state in the other solver's equilibrium, weighted by the magnitude of the pressure, in eps.

    The error is the mean change of the residual from stage to stage: what the state itself is uncertain by.
    """
    target = equations.problem.interface
    states = [transfer(event.problem, event.point.x, target) for event in found]
    residuals = [target.residual(x)[:-1] for x in states]
    weight = target.operator_at(states[-1]).weights * np.abs(target.pressure(states[-1]))
    weight /= weight.sum()
    changes = [weight @ np.abs(b - a) for a, b in pairwise(residuals)]
    return Estimate(float(weight @ np.abs(residuals[-1])), float(sum(changes)) + ROUND_OFF)


# Level 3: events


def _compare_events(hs: EquilibriumPath, fe: EquilibriumPath, rtol: float) -> Iterator[Row]:
    for event, quantity, unit, pointwise in EVENT_QUANTITIES:
        a, b = (_number(path, event, quantity) for path in (hs, fe))
        if not (a and np.isfinite(a.value)) and not (b and np.isfinite(b.value)):
            continue
        budget = (POINTWISE if pointwise else 1) * rtol * _size(quantity, a.value if a else 0.0, hs)
        yield Row(f"{event} {quantity}", unit, a, b, difference(a, b), budget)
    off, budget = difference(hs.energy, fe.energy), rtol * abs(hs.energy.value)
    yield Row("energy released", "R dgamma eps", hs.energy, fe.energy, off, budget)


def _size(quantity: str, value: float, path: EquilibriumPath) -> float:
    """What a budget is relative to; gaps count from the spacing and radii from the axis."""
    return {"load": abs(value), "approach": path.approach_scale}.get(quantity, 1 + abs(value))


EVENT_QUANTITIES = (
    ("pull_off", "load", "R dgamma", False),
    ("jump_on", "approach", "eps", False),
    ("jump_on", "load", "R dgamma", False),
    ("jump_on", "central_gap", "eps", True),
    ("jump_off", "approach", "eps", False),
    ("jump_off", "load", "R dgamma", False),
    ("jump_off", "central_gap", "eps", True),
    ("zero_load", "approach", "eps", False),
    ("zero_load", "contact_radius", "beta", True),
)


def _number(path: EquilibriumPath, name: str, quantity: str) -> Estimate | None:
    """Number of an event, None if there is none, and one of infinite error where it cannot be told if there is."""
    event = path.event(name)
    if event is None:
        return UNTOLD if name in FOLDS and path.jumps is None else None
    return Estimate(getattr(event, quantity), getattr(event, f"{quantity}_error"))


UNTOLD = Estimate(float("nan"), float("inf"))
