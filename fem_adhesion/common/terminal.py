"""Text and tables that fit the terminal: columns are dropped by rank and said to be, numbers and units never cut."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, JustifyMethod, RenderableType, RenderResult
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from fem_adhesion.common import page as page_of

WIDE = 150  # columns where there is no terminal
LEAST = 14  # columns of text that may be wrapped, where it is so long
PAGE = 18  # the same of a cell of a page, in which a number and its unit stay together
NUMBER = re.compile(r"[(=-]*\d[\d.e+()-]*")
UNIT = re.compile(r"(%|[yzafpnµmkMGT]?(m|N|Pa|J|N/m|J/m\^2)|s|R|dgamma(/eps)?|eps|beta|unknowns|points)[.,;:)]*")


FRAMES: Sequence[tuple[Mapping[str, Any], int, int]] = (
    ({"box": box.HEAVY_HEAD}, 3, 1),
    ({"box": box.SIMPLE_HEAD, "show_edge": False, "pad_edge": False, "padding": (0, 0)}, 1, -1),
)
"""How rich frames a table, and how many columns of the terminal the frame takes for each of its own and in all."""


def make_console(*, to_error: bool = False) -> Console:
    """Console as wide as its terminal, or as the variable COLUMNS says, or `WIDE`."""
    known = (sys.stderr if to_error else sys.stdout).isatty() or "COLUMNS" in os.environ
    return Console(stderr=to_error, width=None if known else WIDE)


@dataclass(frozen=True)
class Flow:
    """Parts of a line in rich's markup, such as ``R = 100 nm``, that is broken between them only."""

    parts: Sequence[str]
    separator: str = "; "
    style: str = ""

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Lines, each with as many parts as fit."""
        del console
        line = Text(style=self.style)
        for number, part in enumerate(self.parts):
            end = "" if number == len(self.parts) - 1 else self.separator
            text = Text.from_markup(part + end)
            if line and line.cell_len + len(part + end.rstrip()) > options.max_width:
                line.rstrip()
                yield line
                line = Text(style=self.style)
            line.append_text(text)
        yield line


def prose(text: str) -> Flow:
    """Sentences that are broken between words, but not between a number and its unit."""
    return Flow([escape(part) for part in _words(text)], " ")


def _words(text: str) -> list[str]:
    """Words of a text, a number and its unit being one."""
    parts: list[str] = []
    glued = False  # whether the last word is a number, or the unit of one
    for word in text.split(" "):
        joins = glued and bool(UNIT.fullmatch(word))
        if joins:
            parts[-1] += f" {word}"
        else:
            parts.append(word)
        glued = joins or bool(NUMBER.fullmatch(word))
    return parts


def _wrapped(cell: str, width: int) -> Text:
    """Cell of a table in lines of a width, broken as `prose` is."""
    text, breaks, place = Text.from_markup(cell), [], 0
    for line in text.plain.split("\n"):
        used = 0
        for part in _words(line):
            if used and used + 1 + cell_len(part) > width:
                breaks.append(place)
                used = 0
            used += cell_len(part) + bool(used)
            place += len(part) + 1
    lines = text.divide(breaks)
    for part_of_text in lines:
        part_of_text.rstrip()
    return Text("\n").join(lines)


@dataclass(frozen=True)
class Column:
    """A column of a table, its header, with the unit below, and its cells in rich's markup.

    One of rank 0 stays; the higher, the sooner it is left out, columns of one rank together. Words (`text`) are set to
    the left, numbers to the right; what `wraps` may go on in the next line, and has so many columns of the terminal
    even so.
    """

    header: str
    cells: Sequence[str]
    rank: int = 0
    text: bool = False
    wraps: bool = False
    wrapped: int = LEAST

    @property
    def least(self) -> int:
        """Least width in which nothing is cut: that of a line, or where words may go on below of a word."""
        words = max(cell_len(word) for text in self._texts for line in text.split("\n") for word in _words(line))
        return max(words, min(self.wrapped, self.whole)) if self.wraps else self.whole

    @property
    def whole(self) -> int:
        """Width in which no line is broken."""
        return max(cell_len(line) for text in self._texts for line in text.split("\n"))

    @property
    def _texts(self) -> list[str]:
        return [Text.from_markup(text).plain for text in (self.header, *self.cells)]


@dataclass(frozen=True)
class Fitted:
    """A table that leaves out columns until it fits, and becomes a list where not even those of rank 0 do.

    The first column names the row; title and caption are parts of the lines above and below, styles those of the rows.
    """

    columns: Sequence[Column]
    title: Sequence[str] = ()
    caption: Sequence[str] = ()
    styles: Sequence[str] = ()

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Title, table or list, what was left out, and caption."""
        del console
        if self.title:
            yield Flow(self.title, style="italic")
        ranks = sorted({column.rank for column in self.columns} - {0}, reverse=True)
        fewer = [([column for column in self.columns if column.rank < rank], FRAMES[-1]) for rank in ranks]
        for kept, (frame, each, once) in [*((self.columns, frame) for frame in FRAMES), *fewer]:
            spare = options.max_width - each * len(kept) - once - sum(column.least for column in kept)
            if spare >= 0:
                yield self._table(kept, frame, _widths(kept, spare))
                if left_out := [" ".join(column.header.split()) for column in self.columns if column not in kept]:
                    yield Flow([f"left out at this width: {left_out[0]}", *left_out[1:]], ", ", "dim")
                break
        else:  # every row as a heading and a line for each of its cells
            for first, *row in zip(*(column.cells for column in self.columns), strict=True):
                yield Text.from_markup(first, style="bold")
                for column, cell in zip(self.columns[1:], row, strict=True):
                    yield Flow([f"  {' '.join(column.header.split())}:", " ".join(cell.split())], " ")
        if self.caption:
            yield Flow(self.caption, style="dim italic")

    def _table(self, columns: Sequence[Column], frame: Mapping[str, Any], widths: Sequence[int]) -> Table:
        made, laid = Table(**frame), []
        for column, width in zip(columns, widths, strict=True):
            justify: JustifyMethod = "left" if column.text else "right"
            made.add_column(column.header, justify=justify, no_wrap=not column.wraps, width=width)
            laid.append([_wrapped(cell, width) if column.wraps else cell for cell in column.cells])
        for row, cells in enumerate(zip(*laid, strict=True)):
            made.add_row(*cells, style=(self.styles[row] if self.styles else "") or None)
        return made


def _widths(columns: Sequence[Column], spare: int) -> list[int]:
    """Widths of columns: the least, and what is spare in equal parts, but to none more than its lines need."""
    widths = [column.least for column in columns]
    wanting = sorted((column.whole - column.least, place) for place, column in enumerate(columns))
    for number, (need, place) in enumerate(wanting):
        given = min(need, spare // (len(wanting) - number))
        widths[place] += given
        spare -= given
    return widths


def page(parts: Sequence[str | page_of.Table]) -> Iterator[RenderableType]:
    """Lines and tables of a page, the tables fitted: the last columns are left out first.

    Headers are broken after commas and colons, cells before what is in brackets and what they equal.
    """
    for part in parts:
        if not isinstance(part, page_of.Table):
            yield Text(part)
            continue
        columns = []
        for rank, texts in enumerate(zip(part.columns, *part.rows, strict=True)):
            header, *cells = (re.sub(r" (?=\(|= )", "\n", text.replace("[", r"\[")) for text in texts)
            header = re.sub(r"(?<=[:,]) ", "\n", header)
            columns.append(Column(header, cells, rank, text=True, wraps=True, wrapped=PAGE))
        yield from (Text(), Text(f"## {part.title}"), Text(), Fitted(columns))
