"""Names of the parts of a scene, as the command line and files have them, and their classes: one table, both ways.

A class is imported when it is first asked for. A new part is a class in a file of its own and a line here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

PARTS: dict[str, dict[str, Any]] = {
    "body": {
        "half-space": "fem_adhesion.bodies.half_space:HalfSpace",
        "block": "fem_adhesion.bodies.block:Block",
        "hemisphere": "fem_adhesion.bodies.hemisphere:Hemisphere",
        "held-sphere": "fem_adhesion.bodies.held_sphere:HeldSphere",
        "layer": "fem_adhesion.bodies.layer:Layer",
        "meshed": "fem_adhesion.bodies.meshed:Meshed",
    },
    "material": {
        "linear-elastic": "fem_adhesion.materials:LinearElastic",
        "neo-hookean": "fem_adhesion.materials:NeoHookean",
    },
    "law": {
        "power-law": "halfspace.laws.power_law:PowerLaw",
        "morse": "halfspace.laws.morse:Morse",
        "exponential": "halfspace.laws.exponential:Exponential",
        "dlvo": "halfspace.laws.dlvo:Dlvo",
        "dugdale": "halfspace.laws.dugdale:Dugdale",
    },
    "profile": {
        "paraboloid": "halfspace.profiles.paraboloid:Paraboloid",
        "sphere": "halfspace.profiles.sphere:Sphere",
        "power": "halfspace.profiles.power:Power",
        "hyperboloid": "halfspace.profiles.hyperboloid:Hyperboloid",
    },
}
"""Classes, or where they are, by their names."""


def class_of(kind: str, name: str) -> Any:
    """Class of a part by the name of its kind and its own."""
    found = PARTS[kind][name]
    if isinstance(found, str):
        module, _, attribute = found.partition(":")
        found = getattr(import_module(module), attribute)
    return found


def name_of(part: object) -> str:
    """Name of a part; that of its class if it is not in the table."""
    own = type(part)
    known = (own, f"{own.__module__}:{own.__qualname__}")
    names = (name for table in PARTS.values() for name, home in table.items() if home in known)
    return next(names, own.__qualname__)


def told(part: Any) -> str:
    """Name of a law or a profile and its numbers, in words; R/eps, which a scene tells, left out."""
    own = {field.name: getattr(part, field.name) for field in fields(part)} if is_dataclass(part) else {}
    numbers = [f"{name} {value:g}" for name, value in own.items() if name != "radius_ratio" and math.isfinite(value)]
    return " ".join([name_of(part), *numbers])


def record_of(part: Any) -> Any:
    """A scene or a part as plain data: its fields, and its name unless it is the whole."""
    if isinstance(part, Path):
        return str(part)
    if not is_dataclass(part):
        return part
    named = {field.name: record_of(getattr(part, field.name)) for field in fields(part)}
    return named if "body" in named else {"name": name_of(part), **named}


def part_from(kind: str, record: Mapping[str, Any]) -> Any:
    """Part of a kind from plain data: `record_of` the other way."""
    given = {name: value for name, value in record.items() if name != "name"}
    parts = {name: part_from(name, value) for name, value in given.items() if isinstance(value, Mapping)}
    return class_of(kind, record["name"])(**(given | parts))
