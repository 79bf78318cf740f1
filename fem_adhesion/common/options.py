"""What the commands share: exit codes, help, the options for results."""

from __future__ import annotations

import argparse
import re
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NoReturn, TextIO

from fem_adhesion.common.files import STANDARD, all_written_aside
from halfspace.errors import InputError, nearest

if TYPE_CHECKING:
    from rich.console import Console

AGREE, DISAGREE, BAD_INPUT, INTERRUPTED, TERMINATED = 0, 1, 2, 130, 143


COMMAND: ContextVar[str] = ContextVar("command", default="")
"""Command line that is being run, for the records of its files."""


class Help(argparse.HelpFormatter):
    """Shows defaults, where there are any, and breaks lines between words alone."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return wrap(" ".join(text.split()), width, break_long_words=False, break_on_hyphens=False)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return "\n".join(f"{indent}{line}" for line in self._split_lines(text, width - len(indent)))

    def _get_help_string(self, action: argparse.Action) -> str | None:
        text, default = action.help, action.default
        if not text or default in (None, False, argparse.SUPPRESS) or "%(default)" in text:
            return text
        shown = " ".join(f"{value:g}" for value in default) if isinstance(default, list) else "%(default)s"
        return f"{text} (default: {shown})"


@contextmanager
def ended_by_signal() -> Iterator[None]:
    """Let SIGTERM end the block as Ctrl-C does, so that workers are stopped and nothing is left half-written.

    The KeyboardInterrupt has the number of the signal, which Ctrl-C's has not. A second one changes nothing: the first
    is being heeded. Signals reach the main thread alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def terminate(number: int, _: object) -> NoReturn:
        signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt(number)

    before = signal.signal(signal.SIGTERM, terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


class Parser(argparse.ArgumentParser):
    """Refuses bad arguments in one line, with the nearest of those that it has, and shows defaults."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**{"formatter_class": Help, **settings})
        self._negative_number_matcher = re.compile(r"-\.?\d")  # -100nm is a value too, for its quantity to refuse

    @property
    def version(self) -> str:
        """Version, which argparse asks for where it is to be shown."""
        from importlib.metadata import version  # here, as it takes as long to load as all that help needs

        return f"fem-adhesion {version('fem-adhesion')}"

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> tuple[Any, list[str]]:
        """Refuse what it does not know where it is met: a command knows its own options, the program does not."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            near = _question(unknown[0].partition("=")[0], self._option_string_actions)
            self.error(f"unrecognized arguments: {' '.join(unknown)}{near}")
        return found, []

    def error(self, message: str) -> NoReturn:
        """Exit with code 2."""
        choice = re.search(r"invalid choice: '(.*)' \(choose from (.*)\)", message)
        near = _question(choice[1], re.findall(r"[\w-]+", choice[2])) if choice else ""
        self.exit(BAD_INPUT, f"{self.prog}: {message}{near}; see {self.prog} --help\n")


def _question(word: str, known: Iterable[str]) -> str:
    """Question after the nearest of the words that are known, if one is near."""
    near = nearest(word, known)
    return f" (did you mean {near}?)" if near else ""


@dataclass(frozen=True)
class Command:
    """A command of the program: one line on what it does, more than that, and arguments to begin with.

    `run` does what the options ask for and returns the exit code.
    """

    name: str
    help: str
    description: str
    example: str
    add_options: Callable[[Parser], None]
    run: Callable[[argparse.Namespace], int]

    def add_to(self, commands: Any) -> None:
        """Add it to the commands of a parser, as argparse's ``add_subparsers`` gives them."""
        epilog = f"example: fem-adhesion {self.name} {self.example}"
        described = f"{self.description} What words mean: fem-adhesion words."
        parser = commands.add_parser(self.name, help=self.help, description=described, epilog=epilog)
        self.add_options(parser)
        parser.set_defaults(run=self.run)


def exit_code_of(troubles: Sequence[str]) -> int:
    """Say how much failed that should not have, and give the exit code."""
    if troubles:
        print(f"{len(troubles)} failed that should not have, the first: {troubles[0]}")
    return DISAGREE if troubles else AGREE


FILES = {
    "json": "write {} as JSON, - for standard output",
    "csv": "write {} as a table, - for standard output",
    "plot": "draw {}: png, svg or pdf",
    "html": "write {} as one HTML file",
}


def add_files(group: Any, *, required: bool = False, **contents: str) -> None:
    """Add options that name a file, by the names of `FILES`, each with what is written. What is there is replaced."""
    for name, what in contents.items():
        group.add_argument(f"--{name}", type=Path, required=required, help=FILES[name].format(what), metavar="FILE")


def add_output(command: Parser) -> None:
    """Add the options of a command that writes a directory."""
    results = command.add_argument_group("results")
    results.add_argument("--out", type=Path, required=True, help="write the results into this directory", metavar="DIR")
    add_force(results)


def add_force(group: Any) -> None:
    """Add the option of who names a directory that holds files, whose names the program chooses."""
    text = "replace files of the same names in a directory that is not empty"
    group.add_argument("--force", action="store_true", default=None, help=text)


def add_resume(group: Any) -> None:
    """Add the option of where many results are kept while they are computed."""
    text = "keep each result in this directory as soon as it is there, and go on with those it holds"
    group.add_argument("--resume", type=Path, help=text, metavar="DIR")


def add_workers(command: Parser) -> None:
    """Add the options of where many cases are worked on."""
    command.add_argument("--jobs", type=int, help="processes; as many as cores unless given", metavar="N")
    command.add_argument("--dask", help="scheduler of a Dask cluster to use instead of processes", metavar="ADDRESS")


def require_distinct(*paths: Path | None) -> None:
    """Refuse two outputs under one name."""
    seen: set[Path] = set()
    for path in filter(None, paths):
        where = path if path == STANDARD else path.resolve()
        if where in seen:
            name = "standard output" if path == STANDARD else str(path)
            raise InputError(f"{name} is given for two outputs, limit: one; give each a name of its own")
        seen.add(where)


@contextmanager
def all_written(**paths: Path | None) -> Iterator[dict[str, TextIO]]:
    """Open the files of all outputs that are given, by name: all appear or none. Tables get files for their records.

    See `fem_adhesion.common.record.write_records`; what is written to standard output has none.
    """
    require_distinct(*paths.values())
    given = {name: path for name, path in paths.items() if path}
    if tables := {name: given[name] for name in ("csv", "stress") if given.get(name, STANDARD) != STANDARD}:
        from fem_adhesion.common.record import beside

        given |= {f"{name} record": beside(table) for name, table in tables.items()}
    with all_written_aside(list(given.values())) as files:
        yield dict(zip(given, files, strict=True))


def console_beside(*paths: Path | None) -> Console:
    """Console for what is said to a person: on standard error where standard output is for a machine."""
    from fem_adhesion.common.terminal import make_console

    return make_console(to_error=STANDARD in paths)
