"""What a command is asked to write means the same in all commands, and each says in one line what it wrote."""

import csv
import io
import json
import re
from collections import defaultdict

import pytest

from fem_adhesion import cli

(COMMANDS,) = [action.choices for action in cli.make_parser()._actions if action.choices]
WRITTEN_DIRECTORIES = ("--out", "--problems", "--vtk")
SAID = ("--out", "--resume", "--force", "--jobs", "--dask")  # to be said in the same words too


def test_an_option_means_the_same_in_every_command():
    meanings = defaultdict(set)
    for parser in COMMANDS.values():
        for action in parser._actions:
            for name in action.option_strings:
                meanings[name].add((action.metavar, action.nargs, action.help if name in SAID else ""))
    files = {name: found for name, found in meanings.items() if {"FILE", "DIR"} & {each[0] for each in found}}
    assert {"--json", "--csv", "--plot", "--out", "--resume"} <= files.keys()
    for name in {*files, *SAID}:
        assert len(meanings[name]) == 1, name


@pytest.mark.parametrize("name", COMMANDS)
def test_force_goes_with_directories_that_are_written(name):
    options = COMMANDS[name]._option_string_actions
    assert ("--force" in options) == any(directory in options for directory in WRITTEN_DIRECTORIES)


# Others take long: their quick forms are run by test_readme, which reads the line too.
TIP = "--radius 100nm --modulus 72GPa --poisson 0.17"
QUICK = {
    "curve": "--tabor 0.1 --rtol 1e-2 --json a.json --csv a.csv --plot a.png --vtk fields --points 0",
    "sweep": "--tabor 0.5 1 --csv a.csv --resume kept",
    "assess": f"{TIP} --work-of-adhesion 0.063J/m^2 --hamaker 65zJ --json a.json --plot a.svg",
    "fit": f"{TIP} --nanite model.py",
    "formulas": "--out formulas",
    "benchmark": "--problems sheets --names half-space-1",
}
PLACES = {"curve": "fields", "formulas": "formulas", "benchmark": "sheets"}


@pytest.mark.parametrize("name", QUICK)
def test_a_command_says_in_one_line_what_it_wrote(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    line = [name, *QUICK[name].split()]
    assert cli.main(line) == 0
    out, err = capsys.readouterr()
    (told,) = re.findall("^written: (.*)$", out + err, re.M)
    place = PLACES.get(name)
    made = {file.name for file in tmp_path.iterdir() if file.is_file()}
    inside = f"{place}/ ({len(list((tmp_path / place).iterdir()))} files)" if place else ""
    assert set(told.replace(inside, "").split()) == made
    assert inside in told
    if name in ("curve", "assess"):  # which take longest
        return
    if place:
        assert cli.main(line) == 2
        assert f"{place} holds" in capsys.readouterr().err
        line.append("--force")
    assert cli.main(line) == 0
    assert capsys.readouterr().out.count("(replaced)") == len(made)


def test_words_leave_standard_output_to_data(tmp_path, capsys):
    table, line = tmp_path / "a.csv", ["curve", "--tabor", "0.1", "--rtol", "1e-2"]
    assert cli.main([*line, "--json", "-", "--csv", str(table)]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["scene"]
    assert f"written: {table} {table}-metadata.json\n" in err
    assert "pull-off" in err
    assert cli.main([*line, "--csv", "-"]) == 0
    assert next(csv.DictReader(io.StringIO(capsys.readouterr().out)))["solver"] == "half-space"
