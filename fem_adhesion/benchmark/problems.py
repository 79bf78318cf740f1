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

from fem_adhesion.common.words import part_in
from fem_adhesion.convergence import trace
from fem_adhesion.registry import PARTS
from fem_adhesion.scene import HALF_SPACE, Scene
from halfspace import atlas
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import EVENTS
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import Units
from halfspace.values import Estimate, States

NAMED = re.compile(r"([a-z][a-z-]*[a-z])((?:-[\d.]+)*)-([\d.]+)")
USUAL = (
    *(f"half-space-{tabor:g}" for tabor in (0.1, 0.3, 0.5, 1, 2, 3, 5, 10)),
    *("hemisphere-100-1", "layer-2-1", "dugdale-0.2-1", "morse-3-1"),
)
RTOL = 1e-6  # asked of curves that the atlas does not have: a digit more than most codes give
RADIUS, SPACING, WORK = 1e-6, 3e-10, 0.05  # m, m, J/m^2: a micrometre of silica or so, for numbers in SI
STATES = {name: name for name in EVENTS} | {f"{jump}_landing": jump for jump in ("jump_on", "jump_off")}
KINDS = {f"{state}_{kind}": kind for state in STATES for kind in OBSERVABLES} | {
    "energy": "energy",
    "energy_lost": "energy",
}
"""Kind of each quantity, which has its unit, by its name."""


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
        path = trace(self.scene, rtol=RTOL)
        found = {
            f"{name}_{kind}": event.estimate(kind)
            for name, event in path.events.items()
            if name in EVENTS
            for kind in OBSERVABLES
        }
        return _known(found | {"energy": path.energy})


def named(name: str) -> Problem:
    """Problem of a name, or InputError."""
    found = NAMED.fullmatch(name)
    head, numbers = (found[1], found[2].split("-")[1:]) if found else ("", [])
    kind = next((kind for kind in ("body", "law") if head in PARTS[kind] and head not in ("meshed", "tabulated")), "")
    if not found or not kind:
        raise InputError(
            f"problem = {name!r}, limit: a body or law, its parameters and tabor; as {', '.join(USUAL[-5:])}"
        )
    parts: dict[str, Any] = {kind: part_in(kind, f"{head}:{','.join(numbers)}")}
    return Problem(name, Scene(float(found[3]), **parts))


@lru_cache(maxsize=1024)  # that a parameter is tried at, for several causes
def by_atlas(tabor: float) -> dict[str, Estimate]:
    """Values of a paraboloid on the half-space under the 3-9 law; none of jumps that do not exist."""
    on, off = atlas.jump_on(tabor), atlas.jump_off(tabor)
    states = {"pull_off": atlas.pull_off(tabor), "zero_load": atlas.zero_load(tabor)}
    states |= {"jump_on": on.take_off, "jump_off": off.take_off}
    states |= {"jump_on_landing": on.landing, "jump_off_landing": off.landing}
    found = {f"{name}_{kind}": _number(state, kind) for name, state in states.items() for kind in OBSERVABLES}
    for name, energy in (("energy", atlas.energy_released(tabor)), ("energy_lost", atlas.energy_lost(tabor))):
        found[name] = Estimate(float(energy.energy), float(energy.energy_error))
    return _known(found)


def _number(state: States, kind: str) -> Estimate:
    return Estimate(float(getattr(state, kind)), float(getattr(state, f"{kind}_error")))


def _known(values: Mapping[str, Estimate]) -> dict[str, Estimate]:
    return {name: value for name, value in values.items() if not math.isnan(value.value)}
