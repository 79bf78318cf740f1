"""What is printed fits the terminal: columns are left out by rank and said to be, numbers, units and verdicts whole."""

import fcntl
import io
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from dataclasses import replace

import pytest
from rich.console import Console

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.page import Table
from fem_adhesion.common.terminal import WIDE, Column, Fitted, Flow, make_console, page, prose
from fem_adhesion.crosscheck.comparison import Row, cells, crosscheck_tables
from halfspace.values import Estimate

WIDTHS = [150, 60, 20]


def shown(what, width):
    console = Console(width=width, file=io.StringIO())
    console.print(what, crop=False)  # so that what is too wide is seen
    text = console.file.getvalue()
    assert "…" not in text
    assert max(map(len, text.splitlines()), default=0) <= width
    return text


MADE_UP = Fitted(
    [
        Column("quantity", ["first one", "second one"], text=True),
        Column("seldom\nfoot", ["1.11111111(1)", "2.22222222(2)"], 3),
        Column("often", ["3.33333333(3)", "4.44444444(4)"], 1),
        Column("rare", ["5.55555555(5)", "6.66666666(6)"], 3),
        Column("verdict", ["agree", "disagree"], text=True),
    ],
    ["title one", "R = 100 nm"],
    ["the caption"],
)


def left_out_of(text):
    """Columns that are said to be left out."""
    found = re.search(r"left out at this width: (.*?)( the caption| The end|$)", " ".join(text.split()))
    return found[1].split(", ") if found else []


@pytest.mark.parametrize("width", range(14, 100, 3))
def test_columns_go_by_rank_and_cells_are_whole(width):
    text = shown(MADE_UP, width)
    assert max(map(len, text.splitlines())) <= width
    names = left_out_of(text)
    assert names in ([], ["seldom foot", "rare"], ["seldom foot", "often", "rare"])
    for column in MADE_UP.columns:
        kept = " ".join(column.header.split()) not in names
        assert all(all(word in text for word in cell.split()) == kept for cell in column.cells), column.header


def test_a_table_that_fits_leaves_nothing_out():
    assert "left out" not in shown(MADE_UP, 80)
    assert "┃" in shown(MADE_UP, 80)
    assert "left out" not in shown(MADE_UP, 62)  # without its frame
    assert "left out at this width: seldom foot, rare" in shown(MADE_UP, 50)


def test_a_line_is_broken_between_its_parts_only():
    for width in range(11, 40):
        lines = shown(Flow(["R = 100 nm", "E* = 7 GPa", "[bold]x[/] = 1"]), width).splitlines()
        parts = [part for line in lines for part in re.split(r";\s*", line.strip()) if part]
        assert parts == ["R = 100 nm", "E* = 7 GPa", "x = 1"]


@pytest.mark.parametrize(
    "whole", ["95.6 %,", "2.898(2) R dgamma eps", "100 nm", "0.2 N/m", "1.36 s", "65 zJ", "63 mJ/m^2", "5130 unknowns,"]
)
def test_a_number_is_not_parted_from_its_unit(whole):
    text = f"the model is off by up to {whole} and [so] on"
    for width in range(len(whole), 60):
        lines = shown(prose(text), width).splitlines()
        assert any(whole in line for line in lines), width
        assert " ".join(" ".join(lines).split()) == text


@pytest.mark.parametrize("width", range(22, 80, 4))
def test_a_cell_is_not_broken_between_a_number_and_its_unit(width):
    cell = "spacing 0.229 beta at the edge exceeds 0.175 beta, [red]loads to 20 R dgamma[/] \\[so]"
    text = shown(Fitted([Column("name", ["a"], text=True), Column("cell", [cell], text=True, wraps=True)]), width)
    assert all(
        any(whole in line for line in text.splitlines()) for whole in ("0.229 beta", "0.175 beta,", "20 R dgamma")
    )
    plain = "spacing 0.229 beta at the edge exceeds 0.175 beta, loads to 20 R dgamma [so]"
    assert [
        word for word in re.findall(r"[^\s│┃━─┏┓┳┡╇┩└┘┴]+", text) if word not in ("name", "a", "cell")
    ] == plain.split()


@pytest.fixture(scope="module")
def case(cases_of):
    """A case with all values distinct and every verdict."""
    (solved,) = cases_of(0.5)
    rows = (
        Row("first load", "R dgamma", Estimate(-1.2345678, 1e-7), Estimate(-1.2345679, 2e-7), 1.1e-7, 6.6e-5),
        Row("second load", "J", Estimate(2.3456789, 3e-7), Estimate(2.3999999, 4e-7), 5.5e-2, 7.7e-5),
        Row("third gap", "eps", Estimate(3.456, 1.2e-3), Estimate(3.457, 3.4e-3), 5.6e-4, 7.8e-6),
        Row("fourth gap", "beta", Estimate(4.567, 1.3e-3), None, float("nan"), 8.8e-6),
    )
    return replace(solved, rows=rows)


@pytest.mark.parametrize("width", WIDTHS)
def test_the_verdicts_of_a_comparison_are_whole_at_any_width(case, width):
    text = shown(crosscheck_tables(case)[0], width)
    for row in case.rows:
        assert re.search(rf"\b{row.verdict}\b", text)
    flat = " ".join(text.split())
    known = {word for row in case.rows for cell in cells(row) for word in cell.split()}
    caption = re.findall(r"\d\.\d+", " ".join(crosscheck_tables(case)[0].caption))
    assert set(re.findall(r"-?\d\.\d+(?:e-\d\d)?", text)) <= known | {"0.5", "0.3", *caption}
    values = {cells(row)[2] for row in case.rows}
    assert values <= set(flat.split()) or "half-space" in flat.split("left out at this width:")[1]
    if width >= 60:
        assert values <= set(flat.split())


PARTS = (
    "# A page",
    "* a bullet [1]",
    Table(
        "",
        "Costs",
        "",
        ("method", "to 1e-03", "best reached"),
        (
            ("half-space", "0.25 s = 34 yardsticks (rtol 1e-04)", "1e-09 in 0.5 s (rtol [x])"),
            ("simple relaxation", "-", "7e-02 in 8.5 s (n = 20)"),
        ),
    ),
    "The end.",
)


@pytest.mark.parametrize("width", WIDTHS)
def test_a_page_is_shown_with_its_tables_fitted(width):
    text = "".join(shown(part, width) for part in page(PARTS))
    for word in ("# A page", "* a bullet [1]", "## Costs", "half-space", "simple", "relaxation", "The end."):
        assert word in text
    assert "|" not in text
    lines = [line.strip() for line in text.splitlines()]
    above, below = lines.index("## Costs") - 1, lines.index("## Costs") + 1
    assert (lines[above], lines[below]) == ("", "")
    left_out = left_out_of(text)
    for name, cells_ in (("to 1e-03", ("0.25 s", "= 34", "yardsticks")), ("best reached", ("1e-09 in", "7e-02 in"))):
        assert all(cell in text for cell in cells_) != (name in left_out), (name, width)


def test_the_bar_says_what_is_under_way_and_what_is_left(monkeypatch, capsys):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "80")
    with progress_bar() as step:
        step("sphere, tabor 1", 3, 5)
    shown_last = capsys.readouterr().err
    for words in ("sphere, tabor 1", "3/5", "left:", "-:--:--"):
        assert words in shown_last
    with progress_bar() as step:  # no terminal, no bar
        monkeypatch.delenv("FORCE_COLOR")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("to_error", [False, True])
def test_without_a_terminal_there_is_room_unless_said_otherwise(to_error, monkeypatch):
    monkeypatch.delenv("COLUMNS", raising=False)
    assert make_console(to_error=to_error).width == WIDE
    assert make_console(to_error=to_error).stderr == to_error
    monkeypatch.setenv("COLUMNS", "72")
    assert make_console(to_error=to_error).width == 72


def on_a_terminal(width, *arguments):
    """What a command writes on a pseudo-terminal of a width, without the sequences that move and colour."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 50, width, 0, 0))
    environment = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES", "NO_COLOR")}
    command = [sys.executable, "-m", "fem_adhesion", *arguments]
    with subprocess.Popen(command, stdout=theirs, stderr=theirs, env=environment | {"TERM": "xterm"}) as process:
        os.close(theirs)
        text = b""
        while chunk := _read(ours):
            text += chunk
    os.close(ours)
    assert process.returncode == 0
    return re.sub(r"\x1b\[[\d;?]*[A-Za-z]", "", text.decode()).replace("\r\n", "\n")


def _read(descriptor):
    """Bytes from a terminal, none when the other side has closed it."""
    try:
        return os.read(descriptor, 4096)
    except OSError:
        return b""


@pytest.mark.parametrize("width", [80, 60])
def test_a_curve_on_a_real_terminal_is_readable(width):
    text = on_a_terminal(width, "curve", "--tabor", "2", "--rtol", "1e-3")
    lines = [line.rpartition("\r")[2].rstrip() for line in text.splitlines()]
    assert "…" not in text
    assert max(map(len, lines)) <= width
    assert sum(line[9:10] == "│" for line in lines) == 18
    assert any(re.search(r"-4\.9750\d*\(\d+\)", line) for line in lines)
    assert any("R dgamma" in line for line in lines)
