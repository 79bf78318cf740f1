"""Error against wall time of every method in the house, at one Tabor parameter.

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
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.linalg.lapack import dgesv

import halfspace
from fem_adhesion import convergence
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.common.facts import with_peak_memory
from fem_adhesion.common.jobs import Progress, unheard
from fem_adhesion.scene import Scene
from fem_adhesion.speed.methods import (
    POISSON,
    Family,
    Method,
    Step,
    element_methods,
    estimates,
    halfspace_methods,
    trace_elements,
)
from fem_adhesion.speed.result import Earlier, Growth, SpeedStudy, Status, Timing, Truth
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from halfspace.limits import require_between

TABOR_RANGE = (0.05, 2.0)  # beyond it fixed grids need too many nodes, or rigid surfaces leave nothing to compare
TIGHTEST = 1e-9  # relative tolerance of the truths
TABOR = 1.0  # where digits and R/eps grow
RTOL = 1e-5  # where the Tabor parameter and R/eps grow
LOGARITHMIC = 0.0


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
    chosen = tuple([*halfspace_methods(), *element_methods()] if methods is None else methods)
    truths = find_truths(tabor)
    yardstick = time_yardstick()
    rungs: list[Timing] = []
    for number, method in enumerate(chosen):
        progress(method.name, number, len(chosen))
        truth = truths[method.family]
        for rung, step in enumerate(method.ladder(quick=quick)):
            # Those of the quick ladder, which are cheap, are timed once more, warm, in the full study.
            rungs.append(_run(method.name, step, tabor, truth, again=not quick and rung < method.quick))
    progress("how time grows", len(chosen), len(chosen))
    found = tuple(timed(growth, _seconds) for growth in (growths_for(quick=quick) if growths is None else growths))
    return SpeedStudy(tabor, quick, truths, yardstick, chosen, tuple(rungs), found, earlier)


def require_tabor(tabor: float) -> float:
    """Return the Tabor parameter, or raise InputError unless the study is meant for it."""
    return require_between(tabor, "tabor", *TABOR_RANGE, "take 1, as all methods of the study solve")


def find_truths(tabor: float) -> dict[Family, Truth]:
    """What each family is judged by: the other one at its tightest tolerance, with its own uncertainties."""
    half_space = _truth("half-space", halfspace.trace(tabor, rtol=TIGHTEST))
    elements = _truth("finite elements", trace_elements(tabor, TIGHTEST))
    return {"half-space": elements, "finite elements": half_space}


def _truth(family: Family, path: EquilibriumPath) -> Truth:
    return Truth(family, TIGHTEST, estimates(path), path.approach_scale)


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
    began = time.perf_counter()
    try:
        solved, memory = with_peak_memory(lambda: step.run(tabor))
    except (InputError, NotConverged) as error:
        return Timing(method, step.setting, _status(error), time.perf_counter() - began, str(error))
    seconds = time.perf_counter() - began
    if again:
        seconds = min(seconds, _seconds(lambda: step.run(tabor)))
    known = {name: true for name, true in truth.values.items() if name in solved.values}
    errors = {  # not below the truth's own uncertainty, since nothing less can be told
        name: truth.relative(name, max(abs(solved.values[name] - true.value), true.error))
        for name, true in known.items()
    }
    floors = {name: truth.relative(name, true.error) for name, true in truth.values.items()}
    return Timing(method, step.setting, "converged", seconds, "", solved.unknowns, memory, errors, floors)


def _status(error: InputError | NotConverged) -> Status:
    """How a rung without result ended."""
    if isinstance(error, InputError):
        return "refused"
    return "too coarse" if isinstance(error, GridTooCoarse) else "failed"


# How the time grows


def _hemisphere(radius_ratio: float) -> object:
    return convergence.trace(Scene(TABOR, Hemisphere(radius_ratio=radius_ratio, poisson=POISSON)), rtol=RTOL)


DIGITS = tuple(map(float, range(3, 9)))
GROWTHS = (
    Growth("half-space", "digits", 3.0, DIGITS, lambda x: halfspace.trace(TABOR, rtol=10.0**-x)),
    Growth("finite elements", "digits", 6.0, DIGITS, lambda x: trace_elements(TABOR, 10.0**-x)),
    Growth("half-space", "mu", LOGARITHMIC, (1.0, 3.0, 10.0, 30.0, 100.0), lambda x: halfspace.trace(x, rtol=RTOL)),
    Growth("finite elements", "mu", LOGARITHMIC, (1.0, 3.0, 10.0, 30.0), lambda x: trace_elements(x, RTOL)),
    Growth("hemisphere", "R/eps", LOGARITHMIC, (10.0, 100.0, 1e3, 1e4), _hemisphere),
)


def growths_for(*, quick: bool) -> tuple[Growth, ...]:
    """All growths, yet to be timed; each of the two smallest values only if it is to be quick."""
    return tuple(replace(growth, at=growth.at[:2]) for growth in GROWTHS) if quick else GROWTHS


def timed(growth: Growth, seconds_of: Callable[[Callable[[], object]], float]) -> Growth:
    """Time a growth at each of its values."""
    return replace(growth, seconds=tuple(seconds_of(partial(growth.solve, x)) for x in growth.at))
