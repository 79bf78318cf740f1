"""What records say besides their numbers: JSON's values, versions, the machine, the memory taken, and code."""

from __future__ import annotations

import gc
import hashlib
import math
import os
import platform
from collections.abc import Callable, Mapping
from dataclasses import asdict, is_dataclass
from functools import cache
from importlib.metadata import version
from modulefinder import ModuleFinder
from pathlib import Path
from typing import TypeVar

PROC = Path("/proc")
Result = TypeVar("Result")


def versions() -> dict[str, str]:
    """Versions that decide the numbers."""
    return {"python": platform.python_version(), **{name: version(name) for name in ("fem-adhesion", *LIBRARIES)}}


def plain(value: object) -> object:
    """What JSON has: None for what is infinite or not a number, a name for a file, fields and arrays as such."""
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    if hasattr(value, "tolist"):  # an array; to load NumPy here is too much
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else str(value)


def machine() -> dict[str, str]:
    """Processor, cores, system and threads that decide the times."""
    model = _value(PROC / "cpuinfo", "model name")
    return {
        "processor": platform.processor() or platform.machine() if model == "nan" else model,
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.release()}",
        "OPENBLAS_NUM_THREADS": os.environ.get("OPENBLAS_NUM_THREADS", "not set"),
    }


def with_peak_memory(work: Callable[[], Result]) -> tuple[Result, float]:
    """Result of some work, and by how many MiB the process grew over what it held at the start, at its peak.

    What earlier work has given back to the allocator but not to the system is reused unseen: small needs may show as 0.
    It is nan where the system does not tell.
    """

    def resident(key: str) -> float:
        """Resident memory in KiB, now (VmRSS) or at its peak (VmHWM)."""
        return float(_value(PROC / "self/status", key).split()[0] or "nan")

    gc.collect()
    try:
        (PROC / "self/clear_refs").write_text("5")  # the peak is what it holds now
        start = resident("VmRSS")
    except OSError:
        start = float("nan")
    result = work()
    return result, (resident("VmHWM") - start) / 1024


def _value(file: Path, key: str) -> str:
    """Value of the first line "key: value" of a file; "nan" if there is none."""
    try:
        lines = file.read_text().splitlines()
    except OSError:
        return "nan"
    return next((line.partition(":")[2].strip() for line in lines if line.startswith(key)), "nan")


PROJECT = ("fem_adhesion", "halfspace")
LIBRARIES = ("numpy", "scipy", "scikit-fem")


@cache
def code_digest(module: str) -> str:
    """Digest, 16 hexadecimal digits, of the code that a module of this project, by its full name, runs.

    Two results of the same inputs and digest are the same. The code is read, not run: it is that of the module asked
    for and of all modules of this project that it imports, at whatever place and through whatever others. The versions
    of the libraries that compute with it count as code.
    """
    found = hashlib.sha256()
    for name, file in sorted(sources(module).items()):
        found.update(f"{name} {hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode())
    for library in LIBRARIES:
        found.update(f"{library} {version(library)}\n".encode())
    return found.hexdigest()[:16]


def sources(module: str) -> dict[str, Path]:
    """Files of a module of this project and of all others of it that it imports, by their full names."""
    root = Path(__file__).parents[2]
    libraries = [place.stem for place in root.iterdir() if place.stem not in PROJECT]  # beside it where it is installed
    finder = ModuleFinder([str(root)], excludes=libraries)
    finder.import_hook(module)
    files = {name: vars(found)["__file__"] for name, found in finder.modules.items()}
    return {name: Path(file) for name, file in files.items() if file}
