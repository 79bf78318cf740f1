"""The options that say what the contact is, the same for every command that takes one.

A contact is a material in SI or a Tabor parameter. One rule holds for Poisson's ratios: they belong to the material and
are asked for with it; with a Tabor parameter, which has them in it, they are 0.3 unless given.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_adhesion.registry import PARTS, class_of, name_of
from halfspace.errors import InputError

if TYPE_CHECKING:
    from fem_adhesion.bodies.body import Body, GripName
    from fem_adhesion.common.contact import Contact
    from fem_adhesion.common.options import Parser
    from fem_adhesion.scene import Scene
    from halfspace.elastic.layers import Foundation, Layers, Stratum, Substrate
    from halfspace.laws import Law

    Group = argparse._ArgumentGroup

POISSON = 0.3  # with a Tabor parameter
MATERIAL = ("radius", "modulus", "poisson", "work_of_adhesion")
LAW = ("spacing", "hamaker")  # one of both
COUNTER = ("counter_modulus", "counter_poisson", "counter_radius")
SI_ONLY = ("radius", "modulus", "work_of_adhesion", *LAW, "counter_modulus")


def add_contact(command: Parser, *, in_si_only: bool = False) -> None:
    """Add the options of a contact: of a material only, or of a material or a Tabor parameter."""
    contact = command.add_argument_group("contact", "Quantities carry units; none is guessed.")
    given = "asked for" if in_si_only else f"asked for with a material, {POISSON:g} unless given with --tabor"
    plain = "" if in_si_only else ", with --tabor in radii of the first"
    if not in_si_only:
        contact.add_argument("--tabor", type=float, help="Tabor parameter, or a material instead", metavar="MU")
    contact.add_argument("--radius", help="material: radius of the sphere, as 100nm")
    contact.add_argument("--modulus", help="material: its Young's modulus, as 72GPa")
    contact.add_argument("--poisson", type=float, help=f"its Poisson's ratio, 0 <= nu < 0.5: {given}", metavar="NU")
    contact.add_argument("--work-of-adhesion", help="material: as 0.063J/m^2 or 63mN/m", metavar="ENERGY")
    contact.add_argument("--spacing", help="material: equilibrium spacing of the surface law, as 0.143nm")
    hamaker = "material: Hamaker constant in the place of the spacing, A = 16 pi dgamma eps^2, as 65zJ or 6.5e-20J"
    contact.add_argument("--hamaker", help=hamaker, metavar="ENERGY")
    contact.add_argument("--counter-modulus", help="of the other body; rigid unless given", metavar="MODULUS")
    add_other_body(contact, given, plain, in_si_only=in_si_only)
    spring = "" if in_si_only else ", with --tabor in R dgamma/eps"
    help_text = f"of the cantilever, as 0.2N/m{spring}; fixed grips unless given"
    contact.add_argument("--stiffness", help=help_text, metavar="K")


def add_other_body(contact: Group, given: str, plain: str, *, in_si_only: bool = False) -> None:
    """Add the options of a counter-body that are not in SI, and how bodies are held."""
    contact.add_argument("--counter-poisson", type=float, help=f"of the other body: {given}", metavar="NU")
    contact.add_argument("--counter-radius", help=f"of the other body{plain}; flat unless given", metavar="RADIUS")
    if not in_si_only:
        share = "with --tabor: its part of the compliance, 0 to 1; rigid unless given"
        contact.add_argument("--counter-share", type=float, help=share, metavar="PART")
    grip = "how a sphere is held at its mid-plane or a body at its far side; sliding unless given"
    contact.add_argument("--grip", choices=("sliding", "bonded"), help=grip)


def add_body(body: Group) -> None:
    """Add the options of what is elastic."""
    body.add_argument("--body", choices=tuple(PARTS["body"]), help="what is elastic; half-space unless given")
    body.add_argument("--mesh", type=Path, help="file with the mesh of the body, which is meshed then", metavar="FILE")
    profile = "undeformed gap; the body's own unless given, of a half-space a paraboloid"
    _add_part(body, "profile", profile)
    add_law(body)
    cap = "half-angle of the cap over which a sphere is held, degrees; 30 unless given"
    body.add_argument("--cap-angle", type=float, help=cap, metavar="ANGLE")
    add_layer(body, "thickness of a layer on a rigid base or of a coating: with --tabor in beta, else as 500nm")
    ratio = "Young's modulus of a coating over that of the half-space below"
    body.add_argument("--modulus-ratio", type=float, help=ratio, metavar="RATIO")
    below = "Poisson's ratio of the half-space below a coating; 0.3 unless given"
    body.add_argument("--substrate-poisson", type=float, help=below, metavar="NU")
    strata = "layers from the surface down: thickness in beta, Poisson's ratio (the body's), modulus in the first's (1)"
    body.add_argument("--strata", nargs="+", help=strata, metavar="T:NU:E")
    half_space = "half-space below these, by its modulus and Poisson's ratio; a rigid base unless given"
    body.add_argument("--substrate", help=half_space, metavar="E:NU")
    body.add_argument("--block-radius", type=float, help="size of a block in beta", metavar="L")
    held = "what holds a block at its far side; point_load unless given"
    body.add_argument("--far-field", choices=("point_load", "clamped", "free"), help=held)
    body.add_argument("--strain", choices=tuple(MATERIALS), help="linear or neo-Hookean; small unless given")
    counted = "what the surface law is counted per; projected unless given, at finite strain with matter conserved"
    tractions = ("projected", "surface", "reference", "normal", "vertical")
    body.add_argument("--traction", choices=tractions, help=counted)
    ratio = "with --tabor: R/eps of a body with a size, or of a true profile"
    body.add_argument("--radius-ratio", type=float, help=ratio, metavar="RHO")


def add_layer(group: Group, thickness: str) -> None:
    """Add the options of a layer on a rigid base."""
    group.add_argument("--thickness", help=thickness, metavar="T")
    base = "whether the base holds a layer or carries it without friction; bonded unless given"
    group.add_argument("--foundation", choices=("bonded", "sliding"), help=base)


def add_law(group: Group) -> None:
    """Add the options of the law of tension."""
    _add_part(group, "law", "of the tension between the surfaces; power-law unless given")


def _add_part(group: Group, kind: str, what: str) -> None:
    """Add the options of a law or a profile: its name, and its parameters in their order."""
    group.add_argument(f"--{kind}", choices=tuple(PARTS[kind]), help=what)
    numbers = {name: [n for n in part.parameters if n not in GIVEN_OTHERWISE] for name, part in PARTS[kind].items()}
    taken = "; ".join(f"{name}: {' '.join(own)}" for name, own in numbers.items() if own)
    group.add_argument(f"--{kind}-parameter", nargs="+", help=f"its own, in order ({taken})", metavar="X")


MATERIALS = {"small": "linear-elastic", "finite": "neo-hookean"}  # by the strain
ALIASES = {"path": "mesh", "radius": "block_radius", "base": "substrate"}
"""Options that say what fields of a body are whose names they do not have."""
GIVEN_OTHERWISE = ("radius_ratio", "counter_radius", "end")  # of a profile: by options of a body, or by the body


def scene_of(
    options: argparse.Namespace,
    tabor: float,
    poisson: float,
    radius_ratio: float | None,
    counter: Body | None,
    share: float | None,
    layer: Layers | None = None,
) -> Scene:
    """Scene of the body given; `radius_ratio` is its own, or the profile's, `layer` a thin sample given in SI."""
    from fem_adhesion.scene import Scene

    strata, traction = _strata(options, poisson), {} if options.traction is None else {"traction": options.traction}
    poisson = strata[0].poisson if strata and options.poisson is None else poisson
    material = class_of("material", MATERIALS[options.strain or "small"])(poisson, **traction)
    own: dict[str, object] = {"radius_ratio": radius_ratio, "strata": strata or None, "base": _base(options)}
    if layer or options.thickness is not None:
        own["thickness"] = layer.thickness if layer else _plain(options, "thickness", "beta")
    body = _body(options, own, material)
    profile, law = _profile(options, body, radius_ratio), law_of(options)
    return Scene(tabor, body, profile, law, counter=counter, share=share)


def law_of(options: argparse.Namespace) -> Law:
    """Law given, or the 3-9 law."""
    from halfspace.laws import LENNARD_JONES

    if options.law is None:
        refuse(options, ("law_parameter",), "with --law")
        return LENNARD_JONES
    law: Law = class_of("law", options.law)(*_values(options, "law"))
    return law


def law_named(text: str) -> Law:
    """Law by its name and parameters in one word, as ``power-law:4,10``."""
    name, _, numbers = text.partition(":")
    if name not in PARTS["law"]:
        raise InputError(
            f"law = {name}, limit: one of {', '.join(PARTS['law'])}; write NAME or NAME:PARAMETER,PARAMETER"
        )
    return law_of(argparse.Namespace(law=name, law_parameter=numbers.split(",") if numbers else None))


def _values(options: argparse.Namespace, kind: str) -> list[float | Path]:
    """Parameters of a law or a profile."""
    name, given = getattr(options, kind), getattr(options, f"{kind}_parameter") or []
    own = _parameters(kind, name)
    least = sum(_fields(name, kind)[field].default is MISSING for field in own)
    if not least <= len(given) <= len(own):
        optional = [f"[{field}]" for field in own[least:]]
        listed = " ".join([*own[:least], *optional]) or "none"
        remedy = "give them in this order" if own else "leave it out"
        raise InputError(f"{kind}_parameter = {' '.join(given) or None} for {kind} = {name}, limit: {listed}; {remedy}")
    named = zip(own, given, strict=False)
    return [Path(text) if field == "path" else _number(f"{kind}_parameter", text) for field, text in named]


def _parameters(kind: str, name: str) -> list[str]:
    """Fields of a law or a profile that are numbers of its own, none of which other options give."""
    return [field for field in _fields(name, kind) if field not in GIVEN_OTHERWISE]


def _number(name: str, text: str, why: str = ", limit: a plain number; give one without a unit") -> float:
    try:
        return float(text)
    except ValueError as error:
        raise InputError(f"{name} = {text}{why}") from error


def has_size(options: argparse.Namespace) -> bool:
    """Whether the body given has a length of its own."""
    return "radius_ratio" in _fields(_name(options))


def _name(options: argparse.Namespace) -> str:
    if options.mesh and options.body not in (None, "meshed"):
        raise InputError(f"mesh = {options.mesh} with body = {options.body}, limit: one of both; leave out --body")
    return "meshed" if options.mesh else options.body or "half-space"


def _fields(name: str, kind: str = "body") -> dict[str, Any]:
    return {field.name: field for field in fields(class_of(kind, name))}


def _strata(options: argparse.Namespace, poisson: float) -> tuple[Stratum, ...]:
    """Strata given, from the surface down."""
    from halfspace.elastic.layers import Stratum

    default = (math.nan, poisson, 1.0)
    given = [_numbers("strata", word, len(default)) for word in options.strata or ()]
    return tuple(Stratum(*numbers, *default[len(numbers) :]) for numbers in given)


def _base(options: argparse.Namespace) -> Foundation | Substrate | None:
    """What carries them: the half-space that is given, or a rigid base."""
    from halfspace.elastic.layers import Substrate

    if options.substrate is None:
        rigid: Foundation | None = options.foundation
        return rigid
    refuse(options, ("foundation",), "without --substrate, which is bonded")
    return Substrate(*_numbers("substrate", options.substrate, 2))


def _numbers(name: str, word: str, most: int) -> list[float]:
    numbers = [_number(name, text) for text in word.split(":")]
    if len(numbers) > most:
        raise InputError(f"{name} = {word}, limit: {most} numbers between colons; leave out the rest")
    return numbers


def _body(options: argparse.Namespace, values: Mapping[str, Any], material: object) -> Any:
    """Body of the fields given, none of which it lacks; its lengths are dimensionless."""
    name = _name(options)
    own = _fields(name)
    for field in dict.fromkeys(field for other in PARTS["body"] for field in _fields(other)):
        if field not in ("material", "radius_ratio") and name not in _having(field):
            option = ALIASES.get(field, field)
            refuse(options, (option,), "with " + " or ".join(f"--body {other}" for other in _having(field)))
    asked = [field for field in own if field != "material"]
    values = {field: values.get(field, getattr(options, ALIASES.get(field, field))) for field in asked}
    for field, value in values.items():
        if value is None and own[field].default is MISSING:
            raise InputError(
                f'{field} = None for body = "{name}", limit: {LACKED.get(field, "a number; give --radius-ratio")}'
            )
    given = {field: value for field, value in values.items() if value is not None}
    return class_of("body", name)(material=material, **given)


LACKED = {
    "path": "a file; give --mesh FILE",
    "radius": "a number; give --block-radius, in beta",
    "thickness": "a number; give --thickness, in beta, or with a material as 500nm",
    "modulus_ratio": "a number; give --modulus-ratio",
    "strata": "one or more; give --strata T:NU:E, the thickness in beta",
}
"""What to do about a field of a body that was not given."""


def _having(field: str) -> list[str]:
    """Bodies that have a field; a rigid base of strata is a foundation, too."""
    return [name for name in PARTS["body"] if {field, "base" if field == "foundation" else field} & set(_fields(name))]


def _profile(options: argparse.Namespace, body: Body, radius_ratio: float | None) -> Any:
    """Profile given, or None for the body's own."""
    name = options.profile
    own = name is None or (name == name_of(body.shape) and not body.file)
    if name is None:
        refuse(options, ("profile_parameter",), "with --profile")
    takes = not own and "radius_ratio" in _fields(name, "profile")
    if math.isinf(body.size) and options.radius_ratio is not None and not takes:
        raise InputError(
            f"radius_ratio = {options.radius_ratio:g} means nothing to a {body.name} under a paraboloid; leave it out, "
            "or take --body hemisphere or --profile sphere"
        )
    values = [] if name is None else _values(options, "profile")
    if own:
        return None
    if takes and radius_ratio is None:
        raise InputError(f'radius_ratio = None for profile = "{name}", limit: a number; give --radius-ratio')
    return class_of("profile", name)(*values, *([radius_ratio] if takes else []))


def given(options: argparse.Namespace, *names: str) -> list[str]:
    """Those of some options that were given, as they are written."""
    return [f"--{name.replace('_', '-')}" for name in names if getattr(options, name, None) is not None]


def refuse(options: argparse.Namespace, names: tuple[str, ...], why: str) -> None:
    """Refuse options that would not be heeded."""
    unheeded = given(options, *names)
    if unheeded:
        raise InputError(f"{', '.join(unheeded)} would not be heeded, limit: {why}; leave it out")


def material_unless_tabor(options: argparse.Namespace) -> Contact | None:
    """The contact in SI, or None with a Tabor parameter."""
    present = given(options, *SI_ONLY)
    if options.tabor is not None:
        if present:
            raise InputError(
                f"tabor = {options.tabor:g} with {present[0]}, limit: one of both; leave out --tabor or the material"
            )
        return None
    if not present:
        raise InputError("tabor = None and no material, limit: one of both; give --tabor 2, say, or --radius 100nm ...")
    refuse(options, ("counter_share",), "with --tabor, as the part follows from the moduli")
    return material_of(options)


def _require_whole(options: argparse.Namespace) -> None:
    """Refuse a material that lacks something, or whose spacing is given twice, or by a constant of another law."""
    missing = [f"--{name.replace('_', '-')}" for name in MATERIAL if getattr(options, name) is None]
    laws = given(options, *LAW)
    if not laws:
        missing.append("--spacing or --hamaker")
    if missing:
        raise InputError(f"{', '.join(missing)} missing, limit: a whole material; give it too")
    if len(laws) == 2:
        raise InputError(f"{' with '.join(laws)}, limit: one of both, as each follows from the other; leave one out")
    if options.law is not None and law_of(options) != class_of("law", "power-law")():
        refuse(options, ("hamaker",), "the 3-9 law, by whose tail it gives the spacing, and --spacing with others")


def material_of(options: argparse.Namespace) -> Contact:
    """The contact in SI."""
    from fem_adhesion.common.contact import Contact
    from fem_adhesion.common.numbers import KINDS, parse
    from halfspace.scaling import spacing_of

    _require_whole(options)
    named = {name: text for name in KINDS if (text := getattr(options, name)) is not None}
    quantities = {name: parse(text, name) for name, text in named.items()}
    if "hamaker" in quantities:
        quantities["spacing"] = spacing_of(quantities.pop("hamaker"), quantities["work_of_adhesion"])
    return Contact(
        **quantities,
        poisson=options.poisson,
        counter_poisson=options.counter_poisson,
        grip=options.grip or "sliding",
        law=law_of(options),
        foundation=options.foundation or "bonded",
    )


def counter_of(options: argparse.Namespace) -> tuple[float | None, Body | None, float | None]:
    """First body's R/eps, counter-body and its share as given with a Tabor parameter; both None for a rigid wall."""
    from fem_adhesion.bodies.half_space import HalfSpace
    from fem_adhesion.bodies.held import Hemisphere
    from fem_adhesion.scene import facing_pair
    from halfspace.limits import require_counter_radius

    share, ratio = options.counter_share, options.radius_ratio
    if share is None:
        refuse(options, COUNTER, "with --counter-share where there is --tabor")
        return ratio, None, None
    poisson = POISSON if options.counter_poisson is None else options.counter_poisson
    larger = math.inf if options.counter_radius is None else _plain(options, "counter_radius", "radii of the first")
    if ratio is None or math.isinf(require_counter_radius(larger)):
        return ratio, HalfSpace(poisson=poisson), share
    smaller_ratio, larger_ratio = facing_pair(ratio, larger)
    grip: GripName = options.grip or "sliding"
    return smaller_ratio, Hemisphere(radius_ratio=larger_ratio, grip=grip, poisson=poisson), share


def stiffness_of(options: argparse.Namespace, contact: Contact | None) -> float:
    """Stiffness of the apparatus in R dgamma/eps."""
    if contact:
        return contact.reduced_stiffness
    return math.inf if options.stiffness is None else _plain(options, "stiffness", "R dgamma/eps")


def _plain(options: argparse.Namespace, name: str, unit: str) -> float:
    return _number(name, getattr(options, name), f" is not a plain number in {unit}; give one, or a material")
