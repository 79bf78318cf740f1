"""The table of all peers: each number beside ours, and the cause that `fem-adhesion benchmark` names for its run."""

import csv
import json
import subprocess
import sys
from pathlib import Path

from scipy.optimize import brentq

from halfspace import atlas
from halfspace.theories.maugis import TENSION_TO_MAUGIS, MaugisDugdale

COLUMNS = ("code", "version", "problem", "refinement", "quantity", "value", "deviation", "seconds", "cause")
NOT_ASKED = "not asked"  # the cause, where the problem is none of the benchmark's


def ours(problem, quantity):
    """Our value: of the atlas on the half-space, of Maugis's theory for the tension dgamma/eps otherwise."""
    name, number = problem.rsplit("-", 1)
    event, kind = quantity.split("_load_") if quantity.startswith("zero_load_") else ("", quantity)
    if name == "half-space":
        state = atlas.zero_load(float(number)) if event else atlas.pull_off(float(number))
        return float(getattr(state, kind if event else "load"))
    theory = MaugisDugdale(float(number), float(number) / TENSION_TO_MAUGIS)
    if not event:
        return theory.pull_off().load
    return float(theory.approach(brentq(theory.load, 0.5, 3.0, xtol=1e-14)))


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
