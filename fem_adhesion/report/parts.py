"""Parts of the report: sections and tables."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import unescape
from pathlib import Path

from fem_adhesion.common.page_tables import typeset
from fem_adhesion.report.figures import Figure
from halfspace.errors import InputError

MOST_LINES = 400  # of a table that is shown
MOST_DIGITS = 12  # of a number that was written to be read; more are those of the machine
DIGITS = 4  # that are shown of such


@dataclass(frozen=True)
class Table:
    """A table: the title of all, those of its columns, lines of text, and whether it is seen at once."""

    title: str
    columns: Sequence[str]
    lines: Sequence[Sequence[str]]
    open: bool = False


@dataclass(frozen=True)
class Section:
    """A part of the page.

    Attributes
    ----------
    name, title : str
        For links, and for the reader.
    missing : str
        The command line that was not run for it, or "".
    warning : str
        What went wrong in it, or "".
    paragraphs, figures, tables : sequence
        In the order shown.
    """

    name: str
    title: str
    missing: str = ""
    warning: str = ""
    paragraphs: Sequence[str] = ()
    figures: Sequence[Figure] = ()
    tables: Sequence[Table] = ()


def read_table(file: Path, title: str) -> Table:
    """Contents of a CSV file; the title says so where lines are left out.

    Raises
    ------
    InputError
        If the file is empty.
    """
    with file.open(newline="", encoding="utf-8") as stream:
        columns, *lines = list(csv.reader(stream)) or [[]]
    if not columns:
        raise InputError(f"{file} is empty; run its command again")
    left_out = f" (first {MOST_LINES} of {len(lines)} lines; all are in {file.name})" if len(lines) > MOST_LINES else ""
    shown = [[cell(text) for text in line] for line in lines[:MOST_LINES]]
    return Table(title + left_out, [symbols(name.replace("_", " ")) for name in columns], shown)


def cell(text: str) -> str:
    """Text of a cell: numbers as the machine has them rounded, words for symbols replaced by these."""
    if re.fullmatch(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text) and len(re.sub(r"e.*|\D", "", text)) > MOST_DIGITS:
        return f"{float(text):.{DIGITS}g}"
    return symbols(text)


def symbols(text: str) -> str:
    """Greek letters for their names, as in the paper."""
    return unescape(typeset(text))
