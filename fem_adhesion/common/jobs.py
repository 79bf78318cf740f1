"""The same work on many items at once: in local processes by joblib, or on a Dask cluster that is already there.

Results come as they are ready. A worker that dies takes no other item with it: locally the pool is made anew, and each
item that was handed out and not finished runs in a pool of its own, so that one that kills its worker is known for
certain; on Dask what the scheduler has given up runs again alone.
"""

from __future__ import annotations

import importlib
import os
import signal
import socket
import sys
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, TypeVar
from urllib.parse import urlsplit

import joblib
from joblib.externals.loky.process_executor import TerminatedWorkerError

from halfspace.errors import InputError

Item = TypeVar("Item")
Result = TypeVar("Result")

ATTEMPTS = 3  # at an item whose worker dies
CONNECTION_SECONDS = 30  # a scheduler that is busy answers late; one that is not there is known at once
WATCH_SECONDS = 1  # between two looks of a local worker at whether its study is still alive


@dataclass(frozen=True)
class WorkerDied:
    """The end of an item whose worker died at every attempt, and why it is thought to have."""

    reason: str


def stream(
    work: Callable[[Item], Result], items: Sequence[Item], *, jobs: int | None = None, dask: str | None = None
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    """Do the work on all items and give each with its result, in the order in which they end.

    The work is a function of a module: it is sent to other processes by name; what it raises ends the stream. Items are
    picklable. `jobs` are local processes, as many as there are cores unless given; one works without any process but
    this, in which a crash is not survived. `dask` is the address of the scheduler of a Dask cluster, whose workers must
    have this package; then `jobs` is unused. Close the generator to stop the workers before their time.

    InputError at once, if jobs is not positive, distributed is not installed, or the scheduler does not answer.
    """
    if dask is not None:
        return _on_cluster(work, items, *_connected(dask))
    return _on_cores(work, items, workers(jobs))


def workers(jobs: int | None) -> int:
    """Number of local processes, or InputError unless it is positive."""
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs = {jobs} is outside 1 <= jobs; leave it out to use all cores")
    return jobs or int(joblib.cpu_count())


@contextmanager
def loaded_ahead(module: str, *, jobs: int | None = None, dask: str | None = None) -> Iterator[None]:
    """Let the local workers load a module while their study loads it too, and wait for them."""
    count = workers(jobs) if dask is None else 1
    if count == 1 or module in sys.modules:
        yield
        return
    results = _pool(_load, enumerate([module] * count), count)
    try:
        yield
    finally:
        with suppress(TerminatedWorkerError, ImportError):  # of which `stream` or the study itself tells
            list(results)


def _load(module: str) -> None:
    importlib.import_module(module)


def _on_cores(
    work: Callable[[Item], Result], items: Sequence[Item], jobs: int
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    todo = dict(enumerate(items))
    while todo:
        given: set[int] = set()
        try:
            with _stopped_early(_pool(work, _handed_out(todo, given), jobs)) as results:
                for number, result in results:
                    yield todo.pop(number), result
        except TerminatedWorkerError:
            for number in sorted(given & todo.keys()):
                yield todo[number], _alone(work, todo.pop(number))


def _handed_out(todo: Mapping[int, Item], given: set[int]) -> Iterator[tuple[int, Item]]:
    """Items one by one, noting which have been asked for."""
    for number, item in list(todo.items()):
        given.add(number)
        yield number, item


def _alone(work: Callable[[Item], Result], item: Item) -> Result | WorkerDied:
    """Result of an item in a pool that holds nothing else, tried again while the worker dies."""
    for _ in range(ATTEMPTS - 1):
        try:
            with _stopped_early(_pool(work, [(0, item)], 2)) as results:  # joblib starts no process for a pool of one
                return next(results)[1]
        except TerminatedWorkerError as error:
            last = error
    return WorkerDied(f"its worker died {ATTEMPTS} times: {_one_line(last)}")


def _pool(
    work: Callable[[Item], Result], numbered: Iterable[tuple[int, Item]], jobs: int
) -> Generator[tuple[int, Result], None, None]:
    """Generator of the results with their numbers, as they come."""
    # Each process keeps to one thread of BLAS: the cores are taken by the others.
    settings: dict[str, Any] = {"backend": "loky", "inner_max_num_threads": 1} if jobs > 1 else {}
    # A worker is made anew when it has grown by 300 MB, which large bodies make it do: no trouble of the user's.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs were given", category=UserWarning)
    with joblib.parallel_config(**settings):
        pool = joblib.Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
    results: Generator[tuple[int, Result], None, None] = pool(
        joblib.delayed(_numbered)(work, number, item, os.getpid()) for number, item in numbered
    )
    return results


@contextmanager
def _stopped_early(results: Generator[Result, None, None]) -> Iterator[Generator[Result, None, None]]:
    """Close a generator of results at the end, without joblib's warning that what was under way is lost."""
    try:
        yield results
    finally:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*tasks", category=UserWarning)
            results.close()


def _numbered(work: Callable[[Item], Result], number: int, item: Item, study: int) -> tuple[int, Result]:
    """Result with its number, in a worker that ends when the process of the study is killed."""
    if os.getpid() != study:
        _watch(study)
    return number, work(item)


@cache
def _watch(study: int) -> None:
    """Start to look for the process of the study, once in each worker: an orphan would wait for work for minutes.

    What interrupts the study is its own to heed, though a terminal sends it to the workers too: it ends them.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == study:
            time.sleep(WATCH_SECONDS)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _connected(address: str) -> tuple[ModuleType, Any]:
    """The library `distributed` and a client of the scheduler at an address."""
    try:
        distributed = importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise InputError(f"dask = {address} needs the extra cluster; pip install 'fem-adhesion[cluster]'") from error
    try:
        _knock(address)
        return distributed, distributed.Client(address, timeout=CONNECTION_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"dask = {address} does not answer within {CONNECTION_SECONDS} s; give the scheduler's, as tcp://host:8786"
        ) from error


def _knock(address: str) -> None:
    """Raise OSError or InputError unless somebody listens: a client that fails to connect does not die quietly."""
    parts = urlsplit(address)
    if not parts.hostname or not parts.port:
        raise InputError("no host or no port")
    socket.create_connection((parts.hostname, parts.port), timeout=CONNECTION_SECONDS).close()


def _on_cluster(
    work: Callable[[Item], Result], items: Sequence[Item], distributed: ModuleType, client: Any
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    with client:
        futures = {client.submit(work, item, pure=False): item for item in items}
        try:
            # The scheduler gives up what died with a worker too often, also what only waited there: that runs alone.
            killed = []
            for future in distributed.as_completed(futures, loop=client.loop):
                result = _result(future, distributed.KilledWorker)
                if isinstance(result, WorkerDied):
                    killed.append(futures[future])
                else:
                    yield futures[future], result
            for item in killed:
                futures[again := client.submit(work, item, pure=False)] = item
                yield item, _result(again, distributed.KilledWorker)
        finally:
            client.cancel(list(futures))


def _result(future: Any, killed: type[Exception]) -> Any:
    try:
        return future.result()
    except killed as error:
        return WorkerDied(f"its worker died: {_one_line(error)}")


def _one_line(error: Exception) -> str:
    return str(error).strip().partition("\n")[0]
