"""What may be wrong with somebody's numbers, each cause as a change of our own solution.

A variant of a cause predicts the numbers that a code with the defect gives, from those that are right. It has one free
parameter at most, a size between two positive ends. Where the defect leaves a number open, as a sampled curve its
jumps, the prediction has a spread. Quantities in R dgamma, eps and beta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

import numpy as np

from fem_adhesion.benchmark.problems import KINDS, Problem, by_atlas, events_along
from fem_adhesion.common.page import data_rows
from halfspace.atlas.series import LEAST, MOST
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.theories import closed_forms as jkr

Values = Mapping[str, float]
Prediction = tuple[Values, Values]  # values and, of those that are left open, spreads

REMEDIES: Mapping[str, str] = {row["cause"]: row["remedy"] for row in data_rows("benchmark", "remedies.csv")}
"""What to do by cause."""

CLAMPED = 0.47  # shift of the approach of a clamped block in mu |W|/L, measured on blocks of 30 and 60 beta
BOXES: Mapping[str, float] = {
    "clamped at beta/L of": CLAMPED,
    "free at beta/L of": -CLAMPED,
    "attracting no farther than beta/L of": 0.0,
}
ACTS = ("Tabor parameter", "loads", "radii", "energies")


@dataclass(frozen=True)
class Variant:
    """A cause in one of the ways in which it occurs; its parameter is between the ends, if they differ.

    A prediction is None of a problem for which it is not known at once. Of numbers in none of whose names what the
    cause `needs` is found, a regular expression, it says nothing.
    """

    cause: str
    what: str
    predict: Callable[[Problem, float], Prediction | None]
    ends: tuple[float, float] = (1.0, 1.0)
    needs: str = ""


def variants() -> Iterator[Variant]:
    """All causes in all ways, sound numbers first."""
    yield Variant("sound", "", lambda problem, _: (right(problem), {}))
    for what, shape in BOXES.items():
        yield Variant("domain-too-small", what, partial(_boxed, shape), (1e-6, 0.5))
    for sign, word in ((1, "held"), (-1, "let go")):
        yield Variant(
            "grid-too-coarse", f"a receding edge is {word} by a part of dgamma of", partial(_coarse, sign), (1e-6, 0.5)
        )
    for late, word in ((1, "after"), (-1, "before")):
        for few, which in ((True, "jumps"), (False, "all events")):
            what = f"{which} read off the row {word}, in steps of eps times"
            yield Variant("sampled-jumps", what, partial(_sampled, late, few), (1e-6, 1.0), "jump")
    for row in data_rows("benchmark", "constants.csv"):
        powers = [float(Fraction(row[name])) for name in ACTS]
        for first, _, last in (text.partition(":") for text in row["factors"].split()):
            ends = float(Fraction(first)), float(Fraction(last or first))
            acts = ", ".join(
                f"{name} by {ends[0] ** power:.3g}" for name, power in zip(ACTS, powers, strict=True) if power
            )
            yield Variant(row["cause"], "E/E* of" if last else acts, partial(_constant, powers), ends)
    for row in data_rows("benchmark", "conventions.csv"):
        parts = [float(row[name]) for name in ("one", "own", "reduced", "gap")]
        yield Variant(row["cause"], row["what"], partial(_instead, row["of"], parts), needs=f"_{row['of']}$")
    yield Variant("load-control-tear-off", "the pull-off given as the jump off", _torn, needs="jump_off")
    yield Variant("hertz-radius-in-jkr", "JKR's force with a^2 = R alpha", partial(_theory, _musen))
    yield Variant("jkr-for-intermediate", "JKR's closed forms", partial(_theory, _jkr))


def right(problem: Problem) -> dict[str, float]:
    """Our values."""
    return {name: number.value for name, number in problem.values.items()}


def _open(name: str) -> bool:
    """Whether it is of a landing, or an energy, which follow from more than the states by which a defect is known."""
    return "landing" in name or "energy" in name


def _boxed(shape: float, problem: Problem, size: float) -> Prediction:
    """A box of the size L = 1/size yields otherwise than a half-space, by shape mu W/L, and attracts no farther.

    The tension beyond L sums up to the law's energy at the gap there; the surface is taken as undeformed so far out,
    and never nearer than in equilibrium.
    """
    tabor, (approach, load, *others) = problem.scene.tabor, problem.curve
    gap = np.maximum(tabor / size**2 / 2 - approach, 0.0)
    lacking = -2 * math.pi / tabor * problem.scene.law.energy(gap, tabor)
    tilted = approach - shape * size * tabor * load
    before, yielding, both = (
        {
            f"{name}_{kind}": float(x)
            for name, state in events_along(np.array([*moved, *others])).items()
            for kind, x in zip(OBSERVABLES, state, strict=True)
        }
        for moved in ((approach, load), (tilted, load), (tilted, load + lacking))
    )
    values, spread = right(problem), dict[str, float]()
    # Pressures whose sum vanishes, spread over JKR's radius a, move the body by (a/L)^2 of what a load as large does.
    spread_out = abs(shape) * tabor * size**3 * abs(values["pull_off_load"]) * jkr.ZERO_LOAD_RADIUS**2
    for name, value in values.items():
        if math.isnan(both.get(name, math.nan) + yielding.get(name, math.nan)):
            spread[name] = math.inf if _open(name) else abs(value)
            continue
        values[name] += both[name] - before[name]
        # The surface is deformed, by a fifth of the gap at most; of a box that yields, L is not that of its width.
        spread[name] = (1 if shape else 0.2) * abs(both[name] - yielding[name])
        spread[name] += 0.02 * abs(yielding[name] - before[name]) + name.endswith("approach") * spread_out
    return values, spread


def _bend(problem: Problem) -> float:
    """Load in R dgamma above the pull-off, a distance eps from it."""
    approach, load = problem.curve[:2]
    near = np.s_[max(int(np.argmin(load)) - 3, 0) : int(np.argmin(load)) + 4]
    return float(np.polyfit(approach[near], load[near], 2)[0])


def _coarse(sign: int, problem: Problem, part: float) -> Prediction:
    """A contact edge that is held by nodes recedes as with more work of adhesion, by JKR's powers of it.

    How much more depends on where the nodes stand; the jump on, before which there is no edge, hardly changes. The
    load ripples by as much, which moves the place where it is least.
    """
    values, spread, tabor = right(problem), dict[str, float](), problem.scene.tabor
    for name, value in values.items():
        before, held = name.startswith("jump_on_") and not _open(name), name == "pull_off_load"
        spread[name] = part * (abs(value) * (0.2 if before else 0.5) + (0 if before or held else 0.5 * tabor))
    ripple = part * abs(values["pull_off_load"])
    spread["pull_off_approach"] += math.sqrt(ripple / _bend(problem))
    for name, power in (("pull_off_load", 1.0), ("jump_off_load", 1.0), ("jump_off_approach", 2 / 3)):
        if name in values:
            values[name] *= 1 + sign * power * part
    return values, spread


def _sampled(late: int, few: bool, problem: Problem, step: float) -> Prediction | None:
    """Jumps on the rows beside them, half a step from where they are, give or take its other half."""
    values = right(problem)
    if "jump_on_approach" not in values:
        return None
    spread = {name: 2 * step for name in values if _open(name)}
    # Near a fold the other numbers go as the root of the distance.
    spread |= {f"{name}_{kind}": math.sqrt(step) for name in ("jump_on", "jump_off") for kind in OBSERVABLES[1:]}
    spread |= {f"{name}_approach": step / math.sqrt(12) for name in ("jump_on", "jump_off")}
    values["jump_on_approach"] += late * step / 2
    values["jump_off_approach"] -= late * step / 2
    if not few:
        spread |= {f"{name}_approach": step / math.sqrt(12) for name in ("pull_off", "zero_load")}
        values["pull_off_load"] += (above := _bend(problem) * step**2 / 12)  # the mean, nearly the spread
        spread["pull_off_load"] = above
    return values, spread


def _constant(powers: list[float], problem: Problem, factor: float) -> Prediction | None:
    """A constant that is wrong by a factor moves the Tabor parameter, and the units of loads, radii and energies."""
    tabor, load, radius, energy = (factor**power for power in powers)
    values = right(problem)
    if tabor != 1:
        if not (problem.in_atlas and LEAST <= problem.scene.tabor * tabor <= MOST):
            return None
        values = {name: number.value for name, number in by_atlas(problem.scene.tabor * tabor).items()}
    sizes = {"load": load, "energy": energy, "contact_radius": radius}
    return {name: value * sizes.get(KINDS[name], 1.0) for name, value in values.items()}, {}


def _instead(kind: str, parts: list[float], problem: Problem, _: float) -> Prediction:
    """Numbers of a kind by another convention: so many times 1, the number, that over mu, and the central gap."""
    one, own, reduced, gap = parts
    values = right(problem)
    for name in [name for name in values if name.endswith(f"_{kind}")]:
        central = values.get(name.replace(kind, "central_gap"), math.nan) if gap else 0.0
        values[name] = one + (own + reduced / problem.scene.tabor) * values[name] + gap * central
    return values, {}


def _torn(problem: Problem, _: float) -> Prediction:
    values = right(problem)
    torn = {name.replace("pull_off", "jump_off"): v for name, v in values.items() if name.startswith("pull_off")}
    return values | torn, {name: math.inf for name in values if _open(name)}


APART = jkr.ContactState(0.0, 0.0, math.nan)  # JKR's surfaces jump on when they touch


def _musen(tabor: float) -> Mapping[str, jkr.ContactState]:
    a = jkr.ZERO_LOAD_RADIUS
    least = a * 2 ** (-2 / 3)
    states = jkr.ContactState(tabor * least**2, jkr.JKR_PULL_OFF, least), jkr.ContactState(tabor * a**2, 0.0, a)
    return {"pull_off": states[0], "zero_load": states[1], "jump_on": APART, "jump_off": APART}


def _jkr(tabor: float) -> Mapping[str, jkr.ContactState]:
    own = {"pull_off": jkr.jkr_pull_off, "zero_load": jkr.jkr_zero_load, "jump_off": jkr.jkr_jump_off}
    own["jump_on_landing"] = jkr.jkr_zero_approach
    return {"jump_on": APART, **{name: state(tabor) for name, state in own.items()}}


def _theory(states: Callable[[float], Mapping[str, jkr.ContactState]], problem: Problem, _: float) -> Prediction | None:
    if not problem.in_atlas:
        return None
    known = states(problem.scene.tabor).items()
    return {f"{name}_{kind}": value for name, state in known for kind, value in vars(state).items()}, {}
