"""The solvers need four libraries; what the commands need besides comes with an extra, and they say with which."""

import subprocess
import sys
from dataclasses import replace

import pytest

from fem_adhesion import cli
from fem_adhesion.speed import command as speed

EXTRA = ("rich", "matplotlib", "loky", "plotille", "pint", "jinja2", "markupsafe", "PIL")
BLOCKED = f"""
import sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {EXTRA}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Blocked())
"""


def without_the_extra(code):
    return subprocess.run([sys.executable, "-c", BLOCKED + code], capture_output=True, text=True)


def test_each_library_of_the_extra_is_named_with_it(monkeypatch, refused):
    def missing(_):
        raise ModuleNotFoundError(f"No module named {library!r}", name=f"{library}.part")

    monkeypatch.setattr(cli, "COMMANDS", (replace(speed.COMMAND, run=missing),))
    for library in EXTRA:
        said = f"fem-adhesion: {library}.part is not installed; pip install '.[studies]' in a clone\n"
        assert refused("speed --out out") == said


def test_a_curve_is_traced_without_the_extra():
    done = without_the_extra(
        "import halfspace, fem_adhesion\n"
        "path = fem_adhesion.trace(fem_adhesion.Scene(1.0), rtol=1e-2)\n"
        "print(abs(path.event('pull_off').load - halfspace.trace(1.0, rtol=1e-2).event('pull_off').load) < 0.02)"
    )
    assert (done.stdout, done.stderr) == ("True\n", "")


@pytest.mark.parametrize("line", ["curve --tabor 1", "report --html out.html"])
def test_a_command_without_the_extra_says_what_to_install(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = without_the_extra(f"from fem_adhesion import cli\nsys.exit(cli.main({line.split()}))")
    assert done.returncode == 2
    assert done.stderr.startswith("fem-adhesion: ")
    assert done.stderr.endswith(" is not installed; pip install '.[studies]' in a clone\n")
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())
