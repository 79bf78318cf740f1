"""Names of the parts of a scene, as the command line and files have them, and their classes: one table, both ways.

A new part is a class and a line here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Part:
    """Class of a part and the parameters that one word on the command line gives, in their order.

    Parameters
    ----------
    module, name : str
        Where the class is; it is imported when it is first asked for.
    parameters : dict
        Units by the names of the parameters, "file" for a path, "this or that" for a choice of words.
    """

    module: str
    name: str
    parameters: Mapping[str, str] = field(default_factory=dict)

    @property
    def made_by(self) -> Any:
        """The class."""
        return getattr(import_module(self.module), self.name)


RATIO, GRIP = {"radius_ratio": "R/eps"}, {"grip": "sliding or bonded"}
SHEAR = {"foundation": "bonded or sliding"}
HELD, FLAT, STRATA = (f"fem_adhesion.bodies.{module}" for module in ("held", "half_space", "layers"))
LAWS, PROFILES, WAVES = "halfspace.laws.formulas", "halfspace.profiles.formulas", "halfspace.elastic.layers"

PARTS: dict[str, dict[str, Part]] = {
    "body": {
        "half-space": Part(FLAT, "HalfSpace"),
        "block": Part(FLAT, "Block", {"radius": "beta", "far_field": "point_load or clamped or free"}),
        "hemisphere": Part(HELD, "Hemisphere", RATIO | GRIP),
        "held-sphere": Part(HELD, "HeldSphere", RATIO | {"cap_angle": "degrees"} | GRIP),
        "layer": Part(STRATA, "Layer", {"thickness": "beta"} | SHEAR),
        "coated": Part(STRATA, "Coated", {"thickness": "beta", "modulus_ratio": "E/E below", "substrate_poisson": ""}),
        "layers": Part(STRATA, "Layers"),
        "meshed": Part(HELD, "Meshed", {"path": "file"} | RATIO | GRIP),
    },
    "strata": {"stratum": Part(WAVES, "Stratum", {"thickness": "beta", "poisson": "", "modulus": "E of the first"})},
    "base": {"substrate": Part(WAVES, "Substrate", {"modulus": "E of the first", "poisson": ""})},
    "material": {
        "linear-elastic": Part("fem_adhesion.materials", "LinearElastic"),
        "neo-hookean": Part("fem_adhesion.materials", "NeoHookean"),
    },
    "law": {
        "power-law": Part(LAWS, "PowerLaw", {"attraction": "power", "repulsion": "power"}),
        "morse": Part(LAWS, "Morse", {"k": "1/eps"}),
        "exponential": Part(LAWS, "Exponential", {"k": "1/eps", "core": "power"}),
        "dlvo": Part(LAWS, "Dlvo", {"charge": "", "screening": "1/eps"}),
        "dugdale": Part(LAWS, "Dugdale", {"width": "eps"}),
        "tabulated": Part("halfspace.laws.tabulated", "Tabulated", {"path": "file"}),
    },
    "profile": {
        "paraboloid": Part(PROFILES, "Paraboloid"),
        "sphere": Part(PROFILES, "Sphere", RATIO | {"counter_radius": "R2/R1"}),
        "power": Part(PROFILES, "Power", {"k": "power"}),
        "hyperboloid": Part(PROFILES, "Hyperboloid", {"b": "beta"}),
        "rounded-punch": Part(PROFILES, "RoundedPunch", {"flat": "beta"}),
        "tabulated": Part("halfspace.profiles.tabulated", "Tabulated", {"path": "file"} | RATIO),
    },
}
"""Parts by the name of their kind and their own."""


def class_of(kind: str, name: str) -> Any:
    """Class of a part by the name of its kind and its own."""
    return PARTS[kind][name].made_by


def name_of(part: object) -> str:
    """Name of a part; that of its class if it is not in the table."""
    own = type(part)
    known = {(made.module, made.name): name for table in PARTS.values() for name, made in table.items()}
    return known.get((own.__module__, own.__qualname__), own.__qualname__)


def words_of(part: Any) -> str:
    """Name of a law or a profile, its numbers and what it tells; R/eps, which a scene tells, left out."""
    own = {field.name: getattr(part, field.name) for field in fields(part)} if is_dataclass(part) else {}
    own = {name: value for name, value in own.items() if name != "radius_ratio" and value != math.inf}
    made = [table[name_of(part)] for table in PARTS.values() if name_of(part) in table]
    units = {name: [unit] for one in made for name, unit in one.parameters.items() if unit in ("beta", "eps")}
    numbers = [
        " ".join([name, value.name if isinstance(value, Path) else f"{value:g}", *units.get(name, ())])
        for name, value in own.items()
    ]
    return ", ".join([" ".join([name_of(part), *numbers]), *getattr(part, "findings", ())])


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

    def made(name: str, value: Any) -> Any:
        if isinstance(value, list):
            return tuple(part_from(name, each) for each in value)
        return part_from(name, value) if isinstance(value, Mapping) else value

    given = {name: made(name, value) for name, value in record.items() if name != "name"}
    return class_of(kind, record["name"])(**given)
