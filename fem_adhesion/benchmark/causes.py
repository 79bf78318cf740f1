"""What may be wrong with somebody's numbers, each cause as a change of our own solution.

A variant of a cause predicts the numbers that a code with the defect gives, from those that are right. It has one free
parameter at most, a size between two positive ends. Where the defect leaves a number open, as a sampled curve its
jumps, the prediction has a spread. Quantities in R dgamma, eps and beta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

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

FACTORS = (1 / (2 * math.pi), 1 / math.pi, math.pi, 2 * math.pi)
SHAPE = 0.47  # shift of the approach of a clamped block in mu |W|/L: measured on blocks of 30 and 60 beta
PLACES = 4000  # on a curve of the atlas: turns by parabolas are then right to 1e-8
RIPPLE = 0.5  # spread of what a ripple changes, in that change: it depends on where the nodes stand


@dataclass(frozen=True)
class Truth:
    """Our solution of a problem, and what of it at other parameters the causes ask for."""

    problem: Problem

    @cached_property
    def values(self) -> Values:
        """Our values."""
        return {name: number.value for name, number in self.problem.values.items()}

    @property
    def tabor(self) -> float:
        """Tabor parameter."""
        return self.problem.scene.tabor

    def at(self, factor: float) -> Values | None:
        """Values at a multiple of the Tabor parameter; None where they are not known at once."""
        tabor = self.tabor * factor
        if not (self.problem.in_atlas and LEAST <= tabor <= MOST):
            return None
        return {name: number.value for name, number in by_atlas(tabor).items()}

    @cached_property
    def curve(self) -> Array:
        """Approach, load and contact radius (3, n) along the curve of the atlas."""
        states = atlas.curve(self.tabor).states(PLACES)
        return np.array([states.approach, states.load, states.contact_radius])

    def shifted(self, compliance: float) -> Prediction:
        """Values where the approach has a compliance less, by which a box yields less than a half-space."""
        moved = {
            name: self.values[name] - compliance * self.values[name.replace("approach", "load")]
            for name in self.values
            if name.endswith("approach")
        }
        spread = {name: abs(moved[name] - self.values[name]) / 10 for name in moved}
        if self.problem.in_atlas and "jump_on_load" in self.values:
            approach, load, radius = self.curve
            before = _folds(approach, load, radius)
            after = _folds(approach - compliance * load, load, radius)
            for name in before.keys() & after.keys() & self.values.keys():
                moved[name] = self.values[name] + after[name] - before[name]
                spread[name] = abs(moved[name] - self.values[name]) / 100
        # Of a domain L what the load lacks falls as L^-4; L by the shift of the approach.
        part = 50 * (abs(compliance) / (SHAPE * self.tabor)) ** 4
        spread |= {
            name: spread.get(name, 0.0) + part * abs(v) for name, v in self.values.items() if "landing" not in name
        }
        spread |= {name: math.inf for name in self.values if "landing" in name or "energy" in name}
        return {**self.values, **moved}, spread


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


@dataclass(frozen=True)
class Variant:
    """A cause in one of the ways in which it occurs; its parameter is between the ends, if it has one."""

    cause: str
    what: str
    predict: Callable[[Truth, float], Prediction | None]
    ends: tuple[float, float] | None = None


def variants() -> Iterator[Variant]:
    """All causes in all ways; what changes nothing of a problem, or is not known of it, predicts None."""
    yield Variant("sound", "", lambda truth, _: (truth.values, {}))
    for sign, word in ((1, "stiff"), (-1, "soft")):
        yield Variant("domain-too-small", f"{word} by (eps/R dgamma)", _domain(sign), (1e-6, 0.3))
    yield Variant("grid-too-coarse", "work of adhesion at a receding edge too large by the part", _coarse, (1e-6, 0.5))
    for late, word in ((True, "after"), (False, "before")):
        for all_ in (True, False):
            what = f"{'all events' if all_ else 'jumps alone'} from rows, the one {word} the jump, in steps of (eps)"
            yield Variant("sampled-jumps", what, _sampled(late, all_), (1e-6, 1.0))
    for factor in FACTORS:
        yield Variant("factor-2-pi-r", f"loads times {factor:.4g}", _units(factor, 1.0))
    for first, last in ((0.75, 0.999), (1.5, 2.0)):
        for own in (False, True):
            yield Variant("modulus-e-for-e-star", "modulus in E* is", _modulus(own), (first, last))
    for cause, factors, power in (("factor-2-gamma", (2.0, 0.5), 1 / 3), ("radius-of-one-body", (2.0, 0.5), 2 / 3)):
        by_tabor = 2 / 3 if cause == "factor-2-gamma" else 1 / 3
        for f in factors:
            yield Variant(cause, f"times {f:g} throughout", _material(f**by_tabor, f, f**power))
            yield Variant(cause, f"times {f:g} in the Tabor parameter", _material(f**by_tabor, 1.0, 1.0))
            yield Variant(cause, f"times {f:g} in the units of the results", _units(1 / f, f**-power))
            yield Variant(cause, f"times {f:g} in the unit of the loads", _units(1 / f, 1.0))
    for what, parts in APPROACHES.items():
        yield Variant("displacement-for-approach", what, _instead(*parts))
    yield Variant("load-control-tear-off", "the pull-off given as the jump off", _torn)
    yield Variant("hertz-radius-in-jkr", "JKR's force with a^2 = R alpha", _musen)
    yield Variant("hertz-radius-in-jkr", "contact radii a^2 = R alpha", _hertz)
    yield Variant("jkr-for-intermediate", "JKR's closed forms", _jkr)


APPROACHES: Mapping[str, tuple[float, float, float, float]] = {
    "of the other sign": (0, -1, 0, 0),
    "from where surfaces touch, not a spacing before": (-1, 1, 0, 0),
    "distance of the undeformed surfaces": (1, -1, 0, 0),
    "central gap of the other sign": (0, 0, 0, -1),
    "central gap": (0, 0, 0, 1),
    "central distance": (1, 0, 0, 1),
    "displacement of the surface": (0, 1, 0, 1),
    "displacement of the surface, outwards": (0, -1, 0, -1),
    "in beta^2/R in the place of eps": (0, 0, 1, 0),
}
"""What is given for the approach: a sum of 1, the approach in eps and in beta^2/R, and the central gap, so often."""


def _scaled(values: Values, load: float, radius: float) -> Values:
    """Values in other units of load and radius; the energies go as the loads."""
    sizes = {"load": load, "energy": load, "contact_radius": radius}
    return {name: value * sizes.get(KINDS[name], 1.0) for name, value in values.items()}


def _units(load: float, radius: float) -> Callable[[Truth, float], Prediction]:
    return lambda truth, _: (_scaled(truth.values, load, radius), {})


def _material(tabor: float, load: float, radius: float) -> Callable[[Truth, float], Prediction | None]:
    def predict(truth: Truth, _: float) -> Prediction | None:
        values = truth.at(tabor)
        return None if values is None else (_scaled(values, load, radius), {})

    return predict


def _modulus(own: bool) -> Callable[[Truth, float], Prediction | None]:
    def predict(truth: Truth, part: float) -> Prediction | None:
        values = truth.at(part ** (-2 / 3))
        return None if values is None else (_scaled(values, 1.0, 1.0 if own else part ** (-1 / 3)), {})

    return predict


def _domain(sign: int) -> Callable[[Truth, float], Prediction]:
    return lambda truth, size: truth.shifted(sign * size * truth.tabor)


def _coarse(truth: Truth, part: float) -> Prediction:
    """A contact edge that is held by the nodes recedes as with more work of adhesion, by JKR's powers of it."""
    values, size = dict(truth.values), dict[str, float]()
    powers = {"load": 1.0, "approach": 2 / 3, "contact_radius": 1 / 3}
    for name, value in truth.values.items():
        power, open_ = powers.get(KINDS[name], 1.0), name.startswith(("pull_off", "jump_off"))
        change = power * part * value
        if open_ and KINDS[name] in powers and "landing" not in name and name != "pull_off_approach":
            values[name] += change
        fixed = name.startswith("jump_on_") and "landing" not in name
        size[name] = abs(change) * (RIPPLE if name in ("pull_off_load", "jump_off_approach") else 0.2 if fixed else 1.0)
        size[name] += 0.0 if fixed or name == "pull_off_load" else 0.3 * part * truth.tabor
    return values, size


def _sampled(late: bool, all_: bool) -> Callable[[Truth, float], Prediction | None]:
    """Jumps on the rows beside them, half a step from where they are, give or take its other half."""

    def predict(truth: Truth, step: float) -> Prediction | None:
        if "jump_on_approach" not in truth.values:
            return None
        values, spread = dict(truth.values), dict[str, float]()
        for name, forward in (("jump_on", 1), ("jump_off", -1)):
            values[f"{name}_approach"] += (forward if late else -forward) * step / 2
            spread[f"{name}_approach"] = step / math.sqrt(12)
            # Near a fold the load goes as the root of the distance.
            spread |= {f"{name}_{kind}": math.sqrt(step) for kind in ("load", "central_gap", "contact_radius")}
        for name in truth.values:
            if "landing" in name or name.startswith("energy"):
                spread[name] = 2 * step
        if all_:
            spread["pull_off_load"] = step**2 / truth.tabor**2
            spread |= {f"{name}_approach": step / math.sqrt(12) for name in ("pull_off", "zero_load")}
        return values, spread

    return predict


def _instead(one: float, alpha: float, reduced: float, gap: float) -> Callable[[Truth, float], Prediction]:
    def predict(truth: Truth, _: float) -> Prediction:
        values = dict(truth.values)
        for name in filter(lambda name: name.endswith("_approach"), truth.values):
            own, central = truth.values[name], truth.values[name.replace("approach", "central_gap")]
            values[name] = one + (alpha + reduced / truth.tabor) * own + gap * central
        return values, {}

    return predict


def _torn(truth: Truth, _: float) -> Prediction:
    """The contact ends at the pull-off; what it loses after that is not known."""
    torn = {name.replace("pull_off", "jump_off"): v for name, v in truth.values.items() if name.startswith("pull_off")}
    return {**truth.values, **torn}, {name: math.inf for name in truth.values if "landing" in name or "lost" in name}


def _hertz(truth: Truth, _: float) -> Prediction:
    radii = {
        name: math.sqrt(max(truth.values[name.replace("contact_radius", "approach")], 0) / truth.tabor)
        for name in truth.values
        if name.endswith("contact_radius")
    }
    return {**truth.values, **radii}, {}


def _musen(truth: Truth, _: float) -> Prediction | None:
    if not truth.problem.in_atlas:
        return None
    zero = jkr.ZERO_LOAD_RADIUS
    values = _states(truth.tabor, {"pull_off": (zero * 2 ** (-2 / 3), -1.5 * math.pi), "zero_load": (zero, 0.0)})
    return {**values, **_states(truth.tabor, dict.fromkeys(("jump_on", "jump_off"), (0.0, 0.0)))}, {}


def _states(tabor: float, found: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """Numbers of states from their radii, of which Hertz's approach follows, and their loads."""
    values = dict[str, float]()
    for name, (radius, load) in found.items():
        values |= {f"{name}_approach": tabor * radius**2, f"{name}_load": load, f"{name}_contact_radius": radius}
    return values


def _jkr(truth: Truth, _: float) -> Prediction | None:
    if not truth.problem.in_atlas:
        return None
    mu = truth.tabor
    states = {"pull_off": jkr.jkr_pull_off(mu), "jump_off": jkr.jkr_jump_off(mu), "zero_load": jkr.jkr_zero_load(mu)}
    states["jump_on_landing"] = jkr.jkr_zero_approach(mu)
    values = {"jump_on_approach": 0.0, "jump_on_load": 0.0}
    for name, state in states.items():
        values |= {f"{name}_{kind}": getattr(state, kind) for kind in ("approach", "load", "contact_radius")}
    return values, {}
