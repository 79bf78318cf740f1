"""Command lines run whole, each once in a session, whichever tests and however many workers ask for it."""

import fcntl
import hashlib
import json
import os
import pickle
import re
import shlex
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

from comparisons import PLACE

ROOT = Path(__file__).parents[2]
BIN = Path(sys.executable).parent

COMPARE = "fem-adhesion compare --tabor 0.5 2 --poisson 0.45 --rtol 1e-4 --json result.json"
GREENWOOD = "fem-adhesion greenwood --out greenwood --quick"
ON_ALL_CORES = "make compare"
"""The one run that takes every core: in others the cores are taken by the tests, and more processes only start up."""

REPORT = "fem-adhesion report --html report.html"
FROM_KEPT = (COMPARE, REPORT, "make compare")
"""What compares: parts that one of them has computed are taken from there, see `comparisons`."""

KEEPING = """
import pickle, sys
from fem_adhesion import cli
from fem_adhesion.greenwood import claims, study
compute, judge, told, kept = study.compute, claims.judged, [], []
def keep(found):
    kept.append(found)
    return found
study.compute = lambda *, quick, begin: keep(compute(quick=quick, begin=lambda part: (told.append(part), begin(part))))
claims.judged = lambda found: keep(judge(found))
code = cli.main()
with open({file!r}, "wb") as file:
    pickle.dump((*kept, told), file)
sys.exit(code)
"""
"""The program in whose place its result is kept beside its files: a study of a minute that tests look into."""


COMPARING = """
import sys
from fem_adhesion import cli
from fem_adhesion.crosscheck import scenes
from comparisons import kept
scenes._compared = kept
sys.exit(cli.main())
"""
"""The program in whose place comparisons are kept."""


@dataclass(frozen=True)
class Run:
    """How a command line ended, and the directory where it ran and left its files."""

    line: str
    code: int
    out: str
    err: str
    directory: str

    def __truediv__(self, name):
        return Path(self.directory) / name

    @property
    def kept(self):
        """What `KEEPING` kept."""
        return pickle.loads(kept_beside(self / "").read_bytes())


def kept_beside(directory):
    """File of what is kept, outside the directory where a command leaves its own."""
    return directory.parent / "kept.pkl"


def whole_run(session, line):
    """Run a command line in an empty directory of its own, or read how it ended if that was done before.

    A target of the Makefile runs where that is.

    Who asks while it is under way waits for its end, however long that takes.
    """
    place = session / hashlib.sha256(line.encode()).hexdigest()[:16]
    place.mkdir(parents=True, exist_ok=True)
    record = place / "run.json"
    with (place / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not record.exists():
            record.write_text(json.dumps(asdict(_run(line, place / "here"))))
    return Run(**json.loads(record.read_text()))


def _run(line, directory):
    directory.mkdir()
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "COLUMNS": "150", "NO_COLOR": "1"}
    if line != ON_ALL_CORES:
        environment["LOKY_MAX_CPU_COUNT"] = "1"
    environment = {name: value for name, value in environment.items() if not name.startswith(("PYTEST_", "MAKE"))}
    program, *arguments = shlex.split(line)
    programs = BIN
    if line in FROM_KEPT:
        programs = directory.parents[1]
        environment |= {PLACE: str(programs), "PYTHONPATH": os.pathsep.join(sys.path)}
        (programs / "fem-adhesion").write_text(f"#!{sys.executable}\n{COMPARING}")
        (programs / "fem-adhesion").chmod(0o700)
    if program == "make":
        command, place = _target(arguments, directory, programs), ROOT
    else:
        kept = KEEPING.format(file=str(kept_beside(directory)))
        program = [sys.executable, "-c", kept] if line == GREENWOOD else [str(programs / program)]
        command, place = [*program, *arguments], directory
    done = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True)
    return Run(line, done.returncode, done.stdout, done.stderr, str(directory))


def _target(arguments, directory, programs):
    """Make a target in the environment of the tests: stamps say that it is complete, so that nothing is installed."""
    for stamp in ("installed", "installed-dev"):
        (directory / stamp).touch()
    placed = [re.sub("^OUT=", f"OUT={directory}/", argument) for argument in arguments]
    return ["make", "--no-print-directory", f"VENV={directory}", f"BIN={programs}", *placed]


def tables_in(text):
    """Tables drawn in a text, each as a list of lines: cells by the header above them."""
    found, headers = [], []
    for line in text.splitlines():
        if line.startswith("┏"):
            headers = []
            found.append([])
        elif line.startswith("┃"):
            headers.append([cell.strip() for cell in line.strip("┃").split("┃")])
        elif line.startswith("│"):
            header = [" ".join(filter(None, words)) for words in zip(*headers, strict=True)]
            cells = [cell.strip() for cell in line.strip("│").split("│")]
            found[-1].append(dict(zip(header, cells, strict=True)))
    return found
