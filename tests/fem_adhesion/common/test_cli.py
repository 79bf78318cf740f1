import os
import subprocess
import sys
from dataclasses import fields
from importlib.metadata import version
from pathlib import Path

import pytest

from fem_adhesion import cli
from fem_adhesion.common.files import directory_written_aside, written_aside
from fem_adhesion.common.jobs import ONE_THREAD
from fem_adhesion.crosscheck import scenes as beside
from halfspace.errors import NotConverged
from halfspace.laws import Morse


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--tabor 0", "tabor = 0 is outside 0 < tabor"),
        ("--tabor nan", "tabor = nan"),
        ("--tabor", "argument --tabor: expected at least one argument"),
        ("--tabor soft", "invalid float value: 'soft'"),
        ("--poisson 0.5", "poisson = 0.5 is outside 0 <= poisson < 0.5"),
        ("--rtol 1e-10", "rtol = 1e-10 is outside 1e-9 <= rtol <= 0.1"),
        ("--json /no/such/folder/record.json", "cannot be written"),
        ("--json .", "is a directory; give the name of a file"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_any_work(arguments, message, monkeypatch, refused):
    monkeypatch.setattr(beside, "run", lambda *_, **__: pytest.fail("work was begun"))
    refused("compare", arguments, words=message)


@pytest.mark.parametrize(
    ("arguments", "code", "out", "err"),
    [
        ("--version", 0, f"fem-adhesion {version('fem-adhesion')}\n", ""),
        (
            "compare --tabor 0",
            2,
            "",
            "fem-adhesion: tabor = 0 is outside 0 < tabor; give the Tabor parameter of the contact\n",
        ),
    ],
)
def test_the_package_runs_as_a_module(arguments, code, out, err):
    command = [sys.executable, "-m", "fem_adhesion", *arguments.split()]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (code, out, err)


@pytest.mark.parametrize("command", ["speed", "greenwood"])
def test_an_output_that_cannot_be_is_refused_before_any_work(command, tmp_path, monkeypatch, refused):
    for work in ("speed.study.measure", "greenwood.study.compute"):
        monkeypatch.setattr(f"fem_adhesion.{work}", lambda *_, **__: pytest.fail("work was begun"))
    (tmp_path / "precious").write_text("kept")
    refused(command, "--out", tmp_path, words="use --force")
    assert [file.name for file in tmp_path.iterdir()] == ["precious"]


def test_files_and_directories_have_the_usual_modes(tmp_path):
    with written_aside(tmp_path / "file") as aside, directory_written_aside(tmp_path / "directory") as folder:
        aside.write("new")
        (folder / "one").touch()
    mask = os.umask(0)
    os.umask(mask)
    for name, mode in (("file", 0o666), ("directory", 0o777)):
        assert (tmp_path / name).stat().st_mode & 0o777 == mode & ~mask


@pytest.mark.parametrize("command", [[], ["curve"]], ids=["all", "curve"])
def test_help_does_not_load_the_solvers(command):
    """Nothing heavy is loaded, so that help answers at once on any machine."""
    code = (
        "import sys; from fem_adhesion import cli\n"
        f"try: cli.main([*{command}, '--help'])\nexcept SystemExit: pass\n"
        "heavy = ('skfem', 'numpy', 'scipy', 'rich', 'matplotlib', 'meshio', 'pint', 'importlib.metadata')\n"
        "print([m for m in heavy if m in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "usage: fem-adhesion" in done.stdout
    assert done.stderr.strip() == "[]"


def _threads_of(command, **settings):
    """How many threads a command leaves in its process, and whether it has set how many BLAS may start."""
    code = f"""
import os
from fem_adhesion.cli import main
main({command.split()})
print(len(os.listdir("/proc/self/task")), "OPENBLAS_NUM_THREADS" in os.environ)
"""
    free = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=free | settings)
    number, is_set = done.stdout.split()[-2:]
    return int(number), is_set == "True"


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are counted by Linux")
def test_a_command_keeps_blas_to_one_thread_unless_told():
    assert _threads_of("curve --tabor 0.1 --rtol 1e-2") == (1, True)
    assert not _threads_of("words", OMP_NUM_THREADS="2")[1]


MATERIAL = "--radius 100nm --modulus 70GPa --poisson 0.17 --work-of-adhesion 0.1J/m^2"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("", "--radius, --modulus, --poisson, --work-of-adhesion, --spacing or --hamaker missing"),
        (f"{MATERIAL} --spacing -0.3nm", "spacing = -0.3nm is outside 0 < spacing < inf"),
        (f"{MATERIAL} --spacing 1nm --json a.svg --plot other/../a.svg", "is given for two outputs"),
        (
            f"{MATERIAL} --spacing 0.001nm --grip bonded",
            "--grip would have no effect, limit: tabor <= 10, where a finite sphere is solved, and this is 57.74",
        ),
    ],
)
def test_assess_refuses_in_one_line_before_any_work(arguments, message, monkeypatch, refused, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("fem_adhesion.assess.study.assess", lambda *_: pytest.fail("work was begun"))
    refused("assess", arguments, words=message)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (f"curve {MATERIAL} --spacing 1nm --radius 1e-30nm", "is outside 1e-10 m <= radius"),
        (f"curve {MATERIAL} --spacing 1nm --radius -100nm", "radius = -100nm is outside 0 < radius"),
        ("curve --adhesion 1J/m^2", "curve: unrecognized arguments: --adhesion 1J/m^2 (did you mean --work-of-"),
        ("curve --tabor 1 --solver fe", "(did you mean fem?)"),
        ("", "required: command"),
    ],
)
def test_what_is_not_known_is_answered_with_the_nearest(arguments, message, refused):
    refused(arguments, words=message)


def test_every_option_of_a_contact_is_heeded(monkeypatch):
    """Every number distinct, read back from the contact that is assessed."""
    asked = []
    monkeypatch.setattr("fem_adhesion.assess.study.assess", lambda contact, *_: asked.append(contact))
    other = "--counter-modulus 3GPa --counter-poisson 0.41 --counter-radius 0.7um --grip bonded --stiffness 0.2N/m"
    with pytest.raises(AttributeError):
        cli.main(f"assess {MATERIAL} --spacing 1nm {other} --law morse:3.3".split())
    assert {field.name: getattr(asked[0], field.name) for field in fields(asked[0])} == {
        "radius": pytest.approx(1e-7),
        "modulus": pytest.approx(7e10),
        "poisson": 0.17,
        "work_of_adhesion": pytest.approx(0.1),
        "spacing": pytest.approx(1e-9),
        "counter_modulus": pytest.approx(3e9),
        "counter_poisson": 0.41,
        "counter_radius": pytest.approx(7e-7),
        "stiffness": pytest.approx(0.2),
        "grip": "bonded",
        "law": Morse(3.3),
        "thickness": None,
        "foundation": "bonded",
        "profile": None,
        "mesh": None,
    }


def test_what_does_not_converge_is_one_line_and_exit_code_1(monkeypatch, refused):
    def fail(*_, **__):
        raise NotConverged("no convergence in 40 Newton steps; try a nearer start")

    monkeypatch.setattr("fem_adhesion.curve.solve.solve", fail)
    said = "fem-adhesion: no convergence in 40 Newton steps; try a nearer start; nothing was written\n"
    assert refused("curve", "--tabor", "1", "--json", "-", code=1) == said
