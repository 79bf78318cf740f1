"""The assessment of a contact for the terminal and as a record, in SI."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.assess.predictions import POSITIONS, QUANTITIES, RADII, WORDS, Prediction, Quantity
from fem_adhesion.assess.study import Assessment
from fem_adhesion.assess.thin_sample import WRONG, ThinSample
from fem_adhesion.common import record as common
from fem_adhesion.common.contact import Contact, edge_told
from fem_adhesion.common.facts import plain
from fem_adhesion.common.numbers import KINDS, PREFIXES, engineering, exponent_of, with_error
from fem_adhesion.common.terminal import Column, Fitted, Flow, prose
from fem_adhesion.registry import record_of, words_of
from halfspace.laws import LENNARD_JONES

STANDS = {"bonded": "bonded to its base", "sliding": "sliding on its base"}
DIGITS_OF_RATIO = 4  # significant, at most
RANKS = {
    "both": 0,
    "true profile": 1,
    "finite body": 1,
    "thickness": 1,
}  # by which columns of the differences are left out


def report(assessment: Assessment) -> RenderableType:
    """Everything for the terminal."""
    return Group(
        *_head(assessment),
        models_table(assessment),
        *map(prose, _legend(assessment)),
        Text(),
        *_deviations(assessment),
        *_thin_sample(assessment.contact, assessment.sample),
        *(prose(f"caution: {line}") for line in assessment.cautions),
        *map(prose, assessment.verdict),
    )


def _head(assessment: Assessment) -> Iterator[RenderableType]:
    contact, units = assessment.contact, assessment.contact.units
    yield prose(f"regime: {assessment.regime}")
    yield Flow([f"{name} = {value:.4g}" for name, value in assessment.parameters.items()])
    sizes = (("R", units.radius, "m"), ("E*", units.modulus, "Pa"), ("beta", units.length, "m"))
    ratios = (f"R/eps = {units.radius_ratio:.4g}", f"beta/R = {units.length / units.radius:.2g}")
    yield Flow([*(f"{name} = {engineering(value, unit)}" for name, value, unit in sizes), *ratios])
    law = (("spacing eps", units.spacing, "m"), ("work of adhesion", units.work_of_adhesion, "J/m^2"))
    implied = f"with them the Hamaker constant 16 pi dgamma eps^2 = {engineering(units.hamaker, 'J')}"
    if contact.law != LENNARD_JONES:
        implied = f"law {words_of(contact.law)}"
    yield Flow([*(f"{name} = {engineering(value, unit)}" for name, value, unit in law), implied])
    fixed = math.isinf(contact.stiffness)
    yield Text("fixed grips" if fixed else f"cantilever: {engineering(contact.stiffness, 'N/m')}")
    if contact.thickness and contact.layer:
        h = f"{engineering(contact.thickness, 'm')} = {contact.layer.thickness:.4g} beta"
        yield Flow([f"thin sample: h = {h}", STANDS[contact.foundation]], ", ")
    yield Text()


def _legend(assessment: Assessment) -> Iterator[str]:
    """How to read the table of models; only what stands in it."""
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
    edge = edge_told(assessment.contact.law)
    meanings = {edge: True, "the edge of the theory's own contact, without the ring of attraction around it": False}
    said = {
        meaning: [model.model for model in named if model.is_computed == computed]
        for meaning, computed in meanings.items()
    }
    return (
        "Contact radius: " + "; ".join(f"of {', '.join(names)}, {what}" for what, names in said.items() if names) + "."
    )


def models_table(assessment: Assessment) -> Fitted:
    """A line for each quantity, a column for each model; the last ones are left out first."""
    rows = [name for name in QUANTITIES if any(name in model.values for model in assessment.models)]
    scales = {name: _scale([model.values.get(name) for model in assessment.models]) for name in rows}
    # What was computed first, the best of it last to be left out; theories by their distance from it.
    kept = [model.model for model in (assessment.half_space, assessment.finite, assessment.profile) if model]
    order = [*kept, *(d.model for d in assessment.distances if d.model not in kept)]
    columns = [
        Column(model.model, [_cell(model, name, scales[name][0]) for name in rows], order.index(model.model))
        for model in assessment.models
    ]
    words = Column("quantity", [WORDS[name] for name in rows], text=True, wraps=True)
    units = Column("unit", [scales[name][1] for name in rows], text=True)
    return Fitted([words, units, *columns], ["what each model says"])


def _scale(quantities: Sequence[Quantity | None]) -> tuple[int, str]:
    """Exponent of ten and unit that suit the largest of them."""
    largest = max((q for q in quantities if q), key=lambda q: abs(q.value))
    exponent = exponent_of(largest.value)
    return exponent, PREFIXES[exponent] + largest.unit


def _cell(model: Prediction, name: str, exponent: int) -> str:
    quantity = model.values.get(name)
    return with_error(quantity, 10.0**-exponent) if quantity else "-"


def _deviations(assessment: Assessment) -> Iterator[RenderableType]:
    """Table of how far the finite bodies are from the half-space, by cause, if that is known."""
    known = [d for d in assessment.deviations if d.profile or d.total]
    if not known:
        return
    causes = {
        "true profile": [d.profile for d in known],
        "thickness" if assessment.contact.layer else "finite body": [d.body for d in known],
        "both": [d.total for d in known],
    }
    columns = [
        Column(f"{name}\n%", [with_error(q, 100, DIGITS_OF_RATIO) if q else "-" for q in found], RANKS[name])
        for name, found in causes.items()
        if any(found)
    ]
    words = Column("quantity", [WORDS[d.quantity] for d in known], text=True, wraps=True)
    yield Fitted([words, *columns], [f"difference from the {assessment.half_space.model}, in % of it, by cause"])
    yield Text()


def _thin_sample(contact: Contact, sample: ThinSample | None) -> Iterator[RenderableType]:
    """What of it the half-space and the series get wrong without adhesion, and which thickness is enough."""
    if sample and contact.thickness:
        yield indentations_table(sample)
        until = with_error(sample.hertz_until, digits=DIGITS_OF_RATIO)
        reach = (sample.hertz_until.value * contact.thickness) ** 2 / contact.units.radius
        yield prose(
            "Chi: sqrt(R delta)/h of the indentation delta. Series: Dimitriadis et al. (2002), for chi up to 1. "
            f"Hertz's load is right to {100 * WRONG:g} % up to chi = {until}, here an indentation of "
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
        Column("chi", [f"{row.chi:.4g}" for row in rows], 1),
        Column(f"force\n{PREFIXES[force]}N", [with_error(row.force, 10.0**-force) for row in rows]),
        Column("Hertz off\n%", [with_error(row.half_space, 100, DIGITS_OF_RATIO) for row in rows]),
        Column("series off\n%", [with_error(row.series, 100, DIGITS_OF_RATIO) for row in rows]),
    ]
    return Fitted(columns, ["without adhesion on the thin sample, and how far Hertz's theory and the series are off"])


def enough_table(sample: ThinSample) -> Fitted:
    """Thicknesses from which on the half-space is right, a line each."""
    found = [row.thickness.value for row in sample.enough if row.thickness]
    size = exponent_of(max(found, default=1e-6))
    thicknesses = [with_error(row.thickness, 10.0**-size) if row.thickness else row.note for row in sample.enough]
    columns = [
        Column("in", [WORDS.get(row.quantity, row.quantity) for row in sample.enough], text=True, wraps=True),
        Column(f"thickness\n{PREFIXES[size]}m", thicknesses),
        Column("worst", [WORDS.get(row.worst, "-") for row in sample.enough], 1, text=True, wraps=True),
    ]
    return Fitted(columns, [f"from which thickness on the half-space is right to {100 * WRONG:g} %"])


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
        "models": [{"model": m.model, "values": m.values, "missed": m.missed} for m in assessment.models],
        "thin_sample": assessment.sample,
        "deviations": assessment.deviations,
        "distances": assessment.distances,
        "definitions": {"contact_radius": contact_radius(assessment)},
        "cautions": assessment.cautions,
        "verdict": assessment.verdict,
        "seconds": assessment.seconds,
    }
    return common.record(units=UNITS) | {name: plain(part) for name, part in found.items()}
