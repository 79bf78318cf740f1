"""Error against wall time of every method in the house, at one Tabor parameter: rungs of ladders, and figures of merit.

Each method climbs a ladder of resolutions; a rung is timed from the set-up to the events. Its errors are those of three
quantities against the tightest solution of the other family: no elasticity is judged by itself. Which rungs are climbed
is a matter of the ladders alone, so it is the same on every machine; time is only reported. How the time of the solvers
with error control grows with what is asked of them is measured beside it.

Cells are graded towards the contact edge, whose spike is as wide as 1/mu^2: their number grows as ln(mu), where that of
a uniform grid grows as mu^2 and more. So no power of mu or R/eps is expected, but those of logarithms. Each digit asks
for a degree more: the half-space has then so many more unknowns, whose dense factors cost their third power, and a cell
of finite elements of degree p has p^2 inside, whose elimination costs p^6.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal

import numpy as np
from scipy.linalg.lapack import dgesv

import halfspace
from fem_adhesion import convergence
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.common.facts import with_peak_memory
from fem_adhesion.common.jobs import Progress, unheard
from fem_adhesion.scene import Scene
from fem_adhesion.speed.methods import POISSON, QUANTITIES, Family, Method, Step, all_methods, estimates
from halfspace.errors import GridTooCoarse, InputError, NotConverged, Unsolved, tried
from halfspace.limits import require_between
from halfspace.values import Array, Estimate

Status = Literal["converged", "too coarse", "refused", "failed"]
STATUS: dict[type[Exception], Status] = {InputError: "refused", GridTooCoarse: "too coarse", NotConverged: "failed"}
EXPONENTS = tuple(f"{cost}, x = {x}" for x in ("unknowns", "1/error") for cost in ("time", "peak memory"))
VISIBLE = 4.0  # MiB of memory below which a growth says nothing
TABOR_RANGE = (0.05, 2.0)  # beyond it fixed grids need too many nodes, or rigid surfaces leave nothing to compare
TIGHTEST = 1e-9  # relative tolerance of the truths
TABOR = 1.0  # where digits and R/eps grow
RTOL = 1e-5  # where the Tabor parameter and R/eps grow


@dataclass(frozen=True)
class Truth:
    """What errors are taken against: a solution at a tight tolerance by the family that is not judged by it.

    Values are the pull-off load in R dgamma, the jump_on approach in eps and the hysteresis energy in R dgamma eps, the
    last two only where the curve folds; `approach_scale` in eps is what errors of approaches are relative to, see
    `halfspace.equilibrium.events.approach_scale`.
    """

    family: Family
    rtol: float
    values: Mapping[str, Estimate]
    approach_scale: float

    def relative(self, quantity: str, error: float) -> float:
        """Error of a quantity, relative to its value or, of an approach, which has no size of its own, to the scale."""
        return error / (self.approach_scale if quantity == "jump_on" else abs(self.values[quantity].value))

    @property
    def floors(self) -> dict[str, float]:
        """Its uncertainty in each quantity, relative: no error less than that can be told."""
        return {name: self.relative(name, value.error) for name, value in self.values.items()}


@dataclass(frozen=True)
class Timing:
    """One resolution of one method: its setting, and how it ended, and why.

    The status is ``converged``; ``too coarse``, as its grid cannot carry the spike of tension; ``refused`` before any
    work; ``failed``. Seconds are wall time from the set-up to the events, or to the failure; unknowns include elastic
    ones; memory is the growth of the peak memory of the process in MiB, nan where the system does not tell. Errors and
    floors are for each quantity found, as by `Truth.relative`; not below the uncertainty of the truth on the same
    scale.
    """

    method: str
    setting: str
    status: Status
    seconds: float
    reason: str = ""
    unknowns: int | None = None
    memory: float = float("nan")
    errors: Mapping[str, float] = field(default_factory=dict)
    floors: Mapping[str, float] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether there is a result."""
        return self.status == "converged"

    def error(self, quantity: str | None) -> float:
        """Error of a quantity, or of `worst` if none is named; nan where there is none."""
        return self.errors.get(quantity or self.worst, float("nan"))

    def hidden(self, quantity: str) -> bool:
        """Whether the error is no more than the truth's uncertainty, which then stands in its place."""
        return self.error(quantity) <= self.floors.get(quantity, 0.0)

    @property
    def worst(self) -> str:
        """Quantity with the largest error, or one whose error is not a number; empty without result."""
        return max(self.errors, key=lambda name: np.nan_to_num(self.errors[name], nan=np.inf), default="")


@dataclass(frozen=True)
class Growth:
    """What grows for which solver, and how long that then takes.

    The time is expected to go as a power of what grows, `expected` at most, 0 if only logarithms are. Its values go
    from small to large; each is solved for, and has its seconds once it is timed.
    """

    solver: str
    grows: str
    expected: float
    at: tuple[float, ...]
    solve: Callable[[float], object]
    seconds: tuple[float, ...] = ()

    @property
    def exponent(self) -> float:
        """Exponent b of seconds ~ x^b; nan of fewer than two values."""
        return slope(np.array(self.at), np.array(self.seconds))


Earlier = tuple[str, Sequence[Timing]]
"""Name of the file of an earlier run, and its rungs that have a result; their seconds are yardsticks.

Machines differ, and one differs from hour to hour: what is compared is time in yardsticks, each of its own run.
"""


@dataclass(frozen=True)
class SpeedStudy:
    """All rungs of all methods, in the order of the methods, at one Tabor parameter.

    The truths are by the family that is judged; the yardstick is the seconds that one dgesv of n = 200 took in the same
    run. `growths` tell how the time of the solvers with error control grows with what is asked of them; `earlier` is a
    run to be shown beside, if there is one.
    """

    tabor: float
    quick: bool
    truths: Mapping[Family, Truth]
    yardstick: float
    methods: tuple[Method, ...]
    rungs: tuple[Timing, ...]
    growths: tuple[Growth, ...] = ()
    earlier: Earlier | None = None

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that every truth has."""
        return tuple(q for q in QUANTITIES if all(q in truth.values for truth in self.truths.values()))

    def of(self, method: str) -> list[Timing]:
        """Rungs of a method by name."""
        return [rung for rung in self.rungs if rung.method == method]

    def troubles(self) -> Iterator[str]:
        """What failed that should not have, a sentence each."""
        for quantity in self.quantities:
            a, b = (truth.values[quantity] for truth in self.truths.values())
            if not a.agrees(b):
                yield f"the truths disagree in {quantity}: {a.value:.10g} and {b.value:.10g}"
        for method in self.methods:
            solved = False
            for rung in self.of(method.name):  # a coarse grid may be refused, but not above a finer one that was not
                if (rung.status == "failed" and not method.may_diverge) or (solved and rung.status == "too coarse"):
                    yield f"{method.name} at {rung.setting}: {rung.reason}"
                if rung.converged and not np.isfinite(rung.error(None)):
                    yield f"{method.name} at {rung.setting}: a result that is not a number"
                solved = solved or rung.converged
            if not solved and not method.may_diverge:
                yield f"{method.name}: no rung has a result"

    def exponents(self, method: str) -> dict[str, float]:
        """`EXPONENTS` b of a method's cost ~ x^b, nan where fewer than two rungs converged.

        The error is that of the pull-off load where it exceeds the truth's uncertainty.
        """
        rungs = [rung for rung in self.of(method) if rung.converged]
        n, t, m = (np.array([getattr(r, key) for r in rungs], float) for key in ("unknowns", "seconds", "memory"))
        m[m < VISIBLE] = np.nan
        accuracy = 1 / np.array([np.nan if rung.hidden("pull_off") else rung.error("pull_off") for rung in rungs])
        return dict(zip(EXPONENTS, (slope(x, y) for x in (n, accuracy) for y in (t, m)), strict=True))


def cheapest(rungs: Sequence[Timing], tolerance: float, quantity: str | None = None) -> Timing | None:
    """Fastest rung within the tolerance, in one quantity or in all that it gives; None if there is none."""
    good = [rung for rung in rungs if rung.error(quantity) <= tolerance]
    return min(good, key=lambda rung: rung.seconds, default=None)


def best(rungs: Sequence[Timing], quantity: str | None = None) -> Timing | None:
    """Most accurate rung, in one quantity or in all; None if none converged."""
    good = [rung for rung in rungs if np.isfinite(rung.error(quantity))]
    return min(good, key=lambda rung: rung.error(quantity), default=None)


def pareto_front(rungs: Sequence[Timing], quantity: str) -> list[Timing]:
    """Rungs than which none is both faster and more accurate, from the fastest to the most accurate.

    Of those whose error the truth cannot tell only the fastest counts: no other is known to be more accurate.
    """
    front: list[Timing] = []
    known = [rung for rung in rungs if np.isfinite(rung.error(quantity))]
    for rung in sorted(known, key=lambda r: (r.seconds, r.error(quantity))):
        if not front or (rung.error(quantity) < front[-1].error(quantity) and not front[-1].hidden(quantity)):
            front.append(rung)
    return front


def slope(x: Array, y: Array) -> float:
    """Exponent b of y ~ x^b by least squares of the logarithms; nan from fewer than two different points."""
    use = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    if np.unique(x[use]).size < 2:
        return float("nan")
    return float(np.polyfit(np.log(x[use]), np.log(y[use]), 1)[0])


# How it is measured


def measure(
    tabor: float = 1.0,
    *,
    quick: bool = False,
    progress: Progress = unheard,
    methods: Sequence[Method] | None = None,
    growths: Sequence[Growth] | None = None,
    earlier: Earlier | None = None,
) -> SpeedStudy:
    """Time every method, all unless given, on its ladder of resolutions, and how the time of others grows.

    A quick study climbs the lower rungs only, which `Method.quick` counts, and each once. `progress` is called before
    each method with its name, and how many of how many are done. All growths are measured unless some are given. An
    `earlier` run is kept with the study, to be shown beside.
    InputError if tabor is out of range, NotConverged if a truth is not found.
    """
    require_tabor(tabor)
    chosen = tuple(all_methods() if methods is None else methods)
    truths = find_truths(tabor)
    yardstick = time_yardstick()
    rungs: list[Timing] = []
    for number, method in enumerate(chosen):
        progress(method.name, number, len(chosen))
        truth = truths[method.family]
        for rung, step in enumerate(method.steps[: method.quick if quick else None]):
            # Those of the quick ladder, which are cheap, are timed once more, warm, in the full study.
            rungs.append(_run(method.name, step, tabor, truth, again=not quick and rung < method.quick))
    progress("how time grows", len(chosen), len(chosen))
    found = []
    for growth in GROWTHS if growths is None else growths:
        at = growth.at[:2] if quick else growth.at
        found.append(replace(growth, at=at, seconds=tuple(_seconds(partial(growth.solve, x)) for x in at)))
    return SpeedStudy(tabor, quick, truths, yardstick, chosen, tuple(rungs), tuple(found), earlier)


def require_tabor(tabor: float) -> float:
    """Return the Tabor parameter, or raise InputError unless the study is meant for it."""
    return require_between(tabor, "tabor", *TABOR_RANGE, "take 1, as all methods of the study solve")


def find_truths(tabor: float) -> dict[Family, Truth]:
    """What each family is judged by: the other one at its tightest tolerance, with its own uncertainties."""
    half_space, elements = halfspace.trace(tabor, rtol=TIGHTEST), convergence.trace(Scene(tabor), rtol=TIGHTEST)
    return {
        "half-space": Truth("finite elements", TIGHTEST, estimates(elements), elements.approach_scale),
        "finite elements": Truth("half-space", TIGHTEST, estimates(half_space), half_space.approach_scale),
    }


def time_yardstick() -> float:
    """Seconds of one dgesv of n = 200, the best of 20."""
    rng = np.random.default_rng(0)
    matrix, rhs = rng.normal(size=(200, 200)), rng.normal(size=200)
    return min(_seconds(lambda: dgesv(matrix, rhs)) for _ in range(20))


def _seconds(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def _run(method: str, step: Step, tabor: float, truth: Truth, *, again: bool) -> Timing:
    """One rung: run it, time it again if asked, and compare with the truth."""
    setting, run = step
    began = time.perf_counter()
    outcome = tried(with_peak_memory, lambda: run(tabor), refusals=True)
    seconds = time.perf_counter() - began
    if isinstance(outcome, Unsolved):
        status = next(status for kind, status in STATUS.items() if issubclass(outcome.kind, kind))
        return Timing(method, setting, status, seconds, outcome.reason)
    (unknowns, values), memory = outcome
    if again:
        seconds = min(seconds, _seconds(lambda: run(tabor)))
    errors = {
        name: max(truth.relative(name, abs(values[name] - truth.values[name].value)), floor)
        for name, floor in truth.floors.items()
        if name in values
    }
    return Timing(method, setting, "converged", seconds, "", unknowns, memory, errors, truth.floors)


# How the time grows


DIGITS = tuple(map(float, range(3, 9)))
GROWTHS = (
    Growth("half-space", "digits", 3.0, DIGITS, lambda x: halfspace.trace(TABOR, rtol=10.0**-x)),
    Growth("finite elements", "digits", 6.0, DIGITS, lambda x: convergence.trace(Scene(TABOR), rtol=10.0**-x)),
    Growth("half-space", "mu", 0.0, (1.0, 3.0, 10.0, 30.0, 100.0), lambda x: halfspace.trace(x, rtol=RTOL)),
    Growth("finite elements", "mu", 0.0, (1.0, 3.0, 10.0, 30.0), lambda x: convergence.trace(Scene(x), rtol=RTOL)),
    Growth(
        "hemisphere",
        "R/eps",
        0.0,
        (10.0, 100.0, 1e3, 1e4),
        lambda x: convergence.trace(Scene(TABOR, Hemisphere(radius_ratio=x, poisson=POISSON)), rtol=RTOL),
    ),
)
