"""Spread of a contact's numbers by that of its inputs: to the first order, and by draws of the inputs.

The first order, the sum of squares of (df/dx) times the standard deviation of x, tells which input dominates. Draws
tell whether it may be trusted: where a curve begins to fold, at the Tabor parameter 0.6972146 under fixed grips, jumps
go with the root of the distance to there, and their first order is nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, ndtri

from fem_adhesion.assess.predictions import QUANTITIES, Quantity
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.common.contact import Contact, Inputs
from halfspace.values import Array

ONE_SIGMA = tuple(map(float, ndtr([-1.0, 0.0, 1.0])))  # 15.9, 50 and 84.1 %: value and spread of a normal distribution
MOST = dict.fromkeys(("poisson", "counter_poisson"), 0.4999)  # largest value of an input, where it has one
Model = Callable[[Contact], Mapping[str, Quantity]]


@dataclass(frozen=True)
class Spread(Quantity):
    """A quantity, nan if the contact of the inputs' values lacks it, and its spread.

    Attributes
    ----------
    deviation : float
        Standard deviation to the first order, in the quantity's unit; nan where an end of a difference lacks it.
    shares : mapping of str to float
        Parts of its square by input, the largest first.
    quantiles : tuple of float
        At `ONE_SIGMA` of the draws that have the quantity; empty without draws.
    present : float
        Part of the draws that have it; nan without draws.
    linear : bool
        Whether the first order holds: no quantile is off by more than `USUAL.straight` of the deviation, and all draws
        have the quantity.
    """

    deviation: float
    shares: Mapping[str, float]
    quantiles: tuple[float, ...]
    present: float
    linear: bool


@dataclass(frozen=True)
class Spreads:
    """Spreads of the quantities of a model by the standard deviations of inputs in SI; `drawn` says how many draws."""

    model: str
    inputs: Mapping[str, float]
    quantities: Mapping[str, Spread]
    drawn: int


def spreads(
    name: str, inputs: Inputs, model: Model, drawn: Callable[[Sequence[Contact]], Sequence[Mapping[str, Quantity]]]
) -> Spreads:
    """Spreads of the numbers of a model of that name.

    Parameters
    ----------
    name : str
        Name of the model.
    inputs : Inputs
        Quantities with their standard deviations: independent and normal, cut where a contact cannot be.
    model : callable
        Numbers of a contact, for the first order: two contacts for each input.
    drawn : callable
        The same of many contacts by a quick model, or nothing where there is none.
    """
    values, lacking = model(inputs.contact()), Quantity(math.nan, math.nan, "")
    slopes = {x: _changes(inputs, x, model) for x in inputs.deviations}
    found = drawn([inputs.contact(**draw) for draw in _draws(inputs)])
    quantities = {}
    for quantity in QUANTITIES:
        drawn_ones = [numbers[quantity] for numbers in found if quantity in numbers]
        known = values.get(quantity) or (replace(lacking, unit=drawn_ones[0].unit) if drawn_ones else None)
        if known:
            had = [number.value for number in drawn_ones]
            squares = {x: changed.get(quantity, math.nan) ** 2 for x, changed in slopes.items()}
            deviation = math.sqrt(sum(squares.values()))
            shares = {x: squares[x] / (deviation**2 or 1.0) for x in sorted(squares, key=lambda x: -squares[x])}
            quantiles = np.quantile(had, ONE_SIGMA) if had else np.empty(0)
            present = len(had) / len(found) if found else math.nan
            off = float(np.max(np.abs(quantiles - known.value - deviation * np.array([-1, 0, 1])))) if had else 0.0
            linear = not present < 1 and off <= USUAL.straight * deviation
            quantities[quantity] = Spread(
                **vars(known),
                deviation=deviation,
                shares=shares,
                quantiles=tuple(quantiles.tolist()),
                present=present,
                linear=linear,
            )
    return Spreads(name, inputs.deviations, quantities, len(found))


def _changes(inputs: Inputs, name: str, model: Model) -> dict[str, float]:
    """Changes of the numbers by a standard deviation of an input, to the first order by a central difference."""
    value, deviation = inputs.quantities[name]
    step = max(USUAL.step * deviation, min(USUAL.least_step * value, deviation))
    low, high = (min(max(value + side * step, 0.0), MOST.get(name, math.inf)) for side in (-1, 1))
    before, after = (model(inputs.contact(**{name: x})) for x in (low, high))
    return {q: (after[q].value - before[q].value) / (high - low) * deviation for q in before.keys() & after.keys()}


def _draws(inputs: Inputs) -> list[dict[str, float]]:
    """Draws of the inputs: each takes every part of its distribution once, in an order of its own (Latin hypercube)."""
    order, drawn = np.random.default_rng(0), dict[str, Array]()
    for name, deviation in inputs.deviations.items():
        value = inputs.quantities[name].value
        low, high = ndtr((0.0 - value) / deviation), ndtr((MOST.get(name, math.inf) - value) / deviation)
        parts = (order.permutation(USUAL.draws) + 0.5) / USUAL.draws
        drawn[name] = value + deviation * ndtri(low + (high - low) * parts)
    return [dict(zip(drawn, map(float, row), strict=True)) for row in zip(*drawn.values(), strict=True)]
