"""Special points of the load-approach curve as numbers: their names, their errors, and whether these are asked for."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from halfspace.equilibrium.charts import metric_for
from halfspace.equilibrium.conditions import ROUND_OFF, Located
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, CONTACT_RADIUS, LOAD, OBSERVABLES
from halfspace.errors import InputError, nearest
from halfspace.laws.law import Law
from halfspace.values import Array, Estimate

T = TypeVar("T")
FOLDS = ("jump_on", "jump_off")  # the outermost in the approach
EVENTS = ("pull_off", *FOLDS, "zero_load")
FURTHER = re.compile(r"fold_([2-9]|[1-9]\d+)")  # the folds between the jumps, by their numbers along the curve
# Of the accuracy asked for, that no event is told to be known better than. At 5e-4 the load at pull-off of three strata
# was 3.5 times outside, alike on three grids by accident, and is 1.9 times now; at 0.01 the median estimate on the
# half-space is above 100 true errors.
LEAST = 0.005
REMAINING = 0.5  # of a change between two discretisations: what is left if each errs at most a third of the one before


@dataclass(frozen=True)
class Event:
    """A special point of the curve, with the estimated error of each number.

    Attributes
    ----------
    name : str
        ``pull_off`` (global minimum of the load), ``jump_on``, ``jump_off`` (the first and the last fold, that a
        fixed-grips experiment meets coming from separation and from contact), ``fold_2``, ``fold_3`` ... (those
        between them, in order along the curve), ``zero_load`` (the contact branch where W = 0).
    approach, approach_error : float
        In eps.
    load, load_error : float
        In R dgamma, positive in compression.
    central_gap, central_gap_error : float
        H(0) in eps, zero at the equilibrium spacing.
    contact_radius, contact_radius_error : float
        In beta, of the edge where the tension is largest, H = 3^(1/6) - 1 by the 3-9 law; nan if H(0) exceeds that,
        its error then infinite if that of H(0) leaves it open.
    """

    name: str
    approach: float
    load: float
    central_gap: float
    contact_radius: float
    approach_error: float
    load_error: float
    central_gap_error: float
    contact_radius_error: float

    def estimate(self, quantity: str) -> Estimate:
        """One of its numbers with its error: approach, load, central_gap or contact_radius."""
        return Estimate(getattr(self, quantity), getattr(self, f"{quantity}_error"))

    @property
    def numbers(self) -> dict[str, float]:
        """Its numbers with their errors, by name."""
        return {key: getattr(self, key) for name in OBSERVABLES for key in (name, f"{name}_error")}


class Unconfirmed(NamedTuple):
    """About where a curve as it was traced has a fold that no finer grid has, so that it cannot be told.

    The approach and the central gap are in eps, the load in R dgamma, positive in compression.
    """

    approach: float
    load: float
    central_gap: float


def is_event(name: str) -> bool:
    """Whether curves have events of this name."""
    return name in EVENTS or is_fold(name)


def is_fold(name: str) -> bool:
    """Whether events of this name are folds in the approach."""
    return name in ("jump_on", "jump_off") or bool(FURTHER.fullmatch(name))


def numbered(folds: Iterable[T]) -> dict[str, T]:
    """Folds between the jumps by name, given in order along the curve."""
    return {f"fold_{number}": fold for number, fold in enumerate(folds, 2)}


def usual(events: Mapping[str, T]) -> dict[str, T]:
    """Events but for the folds between the jumps."""
    return {name: events[name] for name in EVENTS if name in events}


def approach_scale(approaches: Iterable[float], spacing: float = 1.0) -> float:
    """Size by which errors and deviations of approaches count: the spacing and the range of those of a path's events.

    An approach has no natural zero: its own size says where somebody began to count. Nor has the position of a base.
    The approaches are those at the events of one path, at least one; the spacing of the surfaces, eps, is in their
    unit.
    """
    values = list(approaches)
    return spacing + max(values) - min(values)


@dataclass(frozen=True)
class Tolerance:
    """Relative accuracy asked of the loads and approaches of a path's events, and of jumps on it.

    Gaps and radii, values at one point, are not asked to have it: their errors say what they are worth. `rtol` is of a
    load, in its own size; `approach` is what approaches, which have no natural zero, are measured by, in eps: see
    `approach_scale`.
    """

    rtol: float
    approach: float

    @classmethod
    def on(cls, events: Mapping[str, Event], rtol: float) -> Tolerance:
        """Tolerance on the path of these events."""
        return cls(rtol, approach_scale(event.approach for event in events.values()))

    def missed_by(self, event: Event, load: float = 0.0) -> tuple[str, ...]:
        """``approach`` and ``load`` of an event if their estimated errors exceed it, but no load that is zero.

        A load counts by its own size, or by that of a greater `load` in R dgamma which it is a remainder of.
        """
        size = math.inf if event.name == "zero_load" else max(load, abs(event.load))
        sizes = {"approach": self.approach, "load": size}
        return tuple(name for name, size in sizes.items() if not getattr(event, f"{name}_error") <= self.rtol * size)

    def missed(self, events: Mapping[str, Event]) -> dict[str, tuple[str, ...]]:
        """By event, the numbers that miss it; empty if it is met."""
        return {name: numbers for name, event in events.items() if (numbers := self.missed_by(event))}


class WithEvents:
    """What a load-approach curve that was solved to a relative accuracy says of its events."""

    events: Mapping[str, Event]
    settings: Mapping[str, Any]

    @property
    def rtol(self) -> float:
        """Relative accuracy that was asked of loads and approaches."""
        return float(self.settings["rtol"])

    @property
    def tolerance(self) -> Tolerance:
        """What `rtol` means for loads and approaches."""
        return Tolerance.on(usual(self.events), self.rtol)

    @property
    def missed(self) -> dict[str, tuple[str, ...]]:
        """By event, the numbers whose estimated errors exceed `tolerance`."""
        return self.tolerance.missed(usual(self.events))

    @property
    def met(self) -> bool:
        """Whether the events have their loads and approaches to the accuracy asked for; `missed` says which have not.

        The folds between the jumps, as they are, do not count.
        """
        return not self.missed

    def event(self, name: str) -> Event | None:
        """Event by name, or None if the curve does not have it; InputError if no curve has an event of that name."""
        if not is_event(name):
            near = nearest(name, EVENTS)
            remedy = f'did you mean "{near}"?' if near else "take one of these, or fold_2, fold_3 ... between the jumps"
            raise InputError(f'event = "{name}" is none of {", ".join(EVENTS)}; {remedy}')
        return self.events.get(name)

    @property
    def stable_under_dead_load(self) -> NDArray[np.bool_]:
        """Stability of the points under a dead load: stable under fixed grips and dW/dalpha positive, (points,)."""
        path: Any = self  # each kind of curve has its own `stable` and `rates`
        return np.asarray(path.stable & (path.rates[:, LOAD] * path.rates[:, APPROACH] > 0))

    def to_dict(self) -> dict[str, Any]:
        """All numbers as plain data: events, points, and what they rest on.

        ``events`` are by name, each a mapping of its numbers and their errors, ``approach`` ... and
        ``approach_error`` ..., and which of them are ``missed``; ``curve`` has the arrays of the points by name, with
        ``stable_under_fixed_grips`` and ``stable_under_dead_load``; all else is as the attributes.
        """
        tolerance = self.tolerance
        return {
            "events": {name: {**e.numbers, "missed": tolerance.missed_by(e)} for name, e in self.events.items()},
            "curve": points_of(self),
            **{name: getattr(self, name) for name in ("met", "unknowns", "seconds", "settings")},
        }


def points_of(path: Any) -> dict[str, Array]:
    """Arrays of the points of a load-approach curve by name, with their errors and stability."""
    names = ("arclength", *OBSERVABLES, *(f"{name}_error" for name in OBSERVABLES))
    stable = {"stable_under_fixed_grips": path.stable, "stable_under_dead_load": path.stable_under_dead_load}
    return {name: getattr(path, name) for name in names} | stable


def tolerance_told(rtol: float, missed: Mapping[str, Sequence[str]]) -> str:
    """Whether a tolerance was met, in words; if not, by which numbers of which states."""
    names = [f"{name} {' and '.join(numbers)}" for name, numbers in missed.items()]
    return f"rtol {rtol:g} not met by {', '.join(names)}" if names else f"rtol {rtol:g} met"


AT_A_POINT = [CENTRAL_GAP, CONTACT_RADIUS]
OWN = np.array([1.0, 0.0, 1.0, 0.0])  # sizes beside their values: approaches and gaps have no natural zero


@dataclass(frozen=True)
class ErrorRule:
    """How errors are told from the changes along chains of discretisations, all of which end with the best.

    `remaining` is the part of the changes that may be left as error, above 1 where it falls slowly from one to the
    next. `parts` says how much each of the last changes along a chain counts, in the place of 1: less than 1 before the
    last, where each is mostly far larger than the next, more than 1 where a change is from other cells with no twin
    beside. `along` says whether the shift of an event along the path counts, see `estimate_event`: on grids that follow
    the contact, whose radius tells it precisely, and where there is no twin to guard against chance. `steps` says that
    it does for other numbers than those at a point alone, as under a law that ends by a step, where an integral over a
    cell in which that stands errs this way or that by its place: there a number of all grids may agree by accident.
    `beyond` is the tension in R dgamma that acts beyond the cells of all discretisations, so that no change tells of
    it. No event is told to be known better than to `least` of its size: coarse grids may all agree by accident far
    below the accuracy that they were made for.
    """

    remaining: float = REMAINING
    parts: tuple[float, ...] = ()
    along: bool = False
    steps: bool = False
    beyond: float = 0.0
    least: float = 0.0

    def change(self, chain: Sequence[Array | float]) -> Array:
        """Sum of the changes along a chain of two values or more, arrays (...) or numbers, each by its part.

        It is nan where one of them is, as of a radius without contact; but those that count in part, being farther
        back, are left out.
        """
        changes = np.abs(np.diff(np.array(chain), axis=0))
        parts = np.array(self.parts[-len(changes) :] or np.ones(len(changes)))
        back = np.flatnonzero(parts < 1)
        changes[back] = np.where(np.isnan(changes[back]), 0.0, changes[back])
        return np.asarray(np.tensordot(parts, changes, 1))

    def estimate(self, chains: Sequence[Sequence[float]], sizes: float) -> Estimate:
        """Of a number, by the chain along which it changes most, and what rounding leaves of terms of such sizes."""
        change = max(float(self.change(chain)) for chain in chains)
        value = chains[0][-1]
        error = self.remaining * change + ROUND_OFF * (1 + sizes)
        return Estimate(value, max(error, self.least * abs(value)))


USUAL = ErrorRule()


def estimate_event(name: str, chains: Sequence[Sequence[Located]], rule: ErrorRule) -> Event:
    """Turn an event into numbers with error estimates, see `errors_of` and `with_doubt`."""
    best = chains[0][-1]
    values, law = best.point.observables, best.problem.interface.law
    return Event(name, *map(float, values), *map(float, with_doubt(errors_of(chains, rule), values, law)))


def errors_of(chains: Sequence[Sequence[Located]], rule: ErrorRule) -> Array:
    """Errors of the observables of a state, (4,): an event, a point of the curve, a landing or a state asked for.

    A chain has the state on discretisations that differ in one respect from one to the next, all chains ending with the
    best. Along a chain the changes add up; of several chains the largest sum counts, so that a number that two grids
    share by accident is not taken for exact. The radius, which at a point errs more than the rest and in turns, is
    known no better than to what the polynomials there end with; where there is but one chain, or `rule.along`, nor is
    the gap.

    If `rule.along` at a stationary event, or `rule.steps` anywhere, an observable's change along each chain is taken
    apart: into what the event's shift along the path makes of it, and the rest, see `_apart`: on a single chain one
    number may stand still by accident while the event moves. If `rule.along`, nor do the gap and radius, which are at a
    point, then fall as averages do: the changes of all chains add up.
    """
    best = chains[0][-1]
    changes = [_changes(chain, rule) for chain in chains]
    whole = np.sum(changes, axis=0)
    if rule.steps or (rule.along and best.condition.stationary):
        ways = slice(None) if rule.along else slice(1)
        changes += [apart for chain in chains for apart in _apart(chain, rule)[ways]]
    errors = rule.remaining * np.max(changes, axis=0) + best.rounding
    if rule.beyond:
        errors += rule.beyond * _by_load(best)
    if rule.along:
        errors[AT_A_POINT] = np.maximum(errors, whole)[AT_A_POINT]
    gap, radius = best.problem.interface.ripples(best.problem.surface_state(best.point.x))
    alone = rule.along or len(chains) == 1
    errors[AT_A_POINT] = np.maximum(errors[AT_A_POINT], np.nan_to_num([gap if alone else 0.0, radius]))
    sizes = np.abs(best.point.observables)
    errors = np.maximum(errors, rule.least * (OWN + sizes))
    if np.isnan(errors[CONTACT_RADIUS]):  # another discretisation has no contact
        errors[CONTACT_RADIUS] = sizes[CONTACT_RADIUS]
    return np.asarray(errors)


def with_doubt(errors: Array, observables: Array, law: Law) -> Array:
    """Errors (4,), without contact that of its radius infinite if the gap's error leaves it open, nan else."""
    if not np.isnan(observables[CONTACT_RADIUS]):
        return errors
    return np.append(errors[:CONTACT_RADIUS], np.inf if (observables - errors)[CENTRAL_GAP] < law.edge_gap else np.nan)


def _by_load(event: Located) -> Array:
    """Changes of the observables, (4,), by a load of 1 R dgamma that is the same all along the curve."""
    changes: Array = np.eye(4)[LOAD]
    if not event.condition.stationary:
        by_shift = event.condition.weights[LOAD] / event.condition.rate(event.point)
        changes += np.abs(by_shift * event.point.rates)
    return changes


def _changes(chain: Sequence[Located], rule: ErrorRule) -> Array:
    """Changes of the observables along a chain, (4,), that of the central gap no less than gaps beside it tell.

    At a point several grids may agree by accident, beside it they do not.
    """
    changes = rule.change([event.point.observables for event in chain])
    states = [(event.problem.interface, event.problem.surface_state(event.point.x)) for event in chain]
    beside = min((surface.beside_axis(x) for surface, x in states), key=max)
    gaps = rule.change([surface.near_axis(x, beside) for surface, x in states])
    changes[CENTRAL_GAP] = max(changes[CENTRAL_GAP], *gaps)
    return changes


def _apart(chain: Sequence[Located], rule: ErrorRule) -> tuple[Array, Array]:
    """Changes of the observables along a chain: by the event's shift along the path, and the rest, the larger counts.

    By a law that ends by a step their sum: there they cancel by accident, elsewhere mostly a number is as well known as
    both cancel. An event is sensitive to shifts where a rate must vanish. They are read off the contact radius, or off
    the central gap where there is no contact. For these two, which are at a point and may stand still by accident, the
    second array is what a shift makes of them that is read off the load or approach that has a rate: at a jump with a
    soft apparatus it is the approach, as at the load's own extremum. Which has one the arclength's units tell.
    """
    event, values = chain[-1], np.array([event.point.observables for event in chain])
    rates, tell = event.point.rates, CONTACT_RADIUS if np.isfinite(values[:, CONTACT_RADIUS]).all() else CENTRAL_GAP
    other = int(np.argmax(metric_for(event.problem).weights[:CENTRAL_GAP] * rates[:CENTRAL_GAP] ** 2))
    by_point, by_average = (values[:, [k]] * (rates / rates[k]) for k in (tell, other))
    both = np.add if rule.steps else np.maximum
    apart, at_least = both(rule.change(by_point), rule.change(values - by_point)), rule.change(by_average)
    at_least[[APPROACH, LOAD]] = 0.0
    return apart, at_least
