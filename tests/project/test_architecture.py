"""Every import goes down the floors of the house, as pyproject.toml has them, and every module has its floor."""

import ast
import itertools
import re
import tomllib
from pathlib import Path

from importlinter.cli import lint_imports

ROOT = Path(__file__).parents[2]
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
FLOORS = next(contract["layers"] for contract in CONTRACTS if contract["type"] == "layers")


def test_imports_keep_the_contracts(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert lint_imports(config_filename=str(ROOT / "pyproject.toml"), cache_dir=None) == 0, capsys.readouterr().out


def _rooms():
    for package in ("halfspace", "fem_adhesion"):
        for path in (ROOT / package).iterdir():
            if path.suffix == ".py" and path.name != "__init__.py":
                yield f"{package}.{path.stem}"
            elif (path / "__init__.py").exists():
                yield f"{package}.{path.name}"


def test_every_room_has_its_floor():
    on = {room: sum(room in re.split(r"[\s|:]+", floor) for floor in FLOORS) for room in _rooms()}
    assert on == dict.fromkeys(on, 1)


def _imports(module):
    path = ROOT / Path(*module.split("."))
    files = [path.with_suffix(".py")] if not path.is_dir() else path.rglob("*.py")
    for node in itertools.chain.from_iterable(ast.walk(ast.parse(file.read_text())) for file in files):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield f"{node.module}.{node.names[0].name}"


def test_the_fourth_level_imports_no_solver():
    """No physics, no numbers: exceptions, containers of results, limits, and the parts by which a scene is known."""
    own = {name for name in _imports("fem_adhesion.weak_form") if name.split(".")[0] in ("halfspace", "fem_adhesion")}
    own = {name for name in own if not name.startswith("fem_adhesion.weak_form.")}
    scene = {"fem_adhesion.scene.Scene", "halfspace.laws.LENNARD_JONES", "halfspace.profiles.Paraboloid"}
    results = {f"halfspace.{name}" for name in ("equilibrium.events.Event", "values.States", "values.Valued")}
    refusals = {"halfspace.errors.InputError", "halfspace.errors.NotConverged", "halfspace.limits.require_between"}
    assert own == scene | results | refusals


def test_the_harmonics_import_no_finite_elements():
    own = {name for name in _imports("fem_adhesion.harmonics") if name.split(".")[0] in ("skfem", "fem_adhesion")}
    assert own == {"fem_adhesion.scene.Scene"}
