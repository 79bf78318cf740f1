"""Adhesive contact of a sphere with an elastic half-space, by an integral equation, after Greenwood (1997).

All quantities are dimensionless: radii in beta = (R^2 dgamma/E*)^(1/3), gaps and approach in eps, loads in R dgamma,
pressures P = mu eps p/dgamma; compression is positive.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from halfspace.accuracy.trace import trace
    from halfspace.equilibrium.curve import EquilibriumPath, Estimate
    from halfspace.equilibrium.events import Event
    from halfspace.errors import ContactTooWide, GridTooCoarse, InputError, NotConverged

__all__ = [
    "ContactTooWide",
    "EquilibriumPath",
    "Estimate",
    "Event",
    "GridTooCoarse",
    "InputError",
    "NotConverged",
    "trace",
]

_HOMES = {
    "trace": "accuracy.trace",
    "EquilibriumPath": "equilibrium.curve",
    "Estimate": "equilibrium.curve",
    "Event": "equilibrium.events",
    **dict.fromkeys(("ContactTooWide", "GridTooCoarse", "InputError", "NotConverged"), "errors"),
}


def __getattr__(name: str) -> Any:
    """Import what is public when it is first asked for, so that the command line answers at once."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
