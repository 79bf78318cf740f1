"""What a method is to the speed study: a ladder of resolutions, each computed from the set-up to the events.

Grids scale with the contact: spacings f are in widths of the spike of tension at the contact edge, extents U and sizes
of blocks L in beta/sqrt(mu).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.equilibrium.curve import COMPRESSION, Chart, EquilibriumPath, find_events, trace_charts
from halfspace.equilibrium.devices import cycle, energy_lost
from halfspace.equilibrium.newton import Traceable
from halfspace.theories.closed_forms import jkr_radius

QUANTITIES = ("pull_off", "jump_on", "hysteresis")

Family = Literal["half-space", "finite elements"]
Variant = Literal["", "clamped", "monolithic"]


@dataclass(frozen=True)
class Solved:
    """What one rung yields.

    Attributes
    ----------
    unknowns : int
        Elastic ones included.
    values : mapping of str to float
        Of `QUANTITIES`, those that the method gives.
    """

    unknowns: int
    values: Mapping[str, float]


@dataclass(frozen=True)
class Step:
    """One rung of a ladder: its resolution in words, and the computation at a Tabor parameter."""

    setting: str
    run: Callable[[float], Solved]


@dataclass(frozen=True)
class Method:
    """A ladder of resolutions.

    Attributes
    ----------
    family : str
        Whose elasticity it is.
    basis : str
        How the pressure or the displacement is represented, or solved for.
    steps : sequence of Step
        From coarse to fine.
    quick : int
        How many of them, the coarsest, make up the quick ladder: a budget of work, the same on every machine.
    variant : str
        What differs from the family's usual: for finite elements, condensed with a point load's far field.
    may_diverge : bool
        Whether its iteration is known to run away from stiff attraction: that it does is then a finding, not a failure.
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

    def ladder(self, *, quick: bool) -> Sequence[Step]:
        """Rungs to climb."""
        return self.steps[: self.quick] if quick else self.steps


def from_path(path: EquilibriumPath) -> Solved:
    """Quantities of an adaptive solver's path."""
    values = {"pull_off": path.events["pull_off"].load}
    grips = cycle(path)
    if grips is not None:
        values |= {"jump_on": grips.jump_on.take_off.approach, "hysteresis": grips.energy_lost.value}
    return Solved(path.unknowns, values)


def from_chart(problem: Traceable, unknowns: int) -> Solved:
    """Quantities from one discretisation, whose events are found once and taken as they are."""
    segments = trace_charts([Chart(problem, unknowns)])
    found = find_events(segments)
    values = {"pull_off": float(found["pull_off"].point.observables[LOAD])}
    loss = energy_lost(segments, found)
    if loss is not None:
        values |= {"jump_on": float(found["jump_on"].point.observables[APPROACH]), "hysteresis": loss}
    return Solved(unknowns, values)


def unit(tabor: float) -> float:
    """Width of a rigid paraboloid's attraction, in beta."""
    return float(1 / np.sqrt(tabor))


def widest(tabor: float) -> float:
    """Contact radius at the end of the curve, in beta."""
    return float(np.hypot(jkr_radius(COMPRESSION), 0.7 * unit(tabor)))
