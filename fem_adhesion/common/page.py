"""Pages that can be sent alone: sections of text, figures and tables, as HTML; the tables as CSV and Markdown too.

Greek letters are written by their names in all texts, and become letters on the page.
"""

from __future__ import annotations

import csv
import re
import tomllib
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from markupsafe import Markup

from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.options import COMMAND
from fem_adhesion.common.record import beside, record, write_beside

Item = TypeVar("Item")
Columns = Mapping[str | tuple[str, ...], Callable[[Item], str | Sequence[str]]]
"""Of a table with a row for each item: a column's name and its text of an item, or names and texts of some at once."""

SYMBOLS: Mapping[str, str] = {
    "mu": "μ",
    "alpha": "\N{GREEK SMALL LETTER ALPHA}",
    "dgamma": "\N{GREEK CAPITAL LETTER DELTA}\N{GREEK SMALL LETTER GAMMA}",
    "beta": "β",
    "eps": "ε",
    "pi": "π",
}
WORDS = re.compile(rf"\b({'|'.join(SYMBOLS)})\b")
NUMBER = re.compile(r"[-+0-9.e]+")
LONG = 40  # letters of a cell from which on it may be broken


@dataclass(frozen=True)
class Table:
    """A table and the file that holds it: `stem` is its name without suffix, empty if there is no file.

    Columns are names with units, `see` a sentence on what to see, `open` whether it is seen at once where tables are
    folded.
    """

    stem: str
    title: str
    see: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    open: bool = False

    @classmethod
    def of(cls, stem: str, title: str, see: str, items: Iterable[Item], columns: Columns[Item]) -> Table:
        """Table with a row for each item."""
        rows = [[cell for get in columns.values() for cell in _listed(get(item))] for item in items]
        return cls(stem, title, see, [name for key in columns for name in _listed(key)], rows)


def _listed(cells: str | Sequence[str]) -> Sequence[str]:
    return (cells,) if isinstance(cells, str) else cells


@dataclass(frozen=True)
class Figure:
    """A picture, the bytes of an SVG file; its caption, what is to be seen, is the text alternative too.

    The title says what is drawn; `stem` is the name of its files without suffix, empty if there are none, and `files`
    are their suffixes.
    """

    svg: bytes
    caption: str
    title: str = ""
    stem: str = ""
    files: Sequence[str] = ()

    @property
    def source(self) -> str:
        """The picture as an address that holds it: a browser shows it as an image, whose scripts never run."""
        return f"data:image/svg+xml;base64,{b64encode(self.svg).decode('ascii')}"

    @property
    def alternative(self) -> str:
        """What is read in place of the picture."""
        return f"{self.title}. {self.caption}" if self.title else self.caption


@dataclass(frozen=True)
class Section:
    """A part of a page: its name for links, and its title.

    `missing` is the command line that was not run for it, and `warning` what went wrong in it, or ""; paragraphs,
    figures and tables are shown in this order.
    """

    name: str
    title: str
    missing: str = ""
    warning: str = ""
    paragraphs: Sequence[str] = ()
    figures: Sequence[Figure] = ()
    tables: Sequence[Table] = ()


def write_page(directory: Path, title: str, lead: Sequence[str], sections: Sequence[Section], spent: str) -> None:
    """Write ``index.html``: title, paragraphs, links to sections, and these.

    At its foot stand the command line that is being run, if any, machine, versions and cost.
    """
    facts = {**machine(), **versions(), "computed in": spent}
    text = render("common/page.html.j2", title=title, lead=lead, sections=sections, facts=facts)
    (directory / "index.html").write_text(text, encoding="utf-8")


def render(template: str, **contents: Any) -> str:
    """Page from the template ``folder/name`` of a folder of this package; `symbols` and `kind` are filters in it."""
    from jinja2 import Environment, PackageLoader, PrefixLoader, StrictUndefined  # here, as tables need no templates

    folder = template.partition("/")[0]
    folders = {name: PackageLoader("fem_adhesion", f"{name}/templates") for name in {"common", folder}}
    environment = Environment(
        loader=PrefixLoader(folders), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= {"symbols": symbols, "kind": kind}
    shared = {"style": template_text("common", "page.css"), "asked": COMMAND.get()}
    return environment.get_template(template).render(shared | contents) + "\n"


def template_text(folder: str, name: str) -> str:
    """Text of a file beside the templates of a folder."""
    return (resources.files("fem_adhesion") / folder / "templates" / name).read_text(encoding="utf-8")


def data_text(folder: str, name: str) -> str:
    """Text of a file of data that comes with a folder."""
    return (resources.files("fem_adhesion") / folder / "data" / name).read_text(encoding="utf-8")


def data_rows(folder: str, name: str) -> list[dict[str, str]]:
    """Rows of a table that comes with a folder, comments left out."""
    return list(csv.DictReader(line for line in data_text(folder, name).splitlines() if not line.startswith("#")))


@cache
def _texts(folder: str) -> Mapping[str, Mapping[str, str]]:
    return tomllib.loads(data_text(folder, "texts.toml"))


def said(folder: str, stem: str, what: str = "see", /, **numbers: Any) -> str:
    """Text of ``data/texts.toml`` of a folder, with numbers put in."""
    return _texts(folder)[stem].get(what, "").format(**numbers)


def titled(folder: str, stem: str, /, **numbers: Any) -> tuple[str, str, str]:
    """Stem, title and what is to be seen of a table, of which ``data/texts.toml`` of a folder has the texts."""
    return stem, said(folder, stem, "title", **numbers), said(folder, stem, "see", **numbers)


def symbols(text: str) -> str:
    """Greek letters for their names, as in the paper, and the sign of an error; markup stays markup."""
    return type(text)(WORDS.sub(lambda match: SYMBOLS[match[0]], text).replace("+-", "±"))


def kind(cell: str) -> str:
    """How a cell is set: as a ``number``, or as a ``long`` text, which is broken; empty of other text."""
    return "number" if NUMBER.fullmatch(cell) else "long" if len(cell) > LONG else ""


def bullets(items: Sequence[str]) -> Markup:
    """Items as a list between paragraphs."""
    return Markup("<ul>{}</ul>").format(Markup("").join(Markup("<li>{}</li>").format(item) for item in items))


def write_csv(tables: Iterable[Table], directory: Path) -> None:
    """Write each table as a CSV file, and the record that serves them all."""
    with beside(directory).open("w", encoding="utf-8") as file:
        write_beside(file, "*.csv", record(units={}))
    for table in tables:
        with (directory / f"{table.stem}.csv").open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([table.columns, *table.rows])


def markdown(parts: Sequence[str | Table]) -> Iterator[str]:
    """Lines of a page in Markdown."""
    for part in parts:
        if isinstance(part, Table):
            yield from ("", f"## {part.title}", "")
            yield from (f"| {' | '.join(cells)} |" for cells in (part.columns, ["---"] * len(part.columns), *part.rows))
        else:
            yield part
