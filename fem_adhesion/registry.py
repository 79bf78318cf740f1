"""Names of the parts of a scene, as the command line and files have them, and their classes: one table, both ways.

A class is imported when it is first asked for. A new part is a class and a line here.
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
        "block": "fem_adhesion.bodies.half_space:Block",
        "hemisphere": "fem_adhesion.bodies.held:Hemisphere",
        "held-sphere": "fem_adhesion.bodies.held:HeldSphere",
        "layer": "fem_adhesion.bodies.layers:Layer",
        "coated": "fem_adhesion.bodies.layers:Coated",
        "layers": "fem_adhesion.bodies.layers:Layers",
        "meshed": "fem_adhesion.bodies.held:Meshed",
    },
    "strata": {"stratum": "halfspace.elastic.layers:Stratum"},
    "base": {"substrate": "halfspace.elastic.layers:Substrate"},
    "material": {
        "linear-elastic": "fem_adhesion.materials:LinearElastic",
        "neo-hookean": "fem_adhesion.materials:NeoHookean",
    },
    "law": {
        "power-law": "halfspace.laws.formulas:PowerLaw(attraction, repulsion)",
        "morse": "halfspace.laws.formulas:Morse(k)",
        "exponential": "halfspace.laws.formulas:Exponential(k, core)",
        "dlvo": "halfspace.laws.formulas:Dlvo(charge, screening)",
        "dugdale": "halfspace.laws.formulas:Dugdale(width)",
        "tabulated": "halfspace.laws.tabulated:Tabulated(path)",
    },
    "profile": {
        "paraboloid": "halfspace.profiles.formulas:Paraboloid",
        "sphere": "halfspace.profiles.formulas:Sphere",
        "power": "halfspace.profiles.formulas:Power(k)",
        "hyperboloid": "halfspace.profiles.formulas:Hyperboloid(b)",
        "rounded-punch": "halfspace.profiles.formulas:RoundedPunch(flat)",
        "tabulated": "halfspace.profiles.tabulated:Tabulated(path)",
    },
}
"""Classes, or where they are, by their names; in brackets the numbers that a law or a profile takes, for its help."""


def class_of(kind: str, name: str) -> Any:
    """Class of a part by the name of its kind and its own."""
    found = PARTS[kind][name]
    if isinstance(found, str):
        module, _, attribute = _place(found).partition(":")
        found = getattr(import_module(module), attribute)
    return found


def _place(home: Any) -> str:
    return home.partition("(")[0] if isinstance(home, str) else ""


def numbers_told(kind: str) -> dict[str, str]:
    """What numbers the parts of a kind take, in their order, by the parts' names; nothing is imported for it."""
    homes = {name: home for name, home in PARTS[kind].items() if isinstance(home, str)}
    return {name: home.partition("(")[2].rstrip(")").replace(",", "") for name, home in homes.items() if "(" in home}


def name_of(part: object) -> str:
    """Name of a part; that of its class if it is not in the table."""
    own = type(part)
    place = f"{own.__module__}:{own.__qualname__}"
    names = (name for table in PARTS.values() for name, home in table.items() if home is own or _place(home) == place)
    return next(names, own.__qualname__)


def told(part: Any) -> str:
    """Name of a law or a profile, its numbers and what it tells; R/eps, which a scene tells, left out."""
    own = {field.name: getattr(part, field.name) for field in fields(part)} if is_dataclass(part) else {}
    own = {name: value for name, value in own.items() if name != "radius_ratio" and value != math.inf}
    numbers = [f"{name} {value.name if isinstance(value, Path) else f'{value:g}'}" for name, value in own.items()]
    return ", ".join([" ".join([name_of(part), *numbers]), *getattr(part, "told", ())])


def record_of(part: Any) -> Any:
    """A scene or a part as plain data: its fields, and its name unless it is the whole."""
    if isinstance(part, Path):
        return str(part)
    if isinstance(part, tuple):
        return [record_of(each) for each in part]
    if not is_dataclass(part):
        return part
    named = {field.name: record_of(getattr(part, field.name)) for field in fields(part)}
    return named if "body" in named else {"name": name_of(part), **named}


def part_from(kind: str, record: Mapping[str, Any]) -> Any:
    """Part of a kind from plain data: `record_of` the other way."""
    given = {name: value for name, value in record.items() if name != "name"}
    parts: dict[str, Any] = {
        name: part_from(name, value) for name, value in given.items() if isinstance(value, Mapping)
    }
    parts |= {
        name: tuple(part_from(name, each) for each in value) for name, value in given.items() if isinstance(value, list)
    }
    return class_of(kind, record["name"])(**(given | parts))
