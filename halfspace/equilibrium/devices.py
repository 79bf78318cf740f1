"""Loading devices: where an apparatus of given stiffness jumps on and off, where it lands, and what energy is lost.

The contact hangs on a spring whose other end, the base, is moved: b = alpha* + W/k. Fixed grips are the spring of
infinite stiffness. The contact jumps at the folds of the base along the path, where it is tangent to a load line of
slope -k, and lands on the next stable state along the path at the same base: that is where the motion by which the
energy falls ends. With E the energy of the contact, a jump sets free

    E + W^2/(2k) at take-off  -  E + W^2/(2k) at landing,

and a cycle loses what its jumps set free, one on and one off unless the curve has stable states between its folds: it
equals the work of the base round the loop, as d(E + W^2/2k) = W db.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.charts import Stage, metric_for, separated, settled, transfer
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import APPROACH, LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import ErrorRule, Event, Tolerance, approach_scale, estimate_event
from halfspace.equilibrium.newton import Control, Traceable
from halfspace.equilibrium.path import Segment, solved_point
from halfspace.equilibrium.search import energy_size, states
from halfspace.equilibrium.states import measured
from halfspace.errors import InputError, NotConverged, Unsolved, required, tried
from halfspace.limits import require_number
from halfspace.values import Array, Estimate


@dataclass(frozen=True)
class DeviceSettings:
    """How far the curve is followed to the jumps of a soft apparatus, which take off far from contact."""

    farther: float = 1.5  # margin by which the points added to a curve reach past the jump
    nearer: float = 1.1  # and past its beginning
    points: int = 12  # so added
    widths: float = 1.7  # of the attraction, where the undeformed gap has doubled: what finite cells should cover


HOW = DeviceSettings()


@dataclass(frozen=True)
class Jump:
    """A jump of the contact at a fixed base: the states before and after, and the energy set free, in R dgamma eps."""

    take_off: Event
    landing: Event
    energy: Estimate

    @property
    def ends(self) -> tuple[Event, Event]:
        """Both states."""
        return self.take_off, self.landing


@dataclass(frozen=True)
class Cycle:
    """One approach and separation by an apparatus of a stiffness in R dgamma/eps, infinite for fixed grips.

    Jumps `on` are from separation into contact, A to B in [G97] Fig. 2a, and `off` back, C to D, each in its order:
    more than one where the curve has stable states between two of its folds. The energy lost is in the whole cycle, in
    R dgamma eps; the tolerance is what was asked of the curve, and so of these states, by the range of their approaches
    too: a soft apparatus lands far away.
    """

    stiffness: float
    on: tuple[Jump, ...]
    off: tuple[Jump, ...]
    energy_lost: Estimate
    tolerance: Tolerance

    @property
    def jump_on(self) -> Jump:
        """The first from separation."""
        return self.on[0]

    @property
    def jump_off(self) -> Jump:
        """The first from contact."""
        return self.off[0]

    @property
    def jumps(self) -> dict[str, Jump]:
        """All by name, ``jump_on``, ``jump_on_2`` ... ``jump_off``, ``jump_off_2`` ..."""
        return {
            name if number == 1 else f"{name}_{number}": jump
            for name, jumps in (("jump_on", self.on), ("jump_off", self.off))
            for number, jump in enumerate(jumps, 1)
        }

    @property
    def met(self) -> bool:
        """Whether all states have their loads and approaches to the accuracy asked for."""
        return not self.missed

    @property
    def missed(self) -> dict[str, tuple[str, ...]]:
        """By state, as ``jump_on landing``, the numbers that have not."""
        states = {f"{name} {end}": self.missed_by(name, end) for name in self.jumps for end in ENDS}
        return {name: numbers for name, numbers in states.items() if numbers}

    def missed_by(self, name: str, end: str) -> tuple[str, ...]:
        """Numbers of one end of a jump, ``take_off`` or ``landing``, that have not the accuracy asked for.

        The load at a landing counts by the larger one of its jump: of a contact that has parted nearly none is left.
        """
        jump = self.jumps[name]
        load = abs(jump.take_off.load) if end == "landing" else 0.0
        return self.tolerance.missed_by(getattr(jump, end), load)


@dataclass(frozen=True)
class JumpStates:
    """Take-off and landing of one jump, on or off, on one discretisation."""

    take_off: Located
    landing: Located
    on: bool

    def energy(self, compliance: float) -> float:
        """Energy set free, that of the spring included."""
        return _energy(self.take_off, compliance) - _energy(self.landing, compliance)


@dataclass(frozen=True)
class StagedJump:
    """A jump on chains of discretisations, by whose changes errors are told, all of which end with the finest."""

    chains: list[list[JumpStates]]

    @property
    def fine(self) -> JumpStates:
        """The jump on the finest discretisation."""
        return self.chains[0][-1]

    def energy(self, rule: ErrorRule, compliance: float = 0.0) -> Estimate:
        """Energy set free with an apparatus of a compliance 1/k."""
        energies = [[states.energy(compliance) for states in chain] for chain in self.chains]
        sizes = sum(energy_size(end) for end in (self.fine.take_off, self.fine.landing))
        return replace(rule, remaining=max(rule.remaining, 1.0)).estimate(energies, sizes)


def cycle(path: EquilibriumPath, stiffness: float = math.inf) -> Cycle | None:
    """All jumps of a cycle with an apparatus of given stiffness, or None where the contact follows it smoothly.

    With fixed grips also where that cannot be told: see `halfspace.equilibrium.curve.EquilibriumPath.jumps`. The
    stiffness is in R dgamma/eps, or InputError unless positive; a dead load is the limit of none: it jumps off at
    ``pull_off``, never to land. NotConverged if a landing cannot be solved for.
    """
    stiffness = require_number(stiffness, "stiffness")
    if not stiffness > 0:
        raise InputError(f"stiffness = {stiffness:g} is outside 0 < stiffness; a dead load jumps off at pull_off")
    staged = staged_jumps(path, stiffness)
    if not staged:
        return None
    on, off = (tuple(_jump(s, path, 1 / stiffness) for s in staged if s.fine.on is way) for way in (True, False))
    lost = sum((jump.energy for jump in (*on, *off)), Estimate(0.0, 0.0))
    states = [state for jump in (*on, *off) for state in jump.ends]
    scale = approach_scale(state.approach for state in (*path.events.values(), *states))
    return Cycle(stiffness, on, off, lost, Tolerance(path.tolerance.rtol, scale))


def staged_jumps(path: EquilibriumPath, stiffness: float = math.inf) -> list[StagedJump]:
    """Jumps of a `cycle`, those on and then those off, on all the discretisations that their errors are told from."""
    if math.isinf(stiffness) and not path.jumps:
        return []
    rough, again = jumps(reaching(path, stiffness).segments, 1 / stiffness), partial(_refined, 1 / stiffness)
    return [StagedJump(required(path.ladder.chains(required(again(path.finest, one)), again))) for one in rough]


def energy_lost(segments: Sequence[Segment]) -> float:
    """Energy lost in a cycle under fixed grips on one discretisation, 0 if the traced curve does not fold."""
    return sum((jump.energy(0.0) for jump in jumps(segments, 0.0)), 0.0)


def jumps(segments: Sequence[Segment], compliance: float) -> list[JumpStates]:
    """Jumps on in their order, then jumps off, with compliance 1/k, on the discretisation of the curve itself."""
    folds = _in_order(segments, Condition(APPROACH, stationary=True, compliance=compliance))
    if not folds:
        return []
    segments, folds = _cut(segments, folds)
    return [*_on(segments, folds, compliance), *_off(segments, folds, compliance)]


@dataclass(frozen=True)
class _Placed:
    """A state and its place along a curve: the number of its segment, and the arclength there."""

    place: tuple[int, float]
    state: Located

    @property
    def stable(self) -> bool:
        """Whether it is stable with the base held."""
        point, base = self.state.point, self.state.condition
        return base.rate(point) * point.rates[APPROACH] > 0 and not self.state.problem.negative_directions(point.x)


def _in_order(segments: Sequence[Segment], condition: Condition) -> list[_Placed]:
    """States of a curve that meet a condition, in order along it."""
    return [
        _Placed((number, state.point.arclength), state)
        for number, segment in enumerate(segments)
        for state in states([segment], condition)
    ]


def _cut(segments: Sequence[Segment], folds: Sequence[_Placed]) -> tuple[list[Segment], list[_Placed]]:
    """Curve with its folds among its points, lest a landing hide with one between two of them; and these on it."""
    whole: list[Segment] = []
    placed: list[_Placed] = []
    for number, segment in enumerate(segments):
        own = [fold.state for fold in folds if fold.place[0] == number]
        points = sorted([*segment.points, *(fold.point for fold in own)], key=lambda point: point.arclength)
        whole.append(measured(segment.problem, points, metric_for(segment.problem)))
        places = {id(point): anew.arclength for point, anew in zip(points, whole[-1].points, strict=True)}
        placed += [_Placed((number, places[id(fold.point)]), fold) for fold in own]
    return whole, placed


def _on(segments: Sequence[Segment], folds: Sequence[_Placed], compliance: float) -> Iterator[JumpStates]:
    """Jumps on: from the first fold, and from that at the end of each stable stretch that is landed on."""
    passed = 0
    while passed < len(folds):
        fold, following = folds[passed], folds[passed + 1 :]
        met = _in_order(segments, _held(fold.state, compliance))
        beyond = [s for s in met if following and s.place > following[0].place]
        if not beyond:
            load = segments[-1].points[-1].observables[LOAD]
            raise NotConverged(
                f"the landing of the jump on lies beyond the end of the curve at load {load:.3g} R dgamma; trace it to "
                "a larger to_load"
            )
        landing = next((state for state in beyond[:-1] if state.stable), beyond[-1])
        yield JumpStates(fold.state, landing.state, on=True)
        passed = sum(fold.place < landing.place for fold in folds)


def _off(segments: Sequence[Segment], folds: Sequence[_Placed], compliance: float) -> Iterator[JumpStates]:
    """Jumps off: from the last fold, and from that at the other end of each stable stretch that is landed on."""
    left = len(folds)
    while left:
        fold, before = folds[left - 1], folds[: left - 1]
        met = _in_order(segments, _held(fold.state, compliance))
        between = [s for s in met if before and before[0].place < s.place < before[-1].place]
        landing = next((state for state in reversed(between) if state.stable), None)
        landed = landing.state if landing else apart(segments[0].problem, fold.state, compliance)
        yield JumpStates(fold.state, landed, on=False)
        left = sum(fold.place < landing.place for fold in folds) if landing else 0


def apart(problem: Traceable, off: Located, compliance: float = 0.0) -> Located:
    """State of the separated branch at the base of a jump off, which may be beyond the beginning of the curve."""
    base = _held(off, compliance).value
    separated = widened(problem, base)
    return required(landing_of(off, separated, separated.undeformed(base), compliance))


def _held(state: Located, compliance: float) -> Condition:
    """The base at a state, b = alpha* + W/k, as it is held in a jump from there."""
    base = Condition(APPROACH, compliance=compliance)
    return replace(base, value=base.level(state.point))


def landing_of(take_off: Located, problem: Traceable, start: Array, compliance: float = 0.0) -> Located | Unsolved:
    """State on a discretisation at the base of a take-off."""
    held = _held(take_off, compliance)
    point = solved_point(problem, start, Control(held.weights, held.value), metric_for(problem), held.weights)
    return point and Located(held, problem, point, 1.0)


def _refined(compliance: float, stage: Stage, states: JumpStates) -> JumpStates | Unsolved:
    """Both states of a jump on another discretisation."""
    fold = settled(states.take_off, stage, lambda state, problem: stage.moved(state, _wide_enough(state, problem)))
    if not fold:
        return fold
    take_off: Located = fold

    def land(state: Located, problem: Traceable) -> Located | Unsolved:
        wide = _wide_enough(state, problem)
        found = tried(landing_of, take_off, wide, transfer(state.problem, state.point.x, wide), compliance)
        # Where that is too far off, along the path.
        there = replace(state, condition=_held(take_off, compliance))
        return found or stage.moved(there, wide)

    landing = settled(states.landing, stage, land)
    return landing and JumpStates(take_off, landing, states.on)


def _wide_enough(state: Located, problem: Traceable) -> Traceable:
    return widened(problem, float(state.point.observables[APPROACH]))


def _jump(staged: StagedJump, path: EquilibriumPath, compliance: float) -> Jump:
    """Jump as numbers, their errors by the changes from one discretisation to another."""
    rule = path.ladder.rule
    alone = replace(rule, along=path.ladder.twin is None)  # no chain from a twin guards against chance
    take_offs, landings = ([[getattr(s, end) for s in chain] for chain in staged.chains] for end in ENDS)
    return Jump(
        estimate_event("take_off", take_offs, alone),
        estimate_event("landing", landings, replace(rule, along=False)),
        staged.energy(rule, compliance),
    )


ENDS = ("take_off", "landing")


def _energy(state: Located, compliance: float) -> float:
    """E + W^2/(2k)."""
    return state.problem.energy(state.point.x) + float(compliance * state.point.observables[LOAD] ** 2 / 2)


# How far the grids must go: a soft apparatus jumps on from beyond the curve's first point


def reaching(path: EquilibriumPath, stiffness: float) -> EquilibriumPath:
    """Extend a curve to the separation from which an apparatus of the given stiffness jumps on, if it has to be."""
    first = path.segments[0]
    jump = first.problem.interface.scales.rigid_jump_on(stiffness)
    if jump > float(first.points[0].observables[APPROACH]) / HOW.nearer:
        return path
    return replace(path, segments=(_far_segment(first, jump), *path.segments))


def widened(problem: Traceable, approach: float) -> Traceable:
    """Problem whose cells cover the attraction at a separation, which widens as its root: the same if they do already.

    So are those whose grid follows the contact, or whose surface law does not act to infinity.
    """
    if not isinstance(problem, ContactProblem) or not isinstance(problem.operator, ElasticOperator):
        return problem
    body, h, scales = problem.operator, 1 - approach, problem.scales
    reach = max(scales.radius_at(HOW.widths**2 * max(h, 0.0)) / body.extent, scales.tail_reach)
    if not body.beyond.size or reach <= scales.tail_reach:
        return problem
    nodes = min(body.beyond.size, body.cell_nodes.shape[1])
    return replace(problem, operator=body.widened(nodes, reach))


def _far_segment(first: Segment, jump: float) -> Segment:
    """Points of the separated branch from beyond a jump to past the first point of a curve."""
    far, near = 1 - HOW.farther * jump, 1 - float(first.points[0].observables[APPROACH]) / HOW.nearer
    problem = widened(first.problem, 1 - far)
    metric = metric_for(problem)
    points = [
        required(separated(problem, approach, metric))
        for approach in (1 - np.geomspace(far, near, HOW.points)).tolist()
    ]
    return measured(problem, points, metric)
