"""The table of all peers: each number beside ours, and the cause that `fem-adhesion benchmark` names for its run."""

import csv
import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np

from halfspace import atlas, trace
from halfspace.laws import Exponential
from halfspace.theories.maugis import TENSION_TO_MAUGIS, MaugisDugdale

COLUMNS = ("code", "version", "problem", "refinement", "quantity", "value", "deviation", "seconds", "cause")
NOT_ASKED = "not asked"  # the cause, where the problem is none of the benchmark's


@cache
def hard_wall(tabor):
    """Pull-off load and approach under no load of the exponential law, as the power of its core goes to infinity."""
    cores = np.array([20, 28, 40, 60])
    events = [trace(tabor, law=Exponential(1.0, int(core))).events for core in cores]
    values = [(event["pull_off"].load, event["zero_load"].approach) for event in events]
    load, approach = np.linalg.solve(np.vander(1 / cores), values)[-1]
    return {"pull_off_load": float(load), "zero_load_approach": float(approach)}


def ours(problem, quantity):
    """Our value: of the atlas on the half-space, of the exponential law on a hard wall, or of Maugis's theory."""
    name, number = problem.rsplit("-", 1)
    event, kind = quantity.split("_load_") if quantity.startswith("zero_load_") else ("", quantity)
    if name == "half-space":
        state = atlas.zero_load(float(number)) if event else atlas.pull_off(float(number))
        return float(getattr(state, kind if event else "load"))
    if name == "exponential":
        return hard_wall(float(number))[quantity]
    return MaugisDugdale(float(number), float(number) / TENSION_TO_MAUGIS).pull_off().load


def cause_of(submission):
    """The likely causes, of those problems alone that the benchmark has."""
    if "half-space" not in submission.read_text():
        return NOT_ASKED
    asked = (sys.executable, "-m", "fem_adhesion", "benchmark", str(submission), "--json", "-")
    found = json.loads(subprocess.run(asked, capture_output=True, text=True, check=False).stdout)
    return " or ".join((found["cause"], *found["alike"]))


def main(runs, table):
    """Grade the runs in a directory and write the table."""
    rows = []
    for code, version, refinement, seconds in csv.reader((runs / "runs.csv").open()):
        submission = runs / f"{code}-{refinement}.csv"
        cause = cause_of(submission)
        for number in csv.DictReader(submission.open()):
            problem, quantity, value = number["problem"], number["quantity"], float(number["value"])
            reference = ours(problem, quantity)
            deviation = f"{(value - reference) / abs(reference):.1e}"
            rows.append((code, version, problem, refinement, quantity, f"{value:.10g}", deviation, seconds, cause))
            print(*rows[-1])
    with table.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
