"""Quantities with units: read from text into SI, and kept with unit and error on the way out."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from halfspace.errors import InputError
from halfspace.values import Estimate

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)(?![a-zA-Z])"
NUMBER_AND_UNIT = re.compile(rf"\s*({NUMBER})\s*(.*?)\s*")
# Units to powers of one digit, as pint evaluates whatever it is given.
POWER = r"[^\W\d_]+[²³]?(?:\s?(?:\^|\*\*)?\s?-?\d)?"
UNIT = re.compile(rf"{POWER}(?:\s*[ */·]\s*{POWER})*")

# SI unit and an example of each quantity that is read.
LENGTH, MODULUS = ("m", "100nm"), ("Pa", "70GPa")
KINDS: Mapping[str, tuple[str, str]] = {
    "radius": LENGTH,
    "counter_radius": LENGTH,
    "spacing": ("m", "0.143nm"),
    "hamaker": ("J", "65zJ"),
    "modulus": MODULUS,
    "counter_modulus": MODULUS,
    "work_of_adhesion": ("J/m^2", "0.1J/m^2"),
    "stiffness": ("N/m", "0.2N/m"),
}


@dataclass(frozen=True)
class Quantity:
    """A number in SI with the estimated bound of its error, in the same unit; `unit` is "1" for a ratio."""

    value: float
    error: float
    unit: str

    @classmethod
    def of(cls, estimate: Estimate, size: float, unit: str) -> Quantity:
        """Dimensionless estimate times the SI size of its unit."""
        return cls(estimate.value * size, abs(estimate.error * size), unit)


def parse(text: str, name: str) -> float:
    """Read a positive quantity with its unit, such as ``100nm``, and return it in SI.

    Parameters
    ----------
    text : str
        A number and a unit that pint knows; for a work of adhesion mN/m is as good as mJ/m^2.
    name : str
        Which quantity, one of `KINDS`.

    Raises
    ------
    InputError
        If the number or the unit is missing, the unit is unknown or of another dimension, or the number is not
        positive and finite.
    """
    example = KINDS[name][1]
    found = NUMBER_AND_UNIT.fullmatch(text)
    if not found:
        raise InputError(f"{name} = {text!r} is not a number with a unit; write it as {example}")
    value = float(found[1]) * _size(text, found[2], name)
    if not 0 < value < math.inf:
        raise InputError(f"{name} = {text} is outside 0 < {name} < inf; write it as {example}")
    return value


def _size(text: str, written: str, name: str) -> float:
    """Size of a unit in the SI unit of the quantity."""
    unit, example = KINDS[name]
    if not written:
        raise InputError(f"{name} = {text} has no unit, limit: a multiple of {unit}; write it as {example}")
    try:
        if not UNIT.fullmatch(written):
            raise InputError(written)
        found = _registry().parse_units(written)
    except (AttributeError, ValueError) as error:  # pint's error for an unknown unit is an AttributeError
        raise InputError(f"{name} = {text} has the unknown unit {written!r}; write it as {example}") from error
    if not found.is_compatible_with(unit):
        raise InputError(f"{name} = {text} has a unit of the wrong kind, limit: a multiple of {unit}; as in {example}")
    return float(_registry().Quantity(1.0, found).to(unit).magnitude)


@cache
def _registry() -> Any:
    import pint  # here, because it takes a third of a second to load

    return pint.UnitRegistry()
