"""Every command that the README shows is one, and those that finish in seconds do."""

import itertools
import re
import shlex
from pathlib import Path

import pytest

from fem_adhesion import cli

README = (Path(__file__).parents[1] / "README.md").read_text()
BLOCKS = re.findall(r"^    (fem-adhesion (?:[^\n\\]|\\\n)*)", README, re.M)
COMMANDS = list(dict.fromkeys(re.sub(r"\s*\\\n\s*", " ", block) for block in BLOCKS))
LONG = ("speed", "greenwood", "finite-sphere", "hard", "report")  # their own tests run them, smaller


def test_the_readme_shows_every_command():
    shown = {shlex.split(command)[1] for command in COMMANDS}
    names = {command.__name__.rsplit(".", 1)[1].replace("_", "-") for command in cli.COMMANDS}
    assert shown == names


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_of_the_readme_runs(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    arguments = shlex.split(command)[1:]
    options = cli.make_parser().parse_args(arguments)
    if arguments[0] in LONG:
        assert callable(options.run)
        return
    assert cli.main(arguments) == 0
    assert capsys.readouterr().out
    asked = [name for flag, name in itertools.pairwise(arguments) if flag in FILES]
    assert all((tmp_path / name).exists() for name in asked)


FILES = ("--plot", "--json", "--csv", "--vtk", "--render", "--movie")


@pytest.mark.parametrize("picture", re.findall(r"!\[[^\]]+\]\(([^)]+)\)", README))
def test_a_picture_of_the_readme_is_there(picture):
    assert (Path(__file__).parents[1] / picture).stat().st_size > 10_000


@pytest.mark.parametrize("command", cli.COMMANDS, ids=lambda command: command.__name__)
def test_the_example_of_a_help_text_can_be_run(command, capsys):
    """Argument by argument; the examples are those of the README or shorter."""
    name = command.__name__.rsplit(".", 1)[1].replace("_", "-")
    with pytest.raises(SystemExit):
        cli.main([name, "--help"])
    shown = " ".join(capsys.readouterr().out.split())
    example = re.search(r"example: (fem-adhesion .*)$", shown)[1]
    assert callable(cli.make_parser().parse_args(shlex.split(example)[1:]).run)
