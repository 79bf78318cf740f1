"""Tables of a page: cells with names, as CSV files and as HTML."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from pathlib import Path

SYMBOLS = {
    "mu": "&mu;",
    "alpha": "&alpha;",
    "dgamma": "&Delta;&gamma;",
    "beta": "&beta;",
    "eps": "&epsilon;",
    "pi": "&pi;",
}

WORDS = re.compile(rf"\b({'|'.join(SYMBOLS)})\b")


@dataclass(frozen=True)
class Table:
    """A table and the file that holds it.

    Attributes
    ----------
    stem, title, see : str
        File name without suffix, heading, one sentence on what to see.
    columns : tuple of str
        Names with units.
    rows : tuple of tuple of str
        Cells.
    """

    stem: str
    title: str
    see: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def write_csv(table: Table, directory: Path) -> None:
    """Write a table as a CSV file."""
    with (directory / f"{table.stem}.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(table.columns)
        writer.writerows(table.rows)


def html(table: Table) -> Iterator[str]:
    """Lines of the table on the page."""
    yield f'<section id="{table.stem}"><h2>{typeset(table.title)}</h2>'
    yield f'<p>{typeset(table.see)} <a href="{table.stem}.csv">CSV</a></p>'
    yield '<div class="wide"><table><thead><tr>'
    yield "".join(f'<th scope="col">{typeset(name)}</th>' for name in table.columns)
    yield "</tr></thead><tbody>"
    for row in table.rows:
        yield f"<tr>{''.join(_cell(cell) for cell in row)}</tr>"
    yield "</tbody></table></div></section>"


def _cell(text: str) -> str:
    number = bool(re.fullmatch(r"[-+0-9.e]+", text))
    return f'<td class="number">{text}</td>' if number else f"<td>{typeset(text)}</td>"


def typeset(text: str) -> str:
    """Escape for HTML, Greek letters and the sign of an error as such."""
    return WORDS.sub(lambda match: SYMBOLS[match[0]], escape(text)).replace("+-", "&plusmn;")
