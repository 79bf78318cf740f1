"""Pages and their tables: cells with names, as CSV files and as HTML."""

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
STYLE = """
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 62rem; margin: 0 auto; padding: 1rem; }
figure { margin: 2rem 0; }
figure img { display: block; width: 100%; height: auto; background: white; border-radius: 6px; }
figcaption, .wide { margin-top: .5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; }
th, td { padding: .2rem .6rem; text-align: left; vertical-align: top; border-bottom: 1px solid #8886; }
td { white-space: nowrap; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
"""


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
