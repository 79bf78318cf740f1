"""How far long work is, for those who wait for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count

Progress = Callable[[str, int, int], None]
"""Told what is under way, how much is done and of how much."""


def unheard(_name: str, _done: int, _total: int) -> None:
    """Progress of which nobody wants to know."""


def in_turn(progress: Progress, total: int) -> Callable[[str], None]:
    """What is told the name of each of so many parts, in order, as its work begins."""
    done = count()
    return lambda name: progress(name, next(done), total)


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """Bar on standard error if that is a terminal, with the time that has gone and what is expected to be left."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    times = (TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn())
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), *times)
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=None)
        yield lambda name, done, total: bar.update(task, description=name, completed=done, total=total)
