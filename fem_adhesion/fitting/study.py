"""The fit of a measured curve: start, best values, intervals, and other models beside the atlas."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.stats import chi2, norm

from fem_adhesion.common.jobs import Progress, in_turn, unheard
from fem_adhesion.common.numbers import Measured
from fem_adhesion.common.scene_options import ATOM
from fem_adhesion.fitting.data import ORDER, Data, Place, Run
from fem_adhesion.fitting.likelihood import MEAN_PULL_OFF, NORMAL, SCALES, Best, Problem
from fem_adhesion.fitting.measured import APPROACH, BASE, ForceCurve, read
from fem_adhesion.fitting.model import SOFTEST, STIFFEST, THEORIES, Apparatus, Theory, by_atlas, by_jkr
from fem_adhesion.fitting.prepare import Prepared, prepare
from fem_adhesion.fitting.profile import Profile, profiled
from fem_adhesion.fitting.traced import Traced
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.errors import InputError, Unsolved, tried
from halfspace.limits import require_poisson
from halfspace.values import Array

TABORS = tuple(np.geomspace(STIFFEST, SOFTEST, 17))  # of first fits: tenfold steps lost 8 minima of 200 curves
TRACED = STIFFEST, 100.0  # least and largest Tabor parameter to which traced models are followed
STRAYED = 5.0  # standard errors from what was known at which a quantity makes up for a wrong model, and is held
CLEAR = 6.0  # difference of Akaike's criterion from which one model is clearly preferred: a likelihood ratio of 20
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
LIMITS = {"sensitivity": (0.1, 10.0), "radius": (ATOM, math.inf)}  # others: positive; a unit may be wrong
MEDIAN = float(norm.isf(0.25))  # size of a normal error, in its standard deviation
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
    values : mapping of str to Value
        Work of adhesion, spacing and what else was fitted.
    """

    name: str
    chi2: float
    criterion: float
    values: Mapping[str, Value]


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
    profile : Profile
        The fits of the atlas at each Tabor parameter that is likely, with their problems, coordinates, Jacobians.
    candidates : tuple of Candidate
        All models, the most likely first.
    branches : tuple of Branch
        Residuals by branch.
    unsolved : mapping of str to str
        Why a model could not be fitted.
    """

    prepared: Prepared
    values: Mapping[str, Value]
    profile: Profile
    candidates: tuple[Candidate, ...]
    branches: tuple[Branch, ...]
    unsolved: Mapping[str, str]

    @property
    def model(self) -> str:
        """The most likely model."""
        return self.candidates[0].name

    @property
    def best(self) -> Best:
        """The fit of the atlas: its problem with data and theory, coordinates, Jacobian."""
        return self.profile.best

    @cached_property
    def contour(self) -> Array:
        """Contour (2, n) of work of adhesion and spacing at 95 %, in SI, computed when asked for."""
        return self.profile.contour()

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
    progress: Progress = unheard,
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
        Fitted beside the atlas: names in `fem_adhesion.fitting.model.THEORIES`, or a law, a profile or a body in one
        word, as `morse:3`, whose curves are traced at some twenty Tabor parameters.
    progress : callable
        Called with the model under way, how many are done, and of how many.

    Raises
    ------
    InputError
        If the curve cannot be used, or a quantity is out of range or missing.
    """
    nominal = stiffness.value if isinstance(stiffness, Measured) else stiffness
    if not isinstance(curve, ForceCurve):
        curve = read(Path(curve), stiffness=nominal)
    stiffness = curve.stiffness if stiffness is None else stiffness
    if stiffness is None:
        raise InputError("stiffness = None, limit: a spring; give it, as 0.2N/m")
    named = {"radius": radius, "modulus": modulus, "stiffness": stiffness}
    named |= {"sensitivity": sensitivity, "compliance": compliance}
    given = {name: each if isinstance(each, Measured) else Measured(each) for name, each in named.items()}
    for name, one in given.items():
        least, most = LIMITS.get(name, (0.0, math.inf))
        if not (least < one.value < most or (name == "compliance" and one.value == 0)):
            raise InputError(f"{name} = {one.value:g} is outside {least:g} < {name} < {most:g}; check its unit")
    if (counter_modulus is None) != (counter_poisson is None):
        raise InputError("counter_modulus without counter_poisson, limit: both or none; give the other too")
    counter = {"counter_modulus": counter_modulus, "counter_poisson": counter_poisson, "counter_radius": counter_radius}
    still = {"poisson": require_poisson(poisson)} | {name: one for name, one in counter.items() if one is not None}
    for name in models:
        if name not in THEORIES:
            Traced(name, poisson).require(given["radius"].value, counter=counter_modulus or counter_radius)
    prepared = prepare(curve)
    loads = 2 * MEAN_PULL_OFF * float(np.max(curve.force - prepared.background)) / prepared.pull_off
    named_models = {
        name: THEORIES.get(name) or Traced(name, poisson, max(loads, COMPRESSION)) for name in (ATLAS, *models)
    }
    found, unsolved = _profiles(_problem(prepared, given, still), named_models, in_turn(progress, len(named_models)))
    atlas = found[ATLAS]
    return Fit(prepared, values_of(atlas), atlas, _candidates(found), _branches(atlas.best), unsolved)


def _profiles(
    problem: Problem, theories: Mapping[str, Theory], begin: Callable[[str], None]
) -> tuple[dict[str, Profile], dict[str, str]]:
    """Profiles of the models, that of the atlas first, and why others have none."""
    found, unsolved = dict[str, Profile](), dict[str, str]()
    for name, theory in theories.items():
        begin(name)
        profile = tried(profile_of, replace(problem, theory=theory), *_starts(theory, found), refusals=True)
        if not isinstance(profile, Unsolved):
            found[name] = profile
        elif theory is by_atlas:
            raise InputError(f"the atlas cannot be fitted to this curve: {profile.reason}")
        else:
            unsolved[name] = profile.reason
    return found, unsolved


def _starts(theory: Theory, found: Mapping[str, Profile]) -> tuple[Sequence[float], tuple[float, float]]:
    """Tabor parameters from which a model's fits start, and the limits to which they go."""
    if isinstance(theory, Traced):
        return [float(np.clip(found[ATLAS].best.tabor, *TRACED))], TRACED
    tabors = TABORS if theory is by_atlas else TABORS[-1:] if theory is by_jkr else TABORS[::2]
    return tabors, (tabors[0], tabors[-1])


def data_of(prepared: Prepared, stiffness: float) -> Data:
    """Samples by branch, with the places of the jumps that were found.

    The base is anywhere between the samples before and after a jump: uniform, of that width over sqrt(12).
    """
    curve = prepared.curve
    travel = curve.travel + (curve.force - prepared.background) / stiffness * (curve.coordinate == APPROACH)
    runs, places = list[Run](), list[Place]()
    segments = (curve.approach, prepared.jump_on), (curve.retract, prepared.jump_off)
    for segment, (samples, jump) in enumerate(segments):
        if jump is None:
            runs.append(Run(segment, "both", samples))
            continue
        parts = slice(samples.start, jump.start + 1), slice(jump.stop, samples.stop)
        runs += [Run(segment, branch, part) for branch, part in zip(ORDER[segment], parts, strict=True)]
        ends = travel[[jump.start, jump.stop]]
        step = float(np.median(np.abs(np.diff(travel[parts[0]]))))
        places.append(Place(segment, float(ends.mean()), max(step, abs(float(np.diff(ends)[0]))) / math.sqrt(12)))
    noise = max(prepared.noise, 1e-6 * prepared.pull_off)  # a curve without noise is one of a millionth
    degree = max(far.line.degree() for far in prepared.baseline.values())
    steady = np.diff(curve.travel[curve.approach], 2)  # of a steady travel these are its errors' alone
    jitter = float(np.median(np.abs(steady))) / MEDIAN / math.sqrt(6)
    periods = tuple(far.period for far in prepared.baseline.values())
    forms = degree, jitter, periods, prepared.contact
    return Data(travel, curve.force, tuple(runs), tuple(places), noise, prepared.correlation, *forms)


def _problem(prepared: Prepared, given: Mapping[str, Measured], still: Mapping[str, float]) -> Problem:
    """Likelihood by the atlas, from which others differ by the theory; `still` is what is known of the bodies."""
    start = {name: each.value for name, each in given.items()}
    if math.isinf(given["modulus"].deviation):
        start["modulus"] = _hertz(prepared, start, still["poisson"])
    work = prepared.pull_off * start["sensitivity"] / (MEAN_PULL_OFF * start["radius"])
    return Problem(
        by_atlas,
        data_of(prepared, given["stiffness"].value),
        Apparatus(**start, **still, work_of_adhesion=work, spacing=1.0, contact_point=prepared.contact),
        ("work_of_adhesion", "contact_point", *(name for name, each in given.items() if each.deviation > 0)),
        {name: each for name, each in given.items() if 0 < each.deviation < math.inf},
        prepared.pull_off,
        given["stiffness"].value if prepared.curve.deflection_given else None,
    )


def profile_of(problem: Problem, tabors: Sequence[float], limits: tuple[float, float]) -> Profile:
    """Profile of a model, started from Tabor parameters.

    Quantities that stray from what is known are held there: thousands of residuals of a wrong model outweigh it.
    """
    found = profiled(problem, tabors, limits)
    known = problem.prior.keys() & {*SCALES} & {*problem.fitted}
    strayed = {name for name in known if abs(problem.departure(name, getattr(found.best.apparatus, name))) > STRAYED}
    if not strayed:
        return found
    kept = tuple(name for name in problem.fitted if name not in strayed)
    return profile_of(replace(problem, fitted=kept), tabors, limits)


def _hertz(prepared: Prepared, start: Mapping[str, float], poisson: float) -> float:
    """Modulus by Hertz's indentation at the largest force; that of the start if the spring takes all of the travel."""
    curve = prepared.curve
    force = float(np.max((curve.force - prepared.background)[curve.approach])) * start["sensitivity"]
    bent = force / start["stiffness"] if curve.coordinate == BASE else 0.0
    depth = float(curve.travel.max()) - prepared.contact - bent
    if depth <= 0:
        return start["modulus"]
    return 0.75 * force / math.sqrt(start["radius"] * depth**3) * (1 - poisson**2)


def values_of(profile: Profile) -> dict[str, Value]:
    """Values with intervals in SI; JKR's theory has no spacing."""
    best, problem = profile.best, profile.best.problem
    spacing = () if problem.theory is by_jkr else ("spacing",)
    names = ("work_of_adhesion", *spacing, *problem.fitted[1:])
    found = {name: Value(getattr(best.apparatus, name), *profile.interval(name), UNITS[name]) for name in names}
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
        end and value * math.exp(side * math.hypot(math.log(end / value), NORMAL * relative))
        for side, end in ((-1, low), (1, high))
    )
    return next(ends), next(ends)


def _candidates(found: Mapping[str, Profile]) -> tuple[Candidate, ...]:
    """Models by their criterion, on the noise that the best of them leaves."""
    scale = min(profile.best.scale for profile in found.values())
    made = []
    for name, profile in found.items():
        values, chi2 = values_of(profile), profile.best.chi2
        made.append(Candidate(name, chi2, chi2 / scale + 2 * profile.best.parameters, values))
    return tuple(sorted(made, key=lambda one: one.criterion))


def _branches(best: Best) -> tuple[Branch, ...]:
    """Mean square of the residuals and their runs of one sign (Wald & Wolfowitz), branch by branch."""
    return tuple(
        Branch(("approach", "retract")[run.segment], run.branch, own.size, float(np.mean(own**2)), _chance(own))
        for run, own in best.residuals()
    )


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
