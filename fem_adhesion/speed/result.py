"""What the speed study finds: rungs of ladders, and the figures of merit drawn from them."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from fem_adhesion.speed.methods import QUANTITIES, Family, Method
from halfspace.errors import InputError
from halfspace.values import Array, Estimate

Status = Literal["converged", "too coarse", "refused", "failed"]
EXPONENTS = tuple(f"{cost}, x = {x}" for x in ("unknowns", "1/error") for cost in ("time", "peak memory"))
VISIBLE = 4.0  # MiB of memory below which a growth says nothing


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

    def error(self, quantity: str) -> float:
        """Error of a quantity; nan where there is none."""
        return self.errors.get(quantity, float("nan"))

    def hidden(self, quantity: str) -> bool:
        """Whether the error is no more than the truth's uncertainty, which then stands in its place."""
        return self.error(quantity) <= self.floors.get(quantity, 0.0)

    @property
    def worst(self) -> str | None:
        """Quantity with the largest error; None without result, or with an error that is not a number."""
        if not self.errors or not np.all(np.isfinite(list(self.errors.values()))):
            return None
        return max(self.errors, key=self.error)


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


@dataclass(frozen=True)
class Earlier:
    """Rungs of an earlier run that have a result, by the name of its file; their seconds are yardsticks.

    Machines differ, and one differs from hour to hour: what is compared is time in yardsticks, each of its own run.
    """

    name: str
    rungs: tuple[Timing, ...]


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

    def uncertainty(self, family: Family, quantity: str) -> float:
        """Uncertainty of the truth that judges a family, on the scale of the errors."""
        truth = self.truths[family]
        return truth.relative(quantity, truth.values[quantity].error)

    def troubles(self) -> Iterator[str]:
        """What failed that should not have, a sentence each."""
        for quantity in self.quantities:
            a, b = (truth.values[quantity] for truth in self.truths.values())
            if not a.agrees(b):
                yield f"the truths disagree in {quantity}: {a.value:.10g} and {b.value:.10g}"
        for method in self.methods:
            yield from _troubles(method, self.of(method.name))

    def exponents(self, method: str) -> dict[str, float]:
        """`EXPONENTS` b of a method's cost ~ x^b, nan where fewer than two rungs converged.

        The error is that of the pull-off load where it exceeds the truth's uncertainty.
        """
        rungs = [rung for rung in self.of(method) if rung.converged]
        n, t, m = (np.array([getattr(r, key) for r in rungs], float) for key in ("unknowns", "seconds", "memory"))
        m[m < VISIBLE] = np.nan
        accuracy = 1 / np.array([np.nan if rung.hidden("pull_off") else rung.error("pull_off") for rung in rungs])
        return dict(zip(EXPONENTS, (slope(x, y) for x in (n, accuracy) for y in (t, m)), strict=True))


def _troubles(method: Method, rungs: Sequence[Timing]) -> Iterator[str]:
    """Failures of one method: a coarse grid may be refused, but not above a finer one that was not."""
    solved = False
    for rung in rungs:
        if (rung.status == "failed" and not method.may_diverge) or (solved and rung.status == "too coarse"):
            yield f"{method.name} at {rung.setting}: {rung.reason}"
        if rung.converged and rung.worst is None:
            yield f"{method.name} at {rung.setting}: a result that is not a number"
        solved = solved or rung.converged
    if not solved and not method.may_diverge:
        yield f"{method.name}: no rung has a result"


def cheapest(rungs: Sequence[Timing], tolerance: float, quantity: str | None = None) -> Timing | None:
    """Fastest rung within the tolerance, in one quantity or in all that it gives; None if there is none."""
    good = [rung for rung in rungs if _error(rung, quantity) <= tolerance]
    return min(good, key=lambda rung: rung.seconds, default=None)


def best(rungs: Sequence[Timing], quantity: str | None = None) -> Timing | None:
    """Most accurate rung, in one quantity or in all; None if none converged."""
    good = [rung for rung in rungs if np.isfinite(_error(rung, quantity))]
    return min(good, key=lambda rung: _error(rung, quantity), default=None)


def _error(rung: Timing, quantity: str | None) -> float:
    named = quantity or rung.worst
    return rung.error(named) if named else float("nan")


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


# An earlier run, read back from its table


def read_earlier(path: Path, tabor: float) -> Earlier:
    """Read ``speed.csv`` of an earlier run at the same Tabor parameter, or raise InputError."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        at = {float(row["tabor"]) for row in rows}
        rungs = tuple(_rung(row) for row in rows if row["outcome"] == "converged")
    except OSError as error:
        raise InputError(
            f"beside = {path} cannot be read: {error.strerror}; give speed.csv of an earlier run"
        ) from None
    except KeyError as error:
        raise InputError(f"beside = {path} has no column {error}; give speed.csv of this version's study") from None
    except (TypeError, ValueError, csv.Error) as error:
        raise InputError(f"beside = {path} is no table of a speed study ({error}); give its speed.csv") from None
    if not rungs:
        raise InputError(f"beside = {path} has no rung with a result; give speed.csv of an earlier run")
    if at != {tabor}:
        raise InputError(f"beside = {path} is of tabor {', '.join(f'{t:g}' for t in sorted(at))}, not {tabor:g}")
    return Earlier(str(path), rungs)


def _rung(row: Mapping[str, str]) -> Timing:
    """Rung of a row of the table, where what is not known is empty."""
    told = [q for q in QUANTITIES if row[f"{q}_error"]]
    errors, floors = ({q: float(row[f"{q}_{what}"]) for q in told} for what in ("error", "truth_uncertainty"))
    yardsticks = float(row["yardsticks"])
    if not 0 < yardsticks < math.inf or not all(math.isfinite(error) for error in errors.values()):
        raise ValueError(f"{row['method']} at {row['setting']} has no time or no error")
    return Timing(row["method"], row["setting"], "converged", yardsticks, errors=errors, floors=floors)
