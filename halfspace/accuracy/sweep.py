"""Curves at many Tabor parameters: their events, energies and losses as arrays, each number with its error.

Each curve is traced by itself, so that its numbers do not depend on which others are asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from halfspace.accuracy.trace import trace
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import EVENTS, Event, usual
from halfspace.errors import InputError, tried
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.profiles import PARABOLOID, Profile, require_profile
from halfspace.values import Array, Estimate, States, Valued

NUMBERS = tuple(field.name for field in fields(States))
UNKNOWN = Estimate(math.nan, math.nan)


@dataclass(frozen=True)
class Summary:
    """What a sweep keeps of one curve, or why it could not be traced, then without events and with energies of nan.

    The energies, in R dgamma eps, are released from separation to zero approach in contact, and lost in a cycle under
    fixed grips: zero if the curve does not fold, nan if its error estimate leaves open whether it does. `missed` are,
    by event, the numbers whose estimated errors exceed the tolerance.
    """

    tabor: float
    events: Mapping[str, Event]
    energy: Estimate
    energy_lost: Estimate
    missed: Mapping[str, tuple[str, ...]]
    reason: str = ""

    @classmethod
    def of(cls, path: EquilibriumPath) -> Summary:
        """Keep the numbers of a curve."""
        jumps = cycle(path)
        lost = jumps.energy_lost if jumps else (UNKNOWN if path.jumps is None else Estimate(0.0, 0.0))
        return cls(path.tabor, usual(path.events), path.energy, lost, path.missed)

    @classmethod
    def failed(cls, tabor: float, reason: str) -> Summary:
        """Say why there is no curve."""
        return cls(tabor, {}, UNKNOWN, UNKNOWN, {}, reason)


Map = Callable[[Callable[[float], Summary], Sequence[float]], Iterable[Summary]]
"""Does the same work on many items and gives the results in their order, as the built-in `map` does."""


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
    rtol: float = 1e-5,
    to_load: float = COMPRESSION,
    map: Map = map,  # noqa: A002 (the very same, unless another is given)
) -> Sweep:
    """Solve for the curves at many Tabor parameters, and keep their events, energies and losses with their errors.

    A curve that cannot be traced leaves nan, and its reason; the others are not lost.

    Parameters
    ----------
    tabors : array_like
        Tabor parameters, at least one, of any order.
    law, profile, body, rtol, to_load
        As of `halfspace.trace`, the same for all curves.
    map : callable
        Traces all curves and gives the results in their order: the built-in one, curve after curve, or that of a pool
        of processes, as ``concurrent.futures.ProcessPoolExecutor().map``.

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
    work = partial(summary, law=law, profile=profile, body=body, rtol=rtol, to_load=to_load)
    found = {curve.tabor: curve for curve in map(work, list(dict.fromkeys(asked)))}
    return collected([found[tabor] for tabor in asked])


def summary(tabor: float, **asked: Any) -> Summary:
    """Trace one curve of a sweep, asked as of `halfspace.trace`; a curve that cannot be traced says why."""
    found = tried(lambda: Summary.of(trace(tabor, **asked)))
    return found or Summary.failed(tabor, found.reason)


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
