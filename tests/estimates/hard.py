"""Hard cases: each has the ending declared beforehand that it must come to, a number within its estimate or a refusal.

`attempts` has the cases. The tables are written as the report reads them: hard.csv, locking.csv, hard.json.
"""

import csv
import json
import math
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from typing import Any, NamedTuple

from judging import judge

from fem_adhesion.common.facts import versions
from fem_adhesion.common.files import directory_written_aside
from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import console_beside
from fem_adhesion.common.terminal import Column, Fitted
from halfspace.errors import InputError, NotConverged

CONVERGED = "converged"


class Refusal(NamedTuple):
    """An end by an exception of one class and no other, in a message that names a value, its limit and the remedy."""

    kind: type[Exception]
    value: str
    limit: str
    remedy: str

    def left_out(self, message):
        """What a message does not name."""
        return [part for part in (self.value, self.limit, self.remedy) if part not in message]


class Measured(NamedTuple):
    """What a case that is solved gives: numbers with estimates, their truth, what that is, and Newton steps taken."""

    numbers: dict[str, Any]
    truth: dict[str, Any]
    reference: str
    newton_steps: int = 0


class Case(NamedTuple):
    """A name, what is attempted under it, and the refusals in which it may end; in numbers if there are none."""

    name: str
    attempt: Callable[[], Measured]
    refusals: tuple[Refusal, ...] = ()
    solvable: bool = False

    @property
    def expected(self):
        """The endings in words."""
        solved = [CONVERGED] if self.solvable or not self.refusals else []
        return " or ".join([*solved, *(refusal.kind.__name__ for refusal in self.refusals)])


@dataclass(frozen=True)
class Row:
    """How a case ended: error and estimate are of the number worst off, nan if it was refused."""

    name: str
    outcome: str
    expected: str
    found: str
    message: str
    error: float = math.nan
    estimate: float = math.nan
    newton_steps: int = 0
    seconds: float = 0.0


@dataclass(frozen=True)
class Locking:
    """Largest error in beta of the deflection under a smooth pressure of unit height, without and with a remedy."""

    poisson: float
    element: str
    remedy: str
    error: float
    remedied: float


def run(cases):
    """Attempt the cases one after the other; an exception that is no refusal is a defect, and ends it all."""
    for case in cases:
        began = time.perf_counter()
        try:
            ended = _measured(case, case.attempt())
        except (InputError, NotConverged) as refusal:
            ended = _refused(case, refusal)
        yield Row(case.name, *ended, seconds=time.perf_counter() - began)


def _measured(case, measured):
    worst = max(judge(measured.numbers, measured.truth), key=lambda number: number.ratio)
    found = CONVERGED if worst.ratio <= 1 else "beyond the estimate"
    outcome = CONVERGED if found in case.expected.split(" or ") else "wrong"
    message = f"{worst.what}, against: {measured.reference}"
    return outcome, case.expected, found, message, worst.error, worst.estimate, measured.newton_steps


def _refused(case, refusal):
    message, kind = str(refusal), type(refusal)
    declared = [one for one in case.refusals if one.kind is kind]
    left_out = min((one.left_out(message) for one in declared), key=len, default=[])
    found = " without ".join([kind.__name__, *map(repr, left_out)])
    return "refused" if declared and not left_out else "wrong", case.expected, found, message


# Tables and files

STYLES = {"converged": "green", "refused": "cyan", "wrong": "bold red"}


def summary(rows):
    """How many cases ended how; otherwise than declared is wrong."""
    counts = Counter(row.outcome for row in rows)
    return ", ".join(f"{counts[outcome]} {outcome}" for outcome in STYLES)


def cases_table(rows):
    """One line for each case: the ending declared, the one found; a refusal in its own words."""
    columns = {
        "case": [row.name for row in rows],
        "expected": [row.expected for row in rows],
        "found": [row.found for row in rows],
        "error": [_small(row.error) for row in rows],
        "estimate": [_small(row.estimate) for row in rows],
        "Newton steps": [str(row.newton_steps or "-") for row in rows],
        "seconds": [f"{row.seconds:.2f}" for row in rows],
        "compared, or refused because": [row.message for row in rows],
    }
    words = {"case", "expected", "found", "compared, or refused because"}
    shown = [Column(h, c, h in words) for h, c in columns.items()]
    return Fitted(shown, [summary(rows)], styles=[STYLES[row.outcome] for row in rows])


def locking_table(rows):
    """One line for each Poisson's ratio and element."""
    columns = {
        "poisson": [f"{row.poisson:g}" for row in rows],
        "element": [row.element for row in rows],
        "error": [_small(row.error) for row in rows],
        "with the remedy": [_small(row.remedied) for row in rows],
        "remedy": [row.remedy for row in rows],
    }
    title = "locking: largest error of the deflection under a smooth pressure"
    return Fitted([Column(h, c, words=True) for h, c in columns.items()], [title])


def _small(value):
    return f"{value:.1e}" if math.isfinite(value) else "-"


def write_hard(directory, rows, locked):
    """Write hard.csv, locking.csv and hard.json, which holds both; null or empty where a case has no number."""
    plain = {"hard": [_plain(row) for row in rows], "locking": [_plain(row) for row in locked]}
    for name, one in (("hard", Row), ("locking", Locking)):
        with (directory / f"{name}.csv").open("w") as file:
            writer = csv.DictWriter(file, [field.name for field in fields(one)], lineterminator="\n")
            writer.writeheader()
            writer.writerows(plain[name])
    whole = {"summary": summary(rows), "versions": versions(), "cases": plain["hard"], "locking": plain["locking"]}
    with (directory / "hard.json").open("w") as file:
        json.dump(whole, file, indent=1, allow_nan=False)


def _plain(row):
    return {name: None if isinstance(v, float) and not math.isfinite(v) else v for name, v in asdict(row).items()}


def attempt_all(directory, cases=None, locking=None):
    """Attempt every case, print how each ended and write the tables; 1 if one ends otherwise than declared, else 0."""
    if cases is None:
        from attempts import CASES, locking

        cases = CASES
    rows = []
    with directory_written_aside(directory, force=True) as aside:
        with progress_bar() as step:
            step(cases[0].name, 0, len(cases) + 1)
            for row in run(cases):
                rows.append(row)
                step([*(case.name for case in cases), "locking"][len(rows)], len(rows), len(cases) + 1)
            locked = list(locking())
        write_hard(aside, rows, locked)
    console_beside().print(cases_table(rows), locking_table(locked))
    return int(any(row.outcome == "wrong" for row in rows))
