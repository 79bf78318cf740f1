"""What records say besides their numbers: values as JSON has them, versions, the machine and the memory taken."""

from __future__ import annotations

import gc
import math
import os
import platform
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

PROC = Path("/proc")


def versions() -> dict[str, str]:
    """Versions that decide the numbers."""
    packages = ("fem-adhesion", "numpy", "scipy", "scikit-fem")
    return {"python": platform.python_version(), **{name: version(name) for name in packages}}


def plain(value: object) -> object:
    """What JSON has: None for what is infinite or not a number, a name for a file."""
    if isinstance(value, dict):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, float):
        return finite(value)
    return value if value is None or isinstance(value, (str, int)) else str(value)


def finite(value: float) -> float | None:
    """The value, or None if it is infinite or not a number."""
    return float(value) if math.isfinite(value) else None


def machine() -> dict[str, str]:
    """Processor, cores, system and threads that decide the times."""
    model = _value(PROC / "cpuinfo", "model name")
    return {
        "processor": platform.processor() or platform.machine() if model == "nan" else model,
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.release()}",
        "OPENBLAS_NUM_THREADS": os.environ.get("OPENBLAS_NUM_THREADS", "not set"),
    }


@dataclass
class Memory:
    """Growth of the peak memory inside a `peak_memory` block, in MiB; nan where the system does not tell."""

    mebibytes: float = float("nan")


@contextmanager
def peak_memory() -> Iterator[Memory]:
    """Measure by how much the process grows, at its peak, over what it holds at the start.

    What earlier work has given back to the allocator but not to the system is reused unseen: small needs may show as 0.
    """
    memory = Memory()
    gc.collect()
    start = _restart_peak()
    yield memory
    memory.mebibytes = (_resident("VmHWM") - start) / 1024


def _restart_peak() -> float:
    """Set the process's peak to what it holds now, in KiB; nan where there is no such thing as /proc."""
    try:
        (PROC / "self/clear_refs").write_text("5")
    except OSError:
        return float("nan")
    return _resident("VmRSS")


def _resident(key: str) -> float:
    """Resident memory in KiB, now (VmRSS) or at its peak (VmHWM)."""
    return float(_value(PROC / "self/status", key).split()[0] or "nan")


def _value(file: Path, key: str) -> str:
    """Value of the first line "key: value" of a file; "nan" if there is none."""
    try:
        lines = file.read_text().splitlines()
    except OSError:
        return "nan"
    return next((line.partition(":")[2].strip() for line in lines if line.startswith(key)), "nan")
