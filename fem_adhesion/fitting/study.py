"""The fit of a measured curve: start, best values, intervals, and other models beside the atlas."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.stats import chi2, norm

from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting.inference import LEVEL, SCALES, Best, Data, Place, Problem, Run
from fem_adhesion.fitting.measured import APPROACH, BASE, ForceCurve, read
from fem_adhesion.fitting.model import SOFTEST, THEORIES, Apparatus, Other
from fem_adhesion.fitting.prepare import Prepared, prepare
from halfspace.atlas.series import LEAST
from halfspace.errors import InputError
from halfspace.limits import require_one_of, require_poisson
from halfspace.values import Array

TABORS = np.geomspace(LEAST, SOFTEST, 13)  # from which fits start; three times the next
NEARLY = 1.1  # chi square, in the least of those at fixed Tabor parameters, up to which a free fit starts from there
SOFT = 20.0  # Tabor parameter from which on fits end in JKR's, wherever they start
FAR_OFF = 3.0  # times the measured pull-off force that a fit's may be
STRAYED = 5.0  # standard errors from what was known at which a quantity makes up for a wrong model, and is held
COARSE = 3  # every third serves the models beside the atlas, which end anywhere
ATLAS = "atlas"
UNITS: Mapping[str, str] = {
    "work_of_adhesion": "J/m^2",
    "spacing": "m",
    "contact_point": "m",
    "radius": "m",
    "modulus": "Pa",
    "stiffness": "N/m",
    "sensitivity": "",
    "compliance": "m/N",
}
"""Parameters and their units in SI."""
RANGE = 7.0  # coordinates to which an end is looked for: a factor of a thousand
EXACT = float(norm.isf((1 - LEVEL) / 2))  # standard errors in half an interval
NORMAL = float(norm.isf(0.25))  # median size of a normal error, in its standard deviation
WIDER = 1.24  # ends of a pair's contour, in those of one of them: the root of both quantiles' ratio
WHITE = 1e-3  # chance below which residuals are no noise


@dataclass(frozen=True)
class Value:
    """A fitted quantity in SI, with the ends of its interval at 95 %; an end that the curve leaves open is None."""

    value: float
    low: float | None
    high: float | None
    unit: str

    @property
    def identified(self) -> bool:
        """Whether both ends are known."""
        return self.low is not None and self.high is not None


@dataclass(frozen=True)
class Candidate:
    """A model that was fitted beside the others.

    Attributes
    ----------
    chi2 : float
        Sum of the squared residuals in standard deviations of the noise.
    criterion : float
        Akaike's, chi2 + 2 x parameters, over `Best.scale` of the best model: less by 2 is e times as likely.
    """

    name: str
    chi2: float
    parameters: int
    criterion: float
    apparatus: Apparatus


@dataclass(frozen=True)
class Branch:
    """Residuals on a branch: samples, mean square in those of the noise, and the chance of so few runs of one sign."""

    segment: str
    branch: str
    samples: int
    mean_square: float
    chance: float


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted curve.

    Attributes
    ----------
    prepared : Prepared
        The curve and what was found in it without a model.
    values : mapping of str to Value
        Work of adhesion, spacing, contact point and what else was fitted.
    best : Best
        The fit itself: its problem with data and theory, coordinates, Jacobian.
    candidates : tuple of Candidate
        All models, the most likely first.
    branches : tuple of Branch
        Residuals by branch.
    """

    prepared: Prepared
    values: Mapping[str, Value]
    best: Best
    candidates: tuple[Candidate, ...]
    branches: tuple[Branch, ...]

    @property
    def model(self) -> str:
        """The most likely model."""
        return self.candidates[0].name

    @cached_property
    def contour(self) -> Array:
        """Contour (2, n) of work of adhesion and spacing at 95 %, in SI, computed when asked for."""
        problem, spacing = self.best.problem, self.values["spacing"]
        middle = problem.coordinate("spacing", spacing.value)
        low, high = (
            limit if end is None else middle + WIDER * (problem.coordinate("spacing", end) - middle)
            for limit, end in zip(_limits(self.best), (spacing.low, spacing.high), strict=True)
        )
        names = "work_of_adhesion", "spacing"
        contour = self.best.contour(names, (min(low, middle), max(high, middle)))
        return np.array([[problem.value(name, x) for x in row] for name, row in zip(names, contour, strict=True)])

    @property
    def misfit(self) -> bool:
        """Whether the residuals are more than the noise."""
        data = self.best.problem.data
        known = data.travel.size / 2 * (1 - data.correlation**2) / (1 + data.correlation**2)  # samples of the baseline
        most = 1 + norm.isf(WHITE) * math.sqrt(2 / self.best.degrees + 2 / known)
        loud = self.best.chi2 / self.best.degrees > most
        return bool(loud or any(part.chance < WHITE / len(self.branches) for part in self.branches))


def fit(
    curve: ForceCurve | Path | str,
    *,
    radius: float | Measured,
    modulus: float | Measured,
    poisson: float,
    stiffness: float | Measured | None = None,
    sensitivity: float | Measured = 1.0,
    compliance: float | Measured = 0.0,
    counter_modulus: float | None = None,
    counter_poisson: float | None = None,
    counter_radius: float | None = None,
    models: Sequence[str] = ("maugis-dugdale", "jkr", "dmt"),
) -> Fit:
    """Fit work of adhesion and spacing to a measured curve, as an apparatus records the contact.

    Parameters
    ----------
    curve : ForceCurve or path
        As `fem_adhesion.fitting.measured.read` gives it, or its file.
    radius, modulus, stiffness, sensitivity, compliance : float or Measured
        Sphere's radius in m and Young's modulus in Pa, spring constant in N/m, true deflection over the recorded one,
        and what else yields in series in m/N. Each exact, with a standard error, or free (an infinite one).
    poisson : float
        Poisson's ratio of the sphere.
    counter_modulus, counter_poisson, counter_radius : float, optional
        Those of the other body, which is rigid and flat unless given.
    models : sequence of str
        Fitted beside the atlas: names in `fem_adhesion.fitting.model.THEORIES`.

    Raises
    ------
    InputError
        If the curve cannot be used, or a quantity is out of range or missing.
    """
    nominal = stiffness.value if isinstance(stiffness, Measured) else stiffness
    if not isinstance(curve, ForceCurve):
        curve = read(Path(curve), stiffness=nominal)
    if stiffness is None:
        stiffness = curve.stiffness
    if stiffness is None:
        raise InputError("stiffness = None, limit: a spring; give it, as 0.2N/m")
    named = {"radius": radius, "modulus": modulus, "stiffness": stiffness}
    named |= {"sensitivity": sensitivity, "compliance": compliance}
    given = {name: each if isinstance(each, Measured) else Measured(each) for name, each in named.items()}
    if (counter_modulus is None) != (counter_poisson is None):
        raise InputError("counter_modulus without counter_poisson, limit: both or none; give the other too")
    other = Other(
        require_poisson(poisson),
        math.inf if counter_modulus is None else counter_modulus,
        0.0 if counter_poisson is None else counter_poisson,
        math.inf if counter_radius is None else counter_radius,
    )
    for name in models:
        require_one_of(name, "model", tuple(THEORIES))
    prepared = prepare(curve)
    every = {name: best_of(name, prepared, given, other) for name in dict.fromkeys((ATLAS, *models))}
    found = {name: best for name, (best, *_) in every.items()}
    best, *others = every[ATLAS]
    values = _values(best, others)
    return Fit(prepared, values, best, _candidates(found), _branches(best))


def data_of(prepared: Prepared, stiffness: float) -> Data:
    """Samples by branch, with the places of the jumps that were found.

    The base is anywhere between the samples before and after a jump: uniform, of that width over sqrt(12).
    """
    curve = prepared.curve
    travel = curve.travel + (curve.force - prepared.background) / stiffness * (curve.coordinate == APPROACH)
    runs, places = list[Run](), list[Place]()
    segments = (curve.approach, prepared.jump_on, "on"), (curve.retract, prepared.jump_off, "off")
    for segment, (samples, jump, name) in enumerate(segments):
        if jump is None:
            runs.append(Run(segment, "both", samples))
            continue
        order = ("contact", "separated") if segment else ("separated", "contact")
        parts = slice(samples.start, jump.last + 1), slice(jump.first, samples.stop)
        runs += [Run(segment, branch, part) for branch, part in zip(order, parts, strict=True)]
        ends = travel[[jump.last, jump.first]]
        step = float(np.median(np.abs(np.diff(travel[parts[0]]))))
        places.append(Place(name, float(ends.mean()), max(step, abs(float(np.diff(ends)[0]))) / math.sqrt(12)))
    noise = max(prepared.noise, 1e-6 * prepared.pull_off)  # a curve without noise is one of a millionth
    degree = 2 if any(line.curvature for line in prepared.baseline.values()) else 1
    steady = np.diff(curve.travel[curve.approach], 2)  # of a steady travel these are its errors' alone
    jitter = float(np.median(np.abs(steady))) / NORMAL / math.sqrt(6)
    periods = tuple(line.period if line.amplitude else 0.0 for line in prepared.baseline.values())
    forms = degree, jitter, periods, prepared.contact
    return Data(travel, curve.force, tuple(runs), tuple(places), noise, prepared.correlation, *forms)


def best_of(
    name: str, prepared: Prepared, given: Mapping[str, Measured], other: Other, held: Sequence[str] = ()
) -> list[Best]:
    """Best fit of a model, then all others, which start at Tabor parameters; JKR's has no spacing to fit.

    Quantities that stray from what is known are held there: thousands of residuals of a wrong model outweigh it.
    """
    found = _fits(name, prepared, given, other, held)
    problem, apparatus = found[0].problem, found[0].apparatus
    known = [key for key in problem.prior if key in SCALES]
    strayed = [key for key in known if abs(problem.departure(key, getattr(apparatus, key))) > STRAYED]
    return best_of(name, prepared, given, other, (*held, *strayed)) if strayed else found


def _fits(
    name: str, prepared: Prepared, given: Mapping[str, Measured], other: Other, held: Sequence[str]
) -> list[Best]:
    prior = {key: each for key, each in given.items() if 0 < each.deviation < math.inf}
    moved = tuple(key for key, each in given.items() if each.deviation > 0 and key not in held)
    nominal = given["stiffness"].value if prepared.curve.deflection_given else None
    data = data_of(prepared, given["stiffness"].value)
    start = {key: each.value for key, each in given.items()}
    if math.isinf(given["modulus"].deviation):
        start["modulus"] = _hertz(prepared, start, other)
    work = prepared.pull_off * start["sensitivity"] / (1.75 * math.pi * start["radius"])
    fitted = ("work_of_adhesion", "contact_point", *moved)
    found = list[Best]()
    starts = TABORS if name == ATLAS else TABORS[-1::-COARSE][: 1 if name == "jkr" else None]
    for tabor in starts:
        apparatus = Apparatus(**start, work_of_adhesion=work, spacing=1.0, contact_point=0.0)
        spacing = other.units(apparatus).tabor / float(tabor)
        problem = Problem(THEORIES[name], other, data, replace(apparatus, spacing=spacing), fitted, prior, nominal)
        problem = replace(problem, start=replace(problem.start, contact_point=_first_contact(problem, prepared)))
        found.append(problem.settled(np.zeros(len(fitted)), loose=True))
    found = [one for one in found if _has_pull_off(one, prepared)] or found
    found.sort(key=lambda one: one.chi2)
    if name == "jkr":
        return found
    free = list[Best]()
    near = [one for one in found[1:] if one.chi2 < NEARLY * found[0].chi2 and _tabor(one) < SOFT]
    for one in [found[0], *(near if name == ATLAS else [])]:
        named = ("work_of_adhesion", "spacing", *fitted[1:])
        free.append(replace(one.asked, start=one.apparatus, fitted=named).settled(np.zeros(len(named))))
    return sorted([*free, *found], key=lambda one: (one not in free, one.chi2))


def _tabor(one: Best) -> float:
    return one.problem.other.units(one.apparatus).tabor


def _has_pull_off(one: Best, prepared: Prepared) -> bool:
    """Whether a fit's pull-off force is near the measured one: a contact point far off makes a minimum without."""
    load = one.problem.other.units(one.apparatus).load / one.apparatus.sensitivity
    return 1 / FAR_OFF < load * 1.75 * math.pi / prepared.pull_off < FAR_OFF


def _hertz(prepared: Prepared, start: Mapping[str, float], other: Other) -> float:
    """Modulus by Hertz's indentation at the largest force; that of the start if the spring takes all of the travel."""
    curve = prepared.curve
    force = float(np.max((curve.force - prepared.background)[curve.approach])) * start["sensitivity"]
    bent = force / start["stiffness"] if curve.coordinate == BASE else 0.0
    depth = float(curve.travel.max()) - prepared.contact - bent
    if depth <= 0:
        return start["modulus"]
    return 0.75 * force / math.sqrt(start["radius"] * depth**3) * (1 - other.poisson**2)


def _first_contact(problem: Problem, prepared: Prepared) -> float:
    """Contact point at which the model's jumps are where the data's are; without any, as its force says."""
    found = problem.branches(problem.start)
    if problem.data.places:
        return float(np.mean([at.travel - found.place(int(at.jump == "off")) for at in problem.data.places]))
    base, force = found.contact
    least = int(np.argmin(force))
    return prepared.contact - float(np.interp(0.0, force[least:], base[least:]))


def _values(best: Best, others: Sequence[Best]) -> dict[str, Value]:
    """Values with intervals in SI."""
    problem, found = best.problem, dict[str, Value]()
    for i, name in enumerate(problem.fitted):
        at, error = float(best.x[i]), EXACT * best.error(name)
        ends: tuple[float | None, float | None] = (at - error, at + error)
        if name == "spacing":
            ends = best.interval(name, _limits(best), others)
        elif name != "contact_point":  # a nuisance, for which the curvature will do
            ends = best.interval(name, (at - RANGE, at + RANGE), others)
        low, high = (None if end is None else problem.value(name, end) for end in ends)
        found[name] = Value(getattr(best.apparatus, name), low, high, UNITS[name])
    for name in problem.held:
        value, relative = problem.prior[name].value, problem.prior[name].deviation / problem.prior[name].value
        found[name] = Value(value, *_widened(value, value, value, relative), UNITS[name])
        work = found["work_of_adhesion"]
        low, high = _widened(work.value, work.low, work.high, relative)
        found["work_of_adhesion"] = replace(work, low=low, high=high)
    return found


def _widened(value: float, low: float | None, high: float | None, relative: float) -> tuple[float | None, float | None]:
    """Ends of an interval with an independent relative error more, in the logarithm."""
    ends = (
        end and value * math.exp(side * math.hypot(math.log(end / value), EXACT * relative))
        for side, end in ((-1, low), (1, high))
    )
    return next(ends), next(ends)


def _limits(best: Best) -> tuple[float, float]:
    """Coordinates of the spacings of the softest and the stiffest contact, beyond which no curve changes."""
    length = best.problem.other.units(best.apparatus).displacement
    softest, stiffest = (best.problem.coordinate("spacing", length / float(tabor)) for tabor in TABORS[[-1, 0]])
    return softest, stiffest


def _candidates(found: Mapping[str, Best]) -> tuple[Candidate, ...]:
    """Models by their criterion, on the noise that the best of them leaves."""
    scale = min(best.scale for best in found.values())
    made = [
        Candidate(name, best.chi2, best.x.size, best.chi2 / scale + 2 * best.x.size, best.apparatus)
        for name, best in found.items()
    ]
    return tuple(sorted(made, key=lambda one: one.criterion))


def _branches(best: Best) -> tuple[Branch, ...]:
    """Mean square of the residuals and their runs of one sign (Wald & Wolfowitz), branch by branch."""
    data, residuals, made = best.problem.data, best.problem.residuals(best.x), list[Branch]()
    for run in data.runs:
        count = data.travel[run.samples].size
        own, residuals = residuals[:count], residuals[count:]
        made.append(
            Branch(("approach", "retract")[run.segment], run.branch, count, float(np.mean(own**2)), _chance(own))
        )
    return tuple(made)


def _chance(residuals: Array) -> float:
    """Chance of so few runs of one sign in noise; 1 for a handful of samples."""
    above = residuals > 0
    n, m = int(above.sum()), int((~above).sum())
    if min(n, m) < 10:
        return float(chi2.sf(np.sum(residuals**2), residuals.size))
    mean = 2 * n * m / (n + m) + 1
    spread = math.sqrt((mean - 1) * (mean - 2) / (n + m - 1))
    runs = 1 + int(np.sum(above[1:] != above[:-1]))
    return float(norm.cdf((runs - mean) / spread))
