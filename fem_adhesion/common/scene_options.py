"""The options that say what the contact is, the same for every command that takes one.

A contact is a material in SI or a Tabor parameter. Poisson's ratios belong to the material and are asked for with it;
with a Tabor parameter, which has them in it, they are 0.3 unless given. The parts of a scene are words, see
`fem_adhesion.common.words`.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from fem_adhesion.common.words import Length, in_beta, part_in, usage
from fem_adhesion.registry import PARTS, class_of, name_of
from halfspace.errors import InputError

if TYPE_CHECKING:
    from fem_adhesion.common.contact import Contact, Inputs
    from fem_adhesion.common.options import Parser
    from fem_adhesion.scene import Scene
    from halfspace.laws import Law
    from halfspace.profiles import Profile, Tabulated

    Group = argparse._ArgumentGroup

POISSON = 0.3  # with a Tabor parameter
MATERIAL = ("radius", "modulus", "poisson", "work_of_adhesion")
LAW = ("spacing", "hamaker")  # one of both
COUNTER = ("counter_modulus", "counter_poisson", "counter_radius")
SI_ONLY = ("radius", "modulus", "work_of_adhesion", *LAW, "counter_modulus", "counter_radius")
ATOM = 1e-10  # radius in m of an atom, below which nothing is a sphere
APEX = 0.01  # part by which the radius of a tip's apex, fitted to its table, may differ from what is given
MATERIALS = {"small": "linear-elastic", "finite": "neo-hookean"}  # by the strain


def add_contact(command: Parser, *, in_si_only: bool = False) -> None:
    """Add the options of a contact: of a material only, or of a material or a Tabor parameter."""
    carry = "Quantities carry units; none is guessed."
    spread = " Each may have a standard deviation, as 100+-20nm or 0.30+-0.02: what follows from it is told."
    contact = command.add_argument_group("contact", carry + spread if in_si_only else carry)
    given, plain, of, number = "required", "", "material: ", str if in_si_only else float
    if not in_si_only:
        of = ""
        given = f"required with a material, {POISSON:g} unless given with --tabor"
        plain = ", with --tabor in R dgamma/eps"
        contact.add_argument("--tabor", type=float, help="Tabor parameter, or a material instead", metavar="MU")
    for name, metavar, text in (
        ("radius", "RADIUS", "material: radius of the sphere, as 100nm"),
        ("modulus", "MODULUS", "material: its Young's modulus, as 72GPa"),
        ("work-of-adhesion", "ENERGY", "material: as 0.063J/m^2 or 63mN/m"),
        (
            "spacing",
            "SPACING",
            "material: equilibrium spacing, as 0.143nm; --law may have lengths then, as morse:0.05nm",
        ),
        ("hamaker", "ENERGY", "material: Hamaker constant instead of the spacing, A = 16 pi dgamma eps^2, as 65zJ"),
        ("counter-modulus", "MODULUS", "material: of the other body; rigid unless given"),
        ("counter-radius", "RADIUS", "material: of the other body; flat unless given"),
        ("stiffness", "K", f"of the cantilever, as 0.2N/m{plain}; fixed grips unless given"),
    ):
        contact.add_argument(f"--{name}", help=text.removeprefix(of), metavar=metavar)
    contact.add_argument("--poisson", type=number, help=f"Poisson's ratio, 0 <= nu < 0.5: {given}", metavar="NU")
    contact.add_argument("--counter-poisson", type=number, help=f"of the other body: {given}", metavar="NU")


def add_body(body: Group) -> None:
    """Add the options of the parts of a scene."""
    size = "R/eps, as other sizes, is left out with a material; lengths in beta, with a material as 500nm"
    elastic = f"what is elastic, half-space unless given: {_words('body')}; {size}"
    body.add_argument("--body", help=elastic, metavar="BODY")
    add_profile(body, "the body's own unless given, of a half-space a paraboloid")
    add_law(body)
    counter = "with --tabor: a larger body in the place of the rigid wall: hemisphere:radius_ratio or half-space"
    body.add_argument("--counter", help=counter, metavar="BODY")
    body.add_argument("--share", type=float, help="with --counter: its part of the compliance, 0 to 1", metavar="PART")
    body.add_argument("--strain", choices=tuple(MATERIALS), help="linear or neo-Hookean; small unless given")
    tractions = ("projected", "surface", "reference", "normal", "vertical")
    counted = f"area that the surface law is counted per: {', '.join(tractions)}; projected unless given, at finite "
    counted += "strain with matter conserved"
    body.add_argument("--traction", choices=tractions, help=counted, metavar="AREA")


def add_profile(group: Group, unless: str, known: tuple[str, ...] = ()) -> None:
    """Add the option of the profile, which does not give what is known of the contact."""
    takes = (
        {name: unit for name, unit in made.parameters.items() if name not in known}
        for made in PARTS["profile"].values()
    )
    words = "; ".join(usage("profile", name, own) for name, own in zip(PARTS["profile"], takes, strict=True))
    group.add_argument("--profile", help=f"undeformed gap; {unless}: {words}", metavar="PROFILE")


def add_law(group: Group) -> None:
    """Add the option of the law of tension."""
    what = "of the tension between the surfaces; power-law:3,9 unless given"
    group.add_argument("--law", help=f"{what}: {_words('law')}", metavar="LAW")


def _words(kind: str) -> str:
    return "; ".join(usage(kind, name) for name in PARTS[kind])


def scene_of(options: argparse.Namespace, tabor: float, contact: Contact | None = None) -> Scene:
    """Scene of the parts given; with a material, of the sizes in SI."""
    from fem_adhesion.scene import Scene

    named = PARTS["body"].get((options.body or "half-space").partition(":")[0])
    has_size = named is not None and "radius_ratio" in named.parameters  # a length of its own
    pair = contact if contact and contact.pair and has_size else None
    length: Length = in_beta
    poisson, size = options.poisson, dict[str, Any]()
    if contact:
        remedy = "with a material give --counter-modulus or --counter-radius"
        refuse(options, ("counter", "share"), f"with --tabor; {remedy}")
        poisson, length = pair.smaller_poisson if pair else contact.poisson, _in_si(contact)
        size = {"radius_ratio": pair.smaller_ratio if pair else contact.units.radius_ratio}
    material = _material(options, poisson)
    body = part_in("body", options.body or "half-space", length, size, poisson=poisson, **material)
    profile = None
    if options.profile and (options.profile != name_of(body.shape) or body.file):
        profile = profile_of(options.profile, contact)
    counter, share = _counter(options), options.share
    if pair:
        counter, share = replace(pair, grip=getattr(body, "grip", "sliding")).counter, pair.share
    return Scene(tabor, body, profile, law_of(options), counter, share)


def profile_of(word: str, contact: Contact | None) -> Profile:
    """Profile of a word; with a material its lengths are in SI, and a tip's table has its radius, or InputError."""
    from halfspace.profiles import Tabulated

    length: Length = in_beta
    size = dict[str, Any]()
    if contact:
        length = _in_si(contact)
        size = {"radius_ratio": contact.units.radius_ratio, "counter_radius": contact.larger_radius}
    profile: Profile = part_in("profile", word, length, size)
    if contact and isinstance(profile, Tabulated):
        _require_apex(profile, contact.units.radius)
    return profile


def _require_apex(tip: Tabulated, radius: float) -> None:
    """Refuse a radius in m that is not that of the tip's apex."""
    from fem_adhesion.common.numbers import engineering, metres_of

    metres = metres_of(tip.path)
    own = tip.radius * metres
    if abs(own / radius - 1) > APEX:
        decades = round(math.log10(own / radius))
        remedy = f"give --radius {engineering(own, 'm').replace(' ', '')}"
        if metres == 1 and abs(own / radius * 10.0**-decades - 1) <= APEX:
            remedy = f"multiply both columns by 1e{-decades:+03d}, or begin it with its unit, as r_nm,z_nm"
        raise InputError(
            f"radius = {engineering(radius, 'm')} under a tip whose apex has {tip.radius:.4g} in its table's unit, "
            f"limit: the same to {100 * APEX:g} %, the table in m; {remedy}"
        )


def _in_si(contact: Contact) -> Length:
    """How lengths in words are read with a material: with their unit."""
    from fem_adhesion.common.numbers import parse

    def length(name: str, text: str) -> float:
        size = parse(text, name)
        if name == "thickness":
            contact.require_sample(size)
        return size / contact.units.length

    return length


def _material(options: argparse.Namespace, poisson: float | None) -> dict[str, Any]:
    """Material of the body, if anything is said of it; strata have their own unless there is."""
    said = {"traction": options.traction} if options.traction is not None else {}
    if poisson is None and options.strain is None and not said:
        return {}
    made = class_of("material", MATERIALS[options.strain or "small"])
    return {"material": made(POISSON if poisson is None else poisson, **said)}


def _counter(options: argparse.Namespace) -> Any:
    """Counter-body that is given in a word, or None for a rigid wall."""
    if options.counter is None:
        unheeded = ("share",) if given(options, "counter_modulus") else ("share", "counter_poisson")
        refuse(options, unheeded, "with --counter")
        return None
    poisson = POISSON if options.counter_poisson is None else options.counter_poisson
    return part_in("body", options.counter, material=class_of("material", "linear-elastic")(poisson))


def law_of(options: argparse.Namespace) -> Law:
    """Law given, or the 3-9 law; with a spacing its lengths may have a unit, k and the screening as their inverse."""
    length: Length = in_beta
    if getattr(options, "spacing", None) is not None:
        length = partial(_in_eps, options.spacing)
    law: Law = part_in("law", options.law or "power-law", length)
    return law


def _in_eps(spacing: str, name: str, text: str) -> float:
    """Length of a law in units of the spacing, which must be exact: the draws of an assessment keep the law."""
    from fem_adhesion.common.numbers import measured, parse

    eps = measured(spacing, "spacing")
    if eps.deviation:
        raise InputError(
            f"spacing = {spacing} with {name} = {text}, limit: no deviation; give {name} as a plain number"
        )
    return parse(text, name) / eps.value


def given(options: argparse.Namespace, *names: str) -> list[str]:
    """Those of some options that were given, as they are written."""
    return [f"--{name.replace('_', '-')}" for name in names if getattr(options, name, None) is not None]


def refuse(options: argparse.Namespace, names: tuple[str, ...], why: str) -> None:
    """Refuse options that would have no effect."""
    if unheeded := given(options, *names):
        raise InputError(f"{', '.join(unheeded)} would have no effect, limit: {why}; leave it out")


def contact_of(options: argparse.Namespace) -> Contact | None:
    """The contact in SI, or None with a Tabor parameter."""
    present = given(options, *SI_ONLY)
    if options.tabor is not None:
        if present:
            raise InputError(
                f"tabor = {options.tabor:g} and {present[0]} are given; give either --tabor or a material, not both"
            )
        return None
    if not present:
        raise InputError("neither --tabor nor a material is given; give --tabor 2, say, or --radius 100nm ...")
    inputs = inputs_of(options)
    for name in inputs.deviations:
        why = "limit: a value without a standard deviation, which assess alone takes; leave it out"
        raise InputError(f"{name} = {getattr(options, name)}, {why}")
    return inputs.contact()


def inputs_of(options: argparse.Namespace, **more: Any) -> Inputs:
    """What the contact is made of; InputError if something is missing, or the spacing given twice."""
    from fem_adhesion.common.contact import Inputs
    from fem_adhesion.common.numbers import measured
    from halfspace.laws import LENNARD_JONES

    missing = [f"--{name.replace('_', '-')}" for name in MATERIAL if getattr(options, name) is None]
    laws, law = given(options, *LAW), law_of(options)
    missing += [] if laws else ["--spacing or --hamaker"]
    if missing:
        raise InputError(f"{', '.join(missing)} missing, limit: a whole material; give it too")
    if len(laws) == 2:
        raise InputError(f"{' and '.join(laws)} are given, and each follows from the other; leave one out")
    if law != LENNARD_JONES:
        refuse(options, ("hamaker",), "the 3-9 law, by whose tail it gives the spacing, and --spacing with others")
    named = {
        name: text
        for name in (*MATERIAL, *LAW, *COUNTER, "stiffness", "thickness")
        if (text := getattr(options, name, None)) is not None
    }
    quantities = {name: measured(str(text), name) for name, text in named.items()}
    for name in quantities.keys() & {"radius", "counter_radius"}:
        if quantities[name].value < ATOM:
            limit = f"{ATOM:g} m <= {name}, the size of an atom"
            raise InputError(f"{name} = {named[name]} is outside {limit}; give a larger one, as 100nm")
    return Inputs(quantities, {"law": law, **more})


def stiffness_of(options: argparse.Namespace, contact: Contact | None) -> float:
    """Stiffness of the apparatus in R dgamma/eps."""
    if contact or options.stiffness is None:
        return contact.reduced_stiffness if contact else math.inf
    return in_beta("stiffness", options.stiffness, "R dgamma/eps")
