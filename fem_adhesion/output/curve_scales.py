"""In which units a curve is shown: the paper's, or SI where the material is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from fem_adhesion.output.assess_report import PREFIXES, exponent_of
from fem_adhesion.studies.curves import Curves
from halfspace.compliance import Array
from halfspace.scaling import Units


@dataclass(frozen=True)
class Scale:
    """Unit in which a quantity is shown.

    Attributes
    ----------
    label : str
        Of an axis, with symbol and unit.
    unit : str
        In plain text.
    size : float
        By which the dimensionless quantity is multiplied.
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

SYMBOLS: Mapping[str, tuple[str, str]] = {
    "approach": (r"approach $\alpha$", "m"),
    "load": (r"load $W$", "N"),
    "central_gap": (r"central gap $h(0) - \epsilon$", "m"),
    "gap": (r"gap $h - \epsilon$", "m"),
    "contact_radius": (r"contact radius $a$", "m"),
    "radius": (r"radius $r$", "m"),
    "pressure": (r"pressure $p$", "Pa"),
    "energy": (r"energy $E$", "J"),
    "stiffness": (r"stiffness $k$", "N/m"),
}


TYPICAL: Mapping[str, float] = {"approach": 10, "central_gap": 10, "gap": 10, "load": 5, "energy": 10}
"""Size of quantities on a curve, in their dimensionless units, that decides the prefix; 1 unless given."""


def si_sizes(units: Units) -> Mapping[str, tuple[float, str]]:
    """Size in SI of the unit of each quantity, and its SI unit."""
    sizes = {
        "approach": units.approach,
        "load": units.load,
        "central_gap": units.approach,
        "gap": units.approach,
        "contact_radius": units.length,
        "radius": units.length,
        "pressure": units.pressure,
        "energy": units.energy,
        "stiffness": units.stiffness,
    }
    return {name: (size, SYMBOLS[name][1]) for name, size in sizes.items()}


def scales(curves: Curves) -> Mapping[str, Scale]:
    """Scale of each quantity of a curve, with the prefix that suits its size."""
    units = curves.question.units
    if units is None:
        return PAPER
    return {name: _si_scale(name, size, unit) for name, (size, unit) in si_sizes(units).items()}


def _si_scale(name: str, size: float, unit: str) -> Scale:
    exponent = exponent_of(size * TYPICAL.get(name, 1.0))
    shown = PREFIXES[exponent] + unit
    return Scale(f"{SYMBOLS[name][0]}, {shown}", shown, size * 10.0**-exponent)
