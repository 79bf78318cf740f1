"""What a model says of a contact, in SI: read off a computed curve or off a closed theory."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

from fem_adhesion.assess import theories
from fem_adhesion.assess.theories import Curve, Loop, estimated, loop
from fem_adhesion.common.numbers import Quantity
from halfspace.elastic.layers import Layer
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Jump, cycle
from halfspace.equilibrium.events import approach_scale
from halfspace.scaling import Units
from halfspace.theories.closed_forms import ContactState
from halfspace.theories.exact_sphere import JKRSphere, RigidSphere
from halfspace.values import Estimate

# Relative distance of JKR's theory with the reach of the attraction from the half-space at the Tabor parameter 300, the
# last that is computed; it falls beyond, the contact's as mu^-1.7.
REFERENCE_TABOR, DECAY = 300.0, 1.5
DISTANCE = {
    "pull_off_force": 3e-5,
    "pull_off_radius": 1e-4,
    "zero_load_radius": 1e-4,
    "jump_on_separation": 1e-2,
    "jump_on_base": 1e-2,
    "jump_off_separation": 3e-4,
    "jump_off_base": 3e-4,
    "energy_lost": 5e-4,
}
QUANTITIES = tuple(DISTANCE)
IN_CONTACT = ("pull_off_force", "pull_off_radius", "zero_load_radius", "jump_off_separation", "jump_off_base")
ON_LAYER = "thin sample"
THIN = 0.12  # beta: on a layer so thick the distance at the Tabor parameter 300 is at most twice the half-space's
RADII = ("pull_off_radius", "zero_load_radius")
POSITIONS = (("jump_on_separation", "jump_off_separation"), ("jump_on_base", "jump_off_base"))  # along two axes
WORDS = {
    "pull_off_force": "pull-off force",
    "pull_off_radius": "contact radius at pull-off",
    "zero_load_radius": "contact radius, no load",
    "jump_on_separation": "separation, jump on",
    "jump_on_base": "base, jump on",
    "jump_off_separation": "separation, jump off",
    "jump_off_base": "base, jump off",
    "energy_lost": "energy lost per cycle",
}


@dataclass(frozen=True)
class Prediction:
    """What one model says.

    Attributes
    ----------
    model : str
        Its name.
    values : mapping of str to Quantity
        Of `QUANTITIES` those that the model has:

        ``pull_off_force``
            Largest tension in N.
        ``pull_off_radius``, ``zero_load_radius``
            Contact radius in m at the largest tension and under no load; of a computed state that of the largest
            traction.
        ``jump_on_separation``, ``jump_off_separation``
            Distance in m of the undeformed surfaces where the cantilever's jump takes off; negative if they overlap.
        ``jump_on_base``, ``jump_off_base``
            Position in m of the cantilever's base there, positive towards the wall, zero where the undeformed surfaces
            would be one spacing apart with the cantilever straight.
        ``energy_lost``
            In J, in a cycle of approach and separation.
    curve : EquilibriumPath, Curve or None
        Where they are read off, if a curve.
    missed : mapping of str to tuple of str
        By state of a computed curve or of its jumps, the numbers that are less accurate than was asked.
    """

    model: str
    values: Mapping[str, Quantity]
    curve: EquilibriumPath | Curve | None = field(default=None, repr=False)
    missed: Mapping[str, Sequence[str]] = field(default_factory=dict)

    @property
    def is_computed(self) -> bool:
        """Whether a solver has computed it, rather than a closed theory, which has a contact radius of its own."""
        return isinstance(self.curve, EquilibriumPath)


def computed(model: str, path: EquilibriumPath, stiffness: float, units: Units) -> Prediction:
    """Read a computed curve, of the half-space or of finite elements, on a cantilever of stiffness in R dgamma/eps.

    NotConverged if a jump or a landing cannot be solved for.
    """
    tension, free = path.events["pull_off"], path.events["zero_load"]
    values = {
        "pull_off_force": Quantity.of(Estimate(-tension.load, tension.load_error), *units.si("load")),
        "pull_off_radius": Quantity.of(tension.estimate("contact_radius"), *units.si("radius")),
        "zero_load_radius": Quantity.of(free.estimate("contact_radius"), *units.si("radius")),
    }
    round_trip = cycle(path, stiffness)
    if round_trip:
        values |= _jump("jump_on", round_trip.jump_on, stiffness, units) | _jump(
            "jump_off", round_trip.jump_off, stiffness, units
        )
        values["energy_lost"] = Quantity.of(round_trip.energy_lost, *units.si("energy"))
    return Prediction(model, _known(values), path, path.missed | (round_trip.missed if round_trip else {}))


def _jump(name: str, jump: Jump, stiffness: float, units: Units) -> dict[str, Quantity]:
    at = jump.take_off
    base = Estimate(at.approach + at.load / stiffness, at.approach_error + at.load_error / stiffness)
    return _positions(name, Estimate(1 - at.approach, at.approach_error), base, units)


def _positions(name: str, separation: Estimate, base: Estimate, units: Units) -> dict[str, Quantity]:
    """Where a jump takes off, along both axes."""
    return {
        f"{name}_separation": Quantity.of(separation, *units.si("approach")),
        f"{name}_base": Quantity.of(base, *units.si("approach")),
    }


def closed(
    model: str, make: Callable[[float, float], Curve], tabor: float, stiffness: float, units: Units
) -> Prediction:
    """Read a closed theory, made from the Tabor parameter and the stiffness in R dgamma/eps.

    The errors are those of the reading, not the theory's distance from the truth.
    """
    curve = make(tabor, stiffness)
    values = {
        "pull_off_force": _read(curve, lambda c: -theories.pull_off(c).load, *units.si("load")),
        "pull_off_radius": _read(curve, lambda c: theories.pull_off(c).contact_radius, *units.si("radius")),
        "zero_load_radius": _read(curve, lambda c: theories.zero_load(c).contact_radius, *units.si("radius")),
    }
    found = loop(curve, stiffness)
    if found:
        values |= _closed_jump("jump_on", found, found.jump_on[0], stiffness, units)
        values |= _closed_jump("jump_off", found, found.jump_off[0], stiffness, units)
        values["energy_lost"] = _read(curve, lambda c: _lost(c, stiffness), *units.si("energy"))
    return Prediction(model, _known(values), curve)


def large_tabor(tabor: float, stiffness: float, units: Units) -> Prediction:
    """JKR's theory with the reach of the attraction, its errors being the distance from the truth: tabor >= 300."""
    read = closed("JKR with reach", theories.jkr_with_reach, tabor, stiffness, units)
    part = (REFERENCE_TABOR / tabor) ** DECAY
    values = {
        name: Quantity(
            q.value, q.error + abs(q.value) * DISTANCE[name] * (part if "jump_on" not in name else 1), q.unit
        )
        for name, q in read.values.items()
    }
    return Prediction(read.model, values, read.curve)


def large_tabor_on(layer: Layer, tabor: float, stiffness: float, units: Units) -> Prediction:
    """JKR's theory on a thin sample, tabor >= 300: the contact's values and the jump off, as `large_tabor` else.

    What is left of the attraction's reach grows where the spike at the edge is no longer narrow beside the thickness.
    """
    read = closed(ON_LAYER, partial(theories.jkr_on, layer), tabor, stiffness, units)
    part = (REFERENCE_TABOR / tabor) ** DECAY * (1 + (THIN / layer.thickness) ** 3)
    values = {
        name: Quantity(q.value, q.error + abs(q.value) * DISTANCE[name] * part, q.unit)
        for name, q in read.values.items()
        if name in IN_CONTACT
    }
    return Prediction(read.model, values, read.curve)


def soft_sphere(units: Units) -> Prediction:
    """Read JKR's theory on the exact profile of the sphere, the contact's values only; InputError where it spans R."""
    theory = JKRSphere(units.tabor, units.radius_ratio)
    tension, free = theory.pull_off(), theory.zero_load()
    values = {
        "pull_off_force": _exact(-tension.load, *units.si("load")),
        "pull_off_radius": _exact(tension.contact_radius, *units.si("radius")),
        "zero_load_radius": _exact(free.contact_radius, *units.si("radius")),
    }
    return Prediction("JKR on the sphere", values)


def rigid_sphere(units: Units) -> Prediction:
    """Read the rigid hemisphere's pull-off force; InputError if it is far smaller than the spacing."""
    tension = RigidSphere(units.radius_ratio).pull_off()
    return Prediction("rigid sphere", {"pull_off_force": _exact(-tension.load, *units.si("load"))})


def _exact(value: float, size: float, unit: str) -> Quantity:
    return Quantity.of(Estimate(value, 1e-12 * abs(value)), size, unit)


def _read(curve: Curve, quantity: Callable[[Curve], float], size: float, unit: str) -> Quantity:
    return Quantity.of(estimated(curve, quantity), size, unit)


def _lost(curve: Curve, stiffness: float) -> float:
    found = loop(curve, stiffness)
    return found.energy_lost if found else math.nan


def _closed_jump(name: str, found: Loop, at: ContactState, stiffness: float, units: Units) -> dict[str, Quantity]:
    """Take-off of a jump; at a turning point of the base a displaced sample errs in the approach alone."""
    separation = Estimate(1 - at.approach, found.spacing)
    base = Estimate(at.approach + at.load / stiffness, found.spacing)
    return _positions(name, separation, base, units)


def _known(values: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Leave out what the model does not have."""
    return {name: q for name, q in values.items() if math.isfinite(q.value)}


def relative(ours: Prediction, reference: Prediction, name: str, spacing: float) -> Quantity | None:
    """Difference of a quantity from a reference's, with both errors in it, or None if either has none.

    It is a part of the reference's value; of a position, which has no natural zero, of the spacing in m and the
    distance between the reference's positions of both jumps, see `halfspace.equilibrium.events.approach_scale`.
    """
    a, b = ours.values.get(name), reference.values.get(name)
    if a is None or b is None:
        return None
    axis = {n for names in POSITIONS if name in names for n in names}
    whole = reference if axis <= reference.values.keys() else ours  # JKR's theory on layers jumps off only
    alike = [q.value for n, q in whole.values.items() if n in axis]
    size = approach_scale(alike, spacing) if alike else abs(b.value)
    if not size:
        return None
    return Quantity((a.value - b.value) / size, (a.error + b.error) / size, "1")
