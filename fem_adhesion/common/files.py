"""Files and directories of files that appear whole or not at all.

What the system refuses at once, before any work, is InputError; what it refuses later, as a full disk or a folder that
is not ours or has vanished, is NotWritten. Either leaves what was there before.
"""

from __future__ import annotations

import errno
import io
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from halfspace.errors import InputError

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

REMEDIES: Mapping[int, str] = {
    errno.ENOSPC: "free some space or choose another disk",
    errno.EDQUOT: "free some of your quota or choose another disk",
    errno.EFBIG: "raise the limit on the size of files, ulimit -f",
    errno.EACCES: "choose a folder that is yours",
    errno.EPERM: "choose a folder that is yours",
    errno.EROFS: "choose a disk that is not read-only",
    errno.ENOENT: "choose a folder that exists, and stays",
    errno.ENOTDIR: "choose a folder that exists, and stays",
    errno.ENAMETOOLONG: "choose a shorter name",
}

ELSEWHERE = "choose another place"
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)  # what is no fault of the name that was given


class NotWritten(RuntimeError):
    """What was computed could not be written; the message says what, why, and what to do."""


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Run a block that does nothing but write `path`: what the system refuses is NotWritten in place of its OSError."""
    try:
        yield
    except OSError as error:
        raise NotWritten(refusal(path, error)) from error


def refusal(path: Path, error: OSError) -> str:
    """One line: what cannot be written, the system's reason, and a remedy."""
    number = error.errno or 0
    reason = os.strerror(number) if number else str(error)
    return f"{path} cannot be written ({reason}); {REMEDIES.get(number, ELSEWHERE)}"


@contextmanager
def written_aside(path: Path) -> Iterator[TextIO]:
    """Open a file beside `path` that takes its place when the block ends well, and vanishes if it does not.

    The file is of text; its attribute ``buffer`` takes bytes. InputError at once, before any work, if `path` cannot be
    written; NotWritten where what is written to the file does not go to the disk.
    """
    with _first(path):
        if path.is_dir():
            raise InputError(f"{path} is a directory; give the name of a file")
        if path.exists() and not path.is_file():
            raise InputError(f"{path} is a device or a pipe, limit: a file; give the name of one")
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", text=True)
    aside = Path(name)
    try:
        with _opened(descriptor, path) as file:
            yield file
            file.flush()
        with writing(path):
            aside.chmod(0o666 & ~_umask())
            aside.replace(path)
    finally:
        with suppress(OSError):  # the folder may have vanished, or have become read-only
            aside.unlink()


class _Output(io.FileIO):
    """File that says what could not be written, and why."""

    def __init__(self, descriptor: int, path: Path) -> None:
        super().__init__(descriptor, "w")
        self.path = path

    def write(self, data: ReadableBuffer, /) -> int:
        with writing(self.path):
            return super().write(data)


def _opened(descriptor: int, path: Path) -> TextIO:
    return io.TextIOWrapper(io.BufferedWriter(_Output(descriptor, path)), encoding="utf-8")


@contextmanager
def directory_written_aside(path: Path, *, force: bool = False) -> Iterator[Path]:
    """Make an empty directory whose files move into `path` when the block ends well, and vanish if it does not.

    In the block, what writes the files stands under `writing`. The path is in a folder that exists; by force it may be
    a directory that is not empty: files of the same names are replaced, others stay. InputError at once, before any
    work, if it is a file, cannot be written, or is not empty without force; NotWritten if the files cannot take their
    places.
    """
    with _first(path):
        if path.exists() and not path.is_dir():
            raise InputError(f"{path} is a file; give the name of a directory")
        exists = path.is_dir()
        aside = Path(tempfile.mkdtemp(dir=path if exists else path.parent, prefix=".unfinished."))
    try:
        present = sum(1 for _ in path.iterdir()) - 1 if exists else 0
        if present and not force:
            raise InputError(f"{path} holds {present} files, limit 0; empty it, choose another or use --force")
        yield aside
        with writing(path):
            _moved(aside, path, exists=exists)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _moved(aside: Path, path: Path, *, exists: bool) -> None:
    """Put the files where they belong: in one step unless the directory was there before."""
    if not exists:
        aside.chmod(0o777 & ~_umask())
        aside.replace(path)
        return
    for file in aside.iterdir():
        file.replace(path / file.name)


@contextmanager
def _first(path: Path) -> Iterator[None]:
    """Tell a name that cannot be written, which can be mended at once, from a disk that is full."""
    try:
        yield
    except OSError as error:
        kind = NotWritten if error.errno in FULL else InputError
        raise kind(refusal(path, error)) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
