"""Adhesive contact of an elastic sphere with an elastic half-space, by an integral equation, after Greenwood (1997).

`trace` gives the whole load-approach curve with its events, `sweep` those of many. Rooms, in the order of reading:
`laws` and `profiles` (the parts of a contact), `elastic` (half-space and layers alone), `equilibrium` (contact, path,
events), `accuracy` (to the digits asked for), `theories` (closed forms), `atlas` (events and energies by
series, without solving); under them `scaling` (SI, and other people's parameters).

Conventions are Greenwood's, everywhere. R is the equivalent radius, E* the contact modulus, dgamma the work of
adhesion, eps the spacing at which the surfaces are in equilibrium, mu = (R dgamma^2/(E*^2 eps^3))^(1/3) the Tabor
parameter and beta = (R^2 dgamma/E*)^(1/3).

| quantity | in the code | unit | sign |
|---|---|---|---|
| approach alpha* | `approach` | eps | positive when pressed together; zero where undeformed surfaces are eps apart |
| gap H = h/eps - 1 | `gap`, `central_gap` | eps | zero at the equilibrium spacing |
| load W | `load` | R dgamma | positive in compression; the pull-off force is -min W |
| radius u, a | `radii`, `contact_radius` | beta | to where the tension is largest, H + 1 = 3^(1/6) by the 3-9 law |
| pressure P | `pressure` | dgamma/(mu eps) | positive in compression |
| energy | `energy` | R dgamma eps | released between a separated state and zero approach in contact |

Of a body with a length of its own the approach is that of the plane or cap by which it is held, zero where the
undeformed pole would be eps from the wall, so it includes the yield of the whole body. R/eps is ``radius_ratio``, and
R/beta its root over that of mu. An approach has no natural zero, so its size is no measure of anything: errors, budgets
and deviations of approaches are relative to eps and the range of the approaches of all events of the curve.

From a call to an event with its error: `trace` checks what is asked and says how the contact is discretised.
`half_space_charts`, or its like, makes the charts: one on a grid fine on the axis, one on a grid that follows the edge.
`climb` goes up the ladder of rungs until the tolerance is met. `trace_charts` traces the curve on the lowest rung.
`find_events` finds which events it has and solves for each there. `chains_of` solves for each again on a finer rung, on
a coarser grid and on a twin of other cells. `turning_point` is Newton's method for a fold or an extremum, `attempt`
that for a given value. `errors_of` makes error estimates of the changes from rung to rung. `Tolerance.missed` says
whether to climb on. `confirmed` decides which turns of the curve every rung has, for events and branches alike.

Events: ``pull_off`` is the deepest minimum of the load; ``jump_on`` and ``jump_off`` are the folds that an experiment
under fixed grips meets when it comes from separation and from contact; ``zero_load`` lies on the contact branch. Each
is solved for, not read off samples of the curve. The approach at pull-off is the place of a flat extremum and less
certain than the load there; its error estimate says by how much.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from halfspace import atlas, laws, profiles, scaling, theories
    from halfspace.accuracy.sweep import Sweep, sweep
    from halfspace.accuracy.trace import trace
    from halfspace.elastic.layers import Coated, Layer, Layers, Stratum, Substrate
    from halfspace.equilibrium.curve import EquilibriumPath
    from halfspace.equilibrium.events import Event
    from halfspace.errors import ContactTooWide, GridTooCoarse, IllPosed, InputError, NotConverged
    from halfspace.values import Estimate

__all__ = [
    "Coated",
    "ContactTooWide",
    "EquilibriumPath",
    "Estimate",
    "Event",
    "GridTooCoarse",
    "IllPosed",
    "InputError",
    "Layer",
    "Layers",
    "NotConverged",
    "Stratum",
    "Substrate",
    "Sweep",
    "atlas",
    "laws",
    "profiles",
    "scaling",
    "sweep",
    "theories",
    "trace",
]

_ROOMS = ("atlas", "laws", "profiles", "scaling", "theories")
_HOMES = {
    "trace": "accuracy.trace",
    "sweep": "accuracy.sweep",
    "Sweep": "accuracy.sweep",
    "EquilibriumPath": "equilibrium.curve",
    "Estimate": "values",
    "Event": "equilibrium.events",
    **dict.fromkeys(("Coated", "Layer", "Layers", "Stratum", "Substrate"), "elastic.layers"),
    **dict.fromkeys(("ContactTooWide", "GridTooCoarse", "IllPosed", "InputError", "NotConverged"), "errors"),
}


def __getattr__(name: str) -> Any:
    """Import what is public when it is first asked for, so that the command line answers at once."""
    if name in _ROOMS:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
