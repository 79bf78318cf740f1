"""``fem-adhesion words``: what the words mean that commands print."""

from __future__ import annotations

import argparse
from importlib.resources import files
from textwrap import indent

from fem_adhesion.common.options import AGREE, Command, Parser
from halfspace.errors import InputError


def add_options(command: Parser) -> None:
    """Add the options."""
    command.add_argument("word", nargs="*", help="all unless given", metavar="WORD")


def run(options: argparse.Namespace) -> int:
    """Print the entries that have a word in their heads."""
    from rich.text import Text

    from fem_adhesion.common.terminal import Prose, broken, make_console

    words = files("fem_adhesion.words").joinpath("data/glossary.md").read_text(encoding="utf-8").replace("\\", "")
    console, asked, found = make_console(), [word.casefold() for word in options.word], False
    for entry in words.split("\n\n"):
        head, _, text = entry.partition("\n: ")
        if text and (not asked or any(word in head.casefold() for word in asked)):
            found = True
            console.print(Prose(head, "bold"), Text(indent(broken(" ".join(text.split()), console.width - 4), " " * 4)))
        elif not text and not asked:
            console.print(f"\n{entry.removeprefix('### ')}", style="underline")
    if not found:
        raise InputError(f"word = {' '.join(asked)} is not explained; fem-adhesion words lists all that are")
    return AGREE


COMMAND = Command(
    "words",
    "explain the words that commands print",
    "Explain the words of the field that commands print.",
    "budget",
    add_options,
    run,
)
