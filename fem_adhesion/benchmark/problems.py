"""Named problems, as ``half-space-0.1`` or ``hemisphere-100-1``: what is asked, and our values with their errors.

A name is that of a body or a law, its parameters, and the Tabor parameter. Unless it says otherwise the body is the
half-space and the law the 3-9 law.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from fem_adhesion.common.known import known
from fem_adhesion.common.words import part_in
from fem_adhesion.convergence import trace
from fem_adhesion.registry import PARTS
from fem_adhesion.scene import HALF_SPACE, Scene
from halfspace import atlas
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import EVENTS, Event, usual
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import Units
from halfspace.values import Array, Estimate

NAMED = re.compile(r"([a-z][a-z-]*[a-z])((?:-[\d.]+)*)-([\d.]+)")
USUAL = (
    *(f"half-space-{tabor:g}" for tabor in (0.1, 0.3, 0.5, 1, 2, 3, 5, 10)),
    *("hemisphere-100-1", "layer-2-1", "dugdale-0.2-1", "morse-3-1"),
)
RTOL = 1e-6  # asked of curves that the atlas does not have: a digit more than most codes give
RADIUS, SPACING, WORK = 1e-6, 3e-10, 0.05  # m, m, J/m^2: a micrometre of silica or so, for numbers in SI
LANDINGS = ("jump_on_landing", "jump_off_landing")  # the states after the jumps
KINDS = {
    f"{state}_{kind}": kind
    for state in (*EVENTS, *LANDINGS)
    for kind in OBSERVABLES
    if (state, kind) != ("zero_load", "load") and not (state in LANDINGS and kind == "approach")
} | {"energy": "energy", "energy_lost": "energy"}
"""Kind of each quantity, which has its unit, by its name."""

PLACES = 1000  # on a curve of the atlas: how events change along it is then right to two thousandths


@dataclass(frozen=True)
class Problem:
    """A scene by its name."""

    name: str
    scene: Scene

    @property
    def in_atlas(self) -> bool:
        """Whether the atlas has it, at any Tabor parameter."""
        return self.scene.body == HALF_SPACE and self.scene.law == LENNARD_JONES

    @property
    def units(self) -> Units:
        """Units of a material in SI that has the Tabor parameter."""
        radius = self.scene.body.size * SPACING if math.isfinite(self.scene.body.size) else RADIUS
        modulus = WORK * math.sqrt(radius / (self.scene.tabor * SPACING) ** 3)
        return Units(radius, modulus, WORK, SPACING)

    @cached_property
    def values(self) -> Mapping[str, Estimate]:
        """Our value of each quantity that the curve has."""
        if self.in_atlas:
            return by_atlas(self.scene.tabor)
        return _values(usual(self._path.events), energy=self._path.energy)

    @cached_property
    def curve(self) -> Array:
        """The states (4, n) along the curve from separation to compression, each its `OBSERVABLES`."""
        states = atlas.curve(self.scene.tabor).states(PLACES) if self.in_atlas else self._path
        return np.array([getattr(states, kind) for kind in OBSERVABLES])

    @cached_property
    def _path(self) -> EquilibriumPath:
        return trace(self.scene, rtol=RTOL)


def named(name: str) -> Problem:
    """Problem of a name, or InputError."""
    found = NAMED.fullmatch(name)
    head, numbers = (found[1], found[2].split("-")[1:]) if found else ("", [])
    kind = next(
        (kind for kind in ("body", "law") if head in PARTS[kind] and head not in ("meshed", "tabulated", "layers")), ""
    )
    if not found or not kind:
        raise InputError(
            f"problem = {name!r}, limit: a body or law, its parameters and tabor; as {', '.join(USUAL[-5:])}"
        )
    parts: dict[str, Any] = {kind: part_in(kind, f"{head}:{','.join(numbers)}")}
    return Problem(name, Scene(float(found[3]), **parts))


@lru_cache(maxsize=1024)  # that a parameter is tried at, for several causes
def by_atlas(tabor: float) -> dict[str, Estimate]:
    """Values of a paraboloid on the half-space under the 3-9 law; none of jumps that do not exist."""
    ((events, released, lost),) = known([tabor])
    return _values(events, energy=released, energy_lost=lost)


def _values(events: Mapping[str, Event], **energies: Estimate) -> dict[str, Estimate]:
    """Numbers of states and energies in the order of `KINDS`, those that exist."""
    found = {f"{name}_{kind}": event.estimate(kind) for name, event in events.items() for kind in OBSERVABLES}
    found |= energies
    return {name: found[name] for name in KINDS if name in found and not math.isnan(found[name].value)}


def events_along(curve: Array) -> dict[str, Array]:
    """States (4,) of the events of a curve (4, n), between its points by parabolas; no jumps if it does not fold."""
    approach, load = curve[:2]
    off = int(np.argmax(np.maximum.accumulate(approach) - approach))
    on = int(np.argmax(approach[: off + 1]))
    turns = {"pull_off": (load, int(np.argmin(load)))}
    if on < off:
        turns |= {"jump_on": (approach, on), "jump_off": (approach, off)}
    found = dict[str, Array]()
    for name, (along, i) in turns.items():
        if 0 < i < approach.size - 1:
            below, here, above = curve[:, i - 1 : i + 2].T
            bend = along[i - 1] - 2 * along[i] + along[i + 1]
            t = (along[i - 1] - along[i + 1]) / (2 * bend) if bend else 0.0
            found[name] = here + t * (above - below) / 2 + t**2 * (above - 2 * here + below) / 2
    if (signs := np.flatnonzero((load[:-1] < 0) & (load[1:] >= 0))).size:
        i = signs[-1]
        found["zero_load"] = curve[:, i] + load[i] / (load[i] - load[i + 1]) * (curve[:, i + 1] - curve[:, i])
    return found
