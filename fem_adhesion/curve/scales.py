"""In which units a curve is shown: the paper's, or SI where the material is known."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from fem_adhesion.common.numbers import PREFIXES, exponent_of
from fem_adhesion.curve.solve import Curves
from halfspace.values import Array


@dataclass(frozen=True)
class Scale:
    """Unit in which a quantity is shown, and the size by which the dimensionless one is multiplied in it.

    The label is that of an axis, with symbol and unit.
    """

    label: str
    unit: str
    size: float = 1.0

    def of(self, value: Array) -> Array:
        """Quantity in the unit."""
        return value * self.size


PAPER: Mapping[str, Scale] = {
    "approach": Scale(r"approach $\alpha^* = \alpha/\epsilon$", "eps"),
    "load": Scale(r"load $W/R\Delta\gamma$", "R dgamma"),
    "central_gap": Scale(r"central gap $H(0)$", "eps"),
    "gap": Scale(r"gap $H = h/\epsilon - 1$", "eps"),
    "contact_radius": Scale(r"contact radius $a/\beta$", "beta"),
    "radius": Scale(r"radius $u = r/\beta$", "beta"),
    "pressure": Scale(r"pressure $P = \mu\epsilon p/\Delta\gamma$", "dgamma/(mu eps)"),
    "energy": Scale(r"energy $E/R\Delta\gamma\epsilon$", "R dgamma eps"),
    "stiffness": Scale(r"stiffness $k\epsilon/R\Delta\gamma$", "R dgamma/eps"),
}

SYMBOLS_IN_SI: Mapping[str, str] = {
    "approach": r"approach $\alpha$",
    "load": "load $W$",
    "central_gap": r"central gap $h(0) - \epsilon$",
    "gap": r"gap $h - \epsilon$",
    "contact_radius": "contact radius $a$",
    "radius": "radius $r$",
    "pressure": "pressure $p$",
    "energy": "energy $E$",
    "stiffness": "stiffness $k$",
}

EVENT_QUANTITIES = ("approach", "load", "central_gap", "contact_radius")
ALIKE: Mapping[str, str] = {"gap": "central_gap", "radius": "contact_radius"}  # quantities with the prefix of another


def scales(curves: Curves) -> Mapping[str, Scale]:
    """Scale of each quantity of a curve, with the prefix that suits the largest of its values at events and jumps."""
    units = curves.question.units
    if units is None:
        return PAPER
    largest = _largest(curves)
    return {name: _si_scale(name, *units.si(name), largest.get(ALIKE.get(name, name), 1.0)) for name in PAPER}


def _largest(curves: Curves) -> Mapping[str, float]:
    """Largest size of what a table of events shows, in dimensionless units; what is not known is left out."""
    states = [event for path in curves.paths.values() for event in path.events.values()]
    cycles = [cycle for cycle in (curves.grips, curves.apparatus) if cycle]
    jumps = [jump for cycle in cycles for jump in cycle.jumps.values()]
    states += [state for jump in jumps for state in (jump.take_off, jump.landing)]
    sizes = {name: [abs(getattr(state, name)) for state in states] for name in EVENT_QUANTITIES}
    sizes["energy"] = [abs(cycle.energy_lost.value) for cycle in cycles]
    known = {name: [size for size in found if math.isfinite(size) and size] for name, found in sizes.items()}
    return {name: max(found) for name, found in known.items() if found}


def _si_scale(name: str, size: float, unit: str, largest: float) -> Scale:
    exponent = exponent_of(size * largest)
    shown = PREFIXES[exponent] + unit
    return Scale(f"{SYMBOLS_IN_SI[name]}, {shown}", shown, size * 10.0**-exponent)
