"""Files and directories of files that appear whole or not at all, and the results of studies in such files.

What the system refuses at once, before any work, is InputError; what it refuses later, as a full disk or a folder that
is not ours or has vanished, is NotWritten. Either leaves what was there before.

Of a study each case has its file, named after a hash of the case's inputs and written at once: whatever happens, it is
there. It holds besides them the number of the format, a digest of the code that computed the result, and a checksum, so
that a result is used again only for exactly what it was computed from and as it was computed. Nothing but such files is
ever read or replaced.
"""

from __future__ import annotations

import errno
import hashlib
import io
import json
import os
import shutil
import stat
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
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
STANDARD_OUTPUT = 1  # its descriptor


class NotWritten(RuntimeError):
    """What was computed could not be written; the message says what, why, and what to do."""


@contextmanager
def writing(path: Path, *, begun: bool = True) -> Iterator[None]:
    """Run a block that does nothing but write `path`: what the system refuses is NotWritten in place of its OSError.

    The message says in one line what cannot be written, the system's reason, and a remedy. Before work has begun, it is
    InputError: a name can be mended at once, but not a disk that is full.
    """
    try:
        yield
    except OSError as error:
        number = error.errno or 0
        reason = os.strerror(number) if number else str(error)
        kind = NotWritten if begun or number in FULL else InputError
        raise kind(f"{path} cannot be written ({reason}); {REMEDIES.get(number, ELSEWHERE)}") from error


@contextmanager
def written_aside(path: Path, *, begun: bool = False) -> Iterator[TextIO]:
    """Open a file beside `path` that takes its place when the block ends well, and vanishes if it does not.

    The file is of text; its attribute ``buffer`` takes bytes. Where `path` is a symbolic link, what it leads to is
    written, and a file that is replaced leaves its mode. A device, a pipe and what is this process' standard output
    have no place to take: they are written to when the block ends well. InputError at once, before any work unless that
    has begun, if `path` cannot be written; NotWritten where what is written to the file does not go to the disk.
    """
    with writing(path, begun=begun):
        if path.is_dir():
            raise InputError(f"{path} is a directory; give the name of a file")
        target, place = path.resolve(), _in_place(path)
        if place is None:
            descriptor, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", text=True)
    if place is not None:
        held = io.BytesIO()
        with _opened(place, path) as stream, io.TextIOWrapper(held, encoding="utf-8") as file:
            yield file
            file.flush()
            stream.buffer.write(held.getvalue())
        return
    aside = Path(name)
    try:
        with _opened(descriptor, path) as file:
            yield file
            file.flush()
        with writing(path):
            _put(aside, target)
    finally:
        with suppress(OSError):  # the folder may have vanished, or have become read-only
            aside.unlink()


def _in_place(path: Path) -> int | None:
    """Descriptor of what is written to where it is, or None of what a file can take the place of."""
    if not path.exists():
        return None
    with suppress(OSError):  # standard output may be closed
        if os.path.samestat(path.stat(), os.fstat(STANDARD_OUTPUT)):
            return os.dup(STANDARD_OUTPUT)
    return None if path.is_file() else os.open(path, os.O_WRONLY)


def _put(aside: Path, target: Path) -> None:
    """Let a file take its place, with the mode of the file that was there, or that of a new one."""
    aside.chmod(stat.S_IMODE(target.stat().st_mode) if target.exists() else 0o666 & ~_umask())
    aside.replace(target)


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
    with writing(path, begun=False):
        present, target = _present(path), path.resolve()
        aside = Path(tempfile.mkdtemp(dir=target.parent if present is None else target, prefix=".unfinished."))
    try:
        if present and not force:
            raise InputError(f"{path} holds {present} files, limit 0; empty it, choose another or use --force")
        yield aside
        with writing(path):
            if present is None:  # in one step
                aside.chmod(0o777 & ~_umask())
                aside.replace(target)
            else:
                for file in aside.iterdir():
                    place = (target / file.name).resolve()
                    if place.is_file():
                        _put(file, place)
                    else:
                        file.replace(place)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _present(directory: Path) -> int | None:
    """Number of files in a directory, None if there is none; InputError if it is a file."""
    if directory.is_dir():
        return len(list(directory.iterdir()))
    if directory.exists():
        raise InputError(f"{directory} is a file; give the name of a directory")
    return None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


# Results of a study

SCHEMA = 2  # raised whenever what is stored changes
FOLDER = "cases"
OTHER_CODE, OTHER_FORMAT = "other code", "another format"

Plain = Mapping[str, object]  # what JSON can hold


@dataclass(frozen=True)
class Store:
    """A directory of results, whose files are in its folder ``cases``, made when the first result comes.

    The code is the digest of what computes the results, see `fem_adhesion.common.facts.code_digest`. Outdated results,
    counted by what computed them, and damaged files, with the reason why their contents cannot be trusted, are to be
    computed again.
    """

    directory: Path
    code: str
    outdated: Counter[str] = field(default_factory=Counter)
    damaged: dict[str, str] = field(default_factory=dict)

    @property
    def notes(self) -> Sequence[str]:
        """What was found and not used, in lines."""
        from fem_adhesion.common.numbers import counted  # loads NumPy, which no help needs

        outdated = [f"{counted(n, 'case')} computed by {what}: computed again" for what, n in self.outdated.items()]
        return (*outdated, *(f"{file} is computed again: {why}" for file, why in self.damaged.items()))

    def path(self, inputs: Plain) -> Path:
        """File of a case."""
        return self.directory / FOLDER / f"{_digest(inputs)[:32]}.json"

    def get(self, inputs: Plain) -> Plain | None:
        """Result of a case, or None if there is none that can be trusted; then a note says so."""
        path = self.path(inputs)
        try:
            found = json.loads(path.read_bytes())
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            self.distrust(inputs, str(error))
            return None
        match found:
            case {"schema": schema} if schema != SCHEMA:
                self.outdated[OTHER_FORMAT] += 1
            case {"inputs": dict(asked), "result": dict(result), "code": str(code), "checksum": str(checksum)}:
                if asked != dict(inputs) or checksum != _digest([asked, code, result]):
                    self.distrust(inputs, "it has been changed")
                elif code != self.code:
                    self.outdated[OTHER_CODE] += 1
                else:
                    return {str(key): value for key, value in result.items()}
            case _:
                self.distrust(inputs, "it does not hold the result of a case")
        return None

    def put(self, inputs: Plain, result: Plain) -> None:
        """Write the result of a case: after this call it is on disk; before, there is none, or the one of before."""
        path = self.path(inputs)
        asked, stored = dict(inputs), dict(result)
        checksum = _digest([asked, self.code, stored])
        content = {"schema": SCHEMA, "code": self.code, "checksum": checksum, "inputs": asked, "result": stored}
        text = json.dumps(content, indent=1, allow_nan=False)
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
        with written_aside(path, begun=True) as file:
            file.write(text)
            file.flush()
            with writing(path):
                os.fsync(file.fileno())
        with writing(path):  # a replaced name lasts through a loss of power, too
            folder = os.open(path.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)

    def distrust(self, inputs: Plain, why: str) -> None:
        """Note that the file of a case is not used, and why."""
        self.damaged[str(self.path(inputs))] = why


def _digest(content: object) -> str:
    """Hash of what JSON can hold, the same whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def open_store(directory: Path, code: str, *, resume: bool = False, force: bool | None = False) -> Store:
    """Store in a directory, an existing one or new in a folder that exists, which is checked but not yet touched.

    To resume is to go on with the cases that it holds, but for the results of other code; by force one is accepted that
    is not empty, None where that cannot be asked for. InputError if the directory is a file, cannot be written, or is
    not empty and neither asked to be resumed nor forced.
    """
    with writing(directory, begun=False):
        present = _present(directory)
    place = directory.parent if present is None else directory
    if not (place.is_dir() and os.access(place, os.W_OK | os.X_OK)):
        raise InputError(f"{directory} cannot be written; choose a folder that exists and is yours")
    if present and not force and not (resume and (directory / FOLDER).is_dir()):
        remedy = "it is no study to resume, choose another" if resume else "choose another or use --resume"
        forced = "" if force is None else " or --force"
        raise InputError(f"{directory} holds {present} files, limit 0; {remedy}{forced}")
    return Store(directory, code)
