"""A thin sample: what of it the half-space and the published series get wrong, and which thickness is enough for it.

Without adhesion the truth is Hertz's theory on the layer, see `halfspace.theories.layered`; with it a computed curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial

from fem_adhesion.assess.predictions import QUANTITIES, Prediction, Quantity, relative
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.common.contact import Contact
from halfspace.elastic.layers import Layer, Layers
from halfspace.errors import NotConverged, tried
from halfspace.limits import LAYER_THICKNESS
from halfspace.roots import root
from halfspace.theories.closed_forms import hertz_load
from halfspace.theories.layered import OnLayers, hertz_ratio, thin_sample_series
from halfspace.values import Estimate


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
    """From which thickness on the half-space is right to `USUAL.wrong`, in one of `QUANTITIES` or in "every quantity".

    The worst is the quantity that is off by so much there; a note says why there is no thickness.
    """

    quantity: str
    thickness: Quantity | None = None
    worst: str = ""
    note: str = ""


@dataclass(frozen=True)
class ThinSample:
    """What assessing a thin sample adds: contacts without adhesion, ascending, and thicknesses that are enough.

    `hertz_until` is the largest (R delta)^(1/2)/h at which Hertz's load on a half-space is right to `USUAL.wrong`.
    """

    indentations: tuple[Indentation, ...]
    hertz_until: Quantity
    enough: tuple[Enough, ...]


def indentations(contact: Contact, thickness: float) -> Iterator[Indentation]:
    """Contacts without adhesion on a sample of a thickness in m."""
    R, E = contact.units.radius, contact.units.modulus
    for part in USUAL.parts:
        delta = part * min(USUAL.deepest * thickness, USUAL.widest * R)
        chi = math.sqrt(R * delta) / thickness
        ratio = hertz_ratio(Layer(1.0, contact.poisson, contact.foundation), chi**2)
        series = thin_sample_series(chi, contact.poisson, contact.foundation)
        hertz = 4 / 3 * E * math.sqrt(R) * delta**1.5
        off = (Quantity.ratio(Estimate(value, 0.0) / ratio - 1) for value in (1.0, series))
        yield Indentation(delta, chi, Quantity.of(ratio, hertz, "N"), *off)


def hertz_until(contact: Contact) -> Quantity:
    """Largest (R delta)^(1/2)/h at which Hertz's load on a half-space is right to `USUAL.wrong`."""
    theory = OnLayers(Layer(1.0, contact.poisson, contact.foundation))

    def beyond(a: float) -> float:
        state = theory.hertz(a)
        return (1 - float(hertz_load(math.sqrt(state.approach))) / state.load) / USUAL.wrong - 1

    a = root(beyond, 1e-4, 1.0, "where Hertz's load is off; take a thick sample", xtol=USUAL.narrow)
    chi = math.sqrt(theory.hertz(a).approach)
    return Quantity.ratio(Estimate(chi, 2 * USUAL.narrow))


def enough(contact: Contact, half_space: Prediction, on_layer: Callable[[Layers], Prediction]) -> Iterator[Enough]:
    """Thicknesses from which on the half-space is right, in the pull-off force and in all quantities.

    Given are what a paraboloid does on a half-space, and what tells the same of it on a layer.
    """

    @cache
    def thin(thickness: float) -> Prediction:
        return on_layer(Layer(thickness, contact.poisson, contact.foundation))

    def parts(log_thickness: float, names: tuple[str, ...]) -> dict[str, Estimate]:
        """Differences from a model on a layer as parts of the half-space's values; none of what one of them lacks."""
        model = thin(math.exp(log_thickness))
        found = {name: relative(model, half_space, name, contact.spacing) for name in names}
        return {name: abs(off) if off else Estimate(0.0, 0.0) for name, off in found.items()}

    def off(log_thickness: float, names: tuple[str, ...]) -> Estimate:
        return max(parts(log_thickness, names).values(), key=lambda part: part.value)

    # A layer bends as a whole by W/h to the first order, which moves approaches; the load follows from its curvature.
    for name, names, power in (("pull_off_force", ("pull_off_force",), 3.0), ("every quantity", QUANTITIES, 1.0)):
        found = tried(_outermost, partial(off, names=names), power) or "not solved"
        if isinstance(found, str):
            yield Enough(name, note=found)
        else:
            worst, _ = max(parts(math.log(found.value), names).items(), key=lambda part: part[1].value)
            yield Enough(name, Quantity.of(found, *contact.units.si("radius")), worst)


def _outermost(off: Callable[[float], Estimate], power: float) -> Estimate | str:
    """Thickness in beta beyond which a difference is below `USUAL.wrong`, by secants in logarithms from the thick side.

    The difference, of the logarithm of a thickness, dies out with a power of it. Where it is below for all layers, or
    above, the answer is in words; NotConverged if no thickness is found.
    """

    def level(x: float) -> float:
        return math.log(max(off(x).value, USUAL.least) / USUAL.wrong)

    (least, most), at, slope = map(math.log, LAYER_THICKNESS), math.log(USUAL.thick), -power
    for _ in range(USUAL.most):
        then = min(max(at - level(at) / slope, least), most)
        if abs(then - at) <= USUAL.root and least < then < most:
            size = math.exp(then)
            return Estimate(size, size * (off(at).error / USUAL.wrong / abs(slope) + USUAL.root))
        if then == at:
            return f"{'below' if at == least else 'above'} {math.exp(at):g} beta"
        slope = min((level(then) - level(at)) / (then - at), USUAL.flattest)
        at = then
    raise NotConverged(f"no thickness within {USUAL.most} secants, limit: one; take a thick sample")
