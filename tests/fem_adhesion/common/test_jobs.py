"""Work on many items: streamed, on processes that die, and on a real Dask cluster."""

import importlib.util
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import processes
import pytest
from processes import wait_until

from fem_adhesion.common import jobs as parallel
from fem_adhesion.common.jobs import Patience, WorkerDied, stream
from halfspace.errors import InputError


def square(x):
    return x * x


def last_if_first(item):
    """The item 0 waits until the others have been given, each of which leaves a file in `directory` then."""
    x, directory = item
    end = time.monotonic() + 60
    while x == 0 and len(list(Path(directory).iterdir())) < 3 and time.monotonic() < end:
        time.sleep(0.01)
    return x


def kill_own_process():
    os.kill(os.getpid(), signal.SIGKILL)


def deadly(item):
    """Square; the item 3 kills its worker while fewer than `deaths` are on record, each a file in `directory`."""
    x, deaths, directory = item
    if x == 3 and len(records := list(Path(directory).iterdir())) < deaths:
        (Path(directory) / str(len(records))).touch()
        kill_own_process()
    return x * x


def failing(x):
    raise ZeroDivisionError(f"item {x}")


def threads(_):
    return os.environ["OPENBLAS_NUM_THREADS"]


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_item_comes_once_with_its_result(jobs):
    assert sorted(stream(square, range(20), jobs=jobs)) == [(x, x * x) for x in range(20)]


KEPT = []


def grown(x):
    """Keep more than a worker may grow by after its first item; loky looks once a second."""
    KEPT.append(np.ones(int(4e8 / 8)))
    time.sleep(1.1)
    return x


def test_a_worker_that_has_grown_is_replaced_in_silence(monkeypatch):
    monkeypatch.setattr(parallel, "PATIENCE", Patience(grown=3e8))
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        assert sorted(x for x, _ in stream(grown, range(6), jobs=2)) == list(range(6))
    assert [str(warning.message) for warning in seen] == []


def test_results_come_as_they_are_ready(tmp_path):
    """Were they given in order, the first would wait in vain, and not be the last."""
    given = []
    for x, _ in stream(last_if_first, [(x, str(tmp_path)) for x in range(4)], jobs=2):
        given.append(x[0])
        (tmp_path / str(x[0])).touch()
    assert given[-1] == 0


def test_an_item_whose_worker_dies_is_tried_again(tmp_path):
    items = [(x, 1, str(tmp_path)) for x in range(8)]
    assert sorted(result for _, result in stream(deadly, items, jobs=2)) == [x * x for x in range(8)]
    assert len(list(tmp_path.iterdir())) == 1


def test_an_item_that_always_kills_its_worker_is_given_up(tmp_path):
    items = [(x, 99, str(tmp_path)) for x in range(8)]
    results = {item[0]: result for item, result in stream(deadly, items, jobs=2)}
    died = results.pop(3)
    assert isinstance(died, WorkerDied)
    assert "died 3 times" in died.reason
    assert results == {x: x * x for x in range(8) if x != 3}
    assert len(list(tmp_path.iterdir())) == 3


def test_an_unforeseen_error_is_not_hidden():
    with pytest.raises(ZeroDivisionError, match="item"):
        list(stream(failing, range(4), jobs=2))


def test_a_stream_can_be_closed_early_and_another_opened():
    first = stream(square, range(1, 50), jobs=2)
    next(first)
    first.close()
    assert len(list(stream(square, range(3), jobs=2))) == 3


def test_workers_keep_to_one_thread_of_blas():
    assert {result for _, result in stream(threads, range(4), jobs=2)} == {"1"}


@pytest.mark.parametrize("jobs", [0, -1])
def test_a_number_of_jobs_out_of_range_is_refused_at_once(jobs):
    with pytest.raises(InputError, match=rf"jobs = {jobs} is outside 1 <= jobs; "):
        stream(square, [1], jobs=jobs)


needs_cluster = pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="needs the extra cluster")


@needs_cluster
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense"])
def test_a_scheduler_that_does_not_answer_is_refused_at_once(address, monkeypatch):
    monkeypatch.setattr(parallel, "PATIENCE", Patience(connection=2))
    with pytest.raises(InputError, match=f"dask = {address} does not answer within 2 s; "):
        stream(square, [1], dask=address)


LONG = 600  # s: the end is for what never comes, not for what is slow


class Cluster:
    """A scheduler on loopback and its workers, which can import this module."""

    def __init__(self, folder):
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            port = str(listener.getsockname()[1])
        self.folder, self.address, self.workers = folder, f"tcp://127.0.0.1:{port}", []
        self.scheduler = self._start("dask_scheduler", "--host", "127.0.0.1", "--port", port)
        while not listens(self.address):
            assert self.scheduler.poll() is None, "the scheduler has ended"
            time.sleep(0.05)

    def _start(self, program, *options):
        places = (str(Path(module.__file__).parent) for module in (sys.modules[__name__], processes))
        path = os.pathsep.join([*places, os.environ.get("PYTHONPATH", "")])
        command = [sys.executable, "-m", f"distributed.cli.{program}", *options, "--no-dashboard"]
        with (self.folder / "log").open("a") as log:
            own = {**os.environ, "PYTHONPATH": path, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}
            return subprocess.Popen(command, env=own, stdout=log, stderr=log, start_new_session=True)

    def add_worker(self):
        """Start one more."""
        options = ("--nthreads", "1", "--local-directory", str(self.folder))
        self.workers.append(self._start("dask_worker", self.address, *options))

    def wait_for(self, number):
        """Wait until the scheduler knows so many workers."""
        from distributed import Client

        with Client(self.address, set_as_default=False, timeout=LONG) as client:
            client.wait_for_workers(number, timeout=LONG)

    def end(self, *processes):
        """Kill them, each with all that it has started."""
        for process in processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def listens(address):
    host, port = address.removeprefix("tcp://").split(":")
    try:
        socket.create_connection((host, int(port))).close()
    except ConnectionRefusedError:
        return False
    return True


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A scheduler without workers; the last test of the file ends it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(parallel, "PATIENCE", Patience(connection=LONG))
        made = Cluster(tmp_path_factory.mktemp("dask"))
        try:
            yield made
        finally:
            made.end(made.scheduler, *made.workers)


@pytest.fixture(scope="module")
def staffed(cluster):
    """The same with two workers."""
    while len(cluster.workers) < 2:
        cluster.add_worker()
    cluster.wait_for(2)
    return cluster


def marking(item):
    """Leave a sign of having begun, and end when there is a file `go` beside it."""
    directory = Path(item)
    (directory / "begun").touch()
    while not (directory / "go").exists():
        time.sleep(0.05)
    return "done"


@needs_cluster
def test_missing_workers_are_named_and_waited_for(cluster, capsys):
    results = []
    at_work = threading.Thread(target=lambda: results.extend(stream(square, [3], dask=cluster.address)))
    at_work.start()
    said = []
    wait_until(lambda: said.append(capsys.readouterr().err) or "no workers" in "".join(said))
    cluster.add_worker()
    at_work.join(LONG)
    assert results == [(3, 9)]
    assert f"start one with dask worker {cluster.address}\n" in "".join(said)


@needs_cluster
def test_a_dask_cluster_does_the_work_and_hides_no_error(staffed, capsys):
    """It is found by host and port alone."""
    address = staffed.address.removeprefix("tcp://")
    assert sorted(stream(square, range(20), dask=address)) == [(x, x * x) for x in range(20)]
    assert "no workers" not in capsys.readouterr().err
    with pytest.raises(ZeroDivisionError, match="item 0"):
        list(stream(failing, [0], dask=address))


@needs_cluster
def test_an_item_whose_cluster_worker_dies_goes_to_another(staffed, tmp_path):
    items = [(x, 1, str(tmp_path)) for x in range(6)]
    assert sorted(result for _, result in stream(deadly, items, dask=staffed.address)) == [x * x for x in range(6)]
    assert len(list(tmp_path.iterdir())) == 1


@needs_cluster
def test_an_item_that_kills_every_cluster_worker_is_given_up(staffed, tmp_path):
    results = {item[0]: r for item, r in stream(deadly, [(x, 99, str(tmp_path)) for x in (2, 3)], dask=staffed.address)}
    assert results[2] == 4
    assert "its worker died" in results[3].reason


@needs_cluster
def test_a_scheduler_that_has_gone_ends_the_work_in_one_line(staffed, tmp_path):
    at_work = stream(marking, [str(tmp_path)], dask=staffed.address)
    threading.Thread(target=lambda: (wait_until((tmp_path / "begun").exists), staffed.end(staffed.scheduler))).start()
    with pytest.raises(InputError, match=r"^dask[^\n]*; start it and run the command again$"):
        next(at_work)
