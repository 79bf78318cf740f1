"""What every peer is asked: events along its load-approach curve, under fixed grips, in the benchmark's columns.

Lengths along the surface in beta, gaps in eps, E* = 1: then R = 1/tabor and dgamma = tabor^2, and a load in R dgamma is
the force over tabor. Runs in the peer's own environment, so it needs NumPy and SciPy alone.
"""

import csv
import math
import sys
import time
from contextlib import contextmanager
from pathlib import Path

from scipy.optimize import brentq, minimize_scalar

TABORS = (0.5, 1.0, 2.0)
COLUMNS = ("problem", "quantity", "value", "unit", "error")


def events(solve, problem, start, step):
    """Rows of pull-off and zero load, walking apart from `start`; solve(approach, state) gives (load, gap, state)."""
    states = {}

    def load(approach):
        above = [known for known in states if known >= approach]  # pressed more closely: on the branch in contact
        states[approach] = solve(approach, states[min(above)][2] if above else None)
        return states[approach][0]

    approaches, loads = [start], [load(start)]
    while len(loads) < 3 or loads[-1] < loads[-2] or loads[-2] > 0:
        approaches.append(round(approaches[-1] - step, 9))
        loads.append(load(approaches[-1]))
    first = next(i for i, value in enumerate(loads) if value < 0)
    zero = brentq(load, approaches[first], approaches[first - 1], xtol=1e-8)
    load(zero)
    least = minimize_scalar(load, bounds=(approaches[-1], approaches[-3]), method="bounded", options={"xatol": 1e-4})
    yield problem, "pull_off_load", float(least.fun), "R dgamma", ""
    yield problem, "pull_off_approach", float(least.x), "eps", 1e-3  # the load is flat there
    yield problem, "zero_load_approach", float(zero), "eps", ""
    if not math.isnan(gap := float(states[zero][1])):
        yield problem, "zero_load_central_gap", gap, "eps", ""


@contextmanager
def record(code, version, refinement):
    """Write the rows to CODE-REFINEMENT.csv in the directory given, and the seconds of CPU to runs.csv."""
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    start, rows = time.process_time(), []
    yield rows
    seconds = time.process_time() - start
    with (out / f"{code}-{refinement}.csv").open("w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    with (out / "runs.csv").open("a", newline="") as file:
        csv.writer(file).writerow((code, version, refinement, f"{seconds:.1f}"))
    print(f"{code} {version} {refinement}: {seconds:.1f} s", flush=True)


def run(code, version, refinements, problems, tabors=TABORS):
    """Record the events at each refinement; problems(tabor, *refinement) gives the problem's name and its `solve`."""
    for refinement in refinements:
        with record(code, version, "-".join(f"{number:g}" for number in refinement)) as rows:
            for tabor in tabors:
                problem, solve = problems(tabor, *refinement)
                rows += events(solve, problem, 0.25 + 2 * tabor, 0.3 + 0.2 * tabor)
