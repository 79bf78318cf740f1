"""The assessment in words, derived from its numbers: regime, cautions, and which model to trust."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fem_adhesion.assess.predictions import QUANTITIES, RADII, Prediction, Quantity, relative
from fem_adhesion.assess.settings import USUAL
from fem_adhesion.common.contact import Contact
from fem_adhesion.finite_strain.traction import yielded_adhesion
from halfspace.laws import LENNARD_JONES


@dataclass(frozen=True)
class Deviation:
    """Relative difference of one of `QUANTITIES` from the half-space's, by cause.

    By the true shape on the half-space, by the finite bodies under it, and by both; as a part of the half-space's
    value, with errors, see `fem_adhesion.assess.predictions.relative`. None where not known.
    """

    quantity: str
    profile: Quantity | None
    body: Quantity | None
    total: Quantity | None


@dataclass(frozen=True)
class Distance:
    """How far a model is from the best one at most, relatively, both errors included, and in which quantity.

    The worst is None if it has none of the best one's; missing are those that it lacks.
    """

    model: str
    worst: str | None
    size: float
    missing: tuple[str, ...]


def deviations(
    half_space: Prediction, profile: Prediction | None, finite: Prediction | None, spacing: float
) -> Iterator[Deviation]:
    """Split the difference between the half-space and the finite bodies, for each quantity of the half-space."""
    for name in QUANTITIES:
        if name in half_space.values:
            by_profile = relative(profile, half_space, name, spacing) if profile else None
            total = relative(finite, half_space, name, spacing) if finite else None
            by_body = Quantity.ratio(total - by_profile) if total and by_profile else None
            yield Deviation(name, by_profile, by_body, total)


def ranked(models: Sequence[Prediction | None], spacing: float) -> tuple[Distance, ...]:
    """Distances from the best model, the nearest first, those that lack quantities last; the spacing is in m.

    The models are half-space, true profile and finite bodies, then the closed theories. The finite bodies are the best,
    or if they were not solved the half-space.
    """
    best = models[2] or models[0]
    found = []
    for model in models:
        if best is None or model is None or model is best:
            continue
        # The contact radius of a closed theory is another than a computed one.
        names = [
            name for name in best.values if name not in RADII or (model.source == "theory") == (best.source == "theory")
        ]
        known = {name: off for name in names if (off := relative(model, best, name, spacing))}
        sizes = {name: abs(off.value) + off.error for name, off in known.items()}
        worst = max(sizes, key=sizes.__getitem__, default=None)
        missing = tuple(name for name in best.values if name not in model.values)
        found.append(Distance(model.model, worst, sizes[worst] if worst else 0.0, missing))
    return tuple(sorted(found, key=lambda distance: (len(distance.missing), distance.size)))


def regime(tabor: float) -> str:
    """Regime of a Tabor parameter, with its limits."""
    limits = f"rigid below tabor {USUAL.stiff:g}, JKR above {USUAL.soft:g}"
    if tabor < USUAL.stiff:
        return f"rigid: Bradley's and DMT's theories ({limits})"
    if tabor > USUAL.soft:
        return f"soft: JKR's theory ({limits})"
    return f"transition between rigid and JKR ({limits})"


def cautions(contact: Contact, half_space: Prediction) -> Iterator[str]:
    """Sentences on what the numbers leave out of account."""
    units = contact.units
    R = units.radius
    wide, far = (half_space.values.get(name) for name in ("zero_load_radius", "jump_on_separation"))
    deepened = f"it raises that by more than its first order tells{_premise(contact)}"
    judged = [
        ("contact radius over R", _over(wide, R), USUAL.contact, "linear elasticity no longer holds"),
        ("strain beta/R", units.length / R, USUAL.strain, "finite strain matters"),
        ("spacing over R", units.spacing / R, USUAL.spacing, "a law between continuous planes is doubtful"),
        ("jump-on distance over R", _over(far, R), USUAL.jump, "the law between planes is doubtful"),
        ("stretching of the attracted surface over the work of adhesion", _yield(contact), USUAL.first_order, deepened),
    ]
    if contact.thickness:
        pressed, h = _over(wide, R) ** 2 * R, contact.thickness
        if not contact.profile:
            judged.append(("indentation over thickness", pressed / h, USUAL.strain, "finite strain matters"))
        judged += [("spacing over thickness", units.spacing / h, USUAL.spacing, "its base attracts through the sample")]
    for what, value, limit, meaning in judged:
        if value > limit:
            yield f"{what} is {value:.2g}, limit {limit:g}: {meaning}"


def left_out(contact: Contact) -> Iterator[str]:
    """What theories of a paraboloid leave out, and surface laws: that the attracted surface stretches."""
    if contact.shape:
        yield f"the half-space and the closed theories assume a paraboloid, and the tip is given as {contact.shape}"
    part = _yield(contact)
    if USUAL.faint <= part <= USUAL.first_order:
        adhesion = contact.units.work_of_adhesion * (1 + part)
        yield (
            "stretching of the attracted surface is left out: to the first order it raises the work of adhesion by "
            f"{percent(part)}, to {adhesion:.4g} J/m^2{_premise(contact)}; give that to include it"
        )


def _yield(contact: Contact) -> float:
    """First order of the part by which the yield of the attracted layer deepens one sphere's work of adhesion."""
    units = contact.units
    if contact.pair or contact.layer or contact.profile:
        return 0.0
    return yielded_adhesion(units.tabor, units.radius_ratio, contact.poisson, contact.law) - 1


def _premise(contact: Contact) -> str:
    return "" if contact.law == LENNARD_JONES else ", if the law attracts matter and not charges on the surfaces"


def _over(quantity: Quantity | None, R: float) -> float:
    return quantity.value / R if quantity else 0.0


def verdict(best: Prediction, distances: Sequence[Distance], *, computed: bool, doubts: Sequence[str] = ()) -> str:
    """Which model to trust; none as it is where there are doubts, cautions that pass a limit.

    The distances, from `ranked`, are from the best one; `computed` says whether that is of the bodies as they are.
    """
    if not computed:
        return f"the finite body is not known: judge {the(best.model)} by the cautions"
    whole = [distance for distance in distances if distance.worst and not distance.missing]
    good = [distance.model for distance in whole if distance.size <= USUAL.good]
    trust = f"trust {the(best.model)}"
    if doubts:
        meanings = ", ".join(dict.fromkeys(doubt.rpartition(": ")[2] for doubt in doubts))
        trust = f"trust no model as it is: {meanings}; of these {the(best.model)} leaves out least"
    if good:
        return f"{trust}; within {percent(USUAL.good)} in every quantity: {', '.join(good)}"
    if whole:
        nearest = f"{the(whole[0].model)} is nearest, off by up to {percent(whole[0].size)}"
        return f"{trust}; no other model is within {percent(USUAL.good)} in every quantity, {nearest}"
    return f"{trust}; no other model has all its quantities"


def the(model: str) -> str:
    """Name of a model in a sentence: theories that are named after their authors take no article."""
    return {"rigid": "the rigid sphere"}.get(model, model if model[0].isupper() else f"the {model}")


def percent(part: float) -> str:
    """A part in per cent, in three digits or whole."""
    return f"{100 * part:.3g} %" if part < 10 else f"{100 * part:.0f} %"
