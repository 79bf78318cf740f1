"""What a fit says and leaves open, in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fem_adhesion.common.numbers import counted, engineering, listed
from fem_adhesion.fitting.likelihood import inverse
from fem_adhesion.fitting.study import ATLAS, CLEAR, STRAYED, Fit, Value
from halfspace.atlas import sphere

LAW = (
    "The intervals are those of a paraboloid on a half-space under the 3-9 law. Data of a Morse law of the same dgamma "
    "were fitted without a misfit at a fifth of its eps and dgamma 5 % off: what eps is depends on the law. --models "
    "with another law, as morse:3, shows by how much."
)
"""What no residual shows."""

NAMES = {"work_of_adhesion": "dgamma", "spacing": "eps", "contact_point": "the contact point", "radius": "R"}
NAMES |= {"modulus": "E", "stiffness": "the stiffness", "sensitivity": "the sensitivity"}
NAMES |= {"compliance": "the compliance in series"}
MISSED = 0.1  # share of the pull-off force by which a fit misses what a curve shows best
SMALLEST = 2.3  # R/eps over tabor, of spheres of 1.5 beta, the smallest that are known
DRAWN = 2.0  # standard errors from what was given at which the fit contradicts it
KNOWN = 0.5  # half width of an interval of the logarithm from which a number counts as settled
FINER = {"noise of a third": (3.0, 1.0, 1.0), "ten times as many samples at the jumps": (1.0, 10.0, 1.0)}
"""Other measurements: how much smaller the errors of samples, of the places of jumps, and all others are."""


def sized(value: float, unit: str) -> str:
    """Number with its unit."""
    return engineering(value, unit) if unit and value else f"{value:.4g}"


def interval(value: Value) -> str:
    """Interval in words."""
    low, high = (None if end is None else sized(end, value.unit) for end in (value.low, value.high))
    if low and high:
        return f"{low} to {high}"
    return f"above {low}" if low else f"below {high}" if high else "any"


def warnings(fit: Fit) -> Iterator[str]:
    """What forbids to take the numbers as they stand."""
    yield from _misfit(fit)
    yield from _models(fit)
    yield from _sphere(fit)
    yield from _untested(fit)
    for name, reason in fit.unsolved.items():
        yield f"{name} was not fitted: {reason}."
    yield LAW
    for name, value in fit.values.items():
        if not value.identified:
            yield open_end(fit, name, value)


def _misfit(fit: Fit) -> Iterator[str]:
    """Where the fit and the curve, or what was known before, are apart."""
    best = fit.best
    if fit.misfit:
        worst = max(fit.branches, key=lambda part: part.mean_square)
        times = math.sqrt(best.chi2 / best.degrees)
        where = f"most on the {worst.branch} branch of the {worst.segment}" if worst.branch != "both" else worst.segment
        yield (
            f"The atlas does not fit: its residuals are {times:.2g} times the noise of the baseline or not random, "
            f"{where}. The intervals are widened by that factor, and hold the truth only as far as the model does."
        )
        held = [
            name for name in ("sensitivity", "compliance", "stiffness", "radius") if name not in best.problem.fitted
        ]
        if held:
            yield f"Held as given: {listed([NAMES[name] for name in held])}; free what is not known for certain."
    pull_off, data = -float(best.problem.branches(best.apparatus).contact[1].min()), fit.prepared.pull_off
    if abs(pull_off - data) > max(MISSED * data, 5 * fit.prepared.noise):
        yield (
            f"The fitted contact pulls off at {engineering(pull_off, 'N')}, the curve at {engineering(data, 'N')}: "
            f"its dgamma is not that of the pull-off."
        )
    for name in best.problem.held:
        yield (
            f"The fit would take {NAMES[name]} more than {STRAYED:g} standard errors from what was given, as that "
            "makes up for what the model lacks; it was held, and its error is in the interval of dgamma."
        )
    for name, given in best.problem.prior.items():
        off = abs(best.problem.departure(name, fit.values[name].value))
        if off > DRAWN:
            was = sized(given.value, fit.values[name].unit)
            yield f"{NAMES[name]} ended {off:.2g} standard errors from the {was} that was given."


def _models(fit: Fit) -> Iterator[str]:
    """Where models disagree."""
    work, first = fit.values["work_of_adhesion"], fit.candidates[0]
    own = next(one for one in fit.candidates if one.name == ATLAS)
    if own.criterion - first.criterion > CLEAR:
        spread = abs(math.log(first.values["work_of_adhesion"].value / work.value))
        yield (
            f"{first.name} fits better than the atlas, by {own.criterion - first.criterion:.3g} in Akaike's criterion; "
            f"its dgamma differs by {100 * spread:.2g} %."
        )
    for one in fit.candidates:
        found = one.values["work_of_adhesion"].value
        is_like = one.criterion - first.criterion < CLEAR and one is not own
        if is_like and not (work.low or 0.0) <= found <= (work.high or math.inf):
            yield (
                f"{one.name} fits alike with dgamma = {sized(found, work.unit)}, outside the interval: the curve does "
                "not tell the two apart, and dgamma is as uncertain as they differ."
            )


def _sphere(fit: Fit) -> Iterator[str]:
    """What dgamma would be of a finite sphere, which no residual shows either, where that is outside the interval."""
    units, value = fit.best.apparatus.units, fit.values["work_of_adhesion"]
    tabor = float(np.clip(units.tabor, *sphere.TABORS))
    ratio = float(np.clip(units.radius / units.spacing, max(sphere.RATIOS[0], SMALLEST * tabor), sphere.RATIOS[-1]))
    share = float(sphere.pull_off(tabor, ratio, min(fit.best.apparatus.poisson, sphere.POISSON[1])).load_ratio)
    if not (value.low or 0.0) <= value.value / share <= (value.high or math.inf):
        yield (
            f"A whole sphere of R/eps = {units.radius / units.spacing:.3g} pulls off at {share:.3g} of the force of a "
            f"paraboloid on a half-space, which is fitted: its dgamma is near {sized(value.value / share, value.unit)}."
        )


def _untested(fit: Fit) -> Iterator[str]:
    """That the modulus is taken on trust, where the curve would hardly tell it, by the curvature."""
    best, problem = fit.best, fit.best.problem
    if "modulus" in problem.fitted:
        return
    freed = replace(problem, start=best.apparatus, fitted=(*problem.fitted, "modulus"))
    x = np.zeros(len(freed.fitted))
    half = replace(best, problem=freed, x=x, jacobian=freed.jacobian(x)).half_width("modulus")
    if half > KNOWN:
        yield (
            "The curve does not test the modulus, which it would leave open by a factor of "
            f"{math.exp(min(half, 7.0)):.2g}: a layer under the surface, or another modulus, changes dgamma and eps "
            "and shows in no residual."
        )


def open_end(fit: Fit, name: str, value: Value) -> str:
    """What the curve says of a number that it does not identify, and why."""
    hidden = [
        text
        for text, jump in (("on", fit.prepared.jump_on), ("off", fit.prepared.jump_off))
        if jump is None and name == "spacing"
    ]
    why = f"The jump {' and the jump '.join(hidden)} is inside the noise: " if hidden else ""
    low, high = value.low, value.high
    if low is None and high is None:
        return f"{why}{NAMES[name]} is not identified at all."
    bound, side, end = ("above", "below", high) if low is None else ("below", "above", low)
    return f"{why}{NAMES[name]} is bounded {bound} only: {side} {sized(end or 0.0, value.unit)} at 95 %."


def comparison(fit: Fit) -> str:
    """Which model the data prefer, and by how much."""
    first, *others = fit.candidates
    alike = [one.name for one in others if one.criterion - first.criterion < CLEAR]
    worse = [one for one in others if one.criterion - first.criterion >= CLEAR]
    parts = [f"{first.name} and {listed(alike)} fit alike" if alike else f"{first.name} fits best"]
    parts += [f"{one.name} is worse by {one.criterion - first.criterion:.3g}" for one in worse]
    return f"{'; '.join(parts)} (Akaike's criterion; from {CLEAR:g} on a model is clearly worse)."


def remedies(fit: Fit) -> Iterator[str]:
    """For each number that is not identified, the measurements that would settle it, by the curvature at its end."""
    for name, value in fit.values.items():
        end = value.high if value.low is None else value.low
        if value.identified or end is None or name not in ("spacing", *fit.best.problem.fitted):
            continue
        at = min(fit.profile.fits, key=lambda one: abs(math.log(getattr(one.apparatus, name) / end)))
        helps = [what for what, sharper in FINER.items() if at.half_width(name, np.repeat(sharper, at.counts)) < KNOWN]
        others = [each for each in at.problem.fitted[2:] if each != name]
        helps += [f"{NAMES[each]} measured apart" for each in others if at.half_width(name, exact=each) < KNOWN]
        shown = sized(end, value.unit)
        if helps:
            yield f"If {NAMES[name]} is near {shown}, {' or '.join(helps)} would settle it."
        else:
            yield (
                f"Neither {' nor '.join(FINER)} would settle {NAMES[name]} if it is near {shown}; a stiffer spring, on "
                "which the attraction can be followed before the jump, would."
            )


def series(fit: Fit) -> Iterator[str]:
    """What an unknown sensitivity or compliance in series does to the work of adhesion."""
    covariance = inverse(fit.best.whole)
    for name in ("sensitivity", "compliance"):
        if name not in fit.best.problem.fitted:
            continue
        i, j = (fit.best.problem.fitted.index(each) for each in ("work_of_adhesion", name))
        correlation = covariance[i, j] / math.sqrt(covariance[i, i] * covariance[j, j])
        moved = 100 * math.sqrt(fit.best.scale) * covariance[i, j] / math.sqrt(covariance[j, j])
        by = f"one standard error more of {NAMES[name]} goes with {moved:+.2g} % of dgamma"
        yield f"dgamma and {NAMES[name]} are fitted together, correlation {correlation:+.2f}: {by}."


def counted_samples(fit: Fit) -> str:
    """How much was fitted."""
    data = fit.best.problem.data
    jumps = listed([f"jump {('on', 'off')[place.segment]}" for place in data.places]) or "no jump"
    noise = f"noise {engineering(data.noise, 'N')}, correlation {data.correlation:.2f}"
    return f"{counted(data.travel.size, 'sample')}, {jumps}; {noise}"
