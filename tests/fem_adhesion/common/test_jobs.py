"""Work on many items: streamed, on processes that die, and on a real Dask cluster."""

import importlib.util
import os
import signal
import socket
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

from fem_adhesion.common import jobs as parallel
from fem_adhesion.common.jobs import ATTEMPTS, CONNECTION_SECONDS, WorkerDied, stream
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


def test_a_worker_that_has_grown_is_made_anew_without_a_word_to_the_user(monkeypatch):
    monkeypatch.setattr(parallel, "GROWN", 3e8)
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        assert sorted(x for x, _ in stream(grown, range(6), jobs=2)) == list(range(6))
    assert [str(warning.message) for warning in seen] == []


def loaded(module):
    time.sleep(0.2)  # a worker that starts late may come to it when another has loaded it twice
    return module in sys.modules


def test_workers_load_a_module_while_their_study_does():
    module = "wave"  # of the standard library, and none that anything here needs
    with parallel.loaded_ahead(module, jobs=2):
        assert module not in sys.modules
    assert any(there for _, there in stream(loaded, [module] * 6, jobs=2))
    assert module not in sys.modules


def test_what_their_study_is_refused_for_is_told_by_it():
    with pytest.raises(InputError, match="on purpose"), parallel.loaded_ahead("wave", jobs=2):
        raise InputError("on purpose")


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


def test_an_item_that_always_kills_its_worker_is_given_up_and_no_other(tmp_path):
    items = [(x, 99, str(tmp_path)) for x in range(8)]
    results = {item[0]: result for item, result in stream(deadly, items, jobs=2)}
    died = results.pop(3)
    assert isinstance(died, WorkerDied)
    assert f"died {ATTEMPTS} times" in died.reason
    assert results == {x: x * x for x in range(8) if x != 3}
    assert len(list(tmp_path.iterdir())) == ATTEMPTS


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
def test_a_scheduler_that_does_not_answer_is_refused_at_once(address):
    with pytest.raises(InputError, match=f"dask = {address} does not answer within {CONNECTION_SECONDS} s; "):
        stream(square, [1], dask=address)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


PATIENCE = 600  # s: the end is for what never comes, not for what is slow


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Address of a scheduler on loopback with two workers that can import this module."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(parallel, "CONNECTION_SECONDS", PATIENCE)
        yield from started_cluster(tmp_path_factory)


def started_cluster(tmp_path_factory):
    scratch = tmp_path_factory.mktemp("dask")
    address = f"tcp://127.0.0.1:{free_port()}"
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": path}
    worker = ["dask_worker", address, "--nthreads", "1", "--no-dashboard", "--local-directory", str(scratch)]
    scheduler = ["dask_scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2], "--no-dashboard"]
    with (scratch / "log").open("w") as log:
        processes = [
            subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.{program}", *options],
                env=environment,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
            for program, *options in (scheduler, worker, worker)
        ]
        try:
            yield wait_for(address, processes[0])
        finally:
            for process in processes:  # with what each has started
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def wait_for(address, scheduler):
    """Wait until the scheduler listens and knows both workers."""
    from distributed import Client

    while not listens(address):
        assert scheduler.poll() is None, "the scheduler has ended"
        time.sleep(0.05)
    with Client(address, set_as_default=False, timeout=PATIENCE) as client:
        client.wait_for_workers(2, timeout=PATIENCE)
    return address


def listens(address):
    host, port = address.removeprefix("tcp://").split(":")
    try:
        socket.create_connection((host, int(port))).close()
    except ConnectionRefusedError:
        return False
    return True


@needs_cluster
def test_a_scheduler_is_found_by_host_and_port_and_said_to_be_waited_for_only_without_workers(
    cluster, capsys, monkeypatch
):
    """That the scheduler knows of none is made up: the work is done all the same."""
    from distributed import Client

    address = cluster.removeprefix("tcp://")
    said = f"dask = {address} has no workers yet and is waited for; start one with dask worker {cluster}"
    assert list(stream(square, [3], dask=address)) == [(3, 9)]
    assert "no workers" not in capsys.readouterr().err
    monkeypatch.setattr(Client, "nthreads", lambda _: {})
    assert list(stream(square, [3], dask=address)) == [(3, 9)]
    assert said in capsys.readouterr().err


@needs_cluster
def test_a_dask_cluster_does_the_work(cluster):
    assert sorted(stream(square, range(20), dask=cluster)) == [(x, x * x) for x in range(20)]


@needs_cluster
def test_an_unforeseen_error_on_the_cluster_is_not_taken_for_a_dead_worker(cluster):
    with pytest.raises(ZeroDivisionError, match="item 0"):
        list(stream(failing, [0], dask=cluster))


@needs_cluster
def test_a_worker_of_the_cluster_that_dies_is_replaced_and_its_item_done(cluster, tmp_path):
    items = [(x, 1, str(tmp_path)) for x in range(6)]
    assert sorted(result for _, result in stream(deadly, items, dask=cluster)) == [x * x for x in range(6)]
    assert len(list(tmp_path.iterdir())) == 1


@needs_cluster
def test_an_item_that_kills_every_worker_of_the_cluster_is_given_up(cluster, tmp_path):
    results = {item[0]: r for item, r in stream(deadly, [(x, 99, str(tmp_path)) for x in (2, 3)], dask=cluster)}
    assert results[2] == 4
    assert "its worker died" in results[3].reason
