"""What a command is asked to write means the same in all commands, and each says in one line what it wrote."""

import csv
import io
import json
import re
from collections import defaultdict

import pytest

from fem_adhesion import cli
from fem_adhesion.curve import pictures

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


# Others take long: test_readme reads the line of their quick forms, test_assess that of its own run.
TIP = "--radius 100nm --modulus 72GPa --poisson 0.17"
QUICK = {
    "curve": "--tabor 0.1 --rtol 1e-2 --json a.json --csv a.csv --plot a.svg --vtk fields --points 0 "
    "--render body.png --movie body.gif",
    "sweep": "--tabor 0.5 1 --csv a.csv --resume kept",
    "fit": f"{TIP} --nanite model.py",
    "formulas": "--out formulas",
    "benchmark": "--problems sheets --names half-space-1",
}
PLACES = {"curve": "fields", "formulas": "formulas", "benchmark": "sheets"}


@pytest.mark.parametrize("name", QUICK)
def test_a_command_says_in_one_line_what_it_wrote(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for kind in ("picture", "movie"):  # which take long
        monkeypatch.setattr(
            pictures, f"write_{kind}", lambda _, file, *_at, kind=kind: file.buffer.write(kind.encode())
        )
    line = [name, *QUICK[name].split()]
    assert cli.main(line) == 0
    out, err = capsys.readouterr()
    (told,) = re.findall("^written: (.*)$", out + err, re.M)
    place = PLACES.get(name)
    made = {file.name for file in tmp_path.iterdir() if file.is_file()}
    inside = f"{place}/ ({len(list((tmp_path / place).iterdir()))} files)" if place else ""
    assert set(told.replace(inside, "").split()) == made
    assert inside in told
    if name == "curve":  # which takes longest
        assert [(tmp_path / f"body.{kind}").read_text() for kind in ("png", "gif")] == ["picture", "movie"]
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
    assert cli.main([*line, "--points", "5", "--csv", "-"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert {row["solver"] for row in rows} == {"half-space"}
    assert sum(not row["event"] for row in rows) == 5
