"""The assessment of a contact for the terminal and as a record, in SI."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.assess.predictions import POSITIONS, QUANTITIES, RADII, WORDS, Quantity
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.spread import Spread
from fem_adhesion.assess.study import Assessment
from fem_adhesion.assess.thin_sample import ThinSample
from fem_adhesion.common import record as common
from fem_adhesion.common.contact import Contact, edge_told
from fem_adhesion.common.facts import plain
from fem_adhesion.common.numbers import KINDS, PREFIXES, decade, engineering, exponent_of, sizes_told, with_error
from fem_adhesion.common.terminal import Column, Fitted, Prose, flow
from fem_adhesion.registry import record_of, words_of
from halfspace.laws import LENNARD_JONES

STANDS = {"bonded": "bonded to its base", "sliding": "sliding on its base"}


def report(assessment: Assessment) -> RenderableType:
    """Everything for the terminal."""
    return Group(
        *_head(assessment),
        *_spreads(assessment),
        models_table(assessment),
        *map(Prose, _legend(assessment)),
        Text(),
        *_deviations(assessment),
        *_thin_sample(assessment.contact, assessment.sample),
        *(Prose(f"caution: {line}") for line in assessment.cautions),
        *map(Prose, assessment.verdict),
    )


def _head(assessment: Assessment) -> Iterator[RenderableType]:
    contact, units = assessment.contact, assessment.contact.units
    yield Prose(f"regime: {assessment.regime}")
    yield flow([f"{name} = {value:.4g}" for name, value in assessment.parameters.items()])
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
    yield Text()


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
    yield Fitted(columns, ["what the inputs leave: value +- standard deviation, and what that comes from"])
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
    low, median, high = spread.quantiles or (math.nan,) * 3
    value, size = (spread.value, spread.deviation) if spread.linear else (median, (high - low) / 2)
    exponent = exponent_of(max(abs(value), size))
    decimals = max(0, 1 - decade(size / 10.0**exponent)) if size else USUAL.digits

    def shown(number: float) -> str:
        return f"{number / 10.0**exponent:.{decimals}f}"

    unit = f"{PREFIXES[exponent]}{spread.unit}"
    if spread.linear:
        return f"{shown(value)} +- {shown(size)} {unit}"
    if not spread.quantiles:
        return f"{shown(spread.value)} {unit}, spread not known"
    part = f"; only {100 * spread.present:.0f} % of draws have it" if spread.present < 1 else ""
    return f"median {shown(median)}, {shown(low)} to {shown(high)} {unit}{part}"


def _legend(assessment: Assessment) -> Iterator[str]:
    """How to read the table of models; only what stands in it."""
    for model in assessment.models:
        if model.source == "atlas":
            yield f"The {model.model} is read from halfspace.atlas, made of solved curves, and not solved anew."
    shown = {name for model in assessment.models for name in model.values}
    if shown & {name for names in POSITIONS for name in names}:
        yield (
            "Separation: of the undeformed surfaces where the jump takes off, negative if they overlap. Base: position "
            "of the cantilever's far end there, zero where the undeformed surfaces would be one spacing apart, "
            "negative away from the wall."
        )
    if assessment.contact.law != LENNARD_JONES:
        yield "Maugis lambda and the theories with a range of attraction, Maugis-Dugdale and DMT-M, are the 3-9 law's."
    if shown & set(RADII):
        yield contact_radius(assessment)
    if assessment.finite and assessment.contact.layer:
        yield "Thin sample: under a rigid sphere; the half-space is as thick as can be."
    elif assessment.finite:
        yield f"Of the {assessment.finite.model} what is round is held at its mid-plane, {assessment.contact.grip}."
    yield (
        "In brackets: error of the last digit, for closed theories that of the reading only. -: not in the model. "
        "Differences of a position are parts of the spacing and the distance between both jumps, others of the value."
    )


def contact_radius(assessment: Assessment) -> str:
    """What each model means by it."""
    named = [model for model in assessment.models if set(model.values) & set(RADII)]
    theirs = "the edge of the theory's own contact, without the ring of attraction around it"
    said = []
    for computed, meaning in ((True, edge_told(assessment.contact.law)), (False, theirs)):
        if names := [model.model for model in named if (model.source != "theory") == computed]:
            said.append(f"of {', '.join(names)}, {meaning}")
    return f"Contact radius: {'; '.join(said)}."


def models_table(assessment: Assessment) -> Fitted:
    """A line for each quantity, a column for each model."""
    models, columns = assessment.models, []
    rows = [name for name in QUANTITIES if any(name in model.values for model in models)]
    largest = [max((m.values[name] for m in models if name in m.values), key=lambda q: abs(q.value)) for name in rows]
    scales = [exponent_of(quantity.value) for quantity in largest]
    for model in models:
        found = zip((model.values.get(name) for name in rows), scales, strict=True)
        cells = [with_error(quantity, 10.0**-exponent) if quantity else "-" for quantity, exponent in found]
        columns.append(Column(model.model, cells))
    units = [PREFIXES[exponent] + quantity.unit for quantity, exponent in zip(largest, scales, strict=True)]
    return Fitted([_words(rows), Column("unit", units, words=True), *columns], ["what each model says"])


def _words(quantities: Iterable[str], header: str = "quantity") -> Column:
    """Column of quantities in words."""
    return Column(header, [WORDS.get(name, name) for name in quantities], words=True)


def _percents(header: str, parts: Iterable[Quantity | None]) -> Column:
    """Column of parts, in per cent."""
    cells = [with_error(part, 100, USUAL.digits) if part else "-" for part in parts]
    return Column(f"{header}\n%", cells)


def _deviations(assessment: Assessment) -> Iterator[RenderableType]:
    """Table of how far the finite bodies are from the half-space, by cause, if that is known."""
    known = [d for d in assessment.deviations if d.profile or d.total]
    if not known:
        return
    body = "thickness" if assessment.contact.layer else "finite body"
    causes = (
        ("true profile", [d.profile for d in known]),
        (body, [d.body for d in known]),
        ("both", [d.total for d in known]),
    )
    columns = [_percents(*cause) for cause in causes if any(cause[1])]
    title = f"difference from the {assessment.half_space.model}, in % of it, by cause"
    yield Fitted([_words(d.quantity for d in known), *columns], [title])
    yield Text()


def _thin_sample(contact: Contact, sample: ThinSample | None) -> Iterator[RenderableType]:
    """What of it the half-space and the series get wrong without adhesion, and which thickness is enough."""
    if sample and contact.thickness:
        yield indentations_table(sample)
        until = with_error(sample.hertz_until, digits=USUAL.digits)
        reach = (sample.hertz_until.value * contact.thickness) ** 2 / contact.units.radius
        yield Prose(
            "Chi: sqrt(R delta)/h of the indentation delta. Series: Dimitriadis et al. (2002), for chi up to 1. "
            f"Hertz's load is right to {100 * USUAL.wrong:g} % up to chi = {until}, here an indentation of "
            f"{engineering(reach, 'm')}."
        )
        yield Text()
        yield enough_table(sample)
        yield Text()


def indentations_table(sample: ThinSample) -> Fitted:
    """Contacts without adhesion, a line each."""
    rows = sample.indentations
    length, force = exponent_of(rows[-1].indentation), exponent_of(rows[-1].force.value)
    columns = [
        Column(f"indentation\n{PREFIXES[length]}m", [f"{row.indentation / 10.0**length:.4g}" for row in rows]),
        Column("chi", [f"{row.chi:.4g}" for row in rows]),
        Column(f"force\n{PREFIXES[force]}N", [with_error(row.force, 10.0**-force) for row in rows]),
        _percents("Hertz off", [row.half_space for row in rows]),
        _percents("series off", [row.series for row in rows]),
    ]
    return Fitted(columns, ["without adhesion on the thin sample, and how far Hertz's theory and the series are off"])


def enough_table(sample: ThinSample) -> Fitted:
    """Thicknesses from which on the half-space is right, a line each."""
    size = exponent_of(max((row.thickness.value for row in sample.enough if row.thickness), default=1e-6))
    thicknesses = [with_error(row.thickness, 10.0**-size) if row.thickness else row.note for row in sample.enough]
    columns = [
        _words((row.quantity for row in sample.enough), "in"),
        Column(f"thickness\n{PREFIXES[size]}m", thicknesses),
        _words((row.worst or "-" for row in sample.enough), "worst"),
    ]
    return Fitted(columns, [f"from which thickness on the half-space is right to {100 * USUAL.wrong:g} %"])


UNITS = {name: unit for name, (unit, _) in KINDS.items()} | {
    "equivalent_radius": "m",
    "contact_modulus": "Pa",
    "thickness_in_beta": "beta",
    "indentation": "m",
}


def record(assessment: Assessment) -> dict[str, object]:
    """Everything as plain data for JSON: a quantity is a value, an error and a unit in SI; see `UNITS` for others."""
    contact = assessment.contact
    found = {
        "input": {**asdict(contact), "law": record_of(contact.law)},
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
        "verdict": assessment.verdict,
        "seconds": assessment.seconds,
    }
    return common.record(units=UNITS) | {name: plain(part) for name, part in found.items()}
