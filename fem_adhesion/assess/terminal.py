"""The assessment of a contact for the terminal and as a record, in SI."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, fields, replace

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.assess.predictions import ATTRACTING, JUMPS, RADII, WORDS, Quantity
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.spread import Spread
from fem_adhesion.assess.study import Assessment
from fem_adhesion.assess.thin_sample import ThinSample
from fem_adhesion.assess.verdict import percent, the
from fem_adhesion.common import record as common
from fem_adhesion.common.contact import Contact, edge_told
from fem_adhesion.common.facts import plain
from fem_adhesion.common.numbers import (
    DIGITS,
    KINDS,
    PREFIXES,
    decade,
    engineering,
    exponent_of,
    sizes_told,
    with_error,
)
from fem_adhesion.common.terminal import Column, Fitted, Prose, broken, flow
from fem_adhesion.registry import record_of, words_of
from halfspace.laws import LENNARD_JONES
from halfspace.values import Estimate

SHOWN = 4  # digits of a number: a contact's inputs have no more
NARROW = 10  # letters of a line of a column's header: four columns and the models' names, framed, fit 80
TABLES = {
    "what each model says of the contact": ("pull_off_force", "pull_off_radius", "zero_load_radius", "energy_lost"),
    "and of its jumps": JUMPS,
}
ANSWER = ("pull_off_force", "jump_on_separation", "jump_off_separation", "energy_lost")
STANDS = {"bonded": "bonded to its base", "sliding": "sliding on its base"}


def report(assessment: Assessment, digits: int = SHOWN) -> RenderableType:
    """Everything for the terminal, the answer first.

    Numbers have so many significant digits at most, fewer where their errors or spreads leave fewer; `DIGITS` and their
    errors in brackets if asked for more than `SHOWN`.
    """
    return Group(
        *_answer(assessment),
        *_spreads(assessment),
        *models_table(assessment, digits),
        *map(Prose, _legend(assessment, digits)),
        Text(),
        *_deviations(assessment, digits),
        *_thin_sample(assessment.contact, assessment.sample, digits),
        *_distances(assessment),
        *_head(assessment),
    )


def _answer(assessment: Assessment) -> Iterator[RenderableType]:
    """Which model to trust, its main numbers, why, and what is left out of account."""
    best = assessment.best
    yield Prose(assessment.verdict, "bold")
    for name in ANSWER:
        if quantity := best.values.get(name):
            told, spread = engineering(quantity.value, quantity.unit), None
            if assessment.spreads and (spread := assessment.spreads.quantities.get(name)):
                told = spread_told(replace(spread, value=quantity.value, error=quantity.error))
            yield Prose(f"  {WORDS[name]}: {told}")
    if not best.values.keys() & set(JUMPS):
        yield Prose("  no jumps: the contact follows the apparatus smoothly")
    off = [
        f"{the(one.model)} is off by up to {percent(one.size)}, in {WORDS[one.worst]}"
        for one in assessment.distances
        if one.model == assessment.half_space.model and one.worst
    ]
    yield Prose("; ".join([f"why: tabor = {assessment.contact.units.tabor:.4g}, {assessment.regime}", *off]))
    yield from (Prose(f"caution: {line}") for line in assessment.cautions)
    yield Text()


def _head(assessment: Assessment) -> Iterator[RenderableType]:
    """What the contact is in SI and by its parameters."""
    contact, units = assessment.contact, assessment.contact.units
    ratios = (f"R/eps = {units.radius_ratio:.4g}", f"beta/R = {units.length / units.radius:.2g}")
    yield flow([*sizes_told(units), *ratios])
    law = (("spacing eps", units.spacing, "m"), ("work of adhesion", units.work_of_adhesion, "J/m^2"))
    implied = f"with them the Hamaker constant 16 pi dgamma eps^2 = {engineering(units.hamaker, 'J')}"
    if contact.law != LENNARD_JONES:
        implied = f"law {words_of(contact.law)}"
    yield flow([*(f"{name} = {engineering(value, unit)}" for name, value, unit in law), implied])
    fixed = math.isinf(contact.stiffness)
    yield Text("fixed grips" if fixed else f"cantilever: {engineering(contact.stiffness, 'N/m')}")
    if contact.thickness and contact.layer:
        h = f"{engineering(contact.thickness, 'm')} = {contact.layer.thickness:.4g} beta"
        yield flow([f"thin sample: h = {h}", STANDS[contact.foundation]], ", ")
    yield flow([f"{name} = {value:.4g}" for name, value in assessment.parameters.items()])


def _spreads(assessment: Assessment) -> Iterator[RenderableType]:
    """What the standard deviations of the inputs leave of the numbers, and which of them counts most."""
    spreads = assessment.spreads
    if not spreads:
        return
    rows = spreads.quantities
    shares = [
        [f"{x.replace('_', ' ')} {100 * part:.0f} %" for x, part in row.shares.items() if part >= 0.05]
        for row in rows.values()
    ]
    columns = [
        _words(rows),
        Column(f"{spreads.model}", [spread_told(row) for row in rows.values()], words=True),
        Column("variance from", [", ".join(parts) for parts in shares], words=True),
    ]
    yield Fitted(columns, ["uncertainty by that of the inputs: value +- standard deviation, and what it comes from"])
    if not spreads.drawn:
        yield Prose("To the first order; there is no atlas of this contact whose draws of the inputs could confirm it.")
    elif not all(row.linear for row in rows.values()):
        yield Prose(
            f"Median and range: linear propagation fails there, as {spreads.drawn} random draws of the inputs show; "
            "they are the median and the 16 % and 84 % quantiles of those draws that have the quantity."
        )
    yield Text()


def spread_told(spread: Spread) -> str:
    """A quantity to the digits that its spread leaves, ``37.1 +- 7.4 nN``; quantiles where linear propagation fails."""
    if not (spread.linear or spread.quantiles):
        return f"{engineering(spread.value, spread.unit)}, spread not known"
    low, median, high = spread.quantiles or (math.nan,) * 3
    value, size = (spread.value, spread.deviation) if spread.linear else (median, (high - low) / 2)
    exponent = exponent_of(max(abs(value), size))
    scale = 10.0**-exponent
    known = -decade(spread.error * scale) if spread.error else DIGITS  # digits that the number itself has
    decimals = max(0, min(1 - decade(size * scale), known)) if size else USUAL.digits

    def shown(number: float) -> str:
        return f"{number * scale:.{decimals}f}"

    unit = f"{PREFIXES[exponent]}{spread.unit}"
    if spread.linear:
        return f"{shown(value)} +- {shown(size) if float(shown(size)) else f'{size * scale:.1g}'} {unit}"
    part = f"; only {100 * spread.present:.0f} % of draws have it" if spread.present < 1 else ""
    return f"median {shown(median)}, {shown(low)} to {shown(high)} {unit}{part}"


def _legend(assessment: Assessment, digits: int) -> Iterator[str]:
    """How to read the table of models; only what stands in it."""
    for model in assessment.models:
        if model.source == "atlas":
            yield f"The {model.model} is read from halfspace.atlas, made of solved curves, and not solved anew."
    shown = {name for model in assessment.models for name in model.values}
    if shown & set(JUMPS):
        yield (
            "Separation: of the undeformed surfaces just before the jump, negative if they overlap. Base position: of "
            "the cantilever's clamped end then, zero where the undeformed surfaces would be one spacing apart, "
            "negative away from the wall."
        )
    if assessment.contact.law != LENNARD_JONES:
        yield "Maugis lambda and the theories with a range of attraction, Maugis-Dugdale and DMT-M, are the 3-9 law's."
    if shown & set(RADII):
        yield contact_radius(assessment)
    yield "DMT-M: DMT's theory in Maugis's form. Rigid: Bradley's."
    if assessment.half_space.model == ATTRACTING:
        yield f"{ATTRACTING}: JKR's theory in contact, and before it the attraction at a distance."
    yield from _told_as_it_is(assessment)
    brackets = "In brackets: error of the last digit, for closed theories that of the reading only."
    fewer = f"{digits} digits, or as many as are certain; --digits all shows more and the errors."
    yield f"{brackets if digits > SHOWN else fewer} -: not in the model."
    if shown & set(JUMPS) and assessment.deviations:
        yield (
            "Differences of a separation or base position are in % of the spacing and the distance between both jumps, "
            "others in % of the value."
        )


def _told_as_it_is(assessment: Assessment) -> Iterator[str]:
    """What the model of the contact as it is stands for, if that was solved."""
    contact, finite = assessment.contact, assessment.finite
    if finite and contact.layer:
        tip = f"tip, {contact.shape}" if contact.shape else "sphere"
        yield f"Thin sample: under a rigid {tip}; the half-space is a sample without a base."
    elif finite and contact.profile:
        yield f"Given profile: {contact.shape}, on the half-space."
    elif finite:
        body = "what is round is an elastic hemisphere held at its mid-plane"
        if contact.mesh:
            body = "the elastic body of the file, held at its grip"
        yield f"{finite.model.capitalize()}: {body}, {contact.grip}."


def contact_radius(assessment: Assessment) -> str:
    """What each model means by it."""
    named = [model for model in assessment.models if set(model.values) & set(RADII)]
    theirs = "the edge of the theory's own contact, without the ring of attraction around it"
    said = []
    for computed, meaning in ((True, edge_told(assessment.contact.law)), (False, theirs)):
        if names := [model.model for model in named if (model.source != "theory") == computed]:
            said.append(f"of {', '.join(names)}, {meaning}")
    return f"Contact radius: {'; '.join(said)}."


def models_table(assessment: Assessment, digits: int = SHOWN) -> Iterator[Fitted]:
    """A line for each model, a column for each quantity: two tables, which fit 80 columns with all digits."""
    models = assessment.models
    for title, names in TABLES.items():
        columns = [Column("model", [model.model for model in models], words=True)]
        for name in names:
            found = [model.values.get(name) for model in models]
            if known := [quantity for quantity in found if quantity]:
                largest = max(known, key=lambda quantity: abs(quantity.value))
                exponent = exponent_of(largest.value)
                spread = assessment.spreads.quantities.get(name) if assessment.spreads else None
                least = spread.deviation / 10 if spread and spread.deviation > 0 and digits <= SHOWN else 0.0
                cells = [_shown(quantity, 10.0**-exponent, digits, least) if quantity else "-" for quantity in found]
                header = f"{broken(WORDS[name], NARROW)}\n{PREFIXES[exponent]}{largest.unit}"
                columns.append(Column(header, cells))
        if columns[1:]:
            yield Fitted(columns, [title])


def _shown(quantity: Quantity, scale: float, digits: int, least: float = 0.0) -> str:
    """Number to some digits, fewer if its error or a greater one leaves fewer; with the error if there are many."""
    known = Estimate(quantity.value, max(quantity.error, least))
    text = with_error(known, scale, digits)
    return text if digits > SHOWN or not math.isfinite(known.error) else text.partition("(")[0]


def _words(quantities: Iterable[str], header: str = "quantity") -> Column:
    """Column of quantities in words."""
    return Column(header, [WORDS.get(name, name) for name in quantities], words=True)


def _percents(header: str, parts: Iterable[Quantity | None], digits: int) -> Column:
    """Column of parts, in per cent."""
    cells = [with_error(part, 100, USUAL.digits) if part else "-" for part in parts]
    if digits <= SHOWN:
        cells = [cell.partition("(")[0] for cell in cells]
    return Column(f"{header}\n%", cells)


def _deviations(assessment: Assessment, digits: int) -> Iterator[RenderableType]:
    """Table of how far the finite bodies are from the half-space, by cause, if that is known."""
    known = [d for d in assessment.deviations if d.profile or d.total]
    if not known:
        return
    body = "thickness" if assessment.contact.layer else "finite body"
    both = any(d.profile for d in known)
    causes = (
        (assessment.profile.model if assessment.profile else "", [d.profile for d in known]),
        (body, [d.body for d in known]),
        ("both" if both else assessment.best.model, [d.total for d in known]),
    )
    columns = [_percents(*cause, digits) for cause in causes if any(cause[1])]
    title = f"difference from {the(assessment.half_space.model)}, in % of it, by cause"
    yield Fitted([_words(d.quantity for d in known), *columns], [title])
    yield Text()


def _distances(assessment: Assessment) -> Iterator[RenderableType]:
    """Table of how far the other models are from the best one, in which quantity most, and how many they have."""
    rows, count = assessment.distances, len(assessment.best.values)
    columns = [
        Column("model", [row.model for row in rows], words=True),
        Column("off by\nup to", [percent(row.size) if row.worst else "-" for row in rows]),
        Column("in", [WORDS[row.worst] if row.worst else "-" for row in rows], words=True),
        Column("has", [f"{count - len(row.missing)} of {count}" for row in rows]),
    ]
    yield Fitted(columns, [f"how far each model is from {the(assessment.best.model)}"])
    yield Text()


def _thin_sample(contact: Contact, sample: ThinSample | None, digits: int) -> Iterator[RenderableType]:
    """What of it the half-space and the series get wrong without adhesion, and which thickness is enough."""
    if sample and contact.thickness:
        yield indentations_table(sample, digits)
        until = _shown(sample.hertz_until, 1.0, min(digits, USUAL.digits))
        reach = (sample.hertz_until.value * contact.thickness) ** 2 / contact.units.radius
        yield Prose(
            "Chi: sqrt(R delta)/h of the indentation delta. Series: Dimitriadis et al. (2002), for chi up to 1. "
            f"Hertz's load is right to {100 * USUAL.wrong:g} % up to chi = {until}, here an indentation of "
            f"{engineering(reach, 'm')}."
        )
        yield Text()
        yield enough_table(sample, digits)
        yield Text()


def indentations_table(sample: ThinSample, digits: int) -> Fitted:
    """Contacts without adhesion, a line each."""
    rows = sample.indentations
    length, force = exponent_of(rows[-1].indentation), exponent_of(rows[-1].force.value)
    columns = [
        Column(f"indentation\n{PREFIXES[length]}m", [f"{row.indentation / 10.0**length:.4g}" for row in rows]),
        Column("chi", [f"{row.chi:.4g}" for row in rows]),
        Column(f"force\n{PREFIXES[force]}N", [_shown(row.force, 10.0**-force, digits) for row in rows]),
        _percents("Hertz off", [row.half_space for row in rows], digits),
        _percents("series off", [row.series for row in rows], digits),
    ]
    return Fitted(columns, ["without adhesion on the thin sample, and how far Hertz's theory and the series are off"])


def enough_table(sample: ThinSample, digits: int) -> Fitted:
    """Thicknesses from which on the half-space is right, a line each."""
    size = exponent_of(max((row.thickness.value for row in sample.enough if row.thickness), default=1e-6))
    thicknesses = [_shown(row.thickness, 10.0**-size, digits) if row.thickness else row.note for row in sample.enough]
    columns = [
        _words((row.quantity for row in sample.enough), "in"),
        Column(f"thickness\n{PREFIXES[size]}m", thicknesses),
        _words((row.worst or "-" for row in sample.enough), "worst"),
    ]
    return Fitted(columns, [f"from which thickness on the half-space is right to {100 * USUAL.wrong:g} %"])


UNITS = {name: KINDS[name][0] for name in (*(part.name for part in fields(Contact)), "hamaker") if name in KINDS} | {
    "equivalent_radius": "m",
    "contact_modulus": "Pa",
    "thickness_in_beta": "beta",
    "indentation": "m",
}


def record(assessment: Assessment) -> dict[str, object]:
    """Everything as plain data for JSON: a quantity is a value, an error and a unit in SI; see `UNITS` for others."""
    contact = assessment.contact
    found = {
        "input": {
            **asdict(contact),
            **{part: record_of(getattr(contact, part)) for part in ("law", "profile", "mesh")},
        },
        "thickness_in_beta": contact.layer.thickness if contact.layer else None,
        "equivalent_radius": contact.units.radius,
        "contact_modulus": contact.units.modulus,
        "hamaker": contact.units.hamaker if contact.law == LENNARD_JONES else None,
        "radius_ratio": contact.units.radius_ratio,
        "parameters": assessment.parameters,
        "regime": assessment.regime,
        "models": [
            {"model": m.model, "source": m.source, "values": m.values, "missed": m.missed} for m in assessment.models
        ],
        "thin_sample": assessment.sample,
        "spreads": assessment.spreads,
        "deviations": assessment.deviations,
        "distances": assessment.distances,
        "definitions": {"contact_radius": contact_radius(assessment)},
        "cautions": assessment.cautions,
        "verdict": [assessment.verdict],
        "seconds": assessment.seconds,
    }
    return common.record(units=UNITS) | {name: plain(part) for name, part in found.items()}
