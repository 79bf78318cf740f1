"""What a model says of a contact, in SI: read off a computed curve or off a closed theory."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from fem_adhesion.assess import theories
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.theories import estimated, loop
from fem_adhesion.common.known import known
from halfspace import atlas
from halfspace.elastic.layers import Layers
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import Event, approach_scale, tolerance_told
from halfspace.scaling import Units
from halfspace.theories import curves
from halfspace.theories.closed_forms import ContactState
from halfspace.theories.exact_sphere import JKRSphere, RigidSphere
from halfspace.values import Array, Estimate

MEASURES: Mapping[str, tuple[str, float]] = {
    "pull_off_force": ("pull-off force", 3e-5),
    "pull_off_radius": ("contact radius at pull-off", 1e-4),
    "zero_load_radius": ("contact radius at zero load", 1e-4),
    "jump_on_separation": ("separation at jump-on", 1e-2),
    "jump_on_base": ("base position at jump-on", 1e-2),
    "jump_off_separation": ("separation at jump-off", 3e-4),
    "jump_off_base": ("base position at jump-off", 3e-4),
    "energy_lost": ("energy lost per cycle", 5e-4),
}
"""Quantities in words, and the relative distance there of JKR's theory with the range of the attraction from the
half-space at the Tabor parameter 300, the last that is computed; it falls beyond, the contact's as mu^-1.7."""

QUANTITIES = tuple(MEASURES)
WORDS = {name: words for name, (words, _) in MEASURES.items()}
ON_LAYER = "thin sample"
ATTRACTING = "JKR with attraction"
RADII = ("pull_off_radius", "zero_load_radius")
POSITIONS = (("jump_on_separation", "jump_off_separation"), ("jump_on_base", "jump_off_base"))  # along two axes
JUMPS = (*POSITIONS[0], *POSITIONS[1])


@dataclass(frozen=True)
class Quantity(Estimate):
    """A number in SI with the estimated bound of its error, in the same unit; `unit` is "1" for a ratio."""

    unit: str

    @classmethod
    def of(cls, estimate: Estimate, size: float, unit: str) -> Quantity:
        """Dimensionless estimate times the SI size of its unit."""
        whole = estimate * size
        return cls(whole.value, whole.error, unit)

    @classmethod
    def ratio(cls, estimate: Estimate) -> Quantity:
        """What has no unit."""
        return cls.of(estimate, 1.0, "1")


@dataclass(frozen=True)
class Prediction:
    """What one model says: those of `QUANTITIES` that it has, and the curve that they are read off, if one.

    ``pull_off_force`` is the largest tension in N; ``pull_off_radius`` and ``zero_load_radius`` are contact radii in m
    there and under no load, of a computed state those of the largest traction. Where the cantilever's jumps take off,
    ``jump_on_separation`` and ``jump_off_separation`` are the distance in m of the undeformed surfaces, negative if
    they overlap; ``jump_on_base`` and ``jump_off_base`` the position in m of its base, positive towards the wall, zero
    where the undeformed surfaces would be one spacing apart with the cantilever straight. ``energy_lost`` in J is that
    of a cycle of approach and separation. By state of a computed curve or of its jumps, `missed` are the numbers that
    are less accurate than was asked; `jumps` has both ends, take-off and landing, of those on and off, dimensionless.
    The source says whether a solver computed them for this contact, or they are read
    from the atlas, or off a closed theory, which has a contact radius of its own.
    """

    model: str
    values: Mapping[str, Quantity]
    curve: EquilibriumPath | Array | None = field(default=None, repr=False, compare=False)
    missed: Mapping[str, Sequence[str]] = field(default_factory=dict)
    source: Literal["solver", "atlas", "theory"] = "theory"
    jumps: Sequence[tuple[Event, Event] | tuple[ContactState, ContactState]] = ()

    @property
    def warning(self) -> str:
        """Which numbers of a computed curve are less accurate than was asked, or nothing."""
        if not isinstance(self.curve, EquilibriumPath) or not self.missed:
            return ""
        return f"{self.model}: {tolerance_told(self.curve.rtol, self.missed)}"


def computed(model: str, path: EquilibriumPath, stiffness: float, units: Units) -> Prediction:
    """Read a computed curve, of the half-space or of finite elements, on a cantilever of stiffness in R dgamma/eps.

    NotConverged if a jump or a landing cannot be solved for.
    """
    found, round_trip = _at_rest(path.events), cycle(path, stiffness)
    if round_trip:
        for name, at in (("jump_on", round_trip.jump_on.take_off), ("jump_off", round_trip.jump_off.take_off)):
            found |= _take_off(name, at.estimate("approach"), at.estimate("load"), stiffness)
        found["energy_lost"] = round_trip.energy_lost
    missed = path.missed | (round_trip.missed if round_trip else {})
    jumps = [round_trip.jump_on.ends, round_trip.jump_off.ends] if round_trip else []
    return Prediction(model, _in_si(found, units), path, missed, "solver", jumps)


def on_atlas(model: str, tabor: float, stiffness: float, units: Units) -> Prediction:
    """Read the half-space from the atlas, 0.01 <= tabor <= 300, and its curve as samples."""
    (values,), curve = read_atlas([tabor], [stiffness], [units]), theories.half_space(tabor, stiffness)
    jumps = loop(curve, stiffness)
    return Prediction(model, values, curve, source="atlas", jumps=[jumps.jump_on, jumps.jump_off] if jumps else [])


def read_atlas(
    tabors: Sequence[float], stiffnesses: Sequence[float], units: Sequence[Units], number: int = USUAL.sampled
) -> Iterator[dict[str, Quantity]]:
    """Numbers of the half-space by the atlas: its series, and for a cantilever so many samples of its curve.

    The errors with a cantilever are those of the samples, see `closed`, and of the atlas' curve, times `USUAL.slack`: a
    turn of the base moves by what the curve's derivatives err. Beyond the curve the second order of the bulge counts.
    """
    for (events, _, lost), tabor, stiffness, unit in zip(known(tabors), tabors, stiffnesses, units, strict=True):
        values, found = dict[str, Quantity](), _at_rest(events)
        if math.isinf(stiffness):
            for name in ("jump_on", "jump_off"):
                if at := events.get(name):
                    found |= _take_off(name, at.estimate("approach"), at.estimate("load"), stiffness)
            found |= {"energy_lost": lost} if "jump_on" in events else {}
        else:
            read = closed("atlas", theories.half_space(tabor, stiffness, number), stiffness, unit).values
            curve = atlas.curve(tabor)
            slack = Estimate(0.0, USUAL.slack * float(curve.errors[:2].max(axis=1).sum()))
            errors = {name: slack for name in read if name not in found}
            end, bulge = theories.far_end(curve)
            on = read["jump_on_separation"].value / unit.approach if "jump_on_separation" in read else 0.0
            if on > end:  # by the first order of the bulge
                errors["jump_on_separation"] += Estimate(0.0, bulge**2 * on)
            more = _in_si(errors, unit)
            values = {name: Quantity.of(read[name] + error, 1.0, error.unit) for name, error in more.items()}
        yield values | _in_si(found, unit)


def _at_rest(events: Mapping[str, Event]) -> dict[str, Estimate]:
    """Numbers that no cantilever changes."""
    return {
        "pull_off_force": events["pull_off"].estimate("load") * -1,
        "pull_off_radius": events["pull_off"].estimate("contact_radius"),
        "zero_load_radius": events["zero_load"].estimate("contact_radius"),
    }


def closed(model: str, curve: Array, stiffness: float, units: Units) -> Prediction:
    """Read the samples of a closed theory, on a cantilever of stiffness in R dgamma/eps.

    The errors are those of the reading, not the theory's distance from the truth. At a turning point of the base a
    displaced sample errs in the approach alone.
    """
    found = {
        "pull_off_force": estimated(curve, lambda c: -theories.pull_off(c).load),
        "pull_off_radius": estimated(curve, lambda c: theories.pull_off(c).contact_radius),
        "zero_load_radius": estimated(curve, lambda c: theories.zero_load(c).contact_radius),
    }
    jumps = loop(curve, stiffness)
    if jumps and loop(curve[:, ::2], stiffness):  # not a ripple of the samples
        for name, (at, _) in (("jump_on", jumps.jump_on), ("jump_off", jumps.jump_off)):
            found |= _take_off(name, Estimate(at.approach, jumps.spacing), Estimate(at.load, 0.0), stiffness)
        found["energy_lost"] = estimated(curve, lambda c: getattr(loop(c, stiffness), "energy_lost", math.nan))
    return Prediction(model, _in_si(found, units), curve, jumps=[jumps.jump_on, jumps.jump_off] if jumps else [])


def _take_off(name: str, approach: Estimate, load: Estimate, stiffness: float) -> dict[str, Estimate]:
    """Where a jump takes off, along both axes, in eps."""
    return {f"{name}_separation": Estimate(1.0, 0.0) - approach, f"{name}_base": approach + load / stiffness}


def _in_si(found: Mapping[str, Estimate], units: Units) -> dict[str, Quantity]:
    """Numbers in SI, without what the model does not have."""
    known = {name: number for name, number in found.items() if math.isfinite(number.value)}
    return {name: Quantity.of(number, *units.si(MEASURED[name.split("_")[-1]])) for name, number in known.items()}


MEASURED = {"force": "load", "radius": "radius", "separation": "approach", "base": "approach", "lost": "energy"}


def large_tabor(tabor: float, stiffness: float, units: Units, layer: Layers | None = None) -> Prediction:
    """JKR's theory with the reach of the attraction, its errors being the distance from the truth: tabor >= 300.

    On a thin sample the distance grows where the spike at the edge is no longer narrow beside the thickness, and that
    of the jump on, and of the energy that it decides on, where the bulge is not.
    """
    how, h = theories.sampling(tabor, stiffness), layer.thickness if layer else math.inf
    curve = theories.jkr_on(layer, tabor, how) if layer else curves.jkr_with_reach(tabor, how)
    read = closed(ON_LAYER if layer else ATTRACTING, curve, stiffness, units)
    part = (USUAL.computed / tabor) ** USUAL.decay
    parts = {
        name: 1 + USUAL.bulge / h if "jump_on" in name else part * (1 + (USUAL.thin / h) ** 3) for name in QUANTITIES
    }
    parts["energy_lost"] = part * (1 + (USUAL.bulge / h) ** 3)
    values = {
        name: Quantity.of(q * Estimate(1.0, MEASURES[name][1] * parts[name]), 1.0, q.unit)
        for name, q in read.values.items()
    }
    return replace(read, values=values)


def exact_sphere(units: Units) -> Prediction:
    """JKR's theory on the exact profile of a soft sphere, in contact only, or the pull-off force of a rigid one.

    InputError where a contact spans R, or R is far smaller than the spacing.
    """
    if units.tabor > USUAL.computed:
        model, theory = "JKR on the sphere", JKRSphere(units.tabor, units.radius_ratio)
        tension = theory.pull_off()
        numbers = {"pull_off_force": -tension.load, "pull_off_radius": tension.contact_radius}
        numbers["zero_load_radius"] = theory.zero_load().contact_radius
    else:
        model, numbers = "rigid sphere", {"pull_off_force": -RigidSphere(units.radius_ratio).pull_off().load}
    found = {name: Estimate(value, 1e-12 * abs(value)) for name, value in numbers.items()}
    return Prediction(model, _in_si(found, units))


def relative(ours: Prediction, reference: Prediction, name: str, spacing: float) -> Quantity | None:
    """Difference of a quantity from a reference's, with both errors in it, or None if either has none.

    It is a part of the reference's value; of a position, which has no natural zero, of the spacing in m and the
    distance between the reference's positions of both jumps, see `halfspace.equilibrium.events.approach_scale`.
    """
    a, b = ours.values.get(name), reference.values.get(name)
    if a is None or b is None:
        return None
    axis = {n for names in POSITIONS if name in names for n in names}
    alike = [q.value for n, q in reference.values.items() if n in axis]
    size = approach_scale(alike, spacing) if alike else abs(b.value)
    if not size:
        return None
    return Quantity.ratio((a - b) / size)
