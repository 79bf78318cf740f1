"""What the speed study finds: rungs of ladders, and the figures of merit drawn from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fem_adhesion.studies.methods import Method
from halfspace.curve import Estimate

CONVERGED = "converged"
VISIBLE = 4.0  # MiB of memory below which a growth says nothing


@dataclass(frozen=True)
class Rung:
    """One resolution of one method.

    Attributes
    ----------
    method, setting : str
        Whose rung, and how fine.
    outcome : str
        ``converged`` or the reason for having no result.
    seconds : float
        Wall time from the set-up to the events, or to the failure; nan if it was left out.
    unknowns : int or None
        Elastic ones included; None without result.
    memory : float
        Growth of the peak memory of the process in MiB; nan where the system does not tell.
    errors : mapping of str to float
        For each quantity found: loads and energies relative, approaches relative to 1 + |alpha*|; not below the truth's
        own uncertainty.
    """

    method: str
    setting: str
    outcome: str
    seconds: float
    unknowns: int | None = None
    memory: float = float("nan")
    errors: Mapping[str, float] = field(default_factory=dict)

    @property
    def converged(self) -> bool:
        """Whether there is a result."""
        return self.outcome == CONVERGED

    def error(self, quantity: str) -> float:
        """Error of a quantity; nan where there is none."""
        return self.errors.get(quantity, float("nan"))

    @property
    def worst_error(self) -> float:
        """Largest error of the quantities found; nan without result."""
        return max(self.errors.values(), default=float("nan"))


@dataclass(frozen=True)
class Exponents:
    """Slopes of a method's cost in log-log scale, nan where fewer than two rungs converged.

    Attributes
    ----------
    time, memory : float
        Against unknowns.
    time_by_accuracy, memory_by_accuracy : float
        Against 1/error, error that of the pull-off load.
    """

    time: float
    memory: float
    time_by_accuracy: float
    memory_by_accuracy: float


@dataclass(frozen=True)
class SpeedStudy:
    """All rungs of all methods.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    quick : bool
        Whether the methods had but a small share of time.
    truth : mapping of str to Estimate
        Pull-off load in R dgamma, jump_on approach in eps, hysteresis energy in R dgamma eps; the last two only where
        the curve folds.
    yardstick : float
        Seconds that one dgesv of n = 200 took in the same run.
    methods : tuple of Method
        In the order of the report.
    rungs : tuple of Rung
        In the order of the methods.
    """

    tabor: float
    quick: bool
    truth: Mapping[str, Estimate]
    yardstick: float
    methods: tuple[Method, ...]
    rungs: tuple[Rung, ...]

    def of(self, method: str) -> list[Rung]:
        """Rungs of a method by name."""
        return [rung for rung in self.rungs if rung.method == method]

    def uncertainty(self, quantity: str) -> float:
        """Uncertainty of the truth, on the scale of the errors."""
        estimate = self.truth[quantity]
        return estimate.error / size_of(quantity, estimate.value)

    def exponents(self, method: str) -> Exponents:
        """Fitted exponents of a method's cost."""
        rungs = [rung for rung in self.of(method) if rung.converged]
        n, t, m = (np.array([getattr(r, key) for r in rungs], float) for key in ("unknowns", "seconds", "memory"))
        m[m < VISIBLE] = np.nan
        accuracy = 1 / np.array([rung.error("pull_off") for rung in rungs])
        return Exponents(slope(n, t), slope(n, m), slope(accuracy, t), slope(accuracy, m))


def size_of(quantity: str, value: float) -> float:
    """What errors of a quantity are relative to: 1 + |alpha*| for an approach, which may be zero."""
    return 1 + abs(value) if quantity == "jump_on" else abs(value)


def cheapest(rungs: Sequence[Rung], tolerance: float, quantity: str | None = None) -> Rung | None:
    """Fastest rung within the tolerance, in one quantity or in all that it gives; None if there is none."""
    good = [rung for rung in rungs if _error(rung, quantity) <= tolerance]
    return min(good, key=lambda rung: rung.seconds, default=None)


def best(rungs: Sequence[Rung], quantity: str | None = None) -> Rung | None:
    """Most accurate rung, in one quantity or in all; None if none converged."""
    good = [rung for rung in rungs if np.isfinite(_error(rung, quantity))]
    return min(good, key=lambda rung: _error(rung, quantity), default=None)


def _error(rung: Rung, quantity: str | None) -> float:
    return rung.error(quantity) if quantity else rung.worst_error


def pareto_front(rungs: Sequence[Rung], quantity: str) -> list[Rung]:
    """Rungs than which none is both faster and more accurate, from the fastest to the most accurate."""
    front: list[Rung] = []
    known = [rung for rung in rungs if np.isfinite(rung.error(quantity))]
    for rung in sorted(known, key=lambda r: (r.seconds, r.error(quantity))):
        if not front or rung.error(quantity) < front[-1].error(quantity):
            front.append(rung)
    return front


def slope(x: np.ndarray, y: np.ndarray) -> float:
    """Exponent b of y ~ x^b by least squares of the logarithms; nan from fewer than two different points."""
    use = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    if np.unique(x[use]).size < 2:
        return float("nan")
    return float(np.polyfit(np.log(x[use]), np.log(y[use]), 1)[0])
