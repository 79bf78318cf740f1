"""Numbers with unit and error: read from text into SI, written as text, and told in sentences.

A sentence is left unsaid where one of its numbers is missing.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from halfspace.errors import InputError
from halfspace.scaling import Units
from halfspace.values import Array, Estimate

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
    "thickness": ("m", "500nm"),
    "hamaker": ("J", "65zJ"),
    "modulus": MODULUS,
    "counter_modulus": MODULUS,
    "work_of_adhesion": ("J/m^2", "0.1J/m^2"),
    "stiffness": ("N/m", "0.2N/m"),
    "force": ("N", "1nN"),
    "detector": ("m/V", "50nm/V"),
    "sensitivity": ("1", "1.1"),
    "compliance": ("m/N", "0.5m/N"),
    "poisson": ("1", "0.3"),
    "counter_poisson": ("1", "0.3"),
}
SPREAD = re.compile(r"\s*(?:\+/?-|±)\s*")


PREFIXES = dict(zip(range(-24, 15, 3), ("y", "z", "a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T"), strict=True))
DIGITS = 6  # significant, at most


def parse(text: str, name: str) -> float:
    """Read a positive quantity with its unit, such as ``100nm``, and return it in SI; a length unless `KINDS` has it.

    Any unit that pint knows will do: for a work of adhesion mN/m is as good as mJ/m^2. InputError if the number or the
    unit is missing, the unit is unknown or of another dimension, or the number is not positive and finite.
    """
    example = KINDS.get(name, LENGTH)[1]
    found = NUMBER_AND_UNIT.fullmatch(text)
    if not found:
        raise InputError(f"{name} = {text!r} is not a number with a unit; write it as {example}")
    value = float(found[1]) * _size(text, found[2], name)
    if not (0 < value < math.inf or KINDS.get(name, LENGTH)[0] == "1"):
        raise InputError(f"{name} = {text} is outside 0 < {name} < inf; write it as {example}")
    return value


def metres_of(table: Path) -> float:
    """Size in m of the unit of a table of two lengths: 1 unless its first line says, as ``r_nm,z_nm``."""
    header = table.read_text(encoding="utf-8-sig", errors="replace").partition("\n")[0]
    found = re.fullmatch(r"\W*[^\W_]+_(\w+)\s*,\s*[^\W_]+_(\w+)\s*", header)
    if found and (found[1] != found[2] or not re.fullmatch("[pnuµm]?m", found[1])):
        units = " and ".join(dict.fromkeys(found.groups()))
        raise InputError(f"{table} has {units} in its header, limit: one unit of pm, nm, um, mm, m; convert it")
    return parse(f"1{found[1]}", "radius") if found else 1.0


class Measured(NamedTuple):
    """A number as it was measured, in SI: its value, and its standard deviation, 0 if it counts as exact."""

    value: float
    deviation: float = 0.0


def measured(text: str, name: str) -> Measured:
    """Read a quantity as `parse`, with its standard deviation behind it if there is one: ``100+-20nm``, or with ±."""
    first, *second = SPREAD.split(text, maxsplit=1)
    if not second:
        return Measured(parse(text, name))
    deviation = parse(second[0], name)
    found, unit = NUMBER_AND_UNIT.fullmatch(first), NUMBER_AND_UNIT.fullmatch(second[0])
    value = parse(first if unit is None or (found and found[2]) else f"{first}{unit[2]}", name)
    if not deviation < value:
        limit = f"a standard deviation below the value; write it as {KINDS[name][1]}"
        raise InputError(f"{name} = {text} may be negative, limit: {limit}")
    return Measured(value, deviation)


def _size(text: str, written: str, name: str) -> float:
    """Size of a unit in the SI unit of the quantity."""
    unit, example = KINDS.get(name, LENGTH)
    if unit == "1" and not written:
        return 1.0
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


def with_error(quantity: Estimate, scale: float = 1.0, digits: int = DIGITS) -> str:
    """Number, times a scale, with the error of its last digit in brackets, rounded up: 60.4440(1).

    It has so many significant digits at most, and a question mark where the error is not known.
    """
    number = quantity * scale
    if not math.isfinite(number.error):
        return f"{number.value:.{digits}g}(?)"
    most = digits - 1 - decade(number.value)
    decimals = max(0, min(most, -decade(number.error)) if number.error else most)
    uncertain = max(1, math.ceil(number.error * 10**decimals * (1 - 1e-9)))
    if uncertain == 10 and decimals:
        decimals, uncertain = decimals - 1, 1
    return f"{number.value:z.{decimals}f}({uncertain})"


def plus_minus(estimate: Estimate) -> str:
    """Value with its error behind it."""
    return f"{digits(estimate)} +- {estimate.error:.1g}"


def digits(estimate: Estimate) -> str:
    """Value to one digit beyond the first uncertain one, ten decimals at most; what is not finite as such."""
    if not (math.isfinite(estimate.value) and math.isfinite(estimate.error)):
        return f"{estimate.value:g}"
    decimals = 1 - math.floor(math.log10(estimate.error)) if estimate.error > 0 else 10
    return f"{estimate.value:z.{min(max(decimals, 1), 10)}f}"


def engineering(value: float, unit: str) -> str:
    """Number with an engineering prefix: 57.1 GPa."""
    exponent = exponent_of(value)
    return f"{value / 10.0**exponent:.4g} {PREFIXES[exponent]}{unit}"


def sizes_told(units: Units) -> list[str]:
    """Radius, modulus and length of a contact in SI."""
    sizes = (("R", units.radius, "m"), ("E*", units.modulus, "Pa"), ("beta", units.length, "m"))
    return [f"{name} = {engineering(value, unit)}" for name, value, unit in sizes]


def exponent_of(value: float) -> int:
    """Power of 1000 below a value, as an exponent of ten, among those that have a prefix."""
    return min(max(3 * (decade(value) // 3), min(PREFIXES)), max(PREFIXES))


def decade(value: float) -> int:
    """Power of ten of the first digit."""
    return math.floor(math.log10(abs(value))) if value else 0


def told(text: str, *numbers: float | Array) -> str:
    """The text, or nothing if a number that it rests on is missing or not finite."""
    known = all(np.size(number) and np.all(np.isfinite(number)) for number in numbers)
    return text if known else ""


def joined(*sentences: str) -> str:
    """Sentences that have something to tell, as one paragraph."""
    return " ".join(filter(None, sentences)) or "No numbers were found to tell of."


def listed(names: Sequence[str]) -> str:
    """Names with commas and an `and`."""
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


def counted(count: int, what: str) -> str:
    """How many there are of something: 1 case, 2 cases."""
    return f"{count} {what}{'' if count == 1 else 's'}"


def span(values: Sequence[float] | Array) -> str:
    """Least and largest of some numbers, to two digits or to the last before the point."""
    ends = (float(np.min(values)), float(np.max(values)))
    return " to ".join(dict.fromkeys(f"{end:.2g}" if abs(end) < 99.5 else f"{end:.0f}" for end in ends))
