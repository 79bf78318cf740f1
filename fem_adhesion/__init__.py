"""Adhesive contact of a sphere with an elastic body by finite elements, and its cross-check on the half-space."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fem_adhesion.convergence import trace
    from fem_adhesion.scene import Counter, Scene

__all__ = ["Counter", "Scene", "trace"]

_HOMES = {"trace": "convergence", "Counter": "scene", "Scene": "scene"}


def __getattr__(name: str) -> Any:
    """Import what is public when it is first asked for, so that the command line answers at once."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
