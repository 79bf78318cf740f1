"""Comparisons of the session: each part of one is computed once, whichever command lines and tests ask for it.

A program that imports this module keeps and finds them in the directory that the environment names.
"""

import fcntl
import hashlib
import os
import pickle
from pathlib import Path

from fem_adhesion.crosscheck import scenes

PLACE = "TESTS_KEPT_COMPARISONS"
computed = scenes._compared


def kept(part, *, rtol):
    """A part of a comparison as it was computed before, or is now."""
    file = Path(os.environ[PLACE], hashlib.sha256(repr((part, rtol)).encode()).hexdigest()[:16])
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not file.exists():
            file.write_bytes(pickle.dumps(computed(part, rtol=rtol)))
    return pickle.loads(file.read_bytes())


def keep(place, patched):
    """Let comparisons of this process be kept in a directory while it is patched."""
    place.mkdir(parents=True, exist_ok=True)
    patched.setenv(PLACE, str(place))
    patched.setattr(scenes, "_compared", kept)
