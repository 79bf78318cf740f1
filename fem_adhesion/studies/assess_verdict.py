"""The assessment in words, derived from its numbers: regime, cautions, and which model to trust."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fem_adhesion.studies.assess_contact import Contact
from fem_adhesion.studies.assess_predictions import WORDS, Prediction, relative
from fem_adhesion.studies.quantities import Quantity

RIGID_TO, SOFT_FROM = (
    0.1,
    5.0,
)  # Tabor parameters between which neither limit serves, [G97] and Johnson & Greenwood 1997
LEVELS = (1e-3, 1e-2, 1e-1)
CLOSE = LEVELS[1:]

WIDEST_CONTACT = 0.3  # of the radius: beyond, neither the parabola nor linear elasticity hold
LARGEST_STRAIN = 0.2  # beta/R, the strain of a contact beta wide
LARGEST_SPACING = 0.1  # eps/R: a sphere of ten atoms is no continuum
FARTHEST_JUMP = 0.3  # of the radius: the law between planes is meant for gaps small against it


@dataclass(frozen=True)
class Deviation:
    """Relative difference of a quantity from the half-space's, by cause.

    Attributes
    ----------
    quantity : str
        One of `fem_adhesion.studies.assess_predictions.QUANTITIES`.
    profile, body, total : Quantity or None
        By the sphere's true shape on the half-space, by the finite body under it, and by both; as a part of the
        half-space's value, with errors. None where not known.
    """

    quantity: str
    profile: Quantity | None
    body: Quantity | None
    total: Quantity | None


def deviation(name: str, half_space: Prediction, profile: Prediction | None, finite: Prediction | None) -> Deviation:
    """Split the difference between the half-space and the finite sphere."""
    by_profile = relative(profile, half_space, name) if profile else None
    total = relative(finite, half_space, name) if finite else None
    if by_profile is None or total is None:
        return Deviation(name, by_profile, None, total)
    by_body = Quantity(total.value - by_profile.value, total.error + by_profile.error, "1")
    return Deviation(name, by_profile, by_body, total)


def regime(tabor: float) -> str:
    """Regime of a Tabor parameter, with its limits."""
    limits = f"rigid below tabor {RIGID_TO:g}, JKR above {SOFT_FROM:g}"
    if tabor < RIGID_TO:
        return f"rigid: Bradley's and DMT's theories ({limits})"
    if tabor > SOFT_FROM:
        return f"soft: JKR's theory ({limits})"
    return f"transition between rigid and JKR ({limits})"


def cautions(contact: Contact, half_space: Prediction) -> Iterator[str]:
    """Sentences on what the numbers leave out of account."""
    units = contact.units
    R = units.radius
    radius = half_space.values.get("zero_load_radius")
    if radius and radius.value > WIDEST_CONTACT * R:
        yield _beyond("contact radius over R", radius.value / R, WIDEST_CONTACT, "linear elasticity no longer holds")
    if units.length > LARGEST_STRAIN * R:
        yield _beyond("strain beta/R", units.length / R, LARGEST_STRAIN, "finite strain matters")
    if units.spacing > LARGEST_SPACING * R:
        yield _beyond(
            "spacing over R", units.spacing / R, LARGEST_SPACING, "a law between continuous planes is doubtful"
        )
    jump = half_space.values.get("jump_on_separation")
    if jump and jump.value > FARTHEST_JUMP * R:
        yield _beyond("jump-on distance over R", jump.value / R, FARTHEST_JUMP, "the law between planes is doubtful")
    if contact.both_elastic:
        yield (
            "both bodies are elastic: they act as one with their contact modulus, and the finite sphere carries all of "
            "the compliance, so that its deviations are too large"
        )
    if math.isfinite(contact.counter_radius):
        yield "both bodies are round: they act as one sphere of the equivalent radius, nearer to a half-space than it"


def _beyond(what: str, value: float, limit: float, meaning: str) -> str:
    return f"{what} is {value:.2g}, limit {limit:g}: {meaning}"


def verdict(
    half_space: Prediction, theories: Sequence[Prediction], deviations: Sequence[Deviation], *, solved: bool
) -> Iterator[str]:
    """Sentences on which model to trust.

    Parameters
    ----------
    half_space : Prediction
        The reference.
    theories : sequence of Prediction
        Closed ones beside it.
    deviations : sequence of Deviation
        Of the finite sphere from the half-space.
    solved : bool
        Whether the finite sphere was solved.
    """
    yield _theories(half_space, theories)
    known = [d for d in deviations if (d.total or d.profile) is not None]
    if not known:
        yield "the finite sphere is not known: judge the half-space by the cautions"
        return
    worst = max(known, key=_size)
    what = "the finite sphere" if solved else "the sphere's true shape on the half-space"
    yield from (f"beside {what}, {_judged(d)}" for d in dict.fromkeys((known[0], worst)))
    yield _advice(half_space, theories, _size(worst), solved=solved)


def _judged(deviation: Deviation) -> str:
    """How far off the half-space is in one quantity, and why."""
    size = _size(deviation)
    level = next((f"within {_percent(level)}" for level in LEVELS if size <= level), f"beyond {_percent(LEVELS[-1])}")
    return f"the half-space is {level} in {WORDS[deviation.quantity]}: off by {_percent(size)}{_cause(deviation)}"


def _cause(deviation: Deviation) -> str:
    if deviation.profile is None or deviation.body is None:
        return ""
    profile, body = abs(deviation.profile.value), abs(deviation.body.value)
    return ", mostly by the true profile" if profile > body else ", mostly by the finite body"


def _advice(half_space: Prediction, theories: Sequence[Prediction], worst: float, *, solved: bool) -> str:
    if worst > CLOSE[0] and solved:
        return "trust the finite sphere; the half-space is an estimate"
    near = [theory for theory in theories if _distance(theory, half_space) <= CLOSE[0]]
    if near:
        best = min(near, key=lambda theory: _distance(theory, half_space))
        return f"trust the {half_space.model}; {best.model} gives the same pull-off force within {_percent(CLOSE[0])}"
    return f"trust the {half_space.model}; no closed theory has its pull-off force within {_percent(CLOSE[0])}"


def _theories(half_space: Prediction, theories: Sequence[Prediction]) -> str:
    """Which closed theory comes close in pull-off."""
    groups = []
    for low, high in ((0.0, CLOSE[0]), CLOSE):
        names = [theory.model for theory in theories if low <= _distance(theory, half_space) < high]
        if names:
            groups.append(f"within {_percent(high)}: {', '.join(names)}")
    beside = "; ".join(groups) or f"none within {_percent(CLOSE[1])}"
    return f"closed theories beside the {half_space.model} in pull-off force: {beside}"


def _distance(theory: Prediction, half_space: Prediction) -> float:
    found = relative(theory, half_space, "pull_off_force")
    return abs(found.value) if found else math.inf


def _size(deviation: Deviation) -> float:
    """Largest that a deviation may be, its error included."""
    known = deviation.total or deviation.profile
    return abs(known.value) + known.error if known else 0.0


def _percent(part: float) -> str:
    return f"{100 * part:.3g} %"
