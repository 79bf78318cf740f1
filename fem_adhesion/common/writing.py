"""What cannot be written: a full disk, a folder that is not ours or has vanished, told apart from defects."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

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


class NotWritten(RuntimeError):
    """What was computed could not be written; the message says what, why, and what to do."""


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Run a block that does nothing but write `path`, so that what the system refuses is no defect.

    Raises
    ------
    NotWritten
        In the place of the block's OSError.
    """
    try:
        yield
    except OSError as error:
        raise NotWritten(refusal(path, error)) from error


def refusal(path: Path, error: OSError) -> str:
    """One line: what cannot be written, the system's reason, and a remedy."""
    number = error.errno or 0
    reason = os.strerror(number) if number else str(error)
    return f"{path} cannot be written ({reason}); {REMEDIES.get(number, ELSEWHERE)}"
