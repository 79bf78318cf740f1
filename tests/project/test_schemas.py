"""Every key and column that a command writes is explained on the page of files, with its unit, and nothing else is."""

import csv
import json
import re
import shlex
from fnmatch import fnmatchcase

import numpy as np
import pytest
from synthetic_curves import synthetic, write
from whole_runs import COMPARE, GREENWOOD, ROOT

from fem_adhesion import cli
from fem_adhesion.common.record import SCHEMA, read
from fem_adhesion.fitting.model import Apparatus
from halfspace import atlas

SECTIONS = dict(
    re.split(r"\n", part, maxsplit=1) for part in (ROOT / "docs/reference/files.md").read_text().split("\n## ")[1:]
)
SI = "--radius 100nm --modulus 72GPa --poisson 0.17 --work-of-adhesion 0.063J/m^2 --spacing 0.143nm"
TIP = "--radius 50nm --modulus 5GPa --poisson 0.3 --stiffness 2N/m"
SOFT = "--radius 2um --modulus 1MPa --poisson 0.4+-0.01 --work-of-adhesion 0.05+-0.01J/m^2 --spacing 0.3nm"
LINES = {
    "curve": [
        "curve --tabor 1 --rtol 1e-2 --json c.json --csv c.csv",
        f"curve {SI} --stiffness 1N/m --rtol 1e-2 --solver fem --stress axis st.csv --json s.json --csv s.csv",
    ],
    "assess": [f"assess {SI} --json a.json", f"assess {SOFT} --stiffness 0.5N/m --thickness 1um --json b.json"],
    "sweep": ["sweep --tabor 0.5 1 --csv s.csv"],
    "benchmark": ["benchmark --problems sheets --names half-space-1", "benchmark {given}/their.csv --json b.json"],
    "fit": [
        f"fit {{given}}/one.csv {TIP} --models jkr --json one.json",
        f"fit {{given}}/one.csv {{given}}/two.csv {TIP} --models jkr --csv many.csv --json many.json",
    ],
}
"""Lines by section: between them they have every key."""
WHOLE = {
    "compare": COMPARE,
    "finite-sphere": "fem-adhesion finite-sphere --out sphere --quick",
    "speed": "fem-adhesion speed --out speed --quick",
    "greenwood": GREENWOOD,
}
"""Lines that other tests run, too."""


def documented(section):
    """Patterns and units of the tables of a section."""
    rows = [[cell.strip() for cell in row.split("|")[1:-1]] for row in re.findall(r"^\|.*\|$", SECTIONS[section], re.M)]
    return {key: unit.split(", ") for keys, unit, *_ in rows for key in re.findall("`([^`]+)`", keys)}


def keys_of(value, path=""):
    """Keys of JSON within each other, `a.b`, each with the unit beside its number, or none."""
    if isinstance(value, dict) and value and "value" not in value:
        for key, inside in value.items():
            yield from keys_of(inside, f"{path}.{key}".lstrip("."))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for inside in value:
            yield from keys_of(inside, path)
    else:
        yield path.removesuffix("_error"), value.get("unit") if isinstance(value, dict) else None
        if isinstance(value, dict) and "correlation" in value:
            yield f"{path}.correlation", None


def explained(name, unit, rows):
    """Pattern that explains a key or a column, the longest, or None."""
    found = []
    for pattern, units in rows.items():
        by_unit = any(fnmatchcase(name, f"{pattern}_{one.replace(' ', '_')}") for one in units if one)
        if by_unit or (fnmatchcase(name, pattern) and (unit is None or unit in units)):
            found.append(pattern)
    return max(found, key=len, default=None)


def require_explained(section, folder):
    """Each key of the folder's files is explained, and each row of the section needed."""
    own, everywhere = documented(section), documented("In every file")
    used, lost = set(), set()
    for file in (file for kind in ("json", "csv") for file in folder.rglob(f"*.{kind}") if file.parent.name != "cases"):
        if file.suffix == ".json":
            found = dict.fromkeys(keys_of(json.loads(file.read_text())))
        else:
            with file.open() as text:
                found = [(re.sub("_error(?=_|$)", "", column), None) for column in next(csv.reader(text))]
        for name, unit in found:
            pattern = explained(name, unit, own) or explained(name, unit, everywhere)
            used.add(pattern)
            lost |= set() if pattern else {f"{file.name}: {name} {unit or ''}"}
    assert sorted(lost) == []
    assert sorted(own.keys() - used) == []


def require_record(folder, *lines):
    """Each file says how it is made again, with which options and versions, but stress and what is to be filled in."""
    files = [file for kind in ("json", "csv") for file in folder.rglob(f"*.{kind}")]
    files = [file for file in files if file.parent.name not in ("cases", "sheets") and file.name != "st.csv"]
    for file in (file for file in files if not file.name.endswith("-metadata.json")):
        found = read(file)
        assert found.keys() >= {"schema", "command", "versions", "scene", "options", "units"}, file
        assert found["schema"] == SCHEMA
        assert found["versions"].keys() >= {"python", "fem-adhesion", "numpy"}
        (line,) = (line for line in lines if shlex.split(found["command"])[1:] == shlex.split(line))
        words = shlex.split(line)
        if "--rtol" in words:
            assert found["options"]["rtol"] == float(words[words.index("--rtol") + 1])


def written(folder):
    """What the lines need: two force curves, and a table for the benchmark."""
    truth = Apparatus(50e-9, 5e9, 0.05, 0.3e-9, 0.0, 2.0, poisson=0.3)
    for seed, name in enumerate(("one.csv", "two.csv")):
        curve = synthetic(truth, np.random.default_rng(seed), noise=5e-11, count=200)
        write(folder / name, curve)
    load = float(atlas.pull_off(1.0).load)
    (folder / "their.csv").write_text(f"problem,quantity,value\nhalf-space-1,pull_off_load,{load:.6f}\n")


@pytest.mark.parametrize("section", LINES)
def test_each_key_of_a_file_is_explained_and_no_other(section, tmp_path, monkeypatch):
    given, made = tmp_path / "given", tmp_path / "made"
    given.mkdir(), made.mkdir()
    written(given)
    monkeypatch.chdir(made)
    lines = [line.format(given=given) for line in LINES[section]]
    for line in lines:
        assert cli.main(shlex.split(line)) == 0
    require_explained(section, made)
    require_record(made, *lines)


@pytest.mark.parametrize("section", WHOLE)
def test_each_column_of_a_study_is_explained_and_no_other(section, whole):
    run = whole(WHOLE[section])
    assert run.code == 0, run.err
    require_explained(section, run / "")
    require_record(run / "", WHOLE[section].removeprefix("fem-adhesion "))
