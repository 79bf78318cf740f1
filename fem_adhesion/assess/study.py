"""A real contact assessed: what each model says of it in SI, how wrong the half-space is and why, what to trust."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

import halfspace
from fem_adhesion import convergence
from fem_adhesion.assess import predictions, verdict
from fem_adhesion.assess.predictions import (
    ON_LAYER,
    Prediction,
    Quantity,
    closed,
    computed,
    exact_sphere,
    on_atlas,
    read_atlas,
)
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.assess.spread import Spreads, spreads
from fem_adhesion.assess.theories import sampling
from fem_adhesion.assess.thin_sample import ThinSample, enough, hertz_until, indentations
from fem_adhesion.bodies.held import Hemisphere, Meshed
from fem_adhesion.common.contact import Contact, Inputs
from fem_adhesion.common.jobs import Progress, in_turn, unheard
from fem_adhesion.scene import Scene
from halfspace.atlas.series import LEAST, MOST
from halfspace.elastic.layers import Layers
from halfspace.errors import InputError, Unsolved, tried
from halfspace.laws import LENNARD_JONES
from halfspace.profiles import PARABOLOID, Profile, Sphere
from halfspace.scaling import ATTARD_PARKER, MAUGIS, MYD, MYD_AMPLIFICATION
from halfspace.theories import curves
from halfspace.values import Array

HALF_SPACE, PROFILE, FINITE, PAIR = "half-space", "true profile", "finite sphere", "finite pair"
GIVEN, MESH = "given profile", "mesh"
Answer = TypeVar("Answer")
THEORIES: Mapping[str, Callable[[float, curves.Sampling], Array]] = {
    "JKR": curves.jkr,
    "Maugis-Dugdale": curves.maugis_dugdale,
    "DMT-M": curves.dmt_maugis,
    "rigid": lambda _, how: curves.bradley(how),
}
PARAMETERS = {
    "Tabor mu": None,
    "Maugis lambda": MAUGIS,
    "Muller-Yushchenko-Derjaguin mu_D": MYD,
    "Muller-Yushchenko-Derjaguin mu_T": MYD_AMPLIFICATION,
    "Attard-Parker sigma": ATTARD_PARKER,
}


@dataclass(frozen=True)
class Assessment:
    """What is known of a contact.

    `half_space` is the paraboloid on the half-space, computed, or a closed theory where that is as good; `profile` the
    true profile of sphere or spheres on it; `finite` the contact as it is: the elastic hemisphere held at its mid-
    plane, with its counter-body if that is more than a rigid wall, the mesh in its place, a given profile on the
    half-space, or the thin sample under the true or the given profile. The deviations are those of the last from the
    first, by cause; distances are those of every other model from the best one, the nearest first; cautions say what is
    left out of account, the verdict which model to trust, `sample` what there is to say of a thin one beside that, and
    `spreads` what the standard deviations of the inputs leave of the numbers.
    """

    contact: Contact
    half_space: Prediction
    profile: Prediction | None
    finite: Prediction | None
    theories: tuple[Prediction, ...]
    deviations: tuple[verdict.Deviation, ...]
    distances: tuple[verdict.Distance, ...]
    regime: str
    cautions: tuple[str, ...]
    verdict: str
    seconds: float = field(compare=False)
    sample: ThinSample | None = None
    spreads: Spreads | None = None

    @property
    def best(self) -> Prediction:
        """What leaves out least."""
        return self.finite or self.half_space

    @property
    def models(self) -> tuple[Prediction, ...]:
        """All predictions, the half-space first."""
        return (*filter(None, (self.half_space, self.profile, self.finite)), *self.theories)

    @property
    def parameters(self) -> Mapping[str, float]:
        """The Tabor parameter and the others' names for it."""
        mu = self.contact.units.tabor
        return {name: float(other.of(mu)) if other else mu for name, other in PARAMETERS.items()}


def assess(contact: Contact, progress: Progress = unheard, inputs: Inputs | None = None) -> Assessment:
    """Assess a contact, or raise NotConverged if the half-space's curve or that of a given shape cannot be traced.

    Given the inputs that it was made of, find what their standard deviations make of the numbers.
    """
    began = time.perf_counter()
    uncertain = inputs if inputs and inputs.deviations else None
    begin = in_turn(progress, 4 + (contact.layer is not None) + (uncertain is not None))
    begin("half-space")
    half_space = _half_space(contact)
    begin("closed theories")
    tabor, stiffness, units = contact.units.tabor, contact.reduced_stiffness, contact.units
    within = USUAL.maugis[0] <= MAUGIS.of(tabor) <= USUAL.maugis[1]
    how = sampling(tabor, stiffness)
    theories = tuple(
        closed(name, make(tabor, how), stiffness, units)
        for name, make in THEORIES.items()
        if within or name != "Maugis-Dugdale"
    )
    begin("profile")
    profile, reason = _tried(PROFILE, _profile, contact) if contact.layer or not contact.shape else (None, None)
    body = _body(contact)
    begin(body)
    # Nothing stands in for a shape that cannot be solved.
    finite, why_not = (_finite(contact), None) if contact.shape else _tried(body, _finite, contact)
    if contact.layer:
        begin("thickness that is enough")
    doubts = tuple(verdict.cautions(contact, (contact.shape and finite) or half_space))
    sample, unknown = _tried("thickness that is enough", partial(_thin_sample, half_space=half_space), contact)
    found, unspread = None, None
    if uncertain:
        begin("spread by that of the inputs")
        found, unspread = _tried("spread by that of the inputs", lambda _: _spreads(uncertain), contact)
    by_profile = None if contact.layer and tabor > USUAL.computed else profile  # JKR's theory on layers has no profile
    distances = verdict.ranked((half_space, profile, finite, *theories), contact.spacing)
    warnings = [model.warning for model in (half_space, profile, finite) if model]
    return Assessment(
        contact,
        half_space,
        profile,
        finite,
        theories,
        tuple(verdict.deviations(half_space, by_profile, finite, contact.spacing)),
        distances,
        verdict.regime(tabor),
        (*doubts, *verdict.left_out(contact), *filter(None, (reason, why_not, unknown, unspread, *warnings))),
        verdict.verdict(finite or half_space, distances, computed=finite is not None, doubts=doubts),
        time.perf_counter() - began,
        sample,
        found,
    )


def _spreads(inputs: Inputs) -> Spreads:
    """What the standard deviations of inputs make of the half-space's numbers, or of those of a sample or a profile."""
    contact = inputs.contact()
    other = contact.layer or contact.profile

    def values(contact: Contact) -> Mapping[str, Quantity]:
        return (_finite if other else _half_space)(contact).values

    def drawn(contacts: Sequence[Contact]) -> list[dict[str, Quantity]]:
        if other or not all(map(_in_atlas, contacts)):
            return []
        units, stiffnesses = [c.units for c in contacts], [c.reduced_stiffness for c in contacts]
        return list(read_atlas([one.tabor for one in units], stiffnesses, units, USUAL.drawn))

    return spreads(_body(contact) if other else HALF_SPACE, inputs, values, drawn)


def require_known(contact: Contact) -> None:
    """Refuse a law at a Tabor parameter at which a closed theory, known for the 3-9 law, is as good; InputError.

    Refuse a profile there, too, for which there is no closed theory, and a mesh where it is not solved.
    """
    tabor = contact.units.tabor
    for name, given, least, most, why in (
        ("profile", contact.profile, USUAL.rigid, USUAL.computed, "as no closed theory has it"),
        ("mesh", contact.mesh, 0.0, USUAL.finite, "as finite elements take long beyond"),
    ):
        if given is not None and not least <= tabor <= most:
            limit = f"{least:g} <= tabor <= {most:g} with --{name}"
            raise InputError(f"tabor = {tabor:.4g}, limit: {limit}, {why}; take fem-adhesion curve for it")
    if contact.law != LENNARD_JONES and not USUAL.rigid <= tabor <= USUAL.computed:
        limit = f"{USUAL.rigid:g} <= tabor <= {USUAL.computed:g} with --law"
        raise InputError(f"tabor = {tabor:.4g}, limit: {limit}; leave it out, as all laws have the same limits there")


def _half_space(contact: Contact) -> Prediction:
    """The computed half-space, or the closed theory that is as good."""
    units, stiffness = contact.units, contact.reduced_stiffness
    if _in_atlas(contact):
        return on_atlas(HALF_SPACE, units.tabor, stiffness, units)
    if units.tabor > USUAL.computed:
        return predictions.large_tabor(units.tabor, stiffness, units)
    if units.tabor < USUAL.rigid:
        return closed("rigid half-space", curves.bradley(sampling(units.tabor, stiffness)), stiffness, units)
    return _traced(HALF_SPACE, contact)


def _in_atlas(contact: Contact) -> bool:
    """Whether the atlas of the half-space has the contact; of a thin sample it has what that is compared with."""
    return contact.law == LENNARD_JONES and LEAST <= contact.units.tabor <= MOST


def _traced(model: str, contact: Contact, rtol: float = USUAL.rtol, **scene: Any) -> Prediction:
    """Curve of the half-space or of layers, by the integral equation."""
    path = halfspace.trace(contact.units.tabor, law=contact.law, rtol=rtol, to_load=USUAL.to_load, **scene)
    return computed(model, path, contact.reduced_stiffness, contact.units)


def _tried(name: str, make: Callable[[Contact], Answer], contact: Contact) -> tuple[Answer | None, str | None]:
    """Answer, or why there is none: the contact is outside what the solver serves, or the solver gave up."""
    answer = tried(make, contact, refusals=True)
    return (None, f"{name} not solved: {answer.reason}") if isinstance(answer, Unsolved) else (answer, None)


def _body(contact: Contact) -> str:
    """Name of the model of the contact as it is."""
    if contact.layer:
        return ON_LAYER
    return GIVEN if contact.profile else MESH if contact.mesh else PAIR if contact.pair else FINITE


def _profile(contact: Contact) -> Prediction:
    """The true profile of sphere or spheres on the half-space, or the one that is given."""
    if contact.profile:
        return _traced(GIVEN, contact, profile=contact.profile)
    units, larger = contact.units, contact.larger_radius
    known = USUAL.rigid <= units.tabor <= USUAL.computed
    if not known and math.isfinite(larger):
        raise InputError(
            f"tabor = {units.tabor:.4g} of two spheres is outside {USUAL.rigid:g} <= tabor <= {USUAL.computed:g}; "
            "the paraboloid serves"
        )
    return _traced(PROFILE, contact, profile=Sphere(units.radius_ratio, larger)) if known else exact_sphere(units)


def _finite(contact: Contact) -> Prediction:
    """The elastic hemisphere held at its mid-plane, against a rigid wall or its counter-body.

    Or the mesh in its place, the profile that is given, or the thin sample.
    """
    units = contact.units
    if contact.layer:
        return _on_layer(contact, contact.layer, contact.profile or Sphere(units.radius_ratio))
    if contact.profile:
        return _profile(contact)
    if units.tabor > USUAL.finite:
        remedy = (
            "take fem-adhesion curve with --body hemisphere" if units.tabor <= USUAL.computed else "JKR's theory holds"
        )
        raise InputError(
            f"tabor = {units.tabor:.4g} is outside tabor <= {USUAL.finite:g}, beyond which it takes long; {remedy}"
        )
    made = partial(Meshed, contact.mesh) if contact.mesh else Hemisphere
    body = made(radius_ratio=contact.smaller_ratio, grip=contact.grip, poisson=contact.smaller_poisson)
    scene = Scene(units.tabor, body, law=contact.law, counter=contact.counter, share=contact.share)
    path = convergence.trace(scene, rtol=USUAL.finite_rtol, to_load=USUAL.to_load)
    return computed(_body(contact), path, contact.reduced_stiffness, units)


def _on_layer(contact: Contact, layer: Layers, profile: Profile, rtol: float = USUAL.finite_rtol) -> Prediction:
    """A profile on a thin sample; of a large Tabor parameter the paraboloid."""
    tabor = contact.units.tabor
    if tabor > USUAL.computed:
        return predictions.large_tabor(tabor, contact.reduced_stiffness, contact.units, layer)
    traced = partial(_traced, ON_LAYER, contact, profile=profile, body=layer)
    return tried(traced, rtol) or traced(rtol / 10)  # a jump's landing, lost on a path, may be found on a finer one


def _thin_sample(contact: Contact, half_space: Prediction) -> ThinSample | None:
    """Where the half-space and the series serve in the place of the thin sample; None of others and under a profile."""
    if contact.thickness is None or contact.profile:
        return None
    on_layer = partial(_on_layer, contact, profile=PARABOLOID, rtol=USUAL.searched)
    return ThinSample(
        tuple(indentations(contact, contact.thickness)),
        hertz_until(contact),
        tuple(enough(contact, half_space, on_layer)),
    )
