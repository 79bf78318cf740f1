"""Results of a study on disk, one file a case, each written at once and whole: whatever happens, they are there.

`solve_all` goes through the cases of any study, on all cores, and leaves out those whose results are there.

A file is named after a hash of the case's inputs. It holds besides them the number of the format, a digest of the code
that computed the result, and a checksum, so that a result is used again only for exactly what it was computed from and
as it was computed. Nothing but such files is ever read or replaced.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeVar

from fem_adhesion.common.files import writing
from fem_adhesion.common.jobs import Progress, WorkerDied, stream, unheard
from fem_adhesion.common.numbers import counted
from halfspace.errors import InputError

SCHEMA = 2  # raised whenever what is stored changes
FOLDER = "cases"
OTHER_CODE, OTHER_FORMAT = "other code", "another format"

Plain = Mapping[str, object]  # what JSON can hold
Item = TypeVar("Item")
Result = TypeVar("Result")


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
        outdated = (
            f"{counted(count, 'case')} computed by {what}: computed again" for what, count in self.outdated.items()
        )
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


def open_store(directory: Path, code: str, *, resume: bool = False, force: bool | None = False) -> Store:
    """Store in a directory, an existing one or new in a folder that exists, which is checked but not yet touched.

    To resume is to go on with the cases that it holds, but for the results of other code; by force one is accepted that
    is not empty, None where that cannot be asked for. InputError if the directory is a file, cannot be written, or is
    not empty and neither asked to be resumed nor forced.
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


@dataclass(frozen=True)
class Kept(Generic[Item, Result]):
    """How the results of a study are kept.

    Of an item, `inputs` are what its result depends on, and `name` what it is called for the eye. `write` goes from a
    result to plain data and `read`, with the item, back, or to InputError if they are none of a result; `died` is the
    result of an item whose worker died, for a reason.
    """

    inputs: Callable[[Item], Plain]
    name: Callable[[Item], str]
    write: Callable[[Result], Plain]
    read: Callable[[Item, Plain], Result]
    died: Callable[[Item, str], Result]


def solve_all(
    items: Sequence[Item],
    store: Store | None,
    *,
    work: Callable[[Item], Result],
    kept: Kept[Item, Result],
    fresh: bool = False,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
) -> tuple[Result, ...]:
    """Results of all items in their order: what the store holds, and the others, computed and stored at once.

    The work, a function of a module, computes the result of an item, each of which is given once, and `kept` says how
    results are kept; if `fresh`, all are computed, whatever the store holds. What a worker died of is not stored: it is
    tried again when the study is resumed. `jobs` and `dask` are those of `fem_adhesion.common.jobs.stream`; `progress`
    is called with the last item's name, how many are done, and of how many. InputError before any work, if jobs is not
    positive or the cluster does not answer.
    """
    found = dict(_stored(items, store, kept)) if store and not fresh else {}
    todo = [item for item in items if item not in found]
    with closing(stream(work, todo, jobs=jobs, dask=dask)) as results:
        progress("starting", len(found), len(items))
        for item, result in results:
            if isinstance(result, WorkerDied):
                found[item] = kept.died(item, result.reason)
            else:
                found[item] = result
                if store:
                    store.put(kept.inputs(item), kept.write(result))
            progress(kept.name(item), len(found), len(items))
    return tuple(found[item] for item in items)


def _stored(items: Sequence[Item], store: Store, kept: Kept[Item, Result]) -> Iterator[tuple[Item, Result]]:
    """Items whose results the store holds."""
    for item in items:
        inputs = kept.inputs(item)
        if (plain := store.get(inputs)) is None:
            continue
        try:
            yield item, kept.read(item, plain)
        except InputError as error:
            store.distrust(inputs, str(error))


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
