"""Files and directories of files that appear whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from halfspace.errors import InputError


@contextmanager
def written_aside(path: Path) -> Iterator[IO[str]]:
    """Open a text file beside `path` that takes its place when the block ends well, and vanishes if it does not.

    Raises
    ------
    InputError
        At once, before any work, if `path` cannot be written.
    """
    if path.is_dir():
        raise InputError(f"{path} is a directory; give the name of a file")
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is a device or a pipe, limit: a file; give the name of one")
    try:
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", text=True)
    except OSError as error:
        raise InputError(
            f"{path} cannot be written ({error.strerror}); choose a folder that exists and is yours"
        ) from error
    aside = Path(name)
    try:
        with os.fdopen(descriptor, "w") as file:
            yield file
        aside.chmod(0o666 & ~_umask())
        aside.replace(path)
    finally:
        aside.unlink(missing_ok=True)


@contextmanager
def directory_written_aside(path: Path, *, force: bool = False) -> Iterator[Path]:
    """Make an empty directory whose files move into `path` when the block ends well, and vanish if it does not.

    Parameters
    ----------
    path : Path
        Directory to be, in a folder that exists.
    force : bool
        Accept a directory that is not empty: files of the same names are replaced, others stay.

    Raises
    ------
    InputError
        At once, before any work, if `path` is a file, cannot be written, or is not empty and `force` not set.
    """
    if path.exists() and not path.is_dir():
        raise InputError(f"{path} is a file; give the name of a directory")
    exists = path.is_dir()
    aside = _directory_in(path if exists else path.parent, path)
    try:
        present = sum(1 for _ in path.iterdir()) - 1 if exists else 0
        if present and not force:
            raise InputError(f"{path} holds {present} files, limit 0; empty it, choose another or use --force")
        yield aside
        path.mkdir(exist_ok=True)
        for file in aside.iterdir():
            file.replace(path / file.name)
    finally:
        shutil.rmtree(aside)


def _directory_in(parent: Path, wanted: Path) -> Path:
    """Make a hidden directory in `parent` that shows that `wanted` can be written."""
    try:
        return Path(tempfile.mkdtemp(dir=parent, prefix=".unfinished."))
    except OSError as error:
        raise InputError(
            f"{wanted} cannot be written ({error.strerror}); choose a folder that exists and is yours"
        ) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
