"""Every command that README and docs show is run whole, as it stands there or in its quick form; its files are opened.

What is in the files is read back by the tests of each command, of the same run. Commands that `make docs` runs while it
builds the pages, and the scripts of the gallery, are not run once more: see test_docs.
"""

import ast
import csv
import itertools
import json
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest
import test_make
from comparisons import keep
from page_tables import value_and_error
from PIL import Image
from pyarrow import parquet
from whole_runs import COMPARE, GREENWOOD, REPORT, ROOT, tables_in

from fem_adhesion import cli

README = (ROOT / "README.md").read_text()
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]

MAKE, INSTALL = "make", "install"  # run by test_make; what the environment of the tests was installed with

# How each is run: as another line, which may only add --quick; by test_make; by what installs the tests' environment.
# What `make docs` runs is not run again, be it shown elsewhere as well.
LINES = {
    **dict.fromkeys((f"make {target}" for target in test_make.TARGETS if target != "clean"), MAKE),
    "make gallery ALL=1": MAKE,
    "pip install '.[studies]'": INSTALL,
    "pip install .": INSTALL,
    **{
        line: line
        for line in (
            COMPARE,
            REPORT,
            "fem-adhesion speed --out speed --quick",
            "fem-adhesion finite-sphere --out sphere --quick",
        )
    },
    "fem-adhesion greenwood --out greenwood": GREENWOOD,
}
(COMMANDS,) = [action for action in cli.make_parser()._actions if action.choices]
NAMES = tuple(COMMANDS.choices)
RUN = tuple(dict.fromkeys(run for run in LINES.values() if run not in (MAKE, INSTALL)))


def _shown():
    """Every command line of the pages but those that `make docs` runs: in blocks of the shell, and within the text."""
    shown, built = [], set()
    for page in PAGES:
        text = re.sub(r"\s*\\\n\s*", " ", page.read_text())
        built |= set(re.findall(r"^```\{run\}\n(?::.*\n)*(.*)$", text, re.M))
        blocks = "".join(re.findall(r"^```sh\n(.*?)^```", text, re.S | re.M)).splitlines()
        prose = re.sub(r"^ *```.*?^ *```", "", text, flags=re.S | re.M)
        blocks += re.findall(r"^    (\S.*)$", prose, re.M)
        inline = [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", prose)]
        shown += [line.split("  #")[0].strip() for line in (*blocks, *inline)]
    return {line for line in shown if re.match(r"(make|pip|fem-adhesion) ", line)} - built


def test_every_command_line_of_the_pages_is_run():
    named = {f"fem-adhesion {name}" for name in NAMES}
    assert sorted(_shown() - named) == sorted(LINES)


def test_a_line_is_run_as_it_stands_or_in_its_quick_form():
    for line, run in LINES.items():
        if run == MAKE:
            assert line.split()[1] in test_make.TARGETS
        elif run != INSTALL:
            assert run in (line, f"{line} --quick")


# --- what the commands leave ---


@pytest.mark.parametrize("line", RUN)
def test_a_command_of_the_pages_runs_to_its_end(line, whole):
    run = whole(line)
    assert run.code == 0, run.err
    assert run.out.strip()
    assert "Traceback" not in run.err
    assert "Warning" not in run.err
    (written,) = re.findall("^written: (.*)$", run.out, re.M)
    arguments = shlex.split(line)
    asked = [argument for flag, argument in itertools.pairwise(arguments) if flag in FILES]
    left = [file for file in Path(run.directory).rglob("*") if file.is_file()]
    for name in asked:
        assert (run / name).exists()
        assert name in written
    for file in left:
        OPENED[file.suffix](file)
    assert bool(left) == bool(asked)
    records = {f"{name}-metadata.json" for name in asked if name.endswith(".csv")}
    assert {file.relative_to(run.directory).parts[0] for file in left} == {*asked, *records}


FILES = ("--plot", "--json", "--csv", "--vtk", "--render", "--movie", "--out", "--problems", "--html")


def _open_json(file):
    def refuse(constant):
        raise ValueError(f"{constant} is no JSON")

    assert json.loads(file.read_text(), parse_constant=refuse)


def _open_csv(file):
    with file.open() as lines:
        reader = csv.DictReader(line for line in lines if not line.startswith("#"))
        rows = list(reader)
    assert reader.fieldnames
    assert rows or file.name == "failures.csv"
    for row in rows:
        assert None not in row, "a line longer than the header"
        assert None not in row.values(), "a line shorter than the header"
        assert "nan" not in row.values()


def _open_picture(file):
    with Image.open(file) as picture:
        assert min(picture.size) > 200
        assert len(picture.convert("RGB").resize((64, 64)).getcolors(4096)) > 10


def _open_page(file):
    text = file.read_text()
    assert text.lstrip().lower().startswith("<!doctype html>")
    assert text.rstrip().endswith("</html>")
    assert "{{" not in text


def _open_emitted(file):
    text = file.read_text()
    assert text.endswith("\n")
    assert "Made by fem-adhesion" in text
    assert not re.search(r"\$\w", text), "a name that nothing stands for"


OPENED = {
    ".json": _open_json,
    ".jsonl": lambda file: [json.loads(line) for line in file.read_text().splitlines()],
    ".csv": _open_csv,
    ".png": _open_picture,
    ".html": _open_page,
    ".parquet": lambda file: parquet.read_table(file).num_rows or pytest.fail("an empty table"),
    ".py": lambda file: ast.parse(file.read_text()),
    **dict.fromkeys((".h", ".c", ".f90", ".tex"), _open_emitted),
    ".md": lambda file: file.read_text().strip() or pytest.fail("an empty page"),
    **dict.fromkeys((".svg", ".vtu", ".vtp", ".vtk", ".pvd"), ElementTree.parse),
}


def test_the_report_takes_what_other_commands_left(whole, monkeypatch, tmp_path, capsys):
    lines = {shlex.split(run)[1]: run for run in RUN if "--out" in run} | {"hard": test_make.HARD}
    made = {name: whole(lines[name]) for name in ("speed", "hard", "greenwood", "finite-sphere")}
    given = [f"--{name}={run / name.replace('finite-', '')}" for name, run in made.items()]
    page = tmp_path / "report.html"
    keep(*whole.args, monkeypatch)
    assert cli.main(["report", "--html", str(page), "--tabor", "0.5", "--walk", "0.05", *given]) == 0
    assert "verdict: agree" in capsys.readouterr().out
    text = page.read_text()
    for name in made:
        assert f"--{name} " not in text, "a section that says how to compute it"
    cases = json.loads((made["hard"] / "hard/hard.json").read_text())["cases"]
    refused = sum(row["outcome"] == "refused" for row in cases)
    assert f"Of {len(cases)} cases: {len(cases) - refused} converged, {refused} refused." in text


# --- what the README says of them ---


def test_the_table_of_the_readme_is_what_make_compare_prints(whole):
    """Values to the digits that both show; differences and errors, which rounding moves, to their magnitude."""
    (shown,) = re.findall(r"^\| quantity \| half-space \|.*?\n\|[-:|]+\n(.*?)\n\n", README, re.M | re.S)
    tables = tables_in(whole(test_make.COMPARE).out)
    solvers = [table for table in tables if {"half-space", "finite elements"} <= table[0].keys()]
    by_triangles = [table for table in tables if {"overlapping triangles", "finite elements"} <= table[0].keys()]
    printed = {row["quantity"]: row for row in solvers[3]}  # of the Tabor parameter 2
    for row in by_triangles[3]:
        printed[row["quantity"]] = row | {"half-space": row["overlapping triangles"]}
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in shown.splitlines()]
    assert len(lines) == 6
    for quantity, *values, difference, budget, verdict in lines:
        row, errors = printed[quantity], []
        for source, cell in zip(("half-space", "finite elements"), values, strict=True):
            (value, error), (now, now_error) = value_and_error(cell), value_and_error(row[source])
            assert value == pytest.approx(now, abs=2 * error)
            assert error == pytest.approx(now_error, rel=1.0)  # one digit is printed
            errors.append(error)
        assert float(difference) <= sum(errors)
        assert (budget, verdict) == (row["budget"], row["verdict"])


@pytest.mark.parametrize("link", sorted(set(re.findall(r"\]\(([^)]+)\)", README))))
def test_a_link_of_the_readme_leads_somewhere(link):
    assert (ROOT / link).exists()


def test_the_readme_is_short():
    assert len(README.splitlines()) <= 120


@pytest.mark.parametrize("name", NAMES)
def test_the_example_of_a_help_text_can_be_run(name, capsys):
    """Argument by argument; the examples are those of the README or shorter."""
    with pytest.raises(SystemExit):
        cli.main([name, "--help"])
    shown = " ".join(capsys.readouterr().out.split())
    assert not re.search("None|False", shown), "defaults are told in words"
    example = re.search(r"example: (fem-adhesion .*)$", shown)[1]
    assert callable(cli.make_parser().parse_args(shlex.split(example)[1:]).run)
