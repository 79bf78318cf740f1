"""Waiting for processes, as the tests that end them from outside do."""

import os
import signal
import subprocess
import time
from contextlib import contextmanager

PATIENCE = 300  # s; an end to waiting for what never comes, not for what is slow


def wait_until(condition):
    """Wait for a condition."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "it never came"
        time.sleep(0.02)


def alive(group):
    """Whether any process of a group is there."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


@contextmanager
def started(command, **how):
    """Process in a group of its own, of which nothing is left at the end; `how` as of `subprocess.Popen`."""
    process = subprocess.Popen(command, start_new_session=True, **how)
    try:
        yield process
    finally:
        if alive(process.pid):
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
