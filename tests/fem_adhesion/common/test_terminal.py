"""What is printed fits the terminal: tables or lists, numbers, units and verdicts whole."""

import fcntl
import io
import os
import pty
import re
import struct
import subprocess
import sys
import termios

import made_up
import pytest
from rich.console import Console

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.page import Table
from fem_adhesion.common.terminal import WIDE, Column, Fitted, Prose, flow, make_console, page
from fem_adhesion.crosscheck.comparison import cells, crosscheck_tables

WIDTHS = [150, 100, 80, 20]


def shown(what, width):
    console = Console(width=width, file=io.StringIO())
    console.print(what, crop=False)  # so that what is too wide is seen
    text = console.file.getvalue()
    assert "…" not in text
    assert max(map(len, text.splitlines()), default=0) <= width
    return text


MADE_UP = Fitted(
    [
        Column("quantity", ["first one", "second one"], words=True),
        Column("seldom\nfoot", ["1.11111111(1)", "2.22222222(2)"]),
        Column("often", ["3.33333333(3)", "4.44444444(4)"]),
        Column("verdict", ["agree", "disagree"], words=True),
    ],
    ["title one", "R = 100 nm"],
    ["the caption"],
)


@pytest.mark.parametrize("width", range(22, 104, 3))
def test_cells_are_whole_in_a_table_or_a_list(width):
    text = shown(MADE_UP, width)
    first, *others = MADE_UP.columns
    for cells_ in (first.cells, *((column.header, *column.cells) for column in others)):
        assert all(word in text for cell in cells_ for word in cell.split()), cells_
    assert ("───" in text) == (width >= 47)
    assert ("━━━" in text) == (width >= 100)


def test_a_list_names_each_number():
    text = " ".join(shown(MADE_UP, 30).split())
    assert "second one; seldom foot: 2.22222222(2); often: 4.44444444(4); verdict: disagree" in text


def test_a_line_is_broken_between_its_parts_only():
    for width in range(11, 40):
        lines = shown(flow(["R = 100 nm", "E* = 7 GPa", "[x] = 1"]), width).splitlines()
        parts = [part for line in lines for part in re.split(r";\s*", line.strip()) if part]
        assert parts == ["R = 100 nm", "E* = 7 GPa", "[x] = 1"]


@pytest.mark.parametrize(
    "whole", ["95.6 %,", "2.898(2) R dgamma eps", "100 nm", "0.2 N/m", "1.36 s", "65 zJ", "63 mJ/m^2", "5130 unknowns,"]
)
def test_a_number_is_not_parted_from_its_unit(whole):
    text = f"the model is off by up to {whole} and [so] on"
    for width in range(len(whole), 60):
        lines = shown(Prose(text), width).splitlines()
        assert any(whole in line for line in lines), width
        assert " ".join(" ".join(lines).split()) == text


@pytest.mark.parametrize("width", range(22, 80, 4))
def test_a_cell_is_not_broken_between_a_number_and_its_unit(width):
    cell = "spacing 0.229 beta at the edge exceeds 0.175 beta, loads to 20 R dgamma [so]"
    text = shown(Fitted([Column("name", ["a"], words=True), Column("cell", [cell], words=True)]), width)
    assert all(
        any(whole in line for line in text.splitlines()) for whole in ("0.229 beta", "0.175 beta,", "20 R dgamma")
    )


@pytest.mark.parametrize("width", WIDTHS)
def test_the_verdicts_of_a_comparison_are_whole_at_any_width(width):
    case = made_up.case(made_up.AGREE, made_up.DISAGREE, made_up.WIDE, made_up.MISSING)
    flat = " ".join(shown(crosscheck_tables(case)[0], width).split())
    for row in case.rows:
        assert re.search(rf"\b{row.verdict}\b", flat)
    assert {cells(row)[1] for row in case.rows} <= set(re.split(r"[ ;]+", flat))
    assert ("half-space:" in flat) == (width == 20)  # a list where a table does not fit, but never at 80


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
    for cell in ("0.25 s", "34 yardsticks", "1e-09 in 0.5 s", "7e-02 in 8.5 s"):
        assert all(word in text for word in cell.split())


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


def test_a_curve_on_a_real_terminal_is_readable():
    text = on_a_terminal(60, "curve", "--tabor", "2", "--rtol", "1e-3")
    lines = [line.rpartition("\r")[2].rstrip() for line in text.splitlines()]
    assert "…" not in text
    assert max(map(len, lines)) <= 60
    assert sum(line[9:10] == "│" for line in lines) == 18
    assert any(re.search(r"-4\.9750\d*\(\d+\)", line) for line in lines)
    assert any("R dgamma" in line for line in lines)
