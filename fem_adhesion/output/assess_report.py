"""The assessment of a contact for the terminal and as a record, in SI."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import asdict

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from fem_adhesion.output.record import versions
from fem_adhesion.studies.assess import Assessment
from fem_adhesion.studies.assess_predictions import QUANTITIES, WORDS, Prediction
from fem_adhesion.studies.quantities import Quantity

PREFIXES = {-18: "a", -15: "f", -12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
DIGITS, DIGITS_OF_RATIO = 6, 4  # significant, at most
LEGEND = (
    "Separation: of the undeformed surfaces where the jump takes off, negative if they overlap. Base: position of the "
    "cantilever's far end there, zero where the undeformed surfaces would be one spacing apart, negative away from the "
    "wall. Of the finite sphere the mid-plane is held. In brackets: error of the last digit, for closed theories that "
    "of the reading only. -: not in the model."
)


def show(assessment: Assessment) -> None:
    """Print everything, 150 columns wide where there is no terminal."""
    Console(width=None if sys.stdout.isatty() else 150).print(report(assessment))


def report(assessment: Assessment) -> RenderableType:
    """Everything for the terminal."""
    return Group(
        *(Text(line) for line in _head(assessment)),
        models_table(assessment),
        Text(LEGEND, style="dim"),
        Text(),
        deviations_table(assessment),
        Text(),
        *(Text(f"caution: {line}") for line in assessment.cautions),
        *(Text(line) for line in assessment.verdict),
    )


def _head(assessment: Assessment) -> Iterator[str]:
    contact, units = assessment.contact, assessment.contact.units
    yield f"regime: {assessment.regime}"
    yield "; ".join(f"{name} = {value:.4g}" for name, value in assessment.parameters.items())
    sizes = (("R", units.radius, "m"), ("E*", units.modulus, "Pa"), ("beta", units.length, "m"))
    yield "; ".join(f"{name} = {engineering(value, unit)}" for name, value, unit in sizes) + (
        f"; R/eps = {units.radius_ratio:.4g}; beta/R = {units.length / units.radius:.2g}"
    )
    fixed = math.isinf(contact.stiffness)
    yield "fixed grips" if fixed else f"cantilever: {engineering(contact.stiffness, 'N/m')}"
    yield ""


def models_table(assessment: Assessment) -> Table:
    """A line for each quantity, a column for each model."""
    table = Table(title="what each model says", title_justify="left")
    table.add_column("quantity", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for model in assessment.models:
        table.add_column(model.model, justify="right", no_wrap=True)
    for name in QUANTITIES:
        known = [model.values[name] for model in assessment.models if name in model.values]
        if known:
            exponent = exponent_of(known[0].value)
            cells = (_cell(model, name, exponent) for model in assessment.models)
            table.add_row(WORDS[name], PREFIXES[exponent] + known[0].unit, *cells)
    return table


def _cell(model: Prediction, name: str, exponent: int) -> str:
    quantity = model.values.get(name)
    return with_error(quantity, 10.0**-exponent) if quantity else "-"


def deviations_table(assessment: Assessment) -> Table:
    """How far the finite sphere is from the half-space, by cause."""
    table = Table(title="finite sphere less half-space, in % of the half-space", title_justify="left")
    table.add_column("quantity", no_wrap=True)
    for cause in ("true profile", "finite body", "both"):
        table.add_column(cause, justify="right", no_wrap=True)
    for d in assessment.deviations:
        if d.profile is None and d.total is None:
            continue
        cells = (with_error(q, 100, DIGITS_OF_RATIO) if q else "-" for q in (d.profile, d.body, d.total))
        table.add_row(WORDS[d.quantity], *cells)
    return table


def with_error(quantity: Quantity, scale: float = 1.0, digits: int = DIGITS) -> str:
    """Number with the error of its last digit in brackets, rounded up: 60.4440(1).

    Parameters
    ----------
    quantity : Quantity
        With its error.
    scale : float
        By which both are multiplied first.
    digits : int
        Significant ones, at most.
    """
    value, error = quantity.value * scale, quantity.error * scale
    most = digits - 1 - _decade(value)
    decimals = max(0, min(most, -_decade(error)) if error else most)
    uncertain = max(1, math.ceil(error * 10**decimals * (1 - 1e-9)))
    return f"{value:.{decimals}f}({uncertain})"


def engineering(value: float, unit: str, digits: int = 4) -> str:
    """Number with an engineering prefix: 57.1 GPa."""
    exponent = exponent_of(value)
    return f"{value / 10.0**exponent:.{digits}g} {PREFIXES[exponent]}{unit}"


def _decade(value: float) -> int:
    return math.floor(math.log10(abs(value))) if value else 0


def exponent_of(value: float) -> int:
    """Power of 1000 below a value, as an exponent of ten, among those that have a prefix."""
    return min(max(3 * (_decade(value) // 3), min(PREFIXES)), max(PREFIXES))


def record(assessment: Assessment) -> dict[str, object]:
    """Everything as plain data for JSON, without infinities: a quantity is a value, an error and a unit in SI."""
    contact = assessment.contact
    return {
        "input": {name: _finite(value) for name, value in asdict(contact).items()},
        "equivalent_radius": contact.units.radius,
        "contact_modulus": contact.units.modulus,
        "radius_ratio": contact.units.radius_ratio,
        "parameters": dict(assessment.parameters),
        "regime": assessment.regime,
        "models": [
            {"model": model.model, "values": {name: asdict(q) for name, q in model.values.items()}}
            for model in assessment.models
        ],
        "deviations": [asdict(deviation) for deviation in assessment.deviations],
        "cautions": list(assessment.cautions),
        "verdict": list(assessment.verdict),
        "seconds": assessment.seconds,
        "versions": versions(),
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
