"""A thin sample: what of it the half-space and the published series get wrong, and which thickness is enough for it.

Without adhesion the truth is Hertz's theory on the layer, see `halfspace.theories.layered`; with it a computed curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial

from fem_adhesion.assess.predictions import QUANTITIES, Prediction, Quantity, relative
from fem_adhesion.common.contact import Contact
from halfspace.elastic.layers import Layer, Layers
from halfspace.errors import NotConverged
from halfspace.limits import LAYER_THICKNESS
from halfspace.roots import root
from halfspace.theories.closed_forms import hertz_load
from halfspace.theories.layered import OnLayers, hertz_ratio, thin_sample_series
from halfspace.values import Estimate

WRONG = 0.01  # part of the value by which the half-space may be off to be right


@dataclass(frozen=True)
class Search:
    """Indentations shown, and the search for a thickness."""

    deepest: float = 0.2  # indentation, as a part of the thickness: small strain
    widest: float = 0.05  # indentation, as a part of the radius: small strain
    parts: tuple[float, ...] = (0.05, 0.1, 0.2, 0.5, 1.0)  # of the deepest indentation
    thick: float = 30.0  # beta, where the search begins
    most: int = 12  # secants
    flattest: float = -0.2  # slope of a secant
    least: float = 1e-12  # difference that counts as none
    narrow: float = 1e-8  # error of the contact radius, in thicknesses
    root: float = 1e-3  # error of the logarithm of the thickness


SEARCH = Search()


@dataclass(frozen=True)
class Indentation:
    """A contact without adhesion: approach delta in m, chi = (R delta)^(1/2)/h, and the force on the sample.

    `half_space` and `series` say how far Hertz's theory and the series of Dimitriadis et al. are from that, as a part.
    """

    indentation: float
    chi: float
    force: Quantity
    half_space: Quantity
    series: Quantity


@dataclass(frozen=True)
class Enough:
    """From which thickness on the half-space is right to `WRONG`, in one of `QUANTITIES` or in "every quantity".

    The worst is the quantity that is off by so much there; a note says why there is no thickness.
    """

    quantity: str
    thickness: Quantity | None = None
    worst: str = ""
    note: str = ""


@dataclass(frozen=True)
class ThinSample:
    """What assessing a thin sample adds: contacts without adhesion, ascending, and thicknesses that are enough.

    `hertz_until` is the largest (R delta)^(1/2)/h at which Hertz's load on a half-space is right to `WRONG`.
    """

    indentations: tuple[Indentation, ...]
    hertz_until: Quantity
    enough: tuple[Enough, ...]


def indentations(contact: Contact, thickness: float) -> Iterator[Indentation]:
    """Contacts without adhesion on a sample of a thickness in m."""
    R, E = contact.units.radius, contact.units.modulus
    for part in SEARCH.parts:
        delta = part * min(SEARCH.deepest * thickness, SEARCH.widest * R)
        chi = math.sqrt(R * delta) / thickness
        ratio = hertz_ratio(_of_unit_thickness(contact), chi**2)
        series = thin_sample_series(chi, contact.poisson, contact.foundation)
        hertz = 4 / 3 * E * math.sqrt(R) * delta**1.5
        yield Indentation(delta, chi, Quantity.of(ratio, hertz, "N"), _off(1.0, ratio), _off(series, ratio))


def _off(value: float, true: Estimate) -> Quantity:
    """Relative difference of a value from the true one."""
    return Quantity.ratio(Estimate(value, 0.0) / true - 1)


def hertz_until(contact: Contact) -> Quantity:
    """Largest (R delta)^(1/2)/h at which Hertz's load on a half-space is right to `WRONG`."""
    theory = OnLayers(_of_unit_thickness(contact))

    def beyond(a: float) -> float:
        state = theory.hertz(a)
        return (1 - float(hertz_load(math.sqrt(state.approach))) / state.load) / WRONG - 1

    a = root(beyond, 1e-4, 1.0, "where Hertz's load is off; take a thick sample", xtol=SEARCH.narrow)
    chi = math.sqrt(theory.hertz(a).approach)
    return Quantity.ratio(Estimate(chi, 2 * SEARCH.narrow))


def _of_unit_thickness(contact: Contact) -> Layers:
    return Layer(1.0, contact.poisson, contact.foundation)


def enough(contact: Contact, half_space: Prediction, on_layer: Callable[[Layers], Prediction]) -> Iterator[Enough]:
    """Thicknesses from which on the half-space is right, in the pull-off force and in all quantities.

    Given are what a paraboloid does on a half-space, and what tells the same of it on a layer.
    """

    @cache
    def thin(thickness: float) -> Prediction:
        return on_layer(Layer(thickness, contact.poisson, contact.foundation))

    def parts(log_thickness: float, names: tuple[str, ...]) -> dict[str, Estimate]:
        model = thin(math.exp(log_thickness))
        return {name: _part(model, half_space, name, contact.spacing) for name in names}

    def off(log_thickness: float, names: tuple[str, ...]) -> Estimate:
        return max(parts(log_thickness, names).values(), key=lambda part: part.value)

    # A layer bends as a whole by W/h to the first order, which moves approaches; the load follows from its curvature.
    for name, names, power in (("pull_off_force", ("pull_off_force",), 3.0), ("every quantity", QUANTITIES, 1.0)):
        try:
            found = _outermost(partial(off, names=names), power)
        except NotConverged:
            found = "not solved"
        if isinstance(found, str):
            yield Enough(name, note=found)
        else:
            largest = parts(math.log(found.value), names)
            worst = max(largest, key=lambda quantity: largest[quantity].value)
            yield Enough(name, Quantity.of(found, *contact.units.si("radius")), worst)


def _part(model: Prediction, half_space: Prediction, name: str, spacing: float) -> Estimate:
    """Difference of the half-space from a model as a part of the half-space's value; none of what one of them lacks."""
    found = relative(model, half_space, name, spacing)
    return abs(found) if found else Estimate(0.0, 0.0)


def _outermost(off: Callable[[float], Estimate], power: float) -> Estimate | str:
    """Thickness in beta beyond which a difference is below `WRONG`, by secants in logarithms from the thick side.

    The difference, of the logarithm of a thickness, dies out with a power of it. Where it is below for all layers, or
    above, the answer is in words; NotConverged if no thickness is found.
    """

    def level(x: float) -> float:
        return math.log(max(off(x).value, SEARCH.least) / WRONG)

    (least, most), at, slope = map(math.log, LAYER_THICKNESS), math.log(SEARCH.thick), -power
    for _ in range(SEARCH.most):
        then = min(max(at - level(at) / slope, least), most)
        if abs(then - at) <= SEARCH.root and least < then < most:
            size = math.exp(then)
            return Estimate(size, size * (off(at).error / WRONG / abs(slope) + SEARCH.root))
        if then == at:
            return f"{'below' if at == least else 'above'} {math.exp(at):g} beta"
        slope = min((level(then) - level(at)) / (then - at), SEARCH.flattest)
        at = then
    raise NotConverged(f"no thickness within {SEARCH.most} secants, limit: one; take a thick sample")
