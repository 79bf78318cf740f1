"""Defects that the tests must notice: each is put into a copy of the project, where a test named with it must fail.

By hand: ``python tests/defects [WORD ...]``, all of defects.toml or those with a word in their name; ``--list`` says
whether the places of all are found. A defect is caught if its tests pass without it and each fails with it, else the
exit code is 1. It is a text that stands once in a file, what takes its place, and the tests as pytest is given them.
"""

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[2]
LEFT_OUT = shutil.ignore_patterns(".git", ".venv", ".*cache*", "__pycache__", "build", "*.egg-info")


def failed(tree, test):
    """The first test of those named that fails in a copy of the project, "" if none does; "not run" without one."""
    ours = {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1", "COLUMNS": "300"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *shlex.split(test)]
    done = subprocess.run(command, cwd=tree, env=os.environ | ours, capture_output=True, text=True, check=False)
    names = re.findall(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.M)
    return {0: "", 1: names[0] if names else "?", 2: "collection"}.get(done.returncode, "not run")


def fate(tree, defect, *, sound):
    """What becomes of a defect in a copy of the project, which is left as it was."""
    file = tree / defect["file"]
    text = file.read_text() if file.exists() else ""
    if text.count(defect["before"]) != 1:
        return f"NOT FOUND: {text.count(defect['before'])} times in {defect['file']}"
    if sound and (found := [test for test in defect["tests"] if failed(tree, test)]):
        return f"FAILS WITHOUT: {', '.join(found)}"
    file.write_text(text.replace(defect["before"], defect["after"]))
    by = {test: failed(tree, test) for test in defect["tests"]}
    file.write_text(text)
    survived = [f"{test} {end}".strip() for test, end in by.items() if end in ("", "not run")]
    return f"SURVIVED {', '.join(survived)}" if survived else f"caught by {', '.join(by.values())}"


def main(arguments=None):
    """Try the defects asked for and print a summary; 1 if one is not caught."""
    parser = argparse.ArgumentParser(prog="tests/defects", description=__doc__)
    parser.add_argument("words", nargs="*", help="parts of the names of the defects; all unless given")
    parser.add_argument(
        "--list", action="store_true", help="show the names and whether their places are found, and try none"
    )
    parser.add_argument("--fast", action="store_true", help="do not try whether the tests pass without the defect")
    asked = parser.parse_args(arguments)
    known = tomllib.loads((Path(__file__).parent / "defects.toml").read_text())["defect"]
    chosen = [d for d in known if not asked.words or any(word in d["name"] for word in asked.words)]
    if asked.list:
        places = [(d, (ROOT / d["file"]).read_text().count(d["before"])) for d in chosen if (ROOT / d["file"]).exists()]
        print(*(f"{d['name']}: {count} times in {d['file']}" for d, count in places), sep="\n")
        return int(len(places) < len(chosen) or any(count != 1 for _, count in places))
    fates = Counter()
    with tempfile.TemporaryDirectory() as place:
        tree = Path(shutil.copytree(ROOT, Path(place, "tree"), ignore=LEFT_OUT))
        for defect in chosen:
            began = time.perf_counter()
            found = fate(tree, defect, sound=not asked.fast)
            fates[found.split(":")[0].split(" ")[0]] += 1
            print(f"{defect['name']}: {found} ({time.perf_counter() - began:.0f} s)", flush=True)
    print(f"{len(chosen)} defects: {', '.join(f'{count} {end}' for end, count in fates.most_common())}")
    return int(fates["caught"] < len(chosen) or not chosen)


if __name__ == "__main__":
    sys.exit(main())
