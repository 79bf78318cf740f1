"""Wheel and sdist have all that is in the repository, and every command runs from the wheel alone."""

import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from importlib.metadata import version

import pytest
from whole_runs import ROOT

pytestmark = pytest.mark.skipif(int(version("setuptools").split(".")[0]) < 77, reason="the build needs setuptools 77")
BUILD = "from setuptools import build_meta as b; b.build_sdist('dist'); b.build_wheel('dist')"
RUN = """
import sys
import fem_adhesion
from fem_adhesion import cli
for command in cli.COMMANDS:
    try:
        cli.main([command.name, "--help"])
    except SystemExit as ended:
        assert ended.code == 0, command
code = cli.main(["formulas", "--out", "formulas"])
print(fem_adhesion.__file__)
sys.exit(code)
"""


def tracked():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return {name for name in listed.stdout.splitlines() if (ROOT / name).exists()}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Both distributions, of a copy of what is tracked."""
    place = tmp_path_factory.mktemp("distribution")
    for name in tracked():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes((ROOT / name).read_bytes())
    (place / "dist").mkdir()
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", BUILD], cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return place / "dist"


def described(place):
    """The description of the project that a package index shows."""
    (place / "metadata").mkdir()
    code = "from setuptools import build_meta as b; b.prepare_metadata_for_build_wheel('metadata')"
    subprocess.run([sys.executable, "-W", "ignore", "-c", code], cwd=place, capture_output=True, check=True)
    (file,) = (place / "metadata").rglob("METADATA")
    return file.read_text()


def test_links_lead_to_the_files_or_are_none_on_a_package_index(built, tmp_path):
    shutil.copytree(built.parent, tmp_path, dirs_exist_ok=True)
    assert re.findall(r"\]\((?!https?:|#)", described(tmp_path)) == []
    assert "](docs" in (tmp_path / "README.md").read_text()
    with (tmp_path / "pyproject.toml").open("a") as file:
        file.write('[project.urls]\nSource = "https://example.org/name/raw/main"\n')
    shutil.rmtree(tmp_path / "metadata")
    assert "](https://example.org/name/raw/main/docs/pictures/curve.png)" in described(tmp_path)


def test_the_sdist_has_all_but_dotfiles(built):
    (file,) = built.glob("*.tar.gz")
    with tarfile.open(file) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    assert {name for name in tracked() if not name.startswith(".")} <= inside


def test_every_command_runs_from_the_wheel_alone(built, tmp_path):
    (file,) = built.glob("*.whl")
    with zipfile.ZipFile(file) as wheel:
        inside = set(wheel.namelist())
        wheel.extractall(tmp_path / "site")
    assert {name for name in tracked() if name.startswith(("halfspace/", "fem_adhesion/"))} <= inside
    environment, run = {"PYTHONPATH": str(tmp_path / "site")}, [sys.executable, "-c", RUN]
    done = subprocess.run(run, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1].startswith(str(tmp_path / "site"))
