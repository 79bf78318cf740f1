"""Curves at many Tabor parameters: their events, energies and losses as arrays, each number with its error."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from halfspace.accuracy.following import Summary, curves, families, family_of
from halfspace.accuracy.trace import trace
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.devices import staged_jumps
from halfspace.equilibrium.events import EVENTS, Event
from halfspace.equilibrium.states import States
from halfspace.errors import InputError, NotConverged
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.profiles import PARABOLOID, Profile, require_profile
from halfspace.values import Array, Valued

Tabors = tuple[float, ...]
Map = Callable[[Callable[[Tabors], list[Summary]], Sequence[Tabors]], Iterable[list[Summary]]]
"""Does the same work on many items and gives the results in their order, as the built-in `map` does."""

NUMBERS = tuple(field.name for field in fields(States))


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Valued):
    """Events, energies and losses over Tabor parameters; all arrays have one number for each, nan where there is none.

    Attributes
    ----------
    tabor : (n,) array
        Tabor parameters, as they were asked for.
    events : mapping of str to States
        By name, ``pull_off``, ``jump_on``, ``jump_off`` and ``zero_load``: approaches, loads, central gaps and contact
        radii with their errors. There are no jumps where a curve does not fold.
    energy, energy_error : (n,) array
        Potential energy released from separation to zero approach in contact, in R dgamma eps.
    energy_lost, energy_lost_error : (n,) array
        In a cycle under fixed grips, in R dgamma eps; 0 where the curve does not fold, nan where that cannot be told.
    met : (n,) array of bool
        Whether all loads and approaches are as accurate as was asked for.
    reasons : mapping of float to str
        Tabor parameters whose curves could not be traced, and why.
    """

    tabor: Array
    events: Mapping[str, States]
    energy: Array
    energy_error: Array
    energy_lost: Array
    energy_lost_error: Array
    met: NDArray[np.bool_]
    reasons: Mapping[float, str]


def sweep(
    tabors: ArrayLike,
    *,
    law: Law = LENNARD_JONES,
    profile: Profile = PARABOLOID,
    body: LayeredBody | None = None,
    rtol: float = 1e-6,
    to_load: float = COMPRESSION,
    map: Map = map,  # noqa: A002 (the very same, unless another is given)
) -> Sweep:
    """Solve for the curves at many Tabor parameters, and keep their events, energies and losses with their errors.

    Of neighbours some are traced, and those between followed from them, all on the same grids: numbers differ from
    those of `halfspace.trace`, or of curves asked for together with others, as errors do. That between three curves
    which fold equally often, at Tabor parameters within 1.5 times, none folds otherwise is an assumption, see
    `halfspace.accuracy.following`. A curve that cannot be traced leaves nan, and its reason; the others are not lost.

    Parameters
    ----------
    tabors : array_like
        Tabor parameters, at least one, of any order.
    law, profile, body, rtol, to_load
        As of `halfspace.trace`, the same for all curves.
    map : callable
        Does the work on all groups of neighbours and gives the results in their order: the built-in one, group after
        group, or that of a pool of processes, as ``concurrent.futures.ProcessPoolExecutor().map``.

    Raises
    ------
    InputError
        If an input is out of range, before any work.
    """
    asked = [require_tabor(value) for value in np.atleast_1d(np.asarray(tabors)).ravel().tolist()]
    if not asked:
        raise InputError("tabors is empty, limit: at least one; give a list of Tabor parameters")
    rtol, to_load, law = require_rtol(rtol), require_load(to_load), require_law(law)
    profile = require_profile(profile)
    work = partial(summaries, law=law, profile=profile, body=body, rtol=rtol, to_load=to_load)
    found = {curve.tabor: curve for part in map(work, families(asked, law, profile, body)) for curve in part}
    return collected([found[tabor] for tabor in asked])


def summaries(
    tabors: Tabors, *, law: Law, profile: Profile, body: LayeredBody | None, rtol: float, to_load: float
) -> list[Summary]:
    """Curves of one of the `families` of a sweep; what cannot be traced, also on grids of its own, says why."""

    def by_itself(tabor: float) -> Summary:
        try:
            path = trace(tabor, law=law, profile=profile, body=body, rtol=rtol, to_load=to_load)
            return Summary.of(path, staged_jumps(path))
        except NotConverged as error:
            return Summary.failed(tabor, str(error))

    if len(tabors) == 1:
        return [by_itself(tabors[0])]
    together = curves(tabors, family_of(tabors, law=law, profile=profile, rtol=rtol, to_load=to_load))
    return [by_itself(curve.tabor) if curve.reason else curve for curve in together]


def collected(summaries: Sequence[Summary]) -> Sweep:
    """Arrays of the numbers of many curves."""
    energies = [(s.energy.value, s.energy.error, s.energy_lost.value, s.energy_lost.error) for s in summaries]
    energy, energy_error, lost, lost_error = np.array(energies).reshape(-1, 4).T
    return Sweep(
        tabor=np.array([s.tabor for s in summaries]),
        events={name: _series([s.events.get(name) for s in summaries]) for name in EVENTS},
        energy=energy,
        energy_error=energy_error,
        energy_lost=lost,
        energy_lost_error=lost_error,
        met=np.array([not (s.missed or s.reason) for s in summaries]),
        reasons={s.tabor: s.reason for s in summaries if s.reason},
    )


def _series(events: Sequence[Event | None]) -> States:
    """Numbers of an event on many curves."""
    return States(*(np.array([getattr(event, name, math.nan) for event in events]) for name in NUMBERS))
