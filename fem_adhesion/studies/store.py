"""Results of a study on disk, one file a case, each written at once and whole: whatever happens, they are there.

A file is named after a hash of the case's inputs, the version of the package and the number of the format, so that a
result is used again only for exactly what it was computed from. Nothing but such files is ever read or replaced.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from fem_adhesion.writing import writing
from halfspace.errors import InputError

SCHEMA = 1  # raised whenever what is stored changes
FOLDER = "cases"

Plain = Mapping[str, object]  # what JSON can hold


@dataclass(frozen=True)
class Store:
    """A directory of results.

    Attributes
    ----------
    directory : Path
        The study's; the files are in its folder ``cases``. Made when the first result comes.
    version : str
        Of the package.
    notes : list of str
        What was found unreadable and is to be computed again.
    """

    directory: Path
    version: str
    notes: list[str] = field(default_factory=list)

    def path(self, inputs: Plain) -> Path:
        """File of a case."""
        text = json.dumps(self._heading(inputs), sort_keys=True, allow_nan=False)
        return self.directory / FOLDER / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.json"

    def get(self, inputs: Plain) -> Plain | None:
        """Result of a case, or None if there is none that can be trusted; then a note says so."""
        path = self.path(inputs)
        try:
            found = json.loads(path.read_bytes())
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            self._ignore(path, str(error))
            return None
        result = found.pop("result", None) if isinstance(found, dict) else None
        if isinstance(result, dict) and found == self._heading(inputs):
            return result
        self._ignore(path, "it does not hold the result of its case")
        return None

    def put(self, inputs: Plain, result: Plain) -> None:
        """Write the result of a case: after this call it is on disk; before, there is none, or the one of before."""
        path = self.path(inputs)
        text = json.dumps({**self._heading(inputs), "result": result}, indent=1, allow_nan=False)
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            _write_through(path, text)

    def _heading(self, inputs: Plain) -> dict[str, object]:
        return {"schema": SCHEMA, "version": self.version, "inputs": dict(inputs)}

    def _ignore(self, path: Path, why: str) -> None:
        self.notes.append(f"{path} is computed again: {why}")


def open_store(directory: Path, *, resume: bool = False, force: bool = False) -> Store:
    """Store in a directory, which is checked but not yet touched.

    Parameters
    ----------
    directory : Path
        An existing one or a new one in a folder that exists.
    resume : bool
        Go on with the cases that it holds.
    force : bool
        Accept one that is not empty.

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
        raise InputError(f"{directory} holds {present} files, limit 0; {remedy} or --force")
    return Store(directory, package_version())


def package_version() -> str:
    """Version of the installed package."""
    try:
        return version("fem-adhesion")
    except PackageNotFoundError:  # run from its sources
        return "unknown"


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
