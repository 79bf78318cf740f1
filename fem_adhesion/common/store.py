"""Results of a study on disk, one file a case, each written at once and whole: whatever happens, they are there.

A file is named after a hash of the case's inputs. It holds besides them the number of the format, a digest of the code
that computed the result, and a checksum, so that a result is used again only for exactly what it was computed from and
as it was computed. Nothing but such files is ever read or replaced.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fem_adhesion.common.files import writing
from halfspace.errors import InputError

SCHEMA = 2  # raised whenever what is stored changes
FOLDER = "cases"
OTHER_CODE, OTHER_FORMAT = "other code", "another format"

Plain = Mapping[str, object]  # what JSON can hold


@dataclass(frozen=True)
class Store:
    """A directory of results.

    Attributes
    ----------
    directory : Path
        The study's; the files are in its folder ``cases``. Made when the first result comes.
    code : str
        Digest of the code that computes the results, see `fem_adhesion.common.code_digest`.
    outdated : Counter of str
        How many results were found that something else computed, by what: they are to be computed again.
    damaged : dict of str to str
        Files whose contents cannot be trusted, and why: their cases are to be computed again.
    """

    directory: Path
    code: str
    outdated: Counter[str] = field(default_factory=Counter)
    damaged: dict[str, str] = field(default_factory=dict)

    @property
    def notes(self) -> Sequence[str]:
        """What was found and not used, in lines."""
        outdated = (f"{_cases(count)} computed by {what}: computed again" for what, count in self.outdated.items())
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
            _write_through(path, text)

    def distrust(self, inputs: Plain, why: str) -> None:
        """Note that the file of a case is not used, and why."""
        self.damaged[str(self.path(inputs))] = why


def _digest(content: object) -> str:
    """Hash of what JSON can hold, the same whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _cases(count: int) -> str:
    return "1 case" if count == 1 else f"{count} cases"


def open_store(directory: Path, code: str, *, resume: bool = False, force: bool | None = False) -> Store:
    """Store in a directory, which is checked but not yet touched.

    Parameters
    ----------
    directory : Path
        An existing one or a new one in a folder that exists.
    code : str
        Digest of the code that computes the results: those of other code are not used.
    resume : bool
        Go on with the cases that it holds.
    force : bool or None
        Accept one that is not empty; None where that cannot be asked for.

    Raises
    ------
    InputError
        If the directory is a file, cannot be written, or is not empty and neither asked to be resumed nor forced.
    """
    if directory.exists() and not directory.is_dir():
        raise InputError(f"{directory} is a file; give the name of a directory")
    place = directory if directory.is_dir() else directory.parent
    if not (place.is_dir() and os.access(place, os.W_OK | os.X_OK)):
        raise InputError(f"{directory} cannot be written; choose a folder that exists and is yours")
    present = len(list(directory.iterdir())) if directory.is_dir() else 0
    if present and not force and not (resume and (directory / FOLDER).is_dir()):
        remedy = "it is no study to resume, choose another" if resume else "choose another or use --resume"
        forced = "" if force is None else " or --force"
        raise InputError(f"{directory} holds {present} files, limit 0; {remedy}{forced}")
    return Store(directory, code)


def _write_through(path: Path, text: str) -> None:
    """Write a file aside, wait until it is on disk, and put it in its place."""
    aside = path.with_name(f".{path.name}")  # left by a crash, it is overwritten by the case's next attempt
    try:
        with aside.open("w") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        aside.replace(path)
    finally:
        aside.unlink(missing_ok=True)
    _sync_directory(path.parent)


def _sync_directory(path: Path) -> None:
    """Make a replaced name last through a loss of power."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
