"""What `make peers` leaves: numbers of other codes beside ours, what is likely wrong, and their errors against time."""

import csv
import sys
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from fem_adhesion import Scene
from fem_adhesion.benchmark.problems import Problem, named
from fem_adhesion.benchmark.study import diagnose
from fem_adhesion.benchmark.submission import Number, Submitted, read
from fem_adhesion.common import style
from fem_adhesion.common.page import Table, write_csv
from halfspace import trace
from halfspace.laws import Dugdale, Exponential
from halfspace.theories.maugis import TENSION_TO_MAUGIS, MaugisDugdale
from halfspace.values import Estimate

COLUMNS = ("code", "version", "problem", "refinement", "quantity", "value", "error", "deviation", "seconds", "cause")
CORES = np.array([20, 28, 40, 60])
FIGURE = "pull_off_load against seconds of CPU: the largest deviation at any Tabor parameter"


class HardWall(Problem):
    """An exponential attraction before a hard wall: the limit of our exponential law for the power of its core."""

    @cached_property
    def values(self):
        """Extrapolated in the inverse power of the core; the error is the change from one power less."""
        paths = [trace(self.scene.tabor, law=Exponential(1.0, int(core))) for core in CORES]
        found = {}
        for event, kind in (("pull_off", "load"), ("pull_off", "approach"), ("zero_load", "approach")):
            values = [getattr(path.events[event], kind) for path in paths]
            limits = [float(np.linalg.solve(np.vander(1 / CORES[i:]), values[i:])[-1]) for i in (0, 1)]
            found[f"{event}_{kind}"] = Estimate.refined(limits[1], limits[0])
        return found


class Maugis(Problem):
    """Maugis's theory in closed form."""

    @cached_property
    def values(self):
        """The pull-off alone."""
        pull_off = MaugisDugdale(self.scene.tabor * TENSION_TO_MAUGIS, self.scene.tabor).pull_off()
        return {f"pull_off_{kind}": Estimate(getattr(pull_off, kind), 1e-9) for kind in ("approach", "load")}


@cache
def problem_of(name):
    """Problem of the benchmark, or one of a peer alone."""
    kind, number = name.rsplit("-", 1)
    if kind == "exponential":
        return HardWall(name, Scene(float(number), law=Exponential(1.0, 60)))
    return Maugis(name, Scene(float(number) / TENSION_TO_MAUGIS, law=Dugdale(0.1))) if kind == "maugis" else named(name)


def judged(rows):
    """What the benchmark says of rows of the table that are of one run."""
    numbers = {}
    for row in rows:
        number = Number(row["quantity"], float(row["value"]), float(row["error"] or 0))
        numbers.setdefault(row["problem"], []).append(number)
    return diagnose([Submitted(problem_of(name), own) for name, own in numbers.items()])


def graded(runs):
    """Rows of the table, of all runs in a directory."""
    for code, version, refinement, seconds in csv.reader((runs / "runs.csv").open()):
        submission = runs / f"{code}-{refinement}.csv"
        found = diagnose(read(submission, problem_of))
        for row, given in zip(found.rows, csv.DictReader(submission.open()), strict=True):
            cause = " or ".join(found.problems[row.problem].causes)
            value = f"{row.theirs:.14g}", given["error"], f"{row.deviation:.1e}"
            yield (code, version, row.problem, refinement, row.quantity, *value, seconds, cause)


def drawn(rows):
    """Largest deviation of a pull-off load against the time of the run, a line for each code."""
    figure, (axes,) = style.panels()
    worst = {}
    for code, _, problem, refinement, quantity, _, _, deviation, seconds, _ in rows:
        if quantity == "pull_off_load" and not problem.startswith("maugis"):
            run = worst.setdefault(code, {}).setdefault(refinement, [float(seconds), 0.0])
            run[1] = max(run[1], abs(float(deviation)))
    for (code, own), marker in zip(worst.items(), "osD^v", strict=False):
        axes.loglog(*zip(*own.values(), strict=True), marker=marker, label=code)
    style.dress(axes, "seconds of CPU", "largest relative deviation of the pull-off load", legend="below")
    return figure


PICTURES = (style.Picture("error_against_time", "Error against time", drawn, lambda _: [FIGURE]),)


def main(runs, directory):
    """Grade the runs in a directory and write what the report takes in."""
    rows = list(graded(Path(runs)))
    Path(directory).mkdir(parents=True, exist_ok=True)
    style.draw(PICTURES, rows, Path(directory))
    write_csv([Table("peers", "", "", COLUMNS, rows), style.captions(PICTURES, rows)], Path(directory))


if __name__ == "__main__":
    main(*sys.argv[1:])
