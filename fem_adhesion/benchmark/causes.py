"""What may be wrong with somebody's numbers, each cause as a change of our own solution.

A variant of a cause predicts the numbers that a code with the defect gives, from those that are right. It has one free
parameter at most, a size between two positive ends. Where the defect leaves a number open, as a sampled curve its
jumps, the prediction has a spread. Quantities in R dgamma, eps and beta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import product

import numpy as np

from fem_adhesion.benchmark.problems import KINDS, Problem, by_atlas
from halfspace import atlas
from halfspace.atlas.series import LEAST, MOST
from halfspace.theories import closed_forms as jkr
from halfspace.values import Array

Values = Mapping[str, float]
Prediction = tuple[Values, Values]  # values and, of those that are left open, spreads

REMEDIES: Mapping[str, str] = {
    "sound": "Nothing to mend; refine once more to see which digits stand.",
    "domain-too-small": "Enlarge the domain until the approaches stand still: they err as 1/L, the loads as L^-4.",
    "grid-too-coarse": "Refine at the contact edge, to 0.1 beta/tabor^2: the force ripples as the edge moves.",
    "sampled-jumps": "Solve for the jumps as folds, or halve the step of the approach until they stand still.",
    "factor-2-pi-r": "Integrate the pressure over rings, 2 pi r dr, and give the load in R dgamma.",
    "modulus-e-for-e-star": "Use E* = E/(1 - nu^2), of two bodies 1/E* = 1/E1* + 1/E2*, in the place of E.",
    "factor-2-gamma": "Use the work of adhesion, dgamma = gamma1 + gamma2 - gamma12, which is 2 gamma of equal bodies.",
    "radius-of-one-body": "Use R = R1 R2/(R1 + R2), half a radius of equal spheres, in the place of R1.",
    "displacement-for-approach": "Give alpha, by which undeformed surfaces a spacing eps apart are pressed together.",
    "load-control-tear-off": "Go on past the pull-off: under fixed grips the contact ends at the fold in approach.",
    "hertz-radius-in-jkr": "Solve for JKR's radius at the approach: Hertz's, a^2 = R alpha, leaves out the tension.",
    "jkr-for-intermediate": "Use the solution at the Tabor parameter, or `fem-adhesion formulas`; JKR is its limit.",
    "cannot-tell": "Give more quantities, of jumps and under no load too, at two Tabor parameters or more.",
}
"""What to do by cause."""

SHAPE = 0.47  # shift of the approach of a clamped block in mu |W|/L: measured on blocks of 30 and 60 beta
FEW = ("jump_on", "jump_off")
PLACES = 4000  # on a curve of the atlas: turns by parabolas are then right to 1e-8
FACTORS = (1 / (2 * math.pi), 1 / math.pi, math.pi, 2 * math.pi)
ACTS, LOAD_UNIT = ("Tabor parameter", "loads", "radii"), (0, -1, 0)
MATERIAL: Mapping[str, tuple[tuple[float | tuple[float, float], ...], tuple[tuple[float, float, float], ...]]] = {
    "factor-2-pi-r": (FACTORS, ((0, 1, 0),)),
    "modulus-e-for-e-star": (((0.75, 0.999), (1.5, 2.0)), ((-2 / 3, 0, -1 / 3), (-2 / 3, 0, 0))),
    "factor-2-gamma": ((2.0, 0.5), ((2 / 3, 1, 1 / 3), (2 / 3, 0, 0), (0, -1, -1 / 3), LOAD_UNIT)),
    "radius-of-one-body": ((2.0, 0.5), ((1 / 3, 1, 2 / 3), (1 / 3, 0, 0), (0, -1, -2 / 3), LOAD_UNIT)),
}
"""Factors by which a constant is wrong, or their ranges, and its powers in the Tabor parameter, in loads and in radii.

The modulus is E in the place of E*, of one body or of two equal ones. The powers are those of a constant that is wrong
throughout; in the Tabor parameter alone; in the units of the results; and in that of the loads.
"""

APPROACHES: Mapping[str, tuple[float, float, float, float]] = {
    "of the other sign": (0, -1, 0, 0),
    "from where surfaces touch": (-1, 1, 0, 0),
    "distance of the undeformed surfaces": (1, -1, 0, 0),
    "central gap of the other sign": (0, 0, 0, -1),
    "central gap": (0, 0, 0, 1),
    "central distance": (1, 0, 0, 1),
    "displacement of the surface": (0, 1, 0, 1),
    "displacement of the surface, outwards": (0, -1, 0, -1),
    "in beta^2/R in the place of eps": (0, 0, 1, 0),
}
"""What is given for the approach: a sum of 1, the approach in eps and in beta^2/R, and the central gap, so often."""


@dataclass(frozen=True)
class Truth:
    """Our solution of a problem, and what the causes ask of it at other Tabor parameters."""

    problem: Problem

    @cached_property
    def values(self) -> Values:
        """Our values."""
        return {name: number.value for name, number in self.problem.values.items()}

    @property
    def tabor(self) -> float:
        """Tabor parameter."""
        return self.problem.scene.tabor

    @cached_property
    def curve(self) -> Array:
        """Approach, load and contact radius (3, n) along the curve of the atlas."""
        states = atlas.curve(self.tabor).states(PLACES)
        return np.array([states.approach, states.load, states.contact_radius])


@dataclass(frozen=True)
class Variant:
    """A cause in one of the ways in which it occurs; its parameter is between the ends, if it has one.

    A prediction is None of a problem for which it is not known at once.
    """

    cause: str
    what: str
    predict: Callable[[Truth, float], Prediction | None]
    ends: tuple[float, float] | None = None


def variants() -> Iterator[Variant]:
    """All causes in all ways, sound numbers first."""
    yield Variant("sound", "", lambda truth, _: (truth.values, {}))
    for sign, word in ((1, "stiff"), (-1, "soft")):
        yield Variant("domain-too-small", f"too {word}; mu/L or so", partial(_boxed, sign), (1e-6, 0.3))
    yield Variant("grid-too-coarse", "a receding edge is held by this part of dgamma", _coarse, (1e-6, 0.5))
    for late, word in ((1, "after"), (-1, "before")):
        for names, which in ((FEW, "jumps"), ((*FEW, "pull_off", "zero_load"), "all events")):
            what = f"{which} read off the row {word}, in steps of (eps)"
            yield Variant("sampled-jumps", what, partial(_sampled, late, names), (1e-6, 1.0))
    for cause, (factors, ways) in MATERIAL.items():
        for factor, powers in product(factors, ways):
            if isinstance(factor, tuple):
                yield Variant(cause, "E/E*", partial(_material, powers), factor)
            else:
                told = ", ".join(f"{name} by {factor**p:.3g}" for name, p in zip(ACTS, powers, strict=True) if p)
                yield Variant(cause, told, partial(_constant, powers, factor))
    for what, parts in APPROACHES.items():
        yield Variant("displacement-for-approach", what, partial(_instead, parts))
    yield Variant("load-control-tear-off", "the pull-off given as the jump off", _torn)
    yield Variant("hertz-radius-in-jkr", "JKR's force with a^2 = R alpha", _musen)
    yield Variant("jkr-for-intermediate", "JKR's closed forms", _jkr)


def _material(powers: tuple[float, float, float], truth: Truth, factor: float) -> Prediction | None:
    tabor, load, radius = (factor**power for power in powers)
    values = truth.values
    if tabor != 1:
        if not (truth.problem.in_atlas and LEAST <= truth.tabor * tabor <= MOST):
            return None
        values = {name: number.value for name, number in by_atlas(truth.tabor * tabor).items()}
    sizes = {"load": load, "energy": load, "contact_radius": radius}
    return {name: value * sizes.get(KINDS[name], 1.0) for name, value in values.items()}, {}


def _constant(powers: tuple[float, float, float], factor: float, truth: Truth, _: float) -> Prediction | None:
    return _material(powers, truth, factor)


def _boxed(sign: int, truth: Truth, size: float) -> Prediction:
    """A box yields less than a half-space, by a compliance that is subtracted; what the load lacks falls as L^-4."""
    compliance, moved, spread = sign * size * truth.tabor, dict(truth.values), dict[str, float]()
    for name, value in truth.values.items():
        if name.endswith("approach"):
            moved[name] = value - compliance * truth.values[name.replace("approach", "load")]
    parts = dict.fromkeys(moved, 0.1)
    if truth.problem.in_atlas and "jump_on_load" in moved:
        approach, load, radius = truth.curve
        before, after = _folds(approach, load, radius), _folds(approach - compliance * load, load, radius)
        for name in before.keys() & after.keys() & moved.keys():
            moved[name], parts[name] = truth.values[name] + after[name] - before[name], 0.01
    for name, value in truth.values.items():
        lacking = 50 * (size / SHAPE) ** 4 * abs(value)
        spread[name] = math.inf if _after(name) else parts[name] * abs(moved[name] - value) + lacking
    return moved, spread


def _folds(approach: Array, load: Array, radius: Array) -> Values:
    """Folds of a curve between which the approach falls most; empty if it does not fall."""
    off = int(np.argmax(np.maximum.accumulate(approach) - approach))
    on = int(np.argmax(approach[: off + 1]))
    found = dict[str, float]()
    for name, i in (("jump_on", on), ("jump_off", off)):
        if not 0 < i < approach.size - 1 or on == off:
            return {}
        below, here, above = approach[i - 1 : i + 2]
        t = (below - above) / (below - 2 * here + above) / 2
        found[f"{name}_approach"] = float(here - (below - above) * t / 4)
        for kind, along in (("load", load), ("contact_radius", radius)):
            found[f"{name}_{kind}"] = float(along[i] + t * (along[i + 1] - along[i - 1]) / 2)
    return {name: value for name, value in found.items() if not math.isnan(value)}  # no radius without contact


def _after(name: str) -> bool:
    """Whether it is of a landing, or an energy, which follow from more than the states by which a defect is known."""
    return "landing" in name or "energy" in name


def _coarse(truth: Truth, part: float) -> Prediction:
    """A contact edge that is held by nodes recedes as with more work of adhesion, by JKR's powers of it.

    How much more depends on where the nodes stand; the jump on, before which there is no edge, hardly changes.
    """
    values, spread = dict(truth.values), dict[str, float]()
    for name, power in (("pull_off_load", 1.0), ("jump_off_load", 1.0), ("jump_off_approach", 2 / 3)):
        if name in values:
            values[name] *= 1 + power * part
    for name, value in truth.values.items():
        before, held = name.startswith("jump_on_") and not _after(name), name == "pull_off_load"
        spread[name] = part * (abs(value) * (0.2 if before else 0.5) + (0 if before or held else 0.5 * truth.tabor))
    return values, spread


def _sampled(late: int, names: tuple[str, ...], truth: Truth, step: float) -> Prediction | None:
    """Jumps on the rows beside them, half a step from where they are, give or take its other half."""
    if "jump_on_approach" not in truth.values:
        return None
    values, spread = dict(truth.values), {name: 2 * step for name in truth.values if _after(name)}
    for name, forward in (("jump_on", late), ("jump_off", -late)):
        values[f"{name}_approach"] += forward * step / 2
        # Near a fold the other numbers go as the root of the distance.
        spread |= {f"{name}_{kind}": math.sqrt(step) for kind in ("load", "central_gap", "contact_radius")}
    spread |= {f"{name}_approach": step / math.sqrt(12) for name in names}
    if "pull_off" in names:
        spread["pull_off_load"] = (step / truth.tabor) ** 2
    return values, spread


def _instead(parts: tuple[float, float, float, float], truth: Truth, _: float) -> Prediction:
    (one, alpha, reduced, gap), values = parts, dict(truth.values)
    for name in truth.values:
        if name.endswith("_approach"):
            central = truth.values[name.replace("approach", "central_gap")]
            values[name] = one + (alpha + reduced / truth.tabor) * values[name] + gap * central
    return values, {}


def _torn(truth: Truth, _: float) -> Prediction:
    torn = {name.replace("pull_off", "jump_off"): v for name, v in truth.values.items() if name.startswith("pull_off")}
    return {**truth.values, **torn}, {name: math.inf for name in truth.values if _after(name)}


def _musen(truth: Truth, _: float) -> Prediction | None:
    a0, least = jkr.ZERO_LOAD_RADIUS, jkr.ZERO_LOAD_RADIUS * 2 ** (-2 / 3)
    apart = jkr.ContactState(0.0, 0.0, math.nan)
    return _jkr_states(
        truth,
        pull_off=jkr.ContactState(truth.tabor * least**2, jkr.JKR_PULL_OFF, least),
        zero_load=jkr.ContactState(truth.tabor * a0**2, 0.0, a0),
        jump_on=apart,
        jump_off=apart,
    )


def _jkr(truth: Truth, _: float) -> Prediction | None:
    mu = truth.tabor
    return _jkr_states(
        truth,
        pull_off=jkr.jkr_pull_off(mu),
        zero_load=jkr.jkr_zero_load(mu),
        jump_on=jkr.ContactState(0.0, 0.0, math.nan),
        jump_on_landing=jkr.jkr_zero_approach(mu),
        jump_off=jkr.jkr_jump_off(mu),
    )


def _jkr_states(truth: Truth, **states: jkr.ContactState) -> Prediction | None:
    if not truth.problem.in_atlas:
        return None
    return {f"{name}_{kind}": value for name, state in states.items() for kind, value in vars(state).items()}, {}
