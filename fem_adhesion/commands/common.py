"""What the commands share: exit codes, the option for results, the progress bar."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction["Parser"]

AGREE, DISAGREE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
NOT_WRITTEN = DISAGREE


class Parser(argparse.ArgumentParser):
    """Refuses bad arguments in one line."""

    def error(self, message: str) -> NoReturn:
        """Exit with code 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def add_output(command: Parser) -> None:
    """Add the options of a command that writes a directory."""
    command.add_argument("--out", type=Path, required=True, help="directory for the results", metavar="DIR")
    command.add_argument("--force", action="store_true", help="replace files in a directory that is not empty")


@contextmanager
def progress_bar() -> Iterator[Callable[[str, int, int], None]]:
    """Bar on standard error if that is a terminal.

    The function it gives says what is under way, how much is done and of how much.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=None)
        yield lambda name, done, total: progress.update(task, description=name, completed=done, total=total)
