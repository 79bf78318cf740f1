"""What is known without solving the contact problem.

`closed_forms` (Hertz, Bradley, JKR), `dmt`, `maugis` (Dugdale's law), `exact_sphere` (a sphere's profile in the place
of a paraboloid's), `curves` (Bradley, DMT, JKR, Maugis as samples), `layered` (Hertz, JKR and a published series on
thin samples), `criteria` (for jumping on), `fits` (closed expressions fitted to the atlas: pull-off, contact radius,
jumps, energy lost).
"""

from importlib import import_module
from typing import Any

__all__ = ["closed_forms", "criteria", "curves", "dmt", "exact_sphere", "fits", "layered", "maugis"]


def __getattr__(name: str) -> Any:
    """Import a module when it is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"{__name__}.{name}")


def __dir__() -> list[str]:
    return __all__
