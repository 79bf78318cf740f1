"""Error against wall time of every method in the house, at one Tabor parameter.

Each method climbs a ladder of resolutions; a rung is timed from the set-up to the events, and its errors are those of
three quantities against the half-space solution at the tightest tolerance. A rung that fails is recorded with its
reason; so is one that is left out since its method has used up its share of time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from scipy.linalg.lapack import dgesv

import halfspace
from fem_adhesion.studies.element_methods import element_methods
from fem_adhesion.studies.halfspace_methods import halfspace_methods
from fem_adhesion.studies.machine import peak_memory
from fem_adhesion.studies.methods import Method, Solved, Step
from fem_adhesion.studies.speed_result import CONVERGED, Rung, SpeedStudy, size_of
from halfspace.curve import Estimate
from halfspace.devices import cycle
from halfspace.errors import InputError, NotConverged

TABOR_RANGE = (0.05, 2.0)  # beyond it fixed grids need too many nodes, or rigid surfaces leave nothing to compare
SHARE = {False: 15.0, True: 0.8}  # seconds for each method, in the full and in the quick study
GROWTH = 3.0  # of the cost of a rung over that of the one below it, at most
REPEATED_BELOW = 0.3  # seconds; the better of the two counts, which is warm

Progress = Callable[[str, int, int], None]


def measure(
    tabor: float = 1.0,
    *,
    quick: bool = False,
    progress: Progress | None = None,
    methods: Sequence[Method] | None = None,
) -> SpeedStudy:
    """Time every method on its ladder of resolutions.

    Parameters
    ----------
    tabor : float
        Tabor parameter, 0.05 to 2.
    quick : bool
        Give each method less than a second instead of fifteen.
    progress : callable
        Called before each method with its name, and how many of how many are done.
    methods : sequence of Method, optional
        All unless given.

    Raises
    ------
    InputError
        If tabor is out of range.
    """
    require_tabor(tabor)
    chosen = tuple([*halfspace_methods(), *element_methods()] if methods is None else methods)
    truth = find_truth(tabor)
    yardstick = time_yardstick()
    rungs: list[Rung] = []
    for number, method in enumerate(chosen):
        if progress:
            progress(method.name, number, len(chosen))
        rungs += _climb(method, tabor, truth, SHARE[quick])
    return SpeedStudy(tabor, quick, truth, yardstick, chosen, tuple(rungs))


def require_tabor(tabor: float) -> float:
    """Return the Tabor parameter, or raise InputError unless the study is meant for it."""
    low, high = TABOR_RANGE
    if not low <= tabor <= high:
        raise InputError(f"tabor = {tabor:g} is outside {low:g} <= tabor <= {high:g} for the speed study; take 1")
    return tabor


def find_truth(tabor: float) -> dict[str, Estimate]:
    """Quantities by the half-space solver at its tightest tolerance, with their uncertainties."""
    path = halfspace.trace(tabor, rtol=1e-9)
    pull_off, jump_on, grips = path.events["pull_off"], path.event("jump_on"), cycle(path)
    truth = {"pull_off": Estimate(pull_off.load, pull_off.load_error)}
    if jump_on and grips:
        truth |= {"jump_on": Estimate(jump_on.approach, jump_on.approach_error), "hysteresis": grips.energy_lost}
    return truth


def time_yardstick() -> float:
    """Seconds of one dgesv of n = 200, the best of 20."""
    rng = np.random.default_rng(0)
    matrix, rhs = rng.normal(size=(200, 200)), rng.normal(size=200)
    return min(_seconds(lambda: dgesv(matrix, rhs)) for _ in range(20))


def _seconds(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def _climb(method: Method, tabor: float, truth: Mapping[str, Estimate], share: float) -> Iterator[Rung]:
    """Rungs of a method until its share of time is used up."""
    ended = time.perf_counter() + share
    last = 0.0
    for number, step in enumerate(method.steps):
        left = ended - time.perf_counter()
        if number and GROWTH * last > left:
            yield Rung(method.name, step.setting, f"left out: {share:g} s for this method are used up", float("nan"))
            continue
        rung = _run(method.name, step, tabor, truth)
        last = rung.seconds
        yield rung


def _run(method: str, step: Step, tabor: float, truth: Mapping[str, Estimate]) -> Rung:
    """One rung: run it, again if that is soon done, and compare with the truth."""
    began = time.perf_counter()
    try:
        with peak_memory() as memory:
            solved = step.run(tabor)
    except NotConverged as error:
        return Rung(method, step.setting, str(error), time.perf_counter() - began)
    seconds = time.perf_counter() - began
    if seconds < REPEATED_BELOW:
        seconds = min(seconds, _seconds(lambda: step.run(tabor)))
    return Rung(method, step.setting, CONVERGED, seconds, solved.unknowns, memory.mebibytes, _errors(solved, truth))


def _errors(solved: Solved, truth: Mapping[str, Estimate]) -> dict[str, float]:
    return {
        name: max(abs(value - truth[name].value), truth[name].error) / size_of(name, truth[name].value)
        for name, value in solved.values.items()
        if name in truth
    }
