"""``fem-adhesion words``: what the words mean that commands print."""

from __future__ import annotations

import argparse
from importlib.resources import files

from fem_adhesion.common.options import AGREE, Command, Parser
from halfspace.errors import InputError


def add_options(command: Parser) -> None:
    """Add the options."""
    command.add_argument("word", nargs="*", help="all unless given", metavar="WORD")


def run(options: argparse.Namespace) -> int:
    """Print the entries that have a word in their heads."""
    from rich.padding import Padding

    from fem_adhesion.common.terminal import Prose, make_console

    words = files("fem_adhesion.words").joinpath("data/glossary.md").read_text(encoding="utf-8").replace("\\", "")
    console, asked, found = make_console(), " ".join(options.word).casefold(), False
    for entry in words.split("\n\n"):
        head, _, text = entry.partition("\n: ")
        if text and asked in head.casefold():
            found = True
            console.print(Prose(head, "bold"), Padding(Prose(" ".join(text.split())), (0, 0, 0, 4), expand=False))
        elif not text and not asked:
            console.print(f"\n{entry.removeprefix('### ')}", style="underline")
    if not found:
        raise InputError(f"word = {asked} is not explained; fem-adhesion words lists all that are")
    return AGREE


COMMAND = Command(
    "words",
    "explain the words that commands print",
    "Explain the words of the field that commands print.",
    "budget",
    add_options,
    run,
)
