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
import secrets
import shutil
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

from halfspace.errors import InputError

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
STANDARD = Path("-")  # stands for standard output


@dataclass(frozen=True)
class Left:
    """What a command has left so far: names of what it wrote, `STANDARD` among them where that carries data, stores."""

    written: list[Path | str] = field(default_factory=list)
    stores: list[Store] = field(default_factory=list)

    @property
    def kept(self) -> str:
        """What is there after an interruption."""
        told = [f"what is done is kept in {one.directory}, --resume {one.directory} goes on" for one in self.stores]
        return "; ".join(told) or "nothing was written"


LEFT: ContextVar[Left] = ContextVar("left")
"""Of the command that is being run."""


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
    """Open a file that is written when the block ends well, see `all_written_aside`."""
    with all_written_aside([path], begun=begun) as (file,):
        yield file


@contextmanager
def all_written_aside(paths: Sequence[Path], *, begun: bool = False) -> Iterator[list[TextIO]]:
    """Open files in memory that are written when the block ends well: all of them or none.

    The files are of text; their attribute ``buffer`` takes bytes. Each is written beside its path first and then takes
    its place. Where the path is a symbolic link, what it leads to is written, and a file that is replaced leaves its
    mode. A device, a pipe and standard output, which is also called ``-``, have no place to take and are written to.
    InputError at once, before any work unless that has begun, if a path cannot be written; NotWritten at the end.
    """
    targets = [_target(path, begun=begun) for path in paths]
    held = [io.BytesIO() for _ in paths]
    files = [io.TextIOWrapper(contents, encoding="utf-8") for contents in held]
    yield list(files)
    asides = [target and _unique(target.parent) for target in targets]
    try:
        for path, file, contents, aside in zip(paths, files, held, asides, strict=True):
            file.flush()
            if aside:
                with writing(path):
                    aside.write_bytes(contents.getbuffer())
        for path, contents, aside, target in zip(paths, held, asides, targets, strict=True):
            with writing(path):
                if aside and target:
                    replaced = target.is_file()
                    _put(aside, target)
                    if not begun:  # files of a store are not what was asked for
                        LEFT.get(Left()).written.append(f"{path} (replaced)" if replaced else path)
                elif _is_standard_output(path):
                    sys.stdout.flush()
                    sys.stdout.buffer.write(contents.getvalue())
                    sys.stdout.flush()
                    LEFT.get(Left()).written.append(STANDARD)
                else:
                    path.write_bytes(contents.getbuffer())
    finally:
        for aside in filter(None, asides):
            with suppress(OSError):  # it has taken its place, or the folder has vanished or become read-only
                aside.unlink()


def _target(path: Path, *, begun: bool) -> Path | None:
    """File that is replaced, or None of what is written to where it is; InputError if neither can be."""
    if _is_standard_output(path):
        return None
    with writing(path, begun=begun):
        if path.is_dir():
            raise InputError(f"{path} is a directory; give the name of a file")
        if path.exists() and not path.is_file():
            return None
        target = path.resolve()
        _require_folder(path, target.parent)
    return target


def _is_standard_output(path: Path) -> bool:
    """Whether a path leads to this process' standard output."""
    if path == STANDARD:
        return True
    with suppress(OSError):  # there is no such file, or standard output is closed
        return os.path.samestat(path.stat(), os.fstat(1))
    return False


def _require_folder(path: Path, folder: Path) -> None:
    if not (folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)):
        raise InputError(f"{path} cannot be written; choose a folder that exists and is yours")


def _unique(folder: Path) -> Path:
    """Name of what is unfinished in a folder."""
    return folder / f".unfinished.{secrets.token_hex(8)}"


def _put(aside: Path, target: Path) -> None:
    """Let a file take its place, with the mode of the file that was there."""
    if target.is_file():
        shutil.copymode(target, aside)
    aside.replace(target)


@contextmanager
def directory_written_aside(path: Path, *, force: bool | None = False) -> Iterator[Path]:
    """Make an empty directory whose files move into `path` when the block ends well, and vanish if it does not.

    In the block, what writes the files stands under `writing`. The path is in a folder that exists; by force it may be
    a directory that is not empty: files of the same names are replaced, others stay. InputError at once, before any
    work, if it is a file, cannot be written, or is not empty without force; NotWritten if the files cannot take their
    places.
    """
    with writing(path, begun=False):
        present, target = require_room(path, force=force), path.resolve()
        aside = _unique(target.parent if present is None else target)
        aside.mkdir()
    try:
        yield aside
        made = sorted(file.name for file in aside.iterdir())
        with writing(path):
            if present is None:  # in one step
                aside.replace(target)
            else:
                for file in aside.iterdir():
                    _put(file, (target / file.name).resolve())
        page = "index.html" if "index.html" in made else ""
        LEFT.get(Left()).written.append(f"{path}/{page} ({len(made)} files)")
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def require_room(directory: Path, *, force: bool | None = False) -> int | None:
    """Number of files in a directory for results, None if there is none; InputError if there are any and no force.

    InputError, too, if it is a file.
    """
    if not directory.is_dir():
        if directory.exists():
            raise InputError(f"{directory} is a file; give the name of a directory")
        return None
    present = len(list(directory.iterdir()))
    if present and not force:
        raise InputError(f"{directory} holds {present} files, limit 0; empty it, choose another or use --force")
    return present


# Results of a study

SCHEMA = 2  # raised whenever what is stored changes
FOLDER = "cases"

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
                self.outdated["another format"] += 1
            case {"inputs": dict(asked), "result": dict(result), "code": str(code), "checksum": str(checksum)}:
                if asked != dict(inputs) or checksum != _digest([asked, code, result]):
                    self.distrust(inputs, "it has been changed")
                elif code != self.code:
                    self.outdated["other code"] += 1
                else:
                    return {str(key): value for key, value in result.items()}
            case _:
                self.distrust(inputs, "it does not hold the result of a case")
        return None

    def put(self, inputs: Plain, result: Plain) -> None:
        """Write the result of a case; until that is done there is none, or the one of before."""
        path = self.path(inputs)
        asked, stored = dict(inputs), dict(result)
        checksum = _digest([asked, self.code, stored])
        content = {"schema": SCHEMA, "code": self.code, "checksum": checksum, "inputs": asked, "result": stored}
        text = json.dumps(content, indent=1, allow_nan=False)
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
        with written_aside(path, begun=True) as file:
            file.write(text)

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
        present = require_room(directory, force=True)
    _require_folder(directory, directory.parent if present is None else directory)
    if present and not force and not (resume and (directory / FOLDER).is_dir()):
        remedy = "it is no study to resume, choose another" if resume else f"choose another or use --resume {directory}"
        forced = "" if force is None else " or --force"
        raise InputError(f"{directory} holds {present} files, limit 0; {remedy}{forced}")
    store = Store(directory, code)
    LEFT.get(Left()).stores.append(store)
    return store
