"""Long work: a bar that shows progress, and the same work on many items at once, by local processes or on a cluster.

`stream` works on items of any kind; `solve_all` on the cases of a study, without those whose results are stored.

Results come as they are ready. A worker that dies costs no other item: the items that were lost with it run again when
nothing else runs, one at a time, so that the item that kills its worker is known for certain.

joblib 1.6 was tried in the place of this module: where a worker dies it ends the whole stream, and its workers outlive
a study that was killed. The second attempts, the watch over the study and the words to the user would all remain, and
these are most of the module.
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
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count, islice
from multiprocessing import active_children
from typing import Any, TypeVar
from urllib.parse import urlsplit

from fem_adhesion.common.files import Plain, Store
from halfspace.errors import InputError

Item = TypeVar("Item")
Result = TypeVar("Result")

BLAS = ("OPENBLAS", "OMP", "MKL", "BLIS")
ONE_THREAD = {**{f"{name}_NUM_THREADS": "1" for name in BLAS}, "VECLIB_MAXIMUM_THREADS": "1"}
"""Each process keeps to one thread of BLAS: on systems as small as ours more threads take up to seven times as long."""


@dataclass(frozen=True)
class Patience:
    """How long workers are waited for, in seconds, and how much they may grow."""

    attempts: int = 3  # at an item whose worker dies; one more only if the machine itself kills at random
    connection: float = 30.0  # for the answer of a scheduler; one that is not there is known at once
    watch: float = 1.0  # between two looks of a local worker at whether its study is alive
    idle: float = 300.0  # after which a local worker without work ends
    grown: float = 1e9  # bytes by which a local worker may grow before it is replaced, which takes a second


PATIENCE = Patience()


def keep_to_one_thread() -> None:
    """Let BLAS use one thread in this process unless the environment says how many. Call it before NumPy is loaded."""
    if "numpy" not in sys.modules and not ONE_THREAD.keys() & os.environ.keys():
        os.environ.update(ONE_THREAD)


# Progress

Progress = Callable[[str, int, int], None]
"""Takes what is under way, how many parts are done, and of how many."""


def unheard(_name: str, _done: int, _total: int) -> None:
    """Progress that nobody wants to see."""


def in_turn(progress: Progress, total: int) -> Callable[[str], None]:
    """Function to call with the name of each part, in order, as its work begins."""
    done = count()
    return lambda name: progress(name, next(done), total)


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """Bar on standard error if that is a terminal, with the time spent and the time expected to remain."""
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
    """End of an item whose worker died at every attempt, and the likely reason."""

    reason: str


@dataclass(frozen=True)
class Pool:
    """Workers: `submit` hands out a call, `width` calls at once; `stop` ends them, at work or idle.

    A future raises `died` if its worker died.
    """

    submit: Callable[..., Future[Any]]
    stop: Callable[[bool], None]
    width: int
    died: type[Exception]


def stream(
    work: Callable[[Item], Result], items: Sequence[Item], *, jobs: int | None = None, dask: str | None = None
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    """Do the work on all items and give each with its result, in the order in which they end.

    The work is a function of a module: it is sent to other processes by name; an error that it raises ends the stream.
    Items are picklable. `jobs` is the number of local processes, by default that of the cores; with one the work is
    done in this process, which does not survive a crash. `dask` is the address of the scheduler of a Dask cluster,
    whose workers have this package; `jobs` is unused then. Close the generator to stop the workers early.

    InputError at once if jobs is not positive, distributed is not installed, or the scheduler does not answer.
    """
    if dask is not None:
        return _on_pool(work, items, _cluster(dask, len(items)))
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs = {jobs} is outside 1 <= jobs; leave it out to use all cores")
    if jobs == 1:
        return ((item, work(item)) for item in items)
    return _on_pool(work, items, _processes(jobs))


def _on_pool(
    work: Callable[[Item], Result], items: Sequence[Item], pool: Pool
) -> Generator[tuple[Item, Result | WorkerDied], None, None]:
    """Results as they come. An item whose worker died runs again when nothing else does, some times at most."""
    waiting, lost = iter(items), list[tuple[Item, int]]()
    given: dict[Future[Result], tuple[Item, int]] = {}  # items with the number of the attempt
    try:
        while True:
            given |= {pool.submit(work, item): (item, 1) for item in islice(waiting, pool.width - len(given))}
            if not given and lost:
                alone = lost.pop()
                given[pool.submit(work, alone[0])] = alone
            if not given:
                return
            for future in wait(given, return_when=FIRST_COMPLETED).done:
                item, attempt = given.pop(future)
                if not isinstance(error := future.exception(), pool.died):
                    yield item, future.result()
                elif attempt < PATIENCE.attempts:
                    lost.append((item, attempt + 1))
                else:
                    yield item, WorkerDied(f"its worker died {attempt} times: {str(error).strip().splitlines()[0]}")
    finally:
        pool.stop(bool(given))


def _processes(number: int | None) -> Pool:
    """Local processes, as many as cores unless their number is given, started anew when one has died."""
    from loky import cpu_count, get_reusable_executor  # here, as every command shows progress and few need processes
    from loky.backend.process import LokyProcess
    from loky.process_executor import TerminatedWorkerError

    # loky warns where it replaces a worker that has grown, which is no trouble of the user's.
    replaced = "A worker (stopped|was restarted) while some jobs were given"
    warnings.filterwarnings("ignore", message=replaced, category=UserWarning)
    number = number or int(cpu_count())
    grown = {"LOKY_MAX_MEMORY_LEAK_SIZE": str(PATIENCE.grown)}
    settings = {"timeout": PATIENCE.idle, "initializer": _watch, "initargs": (os.getpid(),), "env": ONE_THREAD | grown}
    executor: Callable[[], Any] = partial(get_reusable_executor, number, **settings)

    def submit(*call: Any) -> Future[Any]:
        try:
            future: Future[Any] = executor().submit(*call)
        except TerminatedWorkerError:  # it has died just now
            future = executor().submit(*call)
        return future

    def stop(at_work: bool) -> None:
        if not at_work:
            return  # the workers wait for more
        for worker in active_children():  # loky's own way fails on items that it has taken and not yet handed out
            if isinstance(worker, LokyProcess):
                worker.terminate()
        executor().shutdown()

    return Pool(submit, stop, 2 * number, TerminatedWorkerError)


def _watch(study: int) -> None:
    """End this worker soon after its study, without which it would wait for work for minutes.

    Ctrl-C in a terminal reaches the workers too; they leave it to the study, which stops them.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == study:
            time.sleep(PATIENCE.watch)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _cluster(address: str, width: int) -> Pool:
    """Cluster of the scheduler at an address. It takes all items at once, so that it may grow with them."""
    try:
        distributed = importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise InputError(f"dask = {address} needs the extra cluster; pip install '.[cluster]' in a clone") from error
    found, seconds = address if "://" in address else f"tcp://{address}", PATIENCE.connection
    try:
        place = urlsplit(found)
        # A client that fails to connect writes to the terminal.
        socket.create_connection((place.hostname or "", place.port or 0), timeout=seconds).close()
        client = distributed.Client(found, timeout=seconds, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"dask = {address} does not answer within {seconds:g} s; give the scheduler's, as tcp://host:8786"
        ) from error
    if not client.nthreads():
        idle = f"dask = {address} has no workers and is waited for; start one with dask worker {found}"
        sys.stderr.write(f"fem-adhesion: {idle}\n")

    def submit(*call: Any) -> Future[Any]:
        future: Future[Any] = Future()

        def hand_on(done: Any) -> None:
            """Give the result or the error: the client's own executor fails if a worker dies before it is asked."""
            try:
                future.set_result(done.result())
            except CancelledError:
                future.set_exception(InputError("dask: the scheduler has gone; start it and run the command again"))
            except BaseException as error:
                future.set_exception(error)

        client.submit(*call, pure=False).add_done_callback(hand_on)
        return future

    # The scheduler gives up an item that was on too many dying workers, even if it only waited there: that runs alone.
    return Pool(submit, lambda _: client.close(), width, distributed.KilledWorker)


# The cases of a study


def solve_all(
    items: Sequence[Item],
    store: Store | None,
    *,
    work: Callable[..., Any],
    inputs: Callable[[Item], Plain],
    name: Callable[[Item], str],
    write: Callable[[Result], Plain],
    read: Callable[[Item, Plain], Result],
    died: Callable[[Item, str], Result],
    fresh: bool = False,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
) -> tuple[Result, ...]:
    """Results of all items in their order: those in the store, and the others, each stored as soon as it is computed.

    The work, a function of a module, computes the result of an item; each item is given once. `inputs` are what its
    result depends on, `name` what it is called on the screen. `write` makes plain data of a result; `read` takes the
    item and such data, and raises InputError if they hold no result. `died` makes the result of an item whose worker
    died; that is not stored: it is tried again when the study is resumed. If `fresh`, all are computed, whatever the
    store holds.
    `jobs` and `dask` are those of `stream`; `progress` is called with the last item's name, how many are done, and of
    how many. InputError before any work if jobs is not positive or the cluster does not answer.
    """
    found: dict[Item, Result] = {}
    for item in items if store and not fresh else ():
        if store and (plain := store.get(inputs(item))) is not None:
            try:
                found[item] = read(item, plain)
            except InputError as error:
                store.distrust(inputs(item), str(error))
    todo = [item for item in items if item not in found]
    with closing(stream(work, todo, jobs=jobs, dask=dask)) as results:
        progress("starting", len(found), len(items))
        for item, result in results:
            if isinstance(result, WorkerDied):
                found[item] = died(item, result.reason)
            else:
                found[item] = result
                if store:
                    store.put(inputs(item), write(result))
            progress(name(item), len(found), len(items))
    return tuple(found[item] for item in items)
