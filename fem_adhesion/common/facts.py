"""What records have in common: values as JSON has them, and the versions that decide the numbers."""

from __future__ import annotations

import math
import platform
from importlib.metadata import version


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
