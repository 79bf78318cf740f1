"""Curves at neighbouring Tabor parameters: a few are traced, and the events of those between are followed from them.

All are on the same grids, so that the states of an event are vectors that change smoothly with the logarithm of the
Tabor parameter: the next is where the polynomial through the known ones has it, but for a step or two of Newton's
method. What folds a curve has cannot be told without tracing it; but they come and go in pairs, at cusps. Between two
curves near to each other that fold equally often none is taken to fold more or less often, and between any two others
the one in the middle is traced as well. Nor does one event take the place of another unseen, as the deepest of two
minima of the load may: what is found would lie far from where neighbours on both sides have it, and is traced then.

That folds do not come and go again between two Tabor parameters so near is an assumption. A curve in the middle is a
witness of it, and what has a law with a second minimum, where folds may do so, is not followed. Nor is what has one
that ends by a step: each of its states is on a grid of its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from halfspace.accuracy.grids import Grids, Resolution
from halfspace.accuracy.refinement import climb, energy_along
from halfspace.accuracy.stages import Charted, Rung, State
from halfspace.accuracy.trace import half_space_rung
from halfspace.elastic.grid import polynomial
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import Chart, Stage, metric_for
from halfspace.equilibrium.conditions import FOLD, Located, relocate
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import JumpStates, StagedJump, apart, landing_of, staged_jumps
from halfspace.equilibrium.events import EVENTS, Event, Tolerance, usual
from halfspace.equilibrium.path import Point
from halfspace.equilibrium.search import brackets_of
from halfspace.errors import NotConverged
from halfspace.laws import Law
from halfspace.profiles import Profile
from halfspace.scales import Scales
from halfspace.values import Array, Estimate, Valued

RATIO = 1.5  # of the largest Tabor parameter to the least on the same grids
FEWEST, MOST = 4, 16  # curves on the same grids: of three all are traced; what more there are is work for other cores
THROUGH = 4  # curves from which one is followed
# Of the distance between the neighbours, by which a state may be off where it is expected: between two curves of the
# same grids it was up to 0.08, from three on 0.003; it is about a half where one of two events is taken for the other.
OFF = 0.2
NUMBERS = ("x", "observables", "tangent", "rates")
LANDING = "landing"  # of the jump on
STATES = ("separated", "zero_approach", *EVENTS)


@dataclass(frozen=True)
class Summary:
    """What a sweep keeps of one curve, or why it could not be traced, then without events and with energies of nan.

    The energies, in R dgamma eps, are released from separation to zero approach in contact, and lost in a cycle under
    fixed grips: zero if the curve does not fold, nan if that cannot be told. `missed` are, by event, the numbers whose
    estimated errors exceed what was asked for.
    """

    tabor: float
    events: Mapping[str, Event]
    energy: Estimate
    energy_lost: Estimate
    missed: Mapping[str, tuple[str, ...]]
    reason: str = ""

    @classmethod
    def of(cls, path: EquilibriumPath, jumps: Sequence[StagedJump]) -> Summary:
        """Keep the numbers of a curve, of which fixed grips take these jumps."""
        lost = _lost(jumps, path.remaining) if jumps or path.jumps is False else UNKNOWN
        return cls(path.tabor, usual(path.events), path.energy, lost, path.missed)

    @classmethod
    def failed(cls, tabor: float, reason: str) -> Summary:
        """Say why there is no curve."""
        return cls(tabor, {}, UNKNOWN, UNKNOWN, {}, reason)


UNKNOWN = Estimate(math.nan, math.nan)


def _lost(jumps: Sequence[StagedJump], remaining: float) -> Estimate:
    return sum((jump.energy(remaining) for jump in jumps), Estimate(0.0, 0.0))


Turns = tuple[int, dict[str, tuple[bool, ...]]]
"""How often a curve folds, and of its states by name, whether they are on the chart of each stage that follows."""


@dataclass(frozen=True, eq=False, repr=False)
class Known(Valued):
    """A curve as its neighbours need it: how it `turns`, None if none is followed from it, and its states.

    The states by name are on three stages: the rung of the curve, that of the events, and its twin.
    """

    summary: Summary
    turns: Turns | None = None
    stages: tuple[State, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class Family(Valued):
    """Contacts with the half-space at Tabor parameters between two, all on the grids of the larger, the finer ones.

    The attraction is wider at the smaller: so are the grids.
    """

    law: Law
    profile: Profile
    rtol: float
    to_load: float
    least: float
    largest: float
    _grids: dict[Resolution, Grids] = field(default_factory=dict)

    def scales(self, tabor: float) -> Scales:
        """Lengths at a Tabor parameter."""
        return Scales(tabor, self.law, self.profile.surface(tabor))

    def charts(self, tabor: float, resolution: Resolution) -> tuple[Chart, Chart]:
        """Both charts of one contact."""
        if resolution not in self._grids:
            wide = replace(resolution, extent=resolution.extent * math.sqrt(self.largest / self.least))
            self._grids[resolution] = Grids.of(self.scales(self.largest), wide, self.to_load)
        return self._grids[resolution].charts(self.scales(tabor))

    def rung(self, tabor: float, level: int) -> Rung:
        """Rung of a level for one contact."""
        return half_space_rung(self.scales(self.largest), self.rtol, partial(self.charts, tabor), level)

    def traced(self, tabor: float) -> Known:
        """Trace a curve; others are followed from it if it was solved for on the lowest two rungs, with no doubt."""
        try:
            path = climb(self.rtol, partial(self.rung, tabor), to_load=self.to_load)
            jumps = staged_jumps(path)
        except NotConverged as error:
            return Known(Summary.failed(tabor, str(error)))
        summary = Summary.of(path, jumps)
        if path.below or path.margin or len(jumps) not in (0, 2):
            return Known(summary)
        states = [{name: state[name] for name in STATES if name in state} for state in (*path.stages, path.on_twin)]
        if jumps:
            on = jumps[0]
            for state, jump in zip(states, (on.others[0], on.fine, on.others[1]), strict=True):
                state[LANDING] = jump.landing
        return Known(summary, _turns(path, states), tuple(states))

    def followed(self, tabor: float, known: Sequence[Known]) -> Known:
        """Solve for the states of a curve from those of others, which turn alike; NotConverged if it has to be traced.

        The first two of the others are the nearest.
        """
        lowest, rung = (self.rung(tabor, level) for level in (0, 1))
        stages: list[Stage] = [Charted(tuple(lowest.curve())), *rung.stages, *filter(None, [rung.twin])]
        weights = polynomial(np.log([k.summary.tabor for k in known]), math.log(tabor))
        below, fine, twin = states = [
            _followed(stage, [k.stages[number] for k in known], weights) for number, stage in enumerate(stages)
        ]
        chains = [[below, fine], [twin, fine]]
        events = rung.estimates(chains)
        if Tolerance.on(events, self.rtol).missed(events):
            raise NotConverged("more rungs are needed; trace it")
        lost = _lost(_jumps(below, fine, twin), rung.rule.remaining)
        return Known(Summary(tabor, events, energy_along(chains, rung), lost, {}), known[0].turns, tuple(states))


def _turns(path: EquilibriumPath, states: Sequence[State]) -> Turns:
    """How a curve turns, with its states on several stages."""
    charts = {name: tuple(state[name].problem.interface.follows_contact for state in states) for name in states[0]}
    return len(brackets_of(path.segments, FOLD)), charts


def _followed(stage: Stage, known: Sequence[State], weights: Array) -> State:
    """All states on a stage, by those of other curves on theirs, whose weights these are."""
    state = {name: _state(name, stage, [k[name] for k in known], weights) for name in known[0] if name != LANDING}
    if LANDING in known[0]:
        events = [k[LANDING] for k in known]
        at = _expected(events, weights)
        state[LANDING] = _near(at, events, landing_of(state["jump_on"], stage(events[0]).problem, at.x))
    return state


def _state(name: str, stage: Stage, known: Sequence[Located], weights: Array) -> Located:
    """State of a name."""
    problem, at = stage(known[0]).problem, _expected(known, weights)
    condition = known[0].condition
    if name == "separated":  # at an approach that depends on the Tabor parameter
        condition = replace(condition, value=problem.interface.scales.separated_approach)
    event = Located(condition, problem, at, known[0].slope)
    return _near(at, known, relocate(event, problem, at.x, metric_for(problem)))


def _expected(known: Sequence[Located], weights: Array) -> Point:
    """Where an event is by those of others."""
    points = [k.point for k in known]
    x, observables, tangent, rates = (np.tensordot(weights, [getattr(p, name) for p in points], 1) for name in NUMBERS)
    return replace(points[0], x=x, observables=observables, tangent=tangent, rates=rates)


def _near(at: Point, known: Sequence[Located], found: Located) -> Located:
    """State found, unless it is far from where it was expected: then there are two, and NotConverged."""
    metric = metric_for(found.problem)
    if metric.distance(found.point, at) > OFF * metric.distance(known[0].point, known[1].point):
        raise NotConverged("a state is not where its neighbours have it; trace the curve")
    return found


def _jumps(below: State, fine: State, twin: State) -> list[StagedJump]:
    """The jump on and that off, where the curve folds."""
    if LANDING not in fine:
        return []
    states = (fine, below, twin)
    on = [JumpStates(s["jump_on"], s[LANDING], on=True) for s in states]
    off = [JumpStates(s["jump_off"], apart(s["separated"].problem, s["jump_off"]), on=False) for s in states]
    return [StagedJump(first, tuple(others)) for first, *others in (on, off)]


def families(tabors: Sequence[float], law: Law, profile: Profile, body: LayeredBody | None) -> list[tuple[float, ...]]:
    """Tabor parameters whose curves are best computed together, in order, the largest, which take longest, first.

    Those of a surface that scales as the half-space does are so many that some lie between others, or one.
    """
    found: dict[int, list[float]] = {}
    for tabor in sorted(set(tabors)):
        found.setdefault(_rank(tabor), []).append(tabor)
    parts = [
        part
        for family in found.values()
        for part in (_cut(family) if len(family) >= FEWEST and _alike(family, law, profile, body) else zip(family))
    ]
    return sorted(parts, reverse=True)


def _cut(family: Sequence[float]) -> list[tuple[float, ...]]:
    """Parts of a family, equally long but for one: their grids are the family's all the same."""
    ends = np.linspace(0, len(family), math.ceil(len(family) / MOST) + 1).astype(int)
    return [tuple(family[first:last]) for first, last in pairwise(ends)]


def _rank(tabor: float) -> int:
    return math.floor(math.log(tabor) / math.log(RATIO))


def _alike(family: Sequence[float], law: Law, profile: Profile, body: LayeredBody | None) -> bool:
    """Whether contacts differ by nothing but the Tabor parameter, and their cells by its scales alone."""
    first, last = (profile.surface(tabor) for tabor in (family[0], family[-1]))
    scales = Scales(family[0], law, first)
    smooth = not law.outermost and not scales.step_gap
    return body is None and first == last and math.isinf(first.end) and smooth


def family_of(tabors: Sequence[float], **settings: Any) -> Family:
    """Family of which these are."""
    least = RATIO ** _rank(tabors[0])
    return Family(least=min(least, tabors[0]), largest=max(least * RATIO, tabors[-1]), **settings)


def curves(tabors: Sequence[float], family: Family) -> list[Summary]:
    """Curves at Tabor parameters of a family, in order: its ends and its middle are traced."""
    last = len(tabors) - 1
    found = {number: family.traced(tabors[number]) for number in sorted({0, last // 2, last})}

    def fill(first: int, last: int) -> None:
        """Find what is between two curves that are known."""
        if last - first > 1:
            middle = (first + last) // 2
            if found[first].turns and found[first].turns == found[last].turns:
                with suppress(NotConverged):
                    found[middle] = family.followed(tabors[middle], _nearest(found, tabors[middle], found[first].turns))
            if middle not in found:
                found[middle] = family.traced(tabors[middle])
            fill(first, middle)
            fill(middle, last)

    fill(0, last // 2)
    fill(last // 2, last)
    return [found[number].summary for number in range(len(tabors))]


def _nearest(found: Mapping[int, Known], tabor: float, turns: Turns | None) -> list[Known]:
    """Curves that turn alike, the nearest first."""
    alike = (known for known in found.values() if known.turns == turns)
    return sorted(alike, key=lambda known: abs(math.log(known.summary.tabor / tabor)))[:THROUGH]
