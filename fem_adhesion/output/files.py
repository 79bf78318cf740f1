"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO


@contextmanager
def written_aside(path: Path) -> Iterator[IO[str]]:
    """Open a text file beside `path` that takes its place when the block ends well, and vanishes if it does not.

    Raises
    ------
    ValueError
        At once, before any work, if `path` cannot be written.
    """
    if path.is_dir():
        raise ValueError(f"{path} is a directory; give the name of a file")
    try:
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", text=True)
    except OSError as error:
        raise ValueError(
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


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
