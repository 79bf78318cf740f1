"""Text and tables that fit the terminal: nothing is cut, and a number is not parted from its unit."""

from __future__ import annotations

import os
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich import box
from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.table import Table
from rich.text import Text

from fem_adhesion.common import page as page_of

WIDE = 150  # columns where there is no terminal
UNIT = r"(?:%|[yzafpnµmkMGT]?(?:m|N|Pa|J|N/m|J/m\^2)|s|R|eps|beta|unknowns|points)[.,;:)]*(?: |$)"
TOGETHER = re.compile(rf"(?<=[\d)]) (?={UNIT})|(?<=\bR) (?=dgamma)|(?<=dgamma) (?=eps)")
NO_BREAK = "\N{NO-BREAK SPACE}"

FRAMED_FROM = 100  # columns of a terminal in which tables have frames; below, all have the room of the frames instead
FRAMED: Mapping[str, Any] = {"box": box.HEAVY_HEAD}
PLAIN: Mapping[str, Any] = {"box": box.SIMPLE_HEAD, "show_edge": False, "pad_edge": False, "padding": (0, 0)}
AIRY: Mapping[str, Any] = {**PLAIN, "padding": (0, 1, 0, 0)}
LAYOUTS = ((60, FRAMED), (20, FRAMED), (60, AIRY), (20, AIRY), (20, PLAIN), (17, PLAIN), (14, PLAIN))
"""How a table may be laid out, the best first: widths of columns of words, and how rich frames the table."""


def make_console(*, to_error: bool = False) -> Console:
    """Console as wide as its terminal, or as the variable COLUMNS says, or `WIDE`."""
    known = (sys.stderr if to_error else sys.stdout).isatty() or "COLUMNS" in os.environ
    return Console(stderr=to_error, width=None if known else WIDE)


def broken(text: str, width: int) -> str:
    """Text in lines of a width, broken at blanks, but neither in a number and its unit nor at `NO_BREAK`."""
    kept = (TOGETHER.sub(NO_BREAK, line) for line in text.split("\n"))
    lines = (textwrap.fill(line, width, break_long_words=False, break_on_hyphens=False) for line in kept)
    return "\n".join(lines).replace(NO_BREAK, " ")


@dataclass(frozen=True)
class Prose:
    """Sentences in lines as wide as the terminal."""

    text: str
    style: str = ""

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Text in lines."""
        del console
        yield Text(broken(self.text, options.max_width), self.style)


def flow(parts: Sequence[str], separator: str = "; ", style: str = "") -> Prose:
    """Parts of a line, such as ``R = 100 nm``, that is broken between them only."""
    return Prose(separator.join(part.replace(" ", NO_BREAK) for part in parts), style)


@dataclass(frozen=True)
class Column:
    """A column of a table, its header, with the unit below, and its cells: numbers, or words that may be broken."""

    header: str
    cells: Sequence[str]
    words: bool = False


@dataclass(frozen=True)
class Fitted:
    """A table that becomes a list, a paragraph for each row, where it does not fit.

    The first column names the row; title and caption are parts of the lines above and below, styles those of the rows.
    """

    columns: Sequence[Column]
    title: Sequence[str] = ()
    caption: Sequence[str] = ()
    styles: Sequence[str] = ()

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Title, table or list, and caption."""
        if self.title:
            yield flow(self.title, style="italic")
        framed = options.max_width >= FRAMED_FROM
        tables = (self._table(*layout) for layout in LAYOUTS if framed or layout[1] is not FRAMED)
        unbounded = options.update(max_width=10_000)
        fitting = (t for t in tables if console.measure(t, options=unbounded).maximum <= options.max_width)
        if table := next(fitting, None):
            yield table
        else:
            for first, *row in zip(*(column.cells for column in self.columns), strict=True):
                named = ((column, cell) for column, cell in zip(self.columns[1:], row, strict=True) if cell)
                parts = (f"{' '.join(column.header.split())}: {' '.join(cell.split())}" for column, cell in named)
                yield Prose(
                    "; ".join([first, *(part.replace(" ", NO_BREAK) if len(part) < 40 else part for part in parts)])
                )
        if self.caption:
            yield flow(self.caption, style="dim italic")

    def _table(self, width: int, frame: Mapping[str, Any]) -> Table:
        made, laid = Table(**frame), []
        for column in self.columns:
            made.add_column(Text(column.header), justify="left" if column.words else "right", no_wrap=True)
            laid.append([Text(broken(cell, width) if column.words else cell) for cell in column.cells])
        for row, cells in enumerate(zip(*laid, strict=True)):
            made.add_row(*cells, style=(self.styles[row] if self.styles else "") or None)
        return made


def page(parts: Sequence[str | page_of.Table]) -> Iterator[RenderableType]:
    """Lines and tables of a page. Headers are broken after commas and colons, cells before brackets and `=`."""
    for part in parts:
        if not isinstance(part, page_of.Table):
            yield Text(part)
            continue
        columns = []
        for texts in zip(part.columns, *part.rows, strict=True):
            header, *cells = (re.sub(r" (?=\(|= )", "\n", text) for text in texts)
            columns.append(Column(re.sub(r"(?<=[:,]) ", "\n", header), cells, words=True))
        yield from (Text(), Text(f"## {part.title}"), Text(), Fitted(columns))
