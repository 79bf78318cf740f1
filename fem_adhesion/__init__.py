"""Adhesive contact of a sphere with an elastic body by finite elements, and its cross-check on the half-space."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fem_adhesion.convergence import trace
    from fem_adhesion.scene import Scene

__all__ = ["Scene", "trace"]


def __getattr__(name: str) -> Any:
    """Import the solver when it is first asked for, so that the command line answers at once without it."""
    if name == "trace":
        from fem_adhesion.convergence import trace

        return trace
    if name == "Scene":
        from fem_adhesion.scene import Scene

        return Scene
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
