"""Long work: how far it is, for those who wait; and the same on many items at once, by loky or on a Dask cluster.

`stream` works on items of any kind, `solve_all` on the cases of a study, leaving out those whose results are there.

Results come as they are ready. A worker that dies takes no other item with it: each that was handed out and lost so
runs again when nothing else does, so that one that kills its worker is known for certain.
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
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count, islice
from multiprocessing import active_children
from typing import Any, Generic, TypeVar
from urllib.parse import urlsplit

from fem_adhesion.common.files import Plain, Store
from halfspace.errors import InputError

Item = TypeVar("Item")
Result = TypeVar("Result")

ATTEMPTS = 3  # at an item whose worker dies
CONNECTION_SECONDS = 30  # a scheduler that is busy answers late; one that is not there is known at once
WATCH_SECONDS = 1  # between two looks of a local worker at whether its study is still alive
IDLE_SECONDS = 300  # after which a local worker without work ends
GROWN = 1e9  # bytes, by which a local worker may grow before it is made anew; to load all again takes a second
BLAS = ("OPENBLAS", "OMP", "MKL", "BLIS")
ONE_THREAD = {**{f"{name}_NUM_THREADS": "1" for name in BLAS}, "VECLIB_MAXIMUM_THREADS": "1"}
"""Each process keeps to one thread of BLAS: on systems as small as ours others cost up to seven times what one does."""


def keep_to_one_thread() -> None:
    """Have BLAS use one thread in this process unless its environment says how many; it is read as NumPy is loaded."""
    if "numpy" not in sys.modules and not ONE_THREAD.keys() & os.environ.keys():
        os.environ.update(ONE_THREAD)


# How far it is

Progress = Callable[[str, int, int], None]
"""Told what is under way, how much is done and of how much."""


def unheard(_name: str, _done: int, _total: int) -> None:
    """Progress of which nobody wants to know."""


def in_turn(progress: Progress, total: int) -> Callable[[str], None]:
    """What is told the name of each of so many parts, in order, as its work begins."""
    done = count()
    return lambda name: progress(name, next(done), total)


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """Bar on standard error if that is a terminal, with the time that has gone and what is expected to be left."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    times = (TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn())
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), *times)
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=None)
        yield lambda name, done, total: bar.update(task, description=name, completed=done, total=total)


# Many items


@dataclass(frozen=True)
class WorkerDied:
    """The end of an item whose worker died at every attempt, and why it is thought to have."""

    reason: str


@dataclass(frozen=True)
class Pool:
    """Where work is done: how it is handed out, to how many items at once, and how all is stopped, at work or idle.

    What a future raises whose worker `died`; so often an item runs alone then, and what is said if that is in vain.
    """

    submit: Callable[..., Future[Any]]
    stop: Callable[[bool], None]
    width: int
    died: type[Exception]
    alone: int
    lost: str


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
        return _on_pool(work, items, _cluster(dask, len(items)))
    number = workers(jobs)
    return ((item, work(item)) for item in items) if number == 1 else _on_pool(work, items, _processes(number))


def workers(jobs: int | None) -> int:
    """Number of local processes, or InputError unless it is positive."""
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs = {jobs} is outside 1 <= jobs; leave it out to use all cores")
    if jobs is None:
        from loky import cpu_count  # here, as all commands tell how far they are, and few need processes

        return int(cpu_count())
    return jobs


@contextmanager
def loaded_ahead(module: str, *, jobs: int | None = None, dask: str | None = None) -> Iterator[None]:
    """Let the local workers load a module while their study loads it too, and wait for them."""
    number = workers(jobs) if dask is None else 1
    if number == 1 or module in sys.modules:
        yield
        return
    futures = [_processes(number).submit(_load, module) for _ in range(number)]
    try:
        yield
    finally:
        wait(futures)  # of what one raises `stream` or the study itself tells


def _load(module: str) -> None:
    importlib.import_module(module)


def _on_pool(
    work: Callable[[Item], Result], items: Sequence[Item], pool: Pool
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    waiting, lost = iter(items), []
    given: dict[Future[Result], Item] = {}
    try:
        while True:
            given |= {pool.submit(work, item): item for item in islice(waiting, pool.width - len(given))}
            if not given:
                break
            for future in wait(given, return_when=FIRST_COMPLETED).done:
                item = given.pop(future)
                if isinstance(future.exception(), pool.died):
                    lost.append(item)
                else:
                    yield item, future.result()
        for item in lost:
            yield item, _alone(work, item, pool)
    finally:
        pool.stop(bool(given))


def _alone(work: Callable[[Item], Result], item: Item, pool: Pool) -> Result | WorkerDied:
    """Result of an item in a pool that works on nothing else, tried again while the worker dies."""
    for _ in range(pool.alone):
        try:
            result: Result = pool.submit(work, item).result()
            return result
        except pool.died as error:
            last = error
    return WorkerDied(f"{pool.lost}: {str(last).strip().partition(chr(10))[0]}")


def _processes(number: int) -> Pool:
    """So many local processes, made anew when one has died."""
    from loky import get_reusable_executor
    from loky.backend.process import LokyProcess
    from loky.process_executor import TerminatedWorkerError

    # That one is made anew where loky can tell how much it holds is no trouble of the user's.
    of_workers = "A worker (stopped|was restarted) while some jobs were given"
    warnings.filterwarnings("ignore", message=of_workers, category=UserWarning)

    def executor() -> Any:
        env = {**ONE_THREAD, "LOKY_MAX_MEMORY_LEAK_SIZE": str(GROWN)}
        settings = {"timeout": IDLE_SECONDS, "initializer": _watch, "initargs": (os.getpid(),), "env": env}
        return get_reusable_executor(number, **settings)

    def submit(*call: Any) -> Future[Any]:
        future: Future[Any]
        try:
            future = executor().submit(*call)
        except TerminatedWorkerError:  # it has died just now
            future = executor().submit(*call)
        return future

    def stop(at_work: bool) -> None:
        if not at_work:
            return  # they wait for more
        for worker in active_children():  # loky's own way stumbles over what it was given and has not handed out yet
            if isinstance(worker, LokyProcess):
                worker.terminate()
        executor().shutdown()

    return Pool(submit, stop, 2 * number, TerminatedWorkerError, ATTEMPTS - 1, f"its worker died {ATTEMPTS} times")


def _watch(study: int) -> None:
    """Let a worker look for the process of its study, without which it would wait for work for minutes.

    What interrupts the study is its own to heed, though a terminal sends it to the workers too: it ends them.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == study:
            time.sleep(WATCH_SECONDS)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _cluster(address: str, width: int) -> Pool:
    """Cluster of the scheduler at an address, which is given all items at once: it may grow with them."""
    try:
        distributed = importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise InputError(f"dask = {address} needs the extra cluster; pip install 'fem-adhesion[cluster]'") from error
    found = address if "://" in address else f"tcp://{address}"
    try:
        _knock(found)
        client = distributed.Client(found, timeout=CONNECTION_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"dask = {address} does not answer within {CONNECTION_SECONDS} s; give the scheduler's, as tcp://host:8786"
        ) from error
    if not client.nthreads():
        idle = f"dask = {address} has no workers yet and is waited for"
        sys.stderr.write(f"fem-adhesion: {idle}; start one with dask worker {found}\n")

    def submit(*call: Any) -> Future[Any]:
        future: Future[Any] = Future()
        client.submit(*call, pure=False).add_done_callback(partial(_hand_on, future))
        return future

    def stop(at_work: bool) -> None:  # noqa: ARG001 (the client goes in any case)
        client.close()

    # The scheduler gives up what died with a worker too often, also what only waited there: that runs alone, once.
    return Pool(submit, stop, width, distributed.KilledWorker, 1, "its worker died")


def _hand_on(future: Future[Any], done: Any) -> None:
    """Give a future what one of the cluster's has come to.

    The client's own executor asks for the status after the result, and fails if the worker has died in between.
    """
    try:
        future.set_result(done.result())
    except BaseException as error:
        future.set_exception(error)


def _knock(address: str) -> None:
    """Raise OSError or InputError unless somebody listens: a client that fails to connect does not die quietly."""
    parts = urlsplit(address)
    if not parts.hostname or not parts.port:
        raise InputError("no host or no port")
    socket.create_connection((parts.hostname, parts.port), timeout=CONNECTION_SECONDS).close()


# The cases of a study


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
    work: Callable[..., Any],
    kept: Kept[Item, Result],
    parts: Callable[[Sequence[Item]], Sequence[tuple[Item, ...]]] | None = None,
    fresh: bool = False,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
) -> tuple[Result, ...]:
    """Results of all items in their order: what the store holds, and the others, computed and stored at once.

    The work, a function of a module, computes the result of an item, each of which is given once, and `kept` says
    how results are kept. Where items are best worked on together, `parts` says which, and the work turns such a
    part into a list; its results are stored together. If `fresh`, all are computed, whatever the store holds. What
    a worker died of is not stored: it is tried again when the study is resumed. `jobs` and `dask` are those of
    `stream`; `progress` is called with the last item's name, how many are done, and of how many. InputError before
    any work, if jobs is not positive or the cluster does not answer.
    """
    found = dict(_stored(items, store, kept)) if store and not fresh else {}
    todo = [item for item in items if item not in found]
    where = partial(stream, work, jobs=jobs, dask=dask)
    with closing(_one_by_one(where, parts(todo)) if parts else where(todo)) as results:
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


def _one_by_one(
    where: Callable[..., Generator[tuple[tuple[Item, ...], Any], None, None]], parts: Sequence[tuple[Item, ...]]
) -> Generator[tuple[Item, Any], None, None]:
    """Items of parts with their results, as these come; each by itself of what a worker died of."""
    died: list[tuple[Item, ...]] = []
    with closing(where(parts)) as done:
        for part, results in done:
            if not isinstance(results, WorkerDied):
                yield from zip(part, results, strict=True)
            elif len(part) > 1:
                died += [(item,) for item in part]
            else:
                yield part[0], results
    if died:
        yield from _one_by_one(where, died)


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
